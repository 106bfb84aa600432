//! The support region within one tile, from layer to layer.

use std::cell::OnceCell;

use crate::polygon::grid::{EdgeGrid, do_cross};
use crate::polygon::island::{inner_point, inner_point_of};
use crate::polygon::measure::{Bounds, vertex_count};
use crate::polygon::strips::Strips;
use crate::polygon::tiles::{Piece, pieces_of};
use crate::polygon::{Contour, DVec2, Polygon, PolygonSet, dvec2};
use crate::sets::Sets;

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

/// A part is united anew once it has grown to so many times its vertices, and so many more.
const GROWN_TIMES: usize = 2;
const GROWN_BY: usize = 50;

/// What of a support region lies in one tile.
#[derive(Debug)]
pub(super) struct Tile {
    bounds: Bounds,
    /// What of A_k lay here when the region was made.
    area: PolygonSet,
    /// The components of S_k.
    parts: Vec<Part>,
    area_mm2: f64,
}

/// A component of S_k within a tile and the structure it belongs to.
#[derive(Debug)]
pub(super) struct Part {
    /// United contours, then those of what grew to it since: these may touch and overlap others.
    pub(super) piece: Piece,
    pub(super) node: usize,
    pub(super) area_mm2: f64,
    /// How many contours, and vertices of them, are united.
    united: usize,
    united_vertices: usize,
    /// A point well inside, once asked for.
    inner: OnceCell<Option<DVec2>>,
    inside: OnceCell<Strips>,
}

impl Part {
    fn new(piece: Piece, node: usize) -> Part {
        Part {
            area_mm2: piece.contours.iter().map(Contour::signed_area).sum(),
            united: piece.contours.len(),
            united_vertices: vertex_count(&piece.contours),
            piece,
            node,
            inner: OnceCell::new(),
            inside: OnceCell::new(),
        }
    }

    /// Takes in what touches it.
    fn absorb(&mut self, other: Part) {
        self.piece.absorb(other.piece);
        self.area_mm2 += other.area_mm2;
        self.inside.take();
    }

    fn is_united(&self) -> bool {
        self.united == self.piece.contours.len()
    }

    fn has_grown(&self) -> bool {
        vertex_count(&self.piece.contours) > GROWN_TIMES * self.united_vertices + GROWN_BY
    }

    fn inner_point(&self) -> Option<DVec2> {
        *self.inner.get_or_init(|| inner_point_of(self.piece.contours[..self.united].iter()))
    }

    /// Whether `p` lies inside (points on the border may fall either way).
    fn contains(&self, p: DVec2) -> bool {
        self.piece.bounds.contains(Bounds { min: p, max: p })
            && self.inside.get_or_init(|| Strips::of_contours(&self.piece.contours)).contain(p)
    }

    fn set(&self) -> PolygonSet {
        PolygonSet::canonical(self.piece.contours.clone())
    }

    /// What it covers; more than one only where rounding parts it.
    pub(super) fn polygons(&self) -> Vec<Polygon> {
        if self.is_united() { self.set() } else { PolygonSet::from_contours(self.piece.contours.clone()) }
            .islands()
    }
}

impl Tile {
    /// An empty one.
    pub(super) fn new(bounds: Bounds) -> Tile {
        Tile { bounds, area: PolygonSet::EMPTY, parts: Vec::new(), area_mm2: 0.0 }
    }

    /// The components of S_k here.
    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    pub(super) fn area_mm2(&self) -> f64 {
        self.area_mm2
    }

    /// Whether `p` lies in S_k.
    pub(super) fn contains(&self, p: DVec2) -> bool {
        self.parts.iter().any(|part| part.contains(p))
    }

