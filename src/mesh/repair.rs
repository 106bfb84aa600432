//! Putting right what can be put right without guessing; every repair is counted.
//!
//! In order: repeated triangles go; vertices that almost meet on open edges are merged; triangles
//! without area go, their neighbours closing the seam; triangles are turned to agree with their
//! neighbours; bodies that are inside out are turned ([`turn`](super::turn)). Holes are not filled.

use super::topology::{Beyond, Patches, Topology, end, start};
use super::turn::{self, Turned};
use super::{Mesh, weld};
use crate::sets::Sets;
use crate::sort::StableSort;
use glam::Vec3;
use std::collections::HashMap;

/// Distance below which vertices on open edges are taken for one, mm. A micrometre is a tenth of
/// what any printer resolves, and more than the digits that exporters lose on parts up to 10 m
/// (f32) or 1 m (six digits in text).
pub const MERGE_MM: f32 = 1e-3;

/// What was repaired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Repairs {
    /// Triangles without area that were dropped.
    pub degenerate_dropped: usize,
    /// Triangles dropped because an earlier one has the same corners in the same direction.
    pub duplicates_dropped: usize,
    /// Vertices on open edges that were merged into another one at most [`MERGE_MM`] away.
    pub merged_vertices: usize,
    /// Triangles that were turned because they disagreed with the rest of their body.
    pub flipped_faces: usize,
    /// Bodies that were turned as a whole because they were inside out.
    pub inverted_shells: usize,
}

/// What a mesh is like once it is repaired.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Condition {
    /// Enclosed volume, mm3. What is open is closed for this by the cone from its border to the
    /// border's centre; where bodies overlap, the common part counts once for each.
    pub volume: f64,
    /// Parts that share no edge with each other.
    pub shells: usize,
    /// Edges with one triangle.
    pub open_edges: usize,
    /// Edges with three triangles or more.
    pub non_manifold_edges: usize,
    /// Of these, the edges whose triangles do not come in pairs of opposite direction. The others
    /// are places where solids touch, which is no fault.
    pub unbalanced_edges: usize,
    /// Edges whose two triangles cannot be made to agree, as on a Moebius strip.
    pub twisted_edges: usize,
}

/// Repairs a mesh in place. Time and memory are linear in the triangles; a sound mesh comes out
/// unchanged.
pub fn repair(mesh: &mut Mesh) -> (Repairs, Condition) {
    let mut repairs = Repairs { degenerate_dropped: drop_collapsed(mesh), ..Repairs::default() };
    let mut topology = Topology::new(mesh);
    drop_duplicates(mesh, &mut topology, &mut repairs);
    if topology.open_edges() > 0 {
        repairs.merged_vertices = merge_near_vertices(mesh, &topology);
        if repairs.merged_vertices > 0 {
            repairs.degenerate_dropped += drop_collapsed(mesh);
            topology = Topology::new(mesh);
            drop_duplicates(mesh, &mut topology, &mut repairs);
        }
    }
    repairs.degenerate_dropped += drop_slivers(mesh, &mut topology);
    let condition = face_outward(mesh, &topology, &mut repairs);
    (repairs, condition)
}

/// Drops triangles that use a vertex twice.
fn drop_collapsed(mesh: &mut Mesh) -> usize {
    let is_collapsed = |&t: &u32| weld::uses_a_vertex_twice(mesh.triangles[t as usize]);
    let collapsed: Vec<u32> = (0..mesh.triangles.len() as u32).filter(is_collapsed).collect();
    weld::drop_triangles(mesh, &collapsed);
    collapsed.len()
}

fn drop_duplicates(mesh: &mut Mesh, topology: &mut Topology, repairs: &mut Repairs) {
    let dropped = weld::drop_duplicates(mesh, topology);
    if dropped > 0 {
        repairs.duplicates_dropped += dropped;
        *topology = Topology::new(mesh);
    }
}

/// Merges vertices on open edges that lie within [`MERGE_MM`] of an earlier such vertex. Returns how
/// many went. Each vertex joins the first one in reach, in the order of their numbers.
fn merge_near_vertices(mesh: &mut Mesh, topology: &Topology) -> usize {
    let mut on_border: Vec<u32> = topology.border().flat_map(|h| [start(mesh, h), end(mesh, h)]).collect();
    on_border.sort_unstable();
    on_border.dedup();
    let mut names: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut cells = Cells::default();
    let mut merged = 0;
    for &v in &on_border {
        names[v as usize] = cells.first_near(&mesh.vertices, v).unwrap_or_else(|| {
            cells.insert(&mesh.vertices, v);
            v
        });
        merged += usize::from(names[v as usize] != v);
    }
    for v in mesh.triangles.as_flattened_mut() {
        *v = names[*v as usize];
    }
    weld::drop_unused_vertices(mesh);
    merged
}

