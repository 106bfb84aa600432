//! The list of steps from models to G-code.
//!
//! Three phases. [`Job::new`] and [`Job::prepare`] work out what all layers share: placement, layer
//! plan, base layers. [`Job::slice`] works a range of layers; an engine that does not hold the job
//! gets a [`Share`] and does the same. [`Job::finish`] joins the layers in one pass.

mod check;
mod compare;
mod place;
mod print;
mod range;
mod report;
mod sequence;
mod tools;
mod turn;
mod vase;

use std::fmt;

use glam::DMat4;

pub use check::{Finding, Stand};
pub use compare::{Alternative, Alternatives};
pub use place::{FitError, FitHint, Placed, arrange, place_as_told, place_on_bed};
pub use print::Print;
pub use range::{PRINT_RESOLUTION, RangeMeta, RangePlan, RangeResult, Share};
pub use sequence::SequenceError;
pub use tools::ToolError;
use tools::check_tools;
use turn::{Turned, turn_models, turn_standing};

pub use report::{AdhesionReport, FilamentReport, ModelReport, Report, SupportReport, Timing, Warning};

use print::{BodyRange, Prepared};
use range::BodyPiece;

use crate::adhesion::{AdhesionError, AdhesionFigures, AdhesionKind, AdhesionWarning, TeethDrawing};
use crate::gcode::{
    FileNotes, GcodeError, GcodeOptions, Joined, LabelledObject, LayerSummary, event_layers, format_duration,
    join, labelled_objects,
};
use crate::mesh::LoadedModel;
use crate::mesh::{Box3, Mesh};
use crate::orientation::{OrientationError, OrientationReport};
use crate::picture::{Thumbnail, parse_thumbnails, thumbnail_lines};
use crate::polygon::measure::Bounds;
use crate::settings::{OwnSettings, Settings, SettingsError};
use crate::slice::{LayerOptions, LayerSpec};
use crate::sort::StableSort;
use crate::support::{SupportError, SupportMethod, SupportWarning};

/// Milliseconds since some fixed moment; the core has no clock of its own.
pub type Clock<'a> = &'a dyn Fn() -> f64;

/// A model with the name it is known by, such as its file's.
#[derive(Debug, Clone)]
pub struct NamedModel {
    /// Name without folders; it becomes part of the file name of the G-code.
    pub name: String,
    /// The checked mesh and what was found in it.
    pub model: LoadedModel,
    /// Settings of its own.
    pub own: OwnSettings,
    /// Its directions, where they were computed before, with the job's orientation options.
    pub orientation: Option<OrientationReport>,
}

impl NamedModel {
    /// A model with the plate's settings, whose directions are not known.
    pub fn new(name: impl Into<String>, model: LoadedModel) -> NamedModel {
        NamedModel { name: name.into(), model, own: OwnSettings::default(), orientation: None }
    }
}

/// Why a job cannot be done.
#[derive(Debug, Clone, PartialEq)]
pub enum JobError {
    /// The models do not fit the printer.
    Fit(FitError),
    /// Nothing to print: no model, or no model with a volume.
    Empty,
    /// No orientation can be proposed for a model.
    Orientation(OrientationError),
    /// Settings under `support` that contradict each other.
    Support(SupportError),
    /// Settings under `adhesion` that contradict each other.
    Adhesion(AdhesionError),
    /// A start or end code cannot be used, or settings of the file or its layers contradict each other.
    Gcode(GcodeError),
    /// Two tools cannot be used as asked.
    Tools(ToolError),
    /// A model's own settings cannot be used.
    OwnSettings {
        /// The model's name.
        model: String,
        /// What is wrong.
        cause: SettingsError,
    },
    /// Models cannot be printed one after another as they stand.
    Sequence(SequenceError),
    /// [`Job::finish`] was called before this layer was added: a bug of the caller.
    LayerMissing {
        /// The first missing layer.
        index: usize,
    },
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            JobError::Fit(error) => error.fmt(f),
            JobError::Empty => write!(f, "there is nothing to print"),
            JobError::Orientation(error) => error.fmt(f),
            JobError::Support(error) => error.fmt(f),
            JobError::Adhesion(error) => error.fmt(f),
            JobError::Gcode(error) => error.fmt(f),
            JobError::Tools(error) => error.fmt(f),
            JobError::OwnSettings { model, cause } => write!(f, "{model}: {cause}"),
            JobError::Sequence(error) => error.fmt(f),
            JobError::LayerMissing { index } => write!(f, "layer {index} was never worked"),
        }
    }
}

