//! The plane in square tiles, and areas cut along their borders: what changes in one place need not be
//! computed anew everywhere.

use super::boolean::NOTHING_MM2;
use super::island::Island;
use super::measure::Bounds;
use super::{Contour, DVec2, GRID_PER_MM, Polygon, PolygonSet, dvec2, grid_steps, snap};
use crate::sets::Sets;

/// Pieces of neighbouring tiles that touch along less than this, mm, do so by rounding: three grid steps.
const TOUCH_MM: f64 = 3e-4;

/// Rows and columns of tiles; those at the edge of the grid reach beyond it without end.
#[derive(Debug, Clone)]
pub struct Tiles {
    /// Where columns and rows begin, and the last ones end, mm, on the polygon grid.
    lines: [Vec<f64>; 2],
}

impl PolygonSet {
    /// What lies within the box.
    pub fn within(&self, bounds: Bounds) -> PolygonSet {
        let joined = Tiles::around(bounds).cut(self).swap_remove(4);
        PolygonSet::from_contours(joined.into_contours())
    }
}

impl Tiles {
    /// A single tile that holds everything.
    pub fn whole() -> Tiles {
        Tiles { lines: [0, 1].map(|_| vec![f64::NEG_INFINITY, f64::INFINITY]) }
    }

    /// Square tiles over the box, `count` along its longer side.
    pub fn over(bounds: Bounds, count: usize) -> Tiles {
        let origin = grid_steps(bounds.min);
        let size = (bounds.size() * GRID_PER_MM).ceil();
        let side = (size.max_element() / count as f64).ceil().max(1.0);
        if count < 2 {
            return Tiles::whole();
        }
        Tiles { lines: [0, 1].map(|axis| lines(origin[axis], size[axis], side)) }
    }

    /// Nine tiles, of which the fifth has these bounds, on the polygon grid.
    fn around(bounds: Bounds) -> Tiles {
        let (min, max) = (snap(bounds.min), snap(bounds.max));
        Tiles { lines: [0, 1].map(|axis| vec![f64::NEG_INFINITY, min[axis], max[axis], f64::INFINITY]) }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.columns() * self.rows()
    }

    fn columns(&self) -> usize {
        self.lines[0].len() - 1
    }

    fn rows(&self) -> usize {
        self.lines[1].len() - 1
    }

    /// The box of a tile. Tiles are numbered column by column.
    pub fn bounds(&self, tile: usize) -> Bounds {
        let (column, row) = (tile / self.rows(), tile % self.rows());
        let corner = |by: usize| dvec2(self.lines[0][column + by], self.lines[1][row + by]);
        Bounds { min: corner(0), max: corner(1) }
    }

    /// The tile that holds `p`.
    pub fn of(&self, p: DVec2) -> usize {
        let [column, row] = [0, 1].map(|axis| strip_of(&self.lines[axis], p[axis]));
        column * self.rows() + row
    }

    /// Pairs of tiles that lie side by side along x (axis 0) or y (axis 1), in ascending order.
    pub fn neighbours(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        let rows = self.rows();
        (0..self.count()).flat_map(move |tile| {
            let beside = (tile + rows < self.count()).then_some((tile, tile + rows, 0));
            let above = (tile % rows + 1 < rows).then_some((tile, tile + 1, 1));
            beside.into_iter().chain(above)
        })
    }

    /// Pieces that go on across the borders of tiles are one component. `pieces` are those of each tile; for each
    /// of all, tile by tile, the result has the number of its component's first.
    pub fn components(&self, pieces: &[Vec<&Piece>]) -> Vec<usize> {
        let starts: Vec<usize> = std::iter::once(0)
            .chain(pieces.iter().scan(0, |end, of_tile| {
                *end += of_tile.len();
                Some(*end)
            }))
            .collect();
        let mut sets = Sets::new(starts[pieces.len()]);
        for (tile, next, axis) in self.neighbours() {
            for (i, piece) in pieces[tile].iter().enumerate() {
                for (j, other) in pieces[next].iter().enumerate() {
                    if piece.is_continued_by(other, axis) {
                        sets.join(starts[tile] + i, starts[next] + j);
                    }
                }
            }
        }
        sets.roots()
    }

    /// What of `area` lies in each tile, edges cut at the grid point nearest to the crossing.
    ///
    /// Pieces that are apart in a tile may stay joined by a double edge along its border, as one contour;
    /// booleans take that away.
    pub fn cut(&self, area: &PolygonSet) -> Vec<PolygonSet> {
        if self.count() == 1 {
            return vec![area.clone()];
        }
        let columns = cut_across(area.contours().to_vec(), 0, &self.lines[0]);
        let tiles = columns.into_iter().flat_map(|column| cut_across(column, 1, &self.lines[1]));
        tiles.map(within_tile).collect()
    }
}

