//! A printer that is not there: Marlin's side of the serial link in simulated time, with faults by seed.
//!
//! It knows only documented behaviour: line numbers, checksums, the replies, the planner's queue,
//! heaters that take time. Standard library alone, so that it also builds for the page.

#![allow(dead_code, unreachable_pub, reason = "a module of several tests; each needs another part of it")]

use std::collections::{HashMap, VecDeque};
use std::time::Duration;

const MS: Duration = Duration::from_millis(1);

/// Small, seeded, the same everywhere (SplitMix64; Steele, Lea, Flood 2014).
#[derive(Debug, Clone)]
pub struct Rng(u64);

impl Rng {
    pub fn new(seed: u64) -> Rng {
        Rng(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        ((self.next() >> 11) as f64 / (1u64 << 53) as f64) < probability
    }
}

/// Probabilities are per line; counts are of job moves accepted.
#[derive(Debug, Clone, Default)]
pub struct Faults {
    /// A byte changed, lost or added on the way to the printer.
    pub garble_in: f64,
    /// The same on the way back.
    pub garble_out: f64,
    pub lose_ok: f64,
    pub double_ok: f64,
    /// A request comes again some time later.
    pub late_resend: f64,
    /// A request comes many times at once.
    pub resend_storm: f64,
    /// No `ok` behind a request.
    pub no_ok_after_resend: f64,
    pub noise_before_banner: bool,
    pub split_reads: bool,
    pub reset_after: Option<usize>,
    pub hang_after: Option<usize>,
    pub error_after: Option<usize>,
}

#[derive(Debug, Clone)]
pub struct SimOptions {
    pub seed: u64,
    pub advanced_ok: bool,
    pub autoreport: bool,
    pub emergency_parser: bool,
    pub busy: bool,
    pub receive_buffer: usize,
    pub command_queue: usize,
    pub planner: usize,
    pub move_time: Duration,
    pub latency: Duration,
    /// Degrees per second.
    pub heat_rate: f64,
    pub faults: Faults,
}

impl Default for SimOptions {
    fn default() -> SimOptions {
        SimOptions {
            seed: 1,
            advanced_ok: false,
            autoreport: false,
            emergency_parser: true,
            busy: true,
            receive_buffer: 127,
            command_queue: 4,
            planner: 16,
            move_time: 20 * MS,
            latency: MS,
            heat_rate: 5.0,
            faults: Faults::default(),
        }
    }
}

/// What a run is meant to end with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fate {
    Finish,
    Reset,
    Hang,
    Error,
    Unplug,
}

pub fn fate(seed: u64) -> Fate {
    match seed % 10 {
        6 => Fate::Reset,
        7 => Fate::Hang,
        8 => Fate::Error,
        9 => Fate::Unplug,
        _ => Fate::Finish,
    }
}

/// A printer with the mixed faults of this seed, in a job of so many moves.
pub fn faulty_printer(seed: u64, moves: usize) -> SimOptions {
    let mut rng = Rng::new(seed ^ 0x5eed);
    let at = 1 + rng.below(moves - 1);
    let fate = fate(seed);
    SimOptions {
        seed,
        advanced_ok: rng.chance(0.3),
        autoreport: rng.chance(0.5),
        emergency_parser: rng.chance(0.5),
        busy: rng.chance(0.7),
        move_time: Duration::from_millis(1 + rng.next() % 60),
        latency: Duration::from_micros(100 + rng.next() % 4000),
        faults: Faults {
            garble_in: 0.01,
            garble_out: 0.01,
            lose_ok: 0.01,
            double_ok: 0.01,
            late_resend: 0.1,
            resend_storm: 0.1,
            no_ok_after_resend: 0.1,
            noise_before_banner: rng.chance(0.5),
            split_reads: rng.chance(0.5),
            reset_after: (fate == Fate::Reset).then_some(at),
            hang_after: (fate == Fate::Hang).then_some(at),
            error_after: (fate == Fate::Error).then_some(at),
        },
        ..SimOptions::default()
    }
}

/// What occupies the printer.
#[derive(Debug, Clone)]
struct Running {
    command: Command,
    until: Duration,
    heating: bool,
    next_sign: Duration,
}

#[derive(Debug, Clone)]
struct Command {
    number: Option<u32>,
    text: String,
}

#[derive(Debug, Clone, Copy)]
struct Heater {
    target: f64,
    start: f64,
    since: Duration,
}

