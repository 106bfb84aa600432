//! Parts as binary STL, the form in which engines take them.

use crate::Part;

/// The part as a binary STL: 80 bytes of header, a count, 50 bytes for each triangle with its normal
/// left at zero, which readers compute from the corners.
pub fn binary(part: &Part) -> Vec<u8> {
    let mut out = Vec::with_capacity(84 + 50 * part.triangles.len());
    out.resize(80, 0);
    out.extend((part.triangles.len() as u32).to_le_bytes());
    for triangle in &part.triangles {
        out.extend([0; 12]);
        for &corner in triangle {
            // Readers of parts check every index.
            for x in part.vertices[corner as usize] {
                out.extend(x.to_le_bytes());
            }
        }
        out.extend([0; 2]);
    }
    out
}
