//! A range of layers from mesh to G-code. Any engine can do any range; equal layers come out equal
//! whoever made them.

use serde::{Deserialize, Serialize};

use super::report::{Timing, Warning};
use super::{Clock, Finding, check, vase};
use crate::gcode::{GcodeOptions, LabelledObject, LayerInput, LayerSummary, Spiral, layer_gcode};
use crate::mesh::Mesh;
use crate::options::saved;
use crate::polygon::{DVec2, Join, Polygon, PolygonSet};
use crate::region::bridge::{Bridge, bridges};
use crate::region::first_layer::draw_in;
use crate::region::shell::{Division, Exposure, Shells, divide, exposure, hair_of_walls};
use crate::region::{Bead, Path, Region, Role, Width};
use crate::settings::Settings;
use crate::slice::{Axis, LayerSpec, Section, slice_triangles};
use crate::support::SupportMethod;
use crate::toolpath::infill::lines::{Hatch, hatch_linked};
use crate::toolpath::infill::{InfillLayer, InfillOptions, fill_solid, fill_sparse, fill_surface};
use crate::toolpath::ironing::iron;
use crate::toolpath::medial::{ThinFill, carried_to_walls, fill_thin};
use crate::toolpath::overhang::mark_overhangs;
use crate::toolpath::seam::{SeamLine, place_seams};
use crate::toolpath::spots::fill_spots;
use crate::toolpath::walls::{fill_narrow, lay_walls};
use crate::toolpath::{LayerParts, LayerPaths, Way, order_layer};

/// By how much a contour may be simplified for printing, mm: an eighth of what a printer's
/// positioning resolves.
pub const PRINT_RESOLUTION: f64 = 0.0125;

/// A line of seams is taken to go on this far above and below the heights at which it was found, mm:
/// about as far as those are apart.
const SEAM_REACH: f64 = 1.0;

/// What a range of layers of one body, models of a print with the same settings, needs to know besides its triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RangePlan {
    /// All settings of the body's models.
    #[serde(with = "saved")]
    pub settings: Settings,
    /// The layers to print and the neighbours that decide about their skins.
    pub specs: Vec<LayerSpec>,
    /// Place in `specs` of the first layer to print.
    pub first: usize,
    /// Place in `specs` after the last layer to print.
    pub last: usize,
    /// Where the seams of outer walls run up the part.
    pub seams: Vec<SeamLine>,
    /// How sparse infill is laid, so that with what joins its lines the print as a whole has the
    /// density that is set.
    #[serde(with = "saved")]
    pub infill: InfillOptions,
    /// For each layer to print what the global phase has laid, base layers and supports, in
    /// printing order; printed before the part.
    pub laid: Vec<Vec<Path>>,
    /// For each layer to print what another tool lays after the part.
    pub after: Vec<Vec<Path>>,
    /// Objects whose moves are marked.
    pub objects: Vec<LabelledObject>,
}

/// A range of layers of one body, with what it is cut from.
#[derive(Clone, Copy)]
pub(super) struct BodyPiece<'a> {
    pub(super) plan: &'a RangePlan,
    pub(super) mesh: &'a Mesh,
    /// Triangles that cross the planes of `plan.specs`, all of them, in mesh order.
    pub(super) triangles: &'a [u32],
}

/// Layers that follow on one another, made ready for an engine that does not hold the job.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Share {
    /// Place in the file of the first layer.
    first: usize,
    runs: Vec<SharedRun>,
}

/// Layers of one print.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SharedRun {
    /// Layers of the file before the print's first one.
    before: u32,
    bodies: Vec<(RangePlan, Mesh)>,
}

impl Share {
    /// A share without layers, which will begin at the file's layer `first`.
    pub(super) fn beginning_at(first: usize) -> Share {
        Share { first, runs: Vec::new() }
    }

