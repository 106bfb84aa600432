//! Real models made for one purpose each, read back from the G-code: thin walls, bridges, and the flow of
//! whole files.
#![cfg(not(target_arch = "wasm32"))]

mod common;

use common::Print;
use foothold::gcode::filament_area;
use foothold::gcode::read::Strand;
use foothold::region::Bead;
use glam::{DVec2, dvec2};

const BARE: [&str; 2] = ["adhesion.kind=none", "first_layer.elephant_foot=0"];

fn printed(name: &str, sets: &[&str]) -> Option<Print> {
    let folder = common::models_dir()?;
    Some(common::print(&std::fs::read(folder.join(name)).expect("the model"), sets))
}

/// A straight wall of `thin_wall.stl`: from the ring to its free end, and how thick it is.
struct Blade {
    root: DVec2,
    tip: DVec2,
    thickness: f64,
}

/// The four walls as the file has them: each with its middle line, from 0.1 mm outside the ring, whose
/// radius is 12 mm.
fn blades() -> [Blade; 4] {
    let blade = |root: (f64, f64), tip: (f64, f64), thickness: f64| Blade {
        root: root.into(),
        tip: tip.into(),
        thickness,
    };
    [
        blade((12.1, 0.175), (25.0, 0.175), 0.35),
        blade((-0.25, 12.1), (-0.25, 25.0), 0.5),
        blade((-12.1, -0.4), (-25.0, -0.4), 0.8),
        blade((0.5, -12.1), (0.5, -25.0), 1.0),
    ]
}

/// The beads that cover points of a blade's middle line, 0.05 mm apart, up to half its thickness before
/// the tip: for each point the numbers of the strands.
fn over_middle(blade: &Blade, middle: DVec2, strands: &[Strand]) -> Vec<Vec<usize>> {
    let along = (blade.tip - blade.root).normalize();
    let length = blade.root.distance(blade.tip) - blade.thickness / 2.0;
    let covers = |p: DVec2, strand: &Strand| {
        let pieces = strand.points.windows(2).zip(&strand.segments);
        pieces.into_iter().any(|(w, segment)| {
            let share = ((p - w[0]).dot(w[1] - w[0]) / (w[1] - w[0]).length_squared()).clamp(0.0, 1.0);
            p.distance(w[0].lerp(w[1], share)) <= segment.width / 2.0
        })
    };
    let at = |k: usize| {
        let p = middle + blade.root + along * (0.05 * k as f64);
        (0..strands.len()).filter(|&i| covers(p, &strands[i])).collect()
    };
    (0..=(length / 0.05) as usize).map(at).collect()
}

#[test]
fn every_thin_wall_is_there_and_single_ones_are_one_bead() {
    let Some(print) = printed("thin_wall.stl", &BARE) else { return };
    let bounds = print.mesh.bounds().expect("a mesh");
    let middle = ((bounds.min + bounds.max) / 2.0).truncate().as_dvec2();
    assert_eq!(print.file.layers.len(), 25);
    for (index, layer) in print.file.layers.iter().enumerate() {
        for blade in blades() {
            let thickness = blade.thickness;
            let covering = over_middle(&blade, middle, &layer.strands);
            let open = covering.iter().filter(|c| c.is_empty()).count();
            assert_eq!(open, 0, "layer {index}: {open} points of the {thickness} mm wall are bare");
            if thickness < 0.75 {
                // One bead has its width where the wall does, and no other lies beside it.
                let first = &covering[covering.len() / 2];
                assert_eq!(first.len(), 1, "layer {index}: {thickness} mm");
                let along = covering.iter().skip(10).all(|c| c.contains(&first[0]));
                assert!(along, "layer {index}: the {thickness} mm wall is in pieces");
                let others = covering.iter().skip(10).filter(|c| c.len() > 1).count();
                assert_eq!(others, 0, "layer {index}: {others} points of the {thickness} mm wall doubly");
            }
            // The plastic in a stretch of 5 mm is that of the wall.
            let (from, to) = (blade.root.lerp(blade.tip, 0.3), blade.root.lerp(blade.tip, 0.7));
            let found = plastic_between(middle + from, middle + to, &layer.strands);
            let wall = (thickness - 0.2 + 0.2 * std::f64::consts::FRAC_PI_4) * 0.2 * from.distance(to);
            assert!((found / wall - 1.0).abs() < 0.02, "layer {index}, {thickness} mm: {found}, not {wall}");
        }
    }
}

/// Plastic of beads alongside the way from `a` to `b`, not farther than 1 mm from it, mm3.
fn plastic_between(a: DVec2, b: DVec2, strands: &[Strand]) -> f64 {
    let along = (b - a).normalize();
    let share_inside = |w: &[DVec2]| {
        let (s, e) = ((w[0] - a).dot(along), (w[1] - a).dot(along));
        let near = w.iter().all(|&p| (p - a).perp_dot(along).abs() < 1.0);
        let (low, high) = (s.min(e).max(0.0), s.max(e).min(a.distance(b)));
        if near && high > low && s != e { (high - low) / (e - s).abs() } else { 0.0 }
    };
    let of = |s: &Strand| -> f64 {
        s.points.windows(2).zip(&s.segments).map(|(w, segment)| share_inside(w) * segment.volume_mm3).sum()
    };
    strands.iter().map(of).sum()
}

