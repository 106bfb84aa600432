//! Placing on the bed, putting together, taking apart.

mod common;

use common::*;
use foothold::mesh::transform::*;
use foothold::mesh::{Mesh, TransformError};
use glam::{DMat4, DVec3, Vec3, dvec2, dvec3, vec3};

fn bounds(mesh: &Mesh) -> (Vec3, Vec3) {
    let b = mesh.bounds().expect("not empty");
    (b.min, b.max)
}

#[test]
fn a_quarter_turn_swaps_width_and_depth_exactly() {
    let plate = cuboid(Vec3::ZERO, vec3(30.0, 20.0, 10.0));
    let turned = plate.transformed(&rotation_z(90.0)).expect("a rotation");
    assert_eq!(bounds(&turned), (vec3(-20.0, 0.0, 0.0), vec3(0.0, 30.0, 10.0)));
    let upright = plate.transformed(&rotation_x(90.0)).expect("a rotation");
    assert_eq!(bounds(&upright), (vec3(0.0, -10.0, 0.0), vec3(30.0, 0.0, 20.0)));
    assert_eq!(turned.volume(), 6000.0);
    let signs = turned.vertices.iter().flat_map(|v| v.to_array());
    assert!(signs.into_iter().all(|x| x != 0.0 || x.is_sign_positive()), "no -0.0");
}

#[test]
fn mirrors_keep_the_outside_outside() {
    let wedge = frustum(&[dvec2(0.0, 0.0), dvec2(6.0, 0.0), dvec2(0.0, 4.0)], 5.0, 0.5);
    for axis in 0..3 {
        let mirrored = wedge.transformed(&mirror(axis)).expect("invertible");
        assert!(is_closed(&mirrored));
        assert_near(mirrored.volume(), wedge.volume(), 1e-6);
    }
    let flipped = wedge.transformed(&scaling(dvec3(-2.0, 3.0, -0.5))).expect("invertible");
    assert_near(flipped.volume(), 3.0 * wedge.volume(), 1e-6);
}

#[test]
fn dropping_and_centring_compose_into_one_matrix() {
    let part = moved(&bracket(30.0, 4.0, 10.0), vec3(100.5, -7.25, 13.125));
    let turn = rotation_xyz(dvec3(30.0, 45.0, 10.0));
    let turned = part.transformed(&turn).expect("a rotation");
    let placement = centre_at(&turned, dvec2(110.0, 110.0)) * drop_to_bed(&turned) * turn;
    let placed = part.transformed(&placement).expect("invertible");
    let (min, max) = bounds(&placed);
    assert!(min.z.abs() < 1e-5, "{min}");
    assert!((min.x + max.x - 220.0).abs() < 1e-4 && (min.y + max.y - 220.0).abs() < 1e-4);
    assert_near(placed.volume(), part.volume(), 1e-5);
    let dropped = part.transformed(&drop_to_bed(&part)).expect("a move");
    assert_eq!(bounds(&dropped).0.z, 0.0);
}

#[test]
fn placements_that_lose_the_part_are_refused() {
    let part = cube(10.0);
    let not_affine =
        DMat4::from_cols_array(&[1., 0., 0., 1., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]);
    for flat in [
        scaling(dvec3(1.0, 0.0, 1.0)),
        scaling(DVec3::NAN),
        rotation_quaternion(0.0, 0.0, 0.0, 0.0),
        not_affine,
    ] {
        assert_eq!(part.transformed(&flat), Err(TransformError::NotInvertible));
    }
    assert_eq!(part.transformed(&scaling(DVec3::splat(2e5))), Err(TransformError::TooFar));
    assert_eq!(part.transformed(&translation(dvec3(0.0, -2e6, 0.0))), Err(TransformError::TooFar));
}

#[test]
fn appended_meshes_keep_their_shapes() {
    let mut plate = cube(10.0);
    plate.append(&moved(&cube(5.0), vec3(20.0, 0.0, 0.0)));
    assert_eq!((plate.vertices.len(), plate.triangles.len()), (16, 24));
    assert_near(plate.volume(), 1125.0, 1e-12);
    assert_eq!(plate.triangles[12], cube(5.0).triangles[0].map(|v| v + 8));
}

#[test]
fn a_range_of_heights_takes_the_triangles_that_reach_it() {
    let tower = together(&[
        cube(10.0),
        moved(&cube(10.0), vec3(0.0, 0.0, 20.0)),
        moved(&cube(10.0), vec3(0.0, 0.0, 40.0)),
    ]);
    let middle = tower.select(|low, high| low <= 31.0 && high >= 19.0);
    assert_eq!(middle.vertices.len(), 8);
    assert_eq!(soup(&middle), moved(&soup(&cube(10.0)), vec3(0.0, 0.0, 20.0)), "order kept");
    let sides = tower.select(|low, high| low < 5.0 && high > 5.0);
    assert_eq!(sides.triangles.len(), 8);
    assert_eq!(soup(&tower.select(|_, _| true)), soup(&tower));
    assert_eq!(tower.select(|_, _| false), Mesh::default());
}
