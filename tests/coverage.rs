//! What beads cover, measured from the G-code read back, against the section of the mesh computed by
//! other means than the slicer's own: every layer of the closed models, printed solid.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/area.rs"]
mod area;
mod common;

use area::{Area, difference, edges, offset, opened, section, size, united};
use foothold::gcode::read::{ReadLayer, Strand};
use foothold::mesh::Mesh;
use glam::DVec2;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

/// Solid, nothing beside the part, nothing drawn in.
const SOLID: [&str; 3] = ["infill.density=1", "adhesion.kind=none", "first_layer.elephant_foot=0"];

/// Nominal line width, mm.
const LINE: f64 = 0.45;

/// What one layer comes to.
#[derive(Debug, Clone, Copy, Default)]
struct Measure {
    /// Share of the section, opened by 0.1 mm, that beads cover.
    covered: f64,
    /// Share of the beads' area more than 0.1 mm outside the section.
    outside: f64,
    /// Share of the beads' area more than 0.05 mm outside the section.
    past: f64,
    /// The farthest that beads stay behind the outline where a line fits, mm.
    short_of: f64,
    /// Plastic over the section's volume.
    filled: f64,
    /// Where that is.
    #[expect(dead_code, reason = "printed")]
    at: DVec2,
}

impl Measure {
    fn is_good(&self) -> bool {
        self.covered >= 0.99 && self.outside < 0.01 && self.past < 0.002 && self.short_of < 0.05
    }
}

/// Points every 0.1 mm along all outlines, counted through short edges.
fn along(area: &Area) -> Vec<DVec2> {
    let mut points = Vec::new();
    for ring in area.iter().flatten() {
        let mut walked = 0.0;
        for i in 0..ring.len() {
            let (a, b) = (DVec2::from(ring[i]), DVec2::from(ring[(i + 1) % ring.len()]));
            let length = a.distance(b);
            while walked < length {
                points.push(a.lerp(b, walked / length));
                walked += 0.1;
            }
            walked -= length;
        }
    }
    points
}

/// Points inside, 0.07 mm apart.
fn samples(area: &Area) -> Vec<DVec2> {
    const STEP: f64 = 0.07;
    // Rows lie askew, so that no straight outline runs along one.
    let turn = DVec2::from_angle(0.4);
    let back = DVec2::new(turn.x, -turn.y);
    let turned = edges(area).into_iter().map(|edge| edge.map(|p| p.rotate(turn)));
    let edges: Vec<[DVec2; 2]> = turned.collect();
    let rows = |f: fn(f64, f64) -> f64, start: f64| edges.iter().map(|e| e[0].y).fold(start, f);
    let (low, high) = (rows(f64::min, f64::MAX), rows(f64::max, f64::MIN));
    let mut points = Vec::new();
    for row in 0..((high - low) / STEP) as usize {
        let y = low + (row as f64 + 0.5) * STEP;
        let crossing = |[a, b]: &[DVec2; 2]| {
            ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y))
        };
        let mut crossings: Vec<f64> = edges.iter().filter_map(crossing).collect();
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let first = (pair[0] / STEP).ceil() as i64;
            points.extend(
                (first..=(pair[1] / STEP) as i64).map(|i| DVec2::new(i as f64 * STEP, y).rotate(back)),
            );
        }
    }
    points
}

/// The beads of a layer as capsules: from, to, radius.
fn capsules(layer: &ReadLayer) -> Vec<(DVec2, DVec2, f64)> {
    let of = |s: &Strand| -> Vec<(DVec2, DVec2, f64)> {
        let ends = s.points.windows(2).zip(&s.segments);
        ends.map(|(p, segment)| (p[0], p[1], segment.width / 2.0)).collect()
    };
    layer.strands.iter().flat_map(of).collect()
}

fn painted(capsules: &[(DVec2, DVec2, f64)]) -> Area {
    let ring = |&(a, b, r): &(DVec2, DVec2, f64)| {
        let along = (b - a).normalize_or(DVec2::X);
        // The polygon with 24 corners around a circle has its area within 1 %.
        let arc = |centre: DVec2, turn: f64| {
            (0..=12).map(move |i| {
                let angle = turn - FRAC_PI_2 + PI * f64::from(i) / 12.0;
                (centre + r * DVec2::from_angle(angle).rotate(along)).to_array()
            })
        };
        arc(b, 0.0).chain(arc(a, PI)).collect::<Vec<[f64; 2]>>()
    };
    united(capsules.iter().map(ring).collect())
}

/// Capsules in square cells of 1 mm.
struct Nearby {
    capsules: Vec<(DVec2, DVec2, f64)>,
    cells: std::collections::BTreeMap<(i32, i32), Vec<u32>>,
}

