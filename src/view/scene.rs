//! What a layer or a plane looks like: strokes, areas and labels in mm.

use crate::gcode::read::{ReadLayer, Strand};
use crate::gcode::{BedShape, PrinterOptions};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet, dvec2, trig};
use crate::region::Role;

/// Colour by meaning; the painter knows what it looks like in light and dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// A bead of this role.
    Bead(Role),
    /// A bead whose role the G-code does not tell.
    UnknownBead,
    /// Moves without extrusion.
    Travel,
    /// The part's outline.
    Outline,
    /// The part's inside.
    Part,
    /// The border of the bed.
    Bed,
    /// Lines on the bed.
    Grid,
    /// Words.
    Text,
    /// A line that explains, such as from a vertex to where it moves; dashed.
    Guide,
    /// The rail of teeth.
    Rail,
    /// The sides of a tooth.
    Tooth,
    /// A tooth's tip in the part.
    Tip,
    /// A tooth's tip beside the part.
    TipOutside,
    /// From the outline to a tooth's tip: the bite.
    Bite,
    /// A vertex.
    Vertex,
    /// A vertex that simplification drops.
    DroppedVertex,
    /// A stretch that hangs.
    Hanging,
    /// What supports fill in a vertical plane, or in a layer.
    Held,
    /// What they would fill if every downward surface were held.
    HeldAtZero,
    /// A thin plate seen from the front.
    Sheet,
    /// The plane that is looked at.
    Plane,
    /// S-point of type A [Zhao].
    SPointA,
    /// S-point of type B [Zhao].
    SPointB,
    /// IO-point [Zhao].
    IoPoint,
    /// G-point [Zhao].
    GPoint,
    /// The layer above.
    Above,
    /// The permissible overhang of the layer below.
    Grown,
    /// One of the structures of supports; colours repeat after six.
    Structure(u8),
    /// A cell as dark as its number is large, 0 to 10.
    Share(u8),
    /// What is chosen.
    Chosen,
}

impl Ink {
    /// The colour as `#rrggbb` or `#rrggbbaa`. Roles have the colours that users of PrusaSlicer know, a
    /// little darker on light ground.
    pub const fn colour(self, dark: bool) -> &'static str {
        let (light, on_dark) = self.colours();
        if dark { on_dark } else { light }
    }

    const fn colours(self) -> (&'static str, &'static str) {
        match self {
            Ink::Bead(role) => (role_colour(role), role_colour(role)),
            Ink::UnknownBead => ("#8a8f98", "#8a8f98"),
            Ink::Travel => ("#5b8fd9", "#5b8fd9"),
            Ink::Outline | Ink::Text | Ink::Vertex => ("#202124", "#e8eaed"),
            Ink::Part => ("#dde3ea", "#3c4450"),
            Ink::Bed => ("#8c959f", "#7d8590"),
            Ink::Grid => ("#e2e6ea", "#2d333b"),
            Ink::Guide => ("#6b7480", "#9aa5b1"),
            Ink::Rail => ("#0b7d69", "#3fd0b4"),
            Ink::Tooth => ("#0fae93", "#1fbfa3"),
            Ink::Tip | Ink::GPoint => ("#1a56c4", "#7db1ff"),
            Ink::TipOutside | Ink::Hanging => ("#d1242f", "#ff7b72"),
            Ink::DroppedVertex => ("#d1242f", "#ff7b72"),
            Ink::Bite => ("#e36209", "#ffa657"),
            Ink::Held => ("#3fae4980", "#3fae4990"),
            Ink::HeldAtZero => ("#3fae492e", "#3fae4938"),
            Ink::Sheet => ("#2f9e4459", "#56d36466"),
            Ink::Plane | Ink::SPointA => ("#c2185b", "#ff7eb6"),
            Ink::SPointB => ("#8250df", "#d2a8ff"),
            Ink::IoPoint => ("#e36209", "#ffa657"),
            Ink::Above => ("#5b8fd966", "#79b0ff66"),
            Ink::Grown => ("#e3b50566", "#e3b50566"),
            Ink::Structure(index) => structure_colours(index),
            Ink::Share(tenths) => (share_colour(tenths), share_colour(tenths)),
            Ink::Chosen => ("#1a7f37", "#56d364"),
        }
    }

    /// Whether lines of this ink are dashed.
    pub const fn is_dashed(self) -> bool {
        matches!(self, Ink::Guide)
    }

    /// The word by which tests and style sheets find its things in an SVG picture.
    pub const fn name(self) -> &'static str {
        match self {
            Ink::Bead(role) => role.name(),
            Ink::UnknownBead => "unknown",
            Ink::Travel => "travel",
            Ink::Outline => "outline",
            Ink::Part => "part",
            Ink::Bed => "bed",
            Ink::Grid => "grid",
            Ink::Text => "text",
            Ink::Guide => "guide",
            Ink::Rail => "rail",
            Ink::Tooth => "tooth",
            Ink::Tip => "tip",
            Ink::TipOutside => "tip-outside",
            Ink::Bite => "bite",
            Ink::Vertex => "vertex",
            Ink::DroppedVertex => "dropped-vertex",
            Ink::Hanging => "hanging",
            Ink::Held => "held",
            Ink::HeldAtZero => "held-at-zero",
            Ink::Sheet => "sheet",
            Ink::Plane => "plane",
            Ink::SPointA => "s-point-a",
            Ink::SPointB => "s-point-b",
            Ink::IoPoint => "io-point",
            Ink::GPoint => "g-point",
            Ink::Above => "above",
            Ink::Grown => "grown",
            Ink::Structure(_) => "structure",
            Ink::Share(_) => "share",
            Ink::Chosen => "chosen",
        }
    }
}

