//! Fewer points within a tolerance.

use super::measure::vertex_count;
use super::{Contour, DVec2, PolygonSet};

impl PolygonSet {
    /// Drops points so that no dropped point is farther than `tolerance` mm from the new outline
    /// (Douglas and Peucker 1973, from two far corners of each contour). Contours that become
    /// thinner than the tolerance vanish.
    ///
    /// Neighbouring outlines may come to cross by up to the tolerance; the result is united again.
    pub fn simplified(&self, tolerance: f64) -> PolygonSet {
        let simpler: Vec<Contour> = self.contours().iter().map(|c| simplify_ring(c, tolerance)).collect();
        let dropped = vertex_count(&simpler) < self.vertex_count();
        if dropped { PolygonSet::from_contours(simpler) } else { self.clone() }
    }
}

impl PolygonSet {
    /// Like [`PolygonSet::simplified`], but not united again: outlines may cross by up to
    /// `tolerance`. For operands of booleans, which do not mind.
    pub fn roughened(&self, tolerance: f64) -> PolygonSet {
        PolygonSet::canonical(self.contours().iter().map(|c| simplify_ring(c, tolerance)).collect())
    }
}

/// Douglas-Peucker on a closed contour: the two ends are its first point and the point farthest
/// from it, both kept.
pub fn simplify_ring(contour: &Contour, tolerance: f64) -> Contour {
    let points = &contour.points;
    let Some(&first) = points.first() else { return Contour::default() };
    let far = (0..points.len()).max_by(|&a, &b| {
        points[a].distance_squared(first).total_cmp(&points[b].distance_squared(first)).then(b.cmp(&a))
    });
    let far = far.unwrap_or(0);
    let mut ring = points.clone();
    ring.push(first);
    let mut kept = simplify_line(&ring[..=far], tolerance);
    kept.pop();
    kept.extend(simplify_line(&ring[far..], tolerance));
    kept.pop();
    Contour::new(kept)
}

/// Douglas-Peucker on an open line: first and last are kept, dropped points lie within `tolerance`
/// mm of the result.
pub fn simplify_line(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let n = points.len();
    if n < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; n];
    (keep[0], keep[n - 1]) = (true, true);
    let mut open = vec![(0, n - 1)];
    while let Some((a, b)) = open.pop() {
        let farthest = (a + 1..b)
            .map(|i| (i, squared_distance_to_segment(points[i], points[a], points[b])))
            .fold((a, tolerance * tolerance), |best, next| if next.1 > best.1 { next } else { best });
        if farthest.0 > a {
            keep[farthest.0] = true;
            open.push((a, farthest.0));
            open.push((farthest.0, b));
        }
    }
    points.iter().zip(keep).filter_map(|(&p, kept)| kept.then_some(p)).collect()
}

/// Squared distance of `p` from the segment a-b, mm2.
pub fn squared_distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    p.distance_squared(closest_on_segment(p, a, b))
}

/// The point of the segment a-b that is nearest to `p`.
pub fn closest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let along = b - a;
    let length_squared = along.length_squared();
    if length_squared == 0.0 {
        return a;
    }
    a + along * ((p - a).dot(along) / length_squared).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn points_within_the_tolerance_go_and_corners_stay() {
        let dented = Contour::new(vec![
            dvec2(0.0, 0.0),
            dvec2(5.0, 0.01),
            dvec2(10.0, 0.0),
            dvec2(10.0, 10.0),
            dvec2(0.0, 10.0),
        ]);
        let simple = PolygonSet::from_contours(vec![dented]).simplified(0.02);
        assert_eq!(simple, PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 10.0)));
    }

    #[test]
    fn a_contour_of_one_repeated_point_vanishes() {
        let point = Contour::new(vec![dvec2(1.0, 1.0); 4]);
        assert!(PolygonSet::from_contours(vec![point]).simplified(0.1).is_empty());
    }
}