impl Nearby {
    fn new(capsules: Vec<(DVec2, DVec2, f64)>) -> Nearby {
        let mut cells: std::collections::BTreeMap<(i32, i32), Vec<u32>> = Default::default();
        for (i, &(a, b, r)) in capsules.iter().enumerate() {
            let (low, high) = ((a.min(b) - r - 0.5).floor(), (a.max(b) + r + 0.5).floor());
            for x in low.x as i32..=high.x as i32 {
                for y in low.y as i32..=high.y as i32 {
                    cells.entry((x, y)).or_default().push(i as u32);
                }
            }
        }
        Nearby { capsules, cells }
    }

    /// How far `p` is from the nearest bead's border, mm; negative inside; at most 0.5.
    fn distance(&self, p: DVec2) -> f64 {
        let near = self.cells.get(&(p.x.floor() as i32, p.y.floor() as i32)).into_iter().flatten();
        let to = |&i: &u32| {
            let (a, b, r) = self.capsules[i as usize];
            let share = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
            p.distance(a.lerp(b, share)) - r
        };
        near.map(to).fold(0.5, f64::min)
    }
}

fn measure(mesh: &Mesh, slice_z: f64, layer: &ReadLayer, line: f64) -> Option<Measure> {
    let part = section(mesh, slice_z);
    let wide = opened(&part, 0.1);
    if size(&wide) < 0.2 {
        return None;
    }
    let capsules = capsules(layer);
    let beads = painted(&capsules);
    let volume: f64 = layer.strands.iter().map(Strand::volume_mm3).sum();
    let nearby = Nearby::new(capsules);
    // Where a line fits: the outline in thinner places and in sharp corners is not asked for. The library's
    // offsets leave spikes towards corners, in which no line fits.
    let outline = Nearby::new(edges(&part).into_iter().map(|[a, b]| (a, b, 0.0)).collect());
    let fits = |p: &DVec2| outline.distance(*p) > line / 2.0 - 0.005;
    let deep = along(&offset(&part, -line / 2.0)).into_iter().filter(fits);
    let deep = Nearby::new(deep.map(|p| (p, p, 0.0)).collect());
    let followed = along(&part).into_iter().filter(|&p| deep.distance(p) < line / 2.0 + 0.01);
    let short = followed.map(|p| (p, nearby.distance(p)));
    let (at, short_of) = short.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((DVec2::ZERO, 0.0));
    let inside = samples(&wide);
    let covered = inside.iter().filter(|&&p| nearby.distance(p) <= 0.0).count();
    Some(Measure {
        covered: covered as f64 / inside.len().max(1) as f64,
        outside: size(&difference(&beads, &offset(&part, 0.1))) / size(&beads).max(1e-9),
        past: size(&difference(&beads, &offset(&part, 0.05))) / size(&beads).max(1e-9),
        short_of,
        filled: volume / (size(&part) * layer.height),
        at,
    })
}

/// Every layer, or one in ten.
fn chosen(index: usize) -> bool {
    std::env::var("FOOTHOLD_LONG").is_ok_and(|v| v == "1") || index % 10 == 3
}

fn manifest(folder: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(folder.join("manifest.json")).expect("a manifest");
    let manifest: Value = serde_json::from_str(&text).expect("JSON");
    manifest["files"].as_array().expect("a list of files").clone()
}

#[test]
fn beads_cover_the_section_and_keep_to_its_outline() {
    let Some(folder) = common::models_dir() else { return };
    let only = std::env::var("FOOTHOLD_ONLY").ok();
    let mut wrong = Vec::new();
    for entry in manifest(&folder) {
        let name = entry["name"].as_str().expect("a name");
        if entry["kind"] != "good" || only.as_ref().is_some_and(|o| !name.contains(o.as_str())) {
            continue;
        }
        let bytes = std::fs::read(folder.join(name)).expect("the model is there");
        let print = common::print(&bytes, &SOLID);
        let mut worst = Measure { covered: 1.0, ..Measure::default() };
        for (index, (spec, layer)) in print.specs.iter().zip(&print.file.layers).enumerate() {
            let Some(found) =
                chosen(index).then(|| measure(&print.mesh, spec.slice_z, layer, LINE)).flatten()
            else {
                continue;
            };
            worst.covered = worst.covered.min(found.covered);
            worst.outside = worst.outside.max(found.outside);
            worst.past = worst.past.max(found.past);
            worst.short_of = worst.short_of.max(found.short_of);
            worst.filled = worst.filled.max(found.filled);
            if !found.is_good() {
                wrong.push(format!("{name} layer {index}: {found:.4?}"));
            }
        }
        eprintln!("{name}: {worst:.4?}");
    }
    assert!(wrong.is_empty(), "{} layers:\n{}", wrong.len(), wrong.join("\n"));
}
