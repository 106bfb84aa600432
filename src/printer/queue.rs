//! Lines sent and not yet acknowledged, and those kept for a resend.
//!
//! Three numbers cut the kept lines: everything below `floor` is certainly in the printer, everything
//! below `acked` is acknowledged as far as we can count, everything below `cursor` has been sent.
//! An `ok` without a number may be lost or doubled on the way, so `acked` is a good guess; what decides
//! is the printer's own count, which it tells with every resend, every numbered `ok` and every answer
//! to `M105`.

use std::collections::VecDeque;

use super::line::{code, longest_wire, numbered, room_for_command};
use super::reply::OkReply;

/// What a line is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Origin {
    /// Ours: numbering, scripts, console, settings.
    Own,
    /// The job's.
    Job(JobMark),
}

/// Where a line stands in the job.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct JobMark {
    /// Index in the job, from 0, comments counted.
    pub(super) line: u64,
    /// Height when the line is done, mm.
    pub(super) z: Option<f64>,
    /// Layers begun.
    pub(super) layer: u32,
}

#[derive(Debug)]
struct Entry {
    /// The line as it goes out.
    wire: Vec<u8>,
    command: String,
    origin: Origin,
    /// `M105`, whoever asked for it: its answer names its line by itself.
    is_report: bool,
}

/// A line asked for again.
#[derive(Debug, Clone, Copy)]
struct Recovery {
    target: u32,
    /// The line has been sent again; before that the `ok` of the request is awaited.
    sent: bool,
    times: u32,
}

/// What became of an `ok`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Acked {
    /// Lines were acknowledged.
    Progress,
    /// It belonged to a resend: the line asked for may go out now.
    Released,
    /// One too many, expected after a repeated request. What is in flight stays in doubt.
    Swallowed,
    /// Nothing was waiting for it.
    Ignored,
}

/// What became of a request to send again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Resent {
    /// Accepted.
    Followed,
    /// The same request as the one being answered.
    Repeated,
    /// Makes no sense and nothing confirms it: garbled or late.
    Doubtful,
    /// The printer counts from the start again.
    CountLost,
    /// Not kept any more, or never sent.
    Impossible,
}

/// How many lines and bytes may be in flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub(super) lines: u32,
    /// The firmware's receive buffer.
    pub(super) bytes: usize,
}

/// A request that nothing confirms is believed when it came this often.
const BELIEVED_TIMES: u32 = 3;

/// A command that does nothing.
const NOTHING: &str = "G4 P0";

/// Acknowledged lines by count that are taken as certain: `ok`s are doubled, but not so many before a
/// report or a resend sets the count right.
const CERTAIN_LAG: u32 = 64;

#[derive(Debug)]
pub(super) struct SendQueue {
    lines: VecDeque<Entry>,
    /// Number of `lines[0]`.
    first: u32,
    floor: u32,
    acked: u32,
    cursor: u32,
    recovery: Option<Recovery>,
    /// `ok`s of repeated requests still to come.
    surplus: u32,
    /// First and last `M105` sent since the last answer to one.
    reports: Option<(u32, u32)>,
    /// Number after `Last Line:` plus one, from the error just before a request.
    announced: Option<u32>,
    /// The last doubtful request, and how often it came.
    doubted: Option<(u32, u32)>,
    /// Acknowledged lines kept at least.
    keep: usize,
    /// Mark of the last job line that is not kept any more.
    forgotten: Option<JobMark>,
}

impl SendQueue {
    pub(super) fn new(keep: usize) -> SendQueue {
        SendQueue {
            lines: VecDeque::new(),
            first: 0,
            floor: 0,
            acked: 0,
            cursor: 0,
            recovery: None,
            surplus: 0,
            reports: None,
            announced: None,
            doubted: None,
            keep,
            forgotten: None,
        }
    }

