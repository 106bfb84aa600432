//! Layer heights that follow the surface: thin where it is nearly flat, thick where it is steep.
//!
//! On a surface at the angle a to the bed neighbouring layers of height h are h / tan a apart: the
//! stairs that one sees. The height is chosen so that they are no wider than a threshold anywhere
//! in the layer (Cura's "adaptive layers" by their topography size; the cusp height of Dolenc and
//! Makela, "Slicing procedures for layered manufacturing techniques", 1994, is the like measured
//! across the surface). Level facets have no stairs and do not count.
//!
//! Heights are whole multiples of [`STEP`], counted in integers: the same everywhere, and z never
//! drifts.

use super::LayerOptions;
use super::heights::LayerSpec;
use crate::mesh::Mesh;
use crate::sort::StableSort;
use glam::DVec3;

/// Step of heights, mm.
const STEP: f64 = 0.01;

/// Facets that rise by less than this share of their width are level: no height would help, and one
/// of them must not thin a whole layer. Tangent of 1 degree.
const LEVEL: f64 = 0.017_455;

/// Layers of a part that stands on the bed, each as high as the surface beside it allows.
pub(super) fn plan_adaptive(mesh: &Mesh, part_height: f64, options: &LayerOptions) -> Vec<LayerSpec> {
    let limits = Limits::of(mesh, part_height, options);
    let first_height = options.first_height;
    let mut layers = vec![LayerSpec {
        index: 0,
        slice_z: first_height.min(part_height) / 2.0,
        print_z: first_height,
        height: first_height,
    }];
    let mut bottom = 0;
    let mut last = steps(first_height).max(limits.least);
    loop {
        let height = limits.height_at(bottom).min((last + limits.change).max(limits.least));
        let print_z = first_height + (bottom + height) as f64 * STEP;
        let slice_z = print_z - height as f64 * STEP / 2.0;
        if slice_z >= part_height {
            return layers;
        }
        layers.push(LayerSpec { index: layers.len() as u32, slice_z, print_z, height: height as f64 * STEP });
        (bottom, last) = (bottom + height, height);
    }
}

/// mm in steps, to the nearest.
fn steps(length: f64) -> usize {
    (length / STEP).round() as usize
}

/// Highest layer allowed at each height of the part.
struct Limits {
    /// In steps, for each step above the first layer.
    allowed: Vec<usize>,
    least: usize,
    most: usize,
    /// By how much neighbouring layers may differ.
    change: usize,
}

impl Limits {
    fn of(mesh: &Mesh, part_height: f64, options: &LayerOptions) -> Limits {
        let [least, most, change] =
            [options.min_height, options.max_height, options.max_height_change].map(|l| steps(l).max(1));
        let count = ((part_height - options.first_height).max(0.0) / STEP).ceil() as usize;
        let mut slopes = slopes_of(mesh, options, most);
        slopes.stable_sort_by_key(|s| s.allowed);
        let mut limits = Limits { allowed: vec![most; count], least, most: most.max(least), change };
        limits.paint(&slopes);
        limits.smooth();
        limits
    }

    /// Gives each step the lowest limit of the facets there; `slopes` come lowest first, so that a
    /// step is painted once. `next[i]` leads to the first step from i on that is not yet painted.
    fn paint(&mut self, slopes: &[Slope]) {
        let count = self.allowed.len();
        let mut next: Vec<usize> = (0..=count).collect();
        for slope in slopes {
            let mut i = unpainted(&mut next, slope.from.min(count));
            while i < slope.to.min(count) {
                self.allowed[i] = slope.allowed.max(self.least);
                next[i] = i + 1;
                i = unpainted(&mut next, i + 1);
            }
        }
    }

    /// Lets the limit rise and fall by no more than `change` from layer to layer: within a layer of
    /// height h it may change by `change`, so by change / h from step to step.
    fn smooth(&mut self) {
        let mut levels: Vec<f64> = self.allowed.iter().map(|&a| a as f64).collect();
        let change = self.change as f64;
        for i in (0..levels.len().saturating_sub(1)).rev() {
            levels[i] = levels[i].min(levels[i + 1] + change / levels[i + 1]);
        }
        self.allowed = levels.into_iter().map(|l| (l.floor() as usize).max(self.least)).collect();
    }

    /// Highest layer that keeps the limit of every step in it, from this step up.
    fn height_at(&self, bottom: usize) -> usize {
        let mut height = self.most;
        let mut up = 0;
        while up < height {
            height = height.min(self.allowed.get(bottom + up).copied().unwrap_or(self.most)).max(self.least);
            up += 1;
        }
        height
    }
}

/// The first step from `i` on that is not painted; shortens the chain on the way.
fn unpainted(next: &mut [usize], mut i: usize) -> usize {
    while next[i] != i {
        next[i] = next[next[i]];
        i = next[i];
    }
    i
}

