//! Reading and repairing an STL of a million triangles.
//!
//! The aim: parsed in no more time than three.js' STLLoader takes, about 100 ms in a
//! browser, and parsed and welded in at most twice that.
//!
//! Measured 2026-11-22 on a shared Xeon (2 cores, busy), CPU ms, best of several: native parse and
//! weld 56 (the same triangles shuffled 100), topology 30, repair of a sound mesh 136, text (203 MB)
//! 810. As wasm in Node 20.20: parse and weld 90 to 105, repair and inspect 114 to 130, beside 58 to
//! 93 for STLLoader of three 0.187, which does not weld. Before the slots of 16 triangles were asked
//! for together: 80 to 98 native, 154 to 208 in wasm; a small cache of recent vertices instead gave
//! 125 to 175, and nothing on shuffled triangles.

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
