//! What a layer or a plane looks like: strokes, areas and labels in mm.

use crate::gcode::read::{ReadLayer, Strand};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet, dvec2};
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
}

impl Ink {
    /// The colour as `#rrggbb`. Roles have the colours that users of PrusaSlicer know, a little
    /// darker on light ground.
    pub const fn colour(self, dark: bool) -> &'static str {
        match self {
            Ink::Bead(role) => role_colour(role),
            Ink::UnknownBead => "#8a8f98",
            Ink::Travel => "#5b8fd9",
            Ink::Outline => {
                if dark {
                    "#e8eaed"
                } else {
                    "#202124"
                }
            }
            Ink::Part => {
                if dark {
                    "#3c4450"
                } else {
                    "#dde3ea"
                }
            }
            Ink::Bed => {
                if dark {
                    "#7d8590"
                } else {
                    "#8c959f"
                }
            }
            Ink::Grid => {
                if dark {
                    "#2d333b"
                } else {
                    "#e2e6ea"
                }
            }
            Ink::Text => {
                if dark {
                    "#e8eaed"
                } else {
                    "#202124"
                }
            }
        }
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
    /// A few words beside a point.
    Label {
        /// Where the words start, mm.
        at: DVec2,
        /// The words.
        text: String,
    },
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

impl Scene {
    /// A layer as its G-code says, on the bed. `outline` is the section it was made from, where it
    /// is known.
    pub fn of_layer(layer: &ReadLayer, bed: Bounds, outline: Option<&PolygonSet>) -> Scene {
        let mut items = bed_items(bed);
        let mut shown: Option<Bounds> = None;
        for strand in &layer.strands {
            let extent = Bounds::of_points(&strand.points);
            shown = shown.into_iter().chain(extent).reduce(Bounds::union);
            items.extend(strand_items(strand));
        }
        items.extend(outline.into_iter().flat_map(outline_items));
        Scene { items, bounds: shown.unwrap_or(bed).grown(MARGIN) }
    }

    /// A section of the part, such as a vertical plane.
    pub fn of_section(area: &PolygonSet) -> Scene {
        let mut items = vec![Item::Area { area: area.clone(), ink: Ink::Part }];
        items.extend(outline_items(area));
        let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        Scene { items, bounds: area.bounds().unwrap_or(nothing).grown(MARGIN) }
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
fn bed_items(bed: Bounds) -> Vec<Item> {
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
    let upright = steps(bed.min.x, bed.max.x).map(|x| line(dvec2(x, bed.min.y), dvec2(x, bed.max.y)));
    let level = steps(bed.min.y, bed.max.y).map(|y| line(dvec2(bed.min.x, y), dvec2(bed.max.x, y)));
    let corners = vec![bed.min, dvec2(bed.max.x, bed.min.y), bed.max, dvec2(bed.min.x, bed.max.y)];
    let border = Item::Stroke { points: corners, closed: true, width: LineWidth::Px(1.5), ink: Ink::Bed };
    upright.chain(level).chain([border]).collect()
}
