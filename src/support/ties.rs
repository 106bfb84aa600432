//! Low walls on the bed that join pieces standing near each other, so that supports come off in few
//! pieces.

use super::Job;
use super::cover::{boxes_at, in_plan};
use super::pieces::{self, BedBead};
use super::plates::{self, Plate, lines_at};
use super::spans::{self, Span};
use crate::polygon::PolygonSet;
use crate::sets::Sets;
use crate::slice::Axis;
use crate::sort::StableSort;

/// Height of the walls, mm: stiff enough to pull on, little plastic.
const HEIGHT_MM: f64 = 2.0;

/// A wall that would join two pieces.
#[derive(Debug, Clone, Copy)]
struct Tie {
    axis: Axis,
    at: f64,
    span: Span,
    pieces: [usize; 2],
}

/// Joins pieces by the shortest walls that are free to stand, as long as a wall joins two that no
/// other one has joined.
pub(super) fn join(job: &Job, plates: &mut Vec<Plate>) {
    let limit = job.options.plates.join_distance;
    let beads = pieces::on_bed(&job.frame, plates);
    let mut ties = candidates(job, plates, &beads, limit);
    ties.stable_sort_by(|a, b| {
        let key = |t: &Tie| [t.span[1] - t.span[0], t.at, t.span[0]];
        let by_place = key(a).iter().zip(key(b)).map(|(a, b)| a.total_cmp(&b)).find(|o| o.is_ne());
        by_place.unwrap_or((a.axis == Axis::Y).cmp(&(b.axis == Axis::Y)))
    });
    let mut sets = Sets::new(beads.iter().map(|b| b.piece + 1).max().unwrap_or(0));
    let mut changed = Vec::new();
    for tie in ties {
        let [a, b] = tie.pieces.map(|p| sets.root(p));
        if a != b && is_free(job, &tie) {
            sets.join(a, b);
            changed.push(build(job, &tie, plates));
        }
    }
    plates::lay(&job.frame, plates, |i| changed.contains(&i));
}

/// Straight ways from bead to bead of two pieces.
fn candidates(job: &Job, plates: &[Plate], beads: &[BedBead], limit: f64) -> Vec<Tie> {
    let width = job.frame.width;
    let mut ties = Vec::new();
    for (i, a) in beads.iter().enumerate() {
        for b in beads[i + 1..].iter().filter(|b| b.piece != a.piece) {
            let between = |axis, at, span: Span| Tie { axis, at, span, pieces: [a.piece, b.piece] };
            if a.axis != b.axis {
                ties.extend(lengthened(a, b, width).map(|span| between(a.axis, a.at, span)));
                ties.extend(lengthened(b, a, width).map(|span| between(b.axis, b.at, span)));
            } else if a.at == b.at {
                ties.push(between(a.axis, a.at, [a.span[1].min(b.span[1]), a.span[0].max(b.span[0])]));
            } else if let Some(at) = shared_place(job, plates, a, b) {
                let across = if a.axis == Axis::X { Axis::Y } else { Axis::X };
                ties.push(between(across, at, [a.at.min(b.at), a.at.max(b.at)]));
            }
        }
    }
    ties.retain(|t| t.span[1] - t.span[0] <= limit && t.span[0] < t.span[1]);
    ties
}

/// The way along a bead's own line to a bead that runs across it.
fn lengthened(bead: &BedBead, other: &BedBead, width: f64) -> Option<Span> {
    let meets = spans::meet(other.span, [bead.at, bead.at], width / 2.0);
    let way = if other.at < bead.span[0] { [other.at, bead.span[0]] } else { [bead.span[1], other.at] };
    (meets && way[0] < way[1]).then_some(way)
}

/// A place for a wall across two beads that run beside each other: in a plane that is there, or
/// halfway along what they share.
fn shared_place(job: &Job, plates: &[Plate], a: &BedBead, b: &BedBead) -> Option<f64> {
    let shared = [a.span[0].max(b.span[0]), a.span[1].min(b.span[1])];
    if shared[0] >= shared[1] {
        return None;
    }
    let middle = (shared[0] + shared[1]) / 2.0;
    let gap = |at: &f64| (at - middle).abs();
    let there = plates.iter().filter(|p| p.axis != a.axis).map(|p| p.at);
    let nearest = there.min_by(|x, y| gap(x).total_cmp(&gap(y)));
    let is_shared = |at: &f64| shared[0] <= *at && *at <= shared[1];
    let thickness = job.frame.width * f64::from(job.options.plates.thickness);
    match nearest.filter(is_shared) {
        Some(at) => Some(at),
        None => nearest.is_none_or(|at| gap(&at) >= thickness).then_some(middle),
    }
}

/// Number of layers of a wall.
fn layer_count(job: &Job) -> usize {
    job.frame.layers.partition_point(|l| l.print_z <= HEIGHT_MM + 1e-6).max(1)
}

/// Whether a wall keeps the gaps to the part on its whole way, and out of boxes without supports.
fn is_free(job: &Job, tie: &Tie) -> bool {
    let frame = &job.frame;
    let count = layer_count(job).min(frame.layers.len());
    let grown = [tie.span[0] - frame.width / 2.0, tie.span[1] + frame.width / 2.0];
    let is_clear = |k: usize| {
        let left = frame.clear(k, tie.axis, &[tie.at], &[&[grown]]).remove(0);
        left.len() == 1 && left[0][0] <= tie.span[0] + 1e-6 && left[0][1] >= tie.span[1] - 1e-6
    };
    let high = (count + frame.above[count - 1]).min(frame.layers.len());
    let [a, b] = tie.span.map(|u| in_plan(tie.axis, tie.at, u));
    let wall = PolygonSet::rectangle(a - frame.width / 2.0, b + frame.width / 2.0);
    let blocked = boxes_at(&job.options.blockers, 0.0, frame.layers[count - 1].print_z);
    (0..high).all(is_clear) && wall.intersection(&PolygonSet::union_all(&blocked)).is_empty()
}

/// Gives the wall to the plate of its plane and returns that one's index.
fn build(job: &Job, tie: &Tie, plates: &mut Vec<Plate>) -> usize {
    let frame = &job.frame;
    let there = plates.iter().position(|p| p.axis == tie.axis && p.at == tie.at);
    let index = there.unwrap_or_else(|| {
        let lines = lines_at(tie.at, job.options.plates.thickness, frame);
        let air = vec![Vec::new(); frame.layers.len()];
        plates.push(Plate { axis: tie.axis, at: tie.at, is_added: false, area_mm2: 0.0, air, lines });
        plates.len() - 1
    });
    let grown = [tie.span[0] - frame.width / 2.0, tie.span[1] + frame.width / 2.0];
    for air in plates[index].air.iter_mut().take(layer_count(job)) {
        *air = spans::unite(air, &[grown]);
    }
    index
}
