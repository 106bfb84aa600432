//! The cross-section of an extruded line.

use std::f64::consts::PI;

/// An extruded line: a rectangle with half-round sides, `width` by `height` mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bead {
    /// Width from side to side, mm.
    pub width: f64,
    /// Height: the layer's, mm.
    pub height: f64,
}

impl Bead {
    /// Area of the cross-section, mm2: (w - h) h + pi h^2 / 4.
    pub fn area(self) -> f64 {
        (self.width - self.height) * self.height + PI * self.height * self.height / 4.0
    }

    /// Distance between the centre lines of neighbouring beads at which their material exactly
    /// fills the layer: area / height.
    pub fn spacing(self) -> f64 {
        self.area() / self.height
    }

    /// By how much a bead is wider than the strip between neighbours that it exactly fills, mm: the
    /// round sides overlap by h (1 - pi / 4).
    pub fn overlap(self) -> f64 {
        self.width - self.spacing()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacing_is_narrower_than_the_bead_by_what_the_round_sides_leave_open() {
        let bead = Bead { width: 0.45, height: 0.2 };
        assert!((bead.area() - 0.081_415_926_5).abs() < 1e-9);
        assert!((bead.spacing() - 0.407_079_632_7).abs() < 1e-9);
    }
}
