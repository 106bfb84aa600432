//! Moves for the picture in space.

use wasm_bindgen::prelude::*;

use super::convert::settings_from;
use super::error::{Thrown, internal_error};
use crate::gcode::filament_area;
use crate::region::Role;
use crate::view;

/// The moves of some layers as flat arrays; each is handed over, so only its first call has it.
#[wasm_bindgen]
pub struct Moves {
    inner: view::Moves,
}

#[wasm_bindgen]
impl Moves {
    /// Reads the G-code of some layers; `settings` is JSON and tells the filament.
    pub fn read(gcode: &[u8], settings: &str) -> Result<Moves, Thrown> {
        let settings = settings_from(settings)?;
        Ok(Moves { inner: view::Moves::read(gcode, filament_area(settings.filament.diameter)) })
    }

    /// Six numbers a move: x y z of its start and its end, mm.
    pub fn ends(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.inner.ends)
    }

    /// Two numbers a move: width and height of the bead, mm; width 0 is a travel.
    pub fn sizes(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.inner.sizes)
    }

    /// Position of each move's role in `role_names`; 255 for none.
    pub fn roles(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.inner.roles)
    }

    /// Speed of each move, mm/s.
    pub fn speeds(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.inner.speeds)
    }

    /// Plastic per time of each move, mm3/s.
    pub fn flows(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.inner.flows)
    }

    /// Duty of the fan at each move, 0 to 255.
    pub fn fans(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.inner.fans)
    }

    /// Tool of each move.
    pub fn tools(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.inner.tools)
    }

    /// Moves before the end of each layer.
    pub fn layers(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.inner.layers)
    }
}

/// Names and colours of all roles in the order that `Moves.roles` counts them, as a JSON list of
/// `{role, color}`.
#[wasm_bindgen]
pub fn role_colours() -> Result<String, Thrown> {
    let entry = |role: &Role| RoleColour { role: role.name(), color: view::Ink::Bead(*role).colour(false) };
    let all: Vec<RoleColour> = Role::ALL.iter().map(entry).collect();
    serde_json::to_string(&all).map_err(internal_error)
}

#[derive(serde::Serialize)]
struct RoleColour {
    role: &'static str,
    color: &'static str,
}
