//! Sections of solids known on paper, and of meshes with faults.

mod common;

use common::{bracket, cube, cuboid, cylinder, frustum, inverted, soup, sphere, together, torus, tube};
use foothold::mesh::Mesh;
use foothold::polygon::{DVec2, dvec2};
use foothold::slice::{Axis, Section, slice_mesh};
use glam::Vec3;

/// Middles of `count` layers between `low` and `high`.
fn middles(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low + (high - low) * (i as f64 + 0.5) / count as f64).collect()
}

/// Area of the mesh's section at z, from the crossed triangles alone: half the sum of the cross
/// products of their directed cuts. Nothing is chained, snapped or united.
fn section_area(mesh: &Mesh, z: f64) -> f64 {
    let cut = |t: usize| {
        let corners = mesh.corners(t).map(|v| v.as_dvec3());
        let mut ends: Vec<DVec2> = Vec::new();
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            if (a.z >= z) != (b.z >= z) {
                ends.push((a + (b - a) * ((z - a.z) / (b.z - a.z))).truncate());
            }
        }
        let &[p, q] = ends.as_slice() else { return 0.0 };
        let outward = (corners[1] - corners[0]).cross(corners[2] - corners[0]).truncate();
        let cross = p.perp_dot(q);
        if (q - p).perp().dot(outward) < 0.0 { cross } else { -cross }
    };
    (0..mesh.triangles.len()).map(cut).sum::<f64>() / 2.0
}

/// Every layer's area is the mesh's own to what snapping each vertex to the 1e-4 mm grid allows.
#[track_caller]
fn assert_areas(mesh: &Mesh, low: f64, high: f64) {
    let heights = middles(low, high, 97);
    for (section, &z) in slice_mesh(mesh, Axis::Z, &heights, 0.0).iter().zip(&heights) {
        let allowed = section.area.length() * 1e-4;
        let (found, expected) = (section.area.area(), section_area(mesh, z));
        assert!((found - expected).abs() <= allowed, "z {z}: {found} is not {expected}");
        assert!(section.gaps.is_empty());
    }
}

fn only(sections: Vec<Section>) -> Section {
    sections.into_iter().next().expect("one plane was cut")
}

#[test]
fn a_cube_has_400_mm2_on_every_layer() {
    for section in slice_mesh(&cube(20.0), Axis::Z, &middles(0.0, 20.0, 100), 0.0) {
        assert_eq!(section.area.area(), 400.0);
        assert_eq!(section.area.contours().len(), 1);
        assert_eq!(section.area.vertex_count(), 4);
    }
}

#[test]
fn cylinder_sphere_and_torus_have_the_areas_of_their_meshes() {
    assert_areas(&cylinder(10.0, 20.0, 180), 0.0, 20.0);
    assert_areas(&sphere(Vec3::new(1.0, 2.0, 10.0), 10.0, 60, 90), 0.0, 20.0);
    assert_areas(&torus(12.0, 4.0, 90, 40), -4.0, 4.0);
    assert_areas(&tube(10.0, 7.0, 5.0, 64), 0.0, 5.0);
}

#[test]
fn a_torus_is_a_ring_with_a_hole_on_every_layer() {
    for section in slice_mesh(&torus(12.0, 4.0, 90, 40), Axis::Z, &middles(-4.0, 4.0, 40), 0.0) {
        let islands = section.area.islands();
        assert_eq!(islands.len(), 1);
        assert_eq!(islands[0].holes.len(), 1);
    }
}

#[test]
fn planes_along_x_y_and_z_give_the_same_volume() {
    let part = bracket(20.0, 5.0, 8.0);
    let volume = part.volume();
    let bounds = part.bounds().expect("not empty");
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let (low, high) = (f64::from(axis.height(bounds.min)), f64::from(axis.height(bounds.max)));
        let sections = slice_mesh(&part, axis, &middles(low, high, 200), 0.0);
        let sum: f64 = sections.iter().map(|s| s.area.area()).sum::<f64>() * (high - low) / 200.0;
        assert!((sum / volume - 1.0).abs() < 1e-6, "{axis:?}: {sum} is not {volume}");
    }
}

#[test]
fn vertical_planes_see_the_part_upright() {
    let part = cuboid(Vec3::new(1.0, 2.0, 3.0), Vec3::new(5.0, 9.0, 13.0));
    let seen = |axis, at| only(slice_mesh(&part, axis, &[at], 0.0)).area.bounds().expect("not empty");
    assert_eq!((seen(Axis::Y, 4.0).min, seen(Axis::Y, 4.0).max), (dvec2(1.0, 3.0), dvec2(5.0, 13.0)));
    assert_eq!((seen(Axis::X, 4.0).min, seen(Axis::X, 4.0).max), (dvec2(2.0, 3.0), dvec2(9.0, 13.0)));
}

