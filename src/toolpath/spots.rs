//! Spots that all beads of a layer leave open, and what fills them.
//!
//! Where loops turn into a tooth, end at each other or pass a corner, spots stay open that are too
//! small for a bead of their own, which would be a drop with a travel there and back. Instead the
//! bead beside bulges into them: its line bends towards the spot and changes its width there, as far
//! as it keeps to the outline.

mod raster;

use super::LayerParts;
use crate::polygon::grid::EdgeGrid;
use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{Contour, DVec2, PolygonSet, snap};
use crate::region::{Path, Role, Width};
use crate::sort::StableSort;
use raster::{Raster, STEP_MM};
use std::f64::consts::TAU;
use std::ops::{Range, RangeInclusive};

/// What a bulge does not fill the next one may.
const ROUNDS: usize = 2;

/// The points of a bulge are so wide that they reach past the outline by this, mm. Its ramps may cut a corner
/// by a little more.
const PAST_MM: f64 = 0.02;

/// Half the stretch that becomes a flat top, mm.
const TOP_MM: f64 = 0.02;

/// A bead bends out and back over this length, mm.
const RAMP_MM: f64 = 0.1;

/// A bulge's line moves aside by one of these, mm.
const ASIDE_MM: [f64; 6] = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3];

/// In one of as many directions.
const DIRECTIONS: u32 = 16;

/// Beads this near to a spot may fill it, mm.
const REACH_MM: f64 = 0.3;

/// As many of them are tried.
const NEAREST: usize = 3;

/// So many bulges of each shape are tried.
const TRIES: usize = 4;

/// What lies nearer to the outline than this is seen, mm,
const SEEN_MM: f64 = 0.1;

/// and counts this much.
const SEEN_COUNTS: f64 = 2.0;

/// What a bulge leaves open counts this much.
const LEAVING_COSTS: f64 = 2.0;

/// Area laid twice counts this much against area filled.
const OVERFILL_COSTS: f64 = 0.3;

/// On layers smaller than this what a bulge lays twice has nowhere to go, mm2.
const SMALLEST_MM2: f64 = 4.0;

/// Beads that may bulge.
const BULGING: [Role; 3] = [Role::OuterWall, Role::InnerWall, Role::GapFill];

/// Fills the spots in `places`, which lie in `outline`, by beads of these widths, mm.
pub fn fill_spots(
    parts: &mut LayerParts,
    places: &[Contour],
    outline: &PolygonSet,
    widths: &RangeInclusive<f64>,
) {
    if places.is_empty() || outline.area() < SMALLEST_MM2 {
        return;
    }
    let mut raster = Raster::new(places);
    let beads = parts.walls.iter().map(|(_, path)| path).chain(&parts.fills);
    for path in beads.chain(parts.rows.iter().flatten()).filter(|path| path.role != Role::Ironing) {
        raster.cover(path);
    }
    let beads = parts.walls.iter_mut().map(|(_, path)| path).chain(&mut parts.fills);
    let mut beads: Vec<&mut Path> = beads.filter(|path| BULGING.contains(&path.role)).collect();
    let mut border = None;
    for _ in 0..ROUNDS {
        for spot in raster.spots() {
            let border = border.get_or_insert_with(|| {
                EdgeGrid::new(&outline.contours().iter().flat_map(|c| c.edges()).collect::<Vec<_>>())
            });
            let room = Room::new(spot, border, widths);
            let near = room.nearest(&beads).into_iter();
            let best =
                near.filter_map(|(bead, along)| Some((bead, room.best(beads[bead], along, &mut raster)?)));
            if let Some((bead, bulge)) = best.max_by(|a, b| a.1.gain.total_cmp(&b.1.gain)) {
                raster.uncover(&bulge.stretch.part);
                raster.cover(&bulge.bent());
                bulge.lay(beads[bead]);
            }
        }
    }
}

/// A part of a path, from the point before the first that moves to the one after the last.
#[derive(Clone)]
struct Stretch {
    /// The whole path, with more points on its line.
    path: Path,
    /// The part, open.
    part: Path,
    /// Places in the path of the points that move.
    moving: Vec<usize>,
    /// Places in the part of the same points.
    moving_in_part: Range<usize>,
}

impl Stretch {
    /// What can move up to `half` mm before and after the place `along` mm from the path's start; `None` if
    /// that were all of a loop.
    fn new(path: &Path, along: f64, half: f64) -> Option<Stretch> {
        let mut path = path.clone();
        let moving = opened_up(&mut path, along, half);
        let n = path.points.len();
        let (&first, &last) = moving.first().zip(moving.last())?;
        let before = if path.closed { Some((first + n - 1) % n) } else { first.checked_sub(1) };
        let after = if path.closed { Some((last + 1) % n) } else { Some(last + 1).filter(|&i| i < n) };
        if path.closed && moving.len() + 2 > n {
            return None;
        }
        let places: Vec<usize> = before.into_iter().chain(moving.iter().copied()).chain(after).collect();
        let points = places.iter().map(|&i| path.points[i]).collect();
        let widths = places.iter().map(|&i| path.width.at(i)).collect();
        let part = Path { width: Width::Varying(widths), ..Path::open(path.role, points, 0.0) };
        let start = usize::from(before.is_some());
        Some(Stretch { path, part, moving_in_part: start..start + moving.len(), moving })
    }

