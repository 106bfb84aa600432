//! From lines of the axis to beads.

use super::axis::Sample;
use super::border::Triangles;
use super::chains::{Chain, DIRECTION_AT, End, SPUR_REACH, direction, length};
use super::{ThinBeads, ThinFill};
use crate::polygon::{DVec2, by_x_then_y, simplify::closest_on_segment, snap};
use crate::region::{Path, Role, Width};

/// Points within this of the simplified line are dropped, mm.
const POSITION_TOLERANCE_MM: f64 = 0.01;

/// Points whose width is within this share of the simplified line's are dropped.
const WIDTH_TOLERANCE: f64 = 0.02;

/// Share of both tolerances for beads that are seen.
const SEEN: f64 = 0.3;

/// A line of a compact area, shorter than this many radii, has no direction of its own.
const NO_DIRECTION: f64 = 0.3;

/// How much shorter than `min_length` a wide bead that begins at another may be.
const SHORTEST: f64 = 0.35;

/// A line that meets another aslant goes on by this share of what its farther side has to go, times the
/// cosine of the angle between them; its round end covers the rest.
const SLANTED_REACH: f64 = 0.7;

/// The ways over the last [`DIRECTION_AT`] radii and over half of that differ by less than this in a bent
/// stroke; where they differ by more it has a corner.
const MOST_BEND: f64 = 0.5;

/// How wide a stroke is at its end, as shares of its width before; what grows wider runs into another.
const STROKE: std::ops::Range<f64> = 0.55..1.15;

/// In a circle the two ways differ by a quarter of the bend; from the middle of the shorter one to the middle
/// of what is added it bends by twice that.
const BENDS_ON: f64 = 2.0;

/// Length of the line of a stub that ends just beyond another bead, mm.
const STUB_MM: f64 = 0.1;

/// Widths are rounded to this, mm: the grid of positions.
const WIDTHS_PER_MM: f64 = 1e4;

/// Turns a line into beads: none, one, or several where it is too thin in between.
pub(super) fn lay(chain: &Chain, triangles: &Triangles, options: &ThinFill, beads: &mut ThinBeads) {
    let (line, closed) = match chain.ends {
        None => (chain.line.clone(), true),
        Some(ends) => (ended(chain.line.clone(), ends, triangles, options), false),
    };
    let free_ends = chain.ends.into_iter().flatten().zip([line.first(), line.last()]);
    let free_ends = free_ends.filter(|(end, _)| matches!(end, End::Strip { .. }));
    let is_alone = chain.ends.is_none_or(|ends| ends.iter().all(|e| matches!(e, End::Strip { .. })));
    let free_ends: Vec<DVec2> = free_ends.filter_map(|(_, sample)| Some(sample?.at)).collect();
    beads.left_mm2 += swept(&line, closed, |s| 2.0 * s.radius);
    for (run, closed) in thick_runs(line, closed, options.min_thickness) {
        let caps = [run.first(), run.last()].into_iter().flatten().filter(|s| free_ends.contains(&s.at));
        let caps: f64 = caps.map(|s| options.end_inset * bead_width(s, options)).sum();
        let shortest = if is_alone { options.min_length } else { shortest(&run, options) };
        if let Some(path) = bead(&run, closed, shortest - caps, options) {
            beads.left_mm2 -= swept(&run, closed, |s| bead_width(s, options).min(2.0 * s.radius));
            beads.paths.push(path);
        }
    }
    beads.left_mm2 = beads.left_mm2.max(0.0);
}

/// Length of the shortest bead along a line that begins at another bead, mm: it holds as much as one of
/// `min_length` and `min_width`, and has at least [`SHORTEST`] of its length.
fn shortest(line: &[Sample], options: &ThinFill) -> f64 {
    let widest = line.iter().map(|s| bead_width(s, options)).fold(options.min_width, f64::max);
    options.min_length * (options.min_width / widest).max(SHORTEST)
}

