//! What each reply does, and what goes out next.

use super::job::Step;
use super::line::may_take_long;
use super::queue::{Acked, Origin, Resent, Window};
use super::reply::{self, Action, OkReply, Reply};
use super::{Event, Input, PauseReason, Printer, State, StopReason, Waiting};

impl Printer {
    pub(super) fn on_line(&mut self, line: String) {
        if self.state == State::Offline {
            return;
        }
        if self.options.log_everything {
            self.tell(Event::Received(line.clone()));
        }
        self.heard();
        match reply::parse(&line) {
            Reply::Ok(ok) => self.on_ok(ok, &line),
            Reply::Resend(number) => self.on_resend(number),
            Reply::Started => {
                self.tell(Event::Message(line));
                self.board_reset();
            }
            Reply::Busy => self.busy(),
            Reply::Idle => self.idle_printer(),
            Reply::Transmission { last } => self.queue.announce(last),
            Reply::Fault => self.on_fault(line),
            Reply::Killed => self.on_killed(line),
            Reply::Action(action) => self.on_action(action),
            Reply::Firmware => self.on_firmware(&line),
            Reply::Capability { name, on } => self.on_capability(&name, on),
            Reply::Report => self.on_report(&line),
            Reply::Other => self.tell(Event::Message(line)),
        }
    }

    fn on_ok(&mut self, ok: OkReply, line: &str) {
        if let Some(block) = ok.block {
            self.window_lines = self.window_lines.max(block).clamp(1, self.options.max_in_flight.max(1));
        }
        self.statistics.planner_free = ok.planner.or(self.statistics.planner_free);
        if ok.report {
            self.reported();
            self.tell_temperatures(line);
        }
        match self.queue.on_ok(ok) {
            Acked::Progress => self.answered(),
            Acked::Released => {
                self.queue.release();
                self.answered();
            }
            Acked::Swallowed => self.doubt(),
            Acked::Ignored => {}
        }
    }

    fn on_resend(&mut self, number: u32) {
        if !self.state.is_linked() {
            return;
        }
        self.statistics.resends += 1;
        match self.queue.on_resend(number) {
            Resent::Followed => {
                self.answered();
                self.doubt();
            }
            Resent::Repeated | Resent::Doubtful => {
                self.progress();
                self.doubt();
            }
            Resent::CountLost => self.board_reset(),
            Resent::Impossible => {
                let (first, last) = (self.queue.first(), self.queue.end().saturating_sub(1));
                self.cannot_go_on(StopReason::ResendImpossible { asked: number, first, last });
            }
        }
    }

    /// Without a job the handshake begins anew; a job is over.
    fn board_reset(&mut self) {
        match self.state {
            State::Connecting => {
                self.greeting.board_started = true;
                self.await_banner();
            }
            State::Ready => {
                self.enter(Input::BoardReset);
                self.greeting = super::Greeting { board_started: true, ..Default::default() };
                self.await_banner();
            }
            State::Printing
            | State::Finishing
            | State::Parking
            | State::Paused
            | State::Returning
            | State::Cancelling
            | State::Offline
            | State::Halted => self.stop(Input::BoardReset, StopReason::BoardReset),
        }
    }

    fn on_fault(&mut self, line: String) {
        if self.state.has_job() {
            self.cannot_go_on(StopReason::PrinterError { message: line });
        } else {
            self.tell(Event::Warning(line));
        }
    }

    fn on_killed(&mut self, line: String) {
        if self.state.is_linked() {
            self.stop(Input::Killed, StopReason::PrinterError { message: line });
        } else {
            self.tell(Event::Warning(line));
        }
    }

    /// The link works but the job cannot go on: heaters must not stay on.
    fn cannot_go_on(&mut self, reason: StopReason) {
        if self.state.has_job() {
            self.stop(Input::Fault, reason);
            let lines = self.options.fault_lines.iter().flat_map(|line| ["\n", line]);
            self.out.push_back(lines.chain(["\n"]).collect::<String>().into_bytes());
        } else {
            self.stop(Input::GaveUp, reason);
        }
    }

    fn on_action(&mut self, action: Action) {
        match action {
            Action::Pause => self.pause_for(Input::Pause, PauseReason::Printer),
            Action::Paused => self.pause_for(Input::Held, PauseReason::Printer),
            Action::Resume => self.go_on(),
            Action::Cancel => self.cancel_for(StopReason::CancelledByPrinter),
        }
    }

    fn on_firmware(&mut self, line: &str) {
        self.firmware.name = reply::firmware_field(line, "FIRMWARE_NAME").unwrap_or_default();
        self.firmware.machine = reply::firmware_field(line, "MACHINE_TYPE");
        self.firmware.macros =
            ["Klipper", "RepRapFirmware"].iter().any(|name| self.firmware.name.contains(name));
        if self.state == State::Connecting {
            // The answer to M115 shows that it was taken, and so that the count before it was.
            self.greeting.number.into_iter().for_each(|number| self.queue.prove(number));
        } else {
            self.tell(Event::Firmware(self.firmware.clone()));
        }
    }

    fn on_capability(&mut self, name: &str, on: bool) {
        match name {
            "AUTOREPORT_TEMP" => {
                let late = on && !self.firmware.autoreport_temperature && self.state != State::Connecting;
                self.firmware.autoreport_temperature = on;
                if late && self.state.is_linked() {
                    self.ask_for_reports();
                }
            }
            "EMERGENCY_PARSER" => self.firmware.emergency_parser = on,
            _ => {}
        }
    }

    /// A printer that waits for heat tells the temperature; one that reports it by itself tells
    /// nothing by it.
    fn on_report(&mut self, line: &str) {
        self.tell_temperatures(line);
        let waits = self.queue.oldest().is_some_and(may_take_long);
        if waits && !self.firmware.autoreport_temperature {
            self.progress();
        }
    }

