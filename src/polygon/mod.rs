//! Closed contours in the plane, and sets of them.
//!
//! Conventions: millimetres; x to the right, y up; a contour is closed without repeating its first
//! point. In a [`PolygonSet`] outer contours run counter-clockwise, holes clockwise, and no two
//! contours cross. Every operation returns its contours in canonical form: points on the grid
//! [`GRID_MM`], each contour starting at its smallest (x, y), contours sorted. Equal areas reached
//! through the same operations therefore compare equal.

pub mod boolean;
pub mod grid;
pub mod groups;
pub mod hull;
pub mod island;
pub mod measure;
pub mod offset;
pub mod raycast;
pub mod simplify;
#[cfg(test)]
pub(crate) mod stars;
pub mod strips;
pub mod tiles;
pub mod trig;

use crate::sort::StableSort;
pub use glam::{DVec2, dvec2};
pub use offset::Join;

/// Step of the integer grid on which all polygon work happens, in mm: 0.1 um, a thousandth of what
/// printers resolve.
pub const GRID_MM: f64 = 1e-4;

/// Grid steps per mm.
pub(crate) const GRID_PER_MM: f64 = 1e4;

/// The grid point nearest to `p`.
pub fn snap(p: DVec2) -> DVec2 {
    grid_steps(p) / GRID_PER_MM
}

/// Whole grid steps nearest to `p`. Rounded by `floor`, which is one instruction everywhere, where
/// `round` is a call.
pub(crate) fn grid_steps(p: DVec2) -> DVec2 {
    (p * GRID_PER_MM + 0.5).floor()
}

/// One closed loop; the last point is not repeated.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Contour {
    /// Vertices in order, mm.
    pub points: Vec<DVec2>,
}

impl Contour {
    /// A contour through these points.
    pub fn new(points: Vec<DVec2>) -> Self {
        Contour { points }
    }

    /// The edges as pairs of points, the closing one included.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let n = self.points.len();
        (0..n).map(move |i| (self.points[i], self.points[if i + 1 == n { 0 } else { i + 1 }]))
    }

    /// The same loop walked the other way.
    pub fn reversed(&self) -> Contour {
        Contour::new(self.points.iter().rev().copied().collect())
    }

    /// Rotates the list of points so that it starts at the smallest (x, y).
    fn start_at_smallest(&mut self) {
        let smallest = (0..self.points.len()).min_by(|&a, &b| by_x_then_y(self.points[a], self.points[b]));
        self.points.rotate_left(smallest.unwrap_or(0));
    }
}

/// One connected area: an outer contour (counter-clockwise) and its holes (clockwise).
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// The outline.
    pub outer: Contour,
    /// Contours of the holes.
    pub holes: Vec<Contour>,
}

impl Polygon {
    /// The outline, then the holes.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> + Clone {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The same area as a set.
    pub fn into_set(self) -> PolygonSet {
        let mut contours = vec![self.outer];
        contours.extend(self.holes);
        PolygonSet::canonical(contours)
    }
}

/// An area of the plane: any number of islands with holes, kept as oriented contours.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct PolygonSet {
    contours: Vec<Contour>,
}

impl PolygonSet {
    /// The empty area.
    pub const EMPTY: PolygonSet = PolygonSet { contours: Vec::new() };

    /// The area wound around at least once by these contours, whatever their order, overlaps,
    /// self-crossings or direction (non-zero rule).
    pub fn from_contours(contours: Vec<Contour>) -> Self {
        boolean::unite(contours)
    }

    /// An axis-parallel rectangle.
    pub fn rectangle(min: DVec2, max: DVec2) -> Self {
        PolygonSet::canonical(vec![Contour::new(vec![min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)])])
    }

    /// Brings contours that are already free of crossings and rightly oriented into canonical order.
    pub(crate) fn canonical(mut contours: Vec<Contour>) -> Self {
        contours.retain(|c| c.points.len() >= 3);
        for contour in &mut contours {
            contour.start_at_smallest();
        }
        contours.stable_sort_by(compare_contours);
        PolygonSet { contours }
    }

    /// All contours: outer ones counter-clockwise, holes clockwise.
    pub fn contours(&self) -> &[Contour] {
        &self.contours
    }

    /// The contours themselves.
    pub fn into_contours(self) -> Vec<Contour> {
        self.contours
    }

    /// Whether nothing is covered.
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// Number of vertices of all contours.
    pub fn vertex_count(&self) -> usize {
        measure::vertex_count(&self.contours)
    }

    /// The connected parts, each with its holes, ordered by the outer contour's smallest point.
    pub fn islands(&self) -> Vec<Polygon> {
        raycast::group_into_islands(&self.contours)
    }

    /// The same area moved by `by`.
    pub fn translated(&self, by: DVec2) -> PolygonSet {
        let moved = |c: &Contour| Contour::new(c.points.iter().map(|&p| snap(p + by)).collect());
        PolygonSet::canonical(self.contours.iter().map(moved).collect())
    }
}

/// Order of the plane's points used for canonical forms: x first, then y.
pub fn by_x_then_y(a: DVec2, b: DVec2) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

fn compare_contours(a: &Contour, b: &Contour) -> std::cmp::Ordering {
    let by_points = a.points.iter().zip(&b.points).map(|(&p, &q)| by_x_then_y(p, q));
    by_points
        .fold(std::cmp::Ordering::Equal, |found, next| found.then(next))
        .then(a.points.len().cmp(&b.points.len()))
}