impl std::error::Error for JobError {}

impl JobError {
    fn contradiction(setting: &str, cause: String) -> JobError {
        JobError::Gcode(GcodeError::Contradiction { setting: setting.to_owned(), cause })
    }
}

/// A slicing job: models on the bed, settings and the layer plan.
#[derive(Debug)]
pub struct Job {
    settings: Settings,
    name: String,
    /// In printing order; at least one.
    prints: Vec<Print>,
    /// Own settings of models, as (path, value).
    own: Vec<(String, String)>,
    placements: Vec<DMat4>,
    objects: Vec<LabelledObject>,
    orientation: Option<OrientationReport>,
    adhesion: AdhesionReport,
    support: Option<SupportReport>,
    /// What is known of each layer so far.
    layers: Vec<Option<LayerSummary>>,
    warnings: Vec<Warning>,
    /// Weak places of the layers worked so far.
    findings: Vec<Finding>,
    timing: Timing,
    started_ms: f64,
}

impl Job {
    /// Arranges the models on the bed and plans the layers.
    pub fn new(models: &[NamedModel], settings: Settings, clock: Clock) -> Result<Job, JobError> {
        let started_ms = clock();
        let settings = checked(settings)?;
        let turned = turn_models(models, &settings)?;
        let meshes: Vec<&Mesh> = turned.meshes.iter().collect();
        let own = sequence::own_settings(models, &settings)?;
        let mut placed = place_on_bed(&meshes, &settings, &own).map_err(JobError::Fit)?;
        placed.placements =
            placed.placements.iter().zip(&turned.turns).map(|(place, turn)| *place * *turn).collect();
        Job::standing(models, placed, turned, settings, started_ms)
    }

    /// Like [`Job::new`], with the models where `placements` (file to bed coordinates, one for each
    /// model) put them; what `orientation.mode` turns keeps its middle.
    pub fn placed(
        models: &[NamedModel],
        placements: &[DMat4],
        settings: Settings,
        clock: Clock,
    ) -> Result<Job, JobError> {
        let started_ms = clock();
        let settings = checked(settings)?;
        let turned = turn_standing(models, placements, &settings)?;
        let meshes: Vec<&Mesh> = models.iter().map(|m| &m.model.mesh).collect();
        let placed = place_as_told(&meshes, &turned.turns, &settings.printer).map_err(JobError::Fit)?;
        Job::standing(models, placed, turned, settings, started_ms)
    }

    fn standing(
        models: &[NamedModel],
        Placed { mesh, placements, stands }: Placed,
        turned: Turned,
        settings: Settings,
        started_ms: f64,
    ) -> Result<Job, JobError> {
        let remarks = check::check(&settings, &stands);
        let names = models.iter().map(|m| m.name.as_str());
        let objects = labelled_objects(names.zip(stands.iter().map(|it| it.footprint)), &settings.printer);
        let prints = sequence::prints_of(models, mesh, &settings)?;
        Ok(Job {
            name: models.first().map_or_else(String::new, |m| m.name.clone()),
            layers: Vec::new(),
            warnings: model_warnings(models).into_iter().chain(turned.warnings).chain(remarks).collect(),
            findings: Vec::new(),
            orientation: turned.report,
            support: None,
            own: models.iter().flat_map(own_lines).collect(),
            prints,
            objects,
            adhesion: AdhesionReport::default(),
            timing: Timing::default(),
            settings,
            placements,
            started_ms,
        })
    }

    /// Number of layers in the file; known after [`Job::prepare`].
    pub fn layer_count(&self) -> usize {
        self.prints.iter().map(|print| print.specs().len()).sum()
    }

