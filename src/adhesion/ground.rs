//! What stands on the bed, simplified once for all kinds.

use super::FirstLayer;
use crate::polygon::simplify::{simplify_line, simplify_ring};
use crate::polygon::{Contour, DVec2, Join, PolygonSet};

/// Steps of simplification, mm: a vertex goes when it is closer than this to the outline without it.
/// A finely tessellated outline loses nine vertices in ten at the first; a scanned one, whose noise
/// would make offsets slow (a rail around 10,000 vertices of 0.04 mm noise: 90 ms), goes through all
/// three. Their sum, 0.02, is less than half of what a bite may be off.
const TOLERANCES_MM: [f64; 3] = [0.001, 0.004, 0.015];

/// Outlines with fewer vertices are fine enough to be fast.
pub(super) const FAST_VERTICES: usize = 2000;

/// What stands on the bed.
pub(super) struct Ground {
    /// Contours of the part's printed outline: attachment is measured to them.
    pub(super) part: Vec<Contour>,
    /// Part and supports as one area: adhesion is laid around it.
    pub(super) area: PolygonSet,
}

impl Ground {
    pub(super) fn of(first: &FirstLayer) -> Ground {
        let part = simplified(first.outline);
        let area = match first.supports.is_empty() {
            true => part.clone(),
            false => part.union(&simplified(first.supports)),
        };
        Ground { part: part.into_contours(), area }
    }
}

/// Fewer vertices, as far as needed.
fn simplified(set: &PolygonSet) -> PolygonSet {
    let mut simple = simplified_by(set, TOLERANCES_MM[0]);
    for tolerance in &TOLERANCES_MM[1..] {
        if simple.vertex_count() <= FAST_VERTICES {
            break;
        }
        simple = simplified_by(&simple, *tolerance);
    }
    simple
}

/// Crowded outlines grow by this at first, mm, and by [`STEP_FACTOR`] times as much each time after.
const FIRST_STEP_MM: f64 = 0.5;

/// See [`FIRST_STEP_MM`].
const STEP_FACTOR: f64 = 3.0;

/// Outer outlines this many times as long as the box around them are crowded: prongs, spikes, letters.
const CROWDED: f64 = 2.5;

/// The area grown by `distance` mm; where that takes several steps, borders may move by `tolerance` mm in
/// each.
///
/// Crowded outlines grow in steps. At once, the shifted edges of many prongs would all cross each other
/// (10,000 spikes grown by 15 mm: 6 s); the first small step closes most gaps, and what is left is simple.
pub(super) fn grown(area: &PolygonSet, distance: f64, join: Join, tolerance: f64) -> PolygonSet {
    if distance <= FIRST_STEP_MM || !is_crowded(area) {
        return area.offset(distance, join);
    }
    let (mut at, mut left, mut step) = (area.clone(), distance, FIRST_STEP_MM);
    while left > step {
        at = simplified_by(&at.offset(step, join), tolerance);
        left -= step;
        step *= STEP_FACTOR;
    }
    at.offset(left, join)
}

fn is_crowded(area: &PolygonSet) -> bool {
    let around = area.bounds().map_or(0.0, |b| 2.0 * (b.size().x + b.size().y));
    let outer = area.contours().iter().filter(|c| c.signed_area() > 0.0);
    outer.map(Contour::length).sum::<f64>() > CROWDED * around
}

/// Longer contours are simplified in groups of [`GROUP`] vertices: Douglas and Peucker's way costs the square of
/// their number in the worst case, which a comb is. The ends of each group stay.
const LONG: usize = 2500;

/// See [`LONG`].
const GROUP: usize = 256;

/// Contours closer than the tolerance may come to cross by it; unlike [`PolygonSet::simplified`] this does
/// not unite them again, as offsets and distances do not mind.
pub(super) fn simplified_by(set: &PolygonSet, tolerance: f64) -> PolygonSet {
    let simpler = |c: &Contour| {
        if c.points.len() <= LONG {
            return simplify_ring(c, tolerance);
        }
        let groups = (0..c.points.len()).step_by(GROUP);
        let group = |from: usize| {
            let after = c.points.get(from + GROUP).unwrap_or(&c.points[0]);
            let line: Vec<DVec2> = c.points[from..].iter().take(GROUP).chain([after]).copied().collect();
            let mut kept = simplify_line(&line, tolerance);
            kept.pop();
            kept
        };
        Contour::new(groups.flat_map(group).collect())
    };
    PolygonSet::canonical(set.contours().iter().map(simpler).collect())
}
