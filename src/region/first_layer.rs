//! The first layer is squeezed against the bed; its outline is drawn in to make up for it.

use crate::polygon::{Join, PolygonSet};

crate::options! {
    /// What is different on the first layer.
    pub struct FirstLayerOptions {
        /// Line width on the first layer; wider lines hold better.
        line_width: f64 = 0.5, "First layer line width", "mm", 0.1..=2.0;
        /// Speed of everything that is printed on the first layer.
        speed: f64 = 25.0, "First layer speed", "mm/s", 1.0..=1000.0;
        /// By how much the first layer's outline is drawn in, because the bed squeezes it out.
        elephant_foot: f64 = 0.15, "Elephant foot compensation", "mm", 0.0..=2.0;
    }
}

/// The outline drawn in by `options.elephant_foot`; where that would leave less than one line's
/// width the part keeps its outline.
pub fn draw_in(outline: &PolygonSet, options: &FirstLayerOptions) -> PolygonSet {
    let FirstLayerOptions { line_width, elephant_foot, .. } = *options;
    if elephant_foot == 0.0 {
        return outline.clone();
    }
    let core = outline.offset(-elephant_foot - line_width / 2.0, Join::WALL);
    let drawn_in = core.offset(line_width / 2.0, Join::WALL);
    let reached = core.offset(elephant_foot + line_width / 2.0, Join::WALL);
    // Slivers at rounded corners are no thin places.
    let thin = outline.difference(&reached).opened(line_width / 8.0, Join::WALL);
    drawn_in.union(&thin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn a_plate_is_drawn_in_and_a_thin_wall_is_kept() {
        let options = FirstLayerOptions::default();
        let plate = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0));
        assert!((draw_in(&plate, &options).area() - 19.7 * 19.7).abs() < 1e-3);
        let wall = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 0.6));
        assert!((draw_in(&wall, &options).area() - 12.0).abs() < 1e-3);
    }
}
