//! The time estimate against a slow twin that shares no code or method with it: the text is read
//! back, the way is cut into steps of a hundredth of a mm, and the highest speed at each step follows
//! from the limits by one pass back and one forth.

mod common;

use foothold::gcode::read::{ReadMove, Reader};
use foothold::gcode::{
    FileNotes, Flavor, GcodeOptions, LayerInput, PrinterOptions, assemble, join, layer_gcode,
};
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel};
use foothold::polygon::{DVec2, dvec2};
use foothold::region::{Path, Role};
use foothold::settings::Settings;
use proptest::prelude::*;

/// Length of a step, mm.
const STEP: f64 = 0.01;

/// Duration of a file's or layer's moves.
fn simulated(moves: &[ReadMove], printer: &PrinterOptions) -> f64 {
    let mut time = 0.0;
    let mut run: Vec<&ReadMove> = Vec::new();
    for step in moves {
        if step.moves_in_plane() {
            run.push(step);
            continue;
        }
        time += run_time(&std::mem::take(&mut run), printer);
        let rise = (step.to[2] - step.from[2]).abs();
        time += if rise > 0.0 {
            rest_to_rest(rise, step.speed.min(printer.max_speed_z), printer.z_acceleration)
        } else {
            rest_to_rest(
                step.filament_mm.abs(),
                step.speed.min(printer.max_speed_e),
                printer.retract_acceleration,
            )
        };
    }
    time + run_time(&run, printer)
}

fn rest_to_rest(way: f64, speed: f64, acceleration: f64) -> f64 {
    let ramp = speed * speed / (2.0 * acceleration);
    if way < 2.0 * ramp {
        2.0 * (way / acceleration).sqrt()
    } else {
        2.0 * speed / acceleration + (way - 2.0 * ramp) / speed
    }
}

/// Highest speed and acceleration over each step of a run, and the time they give.
fn run_time(run: &[&ReadMove], printer: &PrinterOptions) -> f64 {
    let mut lengths: Vec<f64> = Vec::new();
    let mut accelerations = Vec::new();
    // Speed limits at the ends of steps.
    let mut limits = vec![0.0_f64];
    for (i, step) in run.iter().enumerate() {
        let way = way(step);
        let steps = (way.length() / STEP).ceil().max(1.0) as usize;
        let acceleration = acceleration(step, printer);
        let cruise = cruise(step, printer);
        if i > 0 {
            *limits.last_mut().expect("not empty") = corner(run[i - 1], step, printer);
        }
        lengths.extend(std::iter::repeat_n(way.length() / steps as f64, steps));
        accelerations.extend(std::iter::repeat_n(acceleration, steps));
        limits.extend(std::iter::repeat_n(cruise, steps));
    }
    *limits.last_mut().expect("not empty") = 0.0;
    let n = lengths.len();
    for i in (0..n).rev() {
        limits[i] = limits[i].min((limits[i + 1].powi(2) + 2.0 * accelerations[i] * lengths[i]).sqrt());
    }
    for i in 0..n {
        limits[i + 1] = limits[i + 1].min((limits[i].powi(2) + 2.0 * accelerations[i] * lengths[i]).sqrt());
    }
    (0..n).map(|i| 2.0 * lengths[i] / (limits[i] + limits[i + 1])).sum()
}

fn way(step: &ReadMove) -> DVec2 {
    dvec2(step.to[0] - step.from[0], step.to[1] - step.from[1])
}

/// Marlin takes every move in the plane that turns the extruder for a bead.
fn acceleration(step: &ReadMove, printer: &PrinterOptions) -> f64 {
    match step.filament_mm {
        0.0 => printer.travel_acceleration,
        _ => step.acceleration.unwrap_or(printer.acceleration),
    }
}

fn cruise(step: &ReadMove, printer: &PrinterOptions) -> f64 {
    let way = way(step);
    let by_axis = [way.x, way.y].map(|d| printer.max_speed_xy * way.length() / d.abs());
    let by_filament = printer.max_speed_e * way.length() / step.filament_mm.abs();
    step.speed.min(by_axis[0]).min(by_axis[1]).min(by_filament)
}

