//! Which bodies are inside out.
//!
//! A closed body whose signed volume is negative looks inward. That is right for the wall of a
//! cavity, which lies inside another body, and wrong otherwise. What lies inside what is told by a
//! vertical line through points of the body: the other bodies it crosses on its way up (or down),
//! each counted with its direction, give their winding number.

use super::Mesh;
use super::repair::Bodies;
use super::topology::{Topology, start};
use crate::sort::StableSort;
use glam::{DVec3, Vec3, dvec3};

/// How many triangles and bodies were turned.
pub(super) struct Turned {
    /// Triangles turned in bodies of which others stayed.
    pub(super) flipped_faces: usize,
    /// Bodies turned with all their triangles.
    pub(super) inverted_bodies: usize,
    /// Volume of all bodies after that, mm3.
    pub(super) volume: f64,
}

/// Decides for each body whether it is inside out, and changes `turned` (by triangle; true where it
/// is to be turned) for those that are. On entry `turned` makes the triangles of a body agree.
pub(super) fn turn_inside_out(
    mesh: &Mesh,
    topology: &Topology,
    bodies: &Bodies,
    turned: &mut [bool],
) -> Turned {
    let measures = measure(mesh, topology, bodies, turned);
    let inside_out = if measures.iter().any(|m| m.volume < -m.flat()) {
        decide(&measures, &winding(mesh, bodies, turned, &measures))
    } else {
        vec![false; bodies.count]
    };
    for (&body, turned) in bodies.of.iter().zip(turned.iter_mut()) {
        *turned ^= inside_out[body as usize];
    }
    let volumes = measures.iter().zip(&inside_out).map(|(m, &turn)| if turn { -m.volume } else { m.volume });
    count(bodies, turned, volumes.sum())
}

fn count(bodies: &Bodies, turned: &[bool], volume: f64) -> Turned {
    let mut triangles = vec![[0usize; 2]; bodies.count];
    for (&body, &turned) in bodies.of.iter().zip(turned) {
        triangles[body as usize][usize::from(turned)] += 1;
    }
    let partly = triangles.iter().filter(|[kept, _]| *kept > 0);
    Turned {
        flipped_faces: partly.map(|[_, turned]| turned).sum(),
        inverted_bodies: triangles.iter().filter(|[kept, _]| *kept == 0).count(),
        volume,
    }
}

/// What the decision needs to know of a body.
#[derive(Clone)]
struct Measure {
    /// mm3, positive when it looks outward. An open body is closed by the cone from its border to
    /// the border's centre.
    volume: f64,
    min: Vec3,
    max: Vec3,
    triangles: usize,
}

impl Measure {
    /// Volumes below this are those of a sheet, which has no inside: rounding leaves far less, a
    /// thing of paper far more.
    fn flat(&self) -> f64 {
        1e-9 * (self.max - self.min).as_dvec3().length().powi(3)
    }

    /// Whether the box of `other` lies in the box of this one.
    fn may_hold(&self, other: &Measure) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// Volume of the box.
    fn box_volume(&self) -> f64 {
        (self.max - self.min).as_dvec3().element_product()
    }
}

fn measure(mesh: &Mesh, topology: &Topology, bodies: &Bodies, turned: &[bool]) -> Vec<Measure> {
    let origins = border_centres(mesh, topology, bodies);
    let nothing = Measure { volume: 0.0, min: Vec3::INFINITY, max: Vec3::NEG_INFINITY, triangles: 0 };
    let mut measures = vec![nothing; bodies.count];
    for (t, &body) in bodies.of.iter().enumerate() {
        let corners = mesh.corners(t);
        let [a, b, c] = corners.map(|v| v.as_dvec3() - origins[body as usize]);
        let m = &mut measures[body as usize];
        let six_volumes = a.dot(b.cross(c));
        m.volume += if turned[t] { -six_volumes } else { six_volumes };
        m.min = corners.into_iter().fold(m.min, Vec3::min);
        m.max = corners.into_iter().fold(m.max, Vec3::max);
        m.triangles += 1;
    }
    measures.iter_mut().for_each(|m| m.volume /= 6.0);
    measures
}