impl Heater {
    fn at(&self, now: Duration, rate: f64) -> f64 {
        let change = rate * now.saturating_sub(self.since).as_secs_f64();
        let goal = self.target.max(20.0);
        if goal > self.start { (self.start + change).min(goal) } else { (self.start - change).max(goal) }
    }

    fn set(&mut self, now: Duration, target: f64, rate: f64) {
        *self = Heater { start: self.at(now, rate), target, since: now };
    }

    fn reached(&self, rate: f64) -> Duration {
        let gap = (self.target.max(20.0) - self.start).abs();
        self.since + Duration::from_secs_f64(gap / rate)
    }
}

#[derive(Debug)]
pub struct SimPrinter {
    options: SimOptions,
    rng: Rng,
    now: Duration,
    arriving: VecDeque<(Duration, Vec<u8>)>,
    receive: VecDeque<u8>,
    queue: VecDeque<Command>,
    running: Option<Running>,
    planner: VecDeque<Duration>,
    leaving: VecDeque<(Duration, Vec<u8>)>,
    later: Vec<(Duration, String)>,
    last_number: u32,
    nozzle: Heater,
    bed: Heater,
    report_every: Option<Duration>,
    next_report: Duration,
    booting_until: Option<Duration>,
    truth: HashMap<u32, String>,
    silent: bool,
    /// Numbered commands taken, in order, without number and checksum.
    pub accepted: Vec<String>,
    /// Commands taken without a number: the printer cannot know whether they are whole.
    pub loose: Vec<String>,
    /// Job moves taken (`G1 X...`).
    pub moves: usize,
    pub was_reset: bool,
    pub halted: bool,
    /// Bytes that found the receive buffer full.
    pub overruns: usize,
    /// The most bytes that waited in the receive buffer.
    pub fullest: usize,
    pub resends: usize,
    /// Waits for heat ended by `M108`.
    pub heat_waits_broken: usize,
}

impl SimPrinter {
    /// A printer that is switched on, or starts when the port opens (`power_on`).
    pub fn new(options: SimOptions) -> SimPrinter {
        let cold = Heater { target: 0.0, start: 20.0, since: Duration::ZERO };
        SimPrinter {
            rng: Rng::new(options.seed),
            options,
            now: Duration::ZERO,
            arriving: VecDeque::new(),
            receive: VecDeque::new(),
            queue: VecDeque::new(),
            running: None,
            planner: VecDeque::new(),
            leaving: VecDeque::new(),
            later: Vec::new(),
            last_number: 0,
            nozzle: cold,
            bed: cold,
            report_every: None,
            next_report: Duration::ZERO,
            booting_until: None,
            truth: HashMap::new(),
            silent: false,
            accepted: Vec::new(),
            moves: 0,
            loose: Vec::new(),
            was_reset: false,
            halted: false,
            overruns: 0,
            fullest: 0,
            resends: 0,
            heat_waits_broken: 0,
        }
    }

    /// The board starts: it forgets everything, and listens after half a second.
    pub fn power_on(&mut self) {
        self.arriving.clear();
        self.receive.clear();
        self.queue.clear();
        self.planner.clear();
        self.later.clear();
        self.running = None;
        self.last_number = 0;
        self.halted = false;
        self.report_every = None;
        let rate = self.options.heat_rate;
        self.nozzle.set(self.now, 0.0, rate);
        self.bed.set(self.now, 0.0, rate);
        self.booting_until = Some(self.now + 500 * MS);
        if self.options.faults.noise_before_banner {
            let noise: Vec<u8> = (0..40).map(|_| self.rng.next() as u8).filter(|b| *b != b'\n').collect();
            self.leaving.push_back((self.now, noise));
            self.leaving.push_back((self.now, b"\n".to_vec()));
        }
        for line in ["start", "PowerUp", "Marlin 2.1.2", "echo: Free Memory: 4096  PlannerBufferBytes: 1232"]
        {
            self.say(line);
        }
    }

    pub fn hang(&mut self) {
        self.silent = true;
    }

    /// Every line the host writes is whole; faults come on the way.
    pub fn write(&mut self, now: Duration, bytes: &[u8]) {
        self.now = self.now.max(now);
        let at = self.now + self.options.latency;
        for line in bytes.split_inclusive(|b| *b == b'\n') {
            self.note_truth(line);
            let mut line = line.to_vec();
            if self.rng.chance(self.options.faults.garble_in) {
                garble(&mut self.rng, &mut line);
            }
            self.arriving.push_back((at, line));
        }
    }