    /// S_k = (S_(k+1) u ESF_k) - A_k, for a layer of height `layer_height` mm; whether anything changed.
    ///
    /// Components that neither meet the part nor anything new stay as they are; those that only touch something
    /// new take it in as it is.
    pub(super) fn descend(
        &mut self,
        area: PolygonSet,
        esf: &PolygonSet,
        layer_height: f64,
        sets: &mut Sets,
    ) -> bool {
        let meets = self.meet(area);
        if esf.is_empty() && !meets.contains(&true) {
            return false;
        }
        let new = self.pieces_without_double_edges(esf);
        let jag = JAG_SHARE * layer_height;
        let groups = group(std::mem::take(&mut self.parts), &meets, new, self.bounds);
        let mut held = Held::default();
        let mut changed = !esf.is_empty();
        for group in groups {
            match group {
                Group { meets: true, parts, new } => held.take(parts, new),
                Group { parts, new, .. } => self.grow(parts, new, jag, sets),
            }
        }
        changed |= self.cut(held, jag, sets);
        if changed {
            self.area_mm2 = self.parts.iter().map(|part| part.area_mm2).sum();
        }
        changed
    }

    /// Enters A_k, and tells which components may meet it.
    fn meet(&mut self, area: PolygonSet) -> Vec<bool> {
        let is_as_before = area == self.area || self.parts.is_empty();
        self.area = area;
        if is_as_before {
            return vec![false; self.parts.len()];
        }
        let edges: Vec<(DVec2, DVec2)> = self.area.contours().iter().flat_map(Contour::edges).collect();
        self.parts.iter().map(|part| !self.is_surely_apart(part, &edges)).collect()
    }

    /// The pieces of an area cut along the tile's borders.
    fn pieces_without_double_edges(&self, area: &PolygonSet) -> Vec<Piece> {
        let area = match self.has_double_edges(area) {
            true => PolygonSet::from_contours(area.contours().to_vec()),
            false => area.clone(),
        };
        pieces_of(&without_slivers(area), self.bounds)
    }

    /// Whether the outline runs along one stretch of a border twice.
    fn has_double_edges(&self, area: &PolygonSet) -> bool {
        let on_border: Vec<Bounds> = area
            .contours()
            .iter()
            .flat_map(Contour::edges)
            .filter(|(a, b)| (0..2).any(|axis| a[axis] == b[axis] && self.is_on_border_along(*a, axis)))
            .map(|(a, b)| Bounds { min: a.min(b), max: a.max(b) })
            .collect();
        let overlaps = |a: &Bounds, b: &Bounds| {
            let shared = a.max.min(b.max) - a.min.max(b.min);
            shared.min_element() >= 0.0 && shared.max_element() > 0.0
        };
        on_border.iter().enumerate().any(|(i, a)| on_border[..i].iter().any(|b| overlaps(a, b)))
    }

    fn is_on_border_along(&self, p: DVec2, axis: usize) -> bool {
        p[axis] == self.bounds.min[axis] || p[axis] == self.bounds.max[axis]
    }

    /// Components that do not meet A_k, and what is new beside them, become one.
    fn grow(&mut self, parts: Vec<Part>, new: Vec<Part>, jag: f64, sets: &mut Sets) {
        let node = parts.first().map_or_else(|| sets.add(), |first| first.node);
        for part in &parts {
            sets.join(node, part.node);
        }
        let Some(mut whole) = parts.into_iter().chain(new).reduce(|mut whole, further| {
            whole.absorb(further);
            whole
        }) else {
            return;
        };
        whole.node = node;
        if !whole.has_grown() {
            return self.parts.push(whole);
        }
        let united = PolygonSet::from_contours(whole.piece.contours);
        let united = self.without_jags(without_slivers(united), jag);
        self.parts.extend(pieces_of(&united, self.bounds).into_iter().map(|piece| Part::new(piece, node)));
    }

    /// Cuts components, and what is new beside them, by A_k; whether that changed them.
    fn cut(&mut self, held: Held, jag: f64, sets: &mut Sets) -> bool {
        let Held { above, new } = held;
        if above.is_empty() {
            return false;
        }
        let may_stay = new.is_empty() && above.iter().all(Part::is_united);
        let mut held = new;
        held.extend(above.iter().flat_map(|part| &part.piece.contours).cloned());
        // These contours may overlap: one operand of the difference, which counts what is wound around.
        let held = PolygonSet::canonical(held);
        let left = held.wound_difference(&self.area);
        let left = self.without_jags(without_slivers(left), jag);
        if may_stay && left == held {
            self.parts.extend(above);
            return false;
        }
        let parts: Vec<Part> =
            pieces_of(&left, self.bounds).into_iter().map(|piece| Part::new(piece, sets.add())).collect();
        self.join_parts(&above, &parts, sets);
        self.parts.extend(parts);
        true
    }

