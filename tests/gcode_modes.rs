//! Arcs, events at layers, spirals, ironing and adaptive heights, as the file says them.

mod common;

use common::layers::layer;
use common::{cuboid, cylinder, moved, sphere, together, tube};
use foothold::gcode::read::{ReadMove, Reader, read};
use foothold::gcode::{
    Curve, EventKind, FileNotes, Flavor, GcodeOptions, LayerEvent, LayerInput, Move, Place, Spiral, assemble,
    filament_area, join, layer_gcode, plan_layer,
};
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, Report};
use foothold::polygon::{DVec2, dvec2, trig};
use foothold::region::{Bead, Path, Role};
use foothold::settings::Settings;
use glam::Vec3;
use proptest::prelude::*;

/// Arcs allowed, nothing slowed down.
fn with_arcs(tolerance: f64) -> GcodeOptions {
    let mut options = GcodeOptions::default();
    options.printer.flavor = Flavor::Prusa;
    options.cooling.min_layer_time = 0.0;
    (options.output.arc_fitting, options.output.arc_tolerance) = (true, tolerance);
    options
}

fn run(mesh: &Mesh, sets: &[&str]) -> (String, Report) {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", load(&write_binary(mesh)).expect("a good mesh"));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    let file = assemble(&finished.joined, &range.texts);
    (String::from_utf8(file).expect("ASCII"), finished.report)
}

fn refusal(sets: &[&str]) -> String {
    let settings = Settings::resolve([], sets.iter().copied()).expect("each by itself is good");
    let named = NamedModel::new("part", load(&write_binary(&common::cube(10.0))).expect("a good mesh"));
    Job::new(&[named], settings, &|| 0.0).expect_err("a contradiction").to_string()
}

#[test]
fn a_circle_is_two_arcs() {
    // Radius 10, 120 corners: sagitta 10 (1 - cos 1.5 degrees) = 0.0034 mm. Its perimeter is
    // 240 sin 1.5 degrees 10 = 62.8247 mm; at 0.0814159 mm2 over 2.4052819 mm2 that is 2.12654 mm of filament.
    let circle = Path::closed(Role::OuterWall, common::circle(dvec2(50.0, 50.0), 10.0, 120), 0.45);
    let made = layer_gcode(&layer(1, &[circle]), &with_arcs(0.01));
    let text = String::from_utf8(made.text).expect("ASCII");
    let arcs: Vec<&str> = text.lines().filter(|l| l.starts_with('G')).collect();
    assert_eq!(arcs.len(), 2, "{text}");
    assert!(arcs[0].starts_with("G3 X40 Y50 I-10 J0 E1.0632") && arcs[0].ends_with(" F1800"), "{text}");
    assert!(arcs[1].starts_with("G3 X60 Y50 I10 J0 E1.0632"), "{text}");
    assert!((made.summary.filament_mm - 2.126_54).abs() < 1e-4, "{}", made.summary.filament_mm);
    // From rest to rest at 30 mm/s: 62.83 / 30 + 30 / 1500 = 2.1144 s.
    assert!((made.summary.time_s - 2.1144).abs() < 1e-3, "{}", made.summary.time_s);
}

#[test]
fn arcs_are_not_written_for_a_firmware_that_has_none() {
    let circle = Path::closed(Role::OuterWall, common::circle(dvec2(50.0, 50.0), 10.0, 120), 0.45);
    let mut options = with_arcs(0.01);
    options.printer.flavor = Flavor::Klipper;
    let text = String::from_utf8(layer_gcode(&layer(1, &[circle]), &options).text).expect("ASCII");
    assert!(!text.lines().any(|l| l.starts_with("G2 ") || l.starts_with("G3 ")), "{text}");
    let wide = Settings::resolve([], ["gcode.arc_tolerance=0.05"]).expect_err("too coarse").to_string();
    assert_eq!(wide, "gcode.arc_tolerance: 0.05 is outside 0.001 to 0.02 mm");
}

