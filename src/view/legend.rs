//! What the colours of a layer mean.

use std::collections::BTreeMap;

use serde::Serialize;

use super::scene::Ink;
use crate::gcode::read::{ReadLayer, Strand};
use crate::region::Role;

/// One colour of a layer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LegendEntry {
    /// The role's name, as in the report; empty where the G-code does not tell.
    pub role: &'static str,
    /// Colour as `#rrggbb`.
    pub color: &'static str,
    /// Length of beads, mm.
    pub length_mm: f64,
}

/// The roles of a layer's beads in the order of the report.
pub fn legend(layer: &ReadLayer) -> Vec<LegendEntry> {
    let mut lengths: BTreeMap<Option<Role>, f64> = BTreeMap::new();
    for strand in &layer.strands {
        *lengths.entry(strand.role).or_default() += length(strand);
    }
    let entry = |(role, length_mm): (Option<Role>, f64)| LegendEntry {
        role: role.map_or("", Role::name),
        color: role.map_or(Ink::UnknownBead, Ink::Bead).colour(false),
        length_mm,
    };
    lengths.into_iter().map(entry).collect()
}

fn length(strand: &Strand) -> f64 {
    strand.points.windows(2).map(|w| w[0].distance(w[1])).sum()
}
