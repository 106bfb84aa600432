#[path = "../tests/orientation_shapes/mod.rs"]
mod shapes;
use foothold::polygon::*; use foothold::slice::*; use foothold::region::overhang;
use std::time::{Instant,Duration};
fn main() {
    for (name, mesh) in [("smooth", shapes::bumpy_ball(25.0, 0.0, 160)), ("bumpy", shapes::bumpy_ball(25.0, 0.3, 160))] {
      for res in [0.0, 0.01, 0.02] {
        let b = mesh.bounds().unwrap();
        let n = ((b.max.z - b.min.z) as f64 / 0.2) as usize;
        let hs: Vec<f64> = (0..n).map(|k| b.min.z as f64 + (k as f64 + 0.5) * 0.2).collect();
        let t = Instant::now();
        let loops = slice_loops(&mesh, Axis::Z, &hs);
        let tl = t.elapsed();
        let t = Instant::now();
        let secs = slice_mesh(&mesh, Axis::Z, &hs, res);
        let ts = t.elapsed();
        let verts: usize = secs.iter().map(|s| s.area.vertex_count()).sum();
        let (mut to, mut td, mut te, mut tc, mut tu) = (Duration::ZERO, Duration::ZERO, Duration::ZERO, Duration::ZERO, Duration::ZERO);
        let mut s = PolygonSet::EMPTY; let mut sv = 0; let mut nesf = 0;
        for k in (0..n - 1).rev() {
            let (a, b) = (&secs[k].area, &secs[k + 1].area);
            let t = Instant::now(); let g = overhang::permissible_overhang(a, 0.2); to += t.elapsed();
            let t = Instant::now(); let out = b.difference(&g); td += t.elapsed();
            let t = Instant::now(); let e = if out.is_empty() { PolygonSet::EMPTY } else { nesf += 1; overhang::externally_supported(b, a, 0.2) }; te += t.elapsed();
            let t = Instant::now(); let c = s.difference(a); tc += t.elapsed();
            let t = Instant::now(); s = c.union(&e); tu += t.elapsed();
            sv += s.vertex_count();
        }
        println!("{name} res {res}: layers {n} loops {tl:?} (n {}) slice {ts:?} verts/layer {} offset {to:?} diff {td:?} esf {te:?} x{nesf} carry {tc:?} union {tu:?} sverts/layer {}", loops.len(), verts / n, sv / n);
      }
    }
}
