//! Lines cut to what may be printed on: the bed, or an area.

use super::{AdhesionWarning, Foundation, WarningCode};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, Join, PolygonSet, by_x_then_y};
use crate::region::{Path, Width};
use crate::sort::StableSort;

/// A line, closed or open; a closed one does not repeat its first point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) points: Vec<DVec2>,
    pub(super) closed: bool,
}

impl Line {
    /// A closed line.
    pub(super) fn ring(points: Vec<DVec2>) -> Line {
        Line { points, closed: true }
    }
}

/// The pieces of a line inside the box; the line itself, unchanged, when all of it is.
pub(super) fn to_box(line: Line, bounds: Bounds) -> Vec<Line> {
    if Bounds::of_points(&line.points).is_some_and(|b| bounds.contains(b)) {
        return vec![line];
    }
    let mut points = line.points;
    if line.closed {
        points.extend(points.first().copied());
    }
    let mut pieces: Vec<Vec<DVec2>> = Vec::new();
    for pair in points.windows(2) {
        let Some((a, b)) = segment_in_box(pair[0], pair[1], bounds) else { continue };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&a) => piece.push(b),
            _ => pieces.push(vec![a, b]),
        }
    }
    joined(pieces, line.closed)
}

/// The pieces of a line inside the area, sorted by their first points. The line itself, unchanged,
/// when nothing is cut off.
pub(super) fn to_area(line: Line, area: &PolygonSet) -> Vec<Line> {
    let mut points = line.points.clone();
    if line.closed {
        points.extend(points.first().copied());
    }
    let mut pieces = area.clip_lines(std::slice::from_ref(&points));
    let kept: f64 = pieces.iter().map(|p| length(p)).sum();
    // Points come back rounded to the grid, by up to half a step at each end of an edge.
    if kept > length(&points) - GRID_SLACK_MM * points.len() as f64 {
        return vec![line];
    }
    pieces.stable_sort_by(|p, q| by_x_then_y(p[0], q[0]));
    joined(pieces, line.closed)
}

/// Cuts off what beads would reach into `closed`, a part of the bed's box.
pub(super) fn keep_off(closed: &PolygonSet, bed: Bounds, foundation: &mut Foundation) {
    if closed.is_empty() {
        return;
    }
    let mut open = OpenBed { closed, bed, by_width: Vec::new(), cut_at: None };
    let raft = foundation.raft.iter_mut().map(|layer| &mut layer.paths);
    for paths in foundation.layers.iter_mut().chain(raft) {
        *paths = std::mem::take(paths).into_iter().flat_map(|path| open.cut(path)).collect();
    }
    let is_told = foundation.warnings.iter().any(|it| it.code == WarningCode::AdhesionOffBed);
    if let Some(at) = open.cut_at.filter(|_| !is_told) {
        let message = "printer.forbidden, printer.bed_shape: what holds the part is cut off there".to_owned();
        foundation.warnings.push(AdhesionWarning::new(WarningCode::AdhesionOffBed, message, Some(at)));
    }
}

/// Where beads may run.
struct OpenBed<'a> {
    closed: &'a PolygonSet,
    bed: Bounds,
    /// Where the lines of beads so wide may run.
    by_width: Vec<(f64, PolygonSet)>,
    /// A point that was cut off.
    cut_at: Option<DVec2>,
}

impl OpenBed<'_> {
    fn cut(&mut self, path: Path) -> Vec<Path> {
        let width = match &path.width {
            Width::Uniform(width) => *width,
            Width::Varying(widths) => widths.iter().copied().fold(0.0, f64::max),
        };
        let line = Line { points: path.points.clone(), closed: path.closed };
        let pieces = to_area(line.clone(), self.area(width));
        if pieces.as_slice() == std::slice::from_ref(&line) {
            return vec![path];
        }
        let beside = path.points.iter().copied().find(|&p| !self.area(width).contains(p));
        self.cut_at = self.cut_at.or(beside);
        // Crumbs hold nothing.
        let pieces = pieces.into_iter().filter(|piece| length(&piece.points) > width);
        let bead = |piece: Line| Path { closed: piece.closed, ..Path::open(path.role, piece.points, width) };
        pieces.map(bead).collect()
    }

    fn area(&mut self, width: f64) -> &PolygonSet {
        let known = self.by_width.iter().position(|(w, _)| *w == width);
        let at = known.unwrap_or_else(|| {
            let bed = PolygonSet::rectangle(self.bed.min, self.bed.max);
            let open = bed.difference(&self.closed.offset(width / 2.0, Join::WALL));
            self.by_width.push((width, open));
            self.by_width.len() - 1
        });
        &self.by_width[at].1
    }
}

fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// A length that rounding to the grid may add or take at one point, mm.
const GRID_SLACK_MM: f64 = 2e-4;

/// Open lines from pieces of a line; of a loop, pieces that end in the same point become one.
fn joined(mut pieces: Vec<Vec<DVec2>>, closed: bool) -> Vec<Line> {
    while let Some((i, j)) = meeting(&pieces).filter(|_| closed) {
        let (mut first, mut second) = (pieces[i].clone(), pieces.remove(j));
        if first.first() == second.last() {
            // The two sides of the loop's start: this order keeps their direction.
            std::mem::swap(&mut first, &mut second);
        } else if first.first() == second.first() {
            first.reverse();
        } else if first.last() == second.last() {
            second.reverse();
        }
        first.extend(second.into_iter().skip(1));
        pieces[i] = first;
    }
    pieces.into_iter().map(|points| Line { points, closed: false }).collect()
}

/// Two pieces with a common end, the smaller index first.
fn meeting(pieces: &[Vec<DVec2>]) -> Option<(usize, usize)> {
    let ends = |i: usize| [pieces[i].first(), pieces[i].last()];
    let meet = |i: usize, j: usize| ends(i).iter().any(|end| ends(j).contains(end));
    (0..pieces.len()).find_map(|i| (i + 1..pieces.len()).find(|&j| meet(i, j)).map(|j| (i, j)))
}

/// The part of a segment inside the box (Liang and Barsky 1984).
fn segment_in_box(a: DVec2, b: DVec2, bounds: Bounds) -> Option<(DVec2, DVec2)> {
    let step = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (start, delta) = (a[axis], step[axis]);
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        if delta == 0.0 {
            if start < low || start > high {
                return None;
            }
            continue;
        }
        let (p, q) = ((low - start) / delta, (high - start) / delta);
        (from, to) = (from.max(p.min(q)), to.min(p.max(q)));
    }
    // Ends that are not cut keep their exact coordinates, so that pieces join up.
    let at = |share: f64| match share {
        0.0 => a,
        1.0 => b,
        _ => (a + step * share).clamp(bounds.min, bounds.max),
    };
    (from < to).then(|| (at(from), at(to)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        vec![dvec2(low, low), dvec2(high, low), dvec2(high, high), dvec2(low, high)]
    }

    #[test]
    fn a_loop_over_the_edge_becomes_one_open_line() {
        let bed = Bounds { min: dvec2(-1.0, -1.0), max: dvec2(7.0, 20.0) };
        let pieces = to_box(Line::ring(square(0.0, 10.0)), bed);
        let expected = [dvec2(7.0, 10.0), dvec2(0.0, 10.0), dvec2(0.0, 0.0), dvec2(7.0, 0.0)];
        assert_eq!(pieces, [Line { points: expected.to_vec(), closed: false }]);
    }

    #[test]
    fn what_lies_inside_stays_as_it_is() {
        let ring = Line::ring(square(0.0, 10.0));
        let bed = Bounds { min: dvec2(0.0, 0.0), max: dvec2(10.0, 10.0) };
        assert_eq!(to_box(ring.clone(), bed), std::slice::from_ref(&ring));
        let area = PolygonSet::rectangle(dvec2(-1.0, -1.0), dvec2(11.0, 11.0));
        assert_eq!(to_area(ring.clone(), &area), [ring]);
    }

    #[test]
    fn a_loop_beside_the_bed_is_gone() {
        let bed = Bounds { min: dvec2(11.0, 0.0), max: dvec2(20.0, 10.0) };
        assert!(to_box(Line::ring(square(0.0, 10.0)), bed).is_empty());
        let area = PolygonSet::rectangle(bed.min, bed.max);
        assert!(to_area(Line::ring(square(0.0, 10.0)), &area).is_empty());
    }

    #[test]
    fn an_area_cuts_like_a_box() {
        let bed = Bounds { min: dvec2(3.0, -1.0), max: dvec2(7.0, 20.0) };
        let area = PolygonSet::rectangle(bed.min, bed.max);
        let ring = Line::ring(square(0.0, 10.0));
        let lengths =
            |pieces: Vec<Line>| pieces.iter().map(|p| p.points[0].distance(p.points[1])).sum::<f64>();
        assert_eq!(lengths(to_box(ring.clone(), bed)), 8.0);
        assert_eq!(lengths(to_area(ring, &area)), 8.0);
    }
}
