//! Skirt, brim, raft and teeth for a first layer of 10,000 vertices.
//!
//! Target: all four under 25 ms on one core (50 ms as wasm); teeth no slower than a 20-line brim.

#![allow(missing_docs)] // criterion's macros make public items.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use foothold::adhesion::{AdhesionKind, AdhesionOptions, FirstLayer, compare, lay_foundation};
use foothold::polygon::measure::Bounds;
use foothold::polygon::{Contour, DVec2, PolygonSet, dvec2};

/// One ring of `n` vertices with `waves` waves, 90 mm across; `noise` mm of scanner noise.
fn wave(n: u32, waves: f64, noise: f64) -> PolygonSet {
    let mut state = 1u64;
    let mut dice = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5
    };
    let mut at = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        let radius = 45.0 + 6.0 * libm::sin(waves * angle) + noise * dice();
        dvec2(110.0, 110.0) + dvec2(libm::cos(angle), libm::sin(angle)) * radius
    };
    PolygonSet::from_contours(vec![Contour::new((0..n).map(&mut at).collect())])
}

/// A hundred rings of a hundred vertices, 12 mm apart.
fn many() -> PolygonSet {
    let ring = |k: u32| {
        let centre = dvec2(40.0 + 14.0 * f64::from(k % 10), 40.0 + 14.0 * f64::from(k / 10));
        let at = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / 100.0;
            centre + dvec2(libm::cos(angle), libm::sin(angle)) * 5.0
        };
        Contour::new((0..100).map(at).collect())
    };
    PolygonSet::from_contours((0..100).map(ring).collect())
}

fn adhesion(c: &mut Criterion) {
    let shapes = [("wave", wave(10_000, 14.0, 0.0)), ("noisy", wave(10_000, 14.0, 0.04)), ("many", many())];
    let supports = PolygonSet::EMPTY;
    let bed = Bounds { min: DVec2::ZERO, max: dvec2(220.0, 220.0) };
    for (name, outline) in &shapes {
        let first = FirstLayer {
            outline,
            supports: &supports,
            bed,
            closed: &supports,
            line_width: 0.5,
            height: 0.2,
            next_height: 0.2,
        };
        for kind in AdhesionKind::ALL {
            let options = AdhesionOptions { kind, ..AdhesionOptions::default() };
            c.bench_function(&format!("{name}/{}", kind.name()), |b| {
                b.iter(|| lay_foundation(black_box(&first), &options));
            });
        }
        c.bench_function(&format!("{name}/all four"), |b| {
            b.iter(|| compare(black_box(&first), &AdhesionOptions::default()));
        });
    }
}

criterion_group!(benches, adhesion);
criterion_main!(benches);
