//! What is repaired, what is left alone, and that both are said.

mod common;

use common::*;
use foothold::mesh::stl::write_binary;
use foothold::mesh::{Condition, Inspection, Mesh, Repairs, load, repair};
use glam::{Vec3, vec3};
use proptest::prelude::*;

/// The mesh after repair, with what was done and what is left.
fn repaired(mesh: &Mesh) -> (Mesh, Repairs, Condition) {
    let mut mesh = mesh.clone();
    let (repairs, condition) = repair(&mut mesh);
    (mesh, repairs, condition)
}

fn turn(mesh: &mut Mesh, triangles: impl IntoIterator<Item = usize>) {
    triangles.into_iter().for_each(|t| mesh.triangles[t].swap(1, 2));
}

fn boxed(centre: Vec3, edge: f32) -> Mesh {
    cuboid(centre - edge / 2.0, centre + edge / 2.0)
}

#[test]
fn triangles_that_disagree_are_turned() {
    let sound = cube(10.0);
    for wrong in [vec![3], vec![0, 1, 5, 7, 11], (1..12).collect()] {
        let mut mesh = sound.clone();
        turn(&mut mesh, wrong.clone());
        let (mesh, repairs, _) = repaired(&mesh);
        assert_eq!(repairs.flipped_faces, wrong.len(), "{wrong:?}");
        assert_eq!(repairs.inverted_shells, 0);
        assert!(is_closed(&mesh));
        assert_near(mesh.volume(), 1000.0, 1e-9);
    }
}

#[test]
fn a_body_inside_out_is_turned_as_a_whole() {
    let (mesh, repairs, _) = repaired(&inverted(&cube(10.0)));
    assert_eq!((repairs.flipped_faces, repairs.inverted_shells), (0, 1));
    assert_near(mesh.volume(), 1000.0, 1e-9);
}

#[test]
fn a_cavity_stays_and_a_solid_in_it_too() {
    let nest = [boxed(Vec3::ZERO, 10.0), inverted(&boxed(Vec3::ZERO, 6.0)), boxed(Vec3::ZERO, 2.0)];
    let (mesh, repairs, condition) = repaired(&together(&nest));
    assert_eq!(repairs, Repairs::default());
    assert_near(mesh.volume(), 1000.0 - 216.0 + 8.0, 1e-9);
    assert_near(condition.volume, 792.0, 1e-9);
    assert_eq!(condition.shells, 3);
}

#[test]
fn a_nest_that_is_all_inside_out_is_all_turned() {
    let nest = [boxed(Vec3::ZERO, 2.0), inverted(&boxed(Vec3::ZERO, 6.0)), boxed(Vec3::ZERO, 10.0)];
    let (mesh, repairs, _) = repaired(&inverted(&together(&nest)));
    assert_eq!(repairs.inverted_shells, 3);
    assert_near(mesh.volume(), 792.0, 1e-9);
}

#[test]
fn only_the_outer_body_is_turned_where_only_it_is_wrong() {
    let hollow = [inverted(&boxed(Vec3::ZERO, 10.0)), inverted(&boxed(Vec3::ZERO, 6.0))];
    let (mesh, repairs, _) = repaired(&together(&hollow));
    assert_eq!(repairs.inverted_shells, 1);
    assert_near(mesh.volume(), 784.0, 1e-9);
}

#[test]
fn a_body_in_a_body_stays_a_body() {
    let insert = [boxed(Vec3::ZERO, 10.0), boxed(Vec3::ZERO, 6.0)];
    let (mesh, repairs, _) = repaired(&together(&insert));
    assert_eq!(repairs, Repairs::default());
    assert_near(mesh.volume(), 1216.0, 1e-9);
}

#[test]
fn an_inverted_body_beside_or_half_in_another_is_no_cavity() {
    for at in [vec3(20.0, 0.0, 0.0), vec3(5.0, 1.0, 1.0), vec3(0.0, 0.0, 20.0)] {
        let two = [boxed(Vec3::ZERO, 10.0), inverted(&boxed(at, 4.0))];
        let (mesh, repairs, _) = repaired(&together(&two));
        assert_eq!(repairs.inverted_shells, 1, "{at}");
        assert_near(mesh.volume(), 1064.0, 1e-6);
    }
}

#[test]
fn a_cavity_is_known_in_an_open_body_too() {
    let mut outer = boxed(Vec3::ZERO, 10.0);
    outer.triangles.remove(0);
    let (_, repairs, condition) = repaired(&together(&[outer, inverted(&boxed(Vec3::ZERO, 6.0))]));
    assert_eq!((repairs.inverted_shells, condition.open_edges), (0, 3));
}

