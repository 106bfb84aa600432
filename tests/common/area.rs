//! Areas by other means than the slicer's own: crate `i_overlay`, and the cut of a mesh without chains.

// Each test binary includes this file and uses a part of it.
#![allow(dead_code, unreachable_pub)]

use foothold::mesh::Mesh;
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

/// Shapes; each is an outline and its holes.
pub type Area = Vec<Vec<Vec<[f64; 2]>>>;

/// The cut of a mesh at a height: where its triangles wind round at least once.
///
/// No contour is chained. Each cut triangle gives a directed edge, each edge a triangle with a fixed
/// point; the windings of those add up to the winding of the closed outline.
pub fn section(mesh: &Mesh, z: f64) -> Area {
    let cuts: Vec<[DVec2; 2]> = (0..mesh.triangles.len()).filter_map(|t| cut(mesh, t, z)).collect();
    let Some(pivot) = cuts.first().map(|c| c[0]) else { return Area::new() };
    let fan: Vec<Vec<[f64; 2]>> = cuts
        .iter()
        .filter(|c| c[0] != c[1] && (c[0] - pivot).perp_dot(c[1] - pivot) != 0.0)
        .map(|c| vec![pivot.to_array(), c[0].to_array(), c[1].to_array()])
        .collect();
    fan.simplify_shape(FillRule::NonZero)
}

/// Where the plane cuts a triangle; the part lies to the left.
fn cut(mesh: &Mesh, triangle: usize, z: f64) -> Option<[DVec2; 2]> {
    let corners = mesh.triangles[triangle].map(|v| mesh.vertices[v as usize].as_dvec3());
    let mut ends: [Option<DVec2>; 2] = [None, None];
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let goes_up = a.z < z && b.z >= z;
        if goes_up || (b.z < z && a.z >= z) {
            let (low, high) = if goes_up { (a, b) } else { (b, a) };
            let at = low.truncate() + (high - low).truncate() * ((z - low.z) / (high.z - low.z));
            // Seen from outside the part, the edge runs from where the outline rises to where it falls.
            ends[usize::from(goes_up)] = Some(at);
        }
    }
    Some([ends[0]?, ends[1]?])
}

pub fn offset(area: &Area, by: f64) -> Area {
    let style = OutlineStyle::new(by).line_join(LineJoin::Round(0.1));
    area.outline(&style)
}

/// What discs of this radius inside the area reach. The library's offsets leave thin spikes beside
/// round outlines, up to 0.1 mm long; an opening lies within its area.
pub fn opened(area: &Area, by: f64) -> Area {
    offset(&offset(area, -by), by).overlay(area, OverlayRule::Intersect, FillRule::NonZero)
}

pub fn size(area: &Area) -> f64 {
    let signed = |ring: &Vec<[f64; 2]>| {
        let n = ring.len();
        let cross = |i: usize| ring[i][0] * ring[(i + 1) % n][1] - ring[i][1] * ring[(i + 1) % n][0];
        (0..n).map(cross).sum::<f64>() / 2.0
    };
    area.iter().flatten().map(signed).sum::<f64>().abs()
}

pub fn difference(a: &Area, b: &Area) -> Area {
    a.overlay(b, OverlayRule::Difference, FillRule::NonZero)
}

/// The union of rings.
pub fn united(rings: Vec<Vec<[f64; 2]>>) -> Area {
    rings.simplify_shape(FillRule::NonZero)
}

/// All edges, the area to their left.
pub fn edges(area: &Area) -> Vec<[DVec2; 2]> {
    let of_ring = |ring: &Vec<[f64; 2]>| -> Vec<[DVec2; 2]> {
        (0..ring.len()).map(|i| [ring[i].into(), ring[(i + 1) % ring.len()].into()]).collect()
    };
    area.iter().flatten().flat_map(of_ring).collect()
}

/// Whether the area holds a point.
pub fn holds(area: &Area, p: DVec2) -> bool {
    let crosses = |[a, b]: &[DVec2; 2]| {
        (a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y) > p.x
    };
    edges(area).iter().filter(|e| crosses(e)).count() % 2 == 1
}