/// The heights between which a facet lies, and the limit that it sets, all in steps.
struct Slope {
    from: usize,
    to: usize,
    allowed: usize,
}

/// Facets that allow less than `most`.
fn slopes_of(mesh: &Mesh, options: &LayerOptions, most: usize) -> Vec<Slope> {
    let slope_of = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|v| v.as_dvec3());
        let normal: DVec3 = (b - a).cross(c - a);
        // Tangent of the angle to the bed.
        let tangent = normal.truncate().length() / normal.z.abs();
        let allowed = tangent * options.adaptive_threshold / STEP;
        if tangent < LEVEL || allowed.is_nan() || allowed >= most as f64 {
            return None;
        }
        let above_first = |z: f64| ((z - options.first_height) / STEP).max(0.0);
        let from = above_first(a.z.min(b.z).min(c.z)).floor() as usize;
        let to = above_first(a.z.max(b.z).max(c.z)).ceil() as usize;
        Some(Slope { from, to, allowed: allowed.floor() as usize })
    };
    (0..mesh.triangles.len()).filter_map(slope_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, vec3};

    /// A roof along y, 40 mm wide and `rise` mm high.
    fn roof(rise: f32) -> Mesh {
        let vertices = [-20.0, 20.0]
            .iter()
            .flat_map(|&y: &f32| [vec3(-20.0, y, 0.0), vec3(20.0, y, 0.0), vec3(0.0, y, rise)]);
        let triangles =
            vec![[0, 1, 2], [3, 5, 4], [0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5], [2, 5, 0], [0, 5, 3]];
        Mesh { vertices: vertices.collect::<Vec<Vec3>>(), triangles }
    }

    fn heights(mesh: &Mesh, height: f64, change: &LayerOptions) -> Vec<f64> {
        let layers = plan_adaptive(mesh, height, change);
        for (below, above) in layers.iter().zip(&layers[1..]) {
            assert!((above.print_z - above.height - below.print_z).abs() < 1e-9, "{below:?} {above:?}");
            assert!((above.slice_z - (above.print_z - above.height / 2.0)).abs() < 1e-9);
            assert_eq!(above.index, below.index + 1);
        }
        layers.iter().map(|l| (l.height * 1000.0).round() / 1000.0).collect()
    }

    fn options() -> LayerOptions {
        LayerOptions { adaptive: true, first_height: 0.2, ..LayerOptions::default() }
    }

    #[test]
    fn a_roof_of_30_degrees_gets_layers_of_the_threshold_times_its_tangent() {
        // tan = 11.547 / 20 = 0.57735; 0.2 mm of it are 0.11547, in steps 0.11 mm.
        let found = heights(&roof(11.547), 11.547, &options());
        assert_eq!(found[0], 0.2);
        assert!(found[1..].iter().all(|&h| h == 0.11), "{found:?}");
    }

    #[test]
    fn upright_walls_get_the_highest_layers_and_flat_roofs_the_lowest() {
        // tan = 60 / 20 = 3: 0.6 mm, more than the highest of 0.28.
        let steep = heights(&roof(60.0), 60.0, &options());
        assert_eq!(steep.last(), Some(&0.28));
        // From 0.2 it rises by 0.04 at most.
        assert_eq!(&steep[..4], [0.2, 0.24, 0.28, 0.28]);
        // tan = 0.1: 0.02 mm, less than the lowest of 0.08.
        let flat = heights(&roof(2.0), 2.0, &options());
        assert!(flat[1..].iter().all(|&h| h == 0.08), "{flat:?}");
    }

    #[test]
    fn heights_come_down_before_a_flat_place_and_keep_the_sum() {
        // An upright block of 10 mm under a roof of 5.7 degrees.
        let mut mesh = roof(2.0);
        mesh.vertices.iter_mut().for_each(|v| v.z += 10.0);
        let walls = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
        let base = mesh.vertices.len() as u32;
        mesh.vertices.extend([0.0, 10.0].iter().flat_map(|&z: &f32| walls.map(|[x, y]| vec3(x, y, z))));
        for i in 0..4 {
            let j = (i + 1) % 4;
            mesh.triangles
                .extend([[base + i, base + j, base + j + 4], [base + i, base + j + 4, base + i + 4]]);
        }
        let found = heights(&mesh, 12.0, &options());
        assert!(found.contains(&0.28) && found.last() == Some(&0.08));
        for pair in found.windows(2) {
            assert!((pair[1] - pair[0]).abs() < 0.061, "{found:?}");
        }
        let z = |k: usize| found[..k].iter().sum::<f64>();
        let thin = found.iter().position(|&h| h == 0.08).expect("thin layers");
        assert!((9.5..=10.0 + 1e-9).contains(&z(thin)), "{}", z(thin));
    }
}
