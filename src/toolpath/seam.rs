//! Where a loop starts and ends.

use std::cmp::Ordering;

use crate::polygon::{DVec2, by_x_then_y};

/// Which vertex of a loop becomes its seam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum SeamPosition {
    /// In a corner, inward ones first, of several the rearmost: neighbouring layers agree, and the
    /// corner hides the seam.
    #[default]
    Aligned,
    /// At the rearmost vertex.
    Rear,
}

crate::options! {
    /// Where loops start.
    pub struct SeamOptions {
        /// Which vertex of a loop becomes its start and end.
        position: SeamPosition = SeamPosition::Aligned, "Seam position";
    }
}

/// Cosine of the turn, 30 degrees, from which a vertex counts as a corner that hides a seam.
const CORNER_COSINE: f64 = 0.866_025_403_784_438_6;

/// How well a vertex hides a seam, best first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Hiding {
    InwardCorner,
    OutwardCorner,
    Nothing,
}

/// Rotates the loop, which has the part on its left, so that it starts at its seam.
pub fn start_at_seam(points: &mut [DVec2], position: SeamPosition) {
    let n = points.len();
    let hiding = |i: usize| match position {
        SeamPosition::Rear => Hiding::Nothing,
        SeamPosition::Aligned => hiding_at(points[(i + n - 1) % n], points[i], points[(i + 1) % n]),
    };
    let rated: Vec<Hiding> = (0..n).map(hiding).collect();
    let better =
        |&a: &usize, &b: &usize| rated[a].cmp(&rated[b]).then_with(|| rearmost_first(points[a], points[b]));
    let seam = (0..n).min_by(better).unwrap_or(0);
    points.rotate_left(seam);
}

fn hiding_at(before: DVec2, at: DVec2, after: DVec2) -> Hiding {
    let (to, from) = (at - before, after - at);
    if to.dot(from) > CORNER_COSINE * to.length() * from.length() {
        Hiding::Nothing
    } else if to.perp_dot(from) < 0.0 {
        Hiding::InwardCorner
    } else {
        Hiding::OutwardCorner
    }
}

fn rearmost_first(a: DVec2, b: DVec2) -> Ordering {
    b.y.total_cmp(&a.y).then_with(|| by_x_then_y(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn the_inward_corner_of_an_l_takes_the_seam() {
        let mut l = vec![
            dvec2(0.0, 0.0),
            dvec2(10.0, 0.0),
            dvec2(10.0, 4.0),
            dvec2(4.0, 4.0),
            dvec2(4.0, 10.0),
            dvec2(0.0, 10.0),
        ];
        start_at_seam(&mut l, SeamPosition::Aligned);
        assert_eq!(l[0], dvec2(4.0, 4.0));
        start_at_seam(&mut l, SeamPosition::Rear);
        assert_eq!(l[0], dvec2(0.0, 10.0));
    }
}
