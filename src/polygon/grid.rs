//! Grids of points and edges for neighbour queries.

use super::measure::Bounds;
use super::simplify::closest_on_segment;
use super::{DVec2, dvec2};
use crate::sort::StableSort;

/// Square cells over a box, numbered row by row.
#[derive(Debug, Clone)]
struct Cells {
    origin: DVec2,
    side: f64,
    columns: i64,
    rows: i64,
}

impl Cells {
    /// About as many cells as there are things to sort, over the box of `points`.
    fn over(points: &[DVec2], things: usize) -> Cells {
        let bounds = Bounds::of_points(points).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
        let size = bounds.size();
        let count = things.max(1) as f64;
        // A row of points on one line has no area: its length decides then. 1 um is less than any
        // two different paths are apart.
        let side = (size.x * size.y / count).sqrt().max(size.max_element() / count).max(1e-3);
        Cells {
            origin: bounds.min,
            side,
            columns: (size.x / side) as i64 + 1,
            rows: (size.y / side) as i64 + 1,
        }
    }

    fn count(&self) -> usize {
        (self.columns * self.rows) as usize
    }

    /// Column and row of the cell that holds `p` or is nearest to it.
    fn column_and_row(&self, p: DVec2) -> (i64, i64) {
        let at = (p - self.origin) / self.side;
        ((at.x as i64).clamp(0, self.columns - 1), (at.y as i64).clamp(0, self.rows - 1))
    }

    fn number(&self, column: i64, row: i64) -> usize {
        (row * self.columns + column) as usize
    }
}

/// Points in square cells; the nearest one is found by looking at rings of cells around the query.
#[derive(Debug, Clone)]
pub struct PointGrid {
    frame: Cells,
    /// Points of each cell with the caller's index.
    cells: Vec<Vec<(DVec2, usize)>>,
    count: usize,
}

impl PointGrid {
    /// A grid of all points, whose indices are their places in the slice. There are about as many
    /// cells as points, so that most hold one or two.
    pub fn new(points: &[DVec2]) -> PointGrid {
        let frame = Cells::over(points, points.len());
        let cells = vec![Vec::new(); frame.count()];
        let mut grid = PointGrid { frame, cells, count: points.len() };
        for (index, &p) in points.iter().enumerate() {
            let place = grid.place(p);
            grid.cells[place].push((p, index));
        }
        grid
    }

    /// Whether no point is left.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Takes a point out; does nothing when it is not there.
    pub fn remove(&mut self, p: DVec2, index: usize) {
        let place = self.place(p);
        let before = self.cells[place].len();
        self.cells[place].retain(|&(_, i)| i != index);
        self.count -= before - self.cells[place].len();
    }

    /// The point nearest to `p`; of several the one with the smallest index.
    pub fn nearest(&self, p: DVec2) -> Option<(DVec2, usize)> {
        if self.is_empty() {
            return None;
        }
        let (column, row) = self.frame.column_and_row(p);
        let mut best: Option<(f64, DVec2, usize)> = None;
        for ring in 0..=self.frame.columns.max(self.frame.rows) {
            // Everything in this ring and beyond is at least this far away.
            let reached = (ring - 1) as f64 * self.frame.side;
            if best.is_some_and(|b| reached > 0.0 && b.0 < reached * reached) {
                break;
            }
            self.each_in_ring(column, row, ring, |q, index| {
                let distance = p.distance_squared(q);
                if best.is_none_or(|b| distance < b.0 || (distance == b.0 && index < b.2)) {
                    best = Some((distance, q, index));
                }
            });
        }
        best.map(|(_, q, index)| (q, index))
    }

    fn each_in_ring(&self, column: i64, row: i64, ring: i64, mut visit: impl FnMut(DVec2, usize)) {
        for y in (row - ring).max(0)..=(row + ring).min(self.frame.rows - 1) {
            let on_edge = (y - row).abs() == ring;
            let step = if on_edge || ring == 0 { 1 } else { 2 * ring };
            for x in (column - ring..=column + ring).step_by(step as usize) {
                if (0..self.frame.columns).contains(&x) {
                    for &(q, index) in &self.cells[self.frame.number(x, y)] {
                        visit(q, index);
                    }
                }
            }
        }
    }

