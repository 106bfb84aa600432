//! What must be held, what regular planes leave hanging, and the planes added for it.
//!
//! [Zhao] leaves open what falls between the planes. Here every point of a need must lie, in plan,
//! within half a spacing of a support bead in the layer below the gap.

use super::Job;
use super::frame::Frame;
use super::pieces::Tower;
use super::plane::Demand;
use super::plates::{self, Line, Plate, lines_at};
use super::report::Uncovered;
use super::section::{downward, ordered};
use super::spans::{self, Span};
use crate::polygon::island::{Island, inner_point};
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2, Join, Polygon, PolygonSet, dvec2};
use crate::region::overhang;
use crate::slice::{Axis, slice_triangles};
use crate::sort::StableSort;

/// Needs narrower than twice this, mm, hold themselves (opened by 0.2).
const OPENING_MM: f64 = 0.2;

/// Spots that hang and are smaller than this, mm2, are corners of the rule, not of the part.
const SPOT_MM2: f64 = 0.02;

/// Rounds of adding planes; each adds a plane to every spot that still hangs.
const ROUNDS: usize = 8;

/// What must be held below one layer.
pub(super) struct Need {
    /// The layer below the one that hangs.
    pub(super) layer: usize,
    /// The layer below the gap, where supports must be.
    pub(super) top: usize,
    pub(super) area: PolygonSet,
    /// Islands that begin in the air: a bead beside them is not enough, one must run below.
    afloat: Vec<PolygonSet>,
}

/// A plane wanted for a spot.
#[derive(Debug, Clone, Copy)]
struct Request {
    axis: Axis,
    at: f64,
    /// Stretch along the plane, mm.
    span: Span,
    top: usize,
}

/// The needs of all layers, from the lowest up. Needs nearer to the bed than the gap are left out:
/// the bed holds them.
pub(super) fn needs(job: &Job) -> Vec<Need> {
    let flat = flat_layers(job);
    let closed = closed_cavities(job);
    let need_at = |k: usize| {
        let (frame, options) = (&job.frame, job.options);
        let top = frame.top_under(k)?;
        let (above, below) = (&frame.areas[k + 1], &frame.areas[k]);
        let step = overhang::permissible_step(frame.layers[k + 1].height, options.overhang_angle_deg);
        let boxes = |list: &[[f64; 6]]| boxes_at(list, frame.layers[k].slice_z, frame.layers[k + 1].slice_z);
        let mut area =
            if flat[k] { overhang::need(above, below, step, OPENING_MM) } else { PolygonSet::EMPTY };
        let enforced = boxes(&options.enforcers);
        if !enforced.is_empty() {
            let all = overhang::need(above, below, 0.0, OPENING_MM);
            area = area.union(&all.intersection_with_any(&enforced));
        }
        area = area.difference(&PolygonSet::union_all(&boxes(&options.blockers))).difference(&closed[k]);
        (!area.is_empty()).then(|| Need { layer: k, top, afloat: afloat(&area, above, below), area })
    };
    (0..job.frame.layers.len().saturating_sub(1)).filter_map(need_at).collect()
}

/// The islands of `area` whose whole part of the layer `above` touches nothing in the one `below`.
fn afloat(area: &PolygonSet, above: &PolygonSet, below: &PolygonSet) -> Vec<PolygonSet> {
    let islands = Island::all_of(above);
    let begins_in_air = |need: &Polygon| {
        let whole = inner_point(need).and_then(|p| Island::around(&islands, p));
        // An island that rests on the part below is mostly not in need; most others are.
        let mostly = |i: &usize| need.area() > 0.5 * islands[*i].polygon.area();
        let set = |i: usize| islands[i].polygon.clone().into_set();
        whole.filter(mostly).is_some_and(|i| set(i).intersection(below).is_empty())
    };
    area.islands().into_iter().filter(begins_in_air).map(Polygon::into_set).collect()
}

/// Which layers may need something below the next one: those in which a facet is so flat that its
/// step from layer to layer reaches past the permissible overhang by at least the opening.
fn flat_layers(job: &Job) -> Vec<bool> {
    let layers = job.frame.layers;
    let mut flat = vec![false; layers.len()];
    let height = layers.iter().map(|l| l.height).fold(0.0, f64::max).max(1e-3);
    let angle = job.options.overhang_angle_deg;
    let limit = overhang::permissible_step(1.0, angle) + OPENING_MM / height;
    for t in 0..job.mesh.triangles.len() {
        let sine = downward(job.mesh, t);
        if sine <= limit / (1.0 + limit * limit).sqrt() {
            continue;
        }
        let [a, b, c] = job.mesh.corners(t).map(|v| f64::from(v.z));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let first = layers.partition_point(|l| l.slice_z < low).saturating_sub(1);
        let last = layers.partition_point(|l| l.slice_z <= high);
        flat[first..last.max(first)].fill(true);
    }
    flat
}

