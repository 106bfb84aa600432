//! Permissible overhang (POA) and externally supported features (ESF) of one layer over another.
//!
//! Source: [Karim] K. F. Karim et al., "Feature-Based Support Generation for Optimum Part
//! Deposition Orientation in FDM", equations (2) to (8). Plate supports share [`need`].

use crate::polygon::measure::Bounds;
use crate::polygon::trig::tan;
use crate::polygon::{DVec2, Join, Polygon, PolygonSet, dvec2};

/// Growth is mitred: round joins would let the corners of a frustum that holds itself poke out.
const MITRE: Join = Join::Mitre { limit: 5.0 };

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
    let outside = above.difference(&permissible_overhang(below, step));
    if outside.is_empty() {
        return PolygonSet::EMPTY;
    }
    components_reaching(above.difference(below), &outside)
}

/// What of `above` hangs past the permissible overhang of `below` and is wider than twice
/// `opening` mm: the area that supports must hold at the layer `below`.
pub fn need(above: &PolygonSet, below: &PolygonSet, step: f64, opening: f64) -> PolygonSet {
    if above == below || above.is_empty() {
        return PolygonSet::EMPTY;
    }
    above.difference(&permissible_overhang(below, step)).opened(opening, MITRE)
}

/// The components of `overhang` that hold a piece of `outside`, which lies within `overhang`.
fn components_reaching(overhang: PolygonSet, outside: &PolygonSet) -> PolygonSet {
    let islands = Island::all_of(&overhang);
    if islands.len() == 1 {
        return overhang;
    }
    let mut reaching = vec![false; islands.len()];
    for piece in outside.islands() {
        if let Some(i) = inner_point(&piece).and_then(|p| Island::around(&islands, p)) {
            reaching[i] = true;
        }
    }
    let reaching = islands.into_iter().zip(reaching).filter(|(_, reaches)| *reaches);
    let contours = reaching.flat_map(|(island, _)| island.polygon.into_set().into_contours());
    PolygonSet::canonical(contours.collect())
}

/// One connected component with its box, for questions that most components answer by the box.
#[derive(Debug, Clone)]
pub struct Island {
    /// The component.
    pub polygon: Polygon,
    /// The box around it.
    pub bounds: Bounds,
}

impl Island {
    /// The connected components of an area.
    pub fn all_of(area: &PolygonSet) -> Vec<Island> {
        let boxed = |polygon: Polygon| {
            let bounds = polygon.outer.bounds()?;
            Some(Island { polygon, bounds })
        };
        area.islands().into_iter().filter_map(boxed).collect()
    }

    /// Whether `p` lies inside (points on the border may fall either way).
    pub fn contains(&self, p: DVec2) -> bool {
        self.bounds.contains(Bounds { min: p, max: p })
            && self.polygon.outer.contains(p)
            && !self.polygon.holes.iter().any(|hole| hole.contains(p))
    }

    /// The first of the islands that holds `p`.
    pub fn around(islands: &[Island], p: DVec2) -> Option<usize> {
        islands.iter().position(|island| island.contains(p))
    }
}

/// The edges of an area sorted into level strips, for many questions whether a point is inside.
#[derive(Debug)]
pub struct Strips {
    low: f64,
    per_mm: f64,
    edges: Vec<Vec<(DVec2, DVec2)>>,
}

impl Strips {
    /// Sorts the edges of `area`.
    pub fn new(area: &PolygonSet) -> Strips {
        let (low, height) = area.bounds().map_or((0.0, 0.0), |b| (b.min.y, b.size().y));
        let count = (area.vertex_count() / 4).clamp(1, 512);
        let mut strips =
            Strips { low, per_mm: count as f64 / height.max(1e-3), edges: vec![Vec::new(); count] };
        for (a, b) in area.contours().iter().flat_map(|c| c.edges()) {
            for strip in strips.of(a.y.min(b.y))..=strips.of(a.y.max(b.y)) {
                strips.edges[strip].push((a, b));
            }
        }
        strips
    }

    fn of(&self, y: f64) -> usize {
        (((y - self.low) * self.per_mm) as usize).min(self.edges.len() - 1)
    }

    /// Whether `p` lies inside (points on the border may fall either way).
    pub fn contain(&self, p: DVec2) -> bool {
        let crosses = |&&(a, b): &&(DVec2, DVec2)| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
        };
        self.edges[self.of(p.y)].iter().filter(crosses).count() % 2 == 1
    }
}

/// A point well inside: in the middle of the widest stretch of the level line that halves the
/// tallest gap between two neighbouring vertex heights. `None` for a polygon without height.
pub fn inner_point(polygon: &Polygon) -> Option<DVec2> {
    let contours = || std::iter::once(&polygon.outer).chain(&polygon.holes);
    let mut heights: Vec<f64> = contours().flat_map(|c| c.points.iter().map(|p| p.y)).collect();
    heights.sort_by(f64::total_cmp);
    let tallest = heights.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    let y = (tallest[0] + tallest[1]) / 2.0;
    let crossing = |(a, b): (DVec2, DVec2)| {
        ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y))
    };
    let mut crossings: Vec<f64> = contours().flat_map(|c| c.edges().filter_map(crossing)).collect();
    crossings.sort_by(f64::total_cmp);
    let widest = crossings.chunks_exact(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    Some(dvec2((widest[0] + widest[1]) / 2.0, y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Contour;

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1))
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

    #[test]
    fn an_inner_point_lies_inside_also_of_a_ring() {
        let ring = rectangle(0.0, 0.0, 10.0, 10.0).difference(&rectangle(1.0, 1.0, 9.0, 9.0));
        let ring = ring.islands().remove(0);
        let p = inner_point(&ring).unwrap();
        assert!(Island::all_of(&ring.clone().into_set())[0].contains(p), "{p}");
    }
}
