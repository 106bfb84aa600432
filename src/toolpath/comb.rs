//! Combing: ways between beads that stay inside the part where the straight one would leave it.
//!
//! A way that would leave follows the centre lines of the outer walls, half a line inside the
//! outline, and is then pulled tight. A way to another island is combed up to where it leaves and from
//! where it enters. Walls too thin for a rail, fins, are left along their own bead.

use super::travel::Way;
use crate::polygon::grid::EdgeGrid;
use crate::polygon::{DVec2, Polygon};

/// A way inside the part may be this much longer than the straight one; beyond, pulling the filament
/// back costs less.
const LONGEST_DETOUR: f64 = 2.0;

/// Points nearer to a rail than this lie on it, mm: many times what rounding moves them by, and much
/// less than a line's width.
const ON_RAIL: f64 = 0.02;

/// A fin stands on the wall whose rail is no farther than this from its end, mm.
const TO_RAIL: f64 = 1.0;

/// What keeps travels inside the part on one layer.
pub(super) struct Comb<'a> {
    outline: EdgeGrid,
    /// Island of each edge of the outline.
    islands: Vec<usize>,
    /// Closed lines half a bead inside the outline.
    rails: Vec<&'a [DVec2]>,
    rail_grid: EdgeGrid,
    /// Rail and edge of each edge in the grid.
    owners: Vec<(usize, usize)>,
    /// Beads of walls too thin for a rail.
    fins: Vec<&'a [DVec2]>,
}

/// Where a straight way crosses a rail.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    at: DVec2,
    rail: usize,
    edge: usize,
}