/// Closed curves of changing radius: partly round, partly not.
fn some_outline() -> impl Strategy<Value = Vec<DVec2>> {
    let waves = prop::collection::vec((1..9_u32, 0.0..0.2_f64), 0..3);
    (8..300_usize, 0.5..40.0_f64, waves, 0.0..0.02_f64).prop_map(|(n, radius, waves, noise)| {
        let point = |k: usize| {
            let angle = k as f64 / n as f64 * std::f64::consts::TAU;
            let wave = |&(m, share): &(u32, f64)| share * trig::sin_cos(angle * f64::from(m)).0;
            let swing =
                waves.iter().map(wave).sum::<f64>() + noise * trig::sin_cos(k as f64 * 1e3).0 / radius;
            let (sin, cos) = trig::sin_cos(angle);
            dvec2(100.0 + radius * (1.0 + swing) * cos, 100.0 + radius * (1.0 + swing) * sin)
        };
        (0..n).map(point).collect()
    })
}

/// Points on an arc and its length, from its own definition.
fn trace(from: Place, curve: Curve) -> (Vec<DVec2>, f64) {
    let centre = from.mm() + curve.offset.mm();
    let (a, b) = (from.mm() - centre, curve.to.mm() - centre);
    let mut angle = a.angle_to(b);
    if curve.clockwise && angle > 0.0 {
        angle -= std::f64::consts::TAU;
    } else if !curve.clockwise && angle < 0.0 {
        angle += std::f64::consts::TAU;
    }
    let points = (0..=64).map(|k| centre + DVec2::from_angle(angle * f64::from(k) / 64.0).rotate(a));
    (points.collect(), angle.abs() * a.length())
}

fn distance_to_line(p: DVec2, line: &[DVec2]) -> f64 {
    let to_edge = |w: &[DVec2]| {
        let t = ((p - w[0]).dot(w[1] - w[0]) / (w[1] - w[0]).length_squared()).clamp(0.0, 1.0);
        p.distance(w[0].lerp(w[1], if t.is_nan() { 0.0 } else { t }))
    };
    line.windows(2).map(to_edge).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Arcs keep within the tolerance of the line that they replace and it within that of them; plastic and, within
    /// the tolerance, length stay.
    #[test]
    fn arcs_hug_the_line(points in some_outline(), tolerance in 0.001..0.02_f64) {
        let paths = [Path::closed(Role::InnerWall, points, 0.45)];
        let plan = plan_layer(&layer(1, &paths), &with_arcs(tolerance));
        let mut straight = with_arcs(tolerance);
        straight.output.arc_fitting = false;
        let plain = plan_layer(&layer(1, &paths), &straight);
        let line: Vec<DVec2> = std::iter::once(plain.start).chain(plain.moves.iter().filter_map(|m| match m {
            Move::Extrude { to, .. } => Some(*to),
            _ => None,
        })).map(Place::mm).collect();
        let mut at = plan.start;
        let mut curve_points: Vec<DVec2> = vec![at.mm()];
        let (mut length, mut filament) = (0.0, 0);
        for step in &plan.moves {
            match *step {
                Move::Arc { curve, filament: pushed, .. } => {
                    let (points, along) = trace(at, curve);
                    for &p in &points {
                        prop_assert!(distance_to_line(p, &line) <= tolerance + 0.0025, "{} is off", p);
                    }
                    curve_points.extend(points);
                    (length, filament, at) = (length + along, filament + pushed, curve.to);
                }
                Move::Extrude { to, filament: pushed, .. } => {
                    curve_points.push(to.mm());
                    (length, filament, at) = (length + at.distance(to), filament + pushed, to);
                }
                _ => {}
            }
        }
        for &p in &line {
            // The trace has chords of its own: a 64th of half a circle of 40 mm is off by 0.012 mm.
            prop_assert!(distance_to_line(p, &curve_points) <= tolerance + 0.0135);
        }
        let line_length: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
        prop_assert!((length - line_length).abs() <= 0.01 * line_length, "{} {}", length, line_length);
        let plain_filament: i32 = plain.moves.iter().map(|m| match *m { Move::Extrude { filament, .. } => filament, _ => 0 }).sum();
        prop_assert_eq!(filament, plain_filament);
        prop_assert_eq!(at, plan.start);
        // The file says the same moves.
        let made = layer_gcode(&layer(1, &paths), &with_arcs(tolerance));
        let text = [b"M83\n", &made.text[..]].concat();
        let start = plan.start.mm();
        let moves: Vec<ReadMove> = Reader::from_place(&text, [start.x, start.y, 0.4]).collect();
        let read_length: f64 = moves.iter().map(ReadMove::length).sum();
        // The reader draws small arcs with chords 0.005 mm off: 0.4 % shorter at a radius of 0.4 mm.
        prop_assert!((read_length - length).abs() <= 0.006 * length);
        prop_assert!((moves.iter().map(|m| m.filament_mm).sum::<f64>() - f64::from(filament) / 1e5).abs() < 1e-9);
    }
}