#[test]
fn a_face_in_the_plane_is_neither_missed_nor_doubled() {
    // A step at z = 5: at 5 the plane counts as just below it.
    let steps = together(&[cuboid(Vec3::ZERO, Vec3::new(10.0, 10.0, 5.0))]);
    let area = |z: f64| only(slice_mesh(&steps, Axis::Z, &[z], 0.0)).area.area();
    assert_eq!((area(0.0), area(5.0), area(2.5)), (0.0, 100.0, 100.0));
    let l = bracket(20.0, 5.0, 8.0);
    let areas: Vec<f64> =
        slice_mesh(&l, Axis::Z, &[5.0, 5.0 + 1e-9], 0.0).iter().map(|s| s.area.area()).collect();
    assert_eq!(areas, [160.0, 40.0]);
}

#[test]
fn a_vertex_in_the_plane_is_no_special_case() {
    // An octahedron: its widest section goes through four vertices.
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let vertices = vec![
        corner(5.0, 0.0, 0.0),
        corner(0.0, 5.0, 0.0),
        corner(-5.0, 0.0, 0.0),
        corner(0.0, -5.0, 0.0),
        corner(0.0, 0.0, 5.0),
        corner(0.0, 0.0, -5.0),
    ];
    let ring = |i: u32| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]];
    let mesh = Mesh { vertices, triangles: (0..4).flat_map(ring).collect() };
    let section = only(slice_mesh(&mesh, Axis::Z, &[0.0], 0.0));
    assert_eq!(section.area.area(), 50.0);
    assert_eq!(section.area.contours().len(), 1);
    assert!(section.gaps.is_empty());
}

#[test]
fn overlapping_shells_are_united_and_cavities_stay_empty() {
    let a = cuboid(Vec3::ZERO, Vec3::new(10.0, 10.0, 10.0));
    let b = cuboid(Vec3::new(5.0, 5.0, 0.0), Vec3::new(15.0, 15.0, 10.0));
    let united = only(slice_mesh(&together(&[a.clone(), b]), Axis::Z, &[5.0], 0.0));
    assert_eq!(united.area.area(), 175.0);
    assert_eq!(united.area.contours().len(), 1);
    let void = inverted(&cuboid(Vec3::splat(3.0), Vec3::splat(7.0)));
    assert_eq!(only(slice_mesh(&together(&[a, void]), Axis::Z, &[5.0], 0.0)).area.area(), 84.0);
}

#[test]
fn a_mesh_without_shared_vertices_closes_exactly() {
    let ball = soup(&sphere(Vec3::ZERO, 10.0, 60, 120));
    let section = only(slice_mesh(&ball, Axis::Z, &[1.23], 0.0));
    assert!(section.gaps.is_empty(), "{:?}", section.gaps);
    assert!((section.area.area() - section_area(&ball, 1.23)).abs() < 0.01);
}

#[test]
fn an_opening_is_closed_and_told() {
    let mut part = cube(20.0);
    // The two triangles of the side x = 20.
    let is_open_side = |t: &[u32; 3]| t.iter().all(|&v| part.vertices[v as usize].x == 20.0);
    let kept: Vec<[u32; 3]> = part.triangles.iter().copied().filter(|t| !is_open_side(t)).collect();
    assert_eq!(kept.len(), 10);
    part.triangles = kept;
    let section = only(slice_mesh(&part, Axis::Z, &[5.0], 0.0));
    assert_eq!(section.area.area(), 400.0);
    assert_eq!(section.gaps.len(), 1);
    assert_eq!((section.gaps[0].at, section.gaps[0].length), (dvec2(20.0, 10.0), 20.0));
}

#[test]
fn simplified_sections_stay_within_the_resolution() {
    let cone = frustum(&common::circle(DVec2::ZERO, 10.0, 720), 10.0, 0.5);
    let [exact, simple] = [0.0, 0.0125].map(|r| only(slice_mesh(&cone, Axis::Z, &[5.0], r)).area);
    assert!(simple.vertex_count() < exact.vertex_count() / 3);
    let missed = exact.symmetric_difference(&simple).area();
    assert!(missed < exact.length() * 0.0125, "{missed}");
}