/// Sections of the air in cavities closed in 3D that are to stay empty, layer by layer.
pub(super) fn closed_cavities(job: &Job) -> Vec<PolygonSet> {
    let mut closed = vec![PolygonSet::EMPTY; job.frame.layers.len()];
    if job.facets.is_cavity.is_empty() || job.options.internal {
        return closed;
    }
    let walls = job.facets.is_cavity.iter().zip(0u32..).filter(|(is, _)| **is).map(|(_, t)| t);
    let heights: Vec<f64> = job.frame.layers.iter().map(|l| l.slice_z).collect();
    let sections = slice_triangles(job.mesh, walls, Axis::Z, &heights, 0.0);
    // The need of layer k hangs in layer k + 1 and its air lies in layer k.
    for (k, section) in sections.into_iter().enumerate() {
        closed[k] = section.area.offset(OPENING_MM, Join::WALL);
    }
    closed
}

/// The boxes that reach into the heights between two layers, in plan.
pub(super) fn boxes_at(boxes: &[[f64; 6]], low: f64, high: f64) -> Vec<PolygonSet> {
    let met = boxes.iter().map(ordered).filter(|[min, max]| min[2] <= high && low <= max[2]);
    met.map(|[min, max]| PolygonSet::rectangle(dvec2(min[0], min[1]), dvec2(max[0], max[1]))).collect()
}

/// How far a bead's centre line holds, mm: half the smaller spacing. Counting from the bead's side
/// instead, half a width more, would save a tenth of the plastic on `bridge_test.stl` (18.8 % of the
/// complete support instead of 22.0 %); the print does not say which it means.
fn reach(job: &Job) -> f64 {
    job.spacing(Axis::X).min(job.spacing(Axis::Y)) / 2.0
}

/// What of a need no bead holds.
fn hanging(need: &Need, plates: &[Plate], reach: f64) -> PolygonSet {
    let Some(bounds) = need.area.bounds().map(|b| b.grown(reach)) else { return PolygonSet::EMPTY };
    let mut held = Vec::new();
    for plate in plates {
        let (low, high) = (across(plate.axis, bounds.min), across(plate.axis, bounds.max));
        for line in plate.lines.iter().filter(|l| low <= l.at && l.at <= high) {
            held.extend(line.beads[need.top].iter().map(|&span| capsule(plate.axis, line.at, span, reach)));
        }
    }
    let bare = need.afloat.iter().filter(|island| !is_touched(need, island, plates));
    let bare = PolygonSet::union_all(bare);
    need.area.difference(&PolygonSet::from_contours(held)).union(&bare)
}

/// Whether a bead runs below an island.
fn is_touched(need: &Need, island: &PolygonSet, plates: &[Plate]) -> bool {
    let Some(bounds) = island.bounds() else { return true };
    let runs_below = |plate: &Plate, line: &Line| {
        let box_span = [along(plate.axis, bounds.min), along(plate.axis, bounds.max)];
        let in_box = across(plate.axis, bounds.min) <= line.at && line.at <= across(plate.axis, bounds.max);
        in_box
            && line.beads[need.top].iter().any(|&s| {
                let [a, b] = s.map(|u| in_plan(plate.axis, line.at, u));
                spans::meet(s, box_span, 0.0) && !island.clip_lines(&[vec![a, b]]).is_empty()
            })
    };
    plates.iter().any(|p| p.lines.iter().any(|l| runs_below(p, l)))
}

/// All within `reach` of a bead, its round ends cut to half a regular twelve-gon from within.
fn capsule(axis: Axis, at: f64, [from, to]: Span, reach: f64) -> Contour {
    const COS_30: f64 = 0.866_025_403_784_438_6;
    let arc =
        [(-1.0, 0.0), (-COS_30, 0.5), (-0.5, COS_30), (0.0, 1.0), (0.5, COS_30), (COS_30, 0.5), (1.0, 0.0)];
    let end = arc.iter().map(|&(across, along)| (at + across * reach, to + along * reach));
    let start = arc.iter().rev().map(|&(across, along)| (at + across * reach, from - along * reach));
    let points = end.chain(start).map(|(across, along)| in_plan(axis, across, along)).collect();
    let contour = Contour::new(points);
    if axis == Axis::X { contour.reversed() } else { contour }
}