/// The line with both ends where the bead shall end.
fn ended(mut line: Vec<Sample>, ends: [End; 2], triangles: &Triangles, options: &ThinFill) -> Vec<Sample> {
    let is_strip = ends.iter().all(|e| matches!(e, End::Strip { .. }));
    if is_strip && length(&line) < line[0].radius * NO_DIRECTION {
        line.truncate(1);
    }
    if is_strip && line.len() == 1 {
        let axis = longest_axis(triangles, line[0].at);
        carry_to_border(&mut line, axis, triangles, options);
        line.reverse();
        carry_to_border(&mut line, -axis, triangles, options);
        return line;
    }
    for end in [ends[1], ends[0]] {
        if let End::Strip { tip } = end {
            cut_hook(&mut line, tip);
            let outward = onward(&line);
            carry_to_border(&mut line, outward, triangles, options);
            fit_end(&mut line, triangles);
        }
        // The start is the end of the reversed line.
        line.reverse();
    }
    for end in [ends[1], ends[0]] {
        if let End::Junction { slant } = end {
            trim_at_junction(&mut line, slant, options);
        }
        line.reverse();
    }
    without_reversals(line)
}

/// The unit direction in which a line goes on at its end: a bent stroke bends on.
fn onward(line: &[Sample]) -> DVec2 {
    let straight = -direction(line, true);
    let Some(end) = line.last() else { return straight };
    let back = |radii: f64| line.iter().rev().find(|s| s.at.distance(end.at) >= radii * end.radius);
    let Some((nearer, farther)) = back(DIRECTION_AT / 2.0).zip(back(DIRECTION_AT)) else { return straight };
    let nearer = (end.at - nearer.at).normalize_or(straight);
    let turn = straight.angle_to(nearer);
    let is_stroke = turn.abs() < MOST_BEND && STROKE.contains(&(end.radius / farther.radius));
    if is_stroke { DVec2::from_angle(turn * BENDS_ON).rotate(nearer) } else { straight }
}

/// Ends the line where the bead of the line through the junction does. A short stub that reaches out
/// beyond that bead by the shortest bead's length still keeps a line of [`STUB_MM`].
fn trim_at_junction(line: &mut Vec<Sample>, slant: f64, options: &ThinFill) {
    let Some((&far, &near)) = line.first().zip(line.last()) else { return };
    let farther = SLANTED_REACH * (slant - 1.0 / slant);
    let (by, whole) = ((slant - farther) * bead_width(&near, options) / 2.0, length(line));
    let free = whole - by + options.end_inset * bead_width(&far, options);
    let is_stub = whole > STUB_MM && whole - by < STUB_MM && free >= shortest(&[far], options);
    trim(line, if is_stub { whole - STUB_MM } else { by });
}

/// Moves the line's end to the middle between the sides there, and fits its width to them: in a corner, on a
/// slanted end and beside a junction the place is narrower than where the line came from.
fn fit_end(line: &mut [Sample], triangles: &Triangles) {
    let [.., before, last] = line else { return };
    let side = (last.at - before.at).normalize_or_zero().perp();
    let reach = |d: DVec2| triangles.ray(last.at, d).map_or(last.radius, |free| free.min(last.radius));
    let (left, right) = (reach(side), reach(-side));
    *last = Sample { at: last.at + side * ((left - right) / 2.0), radius: (left + right) / 2.0 };
}

/// Takes off the last stretch of a line where it only turns into a corner at the strip's end: the
/// rule for spurs, for a strip whose end has no junction. A straight end loses as much and gets it
/// back when it is carried to the border.
fn cut_hook(line: &mut Vec<Sample>, tip: f64) {
    let mut beyond = tip;
    let mut keep = line.len();
    for i in (0..line.len()).rev() {
        beyond += line.get(i + 1).map_or(0.0, |next| next.at.distance(line[i].at));
        if beyond <= (1.0 + SPUR_REACH) * line[i].radius {
            keep = i + 1;
        }
    }
    line.truncate(keep.max(2));
}

fn bead_width(sample: &Sample, options: &ThinFill) -> f64 {
    (2.0 * sample.radius).clamp(options.min_width, options.max_width)
}

/// Area under a bead, mm2.
fn swept(line: &[Sample], closed: bool, width: impl Fn(&Sample) -> f64) -> f64 {
    let closing = line.last().zip(line.first()).filter(|_| closed);
    let edges = line.windows(2).map(|w| (&w[0], &w[1])).chain(closing);
    edges.map(|(a, b)| a.at.distance(b.at) * (width(a) + width(b)) / 2.0).sum()
}

/// Of the directions of x and y the one in which the area around `p` is longer.
fn longest_axis(triangles: &Triangles, p: DVec2) -> DVec2 {
    let extent = |d: DVec2| triangles.ray(p, d).unwrap_or(0.0) + triangles.ray(p, -d).unwrap_or(0.0);
    if extent(DVec2::Y) > extent(DVec2::X) { DVec2::Y } else { DVec2::X }
}

