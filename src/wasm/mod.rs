//! What is exported to JavaScript; compiled for wasm32 only. Each export converts and calls.
//!
//! There are two modules: the slicer (feature `slicer`) and the serial protocol (feature `link`). Errors
//! are thrown as `Error` objects with a stable `name` (`error.rs`). After a panic the instance must not
//! be used again.

#[cfg(feature = "slicer")]
mod canvas;
#[cfg(feature = "slicer")]
mod convert;
mod error;
#[cfg(feature = "slicer")]
mod gcode;
#[cfg(feature = "slicer")]
mod job;
#[cfg(feature = "slicer")]
mod model;
#[cfg(feature = "slicer")]
mod moves;
#[cfg(feature = "link")]
mod printer;
#[cfg(feature = "slicer")]
mod scene;
#[cfg(feature = "slicer")]
mod settings;
#[cfg(feature = "slicer")]
mod study;

pub use error::Thrown;
#[cfg(feature = "slicer")]
pub use gcode::{GcodeFile, GcodeReader};
#[cfg(feature = "slicer")]
pub use job::{Chunk, Job, JobResult, slice_share};
#[cfg(feature = "slicer")]
pub use model::{Model, ModelReader, SharedMesh, arrange_parts, parts_picture};
#[cfg(feature = "slicer")]
pub use moves::{Moves, role_colours};
#[cfg(feature = "link")]
pub use printer::{Outline, Printer};
#[cfg(feature = "slicer")]
pub use scene::Scene;
#[cfg(feature = "slicer")]
pub use settings::{default_settings, resolve_own, resolve_settings, version};

use wasm_bindgen::prelude::*;

#[wasm_bindgen(start)]
fn start() {
    console_error_panic_hook::set_once();
}