/// Vertices by cell of a cubic grid, for finding near ones. Only looked up, never walked through,
/// so that the map's order does not matter.
#[derive(Default)]
struct Cells {
    members: HashMap<[i64; 3], Vec<u32>>,
}

impl Cells {
    /// Edge of a cell: wide enough that most vertices have all their neighbours in their own one.
    const EDGE_MM: f64 = 8.0 * MERGE_MM as f64;

    fn cell_of(position: Vec3) -> [i64; 3] {
        position.as_dvec3().to_array().map(|x| (x / Self::EDGE_MM).floor() as i64)
    }

    fn insert(&mut self, vertices: &[Vec3], v: u32) {
        self.members.entry(Self::cell_of(vertices[v as usize])).or_default().push(v);
    }

    /// The smallest number of a member within [`MERGE_MM`] of vertex `v`.
    fn first_near(&self, vertices: &[Vec3], v: u32) -> Option<u32> {
        let position = vertices[v as usize];
        let is_near = |m: &u32| vertices[*m as usize].distance_squared(position) <= MERGE_MM * MERGE_MM;
        let [low, high] = [-MERGE_MM, MERGE_MM].map(|by| Self::cell_of(position + by));
        let mut nearest = None;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let members = self.members.get(&[x, y, z]).map_or(&[][..], Vec::as_slice);
                    let found = members.iter().copied().find(|m| is_near(m));
                    nearest = [nearest, found].into_iter().flatten().min();
                }
            }
        }
        nearest
    }
}

/// Drops triangles whose corners lie on one line. Returns how many.
///
/// Such a triangle closes the seam between its long side's neighbour and the two triangles at its
/// short sides. Before it goes, that neighbour is split at the middle corner, so that the mesh
/// stays closed (the flip of a "cap": Botsch, Kobbelt, A robust procedure to eliminate degenerate
/// faces from triangle meshes, 2001). Chains of them take several rounds; what cannot be flipped
/// is just dropped.
fn drop_slivers(mesh: &mut Mesh, topology: &mut Topology) -> usize {
    /// Rounds in which chains are undone; each one rebuilds the topology.
    const ROUNDS: usize = 16;
    let mut dropped = 0;
    for round in 1.. {
        let slivers: Vec<u32> = (0..mesh.triangles.len() as u32).filter(|&t| is_sliver(mesh, t)).collect();
        if slivers.is_empty() {
            break;
        }
        let flipped = flip_slivers(mesh, topology, &slivers);
        dropped += flipped;
        if flipped == 0 || round == ROUNDS {
            let left: Vec<u32> = slivers.into_iter().filter(|&t| is_sliver(mesh, t)).collect();
            dropped += left.len();
            weld::drop_triangles(mesh, &left);
        }
        *topology = Topology::new(mesh);
    }
    dropped
}

/// Whether the triangle has exactly no area.
fn is_sliver(mesh: &Mesh, triangle: u32) -> bool {
    let [a, b, c] = mesh.corners(triangle as usize).map(Vec3::as_dvec3);
    (b - a).cross(c - a) == glam::DVec3::ZERO
}

/// Replaces slivers and their neighbours, no triangle more than once. Returns how many slivers went.
fn flip_slivers(mesh: &mut Mesh, topology: &Topology, slivers: &[u32]) -> usize {
    let mut is_taken = vec![false; mesh.triangles.len()];
    let mut flipped = 0;
    for &sliver in slivers {
        let long_side = longest_edge(mesh, sliver);
        let Beyond::Twin(twin) = topology.beyond(sliver as usize, long_side) else { continue };
        let [own, other] = [sliver as usize, (twin / 3) as usize];
        if is_taken[own] || is_taken[other] || slivers.binary_search(&(twin / 3)).is_ok() {
            continue;
        }
        let middle = mesh.triangles[own][(long_side + 2) % 3];
        let (from, to) = (start(mesh, twin), end(mesh, twin));
        let far = mesh.triangles[other][((twin % 3 + 2) % 3) as usize];
        mesh.triangles[own] = [from, middle, far];
        mesh.triangles[other] = [middle, to, far];
        is_taken[own] = true;
        is_taken[other] = true;
        flipped += 1;
    }
    flipped
}

