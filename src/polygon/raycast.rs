//! Point in polygon by ray casting, and the nesting of contours.

use super::measure::Bounds;
use super::{Contour, DVec2, Polygon, PolygonSet};

impl Contour {
    /// Whether a ray from `p` to the right crosses the contour an odd number of times.
    ///
    /// Edges are half-open in y, so that a vertex level with `p` counts once [Lv 2022, eq. 13-14,
    /// with the printed condition, inclusive at both ends, put right].
    pub fn contains(&self, p: DVec2) -> bool {
        self.edges().filter(|&(a, b)| crosses_ray(a, b, p)).count() % 2 == 1
    }
}

impl PolygonSet {
    /// Whether `p` lies inside (points on the border may fall either way).
    pub fn contains(&self, p: DVec2) -> bool {
        self.contours().iter().filter(|c| c.contains(p)).count() % 2 == 1
    }
}

fn crosses_ray(a: DVec2, b: DVec2, p: DVec2) -> bool {
    (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
}

/// Gives each clockwise contour to the smallest counter-clockwise one around it.
pub(super) fn group_into_islands(contours: &[Contour]) -> Vec<Polygon> {
    let (outers, holes): (Vec<&Contour>, Vec<&Contour>) =
        contours.iter().partition(|c| c.signed_area() > 0.0);
    let frames: Vec<(f64, Option<Bounds>)> = outers.iter().map(|c| (c.signed_area(), c.bounds())).collect();
    let mut islands: Vec<Polygon> =
        outers.iter().map(|&outer| Polygon { outer: outer.clone(), holes: Vec::new() }).collect();
    for hole in holes {
        let around = (0..outers.len())
            .filter(|&i| is_around(outers[i], frames[i].1, hole))
            .min_by(|&a, &b| frames[a].0.total_cmp(&frames[b].0));
        if let Some(i) = around {
            islands[i].holes.push(hole.clone());
        }
    }
    islands
}

/// Whether `hole`, which crosses no contour, lies within `outer`: most of its edge middles do (a
/// hole may touch its outline in single points).
fn is_around(outer: &Contour, bounds: Option<Bounds>, hole: &Contour) -> bool {
    let fits = matches!((bounds, hole.bounds()), (Some(o), Some(h)) if o.contains(h));
    let middles = || hole.edges().map(|(a, b)| (a + b) / 2.0).take(7);
    fits && 2 * middles().filter(|&p| outer.contains(p)).count() > middles().count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn a_point_level_with_a_vertex_counts_it_once() {
        let diamond =
            Contour::new(vec![dvec2(0.0, -1.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0), dvec2(-1.0, 0.0)]);
        assert!(diamond.contains(dvec2(0.0, 0.0)));
        assert!(!diamond.contains(dvec2(-2.0, 0.0)));
        assert!(!diamond.contains(dvec2(2.0, 0.0)));
        assert!(!diamond.contains(dvec2(-2.0, 1.0)));
    }

    #[test]
    fn an_island_inside_a_hole_stands_alone() {
        let square = |r: f64| PolygonSet::rectangle(dvec2(-r, -r), dvec2(r, r));
        let rings = square(10.0).difference(&square(8.0)).union(&square(6.0).difference(&square(4.0)));
        let islands = rings.islands();
        let areas: Vec<f64> = islands.iter().map(Polygon::area).collect();
        assert_eq!(areas, [400.0 - 256.0, 144.0 - 64.0]);
    }
}
