//! Models printed one after another, as the file says it.

mod common;

use common::ranges::{file, own, shared};
use common::{cube, cuboid, cylinder, moved};
use foothold::gcode::read::{ReadMove, Reader, read};
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Finished, Job, JobError, NamedModel};
use foothold::settings::Settings;
use glam::{DMat4, DVec2, Vec3, dvec2, dvec3};

const BY_OBJECT: &str = "print.sequence=by_object";

fn block(side: f32, height: f32) -> Mesh {
    cuboid(Vec3::ZERO, Vec3::new(side, side, height))
}

fn named(meshes: &[Mesh]) -> Vec<NamedModel> {
    let model = |(k, mesh): (usize, &Mesh)| {
        NamedModel::new(format!("m{}", k + 1), load(&write_binary(mesh)).expect("a good mesh"))
    };
    meshes.iter().enumerate().map(model).collect()
}

fn settings(sets: &[&str]) -> Settings {
    Settings::resolve([], sets.iter().copied()).expect("each by itself is good")
}

fn prepared(meshes: &[Mesh], sets: &[&str]) -> Result<Job, JobError> {
    let mut job = Job::new(&named(meshes), settings(sets), &|| 0.0)?;
    job.prepare(&|| 0.0)?;
    Ok(job)
}

fn sliced(meshes: &[Mesh], sets: &[&str]) -> (String, Finished) {
    let job = prepared(meshes, sets).expect("it fits");
    let count = job.layer_count();
    let (bytes, finished) = file(job, &[0, count], own);
    (String::from_utf8(bytes).expect("ASCII"), finished)
}

/// Boxes of the models on the bed, and their heights, by the placements of the report.
fn boxes(meshes: &[Mesh], finished: &Finished) -> Vec<([DVec2; 2], f64)> {
    let of_one = |(mesh, place): (&Mesh, &[[f64; 4]; 4])| {
        let by = dvec2(place[0][3], place[1][3]);
        let b = mesh.bounds().expect("not empty");
        let [low, high] = [b.min, b.max].map(|v| v.as_dvec3().truncate() + by);
        ([low, high], f64::from(b.max.z - b.min.z))
    };
    meshes.iter().zip(&finished.report.placements).map(of_one).collect()
}

fn distance_to(p: DVec2, [low, high]: [DVec2; 2]) -> f64 {
    p.distance(p.clamp(low, high))
}

/// Model of each bead, by the nearest box; the prime line left out.
fn models_of_beads(text: &str, boxes: &[([DVec2; 2], f64)]) -> Vec<(usize, ReadMove)> {
    let beads = Reader::new(text.as_bytes()).filter(|step| step.lays_bead() && step.layer > 0);
    let nearest = |step: ReadMove| {
        let p = dvec2(step.to[0], step.to[1]);
        let by_distance =
            |a: &usize, b: &usize| distance_to(p, boxes[*a].0).total_cmp(&distance_to(p, boxes[*b].0));
        ((0..boxes.len()).min_by(by_distance).expect("models"), step)
    };
    beads.map(nearest).collect()
}

/// Models of different heights with every kind of base layer.
fn three() -> [Mesh; 3] {
    [block(10.0, 6.0), block(12.0, 12.0), moved(&cylinder(6.0, 8.0, 40), Vec3::new(5.0, 5.0, 0.0))]
}

#[test]
fn a_model_is_done_before_the_next_begins_and_the_lowest_comes_first() {
    for kind in ["none", "skirt", "brim", "raft", "teeth"] {
        let (text, finished) = sliced(&three(), &[BY_OBJECT, &format!("adhesion.kind={kind}")]);
        let boxes = boxes(&three(), &finished);
        let beads = models_of_beads(&text, &boxes);
        let mut order: Vec<usize> = beads.iter().map(|(model, _)| *model).collect();
        order.dedup();
        assert_eq!(order, [0, 2, 1], "{kind}");
        for (k, &(_, height)) in boxes.iter().enumerate() {
            let of_model = || beads.iter().filter(|(model, _)| *model == k).map(|(_, step)| step.to[2]);
            let (low, high) = (of_model().fold(f64::INFINITY, f64::min), of_model().fold(0.0, f64::max));
            assert!((low - 0.2).abs() < 1e-9, "{kind}: {low}");
            assert!(
                high >= height - 1e-6 && (kind == "raft" || high < height + 1e-6),
                "{kind}: {high} {height}"
            );
        }
        let layers = text.matches(";LAYER_CHANGE").count();
        assert_eq!((layers, finished.report.layers), (layers, layers));
        // 30, 40 and 60 layers of 0.2 mm.
        assert!(layers == 130 || kind == "raft", "{kind}: {layers}");
    }
}

