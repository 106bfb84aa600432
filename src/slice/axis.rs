//! The three cutting directions and the 2D frame of each.

use glam::{DVec2, Vec3, dvec2};

/// Normal of a family of parallel planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Planes x = const, seen in (y, z).
    X,
    /// Planes y = const, seen in (x, z).
    Y,
    /// Planes z = const, seen in (x, y): the layers.
    Z,
}

impl Axis {
    /// Coordinate along the normal, mm.
    pub fn height(self, v: Vec3) -> f32 {
        match self {
            Axis::X => v.x,
            Axis::Y => v.y,
            Axis::Z => v.z,
        }
    }

    /// Coordinates within the plane, mm.
    pub fn flat(self, v: Vec3) -> DVec2 {
        match self {
            Axis::X => dvec2(v.y.into(), v.z.into()),
            Axis::Y => dvec2(v.x.into(), v.z.into()),
            Axis::Z => dvec2(v.x.into(), v.y.into()),
        }
    }

    /// Whether (u, v, normal) is a left-handed frame: (x, z, y) is.
    pub(super) fn is_left_handed(self) -> bool {
        self == Axis::Y
    }
}
