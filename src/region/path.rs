//! Centre line of one bead. Stages that lay lines themselves (skirt, brim, teeth, plates, walls,
//! infill) make paths; `toolpath` puts them in printing order.

use super::Role;
use crate::polygon::DVec2;
use crate::polygon::simplify::squared_distance_to_segment;

/// Centre line of one bead, open or closed.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Path {
    /// What the bead is for.
    pub role: Role,
    /// Points of the centre line, mm. A closed path does not repeat its first point.
    pub points: Vec<DVec2>,
    /// Whether the bead returns to its first point.
    pub closed: bool,
    /// Bead width along the path, mm.
    pub width: Width,
    /// Share of the bead's width with nothing below, 0 to 1; told for [`Role::OverhangWall`] alone.
    pub hang: f64,
}

/// Width of a bead along its path.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Width {
    /// The same everywhere, mm.
    Uniform(f64),
    /// One width per point, mm; between two points it changes linearly.
    Varying(Vec<f64>),
}

impl Width {
    /// Width at point `index`.
    pub fn at(&self, index: usize) -> f64 {
        match self {
            Width::Uniform(w) => *w,
            Width::Varying(widths) => widths[index],
        }
    }
}

impl Path {
    /// A closed bead of one width.
    pub fn closed(role: Role, points: Vec<DVec2>, width: f64) -> Self {
        Path { role, points, closed: true, width: Width::Uniform(width), hang: 0.0 }
    }

    /// An open bead of one width.
    pub fn open(role: Role, points: Vec<DVec2>, width: f64) -> Self {
        Path { role, points, closed: false, width: Width::Uniform(width), hang: 0.0 }
    }

    /// Area that the bead covers, mm2: length times width, round ends left out.
    pub fn area(&self) -> f64 {
        let of_edge = |(i, next): (usize, usize)| {
            self.points[i].distance(self.points[next]) * (self.width.at(i) + self.width.at(next)) / 2.0
        };
        self.edges().map(of_edge).sum()
    }

    /// Places of the points at both ends of each edge, the closing edge included.
    pub fn edges(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let n = self.points.len();
        let count = if self.closed { n } else { n.saturating_sub(1) };
        (0..count).map(move |i| (i, (i + 1) % n))
    }

    /// The same line with a bead that is `by` mm wider everywhere.
    pub fn widened(mut self, by: f64) -> Path {
        match &mut self.width {
            Width::Uniform(width) => *width += by,
            Width::Varying(widths) => widths.iter_mut().for_each(|w| *w += by),
        }
        self
    }

    /// Turns a closed path so that it starts at this point.
    pub fn start_at(&mut self, index: usize) {
        self.points.rotate_left(index);
        if let Width::Varying(widths) = &mut self.width {
            widths.rotate_left(index);
        }
    }

    /// Adds a point of the line before point `index`, where the bead is as wide as it was.
    pub fn insert(&mut self, index: usize, p: DVec2) {
        if let Width::Varying(widths) = &mut self.width {
            let (before, after) = (index - 1, index % widths.len());
            let (a, b) = (self.points[before], self.points[after]);
            let share = a.distance(p) / a.distance(b).max(f64::MIN_POSITIVE);
            widths.insert(index, widths[before] + (widths[after] - widths[before]) * share);
        }
        self.points.insert(index, p);
    }

    /// The same bead laid the other way.
    pub fn reversed(mut self) -> Path {
        self.points.reverse();
        if let Width::Varying(widths) = &mut self.width {
            widths.reverse();
        }
        self
    }

    /// Whether the centre line, its closing edge left out, comes nearer to `p` than `distance` mm.
    pub fn is_near(&self, p: DVec2, distance: f64) -> bool {
        let squared = distance * distance;
        self.points.windows(2).any(|w| squared_distance_to_segment(p, w[0], w[1]) < squared)
    }

    /// Length of the centre line, the closing edge included, mm.
    pub fn length(&self) -> f64 {
        self.edges().map(|(i, next)| self.points[i].distance(self.points[next])).sum()
    }
}
