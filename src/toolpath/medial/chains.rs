//! From branches to the lines that are printed in one go.

use super::axis::{Axis, Branch, Node, Sample};
use crate::polygon::DVec2;
use crate::sets::Sets;
use crate::sort::StableSort;

/// A branch that ends at a corner is a spur when it reaches less than this far out of the circle at
/// its junction, in radii of that circle. A right angle's spur reaches sqrt(2) - 1 = 0.41 radii, one
/// of 77 degrees 0.6.
pub(super) const SPUR_REACH: f64 = 0.6;

/// The same along the branch, which a coarse triangulation bends: a right angle's may reach 0.62 radii.
const MOST_BENT: f64 = 0.8;

/// A spur that reaches less than this is nothing but a corner, in radii.
const CORNER_REACH: f64 = 0.3;

/// Each of the two branches of a fork reaches less than this far out of the circle at its junction, in radii.
const FORK_REACH: f64 = 1.0;

/// Half way along, a branch of a fork is thinner than this share of its junction.
const TAPER: f64 = 0.75;

/// Cosines of the turns into a fork's branches: 20 to 90 degrees.
const FORK_COSINES: std::ops::Range<f64> = 0.0..0.94;

/// Cosine of the turn up to which a branch goes straight on from another: 30 degrees.
const STRAIGHT: f64 = 0.87;

/// Junctions closer than this, in radii of the smaller circle, are one: a crossing whose arms are a
/// little out of line.
const SAME_JUNCTION: f64 = 0.6;

/// How far from a junction, in radii, the direction of a branch is measured. Nearer, the axis bends
/// towards the junction.
pub(super) const DIRECTION_AT: f64 = 2.0;

/// What length is worth against straightness when a junction chooses its through line: the shorter
/// of the two branches, as a share of the longest one there, times this, is added to the cosine of
/// the turn.
const LENGTH_WEIGHT: f64 = 0.5;

/// Largest slant at which a line meets another: at 30 degrees. Beyond, they rather run side by side.
const MAX_SLANT: f64 = 2.0;

/// How a line ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// At the end of a strip, whose outline is `tip` mm away where the axis meets it.
    Strip { tip: f64 },
    /// In a junction, on the line that goes through it. `slant` is the way through half of that
    /// line's bead, in halves of its width: 1 at right angles, more the more slanted.
    Junction { slant: f64 },
}

/// A line of the axis to be filled by one bead.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chain {
    pub(super) line: Vec<Sample>,
    /// How the line starts and ends; `None` for a closed line.
    pub(super) ends: Option<[End; 2]>,
}

/// Removes spurs and joins the branches that go on straight through a junction.
pub(super) fn chains(axis: Axis) -> Vec<Chain> {
    let Axis { nodes, mut branches } = axis;
    let mut node_count = branches.len() + 1;
    // Each round removes at least one branch.
    while branches.len() < node_count {
        node_count = branches.len();
        let partners = partners(nodes.len(), &branches, |_, halves| match halves {
            &[a, b] => Some([a, b]),
            _ => None,
        });
        branches = without_spurs(&nodes, joined(branches, &partners));
    }
    let branches = contracted(&nodes, branches);
    let halves = halves_of_nodes(nodes.len(), &branches);
    let partners = partners(nodes.len(), &branches, straightest);
    let through: Vec<Vec<DVec2>> =
        halves.iter().map(|h| through_directions(&branches, &partners, h)).collect();
    let end = |node: u32, line: &[Sample], reversed: bool| match (
        halves[node as usize].len(),
        end_of(line, reversed),
    ) {
        (0 | 1, Some(last)) => End::Strip { tip: tip(nodes[node as usize], last) },
        _ => End::Junction { slant: slant(&through[node as usize], line, reversed) },
    };
    let chain = |b: Branch| {
        let ends = b.ends.map(|[first, last]| [end(first, &b.line, false), end(last, &b.line, true)]);
        Chain { line: b.line, ends }
    };
    joined(branches, &partners).into_iter().map(chain).collect()
}

/// One end of a branch: twice the branch's number, plus one for the end of its line.
type Half = usize;

fn halves_of_nodes(nodes: usize, branches: &[Branch]) -> Vec<Vec<Half>> {
    let mut halves = vec![Vec::new(); nodes];
    for (b, branch) in branches.iter().enumerate() {
        for (e, &node) in branch.ends.iter().flatten().enumerate() {
            halves[node as usize].push(2 * b + e);
        }
    }
    halves
}

/// For each half the one that continues it, as `choose` says for each node.
fn partners(
    nodes: usize,
    branches: &[Branch],
    choose: impl Fn(&[Branch], &[Half]) -> Option<[Half; 2]>,
) -> Vec<Option<Half>> {
    let mut partners = vec![None; 2 * branches.len()];
    for halves in halves_of_nodes(nodes, branches) {
        if let Some([a, b]) = choose(branches, &halves) {
            (partners[a], partners[b]) = (Some(b), Some(a));
        }
    }
    partners
}

