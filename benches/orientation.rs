//! Six directions: part model 1 of [Karim] at 0.01 mm, and parts of 100,000 triangles at 0.2 mm.

use criterion::{Criterion, criterion_group, criterion_main};
use foothold::orientation::{OrientationOptions, orient};

#[path = "../tests/orientation_shapes/mod.rs"]
mod shapes;

fn six_directions(c: &mut Criterion) {
    let mut group = c.benchmark_group("orientation");
    group.sample_size(10);
    let parts = [
        ("part_model_1_4000_layers", shapes::part_model_1(), 0.01),
        ("ball_100k", shapes::bumpy_ball(25.0, 0.0, 160), 0.2),
        ("bumpy_ball_100k", shapes::bumpy_ball(25.0, 0.1, 160), 0.2),
        ("very_bumpy_ball_100k", shapes::bumpy_ball(25.0, 0.3, 160), 0.2),
    ];
    for (name, mesh, layer_height) in parts {
        let options =
            OrientationOptions { layer_height, hull_directions: 0, ..OrientationOptions::default() };
        group.bench_function(name, |b| b.iter(|| orient(&mesh, &options, &mut |_, _| true)));
    }
    group.finish();
}

criterion_group!(benches, six_directions);
criterion_main!(benches);