/// Speed at a corner, written down from the angle between the edges.
fn corner(last: &ReadMove, next: &ReadMove, printer: &PrinterOptions) -> f64 {
    let both = cruise(last, printer).min(cruise(next, printer));
    let acceleration = acceleration(last, printer).min(acceleration(next, printer));
    let turn = way(last).angle_to(way(next)).abs();
    let sine = ((std::f64::consts::PI - turn) / 2.0).sin();
    let by_deviation = (acceleration * printer.junction_deviation * sine / (1.0 - sine).max(1e-300)).sqrt();
    let is_arc = way(next).length() < 1.0 && turn < std::f64::consts::FRAC_PI_4 && turn > 0.0;
    let by_radius = if is_arc { (acceleration * way(next).length() / turn).sqrt() } else { f64::INFINITY };
    both.min(by_deviation).min(by_radius)
}

fn moves_of(text: &[u8], start: [f64; 3]) -> Vec<ReadMove> {
    Reader::from_place(&[b"M83\n", text].concat(), start).collect()
}

fn loops() -> impl Strategy<Value = Vec<Path>> {
    let polygon = (3..200_usize, 0.5..40.0_f64, 20.0..200.0_f64, 0..Role::ALL.len());
    let one = polygon.prop_map(|(n, radius, center, role)| {
        let point = |k: usize| {
            let (sin, cos) = (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
            dvec2(center + radius * cos, center + radius * sin)
        };
        Path::closed(Role::ALL[role], (0..n).map(point).collect(), 0.45)
    });
    let zigzag = (1..30_u32, 0.3..3.0_f64, 1.0..60.0_f64).prop_map(|(n, step, length)| {
        let point =
            |k: u32| dvec2(f64::from(k / 2) * step, if k % 4 == 1 || k % 4 == 2 { length } else { 0.0 });
        Path::open(Role::Infill, (0..2 * n).map(point).collect(), 0.45)
    });
    prop::collection::vec(prop_oneof![one, zigzag], 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_estimate_agrees_with_the_simulation(paths in loops(), acceleration in 300.0..6000.0, travel in 300.0..6000.0, walls in 300.0..6000.0, wipe in any::<bool>(), arcs in any::<bool>(), min_layer_time in 0.0..60.0) {
        let mut options = GcodeOptions::default();
        options.printer.acceleration = acceleration;
        options.printer.travel_acceleration = travel;
        options.acceleration.outer_wall = walls;
        options.retraction.wipe = wipe;
        options.printer.flavor = Flavor::Prusa;
        options.output.arc_fitting = arcs;
        options.cooling.min_layer_time = min_layer_time;
        // Fast enough that small circles have to be slowed down.
        options.filament.max_volumetric_speed = 100.0;
        (options.speed.outer_wall, options.speed.inner_wall, options.speed.infill) = (120.0, 200.0, 200.0);
        (options.speed.skirt, options.speed.brim, options.speed.support) = (150.0, 150.0, 150.0);
        let input = LayerInput { index: 1, print_z: 0.4, height: 0.2, spiral: None, paths: &paths, ways: &[], own: &[] };
        let made = layer_gcode(&input, &options);
        let start = made.summary.stops.expect("text").start;
        let slow = simulated(&moves_of(&made.text, [start.x, start.y, 0.4]), &options.printer);
        let found = made.summary.time_s;
        // The reader draws arcs with chords, whose corners are no arcs to the simulation where they are long.
        let tolerance = if arcs { 0.02 } else { 0.005 };
        prop_assert!((found - slow).abs() < tolerance * slow, "estimate {} s, simulation {} s", found, slow);
    }
}

#[test]
fn the_file_takes_as_long_as_its_moves() {
    let square = |side: f64| {
        let points = vec![dvec2(90.0, 90.0), dvec2(90.0 + side, 90.0), dvec2(90.0 + side, 90.0 + side)];
        Path::closed(Role::OuterWall, points, 0.45)
    };
    let options = GcodeOptions::default();
    let paths: Vec<[Path; 2]> = (1..=8_u32).map(|k| [square(f64::from(k) * 5.0), square(7.0)]).collect();
    let layers: Vec<_> = (0..8)
        .map(|k| {
            let print_z = 0.2 * f64::from(k + 1);
            let input = LayerInput {
                index: k,
                print_z,
                height: 0.2,
                spiral: None,
                paths: &paths[k as usize],
                ways: &[],
                own: &[],
            };
            layer_gcode(&input, &options)
        })
        .collect();
    let summaries: Vec<_> = layers.iter().map(|l| l.summary.clone()).collect();
    let texts: Vec<_> = layers.iter().map(|l| &l.text).collect();
    let joined = join(&summaries, &options, &FileNotes::default()).expect("default templates are good");
    let moves: Vec<ReadMove> = Reader::new(&assemble(&joined, &texts)).collect();
    let slow = simulated(&moves, &options.printer);
    let found = joined.totals.time_s;
    assert!((found - slow).abs() < 0.005 * slow, "estimate {found} s, simulation {slow} s");
}

/// Slices the models onto one plate and checks the report's time against the simulation of the file.
fn check_whole(name: &str, models: &[Vec<u8>], sets: &[&str]) {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let printer = settings.gcode_options().printer;
    let named = models.iter().map(|m| NamedModel::new(name, load(m).expect("it can be read")));
    let mut job = Job::new(&named.collect::<Vec<_>>(), settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    let moves: Vec<ReadMove> = Reader::new(&assemble(&finished.joined, &range.texts)).collect();
    let (found, slow) = (finished.report.time_s, simulated(&moves, &printer));
    eprintln!("{name} {sets:?}: estimate {found:.1} s, simulation {slow:.1} s, {:.4}", found / slow);
    assert!((found / slow - 1.0).abs() < 0.01, "{name} {sets:?}: estimate {found} s, simulation {slow} s");
}

#[test]
fn whole_real_models_take_as_long_as_their_moves() {
    let Some(folder) = common::models_dir() else { return };
    let of_name = |name: &str| std::fs::read(folder.join(name)).expect("the model");
    for (name, sets) in [
        ("bridge_test.stl", &["printer.flavor=marlin"][..]),
        ("cal_cube.stl", &["printer.flavor=klipper", "gcode.arc_fitting=true"]),
        ("tolerance.stl", &["printer.flavor=prusa", "gcode.arc_fitting=true"]),
        ("thin_wall.stl", &["printer.flavor=reprap", "retraction.wipe=true", "retraction.z_hop=0.3"]),
        ("overhang.stl", &["printer.flavor=klipper", "layers.adaptive=true"]),
        ("hole_test.stl", &["printer.flavor=prusa", "layers.adaptive=true", "gcode.arc_fitting=true"]),
        ("xy_calibration.stl", &["printer.flavor=marlin", "gcode.arc_fitting=true", "infill.pattern=gyroid"]),
    ] {
        check_whole(name, &[of_name(name)], sets);
    }
    let plate = [of_name("cal_cube.stl"), of_name("thin_wall.stl")];
    check_whole("two, one after another", &plate, &["print.sequence=by_object", "gcode.arc_fitting=true"]);
}

#[test]
fn models_printed_one_after_another_take_as_long_as_their_moves() {
    let cylinder = common::cylinder(6.0, 5.0, 60);
    let plate = [common::cube(8.0), common::cube(12.0), cylinder].map(|mesh| write_binary(&mesh));
    for flavor in ["marlin", "klipper", "reprap", "prusa"] {
        let flavor = format!("printer.flavor={flavor}");
        for more in
            ["adhesion.kind=skirt", "layers.adaptive=true", "gcode.arc_fitting=true", "retraction.z_hop=0.4"]
        {
            check_whole("by object", &plate, &["print.sequence=by_object", &flavor, more]);
        }
    }
}
