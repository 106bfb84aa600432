//! Segments to closed loops in linear time; openings of the mesh are closed and told.

use glam::DVec2;

use super::section::{EdgeKey, Segment};
use crate::polygon::by_x_then_y;
use crate::sort::StableSort;

/// A closed loop of a section, before shells are united.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    /// Vertices, mm; the last one is not repeated.
    pub points: Vec<DVec2>,
    /// `facets[i]` is the mesh triangle from which the edge points[i]..points[i + 1] was cut;
    /// [`NO_FACET`] where an opening was closed.
    pub facets: Vec<u32>,
}

/// Stands for "no triangle" in [`Loop::facets`].
pub const NO_FACET: u32 = u32::MAX;

/// An opening in a contour that was closed by a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Middle of the closing line, mm.
    pub at: DVec2,
    /// Its length, mm.
    pub length: f64,
}

/// An open run of segments, from a mesh border to a mesh border.
struct Chain {
    points: Vec<DVec2>,
    facets: Vec<u32>,
}

impl Chain {
    fn start(&self) -> DVec2 {
        self.points[0]
    }

    fn end(&self) -> DVec2 {
        self.points[self.points.len() - 1]
    }
}

/// Chains the segments of plane after plane; keeps its tables between calls.
#[derive(Debug, Default)]
pub struct Chainer {
    /// Open addressing: segment index + 1 by the edge on which it starts; 0 is free.
    slots: Vec<u32>,
    used: Vec<bool>,
}

impl Chainer {
    /// Follows each segment to the one that starts on the mesh edge where it ends.
    pub fn chain(&mut self, segments: &[Segment]) -> (Vec<Loop>, Vec<Gap>) {
        self.index(segments);
        let (mut loops, mut chains) = (Vec::new(), Vec::new());
        for start in 0..segments.len() {
            if !self.used[start] {
                match self.follow(segments, start) {
                    Run::Closed(found) => loops.push(found),
                    Run::Open(found) => chains.push(found),
                }
            }
        }
        let gaps = if chains.is_empty() { Vec::new() } else { close_openings(chains, &mut loops) };
        loops.retain(|l| l.points.len() >= 3);
        (loops, gaps)
    }

    fn index(&mut self, segments: &[Segment]) {
        self.used.clear();
        self.used.resize(segments.len(), false);
        self.slots.clear();
        self.slots.resize((segments.len() * 2).next_power_of_two(), 0);
        for (i, segment) in segments.iter().enumerate() {
            let mut slot = self.slot(segment.from_edge);
            while self.slots[slot] != 0 {
                slot = (slot + 1) & (self.slots.len() - 1);
            }
            self.slots[slot] = i as u32 + 1;
        }
    }

    fn slot(&self, edge: EdgeKey) -> usize {
        // Fibonacci hashing: the high bits of the product are well mixed.
        (edge.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize & (self.slots.len() - 1)
    }

    /// The first unused segment that starts on `edge`.
    fn starting_on(&self, segments: &[Segment], edge: EdgeKey) -> Option<usize> {
        let mut slot = self.slot(edge);
        while self.slots[slot] != 0 {
            let i = self.slots[slot] as usize - 1;
            if segments[i].from_edge == edge && !self.used[i] {
                return Some(i);
            }
            slot = (slot + 1) & (self.slots.len() - 1);
        }
        None
    }

    fn follow(&mut self, segments: &[Segment], start: usize) -> Run {
        let (mut points, mut facets) = (Vec::new(), Vec::new());
        let mut current = start;
        loop {
            self.used[current] = true;
            let segment = &segments[current];
            push_edge(&mut points, &mut facets, segment.from, segment.facet);
            if segment.to_edge == segments[start].from_edge {
                drop_closing_duplicate(&mut points, &mut facets);
                return Run::Closed(Loop { points, facets });
            }
            match self.starting_on(segments, segment.to_edge) {
                Some(next) => current = next,
                None => {
                    points.push(segment.to);
                    return Run::Open(Chain { points, facets });
                }
            }
        }
    }
}

enum Run {
    Closed(Loop),
    Open(Chain),
}

/// Appends an edge that starts at `from`; an edge of no length gives way to the one after it.
fn push_edge(points: &mut Vec<DVec2>, facets: &mut Vec<u32>, from: DVec2, facet: u32) {
    if points.last() == Some(&from) {
        facets.pop();
    } else {
        points.push(from);
    }
    facets.push(facet);
}

fn drop_closing_duplicate(points: &mut Vec<DVec2>, facets: &mut Vec<u32>) {
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
        facets.pop();
    }
}

