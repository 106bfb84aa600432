//! The part cut by vertical planes, each edge with what its facet means for supports.

use super::options::SupportOptions;
use super::plane::{Edge, PlaneSection, Zone};
use crate::mesh::Mesh;
use crate::polygon::trig::sin_cos;
use crate::polygon::{DVec2, dvec2};
use crate::sets::Sets;
use crate::slice::chain::NO_FACET;
use crate::slice::{Axis, Gap, Loop, slice_loops};

/// Added to the sine of the overhang angle: facets of f32 vertices that lean by exactly the angle
/// hold themselves.
const LEAN_SLACK: f64 = 1e-3;

/// What is known of each facet of a mesh.
pub(super) struct Facets {
    /// It leans past the overhang angle.
    pub(super) leans: Vec<bool>,
    /// It bounds a cavity that is closed in 3D.
    pub(super) is_cavity: Vec<bool>,
    limit: f64,
}

impl Facets {
    pub(super) fn of(mesh: &Mesh, options: &SupportOptions) -> Facets {
        let limit = sin_cos(options.overhang_angle_deg.to_radians()).0;
        let leans = |t: usize| downward(mesh, t) > limit + LEAN_SLACK;
        let count = mesh.triangles.len();
        let leans = if limit == 0.0 { Vec::new() } else { (0..count).map(leans).collect() };
        Facets { leans, is_cavity: cavities(mesh), limit }
    }

    fn edge(&self, from: DVec2, to: DVec2, facet: u32) -> Edge {
        // At angle 0 every downward edge counts, however rounding turned its facet.
        let across = (to - from).normalize_or_zero().x;
        let leans = match self.leans.get(facet as usize) {
            _ if self.limit == 0.0 => true,
            Some(&leans) => leans,
            None => across > self.limit + LEAN_SLACK,
        };
        let is_cavity = facet != NO_FACET && self.is_cavity.get(facet as usize) == Some(&true);
        Edge { from, to, leans, is_cavity }
    }
}

/// Minus the z of the facet's unit normal: the sine of its lean from the vertical, positive when it
/// faces down.
pub(super) fn downward(mesh: &Mesh, triangle: usize) -> f64 {
    let [a, b, c] = mesh.corners(triangle).map(|v| v.as_dvec3());
    -(b - a).cross(c - a).normalize_or_zero().z
}

/// Facets of shells that enclose nothing but air: their volume is negative. Empty without any.
fn cavities(mesh: &Mesh) -> Vec<bool> {
    let mut sets = Sets::new(mesh.vertices.len());
    for &[a, b, c] in &mesh.triangles {
        sets.join(a as usize, b as usize);
        sets.join(b as usize, c as usize);
    }
    let shells: Vec<usize> = mesh.triangles.iter().map(|t| sets.root(t[0] as usize)).collect();
    let mut volume = vec![0.0; mesh.vertices.len()];
    for (t, &shell) in shells.iter().enumerate() {
        let [a, b, c] = mesh.corners(t).map(|v| v.as_dvec3());
        volume[shell] += a.dot(b.cross(c));
    }
    let found: Vec<bool> = shells.iter().map(|&s| volume[s] < 0.0).collect();
    if found.contains(&true) { found } else { Vec::new() }
}

/// The sections of the planes `axis = places[i]`, ascending, with the openings that were closed.
pub(super) fn sections(
    mesh: &Mesh,
    facets: &Facets,
    options: &SupportOptions,
    axis: Axis,
    places: &[f64],
) -> Vec<(PlaneSection, Vec<Gap>)> {
    let cuts = slice_loops(mesh, axis, places).into_iter().zip(places);
    let section = |((loops, gaps), &at): ((Vec<Loop>, Vec<Gap>), &f64)| {
        let edges = loops.iter().flat_map(|l| {
            let n = l.points.len();
            (0..n).map(|i| facets.edge(l.points[i], l.points[(i + 1) % n], l.facets[i])).collect::<Vec<_>>()
        });
        (PlaneSection { edges: edges.collect(), zones: zones(options, axis, at) }, gaps)
    };
    cuts.map(section).collect()
}

/// The boxes of the settings, cut by a plane.
fn zones(options: &SupportOptions, axis: Axis, at: f64) -> Vec<Zone> {
    let cut = |corners: &[f64; 6], enforce: bool| {
        let [low, high] = ordered(corners);
        let (across, along) = if axis == Axis::X { (0, 1) } else { (1, 0) };
        let met = low[across] <= at && at <= high[across];
        met.then(|| Zone { min: dvec2(low[along], low[2]), max: dvec2(high[along], high[2]), enforce })
    };
    let enforced = options.enforcers.iter().filter_map(|b| cut(b, true));
    enforced.chain(options.blockers.iter().filter_map(|b| cut(b, false))).collect()
}

/// The smallest and the largest corner of a box given by any two opposite ones.
pub(super) fn ordered(corners: &[f64; 6]) -> [[f64; 3]; 2] {
    let pick = |choose: fn(f64, f64) -> f64| [0, 1, 2].map(|i| choose(corners[i], corners[i + 3]));
    [pick(f64::min), pick(f64::max)]
}
