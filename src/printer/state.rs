//! The machine as one table: which command or happening is possible in which state, and where it
//! leads. What has no row is our mistake ([`CommandError`]) when it is a command, and is passed
//! over when the printer caused it.

use std::fmt;

use serde::Serialize;

use super::line::LineFault;

/// Where the link and the job stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// No link: never connected, unplugged, or given up.
    Offline,
    /// The printer is asked for its name (`M110`, `M115`).
    Connecting,
    /// Linked, no job.
    Ready,
    /// Job lines go out.
    Printing,
    /// The last job lines are out; a closing `M105` proves that the printer has them all.
    Finishing,
    /// The park lines go out.
    Parking,
    /// The job waits.
    Paused,
    /// The way back to the job goes out.
    Returning,
    /// The job is dropped; the cool-down lines go out.
    Cancelling,
    /// Stopped for good: the printer needs a reset or a new handshake.
    Halted,
}

/// What moves the machine: our commands first, then what the printer or the port does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Input {
    /// Command: begin the handshake.
    Connect,
    /// Command: print a job.
    Start,
    /// Command: pause and park (also `M0`, `M1`, `//action:pause`).
    Pause,
    /// Command: go on.
    Resume,
    /// Command: drop the job.
    Cancel,
    /// Command: `M112`.
    EmergencyStop,
    /// Command: a line from the console, or speed and flow.
    Line,
    /// Command: the port was closed or the cable pulled.
    Closed,
    /// The handshake was answered.
    Greeted,
    /// The printer paused by itself (`//action:paused`): no parking, unless we were half way back.
    Held,
    /// The lines of park, return or cool-down are done.
    ScriptDone,
    /// The job has no more lines.
    JobSent,
    /// The printer has accepted every line of the job.
    JobConfirmed,
    /// The board started anew.
    BoardReset,
    /// An `Error:` that is neither about transmission nor an unknown command, or a line that
    /// cannot be sent again.
    Fault,
    /// `!!`, or the printer says that it halted.
    Killed,
    /// No answer for too long.
    GaveUp,
}

use Input as I;
use State as S;

/// State, input, next state. A state with no row for an input does not take it.
pub const TABLE: &[(State, Input, State)] = &[
    (S::Offline, I::Connect, S::Connecting),
    // The link was given up, but the port may still be open.
    (S::Offline, I::EmergencyStop, S::Halted),
    //
    (S::Connecting, I::Connect, S::Connecting),
    (S::Connecting, I::EmergencyStop, S::Halted),
    (S::Connecting, I::Closed, S::Offline),
    (S::Connecting, I::Greeted, S::Ready),
    (S::Connecting, I::BoardReset, S::Connecting),
    (S::Connecting, I::Killed, S::Halted),
    (S::Connecting, I::GaveUp, S::Offline),
    //
    (S::Ready, I::Connect, S::Connecting),
    (S::Ready, I::Start, S::Printing),
    (S::Ready, I::EmergencyStop, S::Halted),
    (S::Ready, I::Line, S::Ready),
    (S::Ready, I::Closed, S::Offline),
    (S::Ready, I::BoardReset, S::Connecting),
    (S::Ready, I::Killed, S::Halted),
    (S::Ready, I::GaveUp, S::Offline),
    //
    (S::Printing, I::Pause, S::Parking),
    (S::Printing, I::Held, S::Paused),
    (S::Printing, I::Cancel, S::Cancelling),
    (S::Printing, I::EmergencyStop, S::Halted),
    (S::Printing, I::Line, S::Printing),
    (S::Printing, I::Closed, S::Offline),
    (S::Printing, I::JobSent, S::Finishing),
    (S::Printing, I::BoardReset, S::Halted),
    (S::Printing, I::Fault, S::Halted),
    (S::Printing, I::Killed, S::Halted),
    (S::Printing, I::GaveUp, S::Offline),
    //
    (S::Finishing, I::Pause, S::Parking),
    (S::Finishing, I::Held, S::Paused),
    (S::Finishing, I::Cancel, S::Cancelling),
    (S::Finishing, I::EmergencyStop, S::Halted),
    (S::Finishing, I::Line, S::Finishing),
    (S::Finishing, I::Closed, S::Offline),
    (S::Finishing, I::JobConfirmed, S::Ready),
    (S::Finishing, I::BoardReset, S::Halted),
    (S::Finishing, I::Fault, S::Halted),
    (S::Finishing, I::Killed, S::Halted),
    (S::Finishing, I::GaveUp, S::Offline),
    //
    (S::Parking, I::Resume, S::Returning),
    (S::Parking, I::Cancel, S::Cancelling),
    (S::Parking, I::EmergencyStop, S::Halted),
    (S::Parking, I::Line, S::Parking),
    (S::Parking, I::Closed, S::Offline),
    (S::Parking, I::ScriptDone, S::Paused),
    (S::Parking, I::BoardReset, S::Halted),
    (S::Parking, I::Fault, S::Halted),
    (S::Parking, I::Killed, S::Halted),
    (S::Parking, I::GaveUp, S::Offline),
    //
    (S::Paused, I::Resume, S::Returning),
    (S::Paused, I::Cancel, S::Cancelling),
    (S::Paused, I::EmergencyStop, S::Halted),
    (S::Paused, I::Line, S::Paused),
    (S::Paused, I::Closed, S::Offline),
    (S::Paused, I::BoardReset, S::Halted),
    (S::Paused, I::Fault, S::Halted),
    (S::Paused, I::Killed, S::Halted),
    (S::Paused, I::GaveUp, S::Offline),
    //
    (S::Returning, I::Pause, S::Parking),
    (S::Returning, I::Held, S::Parking),
    (S::Returning, I::Cancel, S::Cancelling),
    (S::Returning, I::EmergencyStop, S::Halted),
    (S::Returning, I::Line, S::Returning),
    (S::Returning, I::Closed, S::Offline),
    (S::Returning, I::ScriptDone, S::Printing),
    (S::Returning, I::BoardReset, S::Halted),
    (S::Returning, I::Fault, S::Halted),
    (S::Returning, I::Killed, S::Halted),
    (S::Returning, I::GaveUp, S::Offline),
    //
    (S::Cancelling, I::EmergencyStop, S::Halted),
    (S::Cancelling, I::Closed, S::Offline),
    (S::Cancelling, I::ScriptDone, S::Ready),
    (S::Cancelling, I::BoardReset, S::Halted),
    (S::Cancelling, I::Fault, S::Halted),
    (S::Cancelling, I::Killed, S::Halted),
    (S::Cancelling, I::GaveUp, S::Offline),
    //
    (S::Halted, I::Connect, S::Connecting),
    (S::Halted, I::EmergencyStop, S::Halted),
    (S::Halted, I::Closed, S::Offline),
];

