//! Errors and settings between Rust and JavaScript.

use std::fmt::Display;

use glam::DMat4;
use js_sys::Error;
use wasm_bindgen::prelude::*;

use crate::mesh::StlError;
use crate::orientation::OrientationError;
use crate::pipeline::{FitError, JobError};
use crate::printer::CommandError;
use crate::settings::{OwnSettings, Settings, SettingsError};

/// A JavaScript error on its way out.
#[derive(Debug)]
pub struct Thrown(Error);

impl From<Thrown> for JsValue {
    fn from(thrown: Thrown) -> JsValue {
        thrown.0.into()
    }
}

fn thrown(name: &str, cause: impl Display) -> Thrown {
    let error = Error::new(&cause.to_string());
    error.set_name(name);
    Thrown(error)
}

/// A file that cannot be read or used.
pub(super) fn model_error(cause: StlError) -> Thrown {
    thrown("ModelError", cause)
}

/// Settings that cannot be used.
pub(super) fn settings_error(cause: SettingsError) -> Thrown {
    thrown("SettingsError", cause)
}

/// A wrong argument from the page or the command line.
pub(super) fn usage_error(cause: impl Display) -> Thrown {
    thrown("UsageError", cause)
}

/// A fault of this program.
pub(super) fn internal_error(cause: impl Display) -> Thrown {
    thrown("InternalError", cause)
}

/// A model that no orientation can be proposed for.
pub(super) fn orientation_error(cause: OrientationError) -> Thrown {
    let name = if matches!(cause, OrientationError::Options(_)) { "SettingsError" } else { "ModelError" };
    thrown(name, cause)
}

/// A job that cannot be done.
pub(super) fn job_error(cause: JobError) -> Thrown {
    let name = match cause {
        JobError::Fit(_) | JobError::Sequence(_) => "FitError",
        JobError::Empty | JobError::Orientation(_) => "ModelError",
        JobError::Gcode(_)
        | JobError::Adhesion(_)
        | JobError::Support(_)
        | JobError::Tools(_)
        | JobError::OwnSettings { .. } => "SettingsError",
        JobError::LayerMissing { .. } => "InternalError",
    };
    thrown(name, cause)
}

/// A command that the printer's state does not allow.
pub(super) fn command_error(cause: CommandError) -> Thrown {
    thrown("CommandError", cause)
}

/// Parts that do not fit the printer.
pub(super) fn fit_error(cause: FitError) -> Thrown {
    thrown("FitError", cause)
}

/// Matrices from 16 numbers each, column by column.
pub(super) fn matrices_from(numbers: &[f64]) -> Result<Vec<DMat4>, Thrown> {
    let columns = numbers.chunks(16).map(|it| it.try_into().map(|it| DMat4::from_cols_array(&it)));
    columns.collect::<Result<_, _>>().map_err(|_| usage_error("a matrix has 16 numbers"))
}

/// One matrix from 16 numbers, column by column.
pub(super) fn matrix_from(numbers: &[f64]) -> Result<DMat4, Thrown> {
    matrices_from(numbers)?.first().copied().ok_or_else(|| usage_error("a matrix has 16 numbers"))
}

/// Settings from JSON.
pub(super) fn settings_from(json: &str) -> Result<Settings, Thrown> {
    Settings::resolve([json], []).map_err(settings_error)
}

/// A model's own settings from JSON.
pub(super) fn own_from(json: &str) -> Result<OwnSettings, Thrown> {
    OwnSettings::resolve([json], []).map_err(settings_error)
}

#[wasm_bindgen]
extern "C" {
    /// The engine's clock, ms; windows, workers and Node have it.
    #[wasm_bindgen(js_namespace = performance)]
    pub(super) fn now() -> f64;
}
