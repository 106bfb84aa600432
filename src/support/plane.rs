//! One vertical plane: what the part's section leaves to be held, by vertical slabs.
//!
//! Coordinates are (u, z): u along the plane, z up, the bed at z = 0. [Zhao] walks along the
//! contours from point to point; we split the plane at every vertex into vertical slabs, in which the
//! edges are ordered by z, and every gap below an edge that needs holding is a trapezoid. Their
//! union is the region the paper's walk traces, and there are no cases to tell apart.
//!
//! [Zhao]: B. Zhao, S. Wang, F. Xie, "Research on Automatic Generation Algorithm for the Supporting
//! Structure in FDM Process".

use crate::polygon::{Contour, DVec2, PolygonSet, dvec2};
use crate::sort::StableSort;

/// Edges may cross by this much before a slab is split at the crossing, mm: vertices are rounded to
/// the polygon grid, and two grid steps of overlap there are no crossing.
const CROSSING_MM: f64 = 2e-4;

/// Columns that are nowhere taller than this, mm, are two surfaces that touch.
const TOUCHING_MM: f64 = 1e-9;

/// An edge of a plane's contours, directed with the part on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Start, (u, z) in mm.
    pub from: DVec2,
    /// End, (u, z) in mm.
    pub to: DVec2,
    /// Whether the surface it was cut from leans past the overhang angle.
    pub leans: bool,
    /// Whether it bounds a cavity that is closed in 3D.
    pub is_cavity: bool,
}

/// A rectangle of a plane where the user decides, (u, z) in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// Smallest u and z.
    pub min: DVec2,
    /// Largest u and z.
    pub max: DVec2,
    /// Hold everything in it (true), or nothing (false).
    pub enforce: bool,
}

/// The section of one plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaneSection {
    /// Edges of all contours; contours of overlapping shells may cross.
    pub edges: Vec<Edge>,
    /// Where the user decides; blockers win.
    pub zones: Vec<Zone>,
}

/// A trapezoid of air between two of the part's surfaces, or a surface and the bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Left and right border.
    pub u: [f64; 2],
    /// Height of the lower end at both borders.
    pub floor: [f64; 2],
    /// Height of the surface above at both borders.
    pub ceiling: [f64; 2],
    /// Whether it stands on the bed, not on the part.
    pub on_bed: bool,
}

impl Column {
    /// Area, mm2.
    pub fn area(&self) -> f64 {
        let height = |side: usize| self.ceiling[side] - self.floor[side];
        (self.u[1] - self.u[0]) * (height(0) + height(1)) / 2.0
    }

    /// The stretch of the level line at height z that lies inside.
    pub fn at_height(&self, z: f64) -> Option<[f64; 2]> {
        let below_ceiling = self.share_where(self.ceiling.map(|c| c - z));
        let above_floor = self.share_where(self.floor.map(|f| z - f));
        let (from, to) = (below_ceiling[0].max(above_floor[0]), below_ceiling[1].min(above_floor[1]));
        let at = |share: f64| match share {
            0.0 => self.u[0],
            1.0 => self.u[1],
            _ => self.u[0] + share * (self.u[1] - self.u[0]),
        };
        (from < to).then(|| [at(from), at(to)])
    }

    /// The share of the width on which a linear function with these border values is positive.
    fn share_where(&self, [left, right]: [f64; 2]) -> [f64; 2] {
        match (left > 0.0, right > 0.0) {
            (true, true) => [0.0, 1.0],
            (true, false) => [0.0, left / (left - right)],
            (false, true) => [left / (left - right), 1.0],
            (false, false) => [1.0, 0.0],
        }
    }

    /// The trapezoid counter-clockwise.
    fn contour(&self) -> Contour {
        let ([a, b], [p, q], [r, s]) = (self.u, self.floor, self.ceiling);
        Contour::new(vec![dvec2(a, p), dvec2(b, q), dvec2(b, s), dvec2(a, r)])
    }
}

/// Which columns are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Demand {
    /// Below every downward surface, not only below those that lean past the angle.
    pub every: bool,
    /// Columns that stand on the part too, not only those on the bed.
    pub everywhere: bool,
    /// Also in cavities that are closed in 3D.
    pub internal: bool,
}

