//! A second pass over top skins: fine lines that lay hardly any plastic and melt the ridges flat.

use super::infill::fill_solid;
use crate::polygon::{Join, PolygonSet};
use crate::region::{Bead, Path, Role};

crate::options! {
    /// Smoothing of top skins by the hot nozzle.
    pub struct IroningOptions {
        /// Irons every top skin.
        enabled: bool = false, "Ironing";
        /// Plastic laid, as a share of what would fill the layer once more.
        flow: f64 = 0.15, "Ironing flow", "", 0.01..=1.0;
        /// Distance between lines.
        spacing: f64 = 0.1, "Ironing spacing", "mm", 0.02..=2.0;
        /// How far from the skin's border the lines stay.
        inset: f64 = 0.1, "Ironing inset", "mm", 0.0..=10.0;
    }
}

/// Lines over a top skin, across those of the skin's own layer.
///
/// They are beads of `flow` times the layer's height, `spacing` apart: exactly that share of plastic.
pub fn iron(skin: &PolygonSet, height: f64, layer: u32, options: &IroningOptions) -> Vec<Path> {
    let height = height * options.flow;
    let round = Bead { width: options.spacing, height }.overlap();
    let bead = Bead { width: options.spacing + round, height };
    let area = skin.offset(-options.inset, Join::WALL);
    fill_solid(&area, Role::Ironing, bead, layer + 1).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn a_square_gets_its_share_of_plastic() {
        let options = IroningOptions { inset: 0.0, ..IroningOptions::default() };
        let skin = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0));
        let lines = iron(&skin, 0.2, 4, &options);
        // 0.15 of 20 x 20 x 0.2 mm3 are 12 mm3: lines 0.1 mm apart are 4000 mm long in all.
        let length: f64 = lines.iter().map(Path::length).sum();
        assert!((length - 4000.0).abs() < 0.03 * 4000.0, "{length}");
        let volume: f64 =
            lines.iter().map(|p| p.length() * Bead { width: p.width.at(0), height: 0.03 }.area()).sum();
        assert!((volume - 12.0).abs() < 0.03 * 12.0, "{volume}");
        assert!(lines.iter().all(|p| p.role == Role::Ironing));
    }
}
