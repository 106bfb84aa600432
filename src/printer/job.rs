//! The job: lines pulled one by one, never held.

use super::event::Journal;
use super::line::{LineFault, code, sendable, strip};
use super::position::Position;
use super::queue::JobMark;

/// The lines of a job, raw: comments, blanks and line ends may be on them. Pulled when a line may go
/// out, so that a job of any length takes the memory of one line.
pub type JobLines = Box<dyn Iterator<Item = Vec<u8>>>;

/// What to print and where to begin.
pub struct JobStart {
    /// The lines, from the first one of the file.
    pub lines: JobLines,
    /// Index of the first line to send, from 0, comments counted; 0 prints all. The lines before are
    /// read at once, to know position and modes, and not sent.
    pub first_line: u64,
    /// Commands sent before the first line: heat, home and purge when a print begins at a layer.
    pub prelude: Vec<String>,
    /// Go to where `first_line` begins, with its modes and speed, after the prelude. Wanted when a print
    /// begins at a layer; not wanted when the printer kept its state.
    pub restore: bool,
}

impl JobStart {
    /// The whole job.
    pub fn new(lines: JobLines) -> JobStart {
        JobStart { lines, first_line: 0, prelude: Vec::new(), restore: false }
    }
}

impl std::fmt::Debug for JobStart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("JobStart").field("first_line", &self.first_line).finish_non_exhaustive()
    }
}

/// What the job wants next.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    Send {
        command: String,
        mark: JobMark,
    },
    /// `M0`, `M1` with the text behind.
    Pause(String),
    /// `M112`.
    Emergency {
        line: u64,
    },
    Bad {
        line: u64,
        fault: LineFault,
    },
    End,
}

pub(super) struct Job {
    lines: JobLines,
    /// Index of the next raw line.
    next: u64,
    layer: u32,
    /// After the lines sent.
    pub(super) position: Position,
    peeked: Option<Step>,
}

impl std::fmt::Debug for Job {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Job").field("next", &self.next).finish_non_exhaustive()
    }
}

impl Job {
    /// Reads over the lines before `first_line`.
    pub(super) fn new(lines: JobLines, first_line: u64) -> Job {
        let mut job = Job { lines, next: 0, layer: 0, position: Position::default(), peeked: None };
        while job.next < first_line {
            let Some(raw) = job.lines.next() else { break };
            job.count_layer(&raw);
            job.position.follow(&String::from_utf8_lossy(strip(&raw)));
            job.next += 1;
        }
        job
    }

    /// The journal of a job that begins at `first_line`: the line before counts as done.
    pub(super) fn journal_before(&self, first_line: u64) -> Journal {
        Journal { acked_line: first_line.checked_sub(1), z: self.position.z, layer: self.layer }
    }

    /// What comes next; the same until it is taken. `limit` is the longest command the line may hold.
    pub(super) fn peek(&mut self, limit: usize) -> &Step {
        if self.peeked.is_none() {
            self.peeked = Some(self.pull(limit));
        }
        self.peeked.as_ref().unwrap_or(&Step::End)
    }

    /// Takes what [`Job::peek`] showed and follows it.
    pub(super) fn take(&mut self) -> Option<Step> {
        let mut step = self.peeked.take()?;
        if let Step::Send { command, mark } = &mut step {
            self.position.follow(command);
            mark.z = self.position.z;
        }
        Some(step)
    }

    fn pull(&mut self, limit: usize) -> Step {
        loop {
            let Some(raw) = self.lines.next() else { return Step::End };
            let line = self.next;
            self.next += 1;
            self.count_layer(&raw);
            let command = strip(&raw);
            match code(command) {
                None if command.is_empty() => {}
                Some((b'M', 110)) => {}
                Some((b'M', 112)) => return Step::Emergency { line },
                Some((b'M', 0 | 1)) => return Step::Pause(pause_text(command)),
                Some(_) | None => {
                    let mark = JobMark { line, z: None, layer: self.layer };
                    return match sendable(command, limit) {
                        Ok(command) => Step::Send { command, mark },
                        Err(fault) => Step::Bad { line, fault },
                    };
                }
            }
        }
    }

    fn count_layer(&mut self, raw: &[u8]) {
        self.layer = layer_after(self.layer, raw);
    }
}

/// Layers begun after this line: `;LAYER_CHANGE` begins one; `;LAYER:n` says its number from 0.
pub(super) fn layer_after(layer: u32, raw: &[u8]) -> u32 {
    let line = raw.trim_ascii_start();
    if line.starts_with(b";LAYER_CHANGE") {
        return layer.saturating_add(1);
    }
    let number = line.strip_prefix(b";LAYER:").and_then(|n| std::str::from_utf8(n.trim_ascii()).ok());
    number.and_then(|n| n.parse::<u32>().ok()).map_or(layer, |n| n.saturating_add(1))
}

/// The text of `M0`/`M1` without the numbers it may begin with.
fn pause_text(command: &[u8]) -> String {
    let text = String::from_utf8_lossy(command);
    let is_wait = |part: &str| {
        part.len() > 1 && part.starts_with(['S', 'P']) && part[1..].bytes().all(|b| b.is_ascii_digit())
    };
    text.split_ascii_whitespace().skip(1).filter(|part| !is_wait(part)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(lines: &'static [&'static str], first_line: u64) -> Job {
        Job::new(Box::new(lines.iter().map(|l| l.as_bytes().to_vec())), first_line)
    }

    fn step(job: &mut Job) -> Step {
        job.peek(79);
        job.take().expect("peeked")
    }

    #[test]
    fn only_commands_come_out_with_their_line_layer_and_height() {
        let mut job = job(&["; head", "", ";LAYER_CHANGE", "G1 Z0.2 ; up", "M110 N5", "G1 X1"], 0);
        let mark = |line| JobMark { line, z: Some(0.2), layer: 1 };
        assert_eq!(step(&mut job), Step::Send { command: "G1 Z0.2".to_owned(), mark: mark(3) });
        assert_eq!(step(&mut job), Step::Send { command: "G1 X1".to_owned(), mark: mark(5) });
        assert_eq!(step(&mut job), Step::End);
    }

    #[test]
    fn pauses_and_the_emergency_stop_are_not_sent() {
        let mut job = job(&["M0 S10 Change filament", "M1", "M112", "G1 X\u{e9}"], 0);
        assert_eq!(step(&mut job), Step::Pause("Change filament".to_owned()));
        assert_eq!(step(&mut job), Step::Pause(String::new()));
        assert_eq!(step(&mut job), Step::Emergency { line: 2 });
        assert_eq!(step(&mut job), Step::Bad { line: 3, fault: LineFault::NotAscii });
    }

    #[test]
    fn lines_before_the_first_are_followed_but_not_sent() {
        let mut job = job(&["G90", ";LAYER:4", "G1 X5 Y6 Z1 F900", "G1 X7"], 3);
        assert_eq!((job.position.x, job.position.z), (Some(5.0), Some(1.0)));
        let mark = JobMark { line: 3, z: Some(1.0), layer: 5 };
        assert_eq!(step(&mut job), Step::Send { command: "G1 X7".to_owned(), mark });
    }

    #[test]
    fn a_line_peeked_at_does_not_move_the_head() {
        let mut job = job(&["G1 X5", "G1 X7"], 1);
        job.peek(79);
        assert_eq!(job.position.x, Some(5.0));
        job.take();
        assert_eq!(job.position.x, Some(7.0));
    }
}
