//! The border of an area to fill: where lines cross it, how they are cut by it, and how their pieces
//! are joined along it.

use crate::polygon::grid::EdgeGrid;
use crate::polygon::{DVec2, PolygonSet};
use crate::sets::Sets;
use crate::sort::StableSort;

/// A place on the border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BorderPlace {
    /// Which contour.
    contour: usize,
    /// Way along the contour from its first point, mm.
    at: f64,
}

/// What of a line lies inside: it begins and ends on the border.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    pub(super) points: Vec<DVec2>,
    pub(super) ends: [BorderPlace; 2],
}

/// The border of an area, measured along its contours.
pub(super) struct Border<'a> {
    area: &'a PolygonSet,
    /// For each contour the way from its first point to each of its points, and its whole length.
    along: Vec<Vec<f64>>,
}

impl<'a> Border<'a> {
    pub(super) fn of(area: &'a PolygonSet) -> Border<'a> {
        let along = area.contours().iter().map(|contour| {
            let mut way = vec![0.0];
            way.extend(contour.edges().scan(0.0, |sum, (a, b)| {
                *sum += a.distance(b);
                Some(*sum)
            }));
            way
        });
        Border { area, along: along.collect() }
    }

    /// The place of a point on this edge.
    pub(super) fn place(&self, contour: usize, edge: usize, p: DVec2) -> BorderPlace {
        let start = self.area.contours()[contour].points[edge];
        BorderPlace { contour, at: self.along[contour][edge] + start.distance(p) }
    }

    /// Cuts lines, which begin and end outside the area, into the pieces inside.
    pub(super) fn cut(&self, lines: &[Vec<DVec2>]) -> Vec<Piece> {
        let owners = self.area.contours().iter().enumerate();
        let owners: Vec<(usize, usize)> =
            owners.flat_map(|(c, contour)| (0..contour.points.len()).map(move |e| (c, e))).collect();
        let edges: Vec<(DVec2, DVec2)> = self.area.contours().iter().flat_map(|c| c.edges()).collect();
        let grid = EdgeGrid::new(&edges);
        let mut pieces = Vec::new();
        for line in lines {
            // What is inside so far, while the line is.
            let mut open: Option<(BorderPlace, Vec<DVec2>)> = None;
            for ends in line.windows(2) {
                let (a, b) = (ends[0], ends[1]);
                for (t, edge) in grid.crossings(a, b) {
                    let p = a.lerp(b, t);
                    let (contour, edge) = owners[edge];
                    let place = self.place(contour, edge, p);
                    open = match open.take() {
                        None => Some((place, vec![p])),
                        Some((start, mut points)) => {
                            points.push(p);
                            pieces.push(Piece { points, ends: [start, place] });
                            None
                        }
                    };
                }
                if let Some((_, points)) = &mut open {
                    points.push(b);
                }
            }
        }
        pieces
    }

    /// Way along the contour in its direction, mm.
    fn way(&self, from: BorderPlace, to: BorderPlace) -> f64 {
        let ahead = to.at - from.at;
        if ahead < 0.0 { ahead + self.length(from.contour) } else { ahead }
    }

    fn length(&self, contour: usize) -> f64 {
        self.along[contour].last().copied().unwrap_or(0.0)
    }

    /// The contour's points between two places of it, in its direction.
    fn points_between(&self, from: BorderPlace, to: BorderPlace) -> Vec<DVec2> {
        let points = &self.area.contours()[from.contour].points;
        let ways = &self.along[from.contour][..points.len()];
        let after = |at: f64| ways.partition_point(|&w| w <= at);
        let (first, last) = (after(from.at), ways.partition_point(|&w| w < to.at));
        if to.at >= from.at {
            return points.get(first..last).unwrap_or_default().to_vec();
        }
        [&points[first..], &points[..last]].concat()
    }

    /// The point at a place.
    fn point(&self, place: BorderPlace) -> DVec2 {
        let ways = &self.along[place.contour];
        let edge = ways.partition_point(|&w| w <= place.at).clamp(1, ways.len() - 1) - 1;
        let points = &self.area.contours()[place.contour].points;
        let share = (place.at - ways[edge]) / (ways[edge + 1] - ways[edge]).max(f64::MIN_POSITIVE);
        points[edge].lerp(points[(edge + 1) % points.len()], share)
    }

    /// Joins pieces whose ends are neighbours along the border and no farther apart than `longest`
    /// mm to lines that follow the border between them. Ends that stay free follow the border for up to
    /// `anchor` mm to the emptier side: where a line only touches a wall it comes off.
    ///
    /// Round each contour an end is joined with the next one whenever both are free and belong to
    /// different lines. Where parallel lines end this gives the familiar zigzag: ends are joined two
    /// by two, on the other side one farther, because there the first pair is one line already.
    pub(super) fn join(&self, pieces: Vec<Piece>, longest: f64, anchor: f64) -> Vec<Vec<DVec2>> {
        let mut joints = vec![None; 2 * pieces.len()];
        let mut lines = Sets::new(pieces.len());
        let rings = self.ends_by_contour(&pieces);
        for ring in &rings {
            let count = ring.len();
            for i in 0..count {
                let (from, to) = (ring[i], ring[(i + 1) % count]);
                let free = |end: usize| joints[end].is_none();
                let places = [from, to].map(|end: usize| pieces[end / 2].ends[end % 2]);
                let near = from != to && self.way(places[0], places[1]) <= longest;
                if near && free(from) && free(to) && lines.join(from / 2, to / 2) {
                    joints[from] = Some(Joint { to, forward: true });
                    joints[to] = Some(Joint { to: from, forward: false });
                }
            }
        }
        let mut anchors = vec![Vec::new(); 2 * pieces.len()];
        for ring in &rings {
            for (i, &end) in ring.iter().enumerate().filter(|(_, end)| joints[**end].is_none()) {
                let beside = [ring[(i + ring.len() - 1) % ring.len()], ring[(i + 1) % ring.len()]];
                let [before, here, after] = [beside[0], end, beside[1]].map(|e| pieces[e / 2].ends[e % 2]);
                anchors[end] = self.anchor(before, here, after, anchor);
            }
        }
        self.follow(&pieces, &joints, &anchors)
    }

    /// The way of a free end along the border, up to `longest` mm and between the ends before and after.
    fn anchor(&self, before: BorderPlace, here: BorderPlace, after: BorderPlace, longest: f64) -> Vec<DVec2> {
        let around = self.length(here.contour);
        let free = |way: f64| if way == 0.0 { around } else { way } / 2.0;
        let (back, on) = (free(self.way(before, here)), free(self.way(here, after)));
        // The other side's may have an anchor, too; a gap stays between them.
        let length = longest.min(back.max(on) - longest / 2.0);
        if length <= longest / 2.0 {
            return Vec::new();
        }
        let at = |by: f64| BorderPlace { at: (here.at + by).rem_euclid(around), ..here };
        if on >= back {
            let end = at(length);
            return [self.points_between(here, end), vec![self.point(end)]].concat();
        }
        let end = at(-length);
        let mut points = [vec![self.point(end)], self.points_between(end, here)].concat();
        points.reverse();
        points
    }

    /// For each contour the ends on it in its direction; end 2 i + k is end k of piece i.
    fn ends_by_contour(&self, pieces: &[Piece]) -> Vec<Vec<usize>> {
        let mut rings = vec![Vec::new(); self.along.len()];
        for (i, piece) in pieces.iter().enumerate() {
            for (k, place) in piece.ends.iter().enumerate() {
                rings[place.contour].push((place.at, 2 * i + k));
            }
        }
        let in_order = |mut ring: Vec<(f64, usize)>| {
            ring.stable_sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            ring.into_iter().map(|(_, end)| end).collect()
        };
        rings.into_iter().map(in_order).collect()
    }

    /// The points of each joined line, from a free end's anchor to the other's.
    fn follow(&self, pieces: &[Piece], joints: &[Option<Joint>], anchors: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
        let mut done = vec![false; pieces.len()];
        let mut lines = Vec::new();
        // Joined lines are never closed, so that each has a free end.
        for start in (0..joints.len()).filter(|&end| joints[end].is_none()) {
            if done[start / 2] {
                continue;
            }
            let mut points: Vec<DVec2> = anchors[start].iter().rev().copied().collect();
            let mut end = start;
            loop {
                let piece = &pieces[end / 2];
                done[end / 2] = true;
                if end.is_multiple_of(2) {
                    points.extend(&piece.points);
                } else {
                    points.extend(piece.points.iter().rev());
                }
                let out = end ^ 1;
                let Some(joint) = joints[out] else {
                    points.extend(&anchors[out]);
                    break;
                };
                points.extend(self.joint_points(pieces, out, joint));
                end = joint.to;
            }
            lines.push(points);
        }
        lines
    }

    fn joint_points(&self, pieces: &[Piece], from: usize, joint: Joint) -> Vec<DVec2> {
        let place = |end: usize| pieces[end / 2].ends[end % 2];
        if joint.forward {
            return self.points_between(place(from), place(joint.to));
        }
        let mut points = self.points_between(place(joint.to), place(from));
        points.reverse();
        points
    }
}

/// How the end of a piece goes on along the border.
#[derive(Debug, Clone, Copy)]
struct Joint {
    /// The end of another piece.
    to: usize,
    /// Whether in the contour's direction.
    forward: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{dvec2, snap};

