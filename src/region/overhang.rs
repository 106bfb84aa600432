//! Permissible overhang (POA) and externally supported features (ESF) of one layer over another.
//!
//! Source: [Karim] K. F. Karim et al., "Feature-Based Support Generation for Optimum Part
//! Deposition Orientation in FDM", equations (2) to (8). Plate supports share [`need`].

use super::reach::Reach;
use crate::polygon::groups::groups_of;
use crate::polygon::island::{Island, inner_point};
use crate::polygon::measure::Bounds;
use crate::polygon::trig::tan;
use crate::polygon::{Join, PolygonSet};

/// Growth is mitred: round joins would let the corners of a frustum that holds itself poke out.
const MITRE: Join = Join::Mitre { limit: MITRE_LIMIT };

/// See [`MITRE`].
const MITRE_LIMIT: f64 = 5.0;

/// What snapping may add to the step between two contours, mm: half a grid diagonal for each of
/// the two sections and for the grown one. Without it a wall that leans by exactly the self-support
/// angle would need support by rounding.
const SNAP_SLACK_MM: f64 = 2e-4;

/// How far a layer of this height may reach past the one below, mm: t tan(alpha), with alpha
/// measured from the vertical.
pub fn permissible_step(layer_height: f64, angle_deg: f64) -> f64 {
    layer_height * tan(angle_deg.to_radians())
}

/// POA ([Karim] eq. 2-4): B'_k, the layer grown by `step` mm, outer rings outward, holes inward.
///
/// *Erratum*: the determinant in the printed offset formula must be
/// `x_i y_(i+1) - x_(i+1) y_i`, (x, y) being the directions of the two edges at a vertex.
pub fn permissible_overhang(layer: &PolygonSet, step: f64) -> PolygonSet {
    layer.offset(step + SNAP_SLACK_MM, MITRE)
}

/// ESF ([Karim] eq. 5-8): the connected components of `above - below` that reach outside the
/// permissible overhang of `below`. The whole component needs support, taken without growth.
pub fn externally_supported(above: &PolygonSet, below: &PolygonSet, step: f64) -> PolygonSet {
    if above == below || above.is_empty() {
        return PolygonSet::EMPTY;
    }
    let reach = Reach::new(below, step + SNAP_SLACK_MM, MITRE_LIMIT);
    let groups = above.grouped_with(below).into_iter();
    let reaching = groups.filter(|[above, _]| !above.is_empty() && !reach.holds(above));
    let overhang = reaching.flat_map(|[above, below]| above.difference(&below).into_contours());
    let overhang = PolygonSet::canonical(overhang.collect());
    if overhang.is_empty() {
        return overhang;
    }
    let islands = Island::all_of(&overhang);
    let mut reaching: Vec<bool> = islands.iter().map(|island| reach.is_left_by(island)).collect();
    let is_open = |(island, reaches): (&Island, &bool)| !reaches && !reach.holds_island(island);
    if islands.iter().zip(&reaching).any(is_open) {
        // Distances leave it open: the growth itself decides.
        mark_reaching(&islands, &outside_growth(&islands, &reaching, below, step), &mut reaching);
    }
    components(overhang, islands, &reaching)
}

/// What of `above` hangs past the permissible overhang of `below` and is wider than twice
/// `opening` mm: the area that supports must hold at the layer `below`.
pub fn need(above: &PolygonSet, below: &PolygonSet, step: f64, opening: f64) -> PolygonSet {
    if above == below || above.is_empty() {
        return PolygonSet::EMPTY;
    }
    above.difference(&permissible_overhang(below, step)).opened(opening, MITRE)
}

/// What of the islands that are not `settled` lies outside the permissible overhang of `below`.
fn outside_growth(islands: &[Island], settled: &[bool], below: &PolygonSet, step: f64) -> PolygonSet {
    let open: Vec<&Island> =
        islands.iter().zip(settled).filter(|(_, settled)| !**settled).map(|(island, _)| island).collect();
    let boxes: Vec<Bounds> = open.iter().map(|island| island.bounds).collect();
    // What lies farther from them than a mitre reaches has no say, nor has the growth of a cut there.
    let around = 1.1 * MITRE_LIMIT * (step + SNAP_SLACK_MM);
    let outside = groups_of(&boxes, around).into_iter().flat_map(|group| {
        let bounds = group.iter().map(|&i| boxes[i]).reduce(Bounds::union);
        let near = bounds.map_or(PolygonSet::EMPTY, |bounds| below.within(bounds.grown(around)));
        let contours = group.iter().flat_map(|&i| open[i].polygon.clone().into_set().into_contours());
        let open = PolygonSet::canonical(contours.collect());
        open.difference(&permissible_overhang(&near, step)).into_contours()
    });
    PolygonSet::canonical(outside.collect())
}

/// Marks the islands of an overhang that hold a piece of `outside`, which lies within them.
fn mark_reaching(islands: &[Island], outside: &PolygonSet, reaching: &mut [bool]) {
    for piece in outside.islands() {
        let point = inner_point(&piece);
        let around = match islands.len() {
            1 => Some(0),
            _ => point.and_then(|p| Island::around(islands, p)),
        };
        if let Some(i) = around {
            reaching[i] = true;
        }
    }
}

