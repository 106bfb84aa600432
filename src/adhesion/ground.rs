//! What stands on the bed, simplified once for all kinds.

use super::FirstLayer;
use crate::polygon::simplify::simplify_ring;
use crate::polygon::{Contour, PolygonSet};

/// Steps of simplification, mm: a vertex goes when it is closer than this to the outline without it.
/// A finely tessellated outline loses nine vertices in ten at the first; a scanned one, whose noise
/// would make offsets slow (a rail around 10,000 vertices of 0.04 mm noise: 90 ms), goes through all
/// three. Their sum, 0.02, is less than half of what a bite may be off.
const TOLERANCES_MM: [f64; 3] = [0.001, 0.004, 0.015];

/// Outlines with fewer vertices are fine enough to be fast.
const FAST_VERTICES: usize = 2000;

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

/// Contours closer than the tolerance may come to cross by it; unlike [`PolygonSet::simplified`] this does
/// not unite them again, as offsets and distances do not mind.
pub(super) fn simplified_by(set: &PolygonSet, tolerance: f64) -> PolygonSet {
    PolygonSet::canonical(set.contours().iter().map(|c| simplify_ring(c, tolerance)).collect())
}
