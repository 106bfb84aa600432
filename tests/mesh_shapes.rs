//! The shapes that all tests build on are closed, face outward, and have the volume on paper.

mod common;

use common::*;
use foothold::mesh::Mesh;
use glam::{DVec2, Vec3, dvec2, vec3};
use std::f64::consts::PI;

#[track_caller]
fn check(shape: &Mesh, volume: f64) {
    assert!(is_closed(shape));
    assert_near(shape.volume(), volume, 1e-5);
    let mut repaired = shape.clone();
    let (repairs, condition) = foothold::mesh::repair(&mut repaired);
    assert_eq!(repairs, Default::default(), "a sound shape needs no repair");
    assert_eq!(&repaired, shape);
    assert_eq!((condition.shells, condition.open_edges, condition.non_manifold_edges), (1, 0, 0));
}

#[test]
fn a_box_has_its_edges_product() {
    check(&cube(20.0), 8000.0);
    check(&cuboid(vec3(-1.0, 2.0, 3.0), vec3(4.0, 6.0, 5.0)), 5.0 * 4.0 * 2.0);
    assert_eq!(cube(20.0).area(), 2400.0);
    assert_eq!(cube(20.0).triangles.len(), 12);
}

#[test]
fn a_hexagonal_cylinder_has_six_triangles_of_area() {
    // A regular hexagon of radius 2 has the area 6 sqrt(3).
    check(&cylinder(2.0, 10.0, 6), 60.0 * 3f64.sqrt());
    check(&cylinder(5.0, 3.0, 200), circle_area(5.0, 200) * 3.0);
}

#[test]
fn a_tube_lacks_its_hole() {
    check(&tube(4.0, 2.0, 10.0, 6), (24.0 - 6.0) * 3f64.sqrt() * 10.0);
}

#[test]
fn spheres_and_tori_come_close_to_the_smooth_ones() {
    let ball = sphere(vec3(1.0, 2.0, 3.0), 10.0, 200, 400);
    assert_near(ball.volume(), 4.0 / 3.0 * PI * 1000.0, 1e-3);
    check(&ball, ball.volume());
    assert_eq!(ball.triangles.len(), 2 * 400 * 199);
    let ring = torus(20.0, 5.0, 400, 200);
    assert_near(ring.volume(), 2.0 * PI * PI * 20.0 * 25.0, 1e-3);
    check(&ring, ring.volume());
}

#[test]
fn an_octahedron_is_the_coarsest_sphere() {
    // Two pyramids over a square of diagonal 2: 4/3.
    check(&sphere(Vec3::ZERO, 1.0, 2, 4), 4.0 / 3.0);
}

#[test]
fn frustums_go_from_pyramid_to_prism() {
    let square = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)].map(|(x, y)| dvec2(x, y));
    check(&frustum(&square, 10.0, 0.0), 120.0);
    check(&frustum(&square, 10.0, 0.5), 36.0 * 10.0 * 1.75 / 3.0);
    check(&frustum(&square, 10.0, 1.0), 360.0);
}

#[test]
fn a_bracket_is_two_legs_less_their_common_corner() {
    let l = bracket(30.0, 4.0, 10.0);
    check(&l, 10.0 * 4.0 * 56.0);
    let bounds = l.bounds().expect("not empty");
    assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, vec3(30.0, 10.0, 30.0)));
}

#[test]
fn a_plate_with_three_holes_lacks_their_area() {
    let plate = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)].map(|(x, y)| dvec2(x, y));
    let holes = [(6.0, 6.0), (15.0, 14.0), (24.0, 6.0)].map(|(x, y)| circle(dvec2(x, y), 4.0, 12));
    let dodecagon = 3.0 * 16.0; // 3 r^2
    check(&prism(&plate, &holes, 1.0, 3.0), (600.0 - 3.0 * dodecagon) * 2.0);
}

#[test]
fn a_concave_outline_is_filled_once() {
    let comb: Vec<DVec2> = [
        (0.0, 0.0),
        (7.0, 0.0),
        (7.0, 5.0),
        (6.0, 5.0),
        (6.0, 1.0),
        (4.0, 1.0),
        (4.0, 5.0),
        (3.0, 5.0),
        (3.0, 1.0),
        (1.0, 1.0),
        (1.0, 5.0),
        (0.0, 5.0),
    ]
    .map(|(x, y)| dvec2(x, y))
    .to_vec();
    check(&prism(&comb, &[], 0.0, 2.0), (7.0 + 3.0 * 4.0) * 2.0);
}
