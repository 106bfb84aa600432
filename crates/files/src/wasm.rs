//! What the module exports to JavaScript; compiled for wasm32 only.

use js_sys::Error;
use wasm_bindgen::prelude::*;

use crate::{FileError, Part};

fn thrown(name: &str, cause: &FileError) -> JsValue {
    let error = Error::new(&cause.to_string());
    error.set_name(name);
    error.into()
}

/// The parts of a model file.
#[wasm_bindgen]
pub struct Parts {
    inner: Vec<Part>,
}

#[wasm_bindgen]
impl Parts {
    /// Reads a 3MF or OBJ file. Throws a `ModelError`.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, bytes: &[u8]) -> Result<Parts, JsValue> {
        let inner = crate::read_model(name, bytes).map_err(|e| thrown("ModelError", &e))?;
        Ok(Parts { inner })
    }

    /// Number of parts.
    pub fn count(&self) -> usize {
        self.inner.len()
    }

    /// Name of a part in the file; empty if it has none.
    pub fn name(&self, index: usize) -> String {
        self.inner.get(index).map(|p| p.name.clone()).unwrap_or_default()
    }

    /// A part as binary STL, mm. The part is given up: only the first call has it.
    pub fn stl(&mut self, index: usize) -> Vec<u8> {
        self.inner.get_mut(index).map(|p| crate::stl::binary(&std::mem::take(p))).unwrap_or_default()
    }
}

/// A profile of another slicer, as JSON (`Imported`). Throws a `SettingsError`.
#[wasm_bindgen]
pub fn import_profile(bytes: &[u8]) -> Result<String, JsValue> {
    let imported = crate::import(bytes).map_err(|e| thrown("SettingsError", &e))?;
    serde_json::to_string(&imported).map_err(|e| Error::new(&e.to_string()).into())
}
