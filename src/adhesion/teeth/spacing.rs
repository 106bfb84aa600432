//! How many teeth each window of the rail gets, and where in it.

use super::Window;

/// Halvings of the search for the pitch: to a millionth of its range.
const HALVINGS: u32 = 20;

/// Smallest and largest distance from tooth to tooth along the rail, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PitchRange {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// Where `wanted` teeth stand in the windows of one contour: the largest pitch along the rails that
/// places so many, then evenly in each window. Fewer when the smallest pitch places fewer.
///
/// `lengths` are the lengths of the rails. Returned is (window index, arc length), in order.
pub(super) fn spread(
    windows: &[Window],
    lengths: &[f64],
    wanted: u32,
    range: PitchRange,
) -> Vec<(usize, f64)> {
    let mut windows = windows.to_vec();
    let fewest = counts(&windows, lengths, range.high).iter().sum::<u32>();
    if fewest > wanted {
        // Many short sides, as of a gear: one tooth on each is too many, so they share.
        windows.iter_mut().for_each(|w| w.behind_corner = false);
    }
    let counted = counts(&windows, lengths, largest_pitch(&windows, lengths, wanted, range));
    let places = |(index, (window, &count)): (usize, (&Window, &u32))| {
        positions(window, count, range.low).into_iter().map(move |s| (index, s)).collect::<Vec<_>>()
    };
    windows.iter().zip(&counted).enumerate().flat_map(places).collect()
}

/// The largest pitch that places so many teeth, or the smallest of the range.
fn largest_pitch(windows: &[Window], lengths: &[f64], wanted: u32, range: PitchRange) -> f64 {
    let is_enough = |pitch: f64| counts(windows, lengths, pitch).iter().sum::<u32>() >= wanted;
    if is_enough(range.high) {
        return range.high;
    }
    let halved = |(enough, few): (f64, f64), _| {
        let middle = (enough + few) / 2.0;
        if is_enough(middle) { (middle, few) } else { (enough, middle) }
    };
    (0..HALVINGS).fold((range.low, range.high), halved).0
}

/// Teeth in each window when each stands as early as it can, `pitch` behind the one before. Windows
/// behind a corner count by themselves, so that equal sides get equal teeth.
fn counts(windows: &[Window], lengths: &[f64], pitch: f64) -> Vec<u32> {
    let mut found = Vec::with_capacity(windows.len());
    let (mut rail, mut last) = (usize::MAX, f64::NEG_INFINITY);
    // Where the rail's last tooth must stand to keep its distance from the first, all round.
    let mut limit = None;
    for window in windows {
        if window.rail != rail {
            (rail, last, limit) = (window.rail, f64::NEG_INFINITY, None);
        }
        if window.behind_corner {
            (last, limit) = (f64::NEG_INFINITY, Some(f64::INFINITY));
        }
        let length = lengths[window.rail];
        if window.ring {
            found.push(((length / pitch).floor() as u32).max(1));
            continue;
        }
        let start = window.from.max(last + pitch);
        let end = window.to.min(limit.unwrap_or(f64::INFINITY));
        if start > end {
            found.push(0);
            continue;
        }
        let count = ((end - start) / pitch + 1e-9).floor();
        last = start + count * pitch;
        limit = limit.or(Some(start + length - pitch));
        found.push(count as u32 + 1);
    }
    found
}

/// `count` places in a window at equal distance, half of it free at both ends where that leaves `low`.
fn positions(window: &Window, count: u32, low: f64) -> Vec<f64> {
    let length = window.to - window.from;
    let share = length / f64::from(count.max(1));
    let step = match (window.ring, count) {
        (true, _) => share,
        (false, 0 | 1) => 0.0,
        (false, _) => share.max(low).min(length / f64::from(count - 1)),
    };
    let middle = (window.from + window.to) / 2.0;
    let start = middle - step * (f64::from(count) - 1.0) / 2.0;
    (0..count).map(|i| start + step * f64::from(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(from: f64, to: f64) -> Window {
        Window { rail: 0, owner: 0, from, to, ring: false, behind_corner: false }
    }

    const RANGE: PitchRange = PitchRange { low: 3.5, high: 15.0 };

    #[test]
    fn a_ring_is_divided_evenly() {
        let ring = Window { ring: true, ..window(0.0, 50.0) };
        let found: Vec<f64> = spread(&[ring], &[50.0], 10, RANGE).iter().map(|p| p.1).collect();
        assert_eq!(found.len(), 10);
        assert!(found.windows(2).all(|w| (w[1] - w[0] - 5.0).abs() < 1e-9));
    }

    #[test]
    fn one_short_window_gets_its_tooth_in_the_middle() {
        assert_eq!(spread(&[window(3.0, 4.0)], &[50.0], 1, RANGE), [(0, 3.5)]);
    }

    #[test]
    fn windows_close_together_share_teeth() {
        // Sixty windows of 1 mm every 4 mm, 24 teeth wanted: not one in each.
        let windows: Vec<Window> =
            (0..60).map(|i| window(4.0 * f64::from(i), 4.0 * f64::from(i) + 1.0)).collect();
        let found = spread(&windows, &[240.0], 24, RANGE);
        assert!((24..=30).contains(&found.len()), "{}", found.len());
    }

    #[test]
    fn two_in_a_window_that_is_just_long_enough_stand_at_its_ends() {
        let found = spread(&[window(10.0, 13.6)], &[100.0], 2, RANGE);
        assert_eq!(found.len(), 2);
        assert!(found[1].1 - found[0].1 >= 3.5);
        assert!(found[0].1 >= 10.0 && found[1].1 <= 13.6);
    }
}