    fn place(&self, p: DVec2) -> usize {
        let (column, row) = self.frame.column_and_row(p);
        self.frame.number(column, row)
    }
}

/// Directed edges in square cells, to find those that a line may cross.
#[derive(Debug, Clone)]
pub struct EdgeGrid {
    frame: Cells,
    /// `edges[starts[i]..starts[i + 1]]` touch the box of cell i.
    starts: Vec<u32>,
    /// Edges with their places in the list that the grid was made of.
    edges: Vec<(DVec2, DVec2, u32)>,
}

impl EdgeGrid {
    /// A grid of the given edges.
    pub fn new(all: &[(DVec2, DVec2)]) -> EdgeGrid {
        let ends: Vec<DVec2> = all.iter().flat_map(|&(a, b)| [a, b]).collect();
        let frame = Cells::over(&ends, all.len());
        let starts = vec![0; frame.count() + 1];
        let mut grid = EdgeGrid { frame, starts, edges: Vec::new() };
        for &(a, b) in all {
            grid.each_cell(a, b, |grid, place| grid.starts[place + 1] += 1);
        }
        for i in 1..grid.starts.len() {
            grid.starts[i] += grid.starts[i - 1];
        }
        let mut next = grid.starts.clone();
        grid.edges = vec![(DVec2::ZERO, DVec2::ZERO, 0); next[next.len() - 1] as usize];
        for (&(a, b), index) in all.iter().zip(0..) {
            grid.each_cell(a, b, |grid, place| {
                grid.edges[next[place] as usize] = (a, b, index);
                next[place] += 1;
            });
        }
        grid
    }

    /// Whether the segment a-b crosses or touches an edge.
    pub fn crosses(&self, a: DVec2, b: DVec2) -> bool {
        self.cells_met(a, b).any(|place| self.in_cell(place).iter().any(|&(c, d, _)| do_cross(a, b, c, d)))
    }

    /// The edges that the segment a-b crosses, by their places in the list, in the order in which it
    /// meets them; with each how far along it is met, 0 at a and 1 at b.
    ///
    /// A point exactly on a line counts as right of it. So a line of segments crosses a closed
    /// contour an even number of times if it begins and ends outside.
    pub fn crossings(&self, a: DVec2, b: DVec2) -> Vec<(f64, usize)> {
        let mut found: Vec<(f64, usize)> = Vec::new();
        for place in self.cells_met(a, b) {
            for &(c, d, index) in self.in_cell(place) {
                found.extend(crossing_at(a, b, c, d).map(|t| (t, index as usize)));
            }
        }
        found.stable_sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        // An edge is met in each cell that both touch.
        found.dedup();
        found
    }