impl<'a> Comb<'a> {
    pub(super) fn new(outline: &[Polygon], rails: Vec<&'a [DVec2]>, fins: Vec<&'a [DVec2]>) -> Comb<'a> {
        let contours =
            |island: &Polygon| -> Vec<(DVec2, DVec2)> { island.contours().flat_map(|c| c.edges()).collect() };
        let owned =
            (0..).zip(outline).flat_map(|(i, island)| contours(island).into_iter().map(move |e| (i, e)));
        let (islands, edges): (Vec<usize>, Vec<(DVec2, DVec2)>) = owned.unzip();
        let closed = |rail: &[DVec2]| -> Vec<(DVec2, DVec2)> {
            (0..rail.len()).map(|i| (rail[i], rail[(i + 1) % rail.len()])).collect()
        };
        let rail_edges: Vec<(DVec2, DVec2)> = rails.iter().flat_map(|r| closed(r)).collect();
        let owners = rails.iter().enumerate().flat_map(|(r, rail)| (0..rail.len()).map(move |e| (r, e)));
        Comb {
            outline: EdgeGrid::new(&edges),
            islands,
            owners: owners.collect(),
            rail_grid: EdgeGrid::new(&rail_edges),
            rails,
            fins,
        }
    }

    /// The way from `a` to `b`: straight if that stays within the outer walls, else along the rails and the
    /// fins that begin there if that is not too long, else straight.
    pub(super) fn way(&self, a: DVec2, b: DVec2) -> Way {
        let way = self.way_between_walls(a, b);
        if !way.crosses_outline || self.fins.is_empty() {
            return way;
        }
        let starts = [vec![vec![a]], self.along_fins(a)].concat();
        let ends = [vec![vec![b]], self.along_fins(b)].concat();
        let mut shortest = (LONGEST_DETOUR * a.distance(b), way);
        for start in &starts {
            for end in &ends {
                let (from, to) = (start[start.len() - 1], end[end.len() - 1]);
                let middle = self.way_between_walls(from, to);
                let back = end.iter().rev().copied();
                let stops: Vec<DVec2> = start.iter().copied().chain(middle.via).chain(back).collect();
                if !middle.crosses_outline && length(&stops) < shortest.0 {
                    let via = stops[1..stops.len() - 1].to_vec();
                    shortest = (length(&stops), Way { via, crosses_outline: false });
                }
            }
        }
        shortest.1
    }

    /// The ways from the end of fins at `p` along them to the wall that they stand on.
    fn along_fins(&self, p: DVec2) -> Vec<Vec<DVec2>> {
        let beginning = self.fins.iter().filter_map(|fin| {
            let (first, last) = (fin.first()?, fin.last()?);
            match p {
                _ if p == *first => Some(fin.to_vec()),
                _ if p == *last => Some(fin.iter().rev().copied().collect()),
                _ => None,
            }
        });
        let to_wall = beginning.map(|mut way: Vec<DVec2>| {
            let foot = self.rail_grid.nearest(way[way.len() - 1], TO_RAIL);
            way.extend(foot);
            way
        });
        to_wall.collect()
    }

    /// The way between places in walls with rails.
    fn way_between_walls(&self, a: DVec2, b: DVec2) -> Way {
        if self.sees(a, b) {
            return Way::default();
        }
        let allowed = LONGEST_DETOUR * a.distance(b);
        let around = self.around(a, b, allowed).map(|stops| self.pulled_tight(&stops));
        match around {
            Some(stops) if length(&stops) <= allowed && self.stays_inside(&stops) => {
                Way { via: stops[1..stops.len() - 1].to_vec(), crosses_outline: false }
            }
            _ => self
                .across(a, b)
                .unwrap_or_else(|| Way { via: Vec::new(), crosses_outline: self.outline.crosses(a, b) }),
        }
    }

    /// The way to another island that leaves the one and enters the other only once: inside them it is
    /// combed. `None` if the straight way is as good, or something else stands between.
    fn across(&self, a: DVec2, b: DVec2) -> Option<Way> {
        let outlines = self.outline.crossings(a, b);
        let island = |i: usize| self.islands[outlines[i].1];
        let last = outlines.len().checked_sub(1).filter(|&last| last > 1 && island(0) != island(last))?;
        let leave = (0..=last).rfind(|&i| island(i) == island(0))?;
        let enter = (0..=last).find(|&i| island(i) == island(last)).filter(|&i| i == leave + 1)?;
        let rails = self.crossings(a, b);
        let share = |c: &Crossing| a.distance(c.at) / a.distance(b);
        let p = rails.iter().rfind(|c| share(c) < outlines[leave].0)?.at;
        let q = rails.iter().find(|c| share(c) > outlines[enter].0)?.at;
        let inside = |from: DVec2, to: DVec2| {
            Some(self.way_between_walls(from, to)).filter(|way| !way.crosses_outline)
        };
        let via = [inside(a, p)?.via, vec![p, q], inside(q, b)?.via].concat();
        let stops = [&[a][..], &via, &[b]].concat();
        let is_short = length(&stops) <= LONGEST_DETOUR * a.distance(b);
        is_short.then_some(Way { via, crosses_outline: true })
    }

    /// Whether the straight way crosses neither the outline nor, its ends left aside, a rail.
    fn sees(&self, a: DVec2, b: DVec2) -> bool {
        let on_rail = (b - a).normalize_or_zero() * ON_RAIL;
        !self.outline.crosses(a, b) && !self.rail_grid.crosses(a + on_rail, b - on_rail)
    }

    fn stays_inside(&self, stops: &[DVec2]) -> bool {
        stops.windows(2).all(|w| !self.outline.crosses(w[0], w[1]))
    }

    /// The straight way with each stretch outside a rail, from the first time it crosses it to the
    /// last, replaced by the shorter way along it. `None` if it leaves for good, or gets much longer
    /// than `allowed`: pulling tight seldom makes half of it.
    fn around(&self, a: DVec2, b: DVec2, allowed: f64) -> Option<Vec<DVec2>> {
        let crossings = self.paired_crossings(a, b)?;
        let mut stops = vec![a];
        let mut i = 0;
        while i < crossings.len() {
            let last = crossings.iter().rposition(|c| c.rail == crossings[i].rail)?;
            stops.extend(self.along(crossings[i], crossings[last]));
            i = last + 1;
        }
        stops.push(b);
        (length(&stops) <= 2.0 * allowed).then_some(stops)
    }

    /// Where the straight way crosses rails, each an even number of times. An end that lies on a rail,
    /// where walls begin, is taken a hair before or behind it if that makes the number even. `None` if an
    /// end lies outside.
    fn paired_crossings(&self, a: DVec2, b: DVec2) -> Option<Vec<Crossing>> {
        let hair = (b - a).normalize_or_zero() * ON_RAIL;
        let shifts = [0.0, -1.0, 1.0];
        let ways =
            shifts.iter().flat_map(|from| shifts.iter().map(move |to| (a + hair * *from, b + hair * *to)));
        ways.map(|(a, b)| self.crossings(a, b)).find(|found| {
            let times = |rail: usize| found.iter().filter(|c| c.rail == rail).count();
            found.iter().all(|c| times(c.rail).is_multiple_of(2))
        })
    }

    fn crossings(&self, a: DVec2, b: DVec2) -> Vec<Crossing> {
        let crossing = |(t, index): (f64, usize)| {
            let (rail, edge) = self.owners[index];
            Crossing { at: a.lerp(b, t), rail, edge }
        };
        self.rail_grid.crossings(a, b).into_iter().map(crossing).collect()
    }

    /// The shorter way along a rail, both ends included.
    fn along(&self, from: Crossing, to: Crossing) -> Vec<DVec2> {
        let rail = self.rails[from.rail];
        let count = rail.len();
        let forward =
            |start: usize, end: usize| (1..=(end + count - start) % count).map(move |k| (start + k) % count);
        let way = |between: Vec<usize>| -> Vec<DVec2> {
            let middle = between.into_iter().map(|i| rail[i]);
            std::iter::once(from.at).chain(middle).chain([to.at]).collect()
        };
        let ahead = way(forward(from.edge, to.edge).collect());
        let mut behind: Vec<usize> = forward(to.edge, from.edge).collect();
        behind.reverse();
        let behind = way(behind);
        if length(&ahead) <= length(&behind) { ahead } else { behind }
    }

    /// Leaves out stops that the way need not touch to stay inside.
    fn pulled_tight(&self, stops: &[DVec2]) -> Vec<DVec2> {
        let mut tight = vec![stops[0]];
        let mut i = 0;
        while i + 1 < stops.len() {
            let sees = |j: &usize| self.sees(stops[i], stops[*j]);
            let next = (i + 2..stops.len()).take_while(sees).last().unwrap_or(i + 1);
            tight.push(stops[next]);
            i = next;
        }
        tight
    }
}