#[test]
fn duplicates_go_and_opposite_faces_stay() {
    let sound = cube(10.0);
    let mut doubled = sound.clone();
    doubled.triangles.extend(sound.triangles.iter().step_by(2).map(|&[a, b, c]| [b, c, a]));
    let (mesh, repairs, condition) = repaired(&doubled);
    assert_eq!((repairs.duplicates_dropped, condition.non_manifold_edges), (6, 0));
    assert_eq!(mesh, sound);

    // Two cubes share a face: both its sides stay, and its four edges have four triangles each.
    let touching = together(&[cube(10.0), cuboid(vec3(10.0, 0.0, 0.0), vec3(20.0, 10.0, 10.0))]);
    let found = load(&write_binary(&touching)).expect("sound").inspection;
    assert_eq!((found.triangles, found.triangles_kept, found.duplicates_dropped), (24, 24, 0));
    assert_near(found.volume_mm3, 2000.0, 1e-9);
    assert_eq!((found.shells, found.non_manifold_edges, found.warnings.len()), (1, 4, 0));
}

#[test]
fn an_inverted_solid_that_touches_another_is_turned() {
    let other = inverted(&cuboid(vec3(10.0, 10.0, 0.0), vec3(20.0, 20.0, 10.0)));
    let found = load(&write_binary(&together(&[cube(10.0), other]))).expect("sound").inspection;
    assert_eq!((found.non_manifold_edges, found.inverted_shells, found.flipped_faces), (1, 1, 0));
    assert_near(found.volume_mm3, 2000.0, 1e-9);
}

#[test]
fn near_vertices_on_open_edges_are_merged() {
    let mut loose = soup(&sphere(Vec3::ZERO, 10.0, 12, 16));
    for (i, v) in loose.vertices.iter_mut().enumerate() {
        *v += 1e-4 * vec3((i % 3) as f32 - 1.0, (i % 5) as f32 / 2.0 - 1.0, (i % 7) as f32 / 3.0 - 1.0);
    }
    let (mesh, repairs, condition) = repaired(&loose);
    assert_eq!(mesh.vertices.len(), 2 + 11 * 16);
    assert_eq!(repairs.merged_vertices, loose.vertices.len() - mesh.vertices.len());
    assert_eq!(condition.open_edges, 0);
    assert!(is_closed(&mesh));
}

#[test]
fn vertices_farther_apart_than_a_micrometre_are_not_merged() {
    let mut mesh = soup(&cube(10.0));
    mesh.vertices.iter_mut().enumerate().for_each(|(i, v)| v.x += 0.002 * i as f32);
    let (_, repairs, condition) = repaired(&mesh);
    assert_eq!((repairs.merged_vertices, condition.open_edges), (0, 36));
}

#[test]
fn a_triangle_without_area_goes_and_the_seam_closes() {
    // The cube's top edge from 4 to 5 gets a point in its middle that only one side uses; a
    // triangle without area lies between that side and the other.
    let mut mesh = cube(10.0);
    let at = |p: Vec3| mesh.vertices.iter().position(|&v| v == p).expect("a corner") as u32;
    let (from, to) = (at(vec3(0.0, 0.0, 10.0)), at(vec3(10.0, 0.0, 10.0)));
    let middle = mesh.vertices.len() as u32;
    mesh.vertices.push(vec3(5.0, 0.0, 10.0));
    let runs = |t: &[u32; 3]| (0..3).find(|&k| (t[k], t[(k + 1) % 3]) == (from, to));
    let (place, k) =
        mesh.triangles.iter().enumerate().find_map(|(i, t)| Some((i, runs(t)?))).expect("an edge");
    let far = mesh.triangles[place][(k + 2) % 3];
    mesh.triangles[place] = [from, middle, far];
    mesh.triangles.push([middle, to, far]);
    mesh.triangles.push([from, to, middle]);
    assert!(is_closed(&mesh));

    let (mesh, repairs, condition) = repaired(&mesh);
    assert_eq!(repairs, Repairs { degenerate_dropped: 1, ..Repairs::default() });
    assert_eq!(mesh.triangles.len(), 14, "12, and the two at the edge split");
    assert!(is_closed(&mesh));
    assert_eq!(condition.open_edges, 0);
    assert_near(mesh.volume(), 1000.0, 1e-12);
    assert!((0..14).all(|t| {
        let [a, b, c] = mesh.corners(t);
        (b - a).cross(c - a).length() > 1.0
    }));
}