    fn in_cell(&self, place: usize) -> &[(DVec2, DVec2, u32)] {
        &self.edges[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// Numbers of the cells that the segment a-b may touch.
    fn cells_met(&self, a: DVec2, b: DVec2) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (self.frame.column_and_row(a.min(b)), self.frame.column_and_row(a.max(b)));
        let columns = move |row| self.columns_met(a, b, row, low.0, high.0);
        (low.1..=high.1).flat_map(move |row| columns(row).map(move |column| self.frame.number(column, row)))
    }

    /// The point on an edge nearest to `p`, if any is within `reach` mm.
    pub fn nearest(&self, p: DVec2, reach: f64) -> Option<DVec2> {
        self.nearest_foot(p, reach).map(|(_, foot, _)| foot)
    }

    /// The edge nearest to `p`, if any is within `reach` mm: squared distance and place in the list.
    pub fn nearest_edge(&self, p: DVec2, reach: f64) -> Option<(f64, usize)> {
        self.nearest_foot(p, reach).map(|(squared, _, index)| (squared, index as usize))
    }

    fn nearest_foot(&self, p: DVec2, reach: f64) -> Option<(f64, DVec2, u32)> {
        let (low, high) = (self.frame.column_and_row(p - reach), self.frame.column_and_row(p + reach));
        let mut best: Option<(f64, DVec2, u32)> = None;
        let mut least = reach * reach;
        for row in low.1..=high.1 {
            for column in low.0..=high.0 {
                let place = self.frame.number(column, row);
                for &(a, b, index) in self.in_cell(place) {
                    let foot = closest_on_segment(p, a, b);
                    let distance = foot.distance_squared(p);
                    if distance <= least {
                        (best, least) = (Some((distance, foot, index)), distance);
                    }
                }
            }
        }
        best
    }

    fn each_cell(&mut self, a: DVec2, b: DVec2, mut visit: impl FnMut(&mut EdgeGrid, usize)) {
        let (low, high) = (self.frame.column_and_row(a.min(b)), self.frame.column_and_row(a.max(b)));
        for row in low.1..=high.1 {
            for column in self.columns_met(a, b, row, low.0, high.0) {
                visit(self, self.frame.number(column, row));
            }
        }
    }

    /// Columns that the segment a-b touches within a row, one more on either side for rounding.
    fn columns_met(
        &self,
        a: DVec2,
        b: DVec2,
        row: i64,
        first: i64,
        last: i64,
    ) -> std::ops::RangeInclusive<i64> {
        let (from, to) = if a.y <= b.y { (a, b) } else { (b, a) };
        let bottom = self.frame.origin.y + row as f64 * self.frame.side;
        let rise = to.y - from.y;
        if rise <= self.frame.side {
            return first..=last;
        }
        let share = |y: f64| ((y - from.y) / rise).clamp(0.0, 1.0);
        let x_at = |y: f64| from.x + (to.x - from.x) * share(y);
        let (p, q) = (x_at(bottom), x_at(bottom + self.frame.side));
        let column = |x: f64| self.frame.column_and_row(dvec2(x, bottom)).0;
        (column(p.min(q)) - 1).max(first)..=(column(p.max(q)) + 1).min(last)
    }
}

/// How far along a-b it crosses c-d; a point on the other's line counts as right of it.
fn crossing_at(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<f64> {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (from, to) = (side(c, d, a), side(c, d, b));
    let crosses = (from > 0.0) != (to > 0.0) && (side(a, b, c) > 0.0) != (side(a, b, d) > 0.0);
    crosses.then(|| from / (from - to))
}

/// Whether two closed segments have a point in common, collinear overlap left aside.
pub fn do_cross(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) <= 0.0
        && side(c, d, a) * side(c, d, b) <= 0.0
        && side(a, b, c) != side(a, b, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(count: usize) -> impl Strategy<Value = Vec<DVec2>> {
        prop::collection::vec((-50.0..50.0f64, -50.0..50.0f64).prop_map(|(x, y)| dvec2(x, y)), 1..count)
    }

    proptest! {
        #[test]
        fn the_nearest_point_is_the_one_a_full_search_finds(points in points(60), query in points(20)) {
            let mut grid = PointGrid::new(&points);
            let mut left: Vec<usize> = (0..points.len()).collect();
            for q in query {
                let by_search = left.iter().copied().min_by(|&a, &b| {
                    points[a].distance_squared(q).total_cmp(&points[b].distance_squared(q))
                });
                prop_assert_eq!(grid.nearest(q).map(|n| n.1), by_search);
                if let Some(i) = by_search {
                    grid.remove(points[i], i);
                    left.retain(|&l| l != i);
                }
            }
        }

        #[test]
        fn a_crossing_is_found_wherever_a_full_search_finds_one(ends in points(80), query in points(20)) {
            let edges: Vec<(DVec2, DVec2)> = ends.chunks_exact(2).map(|e| (e[0], e[1])).collect();
            let grid = EdgeGrid::new(&edges);
            for line in query.chunks_exact(2) {
                let by_search = edges.iter().any(|&(c, d)| do_cross(line[0], line[1], c, d));
                prop_assert_eq!(grid.crosses(line[0], line[1]), by_search);
            }
        }

        #[test]
        fn crossings_are_those_of_a_full_search(ends in points(80), query in points(20)) {
            let edges: Vec<(DVec2, DVec2)> = ends.chunks_exact(2).map(|e| (e[0], e[1])).collect();
            let grid = EdgeGrid::new(&edges);
            for line in query.chunks_exact(2) {
                let of_edge = |(i, &(c, d)): (usize, &(DVec2, DVec2))| Some((crossing_at(line[0], line[1], c, d)?, i));
                let mut by_search: Vec<(f64, usize)> = edges.iter().enumerate().filter_map(of_edge).collect();
                by_search.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
                prop_assert_eq!(grid.crossings(line[0], line[1]), by_search);
            }
        }
    }
}