/// A move that extrudes, as it stands in the text.
#[derive(Debug, Clone, Copy)]
struct Extrusion<'a> {
    from: DVec2,
    to: DVec2,
    /// Filament, mm.
    e: f64,
    kind: &'a str,
    width: f64,
    height: f64,
    /// Fan in force, 0 to 255.
    fan: f64,
    layer: usize,
}

impl Extrusion<'_> {
    fn length(&self) -> f64 {
        self.from.distance(self.to)
    }
}

/// How far the nearest line beside `step` is that runs along it, mm.
fn distance_to_next(step: &Extrusion<'_>, layer: &[Extrusion<'_>]) -> Option<f64> {
    let along = (step.to - step.from).normalize();
    let is_beside = |it: &&Extrusion<'_>| {
        let turn = (it.to - it.from).normalize_or_zero().perp_dot(along).abs();
        let reach = [it.from, it.to].map(|p| (p - step.from).dot(along));
        turn < 3e-4 && reach[0].min(reach[1]) < step.length() && reach[0].max(reach[1]) > 0.0
    };
    let distances = layer.iter().filter(is_beside).map(|it| (it.from - step.from).perp_dot(along).abs());
    distances.filter(|&d| d > 0.1).min_by(f64::total_cmp)
}

/// All extruding moves of the text's layers, read word by word.
fn extrusions(text: &str) -> Vec<Extrusion<'_>> {
    let mut state = Extrusion {
        from: DVec2::ZERO,
        to: DVec2::ZERO,
        e: 0.0,
        kind: "",
        width: 0.0,
        height: 0.0,
        fan: 0.0,
        layer: 0,
    };
    let mut found = Vec::new();
    for line in text.lines() {
        if line == ";LAYER_CHANGE" {
            state.layer += 1;
        } else if let Some((key, value)) = line.strip_prefix(';').and_then(|l| l.split_once(':')) {
            match key {
                "TYPE" => state.kind = value,
                "WIDTH" => state.width = value.parse().expect("a width"),
                "HEIGHT" => state.height = value.parse().expect("a height"),
                _ => {}
            }
            continue;
        }
        let code = line.split(';').next().unwrap_or("");
        let word = |letter: char| -> Option<f64> {
            code.split_whitespace().find_map(|w| w.strip_prefix(letter)?.parse().ok())
        };
        match code.split_whitespace().next() {
            Some("M106") => state.fan = word('S').unwrap_or(255.0),
            Some("M107") => state.fan = 0.0,
            Some("G0" | "G1") => {
                let to = dvec2(word('X').unwrap_or(state.to.x), word('Y').unwrap_or(state.to.y));
                state = Extrusion { from: state.to, to, e: word('E').unwrap_or(0.0), ..state };
                if state.layer > 0 && state.e > 0.0 && state.from != to {
                    found.push(state);
                }
            }
            _ => {}
        }
    }
    found
}

#[test]
fn bridges_have_their_own_flow_and_fan() {
    let sets = [&BARE[..], &["filament.fan_speed=0.2", "filament.bridge_fan_speed=0.8"]].concat();
    let Some(print) = printed("bridge_test.stl", &sets) else { return };
    let text = String::from_utf8(print.text).expect("ASCII");
    let bridges: Vec<Extrusion<'_>> =
        extrusions(&text).into_iter().filter(|m| m.kind == "Bridge infill").collect();
    let (mut spread, mut all) = (0.0, 0.0);
    for layer in bridges.chunk_by(|a, b| a.layer == b.layer) {
        assert!(layer.iter().all(|step| step.fan == 204.0), "0.8 of 255");
        all += layer.iter().map(Extrusion::length).sum::<f64>();
        // Lines are spread over the bridge, each with the plastic for its share of the width.
        for step in layer.iter().filter(|step| step.length() > 0.5) {
            let Some(distance) = distance_to_next(step, layer) else { continue };
            let share = step.e * filament_area(1.75) / (step.length() * distance * step.height);
            if share > 0.9 {
                assert!((share - 0.95).abs() < 0.01, "{share} of the usual flow: {step:?}");
                spread += step.length();
            }
        }
    }
    assert!(spread > 0.8 * all, "{spread} of {all} mm");
}

/// What rounding does to a move: its ends stand in the text to 0.001 mm, its filament to 0.00001 mm, and
/// what rounding took from the filament before is made up for.
const PLACE_STEP: f64 = 0.001;
const FILAMENT_STEP: f64 = 0.00001;

#[test]
fn every_extruding_move_has_the_flow_of_its_stated_bead() {
    let names = ["thin_wall.stl", "bridge_test.stl", "hole_test.stl", "xy_calibration.stl", "cal_cube.stl"];
    for name in names {
        let Some(print) = printed(name, &[]) else { return };
        let text = String::from_utf8(print.text).expect("ASCII");
        let moves = extrusions(&text);
        assert!(moves.len() > 1000, "{name}");
        let (mut found, mut stated) = (0.0, 0.0);
        for step in &moves {
            let per_mm = Bead { width: step.width, height: step.height }.area() / filament_area(1.75);
            let length = step.from.distance(step.to);
            let rounding = per_mm * PLACE_STEP + FILAMENT_STEP;
            let off = (step.e - per_mm * length).abs();
            assert!(off <= 0.01 * per_mm * length + rounding, "{name}: {off} mm of {step:?}");
            found += step.e;
            stated += per_mm * length;
        }
        assert!((found / stated - 1.0).abs() < 0.001, "{name}: {found} mm for {stated}");
    }
}
