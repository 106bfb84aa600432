//! Loops that touch the first layer.

use super::clip::{Line, to_area, to_box};
use super::error::{AdhesionWarning, WarningCode};
use super::ground::{FAST_VERTICES, Ground, simplified_by};
use super::options::{BrimOptions, BrimSide};
use super::{FirstLayer, Foundation};
use crate::polygon::simplify::simplify_ring;
use crate::polygon::trig::sin_cos;
use crate::polygon::{Contour, DVec2, Join, Polygon, PolygonSet, dvec2};
use crate::region::{Path, Role};
use crate::sort::StableSort;

/// Corners are looked for on an outline simplified to this, mm, so that a rounded corner of a
/// fraction of a line counts as one.
const CORNER_TOLERANCE_MM: f64 = 0.1;

/// Each loop follows the one inside it, simplified by this, mm: a twentieth of a usual line, which
/// halves the time.
const LOOP_TOLERANCE_MM: f64 = 0.02;

/// The same for loops of more than [`FAST_VERTICES`]: an eighth of a line.
const MANY_LOOPS_TOLERANCE_MM: f64 = 0.05;

/// Corners of an ear's round area.
const EAR_CORNERS: u32 = 32;

/// A loop of the brim.
struct Loop {
    /// Loops of one home are printed one after another: a connected piece of brim.
    home: usize,
    /// Counted from the outline outward.
    level: u32,
    line: Line,
}

/// The brim, piece by piece, each from its outer edge to the part: what is left over from priming
/// and travel ends up outside, and the loop that must hold on to the part is laid against others.
pub(super) fn brim(first: &FirstLayer, ground: &Ground, options: &BrimOptions) -> Foundation {
    let mut loops = match options.side {
        BrimSide::Both => offsets(&ground.area, options),
        BrimSide::Outer => around_groups(&ground.area, options),
        BrimSide::Inner => inside_holes(&ground.area, options),
    };
    let mut warnings = Vec::new();
    if options.ears {
        let ears = ears(&ground.area, options);
        if ears.is_empty() {
            let message = "adhesion.brim.ears_max_angle_deg: no corner is sharp enough for an ear".to_owned();
            warnings.push(AdhesionWarning::new(WarningCode::NoEars, message, None));
        }
        loops = cut_to_ears(loops, &ears);
    }
    loops.stable_sort_by_key(|l| (l.home, std::cmp::Reverse(l.level)));
    let bed = first.bed.grown(-options.line_width / 2.0);
    let off_bed = loops.iter().flat_map(|l| &l.line.points).find(|&&p| p.clamp(bed.min, bed.max) != p);
    if let Some(&at) = off_bed {
        let message = "adhesion.brim.width: the brim would leave the bed; it is cut off there".to_owned();
        warnings.push(AdhesionWarning::new(WarningCode::AdhesionOffBed, message, Some(at)));
    }
    let lines = loops.into_iter().flat_map(|l| to_box(l.line, bed));
    let path = |line: Line| match line.closed {
        true => Path::closed(Role::Brim, line.points, options.line_width),
        false => Path::open(Role::Brim, line.points, options.line_width),
    };
    Foundation { layers: vec![lines.map(path).collect()], warnings, ..Foundation::default() }
}

/// Number of loops: 20 for the paper's 8.0 mm in lines of 0.4.
fn count(options: &BrimOptions) -> u32 {
    ((options.width / options.line_width).round() as u32).max(1)
}

/// The loops around an area, those of each connected piece under one home.
fn offsets(area: &PolygonSet, options: &BrimOptions) -> Vec<Loop> {
    let mut at = area.offset(options.gap + options.line_width / 2.0, Join::WALL);
    let mut loops: Vec<Loop> = Vec::new();
    for level in 0..count(options) {
        if level > 0 {
            // From loop to loop: corners that were cut off at the mitre's limit stay as they are.
            let many = at.vertex_count() > FAST_VERTICES;
            let tolerance = if many { MANY_LOOPS_TOLERANCE_MM } else { LOOP_TOLERANCE_MM };
            at = simplified_by(&at, tolerance).offset(options.line_width, Join::WALL);
        }
        let ring = |c: &Contour| Loop { home: 0, level, line: Line::ring(c.points.clone()) };
        loops.extend(at.contours().iter().map(ring));
    }
    let pieces: Vec<Polygon> = at.islands();
    if pieces.len() > 1 {
        for l in &mut loops {
            // Every loop lies within the outermost one or is that one, whose border counts neither way.
            let within = |piece: &Polygon| {
                piece.outer.points.contains(&l.line.points[0]) || piece.outer.contains(l.line.points[0])
            };
            l.home = pieces.iter().position(within).unwrap_or(0);
        }
    }
    loops
}

/// Islands that share a space: the bed around the part, or one of its holes.
struct Group {
    /// The hole's contour, counter-clockwise; `None` outside.
    hole: Option<PolygonSet>,
    /// The islands in it, their holes filled.
    islands: PolygonSet,
}

