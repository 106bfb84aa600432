//! The exact minimum with ties, and the paper's rule for choosing among the minima.
//!
//! [`minima`] is the baseline that runs beside the network of [`super::net`], and wins where the
//! two differ.

use super::net::DIRECTIONS;

/// Volumes closer than this are equal, mm3: a hundredth of what the paper's tables print.
pub const TIE_MM3: f64 = 0.01;

/// Volumes closer than this share of the largest are equal: rounding of sums over many layers.
pub const TIE_SHARE: f64 = 1e-6;

/// O_1 by computation: 1 for each volume that equals the smallest within max([`TIE_MM3`],
/// [`TIE_SHARE`] of the largest).
pub fn minima(volumes: &[f64; DIRECTIONS]) -> [u8; DIRECTIONS] {
    let limit = tie_limit(volumes);
    volumes.map(|v| u8::from(v <= limit))
}

/// The first of any number of directions with the fewest structures among those of the smallest
/// volume: what [`minima`], [`ratings`] and [`first_largest`] come to, without a fixed number. 0 if
/// there are none.
pub fn best(volumes: &[f64], structures: &[u32]) -> usize {
    let limit = tie_limit(volumes);
    let smallest = (0..volumes.len()).filter(|&i| volumes[i] <= limit);
    smallest.min_by_key(|&i| structures[i]).unwrap_or(0)
}

/// Volumes up to this equal the smallest, mm3.
fn tie_limit(volumes: &[f64]) -> f64 {
    let smallest = volumes.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    let largest = volumes.iter().fold(0.0, |a: f64, &b| a.max(b));
    smallest + TIE_MM3.max(TIE_SHARE * largest)
}

/// R_i = O_1\[i\] * (fewest structures among the chosen) / structures_i: our reading of
/// [Karim] eq. (13), which is garbled in the print; it gives both printed tables.
///
/// Structures count the base, so they are at least 1.
pub fn ratings(o1: &[u8; DIRECTIONS], structures: &[u32; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let chosen = o1.iter().zip(structures).filter(|(o, _)| **o == 1).map(|(_, &s)| s);
    let fewest = f64::from(chosen.min().unwrap_or(0));
    std::array::from_fn(|i| f64::from(o1[i]) * fewest / f64::from(structures[i].max(1)))
}

/// O_2: one-hot, the first direction with the largest rating.
pub fn first_largest(ratings: &[f64; DIRECTIONS]) -> [u8; DIRECTIONS] {
    let best = (1..DIRECTIONS).fold(0, |best, i| if ratings[i] > ratings[best] { i } else { best });
    std::array::from_fn(|i| u8::from(i == best))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn part_model_2_chooses_direction_1() {
        // [Karim] Table 3: two equal volumes with equally many structures, the first one wins.
        let volumes = [44018.47, 44018.47, 58191.38, 137691.38, 152373.41, 106998.41];
        let o1 = minima(&volumes);
        assert_eq!(o1, [1, 1, 0, 0, 0, 0]);
        let r = ratings(&o1, &[3, 3, 3, 4, 2, 2]);
        assert_eq!(r, [1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(first_largest(&r), [1, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn among_equal_volumes_fewer_structures_win() {
        let r = ratings(&[0, 1, 0, 1, 0, 0], &[1, 4, 1, 2, 1, 1]);
        assert_eq!(r, [0.0, 0.5, 0.0, 1.0, 0.0, 0.0]);
        assert_eq!(first_largest(&r), [0, 0, 0, 1, 0, 0]);
    }

    #[test]
    fn the_rule_for_any_number_agrees_with_the_one_for_six() {
        let (volumes, structures) = ([9.0, 5.0, 5.005, 9.0, 5.0, 7.0], [1, 4, 2, 1, 2, 1]);
        let six = first_largest(&ratings(&minima(&volumes), &structures));
        assert_eq!(six[best(&volumes, &structures)], 1);
        assert_eq!(best(&[5.0, 4.0, 3.0, 3.0, 4.0, 5.0, 2.0, 2.0], &[1, 1, 1, 1, 1, 1, 3, 2]), 7);
    }

    #[test]
    fn a_tie_is_a_hundredth_of_a_cubic_millimetre_or_a_millionth() {
        assert_eq!(minima(&[5.0, 5.009, 5.011, 9.0, 9.0, 9.0]), [1, 1, 0, 0, 0, 0]);
        assert_eq!(minima(&[5e5, 5e5 + 0.9, 5e5 + 1.1, 1e6, 1e6, 1e6]), [1, 1, 0, 0, 0, 0]);
    }
}
