//! Where teeth are built: the printed outline, indexed, and the measure of every tooth.

use super::{Rail, Tooth};
use crate::adhesion::options::TeethOptions;
use crate::adhesion::segments::{Near, Segments};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet};

/// How far a tip's depth may be from the bite asked for, mm: the promised 0.05 less what the
/// simplified outline may be off.
const DEPTH_TOLERANCE_MM: f64 = 0.03;

/// A tooth may be longer than asked by this share of the rail's distance: on the outer side of a turn
/// of 30 degrees the mitred rail is 3.5 % farther away.
const FARTHER: f64 = 1.06;

/// A tooth on a corner may be longer by this factor: its tip goes as deep into a spike as the bite needs.
const FARTHEST_AT_CORNERS: f64 = 2.1;

/// At a spike, how many times as deep as the bite a tip may go along the spike's axis.
const DEEPEST: f64 = 3.0;

/// Steps to the depth in a spike; each is exact for straight flanks.
const STEPS_IN_SPIKE: u32 = 3;

/// Parts thinner than this have no bead to bite into, mm.
const THINNEST_MM: f64 = 0.05;

/// The base's ends are at least this share of the base apart as the crow flies.
const STRAIGHTEST: f64 = 0.5;

/// Shares of a side's length below this are its start.
const ROUNDING: f64 = 1e-9;

/// Cell of the outline's index, mm: about half a tooth.
const CELL_MM: f64 = 1.5;

/// Where a tooth's base may lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Base {
    /// On a smooth stretch of the rail, away from its corners.
    Smooth,
    /// Also around corners: for outlines of short edges and spikes, which have no such stretch.
    AroundCorners,
}

/// The outline that teeth bite into, and their settings.
pub(super) struct Site<'a> {
    pub(super) options: &'a TeethOptions,
    /// The printed outline.
    pub(super) area: &'a PolygonSet,
    /// Its edges; the owner is the contour.
    pub(super) outline: Segments,
    /// For each contour, whether it is a hole.
    pub(super) is_hole: Vec<bool>,
    /// Where centre lines may lie.
    pub(super) bed: Bounds,
    /// Teeth keep this distance from each other, mm.
    pub(super) clearance: f64,
}

impl<'a> Site<'a> {
    pub(super) fn new(area: &'a PolygonSet, bed: Bounds, line_width: f64, options: &'a TeethOptions) -> Self {
        Site {
            options,
            area,
            outline: Segments::of_contours(area.contours(), CELL_MM),
            is_hole: area.contours().iter().map(|c| c.signed_area() < 0.0).collect(),
            bed: bed.grown(-line_width / 2.0),
            // Half a line, so that beads stay apart near the tips; less when base and pitch leave less.
            clearance: (line_width / 2.0).min((options.pitch - options.base) / 4.0),
        }
    }

    /// H - d.
    pub(super) fn bite(&self) -> f64 {
        self.options.height - self.options.offset
    }

    /// The tooth with its base around arc length `s`, turned to the nearest point of the outline, if its
    /// tip lies at the right depth there. Also the contour it bites.
    pub(super) fn tooth_at(&self, rail: &Rail, s: f64, base: Base) -> Option<(Tooth, u32)> {
        let half = self.options.base / 2.0;
        let (a, p, b) = (rail.at(s - half), rail.at(s), rail.at(s + half));
        let farthest = match base {
            Base::Smooth if rail.has_corner_between(s - half, s + half) => return None,
            Base::Smooth => FARTHER,
            Base::AroundCorners => FARTHEST_AT_CORNERS,
        };
        let near = self.outline.nearest(p, self.options.offset * farthest)?;
        let wanted = self.options.holes || !self.is_hole[near.owner as usize];
        let wide =
            a.distance(b) >= STRAIGHTEST * self.options.base && rail.length() > 1.5 * self.options.base;
        let inward = (near.point - p).normalize_or_zero();
        let (tip, bite, shallow) = if wanted && wide { self.tip(&near, p, inward)? } else { return None };
        let on_bed = [a, p, b, tip].iter().all(|p| p.clamp(self.bed.min, self.bed.max) == *p);
        on_bed.then_some((Tooth { a, tip, b, foot: near.point, bite, shallow }, near.owner))
    }

    /// Tip, its depth and whether that is less than asked for, on the way from the rail at `p` inward.
    fn tip(&self, near: &Near, p: DVec2, inward: DVec2) -> Option<(DVec2, f64, bool)> {
        let (depth, shallow) = self.depth_wanted(near, p, inward)?;
        let bite_at = |way: f64| {
            let found = self.outline.nearest(near.point + inward * way, way + DEPTH_TOLERANCE_MM);
            found.map_or(0.0, |n| n.distance)
        };
        let (mut way, mut bite) = (depth, bite_at(depth));
        for _ in 0..STEPS_IN_SPIKE {
            if bite >= depth - DEPTH_TOLERANCE_MM / 2.0 || shallow || bite * DEEPEST < depth {
                break;
            }
            way = (way * depth / bite).min(depth * DEEPEST);
            bite = bite_at(way);
        }
        let fits = (bite - depth).abs() <= DEPTH_TOLERANCE_MM;
        fits.then_some((near.point + inward * way, bite, shallow))
    }

    /// The bite, or half the part's thickness where that is less: the line inward through the foot, twice
    /// the bite deep, leaves the part again.
    fn depth_wanted(&self, near: &Near, p: DVec2, inward: DVec2) -> Option<(f64, bool)> {
        let length = near.distance + 2.0 * self.bite();
        match self.outline.crossings(p, p + inward * length).as_slice() {
            [] => None,
            [_enters] => Some((self.bite(), false)),
            [enters, leaves, ..] => {
                let thickness = (leaves - enters) * length;
                (thickness >= THINNEST_MM).then_some((thickness / 2.0, true))
            }
        }
    }

    /// Whether each side of the tooth crosses the outline once, on its way in, and no rail.
    pub(super) fn is_free(&self, tooth: &Tooth, rails: &Segments) -> bool {
        [tooth.a, tooth.b].into_iter().all(|end| {
            // It starts on its own rail, to rounding.
            let meets_rail = rails.crossings(end, tooth.tip).iter().any(|&share| share > ROUNDING);
            self.outline.crossings(end, tooth.tip).len() == 1 && !meets_rail
        })
    }

    /// The tooth with its true depth: the tip's distance from the outline, negative outside.
    pub(super) fn measured(&self, tooth: Tooth) -> Tooth {
        let within = 4.0 * (self.options.height + self.options.offset);
        let distance = self.outline.nearest(tooth.tip, within).map_or(within, |near| near.distance);
        let bite = if self.area.contains(tooth.tip) { distance } else { -distance };
        Tooth { bite, shallow: bite > 0.0 && bite < self.bite() - DEPTH_TOLERANCE_MM, ..tooth }
    }
}
