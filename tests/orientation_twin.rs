//! A slow twin of the support volumes on a grid of pixels, written from [Karim]
//! alone: no polygon operation of the engine is used, only the loops of its cuts, for the growth and to see
//! strips thinner than a pixel.

mod orientation_shapes;

use foothold::mesh::Mesh;
use foothold::orientation::{OrientationOptions, evaluate, six};
use foothold::slice::{Axis, slice_loops};
use glam::{DVec2, dvec2};
use orientation_shapes::{
    bumpy_ball, cuboid, frustum, inside_out, octahedron, part_model_1, prism, random_from, random_rotation,
    rotated, together,
};

const LAYER: f64 = 0.8;

/// An eighth of the layer height is too wide for the strips of steep walls.
const PIXEL: f64 = LAYER / 32.0;

/// An overhang is looked for this far beside the borders: two steps of the engine's grid, mm.
const BESIDE: f64 = 2e-4;

/// The part as pixels: for each layer, row by row.
struct Grid {
    low: DVec2,
    width: usize,
    height: usize,
    slice_z: Vec<f64>,
    solid: Vec<Vec<bool>>,
}

impl Grid {
    fn new(mesh: &Mesh) -> Grid {
        let bounds = mesh.bounds().expect("the mesh has vertices");
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let layers = ((high.z - low.z) / LAYER - 0.5).ceil() as usize;
        let slice_z: Vec<f64> = (0..layers).map(|k| low.z + (k as f64 + 0.5) * LAYER).collect();
        let size = (high.truncate() - low.truncate()) / PIXEL;
        let (width, height) = (size.x as usize + 9, size.y as usize + 9);
        let low = low.truncate() - 4.321 * PIXEL;
        let mut winding = vec![vec![0i8; width * height]; layers];
        for t in 0..mesh.triangles.len() {
            stamp(mesh.corners(t).map(|v| v.as_dvec3()), low, [width, height], &slice_z, &mut winding);
        }
        let solid = winding.into_iter().map(|layer| layer.into_iter().map(|w| w != 0).collect()).collect();
        Grid { low, width, height, slice_z, solid }
    }

    /// Marks the pixels whose middles lie in a convex polygon, counter-clockwise or clockwise.
    fn fill(&self, corners: &[DVec2], mask: &mut [bool]) {
        let low = corners.iter().copied().reduce(DVec2::min).expect("corners");
        let high = corners.iter().copied().reduce(DVec2::max).expect("corners");
        let range = |low: f64, high: f64, n: usize| {
            let cut = |v: f64| (v.max(0.0) as usize).min(n);
            cut((low / PIXEL - 0.5).ceil())..cut((high / PIXEL - 0.5).floor() + 1.0)
        };
        for y in range(low.y - self.low.y, high.y - self.low.y, self.height) {
            for x in range(low.x - self.low.x, high.x - self.low.x, self.width) {
                let p = self.low + dvec2(x as f64 + 0.5, y as f64 + 0.5) * PIXEL;
                let n = corners.len();
                let side = |i: usize| (corners[(i + 1) % n] - corners[i]).perp_dot(p - corners[i]);
                if (0..n).all(|i| side(i) >= 0.0) || (0..n).all(|i| side(i) <= 0.0) {
                    mask[y * self.width + x] = true;
                }
            }
        }
    }

