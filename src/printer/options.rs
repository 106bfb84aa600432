//! Times, sizes and scripts of the link.

use std::time::Duration;

/// How the link behaves. The defaults fit Marlin and its relatives.
#[derive(Debug, Clone, PartialEq)]
pub struct PrinterOptions {
    /// Wait for an answer to the handshake before it begins anew. Default 2 s: some boards start up
    /// that long when the port opens.
    pub handshake_wait: Duration,
    /// How often the handshake is tried. Default 8.
    pub handshake_tries: u32,
    /// Wait for the `ok` that follows a resend, and for an answer in doubt. Default 0.5 s.
    pub resend_wait: Duration,
    /// How often one line is sent again before the job stops. Default 25.
    pub resend_limit: u32,
    /// Silence before the first probe. Default 30 s.
    pub silence: Duration,
    /// Silence before the first probe in commands that take long (G28, G29, M109, M190, M400 and their
    /// kin), from a printer that does not say `busy` in them. Default 5 min.
    pub long_silence: Duration,
    /// Time between probes. Default 10 s.
    pub probe_interval: Duration,
    /// Unanswered probes that mean lost. Default 5; four times as many while anything else comes in, and
    /// four times as many in commands that take long.
    pub probe_misses: u32,
    /// How often temperatures are asked for or reported. Default 2 s; whole seconds for `M155`.
    pub temperature_interval: Duration,
    /// How often `M105` checks the count of lines while a job runs and the printer reports
    /// temperatures by itself. Default 10 s.
    pub count_check_interval: Duration,
    /// How long begin and end of a job wait for the answer to the `M105` that proves the count of lines,
    /// before they ask again; after three times a plain `ok` counts. Default 2 s.
    pub proof_wait: Duration,
    /// The firmware's receive buffer, bytes. Default 127: the 128 of an 8-bit board hold one less. Never
    /// more is in flight.
    pub receive_buffer: usize,
    /// The firmware's line buffer, bytes, with number, checksum and line feed. Default 96.
    pub max_line: usize,
    /// Lines in flight at most, where the printer reports `ADVANCED_OK`. Default 8.
    pub max_in_flight: u32,
    /// Acknowledged lines kept for a resend. Default 128; fewer than 100 are taken as 100.
    pub keep_lines: usize,
    /// Lines of a pause. Default: pull the filament, lift, go to the corner.
    pub park_lines: Vec<String>,
    /// Lines of a resume; `{x}`, `{y}`, `{z}` are where the job left off. Modes, extruder and speed are
    /// put back by the link after them. Default: back over the part, down, push the filament.
    pub return_lines: Vec<String>,
    /// Lines of a cancel. Default: heaters and fan off, lift, motors off.
    pub cancel_lines: Vec<String>,
    /// Lines sent without number after a fault, unasked and unanswered. Default: heaters off.
    pub fault_lines: Vec<String>,
    /// Tell every line sent and received as an event, `ok`s too. Default off.
    pub log_everything: bool,
}

impl Default for PrinterOptions {
    fn default() -> PrinterOptions {
        let lines = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect();
        PrinterOptions {
            handshake_wait: Duration::from_secs(2),
            handshake_tries: 8,
            resend_wait: Duration::from_millis(500),
            resend_limit: 25,
            silence: Duration::from_secs(30),
            long_silence: Duration::from_secs(5 * 60),
            probe_interval: Duration::from_secs(10),
            probe_misses: 5,
            temperature_interval: Duration::from_secs(2),
            count_check_interval: Duration::from_secs(10),
            proof_wait: Duration::from_secs(2),
            receive_buffer: 127,
            max_line: 96,
            max_in_flight: 8,
            keep_lines: 128,
            park_lines: lines(&["M83", "G1 E-2 F2400", "G91", "G1 Z5 F600", "G90", "G1 X0 Y0 F6000"]),
            return_lines: lines(&["G90", "G1 X{x} Y{y} F6000", "G1 Z{z} F600", "M83", "G1 E2 F2400"]),
            cancel_lines: lines(&["M104 S0", "M140 S0", "M107", "G91", "G1 Z5 F600", "G90", "M84"]),
            fault_lines: lines(&["M104 S0", "M140 S0"]),
            log_everything: false,
        }
    }
}