#[test]
fn the_head_never_meets_what_is_done() {
    const RADIUS: f64 = 45.0;
    for kind in ["skirt", "teeth", "brim"] {
        let (text, finished) =
            sliced(&three(), &[BY_OBJECT, &format!("adhesion.kind={kind}"), "retraction.z_hop=0.3"]);
        let boxes = boxes(&three(), &finished);
        let order = [0, 2, 1];
        let mut at = 0;
        for step in Reader::new(text.as_bytes()).filter(|step| step.layer > 0) {
            let ends = [step.from, step.to].map(|p| dvec2(p[0], p[1]));
            while step.lays_bead() && at < 2 && distance_to(ends[1], boxes[order[at + 1]].0) < 15.0 {
                at += 1;
            }
            for &done in &order[..at] {
                let (walls, height) = boxes[done];
                for share in 0..=16 {
                    let share = f64::from(share) / 16.0;
                    let z = step.from[2] + (step.to[2] - step.from[2]) * share;
                    let p = ends[0].lerp(ends[1], share);
                    assert!(
                        z > height + 1.0 || distance_to(p, walls) >= RADIUS,
                        "{kind}: {p} at {z} is {} mm from a part {height} mm tall",
                        distance_to(p, walls)
                    );
                }
            }
        }
        assert_eq!(at, 2);
    }
}

#[test]
fn the_way_to_the_next_model_leads_over_all_that_is_printed() {
    let (text, _) = sliced(&[block(10.0, 4.0), block(10.0, 6.0)], &[BY_OBJECT, "adhesion.kind=none"]);
    let second = text.match_indices(";LAYER_CHANGE").nth(20).expect("20 and 30 layers").0;
    let way: Vec<&str> = text[second..].lines().take(12).collect();
    // From 4 mm up to 2 mm above, across, and down to the first layer; the fan stands still there.
    assert_eq!(&way[..3], [";LAYER_CHANGE", ";Z:0.2", ";HEIGHT:0.2"]);
    let moves: Vec<&str> = way.iter().copied().filter(|l| !l.starts_with("M73")).skip(3).collect();
    assert_eq!(moves[0], "G1 E-0.8 F2100");
    assert_eq!(moves[1], "G1 Z6 F600");
    assert!(
        moves[2].starts_with("G1 X") && moves[2].ends_with(" F9000") && !moves[2].contains('E'),
        "{way:?}"
    );
    assert_eq!(&moves[3..6], ["G1 Z0.2 F600", "G1 E0.8 F2100", "M107"]);
}

#[test]
fn every_first_layer_has_its_temperatures_and_its_speed() {
    let sets = [BY_OBJECT, "filament.first_layer_nozzle_temp=215", "filament.first_layer_bed_temp=65"];
    let (text, finished) = sliced(&three(), &sets);
    // The start waits for the first one.
    assert_eq!(text.matches("\nM109 S215").count(), 3);
    assert_eq!(text.matches("\nM190 S65").count(), 3);
    assert_eq!((text.matches("\nM104 S210\n").count(), text.matches("\nM140 S60\n").count()), (3, 3));
    let beads = models_of_beads(&text, &boxes(&three(), &finished));
    let fastest = |low: bool| {
        let of_layer = beads.iter().filter(|(_, s)| (s.to[2] < 0.3) == low && s.role.is_some());
        of_layer.map(|(_, s)| s.speed).fold(0.0, f64::max)
    };
    assert!(fastest(true) <= 25.0 && fastest(false) > 25.0);
    assert!(beads.iter().all(|(_, s)| s.to[2] > 0.3 || s.fan == 0));
}

#[test]
fn ranges_and_shares_give_the_bytes_of_the_whole() {
    for sets in [
        vec![BY_OBJECT, "adhesion.kind=teeth"],
        vec![BY_OBJECT, "adhesion.kind=raft", "support.method=plates"],
        vec![BY_OBJECT, "layers.adaptive=true", "retraction.wipe=true", "gcode.arc_fitting=true"],
        vec![BY_OBJECT, "layers.spiral_vase=true", "printer.label_objects=true"],
    ] {
        let job = || prepared(&three(), &sets).expect("it fits");
        let count = job().layer_count();
        let whole = file(job(), &[0, count], own).0;
        let cuts: Vec<usize> = (0..count).step_by(17).chain([count]).collect();
        assert!(file(job(), &cuts, own).0 == whole, "{sets:?}: ranges differ");
        assert!(file(job(), &[0, count / 3, count / 2, count], shared).0 == whole, "{sets:?}: shares differ");
    }
}