    /// Adds layers of a print; of each mesh only the triangles that are needed.
    pub(super) fn push(&mut self, before: u32, bodies: &[BodyPiece<'_>]) {
        let own =
            |b: &BodyPiece<'_>| (b.plan.clone(), b.mesh.subset(b.triangles.iter().map(|&t| t as usize)));
        self.runs.push(SharedRun { before, bodies: bodies.iter().map(own).collect() });
    }

    /// Works the layers.
    pub fn slice(self, clock: Clock) -> RangeResult {
        let mut result = RangeResult::beginning_at(self.first);
        for SharedRun { before, bodies } in &self.runs {
            let all: Vec<Vec<u32>> =
                bodies.iter().map(|(_, mesh)| (0..mesh.triangles.len() as u32).collect()).collect();
            let pieces = bodies.iter().zip(&all);
            let pieces: Vec<BodyPiece<'_>> =
                pieces.map(|((plan, mesh), triangles)| BodyPiece { plan, mesh, triangles }).collect();
            result.add_run(*before, &pieces, clock);
        }
        result
    }
}

/// The G-code of layers that follow on one another.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RangeResult {
    /// Text of each layer.
    pub texts: Vec<Vec<u8>>,
    /// Everything else.
    pub meta: RangeMeta,
}

/// What the join needs of a range; small.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RangeMeta {
    /// Place in the file of the first layer.
    pub first: usize,
    /// Figures of each layer.
    pub summaries: Vec<LayerSummary>,
    /// Remarks on these layers.
    pub warnings: Vec<Warning>,
    /// Weak places of these layers.
    pub findings: Vec<Finding>,
    /// Where the time went.
    pub timing: Timing,
}

impl RangeResult {
    /// A result without layers, which will begin at the file's layer `first`.
    pub(super) fn beginning_at(first: usize) -> RangeResult {
        RangeResult { meta: RangeMeta { first, ..RangeMeta::default() }, ..RangeResult::default() }
    }

    /// Works layers of one print, which has `before` layers of the file before it.
    pub(super) fn add_run(&mut self, before: u32, bodies: &[BodyPiece<'_>], clock: Clock) {
        let (told, found) = (self.meta.warnings.len(), self.meta.findings.len());
        let bodies = cut_bodies(bodies, &mut self.meta, clock);
        self.write(&bodies, clock);
        self.meta.warnings[told..].iter_mut().for_each(|warning| warning.raise(before));
        self.meta.findings[found..].iter_mut().for_each(|finding| finding.raise(before));
    }

    /// Lays and writes the layers, body after body on each of them.
    fn write(&mut self, bodies: &[BodyLayers<'_>], clock: Clock) {
        let Some(BodyLayers { plan, .. }) = bodies.first() else { return };
        let options = GcodeOptions { objects: plan.objects.clone(), ..plan.settings.gcode_options() };
        let own: Vec<GcodeOptions> = bodies[1..].iter().map(|b| b.plan.settings.gcode_options()).collect();
        let options_of = |body: usize| if body == 0 { &options } else { &own[body - 1] };
        for (k, spec) in plan.specs[plan.first..plan.last].iter().enumerate() {
            let mut order = (0..bodies.len()).map(|turn| in_turn(spec.index, turn, bodies.len()));
            let first = order.next().unwrap_or_default();
            let (mut paths, spiral) = bodies[first].lay(k, &mut self.meta, clock);
            let mut own_from = vec![(0, options_of(first))];
            for body in order {
                own_from.push((paths.paths.len(), options_of(body)));
                // A vase has one body only.
                let (more, _) = bodies[body].lay(k, &mut self.meta, clock);
                paths.paths.extend(more.paths);
                paths.ways.extend(more.ways);
            }
            let before = clock();
            let input = LayerInput {
                index: spec.index,
                print_z: spec.print_z,
                height: spec.height,
                spiral,
                paths: &paths.paths,
                ways: &paths.ways,
                own: &own_from,
            };
            let written = layer_gcode(&input, &options);
            self.texts.push(written.text);
            self.meta.summaries.push(written.summary);
            self.meta.timing.gcode += clock() - before;
        }
    }
}

/// Place of a body among `count` in the order of layer `index`, and the other way round: odd layers go
/// back, as their islands do, so that a layer begins near where the one below ends.
pub(super) fn in_turn(index: u32, place: usize, count: usize) -> usize {
    if index.is_multiple_of(2) { place } else { count - 1 - place }
}

/// The layers of a body before beads are laid.
struct BodyLayers<'a> {
    plan: &'a RangePlan,
    /// Section of each of the plan's layers.
    areas: Vec<PolygonSet>,
    exposures: Vec<Exposure>,
}

impl BodyLayers<'_> {
    /// The beads of the `k`th layer to print, and how the nozzle rises along them.
    fn lay(&self, k: usize, meta: &mut RangeMeta, clock: Clock) -> (LayerPaths, Option<Spiral>) {
        let BodyLayers { plan, areas, exposures } = self;
        let place = plan.first + k;
        if let Some(turn) = vase::turn_of(plan, place, areas) {
            let spiral = if turn.is_first { Spiral::First } else { Spiral::Next };
            return (LayerPaths { paths: vec![turn.wall], ways: vec![Way::ACROSS] }, Some(spiral));
        }
        let neighbours = Neighbours { below: place.checked_sub(1).map(|b| &areas[b]), exposures };
        (lay_paths(plan, place, &areas[place], neighbours, meta, clock), None)
    }
}

