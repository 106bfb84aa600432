//! A short way through things that have two ends each: the nearest next, then improved by turning
//! stretches of the way round (2-opt, Croes 1958) and by moving single things (Or-opt, Or 1976).

use crate::polygon::DVec2;
use crate::polygon::grid::PointGrid;

/// Something to visit: in at one end, out at the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    /// First and last point.
    pub(super) ends: [DVec2; 2],
    /// Whether it may be passed from the last point to the first.
    pub(super) turns: bool,
}

/// A stop on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    /// Which stop.
    pub(super) stop: usize,
    /// Whether it is passed from its last point to its first.
    pub(super) turned: bool,
}

/// Improvements look at stretches of up to this many stops, so that layers with thousands of small
/// things cost no more per thing than others.
const WINDOW: usize = 40;

/// Rounds of improvement; hardly a way still changes in the third.
const ROUNDS: usize = 3;

/// An improvement has to save this much, mm: rounding must not make the way go round in circles.
const SAVING: f64 = 1e-6;

/// A short way from `start` through all stops, ending near `goal` if there is one.
pub(super) fn route(stops: &[Stop], start: DVec2, goal: Option<DVec2>) -> Vec<Leg> {
    let mut tour = Tour { stops, start, goal, legs: nearest_next(stops, start) };
    for _ in 0..ROUNDS {
        let turned = tour.turn_stretches();
        let moved = tour.move_stops();
        if !turned && !moved {
            break;
        }
    }
    tour.legs
}

fn nearest_next(stops: &[Stop], start: DVec2) -> Vec<Leg> {
    let ends: Vec<DVec2> = stops.iter().flat_map(|s| s.ends).collect();
    let mut grid = PointGrid::new(&ends);
    for (i, stop) in stops.iter().enumerate().filter(|(_, s)| !s.turns) {
        grid.remove(stop.ends[1], 2 * i + 1);
    }
    let mut here = start;
    let mut legs = Vec::with_capacity(stops.len());
    while let Some((_, end)) = grid.nearest(here) {
        let stop = end / 2;
        grid.remove(ends[2 * stop], 2 * stop);
        grid.remove(ends[2 * stop + 1], 2 * stop + 1);
        here = ends[end ^ 1];
        legs.push(Leg { stop, turned: end % 2 == 1 });
    }
    legs
}

struct Tour<'a> {
    stops: &'a [Stop],
    start: DVec2,
    goal: Option<DVec2>,
    legs: Vec<Leg>,
}

impl Tour<'_> {
    fn entry(&self, leg: Leg) -> DVec2 {
        self.stops[leg.stop].ends[usize::from(leg.turned)]
    }

    fn exit(&self, leg: Leg) -> DVec2 {
        self.stops[leg.stop].ends[usize::from(!leg.turned)]
    }

    /// Where the way comes from before place `i`.
    fn before(&self, i: usize) -> DVec2 {
        i.checked_sub(1).map_or(self.start, |b| self.exit(self.legs[b]))
    }

    /// Way from `p` to what stands at place `i`; nothing behind the end.
    fn on_to(&self, p: DVec2, i: usize) -> f64 {
        let next = self.legs.get(i).map(|&leg| self.entry(leg)).or(self.goal);
        next.map_or(0.0, |q| p.distance(q))
    }

    /// Turns stretches of the way round where that makes it shorter.
    fn turn_stretches(&mut self) -> bool {
        let count = self.legs.len();
        let mut changed = false;
        for first in 0..count {
            for last in first..(first + WINDOW).min(count) {
                if !self.stops[self.legs[last].stop].turns {
                    break;
                }
                let (a, b) = (self.legs[first], self.legs[last]);
                let from = self.before(first);
                let now = from.distance(self.entry(a)) + self.on_to(self.exit(b), last + 1);
                let then = from.distance(self.exit(b)) + self.on_to(self.entry(a), last + 1);
                if then < now - SAVING {
                    self.legs[first..=last].reverse();
                    self.legs[first..=last].iter_mut().for_each(|leg| leg.turned = !leg.turned);
                    changed = true;
                }
            }
        }
        changed
    }

    /// Moves single stops, either way round, to where they lengthen the way least.
    fn move_stops(&mut self) -> bool {
        let count = self.legs.len();
        let mut changed = false;
        for i in 0..count {
            let leg = self.legs[i];
            let from = self.before(i);
            let saved =
                from.distance(self.entry(leg)) + self.on_to(self.exit(leg), i + 1) - self.on_to(from, i + 1);
            let mut best = (saved - SAVING, None);
            for to in i.saturating_sub(WINDOW)..=(i + 1 + WINDOW).min(count) {
                if to == i || to == i + 1 {
                    continue;
                }
                let from = self.before(to);
                for turned in [leg.turned, !leg.turned] {
                    let moved = Leg { turned, ..leg };
                    if turned && !self.stops[leg.stop].turns {
                        continue;
                    }
                    let added = from.distance(self.entry(moved)) + self.on_to(self.exit(moved), to)
                        - self.on_to(from, to);
                    if added < best.0 {
                        best = (added, Some((to, moved)));
                    }
                }
            }
            if let (_, Some((to, moved))) = best {
                self.legs.remove(i);
                self.legs.insert(if to > i { to - 1 } else { to }, moved);
                changed = true;
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;
    use proptest::prelude::*;

    fn length(stops: &[Stop], start: DVec2, goal: Option<DVec2>, legs: &[Leg]) -> f64 {
        let tour = Tour { stops, start, goal, legs: legs.to_vec() };
        let ways = (0..legs.len()).map(|i| tour.before(i).distance(tour.entry(legs[i])));
        let last = legs.last().map_or(start, |&leg| tour.exit(leg));
        ways.sum::<f64>() + goal.map_or(0.0, |g| last.distance(g))
    }

    #[test]
    fn a_row_left_half_done_is_not_come_back_for() {
        // Starting in the middle of a row the nearest next goes one way and all the way back.
        let dots: Vec<Stop> =
            [-1.0, 1.5, 3.0, 4.5].map(|x| Stop { ends: [dvec2(x, 0.0); 2], turns: true }).to_vec();
        let legs = route(&dots, dvec2(0.4, 0.0), Some(dvec2(4.5, 0.0)));
        let order: Vec<usize> = legs.iter().map(|l| l.stop).collect();
        assert_eq!(order, [0, 1, 2, 3]);
    }

    fn stops() -> impl Strategy<Value = Vec<Stop>> {
        let place = || (0.0..50.0f64, 0.0..50.0f64).prop_map(|(x, y)| dvec2(x, y));
        let stop = (place(), place(), any::<bool>());
        prop::collection::vec(stop.prop_map(|(a, b, turns)| Stop { ends: [a, b], turns }), 0..60)
    }

    proptest! {
        #[test]
        fn every_stop_is_passed_once_in_a_way_it_allows(stops in stops()) {
            let goal = Some(dvec2(50.0, 50.0));
            let legs = route(&stops, DVec2::ZERO, goal);
            let mut seen: Vec<usize> = legs.iter().map(|l| l.stop).collect();
            seen.sort_unstable();
            prop_assert_eq!(seen, (0..stops.len()).collect::<Vec<_>>());
            prop_assert!(legs.iter().all(|l| stops[l.stop].turns || !l.turned));
            let before = length(&stops, DVec2::ZERO, goal, &nearest_next(&stops, DVec2::ZERO));
            prop_assert!(length(&stops, DVec2::ZERO, goal, &legs) <= before + 1e-6);
        }
    }
}