fn event(layer: u32, kind: EventKind, gcode: &str) -> LayerEvent {
    LayerEvent { layer: Some(layer), z: None, kind, gcode: gcode.to_owned() }
}

/// A file of three layers of one square each, with events.
fn file_with(events: Vec<LayerEvent>, flavor: Flavor) -> String {
    let mut options = GcodeOptions::default();
    (options.output.events, options.printer.flavor) = (events, flavor);
    let square =
        Path::closed(Role::OuterWall, vec![dvec2(50.0, 50.0), dvec2(60.0, 50.0), dvec2(60.0, 60.0)], 0.45);
    let layers = [0, 1, 2].map(|k| layer_gcode(&layer(k, std::slice::from_ref(&square)), &options));
    let summaries = layers.clone().map(|l| l.summary);
    let joined = join(&summaries, &options, &FileNotes::default()).expect("good templates");
    String::from_utf8(assemble(&joined, &layers.map(|l| l.text))).expect("ASCII")
}

#[test]
fn a_pause_leaves_the_part_and_comes_back() {
    // Layer 1 ends at (50, 50); 5 mm up from 0.2 is 5.2.
    let pause = |flavor| file_with(vec![event(1, EventKind::Pause, "")], flavor);
    let marlin = pause(Flavor::Marlin);
    let stop = "G1 E-0.8 F2100\nG1 Z5.2 F600\nG1 X0 Y220 F9000\n;PAUSE_PRINT\nM0 ; go on by the button\n\
                G1 X50 Y50 F9000\nG1 Z0.4 F600\nG1 E0.8 F2100\n";
    assert!(marlin.contains(stop), "{marlin}");
    let klipper = pause(Flavor::Klipper);
    // Its macro parks the head itself.
    assert!(
        klipper.contains("G1 Z5.2 F600\n;PAUSE_PRINT\nPAUSE\nG1 Z0.4 F600\nG1 E0.8 F2100\n"),
        "{klipper}"
    );
    assert!(pause(Flavor::Reprap).contains("\nM226\n") && pause(Flavor::Prusa).contains("\nM601\n"));
    for text in [marlin, klipper] {
        let second = text.match_indices(";LAYER_CHANGE").nth(1).expect("three layers").0;
        let third = text.match_indices(";LAYER_CHANGE").nth(2).expect("three layers").0;
        assert!((second..third).contains(&text.find(";PAUSE_PRINT").expect("a pause")));
    }
}

#[test]
fn filament_changes_and_custom_lines_come_where_they_are_asked_for() {
    let by_height =
        LayerEvent { z: Some(0.4), layer: None, kind: EventKind::FilamentChange, gcode: String::new() };
    let custom = event(2, EventKind::Custom, "M117 of {layer_count}\nM106 S9\nG1 X1 Y2 Z9 F600");
    let text = file_with(vec![by_height, custom], Flavor::Marlin);
    let third = text.match_indices(";LAYER_CHANGE").nth(2).expect("three layers").0;
    let change = "G1 E-0.8 F2100\nG1 Z5.4 F600\n;COLOR_CHANGE\nM600\n;CUSTOM_GCODE\nM117 of 3\nM106 S9\nG1 X1 Y2 Z9 F600\n";
    let at = text.find(change).unwrap_or_else(|| panic!("{text}"));
    assert!(at > third);
    // From where the lines have left the head, and with the fan that the layer needs.
    assert!(
        text[at..].contains("G1 X50 Y50 F9000\nG1 Z0.6 F600\nG1 E0.8 F2100\nM106 S255\n"),
        "{}",
        &text[at..]
    );
}

