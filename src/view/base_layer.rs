//! Pictures of what holds a part on the bed.

use super::scene::{Ink, Item, LineWidth, Scene};
use crate::adhesion::{TeethDrawing, Tooth};
use crate::pipeline::{Alternative, Alternatives};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet};
use crate::region::{Path, Width};

/// Radius of the mark on a tip, pixels.
const TIP_PX: f64 = 2.5;

/// Free space around base layers, mm.
const MARGIN_MM: f64 = 2.0;

/// The outline that teeth are measured to, the rail, and each tooth's tip and bite.
pub fn teeth_items(drawing: &TeethDrawing) -> Vec<Item> {
    let mut items = outline_strokes(&drawing.outline, Ink::Outline, 1.5);
    items.extend(drawing.rails.iter().map(|rail| hair_line(rail.clone(), true, Ink::Rail)));
    items.extend(drawing.teeth.iter().flat_map(tooth_marks));
    items
}

/// What the marks of [`teeth_items`] mean, in the words of the Learn view.
pub(super) fn teeth_key(drawing: &TeethDrawing) -> Vec<(Ink, &'static str)> {
    let all = [
        (Ink::Outline, "outline as printed"),
        (Ink::Rail, "rail"),
        (Ink::Tip, "tip of a tooth"),
        (Ink::TipOutside, "tip beside the part"),
        (Ink::Bite, "bite"),
    ];
    let beside = drawing.teeth.iter().any(|tooth| tooth.bite <= 0.0);
    all.into_iter().filter(|(ink, _)| *ink != Ink::TipOutside || beside).collect()
}

/// The bite, from the outline to the tip, and the tip.
pub(super) fn tooth_marks(tooth: &Tooth) -> [Item; 2] {
    let ink = if tooth.bite > 0.0 { Ink::Tip } else { Ink::TipOutside };
    [
        hair_line(vec![tooth.foot, tooth.tip], false, Ink::Bite),
        Item::Dot { at: tooth.tip, radius_px: TIP_PX, ink },
    ]
}

/// A thin line.
pub(super) fn hair_line(points: Vec<DVec2>, closed: bool, ink: Ink) -> Item {
    Item::Stroke { points, closed, width: LineWidth::Px(1.2), ink }
}

/// The borders of an area.
pub(super) fn outline_strokes(area: &PolygonSet, ink: Ink, width_px: f64) -> Vec<Item> {
    let stroke =
        |points: Vec<DVec2>| Item::Stroke { points, closed: true, width: LineWidth::Px(width_px), ink };
    area.contours().iter().map(|c| stroke(c.points.clone())).collect()
}

/// A bead of one width.
pub(super) fn bead(path: &Path) -> Item {
    let width = match &path.width {
        Width::Uniform(width) => *width,
        Width::Varying(widths) => widths.first().copied().unwrap_or_default(),
    };
    let (points, closed) = (path.points.clone(), path.closed);
    Item::Stroke { points, closed, width: LineWidth::Mm(width), ink: Ink::Bead(path.role) }
}

impl Scene {
    /// One picture for each kind, all at one scale: the part's first layer and what is laid beside or
    /// below it.
    pub fn of_alternatives(alternatives: &Alternatives) -> Vec<Scene> {
        let extents = alternatives.kinds.iter().filter_map(extent);
        let empty = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        let bounds = extents.reduce(Bounds::union).unwrap_or(empty).grown(MARGIN_MM);
        alternatives.kinds.iter().map(|kind| Scene { items: items_of(kind), bounds }).collect()
    }
}

/// The part on its raft, or the part with beads beside it and teeth in it.
fn items_of(kind: &Alternative) -> Vec<Item> {
    let mut part = vec![Item::Area { area: kind.outline.clone(), ink: Ink::Part }];
    part.extend(outline_strokes(&kind.outline, Ink::Outline, 1.0));
    let beads: Vec<Item> = lowest_beads(kind).iter().map(bead).collect();
    let [below, above] = if kind.foundation.raft.is_empty() { [part, beads] } else { [beads, part] };
    let teeth = kind.foundation.drawing.iter().flat_map(|d| &d.teeth);
    below.into_iter().chain(above).chain(teeth.flat_map(tooth_marks)).collect()
}

fn lowest_beads(kind: &Alternative) -> &[Path] {
    let raft = kind.foundation.raft.first().map(|layer| layer.paths.as_slice());
    raft.or(kind.foundation.layers.first().map(Vec::as_slice)).unwrap_or_default()
}

fn extent(kind: &Alternative) -> Option<Bounds> {
    let beads = Bounds::of_points(lowest_beads(kind).iter().flat_map(|p| &p.points));
    kind.outline.bounds().into_iter().chain(beads).reduce(Bounds::union)
}
