//! Which triangles meet at which edges.
//!
//! Half-edge `3 t + k` is the edge of triangle `t` from its corner `k` to the next one. The two
//! half-edges of an ordinary edge are each other's twins; they run in opposite directions where the
//! two triangles agree on what is outside.

use super::Mesh;

/// What lies beyond a half-edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// The edge belongs to exactly one other triangle: its half-edge.
    Twin(u32),
    /// Nothing: the edge is open.
    Nothing,
    /// Several other triangles: the edge is not manifold.
    Several,
}

/// The edges of a mesh. It describes the mesh it was made of; changing that mesh makes it stale.
#[derive(Debug, Clone)]
pub struct Topology {
    /// By half-edge: its twin, [`NOTHING`] or [`SEVERAL`].
    twins: Vec<u32>,
    /// The half-edges of all edges with more than two triangles, edge after edge.
    crowded: Vec<u32>,
    /// Where each such edge starts in `crowded`, and its length as the last entry.
    crowded_starts: Vec<u32>,
    open_edges: usize,
}

const NOTHING: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

impl Topology {
    /// Finds the neighbours of all edges, in time linear in the triangles (but for the sorting of
    /// the edges at one vertex). No triangle may use a vertex twice.
    pub fn new(mesh: &Mesh) -> Topology {
        let (starts, mut ends) = half_edges_by_smaller_vertex(mesh);
        let mut topology = Topology {
            twins: vec![NOTHING; 3 * mesh.triangles.len()],
            crowded: Vec::new(),
            crowded_starts: vec![0],
            open_edges: 0,
        };
        for range in starts.windows(2) {
            let around = &mut ends[range[0] as usize..range[1] as usize];
            around.sort_unstable();
            for edge in around.chunk_by(|a, b| a >> 32 == b >> 32) {
                topology.add_edge(edge);
            }
        }
        topology
    }

    /// Records one edge; the low half of each number is a half-edge.
    fn add_edge(&mut self, edge: &[u64]) {
        let half_edge = |number: u64| number as u32;
        match *edge {
            [_] => self.open_edges += 1,
            [a, b] => {
                self.twins[half_edge(a) as usize] = half_edge(b);
                self.twins[half_edge(b) as usize] = half_edge(a);
            }
            _ => {
                for &number in edge {
                    self.twins[half_edge(number) as usize] = SEVERAL;
                    self.crowded.push(half_edge(number));
                }
                self.crowded_starts.push(self.crowded.len() as u32);
            }
        }
    }

    /// What lies beyond edge `k` (0..3, from corner `k` to the next) of a triangle.
    pub fn beyond(&self, triangle: usize, k: usize) -> Beyond {
        match self.twins[3 * triangle + k] {
            NOTHING => Beyond::Nothing,
            SEVERAL => Beyond::Several,
            twin => Beyond::Twin(twin),
        }
    }

    /// Edges with one triangle.
    pub fn open_edges(&self) -> usize {
        self.open_edges
    }

    /// Edges with three triangles or more.
    pub fn non_manifold_edges(&self) -> usize {
        self.crowded_starts.len() - 1
    }

    /// The half-edges of each edge with three triangles or more.
    pub fn crowded_edges(&self) -> impl Iterator<Item = &[u32]> {
        self.crowded_starts.windows(2).map(|r| &self.crowded[r[0] as usize..r[1] as usize])
    }

    /// Numbers of the half-edges that have no twin, or several.
    pub(super) fn border(&self) -> impl Iterator<Item = u32> + '_ {
        (0u32..).zip(&self.twins).filter(|&(_, &twin)| twin >= SEVERAL).map(|(h, _)| h)
    }

    /// The triangles at edges where not exactly one triangle in each direction meets another,
    /// open edges left out. Ascending, without repeats.
    pub(super) fn triangles_at_unusual_edges(&self, mesh: &Mesh) -> Vec<u32> {
        let is_unusual = |t: usize| {
            (0..3).any(|k| match self.beyond(t, k) {
                Beyond::Nothing => false,
                Beyond::Several => true,
                Beyond::Twin(twin) => start(mesh, twin) == mesh.triangles[t][k],
            })
        };
        (0..mesh.triangles.len()).filter(|&t| is_unusual(t)).map(|t| t as u32).collect()
    }

    /// Numbers the patches: triangles connected through edges with exactly two triangles.
    /// A patch is numbered by its first triangle.
    pub(super) fn patches(&self, mesh: &Mesh) -> Patches {
        let count = mesh.triangles.len();
        let mut patches =
            Patches { of: vec![NOTHING; count], turned: vec![false; count], count: 0, twisted: 0 };
        let mut open = Vec::new();
        for first in 0..count {
            if patches.of[first] == NOTHING {
                patches.of[first] = patches.count;
                patches.count += 1;
                open.push(first as u32);
                while let Some(triangle) = open.pop() {
                    self.visit_neighbours(mesh, triangle, &mut patches, &mut open);
                }
            }
        }
        patches.twisted /= 2; // each one was seen from both sides
        patches
    }

    fn visit_neighbours(&self, mesh: &Mesh, triangle: u32, patches: &mut Patches, open: &mut Vec<u32>) {
        let t = triangle as usize;
        for k in 0..3 {
            let Beyond::Twin(twin) = self.beyond(t, k) else { continue };
            let next = (twin / 3) as usize;
            let disagree = start(mesh, twin) == mesh.triangles[t][k];
            if patches.of[next] == NOTHING {
                patches.of[next] = patches.of[t];
                patches.turned[next] = patches.turned[t] != disagree;
                open.push(twin / 3);
            } else if patches.turned[next] != (patches.turned[t] != disagree) {
                patches.twisted += 1;
            }
        }
    }
}