/// Cuts the bodies of a print. Where two of them overlap, the earlier one has the place.
fn cut_bodies<'a>(bodies: &[BodyPiece<'a>], meta: &mut RangeMeta, clock: Clock) -> Vec<BodyLayers<'a>> {
    let mut cut: Vec<BodyLayers<'a>> = Vec::new();
    for &BodyPiece { plan, mesh, triangles } in bodies {
        let started = clock();
        let heights: Vec<f64> = plan.specs.iter().map(|s| s.slice_z).collect();
        let sections = slice_triangles(mesh, triangles.iter().copied(), Axis::Z, &heights, PRINT_RESOLUTION);
        meta.warnings.extend(gap_warnings(plan, &sections));
        let mut areas: Vec<PolygonSet> =
            sections.into_iter().map(|s| plan.settings.walls.expanded(s.area)).collect();
        for earlier in &cut {
            for (area, taken) in areas.iter_mut().zip(&earlier.areas) {
                *area = area.difference(taken);
            }
        }
        meta.warnings.extend(vase::flat_warnings(plan, &areas));
        let sliced = clock();
        let exposures = expose(plan, &areas);
        meta.timing.slice += sliced - started;
        meta.timing.regions += clock() - sliced;
        meta.warnings.extend(floating_islands(plan, &areas, &exposures));
        cut.push(BodyLayers { plan, areas, exposures });
    }
    cut
}

/// One warning for each printed layer whose contours had to be closed, with its widest opening.
fn gap_warnings(plan: &RangePlan, sections: &[Section]) -> Vec<Warning> {
    let printed = plan.specs[plan.first..plan.last].iter().zip(&sections[plan.first..plan.last]);
    let worst = |section: &Section| section.gaps.iter().copied().max_by(|a, b| a.length.total_cmp(&b.length));
    let warn = |(spec, section): (&LayerSpec, &Section)| {
        let gap = worst(section)?;
        let message = format!(
            "the mesh is open here: {} gap(s) in the outline closed by straight lines, the widest {:.2} mm",
            section.gaps.len(),
            gap.length
        );
        Some(Warning::on_layer("gap_closed", message, spec.index, gap.at))
    };
    printed.filter_map(warn).collect()
}

/// Islands that nothing holds. Where there are supports these tell what they leave uncovered.
fn floating_islands(plan: &RangePlan, areas: &[PolygonSet], exposures: &[Exposure]) -> Vec<Warning> {
    // Without skins at the bottom a range does not know the layer below it.
    let is_known = SkinNeighbours::of(&plan.settings).below > 0;
    if plan.settings.support.method != SupportMethod::None || !is_known {
        return Vec::new();
    }
    // What is narrower than two hairs counts as nothing bare.
    let narrow = plan.settings.walls.width / 2.0 + SKIN_RESOLUTION;
    let on_layer = |place: usize| {
        let Some(below) = place.checked_sub(1).filter(|&b| plan.specs[b].slice_z > 0.0) else {
            return Vec::new();
        };
        let (area, index) = (&areas[place], plan.specs[place].index);
        // A layer with nothing bare below has no such island but narrow ones.
        match exposures[place].bottom.is_empty() {
            true => check::floating(&check::narrow(area, narrow), &areas[below], index),
            false => check::floating(area, &areas[below], index),
        }
    };
    (plan.first..plan.last).flat_map(on_layer).collect()
}

/// Skins need not follow the outline closer than this, mm: a tenth of a bead.
const SKIN_RESOLUTION: f64 = 0.04;

