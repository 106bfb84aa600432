//! Growing and shrinking areas.

use clipper2_rust::{ClipperOffset, EndType, JoinType, Paths64};

use super::boolean::{from_paths, to_paths};
use super::{DVec2, GRID_PER_MM, PolygonSet};

/// How the corner between two shifted edges is closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Join {
    /// The edges run on until they meet; past `limit` times the distance the corner is cut off.
    Mitre {
        /// Largest distance of the new corner from the old one, in multiples of the offset.
        limit: f64,
    },
    /// Cut off at the offset's distance from the corner.
    Square,
}

impl Join {
    /// What slicers use for walls: mitred up to twice the distance.
    pub const WALL: Join = Join::Mitre { limit: 2.0 };
}

impl PolygonSet {
    /// The area grown by `distance` mm (shrunk when negative); islands that meet are merged,
    /// parts thinner than twice the shrinking distance vanish.
    ///
    /// There are no round joins: their corner points need a sine, which differs between platforms.
    pub fn offset(&self, distance: f64, join: Join) -> PolygonSet {
        if distance == 0.0 || self.is_empty() {
            return self.clone();
        }
        let (kind, limit) = match join {
            Join::Mitre { limit } => (JoinType::Miter, limit),
            Join::Square => (JoinType::Square, 2.0),
        };
        let across = self.is_swept_better_across();
        let mut paths = to_paths(self.contours());
        if across {
            swap_axes(&mut paths);
        }
        let mut engine = ClipperOffset::new(limit, 0.0, false, false);
        engine.add_paths(&paths, kind, EndType::Polygon);
        let mut solution = Paths64::new();
        engine.execute(distance * GRID_PER_MM, &mut solution);
        if across {
            swap_axes(&mut solution);
        }
        from_paths(&solution)
    }

    /// Whether far fewer edges meet a line x = const than a line y = const. The library moves one of the
    /// latter over the plane and searches all that it meets: for a comb of 2,500 prongs side by side
    /// that is five times slower.
    fn is_swept_better_across(&self) -> bool {
        /// Smaller areas are fast either way.
        const FEW: usize = 1000;
        /// So many times fewer.
        const FAR_FEWER: f64 = 4.0;
        if self.vertex_count() < FEW {
            return false;
        }
        let Some(bounds) = self.bounds() else { return false };
        let edges = self.contours().iter().flat_map(|c| c.edges());
        let run = edges.fold(DVec2::ZERO, |sum, (a, b)| sum + (b - a).abs());
        let met = run / bounds.size();
        met.x * FAR_FEWER < met.y
    }

    /// Shrunk and grown again: what is thinner than `2 * radius` disappears.
    pub fn opened(&self, radius: f64, join: Join) -> PolygonSet {
        self.offset(-radius, join).offset(radius, join)
    }

    /// Grown and shrunk again: slots and gaps narrower than `2 * radius` are filled.
    pub fn closed(&self, radius: f64, join: Join) -> PolygonSet {
        self.offset(radius, join).offset(-radius, join)
    }
}

/// Mirrors at the line x = y; walked the other way round, outlines stay outlines.
fn swap_axes(paths: &mut Paths64) {
    for path in paths.iter_mut() {
        path.iter_mut().for_each(|p| std::mem::swap(&mut p.x, &mut p.y));
        path.reverse();
    }
}
