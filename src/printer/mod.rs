//! The serial protocol of Marlin and its relatives, without any I/O.
//!
//! Bytes and time go in, bytes, events and the next deadline come out; see [`Printer`]. The protocol as
//! a table with transcripts: `docs/serial.md`. Sources: the RepRap wiki, "G-code" (checking, replies,
//! action commands), Marlin's documentation of `M105`, `M110`, `M112`, `M115`, `M155` and of the
//! host's side, OctoPrint's documentation of what its host does.

mod event;
mod job;
mod line;
mod link;
mod options;
mod outline;
mod position;
mod queue;
mod reply;
mod state;
mod text;
mod timers;

use std::collections::VecDeque;
use std::time::Duration;

pub use event::{Event, Firmware, Journal, Statistics};
pub use job::{JobLines, JobStart};
pub use line::LineFault;
pub use options::PrinterOptions;
pub use outline::{Heat, LayerStart, MacroLine, Outline, TimeMark};
pub use position::Position;
pub use reply::{Reading, Temperatures};
pub use state::{CommandError, Input, PauseReason, State, StopReason, TABLE};
pub use text::lines_of;

use job::Job;
use line::{Framer, code, room_for_command, sendable, strip, waits_for_heat};
use queue::SendQueue;
use timers::Timers;

/// Own lines that may wait at most.
const MAX_WAITING: usize = 256;

/// Events kept at most before messages are left out; state changes are always kept.
const MAX_EVENTS: usize = 1024;

/// Where the head goes when a job begins in the middle.
const RESTORE_LINES: [&str; 3] = ["G90", "G1 X{x} Y{y} F6000", "G1 Z{z} F600"];

/// The host's side of a serial link to a 3D printer.
///
/// # Contract
///
/// The owner has the port and the clock. It calls
///
/// - [`Printer::handle_bytes`] with what came in, in any pieces,
/// - [`Printer::handle_timeout`] when the time of [`Printer::poll_timeout`] has come (earlier or
///   more often does no harm),
/// - commands, when the user wants something,
///
/// and after each of these polls until empty:
///
/// - [`Printer::poll_transmit`]: write the bytes to the port, whole and in order,
/// - [`Printer::poll_event`]: show it,
/// - [`Printer::poll_timeout`]: set one timer, in place of the last.
///
/// `now` is the time since any fixed moment, from a clock that does not go back (in a page:
/// `performance.now()`); an earlier time than the last one is taken as the last one. Bytes that arrived
/// before a deadline should be handed in before the timeout: late timeouts do no harm, silence that
/// was none does.
///
/// The owner opens the port, calls [`Printer::connect`] and waits for [`Event::Connected`]. When the
/// port closes for any reason it calls [`Printer::handle_closed`]. After [`Event::Stopped`] in state
/// [`State::Offline`] it closes the port; in state [`State::Halted`] it may call `connect` again.
///
/// Commands that the state does not allow return a [`CommandError`] and change nothing: that is the
/// owner's mistake. What the printer does wrong is an [`Event::Stopped`] with a [`StopReason`].
///
/// Memory does not grow with the job: its lines are pulled one by one, some 130 are kept for resends.
///
/// ```
/// use std::time::Duration;
/// use foothold::printer::{Printer, PrinterOptions};
///
/// let mut printer = Printer::new(PrinterOptions::default()).expect("the default scripts are fine");
/// printer.connect(Duration::ZERO).expect("not connected yet");
/// let mut wire = Vec::new();
/// while let Some(bytes) = printer.poll_transmit() {
///     wire.extend(bytes);
/// }
/// assert_eq!(wire, b"\nN0 M110 N0*125\n");
/// ```
#[derive(Debug)]
pub struct Printer {
    options: PrinterOptions,
    state: State,
    now: Duration,
    framer: Framer,
    queue: SendQueue,
    /// Ours, to go out before the job's next line.
    waiting: VecDeque<Waiting>,
    job: Option<Job>,
    /// Journal where the queue holds no line of the job: at its begin and after its end.
    journal: Journal,
    /// The numbering of the job has begun, so that marks in the queue are this job's.
    numbered: bool,
    parked: bool,
    /// Told when the cool-down is done.
    ending: StopReason,
    proof: Proof,
    greeting: Greeting,
    firmware: Firmware,
    /// Lines in flight, as the printer allows.
    window_lines: u32,
    timers: Timers,
    out: VecDeque<Vec<u8>>,
    events: VecDeque<Event>,
    statistics: Statistics,
}

