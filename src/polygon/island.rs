//! Connected parts of an area, and points inside them.

use super::measure::Bounds;
use super::{Contour, DVec2, Polygon, PolygonSet, dvec2};

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

/// A point well inside: in the middle of the widest stretch of the level line that halves the
/// tallest gap between two neighbouring vertex heights. `None` for a polygon without height.
pub fn inner_point(polygon: &Polygon) -> Option<DVec2> {
    inner_point_of(polygon.contours())
}

/// The same for the contours of an area.
pub fn inner_point_of<'a>(contours: impl Iterator<Item = &'a Contour> + Clone) -> Option<DVec2> {
    let contours = || contours.clone();
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

    #[test]
    fn an_inner_point_lies_inside_also_of_a_ring() {
        let square = |low: f64, high: f64| PolygonSet::rectangle(DVec2::splat(low), DVec2::splat(high));
        let ring = square(0.0, 10.0).difference(&square(1.0, 9.0));
        let ring = ring.islands().remove(0);
        let p = inner_point(&ring).unwrap();
        assert!(Island::all_of(&ring.clone().into_set())[0].contains(p), "{p}");
    }
}