/// Lengthens or shortens the line's end so that it lies `end_inset` widths before the border.
fn carry_to_border(line: &mut Vec<Sample>, direction: DVec2, triangles: &Triangles, options: &ThinFill) {
    let Some(&last) = line.last() else { return };
    let width = bead_width(&last, options);
    let free = triangles.ray(last.at, direction).unwrap_or(last.radius);
    let missing = free - options.end_inset * width;
    if missing >= 0.0 {
        line.push(Sample { at: last.at + direction * missing, radius: last.radius });
    } else {
        trim(line, -missing);
    }
}

/// Shortens the line's end by `by` mm; nothing stays of a line that is not longer.
fn trim(line: &mut Vec<Sample>, by: f64) {
    let mut left = by;
    while let Some(last) = line.pop() {
        let Some(&before) = line.last() else { return };
        let edge = last.at.distance(before.at);
        if edge > left {
            line.push(between(last, before, left / edge));
            return;
        }
        left -= edge;
    }
}

fn between(a: Sample, b: Sample, share: f64) -> Sample {
    Sample { at: a.at.lerp(b.at, share), radius: a.radius + (b.radius - a.radius) * share }
}

/// Drops points at which the line turns back on itself: rounding of crowded points.
fn without_reversals(line: Vec<Sample>) -> Vec<Sample> {
    let mut kept: Vec<Sample> = Vec::with_capacity(line.len());
    for sample in line {
        while let [.., a, b] = kept[..]
            && turns_back(a, b, sample)
        {
            kept.pop();
        }
        kept.push(sample);
    }
    kept
}

/// Whether the line a-b-c turns by more than 120 degrees within the width at b.
fn turns_back(a: Sample, b: Sample, c: Sample) -> bool {
    let (u, v) = (b.at - a.at, c.at - b.at);
    let is_short = u.length().min(v.length()) < b.radius;
    is_short && u.dot(v) < -0.5 * u.length() * v.length()
}

/// The stretches where the area is at least `thickness` mm thick, and whether they are closed.
fn thick_runs(mut line: Vec<Sample>, closed: bool, thickness: f64) -> Vec<(Vec<Sample>, bool)> {
    let limit = thickness / 2.0;
    if line.iter().all(|s| s.radius >= limit) {
        return vec![(line, closed)];
    }
    if closed {
        // Opened at the thinnest place, so that no run is cut by where the line happens to start.
        let thinnest = (0..line.len()).min_by(|&a, &b| line[a].radius.total_cmp(&line[b].radius));
        line.rotate_left(thinnest.unwrap_or(0));
        line.push(line[0]);
    }
    let mut runs: Vec<Vec<Sample>> = vec![Vec::new()];
    let mut before: Option<Sample> = None;
    for sample in line {
        let border = before.filter(|b| (b.radius < limit) != (sample.radius < limit));
        let crossing = border.map(|b| between(b, sample, (limit - b.radius) / (sample.radius - b.radius)));
        // `runs` is never empty.
        let run = runs.last_mut().expect("a run is open");
        run.extend(crossing);
        if sample.radius >= limit {
            run.push(sample);
        } else if !run.is_empty() {
            runs.push(Vec::new());
        }
        before = Some(sample);
    }
    runs.into_iter().map(|run| (run, false)).collect()
}

/// The bead along a line, or `None` when that is shorter than `min_length` mm.
fn bead(line: &[Sample], closed: bool, min_length: f64, options: &ThinFill) -> Option<Path> {
    if length(line) < min_length {
        return None;
    }
    let mut line: Vec<Sample> = line
        .iter()
        .map(|s| Sample { at: snap(s.at), radius: round_width(bead_width(s, options)) / 2.0 })
        .collect();
    line.dedup_by(|a, b| a.at == b.at);
    let share = if options.role == Role::OuterWall { SEEN } else { 1.0 };
    let line = if closed { simplified_ring(line, share) } else { simplified(&line, share) };
    if line.len() < if closed { 3 } else { 2 } {
        return None;
    }
    let line = canonical(line, closed);
    let width = width(&line, closed);
    Some(Path {
        role: options.role,
        points: line.into_iter().map(|s| s.at).collect(),
        closed,
        width,
        hang: 0.0,
    })
}