#[test]
fn a_chain_of_triangles_without_area_is_undone() {
    // A strip of n points on one edge, closed by a fan of flat triangles over its chord.
    let points: Vec<Vec3> = (0..9).map(|i| vec3(i as f32, 0.0, 0.0)).collect();
    let mut mesh = Mesh { vertices: points, triangles: Vec::new() };
    mesh.vertices.extend([vec3(4.0, 5.0, 0.0), vec3(4.0, 2.0, 3.0)]);
    mesh.triangles.extend((0..8).map(|i| [i, i + 1, 9]));
    mesh.triangles.extend((1..8).map(|i| [0, i + 1, i])); // flat: chords 0-2, 0-3 ... 0-8
    mesh.triangles.extend([[8, 0, 10], [9, 8, 10], [0, 9, 10]]);
    assert!(is_closed(&mesh));
    let (mesh, repairs, condition) = repaired(&mesh);
    assert_eq!((repairs.degenerate_dropped, condition.open_edges), (7, 0));
    assert!(is_closed(&mesh));
    // Base 8 x 5 / 2, height 3.
    assert_near(mesh.volume().abs(), 20.0, 1e-12);
}

#[test]
fn open_edges_are_counted_and_said() {
    let mut open = cube(10.0);
    open.triangles.remove(0);
    let found = load(&write_binary(&open)).expect("it can be sliced").inspection;
    assert_eq!((found.open_edges, found.shells), (3, 1));
    assert_eq!(found.warnings.len(), 1);
    assert_eq!(
        found.warnings[0].message,
        "3 open edges: the surface has a hole there, and layers are closed by guess"
    );
    // The hole is flat, so that the cone over its border has no volume.
    assert_near(found.volume_mm3, 1000.0, 1e-9);
}

#[test]
fn an_open_body_inside_out_is_turned() {
    let mut open = inverted(&sphere(Vec3::ZERO, 10.0, 20, 20));
    open.triangles.drain(..20);
    let (_, repairs, condition) = repaired(&open);
    assert_eq!(repairs.inverted_shells, 1);
    assert!(condition.volume > 0.0);
}

#[test]
fn a_sheet_has_no_inside() {
    let sheet = Mesh { vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]] };
    let found = load(&write_binary(&sheet)).expect("a triangle with an area").inspection;
    let codes: Vec<&str> = found.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["open_edges", "no_volume", "unit_inch"]);
    assert_eq!((found.open_edges, found.area_mm2, found.volume_mm3), (3, 0.5, 0.0));
}

#[test]
fn the_inspection_reads_as_json() {
    let found: Inspection = load(&write_binary(&cube(20.0))).expect("sound").inspection;
    let json = serde_json::to_value(&found).expect("plain numbers");
    assert_eq!(json["bounds"]["max"], serde_json::json!([20.0, 20.0, 20.0]));
    assert_eq!((&json["triangles"], &json["volume_mm3"]), (&12.into(), &8000.0.into()));
    assert_eq!(json["format"], "binary");
    assert_eq!(json["warnings"], serde_json::json!([]));
}

/// Triangles among few points: every kind of bad mesh.
fn tangle() -> impl Strategy<Value = Mesh> {
    let vertices = prop::collection::vec(prop::array::uniform3(0u8..4), 3..12);
    let triangles = prop::collection::vec(prop::array::uniform3(any::<prop::sample::Index>()), 0..40);
    (vertices, triangles).prop_map(|(vertices, triangles)| Mesh {
        triangles: triangles.iter().map(|t| t.map(|i| i.index(vertices.len()) as u32)).collect(),
        vertices: vertices.iter().map(|v| Vec3::from_array(v.map(f32::from))).collect(),
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn repair_never_panics_and_leaves_only_triangles_with_area(mesh in tangle()) {
        let (mesh, _, condition) = repaired(&mesh);
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(t);
            prop_assert!((b - a).cross(c - a) != Vec3::ZERO);
        }
        prop_assert!(condition.volume.is_finite());
    }

    #[test]
    fn any_faces_of_a_torus_may_be_turned_and_doubled(turned in prop::collection::vec(0usize..96, 0..60), doubled in prop::collection::vec(0usize..96, 0..30)) {
        let sound = torus(10.0, 3.0, 8, 6);
        let mut mesh = sound.clone();
        let mut doubled = doubled;
        doubled.sort_unstable();
        doubled.dedup();
        let mut turned = turned;
        turned.sort_unstable();
        turned.dedup();
        turn(&mut mesh, turned.iter().copied());
        let copies: Vec<[u32; 3]> = doubled.iter().map(|&t| mesh.triangles[t]).collect();
        mesh.triangles.extend(copies);
        let (mesh, repairs, _) = repaired(&mesh);
        prop_assert_eq!(repairs.duplicates_dropped, doubled.len());
        prop_assert_eq!(repairs.flipped_faces, turned.len());
        prop_assert!(is_closed(&mesh));
        prop_assert!((mesh.volume() - sound.volume()).abs() < 1e-6 * sound.volume());
    }
}
