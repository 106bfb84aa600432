//! What is printed together from the bed up: all of the plate, or one model of several.

use std::borrow::Cow;
use std::ops::Range;

use super::place::closed_bed;
use super::range::{self, PRINT_RESOLUTION, RangePlan};
use super::report::{SupportReport, Warning};
use super::{Clock, JobError, adhesion_warning, support_warning, tools};
use crate::adhesion::{
    AdhesionFigures, AdhesionKind, AdhesionOptions, FirstLayer, Foundation, RaftLayer, TeethDrawing,
    lay_foundation,
};
use crate::gcode::LabelledObject;
use crate::mesh::Mesh;
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet};
use crate::region::first_layer::draw_in;
use crate::region::{Bead, Path};
use crate::settings::Settings;
use crate::slice::heights::plan_layers_of;
use crate::slice::{Axis, LayerSpec, slice_triangles};
use crate::support::{SupportInput, SupportMethod, SupportOptions, Supports, check_options, plan_supports};
use crate::toolpath::infill::{InfillOptions, true_lines};
use crate::toolpath::seam::{SeamLine, SeamPosition, chain_seams};
use crate::toolpath::walls::lay_walls;

/// Layers on which the density of sparse infill is measured.
const DENSITY_SAMPLES: usize = 5;

/// Seams are chained on every so many layers.
const SEAM_STEP: usize = 5;

/// Models that are printed together, from their first layer to their last.
#[derive(Debug)]
pub struct Print {
    /// What messages call it; empty for all of the plate.
    name: String,
    settings: Settings,
    mesh: Mesh,
    /// See [`FirstLayer::closed`].
    closed: PolygonSet,
    /// Lowest and highest z of each triangle, so that a range finds its triangles in one pass.
    spans: Vec<[f32; 2]>,
    specs: Vec<LayerSpec>,
    bodies: Vec<Body>,
    /// For each layer the beads of base layers and supports, in printing order.
    laid: Vec<Vec<Path>>,
    /// For each layer the beads of the second tool that come after the part.
    after: Vec<Vec<Path>>,
    /// Rail and teeth to look at; after [`Print::prepare`], only with teeth.
    teeth: Option<TeethDrawing>,
}

/// Models of a print that are made with the same settings.
#[derive(Debug)]
pub(super) struct Body {
    settings: Settings,
    /// Their triangles in the print's mesh.
    triangles: Vec<Range<u32>>,
    /// See [`RangePlan::seams`].
    seams: Vec<SeamLine>,
    /// See [`RangePlan::infill`].
    infill: InfillOptions,
}

impl Body {
    pub(super) fn new(settings: Settings, triangles: Range<u32>) -> Body {
        let infill = settings.infill.clone();
        Body { settings, triangles: vec![triangles], seams: Vec::new(), infill }
    }

    fn triangles(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.triangles.iter().cloned().flatten()
    }
}

/// What the whole job wants to know of a print that has been prepared.
#[derive(Debug, Default)]
pub(super) struct Prepared {
    pub(super) adhesion: AdhesionFigures,
    /// Length of the first layer's outlines, mm.
    pub(super) outline_mm: f64,
    /// `None` without supports.
    pub(super) support: Option<SupportReport>,
    /// Their layers are those of the print.
    pub(super) warnings: Vec<Warning>,
    pub(super) adhesion_ms: f64,
    pub(super) support_ms: f64,
}

/// A range of layers of one body, and the triangles that it needs.
pub(super) struct BodyRange {
    pub(super) plan: RangePlan,
    pub(super) triangles: Vec<u32>,
}

