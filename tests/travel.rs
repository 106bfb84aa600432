//! Travel in the finished file: how often it leaves the part across its outer walls, against the plainest
//! order there is.
#![cfg(not(target_arch = "wasm32"))]

mod common;

use foothold::gcode::{assemble, read};
use foothold::mesh::load;
use foothold::pipeline::{Job, NamedModel, PRINT_RESOLUTION};
use foothold::polygon::DVec2;
use foothold::polygon::grid::EdgeGrid;
use foothold::settings::Settings;
use foothold::slice::{Axis, slice_mesh};

/// The file read back and the outline of each layer.
fn slice(bytes: &[u8], sets: &[&str]) -> (read::ReadGcode, Vec<EdgeGrid>) {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named =
        NamedModel { name: "part".to_owned(), model: load(bytes).expect("a good model"), orientation: None };
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let heights: Vec<f64> = job.specs().iter().map(|s| s.slice_z).collect();
    let outlines = slice_mesh(job.mesh(), Axis::Z, &heights, PRINT_RESOLUTION).into_iter().map(|s| {
        let edges: Vec<(DVec2, DVec2)> = s.area.contours().iter().flat_map(|c| c.edges()).collect();
        EdgeGrid::new(&edges)
    });
    let outlines = outlines.collect();
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let file = assemble(&job.finish(&|| 0.0).expect("all layers").joined, &range.texts);
    (read::read(&file, 1.75), outlines)
}

/// How often ways cross the outline.
fn crossings(ways: &[[DVec2; 2]], outline: &EdgeGrid) -> usize {
    ways.iter().map(|&[a, b]| outline.crossings(a, b).len()).sum()
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
    let sets = ["adhesion.kind=none", "first_layer.elephant_foot=0", "seam.gap=0"];
    let (mut all, mut all_nearest) = (0, 0);
    for name in ["bridge_test.stl", "support_test.stl", "hole_test.stl", "xy_calibration.stl"] {
        let (file, outlines) = slice(&std::fs::read(folder.join(name)).expect("the model"), &sets);
        let (mut found, mut nearest) = (0, 0);
        for (layer, outline) in file.layers.iter().zip(&outlines) {
            // The first way comes from the layer below.
            found += crossings(layer.travels.get(1..).unwrap_or_default(), outline);
            nearest += crossings(&nearest_neighbour(layer), outline);
        }
        eprintln!("{name}: {found} crossings, {nearest} by the nearest neighbour");
        (all, all_nearest) = (all + found, all_nearest + nearest);
    }
    // Ways from island to island, most of what is left, have to cross two outlines each.
    assert!(all * 10 <= all_nearest * 7, "{all} crossings, {all_nearest} by the nearest neighbour");
}
