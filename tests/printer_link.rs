//! The serial link against a simulated printer that delays, garbles, resets and asks for resends.

#[path = "common/printer_sim.rs"]
mod printer_sim;
#[allow(dead_code, unreachable_pub, reason = "an example has more than the tests need")]
#[path = "../examples/replay_serial.rs"]
mod replay_serial;

use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;

use foothold::printer::{Event, JobStart, Journal, Printer, PrinterOptions, State, StopReason};
use proptest::prelude::*;

use printer_sim::{Fate, Faults, Rng, SimOptions, SimPrinter, fate, faulty_printer};

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

/// One run with mixed faults; the complaint, if anything is wrong.
fn mixed_run(seed: u64) -> Result<(), String> {
    const MOVES: usize = 300;
    let job = job(MOVES);
    let mut rig = Rig::new(PrinterOptions::default(), faulty_printer(seed, MOVES));
    if seed.is_multiple_of(3) {
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

#[test]
fn the_emergency_stop_overtakes_lines_that_were_not_written_yet() {
    let mut printer = Printer::new(PrinterOptions::default()).expect("usable");
    let now = secs(1);
    printer.connect(now).expect("offline");
    for text in ["ok\n", "ok\n", "ok T:20 /0\n"] {
        while printer.poll_transmit().is_some() {}
        printer.handle_bytes(now, text.as_bytes());
    }
    printer.start(now, JobStart::new(Box::new(job(9).into_iter().map(String::into_bytes)))).expect("ready");
    for _ in 0..20 {
        printer.send_line(now, "M108").expect("printing");
    }
    printer.emergency_stop(now).expect("printing");
    assert_eq!(printer.poll_transmit().as_deref(), Some(b"\nM112\n".as_slice()));
    assert_eq!(printer.poll_transmit(), None, "nothing follows it");
}

#[test]
fn the_emergency_stop_reaches_a_printer_that_heats() {
    let mut rig = Rig::ready(PrinterOptions::default(), SimOptions::default());
    rig.start(&job(50));
    rig.run_until(secs(11), |_| false);
    assert_eq!(rig.sim.accepted.last().map(String::as_str), Some("M190 S60"), "it heats");
    rig.printer.emergency_stop(rig.now).expect("printing");
    rig.run_until(secs(1), |_| false);
    assert!(rig.sim.halted);
    assert_eq!(rig.writes.last().map(String::as_str), Some("\nM112\n"));
    assert_eq!(rig.printer.state(), State::Halted);
}

#[test]
fn a_pause_while_a_line_is_sent_again_loses_nothing() {
    for seed in 0..20 {
        let faults = Faults { garble_in: 0.2, ..Faults::default() };
        let job = job(120);
        let mut rig =
            Rig::ready(PrinterOptions::default(), SimOptions { seed, faults, ..SimOptions::default() });
        rig.start(&job);
        let resends = rig.sim.resends;
        assert!(rig.run_until(secs(3600), |rig| rig.sim.moves > 30 && rig.sim.resends > resends + 5));
        rig.run_until(secs(3600), |rig| rig.printer.statistics().resends >= 5);
        rig.printer.pause(rig.now).expect("printing");
        assert!(rig.run_until(secs(3600), |rig| rig.printer.state() == State::Paused));
        rig.run_until(secs(300), |_| false);
        rig.printer.resume(rig.now).expect("paused");
        assert!(rig.run_until(secs(3600), Rig::over), "seed {seed}");
        let own = PrinterOptions::default().park_lines;
        let printed = rig.printed();
        let park = printed.windows(own.len()).position(|w| w == own).expect("parked");
        let back = printed.iter().rposition(|line| line.starts_with("G92 E")).expect("returned");
        let rest = printed[back..].iter().position(|line| line == "M83").expect("modes") + back + 1;
        let without: Vec<String> = printed[..park].iter().chain(&printed[rest..]).cloned().collect();
        assert_eq!(without, commands(&job), "seed {seed}");
    }
}

#[test]
fn a_cancel_while_heating_does_not_wait_for_the_heat() {
    let mut rig =
        Rig::ready(PrinterOptions::default(), SimOptions { heat_rate: 0.1, ..SimOptions::default() });
    rig.start(&job(50));
    rig.run_until(secs(30), |_| false);
    assert_eq!(rig.sim.accepted.last().map(String::as_str), Some("M190 S60"), "it heats");
    rig.printer.cancel(rig.now).expect("printing");
    assert!(rig.run_until(secs(5), |rig| rig.printer.state() == State::Ready));
    assert_eq!(rig.sim.heat_waits_broken, 1);
    let cool = PrinterOptions::default().cancel_lines;
    assert_eq!(&rig.sim.accepted[rig.sim.accepted.len() - cool.len()..], cool.as_slice());
    assert_eq!(rig.stopped().map(|(reason, _)| reason), Some(&StopReason::Cancelled));
}

#[test]
fn after_an_unplug_during_a_resend_the_job_goes_on_where_it_stood() {
    for seed in 0..20 {
        let faults = Faults { garble_in: 0.1, ..Faults::default() };
        let job = job(150);
        let mut rig =
            Rig::ready(PrinterOptions::default(), SimOptions { seed, faults, ..SimOptions::default() });
        rig.start(&job);
        let resends = rig.sim.resends;
        assert!(rig.run_until(secs(3600), |rig| rig.sim.resends > resends + 8));
        rig.printer.handle_closed(rig.now);
        rig.exchange();
        let (reason, journal) = rig.stopped().expect("unplugged");
        assert_eq!(reason, &StopReason::PortClosed);
        let acked = journal.and_then(|j| j.acked_line).expect("some lines were printed");
        rig.events.clear();
        rig.printer.connect(rig.now).expect("offline");
        assert!(rig.run_until(secs(60), |rig| rig.printer.state() == State::Ready));
        let lines = Box::new(job.clone().into_iter().map(String::into_bytes));
        let start = JobStart { first_line: acked + 1, ..JobStart::new(lines) };
        rig.printer.start(rig.now, start).expect("ready");
        assert!(rig.run_until(secs(3600), Rig::over));
        assert!(rig.finished(), "seed {seed}");
        // The line in flight when the cable was pulled may have arrived: then it comes twice in a row.
        let mut printed = rig.printed();
        printed.dedup();
        assert_eq!(printed, commands(&job), "seed {seed}");
    }
}

#[test]
fn long_lines_never_overflow_the_receive_buffer() {
    let mut rng = Rng::new(7);
    let lines = |rng: &mut Rng| "0".repeat(rng.below(60));
    let job: Vec<String> = (0..500).map(|i| format!("G1 X{i}.{}", lines(&mut rng))).collect();
    let sim = SimOptions { advanced_ok: true, move_time: Duration::from_millis(80), ..SimOptions::default() };
    let mut rig = Rig::ready(PrinterOptions::default(), sim);
    rig.start(&job);
    let most = Cell::new(0);
    assert!(rig.run_until(secs(3600), |rig| {
        most.set(most.get().max(rig.printer.statistics().in_flight));
        rig.over()
    }));
    assert_eq!(rig.printed(), job);
    assert_eq!(rig.sim.overruns, 0);
    assert_eq!(most.get(), 3, "as many lines in flight as the queue has places");
}

/// Answers every line at once; the most lines ever held.
fn print_at_once(moves: u64) -> usize {
    let pulled = Rc::new(Cell::new(0));
    let mut printer = Printer::new(PrinterOptions::default()).expect("usable");
    let counter = Rc::clone(&pulled);
    let lines = (0..moves).map(move |i| {
        counter.set(i + 1);
        format!("G1 X{i}").into_bytes()
    });
    let mut start = Some(JobStart::new(Box::new(lines)));
    printer.connect(Duration::ZERO).expect("offline");
    let (mut now, mut most) = (Duration::ZERO, 0);
    loop {
        now += Duration::from_millis(1);
        match printer.poll_transmit() {
            Some(bytes) if bytes.windows(5).any(|w| w == b" M105") => {
                printer.handle_bytes(now, b"ok T:20 /0\n");
            }
            Some(_) => printer.handle_bytes(now, b"ok\n"),
            None => printer.handle_timeout(now),
        }
        most = most.max(printer.statistics().held_lines);
        let acked = printer.journal().acked_line.map_or(0, |line| line + 1);
        assert!(pulled.get() <= acked + 2, "{} pulled, {acked} acknowledged", pulled.get());
        while let Some(event) = printer.poll_event() {
            match event {
                Event::Finished(journal) => {
                    assert_eq!(journal.acked_line, Some(moves - 1));
                    return most;
                }
                Event::Stopped { reason, .. } => panic!("{reason}"),
                _ => {}
            }
        }
        if printer.state() == State::Ready {
            start.take().into_iter().for_each(|start| printer.start(now, start).expect("ready"));
        }
    }
}

#[test]
fn a_long_job_takes_no_more_memory_than_a_short_one() {
    let long = if long_runs() { 2_000_000 } else { 100_000 };
    let held = print_at_once(long);
    assert!(held <= 140, "{held} lines held");
    assert_eq!(held, print_at_once(1_000));
}

#[test]
fn a_command_in_the_wrong_state_sends_nothing_and_changes_nothing() {
    let mut printer = Printer::new(PrinterOptions::default()).expect("usable");
    let now = secs(1);
    let start = || JobStart::new(Box::new(std::iter::empty()));
    for _ in 0..2 {
        let state = printer.state();
        assert!(printer.pause(now).is_err() && printer.resume(now).is_err() && printer.cancel(now).is_err());
        assert!(printer.start(now, start()).is_err());
        assert!(printer.send_line(now, "G28").is_err() && printer.set_speed(now, 100).is_err());
        assert_eq!(printer.state(), state);
        assert_eq!((printer.poll_transmit(), printer.poll_event()), (None, None));
        printer.connect(now).expect("offline");
        while printer.poll_transmit().is_some() || printer.poll_event().is_some() {}
    }
    assert!(
        Printer::new(PrinterOptions { park_lines: vec!["G1\nG2".to_owned()], ..Default::default() }).is_err()
    );
}

#[test]
fn events_that_nobody_reads_do_not_pile_up() {
    let mut rig = Rig::ready(PrinterOptions::default(), SimOptions::default());
    for _ in 0..100_000 {
        rig.printer.handle_bytes(rig.now, b"echo: chatter\n");
    }
    let count = std::iter::from_fn(|| rig.printer.poll_event()).count();
    assert!((1..=1024).contains(&count), "{count}");
}

/// Words of the protocol and noise.
fn chatter() -> impl Strategy<Value = Vec<u8>> {
    let words = proptest::sample::select(vec![
        "ok\n",
        "ok N3 P1 B2\n",
        "ok T:1 /2\n",
        "Resend: 1\n",
        "Resend: 7\n",
        "rs 99999999999\n",
        "start\n",
        "wait\n",
        "Error:checksum mismatch, Last Line: 4294967295\n",
        "Error:x, Last Line: 0\n",
        "busy:\n",
        "Error:boom\n",
        "!!\n",
        "//action:pause\n",
        "//action:paused\n",
        "//action:resume\n",
        "//action:cancel\n",
        "FIRMWARE_NAME:\n",
        "Cap:AUTOREPORT_TEMP:1\n",
        "T:nan /inf T0:1 T7:2 B:\n",
        "Resend: 4294967295\n",
        "ok 4294967295\n",
        "ok B4294967295\n",
    ]);
    prop_oneof![
        4 => words.prop_map(|word| word.as_bytes().to_vec()),
        1 => proptest::collection::vec(any::<u8>(), 0..2000),
    ]
}

proptest! {
    /// Whatever comes in and whatever is asked: no panic, nothing piles up, time goes on.
    #[test]
    fn noise_never_panics_and_never_piles_up(
        steps in proptest::collection::vec((chatter(), 0u8..24, 0u64..40_000), 1..120),
    ) {
        let mut printer = Printer::new(PrinterOptions::default()).expect("usable");
        let mut now = Duration::ZERO;
        for (bytes, command, wait) in steps {
            now += Duration::from_millis(wait);
            let start = || JobStart::new(Box::new(job(300).into_iter().map(String::into_bytes)));
            let _ = match command {
                0 | 1 => printer.connect(now),
                2 | 3 => printer.start(now, start()),
                4 => printer.pause(now),
                5 => printer.resume(now),
                6 => printer.cancel(now),
                7 => printer.send_line(now, "M105"),
                8 => printer.send_line(now, "M108"),
                9 => printer.emergency_stop(now),
                _ => Ok(()),
            };
            printer.handle_bytes(now, &bytes);
            printer.handle_timeout(now);
            let written: usize = std::iter::from_fn(|| printer.poll_transmit()).map(|bytes| bytes.len()).sum();
            prop_assert!(written < 20_000, "{written} bytes at once");
            prop_assert!(printer.statistics().held_lines < 600);
            let events = std::iter::from_fn(|| printer.poll_event()).count();
            prop_assert!(events < 2_500, "{events} events at once");
        }
    }

    /// Reads may be split anywhere.
    #[test]
    fn split_reads_mean_the_same(cuts in proptest::collection::vec(1usize..30, 1..40)) {
        let text = b"ok\nFIRMWARE_NAME:M\nok\nok T:20 /0\nResend: 3\r\nok\nT:1 /2\nok N3 P1 B1\n";
        let run = |pieces: Vec<&[u8]>| {
            let mut printer = Printer::new(PrinterOptions::default()).expect("usable");
            printer.connect(Duration::ZERO).expect("offline");
            pieces.iter().for_each(|piece| printer.handle_bytes(Duration::ZERO, piece));
            let sent: Vec<Vec<u8>> = std::iter::from_fn(|| printer.poll_transmit()).collect();
            let events: Vec<Event> = std::iter::from_fn(|| printer.poll_event()).collect();
            (sent, events)
        };
        let (mut pieces, mut rest) = (Vec::new(), text.as_slice());
        for cut in cuts {
            let (piece, after) = rest.split_at(cut.min(rest.len()));
            pieces.push(piece);
            rest = after;
        }
        pieces.push(rest);
        prop_assert_eq!(run(pieces), run(vec![text.as_slice()]));
    }
}

/// One test a transcript in `tests/fixtures/serial`, with its name.
macro_rules! transcripts {
    ($($name:ident),* $(,)?) => {
        mod transcript {
            $(
                #[test]
                fn $name() {
                    let text = include_str!(concat!("fixtures/serial/", stringify!($name), ".txt"));
                    if let Err(why) = super::replay_serial::replay(text) {
                        panic!("{}: {why}", stringify!($name));
                    }
                }
            )*
        }
        const TRANSCRIPTS: &[&str] = &[$(stringify!($name)),*];
    };
}

transcripts! {
    actions,
    advanced_ok,
    another_firmware,
    autoreport,
    board_reset,
    board_reset_by_count,
    board_reset_when_ready,
    busy,
    cancel_during_heating,
    cancel_during_resend,
    console,
    emergency_stop,
    emergency_stop_after_lost,
    emergency_stop_in_the_file,
    error_when_ready,
    finish,
    finish_with_ok_doubled,
    go_on_at_a_line,
    handshake,
    heating,
    jump_the_queue,
    line_lost,
    line_too_long,
    lines_that_are_not_commands,
    long_command,
    no_greeting,
    no_temperature_in_ok,
    not_ascii,
    numbering_lost,
    ok_doubled,
    ok_lost,
    pause,
    pause_before_the_first_move,
    pause_during_resend,
    pause_in_the_file,
    polling,
    printer_error,
    printer_gives_up,
    resend,
    resend_again_after_silence,
    resend_hundred_kept,
    resend_late,
    resend_not_kept,
    resend_number_garbled,
    resend_one_in_flight,
    resend_repeated,
    resend_without_ok,
    silence,
    transmission_errors,
    unknown_command,
    unplug,
    unplug_during_resend,
    wait,
}

#[test]
fn a_line_that_never_arrives_whole_ends_the_job_after_25_times() {
    let mut text = "job G1 X1\n! print\n> N2 G1 X1\n".to_owned();
    text += "< Resend: 2\n< ok\n> N2 G1 X1\n";
    for _ in 1..25 {
        text += "< Resend: 2\n+ 0.5\n> N2 G1 X1\n";
    }
    let end = "< Resend: 2\n+ 0.5\n? Line 2 was sent 25 times\n= halted\n> M104 S0\n> M140 S0\n";
    replay_serial::replay(&(text + end)).expect("holds");
}

#[test]
fn a_transcript_that_does_not_hold_is_refused() {
    for wrong in
        ["> N0 M110 N0", "! connect", "! connect\n> N0 M110 N1", "! ready\n= printing", "! ready\n? x"]
    {
        assert!(replay_serial::replay(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn every_transcript_is_a_test() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/serial");
    for file in std::fs::read_dir(folder).expect("fixtures").flatten() {
        let name = file.path().file_stem().expect("a name").to_string_lossy().into_owned();
        assert!(TRANSCRIPTS.contains(&name.as_str()), "{name}.txt is in no test");
    }
}
