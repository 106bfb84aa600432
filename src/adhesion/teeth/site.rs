//! Where teeth are built: the printed outline, indexed, and the measure of every tooth.

use super::{Rail, Tooth};
use crate::adhesion::options::TeethOptions;
use crate::adhesion::segments::{Near, Segments};
use crate::polygon::PolygonSet;
use crate::polygon::measure::Bounds;

/// How far a tip's depth may be from the bite asked for, mm: the promised 0.05 less what the
/// simplified outline may be off.
const DEPTH_TOLERANCE_MM: f64 = 0.04;

/// A tooth may be longer than asked by this share of the rail's distance: on the outer side of a turn
/// of 30 degrees the mitred rail is 3.5 % farther away.
const FARTHER: f64 = 1.06;

/// Parts thinner than this have no bead to bite into, mm.
const THINNEST_MM: f64 = 0.05;

/// The base's ends are at least this share of the base apart as the crow flies.
const STRAIGHTEST: f64 = 0.5;

/// Cell of the outline's index, mm: about half a tooth.
const CELL_MM: f64 = 1.5;

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
    pub(super) fn tooth_at(&self, rail: &Rail, s: f64) -> Option<(Tooth, u32)> {
        let half = self.options.base / 2.0;
        let (a, p, b) = (rail.at(s - half), rail.at(s), rail.at(s + half));
        let on_bed = self.bed.contains(Bounds { min: a.min(b).min(p), max: a.max(b).max(p) });
        let near = self.outline.nearest(p, self.options.offset * FARTHER)?;
        let wanted = self.options.holes || !self.is_hole[near.owner as usize];
        let wide =
            a.distance(b) >= STRAIGHTEST * self.options.base && rail.length() > 1.5 * self.options.base;
        if !(on_bed && wanted && wide) || rail.has_corner_between(s - half, s + half) {
            return None;
        }
        let inward = (near.point - p).normalize_or_zero();
        let (depth, shallow) = self.depth_wanted(&near, p + inward * (near.distance + 2.0 * self.bite()))?;
        let tip = near.point + inward * depth;
        let bite = self.outline.nearest(tip, depth + DEPTH_TOLERANCE_MM)?.distance;
        let fits =
            (bite - depth).abs() <= DEPTH_TOLERANCE_MM && self.bed.contains(Bounds { min: tip, max: tip });
        fits.then_some((Tooth { a, tip, b, foot: near.point, bite, shallow }, near.owner))
    }

    /// The bite, or half the part's thickness where that is less: the line from the rail through the foot
    /// to `end`, twice the bite deep, leaves the part again.
    fn depth_wanted(&self, near: &Near, end: crate::polygon::DVec2) -> Option<(f64, bool)> {
        let length = near.distance + 2.0 * self.bite();
        let start = near.point + (near.point - end).normalize_or_zero() * near.distance;
        match self.outline.crossings(start, end).as_slice() {
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
            // A side starts on its own rail; one hundredth of it is 0.03 mm.
            let start = end.lerp(tooth.tip, 0.01);
            self.outline.crossings(end, tooth.tip).len() == 1 && rails.crossings(start, tooth.tip).is_empty()
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
