//! Spiral vase: above its bottom the part is one wall that rises all the time.
//!
//! Each layer is laid alone: its wall starts where the outline is farthest back above the outline's
//! middle and ends where that of the next layer does, so that walls follow on one another without a
//! travel, whoever laid them.

use super::range::RangePlan;
use super::report::Warning;
use crate::adhesion::AdhesionKind;
use crate::polygon::{Contour, DVec2, Join, PolygonSet};
use crate::region::{Bead, Path, Role};
use crate::settings::Settings;

/// Settings of a vase: one wall, no infill, nothing on top.
pub(super) fn as_vase(mut settings: Settings) -> Settings {
    settings.walls.count = 1;
    settings.skin.top_layers = 0;
    settings.infill.density = 0.0;
    settings
}

/// Layers below the spiral: the bottom, and all that hold something that keeps the part on the bed.
fn bottom_layers(settings: &Settings) -> u32 {
    let adhesion = &settings.adhesion;
    let base = if adhesion.kind == AdhesionKind::Teeth { adhesion.teeth.layers } else { 1 };
    settings.skin.bottom_layers.max(base)
}

/// A layer's part of the spiral.
pub(super) struct Turn {
    /// The wall, open.
    pub(super) wall: Path,
    /// Whether it is the first turn, whose bead grows from nothing.
    pub(super) is_first: bool,
}

/// The wall of a layer of a vase; `None` where the layer is printed flat: in the bottom, and where
/// its section is not one outline without holes.
pub(super) fn turn_of(plan: &RangePlan, place: usize, areas: &[PolygonSet]) -> Option<Turn> {
    let wall = spiral_wall(plan, place, areas)?;
    let is_first = place.checked_sub(1).is_none_or(|below| spiral_wall(plan, below, areas).is_none());
    let mut points = from_start(&wall);
    let above = areas.get(place + 1).and_then(|_| spiral_wall(plan, place + 1, areas));
    let end = above.map_or(points[0], |next| from_start(&next)[0]);
    points.push(end);
    Some(Turn { wall: Path::open(Role::OuterWall, points, plan.settings.walls.width), is_first })
}

/// The centre line of a vase's wall.
fn spiral_wall(plan: &RangePlan, place: usize, areas: &[PolygonSet]) -> Option<Contour> {
    let (settings, spec) = (&plan.settings, &plan.specs[place]);
    if !settings.layers.spiral_vase || spec.index < bottom_layers(settings) {
        return None;
    }
    let bead = Bead { width: settings.walls.width, height: spec.height };
    let [_] = areas[place].contours() else { return None };
    let wall = areas[place].offset(-bead.width / 2.0, Join::WALL).into_contours();
    <[Contour; 1]>::try_from(wall).ok().map(|[wall]| wall)
}

/// The contour's points from its start on: where it crosses the line straight back from the middle
/// of its bounds, farthest back. Smooth shapes start close to one another from layer to layer.
fn from_start(contour: &Contour) -> Vec<DVec2> {
    let middle = contour.bounds().map_or(0.0, |b| b.centre().x);
    let crossing = |(i, (a, b)): (usize, (DVec2, DVec2))| {
        let crosses = (a.x <= middle) != (b.x <= middle);
        crosses.then(|| (i, a.lerp(b, (middle - a.x) / (b.x - a.x))))
    };
    let crossings = contour.edges().enumerate().filter_map(crossing);
    let back = crossings.max_by(|(_, p), (_, q)| p.y.total_cmp(&q.y));
    // A contour reaches to both sides of its middle; one without width has no crossing.
    let Some((edge, start)) = back else { return contour.points.clone() };
    let count = contour.points.len();
    let rest = (1..=count).map(|k| contour.points[(edge + k) % count]).filter(|&p| p != start);
    std::iter::once(start).chain(rest).collect()
}

/// Remarks on layers above the bottom that must be printed flat, one for each run of them.
pub(super) fn flat_warnings(plan: &RangePlan, areas: &[PolygonSet]) -> Vec<Warning> {
    let settings = &plan.settings;
    let several = |place: usize| {
        let above_bottom = plan.specs[place].index >= bottom_layers(settings);
        above_bottom && areas[place].contours().len() > 1
    };
    let starts = |&place: &usize| several(place) && place.checked_sub(1).is_none_or(|below| !several(below));
    let warn = |place: usize| {
        let count = areas[place].contours().len();
        let message =
            format!("spiral vase: {count} outlines here, so that layers are printed flat from here on");
        let at = areas[place].contours()[1].points[0];
        Warning::on_layer("vase_printed_flat", message, plan.specs[place].index, at)
    };
    let printed = if settings.layers.spiral_vase { plan.first..plan.last } else { 0..0 };
    printed.filter(starts).map(warn).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn a_contour_starts_at_its_back_in_the_middle() {
        let square = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 10.0)).into_contours().remove(0);
        let points = from_start(&square);
        assert_eq!(points[0], dvec2(5.0, 10.0));
        assert_eq!(points.len(), 5);
        let length: f64 =
            points.iter().zip(points[1..].iter().chain(&points[..1])).map(|(a, b)| a.distance(*b)).sum();
        assert!((length - 40.0).abs() < 1e-9);
    }
}
