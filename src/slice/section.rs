//! One plane and triangles: directed segments with the part on their left.

use glam::DVec2;

use super::axis::Axis;
use crate::mesh::Mesh;
use crate::polygon::snap;

/// A mesh edge as the pair of its vertex indices, smaller one first.
pub type EdgeKey = u64;

/// The cut through one triangle, directed so that the part lies to its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Start, mm, on the polygon grid.
    pub from: DVec2,
    /// End, mm, on the polygon grid.
    pub to: DVec2,
    /// Mesh edge on which the segment starts; the neighbour that shares it ends there.
    pub from_edge: EdgeKey,
    /// Mesh edge on which the segment ends.
    pub to_edge: EdgeKey,
    /// Index of the triangle that was cut.
    pub facet: u32,
}

/// Which triangles cross which planes, gathered in one counting sort.
#[derive(Debug)]
pub struct Crossings {
    /// `triangles[starts[i]..starts[i + 1]]` cross plane i, in mesh order.
    triangles: Vec<u32>,
    starts: Vec<u32>,
}

impl Crossings {
    /// Finds the crossings of the planes `axis = heights[i]`, heights ascending, mm, with the given
    /// triangles.
    pub fn find(
        mesh: &Mesh,
        axis: Axis,
        heights: &[f64],
        candidates: impl Iterator<Item = u32> + Clone,
    ) -> Crossings {
        let mut starts = vec![0u32; heights.len() + 1];
        let spans = || candidates.clone().map(|t| (t, planes_crossed(mesh, axis, heights, t)));
        for (_, span) in spans() {
            for plane in span {
                starts[plane + 1] += 1;
            }
        }
        for i in 0..heights.len() {
            starts[i + 1] += starts[i];
        }
        // Heights are non-empty or there is nothing to place: the last start is the total.
        let mut triangles = vec![0u32; starts[heights.len()] as usize];
        let mut next = starts.clone();
        for (t, span) in spans() {
            for plane in span {
                triangles[next[plane] as usize] = t;
                next[plane] += 1;
            }
        }
        Crossings { triangles, starts }
    }

    /// The triangles that cross plane `index`.
    pub fn of_plane(&self, index: usize) -> &[u32] {
        &self.triangles[self.starts[index] as usize..self.starts[index + 1] as usize]
    }
}

/// Planes with a vertex of the triangle below and one in or above them.
fn planes_crossed(mesh: &Mesh, axis: Axis, heights: &[f64], triangle: u32) -> std::ops::Range<usize> {
    let [a, b, c] = mesh.corners(triangle as usize).map(|v| axis.height(v));
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let (Some(&lowest), Some(&highest)) = (heights.first(), heights.last()) else { return 0..0 };
    if low == high || f64::from(high) < lowest || highest <= f64::from(low) {
        return 0..0;
    }
    let first = heights.partition_point(|&h| h <= f64::from(low));
    // Mostly few are crossed.
    first..first + heights[first..].iter().take_while(|&&h| h <= f64::from(high)).count()
}

/// Cuts the given triangles, all of which cross the plane `axis = height`.
pub fn cut(mesh: &Mesh, axis: Axis, height: f64, triangles: &[u32]) -> Vec<Segment> {
    triangles.iter().map(|&t| cut_triangle(mesh, axis, height, t)).collect()
}

fn cut_triangle(mesh: &Mesh, axis: Axis, height: f64, facet: u32) -> Segment {
    let corners = mesh.triangles[facet as usize];
    let above = corners.map(|v| f64::from(axis.height(mesh.vertices[v as usize])) >= height);
    // One corner lies alone on its side: the triangle crosses the plane.
    let lone =
        (0..3).find(|&i| above[i] != above[(i + 1) % 3] && above[i] != above[(i + 2) % 3]).unwrap_or(0);
    let (tip, next, previous) = (corners[lone], corners[(lone + 1) % 3], corners[(lone + 2) % 3]);
    // Seen against the normal, outside is on the right when going from edge tip-next to previous-tip.
    let forward = above[lone] != axis.is_left_handed();
    let (first, last) = if forward { (next, previous) } else { (previous, next) };
    Segment {
        from: cross_edge(mesh, axis, height, tip, first),
        to: cross_edge(mesh, axis, height, tip, last),
        from_edge: edge_key(tip, first),
        to_edge: edge_key(tip, last),
        facet,
    }
}

fn edge_key(a: u32, b: u32) -> EdgeKey {
    (u64::from(a.min(b)) << 32) | u64::from(a.max(b))
}

/// Where an edge meets the plane. The edge is walked upward, so that both neighbours, and any part
/// of the mesh that holds them, get the same point to the last bit.
fn cross_edge(mesh: &Mesh, axis: Axis, height: f64, a: u32, b: u32) -> DVec2 {
    let [a, b] = [a, b].map(|v| mesh.vertices[v as usize]);
    // The edge crosses the plane, so its ends differ in height.
    let (p, q) = if axis.height(a) < axis.height(b) { (a, b) } else { (b, a) };
    let (from, to) = (f64::from(axis.height(p)), f64::from(axis.height(q)));
    let share = (height - from) / (to - from);
    let (p, q) = (axis.flat(p), axis.flat(q));
    snap(p + (q - p) * share)
}
