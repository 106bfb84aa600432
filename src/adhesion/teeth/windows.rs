//! Stretches of the rail on which a tooth can stand.

use super::{Rail, Site};

/// Distance of the samples that look for such stretches, mm.
const STEP_MM: f64 = 0.5;

/// Halvings that find a stretch's end between two samples: to 0.03 mm.
const HALVINGS: u32 = 4;

/// Teeth may have their middle between these two arc lengths (`from` within the first round, `to` at
/// most one round later), all biting the same contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    /// Index of the rail.
    pub(super) rail: usize,
    /// Contour of the outline that teeth here bite.
    pub(super) owner: u32,
    pub(super) from: f64,
    pub(super) to: f64,
    /// Whether this is the whole rail.
    pub(super) ring: bool,
    /// Whether a corner of the rail lies between the window before and this one.
    pub(super) behind_corner: bool,
}

/// The windows of one rail, in order along it.
pub(super) fn windows_of(site: &Site, index: usize, rail: &Rail) -> Vec<Window> {
    let samples: Vec<(f64, Option<u32>)> =
        sample_positions(rail).into_iter().map(|s| (s, owner_at(site, rail, s))).collect();
    let n = samples.len();
    let Some(first) = (0..n).find(|&i| samples[i].1 != samples[(i + n - 1) % n].1) else {
        let ring = |owner| Window {
            rail: index,
            owner,
            from: 0.0,
            to: rail.length(),
            ring: true,
            behind_corner: false,
        };
        return samples.first().and_then(|s| s.1).map(ring).into_iter().collect();
    };
    // From the first change once round, arc lengths going on beyond the start.
    let unrolled = |k: usize| {
        let (s, owner) = samples[(first + k) % n];
        (if first + k >= n { s + rail.length() } else { s }, owner)
    };
    let mut windows: Vec<Window> = Vec::new();
    let mut k = 0;
    while k < n {
        let (from, owner) = unrolled(k);
        let end = (k..n).take_while(|&j| unrolled(j).1 == owner).last().unwrap_or(k);
        if let Some(owner) = owner {
            let before =
                if k == 0 { samples[(first + n - 1) % n].0 - wrap(first, rail) } else { unrolled(k - 1).0 };
            let after = if end + 1 < n { unrolled(end + 1).0 } else { samples[first].0 + rail.length() };
            let limit = |good, bad| last_good(site, rail, owner, good, bad);
            windows.push(Window {
                rail: index,
                owner,
                from: limit(from, before),
                to: limit(unrolled(end).0, after),
                ring: false,
                behind_corner: false,
            });
        }
        k = end + 1;
    }
    mark_corners(rail, &mut windows);
    windows
}

fn mark_corners(rail: &Rail, windows: &mut [Window]) {
    let Some(last) = windows.last() else { return };
    let mut before = last.to - rail.length();
    for window in windows {
        window.behind_corner = rail.has_corner_between(before, window.from);
        before = window.to;
    }
}

/// What to take from the last sample's arc length to come before the first one's.
fn wrap(first: usize, rail: &Rail) -> f64 {
    if first == 0 { rail.length() } else { 0.0 }
}

/// An odd number of samples on each edge, so that its middle is one: a window in the middle of a short
/// edge is not missed.
fn sample_positions(rail: &Rail) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for (start, a, b) in rail.edges() {
        let length = a.distance(b);
        let last = found.last().copied().unwrap_or(f64::NEG_INFINITY);
        if length < STEP_MM / 4.0 && start + length / 2.0 - last < STEP_MM / 2.0 {
            continue;
        }
        let count = (length / STEP_MM).ceil() as u32 | 1;
        found.extend((0..count).map(|i| start + length * (f64::from(i) + 0.5) / f64::from(count)));
    }
    found
}

fn owner_at(site: &Site, rail: &Rail, s: f64) -> Option<u32> {
    site.tooth_at(rail, s).map(|(_, owner)| owner)
}

/// Between a place where a tooth can stand and one where it cannot: nearly the last where it can.
fn last_good(site: &Site, rail: &Rail, owner: u32, good: f64, bad: f64) -> f64 {
    let halved = |(good, bad): (f64, f64), _| {
        let middle = (good + bad) / 2.0;
        if owner_at(site, rail, middle) == Some(owner) { (middle, bad) } else { (good, middle) }
    };
    (0..HALVINGS).fold((good, bad), halved).0
}
