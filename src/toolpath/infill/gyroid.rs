//! The gyroid, sin x cos y + sin y cos z + sin z cos x = 0, cut at the height of a layer.
//!
//! A surface without self-crossing that holds in all directions (Schoen 1970, "Infinite periodic
//! minimal surfaces without self-intersections"). Its curves change from layer to layer as the surface
//! does, so that each layer lies on the one below.

use std::f64::consts::TAU;

use crate::polygon::measure::Bounds;
use crate::polygon::simplify::simplify_line;
use crate::polygon::trig::{acos, atan2, sin_cos};
use crate::polygon::{DVec2, dvec2};

/// Length of the curves in a period's square, in periods, on the average over all heights: the mean
/// over z of both curves' lengths. The test works it out anew.
pub(super) const LENGTH_PER_PERIOD: f64 = 2.456;

/// Points worked out per period; chords then miss the curve by less than a thousandth of a period.
const STEPS: usize = 64;

/// How far the curve may be simplified, as a share of the period.
const TOLERANCE: f64 = 0.002;

/// The curves at height `z`, with the given period, over a box that they leave at both ends.
pub(super) fn curves(bounds: Bounds, z: f64, period: f64) -> Vec<Vec<DVec2>> {
    let scale = period / TAU;
    let wave = Wave::at(z / scale);
    let (low, high) =
        if wave.along_x { (bounds.min, bounds.max) } else { (swap(bounds.min), swap(bounds.max)) };
    let (low, high) = (low / scale, high / scale);
    let periods = |from: f64, to: f64| (from / TAU).floor() as i64 - 1..=(to / TAU).ceil() as i64;
    let mut curves = Vec::new();
    for branch in [1.0, -1.0] {
        let bend = simplify_line(&wave.bend(branch), TOLERANCE * TAU);
        // The bend stays within a period of its row.
        for row in *periods(low.y, high.y).start() - 1..=*periods(low.y, high.y).end() + 1 {
            let over = |k: i64| bend[1..].iter().map(move |&p| p + TAU * dvec2(k as f64, row as f64));
            let curve: Vec<DVec2> = periods(low.x, high.x).flat_map(over).collect();
            let meets = curve.iter().any(|p| p.y >= low.y) && curve.iter().any(|p| p.y <= high.y);
            if meets {
                let to_plane = |p: DVec2| scale * if wave.along_x { p } else { swap(p) };
                curves.push(curve.into_iter().map(to_plane).collect());
            }
        }
    }
    curves
}

fn swap(p: DVec2) -> DVec2 {
    dvec2(p.y, p.x)
}

/// One layer of the gyroid, solved for the coordinate u across the curves, t along them:
/// a cos u + b sin u = -c, with a or b the same for all t.
///
/// Where |cos z| >= |sin z| the curves run along x (t = x, u = y): a = sin x, b = cos z,
/// c = sin z cos x. Elsewhere along y (t = y, u = x): a = sin z, b = cos y, c = sin y cos z.
struct Wave {
    along_x: bool,
    sin_z: f64,
    cos_z: f64,
}

impl Wave {
    fn at(z: f64) -> Wave {
        let (sin_z, cos_z) = sin_cos(z);
        Wave { along_x: cos_z.abs() >= sin_z.abs(), sin_z, cos_z }
    }

    /// One period of one of the two curves, both ends included, as points (t, u).
    fn bend(&self, branch: f64) -> Vec<DVec2> {
        (0..=STEPS).map(|i| self.point(TAU * i as f64 / STEPS as f64, branch)).collect()
    }

    fn point(&self, t: f64, branch: f64) -> DVec2 {
        let (sin_t, cos_t) = sin_cos(t);
        let (a, b, c, fixed) = if self.along_x {
            (sin_t, self.cos_z, self.sin_z * cos_t, self.cos_z)
        } else {
            (self.sin_z, cos_t, sin_t * self.cos_z, self.sin_z)
        };
        // With the fixed coefficient positive the angle below has no jump.
        let sign = if fixed < 0.0 { -1.0 } else { 1.0 };
        let (a, b, c) = (sign * a, sign * b, sign * c);
        let middle = atan2(b, a);
        let aside = acos((-c / (a * a + b * b).sqrt()).clamp(-1.0, 1.0));
        dvec2(t, middle + branch * aside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Bounds = Bounds { min: DVec2::ZERO, max: DVec2::splat(20.0) };

    #[test]
    fn every_point_lies_on_the_surface() {
        let period = 5.0;
        for layer in 0..40 {
            let z = 0.2 * f64::from(layer) + 0.013;
            for p in curves(BOX, z, period).concat() {
                let [x, y, z] = [p.x, p.y, z].map(|v| v * TAU / period);
                let f = x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
                assert!(f.abs() < 1e-9, "{f} at height {z}");
            }
        }
    }

    /// Both curves, added up over a period of heights; what lies outside the box is left out by
    /// counting whole periods only.
    #[test]
    fn the_mean_length_is_the_stated_one() {
        let bend = |z: f64, branch: f64| -> f64 {
            let points = Wave::at(z).bend(branch);
            points.windows(2).map(|w| w[0].distance(w[1])).sum()
        };
        let heights = 256;
        let total: f64 = (0..heights)
            .map(|i| TAU * (f64::from(i) + 0.5) / f64::from(heights))
            .map(|z| bend(z, 1.0) + bend(z, -1.0))
            .sum();
        let mean = total / f64::from(heights) / TAU;
        assert!((mean / LENGTH_PER_PERIOD - 1.0).abs() < 0.002, "{mean}");
    }
}