impl Print {
    /// Plans the layers of models that stand on the bed; `bodies` tells which settings are for which
    /// triangles.
    pub(super) fn new(
        name: String,
        mesh: Mesh,
        bodies: Vec<Body>,
        settings: Settings,
    ) -> Result<Print, JobError> {
        let height = mesh.bounds().map_or(0.0, |b| f64::from(b.max.z));
        if height <= 0.0 {
            return Err(JobError::Empty);
        }
        let bodies = joined(bodies);
        if settings.layers.spiral_vase && bodies.len() > 1 {
            let cause = "models of different settings can be vases with print.sequence=by_object only";
            return Err(JobError::contradiction("layers.spiral_vase", cause.to_owned()));
        }
        let z_span = |t: usize| {
            let [a, b, c] = mesh.corners(t).map(|v| v.z);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        Ok(Print {
            specs: plan_layers_of(&mesh, height, &settings.layers),
            spans: (0..mesh.triangles.len()).map(z_span).collect(),
            bodies,
            name,
            laid: Vec::new(),
            after: Vec::new(),
            teeth: None,
            closed: closed_bed(&settings.printer),
            settings,
            mesh,
        })
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Height of the last layer's top, mm.
    pub(super) fn top(&self) -> f64 {
        self.specs.last().map_or(0.0, |spec| spec.print_z)
    }

    /// The layer plan, from the bed up; a raft adds layers in [`Print::prepare`].
    pub fn specs(&self) -> &[LayerSpec] {
        &self.specs
    }

    /// The models in bed coordinates.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The settings; models of the print may have their own for walls, fills and the like.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Works out what all layers share. To be called once, before any range; a raft adds layers.
    pub(super) fn prepare(&mut self, clock: Clock) -> Result<Prepared, JobError> {
        let started = clock();
        let supports: Vec<Supports> =
            self.bodies.iter().map(|body| self.body_supports(body)).collect::<Result<_, _>>()?;
        let supported = clock();
        let bed_areas: Vec<PolygonSet> = supports.iter().map(Supports::bed_area).collect();
        let adhesion = &self.settings.adhesion;
        let outline = self.first_outline(adhesion.kind);
        let foundation = self.lay_foundation(adhesion, &outline, &PolygonSet::union_all(&bed_areas))?;
        let adhesion_ms = clock() - supported;
        self.teeth.clone_from(&foundation.drawing);
        let followed: Vec<(InfillOptions, Vec<SeamLine>)> =
            self.bodies.iter().map(|b| (self.true_infill(b), self.chain_seams(b))).collect();
        for (body, (infill, seams)) in self.bodies.iter_mut().zip(followed) {
            (body.infill, body.seams) = (infill, seams);
        }
        let told = foundation.warnings.iter().map(adhesion_warning);
        let found = supports.iter().flat_map(|s| s.warnings().iter().map(support_warning));
        let prepared = Prepared {
            adhesion: foundation.figures,
            outline_mm: outline.length(),
            support: SupportReport::of(&supports),
            warnings: told.chain(found).collect(),
            adhesion_ms,
            support_ms: supported - started,
        };
        let of_layer = |k: usize| supports.iter().flat_map(|s| s.layer_paths(k)).collect();
        self.laid = (0..self.specs.len()).map(of_layer).collect();
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
        Ok(prepared)
    }

    /// See [`RangePlan::infill`]; from a few layers spread over the models' height.
    fn true_infill(&self, body: &Body) -> InfillOptions {
        let Settings { walls, infill, layers, .. } = &body.settings;
        if infill.density >= 1.0 {
            return infill.clone();
        }
        let specs = self.specs_of(body);
        let of_sample = |i: usize| specs[(2 * i + 1) * specs.len() / (2 * DENSITY_SAMPLES)].slice_z;
        let heights: Vec<f64> = (0..DENSITY_SAMPLES).map(of_sample).collect();
        let bead = Bead { width: walls.width, height: layers.height };
        let sections = self.body_sections(body, &heights).into_iter();
        let inside: Vec<PolygonSet> =
            sections.map(|area| lay_walls(&area, bead, walls.count).inner).collect();
        true_lines(&inside, bead, infill)
    }

    /// See [`RangePlan::seams`]; from every few layers, which is enough to follow a corner.
    fn chain_seams(&self, body: &Body) -> Vec<SeamLine> {
        if body.settings.seam.position != SeamPosition::Aligned || body.settings.walls.count == 0 {
            return Vec::new();
        }
        let specs = self.specs_of(body);
        let every_few = specs.iter().step_by(SEAM_STEP);
        let mut heights: Vec<f64> = every_few.chain(specs.last()).map(|s| s.slice_z).collect();
        heights.dedup();
        let sections = self.body_sections(body, &heights);
        let sections: Vec<(f64, PolygonSet)> = heights.into_iter().zip(sections).collect();
        chain_seams(&sections)
    }

    /// The layers up to a body's top; at least one.
    fn specs_of(&self, body: &Body) -> &[LayerSpec] {
        let top = body.triangles().map(|t| f64::from(self.spans[t as usize][1])).fold(0.0, f64::max);
        &self.specs[..self.specs.partition_point(|spec| spec.slice_z < top).max(1)]
    }

    fn body_supports(&self, body: &Body) -> Result<Supports, JobError> {
        let mesh = || match self.bodies.len() {
            1 => Cow::Borrowed(&self.mesh),
            _ => Cow::Owned(self.mesh.subset(body.triangles().map(|t| t as usize))),
        };
        let areas = || self.body_sections(body, &self.part_heights());
        self.supports_of(&|| (mesh(), areas()), &body.settings.support)
    }

    /// Supports of all models by other settings than the print's.
    pub fn supports(&self, options: &SupportOptions) -> Result<Supports, JobError> {
        self.supports_of(&|| (Cow::Borrowed(&self.mesh), self.areas()), options)
    }

    /// Supports of some models; `models` cuts them, which is not done without supports.
    fn supports_of<'a>(
        &'a self,
        models: &dyn Fn() -> (Cow<'a, Mesh>, Vec<PolygonSet>),
        options: &SupportOptions,
    ) -> Result<Supports, JobError> {
        check_options(options).map_err(JobError::Support)?;
        if options.method == SupportMethod::None {
            return Ok(Supports::default());
        }
        let (mesh, areas) = models();
        let input = SupportInput { mesh: &mesh, layers: &self.specs, areas: &areas };
        plan_supports(&input, options, &mut |_, _| true).map_err(JobError::Support)
    }

    /// The section in each of the models' layers.
    pub fn areas(&self) -> Vec<PolygonSet> {
        self.sections_at(&self.part_heights())
    }

    /// The section at each of these heights, mm, as it is to be printed.
    fn sections_at(&self, heights: &[f64]) -> Vec<PolygonSet> {
        if let [body] = &self.bodies[..] {
            return self.body_sections(body, heights);
        }
        let all: Vec<Vec<PolygonSet>> =
            self.bodies.iter().map(|body| self.body_sections(body, heights)).collect();
        (0..heights.len()).map(|k| PolygonSet::union_all(all.iter().map(|areas| &areas[k]))).collect()
    }

    fn body_sections(&self, body: &Body, heights: &[f64]) -> Vec<PolygonSet> {
        let sections = slice_triangles(&self.mesh, body.triangles(), Axis::Z, heights, PRINT_RESOLUTION);
        sections.into_iter().map(|s| body.settings.walls.expanded(s.area)).collect()
    }

    /// Where the models' layers are cut, mm.
    pub fn part_heights(&self) -> Vec<f64> {
        // Layers of a raft are cut below the part.
        self.specs.iter().map(|s| s.slice_z).filter(|&z| z > 0.0).collect()
    }

    /// Rail, teeth and the outline they are measured to; known after [`Print::prepare`].
    pub fn teeth_drawing(&self) -> Option<&TeethDrawing> {
        self.teeth.as_ref()
    }

    /// The models' first layer as it will be printed on or beside this kind of base.
    pub fn first_outline(&self, kind: AdhesionKind) -> PolygonSet {
        let height = self.part_heights().first().copied().unwrap_or_default();
        let section = self.sections_at(&[height]).pop().unwrap_or_default();
        // On a raft nothing is squeezed against the bed.
        if kind == AdhesionKind::Raft { section } else { draw_in(&section, &self.settings.first_layer) }
    }

    /// The box around the bed.
    pub fn bed(&self) -> Bounds {
        self.settings.printer.bed()
    }

    /// What other settings than the print's lay around or below the models without supports.
    pub fn foundation(&self, adhesion: &AdhesionOptions) -> Result<Foundation, JobError> {
        self.lay_foundation(adhesion, &self.first_outline(adhesion.kind), &PolygonSet::EMPTY)
    }

    /// What is laid around or below the first layer of models and supports.
    pub(super) fn lay_foundation(
        &self,
        adhesion: &AdhesionOptions,
        outline: &PolygonSet,
        supports: &PolygonSet,
    ) -> Result<Foundation, JobError> {
        lay_foundation(&self.first_layer(outline, supports), adhesion).map_err(JobError::Adhesion)
    }

    pub(super) fn first_layer<'a>(
        &'a self,
        outline: &'a PolygonSet,
        supports: &'a PolygonSet,
    ) -> FirstLayer<'a> {
        let Settings { first_layer, layers, .. } = &self.settings;
        FirstLayer {
            outline,
            supports,
            bed: self.bed(),
            closed: &self.closed,
            line_width: first_layer.line_width,
            height: layers.first_height,
            next_height: self.specs.get(1).map_or(layers.height, |spec| spec.height),
        }
    }

