//! One layer as text: what it says is what was asked for, and reads back as it was planned.

mod common;

use common::layers::layer;
use foothold::gcode::read::{ReadMove, Reader};
use foothold::gcode::{
    GcodeOptions, Move, Place, RetractionOptions, filament_area, layer_gcode, plan_layer, type_name,
};
use foothold::polygon::{DVec2, dvec2};
use foothold::region::{Bead, Path, Role, Width};
use proptest::prelude::*;

/// A step of the text's E in mm3 of usual filament: the least that rounding can hide.
const STEP_MM3: f64 = 2.5e-5;

/// Cross-section of a bead of this width in a layer of 0.2 mm.
fn bead_area(width: f64) -> f64 {
    Bead { width, height: 0.2 }.area()
}

/// Without slowing down short layers, or blowing more at them.
fn unhurried() -> GcodeOptions {
    let mut options = GcodeOptions::default();
    (options.cooling.min_layer_time, options.cooling.fan_below_layer_time) = (0.0, 0.0);
    options
}

fn square(role: Role, side: f64) -> Path {
    let points = vec![dvec2(0.0, 0.0), dvec2(side, 0.0), dvec2(side, side), dvec2(0.0, side)];
    Path::closed(role, points, 0.45)
}

/// The moves of a layer's text, read in the state that the text counts on.
fn read_layer(text: &[u8], start: DVec2, z: f64) -> Vec<ReadMove> {
    let whole = [b"G21\nG90\nM83\n", text].concat();
    let mut reader = Reader::from_place(&whole, [start.x, start.y, z]);
    let moves: Vec<ReadMove> = (&mut reader).collect();
    assert_eq!(reader.malformed, 0, "{:?}", reader.warnings);
    moves
}

#[test]
fn a_square_in_full() {
    // 20 mm of 0.45 x 0.2: 0.0814159 * 20 / 2.4052819 = 0.6769762 mm of filament. Rounded, with the
    // remainder carried on: 0.67698, 0.67697, 0.67698, 0.67697; together 2.70790.
    // Time at 30 mm/s, 1500 mm/s2 and a deviation of 0.013 mm: corners at sqrt(1500 * 0.013 * 2.414214)
    // = 6.861276 mm/s. Outer sides: 0.02 s + 0.0154258 s of ramps over 0.3 + 0.2843076 mm, 19.4156924 mm
    // in 0.6471897 s: 0.6826156. Inner sides: 0.0308516 s over 0.5686153 mm, 19.4313847 mm in
    // 0.6477128 s: 0.6785644. Together 2.72236 s.
    let paths = [square(Role::OuterWall, 20.0)];
    let made = layer_gcode(&layer(1, &paths), &unhurried());
    let expected = ";TYPE:External perimeter\n;WIDTH:0.45\nG1 X20 Y0 E0.67698 F1800\nG1 Y20 E0.67697\n\
                    G1 X0 E0.67698\nG1 Y0 E0.67697\n";
    assert_eq!(String::from_utf8_lossy(&made.text), expected);
    let summary = made.summary;
    assert!((summary.time_s - 2.722_36).abs() < 1e-5, "{}", summary.time_s);
    assert!((summary.filament_mm - 2.7079).abs() < 1e-9);
    assert!((summary.by_role[&Role::OuterWall].length_mm - 80.0).abs() < 1e-9);
    assert!((summary.by_role[&Role::OuterWall].volume_mm3 - 6.513_274).abs() < STEP_MM3);
    assert_eq!(summary.stops.map(|s| (s.start, s.end)), Some((DVec2::ZERO, DVec2::ZERO)));
    assert_eq!((summary.retractions, summary.travel_mm), (0, 0.0));
}

#[test]
fn the_first_layer_has_its_own_speed_and_no_fan() {
    let paths = [square(Role::Infill, 20.0)];
    let feed = |index| {
        let text = layer_gcode(&layer(index, &paths), &unhurried()).text;
        String::from_utf8_lossy(&text)
            .split(" F")
            .nth(1)
            .map(|f| f.trim_end_matches(|c: char| !c.is_ascii_digit()).to_owned())
    };
    assert!(feed(0).is_some_and(|f| f.starts_with("1500\n") || f == "1500"));
    assert!(feed(1).is_some_and(|f| f.starts_with("3600")));
    assert_eq!(layer_gcode(&layer(0, &paths), &GcodeOptions::default()).summary.fan, [0, 0]);
    assert_eq!(layer_gcode(&layer(1, &paths), &GcodeOptions::default()).summary.fan, [255, 255]);
}

