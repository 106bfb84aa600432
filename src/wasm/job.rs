//! One slicing job and its ranges of layers.

use wasm_bindgen::prelude::*;

use super::convert::{job_error, matrices_from, now, own_from, settings_from};
use super::error::{Thrown, internal_error, usage_error};
use super::model::Model;
use super::study;
use crate::gcode::Piece;
use crate::mesh::stl::write_binary;
use crate::pipeline::{self, Finished, NamedModel, RangeMeta, RangeResult, Share};
use crate::view::{Paper, Scene};

/// One slicing job; lives in the lead engine.
#[wasm_bindgen]
pub struct Job {
    /// Gone once the job is finished.
    inner: Option<pipeline::Job>,
}

#[wasm_bindgen]
impl Job {
    /// Takes the models over, places them on the bed and plans the layers; `names` are the models'
    /// file names without ending, `settings` is JSON. `placements` holds 16 numbers for each model,
    /// the columns of its matrix from file to bed coordinates; empty, the models are arranged.
    /// `own` holds each model's own settings, JSON; empty, none has any. Throws a `SettingsError` or a
    /// `FitError`.
    #[wasm_bindgen(constructor)]
    pub fn new(
        models: Vec<Model>,
        names: Vec<String>,
        settings: &str,
        placements: &[f64],
        own: Vec<String>,
    ) -> Result<Job, Thrown> {
        let settings = settings_from(settings)?;
        let parse_ms: f64 = models.iter().map(|m| m.parse_ms).sum();
        let orientation = &settings.orientation;
        let named = models.into_iter().zip(names).map(|(m, name)| m.named(name, orientation));
        let mut named: Vec<NamedModel> = named.collect();
        if !own.is_empty() && own.len() != named.len() {
            return Err(usage_error("own: one text for each model is needed"));
        }
        for (model, own) in named.iter_mut().zip(&own) {
            model.own = own_from(own)?;
        }
        let placements = matrices_from(placements)?;
        let begun = if placements.is_empty() {
            pipeline::Job::new(&named, settings, &now)
        } else if placements.len() == named.len() {
            pipeline::Job::placed(&named, &placements, settings, &now)
        } else {
            return Err(usage_error("placements: 16 numbers for each model are needed"));
        };
        let mut inner = begun.map_err(job_error)?;
        inner.add_parse_time(parse_ms);
        Ok(Job { inner: Some(inner) })
    }

    /// Number of layers; known after `prepare`.
    pub fn layer_count(&self) -> Result<usize, Thrown> {
        Ok(self.inner()?.layer_count())
    }

    /// All models as they stand on the bed, as one binary STL.
    pub fn stl(&self) -> Result<Vec<u8>, Thrown> {
        Ok(write_binary(&self.inner()?.plate()))
    }

    /// Works out what all layers share; once, before any range.
    pub fn prepare(&mut self) -> Result<(), Thrown> {
        self.inner_mut()?.prepare(&now).map_err(job_error)
    }

    /// The layers `first..last` as bytes for `slice_share` in another engine.
    pub fn share(&self, first: usize, last: usize) -> Result<Vec<u8>, Thrown> {
        postcard::to_allocvec(&self.inner()?.share(first, last)).map_err(internal_error)
    }

    /// Works the layers `first..last` here.
    pub fn slice(&self, first: usize, last: usize) -> Result<Chunk, Thrown> {
        Chunk::new(self.inner()?.slice(first, last, &now))
    }

    /// Takes in the figures of a worked range, in any order.
    pub fn add(&mut self, meta: &[u8]) -> Result<(), Thrown> {
        let meta: RangeMeta = postcard::from_bytes(meta).map_err(internal_error)?;
        self.inner_mut()?.add(meta);
        Ok(())
    }

    /// Joins the layers, all of which must have been added. The job is over then.
    pub fn finish(&mut self) -> Result<JobResult, Thrown> {
        let job = self.inner.take().ok_or_else(|| internal_error("the job is over"))?;
        Ok(JobResult { inner: job.finish(&now).map_err(job_error)? })
    }

    /// Skirt, brim, raft and teeth beside each other, as a JSON list (`AdhesionReport`).
    pub fn compare(&self) -> Result<String, Thrown> {
        let kinds = self.inner()?.first_print().compare(&now).map_err(job_error)?;
        serde_json::to_string(&kinds).map_err(internal_error)
    }

    /// One layer as an SVG picture.
    pub fn draw_layer(&self, layer: usize) -> Result<String, Thrown> {
        let job = self.inner()?;
        let last = job.layer_count() - 1;
        let scene = Scene::of_job_layer(job, layer, &now);
        Ok(scene.ok_or_else(|| usage_error(format!("layer {layer}: there are layers 0 to {last}")))?.to_svg())
    }

