//! Support regions from the top down, their volume and the structures they form.
//!
//! Source: [Karim] equations (9) to (12). A_k is the part's section in layer k, S_k the support
//! region, both seen from above; layers are counted from the bed.

use crate::polygon::grid::EdgeGrid;
use crate::polygon::island::{Island, inner_point};
use crate::polygon::strips::Strips;
use crate::polygon::{Contour, DVec2, Polygon, PolygonSet, dvec2};
use crate::region::overhang;

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

/// One cut takes at most so many vertices off.
const MOST_CUT: usize = 24;

/// What the descent needs to know about the print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeRules {
    /// Height t of every layer, mm.
    pub layer_height: f64,
    /// Self-support angle alpha, degrees from the vertical.
    pub self_support_angle_deg: f64,
    /// Layers m of the base below part and supports.
    pub base_layers: u32,
    /// By how much the sections were simplified, mm: two of them may seem farther apart by twice
    /// this, and a wall at the very angle must not need support for it.
    pub section_tolerance: f64,
    /// Structures whose largest layer is under the square of this (a line's width, mm) are specks.
    pub speck_width: f64,
}

/// What supports cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SupportVolumes {
    /// Sum of area(S_k) t, mm3.
    pub support_mm3: f64,
    /// m t area(S_1 u A_1), mm3.
    pub base_mm3: f64,
    /// Connected supports larger than a speck, plus one for the base.
    pub structures: u32,
    /// Connected supports of which no layer is as large as a line is wide.
    pub specks: u32,
    /// area(A_1), mm2: what of the part itself stands on the bed.
    pub bed_contact_mm2: f64,
}

/// A walk over the layers from the top down.
///
/// Equal neighbouring layers come as one step and cost next to nothing, however many there are.
#[derive(Debug)]
pub struct Descent {
    rules: VolumeRules,
    step: f64,
    /// A_k of the layer entered last.
    area: PolygonSet,
    /// S_k of the layer entered last, and its components.
    region: PolygonSet,
    parts: Vec<Part>,
    structures: Structures,
    support_mm3: f64,
}

/// A component of S_k and the structure it belongs to.
#[derive(Debug)]
struct Part {
    island: Island,
    node: usize,
}

impl Part {
    fn overlap(&self, other: &Island) -> PolygonSet {
        self.island.polygon.clone().into_set().intersection(&other.polygon.clone().into_set())
    }
}

impl Descent {
    /// Above the topmost layer.
    pub fn new(rules: VolumeRules) -> Self {
        let step = overhang::permissible_step(rules.layer_height, rules.self_support_angle_deg);
        Descent {
            rules,
            step: step + 2.0 * rules.section_tolerance,
            area: PolygonSet::EMPTY,
            region: PolygonSet::EMPTY,
            parts: Vec::new(),
            structures: Structures::default(),
            support_mm3: 0.0,
        }
    }

    /// Goes down by `layers` layers of one section and finds their support region,
    /// S_k = (S_(k+1) u ESF_k) - A_k.
    ///
    /// *Erratum*: [Karim] eq. (9) writes RA for ESF and looks one layer up only; this is what its
    /// figures do.
    pub fn enter(&mut self, area: PolygonSet, layers: u32) {
        if area != self.area {
            let esf = overhang::externally_supported(&self.area, &area, self.step);
            if !esf.is_empty() || !self.region.is_empty() {
                self.replace_region(&area, &esf);
            }
            self.area = area;
        }
        self.support_mm3 += self.region.area() * self.rules.layer_height * f64::from(layers);
    }

    fn replace_region(&mut self, area: &PolygonSet, esf: &PolygonSet) {
        let mut held = reaching_over(esf, &self.region);
        held.extend_from_slice(self.region.contours());
        // These contours overlap: one operand of the difference, which counts what is wound around.
        let held = PolygonSet::canonical(held);
        let jags = JAG_SHARE * self.rules.layer_height;
        let region = without_jags(without_slivers(held.difference(area)), area, jags);
        if !esf.is_empty() || region != self.region {
            let islands = Island::all_of(&region).into_iter();
            let parts = islands.map(|island| Part { node: self.structures.add(&island), island });
            let parts: Vec<Part> = parts.collect();
            self.join_parts(&parts, area);
            (self.region, self.parts) = (region, parts);
        }
    }

    /// Joins the components of S_k, which are `parts`, to those of S_(k+1) that they overlap.
    ///
    /// A point inside one that lies in the other settles it for most; the overlap itself is made
    /// for those whose point lies in the part above or below.
    fn join_parts(&mut self, parts: &[Part], area: &PolygonSet) {
        let above = std::mem::take(&mut self.parts);
        for part in parts {
            let shared = |other: &Part| part.overlap(&other.island).islands();
            self.join_to(part, &above, shared);
        }
        for part in &above {
            // Nothing of S_k lies in A_k.
            let shared = |_: &Part| part.island.polygon.clone().into_set().difference(area).islands();
            self.join_to(part, parts, shared);
        }
    }

