//! How far an area reaches past another one, by distances alone: most layers of most parts are settled
//! without growing anything.

use crate::polygon::grid::EdgeGrid;
use crate::polygon::island::Island;
use crate::polygon::measure::Bounds;
use crate::polygon::simplify::squared_distance_to_segment;
use crate::polygon::strips::Strips;
use crate::polygon::{Contour, DVec2, PolygonSet};

/// By so much, mm, a point must lie nearer than allowed to be surely within: rounding to the grid may
/// bring the grown border nearer by less.
const NEARER_MM: f64 = 1e-4;

/// By so much, mm, a point must lie farther than allowed to be surely outside. Less could be a sliver
/// that booleans drop.
const FARTHER_MM: f64 = 0.005;

/// Edges are halved at most so often to see whether they stay within reach.
const HALVINGS: u32 = 6;

/// A point, and the edge nearest to it, if one is within reach: squared distance and place in the list.
#[derive(Clone, Copy)]
struct Near {
    at: DVec2,
    edge: Option<(f64, usize)>,
}

/// An area and the mitred growth of it that another one may cover.
pub(super) struct Reach<'a> {
    below: &'a PolygonSet,
    edges: Vec<(DVec2, DVec2)>,
    grid: EdgeGrid,
    inside: std::cell::OnceCell<Strips>,
    step: f64,
    mitre_limit: f64,
}

impl<'a> Reach<'a> {
    /// The growth of `below` by `step` mm, mitred up to `mitre_limit` times that.
    pub(super) fn new(below: &'a PolygonSet, step: f64, mitre_limit: f64) -> Reach<'a> {
        let edges: Vec<(DVec2, DVec2)> = below.contours().iter().flat_map(Contour::edges).collect();
        let grid = EdgeGrid::new(&edges);
        Reach { below, edges, grid, inside: Default::default(), step, mitre_limit }
    }

    /// Whether surely nothing of `area` lies outside the growth. Without a doubt only: false says nothing.
    ///
    /// An area that reaches out does so with its border, or it covers a pocket that the growth leaves.
    pub(super) fn holds(&self, area: &PolygonSet) -> bool {
        let Some(bounds) = area.bounds() else { return true };
        let near = |&&(a, b): &&(DVec2, DVec2)| Bounds { min: a.min(b), max: a.max(b) }.is_near(bounds, 0.0);
        // The other side of the edges of `below`.
        let outward = self.edges.iter().filter(near).map(|&(a, b)| (b, a));
        self.holds_border(area.contours()) && !self.has_pocket(outward, &Strips::new(area))
    }

    /// The same for one connected part.
    pub(super) fn holds_island(&self, island: &Island) -> bool {
        let contours: Vec<Contour> = island.polygon.contours().cloned().collect();
        let edges = contours.iter().flat_map(Contour::edges);
        self.holds_border(&contours) && !self.has_pocket(edges, &Strips::of_contours(&contours))
    }

    /// Whether `area` may have a place to the left of these edges that the growth does not reach, though all of its
    /// border is near: between a pin and its hole, in a bay with a narrow mouth.
    ///
    /// A circle of a step's radius that fits into such a place touches an edge; its middle, from whichever point
    /// of the edge within half a step it is guessed, is no nearer than half a step to any edge.
    fn has_pocket(&self, mut edges: impl Iterator<Item = (DVec2, DVec2)>, area: &Strips) -> bool {
        edges.any(|(a, b)| {
            let inward = (b - a).normalize_or_zero().perp() * self.step;
            let samples = (a.distance(b) / self.step).ceil().max(1.0);
            (0..samples as usize).map(|i| a.lerp(b, (i as f64 + 0.5) / samples) + inward).any(|p| {
                area.contain(p) && self.grid.nearest_edge(p, self.step / 2.0).is_none() && !self.contains(p)
            })
        })
    }

    fn holds_border<'c>(&self, contours: impl IntoIterator<Item = &'c Contour>) -> bool {
        let reach = self.step - NEARER_MM;
        reach > 0.0 && contours.into_iter().all(|contour| self.holds_contour(contour, reach))
    }

    fn holds_contour(&self, contour: &Contour, reach: f64) -> bool {
        let Some(&last) = contour.points.last() else { return true };
        let mut from = self.near(last, reach);
        contour.points.iter().all(|&p| {
            let to = self.near(p, reach);
            let held = self.holds_edge(from, to, reach, HALVINGS);
            from = to;
            held
        })
    }

    fn near(&self, at: DVec2, reach: f64) -> Near {
        Near { at, edge: self.grid.nearest_edge(at, reach) }
    }

    /// Whether a corner of `island` surely lies outside the growth.
    pub(super) fn is_left_by(&self, island: &Island) -> bool {
        island.polygon.contours().flat_map(|c| &c.points).any(|&p| self.is_surely_outside(p))
    }

