//! Checks before printing: each fires on its fixture with place and fix, and stays silent on good parts.

mod common;

use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, Warning};
use foothold::settings::Settings;
use glam::{Vec3, vec3};

fn warnings(mesh: &Mesh, sets: &[&str]) -> Vec<Warning> {
    of_bytes(&write_binary(mesh), sets)
}

fn of_bytes(bytes: &[u8], sets: &[&str]) -> Vec<Warning> {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", load(bytes).expect("a mesh"));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let ranges: Vec<_> = (0..job.layer_count()).step_by(7).collect();
    for first in ranges {
        let meta = job.slice(first, (first + 7).min(job.layer_count()), &|| 0.0).meta;
        job.add(meta);
    }
    job.finish(&|| 0.0).expect("all layers").report.warnings
}

/// Codes of this module's checks among the warnings.
fn codes(found: &[Warning]) -> Vec<&str> {
    let ours = [
        "too_hot_for_printer",
        "nozzle_temperature",
        "bed_temperature",
        "no_pressure_advance",
        "forbidden_zone",
        "floating_island",
    ];
    found.iter().map(|w| w.code.as_str()).filter(|c| ours.contains(c)).collect()
}

#[test]
fn a_good_part_is_passed_in_silence() {
    assert!(codes(&warnings(&common::medley(), &[])).is_empty());
}

#[test]
fn temperatures_are_held_against_material_and_printer() {
    let cube = common::cube(5.0);
    let found = warnings(&cube, &["filament.nozzle_temp=150", "filament.bed_temp=90"]);
    assert_eq!(codes(&found), ["nozzle_temperature", "bed_temperature"]);
    assert_eq!(
        (&found[0].fix[..], &found[1].fix[..]),
        (&["filament.nozzle_temp=190".to_owned()][..], &["filament.bed_temp=70".to_owned()][..])
    );
    assert!(
        found[0].message.starts_with("filament.nozzle_temp: 150 degrees C do not suit PLA: 190 to 230 do")
    );
    let found = warnings(&cube, &["printer.max_nozzle_temp=200"]);
    assert_eq!(codes(&found), ["too_hot_for_printer"; 2]);
    assert_eq!(found[0].fix, ["filament.nozzle_temp=200"]);
}

/// What a fix says can be set, and then the check is silent.
#[test]
fn fixes_mend_what_they_are_for() {
    let cube = common::cube(5.0);
    let sets =
        ["printer.flavor=repetier", "filament.pressure_advance=0.05", "filament.first_layer_bed_temp=100"];
    let found = warnings(&cube, &sets);
    assert_eq!(codes(&found), ["bed_temperature", "no_pressure_advance"]);
    let fixes: Vec<String> = found.iter().flat_map(|w| w.fix.clone()).collect();
    let sets: Vec<&str> = sets.into_iter().chain(fixes.iter().map(String::as_str)).collect();
    assert!(codes(&warnings(&cube, &sets)).is_empty());
}

#[test]
fn a_part_in_a_forbidden_zone_is_told_with_its_place() {
    // The cube stands at 107.5 to 112.5; the zone covers its left half.
    let found = warnings(&common::cube(5.0), &["printer.forbidden=[[0,0,5,5],[100,100,110,120]]"]);
    assert_eq!(codes(&found), ["forbidden_zone"]);
    assert_eq!(found.iter().find(|w| w.code == "forbidden_zone").and_then(|w| w.at), Some([108.75, 110.0]));
}

#[test]
fn an_island_in_the_air_is_told_where_it_begins() {
    let floor = common::cuboid(Vec3::ZERO, vec3(20.0, 20.0, 2.0));
    let lost = common::cuboid(vec3(2.0, 2.0, 5.0), vec3(6.0, 6.0, 8.0));
    let part = common::together(&[floor, lost]);
    let found = warnings(&part, &[]);
    assert_eq!(codes(&found), ["floating_island"]);
    let island = found.iter().find(|w| w.code == "floating_island").expect("found above");
    // Layers of 0.2 mm: the first that cuts above 5 mm is number 25, counted from 0.
    assert_eq!((island.layer, &island.fix[..]), (Some(25), &["support.method=\"plates\"".to_owned()][..]));
    let [x, y] = island.at.expect("a place");
    // The floor's corner stands at 100, 100.
    assert!((102.0..=106.0).contains(&x) && (102.0..=106.0).contains(&y));
    assert!(codes(&warnings(&part, &["support.method=grid"])).is_empty());
    assert!(codes(&warnings(&part, &["adhesion.kind=raft"])).contains(&"floating_island"));
}

#[test]
fn a_raft_holds_what_stands_on_it() {
    assert!(codes(&warnings(&common::medley(), &["adhesion.kind=raft"])).is_empty());
}

#[test]
fn real_models_have_no_islands_in_the_air() {
    let Some(dir) = common::models_dir() else { return };
    for name in ["angle_block_mm.stl", "cal_cube.stl", "hole_test.stl", "tolerance.stl", "xy_calibration.stl"]
    {
        let bytes = std::fs::read(dir.join(name)).expect("a model");
        assert!(codes(&of_bytes(&bytes, &["layers.height=0.3"])).is_empty(), "{name}");
    }
}
