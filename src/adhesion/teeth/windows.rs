//! Stretches of the rail on which a tooth can stand.

use super::site::Base;
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

/// An arc length and the contour that a tooth there would bite.
type Sample = (f64, Option<u32>);

/// The windows of one rail, in order along it.
pub(super) fn windows_of(site: &Site, index: usize, rail: &Rail, base: Base) -> Vec<Window> {
    let owner_at = |s: f64| site.tooth_at(rail, s, base).map(|(_, owner)| owner);
    let samples: Vec<Sample> = sample_positions(rail).into_iter().map(|s| (s, owner_at(s))).collect();
    let window = |owner, from, to| Window { rail: index, owner, from, to, ring: false, behind_corner: false };
    let Some(line) = unrolled(&samples, rail.length()) else {
        let ring = |owner| Window { ring: true, ..window(owner, 0.0, rail.length()) };
        return samples.first().and_then(|s| s.1).map(ring).into_iter().collect();
    };
    let mut windows = Vec::new();
    // All samples but the neighbours at both ends.
    let mut start = 1;
    for run in line[1..line.len() - 1].chunk_by(|x, y| x.1 == y.1) {
        let (before, after) = (line[start - 1].0, line[start + run.len()].0);
        start += run.len();
        if let [(from, Some(owner)), ..] = *run {
            let limit = |good, bad| last_good(|s| owner_at(s) == Some(owner), good, bad);
            windows.push(window(owner, limit(from, before), limit(run[run.len() - 1].0, after)));
        }
    }
    mark_corners(rail, &mut windows);
    windows
}

/// The samples from the first change of owner once round, arc lengths going on beyond the rail's start, with
/// one more at either end; `None` without a change.
fn unrolled(samples: &[Sample], length: f64) -> Option<Vec<Sample>> {
    let n = samples.len();
    let first = (0..n).find(|&i| samples[i].1 != samples[(i + n - 1) % n].1)?;
    let at = |i: usize| {
        let (s, owner) = samples[i % n];
        (s + ((i / n) as f64 - 1.0) * length, owner)
    };
    // Counted one round ahead, so that the sample before the first is not negative.
    Some((first + n - 1..=first + 2 * n).map(at).collect())
}

fn mark_corners(rail: &Rail, windows: &mut [Window]) {
    let Some(last) = windows.last() else { return };
    let mut before = last.to - rail.length();
    for window in windows {
        window.behind_corner = rail.has_corner_between(before, window.from);
        before = window.to;
    }
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

/// Between a place where a tooth can stand and one where it cannot: nearly the last where it can.
fn last_good(can_stand: impl Fn(f64) -> bool, good: f64, bad: f64) -> f64 {
    let halved = |(good, bad): (f64, f64), _| {
        let middle = (good + bad) / 2.0;
        if can_stand(middle) { (middle, bad) } else { (good, middle) }
    };
    (0..HALVINGS).fold((good, bad), halved).0
}
