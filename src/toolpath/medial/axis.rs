//! From triangles to branches of the medial axis.

use super::border::{NONE, Triangles};
use crate::polygon::DVec2;

/// Rounds of Newton's method that move a point onto the medial axis. Two give 1e-4 mm in the tests'
/// shapes.
const ROUNDS: usize = 3;

/// Where the directions to the two nearest points of the outline differ by less than this (length
/// of the difference of unit vectors), both lie on the same side, and the point stays.
const SAME_SIDE: f64 = 0.3;

/// A point of the medial axis and its distance to the outline, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::toolpath) struct Sample {
    pub(in crate::toolpath) at: DVec2,
    pub(in crate::toolpath) radius: f64,
}

/// Where branches end or meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Node {
    /// The axis runs out at a corner of the outline.
    End { corner: DVec2 },
    /// Three branches meet here.
    Junction(Sample),
}

/// A line of the axis between two nodes. At a junction the line contains the junction itself; at an
/// end it stops at the last inner edge.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Branch {
    /// Node at the start and at the end of the line; `None` for a closed line.
    pub(super) ends: Option<[u32; 2]>,
    pub(super) line: Vec<Sample>,
}

/// Nodes and branches.
#[derive(Debug, Default)]
pub(super) struct Axis {
    pub(super) nodes: Vec<Node>,
    pub(super) branches: Vec<Branch>,
}

/// The chordal axis, its points moved onto the medial axis.
pub(super) fn chordal_axis(triangles: &Triangles) -> Axis {
    let mut axis = Axis::default();
    let mut node_of = vec![NONE; triangles.len()];
    for t in 0..triangles.len() as u32 {
        if triangles.inner_edges(t) != 2 {
            node_of[t as usize] = axis.nodes.len() as u32;
            axis.nodes.push(node(triangles, t));
        }
    }
    let mut seen = vec![[false; 3]; triangles.len()];
    for t in (0..triangles.len() as u32).filter(|&t| node_of[t as usize] != NONE) {
        for side in 0..3 {
            trace(triangles, t, side, &node_of, &mut seen, &mut axis);
        }
        if triangles.inner_edges(t) == 0 {
            lone_triangle(triangles, t, &mut axis);
        }
    }
    for t in 0..triangles.len() as u32 {
        for side in 0..3 {
            trace(triangles, t, side, &node_of, &mut seen, &mut axis);
        }
    }
    axis
}

/// Follows the inner edges from `side` of triangle `start` to the next node, or around to the start.
fn trace(
    triangles: &Triangles,
    start: u32,
    side: usize,
    node_of: &[u32],
    seen: &mut [[bool; 3]],
    axis: &mut Axis,
) {
    let mut line = Vec::new();
    let (mut t, mut out) = (start, side);
    while !seen[t as usize][out] {
        let Some((other, back)) = triangles.across(t, out) else { break };
        seen[t as usize][out] = true;
        seen[other as usize][back] = true;
        line.push(chord(triangles, t, out));
        t = other;
        if node_of[t as usize] != NONE {
            break;
        }
        let is_way_out = |&k: &usize| k != back && triangles.across(t, k).is_some();
        let Some(next) = (0..3).find(is_way_out) else { break };
        out = next;
    }
    if line.is_empty() {
        return;
    }
    let ends = [node_of[start as usize], node_of[t as usize]];
    if ends.contains(&NONE) {
        axis.branches.push(Branch { ends: None, line });
        return;
    }
    if let Node::Junction(sample) = axis.nodes[ends[0] as usize] {
        line.insert(0, sample);
    }
    if let Node::Junction(sample) = axis.nodes[ends[1] as usize] {
        line.push(sample);
    }
    axis.branches.push(Branch { ends: Some(ends), line: without_crowding(line, &ends, &axis.nodes) });
}

/// Drops the points between the first and the last that lie within half a radius of a junction at
/// either end: the junction has moved, and they may lie on its other side.
fn without_crowding(line: Vec<Sample>, ends: &[u32; 2], nodes: &[Node]) -> Vec<Sample> {
    let last = line.len() - 1;
    let is_crowded = |sample: &Sample| {
        ends.iter().any(|&end| match nodes[end as usize] {
            Node::End { .. } => false,
            Node::Junction(j) => sample.at.distance(j.at) < j.radius / 2.0,
        })
    };
    let kept = line.iter().enumerate().filter(|&(i, s)| i == 0 || i == last || !is_crowded(s));
    kept.map(|(_, &s)| s).collect()
}

