//! Lines that fill an area: solid, or sparse in a pattern.

pub mod lines;

use crate::polygon::PolygonSet;
use crate::region::Bead;
use crate::region::{Path, Role};
use lines::Hatch;

/// How sparse infill is laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum InfillPattern {
    /// Lines in both diagonal directions on every layer.
    #[default]
    Grid,
    /// Lines in one diagonal direction, turned by 90 degrees from layer to layer.
    Lines,
}

crate::options! {
    /// What fills the part inside its walls and skins.
    pub struct InfillOptions {
        /// Share of the inside that is filled with material; 0 leaves it hollow, 1 makes it solid.
        density: f64 = 0.15, "Infill density", "", 0.0..=1.0;
        /// How the lines run.
        pattern: InfillPattern = InfillPattern::Grid, "Infill pattern";
    }
}

/// Shorter pieces of sparse infill hold nothing and only cost time, mm.
const SHORTEST_SPARSE_LINE: f64 = 0.8;

/// Fills `area` solidly, in the diagonal direction of this layer; returns the beads and what is too
/// narrow for them.
pub fn fill_solid(area: &PolygonSet, role: Role, bead: Bead, layer: u32) -> (Vec<Path>, PolygonSet) {
    lines::hatch_linked(area, role, bead, Hatch::diagonal(layer, bead.spacing()))
}

/// Fills `area` with lines that take up `options.density` of it.
pub fn fill_sparse(area: &PolygonSet, bead: Bead, layer: u32, options: &InfillOptions) -> Vec<Path> {
    if options.density <= 0.0 {
        return Vec::new();
    }
    let distance = bead.spacing() / options.density;
    let hatches = match options.pattern {
        InfillPattern::Lines => vec![Hatch::diagonal(layer, distance)],
        InfillPattern::Grid => vec![Hatch::diagonal(0, 2.0 * distance), Hatch::diagonal(1, 2.0 * distance)],
    };
    let pieces = hatches.into_iter().flat_map(|h| lines::hatch(area, h));
    let long = pieces.filter(|(a, b)| a.distance(*b) >= SHORTEST_SPARSE_LINE);
    long.map(|(a, b)| Path::open(Role::Infill, vec![a, b], bead.width)).collect()
}