#[test]
fn long_travels_retract_and_short_ones_do_not() {
    let line = |x: f64| Path::open(Role::Infill, vec![dvec2(x, 0.0), dvec2(x, 10.0)], 0.45);
    let paths = [line(0.0), line(0.2)];
    let near = layer_gcode(
        &layer(1, &[line(0.0), Path::open(Role::Infill, vec![dvec2(1.0, 10.0), dvec2(1.0, 0.0)], 0.45)]),
        &GcodeOptions::default(),
    );
    assert_eq!(near.summary.retractions, 0);
    assert!((near.summary.travel_mm - 1.0).abs() < 1e-9);
    // From (0, 10) back to (0.2, 0): 10.002 mm.
    let mut options = GcodeOptions::default();
    options.retraction = RetractionOptions { z_hop: 0.3, ..options.retraction };
    let far = layer_gcode(&layer(1, &paths), &options);
    assert_eq!(far.summary.retractions, 1);
    let text = String::from_utf8_lossy(&far.text).into_owned();
    let hop = "G1 E-0.8 F2100\nG1 Z0.7 F600\nG1 X0.2 Y0 F9000\nG1 Z0.4 F600\nG1 E0.8 F2100\n";
    assert!(text.contains(hop), "{text}");
}

#[test]
fn a_bridge_has_its_own_fan() {
    let mut options = unhurried();
    options.filament.fan_speed = 0.5;
    let paths = [square(Role::OuterWall, 10.0), square(Role::Bridge, 10.0), square(Role::Infill, 10.0)];
    let made = layer_gcode(&layer(1, &paths), &options);
    assert_eq!(made.summary.fan, [128, 128]);
    let text = String::from_utf8_lossy(&made.text).into_owned();
    let at = |what: &str| text.find(what).unwrap_or_else(|| panic!("{what} is missing in {text}"));
    assert!(at("External") < at("M106 S255") && at("M106 S255") < at("M106 S128"));
    assert!(at("Bridge") < at("M106 S255") && at("Internal") < at("M106 S128"));
}

#[test]
fn a_wedge_keeps_its_volume_and_states_widths_that_fit_its_flow() {
    // 0.3 to 0.6 mm wide over 10 mm at 0.2: area changes linearly, so volume is that of 0.45 mm:
    // 0.0814159 * 10 = 0.814159 mm3.
    let path = Path {
        role: Role::GapFill,
        points: vec![dvec2(0.0, 0.0), dvec2(10.0, 0.0)],
        closed: false,
        width: Width::Varying(vec![0.3, 0.6]),
        hang: 0.0,
    };
    let made = layer_gcode(&layer(1, std::slice::from_ref(&path)), &GcodeOptions::default());
    assert!((made.summary.by_role[&Role::GapFill].volume_mm3 - 0.814_159).abs() < 1e-4);
    let moves = read_layer(&made.text, DVec2::ZERO, 0.4);
    assert_eq!(moves.len(), 15);
    for step in moves {
        let flow = step.filament_mm * filament_area(1.75) / step.length();
        let stated = bead_area(step.width.expect("stated"));
        assert!((flow / stated - 1.0).abs() < 0.01, "{step:?}");
    }
}

#[test]
fn nothing_to_print_gives_no_text() {
    let dots =
        [Path::open(Role::Infill, vec![], 0.4), Path::closed(Role::Infill, vec![dvec2(1.0, 1.0); 3], 0.4)];
    for paths in [&[][..], &dots] {
        let made = layer_gcode(&layer(3, paths), &GcodeOptions::default());
        assert!(made.text.is_empty() && made.summary.stops.is_none() && made.summary.time_s == 0.0);
    }
}

#[test]
fn marks_stand_at_line_starts_some_ten_seconds_apart() {
    let paths: Vec<Path> = (1..60).map(|k| square(Role::InnerWall, f64::from(k))).collect();
    let made = layer_gcode(&layer(1, &paths), &GcodeOptions::default());
    let marks = &made.summary.marks;
    assert!(
        marks.len() as f64 > made.summary.time_s / 15.0 && marks.len() as f64 <= made.summary.time_s / 10.0
    );
    for &(offset, _) in marks {
        assert_eq!(made.text[offset as usize - 1], b'\n');
    }
    assert!(marks.windows(2).all(|w| w[1].1 - w[0].1 >= 10.0 && w[1].0 > w[0].0));
}

