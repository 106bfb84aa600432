//! The simulated printer of the tests as wasm: the browser tests put it behind a stand-in for
//! `navigator.serial`. No part of the product.
#![cfg(target_arch = "wasm32")]

#[path = "../tests/common/printer_sim.rs"]
mod printer_sim;

use std::time::Duration;

use printer_sim::{Fate, SimOptions, SimPrinter, fate, faulty_printer};
use wasm_bindgen::prelude::*;

/// The simulated printer; times in ms.
#[wasm_bindgen]
pub struct Sim {
    inner: SimPrinter,
}

#[wasm_bindgen]
impl Sim {
    /// Without faults: `move_ms` for a move, `heat_rate` degrees a second.
    pub fn good(move_ms: f64, heat_rate: f64, advanced_ok: bool) -> Sim {
        let latency = if move_ms > 0.0 { Duration::from_millis(1) } else { Duration::ZERO };
        let options = SimOptions {
            move_time: time(move_ms),
            latency,
            heat_rate,
            advanced_ok,
            autoreport: true,
            ..SimOptions::default()
        };
        Sim { inner: SimPrinter::new(options) }
    }

    /// With the mixed faults of a seed, as in `tests/printer_link.rs`, in a job of so many moves.
    pub fn faulty(seed: u32, moves: usize) -> Sim {
        Sim { inner: SimPrinter::new(faulty_printer(u64::from(seed), moves)) }
    }

    /// Takes what the host wrote.
    pub fn write(&mut self, now: f64, bytes: &[u8]) {
        self.inner.write(time(now), bytes);
    }

    /// Lives up to now, and gives what has come out.
    pub fn read(&mut self, now: f64) -> Vec<u8> {
        self.inner.advance(time(now));
        self.inner.read(time(now))
    }

    /// When something happens next.
    pub fn next_event(&self) -> Option<f64> {
        self.inner.next_event().map(|at| at.as_secs_f64() * 1000.0)
    }

    /// The board starts anew.
    pub fn power_on(&mut self) {
        self.inner.power_on();
    }

    /// Puts a line on the way to the host.
    pub fn say(&mut self, line: &str) {
        self.inner.say(line);
    }

    /// Numbered commands taken, one a line.
    pub fn accepted(&self) -> String {
        self.inner.accepted.join("\n")
    }

    /// `M112` has stopped it.
    pub fn halted(&self) -> bool {
        self.inner.halted
    }

    /// Job moves taken.
    pub fn moves(&self) -> usize {
        self.inner.moves
    }

    /// Bytes that found the receive buffer full.
    pub fn overruns(&self) -> usize {
        self.inner.overruns
    }

    /// The most bytes that waited in the receive buffer.
    pub fn fullest(&self) -> usize {
        self.inner.fullest
    }
}

/// What the run of a seed is meant to end with.
#[wasm_bindgen]
pub fn fate_of(seed: u32) -> String {
    match fate(u64::from(seed)) {
        Fate::Finish => "finish",
        Fate::Reset => "reset",
        Fate::Hang => "hang",
        Fate::Error => "error",
        Fate::Unplug => "unplug",
    }
    .to_owned()
}

fn time(ms: f64) -> Duration {
    Duration::try_from_secs_f64(ms / 1000.0).unwrap_or_default()
}