/// Which of the three edges is the longest.
fn longest_edge(mesh: &Mesh, triangle: u32) -> usize {
    let corners = mesh.corners(triangle as usize).map(Vec3::as_dvec3);
    let length = |k: usize| corners[k].distance_squared(corners[(k + 1) % 3]);
    (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or(0)
}

/// Turns triangles so that all look outward, and says what the mesh is like then.
fn face_outward(mesh: &mut Mesh, topology: &Topology, repairs: &mut Repairs) -> Condition {
    let mut patches = topology.patches(mesh);
    keep_the_majority(&mut patches);
    let bodies = bodies(mesh, topology, &patches);
    let Turned { flipped_faces, inverted_bodies, volume } =
        turn::turn_inside_out(mesh, topology, &bodies, &mut patches.turned);
    repairs.flipped_faces = flipped_faces;
    repairs.inverted_shells = inverted_bodies;
    let condition = Condition {
        volume,
        shells: shell_count(topology, &patches),
        open_edges: topology.open_edges(),
        non_manifold_edges: topology.non_manifold_edges(),
        unbalanced_edges: unbalanced_edges(mesh, topology, &patches),
        twisted_edges: patches.twisted,
    };
    for (triangle, _) in mesh.triangles.iter_mut().zip(&patches.turned).filter(|(_, turned)| **turned) {
        triangle.swap(1, 2);
    }
    condition
}

/// Turns the smaller part of each patch, so that most triangles stay as the file has them.
fn keep_the_majority(patches: &mut Patches) {
    let mut balance = vec![0i64; patches.count as usize];
    for (&patch, &turned) in patches.of.iter().zip(&patches.turned) {
        balance[patch as usize] += if turned { 1 } else { -1 };
    }
    for (&patch, turned) in patches.of.iter().zip(&mut patches.turned) {
        *turned ^= balance[patch as usize] > 0;
    }
}

/// Triangles grouped into bodies: pieces of surface with an inside of their own.
pub(super) struct Bodies {
    /// By triangle: number of its body.
    pub(super) of: Vec<u32>,
    /// How many there are.
    pub(super) count: usize,
}

/// A patch is a body, unless it ends at edges with several triangles and needs other patches there
/// to be closed: then these patches are one body. Solids that merely touch in an edge stay apart.
fn bodies(mesh: &Mesh, topology: &Topology, patches: &Patches) -> Bodies {
    let mut sets = Sets::new(patches.count as usize);
    for edge in topology.crowded_edges() {
        let mut ends: Vec<(u32, i32)> =
            edge.iter().map(|&h| (patch_of(patches, h), direction(mesh, patches, h))).collect();
        ends.stable_sort_by(Ord::cmp);
        let needy =
            ends.chunk_by(|a, b| a.0 == b.0).filter(|same| same.iter().map(|e| e.1).sum::<i32>() != 0);
        let needy: Vec<u32> = needy.map(|same| same[0].0).collect();
        for pair in needy.windows(2) {
            sets.join(pair[0] as usize, pair[1] as usize);
        }
    }
    let (numbers, count) = sets.numbers();
    Bodies { of: patches.of.iter().map(|&p| numbers[p as usize]).collect(), count }
}

/// Parts of the mesh connected through any edge.
fn shell_count(topology: &Topology, patches: &Patches) -> usize {
    let mut sets = Sets::new(patches.count as usize);
    for edge in topology.crowded_edges() {
        for &h in edge {
            sets.join(patch_of(patches, edge[0]) as usize, patch_of(patches, h) as usize);
        }
    }
    sets.numbers().1
}

/// Edges of several triangles that do not come in pairs of opposite direction.
fn unbalanced_edges(mesh: &Mesh, topology: &Topology, patches: &Patches) -> usize {
    let sum = |edge: &[u32]| edge.iter().map(|&h| direction(mesh, patches, h)).sum::<i32>();
    topology.crowded_edges().filter(|edge| sum(edge) != 0).count()
}

fn patch_of(patches: &Patches, half_edge: u32) -> u32 {
    patches.of[(half_edge / 3) as usize]
}

/// 1 where the half-edge, its triangle turned if need be, runs to the larger vertex, else -1.
fn direction(mesh: &Mesh, patches: &Patches, half_edge: u32) -> i32 {
    let runs_up = start(mesh, half_edge) < end(mesh, half_edge);
    if runs_up != patches.turned[(half_edge / 3) as usize] { 1 } else { -1 }
}