/// The branches put together where they have partners.
fn joined(branches: Vec<Branch>, partners: &[Option<Half>]) -> Vec<Branch> {
    let mut used = vec![false; branches.len()];
    let mut result = Vec::with_capacity(branches.len());
    let open = (0..partners.len()).filter(|&h| partners[h].is_none() && branches[h / 2].ends.is_some());
    for start in open.chain(0..partners.len()) {
        if used[start / 2] {
            continue;
        }
        let mut line: Vec<Sample> = Vec::new();
        let mut half = start;
        let last = loop {
            used[half / 2] = true;
            append(&mut line, &branches[half / 2].line, half % 2 == 1);
            match partners[half ^ 1] {
                Some(next) if !used[next / 2] => half = next,
                _ => break half ^ 1,
            }
        };
        let is_closed = partners[start].is_some();
        let node = |h: Half| branches[h / 2].ends.map(|ends| ends[h % 2]);
        let ends = node(start).zip(node(last)).map(|(a, b)| [a, b]).filter(|_| !is_closed);
        if is_closed && line.len() > 1 && line.first().map(|s| s.at) == line.last().map(|s| s.at) {
            line.pop();
        }
        result.push(Branch { ends, line });
    }
    result
}

fn append(line: &mut Vec<Sample>, more: &[Sample], reversed: bool) {
    let mut push = |s: &Sample| {
        if line.last().is_none_or(|l| l.at != s.at) {
            line.push(*s);
        }
    };
    if reversed { more.iter().rev().for_each(&mut push) } else { more.iter().for_each(&mut push) }
}

/// Drops the branches that only run into a corner of a wider place.
fn without_spurs(nodes: &[Node], branches: Vec<Branch>) -> Vec<Branch> {
    let halves = halves_of_nodes(nodes.len(), &branches);
    let mut dropped = vec![false; branches.len()];
    for (node, halves_here) in nodes.iter().zip(&halves) {
        let Node::Junction(junction) = node else { continue };
        if halves_here.len() < 3 {
            continue;
        }
        if let Some(tines) = fork(nodes, &halves, &branches, halves_here, junction) {
            tines.iter().for_each(|h| dropped[h / 2] = true);
            continue;
        }
        let spur = |&h: &Half| {
            let [straight, along] = reach(nodes, &halves, &branches[h / 2], h, junction)?;
            let is_short = straight <= SPUR_REACH * junction.radius && along <= MOST_BENT * junction.radius;
            (is_short && !goes_on(&branches, halves_here, h, straight / junction.radius))
                .then_some((along, h))
        };
        let mut spurs: Vec<(f64, Half)> = halves_here.iter().filter_map(spur).collect();
        spurs.stable_sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // A blob of nothing but spurs keeps the two longest as its line.
        let keep = if spurs.len() == halves_here.len() { 2 } else { 0 };
        for (_, h) in &spurs[..spurs.len() - keep] {
            dropped[h / 2] = true;
        }
    }
    branches.into_iter().zip(dropped).filter(|(_, dropped)| !dropped).map(|(b, _)| b).collect()
}

/// The two branches into the corners of a stroke's blunt end, or into what is left on both sides of a wall's
/// tip: the line ends between them rather than in one of them.
fn fork(
    nodes: &[Node],
    halves: &[Vec<Half>],
    branches: &[Branch],
    here: &[Half],
    junction: &Sample,
) -> Option<[Half; 2]> {
    let is_tine = |&h: &Half| {
        let branch = &branches[h / 2];
        let Some([straight, along]) = reach(nodes, halves, branch, h, junction) else { return false };
        let off = |s: &Sample| (s.at.distance(junction.at) - (junction.radius + straight) / 2.0).abs();
        let middle = branch.line.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        straight.max(along) <= FORK_REACH * junction.radius
            && middle.is_none_or(|s| s.radius <= TAPER * junction.radius)
    };
    let (tines, stems): (Vec<Half>, Vec<Half>) = here.iter().partition(|h| is_tine(h));
    let (&[a, b], &[stem]) = (&tines[..], &stems[..]) else { return None };
    let way = |h: Half| direction(&branches[h / 2].line, h % 2 == 1);
    let (on, a_way, b_way) = (-way(stem), way(a), way(b));
    let turns_off = |way: DVec2| FORK_COSINES.contains(&way.dot(on));
    let is_between = on.perp_dot(a_way) * on.perp_dot(b_way) < 0.0;
    (is_between && turns_off(a_way) && turns_off(b_way)).then_some([a, b])
}

/// Whether a spur goes straight on where the other two lines of its junction meet at less than 90
/// degrees: the end of a stroke that another meets just before it, as at the top of a 1.
fn goes_on(branches: &[Branch], halves: &[Half], spur: Half, reach: f64) -> bool {
    if halves.len() != 3 || reach < CORNER_REACH {
        return false;
    }
    let way = |h: Half| direction(&branches[h / 2].line, h % 2 == 1);
    let others = halves.iter().filter(|&&h| h != spur).map(|&h| way(h));
    let &[a, b] = others.collect::<Vec<_>>().as_slice() else { return false };
    let on = way(spur);
    a.dot(b) > 0.0 && (-a.dot(on)).max(-b.dot(on)) > STRAIGHT
}

