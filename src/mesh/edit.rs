//! Changes to where a part stands: turn, scale, mirror, lay flat, drop, as the hand of a user does
//! them.
//!
//! A placement is the matrix from the coordinates of the part's file to the bed's. Every change
//! keeps the middle of the part's box where it is on the bed and sets the part's lowest point on it.

use super::transform::{
    mirror, moved, rotation_to_up, rotation_x, rotation_y, rotation_z, scaling, translation,
};
use super::{Box3, Mesh, TransformError};
use glam::{DMat4, DVec3, dvec3};
use serde::Serialize;

/// A change to a placement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Edit {
    /// Sets the lowest point on the bed and changes nothing else.
    Drop,
    /// Turns about an axis of the bed: 0 is x, 1 is y, 2 is z.
    Turn {
        /// The axis.
        axis: usize,
        /// The angle, degrees, as a right hand turns.
        angle_deg: f64,
    },
    /// Scales along the axes of the bed.
    Scale {
        /// Factors for x, y and z, above zero.
        factors: [f64; 3],
    },
    /// Mirrors one axis of the bed.
    Mirror {
        /// The axis.
        axis: usize,
    },
    /// Turns the part so that a direction of its file points up.
    TurnUp {
        /// The direction, of any length but 0.
        up: [f64; 3],
    },
    /// Turns the part so that a face lies on the bed.
    LayFlat {
        /// Index of the face's triangle.
        triangle: usize,
    },
}

impl Edit {
    /// A change by its name in JSON and its numbers in the order of its fields; `None` if there is none such.
    pub fn from_numbers(kind: &str, numbers: &[f64]) -> Option<Edit> {
        let whole = |n: f64| (n >= 0.0 && n <= f64::from(u32::MAX) && n.fract() == 0.0).then_some(n as usize);
        Some(match (kind, numbers) {
            ("drop", []) => Edit::Drop,
            ("turn", &[axis, angle_deg]) => Edit::Turn { axis: whole(axis)?, angle_deg },
            ("scale", &[x, y, z]) => Edit::Scale { factors: [x, y, z] },
            ("mirror", &[axis]) => Edit::Mirror { axis: whole(axis)? },
            ("turn_up", &[x, y, z]) => Edit::TurnUp { up: [x, y, z] },
            ("lay_flat", &[triangle]) => Edit::LayFlat { triangle: whole(triangle)? },
            _ => return None,
        })
    }
}

/// The placement after `edit`. Refuses an axis or a triangle that does not exist, and what
/// [`Mesh::transformed`] would refuse.
pub fn edited(mesh: &Mesh, placement: &DMat4, edit: Edit) -> Result<DMat4, TransformError> {
    let change = change_of(mesh, placement, edit).ok_or(TransformError::NotInvertible)?;
    let changed = change * *placement;
    if !changed.is_finite() || changed.determinant() == 0.0 {
        return Err(TransformError::NotInvertible);
    }
    let (before, after) = (bounds_under(mesh, placement), bounds_under(mesh, &changed));
    let (Some(before), Some(after)) = (before, after) else { return Ok(changed) };
    let shift = match edit {
        Edit::Drop => DVec3::ZERO,
        _ => middle(&before) - middle(&after),
    };
    Ok(translation(dvec3(shift.x, shift.y, -f64::from(after.min.z))) * changed)
}

/// The smallest box around the mesh as it stands under `placement`.
pub fn bounds_under(mesh: &Mesh, placement: &DMat4) -> Option<Box3> {
    mesh.vertices.iter().map(|v| moved(placement, *v)).fold(None, |found: Option<Box3>, v| match found {
        None => Some(Box3 { min: v, max: v }),
        Some(b) => Some(Box3 { min: b.min.min(v), max: b.max.max(v) }),
    })
}

fn change_of(mesh: &Mesh, placement: &DMat4, edit: Edit) -> Option<DMat4> {
    match edit {
        Edit::Drop => Some(DMat4::IDENTITY),
        Edit::Turn { axis: 0, angle_deg } => Some(rotation_x(angle_deg)),
        Edit::Turn { axis: 1, angle_deg } => Some(rotation_y(angle_deg)),
        Edit::Turn { axis: 2, angle_deg } => Some(rotation_z(angle_deg)),
        Edit::Scale { factors } if factors.iter().all(|f| *f > 0.0) => Some(scaling(DVec3::from(factors))),
        Edit::Mirror { axis } if axis < 3 => Some(mirror(axis)),
        Edit::TurnUp { up } => {
            let now = placement.transform_vector3(DVec3::from(up)).try_normalize()?;
            Some(rotation_to_up(now))
        }
        Edit::LayFlat { triangle } => Some(rotation_to_up(-normal_under(mesh, placement, triangle)?)),
        Edit::Turn { .. } | Edit::Scale { .. } | Edit::Mirror { .. } => None,
    }
}

/// The way a triangle faces under `placement`; `None` without such a triangle, or if it has no area.
fn normal_under(mesh: &Mesh, placement: &DMat4, triangle: usize) -> Option<DVec3> {
    let corners = mesh.triangles.get(triangle)?.map(|v| mesh.vertices[v as usize].as_dvec3());
    let [a, b, c] = corners.map(|v| placement.transform_point3(v));
    let normal = (b - a).cross(c - a) * placement.determinant().signum();
    (normal.length() > 0.0).then_some(normal)
}

