//! How much of the part's surface supports touch from below and from above.

use glam::DVec3;

use super::layers::LayerStack;
use crate::mesh::Mesh;
use crate::polygon::DVec2;

/// Facets are looked at in patches of about this area, mm2, each touched wholly or not at all.
const PATCH_MM2: f64 = 1.0;

/// At most this many patches along a facet's side, so that huge facets stay cheap.
const MOST_PATCHES: f64 = 32.0;

/// A patch of the surface that a support may touch.
#[derive(Debug, Clone, Copy)]
struct Patch {
    at: DVec2,
    area_mm2: f64,
}

/// The patches of a turned mesh, by the run of layers whose support could touch them.
#[derive(Debug)]
pub(super) struct Scars {
    /// Of each run.
    patches: Vec<Vec<Patch>>,
    touched_mm2: f64,
}

impl Scars {
    /// Facets that look down are touched by the support of the layer below them, those that look
    /// up by that of the layer above. Vertical walls are not: supports keep a distance sideways.
    pub(super) fn new(mesh: &Mesh, stack: &LayerStack) -> Scars {
        let mut patches = vec![Vec::new(); stack.runs.len()];
        for t in 0..mesh.triangles.len() {
            let corners = mesh.corners(t).map(|v| v.as_dvec3());
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            if normal.z != 0.0 {
                add_facet(corners, normal, stack, &mut patches);
            }
        }
        Scars { patches, touched_mm2: 0.0 }
    }

    /// Looks at the patches of a run, once; `supports` tells whether a point lies in its support region.
    pub(super) fn look(&mut self, run: usize, supports: impl Fn(DVec2) -> bool) {
        let patches = std::mem::take(&mut self.patches[run]);
        let touched = patches.iter().filter(|patch| supports(patch.at));
        self.touched_mm2 += touched.map(|patch| patch.area_mm2).sum::<f64>();
    }

    /// Surface touched so far, mm2.
    pub(super) fn touched_mm2(&self) -> f64 {
        self.touched_mm2
    }
}

fn add_facet(corners: [DVec3; 3], normal: DVec3, stack: &LayerStack, patches: &mut [Vec<Patch>]) {
    let area = normal.length() / 2.0;
    let n = (area / PATCH_MM2).sqrt().ceil().clamp(1.0, MOST_PATCHES) as usize;
    let [a, along, across] = [corners[0], corners[1] - corners[0], corners[2] - corners[0]];
    let middle = |i: usize, j: usize, third: f64| {
        a + along * ((i as f64 + third) / n as f64) + across * ((j as f64 + third) / n as f64)
    };
    // n rows of triangles pointing one way, and n - 1 of those between them.
    let upright = (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j, 1.0 / 3.0)));
    let between = (1..n).flat_map(|i| (0..n - i).map(move |j| (i - 1, j, 2.0 / 3.0)));
    for (i, j, third) in upright.chain(between) {
        let at = middle(i, j, third);
        // The first plane above the patch.
        let above = stack.planes_up_to(at.z);
        let layer = if normal.z < 0.0 { above.checked_sub(1) } else { Some(above) };
        if let Some(layer) = layer.filter(|&layer| layer < stack.slice_z.len()) {
            let patch = Patch { at: at.truncate(), area_mm2: area / (n * n) as f64 };
            patches[stack.run_of(layer)].push(patch);
        }
    }
}
