//! What a vertical plane looks like to [Zhao]'s method.

use super::base_layer::{hair_line, outline_strokes};
use super::scene::{Anchor, Ink, Item, LineWidth, Scene};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, dvec2};
use crate::support::PlanePicture;
use crate::support::points::{Foot, PointType, SPoint};

/// Radius of the marks of points, pixels.
const POINT_PX: f64 = 4.0;

/// With more points than this their letters would cover each other.
const MOST_LETTERS: usize = 24;

/// Free space around a plane, mm.
const MARGIN_MM: f64 = 3.0;

/// What of a plane is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PlaneDetail {
    /// The section and what of it hangs.
    Section,
    /// And the S-, IO- and G-points.
    Points,
    /// And what is to be held.
    Region,
}

impl Scene {
    /// The plane's section with what hangs, its points with their letters, and what supports must fill,
    /// as far as `detail` goes; z up, the bed at the bottom.
    pub fn of_plane(plane: &PlanePicture, detail: PlaneDetail) -> Scene {
        let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        let part = plane.section.bounds().unwrap_or(nothing);
        let floor = Bounds { min: dvec2(part.min.x, part.min.y.min(0.0)), max: part.max };
        let bounds = floor.grown(MARGIN_MM);
        let bed = vec![dvec2(bounds.min.x, 0.0), dvec2(bounds.max.x, 0.0)];
        let stroke = |points, ink, px| Item::Stroke { points, closed: false, width: LineWidth::Px(px), ink };
        let mut items = Vec::new();
        if detail >= PlaneDetail::Region {
            items.push(Item::Area { area: plane.at_zero.clone(), ink: Ink::HeldAtZero });
            items.push(Item::Area { area: plane.support.clone(), ink: Ink::Held });
        }
        items.push(Item::Area { area: plane.section.clone(), ink: Ink::Part });
        items.push(stroke(bed, Ink::Bed, 2.0));
        items.extend(outline_strokes(&plane.section, Ink::Outline, 1.2));
        items.extend(plane.hanging.iter().map(|&(a, b)| stroke(vec![a, b], Ink::Hanging, 3.0)));
        if detail >= PlaneDetail::Points {
            items.extend(point_items(&plane.points));
        }
        Scene { items, bounds }
    }
}

/// Every S-point with the vertical to its foot: S1 stands over IO1 or G1.
fn point_items(points: &[SPoint]) -> Vec<Item> {
    let lettered = points.len() <= MOST_LETTERS;
    let verticals = points.iter().map(|p| hair_line(vec![p.at, foot_of(p).1], false, Ink::Guide));
    let mut items: Vec<Item> = verticals.collect();
    for (number, point) in points.iter().enumerate() {
        let own = if point.kind == PointType::A { Ink::SPointA } else { Ink::SPointB };
        let (letter, foot, ink) = foot_of(point);
        items.push(Item::Dot { at: point.at, radius_px: POINT_PX, ink: own });
        items.push(Item::Dot { at: foot, radius_px: POINT_PX, ink });
        if lettered {
            let label = |at, letter| Item::Label {
                at,
                text: format!("{letter}{}", number + 1),
                anchor: Anchor::Beside,
            };
            items.extend([label(point.at, "S"), label(foot, letter)]);
        }
    }
    items
}

fn foot_of(point: &SPoint) -> (&'static str, DVec2, Ink) {
    match point.foot {
        Foot::Io(at) => ("IO", at, Ink::IoPoint),
        Foot::G(at) => ("G", at, Ink::GPoint),
    }
}
