//! Checks before printing: each fires on its fixture with place and fix, and stays silent on good parts.

mod common;

use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, Warning};
use foothold::settings::Settings;
use glam::{DMat4, Mat3, Vec3, dvec3, vec3};

fn warnings(mesh: &Mesh, sets: &[&str]) -> Vec<Warning> {
    of_bytes(&write_binary(mesh), sets)
}

fn of_bytes(bytes: &[u8], sets: &[&str]) -> Vec<Warning> {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", load(bytes).expect("a mesh"));
    of_job(Job::new(&[named], settings, &|| 0.0).expect("it fits"))
}

fn of_job(mut job: Job) -> Vec<Warning> {
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
        "no_arcs",
        "not_on_bed",
        "thin_wall",
        "lost_wall",
        "overhang",
        "long_bridge",
        "prime_line",
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
    let found = warnings(&common::cube(5.0), &["printer.forbidden=[[0,0,4,2],[100,100,110,120]]"]);
    assert_eq!(codes(&found), ["forbidden_zone"]);
    assert_eq!(found.iter().find(|w| w.code == "forbidden_zone").and_then(|w| w.at), Some([108.75, 110.0]));
}

#[test]
fn a_part_on_the_prime_line_is_told() {
    // The line runs from (5, 3) to (85, 3); the plate begins at 2.5.
    let plate = common::cuboid(Vec3::ZERO, vec3(215.0, 215.0, 0.4));
    let found = warnings(&plate, &["adhesion.kind=none"]);
    assert_eq!(codes(&found), ["prime_line"]);
    let told = found.iter().find(|w| w.code == "prime_line").expect("told");
    assert_eq!((told.at, &told.fix[..]), (Some([45.0, 3.0]), &["printer.prime_length=0".to_owned()][..]));
    assert!(codes(&warnings(&plate, &["adhesion.kind=none", "printer.prime_length=0"])).is_empty());
    // Start code that fills the nozzle itself goes elsewhere.
    let own = "printer.start_gcode=\"G28\\nM109 S200\\nG1 X0 Y-3 Z1\\nG1 X60 E9\"";
    assert!(codes(&warnings(&plate, &["adhesion.kind=none", own])).is_empty());
    let found = warnings(&common::cube(5.0), &["printer.forbidden=[[60,0,80,5]]"]);
    assert_eq!(codes(&found), ["prime_line"]);
    assert!(found.iter().any(|w| w.message.ends_with("through a zone where this printer must not print")));
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
fn an_island_that_begins_with_an_edge_is_told() {
    let floor = common::cuboid(Vec3::ZERO, vec3(20.0, 20.0, 2.0));
    let mut bar = common::cuboid(vec3(5.0, -1.0, -1.0), vec3(15.0, 1.0, 1.0));
    let turn = Mat3::from_rotation_x(std::f32::consts::FRAC_PI_4);
    // Its lower edge lies at 5 mm: the layer at 5.1 mm cuts a strip of 0.2 mm.
    for vertex in &mut bar.vertices {
        *vertex = turn * *vertex + vec3(0.0, 10.0, 5.0 + 2f32.sqrt());
    }
    let found = warnings(&common::together(&[floor, bar]), &[]);
    let islands: Vec<_> = found.iter().filter(|w| w.code == "floating_island").collect();
    assert_eq!(islands.iter().map(|w| w.layer).collect::<Vec<_>>(), [Some(25)], "{found:?}");
}

#[test]
fn a_raft_holds_what_stands_on_it() {
    assert!(codes(&warnings(&common::medley(), &["adhesion.kind=raft"])).is_empty());
}

#[test]
fn arcs_for_a_firmware_without_them_are_told() {
    let cube = common::cube(5.0);
    let sets = ["gcode.arc_fitting=true", "printer.flavor=klipper"];
    let found = warnings(&cube, &sets);
    assert_eq!(codes(&found), ["no_arcs"]);
    assert_eq!(found[0].fix, ["gcode.arc_fitting=false"]);
    assert!(codes(&warnings(&cube, &["gcode.arc_fitting=true"])).is_empty());
}

#[test]
fn a_part_above_the_bed_is_told() {
    let placed = |z: f64| {
        let named = NamedModel::new("part", load(&write_binary(&common::cube(5.0))).expect("a mesh"));
        let up = DMat4::from_translation(dvec3(50.0, 60.0, z));
        of_job(Job::placed(&[named], &[up], Settings::default(), &|| 0.0).expect("it fits"))
    };
    let found = placed(0.5);
    let told = found.iter().find(|w| w.code == "not_on_bed").expect("told");
    assert_eq!((told.layer, told.at), (Some(0), Some([52.5, 62.5])));
    assert!(told.message.contains("0.50 mm"), "{}", told.message);
    // The first layer is cut at 0.1 mm.
    assert!(codes(&placed(0.05)).is_empty());
}

/// A plate 30 x 10 x 2 mm on a foot of 10 x 10 x 5 mm under its left end.
fn balcony() -> Mesh {
    let foot = common::cuboid(Vec3::ZERO, vec3(10.0, 10.0, 5.0));
    common::together(&[foot, common::cuboid(vec3(0.0, 0.0, 5.0), vec3(30.0, 10.0, 7.0))])
}

#[test]
fn a_balcony_is_told_and_mended_by_supports() {
    let found = warnings(&balcony(), &[]);
    assert_eq!(codes(&found), ["overhang"]);
    let told = found.iter().find(|w| w.code == "overhang").expect("told");
    // 20 x 10 mm in the air, from layer 25 on.
    assert_eq!(told.layer, Some(25));
    assert_eq!(told.message, "200 mm2 hang in the air here without supports");
    let [x, y] = told.at.expect("a place");
    // The plate stands at 95 to 125, 105 to 115.
    assert!((105.0..125.0).contains(&x) && (105.0..115.0).contains(&y), "{x} {y}");
    let fixes: Vec<&str> = told.fix.iter().map(String::as_str).collect();
    assert!(!codes(&warnings(&balcony(), &fixes)).contains(&"overhang"));
}

/// A deck on two pillars with this much air between them, mm.
fn deck(span: f32) -> Mesh {
    let pillar = |x: f32| common::cuboid(vec3(x, 0.0, 0.0), vec3(x + 5.0, 10.0, 5.0));
    let top = common::cuboid(vec3(0.0, 0.0, 5.0), vec3(span + 10.0, 10.0, 7.0));
    common::together(&[pillar(0.0), pillar(span + 5.0), top])
}

#[test]
fn long_bridges_are_told_and_short_ones_pass() {
    let found = warnings(&deck(40.0), &[]);
    assert_eq!(codes(&found), ["long_bridge"]);
    let told = found.iter().find(|w| w.code == "long_bridge").expect("told");
    assert_eq!((told.layer, &told.message[..]), (Some(25), "a bridge of 40 mm will sag here"));
    assert!(codes(&warnings(&deck(25.0), &[])).is_empty());
}

#[test]
fn walls_thinner_than_a_line_are_told_with_what_makes_them_thick_enough() {
    let wall = |thickness: f32| common::cuboid(Vec3::ZERO, vec3(30.0, thickness, 2.0));
    let found = warnings(&wall(0.35), &["first_layer.elephant_foot=0"]);
    assert_eq!(codes(&found), ["thin_wall"]);
    let told = found.iter().find(|w| w.code == "thin_wall").expect("told");
    assert_eq!(
        told.message,
        "a wall is thinner than a line here: 0.35 of 0.45 mm; it is printed as one narrow line (on 9 layers)"
    );
    assert_eq!(told.fix, ["walls.horizontal_expansion=0.05"]);
    let sets = ["first_layer.elephant_foot=0", told.fix[0].as_str()];
    assert!(codes(&warnings(&wall(0.35), &sets)).is_empty());
    assert!(codes(&warnings(&wall(0.5), &[])).is_empty());
    assert_eq!(codes(&warnings(&wall(0.08), &["first_layer.elephant_foot=0"])), ["lost_wall"]);
}

/// The report is the same, however the layers are shared out.
#[test]
fn places_are_told_once_for_the_whole_job() {
    let found = warnings(&common::cuboid(Vec3::ZERO, vec3(30.0, 0.35, 10.0)), &[]);
    assert_eq!(codes(&found), ["thin_wall"]);
}

/// A block of 20 x 20 x 6 mm with a fin of 10 mm and this thickness on its right side.
fn finned(thickness: f32) -> Mesh {
    let block = common::cuboid(Vec3::ZERO, vec3(20.0, 20.0, 6.0));
    let fin = common::cuboid(vec3(19.0, 10.0, 0.0), vec3(30.0, 10.0 + thickness, 6.0));
    common::together(&[block, fin])
}

#[test]
fn a_fin_that_gets_no_line_is_told_where_it_is() {
    let found = warnings(&finned(0.08), &[]);
    assert_eq!(codes(&found), ["lost_wall"]);
    let told = found.iter().find(|w| w.code == "lost_wall").expect("told");
    // 30 layers of 0.2 mm, the first of which is not looked at.
    assert_eq!(
        (told.layer, &told.message[..]),
        (Some(1), "a wall is too thin for any line here: it is left out (on 29 layers)")
    );
    // The whole is 30 mm long and stands at 95 to 125; the fin in its last third.
    let [x, y] = told.at.expect("a place");
    assert!((115.0..125.0).contains(&x) && (y - 110.0).abs() < 0.1, "{x} {y}");
    assert_eq!(told.fix, ["walls.horizontal_expansion=0.23"]);
    assert!(codes(&warnings(&finned(0.08), &[told.fix[0].as_str()])).is_empty());
    // From a tenth of a millimetre on it gets a narrow line, and from a line's width on nothing is said.
    assert_eq!(codes(&warnings(&finned(0.2), &[])), ["thin_wall"]);
    assert!(codes(&warnings(&finned(0.5), &[])).is_empty());
}

/// A part without walls is no lost wall.
#[test]
fn no_walls_are_no_lost_walls() {
    assert!(codes(&warnings(&common::cube(5.0), &["walls.count=0"])).is_empty());
}

/// What the checks say of the models, with the reason for each remark, looked at in pictures of the layers.
#[test]
fn real_models_are_passed_or_rightly_told() {
    let Some(dir) = common::models_dir() else { return };
    let expected: [(&str, &[&str]); 24] = [
        ("angle_block_mm.stl", &[]),
        // Its longest bridge has 50 mm.
        ("bridge_test.stl", &["long_bridge"]),
        ("cal_cube.stl", &[]),
        // Balconies, and a fin as thin as a razor.
        ("featuretype_mm.stl", &["overhang", "thin_wall"]),
        ("halfdonut_ascii_tiny.stl", &[]),
        ("hole_test.stl", &[]),
        // The wedge between the arms of a letter cut through its wall.
        ("hollow_cube_ascii.stl", &["floating_island"]),
        ("idler_riser_mm.stl", &[]),
        // Bodies beside and above each other.
        ("multibody_mm.stl", &["overhang", "floating_island"]),
        // Steps up to 80 degrees out of the vertical.
        ("overhang.stl", &["overhang"]),
        ("own_arch_ascii.stl", &[]),
        ("own_hinge.stl", &[]),
        ("own_hinge_dup.stl", &[]),
        ("own_hinge_flipped.stl", &[]),
        ("own_overlap.stl", &[]),
        ("own_wedge_crlf_upper.stl", &[]),
        ("own_wedge_open.stl", &[]),
        ("own_wedge_solidheader.stl", &[]),
        ("retract_tower.stl", &[]),
        // Islands hang in the air.
        ("support_test.stl", &["floating_island"]),
        // Walls of a tenth of a millimetre and more.
        ("thin_wall.stl", &["thin_wall"]),
        ("tolerance.stl", &[]),
        ("two_objects_ascii.stl", &[]),
        ("xy_calibration.stl", &[]),
    ];
    let found = expected.map(|(name, _)| {
        let bytes = std::fs::read(dir.join(name)).expect("a model");
        let found = of_bytes(&bytes, &["layers.height=0.3"]);
        let mut codes: Vec<String> = codes(&found).into_iter().map(str::to_owned).collect();
        codes.dedup();
        (name, codes)
    });
    let expected = expected.map(|(name, codes)| (name, codes.iter().map(|c| (*c).to_owned()).collect()));
    assert_eq!(found, expected);
}