#[test]
fn senseless_points_and_widths_do_not_panic() {
    for bad in [f64::NAN, f64::INFINITY, -1e300] {
        let points = vec![dvec2(0.0, bad), dvec2(bad, 3.0), dvec2(1.0, 2.0)];
        for width in [Width::Uniform(bad), Width::Varying(vec![bad, 0.4, bad]), Width::Varying(vec![])] {
            let path = Path { role: Role::Infill, points: points.clone(), closed: true, width, hang: 0.0 };
            let _ = layer_gcode(&layer(2, &[path]), &GcodeOptions::default());
        }
    }
}

fn some_path() -> impl Strategy<Value = Path> {
    let points = prop::collection::vec((0.0..220.0, 0.0..220.0).prop_map(|(x, y)| dvec2(x, y)), 2..8);
    let chain = prop::collection::vec((-1.0..1.0, -1.0..1.0).prop_map(|(x, y)| dvec2(x, y)), 2..20).prop_map(
        |steps: Vec<DVec2>| {
            let mut at = dvec2(100.0, 100.0);
            steps
                .into_iter()
                .map(|s| {
                    at += s;
                    at
                })
                .collect::<Vec<_>>()
        },
    );
    let width = prop_oneof![Just(None), (0.15..1.0).prop_map(Some)];
    (prop_oneof![points, chain], any::<bool>(), 0..Role::ALL.len(), 0.15..1.0, width).prop_map(
        |(points, closed, role, from, to)| {
            let width = match to {
                None => Width::Uniform(from),
                Some(to) => {
                    Width::Varying((0..points.len()).map(|i| if i % 2 == 0 { from } else { to }).collect())
                }
            };
            Path { role: Role::ALL[role], points, closed, width, hang: 0.0 }
        },
    )
}

