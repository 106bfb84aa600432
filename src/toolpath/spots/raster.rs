//! Points of an area, and how many edges of beads lie over each.

use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{Contour, DVec2, dvec2};
use crate::region::Path;
use crate::sets::Sets;
use crate::sort::StableSort;
use std::ops::Range;

/// Distance of the points, mm.
pub(super) const STEP_MM: f64 = 0.07;

/// A spot has as many points at least: 0.02 mm2.
const FEWEST: usize = 4;

/// Points along each side of a tile.
const SIDE: i32 = 16;

/// No tile.
const NONE: u32 = u32::MAX;

/// The mark of a place that is no point; other marks say how many edges of beads cover the point.
const NO_POINT: u8 = u8::MAX;

/// Points in a square grid, kept in square tiles where there are any.
pub(super) struct Raster {
    /// Column and row of the first tile.
    low: [i32; 2],
    /// Tiles in a row.
    columns: i32,
    /// Number of each tile among those that are kept, row by row.
    tiles: Vec<u32>,
    /// The marks of each kept tile's points, row by row.
    marks: Vec<u8>,
}

/// The first column or row whose points do not lie below `v` mm.
fn first_from(v: f64) -> i32 {
    (v / STEP_MM - 0.5).ceil() as i32
}

/// The stretches of an area in the rows of points: row and columns.
fn stretches(area: &[Contour]) -> Vec<(i32, Range<i32>)> {
    let mut crossings: Vec<(i32, f64)> = Vec::new();
    for (a, b) in area.iter().flat_map(Contour::edges) {
        for row in first_from(a.y.min(b.y))..first_from(a.y.max(b.y)) {
            let share = ((f64::from(row) + 0.5) * STEP_MM - a.y) / (b.y - a.y);
            crossings.push((row, a.x + (b.x - a.x) * share));
        }
    }
    crossings.stable_sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let stretch = |pair: &[(i32, f64)]| (pair[0].0, first_from(pair[0].1)..first_from(pair[1].1));
    crossings.chunks_exact(2).map(stretch).filter(|(_, columns)| !columns.is_empty()).collect()
}

impl Raster {
    /// The points of `places`, which do not overlap.
    pub(super) fn new(places: &[Contour]) -> Raster {
        let all = stretches(places);
        let [low, high] =
            [0, all.len().saturating_sub(1)].map(|i| all.get(i).map_or(0, |s| s.0.div_euclid(SIDE)));
        let left = all.iter().map(|s| s.1.start).min().unwrap_or(0).div_euclid(SIDE);
        let right = all.iter().map(|s| s.1.end).max().unwrap_or(0).div_euclid(SIDE);
        let columns = right - left + 1;
        let tiles = vec![NONE; (columns * (high - low + 1)) as usize];
        let mut raster = Raster { low: [left, low], columns, tiles, marks: Vec::new() };
        for (row, columns) in all {
            columns.for_each(|column| raster.add(column, row));
        }
        raster
    }

    fn tile(&self, column: i32, row: i32) -> usize {
        let [x, y] = [column.div_euclid(SIDE) - self.low[0], row.div_euclid(SIDE) - self.low[1]];
        (y * self.columns + x) as usize
    }

    fn add(&mut self, column: i32, row: i32) {
        let tile = self.tile(column, row);
        if self.tiles[tile] == NONE {
            self.tiles[tile] = (self.marks.len() as i32 / (SIDE * SIDE)) as u32;
            self.marks.resize(self.marks.len() + (SIDE * SIDE) as usize, NO_POINT);
        }
        let start = self.tiles[tile] as usize * (SIDE * SIDE) as usize;
        self.marks[start + (row.rem_euclid(SIDE) * SIDE + column.rem_euclid(SIDE)) as usize] = 0;
    }

    /// Visits the points of these columns and rows in kept tiles: column, row and mark.
    fn each_kept(&mut self, columns: Range<i32>, rows: Range<i32>, mut visit: impl FnMut(i32, i32, &mut u8)) {
        let count = self.tiles.len() as i32 / self.columns;
        let within = |r: &Range<i32>, low: i32, count: i32| {
            (r.start.div_euclid(SIDE)).max(low)..((r.end - 1).div_euclid(SIDE) + 1).min(low + count)
        };
        for y in within(&rows, self.low[1], count) {
            for x in within(&columns, self.low[0], self.columns) {
                let tile = self.tiles[((y - self.low[1]) * self.columns + x - self.low[0]) as usize];
                if tile == NONE {
                    continue;
                }
                let start = tile as usize * (SIDE * SIDE) as usize;
                for row in rows.start.max(y * SIDE)..rows.end.min((y + 1) * SIDE) {
                    for column in columns.start.max(x * SIDE)..columns.end.min((x + 1) * SIDE) {
                        let place = (row - y * SIDE) * SIDE + column - x * SIDE;
                        visit(column, row, &mut self.marks[start + place as usize]);
                    }
                }
            }
        }
    }

    /// Notes what a bead covers. Returns how many points were open.
    pub(super) fn cover(&mut self, path: &Path) -> i32 {
        self.count_edges(path, true)
    }

    /// Takes back what [`Raster::cover`] noted. Returns how many points are open now.
    pub(super) fn uncover(&mut self, path: &Path) -> i32 {
        self.count_edges(path, false)
    }

