//! Moves without extrusion: on which way, and whether it crosses an outline of the part.

use crate::polygon::DVec2;

/// The way from the end of one path to the start of the next.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Way {
    /// Points on the way, its ends left out; empty for the straight way.
    pub via: Vec<DVec2>,
    /// Whether the way crosses an outline of the part. Filament is pulled back on such ways only,
    /// elsewhere what oozes stays inside.
    pub crosses_outline: bool,
}

impl Way {
    /// The straight way across an outline.
    pub const ACROSS: Way = Way { via: Vec::new(), crosses_outline: true };
}
