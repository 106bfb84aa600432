//! Layers for the G-code stage alone.

use foothold::gcode::LayerInput;
use foothold::region::Path;

/// Layer `index` of a print in layers of 0.2 mm.
pub fn layer(index: u32, paths: &[Path]) -> LayerInput<'_> {
    LayerInput {
        index,
        print_z: 0.2 + 0.2 * f64::from(index),
        height: 0.2,
        spiral: None,
        paths,
        ways: &[],
        own: &[],
    }
}
