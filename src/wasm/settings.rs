//! Settings as JSON, and the engine's version.

use wasm_bindgen::prelude::*;

use super::convert::settings_error;
use super::error::Thrown;
use crate::settings::{OwnSettings, Settings};

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
