//! Reading and repairing an STL of a million triangles.
//!
//! The aim (issue 2): parsed in no more time than three.js' STLLoader takes, about 100 ms in a
//! browser, and parsed and welded in at most twice that.

#[path = "../tests/common/mod.rs"]
mod common;

use criterion::{Criterion, criterion_group, criterion_main};
use foothold::mesh::stl::{StlReader, write_binary, write_text};
use foothold::mesh::{Topology, load, repair};
use glam::Vec3;
use std::hint::black_box;
use std::time::Duration;

fn million_triangles(c: &mut Criterion) {
    // 2 x 1000 x (501 - 1) triangles.
    let ball = common::sphere(Vec3::ZERO, 50.0, 501, 1000);
    assert_eq!(ball.triangles.len(), 1_000_000);
    let bytes = write_binary(&ball);
    let parse = |chunk: usize| {
        let mut reader = StlReader::with_size(bytes.len() as u64);
        bytes.chunks(chunk).for_each(|c| reader.push(c).expect("the file is sound"));
        reader.finish().expect("the file is sound")
    };
    let mut group = c.benchmark_group("million triangles");
    group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(4));
    group.bench_function("parse and weld", |b| b.iter(|| black_box(parse(usize::MAX))));
    group.bench_function("parse and weld, chunks of 64 KiB", |b| b.iter(|| black_box(parse(1 << 16))));
    group.bench_function("topology", |b| b.iter(|| black_box(Topology::new(&ball))));
    group.bench_function("repair of a sound mesh", |b| b.iter(|| black_box(repair(&mut ball.clone()))));
    group.bench_function("load", |b| b.iter(|| black_box(load(&bytes))));
    let text = write_text(&ball, "ball");
    group.bench_function("load text", |b| b.iter(|| black_box(load(text.as_bytes()))));
    group.finish();
}

criterion_group!(benches, million_triangles);
criterion_main!(benches);
