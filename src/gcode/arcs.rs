//! Straight pieces that follow a circle as one arc (G2, G3).
//!
//! An arc starts and ends at corners of the line that it replaces and keeps within a tolerance of all
//! that lies between. Its centre is the point of the chord's bisector that has, by least squares, the
//! same distance from all corners; it is rounded to what I and J words can say before the check.

use super::Place;
use crate::polygon::{DVec2, trig};
use std::f64::consts::{PI, TAU};

/// Fewer pieces are not worth an arc.
const FEWEST_PIECES: usize = 3;

/// Most pieces of one arc, so that long chains cost no time.
const MOST_PIECES: usize = 500;

/// Flatter arcs are as good as straight, and their centres too far to be said exactly, mm.
const LARGEST_RADIUS: f64 = 1000.0;

/// Most that a single piece may turn, radians: the arc is longer than its chord by a 24th of the
/// square, 0.7 %, and its bead thinner by as much.
const LONGEST_STEP: f64 = 0.4;

/// Longest arc, radians: half a circle, with room for rounding. A longer one would be told from its
/// complement by few micrometres at its ends.
const LONGEST_SWEEP: f64 = PI + 0.01;

/// By how much the distances of both ends from the rounded centre may differ, mm; firmwares spread
/// the difference along the arc or leave it to the next move.
const RADIUS_MISMATCH: f64 = 0.002;

/// The curve of an arc without its start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curve {
    /// Where it ends.
    pub to: Place,
    /// From its start to its centre, micrometres.
    pub offset: Place,
    /// Whether it turns clockwise.
    pub clockwise: bool,
}

/// What the timing needs of an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ArcShape {
    pub(super) radius: f64,
    pub(super) length: f64,
    /// Directions at start and end, of length 1.
    pub(super) tangents: [DVec2; 2],
}

impl Curve {
    /// Radius, length and tangents of the arc from a place.
    pub(super) fn shape(&self, from: Place) -> ArcShape {
        let spoke = -self.offset.mm();
        let end_spoke = from.way(self.to) + spoke;
        let turn = if self.clockwise { -1.0 } else { 1.0 };
        let radius = spoke.length();
        ArcShape {
            radius,
            length: radius * sweep(spoke, end_spoke, turn),
            tangents: [spoke, end_spoke].map(|s| s.perp().normalize_or_zero() * turn),
        }
    }
}

/// The longest arc from the first of these places on, and the index of the place where it ends.
/// Neighbouring places must differ.
pub(super) fn fit_arc(places: &[Place], tolerance: f64) -> Option<(usize, Curve)> {
    let most = places.len().min(MOST_PIECES + 1);
    let mut found = None;
    for last in FEWEST_PIECES..most {
        match curve_along(&places[..=last], tolerance) {
            Some(curve) => found = Some((last, curve)),
            None => break,
        }
    }
    found
}

/// The arc along all these places, if it keeps within the tolerance.
fn curve_along(places: &[Place], tolerance: f64) -> Option<Curve> {
    let (&first, &to) = (places.first()?, places.last()?);
    let points: Vec<DVec2> = places.iter().map(|&p| first.way(p)).collect();
    let offset = Place::of(center_of(&points)?);
    let center = offset.mm();
    let radius = center.length();
    let end = points[points.len() - 1];
    if radius > LARGEST_RADIUS || (end.distance(center) - radius).abs() > RADIUS_MISMATCH {
        return None;
    }
    // From the first spoke, -center, to the second one.
    let turn = (points[1] - center).perp_dot(center).signum();
    let mut turned = 0.0;
    for edge in points.windows(2) {
        let [a, b] = [edge[0] - center, edge[1] - center];
        let step = sweep(a, b, turn);
        turned += step;
        let inside = radius - distance_of_segment(a, b);
        let near = (b.length() - radius).abs() <= tolerance && inside <= tolerance;
        if !near || step > LONGEST_STEP || turned > LONGEST_SWEEP {
            return None;
        }
    }
    Some(Curve { to, offset, clockwise: turn < 0.0 })
}

