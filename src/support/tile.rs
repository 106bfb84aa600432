//! The support region within one tile, from layer to layer.

use std::cell::OnceCell;

use crate::polygon::grid::{EdgeGrid, do_cross};
use crate::polygon::island::{Island, inner_point};
use crate::polygon::measure::Bounds;
use crate::polygon::sets::Sets;
use crate::polygon::strips::Strips;
use crate::polygon::tiles::{Piece, pieces_of};
use crate::polygon::{Contour, DVec2, Polygon, PolygonSet, dvec2};

/// Slits and slivers of a support region that are thinner than this, mm, are rounding artefacts of
/// borders that ran along each other: three grid steps.
const THIN_MM: f64 = 3e-4;

/// How far ESF_k reaches over its border with S_(k+1), mm. Both run along A_(k+1) there and are
/// rounded each in its own way. Without this a slit may stay between them, and each layer's piece
/// counts as a structure of its own (129 instead of 3 in one trial).
const BRIDGE_MM: f64 = 3e-4;

/// Jags of a support region's free border that stick out by less than this share of a layer's height are cut
/// off. Only outward ones: filling dents would lay slivers past the part's walls, and borders along the part
/// stay exact, or slits would open there.
const JAG_SHARE: f64 = 0.05;

/// A border this near to the part's, mm, runs along it.
const ALONG_MM: f64 = 2e-3;

/// Regions of so many pairs of edges with the part are cut by it without looking first whether they meet.
const MOST_PAIRS: usize = 10_000;

/// What needs support may touch components of the region whose boxes are this near, mm.
const NEAR_MM: f64 = 1e-3;

/// One cut takes at most so many vertices off.
const MOST_CUT: usize = 24;

/// What of a support region lies in one tile.
#[derive(Debug)]
pub(super) struct Tile {
    bounds: Bounds,
    /// What of A_k lay here when the region was made.
    area: PolygonSet,
    /// S_k, and its components.
    region: PolygonSet,
    parts: Vec<Part>,
    area_mm2: f64,
    inside: OnceCell<Strips>,
}

/// A component of S_k within a tile and the structure it belongs to.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) piece: Piece,
    pub(super) node: usize,
    pub(super) area_mm2: f64,
    /// A point well inside, once asked for.
    inner: OnceCell<Option<DVec2>>,
}

impl Part {
    fn new(piece: Piece, node: usize) -> Part {
        Part { area_mm2: piece.island.polygon.area(), piece, node, inner: OnceCell::new() }
    }

    fn inner_point(&self) -> Option<DVec2> {
        *self.inner.get_or_init(|| inner_point(&self.piece.island.polygon))
    }

    fn overlap(&self, other: &Island) -> PolygonSet {
        self.piece.island.polygon.clone().into_set().intersection(&other.polygon.clone().into_set())
    }
}

impl Tile {
    /// An empty one.
    pub(super) fn new(bounds: Bounds) -> Tile {
        Tile {
            bounds,
            area: PolygonSet::EMPTY,
            region: PolygonSet::EMPTY,
            parts: Vec::new(),
            area_mm2: 0.0,
            inside: OnceCell::new(),
        }
    }

    /// S_k here, and its components.
    pub(super) fn region(&self) -> &PolygonSet {
        &self.region
    }

    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    pub(super) fn area_mm2(&self) -> f64 {
        self.area_mm2
    }

    /// Whether `p` lies in S_k.
    pub(super) fn contains(&self, p: DVec2) -> bool {
        !self.region.is_empty() && self.inside.get_or_init(|| Strips::new(&self.region)).contain(p)
    }

    /// S_k = (S_(k+1) u ESF_k) - A_k, for a layer of height `layer_height` mm; whether anything changed.
    ///
    /// Components that neither meet the part nor anything new stay as they are.
    pub(super) fn descend(
        &mut self,
        area: PolygonSet,
        esf: &PolygonSet,
        layer_height: f64,
        sets: &mut Sets,
    ) -> bool {
        let is_as_before = area == self.area || self.region.is_empty();
        self.area = area;
        let edges: Vec<(DVec2, DVec2)> = match is_as_before {
            true => Vec::new(),
            false => self.area.contours().iter().flat_map(Contour::edges).collect(),
        };
        let meets: Vec<bool> =
            self.parts.iter().map(|part| !is_as_before && !self.is_surely_apart(part, &edges)).collect();
        let stays = !meets.contains(&true);
        if esf.is_empty() && stays {
            return false;
        }
        let new: Vec<Bounds> = esf.contours().iter().filter_map(Contour::bounds).collect();
        let is_new_near = |part: &Part| new.iter().any(|b| b.is_near(part.piece.island.bounds, NEAR_MM));
        let (above, kept): (Vec<_>, Vec<_>) = std::mem::take(&mut self.parts)
            .into_iter()
            .zip(meets)
            .partition(|(part, meets)| *meets || is_new_near(part));
        let [above, mut kept]: [Vec<Part>; 2] =
            [above, kept].map(|parts| parts.into_iter().map(|(part, _)| part).collect());
        let region = area_of(&above);
        let mut held = reaching_over(esf, &region, self.bounds);
        held.extend_from_slice(region.contours());
        // These contours overlap: one operand of the difference, which counts what is wound around.
        let held = PolygonSet::canonical(held);
        // What needs support lies beside the part, so that both leave the rest alone.
        let cut_by = if stays { &PolygonSet::EMPTY } else { &self.area };
        let left = held.wound_difference(cut_by);
        let left = self.without_jags(without_slivers(left), JAG_SHARE * layer_height);
        let changed = !esf.is_empty() || left != region;
        if changed {
            let parts: Vec<Part> =
                pieces_of(&left, self.bounds).into_iter().map(|piece| Part::new(piece, sets.add())).collect();
            self.join_parts(&above, &parts, sets);
            kept.extend(parts);
        } else {
            kept.extend(above);
        }
        self.parts = kept;
        if changed {
            self.region = area_of(&self.parts);
            self.area_mm2 = self.parts.iter().map(|part| part.area_mm2).sum();
            self.inside.take();
        }
        changed
    }

