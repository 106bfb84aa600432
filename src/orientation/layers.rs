//! Uniform layers of a turned part, those with one and the same section taken together.

use std::ops::Range;

use crate::mesh::Mesh;
use crate::slice::LayerOptions;
use crate::slice::heights::plan_layers;
use crate::sort::StableSort;

/// Where the layers are cut, and which of them share a section.
#[derive(Debug)]
pub(super) struct LayerStack {
    /// Height of the part, mm.
    pub(super) height: f64,
    /// Planes of the cuts in the turned mesh's own z, ascending, mm.
    pub(super) slice_z: Vec<f64>,
    /// Neighbouring layers with one section, from the bed up.
    pub(super) runs: Vec<Range<usize>>,
    /// The run of each layer.
    run_of: Vec<u32>,
}

impl LayerStack {
    /// Layers of `layer_height` mm from the part's lowest point up, cut at their middles.
    pub(super) fn new(mesh: &Mesh, layer_height: f64) -> LayerStack {
        let heights = || mesh.triangles.iter().flatten().map(|&v| f64::from(mesh.vertices[v as usize].z));
        let bottom = heights().fold(f64::INFINITY, f64::min);
        let height = (heights().fold(f64::NEG_INFINITY, f64::max) - bottom).max(0.0);
        let options =
            LayerOptions { height: layer_height, first_height: layer_height, ..LayerOptions::default() };
        let slice_z: Vec<f64> =
            plan_layers(height, &options).iter().map(|layer| bottom + layer.slice_z).collect();
        let runs = runs_between(&changes(mesh, &slice_z));
        let numbered = runs.iter().zip(0..).flat_map(|(run, number)| run.clone().map(move |_| number));
        let run_of = numbered.collect();
        LayerStack { height, slice_z, runs, run_of }
    }

    /// The run that the layer belongs to.
    pub(super) fn run_of(&self, layer: usize) -> usize {
        self.run_of[layer] as usize
    }

    /// How many planes lie at `z` or below.
    pub(super) fn planes_up_to(&self, z: f64) -> usize {
        planes_up_to(&self.slice_z, z)
    }
}

/// The triangles that cross the planes of one batch of runs after the other, from the top down.
#[derive(Debug)]
pub(super) struct Crossing {
    /// The lowest batch that each triangle crosses.
    lowest: Vec<u32>,
    /// The triangles whose highest batch it is.
    highest: Vec<Vec<u32>>,
    /// Those that cross the batch asked for last.
    current: Vec<u32>,
}

impl Crossing {
    /// Above the topmost of batches of so many runs.
    pub(super) fn new(mesh: &Mesh, stack: &LayerStack, runs_a_batch: usize) -> Crossing {
        let mut lowest = vec![0; mesh.triangles.len()];
        let mut highest = vec![Vec::new(); stack.runs.len().div_ceil(runs_a_batch)];
        for (t, triangle) in (0..).zip(&mesh.triangles) {
            let planes = triangle.map(|v| stack.planes_up_to(f64::from(mesh.vertices[v as usize].z)));
            let (low, high) =
                (planes[0].min(planes[1]).min(planes[2]), planes[0].max(planes[1]).max(planes[2]));
            if low < high {
                lowest[t as usize] = (stack.run_of(low) / runs_a_batch) as u32;
                highest[stack.run_of(high - 1) / runs_a_batch].push(t);
            }
        }
        Crossing { lowest, highest, current: Vec::new() }
    }

    /// Those of the next batch, in mesh order.
    pub(super) fn next(&mut self) -> &[u32] {
        let batch = self.highest.len() - 1;
        self.current.retain(|&t| self.lowest[t as usize] as usize <= batch);
        self.current.extend(self.highest.pop().unwrap_or_default());
        self.current.stable_sort_by_key(|&t| t);
        &self.current
    }
}

/// How many of the planes lie at `z` or below: guessed, as they are evenly spaced, and put right.
fn planes_up_to(slice_z: &[f64], z: f64) -> usize {
    let n = slice_z.len();
    let [first, .., last] = *slice_z else { return slice_z.partition_point(|&h| h <= z) };
    // Far below and above, the cast ends at 0 and n.
    let mut found = (((z - first) / (last - first) * (n - 1) as f64) as usize).min(n);
    while found > 0 && slice_z[found - 1] > z {
        found -= 1;
    }
    while found < n && slice_z[found] <= z {
        found += 1;
    }
    found
}

