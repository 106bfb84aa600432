//! What the colours of a layer mean.

use std::collections::BTreeMap;

use serde::Serialize;

use super::scene::{Anchor, Ink, Item, Scene};
use super::svg::{BESIDE_PX, Paper, TEXT_PX};
use crate::gcode::read::{ReadLayer, Strand};
use crate::polygon::dvec2;
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

/// Height of a line of the key, pixels.
const LINE_PX: f64 = 24.0;

/// Radius of a dot in the key, pixels.
const DOT_PX: f64 = 5.0;

/// Room for a letter of the key, pixels.
const LETTER_PX: f64 = 0.55 * TEXT_PX;

/// Room for the dot before words and the gap behind them, pixels.
const AROUND_PX: f64 = 40.0;

impl Scene {
    /// The scene with lines below it that say what inks mean, for a picture on `paper`.
    #[must_use]
    pub fn with_key(mut self, key: &[(Ink, &str)], paper: Paper) -> Scene {
        let size = self.bounds.size();
        let width_px = paper.side_px * size.x / size.max_element();
        let places = key_places(key, width_px);
        let lines = places.last().map_or(0, |place| place.0 + 1);
        let share = f64::from(lines) * LINE_PX / paper.side_px;
        // The longer side takes all of the paper's; the lines may make the height the longer one.
        let is_wide = size.x >= size.y + share * size.x;
        let height = if is_wide { share * size.x } else { size.y * share / (1.0 - share) };
        let mm = size.x.max(size.y + height) / paper.side_px;
        self.bounds.min.y -= height;
        let (left, top) = (self.bounds.min.x, self.bounds.min.y + height);
        for (&(ink, word), (line, at_px)) in key.iter().zip(places) {
            let at = dvec2(left, top) + dvec2(at_px + 2.0 * DOT_PX, -(f64::from(line) + 0.5) * LINE_PX) * mm;
            self.items.push(Item::Dot { at, radius_px: DOT_PX, ink });
            // Beside its point a label stands above it; this one stands level with the dot.
            let level = at + dvec2(BESIDE_PX, -BESIDE_PX - TEXT_PX / 3.0) * mm;
            self.items.push(Item::Label { at: level, text: word.to_owned(), anchor: Anchor::Beside });
        }
        self
    }
}

/// Line and left end, pixels, of each word of a key in a picture of this width.
fn key_places(key: &[(Ink, &str)], width_px: f64) -> Vec<(u32, f64)> {
    let (mut line, mut end) = (0, 0.0);
    let mut place = |(_, word): &(Ink, &str)| {
        let room = AROUND_PX + LETTER_PX * word.chars().count() as f64;
        if end > 0.0 && end + room > width_px {
            (line, end) = (line + 1, 0.0);
        }
        end += room;
        (line, end - room)
    };
    key.iter().map(&mut place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::DVec2;
    use crate::polygon::measure::Bounds;

    fn keyed(size: DVec2) -> Scene {
        let scene = Scene { items: Vec::new(), bounds: Bounds { min: DVec2::ZERO, max: size } };
        scene.with_key(&[(Ink::Rail, "rail"), (Ink::Bite, "bite")], Paper::FILE)
    }

    #[test]
    fn a_key_stands_below_the_picture_and_in_it() {
        for size in [dvec2(40.0, 10.0), dvec2(10.0, 40.0), dvec2(20.0, 19.9)] {
            let scene = keyed(size);
            assert_eq!(scene.bounds.max, size);
            let dots: Vec<DVec2> = scene
                .items
                .iter()
                .filter_map(|i| if let Item::Dot { at, .. } = i { Some(*at) } else { None })
                .collect();
            assert_eq!(dots.len(), 2);
            assert!(dots.iter().all(|d| d.y < 0.0 && d.y > scene.bounds.min.y && d.x > 0.0 && d.x < size.x));
            // A line of 24 pixels of 1000.
            let line = -scene.bounds.min.y / scene.bounds.size().max_element();
            assert!((line - 0.024).abs() < 1e-12, "{line}");
        }
    }

    #[test]
    fn a_narrow_picture_gets_several_lines() {
        let scene = keyed(dvec2(1.0, 20.0));
        let line = -scene.bounds.min.y / scene.bounds.size().y;
        assert!((line - 0.048).abs() < 1e-12, "{line}");
    }
}
