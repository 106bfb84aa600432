//! Short layers: how far they are slowed, how the fan answers; accelerations by role; wiping.

mod common;

use common::layers::layer;
use foothold::gcode::read::{ReadMove, Reader, read};
use foothold::gcode::{FileNotes, Flavor, GcodeOptions, LayerGcode, Place, assemble, join, layer_gcode};
use foothold::polygon::{DVec2, dvec2};
use foothold::region::{Path, Role};
use proptest::prelude::*;

fn square(role: Role, side: f64) -> Path {
    let points = vec![dvec2(0.0, 0.0), dvec2(side, 0.0), dvec2(side, side), dvec2(0.0, side)];
    Path::closed(role, points, 0.45)
}

fn text_of(made: &LayerGcode) -> String {
    String::from_utf8(made.text.clone()).expect("ASCII")
}

/// Feed rates of the beads by role.
fn feeds(text: &str) -> Vec<(Option<Role>, u32)> {
    let text = format!("M83\n{text}");
    let moves = Reader::new(text.as_bytes()).filter(ReadMove::lays_bead);
    let mut found: Vec<_> = moves.map(|m| (m.role, (m.speed * 60.0).round() as u32)).collect();
    found.dedup();
    found
}

fn with_min_time(seconds: f64) -> GcodeOptions {
    let mut options = GcodeOptions::default();
    options.cooling.min_layer_time = seconds;
    options
}

#[test]
fn a_short_layer_is_slowed_until_it_lasts() {
    // 80 mm from rest to rest at v with three corners at 6.861276 mm/s and 1500 mm/s2 take
    // 80 / v + v / 1500 + 3 (v - 6.861276)^2 / (1500 v) s: at 20.15 mm/s (F1209) 4.0012 s, at F1210 3.9979 s.
    let paths = [square(Role::OuterWall, 20.0)];
    let made = layer_gcode(&layer(1, &paths), &with_min_time(4.0));
    assert_eq!(feeds(&text_of(&made)), [(Some(Role::OuterWall), 1209)]);
    assert!((made.summary.time_s - 4.0012).abs() < 1e-4, "{}", made.summary.time_s);
    // A layer that lasts long enough stays as it is: 2.72236 s at 30 mm/s.
    assert_eq!(
        feeds(&text_of(&layer_gcode(&layer(1, &paths), &with_min_time(2.722)))),
        [(Some(Role::OuterWall), 1800)]
    );
}

#[test]
fn nothing_is_slowed_below_the_lowest_speed_nor_made_faster() {
    let mut options = with_min_time(100.0);
    options.speed.inner_wall = 5.0;
    let paths = [square(Role::OuterWall, 10.0), square(Role::InnerWall, 10.0), square(Role::Bridge, 10.0)];
    let made = layer_gcode(&layer(1, &paths), &options);
    // 10 mm/s is the lowest; the inner wall was slower already; bridges keep their 25 mm/s.
    let expected = [(Role::OuterWall, 600), (Role::InnerWall, 300), (Role::Bridge, 1500)];
    assert_eq!(feeds(&text_of(&made)), expected.map(|(role, feed)| (Some(role), feed)));
}

#[test]
fn the_fastest_beads_are_slowed_first() {
    // 30 mm/s walls are not touched while 60 mm/s infill can give the time.
    let paths = [square(Role::OuterWall, 40.0), square(Role::Infill, 40.0)];
    let plain = layer_gcode(&layer(1, &paths), &with_min_time(0.0)).summary.time_s;
    let found = feeds(&text_of(&layer_gcode(&layer(1, &paths), &with_min_time(plain + 1.0))));
    assert_eq!(found[0], (Some(Role::OuterWall), 1800));
    assert!(found[1].1 < 3600 && found[1].1 > 1800, "{found:?}");
}

