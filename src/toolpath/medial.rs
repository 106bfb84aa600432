//! One bead of varying width along the middle of a thin area.
//!
//! For what plain offsets cannot fill: walls thinner than two beads, strokes of letters, strips left
//! between walls. The centre line is the medial axis, the width twice the distance to the border.
//! The steps:
//!
//! 1. `border`: the outline with points every `STEP_MM` at least, and its constrained Delaunay
//!    triangulation (crate `spade`).
//! 2. `axis`: the chordal axis [Prasad 1997, "Morphological analysis of shapes"]: triangles with
//!    two inner edges are links of a branch, with three junctions, with one ends. The middles of the
//!    inner edges are moved onto the true medial axis (equal distance to both sides), so that the
//!    triangulation gives only the order and not the accuracy.
//! 3. `chains`: spurs into corners go, and at each junction the straightest and longest two
//!    branches become one line.
//! 4. `bead`: ends carried to the border, widths clamped, few points.
//!
//! Variable-width beads along the medial axis as in [Kuipers, Doubrovski, Wu, Wang 2020, "A framework
//! for adaptive width control of dense contour-parallel toolpaths"], with one bead instead of many:
//! where the area is wider than `max_width` the bead is not, and the rest is reported.
//! Why this way: `docs/decisions/0001-medial-axis.md`.

mod axis;
mod bead;
mod border;
mod chains;

pub(super) use axis::Sample;
pub(super) use bead::ring;

use crate::polygon::grid::EdgeGrid;
use crate::polygon::{DVec2, Join, Polygon, PolygonSet, by_x_then_y, snap};
use crate::region::{Path, Role, Width};
use crate::sort::StableSort;

/// Largest distance of neighbouring points on the triangulated outline, mm. About a bead's width:
/// closer points make more triangles and no better line, wider ones miss turns of the axis.
const STEP_MM: f64 = 0.4;

/// An outline whose edges cross is simplified by this and tried again, mm.
const RETRY_TOLERANCE_MM: f64 = 0.002;

/// If they cross still, needles thinner than twice this are cut off, mm.
const RETRY_OPENING_MM: f64 = 0.005;

/// A bead whose place ends less than this before the part does ends at the outline, mm.
const TO_OUTLINE_MM: f64 = 0.1;

/// A bead ends at most this far from its place's border, in its widths.
const LONGEST_GAP: f64 = 1.5;

/// How thin areas are filled.
#[derive(Debug, Clone, PartialEq)]
pub struct ThinFill {
    /// What the beads are for.
    pub role: Role,
    /// Smallest width of a bead, mm; thinner places get a bead of this width and are overfilled.
    pub min_width: f64,
    /// Largest width of a bead, mm; of thicker places the middle is filled and the rest reported.
    pub max_width: f64,
    /// Where the area is thinner than this there is no bead, mm. 0 follows needles to their tips.
    pub min_thickness: f64,
    /// Beads shorter than this, their ends included, are left out, mm.
    pub min_length: f64,
    /// Distance from the end of the centre line to the end of the strip, in bead widths: 0.5 lets a
    /// round end touch the border, 0 ends the line on the border. The default is pi/8, with which a
    /// round end covers as much as the strip's square one.
    pub end_inset: f64,
}

impl Default for ThinFill {
    fn default() -> Self {
        ThinFill {
            role: Role::GapFill,
            min_width: 0.2,
            max_width: 0.9,
            min_thickness: 0.1,
            min_length: 0.4,
            end_inset: std::f64::consts::FRAC_PI_8,
        }
    }
}

impl ThinFill {
    /// Beads that a nozzle of this diameter, mm, can lay: half to twice as wide.
    pub fn for_nozzle(diameter: f64, role: Role) -> ThinFill {
        ThinFill { role, min_width: 0.5 * diameter, max_width: 2.0 * diameter, ..ThinFill::default() }
    }
}

/// The beads in a thin area and what they leave.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ThinBeads {
    /// Open and closed beads, each open one starting at its smaller (x, y), ordered by their points.
    pub paths: Vec<Path>,
    /// Area without a bead, mm2: beside clamped beads, in places too thin and on lines too short.
    /// Corners that a bead's width does not reach are not counted.
    pub left_mm2: f64,
    /// Places (a point of the outline) where no medial axis was found and loops of `min_width` follow
    /// the outline instead. Empty in all shapes known so far.
    pub fallbacks: Vec<DVec2>,
}

/// Fills an area that is everywhere thinner than `options.max_width` with beads along its middle.
///
/// A strip gives one open path, a ring one closed path. At junctions one line goes through and the
/// others end at its side. Widths lie within `min_width..=max_width`; one that changes by less than
/// 2 % is [`Width::Uniform`](crate::region::Width::Uniform).
pub fn fill_thin(area: &PolygonSet, options: &ThinFill) -> ThinBeads {
    let mut beads = ThinBeads::default();
    for island in area.islands() {
        let mut found = ThinBeads::default();
        fill_island(&island, options, &mut found);
        fit_to_area(&mut found, island.area(), options);
        beads.paths.append(&mut found.paths);
        beads.left_mm2 += found.left_mm2;
        beads.fallbacks.append(&mut found.fallbacks);
    }
    beads.paths.stable_sort_by(|a, b| compare_points(&a.points, &b.points));
    beads
}

/// Widths may be changed by this share to make up for ends and corners that the lines do not reach,
/// and for junctions where they overlap: 0.03 mm on a bead of 0.4 mm.
const FIT_SHARE: f64 = 0.08;