    /// What is printed first: all of the plate, unless its models are printed one after another.
    pub fn first_print(&self) -> &Print {
        // Every job has a print: without models there is an error.
        &self.prints[0]
    }

    /// The layer plan of the first print, from the bed up.
    pub fn specs(&self) -> &[LayerSpec] {
        self.first_print().specs()
    }

    /// The models of the first print in bed coordinates.
    pub fn mesh(&self) -> &Mesh {
        self.first_print().mesh()
    }

    /// All models in bed coordinates, whatever is printed when.
    pub fn plate(&self) -> Mesh {
        let mut plate = Mesh::default();
        self.prints.iter().for_each(|print| plate.append(print.mesh()));
        plate
    }

    /// The settings of the job.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The printable area of the bed.
    pub fn bed(&self) -> Bounds {
        self.settings.printer.bed()
    }

    /// Adds the time that reading the models took.
    pub fn add_parse_time(&mut self, ms: f64) {
        self.timing.parse += ms;
    }

    /// Works out what all layers share. To be called once, before any range; a raft adds layers.
    pub fn prepare(&mut self, clock: Clock) -> Result<(), JobError> {
        let mut adhesion = Vec::new();
        let mut slicing_ms = 0.0;
        for k in 0..self.prints.len() {
            let Prepared { adhesion: figures, outline_mm, support, mut warnings, adhesion_ms, support_ms } =
                self.prints[k].prepare(clock)?;
            adhesion.push((figures, outline_mm));
            let before = self.layers_before(k);
            warnings.iter_mut().for_each(|warning| warning.raise(before));
            self.warnings.extend(warnings);
            self.support = SupportReport::sum(self.support.take(), support, before);
            slicing_ms += adhesion_ms;
            self.timing.support += support_ms;
        }
        self.timing.adhesion += slicing_ms;
        self.adhesion =
            AdhesionReport::new(self.settings.adhesion.kind, &AdhesionFigures::sum(&adhesion), slicing_ms);
        sequence::check(&self.prints).map_err(JobError::Sequence)?;
        self.layers = vec![None; self.layer_count()];
        self.warn_of_late_events();
        Ok(())
    }

    /// Events above the print never happen.
    fn warn_of_late_events(&mut self) {
        let tops: Vec<f64> = self.prints.iter().flat_map(|p| p.specs()).map(|spec| spec.print_z).collect();
        let places = event_layers(&self.settings.gcode.events, &tops);
        for i in (0..places.len()).filter(|&i| places[i].is_none()) {
            let top = tops.last().copied().unwrap_or(0.0);
            let message = format!(
                "gcode.events[{i}] lies above the print, which has {} layers and is {top:.2} mm high",
                tops.len()
            );
            self.warnings.push(Warning::on_job("event_above_print", message));
        }
    }

    /// The layers `first..last` as a piece of work for another engine.
    pub fn share(&self, first: usize, last: usize) -> Share {
        let mut share = Share::beginning_at(first);
        self.each_run(first, last, &mut |before, bodies| share.push(before, bodies));
        share
    }

    /// Works the layers `first..last`.
    pub fn slice(&self, first: usize, last: usize, clock: Clock) -> RangeResult {
        let mut result = RangeResult::beginning_at(first);
        self.each_run(first, last, &mut |before, bodies| result.add_run(before, bodies, clock));
        result
    }