    /// Joins `part` to the one of `others` that holds its inner point, else to those that hold an
    /// inner point of what they share.
    fn join_to(&mut self, part: &Part, others: &[Part], shared: impl Fn(&Part) -> Vec<Polygon>) {
        let holds = |point: DVec2| move |other: &&Part| other.island.contains(point);
        if let Some(other) = inner_point(&part.island.polygon).and_then(|p| others.iter().find(holds(p))) {
            return self.structures.join(part.node, other.node);
        }
        for other in others.iter().filter(|other| other.island.bounds.is_near(part.island.bounds, 0.0)) {
            let points = shared(other).into_iter().filter_map(|piece| inner_point(&piece));
            if points.into_iter().any(|p| other.island.contains(p)) {
                self.structures.join(part.node, other.node);
            }
        }
    }

    /// S_k of the layer entered last.
    pub fn region(&self) -> &PolygonSet {
        &self.region
    }

    /// The components of S_k of the layer entered last, each with a mark; marks of one structure come to
    /// the same number in [`Descent::structure_of`] once all layers were entered.
    pub fn components(&self) -> impl Iterator<Item = (&Polygon, usize)> {
        self.parts.iter().map(|part| (&part.island.polygon, part.node))
    }

    /// A number for the structure that a component belongs to.
    pub fn structure_of(&mut self, mark: usize) -> usize {
        self.structures.root(mark)
    }

    /// The figures, once the layer on the bed has been entered.
    pub fn finish(self) -> SupportVolumes {
        let rules = self.rules;
        let base_mm2 = self.region.union(&self.area).area();
        let (large, specks) = self.structures.count(rules.speck_width * rules.speck_width);
        SupportVolumes {
            support_mm3: self.support_mm3,
            base_mm3: f64::from(rules.base_layers) * rules.layer_height * base_mm2,
            structures: large + 1,
            specks,
            // An empty area sums to -0.0.
            bed_contact_mm2: self.area.area() + 0.0,
        }
    }
}

/// `esf` reaching over the slit to `region` by [`BRIDGE_MM`] where the two share a border; free
/// borders stay where they are.
fn reaching_over(esf: &PolygonSet, region: &PolygonSet) -> Vec<Contour> {
    if region.is_empty() || esf.is_empty() {
        return esf.contours().to_vec();
    }
    let strips = Strips::new(region);
    esf.contours().iter().map(|contour| reach_over(contour, &strips)).collect()
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

/// The region without jags of its free border lower than `height` mm: those borders are what many layers
/// above left, and hold most of the vertices.
fn without_jags(region: PolygonSet, area: &PolygonSet, height: f64) -> PolygonSet {
    let edges: Vec<(DVec2, DVec2)> = area.contours().iter().flat_map(|c| c.edges()).collect();
    let part = EdgeGrid::new(&edges);
    let is_free = |p: &DVec2| part.nearest_edge(*p, ALONG_MM).is_none();
    let contours = region.into_contours().into_iter().map(|contour| {
        let free: Vec<bool> = contour.points.iter().map(is_free).collect();
        cut_jags(contour, &free, height)
    });
    PolygonSet::canonical(contours.collect())
}

/// Leaves out runs of free vertices that lie outside the chord across them, and nearer to it than `height`.
fn cut_jags(contour: Contour, free: &[bool], height: f64) -> Contour {
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
            points[from + 1..to].iter().all(|&p| (0.0..=most).contains(&out(p)))
        };
        let run = free[from + 1..].iter().take(MOST_CUT).take_while(|free| **free).count();
        from = (from + 2..=(from + 1 + run).min(n)).take_while(may_skip).last().unwrap_or(from + 1);
    }
    if kept.len() < 3 { contour } else { Contour::new(kept) }
}

/// Union-find over the components of all layers; a set is one support structure.
#[derive(Debug, Default)]
struct Structures {
    parent: Vec<usize>,
    /// Of the root: the largest component of its set, mm2.
    largest_mm2: Vec<f64>,
}

impl Structures {
    fn add(&mut self, island: &Island) -> usize {
        self.parent.push(self.parent.len());
        self.largest_mm2.push(island.polygon.area());
        self.parent.len() - 1
    }

    fn root(&mut self, mut node: usize) -> usize {
        while self.parent[node] != node {
            self.parent[node] = self.parent[self.parent[node]];
            node = self.parent[node];
        }
        node
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (first, second) = (a.min(b), a.max(b));
        self.parent[second] = first;
        self.largest_mm2[first] = self.largest_mm2[first].max(self.largest_mm2[second]);
    }