/// A line of ours that has no number yet.
#[derive(Debug, Clone, PartialEq)]
enum Waiting {
    /// Count from 0 again, once everything is acknowledged.
    Renumber,
    /// Nothing behind goes out before the printer has shown that it counts anew.
    Proof,
    Line(String),
}

/// An `M105` whose answer proves that the printer has all lines before it.
#[derive(Debug, Default)]
struct Proof {
    /// Number of the `M105` sent.
    number: Option<u32>,
    tries: u32,
    /// Nothing proves it, and nothing speaks against it either.
    believed: bool,
}

#[derive(Debug, Default)]
struct Greeting {
    /// Number of `M115`.
    number: Option<u32>,
    tries: u32,
    board_started: bool,
}

impl Printer {
    /// A link that is not connected.
    ///
    /// # Errors
    ///
    /// A script line of the options that cannot be sent.
    pub fn new(options: PrinterOptions) -> Result<Printer, CommandError> {
        let scripts =
            [&options.park_lines, &options.return_lines, &options.cancel_lines, &options.fault_lines];
        for line in scripts.into_iter().flatten() {
            own_command(line, options.max_line)?;
        }
        let queue = SendQueue::new(options.keep_lines.max(100));
        Ok(Printer {
            options,
            state: State::Offline,
            now: Duration::ZERO,
            framer: Framer::default(),
            queue,
            waiting: VecDeque::new(),
            job: None,
            journal: Journal::default(),
            numbered: false,
            parked: false,
            ending: StopReason::Cancelled,
            proof: Proof::default(),
            greeting: Greeting::default(),
            firmware: Firmware::default(),
            window_lines: 1,
            timers: Timers::default(),
            out: VecDeque::new(),
            events: VecDeque::new(),
            statistics: Statistics::default(),
        })
    }

    // ---- what comes in ----

    /// Takes bytes from the port.
    pub fn handle_bytes(&mut self, now: Duration, bytes: &[u8]) {
        self.advance(now);
        for byte in bytes {
            if let Some(line) = self.framer.push(*byte) {
                self.on_line(line);
                self.pump();
            }
        }
    }

    /// Does what is due.
    pub fn handle_timeout(&mut self, now: Duration) {
        self.advance(now);
        self.on_timers();
        self.pump();
    }

    /// The port is closed or gone. A job stands at its last acknowledged line.
    pub fn handle_closed(&mut self, now: Duration) {
        self.advance(now);
        self.stop(Input::Closed, StopReason::PortClosed);
    }

    // ---- what goes out ----

    /// The next bytes to write, whole lines.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// The next thing to tell.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    // ---- commands ----

    /// Begins the handshake: `M110 N0`, `M115`. The port has just been opened, or the printer halted.
    ///
    /// # Errors
    ///
    /// While a job runs.
    pub fn connect(&mut self, now: Duration) -> Result<(), CommandError> {
        self.advance(now);
        self.command(Input::Connect)?;
        self.framer.clear();
        self.firmware = Firmware::default();
        self.greeting = Greeting::default();
        self.statistics = Statistics::default();
        self.begin_handshake();
        self.pump();
        Ok(())
    }

    /// Prints a job.
    ///
    /// # Errors
    ///
    /// Unless the printer is ready; a prelude line that cannot be sent.
    pub fn start(&mut self, now: Duration, start: JobStart) -> Result<(), CommandError> {
        self.advance(now);
        self.allowed(Input::Start)?;
        let prelude = start.prelude.iter().map(|line| own_command(line, self.options.max_line));
        let prelude = prelude.collect::<Result<Vec<String>, CommandError>>()?;
        self.command(Input::Start)?;
        let job = Job::new(start.lines, start.first_line);
        self.journal = job.journal_before(start.first_line);
        self.numbered = false;
        self.parked = false;
        self.waiting.extend([Waiting::Renumber, Waiting::Proof]);
        self.wait_with(prelude);
        if start.restore {
            let lines = RESTORE_LINES.map(str::to_owned);
            self.wait_with(job.position.way_back(&lines));
        }
        self.job = Some(job);
        self.pump();
        Ok(())
    }

    /// Pauses the job and parks the head. Before the first move of the job the head stays where it is.
    ///
    /// # Errors
    ///
    /// Unless a job prints.
    pub fn pause(&mut self, now: Duration) -> Result<(), CommandError> {
        self.advance(now);
        self.allowed(Input::Pause)?;
        self.pause_for(Input::Pause, PauseReason::User);
        self.pump();
        Ok(())
    }

