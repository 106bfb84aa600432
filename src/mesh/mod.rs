//! Triangles in space, mm: reading and writing STL, welding, checking, repairing, placing.
//!
//! [`load`] is the one way from the bytes of a file to a checked model; its steps are
//! [`stl`] (parse, weld on the fly with [`weld`]), [`topology`], [`repair()`] and [`inspect`].

pub mod edit;
pub mod inspect;
pub mod repair;
pub mod stl;
pub mod topology;
pub mod transform;
mod turn;
mod weld;

pub use edit::{Edit, bounds_under, edited};
pub use inspect::{Extent, Inspection, LoadedModel, Warning, load};
pub use repair::{Condition, Repairs, repair};
pub use stl::{Parsed, StlError, StlReader};
pub use topology::{Beyond, Topology};
pub use transform::TransformError;

use glam::Vec3;

/// A triangle mesh with shared vertices, mm.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Mesh {
    /// Positions, mm; all finite.
    pub vertices: Vec<Vec3>,
    /// Three vertex indices each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// An axis-parallel box in space, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Mesh {
    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        let [a, b, c] = self.triangles[index];
        let vertex = |v: u32| self.vertices[v as usize];
        [vertex(a), vertex(b), vertex(c)] // `map` was not inlined here and took a tenth of a load
    }

    /// The smallest box around all vertices; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<Box3> {
        self.vertices.iter().fold(None, |found, &v| match found {
            None => Some(Box3 { min: v, max: v }),
            Some(b) => Some(Box3 { min: b.min.min(v), max: b.max.max(v) }),
        })
    }

    /// Enclosed volume, mm3: sum of the tetrahedra from the first vertex; negative when inside out.
    /// Where shells overlap, the common part counts once for each.
    pub fn volume(&self) -> f64 {
        let Some(origin) = self.vertices.first().map(|v| v.as_dvec3()) else { return 0.0 };
        let six_volumes = (0..self.triangles.len()).map(|i| {
            let [a, b, c] = self.corners(i).map(|v| v.as_dvec3() - origin);
            a.dot(b.cross(c))
        });
        six_volumes.sum::<f64>() / 6.0
    }

    /// Area of all triangles, mm2.
    pub fn area(&self) -> f64 {
        let twice = (0..self.triangles.len()).map(|i| {
            let [a, b, c] = self.corners(i).map(Vec3::as_dvec3);
            (b - a).cross(c - a).length()
        });
        twice.sum::<f64>() / 2.0
    }

    /// Adds the triangles of `other` behind the own ones; nothing is welded between the two.
    ///
    /// # Panics
    /// When the two together have more than `u32::MAX` vertices.
    pub fn append(&mut self, other: &Mesh) {
        let total = self.vertices.len() + other.vertices.len();
        assert!(u32::try_from(total).is_ok(), "more vertices than u32 can count");
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + offset)));
    }

    /// The part of the mesh made of the triangles whose `keep(lowest z, highest z)` is true, in
    /// their order, with only the vertices that they use, in order of first use.
    pub fn select(&self, keep: impl Fn(f32, f32) -> bool) -> Mesh {
        self.subset((0..self.triangles.len()).filter(|&i| {
            let [a, b, c] = self.corners(i).map(|v| v.z);
            keep(a.min(b).min(c), a.max(b).max(c))
        }))
    }

    /// The mesh of these triangles, with only the vertices that they use, in order of first use.
    pub fn subset(&self, triangles: impl IntoIterator<Item = usize>) -> Mesh {
        const UNSEEN: u32 = u32::MAX;
        let mut renamed = vec![UNSEEN; self.vertices.len()];
        let mut part = Mesh::default();
        for index in triangles {
            let triangle = self.triangles[index].map(|v| {
                let name = &mut renamed[v as usize];
                if *name == UNSEEN {
                    *name = part.vertices.len() as u32;
                    part.vertices.push(self.vertices[v as usize]);
                }
                *name
            });
            part.triangles.push(triangle);
        }
        part
    }
}
