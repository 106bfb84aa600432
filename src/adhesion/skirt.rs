//! Loops around everything that touch nothing.

use super::clip::{Line, to_box};
use super::error::{AdhesionWarning, WarningCode};
use super::ground::Ground;
use super::options::SkirtOptions;
use super::{FirstLayer, Foundation};
use crate::polygon::{Contour, DVec2, Join, PolygonSet, by_x_then_y};
use crate::region::{Path, Role};
use crate::sort::StableSort;

/// The minimum length adds no more loops than this.
const MOST_LOOPS: u32 = 100;

/// Loops around the convex hull of part and supports, outermost first, so that the nozzle comes to
/// the part from nearby.
pub(super) fn skirt(first: &FirstLayer, ground: &Ground, options: &SkirtOptions) -> Foundation {
    let hull = PolygonSet::from_contours(vec![convex_hull(ground.area.contours())]);
    let mut paths: Vec<Path> = Vec::new();
    let (mut length, mut cut_at) = (0.0, None);
    for k in 0..MOST_LOOPS {
        if hull.is_empty() || (k >= options.loops && length >= options.min_length) {
            break;
        }
        let distance = options.distance + (f64::from(k) + 0.5) * first.line_width;
        let before = length;
        for contour in hull.offset(distance, Join::WALL).into_contours() {
            let bed = first.bed.grown(-first.line_width / 2.0);
            cut_at = cut_at.or(contour.points.iter().find(|&&p| p.clamp(bed.min, bed.max) != p).copied());
            for line in to_box(Line::ring(contour.points), bed) {
                let make = if line.closed { Path::closed } else { Path::open };
                paths.push(make(Role::Skirt, line.points, first.line_width));
            }
            length = paths.iter().map(Path::length).sum();
        }
        // A loop that lies wholly beyond the bed: all later ones do.
        if length == before {
            break;
        }
    }
    paths.reverse();
    let message = "adhesion.skirt.distance: the skirt would leave the bed; it is cut off there";
    let warning = |at| AdhesionWarning::new(WarningCode::AdhesionOffBed, message.to_owned(), Some(at));
    Foundation {
        layers: vec![paths],
        warnings: cut_at.map(warning).into_iter().collect(),
        ..Foundation::default()
    }
}

/// Smallest convex ring around all points, counter-clockwise (monotone chain, Andrew 1979).
fn convex_hull(contours: &[Contour]) -> Contour {
    let mut points: Vec<DVec2> = contours.iter().flat_map(|c| &c.points).copied().collect();
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
    use crate::polygon::dvec2;

    #[test]
    fn the_hull_of_a_cross_is_an_octagon() {
        let cross = PolygonSet::rectangle(dvec2(-3.0, -1.0), dvec2(3.0, 1.0))
            .union(&PolygonSet::rectangle(dvec2(-1.0, -3.0), dvec2(1.0, 3.0)));
        let hull = convex_hull(cross.contours());
        assert_eq!(hull.points.len(), 8);
        // 6 x 6 less four corner triangles of 2 x 2 / 2.
        assert_eq!(hull.signed_area(), 28.0);
    }
}
