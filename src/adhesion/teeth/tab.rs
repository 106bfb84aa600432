//! A tab on each rail to pull the strip off by.

use super::{PlacedTooth, Rail, Site};
use crate::adhesion::FirstLayer;
use crate::adhesion::error::{AdhesionWarning, WarningCode};
use crate::polygon::{Contour, DVec2, Join, PolygonSet};
use crate::region::{Path, Role};
use crate::sort::StableSort;

/// Along the rail: what two fingertips or pliers hold, mm.
const WIDTH_MM: f64 = 6.0;

/// Away from the part, mm.
pub(in crate::adhesion) const LENGTH_MM: f64 = 8.0;

/// One tab per rail, between two teeth where the rail is straightest, and a remark where there is no
/// room.
pub(super) fn tabs(
    first: &FirstLayer,
    site: &Site,
    rails: &[(Rail, Vec<PlacedTooth>)],
) -> (Vec<Path>, Option<AdhesionWarning>) {
    let outer = f64::from(site.options.rail_lines - 1) * first.line_width;
    let mut taken = site.area.offset(site.options.offset + outer, Join::WALL);
    let (mut paths, mut missing) = (Vec::new(), None);
    for (rail, teeth) in rails {
        let mut places = gaps(rail, teeth);
        places.stable_sort_by(|x, y| straightness(rail, *y).total_cmp(&straightness(rail, *x)));
        let mut tabs = places.into_iter().map(|s| Tab::at(rail, s, outer));
        match tabs.find(|tab| tab.has_room(site, &taken, first.line_width)) {
            Some(tab) => {
                taken = taken.union(&tab.area(first.line_width));
                paths.push(tab.path(first.line_width));
            }
            None => missing = missing.or(rail.points.first().copied()),
        }
    }
    let message = "adhesion.teeth.tab: no room on the bed for the tab of one rail".to_owned();
    (paths, missing.map(|at| AdhesionWarning::new(WarningCode::NoRoomForTab, message, Some(at))))
}

/// Arc lengths half-way between neighbouring teeth.
fn gaps(rail: &Rail, teeth: &[PlacedTooth]) -> Vec<f64> {
    let Some(first) = teeth.first() else { return vec![0.0] };
    let next = teeth.iter().skip(1).map(|t| t.from).chain([first.from + rail.length()]);
    teeth.iter().zip(next).map(|(t, next)| (t.to + next) / 2.0).collect()
}

/// Chord of the rail over the tab's width.
fn straightness(rail: &Rail, s: f64) -> f64 {
    rail.at(s - WIDTH_MM / 2.0).distance(rail.at(s + WIDTH_MM / 2.0))
}

/// Where a tab stands: the middle of its root, and its directions.
struct Tab {
    root: DVec2,
    along: DVec2,
    outward: DVec2,
}

impl Tab {
    /// A tab on the loop `outer` mm outside the rail. The part is to the left of the rail.
    fn at(rail: &Rail, s: f64, outer: f64) -> Tab {
        let (before, after) = (rail.at(s - WIDTH_MM / 2.0), rail.at(s + WIDTH_MM / 2.0));
        let along = (after - before).normalize_or_zero();
        let outward = -along.perp();
        Tab { root: rail.at(s) + outward * outer, along, outward }
    }

    fn point(&self, x: f64, y: f64) -> DVec2 {
        self.root + self.along * x + self.outward * y
    }

    /// What its beads cover, but for the half bead that touches the rail.
    fn area(&self, line_width: f64) -> PolygonSet {
        let (half, low) = (WIDTH_MM / 2.0, line_width / 2.0);
        let far = LENGTH_MM + line_width;
        let corners = [(-half, low), (half, low), (half, far), (-half, far)].map(|(x, y)| self.point(x, y));
        PolygonSet::from_contours(vec![Contour::new(corners.to_vec())])
    }

    /// Whether its beads lie on the bed and touch nothing but the rail where they are rooted.
    fn has_room(&self, site: &Site, taken: &PolygonSet, line_width: f64) -> bool {
        let area = self.area(line_width);
        area.bounds().is_some_and(|b| site.bed.contains(b)) && area.intersection(taken).is_empty()
    }

    /// Rows along the rail, to and fro, from the rail outward.
    fn path(&self, line_width: f64) -> Path {
        let rows = (LENGTH_MM / line_width).floor() as u32;
        let half = WIDTH_MM / 2.0 - line_width / 2.0;
        let row = |k: u32| {
            let side = if k.is_multiple_of(2) { half } else { -half };
            let y = f64::from(k + 1) * line_width;
            [self.point(-side, y), self.point(side, y)]
        };
        Path::open(Role::Teeth, (0..rows).flat_map(row).collect(), line_width)
    }
}
