//! Loops that change their width where they face each other closely.
//!
//! How closely is found by shrinking balls [Ma, Bae, Choi 2012, "3D medial axis point approximation
//! using nearest neighbors and the normal field"]: the largest circle that touches a loop at a point
//! from inside and crosses no loop. Circles in corners say nothing of the thickness; there the
//! distance is taken from the points beside.

use super::{FittedBead, Strips};
use crate::polygon::grid::EdgeGrid;
use crate::polygon::measure::Bounds;
use crate::polygon::strips::Strips as Inside;
use crate::polygon::{Contour, DVec2, PolygonSet};
use crate::region::Path;
use crate::toolpath::medial::{Sample, ring};

/// Distance of the points at which a loop's width is found, mm: about a bead's width.
const STEP_MM: f64 = 0.4;

/// Balls start larger by this than the widest that matters, mm.
const BORDER_MM: f64 = 0.01;

/// A ball that touches two sides counts if they are seen from its middle under more than this angle's
/// cosine, 120 degrees; otherwise it sits in a corner.
const FACING_COSINE: f64 = -0.5;

/// Rounds of shrinking; a ball mostly needs two or three.
const ROUNDS: usize = 12;

/// Balls that shrink by less than this are done, mm.
const SAME_RADIUS: f64 = 1e-4;

/// A bead's line is moved this much farther than its neighbours' at a corner at most.
const MOST_MITRE: f64 = 1.5;

/// The loops along `lines`, wider or narrower where they face each other closer than
/// `strips.widest`, which is so nowhere but in `close`.
pub(super) fn loops(lines: PolygonSet, close: &PolygonSet, fitted: FittedBead) -> Vec<Path> {
    let FittedBead { bead, role, strips } = fitted;
    let plain = |c: Contour| Path::closed(role, c.points, bead.width);
    let edges: Vec<(DVec2, DVec2)> = lines.contours().iter().flat_map(|c| c.edges()).collect();
    let field =
        Field { edges: EdgeGrid::new(&edges), inside: Inside::new(close), box_of: close.bounds(), strips };
    let fit = |contour: Contour| match field.fitted(&contour, bead.width) {
        Some(samples) => ring(role, samples),
        None => Some(plain(contour)),
    };
    lines.into_contours().into_iter().filter_map(fit).collect()
}

struct Field {
    edges: EdgeGrid,
    /// Where loops are close.
    inside: Inside,
    box_of: Option<Bounds>,
    strips: Strips,
}

/// A point of a loop.
struct Point {
    at: DVec2,
    /// Unit vector into the part, lengthened at corners.
    inward: DVec2,
    /// Distance to the loop opposite: none where the loop is not close to another, or `Unknown`.
    facing: Facing,
}

#[derive(Clone, Copy, PartialEq)]
enum Facing {
    /// Nothing near.
    Far,
    /// Another loop at this distance, mm.
    At(f64),
    /// In a corner.
    Unknown,
}

impl Field {
    /// The loop with new places and widths; `None` if nothing changes.
    fn fitted(&self, contour: &Contour, width: f64) -> Option<Vec<Sample>> {
        let near = contour.bounds().zip(self.box_of).is_some_and(|(a, b)| a.is_near(b, 0.0));
        if !near || !contour.points.iter().any(|&p| self.inside.contain(p)) && !self.any_middle(contour) {
            return None;
        }
        let mut points = self.points(contour);
        resolve(&mut points);
        let changed = points.iter().any(|p| matches!(p.facing, Facing::At(_)));
        let sample = |p: &Point| {
            let change = match p.facing {
                Facing::At(distance) => {
                    distance.clamp(self.strips.narrowest, self.strips.widest) - self.strips.usual
                }
                Facing::Far | Facing::Unknown => 0.0,
            };
            // Each of the two takes half of the change; its line moves by a quarter.
            Sample { at: p.at + p.inward * (change / 4.0), radius: (width + change / 2.0) / 2.0 }
        };
        changed.then(|| points.iter().map(sample).collect())
    }

    fn any_middle(&self, contour: &Contour) -> bool {
        contour.edges().any(|(a, b)| pieces(a, b).any(|p| self.inside.contain(p)))
    }

    /// The loop's vertices, and points every `STEP_MM` on edges in close places.
    fn points(&self, contour: &Contour) -> Vec<Point> {
        let corners = &contour.points;
        let n = corners.len();
        let normal = |i: usize| (corners[(i + 1) % n] - corners[i % n]).normalize_or_zero().perp();
        let mut points = Vec::with_capacity(2 * n);
        for i in 0..n {
            let (before, after) = (normal(i + n - 1), normal(i));
            let middle = (before + after).normalize_or(after);
            let inward = middle / middle.dot(after).max(1.0 / MOST_MITRE);
            points.push(self.point(corners[i], middle, inward));
            let between = pieces(corners[i], corners[(i + 1) % n]).filter(|&p| self.inside.contain(p));
            points.extend(between.map(|p| self.point(p, after, after)));
        }
        points
    }

    fn point(&self, at: DVec2, normal: DVec2, inward: DVec2) -> Point {
        let facing = if self.inside.contain(at) { self.facing(at, normal) } else { Facing::Far };
        Point { at, inward, facing }
    }

    /// The diameter of the largest circle that touches the loop at `p` from inside.
    fn facing(&self, p: DVec2, normal: DVec2) -> Facing {
        let largest = self.strips.widest / 2.0 + BORDER_MM;
        let mut radius = largest;
        let mut touched = None;
        for _ in 0..ROUNDS {
            let centre = p + normal * radius;
            let nearest = self.edges.nearest(centre, radius);
            let Some(x) = nearest.filter(|x| x.distance(centre) < radius - SAME_RADIUS) else { break };
            let way = x - p;
            let next = way.length_squared() / (2.0 * normal.dot(way)).max(1e-9);
            touched = Some(x);
            if next >= radius - SAME_RADIUS {
                break;
            }
            radius = next;
        }
        let Some(x) = touched else { return Facing::Far };
        let centre = p + normal * radius;
        let cosine = (x - centre).normalize_or_zero().dot(-normal);
        if cosine < FACING_COSINE { Facing::At(2.0 * radius) } else { Facing::Unknown }
    }
}

/// Points that cut an edge into equal pieces of at most `STEP_MM`.
fn pieces(a: DVec2, b: DVec2) -> impl Iterator<Item = DVec2> {
    let count = (a.distance(b) / STEP_MM).ceil().max(1.0) as usize;
    (1..count).map(move |i| a.lerp(b, i as f64 / count as f64))
}

/// Points in corners take the distance of the nearer known neighbour along the loop.
fn resolve(points: &mut [Point]) {
    let n = points.len();
    let known = |i: usize| points[i].facing != Facing::Unknown;
    let found: Vec<Option<Facing>> = (0..n)
        .map(|i| {
            if known(i) {
                return None;
            }
            let back = (1..n).find(|k| known((i + n - k) % n)).map(|k| (i + n - k) % n);
            let on = (1..n).find(|k| known((i + k) % n)).map(|k| (i + k) % n);
            let nearer = back.into_iter().chain(on).min_by(|&a, &b| {
                let distance = |j: usize| points[j].at.distance_squared(points[i].at);
                distance(a).total_cmp(&distance(b))
            });
            Some(nearer.map_or(Facing::Far, |j| points[j].facing))
        })
        .collect();
    for (point, found) in points.iter_mut().zip(found) {
        point.facing = found.unwrap_or(point.facing);
    }
}
