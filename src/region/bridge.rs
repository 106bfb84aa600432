//! Bridges: fill with air below that is held at both ends of its lines.
//!
//! For each piece of fill over air the lines are tried in several directions; the one in which most
//! of their length ends on the layer below at both ends is taken, of equal ones that with the
//! shortest span. A piece with most of its length held at one end or none is no bridge.

use crate::polygon::measure::Bounds;
use crate::polygon::strips::Strips;
use crate::polygon::trig::sin_cos;
use crate::polygon::{DVec2, Join, Polygon, PolygonSet};
use crate::sort::StableSort;

/// Directions tried besides those of the piece's own edges.
const EVEN_DIRECTIONS: u32 = 12;

/// Edges whose directions are tried, the longest.
const EDGES_TRIED: usize = 8;

/// Lines tried in each direction at most.
const LINES_TRIED: f64 = 40.0;

/// Share of the lines' length that must be held at both ends.
const HELD_SHARE: f64 = 0.6;

/// Shares closer than this count as equal.
const SAME_SHARE: f64 = 0.05;

/// How far a bridge's lines run on over what holds them, in bead widths.
const ANCHOR: f64 = 3.0;

/// Bridges are at least this wide, in bead widths.
const NARROWEST: f64 = 2.0;

/// A bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// What it fills, its ends over the layer below included.
    pub area: PolygonSet,
    /// Unit vector along its lines.
    pub direction: DVec2,
    /// Longest stretch of a line in the air, mm.
    pub span: f64,
}

/// The bridges in the fill `inner` of a layer that lies on the layer `below`; `bead_width` in mm.
pub fn bridges(inner: &PolygonSet, below: &PolygonSet, bead_width: f64) -> Vec<Bridge> {
    let over_air = inner.difference(below).opened(bead_width * NARROWEST / 2.0, Join::WALL);
    if over_air.is_empty() {
        return Vec::new();
    }
    let ground = Strips::new(below);
    let mut bridges: Vec<Bridge> = Vec::new();
    for piece in over_air.islands() {
        let Some((direction, span)) = bridging_direction(&piece, &ground, bead_width) else { continue };
        let reach = piece.into_set().offset(ANCHOR * bead_width, Join::WALL).intersection(inner);
        let taken = PolygonSet::union_all(bridges.iter().map(|b| &b.area));
        bridges.push(Bridge { area: reach.difference(&taken), direction, span });
    }
    bridges
}

/// The direction in which lines over `piece` are held best, if they are held, and the longest of those
/// that are held at both ends, mm.
fn bridging_direction(piece: &Polygon, ground: &Strips, bead_width: f64) -> Option<(DVec2, f64)> {
    let spans: Vec<(DVec2, Spans)> =
        directions(piece).into_iter().map(|d| (d, Spans::of(piece, d, ground, bead_width))).collect();
    let best = spans.iter().map(|(_, s)| s.held_share()).fold(0.0, f64::max);
    let good = spans.iter().filter(|(_, s)| s.held_share() >= HELD_SHARE.max(best - SAME_SHARE));
    good.min_by(|a, b| a.1.longest.total_cmp(&b.1.longest)).map(|(d, spans)| (*d, spans.longest))
}

/// Directions worth trying: along and across the longest edges, then evenly spread ones.
fn directions(piece: &Polygon) -> Vec<DVec2> {
    let contours = piece.contours();
    let mut edges: Vec<DVec2> = contours.flat_map(|c| c.edges().map(|(a, b)| b - a)).collect();
    edges.stable_sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    edges.truncate(EDGES_TRIED);
    let along = edges.iter().map(|e| e.normalize_or(DVec2::X));
    let even = (0..EVEN_DIRECTIONS).map(|i| {
        let (sin, cos) = sin_cos(f64::from(i) * std::f64::consts::PI / f64::from(EVEN_DIRECTIONS));
        DVec2::new(cos, sin)
    });
    along.flat_map(|d| [d, d.perp()]).chain(even).collect()
}

