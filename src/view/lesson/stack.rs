//! Layers and sheets piled up and seen from the corner.

use glam::{DVec3, dvec3};

use crate::picture::Viewpoint;
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2, PolygonSet, dvec2};
use crate::slice::Axis;
use crate::view::base_layer::outline_strokes;
use crate::view::scene::{Ink, Item, Scene};

/// At most so many layers of a part are drawn.
const MOST_LAYERS: usize = 48;

/// Outlines may move by this in a picture, mm.
const TOLERANCE_MM: f64 = 0.05;

/// Free space around the pile, mm.
const MARGIN_MM: f64 = 3.0;

/// A picture made from below to above.
pub(super) struct Stack {
    right: DVec3,
    up: DVec3,
    items: Vec<Item>,
    extent: Option<Bounds>,
}

impl Stack {
    pub(super) fn new() -> Stack {
        let [right, up, _] = Viewpoint::Iso.frame();
        Stack { right, up, items: Vec::new(), extent: None }
    }

    fn seen(&self, p: DVec3) -> DVec2 {
        dvec2(p.dot(self.right), p.dot(self.up))
    }

    fn add(&mut self, area: &PolygonSet, ink: Ink, border: bool, lift: impl Fn(DVec2) -> DVec3) {
        let simple = area.roughened(TOLERANCE_MM);
        let shown = |c: &Contour| Contour::new(c.points.iter().map(|&p| self.seen(lift(p))).collect());
        let flat = PolygonSet::canonical(simple.contours().iter().map(shown).collect());
        self.extent = self.extent.into_iter().chain(flat.bounds()).reduce(Bounds::union);
        let strokes = if border { outline_strokes(&flat, Ink::Bed, 0.6) } else { Vec::new() };
        self.items.push(Item::Area { area: flat, ink });
        self.items.extend(strokes);
    }

    /// A level area at height z.
    pub(super) fn level(&mut self, area: &PolygonSet, z: f64, ink: Ink) {
        self.add(area, ink, true, |p| dvec3(p.x, p.y, z));
    }

    /// An upright area.
    pub(super) fn upright(&mut self, area: &PolygonSet, axis: Axis, at: f64, ink: Ink) {
        self.add(area, ink, true, |p| match axis {
            Axis::X => dvec3(at, p.x, p.y),
            Axis::Y | Axis::Z => dvec3(p.x, at, p.y),
        });
    }

    pub(super) fn into_scene(self) -> Scene {
        let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        Scene { items: self.items, bounds: self.extent.unwrap_or(nothing).grown(MARGIN_MM) }
    }
}

/// Indices of the layers to draw among `count`, the lowest first.
pub(super) fn shown(count: usize) -> impl DoubleEndedIterator<Item = usize> {
    (0..count).step_by(count.div_ceil(MOST_LAYERS).max(1))
}