/// Triangles connected through ordinary edges, and how they must be turned to agree.
pub(super) struct Patches {
    /// By triangle: number of its patch.
    pub(super) of: Vec<u32>,
    /// By triangle: whether it looks the other way than the first triangle of its patch.
    pub(super) turned: Vec<bool>,
    /// How many patches there are.
    pub(super) count: u32,
    /// Edges across which the two triangles cannot be made to agree (a Moebius strip has some).
    pub(super) twisted: usize,
}

/// Vertex where a half-edge starts.
pub(super) fn start(mesh: &Mesh, half_edge: u32) -> u32 {
    mesh.triangles[(half_edge / 3) as usize][(half_edge % 3) as usize]
}

/// Vertex where a half-edge ends.
pub(super) fn end(mesh: &Mesh, half_edge: u32) -> u32 {
    mesh.triangles[(half_edge / 3) as usize][((half_edge % 3 + 1) % 3) as usize]
}

/// All half-edges, grouped by the smaller one of their two vertices (a counting sort). The numbers
/// of vertex `v` are `starts[v]..starts[v + 1]`: larger vertex in the upper half, half-edge in the lower.
fn half_edges_by_smaller_vertex(mesh: &Mesh) -> (Vec<u32>, Vec<u64>) {
    let mut starts = vec![0u32; mesh.vertices.len() + 1];
    for [a, b, c] in &mesh.triangles {
        for smaller in [a.min(b), b.min(c), c.min(a)] {
            starts[*smaller as usize] += 1;
        }
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    // Each start stands at its group's end now and walks back to its beginning while it is filled.
    let mut ends = vec![0u64; 3 * mesh.triangles.len()];
    for (t, &[a, b, c]) in mesh.triangles.iter().enumerate().rev() {
        for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let place = &mut starts[from.min(to) as usize];
            *place -= 1;
            ends[*place as usize] = u64::from(from.max(to)) << 32 | (3 * t + k) as u64;
        }
    }
    (starts, ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, vec3};

    fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Mesh {
        Mesh { vertices: vertices.to_vec(), triangles: triangles.to_vec() }
    }

    fn tetrahedron() -> Mesh {
        let corners = [Vec3::ZERO, vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)];
        mesh(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    }

    #[test]
    fn twins_of_a_closed_mesh_run_the_other_way() {
        let m = tetrahedron();
        let topology = Topology::new(&m);
        assert_eq!((topology.open_edges(), topology.non_manifold_edges()), (0, 0));
        for h in 0..12u32 {
            let Beyond::Twin(twin) = topology.beyond(h as usize / 3, h as usize % 3) else {
                panic!("half-edge {h} has no twin")
            };
            assert_eq!((start(&m, h), end(&m, h)), (end(&m, twin), start(&m, twin)));
        }
    }

    #[test]
    fn a_missing_triangle_leaves_three_open_edges() {
        let mut m = tetrahedron();
        m.triangles.pop();
        let topology = Topology::new(&m);
        assert_eq!(topology.open_edges(), 3);
        assert_eq!(topology.beyond(0, 0), Beyond::Nothing, "from 0 to 2");
        assert_eq!(topology.border().count(), 3);
    }

    #[test]
    fn a_third_triangle_makes_an_edge_crowded() {
        let mut m = tetrahedron();
        m.vertices.push(vec3(1.0, 1.0, 1.0));
        m.triangles.push([0, 1, 4]);
        let topology = Topology::new(&m);
        assert_eq!((topology.open_edges(), topology.non_manifold_edges()), (2, 1));
        assert_eq!(topology.crowded_edges().map(<[u32]>::to_vec).collect::<Vec<_>>(), [[2, 3, 12]]);
        assert_eq!(topology.beyond(0, 2), Beyond::Several);
    }

    #[test]
    fn patches_are_told_apart_and_turned_triangles_found() {
        let mut m = tetrahedron();
        m.triangles[2] = [1, 3, 2];
        let far = m.vertices.iter().map(|&v| v + Vec3::splat(9.0)).collect::<Vec<_>>();
        m.append(&mesh(&far, &tetrahedron().triangles));
        let patches = Topology::new(&m).patches(&m);
        assert_eq!(patches.count, 2);
        assert_eq!(patches.of, [0, 0, 0, 0, 1, 1, 1, 1]);
        assert_eq!(patches.turned, [false, false, true, false, false, false, false, false]);
        assert_eq!(patches.twisted, 0);
    }

    #[test]
    fn a_moebius_strip_is_twisted() {
        let strip: Vec<Vec3> = (0..5).map(|i| vec3(i as f32, (i * i) as f32, 0.0)).collect();
        let m = mesh(&strip, &[[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 0, 4], [4, 0, 1]]);
        let topology = Topology::new(&m);
        assert_eq!(topology.open_edges(), 5);
        assert_eq!(topology.patches(&m).twisted, 1);
    }
}
