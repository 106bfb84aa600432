//! Offset of a ring vertex by vertex [Lv 2022, section 2.1, eq. 1-8]: for the Learn view, and the slow
//! twin of the polygon library's offset, which makes the rails that are printed.

use crate::polygon::{Contour, DVec2};

/// Below this sine of the corner's angle its two edges count as one straight line (0.06 degrees).
const STRAIGHT: f64 = 1e-3;

/// The vertex `p` of a counter-clockwise ring, shifted outward by `d` mm; `a` and `b` are its
/// neighbours before and after. Distance |QP| = d / sin(alpha / 2).
///
/// Eq. (5) and (6), `Q = P - (u + v) d / sin(alpha)` with u, v the unit vectors to A and B and alpha
/// the angle between them, hold for every alpha in (0, pi); at a reflex vertex the sign turns. The
/// paper's second case, eq. (7) and (8) for alpha > pi/2 with sin(alpha - pi/2), is wrong but at 135
/// degrees and not used. Collinear vertices (0/0) shift along the normal; a vertex where the ring
/// turns back on itself (alpha = 0) has no such point, and shifts along the edge.
pub fn offset_vertex(a: DVec2, p: DVec2, b: DVec2, d: f64) -> DVec2 {
    let (u, v) = ((a - p).normalize_or_zero(), (b - p).normalize_or_zero());
    // Positive at a convex vertex of a counter-clockwise ring: the sign carries the paper's cases.
    let sine = v.perp_dot(u);
    if sine.abs() > STRAIGHT {
        p - (u + v) * (d / sine)
    } else if u.dot(v) < 0.0 {
        p + (u - v).perp().normalize_or_zero() * d
    } else {
        p - u * d
    }
}

/// Every vertex of a counter-clockwise ring shifted outward. Right for convex rings; elsewhere edges
/// may cross, which is why the library's offset is the one that is printed.
pub fn offset_ring(ring: &Contour, d: f64) -> Contour {
    let n = ring.points.len();
    let at = |i: usize| ring.points[i % n];
    Contour::new((0..n).map(|i| offset_vertex(at(i + n - 1), at(i), at(i + 1), d)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::trig::{sin_cos, tan};
    use crate::polygon::{Join, PolygonSet, dvec2};

    /// A corner at the origin of a counter-clockwise ring: edges along +x (next) and at `degrees`.
    fn corner(degrees: f64) -> (DVec2, DVec2, DVec2) {
        let (sin, cos) = sin_cos(degrees.to_radians());
        (dvec2(cos, sin) * 7.0, DVec2::ZERO, dvec2(3.0, 0.0))
    }

    fn distance_to_line(q: DVec2, from: DVec2, to: DVec2) -> f64 {
        ((to - from).normalize().perp_dot(q - from)).abs()
    }

    #[test]
    fn eq_5_and_6_keep_the_distance_to_both_edges_from_1_to_179_degrees() {
        for degrees in 1..180 {
            let (a, p, b) = corner(f64::from(degrees));
            let q = offset_vertex(a, p, b, 2.0);
            assert!((distance_to_line(q, p, a) - 2.0).abs() < 1e-9, "{degrees}");
            assert!((distance_to_line(q, p, b) - 2.0).abs() < 1e-9, "{degrees}");
            let half = sin_cos(f64::from(degrees).to_radians() / 2.0).0;
            assert!((q.distance(p) - 2.0 / half).abs() < 1e-9, "|QP| at {degrees}");
            assert!(q.y < 0.0, "outward is below the edge to +x at {degrees}");
        }
    }

    #[test]
    fn a_reflex_vertex_moves_into_the_notch_by_the_same_distance() {
        for degrees in 181..360 {
            let (a, p, b) = corner(f64::from(degrees));
            let q = offset_vertex(a, p, b, 2.0);
            assert!((distance_to_line(q, p, a) - 2.0).abs() < 1e-9, "{degrees}");
            assert!((distance_to_line(q, p, b) - 2.0).abs() < 1e-9, "{degrees}");
            assert!(q.y < 0.0 && q.x > 0.0 && q.dot(a) > 0.0, "between the edges at {degrees}");
        }
    }

    /// Erratum: eq. (8) as printed, distance of Q from the edge along x.
    fn printed_eq_8(degrees: f64) -> f64 {
        let (sin, _) = sin_cos(degrees.to_radians());
        let (printed, _) = sin_cos((degrees - 90.0).to_radians());
        sin * 2.0 / printed
    }

    #[test]
    fn erratum_the_printed_eq_8_is_right_at_135_degrees_only() {
        assert!((printed_eq_8(120.0) - 3.4641).abs() < 5e-5);
        assert!((printed_eq_8(150.0) - 1.1547).abs() < 5e-5);
        assert!((printed_eq_8(135.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn collinear_vertices_shift_along_the_normal() {
        let q = offset_vertex(dvec2(-4.0, 1.0), dvec2(1.0, 1.0), dvec2(2.0, 1.0), 2.0);
        assert!(q.distance(dvec2(1.0, -1.0)) < 1e-12 || q.distance(dvec2(1.0, 3.0)) < 1e-12);
        // From left to right the inside of a counter-clockwise ring is above.
        assert!(q.y < 1.0);
    }

    #[test]
    fn the_librarys_offset_agrees_on_simple_convex_rings() {
        let regular = |n: usize, r: f64| {
            let at = |i: usize| {
                let (sin, cos) = sin_cos(std::f64::consts::TAU * i as f64 / n as f64);
                dvec2(cos, sin) * r
            };
            Contour::new((0..n).map(at).collect())
        };
        for n in [3, 4, 5, 6, 12, 60, 200] {
            let ring = regular(n, 11.0);
            let twin = offset_ring(&ring, 2.0);
            // A regular n-gon's inradius grows by d; its area is n r^2 tan(pi / n).
            let wedge = std::f64::consts::PI / n as f64;
            let inradius = 11.0 * sin_cos(wedge).1 + 2.0;
            assert!((twin.signed_area() - n as f64 * inradius * inradius * tan(wedge)).abs() < 1e-9);
            let set = PolygonSet::from_contours(vec![ring]).offset(2.0, Join::Mitre { limit: 2.001 });
            let apart = set.symmetric_difference(&PolygonSet::from_contours(vec![twin])).area();
            assert!(apart < 0.05, "{n}: {apart} mm2 apart");
        }
    }
}
