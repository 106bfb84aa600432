//! Lines of seams that run up the part.
//!
//! Outlines at a few heights are put in chains, each with the one above that it goes on in. Along a
//! chain the places are chosen together, by dynamic programming (Viterbi 1967): corners that hide a
//! seam are cheap, ways from height to height are dear. So a seam does not jump to another corner
//! because that is a little better on one layer.

use super::corner::hiding;
use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{Contour, DVec2, PolygonSet};
use crate::sort::StableSort;

/// A line of seams: height and place, from below.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SeamLine {
    /// Height and place, mm.
    pub places: Vec<(f64, DVec2)>,
}

impl SeamLine {
    /// Where the line passes height `z`; it is taken to go on straight up and down by `beyond` mm at
    /// its ends.
    pub fn at(&self, z: f64, beyond: f64) -> Option<DVec2> {
        let (first, last) = (self.places.first()?, self.places.last()?);
        let above = self.places.partition_point(|p| p.0 < z);
        match (above.checked_sub(1).and_then(|i| self.places.get(i)), self.places.get(above)) {
            (Some(a), Some(b)) => {
                let share = (z - a.0) / (b.0 - a.0);
                let jumps = a.1.distance(b.1) > LONGEST_STEP;
                Some(if !jumps {
                    a.1.lerp(b.1, share)
                } else if share < 0.5 {
                    a.1
                } else {
                    b.1
                })
            }
            (None, _) => (first.0 - z <= beyond).then_some(first.1),
            (_, None) => (z - last.0 <= beyond).then_some(last.1),
        }
    }
}

/// Between places farther apart than this a line jumps, mm.
const LONGEST_STEP: f64 = 3.0;

/// What a way of 1 mm from height to height costs; no corner at all costs 1.
const COST_PER_MM: f64 = 0.25;

/// What the front costs more than the rear.
const FRONT_COST: f64 = 0.2;

/// Most corners of an outline that are tried, and most places carried on from the one below.
const CANDIDATES: usize = 16;

/// Outlines are smoothed by this much before their corners are sought, mm.
const SMOOTHING: f64 = 0.05;

/// Outlines that come as close as this, mm, may go on in each other.
const NEAR: f64 = 2.0;

/// Places of an outline that are held against those below.
const PROBES: usize = 12;

/// The lines of seams of a part whose sections at ascending heights are given.
pub fn chain_seams(sections: &[(f64, PolygonSet)]) -> Vec<SeamLine> {
    let smooth: Vec<(f64, PolygonSet)> =
        sections.iter().map(|(z, area)| (*z, area.roughened(SMOOTHING))).collect();
    let mut chains: Vec<Vec<(f64, &Contour)>> = Vec::new();
    // The chains that end in the contours of the section below.
    let mut open: Vec<usize> = Vec::new();
    for (z, area) in &smooth {
        let lower: Vec<&Contour> = open.iter().filter_map(|&c| chains[c].last()).map(|l| l.1).collect();
        let followers = followers(&lower, area.contours());
        let mut next = Vec::new();
        for (contour, below) in area.contours().iter().zip(followers) {
            let chain = below.map_or(chains.len(), |b| open[b]);
            if chain == chains.len() {
                chains.push(Vec::new());
            }
            chains[chain].push((*z, contour));
            next.push(chain);
        }
        open = next;
    }
    chains.iter().map(|chain| seam_line(chain)).collect()
}

/// For each upper contour the lower one that it goes on from; each lower one has at most one.
fn followers(lower: &[&Contour], upper: &[Contour]) -> Vec<Option<usize>> {
    let mut pairs: Vec<(usize, usize, usize)> = Vec::new();
    for (u, contour) in upper.iter().enumerate() {
        for (l, below) in lower.iter().enumerate() {
            let close = closeness(below, contour);
            if close > 0 {
                pairs.push((close, u, l));
            }
        }
    }
    // Closest first; of equals in the order of the contours.
    pairs.stable_sort_by(|a, b| b.0.cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut follows = vec![None; upper.len()];
    let mut taken = vec![false; lower.len()];
    for (_, u, l) in pairs {
        if follows[u].is_none() && !taken[l] {
            follows[u] = Some(l);
            taken[l] = true;
        }
    }
    follows
}

/// How many of the probes on `upper` lie near `lower`; 0 for a hole and an outline.
fn closeness(lower: &Contour, upper: &Contour) -> usize {
    let same_kind = (lower.signed_area() > 0.0) == (upper.signed_area() > 0.0);
    let near = lower.bounds().zip(upper.bounds()).is_some_and(|(a, b)| a.is_near(b, NEAR));
    if !same_kind || !near {
        return 0;
    }
    let step = upper.points.len().div_ceil(PROBES);
    let probes = upper.points.iter().step_by(step);
    probes.filter(|p| closest(lower, **p).distance_squared(**p) <= NEAR * NEAR).count()
}

fn closest(contour: &Contour, p: DVec2) -> DVec2 {
    let places = contour.edges().map(|(a, b)| closest_on_segment(p, a, b));
    places.min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p))).unwrap_or(p)
}