    /// Forgets everything and begins with `N0 M110 N0`.
    pub(super) fn restart(&mut self) {
        self.clear();
        self.push("M110 N0".to_owned(), Origin::Own);
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        *self = SendQueue::new(self.keep);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Adds a line behind all others; it goes out by [`SendQueue::next_to_send`].
    pub(super) fn push(&mut self, command: String, origin: Origin) -> u32 {
        let number = self.end();
        let is_report = code(command.as_bytes()) == Some((b'M', 105));
        self.lines.push_back(Entry { wire: numbered(number, &command), command, origin, is_report });
        number
    }

    /// Number of the next new line.
    pub(super) fn end(&self) -> u32 {
        // At most `keep` and a window of lines are kept.
        self.first + self.lines.len() as u32
    }

    pub(super) fn first(&self) -> u32 {
        self.first
    }

    pub(super) fn acked(&self) -> u32 {
        self.acked
    }

    pub(super) fn in_flight(&self) -> u32 {
        self.cursor - self.acked
    }

    pub(super) fn everything_acked(&self) -> bool {
        self.acked == self.end() && self.recovery.is_none()
    }

    /// Lines wait to be sent again.
    pub(super) fn is_behind(&self) -> bool {
        self.cursor < self.end()
    }

    /// A resend was asked for and its `ok` has not come.
    pub(super) fn awaits_release(&self) -> bool {
        self.recovery.is_some_and(|r| !r.sent)
    }

    /// An `M105` was sent and not answered.
    pub(super) fn report_pending(&self) -> bool {
        self.reports.is_some()
    }

    /// The command of the oldest line in flight.
    pub(super) fn oldest(&self) -> Option<&str> {
        (self.in_flight() > 0).then(|| self.entry(self.acked).map(|e| e.command.as_str()))?
    }

    fn entry(&self, number: u32) -> Option<&Entry> {
        self.lines.get(number.checked_sub(self.first)? as usize)
    }

    pub(super) fn bytes_in_flight(&self) -> usize {
        (self.acked..self.cursor).filter_map(|n| self.entry(n)).map(|e| e.wire.len()).sum()
    }

    /// A line may go out now: the one that waits to be sent again, or a new one with a command of
    /// `bytes` bytes.
    pub(super) fn has_room(&self, window: Window, bytes: usize) -> bool {
        let wire = self.entry(self.cursor).map_or_else(|| longest_wire(self.end(), bytes), |e| e.wire.len());
        match self.in_flight() {
            _ if self.awaits_release() => false,
            0 => true,
            _ if self.recovery.is_some() => false,
            lines => lines < window.lines && self.bytes_in_flight() + wire <= window.bytes,
        }
    }

    /// Bytes of an `M105` sent next, at most.
    pub(super) fn longest_report(&self) -> usize {
        longest_wire(self.end(), "M105".len())
    }

    /// Bytes of the oldest line in flight.
    pub(super) fn oldest_wire(&self) -> usize {
        self.entry(self.acked).map_or(0, |e| e.wire.len())
    }

    /// Room for the command of the next new line.
    pub(super) fn command_limit(&self, max_line: usize) -> usize {
        room_for_command(self.end(), max_line)
    }

    /// The next line on the wire: again where the printer asked, else the newest pushed.
    pub(super) fn next_to_send(&mut self) -> Option<Vec<u8>> {
        let number = self.cursor;
        let entry = self.entry(number)?;
        let wire = entry.wire.clone();
        if entry.is_report {
            self.reports = Some((self.reports.map_or(number, |(first, _)| first.min(number)), number));
        }
        if let Some(recovery) = self.recovery.as_mut().filter(|r| r.target == number) {
            recovery.sent = true;
            recovery.times += 1;
        }
        self.cursor = number + 1;
        Some(wire)
    }

    /// How often the line asked for has been sent again.
    pub(super) fn attempts(&self) -> Option<(u32, u32)> {
        self.recovery.map(|r| (r.target, r.times))
    }

    pub(super) fn on_ok(&mut self, ok: OkReply) -> Acked {
        self.announced = None;
        if ok.report {
            return self.on_report();
        }
        let known = ok.line.filter(|n| *n < self.cursor);
        if self.awaits_release() {
            return Acked::Released;
        }
        if let Some(number) = known {
            if number < self.acked {
                return Acked::Ignored;
            }
            self.acknowledge_below(number + 1);
            return Acked::Progress;
        }
        if self.surplus > 0 {
            self.surplus -= 1;
            return Acked::Swallowed;
        }
        if self.in_flight() == 0 {
            return Acked::Ignored;
        }
        self.acknowledge_below(self.acked + 1);
        Acked::Progress
    }

    /// The answer to `M105` names its line by itself, for one is out at a time.
    fn on_report(&mut self) -> Acked {
        let Some((first, last)) = self.reports.take() else { return Acked::Ignored };
        self.floor = self.floor.max(first + 1);
        let certain = self.floor.max(last + 1);
        if first == last && certain < self.acked && self.recovery.is_none() {
            // More was acknowledged than the printer had taken: `ok`s were doubled.
            self.acked = certain;
            return Acked::Progress;
        }
        if last >= self.acked {
            self.acknowledge_below(last + 1);
        }
        Acked::Progress
    }

    fn acknowledge_below(&mut self, number: u32) {
        self.acked = number;
        self.cursor = self.cursor.max(number);
        self.doubted = None;
        if self.recovery.is_some_and(|r| r.target < number) {
            self.recovery = None;
        }
        self.floor = self.floor.max(self.acked.saturating_sub(CERTAIN_LAG));
        while self.acked - self.first > self.keep as u32 {
            let gone = self.lines.pop_front().map(|entry| entry.origin);
            if let Some(Origin::Job(mark)) = gone {
                self.forgotten = Some(mark);
            }
            self.first += 1;
        }
    }

    /// An error that announces a resend, with its last good line.
    pub(super) fn announce(&mut self, last: Option<u32>) {
        self.announced = last.and_then(|n| n.checked_add(1));
    }

    pub(super) fn on_resend(&mut self, number: u32) -> Resent {
        let confirmed = self.announced.take() == Some(number);
        if self.floor == 0 && number != 1 {
            // Nothing proves yet that M110 arrived: the number may be one of an older count.
            return self.restart_numbering();
        }
        if number < self.floor || number < self.first || number > self.end() {
            return self.on_strange(number, confirmed);
        }
        if self.recovery.is_some_and(|r| r.target == number) {
            self.surplus += 1;
            return Resent::Repeated;
        }
        if confirmed {
            self.floor = number;
        }
        self.go_back_to(number);
        Resent::Followed
    }

    fn restart_numbering(&mut self) -> Resent {
        if self.first > 0 {
            return Resent::Impossible;
        }
        if self.recovery.is_some_and(|r| r.target == 0) {
            self.surplus += 1;
            return Resent::Repeated;
        }
        self.go_back_to(0);
        Resent::Followed
    }

    fn on_strange(&mut self, number: u32, confirmed: bool) -> Resent {
        let times = self.doubted.filter(|(n, _)| *n == number).map_or(1, |(_, times)| times + 1);
        self.doubted = Some((number, times));
        let at_hand = number >= self.first && number <= self.end();
        match confirmed {
            true if number <= 1 => return Resent::CountLost,
            true if at_hand => {
                // Twice said: then it was we who took something for certain that was not.
                self.floor = number;
                self.go_back_to(number);
                return Resent::Followed;
            }
            false if at_hand || times < BELIEVED_TIMES => {}
            true | false => return Resent::Impossible,
        }
        self.surplus += 1;
        Resent::Doubtful
    }

    fn go_back_to(&mut self, number: u32) {
        self.recovery = None;
        self.surplus = 0;
        if number > self.acked {
            self.acknowledge_below(number);
        }
        self.acked = number;
        self.cursor = number;
        self.recovery = Some(Recovery { target: number, sent: false, times: 0 });
    }

    /// The `ok` of the request did not come: go on without. Also when the answer to a line is in
    /// doubt: the oldest line goes out again, and the printer's answer settles it.
    pub(super) fn supply_ok(&mut self) {
        self.surplus = 0;
        match self.recovery {
            Some(recovery) if !recovery.sent => self.release(),
            Some(recovery) => self.cursor = recovery.target,
            None if self.in_flight() > 0 => {
                self.cursor = self.acked;
                self.recovery = Some(Recovery { target: self.acked, sent: true, times: 0 });
            }
            None => {}
        }
    }

    /// The `ok` of the request came. Where the printer asked for the next new line, it has all others.
    pub(super) fn release(&mut self) {
        let end = self.end();
        self.recovery = self.recovery.filter(|r| r.target < end).map(|r| Recovery { sent: true, ..r });
    }

    /// Lines of the job that the printer has not taken become nothing, should it ask for them again.
    pub(super) fn void_job_lines(&mut self) {
        for number in self.acked..self.end() {
            let place = (number - self.first) as usize;
            if let Some(entry) = self.lines.get_mut(place).filter(|e| matches!(e.origin, Origin::Job(_))) {
                entry.command = NOTHING.to_owned();
                entry.wire = numbered(number, NOTHING);
                entry.origin = Origin::Own;
                entry.is_report = false;
            }
        }
    }

    /// A line without number went out; its `ok` acknowledges none of ours.
    pub(super) fn expect_surplus_ok(&mut self) {
        self.surplus += 1;
    }

    /// Something else than an `ok` shows that the printer has this line.
    pub(super) fn prove(&mut self, number: u32) {
        if number < self.cursor {
            self.floor = self.floor.max(number + 1);
        }
    }

    /// The printer has this line, by its own word.
    pub(super) fn is_certain(&self, number: u32) -> bool {
        self.floor > number
    }

    /// Waits no longer for the answer to an `M105`.
    pub(super) fn forget_reports(&mut self) {
        self.reports = None;
    }

    /// The last acknowledged line of the job.
    pub(super) fn last_job_line(&self) -> Option<JobMark> {
        let kept = (self.first..self.acked).rev().filter_map(|n| self.entry(n));
        let mark =
            kept.map(|e| e.origin).find_map(|o| if let Origin::Job(mark) = o { Some(mark) } else { None });
        mark.or(self.forgotten)
    }

    /// Lines held now, for the tests of constant memory.
    pub(super) fn held(&self) -> usize {
        self.lines.len()
    }
}