impl State {
    /// The next state, or `None` where the table has no row.
    pub fn after(self, input: Input) -> Option<State> {
        TABLE.iter().find(|(from, by, _)| *from == self && *by == input).map(|(_, _, to)| *to)
    }

    /// A job is under way: it prints, waits, finishes or is being dropped.
    pub fn has_job(self) -> bool {
        match self {
            S::Printing | S::Finishing | S::Parking | S::Paused | S::Returning | S::Cancelling => true,
            S::Offline | S::Connecting | S::Ready | S::Halted => false,
        }
    }

    /// Lines may go out.
    pub(super) fn is_linked(self) -> bool {
        self == S::Connecting || self == S::Ready || self.has_job()
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            S::Offline => "not connected",
            S::Connecting => "connecting",
            S::Ready => "ready",
            S::Printing => "printing",
            S::Finishing => "finishing",
            S::Parking => "parking",
            S::Paused => "paused",
            S::Returning => "returning to the part",
            S::Cancelling => "cancelling",
            S::Halted => "halted",
        })
    }
}

/// Our own mistake: a command that cannot be taken. Nothing was sent and nothing changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CommandError {
    /// The state has no row for this command in [`TABLE`].
    WrongState {
        /// What was asked.
        input: Input,
        /// Where the machine stands.
        state: State,
    },
    /// The line cannot be sent.
    BadLine(LineFault),
    /// The text holds no command: blank or a comment.
    NothingToSend,
    /// `M110` from outside would break the numbering of lines.
    Numbering,
    /// A percentage outside 10 to 999.
    OutOfRange {
        /// What was asked, percent.
        percent: u32,
    },
    /// Too many lines wait already.
    TooManyWaiting,
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CommandError::WrongState { input, state } => {
                write!(f, "{input:?} is not possible while the printer is {state}")
            }
            CommandError::BadLine(fault) => write!(f, "the line cannot be sent: {fault}"),
            CommandError::NothingToSend => f.write_str("there is no command in this line"),
            CommandError::Numbering => f.write_str("line numbers (M110) are set by the link itself"),
            CommandError::OutOfRange { percent } => write!(f, "{percent} % is outside 10 to 999 %"),
            CommandError::TooManyWaiting => f.write_str("too many lines are waiting to be sent"),
        }
    }
}