    fn holds_edge(&self, from: Near, to: Near, reach: f64, halvings: u32) -> bool {
        let (a, b) = (from.at, to.at);
        let within = |p: DVec2, i: usize| {
            let (c, d) = self.edges[i];
            squared_distance_to_segment(p, c, d) <= reach * reach
        };
        let held = match (from.edge, to.edge) {
            // What is near an edge is convex.
            (Some((_, i)), Some((_, j))) => within(b, i) || within(a, j),
            (None, _) if !self.contains(a) => return false,
            (_, None) if !self.contains(b) => return false,
            _ => false,
        };
        // No point of the edge is farther from the area than this.
        let away = [from, to].map(|near| near.edge.map_or(-reach, |(squared, _)| squared.sqrt()));
        if held || (away[0] + away[1] + a.distance(b)) / 2.0 <= reach {
            return true;
        }
        if (from.edge.is_none() || to.edge.is_none()) && !self.grid.crosses(a, b) {
            return true;
        }
        if halvings == 0 {
            return false;
        }
        let middle = self.near(a.lerp(b, 0.5), reach);
        self.holds_edge(from, middle, reach, halvings - 1) && self.holds_edge(middle, to, reach, halvings - 1)
    }

    fn is_surely_outside(&self, p: DVec2) -> bool {
        let far = self.step + FARTHER_MM;
        self.grid.nearest_edge(p, far).is_none() && !self.may_be_in_mitre(p, far) && !self.contains(p)
    }

    /// Whether `p` may lie in the growth of a corner that points outward: past the ends of its two edges, and
    /// behind neither of them once grown.
    fn may_be_in_mitre(&self, p: DVec2, far: f64) -> bool {
        let around = self.mitre_limit * far;
        if self.grid.nearest_edge(p, around).is_none() {
            return false;
        }
        self.below.contours().iter().any(|contour| {
            let points = &contour.points;
            let n = points.len();
            (0..n).filter(|&i| points[i].distance_squared(p) <= around * around).any(|i| {
                let (before, after) = (points[(i + n - 1) % n], points[(i + 1) % n]);
                let edges = [points[i] - before, after - points[i]].map(DVec2::normalize_or_zero);
                let away = p - points[i];
                edges[0].dot(away) >= -FARTHER_MM
                    && edges[1].dot(away) <= FARTHER_MM
                    && edges.iter().all(|edge| -edge.perp_dot(away) <= far)
            })
        })
    }

    fn contains(&self, p: DVec2) -> bool {
        self.inside.get_or_init(|| Strips::new(self.below)).contain(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::stars::hollow_star;
    use crate::polygon::{Join, dvec2};
    use proptest::prelude::*;

    const LIMIT: f64 = 5.0;

    proptest! {
        #[test]
        fn what_is_settled_is_what_the_growth_says(below in hollow_star(), above in hollow_star(), step in 0.05..3.0f64) {
            let grown = below.offset(step, Join::Mitre { limit: LIMIT });
            let reach = Reach::new(&below, step, LIMIT);
            let outside = above.difference(&grown);
            prop_assert!(!reach.holds(&above) || outside.is_empty(), "{outside:?}");
            for island in Island::all_of(&above.difference(&below)) {
                let left = island.polygon.clone().into_set().difference(&grown);
                prop_assert!(!reach.is_left_by(&island) || !left.is_empty(), "{island:?}");
                prop_assert!(!reach.holds_island(&island) || left.is_empty(), "{island:?}");
            }
        }
    }

    #[test]
    fn a_ring_between_pin_and_hole_is_too_wide_in_the_middle() {
        let square = |r: f64| PolygonSet::rectangle(dvec2(-r, -r), dvec2(r, r));
        let around = square(20.0).difference(&square(5.0));
        let below = around.union(&square(4.5));
        let gap = &Island::all_of(&square(5.0).difference(&square(4.5)))[0];
        // Its border is the border below; the middle is 0.25 away.
        assert!(!Reach::new(&below, 0.2, LIMIT).holds_island(gap));
        assert!(!Reach::new(&below, 0.2, LIMIT).holds(&square(20.0)));
        assert!(Reach::new(&below, 0.6, LIMIT).holds_island(gap));
    }

    #[test]
    fn a_bay_with_a_narrow_mouth_is_left() {
        let bay = PolygonSet::rectangle(dvec2(-2.0, 0.0), dvec2(2.0, 4.0));
        let mouth = PolygonSet::rectangle(dvec2(-0.1, 4.0), dvec2(0.1, 5.0));
        let above = PolygonSet::rectangle(dvec2(-5.0, -3.0), dvec2(5.0, 5.0));
        let below = above.difference(&bay.union(&mouth));
        let hanging = &Island::all_of(&above.difference(&below))[0];
        assert!(!Reach::new(&below, 0.2, LIMIT).holds_island(hanging));
    }

    #[test]
    fn steps_within_reach_are_held_and_longer_ones_leave() {
        let square = |r: f64| PolygonSet::rectangle(dvec2(-r, -r), dvec2(r, r));
        let ring = |r: f64| square(20.0).difference(&square(r));
        let (below, above) = (ring(5.0), ring(4.9));
        assert!(Reach::new(&below, 0.2, LIMIT).holds(&above));
        // A ceiling over the hole has no border of its own.
        assert!(!Reach::new(&below, 0.2, LIMIT).holds(&square(20.0)));
        assert!(!Reach::new(&below, 0.09, LIMIT).holds(&above));
        let step = above.difference(&below);
        assert!(Reach::new(&below, 0.05, LIMIT).is_left_by(&Island::all_of(&step)[0]));
        assert!(!Reach::new(&below, 0.1, LIMIT).is_left_by(&Island::all_of(&step)[0]));
    }
}
