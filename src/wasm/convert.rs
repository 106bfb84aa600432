//! Errors of the slicer, settings and matrices between Rust and JavaScript.

use glam::DMat4;
use wasm_bindgen::prelude::*;

use super::error::{Thrown, thrown, usage_error};
use crate::gcode::inspect::GcodeFileError;
use crate::mesh::StlError;
use crate::orientation::OrientationError;
use crate::pipeline::{FitError, JobError};
use crate::settings::{OwnSettings, Settings, SettingsError};

/// A file that cannot be read or used.
pub(super) fn model_error(cause: StlError) -> Thrown {
    thrown("ModelError", cause)
}

/// A G-code file that cannot be read.
pub(super) fn gcode_file_error(cause: GcodeFileError) -> Thrown {
    thrown("ModelError", cause)
}

/// Settings that cannot be used.
pub(super) fn settings_error(cause: SettingsError) -> Thrown {
    thrown("SettingsError", cause)
}

/// A model that no orientation can be proposed for.
pub(super) fn orientation_error(cause: OrientationError) -> Thrown {
    let name = if matches!(cause, OrientationError::Options(_)) { "SettingsError" } else { "ModelError" };
    thrown(name, cause)
}

/// A job that cannot be done.
pub(super) fn job_error(cause: JobError) -> Thrown {
    let name = match cause {
        JobError::Fit(cause) => return fit_error(cause),
        JobError::Sequence(_) => "FitError",
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

/// Parts that do not fit the printer; its `fix` is the change to every part, JSON, that would make them fit.
pub(super) fn fit_error(cause: FitError) -> Thrown {
    let fix = match &cause {
        FitError::TooLarge { hint, .. } => serde_json::to_string(&hint.edit()).ok(),
        FitError::Outside { .. } | FitError::Placement { .. } => None,
    };
    let thrown = thrown("FitError", cause);
    match fix {
        Some(fix) => thrown.with("fix", &fix),
        None => thrown,
    }
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
