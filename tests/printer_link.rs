//! The serial link against a simulated printer that delays, garbles, resets and asks for resends.

#[path = "common/printer_sim.rs"]
mod printer_sim;

use std::time::Duration;

use foothold::printer::{Event, JobStart, Journal, Printer, PrinterOptions, State, StopReason};
use printer_sim::{Faults, Rng, SimOptions, SimPrinter};

const fn secs(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

/// Host and printer joined by a cable, in simulated time.
struct Rig {
    printer: Printer,
    sim: SimPrinter,
    now: Duration,
    events: Vec<Event>,
    /// What the host wrote, one entry a write.
    writes: Vec<String>,
}

impl Rig {
    fn new(options: PrinterOptions, sim: SimOptions) -> Rig {
        Rig {
            printer: Printer::new(options).expect("usable options"),
            sim: SimPrinter::new(sim),
            now: Duration::ZERO,
            events: Vec::new(),
            writes: Vec::new(),
        }
    }

    /// Connected to a printer that is on.
    fn ready(options: PrinterOptions, sim: SimOptions) -> Rig {
        let mut rig = Rig::new(options, sim);
        rig.printer.connect(rig.now).expect("offline");
        rig.run_until(secs(60), |rig| rig.printer.state() == State::Ready);
        assert_eq!(rig.printer.state(), State::Ready, "{:?}", rig.events);
        rig
    }

    fn start(&mut self, job: &[String]) {
        let job: Vec<String> = job.to_vec();
        let lines = Box::new(job.into_iter().map(String::into_bytes));
        self.printer.start(self.now, JobStart::new(lines)).expect("ready");
    }

    /// Runs until the condition holds or `limit` of simulated time has passed; false on the latter.
    fn run_until(&mut self, limit: Duration, done: impl Fn(&Rig) -> bool) -> bool {
        let end = self.now + limit;
        let mut turns_without_time = 0;
        loop {
            self.exchange();
            if done(self) {
                return true;
            }
            let next = [self.printer.poll_timeout(), self.sim.next_event()].into_iter().flatten().min();
            let Some(next) = next.filter(|next| *next <= end) else {
                self.now = end;
                return done(self);
            };
            turns_without_time = if next > self.now { 0 } else { turns_without_time + 1 };
            assert!(turns_without_time < 10_000, "time stands still at {:?}", self.now);
            self.now = self.now.max(next);
            self.turn();
        }
    }

    /// One moment: the printer lives, its bytes come in, then the timeout if it is due.
    fn turn(&mut self) {
        self.sim.advance(self.now);
        let bytes = self.sim.read(self.now);
        if !bytes.is_empty() {
            self.printer.handle_bytes(self.now, &bytes);
        }
        if self.printer.poll_timeout().is_some_and(|at| at <= self.now) {
            self.printer.handle_timeout(self.now);
        }
    }

    fn exchange(&mut self) {
        while let Some(bytes) = self.printer.poll_transmit() {
            self.writes.push(String::from_utf8_lossy(&bytes).into_owned());
            self.sim.write(self.now, &bytes);
        }
        while let Some(event) = self.printer.poll_event() {
            self.events.push(event);
        }
    }

    fn stopped(&self) -> Option<(&StopReason, Option<Journal>)> {
        self.events.iter().find_map(|event| match event {
            Event::Stopped { reason, journal } => Some((reason, *journal)),
            _ => None,
        })
    }

    fn finished(&self) -> bool {
        self.events.iter().any(|event| matches!(event, Event::Finished(_)))
    }

    fn over(&self) -> bool {
        self.finished() || self.stopped().is_some()
    }

    /// What the printer took of the job: everything but the link's own lines.
    fn printed(&self) -> Vec<String> {
        let own = ["M110", "M105", "M115", "M155", "M104 S0", "M140 S0"];
        self.sim
            .accepted
            .iter()
            .filter(|line| !own.iter().any(|head| line.starts_with(head)))
            .cloned()
            .collect()
    }
}

/// Home, heat, then moves that are all different.
fn job(moves: usize) -> Vec<String> {
    let head = ["; a job", "G28", "M190 S60", "M109 S200 ; hot", "", "M83"].map(str::to_owned);
    let moves = (0..moves).flat_map(|i| {
        let layer = (i % 50 == 0).then(|| ";LAYER_CHANGE".to_owned());
        layer.into_iter().chain([format!("G1 X{i} Y{} E0.0{} ; {i}", i % 97, 1 + i % 8)])
    });
    head.into_iter().chain(moves).collect()
}

/// The job as a printer should see it.
fn commands(job: &[String]) -> Vec<String> {
    let lines = job.iter().map(|line| line.split(';').next().unwrap_or_default().trim().to_owned());
    lines.filter(|line| !line.is_empty()).collect()
}

fn long_runs() -> bool {
    std::env::var_os("FOOTHOLD_LONG").is_some_and(|value| value == "1")
}

/// What a run is meant to end with.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fate {
    Finish,
    Reset,
    Hang,
    Error,
    Unplug,
}