/// What lines in one direction come to.
#[derive(Debug, Default)]
struct Spans {
    total: f64,
    held: f64,
    longest: f64,
}

impl Spans {
    fn of(piece: &Polygon, direction: DVec2, ground: &Strips, bead_width: f64) -> Spans {
        let turn = |p: DVec2| DVec2::new(p.dot(direction), direction.perp_dot(p));
        let contours = piece.contours();
        let edges: Vec<(DVec2, DVec2)> =
            contours.flat_map(|c| c.edges().map(|(a, b)| (turn(a), turn(b)))).collect();
        let ends: Vec<DVec2> = edges.iter().map(|e| e.0).collect();
        let Some(Bounds { min, max }) = Bounds::of_points(&ends) else { return Spans::default() };
        let count = ((max.y - min.y) / bead_width).clamp(1.0, LINES_TRIED).ceil();
        let mut spans = Spans::default();
        for line in 0..count as u32 {
            let v = min.y + (max.y - min.y) * (f64::from(line) + 0.5) / count;
            let crossing = |&(a, b): &(DVec2, DVec2)| {
                ((a.y > v) != (b.y > v)).then(|| a.x + (v - a.y) * (b.x - a.x) / (b.y - a.y))
            };
            let mut crossings: Vec<f64> = edges.iter().filter_map(crossing).collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let back = |u: f64| direction * u + direction.perp() * v;
                let is_held =
                    ground.contain(back(pair[0] - bead_width)) && ground.contain(back(pair[1] + bead_width));
                spans.add(pair[1] - pair[0], is_held);
            }
        }
        spans
    }

    fn add(&mut self, length: f64, is_held: bool) {
        self.total += length;
        if is_held {
            self.held += length;
            self.longest = self.longest.max(length);
        }
    }

    fn held_share(&self) -> f64 {
        if self.total > 0.0 { self.held / self.total } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1))
    }

    #[test]
    fn a_deck_on_two_pillars_runs_from_one_to_the_other() {
        let pillars = rectangle(0.0, 0.0, 5.0, 8.0).union(&rectangle(25.0, 0.0, 30.0, 8.0));
        let [bridge] = &bridges(&rectangle(1.0, 1.0, 29.0, 7.0), &pillars, 0.45)[..] else { panic!() };
        assert!(bridge.direction.perp_dot(DVec2::X).abs() < 1e-9);
        assert!((bridge.area.area() - (20.0 + 6.0 * 0.45) * 6.0).abs() < 0.01);
        assert!((bridge.span - 20.0).abs() < 1e-9);
    }

    #[test]
    fn a_slot_is_bridged_across_and_a_slanted_one_too() {
        let turned = |p: DVec2| DVec2::from_angle(0.3).rotate(p);
        let bar = |x0: f64, x1: f64| {
            let corners = [dvec2(x0, 0.0), dvec2(x1, 0.0), dvec2(x1, 40.0), dvec2(x0, 40.0)].map(turned);
            PolygonSet::from_contours(vec![crate::polygon::Contour::new(corners.to_vec())])
        };
        let below = bar(0.0, 5.0).union(&bar(11.0, 16.0));
        let [bridge] = &bridges(&bar(1.0, 15.0), &below, 0.45)[..] else { panic!() };
        assert!(bridge.direction.perp_dot(turned(DVec2::X)).abs() < 1e-4, "{}", bridge.direction);
    }

    #[test]
    fn a_balcony_and_a_free_plate_are_no_bridges() {
        let wall = rectangle(0.0, 0.0, 5.0, 20.0);
        assert_eq!(bridges(&rectangle(1.0, 1.0, 15.0, 19.0), &wall, 0.45), []);
        assert_eq!(bridges(&rectangle(50.0, 1.0, 65.0, 19.0), &wall, 0.45), []);
    }
}