const fn structure_colours(index: u8) -> (&'static str, &'static str) {
    match index % 6 {
        0 => ("#3fae49b3", "#3fae49b3"),
        1 => ("#5b8fd9b3", "#5b8fd9b3"),
        2 => ("#e3a008b3", "#e3b505b3"),
        3 => ("#c2185bb3", "#ff7eb6b3"),
        4 => ("#8250dfb3", "#d2a8ffb3"),
        _ => ("#0b8f78b3", "#3fd0b4b3"),
    }
}

/// From green for little to red for much.
const fn share_colour(tenths: u8) -> &'static str {
    match tenths {
        0 => "#2da44e80",
        1 => "#57ab5a80",
        2 => "#81b85080",
        3 => "#a9c14780",
        4 => "#cfc63f80",
        5 => "#e3b93980",
        6 => "#e8a13a80",
        7 => "#e9873b80",
        8 => "#e66d3c80",
        9 => "#e0523e80",
        _ => "#d9383f80",
    }
}

const fn role_colour(role: Role) -> &'static str {
    match role {
        Role::OuterWall => "#f47a3a",
        Role::InnerWall => "#e3b505",
        Role::OverhangWall => "#3b4cca",
        Role::GapFill => "#9aa5b1",
        Role::BottomSkin => "#8e5bc4",
        Role::TopSkin => "#e04343",
        Role::SolidInfill => "#a86fd0",
        Role::Infill => "#b5443c",
        Role::Bridge => "#4d80ba",
        Role::Ironing => "#ff8c69",
        Role::Skirt => "#0b8f78",
        Role::Brim => "#0b8f78",
        Role::Teeth => "#0fae93",
        Role::Raft => "#4a8f3c",
        Role::Support => "#3fae49",
        Role::SupportInterface => "#1d7a2b",
        Role::Prime => "#6f7f8f",
        Role::WipeTower => "#a3d9c9",
    }
}

/// How wide a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LineWidth {
    /// As wide as it is, mm.
    Mm(f64),
    /// A hair line of so many pixels, whatever the scale.
    Px(f64),
}

/// One thing to draw.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A line along points.
    Stroke {
        /// Corners, mm.
        points: Vec<DVec2>,
        /// Whether it returns to its first point.
        closed: bool,
        /// How wide.
        width: LineWidth,
        /// Colour.
        ink: Ink,
    },
    /// A filled area, holes left open.
    Area {
        /// The area, mm.
        area: PolygonSet,
        /// Colour.
        ink: Ink,
    },
    /// A round mark of the same size at every scale.
    Dot {
        /// Its middle, mm.
        at: DVec2,
        /// Radius, pixels.
        radius_px: f64,
        /// Colour.
        ink: Ink,
    },
    /// A letter or a number at a point.
    Label {
        /// The point, mm.
        at: DVec2,
        /// What is written.
        text: String,
        /// Which part of the text is at the point.
        anchor: Anchor,
    },
}