fn length(stops: &[DVec2]) -> f64 {
    stops.windows(2).map(|w| w[0].distance(w[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{Join, PolygonSet, dvec2, snap};
    use proptest::prelude::*;

    fn rails(area: &PolygonSet) -> Vec<Vec<DVec2>> {
        area.offset(-0.2, Join::WALL).into_contours().into_iter().map(|c| c.points).collect()
    }

    #[test]
    fn the_way_round_the_inner_corner_of_an_l_touches_it_only() {
        let l = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 5.0))
            .union(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(5.0, 20.0)));
        let rails = rails(&l);
        let comb = Comb::new(&l.islands(), rails.iter().map(Vec::as_slice).collect(), Vec::new());
        let way = comb.way(dvec2(4.0, 18.0), dvec2(18.0, 4.0));
        assert!(!way.crosses_outline);
        assert_eq!(way.via, [dvec2(4.8, 4.8)]);
        assert_eq!(comb.way(dvec2(4.0, 4.0), dvec2(1.0, 15.0)), Way::default());
        // From a seam on a rail, first outwards.
        let way = comb.way(dvec2(4.8, 15.0), dvec2(18.0, 4.0));
        assert_eq!(way, Way { via: vec![dvec2(4.8, 4.8)], crosses_outline: false });
    }

    #[test]
    fn fins_are_left_and_entered_along_their_bead() {
        let block = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0));
        let fin = |y: f64| PolygonSet::rectangle(dvec2(20.0, y - 0.2), dvec2(32.0, y + 0.2));
        let part = PolygonSet::union_all(&[block.clone(), fin(5.0), fin(15.0)]);
        let rails = rails(&block);
        let fins = [5.0, 15.0].map(|y| vec![dvec2(20.0, y), dvec2(31.8, y)]);
        let fins = || fins.iter().map(Vec::as_slice).collect::<Vec<_>>();
        let comb = Comb::new(&part.islands(), rails.iter().map(Vec::as_slice).collect(), fins());
        let way = |from: DVec2, to: DVec2| {
            let way = comb.way(from, to);
            Way { via: way.via.into_iter().map(snap).collect(), ..way }
        };
        let out = way(dvec2(31.8, 5.0), dvec2(10.0, 15.0));
        assert_eq!(out, Way { via: vec![dvec2(20.0, 5.0), dvec2(19.8, 5.0)], crosses_outline: false });
        let back = way(dvec2(10.0, 15.0), dvec2(31.8, 5.0));
        assert_eq!(back, Way { via: vec![dvec2(19.8, 5.0), dvec2(20.0, 5.0)], crosses_outline: false });
        // From tip to tip along both is more than twice as far as through the air.
        assert_eq!(way(dvec2(31.8, 5.0), dvec2(31.8, 15.0)), Way::ACROSS);
    }

    #[test]
    fn a_long_way_round_and_a_way_to_another_island_are_left_straight() {
        let u = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 30.0))
            .difference(&PolygonSet::rectangle(dvec2(5.0, 5.0), dvec2(15.0, 31.0)))
            .union(&PolygonSet::rectangle(dvec2(30.0, 0.0), dvec2(40.0, 5.0)));
        let rails = rails(&u);
        let comb = Comb::new(&u.islands(), rails.iter().map(Vec::as_slice).collect(), Vec::new());
        assert_eq!(comb.way(dvec2(4.0, 29.0), dvec2(16.0, 29.0)), Way::ACROSS);
        assert_eq!(comb.way(dvec2(18.0, 2.0), dvec2(32.0, 2.0)), Way::ACROSS);
        assert!(!comb.way(dvec2(4.0, 8.0), dvec2(16.0, 8.0)).crosses_outline);
    }

    #[test]
    fn a_way_to_another_island_goes_round_the_hole_first() {
        // A frame and a square below it: the straight way crosses the hole of the frame.
        let frame = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0))
            .difference(&PolygonSet::rectangle(dvec2(4.0, 4.0), dvec2(16.0, 16.0)));
        let two = frame.union(&PolygonSet::rectangle(dvec2(8.0, -10.0), dvec2(12.0, -6.0)));
        let rails = rails(&two);
        let comb = Comb::new(&two.islands(), rails.iter().map(Vec::as_slice).collect(), Vec::new());
        let (a, b) = (dvec2(5.0, 18.0), dvec2(10.0, -8.0));
        let way = comb.way(a, b);
        let stops = [&[a][..], &way.via, &[b]].concat();
        let crossed = |w: &[DVec2]| comb.outline.crossings(w[0], w[1]).len();
        assert_eq!(crossed(&[a, b]), 4);
        assert_eq!(stops.windows(2).map(crossed).sum::<usize>(), 2, "{stops:?}");
        assert!(way.crosses_outline);
    }

    proptest! {
        /// Random rectangles one over the other, with holes; random ways between points inside.
        #[test]
        fn a_combed_way_never_meets_the_outline(
            boxes in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 1.0..20.0f64, 1.0..20.0f64), 1..8),
            holes in prop::collection::vec((0.0..40.0f64, 0.0..40.0f64, 0.5..4.0f64, 0.5..4.0f64), 0..5),
            points in prop::collection::vec((0.0..40.0f64, 0.0..40.0f64), 2..12),
        ) {
            let unite = |list: &[(f64, f64, f64, f64)]| {
                let each: Vec<PolygonSet> =
                    list.iter().map(|&(x, y, w, h)| PolygonSet::rectangle(dvec2(x, y), dvec2(x + w, y + h))).collect();
                PolygonSet::union_all(&each)
            };
            let area = unite(&boxes).difference(&unite(&holes));
            let edges: Vec<(DVec2, DVec2)> = area.contours().iter().flat_map(|c| c.edges()).collect();
            let by_search = |a: DVec2, b: DVec2| {
                let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
                edges.iter().any(|&(c, d)| {
                    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
                })
            };
            let rails = rails(&area);
            let comb = Comb::new(&area.islands(), rails.iter().map(Vec::as_slice).collect(), Vec::new());
            let inside: Vec<DVec2> =
                points.into_iter().map(|(x, y)| dvec2(x, y)).filter(|&p| area.contains(p)).collect();
            for pair in inside.windows(2) {
                let way = comb.way(pair[0], pair[1]);
                let stops: Vec<DVec2> =
                    std::iter::once(pair[0]).chain(way.via.iter().copied()).chain([pair[1]]).collect();
                let crosses = stops.windows(2).any(|w| by_search(w[0], w[1]));
                prop_assert!(way.crosses_outline || !crosses);
                prop_assert!(length(&stops) <= LONGEST_DETOUR * pair[0].distance(pair[1]) + 1e-9);
            }
        }
    }
}