/// Whether the section at plane k may differ from the one below it: a vertex lies between the two
/// planes, or a facet that is not vertical crosses both.
fn changes(mesh: &Mesh, slice_z: &[f64]) -> Vec<bool> {
    let n = slice_z.len();
    // The first plane above a vertex; a vertex in a plane counts as above it, as for the cuts.
    let plane_above = |z: f32| planes_up_to(slice_z, f64::from(z));
    let mut starts = vec![0i32; n + 1];
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        let planes = corners.map(|v| plane_above(v.z));
        let (low, high) = (planes[0].min(planes[1]).min(planes[2]), planes[0].max(planes[1]).max(planes[2]));
        let vertical = {
            let [a, b, c] = corners.map(|v| v.as_dvec3().truncate());
            (b - a).perp_dot(c - a) == 0.0
        };
        if vertical {
            planes.iter().filter(|&&p| p < n).for_each(|&p| {
                starts[p] += 1;
                starts[p + 1] -= 1;
            });
        } else if low < n {
            starts[low] += 1;
            starts[n.min(high + 1)] -= 1;
        }
    }
    starts.truncate(n);
    starts
        .iter()
        .scan(0, |open, start| {
            *open += start;
            Some(*open > 0)
        })
        .collect()
}

fn runs_between(changes: &[bool]) -> Vec<Range<usize>> {
    let starts: Vec<usize> = (0..changes.len()).filter(|&k| k == 0 || changes[k]).collect();
    let ends = starts.iter().skip(1).copied().chain([changes.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    /// A tetrahedron on a vertical stick: facets from z = 10 to 20 lean, those below stand.
    fn mesh(top: f32) -> Mesh {
        let ring = |z: f32, r: f32| [vec3(r, 0.0, z), vec3(-r, r, z), vec3(-r, -r, z)];
        let vertices = [ring(0.0, 1.0), ring(10.0, 1.0), ring(20.0, top)].concat();
        let side = |low: u32, i: u32| {
            let (a, b) = (low + i, low + (i + 1) % 3);
            [[a, b, b + 3], [a, b + 3, a + 3]]
        };
        let mut triangles = vec![[2, 1, 0], [6, 7, 8]];
        triangles.extend((0..3).flat_map(|i| side(0, i)));
        triangles.extend((0..3).flat_map(|i| side(3, i)));
        Mesh { vertices, triangles }
    }

    #[test]
    fn a_prism_is_one_run() {
        let stack = LayerStack::new(&mesh(1.0), 0.01);
        assert_eq!(stack.slice_z.len(), 2000);
        // Vertices half-way up start a run of the same section.
        assert_eq!(stack.runs, [0..1000, 1000..2000]);
        assert_eq!((stack.run_of(999), stack.run_of(1000)), (0, 1));
    }

    #[test]
    fn leaning_facets_change_every_layer() {
        let stack = LayerStack::new(&mesh(3.0), 1.0);
        assert_eq!(stack.runs[0], 0..10);
        assert_eq!(stack.runs.len(), 11);
    }

    #[test]
    fn triangles_come_with_every_batch_they_cross() {
        let mesh = mesh(3.0);
        let stack = LayerStack::new(&mesh, 1.0);
        assert_eq!(stack.runs.len(), 11);
        // Runs 8 to 10, 4 to 7, then 0 to 3, which hold all of the stick.
        let mut crossing = Crossing::new(&mesh, &stack, 4);
        assert_eq!(crossing.next(), [8, 9, 10, 11, 12, 13]);
        assert_eq!(crossing.next(), [8, 9, 10, 11, 12, 13]);
        assert_eq!(crossing.next(), [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]);
    }

    #[test]
    fn a_part_that_hangs_below_zero_is_cut_from_its_own_bottom() {
        let mut low = mesh(1.0);
        low.vertices.iter_mut().for_each(|v| v.z -= 7.3);
        let stack = LayerStack::new(&low, 0.2);
        assert!((stack.slice_z[0] + 7.2).abs() < 1e-6);
        assert_eq!(stack.slice_z.len(), 100);
    }
}