/// For each body the mean of the points where its border edges start; for a closed one some corner.
fn border_centres(mesh: &Mesh, topology: &Topology, bodies: &Bodies) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0usize); bodies.count];
    for half_edge in topology.border() {
        let (sum, count) = &mut sums[bodies.of[(half_edge / 3) as usize] as usize];
        *sum += mesh.vertices[start(mesh, half_edge) as usize].as_dvec3();
        *count += 1;
    }
    let mut centres: Vec<Option<DVec3>> =
        sums.iter().map(|&(sum, count)| (count > 0).then(|| sum / count as f64)).collect();
    for (t, &body) in bodies.of.iter().enumerate() {
        centres[body as usize].get_or_insert_with(|| mesh.corners(t)[0].as_dvec3());
    }
    centres.into_iter().map(Option::unwrap_or_default).collect()
}

/// From the largest box to the smallest: a body that looks inward and lies in no other is turned.
/// One that looks outward is turned only where it lies in a body that was turned itself, for then
/// the whole file is inside out and this is the wall of a cavity.
fn decide(measures: &[Measure], winding: &[Vec<Sample>]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..measures.len()).collect();
    order.stable_sort_by(|&a, &b| {
        measures[b].box_volume().total_cmp(&measures[a].box_volume()).then(a.cmp(&b))
    });
    let mut inside_out = vec![None; measures.len()];
    for body in order {
        let own = &measures[body];
        let holders = holders(own, measures, &inside_out, &winding[body]);
        let is_inside = !holders.is_empty() && holders.iter().all(|around| around.winding() >= 1);
        inside_out[body] = Some(if own.volume < -own.flat() {
            !is_inside
        } else {
            own.volume > own.flat()
                && is_inside
                && holders.iter().any(|around| around.innermost_was_turned(measures))
        });
    }
    inside_out.into_iter().map(|turned| turned == Some(true)).collect()
}

/// The bodies decided already that may hold a sample of a body: number, winding number as the file
/// has it, whether it was turned.
struct Holders(Vec<(usize, i32, bool)>);

/// For each sample of the body `own` what is around it.
fn holders(
    own: &Measure,
    measures: &[Measure],
    inside_out: &[Option<bool>],
    samples: &[Sample],
) -> Vec<Holders> {
    let holder = |&(other, crossings): &(u32, Crossings)| {
        let other = other as usize;
        let turned = inside_out[other].filter(|_| measures[other].may_hold(own))?;
        Some((other, crossings.number(), turned))
    };
    samples.iter().map(|around| Holders(around.iter().filter_map(holder).collect())).collect()
}

impl Holders {
    /// How often all of them, turned as decided, wind around the sample.
    fn winding(&self) -> i32 {
        self.0.iter().map(|&(_, number, turned)| if turned { -number } else { number }).sum()
    }

    /// Whether the smallest body around the sample was turned.
    fn innermost_was_turned(&self, measures: &[Measure]) -> bool {
        let around = self.0.iter().filter(|(_, number, _)| *number != 0);
        let size = |body: usize| measures[body].box_volume();
        around.min_by(|a, b| size(a.0).total_cmp(&size(b.0))).is_some_and(|&(_, _, turned)| turned)
    }
}

/// The bodies around one point, with what a vertical line through it says.
type Sample = Vec<(u32, Crossings)>;

/// Signed crossings of one body's surface above and below a point.
#[derive(Default, Clone, Copy)]
struct Crossings {
    above: i32,
    below: i32,
}

impl Crossings {
    /// How often the body winds around the point. Both ways agree on a closed body; on an open one
    /// a way may lead out through a hole, so the larger one counts.
    fn number(self) -> i32 {
        if self.below.abs() > self.above.abs() { self.below } else { self.above }
    }
}

/// Points taken on each body; all must agree, so that a body lying half in another is not inside.
const SAMPLES: usize = 7;