    /// Adds the edges of a bead to the marks of the points below, or takes them off. Returns how many points
    /// are open without them.
    fn count_edges(&mut self, path: &Path, adds: bool) -> i32 {
        let mut open = 0;
        for ends in path.edges() {
            let [(a, from), (b, to)] = [ends.0, ends.1].map(|i| (path.points[i], path.width.at(i) / 2.0));
            let (low, high) = (a.min(b) - from.max(to), a.max(b) + from.max(to));
            let [columns, rows] =
                [low.x..high.x, low.y..high.y].map(|r| first_from(r.start)..first_from(r.end));
            self.each_kept(columns, rows, |column, row, mark| {
                let p = point(column, row);
                let foot = closest_on_segment(p, a, b);
                let share = a.distance(foot) / a.distance(b).max(f64::MIN_POSITIVE);
                if *mark != NO_POINT && foot.distance(p) <= from + (to - from) * share {
                    let without = if adds { *mark } else { mark.saturating_sub(1) };
                    open += i32::from(without == 0);
                    *mark = if adds { (without + 1).min(NO_POINT - 1) } else { without };
                }
            });
        }
        open
    }

    /// Rows and columns of the points that no bead covers, in order.
    fn open(&self) -> Vec<(i32, i32)> {
        let mut points: Vec<(i32, i32)> = Vec::new();
        for (tile, &number) in self.tiles.iter().enumerate().filter(|(_, number)| **number != NONE) {
            let start = number as usize * (SIDE * SIDE) as usize;
            let (y, x) = (tile as i32 / self.columns + self.low[1], tile as i32 % self.columns + self.low[0]);
            let marks = self.marks[start..start + (SIDE * SIDE) as usize].iter().zip(0..);
            let open = marks.filter(|(mark, _)| **mark == 0);
            points.extend(open.map(|(_, place)| (y * SIDE + place / SIDE, x * SIDE + place % SIDE)));
        }
        points.stable_sort_by(Ord::cmp);
        points
    }

    /// Open points that lie together, spot by spot, the spots in the order of their lowest points.
    pub(super) fn spots(&self) -> Vec<Vec<DVec2>> {
        let points = self.open();
        let mut sets = Sets::new(points.len());
        for (i, &(row, column)) in points.iter().enumerate() {
            for beside in [(row, column + 1), (row + 1, column)] {
                if let Ok(other) = points.binary_search(&beside) {
                    sets.join(i, other);
                }
            }
        }
        let mut spots: Vec<Vec<DVec2>> = vec![Vec::new(); points.len()];
        for (i, &(row, column)) in points.iter().enumerate() {
            spots[sets.root(i)].push(point(column, row));
        }
        spots.retain(|spot| spot.len() >= FEWEST);
        spots
    }
}

fn point(column: i32, row: i32) -> DVec2 {
    (dvec2(f64::from(column), f64::from(row)) + 0.5) * STEP_MM
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::stars::hollow_star;
    use crate::region::{Role, Width};
    use proptest::prelude::*;

    fn beads() -> impl Strategy<Value = Vec<Path>> {
        let point = (0.0..10.0, 0.0..10.0, 0.2..0.8_f64);
        let path = (prop::collection::vec(point, 2..6), any::<bool>()).prop_map(|(points, closed)| {
            let widths = points.iter().map(|p| p.2).collect();
            let points = points.iter().map(|p| dvec2(p.0, p.1)).collect();
            Path { closed, width: Width::Varying(widths), ..Path::open(Role::OuterWall, points, 0.0) }
        });
        prop::collection::vec(path, 0..5)
    }

    fn is_under(path: &Path, p: DVec2) -> bool {
        path.edges().any(|(i, next)| {
            let (a, b) = (path.points[i], path.points[next]);
            let foot = closest_on_segment(p, a, b);
            let share = a.distance(foot) / a.distance(b).max(f64::MIN_POSITIVE);
            let width = path.width.at(i) + (path.width.at(next) - path.width.at(i)) * share;
            foot.distance(p) <= width / 2.0
        })
    }

    proptest! {
        /// The twin asks every point of the area's box whether it is inside and under no bead.
        #[test]
        fn open_points_are_those_inside_under_no_bead(area in hollow_star(), beads in beads()) {
            let mut raster = Raster::new(area.contours());
            let all: usize = raster.open().len();
            let covered: i32 = beads.iter().map(|path| raster.cover(path)).sum();
            let mut expected = Vec::new();
            for (row, column) in (-30..160).flat_map(|row| (-30..160).map(move |column| (row, column))) {
                let p = point(column, row);
                if area.contains(p) && !beads.iter().any(|path| is_under(path, p)) {
                    expected.push((row, column));
                }
            }
            prop_assert_eq!(&raster.open(), &expected);
            prop_assert_eq!(all, expected.len() + covered as usize);
            let largest = raster.spots().iter().map(Vec::len).max().unwrap_or(0);
            prop_assert!(largest <= expected.len());
            let uncovered: i32 = beads.iter().map(|path| raster.uncover(path)).sum();
            prop_assert_eq!((uncovered, raster.open().len()), (covered, all));
        }
    }
}
