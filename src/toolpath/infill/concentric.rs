//! Loops that follow the border, one inside the other.

use crate::polygon::{Contour, Join, PolygonSet};

/// Loops `distance` apart; the first is the border of `area` itself, so that walls hold it.
pub(super) fn loops(area: &PolygonSet, distance: f64) -> Vec<Contour> {
    let mut loops = Vec::new();
    let mut inside = area.clone();
    while !inside.is_empty() {
        let next = inside.offset(-distance, Join::WALL);
        loops.extend(inside.into_contours());
        inside = next;
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn loops_of_a_square_are_squares() {
        let square = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(40.0, 40.0));
        let lengths: Vec<f64> = loops(&square, 4.0).iter().map(|c| c.length().round()).collect();
        assert_eq!(lengths, [160.0, 128.0, 96.0, 64.0, 32.0]);
    }
}