/// The plastic may differ from the area's by this share without any change of widths.
const FIT_TOLERANCE: f64 = 0.02;

/// Scales the widths so that the beads hold as much plastic as the area has room for, within
/// [`FIT_TOLERANCE`].
fn fit_to_area(beads: &mut ThinBeads, area: f64, options: &ThinFill) {
    let laid: f64 = beads.paths.iter().map(Path::area).sum();
    let wanted = (area - beads.left_mm2) / laid;
    if !wanted.is_finite() {
        return;
    }
    let needed = wanted / wanted.clamp(1.0 - FIT_TOLERANCE, 1.0 + FIT_TOLERANCE);
    let share = needed.clamp(1.0 - FIT_SHARE, 1.0 + FIT_SHARE);
    let fit = |w: &mut f64| *w = (*w * share).clamp(options.min_width, options.max_width);
    for path in &mut beads.paths {
        match &mut path.width {
            Width::Uniform(width) => fit(width),
            Width::Varying(widths) => widths.iter_mut().for_each(fit),
        }
    }
}

fn fill_island(island: &Polygon, options: &ThinFill, beads: &mut ThinBeads) {
    if island.area() < options.min_thickness * options.min_length / 2.0 {
        beads.left_mm2 += island.area();
        return;
    }
    if let Some(triangles) = border::triangulate(std::slice::from_ref(island), STEP_MM) {
        return fill_triangles(&triangles, options, beads);
    }
    let set = island.clone().into_set();
    let retry = |set: PolygonSet| border::triangulate(&set.islands(), STEP_MM);
    let triangles = retry(set.simplified(RETRY_TOLERANCE_MM))
        .or_else(|| retry(set.opened(RETRY_OPENING_MM, Join::WALL).simplified(RETRY_TOLERANCE_MM)));
    match triangles {
        Some(triangles) => fill_triangles(&triangles, options, beads),
        None => follow_outline(&set, options, beads),
    }
}

/// The beads in `places`, their ends carried on to the places' border where that lies inside `part`: a
/// wall runs there, which the beads shall touch.
pub fn carried_to_walls(paths: Vec<Path>, places: &PolygonSet, part: &PolygonSet) -> Vec<Path> {
    let edges: Vec<(DVec2, DVec2)> = places.contours().iter().flat_map(|c| c.edges()).collect();
    let border = EdgeGrid::new(&edges);
    let carried = |(i, path): (usize, &Path)| {
        let mut carried = path.clone();
        let last = path.points.len() - 1;
        for (end, before) in [(0, 1), (last, last.saturating_sub(1))] {
            let (from, width) = (path.points[end], path.width.at(end));
            let way = (from - path.points[before.min(last)]).normalize_or_zero();
            let Some(&(share, _)) = border.crossings(from, from + way * (LONGEST_GAP * width)).first() else {
                continue;
            };
            let gap = way * (share * LONGEST_GAP * width);
            let others = paths.iter().enumerate().filter(|&(k, _)| k != i);
            let is_free = others.map(|(_, p)| p).all(|p| !p.is_near(from + gap / 2.0, width / 2.0));
            if !path.closed && is_free && part.contains(from + gap + way * TO_OUTLINE_MM) {
                carried.points[end] = snap(from + gap);
            }
        }
        carried
    };
    paths.iter().enumerate().map(carried).collect()
}

fn fill_triangles(triangles: &border::Triangles, options: &ThinFill, beads: &mut ThinBeads) {
    let axis = axis::chordal_axis(triangles);
    for chain in chains::chains(axis) {
        bead::lay(&chain, triangles, options, beads);
    }
}

/// Loops of the smallest width along the outline: crude, but printable and never far off.
fn follow_outline(island: &PolygonSet, options: &ThinFill, beads: &mut ThinBeads) {
    beads.fallbacks.extend(island.contours().first().and_then(|c| c.points.first()));
    let loops = island.offset(-options.min_width / 2.0, Join::WALL);
    let covered = loops.length() * options.min_width;
    beads.left_mm2 += (island.area() - covered).max(0.0);
    let paths = loops.into_contours().into_iter();
    beads.paths.extend(paths.map(|c| Path::closed(options.role, c.points, options.min_width)));
}

fn compare_points(a: &[DVec2], b: &[DVec2]) -> std::cmp::Ordering {
    let by_points = a.iter().zip(b).map(|(&p, &q)| by_x_then_y(p, q));
    by_points.fold(std::cmp::Ordering::Equal, |found, next| found.then(next)).then(a.len().cmp(&b.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    /// What follows the outline where no middle line is found.
    #[test]
    fn loops_of_the_smallest_width_follow_an_outline_and_say_where() {
        let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 0.5));
        let mut beads = ThinBeads::default();
        follow_outline(&strip, &ThinFill::default(), &mut beads);
        let [path] = &beads.paths[..] else { panic!("{} paths", beads.paths.len()) };
        assert!(path.closed && path.width == Width::Uniform(0.2));
        let length = 2.0 * (9.8 + 0.3);
        assert!((path.length() - length).abs() < 1e-3, "{}", path.length());
        assert!((beads.left_mm2 - (5.0 - 0.2 * length)).abs() < 1e-3, "{}", beads.left_mm2);
        let [at] = beads.fallbacks[..] else { panic!("{:?}", beads.fallbacks) };
        assert!(strip.contours()[0].points.contains(&at));
    }
}
