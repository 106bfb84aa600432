//! Union, difference and intersection, over `clipper2-rust` on the integer grid.
//!
//! Only this file and `offset.rs` know that library. Slivers below [`NOTHING_MM2`] are dropped.

use std::cell::RefCell;

use clipper2_rust::{ClipType, Clipper64, FillRule, Path64, Paths64, Point64};

use super::groups::groups_of;
use super::measure::Bounds;
use super::{Contour, DVec2, GRID_PER_MM, PolygonSet, dvec2, grid_steps};

/// A connected area smaller than this is a rounding artefact, mm2 (100 grid cells).
pub const NOTHING_MM2: f64 = 1e-6;

impl PolygonSet {
    /// What lies in `self` or in `other`.
    pub fn union(&self, other: &PolygonSet) -> PolygonSet {
        if other.is_empty() {
            return self.clone();
        }
        if self.is_empty() {
            return other.clone();
        }
        run(ClipType::Union, to_paths(self.contours()), to_paths(other.contours()))
    }

    /// What lies in `self` but not in `other`.
    pub fn difference(&self, other: &PolygonSet) -> PolygonSet {
        if self.is_empty() || other.is_empty() || !self.may_touch(other) {
            return self.clone();
        }
        if self == other {
            return PolygonSet::EMPTY;
        }
        run(ClipType::Difference, to_paths(self.contours()), to_paths(other.contours()))
    }

    /// What of `self` and of `other` hangs together by the boxes of contours, as pairs: a boolean of the two is
    /// that of each pair. The library's time grows with the number of edges that a level line meets, whether or
    /// not they have to do with each other.
    pub fn grouped_with(&self, other: &PolygonSet) -> Vec<[PolygonSet; 2]> {
        let contours: Vec<&Contour> = self.contours().iter().chain(other.contours()).collect();
        let boxes: Vec<Bounds> = contours.iter().filter_map(|c| c.bounds()).collect();
        let groups = groups_of(&boxes, 0.0);
        if groups.len() < 2 || boxes.len() < contours.len() {
            return vec![[self.clone(), other.clone()]];
        }
        let count = self.contours().len();
        let of =
            |members: &[usize]| PolygonSet::canonical(members.iter().map(|&i| contours[i].clone()).collect());
        let pair = |group: Vec<usize>| {
            let own = group.partition_point(|&i| i < count);
            [of(&group[..own]), of(&group[own..])]
        };
        groups.into_iter().map(pair).collect()
    }

    /// Like [`PolygonSet::difference`] where contours of `self` may overlap, or run to and fro on one line:
    /// what they wind around counts.
    pub fn wound_difference(&self, other: &PolygonSet) -> PolygonSet {
        if !self.is_empty() && !self.may_touch(other) {
            return unite(self.contours().to_vec());
        }
        self.difference(other)
    }

    /// What lies in both.
    pub fn intersection(&self, other: &PolygonSet) -> PolygonSet {
        if self.is_empty() || other.is_empty() || !self.may_touch(other) {
            return PolygonSet::EMPTY;
        }
        if self == other {
            return self.clone();
        }
        run(ClipType::Intersection, to_paths(self.contours()), to_paths(other.contours()))
    }

    /// What lies in exactly one of the two.
    pub fn symmetric_difference(&self, other: &PolygonSet) -> PolygonSet {
        run(ClipType::Xor, to_paths(self.contours()), to_paths(other.contours()))
    }

    /// The union of many areas in one pass.
    pub fn union_all<'a>(sets: impl IntoIterator<Item = &'a PolygonSet>) -> PolygonSet {
        let mut sets = sets.into_iter().filter(|s| !s.is_empty()).peekable();
        let Some(first) = sets.next() else { return PolygonSet::EMPTY };
        if sets.peek().is_none() {
            return first.clone();
        }
        let paths: Paths64 =
            std::iter::once(first).chain(sets).flat_map(|s| to_paths(s.contours())).collect();
        run(ClipType::Union, paths, Paths64::new())
    }

    /// What of `self` lies in at least one of `sets`, in one pass.
    pub fn intersection_with_any<'a>(&self, sets: impl IntoIterator<Item = &'a PolygonSet>) -> PolygonSet {
        let clips: Paths64 = sets.into_iter().flat_map(|s| to_paths(s.contours())).collect();
        if self.is_empty() || clips.is_empty() {
            return PolygonSet::EMPTY;
        }
        run(ClipType::Intersection, to_paths(self.contours()), clips)
    }

    /// The pieces of open polylines that lie inside `self`, each with at least two points.
    pub fn clip_lines(&self, lines: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
        if self.is_empty() || lines.is_empty() {
            return Vec::new();
        }
        let open: Paths64 = lines.iter().map(|l| l.iter().map(|&p| to_point(p)).collect()).collect();
        let mut clipper = Clipper64::new();
        clipper.add_open_subject(&open);
        clipper.add_clip(&to_paths(self.contours()));
        let (mut areas, mut pieces) = (Paths64::new(), Paths64::new());
        clipper.execute(ClipType::Intersection, FillRule::NonZero, &mut areas, Some(&mut pieces));
        pieces.iter().map(from_path).filter(|l| l.len() >= 2).collect()
    }

    fn may_touch(&self, other: &PolygonSet) -> bool {
        matches!((self.bounds(), other.bounds()), (Some(a), Some(b)) if a.is_near(b, 0.0))
    }
}

/// The area wound around at least once, whatever the contours' order, overlaps or direction.
pub(super) fn unite(contours: Vec<Contour>) -> PolygonSet {
    run(ClipType::Union, to_paths(&contours), Paths64::new())
}

fn run(kind: ClipType, subjects: Paths64, clips: Paths64) -> PolygonSet {
    let mut solution = Paths64::new();
    CLIPPER.with_borrow_mut(|clipper| {
        // Also what an operation left behind that panicked.
        clipper.clear();
        clipper.set_preserve_collinear(false);
        clipper.add_subject(&subjects);
        clipper.add_clip(&clips);
        clipper.execute(kind, FillRule::NonZero, &mut solution, None);
    });
    from_paths(&solution)
}

thread_local! {
    /// Keeps the memory of its tables from one operation to the next: many are small.
    static CLIPPER: RefCell<Clipper64> = RefCell::new(Clipper64::new());
}

pub(super) fn to_paths(contours: &[Contour]) -> Paths64 {
    contours.iter().map(|c| c.points.iter().map(|&p| to_point(p)).collect()).collect()
}

pub(super) fn from_paths(paths: &Paths64) -> PolygonSet {
    let contours = paths.iter().map(|p| Contour::new(from_path(p)));
    PolygonSet::canonical(contours.filter(|c| c.signed_area().abs() >= NOTHING_MM2).collect())
}

fn from_path(path: &Path64) -> Vec<DVec2> {
    path.iter().map(|p| dvec2(p.x as f64 / GRID_PER_MM, p.y as f64 / GRID_PER_MM)).collect()
}

fn to_point(p: DVec2) -> Point64 {
    let steps = grid_steps(p);
    Point64::new(steps.x as i64, steps.y as i64)
}