/// The marked islands of `overhang`.
fn components(overhang: PolygonSet, islands: Vec<Island>, marked: &[bool]) -> PolygonSet {
    if !marked.contains(&false) {
        return overhang;
    }
    let marked = islands.into_iter().zip(marked).filter(|(_, marked)| **marked);
    let contours = marked.flat_map(|(island, _)| island.polygon.into_set().into_contours());
    PolygonSet::canonical(contours.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::stars::hollow_star;
    use crate::polygon::{Contour, dvec2};
    use proptest::prelude::*;

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1))
    }

    proptest! {
        #[test]
        fn what_needs_support_is_what_leaves_the_growth(
            below in hollow_star(),
            above in hollow_star(),
            step in 0.01..1.0f64,
        ) {
            let grown = permissible_overhang(&below, step);
            let leaves = |island: &Island| !island.polygon.clone().into_set().difference(&grown).is_empty();
            let islands = Island::all_of(&above.difference(&below));
            let expected: f64 = islands.iter().filter(|i| leaves(i)).map(|i| i.polygon.area()).sum();
            let found = externally_supported(&above, &below, step).area();
            prop_assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
        }
    }

    #[test]
    fn at_45_degrees_a_layer_may_reach_out_by_its_height() {
        assert!((permissible_step(0.2, 45.0) - 0.2).abs() < 1e-15);
        assert!((permissible_step(0.2, 30.0) - 0.115470).abs() < 1e-6);
        assert_eq!(permissible_step(0.2, 0.0), 0.0);
    }

    #[test]
    fn the_whole_component_needs_support_not_only_its_far_part() {
        let below = rectangle(0.0, 0.0, 10.0, 10.0);
        // 5 mm to the right, and a step of 0.1 to the left that holds itself.
        let above = rectangle(-0.1, 0.0, 15.0, 10.0);
        let esf = externally_supported(&above, &below, 0.2);
        assert_eq!(esf, rectangle(10.0, 0.0, 15.0, 10.0));
    }

    #[test]
    fn a_step_within_the_permissible_overhang_needs_nothing() {
        let below = rectangle(0.0, 0.0, 10.0, 10.0);
        let above = rectangle(-0.2, -0.2, 10.2, 10.2);
        assert!(externally_supported(&above, &below, 0.2).is_empty());
        assert!(!externally_supported(&above, &below, 0.19).is_empty());
    }

    #[test]
    fn holes_grow_inward() {
        let ring =
            |hole: f64| rectangle(-20.0, -20.0, 20.0, 20.0).difference(&rectangle(-hole, -hole, hole, hole));
        assert!(externally_supported(&ring(4.9), &ring(5.0), 0.2).is_empty());
        let ceiling = externally_supported(&ring(1.0), &ring(5.0), 0.2);
        assert!((ceiling.area() - 96.0).abs() < 1e-9);
    }

    #[test]
    fn erratum_the_determinant_of_the_offset_formula() {
        // Q = P + d (e_i - e_(i+1)) / det with unit edges e: with det = x_i y_(i+1) - x_(i+1) y_i
        // the vertex lies at distance d from both edges, with a plus sign in it it does not.
        let corner = Contour::new(vec![dvec2(0.0, 0.0), dvec2(10.0, 4.0), dvec2(1.0, 9.0)]);
        let (p, d) = (dvec2(10.0, 4.0), 0.5);
        let (e, f) = (dvec2(10.0, 4.0).normalize(), dvec2(-9.0, 5.0).normalize());
        let distances = |det: f64| {
            let q = p + (e - f) * d / det;
            [e, f].map(|edge| -edge.perp_dot(q - p))
        };
        let right = distances(e.x * f.y - f.x * e.y);
        assert!(right.iter().all(|r| (r - d).abs() < 1e-9), "{right:?}");
        let wrong = distances(e.x * f.y + f.x * e.y);
        assert!(wrong.iter().any(|w| (w - d).abs() > 0.1), "{wrong:?}");
        // The production path grows the same corner.
        let q = p + (e - f) * d / (e.x * f.y - f.x * e.y);
        let grown = PolygonSet::from_contours(vec![corner]).offset(d, MITRE);
        let nearest = grown.contours()[0].points.iter().map(|g| g.distance(q)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-4, "{nearest}");
    }

    #[test]
    fn the_need_of_plates_is_opened() {
        let below = rectangle(0.0, 0.0, 10.0, 10.0);
        let above = rectangle(0.0, 0.0, 13.0, 10.0).union(&rectangle(0.0, 10.0, 10.0, 10.5));
        let found = need(&above, &below, 0.2, 0.2);
        // 2.8 x 10 at the right; the strip 0.3 wide above is thinner than 0.4 and vanishes.
        assert!((found.area() - 28.0).abs() < 0.1, "{}", found.area());
    }
}
