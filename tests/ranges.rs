//! A job cut into ranges, worked by engines that hold it or not, gives the same bytes as in one go.

mod common;

use common::ranges::{file, own, shared};
use common::{bracket, cylinder, moved, sphere, together, torus};
use foothold::mesh::{LoadedModel, Mesh, load};
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;
use glam::Vec3;

fn model(mesh: &Mesh) -> LoadedModel {
    load(&foothold::mesh::stl::write_binary(mesh)).expect("a good mesh")
}

fn job(mesh: &Mesh, sets: &[&str]) -> Job {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", model(mesh));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    job
}

fn assert_same_bytes(mesh: &Mesh, sets: &[&str]) {
    let count = job(mesh, sets).layer_count();
    let (whole, _) = file(job(mesh, sets), &[0, count], own);
    assert!(whole.len() > 10_000);
    let mut cuts: Vec<usize> = (0..count).step_by(7).collect();
    cuts.push(count);
    assert!(file(job(mesh, sets), &cuts, own).0 == whole, "ranges differ from the whole");
    assert!(file(job(mesh, sets), &cuts, shared).0 == whole, "shares differ from the whole");
    let mixed = |j: &Job, a, b| if a % 2 == 0 { own(j, a, b) } else { shared(j, a, b) };
    assert!(file(job(mesh, sets), &[0, 1, 2, 3, count - 1, count], mixed).0 == whole, "a mix differs");
}

#[test]
fn modes_are_the_same_in_ranges() {
    let part = together(&[
        cylinder(10.0, 6.0, 64),
        moved(&sphere(Vec3::new(0.0, 0.0, 6.0), 9.0, 24, 36), Vec3::ZERO),
    ]);
    for mode in ["layers.spiral_vase=true", "layers.adaptive=true", "ironing.enabled=true"] {
        assert_same_bytes(&part, &[mode, "retraction.wipe=true"]);
    }
}

#[test]
fn ranges_and_shares_give_the_bytes_of_the_whole() {
    let part = together(&[
        bracket(20.0, 5.0, 8.0),
        moved(&sphere(Vec3::new(0.0, 0.0, 6.0), 6.0, 40, 60), Vec3::new(40.0, 0.0, 0.0)),
        moved(&cylinder(4.0, 9.0, 50), Vec3::new(-20.0, 5.0, 0.0)),
        moved(&torus(8.0, 3.0, 60, 30), Vec3::new(0.0, 30.0, 3.0)),
    ]);
    for kind in ["none", "skirt", "brim", "raft", "teeth"] {
        assert_same_bytes(&part, &[&format!("adhesion.kind={kind}")]);
    }
    assert_same_bytes(&part, &["skin.top_layers=0", "skin.bottom_layers=0", "infill.pattern=lines"]);
    assert_same_bytes(&part, &["support.method=plates"]);
    assert_same_bytes(&part, &["support.method=grid", "adhesion.kind=raft"]);
    assert_same_bytes(&part, &["infill.density=1", "walls.count=1", "skin.top_layers=9"]);
}

#[test]
fn a_raft_lifts_the_part() {
    let cube = common::cube(10.0);
    let plain = job(&cube, &["adhesion.kind=none"]);
    let raised = job(&cube, &["adhesion.kind=raft", "adhesion.raft.layers=2"]);
    assert!(raised.layer_count() > plain.layer_count());
    let extra = raised.layer_count() - plain.layer_count();
    let lift = raised.specs()[extra].print_z - plain.specs()[0].print_z;
    let raft_top = raised.specs()[extra - 1].print_z;
    assert!((lift - raft_top - 0.2).abs() < 1e-9, "the part hangs adhesion.raft.gap above the raft");
    let (file, _) = file(raised, &[0, extra + 50], own);
    let text = String::from_utf8(file).expect("ASCII");
    assert!(text.contains(&format!(";Z:{}", plain.specs()[0].print_z + lift)));
}
