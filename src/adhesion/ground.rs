//! What stands on the bed, simplified once for all kinds.

use super::FirstLayer;
use crate::polygon::simplify::simplify_ring;
use crate::polygon::{Contour, PolygonSet};

/// Vertices closer to the outline than this are dropped, mm: a tenth of what the bite may be off, and
/// well below what a printer resolves; fine tessellations lose nine vertices in ten.
const TOLERANCE_MM: f64 = 0.005;

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

/// Fewer vertices. Contours closer than the tolerance may come to cross by it; unlike
/// [`PolygonSet::simplified`] this does not unite them again, as offsets and distances do not mind.
fn simplified(set: &PolygonSet) -> PolygonSet {
    PolygonSet::canonical(set.contours().iter().map(|c| simplify_ring(c, TOLERANCE_MM)).collect())
}
