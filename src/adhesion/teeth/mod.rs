//! Brim teeth [Lv 2022]: a rail around the outline with teeth that bite into it.

use crate::polygon::{DVec2, PolygonSet};
use crate::region::Path;

/// One tooth: the path leaves the rail at `a`, turns at `tip` and returns to the rail at `b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tooth {
    /// Where the path leaves the rail (A_i of eq. 15).
    pub a: DVec2,
    /// Where it turns, inside the part (C_i of eq. 17).
    pub tip: DVec2,
    /// Where it returns to the rail (B_i of eq. 16).
    pub b: DVec2,
    /// Where the tooth's axis meets the outline.
    pub foot: DVec2,
    /// Depth of the tip in the part, mm: its distance from the outline; negative outside.
    pub bite: f64,
    /// Whether the part is thinner than twice the bite asked for, so that this tooth bites less.
    pub shallow: bool,
}

/// What the layer canvas and the Learn view draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TeethDrawing {
    /// The printed outline that everything is measured to (supports included).
    pub outline: PolygonSet,
    /// The rails without teeth.
    pub rails: Vec<Path>,
    /// All teeth.
    pub teeth: Vec<Tooth>,
}