/// A point of the bed from its places across and along a plane.
pub(super) fn in_plan(axis: Axis, across: f64, along: f64) -> DVec2 {
    if axis == Axis::X { dvec2(across, along) } else { dvec2(along, across) }
}

fn across(axis: Axis, p: DVec2) -> f64 {
    if axis == Axis::X { p.x } else { p.y }
}

fn along(axis: Axis, p: DVec2) -> f64 {
    if axis == Axis::X { p.y } else { p.x }
}

/// A need that still has spots to hold.
struct Open<'a> {
    need: &'a Need,
    /// What hung in the round before, mm2.
    area: f64,
    /// Rounds without progress: after the first the planes are turned, after the second we give up.
    stalled: usize,
}

/// Adds planes until everything is held or nothing more can be done: along the room at a spot, or
/// `across` it.
pub(super) fn add_planes(job: &Job, needs: &[Need], plates: &mut Vec<Plate>, across: bool) {
    let reach = reach(job);
    let mut open: Vec<Open> =
        needs.iter().map(|need| Open { need, area: f64::INFINITY, stalled: 0 }).collect();
    for _ in 0..ROUNDS {
        let mut requests = Vec::new();
        open.retain_mut(|one| {
            let spots = spots(&hanging(one.need, plates, reach));
            let area: f64 = spots.iter().map(PolygonSet::area).sum();
            one.stalled = if area > 0.99 * one.area { one.stalled + 1 } else { 0 };
            one.area = area;
            let goes_on = area > 0.0 && one.stalled < 2;
            if goes_on {
                let turned = (one.stalled == 1) != across;
                requests.extend(spots.iter().filter_map(|spot| request(job, one.need, spot, turned)));
            }
            goes_on
        });
        if requests.is_empty() {
            return;
        }
        fulfil(job, requests, plates);
    }
}

/// The islands of what hangs that are worth a plane.
fn spots(left: &PolygonSet) -> Vec<PolygonSet> {
    left.islands().into_iter().filter(|i| i.area() > SPOT_MM2).map(|i| i.into_set()).collect()
}

/// A plane near a spot, where there is room for its beads: along the room, or `turned` across it.
fn request(job: &Job, need: &Need, spot: &PolygonSet, turned: bool) -> Option<Request> {
    let reach = reach(job);
    let bounds = spot.bounds()?;
    let around = bounds.grown(0.6 * reach);
    let above = job.frame.areas[need.layer + 1].intersection(&PolygonSet::rectangle(around.min, around.max));
    let blocked = job.frame.areas[need.top].offset(job.frame.clearance, Join::WALL);
    let room = above.difference(&blocked);
    let inner = room.opened(job.frame.width / 4.0, Join::WALL);
    let room = if inner.is_empty() { room } else { inner };
    let centre = bounds.centre();
    let distance = |p: &(Bounds, DVec2)| p.1.distance_squared(centre);
    let places = room.islands().into_iter().filter_map(|i| Some((i.outer.bounds()?, inner_point(&i)?)));
    let (extent, point) = places.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let size = extent.size();
    let axis = if (size.x >= size.y) != turned { Axis::Y } else { Axis::X };
    let margin = reach / 2.0;
    let span =
        [along(axis, bounds.min.min(extent.min)) - margin, along(axis, bounds.max.max(extent.max)) + margin];
    Some(Request { axis, at: across(axis, point), span, top: need.top })
}

/// Puts plates where they are wanted; what is wanted within a plate's thickness of another plane
/// goes there.
fn fulfil(job: &Job, mut requests: Vec<Request>, plates: &mut Vec<Plate>) {
    requests.stable_sort_by(|a, b| {
        a.at.total_cmp(&b.at).then(a.top.cmp(&b.top)).then(a.span[0].total_cmp(&b.span[0]))
    });
    let thickness = job.frame.width * f64::from(job.options.plates.thickness);
    let mut changed = Vec::new();
    for axis in [Axis::X, Axis::Y] {
        let mut places: Vec<f64> = Vec::new();
        let mut wanted: Vec<(usize, Request)> = Vec::new();
        for mut request in requests.iter().copied().filter(|r| r.axis == axis) {
            let gap = |at: f64| (at - request.at).abs();
            let others = plates.iter().filter(|p| p.axis == axis).map(|p| p.at).chain(places.last().copied());
            let nearest = others.min_by(|&a, &b| gap(a).total_cmp(&gap(b)));
            request.at = nearest.filter(|&at| gap(at) < thickness).unwrap_or(request.at);
            if places.last() != Some(&request.at) {
                places.push(request.at);
            }
            wanted.push((places.len() - 1, request));
        }
        let demand =
            Demand { every: true, everywhere: job.options.everywhere, internal: job.options.internal };
        let cuts = sorted_sections(job, axis, &places);
        for (place, at) in places.iter().enumerate() {
            let room = job.frame.air(&cuts[place].columns(demand));
            let of_place = || wanted.iter().filter(|(p, _)| *p == place).map(|(_, r)| r);
            let index = plate_at(job, axis, *at, plates);
            of_place().for_each(|request| extend(&job.frame, &mut plates[index], &room, request));
            changed.push(index);
        }
    }
    plates::lay(&job.frame, plates, |i| changed.contains(&i));
}