#[test]
fn the_fan_answers_to_the_time_before_slowing_down() {
    // 2.72 s is less than 8 s: the most fan, and 10 mm/s. Squares of 400 mm take 53 s at 30 mm/s.
    let mut options = GcodeOptions::default();
    (options.filament.fan_speed, options.filament.max_fan_speed) = (0.4, 1.0);
    let fan = |side: f64| layer_gcode(&layer(1, &[square(Role::OuterWall, side)]), &options).summary.fan;
    assert_eq!(fan(20.0), [255, 255]);
    assert_eq!(fan(1000.0), [102, 102]);
    let middling = fan(400.0)[0];
    assert!(middling > 102 && middling < 130, "{middling}");
}

#[test]
fn roles_accelerate_as_they_are_told_and_the_layer_leaves_the_printers_own() {
    let mut options = with_min_time(0.0);
    (options.acceleration.outer_wall, options.acceleration.infill) = (800.0, 2500.0);
    let paths = [square(Role::OuterWall, 10.0), square(Role::InnerWall, 10.0), square(Role::Infill, 10.0)];
    let lines = |index: u32, options: &GcodeOptions| {
        let text = text_of(&layer_gcode(&layer(index, &paths), options));
        let wanted = |l: &&str| l.starts_with("M204") || l.starts_with("SET_V") || l.starts_with(";TYPE");
        text.lines().filter(wanted).map(str::to_owned).collect::<Vec<_>>()
    };
    let expected =
        [";TYPE:External perimeter", "M204 P800", ";TYPE:Perimeter", "M204 P1500", ";TYPE:Internal infill"];
    assert_eq!(lines(1, &options), [&expected[..], &["M204 P2500", "M204 P1500"]].concat());
    // One value for all moves: never more than travels may have.
    options.printer.flavor = Flavor::Klipper;
    let expected = [
        ";TYPE:External perimeter",
        "SET_VELOCITY_LIMIT ACCEL=800",
        ";TYPE:Perimeter",
        "SET_VELOCITY_LIMIT ACCEL=1500",
        ";TYPE:Internal infill",
    ];
    assert_eq!(lines(1, &options), expected);
    options.printer.flavor = Flavor::Marlin;
    options.acceleration.first_layer = 500.0;
    let first = lines(0, &options);
    assert_eq!((first[1].as_str(), first.last().map(String::as_str)), ("M204 P500", Some("M204 P1500")));
    assert_eq!(first.iter().filter(|l| l.starts_with("M204")).count(), 2);
}

#[test]
fn the_nozzle_is_wiped_over_the_bead_while_it_retracts() {
    let mut options = with_min_time(0.0);
    (options.retraction.wipe, options.retraction.length) = (true, 1.0);
    let paths = [
        square(Role::OuterWall, 10.0),
        Path::open(Role::Infill, vec![dvec2(50.0, 0.0), dvec2(50.0, 9.0)], 0.45),
    ];
    let text = text_of(&layer_gcode(&layer(1, &paths), &options));
    // 2 mm at 0.8 x 150 = 120 mm/s take 1/60 s, in which 35 mm/s pull 0.58333 mm; the other 0.41667 mm at rest
    // before. The wipe goes on along the loop, from (0, 0) towards (10, 0).
    let expected = "G1 E-0.41667 F2100\nG1 X2 Y0 E-0.58333 F7200\nG1 X50 F9000\nG1 E1 F2100\n";
    let expected_with_y = expected.replace("X2 Y0", "X2");
    assert!(text.contains(expected) || text.contains(&expected_with_y), "{text}");
    // Round a corner the pulling is shared out by length.
    options.retraction.wipe_distance = 12.0;
    let text = text_of(&layer_gcode(&layer(1, &paths), &options));
    assert!(text.contains("G1 X10 E-0.83333 F7200\nG1 Y2 E-0.16667\nG1 X50 Y0 F9000\n"), "{text}");
}