    /// Returns to the part and goes on.
    ///
    /// # Errors
    ///
    /// Unless the job waits.
    pub fn resume(&mut self, now: Duration) -> Result<(), CommandError> {
        self.advance(now);
        self.allowed(Input::Resume)?;
        self.go_on();
        self.pump();
        Ok(())
    }

    /// Drops the job and cools down; a wait for heat is broken off. Lines that the printer has taken are
    /// printed; one that it asks for again is not.
    ///
    /// # Errors
    ///
    /// Unless there is a job.
    pub fn cancel(&mut self, now: Duration) -> Result<(), CommandError> {
        self.advance(now);
        self.allowed(Input::Cancel)?;
        self.cancel_for(StopReason::Cancelled);
        self.pump();
        Ok(())
    }

    /// `M112`, in the very next [`Printer::poll_transmit`]. Possible in every state: the port may be open
    /// even where the link was given up.
    ///
    /// # Errors
    ///
    /// None today; the table decides.
    pub fn emergency_stop(&mut self, now: Duration) -> Result<(), CommandError> {
        self.advance(now);
        self.allowed(Input::EmergencyStop)?;
        self.emergency_for(StopReason::EmergencyStop);
        Ok(())
    }

    /// Sends one command from the console, before the job's next line. `M112` is
    /// [`Printer::emergency_stop`]; `M108` and `M410` jump the queue.
    ///
    /// # Errors
    ///
    /// Without a link, and for lines that cannot be sent.
    pub fn send_line(&mut self, now: Duration, text: &str) -> Result<(), CommandError> {
        self.advance(now);
        let command = own_command(text, self.options.max_line)?;
        match code(command.as_bytes()) {
            Some((b'M', 112)) => return self.emergency_stop(now),
            Some((b'M', 110)) => return Err(CommandError::Numbering),
            Some(_) | None => {}
        }
        self.allowed(Input::Line)?;
        if self.waiting.len() + self.out.len() >= MAX_WAITING {
            return Err(CommandError::TooManyWaiting);
        }
        match code(command.as_bytes()) {
            Some((b'M', 108 | 410)) => self.jump_the_queue(&command),
            Some(_) | None => self.wait_with([command]),
        }
        self.pump();
        Ok(())
    }

    /// Speed of the moves, percent (`M220`).
    ///
    /// # Errors
    ///
    /// Without a link, or outside 10 to 999.
    pub fn set_speed(&mut self, now: Duration, percent: u32) -> Result<(), CommandError> {
        self.set_percent(now, "M220", percent)
    }

    /// Flow of the extruder, percent (`M221`).
    ///
    /// # Errors
    ///
    /// Without a link, or outside 10 to 999.
    pub fn set_flow(&mut self, now: Duration, percent: u32) -> Result<(), CommandError> {
        self.set_percent(now, "M221", percent)
    }

    fn set_percent(&mut self, now: Duration, command: &str, percent: u32) -> Result<(), CommandError> {
        if !(10..=999).contains(&percent) {
            return Err(CommandError::OutOfRange { percent });
        }
        self.send_line(now, &format!("{command} S{percent}"))
    }

    // ---- what is known ----

    /// Whether every line sent and received is told ([`PrinterOptions::log_everything`]).
    pub fn log_everything(&mut self, on: bool) {
        self.options.log_everything = on;
    }

    /// Where the link stands.
    pub fn state(&self) -> State {
        self.state
    }

    /// What the printer told of itself.
    pub fn firmware(&self) -> &Firmware {
        &self.firmware
    }

    /// The last acknowledged line of the job, also after its end.
    pub fn journal(&self) -> Journal {
        if !self.state.has_job() || !self.numbered {
            return self.journal;
        }
        self.queue.last_job_line().map_or(self.journal, |mark| Journal {
            acked_line: Some(mark.line),
            z: mark.z,
            layer: mark.layer,
        })
    }

    /// Position and modes after the last job line sent.
    pub fn position(&self) -> Option<Position> {
        self.job.as_ref().map(|job| job.position)
    }

    /// Counters.
    pub fn statistics(&self) -> Statistics {
        Statistics {
            dropped_replies: self.framer.dropped,
            held_lines: self.queue.held() + self.waiting.len(),
            in_flight: self.queue.in_flight(),
            ..self.statistics
        }
    }

