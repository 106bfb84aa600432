//! Everything that happens because time passes.

use std::time::Duration;

use super::line::{may_take_long, waits_for_heat};
use super::{Input, Printer, Proof, State, StopReason, Waiting};

/// After the first line of a banner the board is given this long before it is spoken to.
const BANNER_WAIT: Duration = Duration::from_secs(1);

/// An `M105` that has to prove something keeps this far from another one, whose answer may be doubled.
const REPORT_GAP: Duration = Duration::from_millis(250);

/// How often it is sent before a plain `ok` is believed.
const PROOF_TRIES: u32 = 3;

/// While anything else comes in, and again in a command that takes long, this many times more probes are
/// sent before the link is lost.
const PATIENCE: u32 = 4;

/// Deadlines and what silence is measured from.
#[derive(Debug, Default)]
pub(super) struct Timers {
    /// The handshake begins anew.
    pub(super) handshake: Option<Duration>,
    /// A missing `ok` is supplied, or the oldest line sent again.
    pub(super) doubt: Option<Duration>,
    /// `M105` is due.
    pub(super) report: Option<Duration>,
    /// The `M105` that proves the count is sent or given up.
    pub(super) proof: Option<Duration>,
    /// The last `ok`, resend or busy, or the first line after a time with none in flight.
    progress: Duration,
    /// The last answer to `M105`.
    last_report: Duration,
    probes: u32,
    last_probe: Duration,
    /// Something came in since the last progress.
    heard: bool,
    /// The printer sends `busy` when it is: its silence means what it says.
    says_busy: bool,
    /// Bytes written since the last progress, and those in flight then.
    unanswered: usize,
}

impl Printer {
    /// The time of the next deadline, to hand to [`Printer::handle_timeout`].
    pub fn poll_timeout(&self) -> Option<Duration> {
        let t = &self.timers;
        [t.handshake, t.doubt, t.report, t.proof, self.silence_ends()].into_iter().flatten().min()
    }

    pub(super) fn on_timers(&mut self) {
        let now = self.now;
        let due = |at: Option<Duration>| at.is_some_and(|at| at <= now);
        if due(self.timers.handshake) {
            self.handshake_is_due();
        }
        if due(self.timers.doubt) {
            self.timers.doubt = None;
            self.queue.supply_ok();
        }
        if due(self.timers.report) {
            self.report_is_due();
        }
        if due(self.timers.proof) {
            self.proof_is_due();
        }
        if due(self.silence_ends()) {
            self.probe();
        }
    }

    /// The printer answered or is at work.
    pub(super) fn progress(&mut self) {
        self.timers.progress = self.now;
        self.timers.probes = 0;
        self.timers.heard = false;
        self.timers.unanswered = self.queue.bytes_in_flight();
    }

    pub(super) fn busy(&mut self) {
        self.progress();
        self.timers.says_busy = true;
    }

    pub(super) fn heard(&mut self) {
        self.timers.heard = true;
    }

    /// A line was answered: the next one's silence counts anew.
    pub(super) fn answered(&mut self) {
        self.progress();
        if !self.queue.awaits_release() {
            self.timers.doubt = None;
        }
    }

    pub(super) fn reported(&mut self) {
        self.timers.last_report = self.now;
    }

    /// A new line is about to go out: if it is the only one, silence counts from now.
    pub(super) fn waits_from_now(&mut self) {
        if self.queue.in_flight() == 0 {
            self.progress();
        }
    }

    /// Bytes are about to be written.
    pub(super) fn written(&mut self, bytes: usize) {
        self.timers.unanswered += bytes;
    }

    /// What is in flight is in doubt; settled soon.
    pub(super) fn doubt(&mut self) {
        let at = self.now + self.options.resend_wait;
        self.timers.doubt.get_or_insert(at);
    }

    /// `wait`: the printer has nothing to do. If a line of ours is long unanswered, its `ok` got lost.
    pub(super) fn idle_printer(&mut self) {
        let waited = self.now.saturating_sub(self.timers.progress) >= self.options.resend_wait;
        if self.queue.in_flight() > 0 && waited {
            self.doubt();
        }
    }

    // ---- handshake ----

    /// `M110 N0` now, `M115` when it is answered. The first line feed ends half a line of whoever wrote
    /// to this port before.
    pub(super) fn begin_handshake(&mut self) {
        self.clear_handshake();
        self.queue.restart();
        self.out.push_back(b"\n".to_vec());
        self.wait_with(["M115".to_owned()]);
        self.timers.handshake = Some(self.now + self.options.handshake_wait);
    }

