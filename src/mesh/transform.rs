//! Placing a mesh: rotate, scale, mirror, move, as 4x4 matrices that can be multiplied.
//!
//! The builders make matrices in f64; [`Mesh::transformed`] applies one. A placement is the product
//! of the matrices in reverse order of application, `drop * rotation * scaling`, so that the caller
//! can report the matrix that was applied. Sine and cosine come from `libm` and are exact for
//! multiples of 90 degrees.

use super::Mesh;
use super::weld::REACH_MM;
use glam::{DMat4, DVec2, DVec3, Vec3, dvec3};
use std::fmt;

/// Why a matrix cannot be applied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TransformError {
    /// It has no inverse (a scale of zero), is not affine or not finite.
    NotInvertible,
    /// A vertex would lie more than a kilometre from the origin.
    TooFar,
}

impl fmt::Display for TransformError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TransformError::NotInvertible => write!(f, "the placement flattens the part"),
            TransformError::TooFar => write!(f, "the placement moves the part more than {REACH_MM} mm away"),
        }
    }
}

impl std::error::Error for TransformError {}

impl Mesh {
    /// The mesh moved by an affine matrix. A matrix that mirrors turns the triangles, so that they
    /// still face outward.
    pub fn transformed(&self, by: &DMat4) -> Result<Mesh, TransformError> {
        let determinant = by.determinant();
        let is_affine = by.row(3) == glam::dvec4(0.0, 0.0, 0.0, 1.0);
        if !is_affine || !by.is_finite() || !determinant.is_finite() || determinant == 0.0 {
            return Err(TransformError::NotInvertible);
        }
        let vertices: Vec<Vec3> = self.vertices.iter().map(|v| moved(by, *v)).collect();
        if !vertices.iter().flat_map(|v| v.to_array()).all(|x| x.abs() <= REACH_MM) {
            return Err(TransformError::TooFar);
        }
        let mut triangles = self.triangles.clone();
        if determinant < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        Ok(Mesh { vertices, triangles })
    }
}

/// The vertex moved in f64 and rounded once; never -0.0.
pub(super) fn moved(by: &DMat4, vertex: Vec3) -> Vec3 {
    by.transform_point3(vertex.as_dvec3()).as_vec3() + Vec3::ZERO
}

/// Rotation about the x axis, degrees, from y towards z.
pub fn rotation_x(angle_deg: f64) -> DMat4 {
    let (sin, cos) = sin_cos_deg(angle_deg);
    rows([1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos])
}

/// Rotation about the y axis, degrees, from z towards x.
pub fn rotation_y(angle_deg: f64) -> DMat4 {
    let (sin, cos) = sin_cos_deg(angle_deg);
    rows([cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos])
}

/// Rotation about the z axis, degrees, from x towards y.
pub fn rotation_z(angle_deg: f64) -> DMat4 {
    let (sin, cos) = sin_cos_deg(angle_deg);
    rows([cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0])
}

/// Rotation about x, then y, then z (each about the fixed axis), degrees.
pub fn rotation_xyz(angles_deg: DVec3) -> DMat4 {
    rotation_z(angles_deg.z) * rotation_y(angles_deg.y) * rotation_x(angles_deg.x)
}

/// Rotation by the quaternion `x i + y j + z k + w`, of any length but zero (zero gives NaN, which
/// [`Mesh::transformed`] refuses).
pub fn rotation_quaternion(x: f64, y: f64, z: f64, w: f64) -> DMat4 {
    let s = 2.0 / (x * x + y * y + z * z + w * w);
    rows(
        [1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)],
    )
}

/// A rotation that makes `up` (any length but zero) point along +z; exact for `up` along an axis.
/// For an `up` that points upward it is the shortest one; else a half turn about x goes before it,
/// for near straight down the shortest one loses all its digits.
pub fn rotation_to_up(up: DVec3) -> DMat4 {
    let up = up.normalize();
    if up.z < 0.0 {
        let half_turn = rotation_x(180.0);
        return rotation_to_up(half_turn.transform_vector3(up)) * half_turn;
    }
    // Rodrigues' formula for the axis up x z and cosine up.z.
    let k = 1.0 / (1.0 + up.z);
    let cross = -k * up.x * up.y;
    rows([1.0 - k * up.x * up.x, cross, -up.x], [cross, 1.0 - k * up.y * up.y, -up.y], up.to_array())
}