    /// Puts the raft's layers below the models'.
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

    /// The layers `first..last` of each body.
    pub(super) fn ranges(&self, first: usize, last: usize, objects: &[LabelledObject]) -> Vec<BodyRange> {
        let of_body = |place: usize| {
            let plan = self.plan(place, first, last, objects);
            let triangles = self.triangles_of(&self.bodies[place], &plan);
            BodyRange { plan, triangles }
        };
        (0..self.bodies.len()).map(of_body).collect()
    }

    fn plan(&self, place: usize, first: usize, last: usize, objects: &[LabelledObject]) -> RangePlan {
        let body = &self.bodies[place];
        let halos = || self.bodies.iter().map(|b| range::SkinNeighbours::of(&b.settings));
        // Bridges and overhanging walls look at the layer below, skins or not; a turn of a spiral ends
        // where the next one starts.
        let next = usize::from(body.settings.layers.spiral_vase);
        let low = first.saturating_sub(halos().map(|halo| halo.below).fold(1, usize::max));
        let high = (last + halos().map(|halo| halo.above).fold(next, usize::max)).min(self.specs.len());
        // What is printed before all bodies comes with the first one, what is printed after with the last.
        let part_of = |all: &[Vec<Path>], is_mine: &dyn Fn(usize) -> bool| -> Vec<Vec<Path>> {
            let mine = |k: usize| if is_mine(k) { all[k].clone() } else { Vec::new() };
            (first.min(all.len())..last.min(all.len())).map(mine).collect()
        };
        let count = self.bodies.len();
        let turn = |k: usize| range::in_turn(k as u32, place, count);
        RangePlan {
            settings: body.settings.clone(),
            specs: self.specs[low..high].to_vec(),
            first: first - low,
            last: last - low,
            seams: body.seams.clone(),
            infill: body.infill.clone(),
            laid: part_of(&self.laid, &|k| turn(k) == 0),
            after: part_of(&self.after, &|k| turn(k) + 1 == count),
            objects: objects.to_vec(),
        }
    }

