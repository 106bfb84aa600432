//! Simplification of the rail [Lv 2022, section 2.2, eq. 9-12], the paper's six steps.

use crate::polygon::{Contour, DVec2};

/// Limits of the simplification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Lmin: edges at least this long are kept, mm.
    pub length: f64,
    /// Hmin: vertices at least this far off are kept, mm.
    pub height: f64,
}

/// One forward pass over an open line. A is the last kept vertex, B the current, C the next one;
/// B goes when |AB| < Lmin **and** its height over AC (eq. 12) is below Hmin. First and last are kept.
///
/// The paper calls this Douglas-Peucker, but a vertex is compared with its neighbours only, so
/// small heights add up over a run of dropped vertices. Kept is another bound: every dropped vertex
/// lies within Lmin of a kept one, so no vertex is farther than Lmin from the result.
pub fn simplify_forward(points: &[DVec2], limits: Limits) -> Vec<DVec2> {
    let [first, .., last] = points else { return points.to_vec() };
    let mut kept = vec![*first];
    let mut a = *first;
    for pair in points[1..].windows(2) {
        let (b, c) = (pair[0], pair[1]);
        let short = a.distance_squared(b) < limits.length * limits.length;
        if !(short && squared_height(a, b, c) < limits.height * limits.height) {
            kept.push(b);
            a = b;
        }
    }
    kept.push(*last);
    kept
}

/// The same for a ring, from a true corner (its sharpest vertex) round to that corner again, the
/// closing edge included.
pub fn simplify_closed(ring: &Contour, limits: Limits) -> Contour {
    let mut points = ring.points.clone();
    if points.len() < 4 {
        return ring.clone();
    }
    let corner = sharpest_vertex(&points);
    points.rotate_left(corner);
    points.push(points[0]);
    let mut kept = simplify_forward(&points, limits);
    kept.pop();
    if kept.len() < 3 { ring.clone() } else { Contour::new(kept) }
}

/// Squared height of B over AC, eq. (12); over a point when A = C.
fn squared_height(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let base = (c - a).length_squared();
    if base == 0.0 {
        return a.distance_squared(b);
    }
    let twice_area = (b - a).perp_dot(c - a);
    twice_area * twice_area / base
}

/// Index of the vertex where the ring turns most; the first of equals.
fn sharpest_vertex(points: &[DVec2]) -> usize {
    let n = points.len();
    let straightness = |i: usize| {
        let (to, from) = (points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]);
        to.normalize_or_zero().dot(from.normalize_or_zero())
    };
    (0..n).min_by(|&i, &j| straightness(i).total_cmp(&straightness(j))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;
    use crate::polygon::simplify::squared_distance_to_segment;
    use crate::polygon::trig::sin_cos;

    const LIMITS: Limits = Limits { length: 0.5, height: 0.05 };

    fn farthest(points: &[DVec2], from: &[DVec2]) -> f64 {
        let near = |p: &DVec2| {
            from.windows(2).map(|w| squared_distance_to_segment(*p, w[0], w[1])).fold(f64::INFINITY, f64::min)
        };
        points.iter().map(near).fold(0.0, f64::max).sqrt()
    }

    #[test]
    fn short_and_flat_goes_long_or_high_stays() {
        let line = [
            dvec2(0.0, 0.0),
            dvec2(0.4, 0.01), // short and flat
            dvec2(1.0, 0.0),
            dvec2(1.3, 0.2), // short and high
            dvec2(1.6, 0.0),
            dvec2(9.0, 0.0), // long and flat
            dvec2(12.0, 0.0),
        ];
        let kept = simplify_forward(&line, LIMITS);
        assert_eq!(kept, [line[0], line[2], line[3], line[4], line[5], line[6]]);
    }

    #[test]
    fn a_fine_circle_keeps_edges_of_half_a_millimetre() {
        let at = |i: usize| {
            let (sin, cos) = sin_cos(std::f64::consts::TAU * i as f64 / 5000.0);
            dvec2(cos, sin) * 20.0
        };
        let ring = Contour::new((0..5000).map(at).collect());
        let simple = simplify_closed(&ring, LIMITS);
        // 125.66 mm in edges of 0.5 to 0.5252 (one step of 0.0251 more).
        assert!((239..=252).contains(&simple.points.len()), "{}", simple.points.len());
        // The sagitta of a chord of 0.525 at radius 20 is 0.0017.
        assert!(farthest(&ring.points, &[&simple.points[..], &simple.points[..1]].concat()) < 0.0018);
    }

    #[test]
    fn the_bound_kept_is_lmin_not_hmin() {
        // A hairpin of tiny steps, 0.45 high: every vertex is flat over its neighbours.
        let up = (0..=45).map(|i| dvec2(0.0, 0.01 * f64::from(i)));
        let down = (0..45).rev().map(|i| dvec2(0.001, 0.01 * f64::from(i)));
        let mut line: Vec<DVec2> = up.chain(down).collect();
        line.push(dvec2(3.0, 0.0));
        let off = farthest(&line, &simplify_forward(&line, LIMITS));
        assert!(off > 8.0 * LIMITS.height && off <= LIMITS.length, "{off}");
    }

    #[test]
    fn random_walks_stay_within_lmin() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5
        };
        for _ in 0..50 {
            let mut at = DVec2::ZERO;
            let walk: Vec<DVec2> = (0..400)
                .map(|_| {
                    at += dvec2(next() * 0.3 + 0.05, next() * 0.3);
                    at
                })
                .collect();
            let kept = simplify_forward(&walk, LIMITS);
            assert!(farthest(&walk, &kept) <= LIMITS.length);
            assert!(kept.len() < walk.len());
        }
    }
}