/// Scaling about the origin; a negative factor mirrors.
pub fn scaling(factors: DVec3) -> DMat4 {
    DMat4::from_scale(factors)
}

/// Mirroring of x, y or z (`axis` 0, 1 or 2) at the origin.
///
/// # Panics
/// When `axis` is larger than 2.
pub fn mirror(axis: usize) -> DMat4 {
    let mut factors = DVec3::ONE;
    factors[axis] = -1.0;
    scaling(factors)
}

/// Translation, mm.
pub fn translation(by: DVec3) -> DMat4 {
    DMat4::from_translation(by)
}

/// The move straight down or up that sets the lowest point of `mesh` on the bed, z = 0.
pub fn drop_to_bed(mesh: &Mesh) -> DMat4 {
    let lowest = mesh.bounds().map_or(0.0, |b| f64::from(b.min.z));
    translation(dvec3(0.0, 0.0, -lowest))
}

/// The move along the bed that sets the middle of the box around `mesh` at `at`, mm.
pub fn centre_at(mesh: &Mesh, at: DVec2) -> DMat4 {
    let Some(bounds) = mesh.bounds() else { return DMat4::IDENTITY };
    let middle = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) / 2.0;
    translation(dvec3(at.x - middle.x, at.y - middle.y, 0.0))
}

fn rows(x: [f64; 3], y: [f64; 3], z: [f64; 3]) -> DMat4 {
    DMat4::from_mat3(glam::DMat3::from_cols(x.into(), y.into(), z.into()).transpose())
}

/// Sine and cosine of an angle in degrees; exact for multiples of 90.
fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    let turn = angle_deg % 360.0; // exact for f64
    match if turn < 0.0 { turn + 360.0 } else { turn } {
        0.0 | 360.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincos(other * (std::f64::consts::PI / 180.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: DVec3, b: DVec3) {
        assert!(a.distance(b) < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(rotation_x(90.0).transform_point3(DVec3::Y), DVec3::Z);
        assert_eq!(rotation_y(90.0).transform_point3(DVec3::Z), DVec3::X);
        assert_eq!(rotation_z(90.0).transform_point3(DVec3::X), DVec3::Y);
        assert_eq!(rotation_z(-270.0), rotation_z(90.0));
        assert_eq!(rotation_z(720.0), DMat4::IDENTITY);
        assert_eq!(rotation_y(180.0).transform_point3(DVec3::X), -DVec3::X);
    }

    #[test]
    fn thirty_degrees_have_half_a_sine() {
        near(rotation_z(30.0).transform_point3(DVec3::X), dvec3(0.75f64.sqrt(), 0.5, 0.0));
        near(rotation_z(-30.0).transform_point3(DVec3::X), dvec3(0.75f64.sqrt(), -0.5, 0.0));
    }

    #[test]
    fn angles_turn_about_x_first_and_z_last() {
        let turned = rotation_xyz(dvec3(90.0, 0.0, 90.0)).transform_point3(dvec3(1.0, 2.0, 3.0));
        assert_eq!(turned, dvec3(3.0, 1.0, 2.0), "(1, 2, 3) -> (1, -3, 2) -> (3, 1, 2)");
    }

    #[test]
    fn a_quaternion_of_any_length_is_its_rotation() {
        near(rotation_quaternion(0.0, 0.0, 5.0, 5.0).transform_point3(DVec3::X), DVec3::Y);
        near(rotation_quaternion(1.0, 1.0, 1.0, 1.0).transform_point3(DVec3::X), DVec3::Y);
    }

    #[test]
    fn up_comes_to_point_up() {
        for up in [DVec3::Z, -DVec3::Z, DVec3::X, -DVec3::Y, dvec3(1.0, -2.0, -3.0), dvec3(0.0, 1e-9, -1.0)] {
            let matrix = rotation_to_up(up);
            near(matrix.transform_vector3(up.normalize()), DVec3::Z);
            assert!((matrix.determinant() - 1.0).abs() < 1e-9, "a rotation keeps volumes");
        }
        assert_eq!(rotation_to_up(DVec3::Z), DMat4::IDENTITY);
        assert_eq!(rotation_to_up(-DVec3::X).transform_vector3(-DVec3::X), DVec3::Z);
    }
}