    /// What has come out by now, in one piece.
    pub fn read(&mut self, now: Duration) -> Vec<u8> {
        let mut bytes = Vec::new();
        while self.leaving.front().is_some_and(|(at, _)| *at <= now) {
            if let Some((_, piece)) = self.leaving.pop_front() {
                bytes.extend(piece);
            }
        }
        bytes
    }

    /// When something happens next.
    pub fn next_event(&self) -> Option<Duration> {
        let out = self.leaving.front().map(|(at, _)| *at);
        if self.silent {
            return out;
        }
        let run = self.running.as_ref().map(|r| r.until.min(r.next_sign));
        let report = self.report_every.map(|_| self.next_report);
        let arrival = self.arriving.front().map(|(at, _)| *at);
        let later = self.later.iter().map(|(at, _)| *at).min();
        [out, run, report, arrival, later, self.booting_until].into_iter().flatten().min()
    }

    /// Lives up to `now`.
    pub fn advance(&mut self, now: Duration) {
        while let Some(at) = self.inner_event().filter(|at| *at <= now) {
            self.now = self.now.max(at);
            self.live();
        }
        self.now = self.now.max(now);
    }

    fn inner_event(&self) -> Option<Duration> {
        if self.silent {
            return None;
        }
        let run = self.running.as_ref().map(|r| r.until.min(r.next_sign));
        let report = self.report_every.map(|_| self.next_report);
        let arrival = self.arriving.front().map(|(at, _)| *at);
        let later = self.later.iter().map(|(at, _)| *at).min();
        [run, report, arrival, later, self.booting_until].into_iter().flatten().min()
    }

    fn live(&mut self) {
        let now = self.now;
        if self.booting_until.is_some_and(|at| at <= now) {
            self.booting_until = None;
        }
        self.receive_due();
        self.signs_of_life();
        self.later_due();
        loop {
            self.take_lines();
            if !self.run_one() {
                break;
            }
        }
    }

    fn receive_due(&mut self) {
        while self.arriving.front().is_some_and(|(at, _)| *at <= self.now) {
            let Some((_, bytes)) = self.arriving.pop_front() else { return };
            if self.booting_until.is_some() || self.halted {
                continue;
            }
            for byte in &bytes {
                if self.receive.len() < self.options.receive_buffer {
                    self.receive.push_back(*byte);
                } else {
                    self.overruns += 1;
                }
            }
            self.fullest = self.fullest.max(self.receive.len());
            self.read_past_the_queue(bytes.trim_ascii());
            self.take_lines();
        }
    }

    fn read_past_the_queue(&mut self, line: &[u8]) {
        if !self.options.emergency_parser {
            return;
        }
        match line {
            b"M112" => self.kill(),
            b"M108" => {
                if let Some(running) = self.running.as_mut().filter(|r| r.heating) {
                    running.until = self.now;
                    self.heat_waits_broken += 1;
                }
            }
            _ => {}
        }
    }

    fn kill(&mut self) {
        self.say("Error:Printer halted. kill() called!");
        self.halted = true;
        self.queue.clear();
        self.running = None;
        self.report_every = None;
        self.receive.clear();
    }

    fn signs_of_life(&mut self) {
        let now = self.now;
        if let Some(running) = self.running.as_mut().filter(|r| r.next_sign <= now && r.until > now) {
            running.next_sign = now + Duration::from_secs(if running.heating { 1 } else { 2 });
            if running.heating {
                let report = self.report();
                self.say(&report);
            } else if self.options.busy {
                self.say("echo:busy: processing");
            }
        }
        if let Some(every) = self.report_every.filter(|_| self.next_report <= now) {
            self.next_report = now + every;
            let report = format!(" {}", self.report());
            self.say(&report);
        }
    }

    fn later_due(&mut self) {
        let now = self.now;
        let (due, rest) = std::mem::take(&mut self.later).into_iter().partition(|(at, _)| *at <= now);
        self.later = rest;
        let due: Vec<(Duration, String)> = due;
        for (_, line) in due {
            self.say(&line);
        }
    }

    fn report(&self) -> String {
        let rate = self.options.heat_rate;
        let (nozzle, bed) = (self.nozzle.at(self.now, rate), self.bed.at(self.now, rate));
        format!("T:{nozzle:.1} /{:.1} B:{bed:.1} /{:.1} @:0 B@:0", self.nozzle.target, self.bed.target)
    }

    // ---- lines ----