#[test]
fn the_way_to_the_next_layer_wipes_as_well() {
    let mut options = with_min_time(0.0);
    options.retraction.wipe = true;
    let line = Path::open(Role::Infill, vec![dvec2(20.0, 20.0), dvec2(20.0, 60.0)], 0.45);
    let layers = [0, 1].map(|k| layer_gcode(&layer(k, std::slice::from_ref(&line)), &options));
    assert_eq!(layers[0].summary.wipe, [dvec2(20.0, 60.0), dvec2(20.0, 58.0)]);
    let joined =
        join(&layers.clone().map(|l| l.summary), &options, &FileNotes::default()).expect("good templates");
    let file = assemble(&joined, &layers.map(|l| l.text));
    let text = String::from_utf8(file.clone()).expect("ASCII");
    // All of the 0.8 mm but 0.58333 are pulled before; then back along the line, up and away.
    let way = "G1 E-0.21667 F2100\nG1 X20 Y58 E-0.58333 F7200\nG1 Z0.4 F600\nG1 Y20 F9000\nG1 E0.8 F2100\n";
    assert!(text.contains(way), "{text}");
    let found = read(&file, 1.75);
    assert_eq!(found.layers.iter().map(|l| l.retractions).sum::<u32>(), joined.totals.retractions);
}

fn some_paths() -> impl Strategy<Value = Vec<Path>> {
    let point = (0.0..60.0_f64, 0.0..60.0_f64).prop_map(|(x, y)| dvec2(x, y));
    let path = (prop::collection::vec(point, 2..8), any::<bool>(), 0..Role::ALL.len());
    let path =
        path.prop_map(|(points, closed, role)| Path { closed, ..Path::open(Role::ALL[role], points, 0.45) });
    prop::collection::vec(path, 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever is asked for, beads, their order and their plastic stay the same; only feed rates change, none
    /// of them upwards, and the layer lasts as long as was asked unless everything is at the lowest speed.
    #[test]
    fn slowing_down_changes_nothing_but_speed(paths in some_paths(), seconds in 0.0..200.0, least in 1.0..40.0) {
        let mut options = with_min_time(seconds);
        options.cooling.min_speed = least;
        let slow = layer_gcode(&layer(1, &paths), &options);
        let fast = layer_gcode(&layer(1, &paths), &with_min_time(0.0));
        let moves = |made: &LayerGcode| Reader::new(&[b"M83\n", &made.text[..]].concat()).collect::<Vec<_>>();
        let (slow_moves, fast_moves) = (moves(&slow), moves(&fast));
        prop_assert_eq!(slow_moves.len(), fast_moves.len());
        for (s, f) in slow_moves.iter().zip(&fast_moves) {
            prop_assert_eq!((s.to, s.filament_mm, s.role), (f.to, f.filament_mm, f.role));
            prop_assert!(s.speed <= f.speed && s.speed >= f.speed.min(least) - 1.0 / 60.0);
        }
        let slowed = |m: &&ReadMove| m.lays_bead() && m.role != Some(Role::Bridge);
        let all_at_least = slow_moves.iter().filter(slowed).all(|m| m.speed <= least);
        prop_assert!(slow.summary.time_s >= seconds || all_at_least);
    }

    /// Wiping stays on the path printed last and pulls back as much as is pushed again.
    #[test]
    fn wipes_run_over_printed_beads(paths in some_paths(), distance in 0.0..30.0) {
        let mut options = with_min_time(0.0);
        (options.retraction.wipe, options.retraction.wipe_distance) = (true, distance);
        let made = layer_gcode(&layer(1, &paths), &options);
        let Some(stops) = made.summary.stops else { return Ok(()) };
        let text = [b"M83\n", &made.text[..]].concat();
        let mut printed: Vec<[DVec2; 2]> = Vec::new();
        let mut balance = 0.0;
        for step in Reader::from_place(&text, [stops.start.x, stops.start.y, 0.4]) {
            let [from, to] = [step.from, step.to].map(|p| dvec2(p[0], p[1]));
            if step.lays_bead() {
                printed.push([from, to]);
                continue;
            }
            balance += step.filament_mm;
            if step.filament_mm < 0.0 && step.moves_in_plane() {
                let near = |&[a, b]: &[DVec2; 2]| {
                    let t = ((to - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    to.distance(a.lerp(b, t)) < 0.001
                };
                prop_assert!(printed.iter().rev().take(9).any(near), "{} {}", from, to);
            }
        }
        prop_assert!(balance.abs() < 1e-9);
        prop_assert!(Place::of(stops.end) == Place::of(made.summary.wipe.first().copied().unwrap_or(stops.end)));
    }
}
