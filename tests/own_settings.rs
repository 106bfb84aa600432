//! Models on a plate with settings of their own.

mod common;

use common::ranges::{file, own, shared};
use common::{cube, cuboid, moved};
use foothold::gcode::read::{ReadMove, Reader};
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Finished, Job, JobError, NamedModel};
use foothold::region::Role;
use foothold::settings::{OwnSettings, Settings};
use glam::{DMat4, Vec3, dvec3};

const AREA: f64 = std::f64::consts::PI * 1.75 * 1.75 / 4.0;

fn model(name: &str, mesh: &Mesh, own: &[&str]) -> NamedModel {
    let own = OwnSettings::resolve([], own.iter().copied()).expect("assignments");
    NamedModel { own, ..NamedModel::new(name, load(&write_binary(mesh)).expect("a good mesh")) }
}

fn prepared(models: &[NamedModel], sets: &[&str]) -> Result<Job, JobError> {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let mut job = Job::new(models, settings, &|| 0.0)?;
    job.prepare(&|| 0.0)?;
    Ok(job)
}

fn sliced(models: &[NamedModel], sets: &[&str]) -> (String, Finished) {
    let job = prepared(models, sets).expect("it fits");
    let count = job.layer_count();
    let (bytes, finished) = file(job, &[0, count], own);
    (String::from_utf8(bytes).expect("ASCII"), finished)
}

/// Beads of the model at each side of the bed's middle along x: they stand in a row of two.
fn sides(text: &str) -> [Vec<ReadMove>; 2] {
    let beads = Reader::new(text.as_bytes()).filter(|s| s.lays_bead() && s.layer > 0);
    let (left, right) = beads.partition(|s| s.to[0] < 110.0);
    [left, right]
}

fn volume(beads: &[ReadMove]) -> f64 {
    beads.iter().map(|s| s.filament_mm * AREA).sum()
}

fn pair(first: &[&str], second: &[&str]) -> [NamedModel; 2] {
    [model("a", &cube(20.0), first), model("b", &cube(20.0), second)]
}

#[test]
fn a_hollow_and_a_solid_cube_have_their_volumes() {
    let own_density = pair(&["infill.density=0"], &["infill.density=1"]);
    for sequence in ["by_layer", "by_object"] {
        let (text, finished) =
            sliced(&own_density, &["adhesion.kind=none", &format!("print.sequence={sequence}")]);
        let [hollow, solid] = sides(&text).map(|beads| volume(&beads));
        // 8000 mm3. Hollow: four bottom and five top layers of 400 mm2 x 0.2, and three beads of 0.45 mm at
        // their spacing of 0.45 - 0.2 (1 - pi / 4) along the rest: 91 layers of 400 - 17.38^2 mm2.
        assert!((solid / 8000.0 - 1.0).abs() < 0.03, "{solid}");
        let ring = 400.0 - (20.0_f64 - 2.0 * (3.0 * 0.4071 + 0.0429)).powi(2);
        let expected = 9.0 * 80.0 + 91.0 * 0.2 * ring;
        assert!((hollow / expected - 1.0).abs() < 0.04, "{hollow} {expected}");
        let all = finished.report.by_role.iter().filter(|(role, _)| **role != Role::Prime);
        let all: f64 = all.map(|(_, used)| used.volume_mm3).sum();
        assert!((hollow + solid - all).abs() < 1e-3 * all, "{hollow} {solid} {all}");
        for line in ["; models.a.infill.density = 0\n", "; models.b.infill.density = 1\n"] {
            assert!(text.contains(line), "{line}");
        }
    }
}

#[test]
fn ranges_and_shares_give_the_bytes_of_the_whole() {
    let slope = [
        model("a", &cube(15.0), &["walls.count=1", "skin.top_layers=9", "infill.pattern=lines"]),
        model("b", &moved(&cuboid(Vec3::ZERO, Vec3::new(12.0, 9.0, 21.0)), Vec3::ZERO), &[]),
        model(
            "c",
            &common::sphere(Vec3::new(0.0, 0.0, 6.0), 7.0, 20, 30),
            &["support.method=plates", "seam.position=rear"],
        ),
    ];
    for sets in [
        vec!["adhesion.kind=brim"],
        vec!["adhesion.kind=raft", "layers.adaptive=true"],
        vec!["print.sequence=by_object"],
    ] {
        let job = || prepared(&slope, &sets).expect("it fits");
        let count = job().layer_count();
        let whole = file(job(), &[0, count], own).0;
        assert!(file(job(), &[0, count / 3, count / 2, count], own).0 == whole, "{sets:?}: ranges differ");
        let cuts: Vec<usize> = (0..count).step_by(11).chain([count]).collect();
        assert!(file(job(), &cuts, shared).0 == whole, "{sets:?}: shares differ");
    }
}