    /// Joins `parts` of S_k to those of S_(k+1), `above`, that they overlap.
    ///
    /// A point inside one that lies in the other settles it for most; the overlap itself is made
    /// for those whose point lies in the part above or below.
    fn join_parts(&self, above: &[Part], parts: &[Part], sets: &mut Sets) {
        for part in parts {
            let shared = |other: &Part| part.overlap(&other.piece.island).islands();
            join_to(part, above, sets, shared);
        }
        for part in above {
            // Nothing of S_k lies in A_k.
            let shared =
                |_: &Part| part.piece.island.polygon.clone().into_set().difference(&self.area).islands();
            join_to(part, parts, sets, shared);
        }
    }

    /// The region without jags of its free border lower than `height` mm: those borders are what many
    /// layers above left, and hold most of the vertices.
    fn without_jags(&self, region: PolygonSet, height: f64) -> PolygonSet {
        let part = OnceCell::new();
        let is_free = |p: DVec2| {
            let part = part.get_or_init(|| {
                EdgeGrid::new(&self.area.contours().iter().flat_map(Contour::edges).collect::<Vec<_>>())
            });
            !self.is_on_border(p) && part.nearest_edge(p, ALONG_MM).is_none()
        };
        let contours = region.into_contours().into_iter().map(|contour| cut_jags(contour, is_free, height));
        PolygonSet::canonical(contours.collect())
    }

    /// Whether nothing of the component lies in A_k, of which these are the edges. Without a doubt only: false
    /// says nothing.
    fn is_surely_apart(&self, part: &Part, edges: &[(DVec2, DVec2)]) -> bool {
        let Island { polygon, bounds } = &part.piece.island;
        let is_near =
            |&&(a, b): &&(DVec2, DVec2)| Bounds { min: a.min(b), max: a.max(b) }.is_near(*bounds, 0.0);
        let near: Vec<(DVec2, DVec2)> = edges.iter().filter(is_near).copied().collect();
        let contours = || polygon.contours();
        if near.len() * contours().map(|c| c.points.len()).sum::<usize>() > MOST_PAIRS {
            return false;
        }
        let is_outside = |contour: &Contour| {
            let inner = contour.points.iter().find(|p| !self.is_on_border(**p));
            inner.is_some_and(|&p| !self.area.contains(p))
        };
        !contours().flat_map(Contour::edges).any(|(a, b)| near.iter().any(|&(c, d)| do_cross(a, b, c, d)))
            && contours().all(is_outside)
            && !near.iter().any(|&(p, _)| !self.is_on_border(p) && part.piece.island.contains(p))
    }

    fn is_on_border(&self, p: DVec2) -> bool {
        p.cmpeq(self.bounds.min).any() || p.cmpeq(self.bounds.max).any()
    }
}

/// The components as one area.
fn area_of(parts: &[Part]) -> PolygonSet {
    let contours = parts.iter().flat_map(|part| part.piece.island.polygon.contours());
    PolygonSet::canonical(contours.cloned().collect())
}

/// Joins `part` to the one of `others` that holds its inner point, else to those that hold an inner
/// point of what they share.
fn join_to(part: &Part, others: &[Part], sets: &mut Sets, shared: impl Fn(&Part) -> Vec<Polygon>) {
    let holds = |point: DVec2| move |other: &&Part| other.piece.island.contains(point);
    if let Some(other) = part.inner_point().and_then(|p| others.iter().find(holds(p))) {
        sets.join(part.node, other.node);
        return;
    }
    for other in
        others.iter().filter(|other| other.piece.island.bounds.is_near(part.piece.island.bounds, 0.0))
    {
        let points = shared(other).into_iter().filter_map(|piece| inner_point(&piece));
        if points.into_iter().any(|p| other.piece.island.contains(p)) {
            sets.join(part.node, other.node);
        }
    }
}