    fn moving_points(&self) -> &[DVec2] {
        &self.part.points[self.moving_in_part.clone()]
    }
}

/// A stretch that bulges.
struct Bulge {
    stretch: Stretch,
    /// Where the moving points go.
    line: Vec<DVec2>,
    /// Width there, mm.
    width: f64,
    /// Area filled, less what it costs, mm2.
    gain: f64,
    /// Points of the spot that it fills.
    filled: i32,
}

impl Bulge {
    /// The bulging part.
    fn bent(&self) -> Path {
        bent(&self.stretch.part, self.stretch.moving_in_part.clone(), &self.line, self.width)
    }

    /// Puts the bulge into its path.
    fn lay(self, path: &mut Path) {
        let Stretch { path: opened_up, moving, .. } = self.stretch;
        *path = bent(&opened_up, moving.into_iter(), &self.line, self.width);
    }

    /// How many points outside the spot it leaves open.
    fn leaves(&self, raster: &mut Raster) -> i32 {
        let bent = self.bent();
        let opened = raster.uncover(&self.stretch.part);
        let closed = raster.cover(&bent);
        raster.uncover(&bent);
        raster.cover(&self.stretch.part);
        opened - closed + self.filled
    }
}

/// The path with the points of these places moved to `line`, and a bead of this width there.
fn bent(path: &Path, places: impl Iterator<Item = usize>, line: &[DVec2], width: f64) -> Path {
    let mut points = path.points.clone();
    let mut widths: Vec<f64> = (0..points.len()).map(|i| path.width.at(i)).collect();
    for (i, &p) in places.zip(line) {
        points[i] = snap(p);
        widths[i] = width;
    }
    Path { points, width: Width::Varying(widths), ..path.clone() }
}

/// A spot and what bounds the beads that fill it.
struct Room<'a> {
    /// The spot's points, and what each counts: more where it is seen from outside.
    spot: Vec<(DVec2, f64)>,
    middle: DVec2,
    border: &'a EdgeGrid,
    widths: &'a RangeInclusive<f64>,
}

