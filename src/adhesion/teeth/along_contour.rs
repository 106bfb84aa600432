//! Teeth along the contour, what is printed by default: every tip at the bite's depth in the printed
//! outline, at even distances along each smooth stretch, none crossing anything.
//!
//! Beyond [Lv 2022], whose teeth edge by edge point past corners and miss curves (`per_edge`).

use super::site::Base;
use super::spacing::{PitchRange, spread};
use super::windows::windows_of;
use super::{PlacedTooth, Rail, Site, Window};
use crate::adhesion::attachment::length_within;
use crate::adhesion::clip::{Line, to_box};
use crate::adhesion::segments::{Segment, Segments, distance_between};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet};
use crate::sort::StableSort;

/// Outline within the rail's distance and this much more counts as reachable, mm.
pub(super) const REACH_SLACK_MM: f64 = 0.02;

/// A tooth that does not fit is tried again in steps of this, mm.
const SHIFT_MM: f64 = 0.25;

/// Share of the teeth that fit which are promised.
const PROMISED: f64 = 0.9;

/// What another way to measure the reachable length may find more, in teeth.
const MEASURE_SLACK: f64 = 0.02;

/// Parts reached all round get at least this many teeth, however small, if they fit.
const FEWEST: u32 = 3;

/// How often teeth are spread again without the windows in which one did not fit.
const TRIES: u32 = 4;

/// Cell of the rails' index, mm.
const RAIL_CELL_MM: f64 = 2.0;

/// Rails with their teeth, and what is missing.
pub(super) struct Placement {
    /// Rails with the teeth along them, in order; a rail without teeth is not printed.
    pub(super) rails: Vec<(Rail, Vec<PlacedTooth>)>,
    /// Teeth that the reachable outline has length for, but that do not fit or leave the bed.
    pub(super) left_out: u32,
    /// Where some of them are missing.
    pub(super) missing_at: Option<DVec2>,
    /// Outer outlines without any tooth: how many, and a point of the first.
    pub(super) bare: Option<(u32, DVec2)>,
}

impl Placement {
    /// All of these teeth, none left out.
    pub(super) fn all(rails: Vec<(Rail, Vec<PlacedTooth>)>) -> Placement {
        Placement { rails, left_out: 0, missing_at: None, bare: None }
    }
}

/// Places teeth along all rails.
pub(super) fn place(site: &Site, rails: &PolygonSet) -> Placement {
    // Not simplified: the outline was, and near rails would come to cross.
    let rails: Vec<Rail> = rails.contours().iter().map(|c| Rail::new(c.points.clone())).collect();
    let index = index_of(&rails);
    let reach = Reach::measure(site, &rails, &index);
    let mut work = Work { site, index, rails: &rails, placed: Placed::new(site) };
    let mut summary = Summary::default();
    let smooth = work.windows(Base::Smooth);
    let around_corners = std::cell::OnceCell::new();
    for owner in (0..site.is_hole.len() as u32).filter(|&o| site.options.holes || !site.is_hole[o as usize]) {
        let own =
            |all: &[Window]| -> Vec<Window> { all.iter().filter(|w| w.owner == owner).copied().collect() };
        let wanted = reach.wanted(site, owner);
        let mut count = work.place_on(own(&smooth), wanted, Base::Smooth);
        if count < wanted {
            let windows = own(around_corners.get_or_init(|| work.windows(Base::AroundCorners)));
            count = work.add_around_corners(windows, wanted, count);
        }
        summary.add(site, &reach, owner, count);
    }
    let teeth = work.placed.teeth;
    summary.into_placement(rails, teeth)
}

fn index_of(rails: &[Rail]) -> Segments {
    let edges = rails.iter().flat_map(|r| r.edges().map(|(_, a, b)| Segment { a, b, owner: 0 }));
    Segments::new(edges.collect(), RAIL_CELL_MM)
}

/// Length of each contour that a rail reaches, mm.
struct Reach {
    /// By the rails as if the bed had no edge.
    whole: Vec<f64>,
    /// By what of them lies on the bed.
    on_bed: Vec<f64>,
}