/// Where a label stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of its point and above, clear of a dot there.
    Beside,
    /// Around its point.
    Middle,
}

/// Things to draw, farthest first, and the box to show.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What to draw, in order.
    pub items: Vec<Item>,
    /// What to show when nothing is zoomed, mm.
    pub bounds: Bounds,
}

/// Free space around the things shown, mm.
const MARGIN: f64 = 3.0;

/// Distance of the lines on the bed, mm.
const BED_LINES: f64 = 10.0;

/// Corners of a round bed's border.
const BED_CORNERS: u32 = 96;

/// A corner of a polygon of [`BED_CORNERS`] corners in the unit circle.
fn on_circle(corner: u32) -> DVec2 {
    let (sin, cos) = trig::sin_cos(f64::from(corner) * std::f64::consts::TAU / f64::from(BED_CORNERS));
    dvec2(cos, sin)
}

impl Scene {
    /// A layer as its G-code says, on the printer's bed. `outline` is the section it was made from, where it
    /// is known.
    pub fn of_layer(layer: &ReadLayer, printer: &PrinterOptions, outline: Option<&PolygonSet>) -> Scene {
        let bed = printer.bed();
        let mut items = bed_items(bed, printer.bed_shape);
        let mut shown: Option<Bounds> = None;
        for strand in &layer.strands {
            let extent = Bounds::of_points(&strand.points);
            shown = shown.into_iter().chain(extent).reduce(Bounds::union);
            items.extend(strand_items(strand));
        }
        items.extend(outline.into_iter().flat_map(outline_items));
        Scene { items, bounds: shown.unwrap_or(bed).grown(MARGIN) }
    }
}

/// The strand as strokes, each as wide as its segments.
fn strand_items(strand: &Strand) -> Vec<Item> {
    let ink = strand.role.map_or(Ink::UnknownBead, Ink::Bead);
    let mut items = Vec::new();
    let mut first = 0;
    for run in strand.segments.chunk_by(|a, b| a.width == b.width) {
        let points = strand.points[first..=first + run.len()].to_vec();
        items.push(Item::Stroke { points, closed: false, width: LineWidth::Mm(run[0].width), ink });
        first += run.len();
    }
    items
}

fn outline_items(area: &PolygonSet) -> Vec<Item> {
    let stroke = |points: Vec<DVec2>| Item::Stroke {
        points,
        closed: true,
        width: LineWidth::Px(1.0),
        ink: Ink::Outline,
    };
    area.contours().iter().map(|c| stroke(c.points.clone())).collect()
}

/// The bed's border and a line every centimetre.
fn bed_items(bed: Bounds, shape: BedShape) -> Vec<Item> {
    let line = |a: DVec2, b: DVec2| Item::Stroke {
        points: vec![a, b],
        closed: false,
        width: LineWidth::Px(1.0),
        ink: Ink::Grid,
    };
    let steps = |low: f64, high: f64| {
        let count = ((high - low) / BED_LINES).ceil() as usize;
        (1..count).map(move |i| low + i as f64 * BED_LINES)
    };
    let (centre, half) = (bed.centre(), bed.size() / 2.0);
    // How far a line reaches that is this share of the bed's half away from the middle.
    let reach = |share: f64| match shape {
        BedShape::Rectangle => 1.0,
        BedShape::Round => (1.0 - share * share).max(0.0).sqrt(),
    };
    let upright = steps(bed.min.x, bed.max.x).map(|x| {
        let y = half.y * reach((x - centre.x) / half.x);
        line(dvec2(x, centre.y - y), dvec2(x, centre.y + y))
    });
    let level = steps(bed.min.y, bed.max.y).map(|y| {
        let x = half.x * reach((y - centre.y) / half.y);
        line(dvec2(centre.x - x, y), dvec2(centre.x + x, y))
    });
    let corners = match shape {
        BedShape::Rectangle => {
            vec![bed.min, dvec2(bed.max.x, bed.min.y), bed.max, dvec2(bed.min.x, bed.max.y)]
        }
        BedShape::Round => (0..BED_CORNERS).map(|k| centre + half * on_circle(k)).collect(),
    };
    let border = Item::Stroke { points: corners, closed: true, width: LineWidth::Px(1.5), ink: Ink::Bed };
    upright.chain(level).chain([border]).collect()
}
