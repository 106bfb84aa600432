//! Many questions whether a point lies in one area.

use super::measure::{Bounds, vertex_count};
use super::{Contour, DVec2, PolygonSet};

/// The edges of an area sorted into level strips, for many questions whether a point is inside.
#[derive(Debug)]
pub struct Strips {
    low: f64,
    per_mm: f64,
    /// Where the edges of each strip begin, and the last ones end.
    starts: Vec<u32>,
    edges: Vec<(DVec2, DVec2)>,
}

impl Strips {
    /// Sorts the edges of `area`.
    pub fn new(area: &PolygonSet) -> Strips {
        Strips::of_contours(area.contours())
    }

    /// The same for contours that may overlap: what they wind around is inside.
    pub fn of_contours(contours: &[Contour]) -> Strips {
        let bounds = Bounds::of_points(contours.iter().flat_map(|c| &c.points));
        let (low, height) = bounds.map_or((0.0, 0.0), |b| (b.min.y, b.size().y));
        let count = (vertex_count(contours) / 4).clamp(1, 512);
        let mut strips = Strips {
            low,
            per_mm: count as f64 / height.max(1e-3),
            starts: vec![0; count + 1],
            edges: Vec::new(),
        };
        let edges = || contours.iter().flat_map(Contour::edges);
        for (a, b) in edges() {
            (strips.at(a.y.min(b.y))..=strips.at(a.y.max(b.y))).for_each(|strip| strips.starts[strip] += 1);
        }
        // The end of each strip; filling it moves that to its start.
        let mut end = 0;
        strips.starts.iter_mut().for_each(|start| {
            end += *start;
            *start = end;
        });
        strips.edges.resize(end as usize, (DVec2::ZERO, DVec2::ZERO));
        for (a, b) in edges() {
            for strip in strips.at(a.y.min(b.y))..=strips.at(a.y.max(b.y)) {
                strips.starts[strip] -= 1;
                strips.edges[strips.starts[strip] as usize] = (a, b);
            }
        }
        strips
    }

    fn at(&self, y: f64) -> usize {
        (((y - self.low) * self.per_mm) as usize).min(self.starts.len() - 2)
    }

    /// Whether `p` lies inside (points on the border may fall either way).
    pub fn contain(&self, p: DVec2) -> bool {
        let crosses = |&&(a, b): &&(DVec2, DVec2)| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
        };
        let turn = |&(a, b): &(DVec2, DVec2)| if a.y < b.y { 1 } else { -1 };
        let strip = self.at(p.y);
        let edges = &self.edges[self.starts[strip] as usize..self.starts[strip + 1] as usize];
        edges.iter().filter(crosses).map(turn).sum::<i32>() != 0
    }
}
