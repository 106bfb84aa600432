//! Triangles in space, mm: reading and writing STL, welding, checking, repairing, placing.

use glam::Vec3;

/// A triangle mesh with shared vertices, mm.
#[derive(Debug, Clone, PartialEq, Default)]
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
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|v| self.vertices[v as usize])
    }

    /// The smallest box around all triangles' vertices; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<Box3> {
        self.vertices.iter().fold(None, |found, &v| match found {
            None => Some(Box3 { min: v, max: v }),
            Some(b) => Some(Box3 { min: b.min.min(v), max: b.max.max(v) }),
        })
    }

    /// Enclosed volume, mm3: sum of the tetrahedra from the first vertex; negative when inside out.
    pub fn volume(&self) -> f64 {
        let Some(origin) = self.vertices.first().map(|v| v.as_dvec3()) else { return 0.0 };
        let six_volumes = (0..self.triangles.len()).map(|i| {
            let [a, b, c] = self.corners(i).map(|v| v.as_dvec3() - origin);
            a.dot(b.cross(c))
        });
        six_volumes.sum::<f64>() / 6.0
    }
}