    /// B'_k: the layer and everything within the mitred growth of its loops.
    fn permissible(&self, layer: usize, loops: &[Vec<DVec2>], step: f64) -> Vec<bool> {
        let mut mask = self.solid[layer].clone();
        for ring in loops {
            let n = ring.len();
            for i in 0..n {
                let (a, b, c) = (ring[i], ring[(i + 1) % n], ring[(i + 2) % n]);
                let (e, f) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero());
                // Outside is on the right.
                let (m, o) = (dvec2(e.y, -e.x) * step, dvec2(f.y, -f.x) * step);
                // A little of the inside too: the loops are rounded to the engine's grid.
                let inner = m / 64.0;
                self.fill(&[a - inner, b - inner, b + m, a + m], &mut mask);
                if e.perp_dot(f) > 1e-9 {
                    let tip = (m + o) / (1.0 + e.dot(f));
                    let cut =
                        step * (1.0 - ((1.0 + e.dot(f)) / 2.0).sqrt()) / ((1.0 - e.dot(f)) / 2.0).sqrt();
                    if tip.length() <= 5.0 * step {
                        self.fill(&[b, b + m, b + tip, b + o], &mut mask);
                    } else {
                        self.fill(&[b, b + m, b + m + e * cut, b + o - f * cut, b + o], &mut mask);
                    }
                }
            }
        }
        mask
    }

    /// Marks all of `overhang` that hangs together with a pixel outside `reach`, be it by strips thinner than
    /// a pixel, which `beads` follow.
    fn supported(&self, overhang: &[bool], reach: &[bool], beads: &Beads) -> Vec<bool> {
        let mut found = vec![false; overhang.len()];
        let mut open: Vec<usize> = (0..overhang.len()).filter(|&i| overhang[i] && !reach[i]).collect();
        open.iter().for_each(|&i| found[i] = true);
        let mut strung = vec![false; beads.tied.len()];
        while let Some(i) = open.pop() {
            let mut pixels: Vec<usize> = self.around(i).to_vec();
            let mut beads_open = beads.at_pixel(i).to_vec();
            while let Some(bead) = beads_open.pop() {
                if !std::mem::replace(&mut strung[bead], true) {
                    beads_open.extend(beads.tied[bead].into_iter().flatten());
                    pixels.extend(&beads.pixels[bead]);
                }
            }
            for j in pixels {
                if overhang[j] && !found[j] {
                    found[j] = true;
                    open.push(j);
                }
            }
        }
        found
    }

    /// A pixel and its neighbours; the grid has an empty border, so they exist.
    fn around(&self, i: usize) -> [usize; 9] {
        let w = self.width;
        [i, i - 1, i + 1, i - w, i + w, i - w - 1, i - w + 1, i + w - 1, i + w + 1]
    }

    fn middle_of(&self, pixel: usize) -> DVec2 {
        self.low + dvec2((pixel % self.width) as f64 + 0.5, (pixel / self.width) as f64 + 0.5) * PIXEL
    }

    fn pixel_of(&self, p: DVec2) -> usize {
        let at = (p - self.low) / PIXEL;
        at.y as usize * self.width + at.x as usize
    }

    /// Volumes of supports and base, mm3.
    fn volumes(&self, mesh: &Mesh) -> (f64, f64) {
        let loops = slice_loops(mesh, Axis::Z, &self.slice_z);
        let mut region = vec![false; self.width * self.height];
        let mut support = 0;
        for k in (0..self.slice_z.len()).rev() {
            if k + 1 < self.slice_z.len() {
                let (below, above) = (&self.solid[k], &self.solid[k + 1]);
                let rings: Vec<Vec<DVec2>> = loops[k].0.iter().map(|l| l.points.clone()).collect();
                let reach = self.permissible(k, &rings, LAYER);
                let overhang: Vec<bool> = above.iter().zip(below).map(|(a, b)| *a && !b).collect();
                let rings_above: Vec<Vec<DVec2>> = loops[k + 1].0.iter().map(|l| l.points.clone()).collect();
                let hangs = |p: DVec2| winding(&rings_above, p) != 0 && winding(&rings, p) == 0;
                let beads = Beads::new(self, &threads(&rings_above, &rings, hangs), &overhang, hangs);
                let esf = self.supported(&overhang, &reach, &beads);
                region.iter_mut().zip(esf).zip(below).for_each(|((s, e), a)| *s = (*s || e) && !a);
            }
            support += region.iter().filter(|s| **s).count();
        }
        let base = region.iter().zip(&self.solid[0]).filter(|(s, a)| **s || **a).count();
        let pixel = PIXEL * PIXEL * LAYER;
        (support as f64 * pixel, 5.0 * base as f64 * pixel)
    }
}