impl Reach {
    fn measure(site: &Site, rails: &[Rail], index: &Segments) -> Reach {
        let reach = site.options.offset + REACH_SLACK_MM;
        let contours = site.area.contours();
        let whole = length_within(contours, index, reach);
        let bounds = Bounds::of_points(rails.iter().flat_map(|r| &r.points));
        if bounds.is_none_or(|b| site.bed.contains(b)) {
            return Reach { on_bed: whole.clone(), whole };
        }
        let pieces = rails.iter().flat_map(|rail| to_box(Line::ring(rail.points.clone()), site.bed));
        let edges = pieces.flat_map(|line| {
            let closing = line.closed.then(|| (line.points[line.points.len() - 1], line.points[0]));
            let open: Vec<_> = line.points.windows(2).map(|w| (w[0], w[1])).collect();
            open.into_iter().chain(closing).map(|(a, b)| Segment { a, b, owner: 0 })
        });
        let on_bed = length_within(contours, &Segments::new(edges.collect(), RAIL_CELL_MM), reach);
        Reach { whole, on_bed }
    }

    /// Teeth that a contour shall have: one per pitch of reachable length, at least the promised share
    /// of that, and [`FEWEST`].
    fn wanted(&self, site: &Site, owner: u32) -> u32 {
        let reached = self.on_bed[owner as usize];
        let all_round = reached > 0.8 * site.area.contours()[owner as usize].length();
        let fitting = reached / site.options.pitch;
        let least = (PROMISED * fitting + MEASURE_SLACK).ceil();
        (fitting.round().max(least) as u32).max(if all_round { FEWEST } else { 0 })
    }
}

/// Counts over all contours.
#[derive(Default)]
struct Summary {
    left_out: u32,
    missing_at: Option<DVec2>,
    bare: Option<(u32, DVec2)>,
}

impl Summary {
    fn add(&mut self, site: &Site, reach: &Reach, owner: u32, placed: u32) {
        let whole = (reach.whole[owner as usize] / site.options.pitch).round() as u32;
        // Contours have at least three points.
        let at = site.area.contours()[owner as usize].points[0];
        if placed < whole {
            self.left_out += whole - placed;
            self.missing_at = self.missing_at.or(Some(at));
        }
        if placed == 0 && !site.is_hole[owner as usize] {
            self.bare = Some(self.bare.map_or((1, at), |(n, at)| (n + 1, at)));
        }
    }

    fn into_placement(self, rails: Vec<Rail>, teeth: Vec<PlacedTooth>) -> Placement {
        let mut by_rail: Vec<Vec<PlacedTooth>> = vec![Vec::new(); rails.len()];
        for tooth in teeth {
            by_rail[tooth.rail].push(tooth);
        }
        for teeth in &mut by_rail {
            teeth.stable_sort_by(|x, y| x.from.total_cmp(&y.from));
        }
        let rails = rails.into_iter().zip(by_rail).filter(|(_, teeth)| !teeth.is_empty()).collect();
        Placement { rails, left_out: self.left_out, missing_at: self.missing_at, bare: self.bare }
    }
}

/// The teeth standing so far, and what new ones must not touch.
struct Work<'a> {
    site: &'a Site<'a>,
    rails: &'a [Rail],
    index: Segments,
    placed: Placed,
}

