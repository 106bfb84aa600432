//! Plates for a part of 100,000 triangles at spacing 4: under 1 s of single-core wasm,
//! which is about 0.6 s natively.
//!
//! Measured 2026-11-22 on a shared Xeon (2 cores, busy), best of 5, everything of `plan_supports`,
//! the layers' sections not counted: 100,000 triangles at spacing 4 (40 planes) 82 ms; 25,000
//! triangles 57 ms; 100,000 triangles at spacing 1 (160 planes) 172 ms. A quarter of the
//! triangles or four times the planes change the time by a factor of 2: it grows with triangles plus
//! output, not with triangles times planes.

#[path = "../tests/common/mod.rs"]
mod common;

use criterion::{Criterion, criterion_group, criterion_main};
use foothold::mesh::Mesh;
use foothold::polygon::PolygonSet;
use foothold::slice::heights::plan_layers;
use foothold::slice::{Axis, LayerOptions, slice_mesh};
use foothold::support::{PlateOptions, SupportInput, SupportMethod, SupportOptions, plan_supports};
use glam::vec3;
use std::hint::black_box;
use std::time::Duration;

fn ball(rings: usize, segments: usize) -> Mesh {
    common::sphere(vec3(45.0, 45.0, 40.0), 40.0, rings, segments)
}

fn plates_of_a_ball(c: &mut Criterion) {
    let mut group = c.benchmark_group("plates");
    group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(4));
    for (name, mesh, spacing) in [
        ("100,000 triangles, spacing 4", ball(251, 200), 4.0),
        ("25,000 triangles, spacing 4", ball(126, 100), 4.0),
        ("100,000 triangles, spacing 1", ball(251, 200), 1.0),
    ] {
        let layers = plan_layers(80.0, &LayerOptions::default());
        let heights: Vec<f64> = layers.iter().map(|l| l.slice_z).collect();
        let sections = slice_mesh(&mesh, Axis::Z, &heights, 0.0125);
        let areas: Vec<PolygonSet> = sections.into_iter().map(|s| s.area).collect();
        let plates = PlateOptions { spacing_x: spacing, spacing_y: spacing, ..PlateOptions::default() };
        let options = SupportOptions { method: SupportMethod::Plates, plates, ..SupportOptions::default() };
        let input = SupportInput { mesh: &mesh, layers: &layers, areas: &areas };
        group.bench_function(name, |b| {
            b.iter(|| black_box(plan_supports(&input, &options, &mut |_, _| true)))
        });
    }
    group.finish();
}

criterion_group!(benches, plates_of_a_ball);
criterion_main!(benches);