impl Demand {
    /// The paper's: every downward surface is held, wherever the support stands.
    pub const PAPER: Demand = Demand { every: true, everywhere: true, internal: true };
}

impl PlaneSection {
    /// The section of a solid area, every downward edge leaning past the angle: [Zhao]'s case.
    pub fn of_area(area: &PolygonSet) -> PlaneSection {
        let edge = |(from, to)| Edge { from, to, leans: true, is_cavity: false };
        let edges = area.contours().iter().flat_map(|c| c.edges().map(edge)).collect();
        PlaneSection { edges, zones: Vec::new() }
    }

    /// The columns that `demand` asks for, from left to right; each is as wide as its two surfaces
    /// are straight. O((n + k) log n) for n edges and k edges met by the slabs.
    pub fn columns(&self, demand: Demand) -> Vec<Column> {
        Sweep::new(self, demand).run()
    }

    fn holds(&self, edge: &Edge, at: DVec2) -> bool {
        let inside = |zone: &&Zone| zone.min.cmple(at).all() && at.cmple(zone.max).all();
        let mut wish = None;
        for zone in self.zones.iter().filter(inside) {
            wish = Some(zone.enforce && wish != Some(false));
        }
        wish.unwrap_or(edge.leans)
    }

    /// Where u must be split: at vertices, and where zones begin and end.
    fn breaks(&self, sides: &[Side]) -> Vec<f64> {
        let mut breaks: Vec<f64> = sides.iter().flat_map(|s| [s.left.x, s.right.x]).collect();
        for zone in &self.zones {
            breaks.extend([zone.min.x, zone.max.x]);
            for z in [zone.min.y, zone.max.y] {
                breaks.extend(sides.iter().filter_map(|s| s.crossing_height(z)));
            }
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// The region that columns cover, as contours with holes (rounded to the polygon grid).
pub fn region(columns: &[Column]) -> PolygonSet {
    PolygonSet::from_contours(columns.iter().map(Column::contour).collect())
}

/// An edge that is not vertical, from left to right.
#[derive(Debug, Clone, Copy)]
struct Side {
    left: DVec2,
    right: DVec2,
    /// What the winding number grows by on the way up through the edge: 1 at a downward surface.
    rise: i32,
    edge: u32,
}

impl Side {
    fn of((index, edge): (usize, &Edge)) -> Option<Side> {
        let (from, to) = (edge.from, edge.to);
        let (left, right, rise) = if from.x < to.x { (from, to, 1) } else { (to, from, -1) };
        (from.x != to.x).then_some(Side { left, right, rise, edge: index as u32 })
    }

    fn height_at(&self, u: f64) -> f64 {
        if u == self.right.x {
            return self.right.y;
        }
        self.left.y + (u - self.left.x) * ((self.right.y - self.left.y) / (self.right.x - self.left.x))
    }

    fn crossing_height(&self, z: f64) -> Option<f64> {
        let (a, b) = (self.left, self.right);
        ((a.y > z) != (b.y > z)).then(|| a.x + (z - a.y) * (b.x - a.x) / (b.y - a.y))
    }
}

/// A side within one slab: its heights at both borders.
#[derive(Debug, Clone, Copy)]
struct Strand {
    side: u32,
    z: [f64; 2],
}

/// Stands for the bed where a side is asked for.
const BED: u32 = u32::MAX;

/// Goes from slab to slab and keeps the sides that cross it.
struct Sweep<'a> {
    section: &'a PlaneSection,
    demand: Demand,
    /// By left end.
    sides: Vec<Side>,
    active: Vec<u32>,
    strands: Vec<Strand>,
    columns: Vec<Column>,
    /// The floor's side of each column.
    floors: Vec<u32>,
    /// The last column below each side, or `u32::MAX`.
    last_below: Vec<u32>,
}

impl<'a> Sweep<'a> {
    fn new(section: &'a PlaneSection, demand: Demand) -> Self {
        let mut sides: Vec<Side> = section.edges.iter().enumerate().filter_map(Side::of).collect();
        sides.stable_sort_by(|a, b| a.left.x.total_cmp(&b.left.x).then(a.edge.cmp(&b.edge)));
        let last_below = vec![u32::MAX; sides.len()];
        let (columns, floors) = (Vec::new(), Vec::new());
        Sweep { section, demand, sides, active: Vec::new(), strands: Vec::new(), columns, floors, last_below }
    }

    fn run(mut self) -> Vec<Column> {
        let breaks = self.section.breaks(&self.sides);
        let mut next = 0;
        for slab in breaks.windows(2) {
            let (from, to) = (slab[0], slab[1]);
            self.active.retain(|&s| self.sides[s as usize].right.x > from);
            while self.sides.get(next).is_some_and(|s| s.left.x <= from) {
                self.active.push(next as u32);
                next += 1;
            }
            let crossings = self.order(from, to);
            if crossings.is_empty() {
                self.gaps(from, to);
            } else {
                let mut at = from;
                for until in crossings.into_iter().chain([to]) {
                    self.order(at, until);
                    self.gaps(at, until);
                    at = until;
                }
            }
        }
        self.columns
    }

    /// Orders the strands of a slab by height; gives the places where two of them cross.
    fn order(&mut self, from: f64, to: f64) -> Vec<f64> {
        self.strands.clear();
        for &side in &self.active {
            let z = [from, to].map(|u| self.sides[side as usize].height_at(u));
            self.strands.push(Strand { side, z });
        }
        // Where surfaces touch, the one that the part lies above comes first: no gap opens.
        let rise = |s: &Strand| self.sides[s.side as usize].rise;
        let middle = |s: &Strand| s.z[0] + s.z[1];
        self.strands.stable_sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(rise(b).cmp(&rise(a))));
        self.active.clear();
        self.active.extend(self.strands.iter().map(|s| s.side));
        let crossed = |low: &Strand, high: &Strand| (0..2).any(|i| low.z[i] - high.z[i] > CROSSING_MM);
        if !self.strands.windows(2).any(|pair| crossed(&pair[0], &pair[1])) {
            return Vec::new();
        }
        self.crossings(from, to)
    }

    fn crossings(&self, from: f64, to: f64) -> Vec<f64> {
        let mut found = Vec::new();
        for (i, a) in self.strands.iter().enumerate() {
            for b in &self.strands[i + 1..] {
                let [at_left, at_right] = [a.z[0] - b.z[0], a.z[1] - b.z[1]];
                if at_left * at_right < 0.0 {
                    found.push(from + (to - from) * at_left / (at_left - at_right));
                }
            }
        }
        found.retain(|&u| from < u && u < to);
        found.sort_by(f64::total_cmp);
        found.dedup();
        found
    }

    /// Walks up through the slab's strands: a gap ends where the part begins.
    fn gaps(&mut self, from: f64, to: f64) {
        let (mut winding, mut floor) = (0, Strand { side: BED, z: [0.0; 2] });
        for place in 0..self.strands.len() {
            let strand = self.strands[place];
            let before = winding;
            winding += self.sides[strand.side as usize].rise;
            if before == 0 {
                self.gap([from, to], floor, strand);
            }
            if winding == 0 {
                floor = strand;
            }
        }
    }

    fn gap(&mut self, u: [f64; 2], floor: Strand, ceiling: Strand) {
        let on_bed = floor.side == BED;
        let height = (0..2).map(|i| ceiling.z[i] - floor.z[i]).fold(f64::NEG_INFINITY, f64::max);
        if height <= TOUCHING_MM || (!on_bed && !self.demand.everywhere) || !self.is_wanted(u, floor, ceiling)
        {
            return;
        }
        let last = self.last_below[ceiling.side as usize] as usize;
        let goes_on =
            self.columns.get(last).is_some_and(|c| c.u[1] == u[0] && self.floors[last] == floor.side);
        if goes_on {
            let column = &mut self.columns[last];
            (column.u[1], column.floor[1], column.ceiling[1]) = (u[1], floor.z[1], ceiling.z[1]);
        } else {
            self.last_below[ceiling.side as usize] = self.columns.len() as u32;
            self.columns.push(Column { u, floor: floor.z, ceiling: ceiling.z, on_bed });
            self.floors.push(floor.side);
        }
    }

    fn is_wanted(&self, u: [f64; 2], floor: Strand, ceiling: Strand) -> bool {
        let edge_of = |side: u32| &self.section.edges[self.sides[side as usize].edge as usize];
        let above = edge_of(ceiling.side);
        let closed_in = above.is_cavity || (floor.side != BED && edge_of(floor.side).is_cavity);
        let middle = dvec2((u[0] + u[1]) / 2.0, (ceiling.z[0] + ceiling.z[1]) / 2.0);
        (self.demand.internal || !closed_in) && (self.demand.every || self.section.holds(above, middle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(corners: &[(f64, f64)]) -> PlaneSection {
        let contour = Contour::new(corners.iter().map(|&(u, z)| dvec2(u, z)).collect());
        PlaneSection::of_area(&PolygonSet::from_contours(vec![contour]))
    }

    fn area(columns: &[Column]) -> f64 {
        columns.iter().map(Column::area).sum()
    }

    #[test]
    fn a_table_is_held_between_and_beside_its_legs() {
        let table = section(&[
            (0.0, 20.0),
            (10.0, 20.0),
            (10.0, 0.0),
            (12.0, 0.0),
            (12.0, 20.0),
            (30.0, 20.0),
            (30.0, 22.0),
            (0.0, 22.0),
        ]);
        let columns = table.columns(Demand::PAPER);
        assert_eq!(columns.len(), 2);
        assert_eq!(area(&columns), 28.0 * 20.0);
        assert!(columns.iter().all(|c| c.on_bed));
    }

    #[test]
    fn contours_that_cross_are_one_part() {
        // Two slanted bars make an X: held are the two upper wedges' undersides and the gap below.
        let bar = |flip: f64| {
            let points =
                [(-10.0, 10.0), (-9.0, 10.0), (10.0, 29.0), (10.0, 30.0), (9.0, 30.0), (-10.0, 11.0)];
            let mut contour = Contour::new(points.iter().map(|&(u, z)| dvec2(u * flip, z)).collect());
            if flip < 0.0 {
                contour.points.reverse();
            }
            contour
        };
        let bars = [bar(1.0), bar(-1.0)];
        let edge = |(from, to)| Edge { from, to, leans: true, is_cavity: false };
        let edges = bars.iter().flat_map(|b| b.edges().map(edge).collect::<Vec<_>>()).collect();
        let crossed = PlaneSection { edges, zones: Vec::new() };
        let united = PlaneSection::of_area(&PolygonSet::from_contours(bars.to_vec()));
        let found = [crossed, united].map(|s| area(&s.columns(Demand::PAPER)));
        assert!((found[0] - found[1]).abs() < 1e-3, "{found:?}");
        // Below each bar's underside down to the bed or the other bar.
        assert!(found[0] > 300.0);
    }

    #[test]
    fn zones_hold_and_free_a_stretch_of_a_ceiling() {
        let mut roof = section(&[(0.0, 10.0), (20.0, 10.0), (20.0, 12.0), (0.0, 12.0)]);
        let zone = |from, to, enforce| Zone { min: dvec2(from, 9.0), max: dvec2(to, 11.0), enforce };
        roof.zones = vec![zone(5.0, 8.0, false)];
        assert_eq!(area(&roof.columns(Demand { every: false, ..Demand::PAPER })), 170.0);
        roof.edges.iter_mut().for_each(|e| e.leans = false);
        roof.zones = vec![zone(2.0, 9.0, true), zone(5.0, 8.0, false)];
        assert_eq!(area(&roof.columns(Demand { every: false, ..Demand::PAPER })), 40.0);
    }

    #[test]
    fn a_level_line_is_cut_where_the_column_is() {
        let column = Column { u: [0.0, 10.0], floor: [0.0, 5.0], ceiling: [10.0, 20.0], on_bed: false };
        assert_eq!(column.at_height(2.5), Some([0.0, 5.0]));
        assert_eq!(column.at_height(15.0), Some([5.0, 10.0]));
        assert_eq!(column.at_height(7.0), Some([0.0, 10.0]));
        assert_eq!(column.at_height(20.0), None);
        assert_eq!(column.area(), 125.0);
    }
}
