//! A simple prime tower: square loops on which a tool that takes over is purged before it goes on.

use crate::polygon::{DVec2, dvec2};
use crate::region::{Bead, Path, Role};

crate::options! {
    /// Where a tool that takes over is purged.
    pub struct PrimeTowerOptions {
        /// Side of the square tower.
        size: f64 = 20.0, "Prime tower size", "mm", 5.0..=200.0;
        /// Least plastic that each change of tools leaves on the tower, as far as it holds it.
        min_volume: f64 = 15.0, "Purged volume", "mm3", 0.0..=1000.0;
        /// Width of its beads.
        line_width: f64 = 0.45, "Line width", "mm", 0.1..=2.0;
        /// Width of the brim around its first layer.
        brim_width: f64 = 3.0, "Brim", "mm", 0.0..=20.0;
    }
}

/// Fewer loops than this make no tower that stands.
const FEWEST_LOOPS: usize = 2;

/// The loops of one layer of a tower, from inside out, whose lower left corner is `corner`: as many
/// as the volume asks for at the height of ordinary layers, `layer_height` mm, so that all layers
/// stand on each other. On the bed (`has_brim`) more loops follow around it.
pub fn tower_loops(
    corner: DVec2,
    options: &PrimeTowerOptions,
    layer_height: f64,
    has_brim: bool,
) -> Vec<Path> {
    let bead = Bead { width: options.line_width, height: layer_height };
    let spacing = bead.spacing();
    let side = |inset: f64| options.size - options.line_width - 2.0 * inset;
    let mut insets = Vec::new();
    let mut volume = 0.0;
    for inset in (0..).map(|i| f64::from(i) * spacing).take_while(|&inset| side(inset) > spacing) {
        if volume >= options.min_volume && insets.len() >= FEWEST_LOOPS {
            break;
        }
        volume += 4.0 * side(inset) * bead.area();
        insets.push(inset);
    }
    insets.reverse();
    if has_brim {
        let count = (options.brim_width / spacing).floor() as u32;
        insets.extend((1..=count).map(|i| -f64::from(i) * spacing));
    }
    let square = |inset: f64| {
        let low = corner + options.line_width / 2.0 + inset;
        let high = low + side(inset);
        let points = vec![low, dvec2(high.x, low.y), high, dvec2(low.x, high.y)];
        Path::closed(Role::WipeTower, points, options.line_width)
    };
    insets.into_iter().map(square).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tower_takes_the_volume_and_stays_within_its_square() {
        let options = PrimeTowerOptions::default();
        let loops = tower_loops(dvec2(5.0, 7.0), &options, 0.2, false);
        // 4 x 19.55 x 0.0814 = 6.4 mm3 in the outermost loop: three are needed for 15.
        assert_eq!(loops.len(), 3);
        let area = Bead { width: 0.45, height: 0.2 }.area();
        assert!(loops.iter().map(Path::length).sum::<f64>() * area >= 15.0);
        let points = || loops.iter().flat_map(|l| &l.points);
        assert!(points().all(|p| p.x >= 5.225 - 1e-9 && p.x <= 24.775 + 1e-9 && p.y >= 7.225 - 1e-9));
        let with_brim = tower_loops(dvec2(5.0, 7.0), &options, 0.2, true);
        assert_eq!(with_brim.len(), 3 + 7);
        // More than fits fills the square.
        let full = PrimeTowerOptions { min_volume: 1000.0, ..options };
        let loops = tower_loops(DVec2::ZERO, &full, 0.2, false);
        let filled = loops.iter().map(Path::length).sum::<f64>() * area;
        assert!((filled / (400.0 * 0.2) - 1.0).abs() < 0.02, "{filled}");
    }
}