impl<'a> Room<'a> {
    fn new(spot: Vec<DVec2>, border: &'a EdgeGrid, widths: &'a RangeInclusive<f64>) -> Room<'a> {
        let middle = spot.iter().sum::<DVec2>() / spot.len() as f64;
        let weight = |p: DVec2| if border.nearest(p, SEEN_MM).is_some() { SEEN_COUNTS } else { 1.0 };
        Room { spot: spot.into_iter().map(|p| (p, weight(p))).collect(), middle, border, widths }
    }

    /// The beads whose sides are nearest to the spot's middle, and how far along them that is, mm.
    fn nearest(&self, beads: &[&mut Path]) -> Vec<(usize, f64)> {
        let mut found: Vec<(f64, usize, f64)> = Vec::new();
        for (bead, path) in beads.iter().enumerate() {
            let mut before = 0.0;
            let mut best = (REACH_MM, bead, 0.0);
            for (i, next) in path.edges() {
                let (a, b) = (path.points[i], path.points[next]);
                let foot = closest_on_segment(self.middle, a, b);
                let share = a.distance(foot) / a.distance(b).max(f64::MIN_POSITIVE);
                let width = path.width.at(i) + (path.width.at(next) - path.width.at(i)) * share;
                let free = foot.distance(self.middle) - width / 2.0;
                if free < best.0 {
                    best = (free, bead, before + a.distance(foot));
                }
                before += a.distance(b);
            }
            found.extend((best.0 < REACH_MM).then_some(best));
        }
        found.stable_sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(NEAREST);
        found.into_iter().map(|(_, bead, along)| (bead, along)).collect()
    }

    /// The bulge `along` mm from the path's start that fills most of the spot and leaves least open: with a
    /// point, with a flat top as long as the spot, or of a stretch as long as the spot.
    fn best(&self, path: &Path, along: f64, raster: &mut Raster) -> Option<Bulge> {
        let foot = point_at(path, along);
        let way = (self.middle - foot).normalize_or_zero();
        let beside = |p: &(DVec2, f64)| (p.0 - foot).dot(way.perp()).abs();
        let half = self.spot.iter().map(beside).fold(0.0, f64::max) - STEP_MM;
        let mut all = self.bulges(Stretch::new(path, along, 0.0)?, 0.0, way);
        if half > RAMP_MM {
            let shapes = [Stretch::new(path, along, half), Stretch::new(path, along, TOP_MM)];
            all.extend(shapes.into_iter().flatten().flat_map(|stretch| self.bulges(stretch, half, way)));
        }
        for bulge in &mut all {
            bulge.gain -= LEAVING_COSTS * f64::from(bulge.leaves(raster)) * STEP_MM * STEP_MM;
        }
        all.into_iter().filter(|b| b.gain > 0.0).max_by(|a, b| a.gain.total_cmp(&b.gain))
    }

    /// The best bulges of a stretch, but for what they leave open; up to `half` mm long on both sides.
    fn bulges(&self, stretch: Stretch, half: f64, way: DVec2) -> Vec<Bulge> {
        let before = stretch.moving.iter().map(|&i| stretch.path.width.at(i)).fold(0.0, f64::max);
        let points = stretch.moving_points();
        let is_short = points[0].distance(points[points.len() - 1]) < half;
        let points = if is_short { spread(points, way, half) } else { points.to_vec() };
        let turns = (0..DIRECTIONS).map(|i| DVec2::from_angle(f64::from(i) * TAU / f64::from(DIRECTIONS)));
        let ways = turns.flat_map(|turn| ASIDE_MM.map(|far| turn.rotate(way) * far));
        let bulge = |by: DVec2| {
            let line: Vec<DVec2> = points.iter().map(|p| p + by).collect();
            let width = self.width(&line)?;
            let (filled, worth) = self.covered(&line, width / 2.0);
            let detour = 2.0 * (by.length().hypot(RAMP_MM) - RAMP_MM);
            let laid = (width - before) * (2.0 * half + RAMP_MM) + width * detour;
            let twice = (laid - f64::from(filled) * STEP_MM * STEP_MM).max(0.0);
            let gain = worth * STEP_MM * STEP_MM - OVERFILL_COSTS * twice;
            (gain > 0.0).then_some((gain, line, width, filled))
        };
        let mut found: Vec<_> = ways.filter_map(bulge).collect();
        found.stable_sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(TRIES);
        let bulge =
            |(gain, line, width, filled)| Bulge { stretch: stretch.clone(), line, width, gain, filled };
        found.into_iter().map(bulge).collect()
    }

    /// The widest bead along a line that keeps to the outline; `None` if that is too narrow.
    fn width(&self, line: &[DVec2]) -> Option<f64> {
        let most = self.widths.end() / 2.0;
        let free = |p: &DVec2| self.border.nearest(*p, most).map_or(most, |q| q.distance(*p) + PAST_MM);
        let width = 2.0 * line.iter().map(free).fold(most, f64::min);
        (width >= *self.widths.start()).then_some(width)
    }

    /// Points of the spot that a bead covers, and what they count.
    fn covered(&self, line: &[DVec2], radius: f64) -> (i32, f64) {
        let is_near = |p: DVec2| {
            line[0].distance(p) <= radius
                || line.windows(2).any(|w| closest_on_segment(p, w[0], w[1]).distance(p) <= radius)
        };
        let covered = self.spot.iter().filter(|(p, _)| is_near(*p));
        covered.fold((0, 0.0), |(count, worth), (_, weight)| (count + 1, worth + weight))
    }
}

/// The same number of points at right angles to `way`, up to `half` mm on both sides of their middle and in
/// the same direction.
fn spread(stretch: &[DVec2], way: DVec2, half: f64) -> Vec<DVec2> {
    let (first, last) = (stretch[0], stretch[stretch.len() - 1]);
    let side = way.perp() * half * way.perp().dot(last - first).signum();
    let share = |i: usize| 2.0 * i as f64 / (stretch.len() - 1).max(1) as f64 - 1.0;
    (0..stretch.len()).map(|i| first.midpoint(last) + side * share(i)).collect()
}

/// The point `along` mm from the path's start.
fn point_at(path: &Path, along: f64) -> DVec2 {
    let mut left = along;
    for (i, next) in path.edges() {
        let (a, b) = (path.points[i], path.points[next]);
        let edge = a.distance(b);
        if left <= edge {
            return a.lerp(b, left / edge.max(f64::MIN_POSITIVE));
        }
        left -= edge;
    }
    path.points[path.points.len() - 1]
}