fn middle(b: &Box3) -> DVec3 {
    (b.min.as_dvec3() + b.max.as_dvec3()) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// A corner of a box of 2 x 4 x 6 mm: right-angled at the origin.
    fn wedge() -> Mesh {
        let vertices =
            vec![Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0), Vec3::new(0.0, 0.0, 6.0)];
        Mesh { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
    }

    fn size(mesh: &Mesh, placement: &DMat4) -> [f32; 3] {
        let b = bounds_under(mesh, placement).unwrap();
        (b.max - b.min).to_array()
    }

    fn stands_at(mesh: &Mesh, placement: &DMat4) -> ([f64; 2], f32) {
        let b = bounds_under(mesh, placement).unwrap();
        let m = middle(&b);
        ([m.x, m.y], b.min.z)
    }

    #[test]
    fn a_quarter_turn_swaps_two_sides_and_keeps_the_middle() {
        let (mesh, at) = (wedge(), translation(dvec3(100.0, 50.0, 3.0)));
        let turned = edited(&mesh, &at, Edit::Turn { axis: 0, angle_deg: 90.0 }).unwrap();
        assert_eq!(size(&mesh, &turned), [2.0, 6.0, 4.0]);
        assert_eq!(stands_at(&mesh, &turned), ([101.0, 52.0], 0.0));
        let back = edited(&mesh, &turned, Edit::Turn { axis: 0, angle_deg: -90.0 }).unwrap();
        assert_eq!(back, translation(dvec3(100.0, 50.0, 0.0)));
    }

    #[test]
    fn a_direction_of_the_file_comes_to_the_top_however_the_part_stands() {
        let mesh = wedge();
        let at = edited(&mesh, &DMat4::IDENTITY, Edit::Turn { axis: 0, angle_deg: 90.0 }).unwrap();
        let turned = edited(&mesh, &at, Edit::TurnUp { up: [3.0, 0.0, 0.0] }).unwrap();
        assert!((turned.transform_vector3(DVec3::X) - DVec3::Z).length() < 1e-12);
        assert!((size(&mesh, &turned)[2] - 2.0).abs() < 1e-6);
        assert!(edited(&mesh, &at, Edit::TurnUp { up: [0.0; 3] }).is_err());
    }

    #[test]
    fn drop_moves_straight_down() {
        let (mesh, at) = (wedge(), translation(dvec3(7.0, 8.0, 9.0)));
        assert_eq!(edited(&mesh, &at, Edit::Drop).unwrap(), translation(dvec3(7.0, 8.0, 0.0)));
    }

    #[test]
    fn scaling_and_mirroring_keep_the_middle() {
        let mesh = wedge();
        let scaled = edited(&mesh, &DMat4::IDENTITY, Edit::Scale { factors: [2.0, 1.0, 0.5] }).unwrap();
        assert_eq!(size(&mesh, &scaled), [4.0, 4.0, 3.0]);
        assert_eq!(stands_at(&mesh, &scaled), ([1.0, 2.0], 0.0));
        let mirrored = edited(&mesh, &scaled, Edit::Mirror { axis: 1 }).unwrap();
        assert!(mirrored.determinant() < 0.0);
        assert_eq!(stands_at(&mesh, &mirrored), ([1.0, 2.0], 0.0));
    }

    #[test]
    fn a_face_comes_to_lie_on_the_bed_also_mirrored() {
        let mesh = wedge();
        let plain = DMat4::IDENTITY;
        let mirrored = edited(&mesh, &plain, Edit::Mirror { axis: 0 }).unwrap();
        for placement in [plain, mirrored] {
            for triangle in 0..4 {
                let flat = edited(&mesh, &placement, Edit::LayFlat { triangle }).unwrap();
                for v in mesh.triangles[triangle] {
                    let z = moved(&flat, mesh.vertices[v as usize]).z;
                    assert!(z.abs() < 1e-5, "triangle {triangle}: {z}");
                }
            }
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let mesh = wedge();
        for edit in [
            Edit::Turn { axis: 3, angle_deg: 1.0 },
            Edit::Turn { axis: 0, angle_deg: f64::NAN },
            Edit::Mirror { axis: 3 },
            Edit::Scale { factors: [1.0, 0.0, 1.0] },
            Edit::Scale { factors: [1.0, -1.0, 1.0] },
            Edit::LayFlat { triangle: 4 },
        ] {
            assert_eq!(edited(&mesh, &DMat4::IDENTITY, edit), Err(TransformError::NotInvertible), "{edit:?}");
        }
    }

    #[test]
    fn a_change_is_its_kind_and_its_numbers() {
        let turn = Edit::Turn { axis: 2, angle_deg: -12.5 };
        assert_eq!(Edit::from_numbers("turn", &[2.0, -12.5]), Some(turn));
        assert_eq!(Edit::from_numbers("lay_flat", &[7.0]), Some(Edit::LayFlat { triangle: 7 }));
        let wrong: [(&str, &[f64]); 5] =
            [("turn", &[2.0]), ("drop", &[1.0]), ("mirror", &[0.5]), ("lay_flat", &[-1.0]), ("spin", &[])];
        for (kind, numbers) in wrong {
            assert_eq!(Edit::from_numbers(kind, numbers), None, "{kind} {numbers:?}");
        }
    }
}