/// `esf` reaching over the slit to `region` by [`BRIDGE_MM`] where the two share a border; free
/// borders stay where they are.
///
/// Nothing reaches out of the tile.
fn reaching_over(esf: &PolygonSet, region: &PolygonSet, bounds: Bounds) -> Vec<Contour> {
    if region.is_empty() || esf.is_empty() {
        return esf.contours().to_vec();
    }
    let strips = Strips::new(region);
    let within = |mut contour: Contour| {
        contour.points.iter_mut().for_each(|p| *p = p.clamp(bounds.min, bounds.max));
        contour
    };
    esf.contours().iter().map(|contour| within(reach_over(contour, &strips))).collect()
}

fn reach_over(contour: &Contour, region: &Strips) -> Contour {
    let mut edges = Vec::with_capacity(contour.points.len());
    contour.edges().for_each(|(a, b)| split_shared(a, b, region, SPLITS, &mut edges));
    let mut points = Vec::with_capacity(edges.len());
    for (i, &(at, out)) in edges.iter().enumerate() {
        let (_, before) = edges[if i == 0 { edges.len() - 1 } else { i - 1 }];
        match (before, out) {
            (None, None) => points.push(at),
            (Some(before), None) => points.extend([at + before * BRIDGE_MM, at]),
            (None, Some(out)) => points.extend([at, at + out * BRIDGE_MM]),
            (Some(before), Some(out)) => points.push(at + (before + out).normalize_or(out) * BRIDGE_MM),
        }
    }
    Contour::new(points)
}

/// How often an edge that shares its border in part is halved: a 4,000th of its length is exact
/// enough for a strip of [`BRIDGE_MM`].
const SPLITS: u32 = 12;

/// Appends the edge from a to b as start points with the outward normal where `region` lies across
/// it, and `None` where nothing does.
fn split_shared(a: DVec2, b: DVec2, region: &Strips, splits: u32, edges: &mut Vec<(DVec2, Option<DVec2>)>) {
    let along = (b - a).normalize_or_zero();
    let out = dvec2(along.y, -along.x);
    let beyond = |share: f64| region.contain(a.lerp(b, share) + out * BRIDGE_MM);
    let across = [beyond(0.01), beyond(0.5), beyond(0.99)];
    if across == [true; 3] || across == [false; 3] || splits == 0 {
        return edges.push((a, across[1].then_some(out)));
    }
    let middle = a.lerp(b, 0.5);
    split_shared(a, middle, region, splits - 1, edges);
    split_shared(middle, b, region, splits - 1, edges);
}

/// The area without slits and slivers.
fn without_slivers(area: PolygonSet) -> PolygonSet {
    let thin = |c: &Contour| 2.0 * c.signed_area().abs() < THIN_MM * c.length();
    if !area.contours().iter().any(thin) {
        return area;
    }
    PolygonSet::canonical(area.into_contours().into_iter().filter(|c| !thin(c)).collect())
}

/// Leaves out runs of free vertices that lie outside the chord across them, and nearer to it than `height`.
fn cut_jags(contour: Contour, is_free: impl Fn(DVec2) -> bool, height: f64) -> Contour {
    let points = &contour.points;
    let n = points.len();
    let mut kept = Vec::with_capacity(n);
    let mut from = 0;
    while from < n {
        kept.push(points[from]);
        let may_skip = |&to: &usize| {
            let (a, along) = (points[from], points[to % n] - points[from]);
            // The region lies to the left.
            let out = |p: DVec2| -along.perp_dot(p - a);
            let most = height * along.length();
            points[from + 1..to].iter().all(|&p| (0.0..=most).contains(&out(p))) && is_free(points[to - 1])
        };
        from = (from + 2..=(from + 1 + MOST_CUT).min(n)).take_while(may_skip).last().unwrap_or(from + 1);
    }
    if kept.len() < 3 { contour } else { Contour::new(kept) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::tiles::Tiles;

    #[test]
    fn jags_of_free_borders_are_cut_and_dents_stay() {
        let points =
            [(0.0, 0.0), (5.0, -0.01), (10.0, 0.0), (10.01, 5.0), (10.0, 10.0), (5.0, 9.99), (0.0, 10.0)];
        let shape = PolygonSet::canonical(vec![Contour::new(points.map(|(x, y)| dvec2(x, y)).to_vec())]);
        // The part lies along the jag at the right.
        let part = PolygonSet::rectangle(dvec2(10.011, 4.0), dvec2(20.0, 6.0));
        let tile = Tile { area: part, ..Tile::new(Tiles::whole().bounds(0)) };
        let found = tile.without_jags(shape.clone(), 0.02);
        let left: Vec<DVec2> = found.contours()[0].points.clone();
        assert_eq!(left.len(), 6, "{left:?}");
        assert!(left.contains(&dvec2(10.01, 5.0)) && left.contains(&dvec2(5.0, 9.99)));
        assert!(!left.contains(&dvec2(5.0, -0.01)));
        assert_eq!(tile.without_jags(shape.clone(), 0.005), shape);
    }
}