/// A connected piece of an area within a tile.
#[derive(Debug)]
pub struct Piece {
    /// What they wind around is the piece.
    pub contours: Vec<Contour>,
    /// The box around it.
    pub bounds: Bounds,
    /// Where it meets the tile's borders: at the lower and upper end along x, then along y.
    meets: [[Vec<(f64, f64)>; 2]; 2],
}

/// The connected pieces of an area that lies within the tile of these bounds and has no double edges.
pub fn pieces_of(area: &PolygonSet, bounds: Bounds) -> Vec<Piece> {
    Island::all_of(area).into_iter().map(|island| Piece::new(island, bounds)).collect()
}

impl Piece {
    fn new(island: Island, bounds: Bounds) -> Piece {
        let meets = [0, 1].map(|axis| [bounds.min, bounds.max].map(|end| edges_on(&island, axis, end[axis])));
        let Polygon { outer, holes } = island.polygon;
        Piece { contours: std::iter::once(outer).chain(holes).collect(), bounds: island.bounds, meets }
    }

    /// Takes in another piece of the tile that touches this one.
    pub fn absorb(&mut self, other: Piece) {
        self.contours.extend(other.contours);
        self.bounds = self.bounds.union(other.bounds);
        let stretches = self.meets.iter_mut().flatten().zip(other.meets.into_iter().flatten());
        stretches.for_each(|(own, further)| own.extend(further));
    }

    /// Whether this piece and one of the next tile along `axis` are one component, cut by the border.
    fn is_continued_by(&self, next: &Piece, axis: usize) -> bool {
        let shared = |a: (f64, f64), b: (f64, f64)| a.1.min(b.1) - a.0.max(b.0);
        let ends = &next.meets[axis][0];
        self.meets[axis][1].iter().any(|&a| ends.iter().any(|&b| shared(a, b) > TOUCH_MM))
    }
}

/// The stretches of the island's outline where the coordinate `axis` is `end`.
fn edges_on(island: &Island, axis: usize, end: f64) -> Vec<(f64, f64)> {
    if island.bounds.min[axis] != end && island.bounds.max[axis] != end {
        return Vec::new();
    }
    let on_end =
        island.polygon.contours().flat_map(Contour::edges).filter(|(a, b)| a[axis] == end && b[axis] == end);
    on_end.map(|(a, b)| (a[1 - axis].min(b[1 - axis]), a[1 - axis].max(b[1 - axis]))).collect()
}

/// Lines from `origin` on, `side` apart, past `size`; all in grid steps, the result in mm.
fn lines(origin: f64, size: f64, side: f64) -> Vec<f64> {
    let strips = (size / side).ceil().max(1.0) as usize;
    (0..=strips).map(|k| (origin + k as f64 * side) / GRID_PER_MM).collect()
}

/// The contours of a tile as an area: a hole around the whole tile leaves nothing.
fn within_tile(contours: Vec<Contour>) -> PolygonSet {
    let area: f64 = contours.iter().map(Contour::signed_area).sum();
    if area < NOTHING_MM2 { PolygonSet::EMPTY } else { PolygonSet::canonical(contours) }
}

/// The strip between two of the lines that holds the coordinate; beyond the lines the nearest.
fn strip_of(lines: &[f64], at: f64) -> usize {
    let inner = &lines[1..lines.len() - 1];
    inner.partition_point(|&line| line <= at)
}

/// Cuts contours into the strips between the lines where coordinate `axis` has one of the given values
/// (Sutherland and Hodgman 1974, all lines in one pass).
fn cut_across(contours: Vec<Contour>, axis: usize, lines: &[f64]) -> Vec<Vec<Contour>> {
    let mut strips = vec![Vec::new(); lines.len() - 1];
    for contour in contours {
        let places: Vec<usize> = contour.points.iter().map(|p| strip_of(lines, p[axis])).collect();
        let (Some(&low), Some(&high)) = (places.iter().min(), places.iter().max()) else { continue };
        if low == high {
            strips[low].push(contour);
            continue;
        }
        let mut pieces = vec![Vec::new(); high - low + 1];
        for (i, (a, b)) in contour.edges().enumerate() {
            let (from, to) = (places[i], places[if i + 1 == places.len() { 0 } else { i + 1 }]);
            push_new(&mut pieces[from - low], a);
            let mut cross = |line: usize, left: usize, entered: usize| {
                let p = crossing(a, b, axis, lines[line]);
                push_new(&mut pieces[left - low], p);
                push_new(&mut pieces[entered - low], p);
            };
            (from..to).for_each(|strip| cross(strip + 1, strip, strip + 1));
            (to..from).rev().for_each(|strip| cross(strip + 1, strip + 1, strip));
        }
        let closed = pieces.into_iter().map(|points| Contour::new(without_closing_double(points)));
        for (strip, piece) in strips[low..=high].iter_mut().zip(closed) {
            if piece.signed_area().abs() >= NOTHING_MM2 {
                strip.push(piece);
            }
        }
    }
    strips
}

