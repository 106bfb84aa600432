//! Growing and shrinking areas.

use clipper2_rust::{ClipperOffset, EndType, JoinType, Paths64};

use super::boolean::{from_paths, to_paths};
use super::{GRID_PER_MM, PolygonSet};

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
        let mut engine = ClipperOffset::new(limit, 0.0, false, false);
        engine.add_paths(&to_paths(self.contours()), kind, EndType::Polygon);
        let mut solution = Paths64::new();
        engine.execute(distance * GRID_PER_MM, &mut solution);
        from_paths(&solution)
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