/// Past this many open chains in one plane each takes the nearest free start in turn, instead of
/// the nearest pair of all going first: such a section is beyond honest repair, and must not take
/// minutes.
const MANY_CHAINS: usize = 64;

/// Joins open chains end to start until all are closed; tells each closing line.
fn close_openings(chains: Vec<Chain>, loops: &mut Vec<Loop>) -> Vec<Gap> {
    let successors =
        if chains.len() > MANY_CHAINS { link_in_turn(&chains) } else { link_nearest_first(&chains) };
    let bridged = chains.iter().zip(&successors).map(|(c, &next)| (c.end(), chains[next].start()));
    let gaps = bridged.filter(|(end, start)| end != start);
    let gaps =
        gaps.map(|(end, start)| Gap { at: (end + start) / 2.0, length: end.distance(start) }).collect();
    let mut open: Vec<Option<Chain>> = chains.into_iter().map(Some).collect();
    for first in 0..open.len() {
        let Some(mut ring) = open[first].take() else { continue };
        let mut next = successors[first];
        while let Some(tail) = open[next].take() {
            append(&mut ring, tail);
            next = successors[next];
        }
        loops.push(close(ring.points, ring.facets));
    }
    gaps
}

/// For each chain the one that follows it: over and over the nearest end and start among those
/// still free. A permutation.
fn link_nearest_first(chains: &[Chain]) -> Vec<usize> {
    let n = chains.len();
    let distance = |&(i, j): &(usize, usize)| chains[i].end().distance_squared(chains[j].start());
    let mut pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).collect();
    pairs.stable_sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let (mut successors, mut taken) = (vec![None; n], vec![false; n]);
    for (i, j) in pairs {
        if successors[i].is_none() && !taken[j] {
            successors[i] = Some(j);
            taken[j] = true;
        }
    }
    // Every end met every start, so none is left without one.
    successors.into_iter().flatten().collect()
}

/// For each chain the nearest start that is still free, chain after chain. A permutation.
fn link_in_turn(chains: &[Chain]) -> Vec<usize> {
    let mut free: Vec<usize> = (0..chains.len()).collect();
    free.stable_sort_by(|&a, &b| by_x_then_y(chains[a].start(), chains[b].start()).then(a.cmp(&b)));
    let take_nearest = |chain: &Chain| free.remove(nearest_by_x(chains, &free, chain.end()));
    chains.iter().map(take_nearest).collect()
}

/// Place in `free`, which is sorted by x, of the start nearest to `end`; looks outward from
/// `end.x` until the distance in x alone is too large.
fn nearest_by_x(chains: &[Chain], free: &[usize], end: DVec2) -> usize {
    let start = |place: usize| chains[free[place]].start();
    let middle = free.partition_point(|&c| chains[c].start().x < end.x);
    let (mut best, mut best_distance) = (middle.min(free.len() - 1), f64::INFINITY);
    let mut look = |place: usize| {
        let to_start = start(place) - end;
        if to_start.length_squared() < best_distance {
            (best, best_distance) = (place, to_start.length_squared());
        }
        to_start.x * to_start.x <= best_distance
    };
    let _ = (middle..free.len()).all(&mut look);
    let _ = (0..middle).rev().all(&mut look);
    best
}

fn append(chain: &mut Chain, tail: Chain) {
    if chain.end() == tail.start() {
        chain.points.pop();
    } else {
        chain.facets.push(NO_FACET);
    }
    chain.points.extend(tail.points);
    chain.facets.extend(tail.facets);
}

fn close(mut points: Vec<DVec2>, mut facets: Vec<u32>) -> Loop {
    if points.first() == points.last() {
        points.pop();
    } else {
        facets.push(NO_FACET);
    }
    Loop { points, facets }
}