fn push_new(points: &mut Vec<DVec2>, p: DVec2) {
    if points.last() != Some(&p) {
        points.push(p);
    }
}

fn without_closing_double(mut points: Vec<DVec2>) -> Vec<DVec2> {
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Where the edge meets the line, the same whichever way it is walked.
fn crossing(a: DVec2, b: DVec2, axis: usize, line: f64) -> DVec2 {
    let (from, to) = if a[axis] < b[axis] { (a, b) } else { (b, a) };
    let share = ((line - from[axis]) / (to[axis] - from[axis])).clamp(0.0, 1.0);
    let mut p = snap(from.lerp(to, share));
    p[axis] = line;
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::stars::hollow_star;
    use proptest::prelude::*;

    fn square(low: f64, high: f64) -> PolygonSet {
        PolygonSet::rectangle(DVec2::splat(low), DVec2::splat(high))
    }

    #[test]
    fn a_ring_in_nine_tiles_leaves_the_middle_one_empty() {
        let ring = square(0.0, 9.0).difference(&square(2.0, 7.0));
        let tiles = Tiles::over(ring.bounds().unwrap(), 3);
        let areas: Vec<f64> = tiles.cut(&ring).iter().map(PolygonSet::area).collect();
        assert_eq!(areas, [8.0, 6.0, 8.0, 6.0, 0.0, 6.0, 8.0, 6.0, 8.0]);
        assert!(tiles.cut(&ring)[4].is_empty());
        assert_eq!(tiles.cut(&square(0.0, 9.0))[4], square(3.0, 6.0));
        assert_eq!(tiles.bounds(5).min, dvec2(3.0, 6.0));
        assert_eq!(tiles.of(dvec2(3.5, 8.5)), 5);
    }

    #[test]
    fn neighbours_share_a_border() {
        let tiles = Tiles::over(Bounds { min: DVec2::ZERO, max: dvec2(2.0, 3.0) }, 3);
        let pairs: Vec<(usize, usize, usize)> = tiles.neighbours().collect();
        assert_eq!(pairs, [(0, 3, 0), (0, 1, 1), (1, 4, 0), (1, 2, 1), (2, 5, 0), (3, 4, 1), (4, 5, 1)]);
    }

    proptest! {
        #[test]
        fn pieces_are_the_area_within_each_tile(area in hollow_star(), count in 2usize..9) {
            let tiles = Tiles::over(Bounds { min: DVec2::ZERO, max: dvec2(10.0, 8.0) }, count);
            let pieces = tiles.cut(&area);
            prop_assert_eq!(pieces.len(), tiles.count());
            for (i, piece) in pieces.iter().enumerate() {
                let b = tiles.bounds(i);
                // Tiles at the edge reach beyond the grid.
                let wide = |low: f64, high: f64| (if low == 0.0 { -20.0 } else { low }, high);
                let ((x0, x1), (y0, mut y1)) = (wide(b.min.x, b.max.x), wide(b.min.y, b.max.y));
                if i % tiles.rows() + 1 == tiles.rows() { y1 = 20.0; }
                let expected = area.intersection(&PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1)));
                let wrong = piece.symmetric_difference(&expected).area();
                prop_assert!(wrong < 1e-3, "{i}: {wrong}");
            }
        }

        #[test]
        fn what_lies_within_a_box_is_the_area_there(area in hollow_star(), low in 0.0..5.0f64, size in 0.5..5.0f64) {
            let corners = [dvec2(low, low + 1.0), dvec2(low + size, low + 1.0 + size)].map(snap);
            let expected = area.intersection(&PolygonSet::rectangle(corners[0], corners[1]));
            let found = area.within(Bounds { min: corners[0], max: corners[1] });
            let wrong = found.symmetric_difference(&expected).area();
            prop_assert!(wrong < 1e-3, "{wrong}");
        }
    }
}
