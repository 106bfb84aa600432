//! Bead volume to filament length.

use super::FILAMENT_STEPS;
use std::f64::consts::PI;

/// Cross-section of the filament, mm2, from its diameter in mm.
pub fn filament_area(diameter: f64) -> f64 {
    PI * diameter * diameter / 4.0
}

/// Turns volumes into filament in the text's steps of 1e-5 mm. What rounding takes from one segment
/// is given to the next, so that a sum is never off by more than half a step.
#[derive(Debug)]
pub(crate) struct Feeder {
    steps_per_mm3: f64,
    /// Filament owed to the next segment, in steps; at most half a step either way.
    owed: f64,
}

impl Feeder {
    /// A feeder for filament of this diameter, mm.
    pub(crate) fn new(diameter: f64) -> Feeder {
        Feeder { steps_per_mm3: FILAMENT_STEPS / filament_area(diameter), owed: 0.0 }
    }

    /// Steps of filament for a volume in mm3.
    pub(crate) fn filament(&mut self, volume: f64) -> i32 {
        let exact = volume * self.steps_per_mm3 + self.owed;
        let steps = exact.round();
        self.owed = exact - steps;
        steps as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::Bead;

    #[test]
    fn a_hundred_mm_of_the_usual_bead_needs_3_38488_mm_of_filament() {
        // Area (0.45 - 0.2) 0.2 + pi 0.04 / 4 = 0.05 + 0.0314159 = 0.0814159 mm2; times 100 mm and
        // over the filament's pi 1.75^2 / 4 = 2.4052819 mm2 that is 3.38488 mm.
        assert!((Bead { width: 0.45, height: 0.2 }.area() - 0.081_415_926_5).abs() < 1e-10);
        assert!((filament_area(1.75) - 2.405_281_9).abs() < 1e-7);
        assert_eq!(Feeder::new(1.75).filament(Bead { width: 0.45, height: 0.2 }.area() * 100.0), 338_488);
    }

    #[test]
    fn a_thousand_short_segments_add_up_to_one_long_one() {
        let mut feeder = Feeder::new(1.75);
        let volume = Bead { width: 0.45, height: 0.2 }.area() * 0.1;
        let sum: i32 = (0..1000).map(|_| feeder.filament(volume)).sum();
        assert!((sum - 338_488).abs() <= 1, "{sum}");
    }
}
