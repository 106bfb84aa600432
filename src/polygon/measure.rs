//! Area, length, centroid and bounds.

use super::{Contour, DVec2, Polygon, PolygonSet};

/// An axis-parallel box in the plane, mm.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Bounds {
    /// Smallest x and y.
    pub min: DVec2,
    /// Largest x and y.
    pub max: DVec2,
}

impl Bounds {
    /// The smallest box around the points, or `None` without points.
    pub fn of_points<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> Option<Bounds> {
        points.into_iter().fold(None, |found: Option<Bounds>, &p| match found {
            None => Some(Bounds { min: p, max: p }),
            Some(b) => Some(Bounds { min: b.min.min(p), max: b.max.max(p) }),
        })
    }

    /// The smallest box around both.
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the boxes share a point when grown towards each other by `margin` mm.
    pub fn is_near(self, other: Bounds, margin: f64) -> bool {
        self.min.cmple(other.max + margin).all() && other.min.cmple(self.max + margin).all()
    }

    /// The box grown by `margin` mm on each side.
    pub fn grown(self, margin: f64) -> Bounds {
        Bounds { min: self.min - margin, max: self.max + margin }
    }

    /// Whether `other` lies inside, the border included.
    pub fn contains(self, other: Bounds) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// Width and height, mm.
    pub fn size(self) -> DVec2 {
        self.max - self.min
    }

    /// The middle.
    pub fn centre(self) -> DVec2 {
        (self.min + self.max) / 2.0
    }
}

/// Number of vertices of all these contours.
pub fn vertex_count(contours: &[Contour]) -> usize {
    contours.iter().map(|c| c.points.len()).sum()
}

impl Contour {
    /// Enclosed area, mm2: positive counter-clockwise, negative clockwise.
    pub fn signed_area(&self) -> f64 {
        let Some(&origin) = self.points.first() else { return 0.0 };
        self.edges().map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>() / 2.0
    }

    /// Length of the loop, mm.
    pub fn length(&self) -> f64 {
        self.edges().map(|(a, b)| a.distance(b)).sum()
    }

    /// The smallest box around the contour.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of_points(&self.points)
    }
}

impl Polygon {
    /// Covered area, mm2.
    pub fn area(&self) -> f64 {
        self.outer.signed_area() + self.holes.iter().map(Contour::signed_area).sum::<f64>()
    }
}

impl PolygonSet {
    /// Covered area, mm2.
    pub fn area(&self) -> f64 {
        self.contours().iter().map(Contour::signed_area).sum()
    }

    /// Length of all outlines, mm.
    pub fn length(&self) -> f64 {
        self.contours().iter().map(Contour::length).sum()
    }

    /// The smallest box around everything.
    pub fn bounds(&self) -> Option<Bounds> {
        self.contours().iter().filter_map(Contour::bounds).reduce(Bounds::union)
    }
}
