//! Nested loops along every outline, and what they leave over.
//!
//! Two beads lie side by side only where both are nearly full width; thinner places are handed on, to
//! be filled by one bead of fitting width. Where a pair of loops leaves a strip that is too thin for
//! a bead between them, or lacks a little room, both change their width and fill the place edge to
//! edge, as in [Kuipers, Doubrovski, Wu, Wang 2020, "A framework for adaptive width control of dense
//! contour-parallel toolpaths"].

mod fit;

use crate::polygon::{Contour, Join, Polygon, PolygonSet};
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
        /// By how much every outline is moved outward before anything else, to make up for plastic
        /// that shrinks; negative moves it inward. Holes become smaller by it.
        horizontal_expansion: f64 = 0.0, "Horizontal expansion", "mm", -2.0..=2.0;
        /// By how much holes are made larger besides; negative makes them smaller.
        hole_expansion: f64 = 0.0, "Hole expansion", "mm", -2.0..=2.0;
    }
}

impl WallOptions {
    /// The section of a part with `horizontal_expansion` and `hole_expansion`.
    pub fn expanded(&self, section: PolygonSet) -> PolygonSet {
        let grown = section.offset(self.horizontal_expansion, Join::WALL);
        if self.hole_expansion == 0.0 {
            return grown;
        }
        let with_holes = |island: Polygon| {
            let filled = |c: &Contour| PolygonSet::from_contours(vec![c.clone()]);
            let holes = island.holes.iter().map(|h| filled(h).offset(self.hole_expansion, Join::WALL));
            filled(&island.outer).difference(&PolygonSet::union_all(&holes.collect::<Vec<_>>()))
        };
        PolygonSet::union_all(&grown.islands().into_iter().map(with_holes).collect::<Vec<_>>())
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
    /// Places at the outline too thin for any bead, and hair-thin slivers along it.
    pub lost: PolygonSet,
    /// Where loops changed their width or could not run.
    pub close: Vec<Contour>,
    /// What lies inside the innermost wall, up to the border of its bead's cell.
    pub inner: PolygonSet,
}

/// Strips narrower than this are left open: no nozzle lays so thin a bead, mm.
const NARROWEST_STRIP: f64 = 0.1;

/// Area under which a layer's thin places are not worth a look, mm2.
const NO_THIN_PLACES: f64 = 0.01;

/// The like for places too thin for any bead, mm2.
const NOTHING_LOST: f64 = 0.1;

/// The like for places where beads should be wider or narrower than usual, mm2.
const NO_CLOSE_PLACES: f64 = 0.05;

/// Loops behind the outer one need not follow the outline closer than this, mm: a twentieth of a bead.
const INNER_RESOLUTION: f64 = 0.02;

/// Two beads lie side by side from this thickness on, in line widths; up to there one bead fills the
/// place. With the usual width of 1.1 nozzles that one bead grows to twice the nozzle at most.
const PAIR_FROM: f64 = 1.75;

/// The like for teeth, which are too short for a bead of their own.
const TOOTH_FROM: f64 = 1.5;

/// Area between the lines of a tooth's two beads at most, in squares of a line width.
const LARGEST_TOOTH: f64 = 0.5;

/// Area under which what a layer's outer walls lack is corners' tips, mm2.
const NO_TEETH: f64 = 0.03;

/// The like for a single place, mm2.
const SPECK: f64 = 0.003;

/// A tooth that goes on as a thinner strip of more than this share of its area is left to a single bead.
const MOST_BEYOND: f64 = 0.3;

/// Areas closer than this touch, mm.
const TOUCHING: f64 = 0.01;

/// A bead between two loops is at least this wide, in line widths; the loops fill thinner strips.
const MIDDLE_FROM: f64 = 0.5;

/// Distances between the lines of two neighbouring loops that face each other, mm.
#[derive(Debug, Clone, Copy)]
struct Strips {
    /// No two beads fit below this.
    narrowest: f64,
    /// Both have their usual width at this.
    usual: f64,
    /// A bead fits in between above this.
    widest: f64,
}

impl Strips {
    fn of(bead: Bead) -> Strips {
        let usual = bead.spacing();
        Strips {
            narrowest: (PAIR_FROM - 1.0) * bead.width,
            usual,
            widest: usual + MIDDLE_FROM * bead.width - bead.overlap(),
        }
    }
}

/// Beads of loops that may change their width.
#[derive(Debug, Clone, Copy)]
struct FittedBead {
    /// The usual bead.
    bead: Bead,
    role: Role,
    strips: Strips,
}

/// Lays `count` loops of this bead along the outline.
///
/// With s the bead's spacing, wall i runs at w/2 + i s inside the outline.
pub fn lay_walls(outline: &PolygonSet, bead: Bead, count: u32) -> Walls {
    let spacing = bead.spacing();
    let strips = Strips::of(bead);
    let mut walls = Walls { inner: outline.clone(), ..Walls::default() };
    let mut thin_inner = Vec::new();
    for depth in 0..count {
        if walls.inner.is_empty() {
            break;
        }
        if depth > 0 {
            walls.inner = walls.inner.roughened(INNER_RESOLUTION);
        }
        let to_centre = if depth == 0 { bead.width / 2.0 } else { spacing / 2.0 };
        let role = if depth == 0 { Role::OuterWall } else { Role::InnerWall };
        let lines = walls.inner.offset(-to_centre, Join::WALL);
        // What is left where the loops are far enough apart for a bead in between.
        let core = lines.offset(-strips.widest / 2.0, Join::WALL);
        let roomy = core.offset(strips.widest / 2.0 + to_centre, Join::WALL);
        if walls.inner.area() - roomy.area() >= NO_CLOSE_PLACES {
            let close = walls.inner.difference(&roomy);
            let centre = without_thin(&lines, strips.narrowest / 2.0);
            let centre = if depth == 0 { with_teeth(centre, &lines, bead.width) } else { centre };
            let (thin, lost) = thin_places(&walls.inner, &close, &centre, to_centre);
            match depth {
                0 => (walls.thin_outer, walls.lost) = (thin, lost),
                _ => thin_inner.push(thin),
            }
            let fitted = fit::loops(centre, &close, FittedBead { bead, role, strips });
            walls.loops.extend(fitted.into_iter().map(|path| (depth, path)));
            walls.close.extend(close.into_contours());
        } else {
            let contours = lines.into_contours().into_iter();
            walls.loops.extend(contours.map(|c| (depth, Path::closed(role, c.points, bead.width))));
        }
        walls.inner = core.offset((strips.widest - spacing) / 2.0, Join::WALL);
    }
    walls.thin_inner = PolygonSet::union_all(&thin_inner);
    walls
}

/// Corners down to 20 degrees keep their tips where it matters: the outline.
const SHARP: Join = Join::Mitre { limit: 6.0 };

/// Whether the contour has a corner of less than 60 degrees, whose tip [`Join::WALL`] cuts off.
fn has_sharp_corner(contour: &Contour) -> bool {
    let points = &contour.points;
    let n = points.len();
    let way = |i: usize| (points[(i + 1) % n] - points[i % n]).normalize_or_zero();
    (0..n).any(|i| way(i).perp_dot(way(i + 1)) > 0.0 && way(i).dot(way(i + 1)) < -0.5)
}

/// Vertices of an intersection of nearly equal outlines closer than this to its edges go, mm.
const SAME_LINE: f64 = 1e-3;

/// The area without what is thinner than twice `radius`; sharp corners stay.
fn without_thin(lines: &PolygonSet, radius: f64) -> PolygonSet {
    let core = lines.offset(-radius, Join::WALL);
    if core.contours().iter().any(has_sharp_corner) {
        return core.offset(radius, SHARP).intersection(lines).simplified(SAME_LINE);
    }
    core.offset(radius, Join::WALL)
}

/// Adds what was cut off as too thin for two beads and is no longer than a bead is wide, such as the feet of
/// raised letters: a wall runs there and back in less space than a bead of its own would need to begin.
fn with_teeth(centre: PolygonSet, lines: &PolygonSet, width: f64) -> PolygonSet {
    if lines.area() - centre.area() < NO_TEETH {
        return centre;
    }
    let fine = without_thin(lines, (TOOTH_FROM - 1.0) / 2.0 * width);
    let is_short = |tooth: &PolygonSet| (SPECK..LARGEST_TOOTH * width * width).contains(&tooth.area());
    let found = fine.difference(&centre).islands().into_iter().map(Polygon::into_set).filter(is_short);
    let found: Vec<PolygonSet> = found.collect();
    if found.is_empty() {
        return centre;
    }
    let thinner: Vec<PolygonSet> =
        lines.difference(&fine).islands().into_iter().map(Polygon::into_set).collect();
    let stands = |tooth: &PolygonSet| {
        let grown = tooth.offset(TOUCHING, Join::WALL);
        let touches = |other: &&PolygonSet| !grown.intersection(other).is_empty();
        let beyond: f64 = thinner.iter().filter(touches).map(PolygonSet::area).sum();
        touches(&&centre) && beyond < MOST_BEYOND * tooth.area()
    };
    let mut parts: Vec<PolygonSet> = found.into_iter().filter(stands).collect();
    if parts.is_empty() {
        return centre;
    }
    parts.push(centre);
    PolygonSet::union_all(&parts).simplified(SAME_LINE)
}

/// Fills an area narrower than three beads with loops and what they leave between them: lines across it
/// would be short and shake the printer.
///
/// The area's border is that of the beads' cells. Returns the loops, places at the border too thin for
/// two beads, and the like between the loops. `None` if the area is wider.
pub fn fill_narrow(area: &PolygonSet, role: Role, bead: Bead) -> Option<Walls> {
    let spacing = bead.spacing();
    // The mean thickness is a quick answer for most.
    let is_narrow = 2.0 * area.area() < NARROW * spacing * area.length()
        && area.offset(-NARROW / 2.0 * spacing, Join::WALL).is_empty();
    is_narrow.then(|| {
        let mut walls = lay_walls(&area.offset(bead.overlap() / 2.0, Join::WALL), bead, 2);
        walls.loops.iter_mut().for_each(|(_, path)| path.role = role);
        walls
    })
}

/// Thickness up to which an area is filled with loops, in line distances.
const NARROW: f64 = 3.0;

/// What of `area` the walls along `centre` do not reach: where a bead fits, and what is too thin for one.
/// All of it lies in `close`, and next to nothing elsewhere.
fn thin_places(
    area: &PolygonSet,
    close: &PolygonSet,
    centre: &PolygonSet,
    to_centre: f64,
) -> (PolygonSet, PolygonSet) {
    let reached = centre.offset(to_centre, Join::WALL);
    if area.area() - reached.area() < NO_THIN_PLACES {
        return (PolygonSet::EMPTY, PolygonSet::EMPTY);
    }
    let left = close.difference(&reached);
    let thin = left.opened(NARROWEST_STRIP / 2.0, Join::WALL);
    let is_lost = left.area() - thin.area() >= NOTHING_LOST;
    let lost = if is_lost { left.difference(&thin) } else { PolygonSet::EMPTY };
    (thin, lost)
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
    fn expansion_moves_the_outline_and_holes_on_their_own() {
        let square = |r: f64| PolygonSet::rectangle(dvec2(-r, -r), dvec2(r, r));
        let expanded = |horizontal_expansion: f64, hole_expansion: f64| {
            let options = WallOptions { horizontal_expansion, hole_expansion, ..WallOptions::default() };
            options.expanded(square(10.0).difference(&square(5.0)))
        };
        assert_eq!(expanded(0.0, 0.0), square(10.0).difference(&square(5.0)));
        assert_eq!(expanded(0.1, 0.0), square(10.1).difference(&square(4.9)));
        assert_eq!(expanded(-0.1, 0.3), square(9.9).difference(&square(5.4)));
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

    /// 0.7 mm is too thin for two beads beside each other, 1.5 mm long for one of its own.
    #[test]
    fn a_wall_runs_around_a_short_tooth_and_not_around_a_long_one() {
        let reaching = |length: f64| {
            let tooth = PolygonSet::rectangle(dvec2(10.0, 4.0), dvec2(10.0 + length, 4.7));
            let block = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 10.0));
            let walls = lay_walls(&PolygonSet::union_all(&[block, tooth]), BEAD, 1);
            let points = walls.loops.iter().flat_map(|(_, path)| &path.points);
            (points.map(|p| p.x).fold(f64::MIN, f64::max), walls.thin_outer.area())
        };
        let (reach, left) = reaching(0.35);
        assert!((reach - (10.35 - 0.225)).abs() < 0.03 && left < 0.03, "{reach} {left}");
        let (reach, left) = reaching(1.5);
        assert!(reach < 10.0 && left > 0.9, "{reach} {left}");
    }

    #[test]
    fn a_pair_of_loops_shares_what_is_missing_or_left_over() {
        for thickness in [0.8, 0.9, 1.0] {
            let walls = lay_walls(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, thickness)), BEAD, 3);
            let [(0, path)] = &walls.loops[..] else { panic!("{thickness}: {:?}", walls.loops) };
            assert!(walls.thin_outer.is_empty() && walls.thin_inner.is_empty() && walls.inner.is_empty());
            let width = (thickness + BEAD.overlap()) / 2.0;
            for (i, p) in path.points.iter().enumerate() {
                assert!((path.width.at(i) - width).abs() < 0.01, "{thickness}: {:?}", path.width);
                assert!((p.y.min(thickness - p.y) - width / 2.0).abs() < 0.01, "{thickness}: {p}");
            }
        }
    }
}