/// The stretches of both borders along which `above` lies beside them and `below` does not: for each ring
/// points closer than half a pixel, in order, or `None` where there is no overhang.
fn threads(
    above: &[Vec<DVec2>],
    below: &[Vec<DVec2>],
    hangs: impl Fn(DVec2) -> bool,
) -> Vec<Vec<Option<DVec2>>> {
    let hanging = |p: DVec2| hangs(p).then_some(p);
    // The part lies to the left of its rings.
    let along = |ring: &Vec<DVec2>, side: f64| {
        let n = ring.len();
        let mut thread = Vec::new();
        for i in 0..n {
            let (a, b, c) = (ring[i], ring[(i + 1) % n], ring[(i + 2) % n]);
            let [left, next] = [b - a, c - b].map(|v| v.normalize_or_zero().perp() * side * BESIDE);
            let count = (a.distance(b) / (PIXEL / 2.0)).ceil().max(1.0) as u32;
            let shares = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
            thread.extend(shares.map(|share| hanging(a.lerp(b, share) + left)));
            thread.push(hanging(b + (left + next).normalize_or_zero() * BESIDE));
        }
        thread
    };
    let inside = above.iter().map(|ring| along(ring, 1.0));
    inside.chain(below.iter().map(|ring| along(ring, -1.0))).collect()
}

/// How often the rings run around `p`.
fn winding(rings: &[Vec<DVec2>], p: DVec2) -> i32 {
    let edges = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let crossed = |(a, b): (&DVec2, &DVec2)| {
        let right = (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y);
        if right { if b.y > a.y { 1 } else { -1 } } else { 0 }
    };
    edges.map(crossed).sum()
}

/// Points of an overhang along its borders, those next to each other tied.
struct Beads {
    tied: Vec<[Option<usize>; 2]>,
    /// The overhanging pixels beside each that the overhang reaches without a break.
    pixels: Vec<Vec<usize>>,
    by_pixel: std::collections::BTreeMap<usize, Vec<usize>>,
}

impl Beads {
    fn new(
        grid: &Grid,
        threads: &[Vec<Option<DVec2>>],
        overhang: &[bool],
        hangs: impl Fn(DVec2) -> bool,
    ) -> Beads {
        let mut beads = Beads { tied: Vec::new(), pixels: Vec::new(), by_pixel: Default::default() };
        let is_joined = |p: DVec2, pixel: usize| {
            let middle = grid.middle_of(pixel);
            (1..5).all(|k| hangs(p.lerp(middle, f64::from(k) / 5.0)))
        };
        let joined = |p: DVec2| {
            let around = grid.around(grid.pixel_of(p)).into_iter();
            around.filter(|&pixel| overhang[pixel] && is_joined(p, pixel)).collect()
        };
        for thread in threads {
            let numbers: Vec<Option<usize>> =
                thread.iter().map(|p| p.map(|p| beads.add(joined(p)))).collect();
            let n = numbers.len();
            for (i, number) in numbers.iter().enumerate() {
                if let Some(bead) = *number {
                    beads.tied[bead] = [numbers[(i + n - 1) % n], numbers[(i + 1) % n]];
                }
            }
        }
        beads
    }

    fn add(&mut self, pixels: Vec<usize>) -> usize {
        let number = self.tied.len();
        pixels.iter().for_each(|&pixel| self.by_pixel.entry(pixel).or_default().push(number));
        self.pixels.push(pixels);
        self.tied.push([None; 2]);
        number
    }

    fn at_pixel(&self, pixel: usize) -> &[usize] {
        self.by_pixel.get(&pixel).map_or(&[], Vec::as_slice)
    }
}