/// Bare tops and bottoms of every layer that has its neighbours at hand.
fn expose(plan: &RangePlan, areas: &[PolygonSet]) -> Vec<Exposure> {
    let SkinNeighbours { above, below } = SkinNeighbours::of(&plan.settings);
    let walls = &plan.settings.walls;
    let hair = hair_of_walls(walls.width * f64::from(walls.count), above.max(below) as u32);
    let hair = hair.min(walls.width / 2.0);
    let rough: Vec<PolygonSet> = areas.iter().map(|a| a.roughened(SKIN_RESOLUTION.min(hair / 2.0))).collect();
    let low = plan.first.saturating_sub(below.saturating_sub(1));
    let high = (plan.last + above.saturating_sub(1)).min(areas.len());
    let expose_at = |i: usize| match (low..high).contains(&i) {
        true => exposure(i.checked_sub(1).map(|b| &rough[b]), &rough[i], rough.get(i + 1), hair),
        false => Exposure::default(),
    };
    (0..areas.len()).map(expose_at).collect()
}

/// How many layers above and below a layer decide about its skins.
pub(super) struct SkinNeighbours {
    pub above: usize,
    pub below: usize,
}

impl SkinNeighbours {
    pub(super) fn of(settings: &Settings) -> SkinNeighbours {
        let skin = &settings.skin;
        SkinNeighbours { above: skin.top_layers as usize, below: skin.bottom_layers as usize }
    }
}

/// Lets solid regions reach into each other and into sparse infill as far as they do into walls, so that
/// no gaps stay open between their lines.
fn reach_over(regions: &mut [Region], overlap: f64, inner: &PolygonSet) {
    if regions.len() < 2 {
        return;
    }
    for region in regions.iter_mut().filter(|region| region.role != Role::Infill) {
        region.area = region.area.offset(overlap, Join::WALL).intersection(inner);
    }
}

/// Fills need not follow the innermost wall closer than this, mm: they reach into it farther.
const FILL_RESOLUTION: f64 = 0.03;

/// Skins, solid and sparse infill inside the walls of the layer at `place`.
fn divide_inside(
    inner: &PolygonSet,
    settings: &Settings,
    place: usize,
    exposures: &[Exposure],
    bead_width: f64,
) -> Vec<Region> {
    let SkinNeighbours { above, below } = SkinNeighbours::of(settings);
    let tops: Vec<&PolygonSet> = exposures[place..].iter().take(above).map(|e| &e.top).collect();
    let bottoms: Vec<&PolygonSet> = exposures[..=place].iter().rev().take(below).map(|e| &e.bottom).collect();
    let infill = &settings.infill;
    let solid_below = match infill.density {
        0.0 => 0.0,
        1.0 => f64::INFINITY,
        _ => infill.solid_below_area,
    };
    divide(inner, &Shells { tops: &tops, bottoms: &bottoms }, Division { bead_width, solid_below })
}

/// What a layer's paths depend on besides its own area.
#[derive(Clone, Copy)]
struct Neighbours<'a> {
    /// Area of the layer below.
    below: Option<&'a PolygonSet>,
    /// Bare tops and bottoms of all layers at hand.
    exposures: &'a [Exposure],
}

/// Lines along a bridge with this share of the usual plastic, and what is too narrow for them. Nothing
/// beside a bridge carries a strip that they leave, so they are spread over all of it.
fn fill_bridge(bridge: &Bridge, bead: Bead, flow: f64) -> (Vec<Path>, PolygonSet) {
    let usual = Hatch::along(bridge.direction, bead.spacing());
    let hatch = usual.fitted(&bridge.area).unwrap_or(usual);
    let bead = Bead { width: bead.width + hatch.distance() - usual.distance(), ..bead };
    let (paths, narrow) = hatch_linked(&bridge.area, Role::Bridge, bead, hatch);
    let thinned = |width: f64| Bead { width, ..bead }.with_flow(flow).width;
    let with_flow = |path: Path| {
        let width = match path.width {
            Width::Uniform(width) => Width::Uniform(thinned(width)),
            Width::Varying(widths) => Width::Varying(widths.into_iter().map(thinned).collect()),
        };
        Path { width, ..path }
    };
    (paths.into_iter().map(with_flow).collect(), narrow)
}

/// Thin places whose middle line was not found, told by the first of them.
fn fallback_warning(places: &[DVec2], layer: u32) -> Option<Warning> {
    let message = format!(
        "no middle line found in {} thin place(s): loops follow the outline there and may leave gaps",
        places.len()
    );
    places.first().map(|&at| Warning::on_layer("thin_place_outlined", message, layer, at))
}