/// How far a branch that ends freely reaches beyond the circle at its junction, straight and along it, mm.
fn reach(
    nodes: &[Node],
    halves: &[Vec<Half>],
    branch: &Branch,
    half: Half,
    junction: &Sample,
) -> Option<[f64; 2]> {
    let far = branch.ends?[1 - half % 2] as usize;
    if halves[far].len() != 1 {
        return None;
    }
    let last = end_of(&branch.line, half.is_multiple_of(2))?;
    let straight = match nodes[far] {
        Node::End { corner } => junction.at.distance(corner),
        Node::Junction(end) => junction.at.distance(end.at) + end.radius,
    };
    let along = length(&branch.line) + tip(nodes[far], last);
    Some([straight - junction.radius, along - junction.radius])
}

fn end_of(line: &[Sample], last: bool) -> Option<Sample> {
    if last { line.last().copied() } else { line.first().copied() }
}

/// How far the outline is from the last point of a line that ends at `node`, mm.
fn tip(node: Node, last: Sample) -> f64 {
    match node {
        Node::Junction(sample) => sample.radius,
        Node::End { corner } => last.at.distance(corner),
    }
}

/// Makes one node of junctions that all but coincide.
fn contracted(nodes: &[Node], branches: Vec<Branch>) -> Vec<Branch> {
    let degrees: Vec<usize> = halves_of_nodes(nodes.len(), &branches).iter().map(Vec::len).collect();
    let radius = |n: u32| match nodes[n as usize] {
        Node::Junction(sample) if degrees[n as usize] > 2 => sample.radius,
        _ => 0.0,
    };
    let is_link = |b: &Branch| {
        let limit = b.ends.map_or(0.0, |[m, n]| radius(m).min(radius(n)) * SAME_JUNCTION);
        limit > 0.0 && length(&b.line) <= limit
    };
    let (links, mut rest): (Vec<Branch>, Vec<Branch>) = branches.into_iter().partition(is_link);
    let mut sets = Sets::new(nodes.len());
    for [m, n] in links.iter().filter_map(|b| b.ends) {
        sets.join(m as usize, n as usize);
    }
    for branch in &mut rest {
        branch.ends = branch.ends.map(|ends| ends.map(|n| sets.root(n as usize) as u32));
    }
    rest
}

/// The two halves at a node that make the straightest and longest line.
fn straightest(branches: &[Branch], halves: &[Half]) -> Option<[Half; 2]> {
    let lengths: Vec<f64> = halves.iter().map(|&h| length(&branches[h / 2].line)).collect();
    let longest = lengths.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let directions: Vec<DVec2> =
        halves.iter().map(|&h| direction(&branches[h / 2].line, h % 2 == 1)).collect();
    let mut best: Option<(f64, [Half; 2])> = None;
    for i in 0..halves.len() {
        for j in i + 1..halves.len() {
            let length = lengths[i].min(lengths[j]) / longest;
            let score = LENGTH_WEIGHT * length - directions[i].dot(directions[j]);
            if best.is_none_or(|(b, _)| score > b) {
                best = Some((score, [halves[i], halves[j]]));
            }
        }
    }
    best.map(|(_, pair)| pair)
}

/// The directions from a node along the line that goes through it.
fn through_directions(branches: &[Branch], partners: &[Option<Half>], halves: &[Half]) -> Vec<DVec2> {
    let through = halves.iter().filter(|&&h| partners[h].is_some());
    through.map(|&h| direction(&branches[h / 2].line, h % 2 == 1)).collect()
}

/// [`End::Junction`]'s slant: one over the sine of the angle to the nearer side of the through line.
fn slant(through: &[DVec2], line: &[Sample], reversed: bool) -> f64 {
    let own = direction(line, reversed);
    let nearer = through.iter().max_by(|a, b| a.dot(own).total_cmp(&b.dot(own)));
    nearer.map_or(1.0, |d| 1.0 / d.perp_dot(own).abs().max(1.0 / MAX_SLANT))
}

/// Unit vector into a line from its start, or from its end if `reversed`; zero without length.
pub(super) fn direction(line: &[Sample], reversed: bool) -> DVec2 {
    let from = |i: usize| if reversed { line[line.len() - 1 - i] } else { line[i] };
    let Some(start) = (!line.is_empty()).then(|| from(0)) else { return DVec2::ZERO };
    let far = (1..line.len()).map(from).find(|s| s.at.distance(start.at) >= DIRECTION_AT * start.radius);
    let far = far.unwrap_or_else(|| from(line.len() - 1));
    (far.at - start.at).normalize_or_zero()
}

/// Length of a line, mm.
pub(super) fn length(line: &[Sample]) -> f64 {
    line.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
}
