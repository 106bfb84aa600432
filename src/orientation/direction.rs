//! Directions that may point up, and the rotation that brings them there.

use glam::{DMat3, DMat4, DVec3};
use serde::{Deserialize, Serialize};

use crate::mesh::transform::rotation_to_up;
use crate::mesh::{Mesh, TransformError};

/// A direction of the part as it lies that may be turned up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Direction {
    /// 1 to 6 for the axes, from 7 for faces of the convex hull.
    pub id: u32,
    /// Unit vector of the part as it lies.
    pub up: [f64; 3],
}

/// Ids 1, 2 = +z, -z up; 3, 4 = +x, -x; 5, 6 = +y, -y [Karim, Table 1].
pub fn six() -> [Direction; 6] {
    let ups = [
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
    ];
    std::array::from_fn(|i| Direction { id: i as u32 + 1, up: ups[i] })
}

/// The rotation that brings the unit vector `up` to +z, by the shortest way for vectors of the
/// upper half, after half a turn about x for the others.
///
/// Its third row is `up` itself, so heights are not rounded; for the six axes every entry is
/// 0, 1 or -1 and nothing is.
pub fn rotation_for(up: DVec3) -> DMat3 {
    DMat3::from_mat4(rotation_to_up(up))
}

/// The mesh turned so that the unit vector `up` points to +z, about the origin.
pub(super) fn turned(mesh: &Mesh, up: DVec3) -> Result<Mesh, TransformError> {
    mesh.transformed(&DMat4::from_mat3(rotation_for(up)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_turn_without_rounding() {
        for direction in six() {
            let up = DVec3::from(direction.up);
            let rotation = rotation_for(up);
            assert_eq!(rotation * up, DVec3::Z);
            assert_eq!(rotation.determinant(), 1.0);
            assert!(rotation.to_cols_array().iter().all(|e| [0.0, 1.0, -1.0].contains(e)));
        }
    }

    #[test]
    fn any_direction_comes_to_the_top_without_mirroring() {
        for up in [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, -4.0), DVec3::new(1e-9, 0.0, -1.0)] {
            let up = up.normalize();
            let rotation = rotation_for(up);
            assert!((rotation * up - DVec3::Z).length() < 1e-15);
            assert!((rotation.determinant() - 1.0).abs() < 1e-15);
            assert!(
                (rotation * rotation.transpose() - DMat3::IDENTITY)
                    .to_cols_array()
                    .iter()
                    .all(|e| e.abs() < 1e-15)
            );
        }
    }
}