    /// A vertical plane such as `y=12.5`, mm in bed coordinates, as an SVG picture.
    pub fn draw_plane(&self, plane: &str) -> Result<String, Thrown> {
        Ok(Scene::of_job_plane(self.inner()?, plane).map_err(usage_error)?.to_svg())
    }

    /// Every kind of base layer with its picture, and which suits, as JSON (`BaseLayers` in
    /// `messages.ts`). Pictures are `side` CSS pixels long, for dark ground or light.
    pub fn base_layers(&self, side: f64, dark: bool) -> Result<String, Thrown> {
        study::base_layers(self.inner()?, Paper::inline(side, dark))
    }

    /// A plane with its figures, as JSON (`PlaneStudy`).
    pub fn plane(&self, plane: &str, side: f64, dark: bool) -> Result<String, Thrown> {
        study::plane(self.inner()?, plane, Paper::inline(side, dark))
    }

    /// The plates of `support.method` plates as sheets without thickness, as JSON (`Sheet[]`).
    pub fn sheets(&self) -> Result<String, Thrown> {
        study::sheets_of(self.inner()?)
    }

    /// The steps of a lesson, "teeth", "plates" or "features", as JSON (`LessonStep[]`). `at` is a
    /// plane such as `y=12.5`, a layer counted from 1, or empty for one that shows much.
    pub fn lesson(&self, lesson: &str, at: &str, side: f64, dark: bool) -> Result<String, Thrown> {
        study::lesson(self.inner()?, lesson, at, Paper::inline(side, dark))
    }

    fn inner(&self) -> Result<&pipeline::Job, Thrown> {
        self.inner.as_ref().ok_or_else(|| internal_error("the job is over"))
    }

    fn inner_mut(&mut self) -> Result<&mut pipeline::Job, Thrown> {
        self.inner.as_mut().ok_or_else(|| internal_error("the job is over"))
    }
}

/// Works a range that another engine shared.
#[wasm_bindgen]
pub fn slice_share(share: &[u8]) -> Result<Chunk, Thrown> {
    let share: Share = postcard::from_bytes(share).map_err(internal_error)?;
    Chunk::new(share.slice(&now))
}

/// The G-code of a range of layers.
#[wasm_bindgen]
pub struct Chunk {
    meta: Vec<u8>,
    text: Vec<u8>,
    offsets: Vec<u32>,
}

impl Chunk {
    fn new(result: RangeResult) -> Result<Chunk, Thrown> {
        let meta = postcard::to_allocvec(&result.meta).map_err(internal_error)?;
        let ends = result.texts.iter().scan(0, |end, text| {
            *end += text.len() as u32;
            Some(*end)
        });
        let offsets = std::iter::once(0).chain(ends).collect();
        Ok(Chunk { meta, text: result.texts.concat(), offsets })
    }
}

#[wasm_bindgen]
impl Chunk {
    /// Figures for [`Job::add`].
    pub fn meta(&self) -> Vec<u8> {
        self.meta.clone()
    }

    /// Text of all layers, one after another; handed over, so only the first call has it.
    pub fn text(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.text)
    }

    /// Layer i of the range is `text[offsets[i]..offsets[i + 1]]`, bytes.
    pub fn layer_offsets(&self) -> Vec<u32> {
        self.offsets.clone()
    }
}

/// A joined job.
#[wasm_bindgen(js_name = Result)]
pub struct JobResult {
    inner: Finished,
}

#[wasm_bindgen(js_class = Result)]
impl JobResult {
    /// The report, as JSON (`Report`).
    pub fn report(&self) -> Result<String, Thrown> {
        serde_json::to_string(&self.inner.report).map_err(internal_error)
    }

    /// Seconds that each layer takes, from its first to its last stop.
    pub fn layer_times(&self) -> Vec<f64> {
        self.inner.layer_times_s.clone()
    }

    /// Marks for the picture of the first layer, for `Scene.layer`; empty without teeth.
    pub fn marks(&self) -> Result<Vec<u8>, Thrown> {
        let bytes = self.inner.teeth.as_ref().map(postcard::to_allocvec).transpose();
        Ok(bytes.map_err(internal_error)?.unwrap_or_default())
    }

    /// A name for the file.
    pub fn file_name(&self) -> String {
        self.inner.file_name.clone()
    }

    /// All text that is in no layer.
    pub fn glue(&self) -> Vec<u8> {
        self.inner.joined.glue.clone()
    }

    /// The file as triples (source, from, to): source 0 is the glue, source k + 1 the text of layer
    /// k; from and to are byte offsets.
    pub fn pieces(&self) -> Vec<u32> {
        let triple = |p: &Piece| [p.layer.map_or(0, |k| k + 1), p.start, p.end];
        self.inner.joined.pieces.iter().flat_map(triple).collect()
    }
}