    /// Hands out the layers `first..last` print by print: the layers of the file before the print's
    /// first one, and the range of each of its bodies.
    fn each_run(&self, first: usize, last: usize, take: &mut dyn FnMut(u32, &[BodyPiece<'_>])) {
        for (k, print) in self.prints.iter().enumerate() {
            let before = self.layers_before(k);
            let local = |layer: usize| layer.saturating_sub(before as usize).min(print.specs().len());
            let (from, to) = (local(first), local(last));
            if from < to {
                let ranges = print.ranges(from, to, &self.objects);
                let pieces = ranges.iter().map(|BodyRange { plan, triangles }| BodyPiece {
                    plan,
                    mesh: print.mesh(),
                    triangles,
                });
                take(before, &pieces.collect::<Vec<_>>());
            }
        }
    }

    /// Layers of the file before the `k`th print.
    fn layers_before(&self, k: usize) -> u32 {
        self.prints[..k].iter().map(|print| print.specs().len() as u32).sum()
    }

    /// The print that the file's layer `index` belongs to, and the layer's place in it.
    pub fn print_of(&self, index: usize) -> Option<(&Print, usize)> {
        let place = (0..self.prints.len()).rfind(|&k| self.layers_before(k) as usize <= index)?;
        let local = index - self.layers_before(place) as usize;
        (local < self.prints[place].specs().len()).then(|| (&self.prints[place], local))
    }

    /// Takes in the figures of a worked range.
    pub fn add(&mut self, meta: RangeMeta) {
        self.timing.add(&meta.timing);
        self.warnings.extend(meta.warnings);
        self.findings.extend(meta.findings);
        for (place, summary) in (meta.first..).zip(meta.summaries) {
            self.layers[place] = Some(summary);
        }
    }

    /// Joins the layers, all of which must have been added.
    pub fn finish(mut self, clock: Clock) -> Result<Finished, JobError> {
        let missing = |index: usize| move || JobError::LayerMissing { index };
        let take =
            |(index, layer): (usize, &mut Option<LayerSummary>)| layer.take().ok_or_else(missing(index));
        let summaries: Vec<LayerSummary> =
            self.layers.iter_mut().enumerate().map(take).collect::<Result<_, _>>()?;
        let started = clock();
        let settings = [self.settings.lines(), std::mem::take(&mut self.own)].concat();
        let thumbnails = thumbnails_of(&self.settings)?;
        let head =
            if thumbnails.is_empty() { String::new() } else { thumbnail_lines(&self.plate(), &thumbnails) };
        let notes = FileNotes { head: head.as_bytes(), settings: &settings };
        let options = GcodeOptions { objects: self.objects.clone(), ..self.settings.gcode_options() };
        let joined = join(&summaries, &options, &notes).map_err(JobError::Gcode)?;
        self.timing.gcode += clock() - started;
        self.timing.total = clock() - self.started_ms + self.timing.parse;
        self.warnings.extend(check::told(&mut self.findings, &self.settings));
        self.warnings.stable_sort_by_key(|w| w.layer);
        let report = self.report(&joined);
        let file_name = self.file_name(report.time_s);
        let layer_times_s = summaries.iter().map(|s| s.time_s).collect();
        let teeth = self.first_print().teeth_drawing().cloned();
        Ok(Finished { joined, report, file_name, layer_times_s, teeth })
    }

    fn report(&self, joined: &Joined) -> Report {
        let rows = |m: &DMat4| m.transpose().to_cols_array_2d();
        let placements: Vec<[[f64; 4]; 4]> = self.placements.iter().map(rows).collect();
        let boxes = self.prints.iter().filter_map(|print| print.mesh().bounds());
        let around = boxes.reduce(|a, b| Box3 { min: a.min.min(b.min), max: a.max.max(b.max) });
        let bounds = around.map_or([[0.0; 3]; 2], |b| [b.min, b.max].map(|v| v.as_dvec3().to_array()));
        let meshes = || self.prints.iter().map(Print::mesh);
        let totals = &joined.totals;
        Report {
            engine: engine_name(),
            model: ModelReport {
                triangles: meshes().map(|mesh| mesh.triangles.len()).sum(),
                bounds,
                volume_mm3: meshes().map(Mesh::volume).sum(),
            },
            placement: placements.first().copied().unwrap_or_default(),
            placements,
            layers: self.layer_count(),
            filament: FilamentReport {
                length_mm: totals.filament_mm,
                volume_mm3: totals.volume_mm3,
                mass_g: totals.mass_g,
                cost: totals.cost,
            },
            time_s: totals.time_s,
            by_role: totals.by_role.clone(),
            adhesion: self.adhesion.timed(&totals.by_role),
            support: self.support.as_ref().map(|s| s.timed(&totals.by_role)),
            orientation: self.orientation.clone(),
            timing_ms: self.timing,
            warnings: self.warnings.clone(),
        }
    }

    /// `<model>_<layer height>mm_<material>_<time>.gcode`.
    fn file_name(&self, time_s: f64) -> String {
        let Settings { layers, filament, .. } = &self.settings;
        let time = format_duration(time_s).replace(' ', "");
        format!("{}_{}mm_{}_{}.gcode", self.name, layers.height, filament.material, time)
    }
}

/// A joined job.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// The text between the layers, and how it and the layers' texts make the file.
    pub joined: Joined,
    /// The figures.
    pub report: Report,
    /// A name for the file.
    pub file_name: String,
    /// Seconds from the first to the last stop of each layer; travels between layers are in none.
    pub layer_times_s: Vec<f64>,
    /// Rail, teeth and the outline they are measured to, for the picture of the first layer.
    pub teeth: Option<TeethDrawing>,
}

/// Name and version of this engine.
pub fn engine_name() -> String {
    format!("Foothold {}", env!("CARGO_PKG_VERSION"))
}

/// Refuses templates with unknown placeholders, tools that are not there and settings that contradict
/// each other; settles what a vase needs.
fn checked(settings: Settings) -> Result<Settings, JobError> {
    crate::gcode::check_templates(&settings.printer).map_err(JobError::Gcode)?;
    crate::gcode::check_output(&settings.gcode_options()).map_err(JobError::Gcode)?;
    check_tools(&settings).map_err(JobError::Tools)?;
    check_heights(&settings.layers)?;
    thumbnails_of(&settings)?;
    if settings.layers.spiral_vase { vase_of(settings) } else { Ok(settings) }
}

/// The thumbnails that `gcode.thumbnails` asks for.
fn thumbnails_of(settings: &Settings) -> Result<Vec<Thumbnail>, JobError> {
    parse_thumbnails(&settings.gcode.thumbnails)
        .map_err(|cause| JobError::contradiction("gcode.thumbnails", cause))
}

/// Adaptive heights need room between their limits.
fn check_heights(options: &LayerOptions) -> Result<(), JobError> {
    let LayerOptions { min_height, max_height, adaptive, .. } = *options;
    if !adaptive || min_height <= max_height {
        return Ok(());
    }
    let cause = format!("{min_height} mm is more than layers.max_height, {max_height} mm");
    Err(JobError::contradiction("layers.min_height", cause))
}

/// The settings of a vase, if nothing in them is against it.
fn vase_of(settings: Settings) -> Result<Settings, JobError> {
    let with = |what: &str| {
        let cause = format!("a vase cannot be printed with {what}");
        Err(JobError::contradiction("layers.spiral_vase", cause))
    };
    if settings.support.method != SupportMethod::None {
        return with("supports (support.method)");
    }
    if settings.adhesion.kind == AdhesionKind::Raft {
        return with("adhesion.kind=raft");
    }
    Ok(vase::as_vase(settings))
}

/// A model's own settings as the file tells them.
fn own_lines(model: &NamedModel) -> Vec<(String, String)> {
    let name = model.name.replace(char::is_control, " ");
    model.own.lines().into_iter().map(|(path, value)| (format!("models.{name}.{path}"), value)).collect()
}

fn model_warnings(models: &[NamedModel]) -> Vec<Warning> {
    let of_model = |m: &NamedModel| {
        let found = m.model.inspection.warnings.iter();
        let named = |w: &crate::mesh::Warning| Warning::on_job(w.code, format!("{}: {}", m.name, w.message));
        found.map(named).collect::<Vec<_>>()
    };
    models.iter().flat_map(of_model).collect()
}

fn support_warning(found: &SupportWarning) -> Warning {
    let SupportWarning { code, message, layer, at } = found.clone();
    Warning { code, message, layer, at, fix: Vec::new() }
}

fn adhesion_warning(found: &AdhesionWarning) -> Warning {
    let at = found.at.map(|p| p.to_array());
    let code = found.code.name().to_owned();
    Warning { code, message: found.message.clone(), layer: Some(0), at, fix: Vec::new() }
}