/// Adds points to a path: `along` mm from its start, `half` mm before and after it, and where the ramps
/// there begin and end. Gives the places of all points but the ramps' outer ends, in the path's order.
fn opened_up(path: &mut Path, along: f64, half: f64) -> Vec<usize> {
    let length = path.length();
    for at in [along - half - RAMP_MM, along - half, along, along + half, along + half + RAMP_MM] {
        insert_at(path, if path.closed { at.rem_euclid(length) } else { at });
    }
    let mut at = 0.0;
    let mut found: Vec<usize> = Vec::new();
    for i in 0..path.points.len() {
        let apart = (at - along).abs();
        if (if path.closed { apart.min(length - apart) } else { apart }) <= half + SAME_PLACE_MM {
            found.push(i);
        }
        at += path.points[i].distance(path.points[(i + 1) % path.points.len()]);
    }
    // A stretch over the path's start begins after the gap in the numbers.
    let gap = found.windows(2).position(|w| w[1] != w[0] + 1);
    found.rotate_left(gap.map_or(0, |gap| gap + 1));
    found
}

/// Points of a path closer than this are one, mm.
const SAME_PLACE_MM: f64 = 1e-6;

/// Adds a point `along` mm from the start, unless there is one or the path does not go there.
fn insert_at(path: &mut Path, along: f64) {
    let mut left = along;
    for (i, next) in path.edges() {
        let (a, b) = (path.points[i], path.points[next]);
        let edge = a.distance(b);
        if left < edge {
            if left > SAME_PLACE_MM && edge - left > SAME_PLACE_MM {
                path.insert(i + 1, a.lerp(b, left / edge));
            }
            return;
        }
        left -= edge;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    const WIDTHS: RangeInclusive<f64> = 0.2..=0.8;

    /// A strip with a bead along it, and a tooth of 0.5 mm on it that the bead does not reach.
    fn strip_with_a_tooth() -> (PolygonSet, LayerParts) {
        let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 0.45));
        let tooth = PolygonSet::rectangle(dvec2(3.0, 0.4), dvec2(3.5, 0.85));
        let bead = Path::open(Role::OuterWall, vec![dvec2(0.225, 0.225), dvec2(9.775, 0.225)], 0.45);
        let parts = LayerParts { fills: vec![bead], ..LayerParts::default() };
        (PolygonSet::union_all(&[strip, tooth]), parts)
    }

    fn open_points(parts: &LayerParts, outline: &PolygonSet) -> usize {
        let mut raster = Raster::new(outline.contours());
        parts.fills.iter().for_each(|path| {
            raster.cover(path);
        });
        raster.spots().iter().map(Vec::len).sum()
    }

    #[test]
    fn a_bead_bulges_into_a_tooth_and_keeps_to_the_outline() {
        let (outline, mut parts) = strip_with_a_tooth();
        let before = open_points(&parts, &outline);
        fill_spots(&mut parts, outline.contours(), &outline, &WIDTHS);
        let [path] = &parts.fills[..] else { panic!("{} beads", parts.fills.len()) };
        let after = open_points(&parts, &outline);
        assert!(before > 30 && after < before / 3, "{before} points open, then {after}");
        let edges: Vec<(DVec2, DVec2)> = outline.contours().iter().flat_map(|c| c.edges()).collect();
        let border = EdgeGrid::new(&edges);
        for (i, &p) in path.points.iter().enumerate() {
            let width = path.width.at(i);
            assert!(WIDTHS.contains(&width), "{width}");
            assert!(outline.contains(p) && border.nearest(p, width / 2.0 - 2.0 * PAST_MM).is_none(), "{p}");
        }
        assert_eq!((path.points[0], path.width.at(0)), (dvec2(0.225, 0.225), 0.45));
    }

    #[test]
    fn a_loop_that_starts_at_the_spot_bulges_too() {
        let (outline, _) = strip_with_a_tooth();
        for start in 0..4 {
            let corners = [dvec2(0.2, 0.225), dvec2(3.25, 0.225), dvec2(9.8, 0.225), dvec2(9.8, 0.215)];
            let mut path = Path::closed(Role::InnerWall, corners.to_vec(), 0.43);
            path.start_at(start);
            let mut parts = LayerParts { fills: vec![path], ..LayerParts::default() };
            let before = open_points(&parts, &outline);
            fill_spots(&mut parts, outline.contours(), &outline, &WIDTHS);
            let after = open_points(&parts, &outline);
            assert!(after < before / 2, "from point {start}: {before} points open, then {after}");
        }
    }

    #[test]
    fn beads_that_leave_nothing_open_or_are_none_of_the_walls_stay() {
        let (outline, parts) = strip_with_a_tooth();
        let strip = PolygonSet::rectangle(dvec2(0.225, 0.0), dvec2(9.775, 0.45));
        let mut covered = parts.clone();
        fill_spots(&mut covered, strip.contours(), &strip, &WIDTHS);
        assert_eq!(covered, parts);
        let mut infill = parts;
        infill.fills[0].role = Role::Infill;
        let before = infill.clone();
        fill_spots(&mut infill, outline.contours(), &outline, &WIDTHS);
        assert_eq!(infill, before);
    }
}
