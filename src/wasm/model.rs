//! Reading and looking at models.

use glam::{DMat4, DVec3};
use wasm_bindgen::prelude::*;

use super::canvas::MODEL_TINT;
use super::convert::{
    fit_error, matrices_from, matrix_from, model_error, now, orientation_error, own_from, settings_error,
    settings_from,
};
use super::error::{Thrown, internal_error, usage_error};
use super::scene::Scene;
use super::study::orientation_steps;
use crate::mesh::transform::rotation_to_up;
use crate::mesh::{Box3, Edit, LoadedModel, Mesh, StlReader, bounds_under, edited};
use crate::orientation::{
    Direction, DirectionFigures, OrientationOptions, OrientationReport, candidates, choose, evaluate,
};
use crate::picture::{ModelPicture, Viewpoint};
use crate::pipeline::{self, NamedModel};
use crate::settings::Settings;
use crate::view::Paper;

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
        Ok(Model { inner, parse_ms: self.busy_ms + now() - started, oriented: None })
    }
}

/// A model ready to be sliced.
#[wasm_bindgen]
pub struct Model {
    pub(super) inner: LoadedModel,
    pub(super) parse_ms: f64,
    /// Its directions and the options that they were compared with.
    oriented: Option<(OrientationOptions, OrientationReport)>,
}

impl Model {
    /// The model for a job; directions that were compared in another way are of no use to it.
    pub(super) fn named(self, name: String, options: &OrientationOptions) -> NamedModel {
        let known = self.oriented.filter(|(compared, _)| compared == options);
        NamedModel { orientation: known.map(|(_, report)| report), ..NamedModel::new(name, self.inner) }
    }
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

    /// Vertices in the file's coordinates: xyz triples, mm.
    pub fn positions(&self) -> Vec<f32> {
        self.inner.mesh.vertices.iter().flat_map(|v| v.to_array()).collect()
    }

    /// Triangles: three vertices each, counter-clockwise seen from outside.
    pub fn indices(&self) -> Vec<u32> {
        self.inner.mesh.triangles.concat()
    }

    /// Where the model stands after a change, an `Edit` by its kind and its numbers: the matrix (16
    /// numbers, column by column) and the box around it (lowest x y z, highest x y z, mm). Throws a
    /// `UsageError`.
    pub fn edit(&self, placement: &[f64], kind: &str, numbers: &[f64]) -> Result<Vec<f64>, Thrown> {
        let edit = Edit::from_numbers(kind, numbers);
        let edit = edit.ok_or_else(|| usage_error(format!("{kind} {numbers:?}: there is no such change")))?;
        let mesh = &self.inner.mesh;
        let placed = edited(mesh, &matrix_from(placement)?, edit).map_err(usage_error)?;
        Ok(matrix_and_box(mesh, &placed))
    }

    /// The model with `up` (three numbers) turned up, seen from the front left above: RGBA pixels, row by
    /// row from the top, clear where nothing is seen.
    pub fn thumbnail(&self, up: &[f64], width: usize, height: usize) -> Result<Vec<u8>, Thrown> {
        let &[x, y, z] = up else { return Err(usage_error("up: three numbers are needed")) };
        let turn = rotation_to_up(DVec3::new(x, y, z).normalize_or(DVec3::Z));
        let turned = self.inner.mesh.transformed(&turn).map_err(internal_error)?;
        Ok(ModelPicture::new(&turned, Viewpoint::Iso).fitted(width, height, MODEL_TINT))
    }

    /// The directions to compare, x, y, z of the vector that points up for id 1, 2 and so on: the
    /// six axes, then sides of the hull. `all` as well those that may only be shown, not chosen.
    /// `settings` is JSON. Throws a `ModelError` or a `SettingsError`.
    pub fn directions(&self, settings: &str, all: bool) -> Result<Vec<f64>, Thrown> {
        let options = settings_from(settings)?.orientation;
        let options = if all { options } else { options.for_choice() };
        let found = candidates(&self.inner.mesh, &options).map_err(orientation_error)?;
        Ok(found.iter().flat_map(|d| d.up).collect())
    }

    /// Figures of one direction for `choose`.
    pub fn evaluate(&self, settings: &str, id: u32, up: &[f64]) -> Result<Vec<u8>, Thrown> {
        evaluated(&self.inner.mesh, settings, id, up)
    }

    /// Chooses among evaluated directions: the report as JSON (`OrientationReport`). A job of this
    /// model with the same settings turns it that way without comparing again.
    pub fn choose(&mut self, settings: &str, figures: Vec<js_sys::Uint8Array>) -> Result<String, Thrown> {
        let options = settings_from(settings)?.orientation;
        let figures = figures.iter().map(|bytes| postcard::from_bytes(&bytes.to_vec()));
        let figures: Vec<DirectionFigures> = figures.collect::<Result<_, _>>().map_err(internal_error)?;
        let report = choose(figures, &options).map_err(orientation_error)?;
        let text = serde_json::to_string(&report).map_err(internal_error)?;
        self.oriented = Some((options, report));
        Ok(text)
    }