fn some_paths() -> impl Strategy<Value = Vec<Path>> {
    prop::collection::vec(some_path(), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn the_text_reads_back_as_the_planned_moves(paths in some_paths(), index in 0_u32..3, z_hop in 0.0..1.0) {
        let mut options = GcodeOptions::default();
        options.retraction.z_hop = z_hop;
        let input = layer(index, &paths);
        let plan = plan_layer(&input, &options);
        let text = layer_gcode(&input, &options).text;
        let mut read = read_layer(&text, plan.start.mm(), input.print_z).into_iter();
        let (mut role, mut width) = (None, None);
        for step in &plan.moves {
            let (to, filament, feed) = match *step {
                Move::Role(next) => { role = Some(next); continue }
                Move::Height(_) => continue,
                Move::Width(next) => { width = Some(f64::from(next) / 1000.0); continue }
                Move::Fan(_) | Move::Acceleration(_) | Move::Tool { .. } | Move::Object { .. } => continue,
                Move::Extrude { to, filament, feed } | Move::Wipe { to, filament, feed } => (Some(to), filament, feed),
                Move::Climb { to, filament, feed, .. } => (Some(to), filament, feed),
                Move::Arc { curve, filament, feed } => (Some(curve.to), filament, feed),
                Move::Travel { to, feed } => (Some(to), 0, feed),
                Move::Filament { filament, feed } => (None, filament, feed),
                Move::Lift { feed, .. } => (None, 0, feed),
            };
            let found = read.next().expect("as many moves");
            if let Some(to) = to {
                prop_assert!((found.to[0] - to.mm().x).abs() < 1e-9 && (found.to[1] - to.mm().y).abs() < 1e-9);
            }
            if let Move::Lift { z, .. } = *step {
                prop_assert!((found.to[2] - f64::from(z) / 1000.0).abs() < 1e-9);
            }
            prop_assert!((found.filament_mm - f64::from(filament) / 1e5).abs() < 1e-9);
            prop_assert!((found.speed - f64::from(feed) / 60.0).abs() < 1e-9);
            if filament > 0 && to.is_some() {
                // Roles that share a type name read as one of them.
                prop_assert_eq!(found.role.map(type_name), role.map(type_name));
                prop_assert_eq!(found.width, width);
            }
        }
        prop_assert!(read.next().is_none());
        prop_assert_eq!(read_end(&paths), layer_gcode(&input, &options).summary.stops.map(|s| Place::of(s.end)));
    }

    /// The beads of the text are the edges of the paths, in order.
    #[test]
    fn every_edge_is_printed_once_in_order(paths in some_paths()) {
        let uniform: Vec<Path> =
            paths.into_iter().map(|p| Path { width: Width::Uniform(0.45), ..p }).collect();
        let input = layer(1, &uniform);
        let made = layer_gcode(&input, &GcodeOptions::default());
        let start = made.summary.stops.expect("paths have length").start;
        let beads = read_layer(&made.text, start, 0.4).into_iter().filter(ReadMove::lays_bead);
        let edges = uniform.iter().flat_map(edges);
        let mut beads = beads.map(|b| (dvec2(b.from[0], b.from[1]), dvec2(b.to[0], b.to[1])));
        for (from, to) in edges {
            let (found_from, found_to) = beads.next().expect("as many beads");
            for (p, q) in [(from, found_from), (to, found_to)] {
                prop_assert!((p - q).abs().max_element() <= 0.000_500_001, "{} {}", p, q);
            }
        }
        prop_assert!(beads.next().is_none());
    }

    #[test]
    fn the_sum_of_e_is_the_volume_of_the_beads(paths in some_paths(), index in 0_u32..3) {
        let input = layer(index, &paths);
        // Beads that iron are as high as all others here.
        let options = GcodeOptions { ironing_flow: 1.0, ..GcodeOptions::default() };
        let made = layer_gcode(&input, &options);
        let mut expected = 0.0;
        for path in &paths {
            let n = path.points.len();
            for i in 0..n - usize::from(!path.closed) {
                let j = (i + 1) % n;
                let length = Place::of(path.points[i]).distance(Place::of(path.points[j]));
                // The area averaged over many points of the edge.
                let steps = 2000;
                let mean: f64 = (0..steps).map(|k| {
                    let t = (f64::from(k) + 0.5) / f64::from(steps);
                    bead_area(path.width.at(i) + (path.width.at(j) - path.width.at(i)) * t)
                }).sum::<f64>() / f64::from(steps);
                expected += mean * length;
            }
        }
        let e_sum: f64 = read_layer(&made.text, made.summary.stops.expect("text").start, input.print_z)
            .iter().map(|m| m.filament_mm).sum();
        prop_assert!((e_sum - made.summary.filament_mm).abs() < 1e-8);
        let volume = e_sum * filament_area(1.75);
        // Pieces that bend at w = h are taken at their middle.
        let tolerance = 1e-4 + 2e-3 * expected * f64::from(u8::from(paths.iter().any(bends)));
        prop_assert!((volume - expected).abs() < tolerance, "{} {}", volume, expected);
        let by_role: f64 = made.summary.by_role.values().map(|r| r.volume_mm3).sum();
        prop_assert!((by_role - volume).abs() < 1e-6);
    }

    #[test]
    fn the_nozzle_is_never_asked_to_melt_too_much(paths in some_paths(), most in 0.5..10.0) {
        let mut options = GcodeOptions::default();
        options.filament.max_volumetric_speed = most;
        let input = layer(1, &paths);
        let made = layer_gcode(&input, &options);
        let start = made.summary.stops.expect("text").start;
        for step in read_layer(&made.text, start, 0.4).iter().filter(|m| m.lays_bead()) {
            let least = step.filament_mm * filament_area(1.75) - STEP_MM3;
            prop_assert!(least / step.length() * step.speed <= most * (1.0 + 1e-9), "{:?}", step);
        }
    }

    #[test]
    fn flow_and_stated_width_agree_within_one_percent(paths in some_paths()) {
        let made = layer_gcode(&layer(1, &paths), &GcodeOptions { ironing_flow: 1.0, ..GcodeOptions::default() });
        let start = made.summary.stops.expect("text").start;
        for step in read_layer(&made.text, start, 0.4).iter().filter(|m| m.lays_bead()) {
            let stated = bead_area(step.width.expect("stated")) * step.length();
            let found = step.filament_mm * filament_area(1.75);
            prop_assert!((found - stated).abs() <= 0.01 * stated + STEP_MM3, "{:?}", step);
        }
    }
}

fn bends(path: &Path) -> bool {
    match &path.width {
        Width::Uniform(_) => false,
        Width::Varying(w) => w.iter().any(|&w| w < 0.2) && w.iter().any(|&w| w > 0.2),
    }
}

fn edges(path: &Path) -> Vec<(DVec2, DVec2)> {
    let n = path.points.len();
    let count = n - usize::from(!path.closed);
    let all = (0..count).map(|i| (path.points[i], path.points[(i + 1) % n]));
    all.filter(|&(p, q)| Place::of(p) != Place::of(q)).collect()
}

/// Where the last path with length ends.
fn read_end(paths: &[Path]) -> Option<Place> {
    paths.iter().rev().find_map(|p| edges(p).last().map(|e| Place::of(e.1)))
}
