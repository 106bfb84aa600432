//! Merging of equal vertices while a file is read, and what must go after it.

use super::topology::Topology;
use super::{Mesh, StlError};
use crate::sort::StableSort;
use glam::Vec3;

/// Largest coordinate accepted, mm: a kilometre. At that distance neighbouring f32 numbers are
/// 0.06 mm apart, so a part out there has lost its shape; and the 1e-4 mm grid of the plane still
/// squares such numbers within 128 bits.
pub(super) const REACH_MM: f32 = 1e6;

/// Most triangles a mesh may have: half-edges (three for each triangle) are counted in u32, and the
/// last two numbers mean "none" and "several".
pub(super) const MAX_TRIANGLES: u64 = (u32::MAX as u64 - 2) / 3;

/// The corners of one triangle, mm.
pub(super) type Corners = [[f32; 3]; 3];

/// Triangles taken at a time: enough to keep the memory busy, few enough to stay in registers' reach.
pub(super) const BLOCK: usize = 16;

/// Builds an indexed mesh from corners that come one triangle after the other.
pub(super) struct Welder {
    mesh: Mesh,
    table: VertexTable,
    read: u64,
    degenerate: u64,
    max_triangles: u64,
}

impl Welder {
    /// An empty mesh with room for about `expected` triangles of a closed surface.
    pub(super) fn new(expected: usize) -> Welder {
        let mesh =
            Mesh { vertices: Vec::with_capacity(expected / 2 + 2), triangles: Vec::with_capacity(expected) };
        let table = VertexTable::with_room_for(expected / 2 + 2);
        Welder { mesh, table, read: 0, degenerate: 0, max_triangles: MAX_TRIANGLES }
    }

    /// Triangles added so far, dropped ones included.
    pub(super) fn read(&self) -> u64 {
        self.read
    }

    /// Triangles dropped because two of their corners are the same point.
    pub(super) fn degenerate(&self) -> u64 {
        self.degenerate
    }

    /// Adds a triangle; an error names it by its number, from 1.
    pub(super) fn add(&mut self, triangle: Corners) -> Result<(), StlError> {
        self.add_block(&[triangle])
    }

    /// Adds up to [`BLOCK`] triangles. All slots of the table are asked for before the first answer
    /// is needed, so that the waits for memory overlap.
    #[inline]
    pub(super) fn add_block(&mut self, triangles: &[Corners]) -> Result<(), StlError> {
        let mut hints = [[FREE; 3]; BLOCK];
        for (hint, corners) in hints.iter_mut().zip(triangles) {
            for (hint, &corner) in hint.iter_mut().zip(corners) {
                *hint = self.table.slots[self.table.slot_of(without_sign_of_zero(corner))];
            }
        }
        for (hint, corners) in hints.iter().zip(triangles) {
            self.read += 1;
            let in_reach = corners.as_flattened().iter().all(|x| x.abs() <= REACH_MM);
            if !in_reach || self.read > self.max_triangles {
                return Err(self.refusal(corners));
            }
            let index = |k: usize| (hint[k], without_sign_of_zero(corners[k]));
            let [a, b, c] = [index(0), index(1), index(2)];
            let mut index_of = |(hint, vertex)| self.table.index_of(&mut self.mesh.vertices, vertex, hint);
            let triangle = [index_of(a), index_of(b), index_of(c)];
            if uses_a_vertex_twice(triangle) {
                self.degenerate += 1;
            } else {
                self.mesh.triangles.push(triangle);
            }
        }
        Ok(())
    }

    #[cold]
    fn refusal(&self, corners: &Corners) -> StlError {
        let numbers = corners.as_flattened();
        if numbers.iter().any(|x| !x.is_finite()) {
            return StlError::NonFinite { triangle: self.read };
        }
        let reach_mm = numbers.iter().fold(0.0f32, |m, x| m.max(x.abs()));
        if reach_mm > REACH_MM {
            return StlError::TooFar { triangle: self.read, reach_mm };
        }
        StlError::TooMany { limit: self.max_triangles }
    }