/// A place on an outline that may become the seam.
struct Candidate {
    at: DVec2,
    /// Cost of the cheapest line up to here.
    cost: f64,
    /// The place below on that line.
    from: usize,
}

fn seam_line(chain: &[(f64, &Contour)]) -> SeamLine {
    let mut rows: Vec<Vec<Candidate>> = Vec::with_capacity(chain.len());
    for (_, contour) in chain {
        let row = candidates(contour, rows.last().map_or(&[], Vec::as_slice));
        rows.push(row);
    }
    let cheapest = |row: &[Candidate]| (0..row.len()).min_by(|&a, &b| row[a].cost.total_cmp(&row[b].cost));
    let mut place = rows.last().and_then(|row| cheapest(row)).unwrap_or(0);
    let mut places = Vec::with_capacity(chain.len());
    for (row, (z, _)) in rows.iter().zip(chain).rev() {
        places.push((*z, row[place].at));
        place = row[place].from;
    }
    places.reverse();
    SeamLine { places }
}

/// The best corners, the rearmost place, and the places carried on from the cheapest ones below.
fn candidates(contour: &Contour, below: &[Candidate]) -> Vec<Candidate> {
    let points = &contour.points;
    let Some(bounds) = contour.bounds() else { return Vec::new() };
    let front = |p: DVec2| FRONT_COST * (bounds.max.y - p.y) / bounds.size().y.max(f64::MIN_POSITIVE);
    let mut own: Vec<(f64, DVec2)> =
        (0..points.len()).map(|i| (hiding(points, i) + front(points[i]), points[i])).collect();
    own.stable_sort_by(|a, b| a.0.total_cmp(&b.0));
    let rear = own.iter().copied().min_by(|a, b| b.1.y.total_cmp(&a.1.y).then(a.1.x.total_cmp(&b.1.x)));
    own.truncate(CANDIDATES);
    own.extend(rear);
    let mut cheapest: Vec<&Candidate> = below.iter().collect();
    cheapest.stable_sort_by(|a, b| a.cost.total_cmp(&b.cost));
    own.extend(cheapest.into_iter().take(CANDIDATES).map(|c| {
        let at = closest(contour, c.at);
        (1.0 + front(at), at)
    }));
    let reach = |(cost, at): (f64, DVec2)| {
        let ways = below.iter().map(|c| c.cost + COST_PER_MM * c.at.distance(at));
        let (from, way) = ways.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
        Candidate { at, cost: cost + way, from }
    };
    own.into_iter().map(reach).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    /// A square of 20 with a notch of `depth` cut into its left side.
    fn notched(depth: f64, shift: f64) -> PolygonSet {
        let square = PolygonSet::rectangle(dvec2(shift, 0.0), dvec2(20.0 + shift, 20.0));
        square.difference(&PolygonSet::rectangle(dvec2(shift - 1.0, 8.0), dvec2(shift + depth, 12.0)))
    }

    #[test]
    fn the_line_keeps_to_its_corner_where_that_is_shallow_for_a_while() {
        let depth = |i: i32| if i == 5 { 0.02 } else { 3.0 };
        let sections: Vec<(f64, PolygonSet)> =
            (0..10).map(|i| (f64::from(i), notched(depth(i), 0.1 * f64::from(i)))).collect();
        let lines = chain_seams(&sections);
        assert_eq!(lines.len(), 1);
        for (i, (z, at)) in (0..).zip(&lines[0].places) {
            assert_eq!(*z, f64::from(i));
            let corner = dvec2(depth(i) + 0.1 * f64::from(i), 12.0);
            assert!(at.distance(corner) < 3.2, "{at} at {z}");
            assert!(i == 5 || at.distance(corner) < 1e-3, "{at} at {z}");
        }
    }

    #[test]
    fn two_towers_have_a_line_each_that_ends_with_them() {
        let tower = |x: f64| PolygonSet::rectangle(dvec2(x, 0.0), dvec2(x + 5.0, 5.0));
        let sections: Vec<(f64, PolygonSet)> = (0..6)
            .map(|i| (f64::from(i), if i < 3 { tower(0.0).union(&tower(20.0)) } else { tower(20.0) }))
            .collect();
        let lines = chain_seams(&sections);
        let counts: Vec<usize> = lines.iter().map(|l| l.places.len()).collect();
        assert_eq!(counts, [3, 6]);
        assert_eq!(lines[0].at(2.4, 0.5), Some(dvec2(5.0, 5.0)));
        assert_eq!(lines[0].at(3.0, 0.5), None);
        assert_eq!(lines[1].at(2.5, 0.5), Some(dvec2(25.0, 5.0)));
    }
}