    fn take_lines(&mut self) {
        while self.queue.len() < self.options.command_queue && !self.halted {
            let Some(end) = self.receive.iter().position(|b| *b == b'\n') else { return };
            let line: Vec<u8> = self.receive.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line).into_owned();
            let line = line.split(';').next().unwrap_or_default().trim();
            if !line.is_empty() {
                self.take(line);
            }
        }
    }

    fn take(&mut self, line: &str) {
        let star = line.rfind('*');
        let Some(rest) = line.strip_prefix('N') else {
            return match star {
                Some(_) => self.refuse("No Line Number with checksum"),
                None => self.accept(None, line),
            };
        };
        let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
        let number: u32 = digits.parse().unwrap_or(0);
        if number != self.last_number.wrapping_add(1) && !line.contains("M110") {
            return self.refuse("Line Number is not Last Line Number+1");
        }
        let Some(star) = star else { return self.refuse("No Checksum with line number") };
        let sum = line.as_bytes()[..star].iter().fold(0, |sum, byte| sum ^ byte);
        let told = line[star + 1..].parse::<u8>().ok();
        let command =
            line[..star].trim_start_matches(['N', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']).trim();
        if told != Some(sum) || !self.is_true(number, command) {
            return self.refuse("checksum mismatch");
        }
        self.last_number = number;
        self.accept(Some(number), command);
    }

    /// XOR lets one in 256 joined lines pass. That is the protocol's limit, not the host's; the simulator
    /// sees what was sent and refuses those too.
    fn is_true(&self, number: u32, command: &str) -> bool {
        self.truth.get(&number).is_none_or(|sent| sent == command)
    }

    fn note_truth(&mut self, line: &[u8]) {
        let text = String::from_utf8_lossy(line);
        let Some((head, _)) = text.trim().rsplit_once('*') else { return };
        let Some((number, command)) = head.strip_prefix('N').and_then(|rest| rest.split_once(' ')) else {
            return;
        };
        if let Ok(number) = number.parse() {
            self.truth.insert(number, command.to_owned());
        }
    }

    fn accept(&mut self, number: Option<u32>, text: &str) {
        if let Some(count) = text.strip_prefix("M110 N") {
            self.last_number = count.parse().unwrap_or(0);
        }
        let taken = if number.is_some() { &mut self.accepted } else { &mut self.loose };
        taken.push(text.to_owned());
        self.queue.push_back(Command { number, text: text.to_owned() });
        if text.starts_with("G1 X") {
            self.moves += 1;
            self.planned_faults();
        }
    }

    fn planned_faults(&mut self) {
        let faults = self.options.faults.clone();
        if faults.reset_after == Some(self.moves) && !self.was_reset {
            self.power_on();
            self.was_reset = true;
        }
        if faults.hang_after == Some(self.moves) {
            self.hang();
        }
        if faults.error_after == Some(self.moves) {
            self.say("Error:Thermal Runaway, system stopped! Heater_ID: 0");
        }
    }

    /// Tells the error, throws away what waits unread, asks for the line after the last good one.
    fn refuse(&mut self, why: &str) {
        self.resends += 1;
        self.receive.clear();
        let last = self.last_number;
        let request = format!("Resend: {}", last.wrapping_add(1));
        self.say(&format!("Error:{why}, Last Line: {last}"));
        self.ask_again(&request);
        if self.rng.chance(self.options.faults.resend_storm) {
            for _ in 0..2 + self.rng.below(8) {
                self.ask_again(&request);
            }
        }
        if self.rng.chance(self.options.faults.late_resend) {
            let at = self.now + Duration::from_millis(20 + self.rng.next() % 500);
            self.later.push((at, request));
            self.later.push((at, "ok".to_owned()));
        }
    }

    fn ask_again(&mut self, request: &str) {
        self.say(request);
        if !self.rng.chance(self.options.faults.no_ok_after_resend) {
            self.say_ok(None);
        }
    }

    // ---- commands ----

    /// Begins or ends a command; false when there is nothing to do now.
    fn run_one(&mut self) -> bool {
        if self.halted || self.booting_until.is_some() {
            return false;
        }
        match self.running.take() {
            Some(running) if running.until > self.now => {
                self.running = Some(running);
                false
            }
            Some(running) => {
                self.done(&running.command);
                true
            }
            None => {
                let Some(command) = self.queue.pop_front() else { return false };
                self.begin(command);
                true
            }
        }
    }

    fn begin(&mut self, command: Command) {
        let now = self.now;
        while self.planner.front().is_some_and(|end| *end <= now) {
            self.planner.pop_front();
        }
        let idle = self.planner.back().copied().unwrap_or(now).max(now);
        let rate = self.options.heat_rate;
        let word = command.text.split(' ').next().unwrap_or_default();
        let heating = matches!(word, "M109" | "M190");
        let until = match word {
            "G0" | "G1" => self.plan_move(idle),
            "G28" | "G29" => idle + Duration::from_secs(8),
            "G4" => idle + Duration::from_secs_f64(value(&command.text, 'S').unwrap_or(0.0)),
            "M400" => idle,
            "M104" | "M109" => {
                self.nozzle.set(now, value(&command.text, 'S').unwrap_or(0.0), rate);
                if heating { self.nozzle.reached(rate) } else { now }
            }
            "M140" | "M190" => {
                self.bed.set(now, value(&command.text, 'S').unwrap_or(0.0), rate);
                if heating { self.bed.reached(rate) } else { now }
            }
            _ => now,
        };
        let next_sign = now + Duration::from_secs(if heating { 1 } else { 2 });
        self.running = Some(Running { command, until, heating, next_sign });
    }

    /// Time when the planner has taken the move: at once, or when it has a free place.
    fn plan_move(&mut self, idle: Duration) -> Duration {
        let free = self.planner.len() < self.options.planner;
        let taken = if free { self.now } else { self.planner.front().copied().unwrap_or(self.now) };
        self.planner.push_back(idle + self.options.move_time);
        taken
    }

    fn done(&mut self, command: &Command) {
        match command.text.split(' ').next().unwrap_or_default() {
            "M105" => {
                let report = format!("ok {}", self.report());
                self.say(&report);
                return;
            }
            "M115" => self.introduce(),
            "M155" => {
                let every = value(&command.text, 'S').filter(|s| *s > 0.0);
                self.report_every = every.map(Duration::from_secs_f64);
                self.next_report = self.now + self.report_every.unwrap_or_default();
            }
            "M112" => return self.kill(),
            "M999" => self.say("echo:Unknown command: \"M999\""),
            _ => {}
        }
        self.say_ok(command.number);
    }

    fn introduce(&mut self) {
        self.say("FIRMWARE_NAME:Marlin 2.1.2 (simulated) SOURCE_CODE_URL:none PROTOCOL_VERSION:1.0 MACHINE_TYPE:Sim One EXTRUDER_COUNT:1");
        let report = format!("Cap:AUTOREPORT_TEMP:{}", u8::from(self.options.autoreport));
        let parser = format!("Cap:EMERGENCY_PARSER:{}", u8::from(self.options.emergency_parser));
        self.say(&report);
        self.say(&parser);
    }

    // ---- words ----

    fn say_ok(&mut self, number: Option<u32>) {
        if self.rng.chance(self.options.faults.lose_ok) {
            return;
        }
        let mut text = "ok".to_owned();
        if self.options.advanced_ok {
            if let Some(number) = number {
                text += &format!(" N{number}");
            }
            let planner = self.options.planner.saturating_sub(self.planner.len());
            let block = self.options.command_queue - self.queue.len().min(self.options.command_queue - 1) - 1;
            text += &format!(" P{planner} B{block}");
        }
        self.say(&text);
        if self.rng.chance(self.options.faults.double_ok) {
            self.say(&text);
        }
    }

    /// Puts a line on the way to the host, with faults.
    pub fn say(&mut self, line: &str) {
        if self.silent {
            return;
        }
        let mut bytes = format!("{line}\n").into_bytes();
        if self.rng.chance(self.options.faults.garble_out) {
            garble(&mut self.rng, &mut bytes);
        }
        let mut at =
            self.leaving.back().map_or(Duration::ZERO, |(at, _)| *at).max(self.now + self.options.latency);
        if !self.options.faults.split_reads {
            self.leaving.push_back((at, bytes));
            return;
        }
        while !bytes.is_empty() {
            let cut = 1 + self.rng.below(bytes.len());
            let rest = bytes.split_off(cut);
            self.leaving.push_back((at, std::mem::replace(&mut bytes, rest)));
            at += Duration::from_micros(self.rng.next() % 3000);
        }
    }
}

/// One byte changed, lost or added, the line feed not spared.
fn garble(rng: &mut Rng, line: &mut Vec<u8>) {
    if line.is_empty() {
        return;
    }
    let at = rng.below(line.len());
    let byte = rng.next() as u8;
    match rng.below(6) {
        0 => drop(line.remove(at)),
        1 => line.insert(at, byte),
        _ => line[at] ^= byte.max(1),
    }
}

fn value(text: &str, letter: char) -> Option<f64> {
    text.split(' ').find_map(|word| word.strip_prefix(letter)?.parse().ok())
}