/// The centre, seen from the first point, which is the origin.
///
/// With m the middle and n the normal of the chord, c = m + t n. That |q - c| = |c| for a point q is
/// linear in t: t (2 n q) = |q|^2 - 2 m q.
fn center_of(points: &[DVec2]) -> Option<DVec2> {
    let chord = *points.last()?;
    let middle = chord / 2.0;
    let normal = chord.try_normalize()?.perp();
    let (mut products, mut squares) = (0.0, 0.0);
    for &q in &points[1..points.len() - 1] {
        let along = 2.0 * normal.dot(q);
        products += along * (q.length_squared() - 2.0 * middle.dot(q));
        squares += along * along;
    }
    let center = middle + normal * (products / squares);
    // Points on the chord leave t open: 0 / 0.
    center.is_finite().then_some(center)
}

/// Distance of the segment from the origin.
fn distance_of_segment(a: DVec2, b: DVec2) -> f64 {
    let edge = b - a;
    let share = (-a.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    (a + edge * share).length()
}

/// Angle from one spoke to the other in the sense of `turn` (1 or -1), 0 to a full turn.
fn sweep(from: DVec2, to: DVec2, turn: f64) -> f64 {
    let angle = trig::atan2(turn * from.perp_dot(to), from.dot(to));
    if angle < 0.0 { angle + TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    /// Points on a circle of radius `r` mm around the origin, every `step` degrees.
    fn ring(r: f64, step: i32, count: i32) -> Vec<Place> {
        let point = |k: i32| {
            let (sin, cos) = trig::sin_cos(f64::from(k * step).to_radians());
            Place::of(dvec2(r * cos, r * sin))
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn points_on_a_circle_give_its_centre_and_length() {
        // A quarter of radius 10 in steps of 3 degrees; sagitta 10 (1 - cos 1.5) = 0.0034 mm.
        let places = ring(10.0, 3, 31);
        let (last, curve) = fit_arc(&places, 0.01).expect("an arc");
        assert_eq!((last, curve.to, curve.clockwise), (30, Place { x: 0, y: 10_000 }, false));
        assert!((curve.offset.x + 10_000).abs() <= 1 && curve.offset.y.abs() <= 1, "{curve:?}");
        let shape = curve.shape(places[0]);
        assert!((shape.length - 5.0 * PI).abs() < 0.002 && (shape.radius - 10.0).abs() < 0.002);
        assert!(shape.tangents[0].distance(dvec2(0.0, 1.0)) < 1e-3);
        assert!(shape.tangents[1].distance(dvec2(-1.0, 0.0)) < 1e-3);
        // Backwards it turns clockwise.
        let back: Vec<Place> = places.into_iter().rev().collect();
        assert!(fit_arc(&back, 0.01).is_some_and(|(last, curve)| last == 30 && curve.clockwise));
    }

    #[test]
    fn a_full_circle_takes_at_least_two_arcs() {
        let (last, curve) = fit_arc(&ring(10.0, 3, 121), 0.01).expect("an arc");
        assert_eq!((last, curve.to.y.abs() <= 1), (60, true));
    }

    #[test]
    fn coarse_rings_lines_and_zigzags_stay_as_they_are() {
        // Sagitta of 10 (1 - cos 3) = 0.0137 mm.
        assert_eq!(fit_arc(&ring(10.0, 6, 31), 0.0125), None);
        let along =
            |y: fn(i32) -> i32| -> Vec<Place> { (0..9).map(|k| Place { x: 900 * k, y: y(k) }).collect() };
        assert_eq!(fit_arc(&along(|_| 0), 0.02), None);
        assert_eq!(fit_arc(&along(|k| 30 * (k % 2)), 0.02), None);
        assert_eq!(fit_arc(&along(|_| 5)[..3], 0.02), None);
    }
}