    /// How many sets reach `speck_mm2` in some layer, and how many do not.
    fn count(&self, speck_mm2: f64) -> (u32, u32) {
        let roots = (0..self.parent.len()).filter(|&i| self.parent[i] == i);
        roots.fold((0, 0), |(large, specks), i| {
            if self.largest_mm2[i] < speck_mm2 { (large, specks + 1) } else { (large + 1, specks) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    const RULES: VolumeRules = VolumeRules {
        layer_height: 0.5,
        self_support_angle_deg: 45.0,
        base_layers: 5,
        section_tolerance: 0.0,
        speck_width: 0.45,
    };

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1))
    }

    /// Layers from the top down, as (section, number of layers).
    fn descend(layers: &[(PolygonSet, u32)]) -> SupportVolumes {
        let mut descent = Descent::new(RULES);
        layers.iter().for_each(|(area, count)| descent.enter(area.clone(), *count));
        descent.finish()
    }

    #[test]
    fn a_t_is_held_down_to_the_bed() {
        // Erratum of eq. (9): looking one layer up only, support would end one layer below the top.
        let found = descend(&[(rectangle(0.0, 0.0, 30.0, 10.0), 4), (rectangle(10.0, 0.0, 20.0, 10.0), 60)]);
        assert!((found.support_mm3 - 20.0 * 10.0 * 30.0).abs() < 1e-9);
        assert!((found.base_mm3 - 5.0 * 0.5 * 300.0).abs() < 1e-9);
        assert_eq!((found.structures, found.specks), (3, 0));
        assert_eq!(found.bed_contact_mm2, 100.0);
    }

    #[test]
    fn support_stands_on_the_part_below_it() {
        let foot = rectangle(0.0, 0.0, 30.0, 10.0);
        let found = descend(&[
            (rectangle(0.0, 0.0, 30.0, 10.0), 4),
            (rectangle(10.0, 0.0, 20.0, 10.0), 8),
            (foot, 2),
        ]);
        assert!((found.support_mm3 - 20.0 * 10.0 * 4.0).abs() < 1e-9);
        assert_eq!(found.structures, 3);
    }

    #[test]
    fn two_supports_that_meet_further_down_are_one_structure() {
        let wall = rectangle(14.0, 0.0, 16.0, 10.0);
        let top = rectangle(0.0, 0.0, 30.0, 10.0);
        // The wall hangs in the air, so that the supports beside it and under it are one.
        let foot = rectangle(0.0, 0.0, 1.0, 10.0);
        let found = descend(&[(top, 4), (wall.union(&foot), 8), (foot, 8)]);
        assert_eq!(found.structures, 2);
    }

    #[test]
    fn one_support_split_by_the_part_stays_one() {
        let top = rectangle(0.0, 0.0, 30.0, 10.0);
        let foot = rectangle(0.0, 0.0, 1.0, 10.0);
        let ridge = foot.union(&rectangle(14.0, 0.0, 16.0, 10.0));
        let found = descend(&[(top, 4), (foot, 8), (ridge, 8)]);
        assert_eq!(found.structures, 2);
    }

    #[test]
    fn tiny_structures_are_counted_apart() {
        let tip = rectangle(20.0, 5.0, 20.3, 5.3);
        let body = rectangle(0.0, 0.0, 10.0, 10.0);
        let found = descend(&[(body.union(&tip), 2), (body, 10)]);
        assert_eq!((found.structures, found.specks), (1, 1));
        assert!((found.support_mm3 - 0.09 * 5.0).abs() < 1e-9);
    }

    #[test]
    fn jags_of_free_borders_are_cut_and_dents_stay() {
        let points =
            [(0.0, 0.0), (5.0, -0.01), (10.0, 0.0), (10.01, 5.0), (10.0, 10.0), (5.0, 9.99), (0.0, 10.0)];
        let shape = PolygonSet::canonical(vec![Contour::new(points.map(|(x, y)| dvec2(x, y)).to_vec())]);
        // The part lies along the jag at the right.
        let part = rectangle(10.011, 4.0, 20.0, 6.0);
        let found = without_jags(shape.clone(), &part, 0.02);
        let left: Vec<DVec2> = found.contours()[0].points.clone();
        assert_eq!(left.len(), 6, "{left:?}");
        assert!(left.contains(&dvec2(10.01, 5.0)) && left.contains(&dvec2(5.0, 9.99)));
        assert!(!left.contains(&dvec2(5.0, -0.01)));
        assert_eq!(without_jags(shape.clone(), &part, 0.005), shape);
    }

    #[test]
    fn nothing_in_nothing_out() {
        let found = Descent::new(RULES).finish();
        assert_eq!((found.support_mm3, found.base_mm3, found.structures), (0.0, 0.0, 1));
    }
}
