//! Reading and looking at models.

use wasm_bindgen::prelude::*;

use super::convert::{Thrown, internal_error, model_error, now, orientation_error, settings_from};
use super::scene::Scene;
use crate::mesh::{LoadedModel, StlReader};
use crate::orientation::orient;
use crate::view::{ModelPicture, Viewpoint};

/// Reads an STL file from chunks of any size.
#[wasm_bindgen]
pub struct ModelReader {
    inner: StlReader,
    busy_ms: f64,
}

#[wasm_bindgen]
impl ModelReader {
    /// A reader of a file of `expected_bytes`, where that is known.
    #[wasm_bindgen(constructor)]
    pub fn new(expected_bytes: Option<f64>) -> ModelReader {
        let inner = expected_bytes.map_or_else(StlReader::new, |bytes| StlReader::with_size(bytes as u64));
        ModelReader { inner, busy_ms: 0.0 }
    }

    /// Takes the next bytes of the file. Throws a `ModelError`.
    pub fn push(&mut self, chunk: &[u8]) -> Result<(), Thrown> {
        let started = now();
        let pushed = self.inner.push(chunk).map_err(model_error);
        self.busy_ms += now() - started;
        pushed
    }

    /// The model, after the last chunk: welded, checked and repaired. Throws a `ModelError`.
    pub fn finish(self) -> Result<Model, Thrown> {
        let started = now();
        let parsed = self.inner.finish().map_err(model_error)?;
        let inner = LoadedModel::new(parsed).map_err(model_error)?;
        Ok(Model { inner, parse_ms: self.busy_ms + now() - started })
    }
}

/// A model ready to be sliced.
#[wasm_bindgen]
pub struct Model {
    pub(super) inner: LoadedModel,
    pub(super) parse_ms: f64,
}

#[wasm_bindgen]
impl Model {
    /// What was found in the file, as JSON (`Inspection`).
    pub fn inspect(&self) -> Result<String, Thrown> {
        serde_json::to_string(&self.inner.inspection).map_err(internal_error)
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.inner.mesh.triangles.len()
    }

    /// The model seen from "top", "front" or, with any other word, from the front left above.
    pub fn picture(&self, view: &str) -> Scene {
        let viewpoint = match view {
            "top" => Viewpoint::Top,
            "front" => Viewpoint::Front,
            _ => Viewpoint::Iso,
        };
        Scene::of_model(ModelPicture::new(&self.inner.mesh, viewpoint))
    }

    /// The six directions, sides of the hull and the choice, as JSON (`OrientationReport`);
    /// `settings` is JSON. Throws a `ModelError` or a `SettingsError`.
    pub fn orient(&self, settings: &str) -> Result<String, Thrown> {
        let options = settings_from(settings)?.orientation;
        let report = orient(&self.inner.mesh, &options, &mut |_, _| true).map_err(orientation_error)?;
        serde_json::to_string(&report).map_err(internal_error)
    }

    /// A copy of the model.
    pub fn clone_model(&self) -> Model {
        Model { inner: self.inner.clone(), parse_ms: self.parse_ms }
    }
}