impl Work<'_> {
    /// Places up to `wanted` teeth in the windows of one contour; how many stand.
    ///
    /// Where something is in the way of a planned tooth, its window is given up and the teeth are
    /// spread again over the others, so that what is lost in one place is made up in another.
    fn place_on(&mut self, mut windows: Vec<Window>, wanted: u32, base: Base) -> u32 {
        let before = self.placed.teeth.len();
        for _ in 0..TRIES {
            let failed = self.place_spread(&windows, wanted, base);
            let count = (self.placed.teeth.len() - before) as u32;
            if count >= wanted || failed.is_empty() {
                break;
            }
            let kept: Vec<Window> =
                (0..windows.len()).filter(|i| !failed.contains(i)).map(|i| windows[i]).collect();
            if kept.is_empty() {
                break;
            }
            windows = kept;
            self.placed.truncate(before);
        }
        self.fill(&windows, wanted, (self.placed.teeth.len() - before) as u32, base)
    }

    /// Where smooth stretches have no room for all teeth, more of them around corners: in between when
    /// some are missing, anew when most are. `count` teeth of the contour stand already.
    fn add_around_corners(&mut self, windows: Vec<Window>, wanted: u32, count: u32) -> u32 {
        if count > wanted / 2 {
            return self.fill(&windows, wanted, count, Base::AroundCorners);
        }
        let smooth = self.placed.teeth.split_off(self.placed.teeth.len() - count as usize);
        self.placed.truncate(self.placed.teeth.len());
        let found = self.place_on(windows, wanted, Base::AroundCorners);
        if found >= count {
            return found;
        }
        self.placed.truncate(self.placed.teeth.len() - found as usize);
        smooth.into_iter().for_each(|tooth| self.placed.add(tooth));
        count
    }

    fn windows(&self, base: Base) -> Vec<Window> {
        let of = |(i, rail)| windows_of(self.site, i, rail, base);
        self.rails.iter().enumerate().flat_map(of).collect()
    }

    /// Spreads teeth over the windows; those windows in which a planned tooth does not fit.
    fn place_spread(&mut self, windows: &[Window], wanted: u32, base: Base) -> Vec<usize> {
        let options = self.site.options;
        let low = options.base + 0.35 * (options.pitch - options.base);
        let range = PitchRange { low, high: 3.0 * options.pitch };
        let lengths: Vec<f64> = self.rails.iter().map(Rail::length).collect();
        let mut failed = Vec::new();
        for (index, s) in spread(windows, &lengths, wanted, range) {
            if !self.place_near(&windows[index], s, base) {
                failed.push(index);
            }
        }
        failed
    }

    /// Puts a tooth at `s`, or as near to it as one fits.
    fn place_near(&mut self, window: &Window, s: f64, base: Base) -> bool {
        let shifts = (self.site.options.pitch / 2.0 / SHIFT_MM) as i32;
        let tries = (0..=shifts).flat_map(|k| [f64::from(k), -f64::from(k)]).skip(1);
        let inside = |s: &f64| window.ring || (window.from <= *s && *s <= window.to);
        tries.map(|k| s + k * SHIFT_MM).filter(inside).any(|s| self.try_at(window, s, base))
    }

    /// Puts more teeth wherever one fits, until there are enough.
    fn fill(&mut self, windows: &[Window], wanted: u32, mut count: u32, base: Base) -> u32 {
        for window in windows {
            let steps = ((window.to - window.from) / SHIFT_MM) as u32;
            for k in 0..=steps {
                if count >= wanted {
                    return count;
                }
                count += u32::from(self.try_at(window, window.from + f64::from(k) * SHIFT_MM, base));
            }
        }
        count
    }

    fn try_at(&mut self, window: &Window, s: f64, base: Base) -> bool {
        let rail = &self.rails[window.rail];
        let Some((tooth, owner)) = self.site.tooth_at(rail, s, base) else { return false };
        let s = s.rem_euclid(rail.length());
        let half = self.site.options.base / 2.0;
        let placed = PlacedTooth { tooth, rail: window.rail, from: s - half, to: s + half };
        let stands = owner == window.owner
            && self.placed.keeps_clear(&placed, self.site.clearance)
            && self.site.is_free(&tooth, &self.index);
        if stands {
            self.placed.add(placed);
        }
        stands
    }
}

/// Teeth in square cells as wide as the largest tooth, so that neighbours are found quickly.
struct Placed {
    teeth: Vec<PlacedTooth>,
    cell: f64,
    cells: std::collections::BTreeMap<(i64, i64), Vec<u32>>,
}

impl Placed {
    fn new(site: &Site) -> Placed {
        let cell = site.options.base.max(1.1 * site.options.height) + site.clearance;
        Placed { teeth: Vec::new(), cell, cells: Default::default() }
    }

    fn cell_of(&self, tooth: &PlacedTooth) -> (i64, i64) {
        let at = (tooth.tooth.foot / self.cell).floor();
        (at.x as i64, at.y as i64)
    }

    /// Takes away all teeth but the first `count`.
    fn truncate(&mut self, count: usize) {
        self.teeth.truncate(count);
        self.cells.values_mut().for_each(|indices| indices.retain(|&i| (i as usize) < count));
    }

    fn add(&mut self, tooth: PlacedTooth) {
        let index = self.teeth.len() as u32;
        self.cells.entry(self.cell_of(&tooth)).or_default().push(index);
        self.teeth.push(tooth);
    }

    /// Whether the tooth's sides keep `clearance` from all others. Feet of teeth that touch are at most
    /// two teeth apart, so two cells each way are looked at.
    fn keeps_clear(&self, tooth: &PlacedTooth, clearance: f64) -> bool {
        let (x, y) = self.cell_of(tooth);
        let around = (x - 2..=x + 2).flat_map(|x| (y - 2..=y + 2).map(move |y| (x, y)));
        let mut others = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        !others.any(|&i| are_close(tooth, &self.teeth[i as usize], clearance))
    }
}

fn are_close(x: &PlacedTooth, y: &PlacedTooth, clearance: f64) -> bool {
    let sides = |t: &PlacedTooth| [(t.tooth.a, t.tooth.tip), (t.tooth.tip, t.tooth.b)];
    sides(x).into_iter().any(|s| sides(y).into_iter().any(|t| distance_between(s, t) < clearance))
}
