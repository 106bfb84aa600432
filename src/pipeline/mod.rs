//! The list of steps from models to G-code.
//!
//! Three phases. [`Job::new`] and [`Job::prepare`] work out what all layers share: placement, layer
//! plan, base layers. [`Job::slice`] works a range of layers; an engine that does not hold the job
//! gets a [`Share`] and does the same. [`Job::finish`] joins the layers in one pass.

mod check;
mod compare;
mod place;
mod range;
mod report;
mod tools;
mod turn;
mod vase;

use std::fmt;

use glam::DMat4;

pub use compare::{Alternative, Alternatives};
pub use place::{FitError, Placed, arrange, place_as_told, place_on_bed};
pub use range::{PRINT_RESOLUTION, RangeMeta, RangePlan, RangeResult, Share};
pub use tools::ToolError;
use tools::check_tools;
use turn::{Turned, turn_models, turn_standing};

pub use report::{AdhesionReport, FilamentReport, ModelReport, Report, SupportReport, Timing, Warning};

use crate::adhesion::{
    AdhesionError, AdhesionKind, AdhesionOptions, AdhesionWarning, FirstLayer, Foundation, RaftLayer,
    TeethDrawing, lay_foundation,
};
use crate::gcode::{
    FileNotes, GcodeError, GcodeOptions, Joined, LabelledObject, LayerSummary, event_layers, format_duration,
    join, labelled_objects,
};
use crate::mesh::LoadedModel;
use crate::mesh::Mesh;
use crate::orientation::{OrientationError, OrientationReport};
use crate::polygon::PolygonSet;
use crate::polygon::measure::Bounds;
use crate::region::first_layer::draw_in;
use crate::region::{Bead, Path};
use crate::settings::Settings;
use crate::slice::heights::plan_layers_of;
use crate::slice::{Axis, LayerOptions, LayerSpec, slice_mesh};
use crate::sort::StableSort;
use crate::support::{
    SupportError, SupportInput, SupportMethod, SupportOptions, SupportWarning, Supports, check_options,
    plan_supports,
};
use crate::toolpath::infill::line_density;
use crate::toolpath::seam::{SeamLine, SeamPosition, chain_seams};
use crate::toolpath::walls::lay_walls;

/// Milliseconds since some fixed moment; the core has no clock of its own.
pub type Clock<'a> = &'a dyn Fn() -> f64;

/// Layers on which the density of sparse infill is measured.
const DENSITY_SAMPLES: usize = 5;

/// Seams are chained on every so many layers.
const SEAM_STEP: usize = 5;

/// A model with the name it is known by, such as its file's.
#[derive(Debug, Clone)]
pub struct NamedModel {
    /// Name without folders; it becomes part of the file name of the G-code.
    pub name: String,
    /// The checked mesh and what was found in it.
    pub model: LoadedModel,
    /// Its directions, where they were computed before, with the job's orientation options.
    pub orientation: Option<OrientationReport>,
}

