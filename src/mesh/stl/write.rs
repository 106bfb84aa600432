//! Writing STL.

use super::binary::RECORD_BYTES;
use crate::mesh::Mesh;
use glam::Vec3;
use std::fmt::Write;

/// The mesh as a binary STL; the header does not begin with "solid".
///
/// # Panics
/// When the mesh has more than `u32::MAX` triangles.
pub fn write_binary(mesh: &Mesh) -> Vec<u8> {
    let count = u32::try_from(mesh.triangles.len()).expect("the format counts triangles in 32 bits");
    let mut bytes = Vec::with_capacity(super::HEADER_BYTES + mesh.triangles.len() * RECORD_BYTES);
    bytes.extend_from_slice(b"binary STL, mm");
    bytes.resize(80, 0);
    bytes.extend(count.to_le_bytes());
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        for number in [normal(a, b, c), a, b, c].iter().flat_map(|v| v.to_array()) {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// The mesh as a text STL with one solid of this name. Numbers have as many digits as it takes to
/// read the same f32 again.
pub fn write_text(mesh: &Mesh, name: &str) -> String {
    let name = name.replace(['\r', '\n'], " ");
    let mut text = format!("solid {name}\n");
    for triangle in 0..mesh.triangles.len() {
        facet(&mut text, mesh.corners(triangle)).expect("writing to a String cannot fail");
    }
    text.push_str(&format!("endsolid {name}\n"));
    text
}

fn facet(text: &mut String, [a, b, c]: [Vec3; 3]) -> std::fmt::Result {
    let n = normal(a, b, c);
    writeln!(text, "facet normal {} {} {}\n  outer loop", n.x, n.y, n.z)?;
    for v in [a, b, c] {
        writeln!(text, "    vertex {} {} {}", v.x, v.y, v.z)?;
    }
    writeln!(text, "  endloop\nendfacet")
}

/// Unit normal of the triangle, zero where it has no area.
fn normal(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