/// A place for single beads, and by how much these are wider than it, mm.
type ThinPlace = (PolygonSet, f64);

/// Lays the fills of one layer.
struct LayerFills<'a> {
    plan: &'a RangePlan,
    spec: &'a LayerSpec,
    bead: Bead,
    /// How far the areas to fill reach into the innermost wall, mm.
    overlap: f64,
}

impl LayerFills<'_> {
    /// Lays regions and bridges; gives what is too narrow for their lines.
    fn fill_areas(
        &self,
        regions: Vec<Region>,
        bridges: Vec<Bridge>,
        parts: &mut LayerParts,
    ) -> Vec<ThinPlace> {
        let settings = &self.plan.settings;
        // The area reaches into the walls already, as far as skins do.
        let reach = (settings.infill.overlap - settings.skin.overlap).max(0.0);
        let sparse = InfillOptions { overlap: reach, ..self.plan.infill.clone() };
        let mut narrow_places = Vec::new();
        for region in regions {
            narrow_places.extend(self.fill_region(region, &sparse, parts));
        }
        for bridge in bridges {
            let (paths, narrow) = fill_bridge(&bridge, self.bead, settings.skin.bridge_flow);
            parts.fills.extend(paths);
            narrow_places.push((narrow, self.wider_beside_fills()));
        }
        narrow_places
    }

    /// What fills leave over has their overlap with the walls in it.
    fn wider_beside_fills(&self) -> f64 {
        self.bead.overlap() - 2.0 * self.overlap
    }

    /// Lays a region as its role asks; gives what is too narrow for solid lines.
    fn fill_region(&self, region: Region, sparse: &InfillOptions, parts: &mut LayerParts) -> Vec<ThinPlace> {
        let LayerFills { plan: RangePlan { settings, .. }, spec, bead, .. } = *self;
        if region.role == Role::TopSkin && settings.ironing.enabled {
            parts.fills.extend(iron(&region.area, spec.height, spec.index, &settings.ironing));
        }
        if region.role == Role::Infill {
            let layer = InfillLayer { index: spec.index, z: spec.print_z };
            parts.fills.extend(fill_sparse(&region.area, bead, layer, sparse));
            return Vec::new();
        }
        if matches!(region.role, Role::TopSkin | Role::BottomSkin) && settings.skin.monotonic {
            let (rows, narrow) = fill_surface(&region.area, region.role, bead, spec.index);
            parts.rows.extend(rows);
            return vec![(narrow, self.wider_beside_fills())];
        }
        let mut wide = Vec::new();
        let mut thin = Vec::new();
        for island in region.area.islands().into_iter().map(Polygon::into_set) {
            let Some(loops) = fill_narrow(&island, region.role, bead) else {
                wide.extend(island.into_contours());
                continue;
            };
            parts.fills.extend(loops.loops.into_iter().map(|(_, path)| path));
            thin.extend([(loops.thin_outer, 0.0), (loops.thin_inner, bead.overlap())]);
        }
        let (paths, narrow) = fill_solid(&PolygonSet::canonical(wide), region.role, bead, spec.index);
        parts.fills.extend(paths);
        thin.push((narrow, self.wider_beside_fills()));
        thin
    }

    /// Fills walls thinner than two beads, and what walls and fills leave between them; gives the places
    /// whose outline is followed for want of a middle line.
    fn fill_thin_places(
        &self,
        thin_walls: &PolygonSet,
        outline: &PolygonSet,
        gaps: Vec<ThinPlace>,
        parts: &mut LayerParts,
    ) -> Vec<DVec2> {
        let nozzle = self.plan.settings.printer.nozzle_diameter;
        let single = fill_thin(thin_walls, &ThinFill::for_nozzle(nozzle, Role::OuterWall));
        let mut fallbacks = single.fallbacks;
        if !single.paths.is_empty() {
            parts.fills.extend(carried_to_walls(single.paths, thin_walls, outline));
        }
        // A bead between others overlaps them with its round sides, so it is wider than its gap.
        let gap = |by: f64| {
            let options = ThinFill::for_nozzle(nozzle, Role::GapFill);
            ThinFill { min_width: options.min_width - by, max_width: options.max_width - by, ..options }
        };
        for (area, wider) in gaps {
            let beads = fill_thin(&area, &gap(wider));
            parts.fills.extend(beads.paths.into_iter().map(|path| path.widened(wider)));
            fallbacks.extend(beads.fallbacks);
        }
        fallbacks
    }
}