    /// The steps of the lesson about orientation for what `choose` compared last, as JSON
    /// (`LessonStep[]`).
    pub fn orientation_lesson(&self, side: f64, dark: bool) -> Result<String, Thrown> {
        let (_, report) =
            self.oriented.as_ref().ok_or_else(|| usage_error("directions are not compared yet"))?;
        orientation_steps(report, Paper::inline(side, dark))
    }

    /// The model's triangles as bytes for a `SharedMesh` in another engine.
    pub fn share(&self) -> Result<Vec<u8>, Thrown> {
        postcard::to_allocvec(&self.inner.mesh).map_err(internal_error)
    }

    /// The matrix and the box of `edit`'s answer for a placement as it is.
    pub fn stand(&self, placement: &[f64]) -> Result<Vec<f64>, Thrown> {
        Ok(matrix_and_box(&self.inner.mesh, &matrix_from(placement)?))
    }

    /// A copy of the model.
    pub fn clone_model(&self) -> Model {
        Model { inner: self.inner.clone(), parse_ms: self.parse_ms, oriented: self.oriented.clone() }
    }
}

/// A mesh that another engine shared, to evaluate directions of.
#[wasm_bindgen]
pub struct SharedMesh {
    inner: Mesh,
}

#[wasm_bindgen]
impl SharedMesh {
    /// The mesh that `Model.share` wrote.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: &[u8]) -> Result<SharedMesh, Thrown> {
        Ok(SharedMesh { inner: postcard::from_bytes(bytes).map_err(internal_error)? })
    }

    /// Figures of one direction for `Model.choose`.
    pub fn evaluate(&self, settings: &str, id: u32, up: &[f64]) -> Result<Vec<u8>, Thrown> {
        evaluated(&self.inner, settings, id, up)
    }
}

fn evaluated(mesh: &Mesh, settings: &str, id: u32, up: &[f64]) -> Result<Vec<u8>, Thrown> {
    let options = settings_from(settings)?.orientation;
    let up = <[f64; 3]>::try_from(up).map_err(internal_error)?;
    let figures = evaluate(mesh, &Direction { id, up }, &options, &mut |_, _| true);
    postcard::to_allocvec(&figures.map_err(orientation_error)?).map_err(internal_error)
}

fn matrix_and_box(mesh: &Mesh, placement: &DMat4) -> Vec<f64> {
    let reach =
        bounds_under(mesh, placement).map_or([DVec3::ZERO; 2], |b| [b.min.as_dvec3(), b.max.as_dvec3()]);
    placement.to_cols_array().into_iter().chain(reach.iter().flat_map(|v| v.to_array())).collect()
}

/// Placements (16 numbers each) that stand the parts side by side on the bed, as they are turned and
/// scaled by `placements`; `boxes` holds the six numbers of each part's box there, `own` the
/// parts' own settings as for a `Job`. Throws a `FitError` or a `SettingsError`.
#[wasm_bindgen]
pub fn arrange_parts(
    placements: &[f64],
    boxes: &[f64],
    settings: &str,
    own: Vec<String>,
) -> Result<Vec<f64>, Thrown> {
    let settings = settings_from(settings)?;
    let of_part = |own: &String| settings.of_model(&own_from(own)?).map_err(settings_error);
    let own: Vec<Settings> = own.iter().map(of_part).collect::<Result<_, Thrown>>()?;
    let corner = |at: &[f64]| DVec3::new(at[0], at[1], at[2]).as_vec3();
    let boxes: Vec<Box3> =
        boxes.chunks_exact(6).map(|b| Box3 { min: corner(&b[..3]), max: corner(&b[3..]) }).collect();
    let moves = pipeline::arrange(&boxes, &settings, &own).map_err(fit_error)?;
    let placed = matrices_from(placements)?.into_iter().zip(moves);
    Ok(placed.flat_map(|(it, by)| (DMat4::from_translation(by) * it).to_cols_array()).collect())
}

/// The parts on the bed (`placements`: 16 numbers each) seen from "top", "front" or, with any other
/// word, from the front left above. Throws a `UsageError`.
#[wasm_bindgen]
pub fn parts_picture(parts: Vec<Model>, placements: &[f64], view: &str) -> Result<Scene, Thrown> {
    let viewpoint = match view {
        "top" => Viewpoint::Top,
        "front" => Viewpoint::Front,
        _ => Viewpoint::Iso,
    };
    let mut all = Mesh::default();
    for (part, placement) in parts.iter().zip(matrices_from(placements)?) {
        all.append(&part.inner.mesh.transformed(&placement).map_err(usage_error)?);
    }
    Ok(Scene::of_model(ModelPicture::new(&all, viewpoint)))
}
