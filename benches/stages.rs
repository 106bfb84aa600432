//! The stages of slicing one by one, and a whole range: a bumpy ball of 80,000 triangles and 60 mm.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, PRINT_RESOLUTION};
use foothold::polygon::{Join, PolygonSet};
use foothold::region::{Bead, Role};
use foothold::settings::Settings;
use foothold::slice::{Axis, slice_mesh};
use foothold::toolpath::infill::fill_solid;
use foothold::toolpath::walls::lay_walls;
use glam::Vec3;

const BEAD: Bead = Bead { width: 0.45, height: 0.2 };

/// A ball whose surface waves by 3 %, like a scan's.
fn bumpy_ball(rings: u32, segments: u32) -> Mesh {
    let at = |ring: u32, segment: u32| {
        let (polar, round) = (
            std::f64::consts::PI * f64::from(ring) / f64::from(rings),
            std::f64::consts::TAU * f64::from(segment) / f64::from(segments),
        );
        let radius = 30.0 * (1.0 + 0.03 * (9.0 * polar).sin() * (11.0 * round).sin());
        let flat = radius * polar.sin();
        Vec3::new(
            (flat * round.cos()) as f32,
            (flat * round.sin()) as f32,
            (30.0 + radius * polar.cos()) as f32,
        )
    };
    let mut vertices: Vec<Vec3> = Vec::new();
    for ring in 0..=rings {
        vertices.extend((0..segments).map(|segment| at(ring, segment)));
    }
    let place = |ring: u32, segment: u32| ring * segments + segment % segments;
    let quad = |(ring, segment): (u32, u32)| {
        let [a, b] = [place(ring, segment), place(ring, segment + 1)];
        let [c, d] = [place(ring + 1, segment), place(ring + 1, segment + 1)];
        [[a, c, b], [b, c, d]]
    };
    let quads = (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s)));
    Mesh { vertices, triangles: quads.flat_map(quad).collect() }
}

fn stages(criterion: &mut Criterion) {
    let mesh = bumpy_ball(200, 200);
    let heights: Vec<f64> = (0..64).map(|i| 10.0 + 0.2 * f64::from(i)).collect();
    criterion.bench_function("slice 64 layers", |b| {
        b.iter(|| slice_mesh(black_box(&mesh), Axis::Z, &heights, PRINT_RESOLUTION));
    });
    let sections = slice_mesh(&mesh, Axis::Z, &heights, PRINT_RESOLUTION);
    let area: &PolygonSet = &sections[32].area;
    criterion.bench_function("offset one layer", |b| b.iter(|| black_box(area).offset(-0.4, Join::WALL)));
    criterion.bench_function("difference of two layers", |b| {
        b.iter(|| black_box(area).difference(&sections[33].area));
    });
    criterion.bench_function("walls of one layer", |b| b.iter(|| lay_walls(black_box(area), BEAD, 3)));
    criterion.bench_function("solid infill of one layer", |b| {
        b.iter(|| fill_solid(black_box(area), Role::SolidInfill, BEAD, 0));
    });
}

fn whole(criterion: &mut Criterion) {
    let model = load(&write_binary(&bumpy_ball(200, 200))).expect("a closed ball");
    let named = NamedModel::new("ball", model);
    let mut job = Job::new(&[named], Settings::default(), &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("default settings");
    let mut group = criterion.benchmark_group("whole");
    group.sample_size(10);
    group.bench_function("24 layers to text", |b| b.iter(|| job.slice(100, 124, &|| 0.0)));
    group.finish();
}

criterion_group!(benches, stages, whole);
criterion_main!(benches);