/// Starts the outer walls where their seams run.
fn set_seams(plan: &RangePlan, spec: &LayerSpec, parts: &mut LayerParts) {
    let seams: Vec<DVec2> = plan.seams.iter().filter_map(|s| s.at(spec.slice_z, SEAM_REACH)).collect();
    let mut outer: Vec<&mut Path> =
        parts.walls.iter_mut().filter(|(depth, _)| *depth == 0).map(|(_, path)| path).collect();
    place_seams(&mut outer, &plan.settings.seam, &seams, spec.index);
}

/// Walls, fills and foundation of one layer, in printing order.
fn lay_paths(
    plan: &RangePlan,
    place: usize,
    area: &PolygonSet,
    Neighbours { below, exposures }: Neighbours<'_>,
    meta: &mut RangeMeta,
    clock: Clock,
) -> LayerPaths {
    let started = clock();
    let (settings, spec) = (&plan.settings, &plan.specs[place]);
    let is_first = spec.index == 0;
    // On a raft layer 0 holds nothing of the part, and its area is empty.
    let outline = if is_first { draw_in(area, &settings.first_layer) } else { area.clone() };
    let width = if is_first { settings.first_layer.line_width } else { settings.walls.width };
    let bead = Bead { width, height: spec.height };
    let walls = lay_walls(&outline, bead, settings.walls.count);

    let before_regions = clock();
    // The first layer lies on the bed, and what lies on a raft has no layer below to span.
    let over_air = below.filter(|below| !below.is_empty() && !exposures[place].bottom.is_empty());
    let overlap = if settings.walls.count > 0 { settings.skin.overlap * width } else { 0.0 };
    let inner = walls.inner.roughened(FILL_RESOLUTION).offset(overlap, Join::WALL);
    let mut regions = divide_inside(&inner, settings, place, exposures, width);
    let bridges = over_air.map_or_else(Vec::new, |below| bridges(&inner, below, width));
    reach_over(&mut regions, overlap, &inner);
    for region in &mut regions {
        region.area = bridges.iter().fold(std::mem::take(&mut region.area), |a, b| a.difference(&b.area));
    }
    let after_regions = clock();

    let findings = check::Findings { layer: spec.index, settings };
    if let Some(below) = over_air {
        meta.findings.extend(findings.over_air(&exposures[place].bottom, below, &bridges));
    }
    let fills = LayerFills { plan, spec, bead, overlap };
    let mut parts = LayerParts { walls: walls.loops, ..LayerParts::default() };
    parts.foundation = plan.laid.get(place - plan.first).cloned().unwrap_or_default();
    parts.after = plan.after.get(place - plan.first).cloned().unwrap_or_default();
    let mut gaps = vec![(walls.thin_inner, bead.overlap())];
    gaps.extend(fills.fill_areas(regions, bridges, &mut parts));
    let fallbacks = fills.fill_thin_places(&walls.thin_outer, &outline, gaps, &mut parts);
    let nozzle = settings.printer.nozzle_diameter;
    fill_spots(&mut parts, &walls.close, &outline, &(0.5 * nozzle..=2.0 * nozzle));
    meta.warnings.extend(fallback_warning(&fallbacks, spec.index));
    meta.findings.extend(findings.thin_walls(&parts));
    meta.findings.extend(findings.lost_walls(&walls.lost));
    set_seams(plan, spec, &mut parts);
    let ordered = order_layer(parts, &outline, spec.index, settings.seam.position);
    let ordered = match over_air {
        Some(below) => mark_overhangs(ordered, below, &exposures[place].bottom, width),
        None => ordered,
    };
    meta.timing.regions += after_regions - before_regions;
    meta.timing.toolpath += clock() - after_regions + before_regions - started;
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn thin_places_that_are_outlined_are_told_once_a_layer_with_the_first_place() {
        assert_eq!(fallback_warning(&[], 3), None);
        let told = fallback_warning(&[dvec2(1.5, 2.0), dvec2(9.0, 9.0)], 3).expect("a warning");
        assert_eq!(
            (told.code.as_str(), told.layer, told.at),
            ("thin_place_outlined", Some(3), Some([1.5, 2.0]))
        );
        assert!(told.message.contains("2 thin place(s)"), "{}", told.message);
    }
}
