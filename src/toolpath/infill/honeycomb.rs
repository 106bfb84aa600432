//! Hexagons from zigzag lines that lie side by side where they meet, the same on every layer.

use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, dvec2};

/// Half the square root of 3: height of a slanting side of length 1.
const SLANT: f64 = 0.866_025_403_784_438_6;

/// Zigzag lines over a box that they leave at both ends.
///
/// A line with hexagons of side a goes a along, a up, a along, a down: 4 a of bead in a period of 3 a.
/// Its neighbour is half a period ahead and `spacing` farther than would make them meet, so that both
/// print the side between them. With p = a sqrt(3)/2 + spacing from line to line the beads take up
/// 4 a spacing / (3 a p) = `density` of the area.
pub(super) fn zigzags(bounds: Bounds, spacing: f64, density: f64) -> Vec<Vec<DVec2>> {
    let pitch = 4.0 * spacing / (3.0 * density);
    let rise = (pitch - spacing).max(0.0);
    let side = rise / SLANT;
    let period = 3.0 * side;
    if period <= 0.0 {
        return Vec::new();
    }
    let rows = (bounds.min.y / pitch).floor() as i64 - 1..=(bounds.max.y / pitch).ceil() as i64 + 1;
    let row = |k: i64| {
        let shift = if k.rem_euclid(2) == 0 { 0.0 } else { period / 2.0 };
        let columns =
            ((bounds.min.x - shift) / period).floor() as i64 - 1..=(bounds.max.x / period).ceil() as i64;
        let (low, high) = (k as f64 * pitch, k as f64 * pitch + rise);
        let hexagon = move |i: i64| {
            let x = i as f64 * period + shift;
            [(0.0, low), (1.0, low), (1.5, high), (2.5, high)].map(|(along, y)| dvec2(x + along * side, y))
        };
        columns.flat_map(hexagon).collect()
    };
    rows.map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_equal_and_neighbours_lie_side_by_side() {
        let bounds = Bounds { min: DVec2::ZERO, max: DVec2::splat(10.0) };
        let rows = zigzags(bounds, 0.4, 0.2);
        let side = (4.0 * 0.4 / 0.6 - 0.4) / SLANT;
        for ends in rows[0].windows(2) {
            assert!((ends[0].distance(ends[1]) - side).abs() < 1e-9);
        }
        let top = rows[0].iter().map(|p| p.y).fold(f64::MIN, f64::max);
        let next = rows[1].iter().map(|p| p.y).fold(f64::MAX, f64::min);
        assert!((next - top - 0.4).abs() < 1e-9);
    }
}