    /// Triangles of a body that cross a plane of the plan, in mesh order.
    fn triangles_of(&self, body: &Body, plan: &RangePlan) -> Vec<u32> {
        let planes = plan.specs.first().zip(plan.specs.last());
        let (low, high) = planes.map_or((0.0, 0.0), |(a, b)| (a.slice_z, b.slice_z));
        let crosses = |&t: &u32| {
            let [bottom, top] = self.spans[t as usize];
            f64::from(bottom) < high && f64::from(top) >= low
        };
        body.triangles().filter(crosses).collect()
    }

    /// Places that the nozzle comes to above `height` mm: corners of the models, and points of base
    /// layers and supports, mm.
    pub(super) fn reach(&self, height: f64) -> Vec<DVec2> {
        let flat = |v: &glam::Vec3| v.as_dvec3().truncate();
        let above = self.specs.partition_point(|spec| spec.print_z <= height);
        let laid = self.laid.iter().skip(above).flatten().flat_map(|path| &path.points);
        self.mesh.vertices.iter().map(flat).chain(laid.copied()).collect()
    }
}

/// Bodies of equal settings as one.
fn joined(bodies: Vec<Body>) -> Vec<Body> {
    let mut all: Vec<Body> = Vec::new();
    for body in bodies {
        match all.iter_mut().find(|known| known.settings == body.settings) {
            Some(known) => known.triangles.extend(body.triangles),
            None => all.push(body),
        }
    }
    all
}