    fn tell_temperatures(&mut self, line: &str) {
        if let Some(temperatures) = reply::temperatures(line.strip_prefix("ok").unwrap_or(line)) {
            self.tell(Event::Temperatures(temperatures));
        }
    }

    // ---- what goes out ----

    /// Sends what may go out and takes the steps that follow from it, until nothing changes.
    pub(super) fn pump(&mut self) {
        loop {
            while self.state.is_linked() && self.send_one() {}
            if !self.settle() {
                break;
            }
        }
    }

    fn window(&self) -> Window {
        Window { lines: self.window_lines, bytes: self.options.receive_buffer }
    }

    /// One line, if there is one and room for it. True when something happened.
    fn send_one(&mut self) -> bool {
        if self.queue.is_behind() {
            return self.queue.has_room(self.window(), 0) && self.transmit();
        }
        match self.waiting.front() {
            Some(Waiting::Renumber) => self.renumber(),
            Some(Waiting::Proof) => self.prove() && self.counting_proved(),
            Some(Waiting::Line(command)) => {
                let room = self.queue.has_room(self.window(), command.len());
                let Some(Waiting::Line(command)) = self.waiting.pop_front_if(|_| room) else { return false };
                self.send_now(command)
            }
            None if self.state == State::Printing => self.job_step(),
            None => false,
        }
    }

    fn renumber(&mut self) -> bool {
        if !self.queue.everything_acked() {
            return false;
        }
        self.waiting.pop_front();
        self.waits_from_now();
        self.queue.restart();
        self.begin_proof();
        self.numbered = true;
        true
    }

    fn counting_proved(&mut self) -> bool {
        self.timers.proof = None;
        self.queue.prove(0);
        self.waiting.pop_front().is_some()
    }

    /// Gives the line a number and sends it, whatever is in flight.
    pub(super) fn send_now(&mut self, command: String) -> bool {
        self.waits_from_now();
        let number = self.queue.push(command, Origin::Own);
        if self.state == State::Connecting {
            self.greeting.number = Some(number);
        }
        self.transmit()
    }

    fn transmit(&mut self) -> bool {
        if let Some((number, times)) = self.queue.attempts().filter(|(_, n)| *n >= self.options.resend_limit)
        {
            self.cannot_go_on(StopReason::ResendLoop { number, times });
            return true;
        }
        let Some(wire) = self.queue.next_to_send() else { return false };
        self.written(wire.len());
        self.statistics.sent += 1;
        if self.options.log_everything {
            let text = String::from_utf8_lossy(wire.trim_ascii_end()).into_owned();
            self.tell(Event::Sent(text));
        }
        self.out.push_back(wire);
        true
    }

    fn job_step(&mut self) -> bool {
        let limit = self.queue.command_limit(self.options.max_line);
        let window = self.window();
        let Some(job) = self.job.as_mut() else { return false };
        match job.peek(limit) {
            Step::Send { command, .. } if !self.queue.has_room(window, command.len()) => return false,
            // It would overtake lines that are not in the printer yet.
            Step::Emergency { .. } if !self.queue.everything_acked() => return false,
            Step::End => {
                self.enter(Input::JobSent);
                self.begin_proof();
                return true;
            }
            Step::Send { .. } | Step::Pause(_) | Step::Emergency { .. } | Step::Bad { .. } => {}
        }
        match job.take() {
            Some(Step::Send { command, mark }) => {
                self.waits_from_now();
                self.queue.push(command, Origin::Job(mark));
                self.transmit();
            }
            Some(Step::Pause(text)) => self.pause_for(Input::Pause, PauseReason::Job(text)),
            Some(Step::Emergency { line }) => self.emergency_for(StopReason::EmergencyInJob { line }),
            Some(Step::Bad { line, fault }) => self.cancel_for(StopReason::BadJobLine { line, fault }),
            Some(Step::End) | None => return false,
        }
        true
    }

    // ---- steps that follow by themselves ----

    fn settle(&mut self) -> bool {
        let sent = self.waiting.is_empty();
        let done = sent && self.queue.everything_acked();
        match self.state {
            State::Connecting => {
                self.greeting.number.is_some_and(|n| self.queue.acked() > n) && self.greeted()
            }
            State::Parking => done && self.enter(Input::ScriptDone),
            State::Returning => sent && self.enter(Input::ScriptDone),
            State::Cancelling => done && self.cancelled(),
            State::Finishing => sent && self.prove() && self.finish(),
            State::Offline | State::Ready | State::Printing | State::Paused | State::Halted => false,
        }
    }

    fn greeted(&mut self) -> bool {
        self.enter(Input::Greeted);
        self.timers.handshake = None;
        self.tell(Event::Firmware(self.firmware.clone()));
        self.tell(Event::Connected { board_started: self.greeting.board_started });
        if self.firmware.autoreport_temperature {
            self.ask_for_reports();
        }
        self.wait_with(["M105".to_owned()]);
        self.schedule_report();
        true
    }

    fn ask_for_reports(&mut self) {
        let seconds = self.options.temperature_interval.as_secs().max(1);
        self.wait_with([format!("M155 S{seconds}")]);
    }

    fn cancelled(&mut self) -> bool {
        self.enter(Input::ScriptDone);
        let reason = std::mem::replace(&mut self.ending, StopReason::Cancelled);
        self.tell(Event::Stopped { reason, journal: Some(self.journal) });
        true
    }

    pub(super) fn finish(&mut self) -> bool {
        let journal = self.journal();
        self.enter(Input::JobConfirmed);
        self.journal = journal;
        self.numbered = false;
        self.job = None;
        self.timers.proof = None;
        self.tell(Event::Finished(journal));
        true
    }
}
