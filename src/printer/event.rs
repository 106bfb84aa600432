//! What the link tells its owner.

use serde::Serialize;

use super::reply::Temperatures;
use super::state::{PauseReason, State, StopReason};

/// Something the page may want to show. Owned values only.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", content = "data", rename_all = "snake_case")]
pub enum Event {
    /// The state changed.
    State {
        /// Before.
        from: State,
        /// Now.
        to: State,
    },
    /// The handshake succeeded.
    Connected {
        /// The board started during the handshake: it kept no state from before.
        board_started: bool,
    },
    /// The printer told its name (`M115`).
    Firmware(Firmware),
    /// A temperature report.
    Temperatures(Temperatures),
    /// A line from the printer worth showing: everything but `ok`, resends, busy and temperatures.
    Message(String),
    /// An `Error:` that does not end anything.
    Warning(String),
    /// A line as sent, without its line feed ([`super::PrinterOptions::log_everything`]).
    Sent(String),
    /// A line as received ([`super::PrinterOptions::log_everything`]).
    Received(String),
    /// The job waits.
    Paused(PauseReason),
    /// The printer has accepted the whole job.
    Finished(Journal),
    /// A job or the link ended before its time. With a job, where it stands.
    Stopped {
        /// Why.
        reason: StopReason,
        /// The last acknowledged line, if there was a job.
        journal: Option<Journal>,
    },
}

/// How far a job got, to go on from there: what is kept when the tab is closed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Journal {
    /// Index of the last acknowledged line in the job, from 0, comments counted. `None` before the
    /// first. A job goes on at this line plus one.
    pub acked_line: Option<u64>,
    /// Height after that line, mm, if the job told one.
    pub z: Option<f64>,
    /// Layers begun by then: 0 before the first `;LAYER_CHANGE`.
    pub layer: u32,
}

/// What `M115` tells.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Firmware {
    /// `FIRMWARE_NAME`.
    pub name: String,
    /// `MACHINE_TYPE`, the printer's own name.
    pub machine: Option<String>,
    /// It reads macros: Klipper, RepRapFirmware.
    pub macros: bool,
    /// `Cap:AUTOREPORT_TEMP`: temperatures come by `M155`.
    pub autoreport_temperature: bool,
    /// `Cap:EMERGENCY_PARSER`: `M112`, `M108`, `M410` are read past the queue.
    pub emergency_parser: bool,
}

/// Counters since the handshake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Lines sent, those sent again included.
    pub sent: u64,
    /// Requests of the printer to send again.
    pub resends: u64,
    /// Overlong reply lines thrown away.
    pub dropped_replies: u64,
    /// Free places of the planner, from a printer that tells (`ADVANCED_OK`).
    pub planner_free: Option<u32>,
    /// Lines held in memory now: kept for resends and in flight.
    pub held_lines: usize,
    /// Lines in flight now.
    pub in_flight: u32,
}
