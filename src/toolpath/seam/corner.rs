//! How well a place on a loop hides a seam.

use std::f64::consts::FRAC_PI_2;

use crate::polygon::DVec2;
use crate::polygon::trig::atan2;

/// A corner is looked at over this length of its sides, mm, so that one of many short edges counts
/// as a corner too, and a single kink in a scan does not.
const ARM: f64 = 0.5;

/// From 0, an inward corner of 90 degrees or sharper, to 1, no corner at all; outward corners count
/// half. The part lies on the loop's left.
pub(super) fn hiding(points: &[DVec2], vertex: usize) -> f64 {
    let at = points[vertex];
    let before = at - walk(points, vertex, points.len() - 1);
    let after = walk(points, vertex, 1) - at;
    let turn = atan2(before.perp_dot(after), before.dot(after));
    let sharpness = (turn.abs() / FRAC_PI_2).min(1.0);
    1.0 - if turn < 0.0 { sharpness } else { sharpness / 2.0 }
}

/// The point [`ARM`] away from a vertex along the loop, in steps of `step` vertices.
fn walk(points: &[DVec2], vertex: usize, step: usize) -> DVec2 {
    let (mut left, mut i) = (ARM, vertex);
    for _ in 0..points.len() {
        let next = (i + step) % points.len();
        let length = points[i].distance(points[next]);
        if length >= left && length > 0.0 {
            return points[i].lerp(points[next], left / length);
        }
        left -= length;
        i = next;
    }
    points[i]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn inward_corners_hide_best_and_straight_sides_not_at_all() {
        let l = [(0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)];
        let points = l.map(|(x, y)| dvec2(x, y));
        let rated: Vec<f64> = (0..7).map(|i| (hiding(&points, i) * 100.0).round() / 100.0).collect();
        assert_eq!(rated, [0.5, 1.0, 0.5, 0.5, 0.0, 0.5, 0.5]);
    }
}