fn groups(area: &PolygonSet) -> Vec<Group> {
    let islands = area.islands();
    let holes: Vec<Contour> = islands.iter().flat_map(|i| &i.holes).map(Contour::reversed).collect();
    let mut members: Vec<Vec<Contour>> = vec![Vec::new(); holes.len() + 1];
    for island in islands {
        let home = smallest_around(&holes, &island.outer).map_or(0, |i| i + 1);
        members[home].push(island.outer);
    }
    let spaces = std::iter::once(None).chain(holes.into_iter().map(|h| Some(PolygonSet::canonical(vec![h]))));
    spaces.zip(members).map(|(hole, outers)| Group { hole, islands: PolygonSet::canonical(outers) }).collect()
}

/// Index of the smallest hole around an island; no contour crosses another.
fn smallest_around(holes: &[Contour], island: &Contour) -> Option<usize> {
    let fits = |hole: &Contour| {
        let boxes = (hole.bounds(), island.bounds());
        matches!(boxes, (Some(h), Some(i)) if h.contains(i)) && hole.contains(island.points[0])
    };
    let around = (0..holes.len()).filter(|&i| fits(&holes[i]));
    around.min_by(|&i, &j| holes[i].signed_area().total_cmp(&holes[j].signed_area()))
}

fn around_groups(area: &PolygonSet, options: &BrimOptions) -> Vec<Loop> {
    let mut loops: Vec<Loop> = Vec::new();
    for group in groups(area).iter().filter(|g| !g.islands.is_empty()) {
        let found = offsets(&group.islands, options);
        // Away from the wall of the hole that the islands stand in.
        let room = group.hole.as_ref().map(|h| h.offset(-options.gap - options.line_width, Join::WALL));
        add(&mut loops, found, room.as_ref());
    }
    loops
}

fn inside_holes(area: &PolygonSet, options: &BrimOptions) -> Vec<Loop> {
    let mut loops: Vec<Loop> = Vec::new();
    for group in groups(area) {
        let Some(hole) = group.hole else { continue };
        let ring = |level: u32| {
            let inward = options.gap + (f64::from(level) + 0.5) * options.line_width;
            let set = hole.offset(-inward, Join::WALL);
            set.into_contours().into_iter().map(move |c| Loop { home: 0, level, line: Line::ring(c.points) })
        };
        let found = (0..count(options)).flat_map(ring).collect();
        let away = group.islands.offset(options.gap + options.line_width, Join::WALL);
        let room = (!group.islands.is_empty()).then(|| hole.difference(&away));
        add(&mut loops, found, room.as_ref());
    }
    loops
}

/// Adds loops under homes of their own, cut to the room there is.
fn add(loops: &mut Vec<Loop>, found: Vec<Loop>, room: Option<&PolygonSet>) {
    let base = loops.iter().map(|l| l.home + 1).max().unwrap_or(0);
    for Loop { home, level, line } in found {
        let lines = match room {
            Some(room) => to_area(line, room),
            None => vec![line],
        };
        loops.extend(lines.into_iter().map(|line| Loop { home: base + home, level, line }));
    }
}

/// A round area at each convex corner sharper than the limit.
fn ears(area: &PolygonSet, options: &BrimOptions) -> Vec<PolygonSet> {
    let limit = sin_cos(options.ears_max_angle_deg.to_radians()).1;
    let wanted = |c: &&Contour| match options.side {
        BrimSide::Both => true,
        BrimSide::Outer => c.signed_area() > 0.0,
        BrimSide::Inner => c.signed_area() < 0.0,
    };
    let corners = area.contours().iter().filter(wanted).flat_map(|c| sharp_corners(c, limit));
    corners.map(|p| disc(p, options.width + options.gap)).collect()
}

/// Convex corners whose inner angle has a larger cosine than `limit`.
fn sharp_corners(contour: &Contour, limit: f64) -> Vec<DVec2> {
    let points = simplify_ring(contour, CORNER_TOLERANCE_MM).points;
    let n = points.len();
    let is_sharp = |i: &usize| {
        let p = points[*i];
        let u = (points[(i + n - 1) % n] - p).normalize_or_zero();
        let v = (points[(i + 1) % n] - p).normalize_or_zero();
        v.perp_dot(u) > 0.0 && u.dot(v) > limit
    };
    (0..n).filter(is_sharp).map(|i| points[i]).collect()
}

fn disc(centre: DVec2, radius: f64) -> PolygonSet {
    let corner = |i: u32| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / f64::from(EAR_CORNERS));
        centre + dvec2(cos, sin) * radius
    };
    PolygonSet::from_contours(vec![Contour::new((0..EAR_CORNERS).map(corner).collect())])
}

/// What of the loops lies in an ear, ear by ear; ears that overlap are one.
fn cut_to_ears(loops: Vec<Loop>, ears: &[PolygonSet]) -> Vec<Loop> {
    let homes: Vec<PolygonSet> =
        PolygonSet::union_all(ears).islands().into_iter().map(Polygon::into_set).collect();
    let mut cut = Vec::new();
    for (home, ear) in homes.iter().enumerate() {
        for Loop { level, line, .. } in &loops {
            let pieces = to_area(line.clone(), ear).into_iter();
            cut.extend(pieces.map(|line| Loop { home, level: *level, line }));
        }
    }
    cut
}