/// Sections in the order of `places`, which need not ascend.
fn sorted_sections(job: &Job, axis: Axis, places: &[f64]) -> Vec<super::PlaneSection> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.stable_sort_by(|&a, &b| places[a].total_cmp(&places[b]));
    let ascending: Vec<f64> = order.iter().map(|&i| places[i]).collect();
    let mut cuts: Vec<Option<super::PlaneSection>> = places.iter().map(|_| None).collect();
    for ((section, _), i) in job.sections(axis, &ascending).into_iter().zip(order) {
        cuts[i] = Some(section);
    }
    cuts.into_iter().flatten().collect()
}

/// The index of the plate in this plane; a new one when there is none.
fn plate_at(job: &Job, axis: Axis, at: f64, plates: &mut Vec<Plate>) -> usize {
    if let Some(index) = plates.iter().position(|p| p.axis == axis && p.at == at) {
        return index;
    }
    let lines: Vec<Line> = lines_at(at, job.options.plates.thickness, &job.frame);
    let air = vec![Vec::new(); job.frame.layers.len()];
    plates.push(Plate { axis, at, is_added: true, area_mm2: 0.0, air, lines });
    plates.len() - 1
}

/// Extends a plate by what stands straight below a stretch of its top layer.
fn extend(frame: &Frame, plate: &mut Plate, room: &[Vec<Span>], request: &Request) {
    let mut column = vec![request.span];
    for k in (0..=request.top).rev() {
        column = spans::intersect(&column, &room[k]);
        if column.is_empty() {
            break;
        }
        let before = spans::length(&plate.air[k]);
        plate.air[k] = spans::unite(&plate.air[k], &column);
        plate.area_mm2 += (spans::length(&plate.air[k]) - before) * frame.layers[k].height;
    }
}

/// Gives each tower a plate across its middle.
pub(super) fn cross(job: &Job, towers: &[Tower], plates: &mut Vec<Plate>) {
    let margin = reach(job) / 2.0;
    let across_tower = |tower: &Tower| {
        let plate = &plates[tower.plate];
        let axis = if plate.axis == Axis::X { Axis::Y } else { Axis::X };
        let at = (tower.span[0] + tower.span[1]) / 2.0;
        Request { axis, at, span: [plate.at - margin, plate.at + margin], top: tower.top }
    };
    let requests = towers.iter().map(across_tower).collect();
    fulfil(job, requests, plates);
}

/// What hangs in the end, place by place.
pub(super) fn report_uncovered(job: &Job, needs: &[Need], plates: &[Plate]) -> Vec<Uncovered> {
    let of_need = |need: &Need| {
        let spots = spots(&hanging(need, plates, reach(job)));
        let layer = need.layer as u32 + 1;
        let report = |spot: &PolygonSet| {
            let at = spot.islands().first().and_then(inner_point)?.to_array();
            Some(Uncovered { layer, at, area_mm2: spot.area() })
        };
        spots.iter().filter_map(report).collect::<Vec<_>>()
    };
    needs.iter().flat_map(of_need).collect()
}

/// Whether the lines along one axis alone hold the need.
pub(super) fn is_held_along(job: &Job, need: &Need, plates: &[Plate], axis: Axis) -> bool {
    let reach = reach(job);
    let without: Vec<Contour> = plates
        .iter()
        .filter(|p| p.axis == axis)
        .flat_map(|p| p.lines.iter().map(move |l| (p.axis, l)))
        .flat_map(|(axis, l)| l.beads[need.top].iter().map(move |&s| capsule(axis, l.at, s, reach)))
        .collect();
    spots(&need.area.difference(&PolygonSet::from_contours(without))).is_empty()
}