    fn joined(longest: f64, anchor: f64, at: &[f64]) -> Vec<Vec<DVec2>> {
        let square = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 10.0));
        let border = Border::of(&square);
        let lines: Vec<Vec<DVec2>> = at.iter().map(|&x| vec![dvec2(x, -1.0), dvec2(x, 11.0)]).collect();
        let lines = border.join(border.cut(&lines), longest, anchor);
        lines.into_iter().map(|line| line.into_iter().map(snap).collect()).collect()
    }

    #[test]
    fn free_ends_follow_the_border_to_the_emptier_side() {
        let lines = joined(0.0, 1.0, &[3.0]);
        let along = [dvec2(4.0, 0.0), dvec2(3.0, 0.0), dvec2(3.0, 10.0), dvec2(4.0, 10.0)];
        assert_eq!(lines, [along.to_vec()]);
        // Around the corner.
        let lines = joined(0.0, 1.0, &[9.5]);
        let along = [dvec2(8.5, 0.0), dvec2(9.5, 0.0), dvec2(9.5, 10.0), dvec2(8.5, 10.0)];
        assert_eq!(lines, [along.to_vec()]);
        assert_eq!(joined(0.0, 0.0, &[3.0]), [vec![dvec2(3.0, 0.0), dvec2(3.0, 10.0)]]);
    }

    #[test]
    fn joined_ends_have_no_anchor() {
        let lines = joined(3.0, 1.0, &[3.0, 5.0]);
        let [line] = &lines[..] else { panic!("{lines:?}") };
        let anchored = [dvec2(2.0, 10.0), dvec2(3.0, 10.0), dvec2(3.0, 0.0), dvec2(5.0, 0.0)];
        let other = [dvec2(5.0, 10.0), dvec2(6.0, 10.0)];
        assert_eq!(*line, [&anchored[..], &other].concat());
    }
}
