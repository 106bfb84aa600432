//! How much of an outline lies near some lines.

use super::segments::{Segment, Segments};
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2};
use crate::sort::StableSort;

/// For each contour, the length of it that lies within `reach` mm of a line, mm. Exact: each edge is
/// cut with the rounded strip around each line.
pub(super) fn length_within(contours: &[Contour], lines: &Segments, reach: f64) -> Vec<f64> {
    let mut covered = Vec::new();
    let mut of_edge = |a: DVec2, b: DVec2| {
        covered.clear();
        let near = Bounds { min: a.min(b), max: a.max(b) }.grown(reach);
        lines.for_near(near, |line| {
            // Cells are wider than the reach: most lines in them are too far away.
            if near.is_near(Bounds { min: line.a.min(line.b), max: line.a.max(line.b) }, 0.0) {
                covered.extend(stretch_within(a, b, line, reach));
            }
        });
        a.distance(b) * united_length(&mut covered)
    };
    contours.iter().map(|c| c.edges().map(|(a, b)| of_edge(a, b)).sum()).collect()
}

/// The shares of the edge a-b between which it lies within `reach` of the line: one interval, as
/// the set of points near a segment is convex.
fn stretch_within(a: DVec2, b: DVec2, line: &Segment, reach: f64) -> Option<(f64, f64)> {
    let parts =
        [within_disc(a, b, line.a, reach), within_disc(a, b, line.b, reach), within_strip(a, b, line, reach)];
    let whole = parts.into_iter().flatten().reduce(|x, y| (x.0.min(y.0), x.1.max(y.1)))?;
    let cut = (whole.0.max(0.0), whole.1.min(1.0));
    (cut.0 < cut.1).then_some(cut)
}

fn within_disc(a: DVec2, b: DVec2, centre: DVec2, radius: f64) -> Option<(f64, f64)> {
    let (along, from) = (b - a, a - centre);
    let (squared, half) = (along.length_squared(), along.dot(from));
    let root = half * half - squared * (from.length_squared() - radius * radius);
    if squared == 0.0 || root <= 0.0 {
        return None;
    }
    Some(((-half - root.sqrt()) / squared, (-half + root.sqrt()) / squared))
}

fn within_strip(a: DVec2, b: DVec2, line: &Segment, reach: f64) -> Option<(f64, f64)> {
    let length = line.a.distance(line.b);
    if length == 0.0 {
        return None;
    }
    let along = (line.b - line.a) / length;
    let (from, step) = (a - line.a, b - a);
    let ends = within(from.dot(along), step.dot(along), 0.0, length)?;
    let sides = within(along.perp_dot(from), along.perp_dot(step), -reach, reach)?;
    let both = (ends.0.max(sides.0), ends.1.min(sides.1));
    (both.0 < both.1).then_some(both)
}

/// Where `start + t * step` lies between `low` and `high`.
fn within(start: f64, step: f64, low: f64, high: f64) -> Option<(f64, f64)> {
    if step == 0.0 {
        return (low <= start && start <= high).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (p, q) = ((low - start) / step, (high - start) / step);
    Some((p.min(q), p.max(q)))
}

fn united_length(intervals: &mut [(f64, f64)]) -> f64 {
    intervals.stable_sort_by(|x, y| x.0.total_cmp(&y.0));
    let (mut length, mut end) = (0.0, f64::NEG_INFINITY);
    for &(from, to) in intervals.iter() {
        length += (to - from.max(end)).max(0.0);
        end = end.max(to);
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{PolygonSet, dvec2};

    fn near(lines: &[(DVec2, DVec2)], reach: f64) -> f64 {
        let square = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 10.0));
        let segments = lines.iter().map(|&(a, b)| Segment { a, b, owner: 0 }).collect();
        length_within(square.contours(), &Segments::new(segments, 1.0), reach)[0]
    }

    #[test]
    fn lengths_known_on_paper() {
        // Beside the lower edge at 0.3 with reach 0.5: 4 mm and a half chord of 0.4 at each end.
        let beside = (dvec2(3.0, -0.3), dvec2(7.0, -0.3));
        assert!((near(&[beside], 0.5) - 4.8).abs() < 1e-9);
        // The same line twice holds no more than once, and half of it holds nothing new.
        let half = (dvec2(4.0, -0.3), dvec2(6.0, -0.3));
        assert!((near(&[beside, beside, half], 0.5) - 4.8).abs() < 1e-9);
        // A line through the edge at a right angle: the chord of the strip's width.
        assert!((near(&[(dvec2(5.0, -2.0), dvec2(5.0, 2.0))], 0.5) - 1.0).abs() < 1e-9);
        // A point at a corner: reach on each of two edges.
        assert!((near(&[(dvec2(0.0, 0.0), dvec2(0.0, 0.0))], 0.5) - 1.0).abs() < 1e-9);
        assert_eq!(near(&[(dvec2(3.0, -0.6), dvec2(7.0, -0.6))], 0.5), 0.0);
    }
}