impl std::error::Error for CommandError {}

/// Why a job or the link ended before its time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum StopReason {
    /// By the user.
    Cancelled,
    /// By `//action:cancel`.
    CancelledByPrinter,
    /// `M112` by the user.
    EmergencyStop,
    /// `M112` in the job.
    EmergencyInJob {
        /// Index of the line in the job, from 0.
        line: u64,
    },
    /// The board started anew.
    BoardReset,
    /// An `Error:` or `!!` of the printer.
    PrinterError {
        /// What the printer said.
        message: String,
    },
    /// A line was asked for that is not kept any more, or was never sent.
    ResendImpossible {
        /// Number of the line asked for.
        asked: u32,
        /// First number still kept.
        first: u32,
        /// Last number sent.
        last: u32,
    },
    /// The same line was sent again and again and never arrived.
    ResendLoop {
        /// Number of the line.
        number: u32,
        /// How often it was sent.
        times: u32,
    },
    /// A line of the job cannot be sent.
    BadJobLine {
        /// Index of the line in the job, from 0.
        line: u64,
        /// What is wrong with it.
        fault: LineFault,
    },
    /// No answer to the handshake.
    NoGreeting,
    /// No answer to lines and probes.
    NoAnswer,
    /// The port was closed or the cable pulled.
    PortClosed,
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StopReason::Cancelled => f.write_str("The print was cancelled."),
            StopReason::CancelledByPrinter => f.write_str("The print was cancelled at the printer."),
            StopReason::EmergencyStop => {
                f.write_str("Emergency stop. The printer has to be reset before it prints again.")
            }
            StopReason::EmergencyInJob { line } => write!(
                f,
                "Line {} of the file is an emergency stop (M112). The printer has to be reset.",
                line + 1
            ),
            StopReason::BoardReset => f.write_str(
                "The printer restarted by itself and forgot where it was. Often that is the power supply \
                 or the USB cable.",
            ),
            StopReason::PrinterError { message } => write!(f, "The printer reported: {message}"),
            StopReason::ResendImpossible { asked, first, last } => write!(
                f,
                "The printer asked for line {asked} again; only lines {first} to {last} are at hand. \
                 Going on would print something else."
            ),
            StopReason::ResendLoop { number, times } => write!(
                f,
                "Line {number} was sent {times} times and never arrived whole. Check the USB cable."
            ),
            StopReason::BadJobLine { line, fault } => {
                write!(f, "Line {} of the file cannot be sent: {fault}.", line + 1)
            }
            StopReason::NoGreeting => f.write_str(
                "Nothing that answers like a printer. Wrong speed (baud rate) or wrong port, perhaps.",
            ),
            StopReason::NoAnswer => f.write_str("The printer stopped answering."),
            StopReason::PortClosed => {
                f.write_str("The connection was closed: cable pulled, or printer switched off.")
            }
        }
    }
}

/// Why a job waits.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", content = "text", rename_all = "snake_case")]
pub enum PauseReason {
    /// The user asked.
    User,
    /// The printer asked (`//action:pause`, `//action:paused`).
    Printer,
    /// `M0` or `M1` in the job, with its text.
    Job(String),
}

impl fmt::Display for PauseReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PauseReason::User => f.write_str("Paused."),
            PauseReason::Printer => f.write_str("Paused by the printer."),
            PauseReason::Job(text) if text.is_empty() => f.write_str("Paused by the file."),
            PauseReason::Job(text) => write!(f, "Paused by the file: {text}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_state_and_input_have_two_rows() {
        for (i, a) in TABLE.iter().enumerate() {
            for b in &TABLE[i + 1..] {
                assert!((a.0, a.1) != (b.0, b.1), "{:?} {:?} twice", a.0, a.1);
            }
        }
    }

    #[test]
    fn the_emergency_stop_leads_to_halted_from_every_linked_state() {
        for (from, _, _) in TABLE {
            if from.is_linked() {
                assert_eq!(from.after(I::EmergencyStop), Some(S::Halted), "{from:?}");
                assert_eq!(from.after(I::Closed), Some(S::Offline), "{from:?}");
            }
        }
    }

    #[test]
    fn a_board_reset_never_leaves_a_job_running() {
        for (from, input, to) in TABLE {
            if *input == I::BoardReset && from.has_job() {
                assert_eq!(*to, S::Halted, "{from:?}");
            }
        }
    }

    #[test]
    fn nothing_leads_from_halted_to_a_job() {
        for (from, _, to) in TABLE {
            assert!(*from != S::Halted || !to.has_job());
        }
    }
}