/// A closed bead through these points, walked as given; `None` without an area.
pub(crate) fn ring(role: Role, line: Vec<Sample>) -> Option<Path> {
    let rounded = |s: Sample| Sample { at: snap(s.at), radius: round_width(2.0 * s.radius) / 2.0 };
    let mut line: Vec<Sample> = line.into_iter().map(rounded).collect();
    line.dedup_by(|a, b| a.at == b.at);
    let line = simplified_ring(line, 1.0);
    let width = (line.len() >= 3).then(|| width(&line, true))?;
    Some(Path { role, points: line.into_iter().map(|s| s.at).collect(), closed: true, width, hang: 0.0 })
}

fn round_width(width: f64) -> f64 {
    (width * WIDTHS_PER_MM).round() / WIDTHS_PER_MM
}

fn width(line: &[Sample], closed: bool) -> Width {
    let total = length(line) + if closed { line[0].at.distance(line[line.len() - 1].at) } else { 0.0 };
    let mean = round_width(swept(line, closed, |s| 2.0 * s.radius) / total);
    let is_mean = |s: &Sample| (2.0 * s.radius - mean).abs() <= WIDTH_TOLERANCE * mean;
    if line.iter().all(is_mean) {
        Width::Uniform(mean)
    } else {
        Width::Varying(line.iter().map(|s| 2.0 * s.radius).collect())
    }
}

/// Open lines start at their smaller end, closed ones at their smallest point, counter-clockwise.
fn canonical(mut line: Vec<Sample>, closed: bool) -> Vec<Sample> {
    if !closed {
        if by_x_then_y(line[line.len() - 1].at, line[0].at).is_lt() {
            line.reverse();
        }
        return line;
    }
    let origin = line[0].at;
    let edges = line.iter().zip(line.iter().cycle().skip(1));
    if edges.map(|(a, b)| (a.at - origin).perp_dot(b.at - origin)).sum::<f64>() < 0.0 {
        line.reverse();
    }
    let smallest = (0..line.len()).min_by(|&a, &b| by_x_then_y(line[a].at, line[b].at));
    line.rotate_left(smallest.unwrap_or(0));
    line
}

/// A closed line from two far points, both kept.
fn simplified_ring(mut line: Vec<Sample>, share: f64) -> Vec<Sample> {
    let Some(smallest) = (0..line.len()).min_by(|&a, &b| by_x_then_y(line[a].at, line[b].at)) else {
        return line;
    };
    line.rotate_left(smallest);
    let first = line[0];
    let far = (0..line.len()).max_by(|&a, &b| {
        let distance = |i: usize| line[i].at.distance_squared(first.at);
        distance(a).total_cmp(&distance(b)).then(b.cmp(&a))
    });
    let far = far.unwrap_or(0);
    line.push(first);
    let mut kept = simplified(&line[..=far], share);
    kept.pop();
    kept.extend(simplified(&line[far..], share));
    kept.pop();
    kept
}

/// Douglas and Peucker 1973 with two measures: the distance to the edge, and the difference from the
/// width in the middle of it, each as a share of what is allowed.
fn simplified(line: &[Sample], share: f64) -> Vec<Sample> {
    let n = line.len();
    if n < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; n];
    (keep[0], keep[n - 1]) = (true, true);
    let mut open = vec![(0, n - 1)];
    while let Some((a, b)) = open.pop() {
        let worst = (a + 1..b)
            .map(|i| (i, excess(line[i], line[a], line[b])))
            .fold((a, share), |worst, next| if next.1 > worst.1 { next } else { worst });
        if worst.0 > a {
            keep[worst.0] = true;
            open.push((a, worst.0));
            open.push((worst.0, b));
        }
    }
    line.iter().zip(keep).filter_map(|(&s, kept)| kept.then_some(s)).collect()
}

/// How far `s` is from the edge a-b, in tolerances.
fn excess(s: Sample, a: Sample, b: Sample) -> f64 {
    let foot = closest_on_segment(s.at, a.at, b.at);
    let edge = a.at.distance(b.at);
    let share = if edge > 0.0 { a.at.distance(foot) / edge } else { 0.0 };
    let radius = a.radius + (b.radius - a.radius) * share;
    let off = s.at.distance(foot) / POSITION_TOLERANCE_MM;
    off.max((s.radius - radius).abs() / (WIDTH_TOLERANCE * s.radius))
}