impl NamedModel {
    /// A model whose directions are not known.
    pub fn new(name: impl Into<String>, model: LoadedModel) -> NamedModel {
        NamedModel { name: name.into(), model, orientation: None }
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
    mesh: Mesh,
    /// Lowest and highest z of each triangle, so that a range finds its triangles in one pass.
    spans: Vec<[f32; 2]>,
    specs: Vec<LayerSpec>,
    placements: Vec<DMat4>,
    objects: Vec<LabelledObject>,
    /// For each layer the beads of base layers and supports, in printing order.
    laid: Vec<Vec<Path>>,
    /// See [`RangePlan::seams`].
    seams: Vec<SeamLine>,
    /// See [`RangePlan::line_density`].
    line_density: f64,
    /// For each layer the beads of the second tool that come after the part.
    after: Vec<Vec<Path>>,
    orientation: Option<OrientationReport>,
    adhesion: AdhesionReport,
    /// Rail and teeth to look at; after [`Job::prepare`], only with teeth.
    teeth: Option<TeethDrawing>,
    support: Option<SupportReport>,
    /// What is known of each layer so far.
    layers: Vec<Option<LayerSummary>>,
    warnings: Vec<Warning>,
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
        let mut placed = place_on_bed(&meshes, &settings.printer).map_err(JobError::Fit)?;
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
        Placed { mesh, placements, footprints }: Placed,
        turned: Turned,
        settings: Settings,
        started_ms: f64,
    ) -> Result<Job, JobError> {
        let height = mesh.bounds().map_or(0.0, |b| f64::from(b.max.z));
        if height <= 0.0 {
            return Err(JobError::Empty);
        }
        let specs = plan_layers_of(&mesh, height, &settings.layers);
        let z_span = |t: usize| {
            let [a, b, c] = mesh.corners(t).map(|v| v.z);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let remarks = check::check(&settings, &footprints);
        let names = models.iter().map(|m| m.name.as_str());
        let objects = labelled_objects(names.zip(footprints), &settings.printer);
        Ok(Job {
            name: models.first().map_or_else(String::new, |m| m.name.clone()),
            spans: (0..mesh.triangles.len()).map(z_span).collect(),
            layers: vec![None; specs.len()],
            warnings: model_warnings(models).into_iter().chain(turned.warnings).chain(remarks).collect(),
            orientation: turned.report,
            laid: Vec::new(),
            seams: Vec::new(),
            line_density: settings.infill.density,
            teeth: None,
            after: Vec::new(),
            support: None,
            objects,
            adhesion: AdhesionReport::default(),
            timing: Timing::default(),
            settings,
            mesh,
            specs,
            placements,
            started_ms,
        })
    }

    /// Number of layers; known after [`Job::prepare`].
    pub fn layer_count(&self) -> usize {
        self.specs.len()
    }

    /// The layer plan, from the bed up.
    pub fn specs(&self) -> &[LayerSpec] {
        &self.specs
    }

    /// All models in bed coordinates.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The settings of the job.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Adds the time that reading the models took.
    pub fn add_parse_time(&mut self, ms: f64) {
        self.timing.parse += ms;
    }

    /// Works out what all layers share. To be called once, before any range; a raft adds layers.
    pub fn prepare(&mut self, clock: Clock) -> Result<(), JobError> {
        let started = clock();
        let supports = self.plan_supports()?;
        let supported = clock();
        let adhesion = &self.settings.adhesion;
        let kind = adhesion.kind;
        let foundation = self.lay_foundation(adhesion, &self.first_outline(kind), &supports.bed_area())?;
        self.teeth.clone_from(&foundation.drawing);
        self.adhesion = AdhesionReport::new(kind, &foundation.figures, clock() - supported);
        self.timing.support = supported - started;
        self.timing.adhesion = clock() - supported;
        self.line_density = self.infill_line_density();
        self.seams = self.chain_seams();
        self.warnings.extend(foundation.warnings.iter().map(adhesion_warning));
        self.warnings.extend(supports.warnings().iter().map(support_warning));
        self.support = SupportReport::of(&supports);
        self.laid = (0..self.specs.len()).map(|k| supports.layer_paths(k)).collect();
        if foundation.raft.is_empty() {
            // The base is printed first: it keeps what follows on the bed.
            for (place, paths) in self.laid.iter_mut().zip(foundation.layers) {
                place.splice(..0, paths);
            }
        } else {
            self.raise_on(foundation);
        }
        let arranged = tools::order_tools(&mut self.laid, &self.mesh, &self.specs, &self.settings);
        self.after = arranged.map_err(JobError::Tools)?;
        self.layers = vec![None; self.specs.len()];
        self.warn_of_late_events();
        Ok(())
    }

    /// See [`RangePlan::line_density`]; from a few layers spread over the part's height.
    fn infill_line_density(&self) -> f64 {
        let Settings { walls, infill, layers, .. } = &self.settings;
        if infill.density >= 1.0 {
            return infill.density;
        }
        let of_sample = |i: usize| self.specs[(2 * i + 1) * self.specs.len() / (2 * DENSITY_SAMPLES)].slice_z;
        let heights: Vec<f64> = (0..DENSITY_SAMPLES).map(of_sample).collect();
        let bead = Bead { width: walls.width, height: layers.height };
        let sections = self.sections_at(&heights).into_iter();
        let inside: Vec<PolygonSet> =
            sections.map(|area| lay_walls(&area, bead, walls.count).inner).collect();
        line_density(&inside, bead, infill)
    }

    /// See [`RangePlan::seams`]; from every few layers, which is enough to follow a corner.
    fn chain_seams(&self) -> Vec<SeamLine> {
        if self.settings.seam.position != SeamPosition::Aligned || self.settings.walls.count == 0 {
            return Vec::new();
        }
        let every_few = self.specs.iter().step_by(SEAM_STEP);
        let mut heights: Vec<f64> = every_few.chain(self.specs.last()).map(|s| s.slice_z).collect();
        heights.dedup();
        let sections = self.sections_at(&heights);
        let sections: Vec<(f64, PolygonSet)> = heights.into_iter().zip(sections).collect();
        chain_seams(&sections)
    }

    /// Events above the print never happen.
    fn warn_of_late_events(&mut self) {
        let tops: Vec<f64> = self.specs.iter().map(|spec| spec.print_z).collect();
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

    /// Supports of the whole part.
    fn plan_supports(&self) -> Result<Supports, JobError> {
        self.supports(&self.settings.support)
    }

    /// Supports of the whole part by other settings than the job's.
    pub fn supports(&self, options: &SupportOptions) -> Result<Supports, JobError> {
        check_options(options).map_err(JobError::Support)?;
        if options.method == SupportMethod::None {
            return Ok(Supports::default());
        }
        let areas = self.areas();
        let input = SupportInput { mesh: &self.mesh, layers: &self.specs, areas: &areas };
        plan_supports(&input, options, &mut |_, _| true).map_err(JobError::Support)
    }

    /// The part's section in each of its layers.
    pub fn areas(&self) -> Vec<PolygonSet> {
        self.sections_at(&self.part_heights())
    }

    /// The part's section at each of these heights, mm, as it is to be printed.
    fn sections_at(&self, heights: &[f64]) -> Vec<PolygonSet> {
        let sections = slice_mesh(&self.mesh, Axis::Z, heights, PRINT_RESOLUTION);
        sections.into_iter().map(|s| self.settings.walls.expanded(s.area)).collect()
    }

    /// Where the part's layers are cut, mm.
    pub fn part_heights(&self) -> Vec<f64> {
        // Layers of a raft are cut below the part.
        self.specs.iter().map(|s| s.slice_z).filter(|&z| z > 0.0).collect()
    }

    /// Rail, teeth and the outline they are measured to; known after [`Job::prepare`].
    pub fn teeth_drawing(&self) -> Option<&TeethDrawing> {
        self.teeth.as_ref()
    }

    /// The part's first layer as it will be printed on or beside this kind of base.
    pub fn first_outline(&self, kind: AdhesionKind) -> PolygonSet {
        let height = self.part_heights().first().copied().unwrap_or_default();
        let section = self.sections_at(&[height]).pop().unwrap_or_default();
        // On a raft nothing is squeezed against the bed.
        if kind == AdhesionKind::Raft { section } else { draw_in(&section, &self.settings.first_layer) }
    }

    /// The printable area of the bed.
    pub fn bed(&self) -> Bounds {
        self.settings.printer.bed()
    }

    /// What other settings than the job's lay around or below the part without supports.
    pub fn foundation(&self, adhesion: &AdhesionOptions) -> Result<Foundation, JobError> {
        self.lay_foundation(adhesion, &self.first_outline(adhesion.kind), &PolygonSet::EMPTY)
    }

    /// What is laid around or below the first layer of part and supports.
    fn lay_foundation(
        &self,
        adhesion: &AdhesionOptions,
        outline: &PolygonSet,
        supports: &PolygonSet,
    ) -> Result<Foundation, JobError> {
        lay_foundation(&self.first_layer(outline, supports), adhesion).map_err(JobError::Adhesion)
    }

    fn first_layer<'a>(&self, outline: &'a PolygonSet, supports: &'a PolygonSet) -> FirstLayer<'a> {
        let Settings { first_layer, layers, .. } = &self.settings;
        FirstLayer {
            outline,
            supports,
            bed: self.bed(),
            line_width: first_layer.line_width,
            height: layers.first_height,
            next_height: self.specs.get(1).map_or(layers.height, |spec| spec.height),
        }
    }

    /// Puts the raft's layers below the part's.
    fn raise_on(&mut self, foundation: Foundation) {
        let count = foundation.raft.len() as u32;
        let raise = |spec: &LayerSpec| LayerSpec {
            index: spec.index + count,
            print_z: spec.print_z + foundation.lift,
            ..*spec
        };
        let raised: Vec<LayerSpec> = self.specs.iter().map(raise).collect();
        let mut print_z = 0.0;
        let mut spec_of = |(index, layer): (u32, &RaftLayer)| {
            print_z += layer.height;
            // Cut below the part, where nothing is met.
            LayerSpec { index, slice_z: f64::from(index) - f64::from(count), print_z, height: layer.height }
        };
        self.specs = (0..).zip(&foundation.raft).map(&mut spec_of).collect();
        self.specs.extend(raised);
        self.laid.splice(..0, foundation.raft.into_iter().map(|layer| layer.paths));
    }

    /// The layers `first..last` as a piece of work for another engine.
    pub fn share(&self, first: usize, last: usize) -> Share {
        let plan = self.plan(first, last);
        let triangles: Vec<u32> = self.triangles_of(&plan).collect();
        Share::new(plan, &self.mesh, &triangles)
    }

    /// Works the layers `first..last`.
    pub fn slice(&self, first: usize, last: usize, clock: Clock) -> RangeResult {
        let plan = self.plan(first, last);
        let triangles: Vec<u32> = self.triangles_of(&plan).collect();
        range::slice_range(&plan, &self.mesh, triangles.iter().copied(), clock)
    }

    fn plan(&self, first: usize, last: usize) -> RangePlan {
        let halo = range::SkinNeighbours::of(&self.settings);
        // Bridges and overhanging walls look at the layer below, skins or not; a turn of a spiral ends
        // where the next one starts.
        let next = usize::from(self.settings.layers.spiral_vase);
        let low = first.saturating_sub(halo.below.max(1));
        let high = (last + halo.above.max(next)).min(self.specs.len());
        RangePlan {
            settings: self.settings.clone(),
            specs: self.specs[low..high].to_vec(),
            first: first - low,
            last: last - low,
            seams: self.seams.clone(),
            line_density: self.line_density,
            laid: self.laid[first.min(self.laid.len())..last.min(self.laid.len())].to_vec(),
            after: self.after[first.min(self.after.len())..last.min(self.after.len())].to_vec(),
            objects: self.objects.clone(),
        }
    }

    /// Triangles that cross a plane of the plan, in mesh order.
    fn triangles_of(&self, plan: &RangePlan) -> impl Iterator<Item = u32> {
        let planes = plan.specs.first().zip(plan.specs.last());
        let (low, high) = planes.map_or((0.0, 0.0), |(a, b)| (a.slice_z, b.slice_z));
        let crosses = move |[bottom, top]: [f32; 2]| f64::from(bottom) < high && f64::from(top) >= low;
        (0u32..).zip(&self.spans).filter(move |(_, span)| crosses(**span)).map(|(t, _)| t)
    }

    /// Takes in the figures of a worked range.
    pub fn add(&mut self, meta: RangeMeta) {
        self.timing.add(&meta.timing);
        self.warnings.extend(meta.warnings);
        for summary in meta.summaries {
            let place = summary.index as usize;
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
        let notes = FileNotes { head: &[], settings: &self.settings.lines() };
        let options = GcodeOptions { objects: self.objects.clone(), ..self.settings.gcode_options() };
        let joined = join(&summaries, &options, &notes).map_err(JobError::Gcode)?;
        self.timing.gcode += clock() - started;
        self.timing.total = clock() - self.started_ms + self.timing.parse;
        self.warnings.stable_sort_by_key(|w| w.layer);
        let report = self.report(&joined);
        let file_name = self.file_name(report.time_s);
        let layer_times_s = summaries.iter().map(|s| s.time_s).collect();
        Ok(Finished { joined, report, file_name, layer_times_s, teeth: self.teeth })
    }

    fn report(&self, joined: &Joined) -> Report {
        let rows = |m: &DMat4| m.transpose().to_cols_array_2d();
        let placements: Vec<[[f64; 4]; 4]> = self.placements.iter().map(rows).collect();
        let bounds =
            self.mesh.bounds().map_or([[0.0; 3]; 2], |b| [b.min, b.max].map(|v| v.as_dvec3().to_array()));
        let totals = &joined.totals;
        Report {
            engine: engine_name(),
            model: ModelReport {
                triangles: self.mesh.triangles.len(),
                bounds,
                volume_mm3: self.mesh.volume(),
            },
            placement: placements.first().copied().unwrap_or_default(),
            placements,
            layers: self.specs.len(),
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
    if settings.layers.spiral_vase { vase_of(settings) } else { Ok(settings) }
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