/// For every body, samples of the other bodies around the centres of some of its triangles.
fn winding(mesh: &Mesh, bodies: &Bodies, turned: &[bool], measures: &[Measure]) -> Vec<Vec<Sample>> {
    let mut points = sample_points(mesh, bodies, measures);
    points.stable_sort_by(|a, b| a.at.x.total_cmp(&b.at.x).then(a.body.cmp(&b.body)));
    for (t, &body) in bodies.of.iter().enumerate() {
        let [a, b, c] = mesh.corners(t).map(Vec3::as_dvec3);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let first = points.partition_point(|p| p.at.x < low.x);
        let near = points[first..].iter_mut().take_while(|p| p.at.x <= high.x);
        for point in near.filter(|p| low.y <= p.at.y && p.at.y <= high.y && p.body != body) {
            point.cross(mesh, t, body, turned[t]);
        }
    }
    let mut samples = vec![Vec::new(); bodies.count];
    for point in points {
        samples[point.body as usize].push(point.around);
    }
    samples
}

/// A point on the surface of a body, and what is around it.
struct SamplePoint {
    at: DVec3,
    body: u32,
    around: Sample,
}

/// The centres of up to [`SAMPLES`] triangles of each body, spread over its list of triangles.
fn sample_points(mesh: &Mesh, bodies: &Bodies, measures: &[Measure]) -> Vec<SamplePoint> {
    let mut seen = vec![0; bodies.count];
    let mut points = Vec::new();
    for (t, &body) in bodies.of.iter().enumerate() {
        let step = measures[body as usize].triangles.div_ceil(SAMPLES);
        let number: &mut usize = &mut seen[body as usize];
        if number.is_multiple_of(step) {
            let [a, b, c] = mesh.corners(t).map(Vec3::as_dvec3);
            points.push(SamplePoint { at: (a + b + c) / 3.0, body, around: Vec::new() });
        }
        *number += 1;
    }
    points
}

impl SamplePoint {
    /// Counts the crossing of the vertical line through this point with a triangle, if there is one.
    fn cross(&mut self, mesh: &Mesh, triangle: usize, body: u32, turned: bool) {
        let Some((z, looks_up)) = crossing(mesh, triangle, self.at) else { return };
        let crossings = match self.around.iter().position(|(other, _)| *other == body) {
            Some(place) => &mut self.around[place].1,
            None => {
                self.around.push((body, Crossings::default()));
                &mut self.around.last_mut().expect("just pushed").1
            }
        };
        let looks_up = looks_up != turned;
        if z > self.at.z {
            crossings.above += if looks_up { 1 } else { -1 };
        } else {
            crossings.below += if looks_up { -1 } else { 1 };
        }
    }
}

/// Height at which the vertical line through `at` crosses a triangle, and whether its outside is up.
/// Seen from above, a point on an edge belongs to exactly one of the triangles at the edge: its
/// side is always asked from the edge's smaller vertex to the larger one.
fn crossing(mesh: &Mesh, triangle: usize, at: DVec3) -> Option<(f64, bool)> {
    let [a, b, c] = mesh.triangles[triangle];
    let looks_up = is_left(mesh, a, b, at);
    if is_left(mesh, b, c, at) != looks_up || is_left(mesh, c, a, at) != looks_up {
        return None;
    }
    let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let offset = at - a;
    let z = a.z - (normal.x * offset.x + normal.y * offset.y) / normal.z;
    (normal.z != 0.0).then_some((z, looks_up))
}

/// Whether `at` lies to the left of the edge from vertex `from` to vertex `to`, seen from above.
fn is_left(mesh: &Mesh, from: u32, to: u32, at: DVec3) -> bool {
    let [p, q] =
        [from.min(to), from.max(to)].map(|v| mesh.vertices[v as usize].as_dvec3() - dvec3(at.x, at.y, 0.0));
    (p.x * q.y - p.y * q.x >= 0.0) != (from > to)
}