#[test]
fn odd_layers_begin_with_the_body_that_even_ones_end_with() {
    let (text, _) = sliced(&pair(&["walls.count=1"], &["walls.count=2"]), &["adhesion.kind=none"]);
    let mut sides: Vec<bool> = Reader::new(text.as_bytes())
        .filter(|s| s.lays_bead() && s.layer > 0)
        .map(|s| s.to[0] < 110.0)
        .collect();
    sides.dedup();
    // 100 layers, each with one way from model to model.
    assert_eq!(sides.len(), 101);
}

#[test]
fn models_of_equal_settings_are_one_body() {
    let plain = sliced(&pair(&[], &[]), &["walls.count=2"]).0;
    let own_of_both = sliced(&pair(&["walls.count=2"], &["walls.count=2"]), &[]).0;
    let beads = |text: &str| {
        text.lines().take_while(|l| !l.starts_with("; filament used")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(beads(&plain) == beads(&own_of_both));
}

#[test]
fn speeds_and_supports_are_those_of_the_model() {
    // A table: 20 x 20 mm on a leg.
    let table = common::together(&[
        cuboid(Vec3::new(8.0, 8.0, 0.0), Vec3::new(12.0, 12.0, 10.0)),
        cuboid(Vec3::new(0.0, 0.0, 10.0), Vec3::new(20.0, 20.0, 13.0)),
    ]);
    let models =
        [model("a", &table, &["speed.outer_wall=17"]), model("b", &table, &["support.method=plates"])];
    let (text, finished) = sliced(&models, &["adhesion.kind=none", "cooling.min_layer_time=0"]);
    let [a, b] = sides(&text);
    let has = |beads: &[ReadMove], role| beads.iter().any(|s| s.role == Some(role));
    assert!(!has(&a, Role::Support) && has(&b, Role::Support));
    assert!(finished.report.support.is_some());
    let outer = |beads: &[ReadMove]| {
        let walls = beads.iter().filter(|s| s.role == Some(Role::OuterWall) && s.to[2] > 0.3);
        walls.map(|s| s.speed).fold(0.0, f64::max)
    };
    assert_eq!((outer(&a), outer(&b)), (17.0, 30.0));
    // The travels are the plate's; the end code parks as it likes.
    let travels =
        Reader::new(text.as_bytes()).filter(|s| s.moves_in_plane() && !s.lays_bead() && s.layer > 0);
    assert!(travels.filter(|s| s.speed != 150.0).count() <= 1);
}

#[test]
fn layers_of_its_own_need_one_after_another() {
    let fine = pair(&["layers.height=0.1"], &["adhesion.kind=brim"]);
    let (text, finished) = sliced(&fine, &["print.sequence=by_object", "adhesion.kind=none"]);
    // 0.2 + 198 x 0.1 and 100 x 0.2.
    assert_eq!(finished.report.layers, 199 + 100);
    let [a, b] = sides(&text);
    let brim = |beads: &[ReadMove]| beads.iter().any(|s| s.role == Some(Role::Skirt));
    assert!(!brim(&a) && brim(&b));
    let error = prepared(&fine, &[]).expect_err("by layer").to_string();
    assert_eq!(error, "a: layers.height: a model can have its own with print.sequence=by_object only");
    let error = prepared(&pair(&[], &["filament.bed_temp=9"]), &[]).expect_err("the plate's").to_string();
    assert_eq!(error, "b: filament.bed_temp: holds for the whole plate; a model cannot have its own");
    let error = prepared(&pair(&["infill.density=2"], &[]), &[]).expect_err("out of range").to_string();
    assert_eq!(error, "a: infill.density: 2 is outside 0 to 1");
}

#[test]
fn vases_of_different_settings_need_one_after_another() {
    let models = pair(&["walls.width=0.6"], &[]);
    let error = prepared(&models, &["layers.spiral_vase=true"]).expect_err("by layer").to_string();
    assert_eq!(
        error,
        "layers.spiral_vase: models of different settings can be vases with print.sequence=by_object only"
    );
    let (text, _) =
        sliced(&models, &["layers.spiral_vase=true", "print.sequence=by_object", "adhesion.kind=none"]);
    let [a, b] = sides(&text).map(|beads| beads.iter().filter_map(|s| s.width).fold(0.0, f64::max));
    assert_eq!((a, b), (0.6, 0.5));
}

#[test]
fn where_models_overlap_nothing_is_printed_twice() {
    let at = |x: f64| DMat4::from_translation(dvec3(x, 100.0, 0.0));
    let models = pair(&["infill.density=1"], &["infill.density=1", "walls.count=2"]);
    let settings = Settings::resolve([], ["adhesion.kind=none"]).expect("good settings");
    let mut job = Job::placed(&models, &[at(100.0), at(110.0)], settings, &|| 0.0).expect("on the bed");
    job.prepare(&|| 0.0).expect("good settings");
    let count = job.layer_count();
    let (bytes, _) = file(job, &[0, count], own);
    let text = String::from_utf8(bytes).expect("ASCII");
    let printed: f64 = sides(&text).iter().map(|beads| volume(beads)).sum();
    assert!((printed / (30.0 * 20.0 * 20.0) - 1.0).abs() < 0.03, "{printed}");
}
