//! Loops around everything that touch nothing.

use super::clip::{Line, to_box};
use super::error::{AdhesionWarning, WarningCode};
use super::ground::Ground;
use super::options::SkirtOptions;
use super::{FirstLayer, Foundation};
use crate::polygon::hull::convex_hull;
use crate::polygon::{Join, PolygonSet};
use crate::region::{Path, Role};

/// The minimum length adds no more loops than this.
const MOST_LOOPS: u32 = 100;

/// Loops around the convex hull of part and supports, outermost first, so that the nozzle comes to
/// the part from nearby.
pub(super) fn skirt(first: &FirstLayer, ground: &Ground, options: &SkirtOptions) -> Foundation {
    let points = ground.area.contours().iter().flat_map(|c| &c.points).copied().collect();
    let hull = PolygonSet::from_contours(vec![convex_hull(points)]);
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
