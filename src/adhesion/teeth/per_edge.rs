//! Teeth edge by edge, [Lv 2022] section 2.4 to the letter: to learn from, not to print with.
//!
//! Its flaws are kept, with tests: the last tooth of every edge stands on the rail's corner and may
//! point past the part; an edge shorter than the pitch gets none, so a finely tessellated circle
//! has no teeth at all; tips may cross a neighbouring wall.

use super::simplify::{Limits, simplify_closed};
use super::{PlacedTooth, Rail, Site, Tooth};
use crate::polygon::{Contour, DVec2, PolygonSet};

/// How far from an edge's middle eq. (13) and (14) ask which side is inside, mm.
const SIDE_PROBE_MM: f64 = 1e-3;

/// Rails with the teeth of each edge, in order along the path.
pub(super) fn place(site: &Site, rails: &PolygonSet) -> Vec<(Rail, Vec<PlacedTooth>)> {
    let limits = Limits { length: site.options.simplify_length, height: site.options.simplify_height };
    let wanted = rails.contours().iter().filter(|c| site.options.holes || c.signed_area() > 0.0);
    let with_teeth = |(index, ring): (usize, &Contour)| {
        let rail = Rail::new(simplify_closed(ring, limits).points);
        let placed = |(start, from, to)| {
            teeth_of_edge(site, rails, from, to).into_iter().map(move |tooth| PlacedTooth {
                tooth,
                rail: index,
                from: start + from.distance(tooth.a),
                to: start + from.distance(tooth.b),
            })
        };
        let teeth = rail.edges().flat_map(placed).collect();
        (rail, teeth)
    };
    wanted.enumerate().map(with_teeth).collect()
}

/// N = floor(|A'B'| / d2) teeth on the edge from A' to B' [eq. 15-17]:
/// s = (B' - A') / N, A_i = A' + (i - 1) s + s (d2 - d1) / d2, B_i = A' + i s, and C_i is the middle
/// of A_i and B_i moved by H to the inside.
///
/// Eq. (17) is garbled in print (two cases for y, one with x); this normal form is what it means.
/// The base comes out as |s| d1 / d2, not d1.
fn teeth_of_edge(site: &Site, rails: &PolygonSet, from: DVec2, to: DVec2) -> Vec<Tooth> {
    let count = (from.distance(to) / site.options.pitch).floor();
    if count < 1.0 {
        return Vec::new();
    }
    let step = (to - from) / count;
    let inward = inward_normal(rails, from, to);
    let gap = step * ((site.options.pitch - site.options.base) / site.options.pitch);
    let tooth = |i: u32| {
        let (a, b) = (from + step * f64::from(i) + gap, from + step * f64::from(i + 1));
        let middle = (a + b) / 2.0;
        site.measured(Tooth {
            a,
            tip: middle + inward * site.options.height,
            b,
            foot: middle + inward * site.options.offset,
            bite: 0.0,
            shallow: false,
        })
    };
    (0..count as u32).map(tooth).collect()
}

/// The unit normal that leads inside, chosen by ray casting [eq. 13, 14, half-open].
fn inward_normal(rails: &PolygonSet, from: DVec2, to: DVec2) -> DVec2 {
    let normal = (to - from).perp().normalize_or_zero();
    let middle = (from + to) / 2.0;
    if rails.contains(middle + normal * SIDE_PROBE_MM) { normal } else { -normal }
}