    /// The mesh, without vertices that only dropped triangles used.
    pub(super) fn finish(self) -> Mesh {
        let mut mesh = self.mesh;
        drop(self.table);
        if self.degenerate > 0 {
            drop_unused_vertices(&mut mesh);
        }
        mesh
    }
}

/// Whether two of the three indices are equal.
pub(super) fn uses_a_vertex_twice([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Removes vertices that no triangle uses; the others keep their order.
pub(super) fn drop_unused_vertices(mesh: &mut Mesh) {
    let mut used = vec![false; mesh.vertices.len()];
    for &v in mesh.triangles.as_flattened() {
        used[v as usize] = true;
    }
    let mut names = vec![0; used.len()];
    let mut count = 0u32;
    for (name, &used) in names.iter_mut().zip(&used) {
        *name = count;
        count += u32::from(used);
    }
    let mut next = used.iter();
    mesh.vertices.retain(|_| next.next() == Some(&true));
    for v in mesh.triangles.as_flattened_mut() {
        *v = names[*v as usize];
    }
}

/// Drops triangles that repeat an earlier one: same vertices in the same cyclic direction. The one
/// with the opposite direction stays: there two solids touch. Returns how many went.
///
/// A repeated triangle has company in the same direction on each edge, so only triangles at such
/// edges are compared.
pub(super) fn drop_duplicates(mesh: &mut Mesh, topology: &Topology) -> usize {
    let mut suspects: Vec<([u32; 3], u32)> = topology
        .triangles_at_unusual_edges(mesh)
        .into_iter()
        .map(|t| (smallest_first(mesh.triangles[t as usize]), t))
        .collect();
    suspects.stable_sort_by(Ord::cmp);
    let repeats: Vec<u32> = suspects.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
    drop_triangles(mesh, &repeats);
    repeats.len()
}

/// Removes the triangles with these numbers and the vertices that nothing uses then.
pub(super) fn drop_triangles(mesh: &mut Mesh, numbers: &[u32]) {
    if numbers.is_empty() {
        return;
    }
    let mut gone = vec![false; mesh.triangles.len()];
    for &t in numbers {
        gone[t as usize] = true;
    }
    let mut next = gone.iter();
    mesh.triangles.retain(|_| next.next() == Some(&false));
    drop_unused_vertices(mesh);
}

/// The triangle rotated so that its smallest index stands first; the direction stays.
fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        m if m == a => [a, b, c],
        m if m == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// Which vertex number a position has: open addressing with linear probing, at most half full. The
/// slots hold numbers only, the positions stay in the mesh. The result is the order of first
/// appearance, whatever the hash does.
struct VertexTable {
    slots: Vec<u32>,
    /// The hash's upper bits are the slot: 64 - log2(slots).
    shift: u32,
}

const FREE: u32 = u32::MAX;

impl VertexTable {
    fn with_room_for(vertices: usize) -> VertexTable {
        let slots = (2 * vertices).next_power_of_two().max(64);
        VertexTable { slots: vec![FREE; slots], shift: 64 - slots.trailing_zeros() }
    }

    /// Where the search for a vertex starts.
    #[inline]
    fn slot_of(&self, vertex: Vec3) -> usize {
        (hash(vertex) >> self.shift) as usize
    }

    /// The number of the vertex at this position, a new one if there was none. `hint` is a number
    /// that may be the right one, or [`FREE`].
    #[inline]
    fn index_of(&mut self, vertices: &mut Vec<Vec3>, vertex: Vec3, hint: u32) -> u32 {
        if vertices.get(hint as usize) == Some(&vertex) {
            return hint;
        }
        let mask = self.slots.len() - 1;
        let mut slot = self.slot_of(vertex);
        loop {
            let found = self.slots[slot];
            if found == FREE {
                return self.insert(vertices, vertex, slot);
            }
            if vertices[found as usize] == vertex {
                return found;
            }
            slot = (slot + 1) & mask;
        }
    }

    fn insert(&mut self, vertices: &mut Vec<Vec3>, vertex: Vec3, slot: usize) -> u32 {
        // Below u32::MAX: MAX_TRIANGLES keeps three vertices for each triangle in range.
        let index = vertices.len() as u32;
        vertices.push(vertex);
        self.slots[slot] = index;
        if 2 * vertices.len() > self.slots.len() {
            self.grow(vertices);
        }
        index
    }

    fn grow(&mut self, vertices: &[Vec3]) {
        let doubled = self.slots.len();
        self.slots = Vec::new(); // freed before the new one is there
        *self = VertexTable::with_room_for(doubled);
        let mask = self.slots.len() - 1;
        for (index, &vertex) in vertices.iter().enumerate() {
            let mut slot = self.slot_of(vertex);
            while self.slots[slot] != FREE {
                slot = (slot + 1) & mask;
            }
            self.slots[slot] = index as u32;
        }
    }
}

/// The position with 0.0 for -0.0, so that equal positions have equal bits.
#[inline]
fn without_sign_of_zero([x, y, z]: [f32; 3]) -> Vec3 {
    Vec3::new(x + 0.0, y + 0.0, z + 0.0)
}

/// Mixes the bits of the three coordinates; the upper bits are the good ones (multiplicative
/// hashing, Knuth, The Art of Computer Programming 3, 6.4). The factors are odd and without pattern.
#[inline]
fn hash(v: Vec3) -> u64 {
    let [x, y, z] = v.to_array().map(|c| u64::from(c.to_bits()));
    let mixed = (x | y << 32).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ z.wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    (mixed ^ mixed >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weld(triangles: &[[[f32; 3]; 3]]) -> (Mesh, u64) {
        let mut welder = Welder::new(0);
        for &t in triangles {
            welder.add(t).expect("finite and near");
        }
        let degenerate = welder.degenerate();
        (welder.finish(), degenerate)
    }

    #[test]
    fn equal_corners_become_one_vertex_and_minus_zero_is_zero() {
        let square = [
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
            [[-0.0, 0.0, -0.0], [1.0, 1.0, -0.0], [0.0, 1.0, 0.0]],
        ];
        let (mesh, degenerate) = weld(&square);
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(degenerate, 0);
    }

    #[test]
    fn a_triangle_with_two_equal_corners_goes_with_its_vertices() {
        let [p, q, r] = [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 1.0, 0.0]];
        let (mesh, degenerate) = weld(&[[[9.0; 3], [9.0; 3], p], [p, q, r]]);
        assert_eq!(degenerate, 1);
        assert_eq!(mesh.vertices, [p, q, r].map(Vec3::from_array));
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn the_table_finds_what_a_search_from_the_start_finds() {
        let corner = |i: u32| [(i * 7 % 31) as f32, (i % 11) as f32 * 0.1, (i * 5 % 17) as f32];
        let triangles: Vec<_> = (0..3_000).map(|i| [corner(i), corner(i + 1), corner(2 * i + 5)]).collect();
        let (mesh, degenerate) = weld(&triangles);
        let mut seen: Vec<[f32; 3]> = Vec::new();
        let mut index_of = |c: [f32; 3]| {
            seen.iter().position(|&s| s == c).unwrap_or_else(|| {
                seen.push(c);
                seen.len() - 1
            }) as u32
        };
        let slow: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(&mut index_of)).collect();
        let slow: Vec<[u32; 3]> = slow.into_iter().filter(|&t| !uses_a_vertex_twice(t)).collect();
        assert!(seen.len() > 1000, "the table must have grown");
        assert_eq!(degenerate, 0, "no two corners here are equal");
        assert_eq!(mesh.triangles, slow);
        assert_eq!(mesh.vertices, seen.into_iter().map(Vec3::from_array).collect::<Vec<_>>());
    }

    #[test]
    fn too_many_triangles_are_refused() {
        let mut welder = Welder { max_triangles: 1, ..Welder::new(0) };
        let t = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(welder.add(t), Ok(()));
        assert_eq!(welder.add(t), Err(StlError::TooMany { limit: 1 }));
    }

    #[test]
    fn smallest_first_keeps_the_direction() {
        assert_eq!(smallest_first([7, 3, 5]), smallest_first([3, 5, 7]));
        assert_ne!(smallest_first([7, 5, 3]), smallest_first([7, 3, 5]));
    }
}
