//! Convex hulls in the plane.

use super::{Contour, DVec2, by_x_then_y};
use crate::sort::StableSort;

/// Smallest convex ring around all points, counter-clockwise (monotone chain, Andrew 1979).
pub fn convex_hull(mut points: Vec<DVec2>) -> Contour {
    points.stable_sort_by(|&p, &q| by_x_then_y(p, q));
    points.dedup();
    let lower = half_hull(points.iter().copied());
    let upper = half_hull(points.iter().rev().copied());
    Contour::new(lower.into_iter().chain(upper).collect())
}

/// The chain that turns left, without its last point.
fn half_hull(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut chain: Vec<DVec2> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp_dot(p - b) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{PolygonSet, dvec2};

    #[test]
    fn the_hull_of_a_cross_is_an_octagon() {
        let cross = PolygonSet::rectangle(dvec2(-3.0, -1.0), dvec2(3.0, 1.0))
            .union(&PolygonSet::rectangle(dvec2(-1.0, -3.0), dvec2(1.0, 3.0)));
        let hull = convex_hull(cross.contours().iter().flat_map(|c| &c.points).copied().collect());
        assert_eq!(hull.points.len(), 8);
        // 6 x 6 less four corner triangles of 2 x 2 / 2.
        assert_eq!(hull.signed_area(), 28.0);
    }
}
