//! Nested loops along every outline, and what they leave over.
//!
//! A loop is laid only where the part is thick enough for two beads side by side; thinner places
//! are handed on, to be filled by beads of fitting width.

use crate::polygon::{Join, PolygonSet};
use crate::region::Bead;
use crate::region::{Path, Role};

crate::options! {
    /// Loops along every outline.
    pub struct WallOptions {
        /// Number of loops. One is for vases and tests, two or three for ordinary parts; 0 prints
        /// no walls.
        count: u32 = 3, "Walls", "", 0.0..=50.0;
        /// Width of the loops' beads; slicers use the nozzle's diameter and a tenth more.
        width: f64 = 0.45, "Wall line width", "mm", 0.1..=2.0;
    }
}

/// The walls of one layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Walls {
    /// Closed beads with their depth: 0 is the outer wall.
    pub loops: Vec<(u32, Path)>,
    /// Places at the outline too thin for two beads side by side.
    pub thin_outer: PolygonSet,
    /// The like between inner walls.
    pub thin_inner: PolygonSet,
    /// What lies inside the innermost wall, up to the border of its bead's cell.
    pub inner: PolygonSet,
}

/// Strips narrower than this are left open: no nozzle lays so thin a bead, mm.
const NARROWEST_STRIP: f64 = 0.1;

/// Area under which a layer's thin places are not worth a look, mm2.
const NO_THIN_PLACES: f64 = 0.01;

/// Lays `count` loops of this bead along the outline.
///
/// With s the bead's spacing, wall i runs at w/2 + i s inside the outline. Shrinking the outline by
/// w/2 + s/2 leaves `inside`, the area within the first wall's cell; grown back by s/2 it gives the
/// wall's centre line wherever two beads fit side by side.
pub fn lay_walls(outline: &PolygonSet, bead: Bead, count: u32) -> Walls {
    let spacing = bead.spacing();
    let mut walls = Walls { inner: outline.clone(), ..Walls::default() };
    let mut thin_inner = Vec::new();
    for depth in 0..count {
        if walls.inner.is_empty() {
            break;
        }
        let to_centre = if depth == 0 { bead.width / 2.0 } else { spacing / 2.0 };
        let inside = walls.inner.offset(-(to_centre + spacing / 2.0), Join::WALL);
        let centre = inside.offset(spacing / 2.0, Join::WALL);
        let thin = thin_places(&walls.inner, &centre, to_centre);
        let role = if depth == 0 { Role::OuterWall } else { Role::InnerWall };
        match depth {
            0 => walls.thin_outer = thin,
            _ => thin_inner.push(thin),
        }
        let as_path = |points| (depth, Path::closed(role, points, bead.width));
        walls.loops.extend(centre.into_contours().into_iter().map(|c| as_path(c.points)));
        walls.inner = inside;
    }
    walls.thin_inner = PolygonSet::union_all(&thin_inner);
    walls
}

/// What of `area` the walls along `centre` do not reach, without hair-thin slivers.
fn thin_places(area: &PolygonSet, centre: &PolygonSet, to_centre: f64) -> PolygonSet {
    let reached = centre.offset(to_centre, Join::WALL);
    if area.area() - reached.area() < NO_THIN_PLACES {
        return PolygonSet::EMPTY;
    }
    area.difference(&reached).opened(NARROWEST_STRIP / 2.0, Join::WALL)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    const BEAD: Bead = Bead { width: 0.45, height: 0.2 };

    #[test]
    fn walls_of_a_square_are_nested_squares() {
        let walls = lay_walls(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0)), BEAD, 3);
        let lengths: Vec<f64> = walls.loops.iter().map(|(_, p)| p.length()).collect();
        let s = BEAD.spacing();
        for (i, length) in lengths.iter().enumerate() {
            let side = 20.0 - 0.45 - 2.0 * s * i as f64;
            assert!((length - 4.0 * side).abs() < 2e-3, "{length} is not 4 x {side}");
        }
        assert!(walls.thin_outer.is_empty() && walls.thin_inner.is_empty());
        let side = 20.0 - 0.45 - 5.0 * s;
        assert!((walls.inner.area() - side * side).abs() < 0.02);
    }

    #[test]
    fn a_plate_too_thin_for_two_beads_is_thin_all_over() {
        let walls = lay_walls(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 0.6)), BEAD, 3);
        assert!(walls.loops.is_empty());
        assert!((walls.thin_outer.area() - 12.0).abs() < 1e-3);
        assert!(walls.inner.is_empty());
    }

    #[test]
    fn what_two_walls_leave_between_them_is_thin() {
        let walls = lay_walls(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 1.1)), BEAD, 3);
        assert_eq!(walls.loops.len(), 1);
        let left = 1.1 - 0.45 - BEAD.spacing();
        assert!((walls.thin_inner.area() - left * (20.0 - 0.45 - BEAD.spacing())).abs() < 0.02);
    }
}