    /// The board is starting: what was sent is lost, and it is given time to get ready.
    pub(super) fn await_banner(&mut self) {
        if !self.queue.is_empty() || self.greeting.number.is_some() {
            self.clear_handshake();
            self.queue.clear();
            self.timers.handshake = Some(self.now + BANNER_WAIT);
        }
    }

    fn clear_handshake(&mut self) {
        self.waiting.clear();
        self.out.clear();
        self.greeting.number = None;
        self.window_lines = 1;
        self.timers = Timers::default();
    }

    fn handshake_is_due(&mut self) {
        self.greeting.tries += 1;
        if self.greeting.tries >= self.options.handshake_tries {
            self.stop(Input::GaveUp, StopReason::NoGreeting);
        } else {
            self.begin_handshake();
        }
    }

    // ---- temperatures, and the count of lines ----

    pub(super) fn schedule_report(&mut self) {
        let wait = if self.firmware.autoreport_temperature {
            self.options.count_check_interval
        } else {
            self.options.temperature_interval
        };
        self.timers.report = Some(self.now + wait);
    }

    fn report_is_due(&mut self) {
        self.schedule_report();
        if self.queue.report_pending() && self.queue.everything_acked() {
            self.queue.forget_reports();
        }
        let asked = self.queue.report_pending() || self.waiting.iter().any(is_report);
        if !asked && self.state != State::Finishing {
            self.wait_with(["M105".to_owned()]);
        }
    }

    // ---- the proof that the printer counts as we do ----

    /// At the begin of a job, that the new numbering has arrived; at its end, that all of it has.
    pub(super) fn begin_proof(&mut self) {
        self.proof = Proof::default();
        self.timers.proof = Some(self.now);
    }

    /// Sends an `M105` when nothing else is out; its answer comes for a line that was taken in order, and
    /// so for all before it. True when the proof is there.
    pub(super) fn prove(&mut self) -> bool {
        if self.proof.believed {
            return true;
        }
        if let Some(number) = self.proof.number {
            return self.queue.is_certain(number);
        }
        let quiet = self.timers.last_report + REPORT_GAP;
        if !self.queue.everything_acked() || self.queue.report_pending() {
            return false;
        }
        if self.now < quiet {
            self.timers.proof = Some(quiet);
            return false;
        }
        self.timers.proof = Some(self.now + self.options.proof_wait);
        self.proof.number = Some(self.queue.end());
        self.send_now("M105".to_owned());
        false
    }

    /// A firmware that does not answer `M105` in the `ok` line is believed after some tries, if it asks
    /// for nothing again.
    fn proof_is_due(&mut self) {
        let wanted = self.state == State::Finishing || self.waiting.contains(&Waiting::Proof);
        self.timers.proof = wanted.then_some(self.now + self.options.proof_wait);
        if !wanted || !self.queue.everything_acked() {
            return;
        }
        self.queue.forget_reports();
        if self.proof.number.take().is_some() {
            self.proof.tries += 1;
            self.proof.believed = self.proof.tries >= PROOF_TRIES;
        }
    }

    // ---- silence ----

    fn silence_ends(&self) -> Option<Duration> {
        if self.state == State::Connecting || !self.state.is_linked() {
            return None;
        }
        let oldest = self.queue.oldest()?;
        let (t, o) = (&self.timers, &self.options);
        if t.probes > 0 {
            return Some(t.last_probe + o.probe_interval);
        }
        let tells = t.says_busy && !waits_for_heat(oldest);
        Some(t.progress + if may_take_long(oldest) && !tells { o.long_silence } else { o.silence })
    }

    /// First a numbered `M105` behind the line in flight: the answer tells which of the two the printer
    /// has. Then the oldest line again, as far as the receive buffer has room, else a line feed.
    fn probe(&mut self) {
        let long = self.queue.oldest().is_some_and(may_take_long);
        let patience = [self.timers.heard, long].iter().filter(|slow| **slow).fold(1, |p, _| p * PATIENCE);
        if self.timers.probes >= self.options.probe_misses * patience {
            self.stop(Input::GaveUp, StopReason::NoAnswer);
            return;
        }
        self.timers.probes += 1;
        self.timers.last_probe = self.now;
        let fits = |bytes: usize| self.timers.unanswered + bytes <= self.options.receive_buffer;
        let first = self.timers.probes == 1 && !self.queue.is_behind() && !self.queue.awaits_release();
        if first && fits(self.queue.longest_report()) {
            self.send_now("M105".to_owned());
        } else if fits(self.queue.oldest_wire()) {
            self.queue.supply_ok();
        } else if fits(1) {
            self.timers.unanswered += 1;
            self.out.push_back(b"\n".to_vec());
        }
    }
}

fn is_report(waiting: &Waiting) -> bool {
    *waiting == Waiting::Line("M105".to_owned())
}