#[test]
fn one_model_alone_is_printed_as_always() {
    let lines = |sets: &[&str]| {
        let (text, _) = sliced(&[cube(10.0)], sets);
        text.lines().filter(|l| !l.starts_with("; print.sequence")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(lines(&[BY_OBJECT]) == lines(&[]));
}

#[test]
fn vases_follow_one_another() {
    let vases = [cylinder(10.0, 6.0, 60), cylinder(8.0, 5.0, 60)];
    let (text, finished) = sliced(&vases, &[BY_OBJECT, "layers.spiral_vase=true", "adhesion.kind=none"]);
    assert!(finished.report.warnings.is_empty(), "{:?}", finished.report.warnings);
    let climbs = Reader::new(text.as_bytes()).filter(|s| s.lays_bead() && s.to[2] > s.from[2]).count();
    // 21 and 26 turns above four bottom layers of 60 corners each, or a few more where turns end.
    assert!((2700..3100).contains(&climbs), "{climbs}");
}

#[test]
fn labels_name_each_model_in_one_stretch() {
    let sets = [BY_OBJECT, "printer.label_objects=true", "adhesion.kind=none"];
    let (text, _) = sliced(&three(), &sets);
    let mut begun: Vec<&str> = text.lines().filter(|l| l.starts_with("M486 S") && *l != "M486 S-1").collect();
    begun.dedup();
    assert_eq!(begun, ["M486 S0", "M486 S2", "M486 S1"]);
}

#[test]
fn a_file_read_back_has_the_layers_of_each_model() {
    let (text, finished) = sliced(&[block(10.0, 2.0), block(10.0, 3.0)], &[BY_OBJECT]);
    let layers = read(text.as_bytes(), 1.75).layers;
    assert_eq!(layers.len(), finished.report.layers);
    let tops: Vec<i64> = layers.iter().map(|l| (l.z * 1000.0).round() as i64).collect();
    let expected: Vec<i64> = (1..=10).chain(1..=15).map(|k| 200 * k).collect();
    assert_eq!(tops, expected);
    // Without a stated height it is what the layer rises above the one before, or above the bed.
    let bare: String = text.lines().filter(|l| !l.starts_with(";HEIGHT")).map(|l| format!("{l}\n")).collect();
    assert!(read(bare.as_bytes(), 1.75).layers.iter().all(|l| (l.height - 0.2).abs() < 1e-9));
    let volume: f64 = finished.report.by_role.values().map(|used| used.volume_mm3).sum();
    assert!((volume - finished.report.filament.volume_mm3).abs() < 1e-6);
    assert!((text.matches("M73 P100").count(), text.matches("M73 P0 ").count()) == (1, 1));
}

fn refusal(meshes: &[Mesh], sets: &[&str]) -> String {
    let sets: Vec<&str> = [BY_OBJECT].into_iter().chain(sets.iter().copied()).collect();
    prepared(meshes, &sets).expect_err("a contradiction").to_string()
}

#[test]
fn what_cannot_be_printed_one_after_another_is_refused() {
    let pair = [block(10.0, 30.0), block(10.0, 40.0)];
    assert_eq!(
        refusal(&pair, &[]),
        "print.sequence: part 1 (m1) is 30.0 mm tall; to print one after another all parts but the tallest \
         must be below 25 mm (printer.extruder_clearance_height)"
    );
    assert!(prepared(&pair, &[BY_OBJECT, "printer.extruder_clearance_height=30"]).is_ok());
    assert_eq!(
        refusal(&pair, &[r#"gcode.events=[{"layer":3,"kind":"pause"}]"#]),
        "print.sequence: models cannot be printed one after another with pauses and other events at layers \
         (gcode.events)"
    );
    assert!(refusal(&pair, &["support.tool=1", "printer.extruders=2"]).ends_with("(support.tool)"));
    // Five parts of 60 mm with 45 mm between them do not fit 220 mm.
    let many = vec![block(60.0, 5.0); 5];
    let error = Job::new(&named(&many), settings(&[BY_OBJECT]), &|| 0.0).expect_err("too many");
    assert!(matches!(error, JobError::Fit(_)), "{error}");
}

#[test]
fn parts_placed_too_near_are_named_with_their_distance() {
    let at = |x: f64| DMat4::from_translation(dvec3(x, 100.0, 0.0));
    let models = named(&[block(10.0, 5.0), block(10.0, 5.0)]);
    let job = |x: f64, kind: &str| {
        let sets = [BY_OBJECT, &format!("adhesion.kind={kind}")];
        let mut job = Job::placed(&models, &[at(50.0), at(x)], settings(&sets), &|| 0.0).expect("on the bed");
        job.prepare(&|| 0.0).map_err(|e| e.to_string())
    };
    assert_eq!(job(105.0, "none"), Ok(()));
    assert_eq!(
        job(90.0, "none"),
        Err("print.sequence: part 1 (m1) and part 2 (m2) are 30.0 mm apart, base layer included; to print one \
             after another the head needs 45 mm (printer.extruder_clearance_radius)"
            .to_owned())
    );
    // The brim of the second one comes nearer than it does itself.
    assert!(job(105.0, "brim").is_err());
    assert!(job(115.0, "brim").is_ok());
}