    /// Joins `parts` of S_k to those of S_(k+1), `above`, that they overlap.
    ///
    /// A point inside one that lies in the other settles it for most; the overlap itself is made
    /// for those whose point lies in the part above or below.
    fn join_parts(&self, above: &[Part], parts: &[Part], sets: &mut Sets) {
        for part in parts {
            join_to(part, above, sets, |other| part.set().intersection(&other.set()).islands());
        }
        for part in above {
            // Nothing of S_k lies in A_k.
            join_to(part, parts, sets, |_| part.set().difference(&self.area).islands());
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
        let Piece { contours, bounds, .. } = &part.piece;
        let is_near =
            |&&(a, b): &&(DVec2, DVec2)| Bounds { min: a.min(b), max: a.max(b) }.is_near(*bounds, 0.0);
        let near: Vec<(DVec2, DVec2)> = edges.iter().filter(is_near).copied().collect();
        if near.len() * vertex_count(contours) > MOST_PAIRS {
            return false;
        }
        let is_outside = |contour: &Contour| {
            let inner = contour.points.iter().find(|p| !self.is_on_border(**p));
            inner.is_some_and(|&p| !self.area.contains(p))
        };
        let mut own = contours.iter().flat_map(Contour::edges);
        // What grew to the part since hangs together with it.
        !own.any(|(a, b)| near.iter().any(|&(c, d)| do_cross(a, b, c, d)))
            && contours[..part.united].iter().all(is_outside)
            && !near.iter().any(|&(p, _)| !self.is_on_border(p) && part.contains(p))
    }

    fn is_on_border(&self, p: DVec2) -> bool {
        (0..2).any(|axis| self.is_on_border_along(p, axis))
    }
}

/// Components of S_(k+1) and pieces of ESF_k that touch each other.
#[derive(Default)]
struct Group {
    /// Whether any of the components may meet A_k.
    meets: bool,
    parts: Vec<Part>,
    new: Vec<Part>,
}

/// What A_k is to be taken from.
#[derive(Default)]
struct Held {
    above: Vec<Part>,
    new: Vec<Contour>,
}

impl Held {
    fn take(&mut self, parts: Vec<Part>, new: Vec<Part>) {
        self.above.extend(parts);
        self.new.extend(new.into_iter().flat_map(|part| part.piece.contours));
    }
}

/// Groups of what touches. The pieces reach over the slits to the components they touch.
fn group(parts: Vec<Part>, meets: &[bool], new: Vec<Piece>, bounds: Bounds) -> Vec<Group> {
    let mut sets = Sets::new(parts.len() + new.len());
    let mut reaching = Vec::with_capacity(new.len());
    for (i, piece) in new.into_iter().enumerate() {
        let mut new = Part::new(piece, 0);
        for part in touched(&mut new, &parts, bounds) {
            sets.join(part, parts.len() + i);
        }
        reaching.push(new);
    }
    let mut groups: Vec<Group> = Vec::new();
    groups.resize_with(parts.len() + reaching.len(), Group::default);
    let count = parts.len();
    for (i, part) in parts.into_iter().enumerate() {
        let group = &mut groups[sets.root(i)];
        group.meets |= meets[i];
        group.parts.push(part);
    }
    for (i, new) in reaching.into_iter().enumerate() {
        groups[sets.root(count + i)].new.push(new);
    }
    groups.retain(|group| !group.parts.is_empty() || !group.new.is_empty());
    groups
}

/// The components that `new` touches. It reaches over the slit to them by [`BRIDGE_MM`] where they share a border;
/// free borders stay where they are, and nothing reaches out of the tile.
fn touched(new: &mut Part, parts: &[Part], bounds: Bounds) -> Vec<usize> {
    let is_near = |&i: &usize| parts[i].piece.bounds.is_near(new.piece.bounds, NEAR_MM);
    let near: Vec<usize> = (0..parts.len()).filter(is_near).collect();
    if near.is_empty() {
        return near;
    }
    let mut found = vec![false; near.len()];
    let mut is_beside = |p: DVec2| {
        let beside = near.iter().position(|&i| parts[i].contains(p));
        if let Some(k) = beside {
            found[k] = true;
        }
        beside.is_some()
    };
    let mut reaching = Vec::with_capacity(new.piece.contours.len());
    for contour in &new.piece.contours {
        let mut contour = reach_over(contour, &mut is_beside);
        contour.points.iter_mut().for_each(|p| *p = p.clamp(bounds.min, bounds.max));
        reaching.push(contour);
    }
    for (k, &i) in near.iter().enumerate() {
        found[k] = found[k] || is_touched_by(&parts[i], new);
    }
    new.piece.contours = reaching;
    new.inside.take();
    near.into_iter().zip(found).filter(|(_, found)| *found).map(|(i, _)| i).collect()
}

/// Whether `new` lies across an edge of the part: one of its own may be so long that the part shares only little of it.
fn is_touched_by(part: &Part, new: &Part) -> bool {
    let around = new.piece.bounds.grown(NEAR_MM);
    let mut edges = part.piece.contours.iter().flat_map(Contour::edges);
    edges.any(|(a, b)| {
        let out = outward(a, b) * BRIDGE_MM;
        Bounds { min: a.min(b), max: a.max(b) }.is_near(around, 0.0)
            && SAMPLES.iter().any(|&share| new.contains(a.lerp(b, share) + out))
    })
}

/// Joins `part` to the one of `others` that holds its inner point, else to those that hold an inner
/// point of what they share.
fn join_to(part: &Part, others: &[Part], sets: &mut Sets, shared: impl Fn(&Part) -> Vec<Polygon>) {
    if let Some(other) = part.inner_point().and_then(|p| others.iter().find(|other| other.contains(p))) {
        sets.join(part.node, other.node);
        return;
    }
    for other in others.iter().filter(|other| other.piece.bounds.is_near(part.piece.bounds, 0.0)) {
        let points = shared(other).into_iter().filter_map(|piece| inner_point(&piece));
        if points.into_iter().any(|p| other.contains(p)) {
            sets.join(part.node, other.node);
        }
    }
}

/// The contour reaching by [`BRIDGE_MM`] into what `is_beside` tells to lie across its edges.
fn reach_over(contour: &Contour, is_beside: &mut impl FnMut(DVec2) -> bool) -> Contour {
    let mut edges = Vec::with_capacity(contour.points.len());
    contour.edges().for_each(|(a, b)| split_shared(a, b, is_beside, SPLITS, &mut edges));
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

/// Where along an edge it is asked what lies beside it.
const SAMPLES: [f64; 3] = [0.01, 0.5, 0.99];

/// Unit vector to the right of an edge, where the area is to the left.
fn outward(a: DVec2, b: DVec2) -> DVec2 {
    let along = (b - a).normalize_or_zero();
    dvec2(along.y, -along.x)
}

/// Appends the edge from a to b as start points with the outward normal where something lies across
/// it, and `None` where nothing does.
fn split_shared(
    a: DVec2,
    b: DVec2,
    is_beside: &mut impl FnMut(DVec2) -> bool,
    splits: u32,
    edges: &mut Vec<(DVec2, Option<DVec2>)>,
) {
    let out = outward(a, b);
    let across = SAMPLES.map(|share| is_beside(a.lerp(b, share) + out * BRIDGE_MM));
    if across == [true; 3] || across == [false; 3] || splits == 0 {
        return edges.push((a, across[1].then_some(out)));
    }
    let middle = a.lerp(b, 0.5);
    split_shared(a, middle, is_beside, splits - 1, edges);
    split_shared(middle, b, is_beside, splits - 1, edges);
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
