//! Travel in the finished file: how often it leaves the part across its outer walls, against the plainest
//! order there is.
#![cfg(not(target_arch = "wasm32"))]

mod common;

use foothold::gcode::{assemble, read};
use foothold::mesh::load;
use foothold::pipeline::{Job, NamedModel, PRINT_RESOLUTION};
use foothold::polygon::grid::EdgeGrid;
use foothold::polygon::{DVec2, Polygon};
use foothold::settings::Settings;
use foothold::slice::{Axis, slice_mesh};

/// A layer's islands with the grids of their outlines.
type Outline = Vec<(Polygon, EdgeGrid)>;

/// The file read back and the outline of each layer.
fn slice(bytes: &[u8], sets: &[&str]) -> (read::ReadGcode, Vec<Outline>) {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", load(bytes).expect("a good model"));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let heights: Vec<f64> = job.specs().iter().map(|s| s.slice_z).collect();
    let with_grid = |island: Polygon| {
        let contours = std::iter::once(&island.outer).chain(&island.holes);
        let edges: Vec<(DVec2, DVec2)> = contours.flat_map(|c| c.edges()).collect();
        (island, EdgeGrid::new(&edges))
    };
    let sections = slice_mesh(job.mesh(), Axis::Z, &heights, PRINT_RESOLUTION).into_iter();
    let outlines = sections.map(|s| s.area.islands().into_iter().map(with_grid).collect());
    let outlines = outlines.collect();
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let file = assemble(&job.finish(&|| 0.0).expect("all layers").joined, &range.texts);
    (read::read(&file, 1.75), outlines)
}

fn holds(island: &Polygon, p: DVec2) -> bool {
    island.outer.contains(p) && !island.holes.iter().any(|h| h.contains(p))
}

/// How often ways cross outlines: those from island to island, which have to, and those that begin and
/// end on the same one.
fn crossings(ways: &[[DVec2; 2]], outline: &Outline) -> [usize; 2] {
    let mut found = [0, 0];
    for &[a, b] in ways {
        let stays = outline.iter().any(|(island, _)| holds(island, a) && holds(island, b));
        found[usize::from(stays)] += outline.iter().map(|(_, g)| g.crossings(a, b).len()).sum::<usize>();
    }
    found
}

/// Straight ways through the strands of a layer, always to the nearest end.
fn nearest_neighbour(layer: &read::ReadLayer) -> Vec<[DVec2; 2]> {
    let mut left: Vec<(DVec2, DVec2)> =
        layer.strands.iter().filter_map(|s| Some((*s.points.first()?, *s.points.last()?))).collect();
    let mut ways = Vec::new();
    let mut here = DVec2::ZERO;
    while !left.is_empty() {
        let near = |&(a, b): &(DVec2, DVec2)| here.distance_squared(a).min(here.distance_squared(b));
        let nearest = (0..left.len()).min_by(|&i, &j| near(&left[i]).total_cmp(&near(&left[j])));
        let (a, b) = left.swap_remove(nearest.unwrap_or(0));
        let turned = here.distance_squared(b) < here.distance_squared(a);
        let (entry, exit) = if turned { (b, a) } else { (a, b) };
        ways.push([here, entry]);
        here = exit;
    }
    ways.split_off(1.min(ways.len()))
}

#[test]
fn travel_hardly_leaves_the_part() {
    let Some(folder) = common::models_dir() else { return };
    let sets = ["adhesion.kind=none", "first_layer.elephant_foot=0"];
    let (mut all, mut all_nearest) = ([0, 0], [0, 0]);
    let mut unavoidable = 0;
    for name in ["bridge_test.stl", "support_test.stl", "hole_test.stl", "xy_calibration.stl"] {
        let (file, outlines) = slice(&std::fs::read(folder.join(name)).expect("the model"), &sets);
        let (mut found, mut nearest, mut needed) = ([0, 0], [0, 0], 0);
        for (layer, outline) in file.layers.iter().zip(&outlines) {
            // The first way comes from the layer below.
            add(&mut found, crossings(layer.travels.get(1..).unwrap_or_default(), outline));
            add(&mut nearest, crossings(&nearest_neighbour(layer), outline));
            // From island to island the nozzle leaves one and enters the next.
            needed += 2 * outline.len().saturating_sub(1);
        }
        eprintln!(
            "{name}: crossings between islands and within one {found:?}, {needed} of them unavoidable, \
             nearest neighbour {nearest:?}"
        );
        unavoidable += needed;
        add(&mut all, found);
        add(&mut all_nearest, nearest);
    }
    // What an order could avoid: all but leaving one island and entering the next, once for each.
    let avoidable = |crossings: [usize; 2]| crossings[0] + crossings[1] - unavoidable;
    let (ours, plain) = (avoidable(all), avoidable(all_nearest));
    assert!(
        ours * 10 <= plain,
        "{ours} crossings more than the {unavoidable} needed, nearest neighbour {plain}"
    );
}

fn add(sum: &mut [usize; 2], more: [usize; 2]) {
    sum.iter_mut().zip(more).for_each(|(s, m)| *s += m);
}