#[test]
fn events_above_the_print_are_told() {
    let events = r#"gcode.events=[{"z":5,"kind":"pause"},{"layer":3,"kind":"filament_change"},{"z":10,"kind":"pause"}]"#;
    let (text, report) = run(&common::cube(10.0), &[events]);
    assert_eq!((text.matches("\nM0 ").count(), text.matches("\nM600\n").count()), (1, 1));
    let found: Vec<_> = report.warnings.iter().filter(|w| w.code == "event_above_print").collect();
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].message,
        "gcode.events[2] lies above the print, which has 50 layers and is 10.00 mm high"
    );
    assert_eq!(refusal(&[r#"gcode.events=[{"kind":"pause"}]"#]), "gcode.events[0]: needs either layer or z");
}

#[test]
fn a_turn_of_a_spiral_rises_evenly_and_the_first_one_grows() {
    let points =
        vec![dvec2(10.0, 10.0), dvec2(20.0, 10.0), dvec2(20.0, 20.0), dvec2(10.0, 20.0), dvec2(10.0, 10.0)];
    let wall = [Path::open(Role::OuterWall, points, 0.45)];
    let turn = |spiral| {
        let input = LayerInput { spiral: Some(spiral), ..layer(4, &wall) };
        let mut options = GcodeOptions::default();
        options.cooling.min_layer_time = 0.0;
        let made = layer_gcode(&input, &options);
        (String::from_utf8(made.text).expect("ASCII"), made.summary)
    };
    // 10 mm of 0.0814159 mm2 are 0.338488 mm of filament; from 0.8 to 1 mm in quarters.
    let (text, summary) = turn(Spiral::Next);
    let expected =
        "G1 X20 Y10 Z0.85 E0.33849 F1800\nG1 Y20 Z0.9 E0.33849\nG1 X10 Z0.95 E0.33848\nG1 Y10 Z1 E0.33849\n";
    assert!(text.ends_with(expected), "{text}");
    assert!((summary.start_z - 0.8).abs() < 1e-9 && (summary.print_z - 1.0).abs() < 1e-9);
    // Shares of an eighth, three, five and seven eighths.
    let (text, _) = turn(Spiral::First);
    let expected =
        "G1 X20 Y10 Z0.85 E0.04231 F1800\nG1 Y20 Z0.9 E0.12693\nG1 X10 Z0.95 E0.21156\nG1 Y10 Z1 E0.29618\n";
    assert!(text.ends_with(expected), "{text}");
}

#[test]
fn a_vase_is_one_bead_without_travels() {
    let (text, report) = run(&cylinder(15.0, 10.0, 90), &["layers.spiral_vase=true", "adhesion.kind=none"]);
    let from = text.match_indices(";LAYER_CHANGE").nth(4).expect("layers above the bottom").0;
    let head = [b"M83\n".as_slice(), &text.as_bytes()[..from]].concat();
    let mut reader = Reader::new(&head);
    while reader.next().is_some() {}
    let spiral = [b"M83\n".as_slice(), &text.as_bytes()[from..]].concat();
    let moves: Vec<ReadMove> = Reader::from_place(&spiral, reader.place()).collect();
    let first = moves.iter().position(ReadMove::lays_bead).expect("beads");
    let last = moves.iter().rposition(ReadMove::lays_bead).expect("beads");
    let mut z = 0.8;
    for step in &moves[first..=last] {
        assert!(
            step.lays_bead() && step.to[2] >= step.from[2] && step.role == Some(Role::OuterWall),
            "{step:?}"
        );
        z = step.to[2];
    }
    assert!((z - 10.0).abs() < 1e-9, "{z}");
    // 45 full turns and a half of the first: 2 pi (15 - 0.225) mm of 0.0814159 mm2 each.
    let volume: f64 = moves[first..=last].iter().map(|m| m.filament_mm * filament_area(1.75)).sum();
    let expected = 45.5 * 2.0 * std::f64::consts::PI * 14.775 * 0.081_415_93;
    assert!((volume - expected).abs() < 0.005 * expected, "{volume} {expected}");
    assert!(!report.by_role.contains_key(&Role::TopSkin) && !report.by_role.contains_key(&Role::Infill));
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
}

#[test]
fn what_is_no_vase_is_printed_flat_with_a_warning_or_refused() {
    let (text, report) = run(&tube(15.0, 8.0, 5.0, 60), &["layers.spiral_vase=true", "adhesion.kind=none"]);
    let found: Vec<_> = report.warnings.iter().filter(|w| w.code == "vase_printed_flat").collect();
    assert_eq!((found.len(), found[0].layer), (1, Some(4)));
    assert_eq!(read(text.as_bytes(), 1.75).layers[10].strands.len(), 2);
    assert_eq!(
        refusal(&["layers.spiral_vase=true", "support.method=plates"]),
        "layers.spiral_vase: a vase cannot be printed with supports (support.method)"
    );
    assert_eq!(
        refusal(&["layers.spiral_vase=true", "adhesion.kind=raft"]),
        "layers.spiral_vase: a vase cannot be printed with adhesion.kind=raft"
    );
}

#[test]
fn only_what_is_open_to_the_sky_is_ironed() {
    // A block of 20 mm with one of 10 mm on it: 400 - 100 mm2 at layer 9, 100 mm2 at layer 19, less the walls.
    let steps = together(&[
        cuboid(Vec3::ZERO, Vec3::new(20.0, 20.0, 2.0)),
        moved(&cuboid(Vec3::ZERO, Vec3::new(10.0, 10.0, 2.0)), Vec3::new(5.0, 5.0, 2.0)),
    ]);
    let (text, report) = run(&steps, &["ironing.enabled=true", "adhesion.kind=none"]);
    let file = read(text.as_bytes(), 1.75);
    let irons =
        |l: &foothold::gcode::read::ReadLayer| l.strands.iter().any(|s| s.role == Some(Role::Ironing));
    let layers: Vec<usize> = (0..file.layers.len()).filter(|&k| irons(&file.layers[k])).collect();
    assert_eq!(layers, [9, 19]);
    // It comes last, at 15 mm/s, in lines of 0.15 x 0.2 = 0.03 mm height.
    for &k in &layers {
        let roles: Vec<_> = file.layers[k].strands.iter().map(|s| s.role).collect();
        let first = roles.iter().position(|&r| r == Some(Role::Ironing)).expect("ironed");
        assert!(roles[first..].iter().all(|&r| r == Some(Role::Ironing)), "{roles:?}");
    }
    assert_eq!(text.matches(";HEIGHT:0.03\n").count(), 2);
    let ironed = &report.by_role[&Role::Ironing];
    let bead = Bead { width: 0.1 + 0.03 * (1.0 - std::f64::consts::FRAC_PI_4), height: 0.03 }.area();
    assert!((ironed.volume_mm3 / ironed.length_mm - bead).abs() < 0.01 * bead);
    // 17.2 mm x 17.2 mm less 10 x 10 and 7.2 x 7.2 mm are inside the walls: 196 and 52 mm2; 10 lines a mm.
    assert!((ironed.length_mm - 2480.0).abs() < 0.1 * 2480.0, "{}", ironed.length_mm);
    let slow = |m: &ReadMove| m.lays_bead() && m.role == Some(Role::Ironing);
    assert!(Reader::new(text.as_bytes()).filter(slow).all(|m| m.speed <= 15.0 + 1e-9));
}

#[test]
fn adaptive_heights_run_through_the_whole_job() {
    let ball = sphere(Vec3::new(0.0, 0.0, 10.0), 10.0, 48, 72);
    let sets = ["layers.adaptive=true", "adhesion.kind=brim", "support.method=plates"];
    let (text, report) = run(&ball, &sets);
    let file = read(text.as_bytes(), 1.75);
    let heights: Vec<f64> = file.layers.iter().map(|l| l.height).collect();
    // Thick around the equator, thin near the top.
    assert!(heights.contains(&0.28) && heights.last().is_some_and(|&h| h <= 0.09), "{heights:?}");
    let mut z = 0.0;
    for layer in file.layers.iter().filter(|l| !l.strands.is_empty()) {
        assert!((layer.z - z - layer.height).abs() < 2e-3, "{} after {z}", layer.z);
        z = layer.z;
    }
    assert!((z - 20.0).abs() < 0.15);
    // Beads are as high as their layer says.
    for layer in &file.layers {
        for strand in &layer.strands {
            for (i, s) in strand.segments.iter().enumerate() {
                let length = strand.points[i].distance(strand.points[i + 1]);
                let stated = Bead { width: s.width, height: layer.height }.area() * length;
                assert!(
                    (s.volume_mm3 - stated).abs() <= 0.01 * stated + 5e-5,
                    "{s:?} in {layer:?}",
                    layer = layer.z
                );
            }
        }
    }
    assert!(report.support.is_some());
    let found = refusal(&["layers.adaptive=true", "layers.min_height=0.3"]);
    assert_eq!(found, "layers.min_height: 0.3 mm is more than layers.max_height, 0.28 mm");
}