    // ---- steps that commands and the printer share ----

    fn advance(&mut self, now: Duration) {
        self.now = self.now.max(now);
    }

    /// Whether the table has a row; changes nothing.
    fn allowed(&self, input: Input) -> Result<(), CommandError> {
        let state = self.state;
        state.after(input).map(|_| ()).ok_or(CommandError::WrongState { input, state })
    }

    fn command(&mut self, input: Input) -> Result<(), CommandError> {
        self.allowed(input)?;
        self.enter(input);
        Ok(())
    }

    /// Goes where the table leads; false where it has no row.
    fn enter(&mut self, input: Input) -> bool {
        let from = self.state;
        let Some(to) = from.after(input) else { return false };
        self.state = to;
        if from != to {
            self.tell(Event::State { from, to });
        }
        true
    }

    fn tell(&mut self, event: Event) {
        let must = match event {
            Event::State { .. } | Event::Connected { .. } | Event::Firmware(_) => true,
            Event::Paused(_) | Event::Finished(_) | Event::Stopped { .. } => true,
            Event::Temperatures(_) | Event::Message(_) | Event::Warning(_) => false,
            Event::Sent(_) | Event::Received(_) => false,
        };
        if must || self.events.len() < MAX_EVENTS {
            self.events.push_back(event);
        }
    }

    fn wait_with(&mut self, commands: impl IntoIterator<Item = String>) {
        self.waiting.extend(commands.into_iter().map(Waiting::Line));
    }

    /// Past every line that waits; without a number, for the order of numbers is the queue's.
    fn jump_the_queue(&mut self, command: &str) {
        self.queue.expect_surplus_ok();
        self.out.push_front(format!("\n{command}\n").into_bytes());
    }

    fn pause_for(&mut self, input: Input, reason: PauseReason) {
        if !self.enter(input) {
            return;
        }
        self.tell(Event::Paused(reason));
        let position = self.job.as_ref().map(|job| job.position).unwrap_or_default();
        if self.state == State::Parking && position.is_known() {
            self.parked = true;
            self.wait_with(position.park(&self.options.park_lines));
        }
    }

    fn go_on(&mut self) {
        if !self.enter(Input::Resume) {
            return;
        }
        if std::mem::take(&mut self.parked) {
            let lines = self.job.as_ref().map(|job| job.position.way_back(&self.options.return_lines));
            self.wait_with(lines.unwrap_or_default());
        }
    }

    fn cancel_for(&mut self, reason: StopReason) {
        if !self.enter(Input::Cancel) {
            return;
        }
        self.journal = self.queue_journal();
        self.numbered = false;
        self.job = None;
        self.ending = reason;
        self.waiting.clear();
        if self.queue.oldest().is_some_and(waits_for_heat) {
            self.jump_the_queue("M108");
        }
        self.queue.void_job_lines();
        self.wait_with(self.options.cancel_lines.clone());
    }

    fn queue_journal(&self) -> Journal {
        let mark = self.queue.last_job_line().filter(|_| self.numbered);
        mark.map_or(self.journal, |m| Journal { acked_line: Some(m.line), z: m.z, layer: m.layer })
    }

    /// The line feed ends whatever half a line the printer may hold, so that the command stands alone.
    fn emergency_for(&mut self, reason: StopReason) {
        self.stop(Input::EmergencyStop, reason);
        self.out.push_front(b"\nM112\n".to_vec());
    }

    /// Ends job and link for this reason, if the table lets it.
    fn stop(&mut self, input: Input, reason: StopReason) {
        let had_job = self.state.has_job();
        let journal = self.journal();
        if !self.enter(input) {
            return;
        }
        self.journal = journal;
        self.numbered = false;
        self.job = None;
        self.waiting.clear();
        self.out.clear();
        self.timers = Timers::default();
        self.tell(Event::Stopped { reason, journal: had_job.then_some(journal) });
    }
}

/// A command of ours, with room for any number and for positions filled in.
fn own_command(text: &str, max_line: usize) -> Result<String, CommandError> {
    if text.trim().contains(['\n', '\r']) {
        return Err(CommandError::BadLine(LineFault::SeveralLines));
    }
    let command = sendable(strip(text.as_bytes()), room_for_command(u32::MAX, max_line));
    match command.map_err(CommandError::BadLine)? {
        command if command.is_empty() => Err(CommandError::NothingToSend),
        command => Ok(command),
    }
}
