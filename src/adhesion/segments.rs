//! Many segments in a uniform grid: which is nearest to a point, which a line crosses.

use crate::polygon::measure::Bounds;
use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{Contour, DVec2, dvec2};
use crate::sort::StableSort;

/// At most this many cells per segment, so that a long thin scene does not fill the memory.
const CELLS_PER_SEGMENT: f64 = 16.0;

/// A segment and the contour (or path) that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    pub(super) a: DVec2,
    pub(super) b: DVec2,
    pub(super) owner: u32,
}

/// The point of a segment that is nearest to some point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    pub(super) distance: f64,
    pub(super) point: DVec2,
    pub(super) owner: u32,
}

/// Segments by grid cell: cell `i` holds `items[starts[i]..starts[i + 1]]`.
pub(super) struct Segments {
    segments: Vec<Segment>,
    grid: Grid,
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Segments {
    /// Indexes the segments; `cell` is the wanted cell size, mm.
    pub(super) fn new(segments: Vec<Segment>, cell: f64) -> Self {
        let grid = Grid::around(&segments, cell);
        let mut starts = vec![0; grid.cells() + 1];
        for segment in &segments {
            grid.for_cells_of(segment, |cell| starts[cell + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut items = vec![0; starts[grid.cells()] as usize];
        let mut next = starts.clone();
        for (index, segment) in segments.iter().enumerate() {
            grid.for_cells_of(segment, |cell| {
                items[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        Segments { segments, grid, starts, items }
    }

    /// The edges of contours; the owner is the contour's index.
    pub(super) fn of_contours(contours: &[Contour], cell: f64) -> Self {
        let edges = |(owner, c): (usize, &Contour)| {
            c.edges().map(move |(a, b)| Segment { a, b, owner: owner as u32 }).collect::<Vec<_>>()
        };
        Segments::new(contours.iter().enumerate().flat_map(edges).collect(), cell)
    }

    /// The nearest point of any segment that is at most `within` mm away.
    pub(super) fn nearest(&self, p: DVec2, within: f64) -> Option<Near> {
        let mut best: Option<Near> = None;
        let mut best_squared = within * within;
        self.for_near(Bounds { min: p, max: p }.grown(within), |segment| {
            let point = closest_on_segment(p, segment.a, segment.b);
            let squared = p.distance_squared(point);
            if squared < best_squared {
                best_squared = squared;
                best = Some(Near { distance: 0.0, point, owner: segment.owner });
            }
        });
        best.map(|near| Near { distance: best_squared.sqrt(), ..near })
    }

    /// Where the line from `a` to `b` crosses segments, as sorted shares of its length in (0, 1).
    ///
    /// A vertex exactly on the line counts for one of its edges only: the half-open rule of
    /// `polygon::raycast`, turned into the direction of the line.
    pub(super) fn crossings(&self, a: DVec2, b: DVec2) -> Vec<f64> {
        let mut found: Vec<(DVec2, DVec2, f64)> = Vec::new();
        self.for_near(Bounds { min: a.min(b), max: a.max(b) }, |segment| {
            if let Some(share) = crossing(a, b, segment) {
                found.push((segment.a, segment.b, share));
            }
        });
        // A segment that lies in several cells was met several times.
        found.stable_sort_by(|x, y| x.2.total_cmp(&y.2));
        found.dedup();
        found.into_iter().map(|(_, _, share)| share).collect()
    }

    /// Calls `visit` for every segment in the cells that the box touches, some of them repeatedly.
    pub(super) fn for_near(&self, near: Bounds, mut visit: impl FnMut(&Segment)) {
        let Some((low, high)) = self.grid.cell_range(near) else { return };
        for y in low.1..=high.1 {
            let row = y * self.grid.columns;
            let (from, to) = (self.starts[row + low.0], self.starts[row + high.0 + 1]);
            for &index in &self.items[from as usize..to as usize] {
                visit(&self.segments[index as usize]);
            }
        }
    }
}

fn crossing(a: DVec2, b: DVec2, segment: &Segment) -> Option<f64> {
    let along = b - a;
    let (left, right) = (along.perp_dot(segment.a - a), along.perp_dot(segment.b - a));
    if (left > 0.0) == (right > 0.0) {
        return None;
    }
    let meet = segment.a + (segment.b - segment.a) * (left / (left - right));
    let share = (meet - a).dot(along) / along.length_squared();
    (share > 0.0 && share < 1.0).then_some(share)
}

/// Distance between two segments, mm; 0 where they cross.
pub(super) fn distance_between(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> f64 {
    let side = |s: (DVec2, DVec2), p: DVec2| (s.1 - s.0).perp_dot(p - s.0);
    let parted = |s: (DVec2, DVec2), t: (DVec2, DVec2)| side(s, t.0) * side(s, t.1) > 0.0;
    let ends = [(a.0, b), (a.1, b), (b.0, a), (b.1, a)];
    let apart = ends.map(|(p, s)| p.distance_squared(closest_on_segment(p, s.0, s.1)));
    let nearest = apart.into_iter().fold(f64::INFINITY, f64::min).sqrt();
    if parted(a, b) || parted(b, a) || nearest == 0.0 {
        return nearest;
    }
    // Neither lies on one side of the other: they cross, unless they are collinear.
    if side(a, b.0) == 0.0 && side(a, b.1) == 0.0 { nearest } else { 0.0 }
}

struct Grid {
    origin: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    fn around(segments: &[Segment], cell: f64) -> Grid {
        let ends = segments.iter().flat_map(|s| [&s.a, &s.b]);
        let Some(bounds) = Bounds::of_points(ends) else {
            return Grid { origin: DVec2::ZERO, cell, columns: 0, rows: 0 };
        };
        let size = bounds.size();
        let most = CELLS_PER_SEGMENT * (segments.len() as f64 + 64.0);
        let cell = cell.max((size.x * size.y / most).sqrt()).max((size.x + size.y) / most);
        let count = |length: f64| (length / cell).floor() as usize + 1;
        Grid { origin: bounds.min, cell, columns: count(size.x), rows: count(size.y) }
    }

    fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// First and last (column, row) that the box touches.
    fn cell_range(&self, b: Bounds) -> Option<((usize, usize), (usize, usize))> {
        let low = ((b.min - self.origin) / self.cell).floor();
        let high = ((b.max - self.origin) / self.cell).floor();
        let last = dvec2(self.columns as f64 - 1.0, self.rows as f64 - 1.0);
        if high.x < 0.0 || high.y < 0.0 || low.x > last.x || low.y > last.y || self.cells() == 0 {
            return None;
        }
        let (low, high) = (low.max(DVec2::ZERO), high.min(last));
        Some(((low.x as usize, low.y as usize), (high.x as usize, high.y as usize)))
    }

    /// Visits the cells that a segment passes: row by row, the columns of its piece in that row.
    fn for_cells_of(&self, segment: &Segment, mut visit: impl FnMut(usize)) {
        let (a, b) = if segment.a.y <= segment.b.y { (segment.a, segment.b) } else { (segment.b, segment.a) };
        let range = self.cell_range(Bounds { min: a.min(b), max: a.max(b) });
        let Some(((left, first), (right, last))) = range else { return };
        if first == last {
            return (left..=right).for_each(|column| visit(first * self.columns + column));
        }
        let at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
        for row in first..=last {
            let bottom = self.origin.y + row as f64 * self.cell;
            let (p, q) = (at(bottom.max(a.y)), at((bottom + self.cell).min(b.y)));
            let slack = self.cell * 1e-6;
            let piece = Bounds {
                min: dvec2(p.min(q) - slack, bottom + slack),
                max: dvec2(p.max(q) + slack, bottom + slack),
            };
            let Some(((low, _), (high, _))) = self.cell_range(piece) else { continue };
            (low..=high).for_each(|column| visit(row * self.columns + column));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::simplify::squared_distance_to_segment;

    /// A fixed sequence of numbers in 0..1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        }
    }

    #[test]
    fn the_grid_finds_what_a_plain_search_finds() {
        let mut next = numbers();
        let mut point = move || dvec2(next() * 50.0, next() * 30.0);
        let segments: Vec<Segment> = (0..300).map(|i| Segment { a: point(), b: point(), owner: i }).collect();
        let index = Segments::new(segments.clone(), 1.0);
        for _ in 0..200 {
            let (p, q) = (point(), point());
            let plain = segments.iter().map(|s| squared_distance_to_segment(p, s.a, s.b));
            let plain = plain.fold(f64::INFINITY, f64::min).sqrt();
            let found = index.nearest(p, 60.0).expect("300 segments within 60 mm");
            assert!((found.distance - plain).abs() < 1e-12);
            let crossed = segments.iter().filter(|s| crossing(p, q, s).is_some()).count();
            assert_eq!(index.crossings(p, q).len(), crossed);
        }
    }

    #[test]
    fn distances_between_segments_known_on_paper() {
        let x = (dvec2(0.0, 0.0), dvec2(4.0, 0.0));
        let cases = [
            (dvec2(0.0, 3.0), dvec2(4.0, 3.0), 3.0),
            (dvec2(2.0, -1.0), dvec2(2.0, 1.0), 0.0),
            (dvec2(7.0, 4.0), dvec2(7.0, 9.0), 5.0),
            (dvec2(6.0, 0.0), dvec2(9.0, 0.0), 2.0),
            (dvec2(2.0, 0.0), dvec2(9.0, 0.0), 0.0),
        ];
        for (a, b, expected) in cases {
            assert!((distance_between(x, (a, b)) - expected).abs() < 1e-12, "{a} {b}");
        }
    }
}
