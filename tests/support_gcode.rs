//! Supports as the G-code says: what they hold, how near they come to the part, and how much plastic
//! in how many pieces they are beside another slicer's.

mod common;

use std::path::Path;
use std::process::Command;

use foothold::gcode::{assemble, read};
use foothold::mesh::load;
use foothold::pipeline::{Job, NamedModel, Report};
use foothold::polygon::simplify::closest_on_segment;
use foothold::polygon::{DVec2, PolygonSet, dvec2};
use foothold::region::Role;
use foothold::region::overhang::{need, permissible_step};
use foothold::settings::Settings;
use foothold::slice::{Axis, slice_mesh};

const MODELS: [&str; 5] = ["support_test", "overhang", "own_arch_ascii", "own_hinge", "bridge_test"];

/// One straight bead of a support as the file has it, mm.
#[derive(Debug, Clone, Copy)]
struct Bead {
    from: DVec2,
    to: DVec2,
    width: f64,
    is_interface: bool,
}

/// The supports of one layer of a file.
#[derive(Debug, Clone, Default)]
struct Layer {
    top: f64,
    height: f64,
    beads: Vec<Bead>,
    plastic_mm3: f64,
}

/// The supports of a file, layer by layer.
fn supports_of(gcode: &[u8]) -> Vec<Layer> {
    let file = read::read(gcode, 1.75);
    let of_layer = |layer: &read::ReadLayer| {
        let mut found = Layer { top: layer.z, height: layer.height, ..Layer::default() };
        for strand in &layer.strands {
            let is_interface = strand.role == Some(Role::SupportInterface);
            if strand.role != Some(Role::Support) && !is_interface {
                continue;
            }
            found.plastic_mm3 += strand.volume_mm3();
            let ends = strand.points.windows(2).zip(&strand.segments);
            found.beads.extend(ends.map(|(p, s)| Bead {
                from: p[0],
                to: p[1],
                width: s.width,
                is_interface,
            }));
        }
        found
    };
    file.layers.iter().map(of_layer).collect()
}

/// Structures that hang together: voxels of 0.1 mm in plan and of a layer in height, joined by faces.
/// Beads that touch side by side are one.
fn pieces(layers: &[Layer]) -> usize {
    const PIXEL_MM: f64 = 0.1;
    let beads = || layers.iter().flat_map(|l| &l.beads);
    let low = beads().flat_map(|b| [b.from, b.to]).fold(DVec2::INFINITY, DVec2::min) - 1.0;
    let high = beads().flat_map(|b| [b.from, b.to]).fold(DVec2::NEG_INFINITY, DVec2::max) + 1.0;
    let columns = ((high.x - low.x) / PIXEL_MM).ceil() as usize;
    let rows = ((high.y - low.y) / PIXEL_MM).ceil() as usize;
    let mut parent: Vec<u32> = Vec::new();
    // The last layers with supports: their tops and their voxels' numbers.
    let mut below: Vec<(f64, Vec<u32>)> = Vec::new();
    for layer in layers.iter().filter(|l| !l.beads.is_empty()) {
        let mut voxels = vec![u32::MAX; columns * rows];
        for bead in &layer.beads {
            // A hair, so that neighbours that touch share a voxel's face.
            let reach = bead.width / 2.0 + PIXEL_MM / 2.0;
            let first = ((bead.from.min(bead.to) - low - reach) / PIXEL_MM).floor();
            let last = ((bead.from.max(bead.to) - low + reach) / PIXEL_MM).ceil();
            for y in first.y as usize..=last.y as usize {
                for x in first.x as usize..=last.x as usize {
                    let centre = low + (dvec2(x as f64, y as f64) + 0.5) * PIXEL_MM;
                    let voxel = &mut voxels[y * columns + x];
                    let near = closest_on_segment(centre, bead.from, bead.to).distance(centre) <= reach;
                    if near && *voxel == u32::MAX {
                        *voxel = parent.len() as u32;
                        parent.push(*voxel);
                    }
                }
            }
        }
        for i in (0..voxels.len()).filter(|&i| voxels[i] != u32::MAX) {
            for beside in [i.wrapping_sub(1), i.wrapping_sub(columns)] {
                if let Some(&other) = voxels.get(beside).filter(|&&v| v != u32::MAX) {
                    link(&mut parent, voxels[i], other);
                }
            }
            for (top, other) in &below {
                if (layer.top - layer.height - top).abs() < 0.06 && other[i] != u32::MAX {
                    link(&mut parent, voxels[i], other[i]);
                }
            }
        }
        below.retain(|(top, _)| *top > layer.top - 1.0);
        below.push((layer.top, voxels));
    }
    (0..parent.len() as u32).filter(|&i| root(&mut parent, i) == i).count()
}

fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        parent[node as usize] = parent[parent[node as usize] as usize];
        node = parent[node as usize];
    }
    node
}

fn link(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// The part in bed coordinates, its file and its report.
struct Printed {
    areas: Vec<PolygonSet>,
    supports: Vec<Layer>,
    report: Report,
}

fn printed(model: &Path, sets: &[&str]) -> Printed {
    let loaded = load(&std::fs::read(model).expect("the model is there")).expect("the model is sound");
    let sets = sets.iter().copied().chain(["support.method=plates"]);
    let settings = Settings::resolve([], sets).expect("good settings");
    let mut job = Job::new(&[NamedModel::new("part", loaded)], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let heights: Vec<f64> = job.specs().iter().map(|s| s.slice_z).collect();
    let areas = slice_mesh(job.mesh(), Axis::Z, &heights, 0.0).into_iter().map(|s| s.area).collect();
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    let supports = supports_of(&assemble(&finished.joined, &range.texts));
    Printed { areas, supports, report: finished.report }
}

/// Every point of every need is within half a spacing of a bead in the layer below the gap,
/// interface not counted; points 0.25 mm apart are looked at.
fn assert_covered(name: &str, part: &Printed) {
    let mut checked = 0;
    for k in 1..part.areas.len() - 1 {
        let area = need(&part.areas[k + 1], &part.areas[k], permissible_step(0.2, 45.0), 0.2);
        let Some(bounds) = area.bounds() else { continue };
        let beads: Vec<&Bead> = part.supports[k - 1].beads.iter().filter(|b| !b.is_interface).collect();
        let steps = (bounds.size() / 0.25).ceil();
        let points = (0..=steps.y as u32).flat_map(|j| (0..=steps.x as u32).map(move |i| (i, j)));
        let points = points.map(|(i, j)| bounds.min + 0.25 * dvec2(f64::from(i), f64::from(j)));
        for p in points.filter(|&p| area.contains(p)) {
            let distance = |b: &&Bead| closest_on_segment(p, b.from, b.to).distance(p) - b.width / 2.0;
            let nearest = beads.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest <= 2.0, "{name} layer {k}: {p} is {nearest} mm from a bead");
            checked += 1;
        }
    }
    assert!(checked > 10, "{name}: {checked} points of need");
}

/// No bead comes nearer to the part's outline than the sideways gap less 0.05.
fn assert_clear(name: &str, part: &Printed) {
    let mut checked = 0;
    for (k, (area, layer)) in part.areas.iter().zip(&part.supports).enumerate() {
        let edges: Vec<(DVec2, DVec2)> = area.contours().iter().flat_map(|c| c.edges()).collect();
        for bead in &layer.beads {
            let near = bead.width / 2.0 + 0.35;
            let (low, high) = (bead.from.min(bead.to) - near, bead.from.max(bead.to) + near);
            let beside =
                |e: &&(DVec2, DVec2)| e.0.max(e.1).cmpge(low).all() && e.0.min(e.1).cmple(high).all();
            for &(a, b) in edges.iter().filter(beside) {
                let distance = between(bead.from, bead.to, a, b);
                assert!(distance >= near, "{name} layer {k}: {bead:?} is {distance} mm from an outline");
            }
            assert!(!area.contains(bead.from), "{name} layer {k}: {bead:?} in the part");
            checked += 1;
        }
    }
    assert!(checked > 100, "{name}: {checked} beads");
}

/// Distance of two segments, mm.
fn between(p: DVec2, q: DVec2, a: DVec2, b: DVec2) -> f64 {
    let side = |o: DVec2, d: DVec2, x: DVec2| (d - o).perp_dot(x - o);
    let crosses = side(p, q, a) * side(p, q, b) < 0.0 && side(a, b, p) * side(a, b, q) < 0.0;
    let to = |x: DVec2, s: DVec2, e: DVec2| closest_on_segment(x, s, e).distance(x);
    if crosses { 0.0 } else { to(a, p, q).min(to(b, p, q)).min(to(p, a, b)).min(to(q, a, b)) }
}

#[test]
fn the_files_of_real_models_hold_what_hangs_and_keep_clear_of_the_part() {
    let Some(dir) = common::models_dir() else { return };
    for name in MODELS {
        let part = printed(&dir.join(name).with_extension("stl"), &[]);
        let report = &part.report.support.as_ref().expect("there are supports").figures;
        assert!(report.uncovered.is_empty(), "{name}: {:?}", report.uncovered);
        assert_covered(name, &part);
        assert_clear(name, &part);
    }
}

/// Plastic and pieces of supports in a file.
fn figures(layers: &[Layer]) -> (f64, usize) {
    (layers.iter().map(|l| l.plastic_mm3).sum(), pieces(layers))
}

/// `None`, said on stderr, where PrusaSlicer is not installed.
fn of_prusa_slicer(model: &Path) -> Option<(f64, usize)> {
    let out = std::env::temp_dir().join(format!("foothold-{}-support.gcode", std::process::id()));
    let mut run = Command::new("prusa-slicer");
    run.args(["--export-gcode", "--support-material", "-o"]).arg(&out).arg(model);
    if !run.output().ok()?.status.success() {
        return None;
    }
    let found = figures(&supports_of(&std::fs::read(&out).ok()?));
    std::fs::remove_file(&out).ok()?;
    Some(found)
}

#[test]
fn less_plastic_in_fewer_pieces_than_prusa_slicer() {
    let Some(dir) = common::models_dir() else { return };
    if std::env::var_os("FOOTHOLD_LONG").is_none() {
        return;
    }
    let mut worse = Vec::new();
    println!("| model | plates alone / complete | plates + interface | pieces | PrusaSlicer | pieces |");
    println!("|---|---|---|---|---|---|");
    for name in MODELS {
        let model = dir.join(name).with_extension("stl");
        let Some((their_mm3, their_pieces)) = of_prusa_slicer(&model) else {
            eprintln!("skipped: prusa-slicer is not installed");
            return;
        };
        let part = printed(&model, &[]);
        let report = &part.report.support.as_ref().expect("there are supports").figures;
        let bare = printed(&model, &["support.interface_layers=0"]);
        let alone = figures(&bare.supports);
        let (own_mm3, own_pieces) = figures(&part.supports);
        let share = alone.0 / report.complete_volume_mm3;
        println!(
            "| {name} | {:.1} / {:.1} mm3, {:.1} % | {own_mm3:.1} mm3 | {own_pieces} (bare {}, reported {}) | {their_mm3:.1} mm3 | {their_pieces} |",
            alone.0,
            report.complete_volume_mm3,
            100.0 * share,
            alone.1,
            report.pieces
        );
        if share > 0.24 || own_mm3 >= their_mm3 || own_pieces >= their_pieces {
            worse.push(name);
        }
    }
    assert!(worse.is_empty(), "{worse:?}");
}
