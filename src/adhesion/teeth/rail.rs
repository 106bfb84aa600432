//! The rail as a closed line by arc length.

use super::PlacedTooth;
use crate::polygon::DVec2;
use crate::sort::StableSort;

/// Cosine of the turn from which a vertex of the rail is a corner and not part of a curve (30
/// degrees). Outlines are simplified to 0.005 mm, so curves of 0.15 mm radius or more turn by less.
const CORNER_COS: f64 = 0.866;

/// Points closer along the path are one, mm.
const SAME_POINT_MM: f64 = 1e-9;

/// A closed line with the arc length at each vertex.
pub(super) struct Rail {
    /// Vertices; the last is not repeated.
    pub(super) points: Vec<DVec2>,
    /// Arc length at each vertex, and the whole length last.
    along: Vec<f64>,
    /// Arc lengths of the corners, ascending.
    corners: Vec<f64>,
}

impl Rail {
    /// A rail through these points, no two neighbours equal.
    pub(super) fn new(points: Vec<DVec2>) -> Rail {
        let n = points.len();
        let mut along = vec![0.0; n + 1];
        for i in 0..n {
            along[i + 1] = along[i] + points[i].distance(points[(i + 1) % n]);
        }
        let is_corner = |i: usize| {
            let (to, from) = (points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]);
            to.normalize_or_zero().dot(from.normalize_or_zero()) < CORNER_COS
        };
        let corners = (0..n).filter(|&i| is_corner(i)).map(|i| along[i]).collect();
        Rail { points, along, corners }
    }

    pub(super) fn length(&self) -> f64 {
        self.along[self.points.len()]
    }

    /// The edges with the arc length at their start.
    pub(super) fn edges(&self) -> impl Iterator<Item = (f64, DVec2, DVec2)> + '_ {
        let n = self.points.len();
        (0..n).map(move |i| (self.along[i], self.points[i], self.points[(i + 1) % n]))
    }

    /// The point at an arc length, counted round and round.
    pub(super) fn at(&self, s: f64) -> DVec2 {
        let s = s.rem_euclid(self.length());
        let n = self.points.len();
        let i = (self.along.partition_point(|&a| a <= s)).clamp(1, n) - 1;
        let (a, b) = (self.points[i], self.points[(i + 1) % n]);
        let edge = self.along[i + 1] - self.along[i];
        if edge > 0.0 { a.lerp(b, ((s - self.along[i]) / edge).min(1.0)) } else { a }
    }

    /// Whether a corner lies strictly between the two arc lengths, at most one round apart.
    pub(super) fn has_corner_between(&self, from: f64, to: f64) -> bool {
        let length = self.length();
        let start = from.rem_euclid(length);
        let end = start + (to - from);
        let first = self.corners.partition_point(|&c| c <= start);
        let next = self.corners.get(first).copied().or(self.corners.first().map(|c| c + length));
        next.is_some_and(|c| c < end)
    }

    /// The path of rail and teeth: rail up to A, tip, B, rail again [Lv 2022, section 2.4, step 6].
    /// `teeth` stand in order along the rail; their spans do not overlap.
    pub(super) fn zigzag(&self, teeth: &[PlacedTooth]) -> Vec<DVec2> {
        let length = self.length();
        // A path starts behind the tooth that stands on the ring's start, if one does.
        let wraps = |t: &&PlacedTooth| t.from < -SAME_POINT_MM || t.to > length + SAME_POINT_MM;
        let start = teeth.iter().find(wraps).map_or(0.0, |t| t.to.rem_euclid(length));
        let relative = |s: f64| (s - start).rem_euclid(length);
        let mut stops: Vec<(f64, f64, [DVec2; 3])> = teeth
            .iter()
            .map(|t| {
                (relative(t.from), relative(t.from) + (t.to - t.from), [t.tooth.a, t.tooth.tip, t.tooth.b])
            })
            .collect();
        stops.stable_sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut vertices: Vec<(f64, DVec2)> = self.edges().map(|(s, a, _)| (relative(s), a)).collect();
        vertices.stable_sort_by(|x, y| x.0.total_cmp(&y.0));
        merged(&vertices, &stops)
    }
}

/// Rail vertices outside the teeth's bases, and the teeth, in order.
fn merged(vertices: &[(f64, DVec2)], stops: &[(f64, f64, [DVec2; 3])]) -> Vec<DVec2> {
    let mut path: Vec<DVec2> = Vec::with_capacity(vertices.len() + 3 * stops.len());
    let mut push = |p: DVec2| {
        if path.last().is_none_or(|q| q.distance(p) > SAME_POINT_MM) {
            path.push(p);
        }
    };
    let mut vertices = vertices.iter().peekable();
    for (from, to, points) in stops {
        while let Some((_, p)) = vertices.next_if(|v| v.0 <= *from) {
            push(*p);
        }
        points.iter().for_each(|&p| push(p));
        while vertices.next_if(|v| v.0 < *to).is_some() {}
    }
    vertices.for_each(|v| push(v.1));
    if path.len() > 1 && path[0].distance(path[path.len() - 1]) <= SAME_POINT_MM {
        path.pop();
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    fn square() -> Rail {
        Rail::new(vec![dvec2(0.0, 0.0), dvec2(10.0, 0.0), dvec2(10.0, 10.0), dvec2(0.0, 10.0)])
    }

    #[test]
    fn arc_length_runs_round_and_round() {
        let rail = square();
        assert_eq!(rail.length(), 40.0);
        assert_eq!(rail.at(13.0), dvec2(10.0, 3.0));
        assert!(rail.at(-1.0).distance(dvec2(0.0, 1.0)) < 1e-12);
        assert_eq!(rail.at(83.0), dvec2(3.0, 0.0));
    }

    #[test]
    fn corners_are_found_across_the_start() {
        let rail = square();
        assert!(rail.has_corner_between(8.0, 12.0));
        assert!(!rail.has_corner_between(11.0, 19.0));
        assert!(rail.has_corner_between(-1.0, 1.0) && rail.has_corner_between(39.0, 41.0));
        assert!(!rail.has_corner_between(-4.0, -1.0));
        assert!(!rail.has_corner_between(10.0, 20.0));
    }
}
