//! What the engine exports to JavaScript; compiled for wasm32 only. Each export converts and calls.
//!
//! Errors are thrown as `Error` objects with a stable `name` (`convert.rs`). After a panic the
//! instance must not be used again.

mod canvas;
mod convert;
mod job;
mod model;
mod moves;
mod printer;
mod scene;
mod study;

pub use convert::Thrown;
pub use job::{Chunk, Job, JobResult, slice_share};
pub use model::{Model, ModelReader, SharedMesh, arrange_parts, parts_picture};
pub use moves::{Moves, role_colours};
pub use printer::{Outline, Printer};
pub use scene::Scene;
pub use study::orientation_lesson;

use wasm_bindgen::prelude::*;

use crate::settings::{OwnSettings, Settings};
use convert::settings_error;

#[wasm_bindgen(start)]
fn start() {
    console_error_panic_hook::set_once();
}

/// Version of the engine.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// All settings with their defaults, as JSON.
#[wasm_bindgen]
pub fn default_settings() -> String {
    Settings::default().to_json()
}

/// Defaults, changed by JSON texts in turn and then by assignments `path=value`; as JSON. Throws a
/// `SettingsError` that names the setting's path.
#[wasm_bindgen]
pub fn resolve_settings(files: Vec<String>, sets: Vec<String>) -> Result<String, Thrown> {
    let settings = Settings::resolve(files.iter().map(String::as_str), sets.iter().map(String::as_str));
    Ok(settings.map_err(settings_error)?.to_json())
}

/// A model's own settings as JSON, from texts and `path=value` words like `resolve_settings`, without
/// those of the plate. Throws a `SettingsError`.
#[wasm_bindgen]
pub fn resolve_own(files: Vec<String>, sets: Vec<String>) -> Result<String, Thrown> {
    let own = OwnSettings::resolve(files.iter().map(String::as_str), sets.iter().map(String::as_str));
    Ok(own.map_err(settings_error)?.to_json())
}
