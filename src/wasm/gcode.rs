//! G-code files of any slicer.

use wasm_bindgen::prelude::*;

use super::convert::{gcode_file_error, settings_from};
use super::error::{Thrown, internal_error};
use crate::gcode::inspect::{InspectedGcode, Inspector};

/// Reads a G-code file from chunks of any size.
#[wasm_bindgen]
pub struct GcodeReader {
    inner: Inspector,
}

#[wasm_bindgen]
impl GcodeReader {
    /// A reader; `settings` is JSON and tells the filament where the file does not.
    #[wasm_bindgen(constructor)]
    pub fn new(settings: &str) -> Result<GcodeReader, Thrown> {
        Ok(GcodeReader { inner: Inspector::new(settings_from(settings)?.filament) })
    }

    /// Takes the next bytes of the file. Throws a `ModelError`.
    pub fn push(&mut self, chunk: &[u8]) -> Result<(), Thrown> {
        self.inner.push(chunk).map_err(gcode_file_error)
    }

    /// The file, after the last chunk. Throws a `ModelError`.
    pub fn finish(self) -> Result<GcodeFile, Thrown> {
        Ok(GcodeFile { inner: self.inner.finish().map_err(gcode_file_error)? })
    }
}

/// A G-code file.
#[wasm_bindgen]
pub struct GcodeFile {
    inner: InspectedGcode,
}

#[wasm_bindgen]
impl GcodeFile {
    /// The figures, as JSON (`GcodeFigures`).
    pub fn figures(&self) -> Result<String, Thrown> {
        serde_json::to_string(&self.inner.figures).map_err(internal_error)
    }

    /// The byte at which each layer begins.
    pub fn offsets(&self) -> Vec<f64> {
        self.inner.layers.iter().map(|layer| layer.offset as f64).collect()
    }

    /// For each layer the G-code to be read before it when it is read alone.
    pub fn heads(&self) -> Vec<String> {
        self.inner.layers.iter().map(|layer| layer.head.clone()).collect()
    }

    /// Seconds that each layer takes.
    pub fn times(&self) -> Vec<f64> {
        self.inner.layers.iter().map(|layer| layer.time_s).collect()
    }
}