/// A triangle without inner edges is a whole area: its axis is the centre of its inscribed circle,
/// with an end to either side.
fn lone_triangle(triangles: &Triangles, t: u32, axis: &mut Axis) {
    let corners @ [a, b, c] = triangles.corners(t).map(|v| triangles.point(v));
    let [la, lb, lc] = [b.distance(c), c.distance(a), a.distance(b)];
    let at = (a * la + b * lb + c * lc) / (la + lb + lc);
    let radius = (b - a).perp_dot(c - a) / (la + lb + lc);
    let first = axis.nodes.len() as u32;
    axis.nodes.extend(corners[..2].iter().map(|&corner| Node::End { corner }));
    axis.branches.push(Branch { ends: Some([first, first + 1]), line: vec![Sample { at, radius }] });
}

fn node(triangles: &Triangles, t: u32) -> Node {
    match triangles.inner_edges(t) {
        3 => Node::Junction(junction(triangles, triangles.corners(t))),
        1 => {
            let inner = (0..3).find(|&k| triangles.across(t, k).is_some()).unwrap_or(0);
            Node::End { corner: triangles.point(triangles.corners(t)[(inner + 2) % 3]) }
        }
        _ => Node::End { corner: triangles.point(triangles.corners(t)[0]) },
    }
}

/// The middle of an inner edge, moved until it is equally far from the sides at its two ends.
fn chord(triangles: &Triangles, t: u32, side: usize) -> Sample {
    let corners = triangles.corners(t);
    let (a, b) = (corners[side], corners[(side + 1) % 3]);
    let middle = (triangles.point(a) + triangles.point(b)) / 2.0;
    let reach = triangles.point(a).distance(triangles.point(b)) / 2.0;
    let mut at = middle;
    for _ in 0..ROUNDS {
        let [(to_a, da), (to_b, db)] = [a, b].map(|v| away(triangles, v, at));
        let difference = to_a - to_b;
        if difference.length() < SAME_SIDE {
            break;
        }
        let moved = at + difference * ((db - da) / difference.length_squared());
        if moved.distance(middle) > reach {
            break;
        }
        at = moved;
    }
    Sample { at, radius: clearance(triangles, &[a, b], at) }
}

/// The point equally far from the sides at all three corners, near the middle of the circle through
/// the corners.
fn junction(triangles: &Triangles, corners: [u32; 3]) -> Sample {
    let start = centre(corners.map(|v| triangles.point(v)));
    let reach = clearance(triangles, &corners, start);
    let mut at = start;
    for _ in 0..ROUNDS {
        let [(ua, da), (ub, db), (uc, dc)] = corners.map(|v| away(triangles, v, at));
        let (g, h) = (ua - ub, ua - uc);
        let det = g.perp_dot(h);
        if det.abs() < SAME_SIDE * SAME_SIDE {
            break;
        }
        // Solves g . step = db - da and h . step = dc - da.
        let (e, f) = (db - da, dc - da);
        let moved = at + DVec2::new(e * h.y - f * g.y, f * g.x - e * h.x) / det;
        if moved.distance(start) > reach {
            break;
        }
        at = moved;
    }
    Sample { at, radius: clearance(triangles, &corners, at) }
}

/// Centre of the circle through the corners if it lies inside, else the middle of the longest edge.
fn centre([a, b, c]: [DVec2; 3]) -> DVec2 {
    let edges = [(a, b, c), (b, c, a), (c, a, b)];
    if let Some(&(p, q, _)) = edges.iter().find(|(p, q, r)| (*p - *r).dot(*q - *r) <= 0.0) {
        return (p + q) / 2.0;
    }
    let (u, v) = (b - a, c - a);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    a + DVec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / (2.0 * u.perp_dot(v))
}

/// Unit vector from the outline near `vertex` to `p`, and that distance.
fn away(triangles: &Triangles, vertex: u32, p: DVec2) -> (DVec2, f64) {
    let from = p - triangles.nearest(vertex, p);
    (from.normalize_or_zero(), from.length())
}

/// Distance from `p` to the outline near the given vertices.
fn clearance(triangles: &Triangles, vertices: &[u32], p: DVec2) -> f64 {
    vertices.iter().map(|&v| triangles.nearest(v, p).distance(p)).fold(f64::INFINITY, f64::min)
}
