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
    /// Area of the cross-section, mm2: (w - h) h + pi h^2 / 4. A bead narrower than high can't be that
    /// shape; it is taken as an ellipse, pi w h / 4, which meets the other at w = h and vanishes with
    /// the width. Negative sizes count as 0.
    pub fn area(self) -> f64 {
        let (w, h) = (self.width.max(0.0), self.height.max(0.0));
        if w >= h { (w - h) * h + PI * h * h / 4.0 } else { PI * w * h / 4.0 }
    }

    /// Distance between the centre lines of neighbouring beads at which their material exactly
    /// fills the layer: area / height.
    pub fn spacing(self) -> f64 {
        self.area() / self.height
    }

    /// The bead of the same height with this share of the plastic.
    pub fn with_flow(self, share: f64) -> Bead {
        let round = PI * self.height * self.height / 4.0;
        let area = self.area() * share;
        let width = if area >= round {
            (area - round) / self.height + self.height
        } else {
            self.height * area / round
        };
        Bead { width, ..self }
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
    fn a_bead_as_wide_as_high_is_a_circle_and_narrower_ones_shrink_to_nothing() {
        let area = |width: f64| Bead { width, height: 0.2 }.area();
        assert!((area(0.2) - PI * 0.01).abs() < 1e-15);
        assert!((area(0.2 - 1e-12) - PI * 0.01).abs() < 1e-12);
        assert_eq!((area(0.0), area(-1.0)), (0.0, 0.0));
    }

    #[test]
    fn flow_changes_the_area_by_its_share() {
        let bead = Bead { width: 0.45, height: 0.2 };
        for share in [0.1, 0.5, 0.95, 1.0, 2.0] {
            assert!((bead.with_flow(share).area() - share * bead.area()).abs() < 1e-12, "{share}");
        }
    }

    #[test]
    fn spacing_is_narrower_than_the_bead_by_what_the_round_sides_leave_open() {
        let bead = Bead { width: 0.45, height: 0.2 };
        assert!((bead.area() - 0.081_415_926_5).abs() < 1e-9);
        assert!((bead.spacing() - 0.407_079_632_7).abs() < 1e-9);
    }
}
