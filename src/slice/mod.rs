//! A mesh cut by planes: closed contours in the plane, united into areas.
//!
//! A vertex exactly in a plane counts as above it, so every plane is cut as if it lay an
//! infinitesimal step lower: faces and vertices in the plane need no special case, and no contour
//! is missed or doubled.

mod adaptive;
pub mod axis;
pub mod chain;
pub mod heights;
pub mod section;

pub use axis::Axis;
pub use chain::{Gap, Loop};
pub use heights::{LayerOptions, LayerSpec};

use crate::mesh::Mesh;
use crate::polygon::simplify::simplify_ring;
use crate::polygon::{Contour, PolygonSet};

/// What is printed at one height.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Where the layer is cut and printed.
    pub spec: LayerSpec,
    /// The part's section at `spec.slice_z`, mm.
    pub area: PolygonSet,
}

/// The cut of one plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Everything inside the mesh; overlapping shells are united.
    pub area: PolygonSet,
    /// Openings of the mesh that had to be closed to get closed contours.
    pub gaps: Vec<Gap>,
}

/// Cuts the mesh by the planes `axis = heights[i]`, heights ascending, mm.
///
/// `resolution` is the distance, mm, by which a contour may be simplified before shells are
/// united; 0 keeps every vertex of the exact section (snapped to the polygon grid).
pub fn slice_mesh(mesh: &Mesh, axis: Axis, heights: &[f64], resolution: f64) -> Vec<Section> {
    let all = 0..mesh.triangles.len() as u32;
    slice_triangles(mesh, all, axis, heights, resolution)
}

/// Like [`slice_mesh`] for some of the mesh's triangles: all that cross the planes must be among
/// them, and they must come in mesh order.
pub fn slice_triangles(
    mesh: &Mesh,
    triangles: impl Iterator<Item = u32> + Clone,
    axis: Axis,
    heights: &[f64],
    resolution: f64,
) -> Vec<Section> {
    let sections = loops_of(mesh, triangles, axis, heights).into_iter();
    sections.map(|(loops, gaps)| Section { area: unite(loops, resolution), gaps }).collect()
}

/// The loops of each plane before shells are united, every edge with the triangle it was cut from.
pub fn slice_loops(mesh: &Mesh, axis: Axis, heights: &[f64]) -> Vec<(Vec<Loop>, Vec<Gap>)> {
    loops_of(mesh, 0..mesh.triangles.len() as u32, axis, heights)
}

fn loops_of(
    mesh: &Mesh,
    triangles: impl Iterator<Item = u32> + Clone,
    axis: Axis,
    heights: &[f64],
) -> Vec<(Vec<Loop>, Vec<Gap>)> {
    let crossings = section::Crossings::find(mesh, axis, heights, triangles);
    let mut chainer = chain::Chainer::default();
    let cut =
        |(i, &height): (usize, &f64)| chainer.chain(&section::cut(mesh, axis, height, crossings.of_plane(i)));
    heights.iter().enumerate().map(cut).collect()
}

fn unite(loops: Vec<Loop>, resolution: f64) -> PolygonSet {
    let contours = loops.into_iter().map(|l| {
        let contour = Contour::new(l.points);
        if resolution > 0.0 { simplify_ring(&contour, resolution) } else { contour }
    });
    PolygonSet::from_contours(contours.collect())
}
