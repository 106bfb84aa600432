//! Random shapes for tests.

use proptest::prelude::*;

use super::{Contour, DVec2, Join, PolygonSet, dvec2, trig};

/// A star of any shape around `centre`, its tips 0.5 to 5 mm away, stretched `stretch` times along x.
pub(crate) fn star(centre: DVec2, stretch: f64) -> impl Strategy<Value = PolygonSet> {
    prop::collection::vec(0.5..5.0f64, 3..32).prop_map(move |radii| {
        let at = |(i, r): (usize, &f64)| {
            let (sin, cos) = trig::sin_cos(std::f64::consts::TAU * i as f64 / radii.len() as f64);
            centre + dvec2(stretch * cos, sin) * *r
        };
        PolygonSet::from_contours(vec![Contour::new(radii.iter().enumerate().map(at).collect())])
    })
}

/// The same around (5, 5), with a hole where it is wide enough.
pub(crate) fn hollow_star() -> impl Strategy<Value = PolygonSet> {
    star(dvec2(5.0, 5.0), 1.0).prop_map(|outer| outer.difference(&outer.offset(-1.2, Join::WALL)))
}