/// Adds the triangle to the winding number of every pixel and layer below it.
fn stamp(
    [a, b, c]: [glam::DVec3; 3],
    low: DVec2,
    [width, height]: [usize; 2],
    slice_z: &[f64],
    winding: &mut [Vec<i8>],
) {
    let twice = (b - a).truncate().perp_dot((c - a).truncate());
    if twice == 0.0 {
        return;
    }
    let box_low = ((a.min(b).min(c).truncate() - low) / PIXEL - 0.5).ceil().max(DVec2::ZERO);
    let box_high = ((a.max(b).max(c).truncate() - low) / PIXEL - 0.5).floor();
    for y in box_low.y as usize..=(box_high.y.max(0.0) as usize).min(height - 1) {
        for x in box_low.x as usize..=(box_high.x.max(0.0) as usize).min(width - 1) {
            let p = low + dvec2(x as f64 + 0.5, y as f64 + 0.5) * PIXEL;
            let share =
                |q: glam::DVec3, r: glam::DVec3| (q.truncate() - p).perp_dot(r.truncate() - p) / twice;
            let (u, v, w) = (share(b, c), share(c, a), share(a, b));
            if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                let z = u * a.z + v * b.z + w * c.z;
                let below = slice_z.partition_point(|&h| h < z);
                winding[..below].iter_mut().for_each(|layer| layer[y * width + x] += twice.signum() as i8);
            }
        }
    }
}

fn models() -> Vec<(&'static str, Mesh)> {
    let scaled = |mut mesh: Mesh, by: f32| {
        mesh.vertices.iter_mut().for_each(|v| *v *= by);
        mesh
    };
    let t = [
        [0.0, 15.0],
        [7.0, 15.0],
        [7.0, 0.0],
        [12.0, 0.0],
        [12.0, 15.0],
        [19.0, 15.0],
        [19.0, 19.0],
        [0.0, 19.0],
    ];
    let l = [[0.0, 0.0], [18.0, 0.0], [18.0, 5.0], [6.0, 5.0], [6.0, 16.0], [0.0, 16.0]];
    let arch = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 9.0],
        [14.0, 9.0],
        [14.0, 0.0],
        [18.0, 0.0],
        [18.0, 13.0],
        [0.0, 13.0],
    ];
    vec![
        ("box", cuboid([0.0; 3], [10.0, 14.0, 18.0])),
        ("part model 1", scaled(part_model_1(), 0.5)),
        ("T", prism(&t, 9.0)),
        ("L", prism(&l, 8.0)),
        ("arch", prism(&arch, 7.0)),
        ("frustum", frustum(4.0, 9.0, 12.0)),
        ("octahedron", octahedron(10.0)),
        ("hollow", together(&[cuboid([0.0; 3], [16.0; 3]), inside_out(cuboid([4.0; 3], [12.0; 3]))])),
        (
            "cross",
            together(&[
                cuboid([0.0, 6.0, 6.0], [20.0, 12.0, 12.0]),
                cuboid([7.0, 0.0, 5.0], [13.0, 18.0, 13.0]),
            ]),
        ),
        ("ball", bumpy_ball(9.0, 0.1, 24)),
    ]
}

/// Random turns by seed.
const SEEDS: [u64; 6] = [1, 2, 3, 4, 5, 6];

#[test]
fn volumes_agree_with_the_pixels_within_3_percent() {
    let long = std::env::var_os("FOOTHOLD_LONG").is_some();
    let options = OrientationOptions { layer_height: LAYER, ..OrientationOptions::default() };
    let mut wrong: Vec<String> = Vec::new();
    for seed in SEEDS.into_iter().take(if long { SEEDS.len() } else { 1 }) {
        let mut random = random_from(seed);
        for (i, (name, mesh)) in models().into_iter().enumerate() {
            let mesh = rotated(&mesh, random_rotation(&mut random));
            if !long && i % 3 != 1 {
                continue;
            }
            let fast = evaluate(&mesh, &six()[0], &options, &mut |_, _| true).expect("the model is sound");
            let (support, base) = Grid::new(&mesh).volumes(&mesh);
            println!(
                "{name}: support {:.1}, pixels {support:.1}; base {:.1}, {base:.1}",
                fast.support_mm3, fast.base_mm3
            );
            let agree = |found: f64, pixels: f64| (found - pixels).abs() <= 0.03 * pixels;
            if !agree(fast.support_mm3, support) || !agree(fast.base_mm3, base) {
                wrong.push(format!("{name} by seed {seed}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
