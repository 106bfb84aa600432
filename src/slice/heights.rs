//! The layer plan: where each layer is cut and printed.

use serde::{Deserialize, Serialize};

use super::adaptive::plan_adaptive;
use crate::mesh::Mesh;

crate::options! {
    /// Heights of the layers.
    pub struct LayerOptions {
        /// Height of every layer but the first.
        height: f64 = 0.2, "Layer height", "mm", 0.01..=2.0;
        /// Height of the first layer; a thicker one forgives an uneven bed.
        first_height: f64 = 0.2, "First layer height", "mm", 0.01..=2.0;
        /// Chooses the height of each layer above the first by the slope of the surface beside it, between
        /// `min_height` and `max_height`; `height` then counts no more.
        adaptive: bool = false, "Adaptive layer heights";
        /// Lowest layer chosen.
        min_height: f64 = 0.08, "Lowest layer", "mm", 0.01..=2.0;
        /// Highest layer chosen; three quarters of the nozzle's diameter is as much as it lays well.
        max_height: f64 = 0.28, "Highest layer", "mm", 0.01..=2.0;
        /// How far the outlines of neighbouring layers may be apart on a slope: the width of its stairs.
        /// Less gives finer layers.
        adaptive_threshold: f64 = 0.2, "Width of stairs", "mm", 0.01..=10.0;
        /// By how much neighbouring layers may differ.
        max_height_change: f64 = 0.04, "Change from layer to layer", "mm", 0.01..=2.0;
        /// Prints the part as a vase: above its bottom layers one wall that rises all the time, without a
        /// seam, infill or top.
        spiral_vase: bool = false, "Spiral vase";
    }
}

/// Where one layer is cut and printed, mm above the bed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LayerSpec {
    /// Counted from 0 at the bed.
    pub index: u32,
    /// Plane of the cut: half-way up the layer.
    pub slice_z: f64,
    /// Height of the nozzle: the layer's top.
    pub print_z: f64,
    /// Thickness of the layer.
    pub height: f64,
}

/// Layers of a part that stands on the bed and is `part_height` mm tall, with heights by its surface if
/// `options.adaptive`.
pub fn plan_layers_of(mesh: &Mesh, part_height: f64, options: &LayerOptions) -> Vec<LayerSpec> {
    if options.adaptive {
        plan_adaptive(mesh, part_height, options)
    } else {
        plan_layers(part_height, options)
    }
}

/// Layers of equal height of a part that is `part_height` mm tall and stands on the bed. The topmost layer is the
/// last one whose middle lies below the part's top; a part thinner than half the first layer
/// still gets one, cut at half its own height.
pub fn plan_layers(part_height: f64, options: &LayerOptions) -> Vec<LayerSpec> {
    let LayerOptions { height, first_height, .. } = *options;
    let first = LayerSpec {
        index: 0,
        slice_z: first_height.min(part_height) / 2.0,
        print_z: first_height,
        height: first_height,
    };
    let upper = (1u32..).map(|index| {
        let print_z = first_height + f64::from(index) * height;
        LayerSpec { index, slice_z: print_z - height / 2.0, print_z, height }
    });
    std::iter::once(first).chain(upper.take_while(|l| l.slice_z < part_height)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_20_mm_cube_has_100_layers_cut_at_their_middles() {
        let layers = plan_layers(20.0, &LayerOptions::default());
        assert_eq!(layers.len(), 100);
        assert!((layers[0].slice_z - 0.1).abs() < 1e-12);
        assert!((layers[99].slice_z - 19.9).abs() < 1e-9);
        assert!((layers[99].print_z - 20.0).abs() < 1e-9);
    }

    #[test]
    fn the_last_half_layer_is_printed_only_when_its_middle_is_in_the_part() {
        let count = |height| plan_layers(height, &LayerOptions::default()).len();
        assert_eq!(count(0.29), 1);
        assert_eq!(count(0.31), 2);
        assert_eq!(count(0.05), 1);
    }
}
