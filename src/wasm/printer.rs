//! The serial link for the page: times in ms of its clock, events and journal as JSON.

use std::time::Duration;

use js_sys::{Function, Uint8Array};
use wasm_bindgen::prelude::*;

use super::error::{Thrown, internal_error, thrown, usage_error};
use crate::printer::{self, CommandError, JobLines, JobStart, PrinterOptions};

/// The host's side of a serial link; the contract is that of the engine's type of this name.
#[wasm_bindgen]
pub struct Printer {
    inner: printer::Printer,
}

#[wasm_bindgen]
impl Printer {
    /// A link that is not connected. `handshake_tries`, each 2 s, before it gives up.
    #[wasm_bindgen(constructor)]
    pub fn new(handshake_tries: Option<u32>) -> Result<Printer, Thrown> {
        let usual = PrinterOptions::default();
        let handshake_tries = handshake_tries.unwrap_or(usual.handshake_tries);
        let options = PrinterOptions { handshake_tries, ..usual };
        Ok(Printer { inner: printer::Printer::new(options).map_err(internal_error)? })
    }

    /// Takes bytes from the port.
    pub fn handle_bytes(&mut self, now: f64, bytes: &[u8]) {
        self.inner.handle_bytes(time(now), bytes);
    }

    /// Does what is due.
    pub fn handle_timeout(&mut self, now: f64) {
        self.inner.handle_timeout(time(now));
    }

    /// The port is closed or gone.
    pub fn handle_closed(&mut self, now: f64) {
        self.inner.handle_closed(time(now));
    }

    /// The next bytes to write.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.inner.poll_transmit()
    }

    /// All events since the last call, a JSON list of `Event`; undefined where there are none.
    pub fn poll_events(&mut self) -> Result<Option<String>, Thrown> {
        let events: Vec<printer::Event> = std::iter::from_fn(|| self.inner.poll_event()).collect();
        if events.is_empty() {
            return Ok(None);
        }
        serde_json::to_string(&events).map(Some).map_err(internal_error)
    }

    /// When the next deadline is.
    pub fn poll_timeout(&self) -> Option<f64> {
        self.inner.poll_timeout().map(|at| at.as_secs_f64() * 1000.0)
    }

    /// Begins the handshake. Throws a `CommandError`, as do the others below, where the state does not allow it.
    pub fn connect(&mut self, now: f64) -> Result<(), Thrown> {
        self.inner.connect(time(now)).map_err(command_error)
    }

    /// Prints a job from a line on, without any preparation. `pull` gives the next piece of its text as
    /// a `Uint8Array`, undefined at the end.
    pub fn start(&mut self, now: f64, pull: Function, first_line: f64) -> Result<(), Thrown> {
        let start = JobStart { first_line: first_line as u64, ..JobStart::new(lines(pull)) };
        self.inner.start(time(now), start).map_err(command_error)
    }

    /// Prints a job from a layer (from 0) on, on a board that forgot everything while the nozzle stands at
    /// height `z`, mm; `purge` mm of filament fill it again.
    pub fn start_at_layer(
        &mut self,
        now: f64,
        pull: Function,
        outline: &Outline,
        layer: usize,
        z: f64,
        purge: f64,
    ) -> Result<(), Thrown> {
        let begin = outline.inner.layers.get(layer).ok_or_else(|| usage_error("there is no such layer"))?;
        let prelude = begin.heat.restart_lines(z, purge);
        let start = JobStart { lines: lines(pull), first_line: begin.line, prelude, restore: true };
        self.inner.start(time(now), start).map_err(command_error)
    }

    /// Pauses and parks.
    pub fn pause(&mut self, now: f64) -> Result<(), Thrown> {
        self.inner.pause(time(now)).map_err(command_error)
    }

    /// Goes on.
    pub fn resume(&mut self, now: f64) -> Result<(), Thrown> {
        self.inner.resume(time(now)).map_err(command_error)
    }

    /// Drops the job and cools down.
    pub fn cancel(&mut self, now: f64) -> Result<(), Thrown> {
        self.inner.cancel(time(now)).map_err(command_error)
    }

    /// `M112` in the very next write.
    pub fn emergency_stop(&mut self, now: f64) -> Result<(), Thrown> {
        self.inner.emergency_stop(time(now)).map_err(command_error)
    }

    /// Sends one command.
    pub fn send_line(&mut self, now: f64, text: &str) -> Result<(), Thrown> {
        self.inner.send_line(time(now), text).map_err(command_error)
    }

    /// Speed of the moves, percent.
    pub fn set_speed(&mut self, now: f64, percent: u32) -> Result<(), Thrown> {
        self.inner.set_speed(time(now), percent).map_err(command_error)
    }

    /// Flow of the extruder, percent.
    pub fn set_flow(&mut self, now: f64, percent: u32) -> Result<(), Thrown> {
        self.inner.set_flow(time(now), percent).map_err(command_error)
    }

    /// Whether every line sent and received is told.
    pub fn log_everything(&mut self, on: bool) {
        self.inner.log_everything(on);
    }

    /// The last acknowledged line, JSON (`Journal`).
    pub fn journal(&self) -> Result<String, Thrown> {
        serde_json::to_string(&self.inner.journal()).map_err(internal_error)
    }

    /// Requests to send again since the handshake.
    pub fn resends(&self) -> f64 {
        self.inner.statistics().resends as f64
    }
}

/// What a job holds, read once.
#[wasm_bindgen]
pub struct Outline {
    inner: printer::Outline,
}

#[wasm_bindgen]
impl Outline {
    /// Reads the whole text; `pull` as for `Printer.start`.
    #[wasm_bindgen(constructor)]
    pub fn new(pull: Function) -> Outline {
        Outline { inner: printer::Outline::of(lines(pull)) }
    }

    /// As JSON (`Outline`).
    pub fn json(&self) -> Result<String, Thrown> {
        serde_json::to_string(&self.inner).map_err(internal_error)
    }
}

fn time(ms: f64) -> Duration {
    Duration::try_from_secs_f64(ms / 1000.0).unwrap_or_default()
}

/// What `pull` throws ends the lines as their end does: whoever gave `pull` has to notice and cancel.
fn lines(pull: Function) -> JobLines {
    Box::new(printer::lines_of(move || {
        let piece = pull.call0(&JsValue::NULL).ok()?;
        piece.dyn_into::<Uint8Array>().ok().map(|piece| piece.to_vec())
    }))
}

/// A command that the printer's state does not allow.
fn command_error(cause: CommandError) -> Thrown {
    thrown("CommandError", cause)
}