fn fate(seed: u64) -> Fate {
    match seed % 10 {
        6 => Fate::Reset,
        7 => Fate::Hang,
        8 => Fate::Error,
        9 => Fate::Unplug,
        _ => Fate::Finish,
    }
}

fn faulty_printer(seed: u64, moves: usize) -> SimOptions {
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

/// One run with mixed faults; the complaint, if anything is wrong.
fn mixed_run(seed: u64) -> Result<(), String> {
    const MOVES: usize = 300;
    let job = job(MOVES);
    let mut rig = Rig::new(PrinterOptions::default(), faulty_printer(seed, MOVES));
    if seed % 3 == 0 {
        rig.sim.power_on();
    }
    rig.printer.connect(rig.now).expect("offline");
    if !rig.run_until(secs(120), |rig| rig.printer.state() == State::Ready) {
        return Err(format!("never connected: {:?}", rig.events));
    }
    rig.start(&job);
    let unplug_at = Rng::new(seed).below(MOVES);
    if fate(seed) == Fate::Unplug {
        rig.run_until(secs(7200), |rig| rig.sim.moves > unplug_at || rig.over());
        rig.printer.handle_closed(rig.now);
    }
    if !rig.run_until(secs(4 * 3600), Rig::over) {
        return Err(format!("hangs in {:?}; {:?}", rig.printer.state(), rig.printer.statistics()));
    }
    judge(seed, &rig, &commands(&job))
}

fn judge(seed: u64, rig: &Rig, commands: &[String]) -> Result<(), String> {
    let printed = rig.printed();
    if commands.get(..printed.len()) != Some(printed.as_slice()) {
        let at = commands.iter().zip(&printed).position(|(a, b)| a != b).unwrap_or(commands.len());
        return Err(format!("differs at {at}: {:?} for {:?}", printed.get(at), commands.get(at)));
    }
    let right = match (fate(seed), rig.stopped().map(|(reason, _)| reason)) {
        (Fate::Finish, None) => printed.len() == commands.len(),
        (Fate::Reset, Some(StopReason::BoardReset)) => rig.sim.was_reset,
        (Fate::Hang, Some(StopReason::NoAnswer)) => true,
        // A garbled error line is no error line; then the job may also be printed whole.
        (Fate::Error, Some(StopReason::PrinterError { .. })) => true,
        (Fate::Error, None) => printed.len() == commands.len(),
        (Fate::Unplug, Some(StopReason::PortClosed)) => true,
        _ => false,
    };
    if right { Ok(()) } else { Err(format!("{:?} ended with {:?}", fate(seed), rig.stopped())) }
}

#[test]
fn mixed_faults_never_change_the_job_and_never_hang() {
    let seeds: Vec<u64> = if long_runs() {
        (0..500).collect()
    } else {
        (0..500).step_by(10).map(|s| s + s / 10 % 10).collect()
    };
    let failures: Vec<String> = seeds
        .iter()
        .filter_map(|seed| mixed_run(*seed).err().map(|complaint| format!("seed {seed}: {complaint}")))
        .collect();
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), seeds.len(), failures.join("\n"));
}

#[test]
fn a_printer_without_faults_gets_the_job_and_its_buffer_never_overflows() {
    for advanced_ok in [false, true] {
        let job = job(400);
        let sim = SimOptions { advanced_ok, move_time: Duration::from_millis(60), ..SimOptions::default() };
        let mut rig = Rig::ready(PrinterOptions::default(), sim);
        rig.start(&job);
        assert!(rig.run_until(secs(3600), Rig::over));
        assert_eq!(rig.printed(), commands(&job));
        assert!(rig.finished());
        assert_eq!((rig.sim.overruns, rig.sim.resends), (0, 0));
    }
}
