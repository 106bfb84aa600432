//! Dense layers between plates and part.
//!
//! Below what must be held the topmost layers are lines side by side. They run over the plates of
//! one direction and between those of the other, which stay as they are.

use std::collections::BTreeMap;

use super::Job;
use super::beads::Bead;
use super::cover::{Need, is_held_along};
use super::plates::Plate;
use super::report::PlateAxis;
use super::spans::{self, Span};
use crate::polygon::{DVec2, Join, PolygonSet, dvec2};
use crate::region::Role;
use crate::slice::Axis;

/// Shorter lines, mm, hold nothing.
const SHORTEST_MM: f64 = 0.5;

/// Where a layer is dense, for centre lines.
pub(super) struct Dense {
    area: PolygonSet,
}

/// The dense areas by layer.
pub(super) fn areas(job: &Job, needs: &[Need]) -> BTreeMap<usize, Dense> {
    let frame = &job.frame;
    let mut below: BTreeMap<usize, Vec<&PolygonSet>> = BTreeMap::new();
    for need in needs {
        for i in 0..(job.options.interface_layers as usize).min(need.top + 1) {
            below.entry(need.top - i).or_default().push(&need.area);
        }
    }
    // Below a gap the bed's first layer stays bare plates: they must hold on to it.
    below.remove(&0);
    let area_of = |k: usize, needs: Vec<&PolygonSet>| {
        let near = (k - frame.below[k])..=(k + frame.above[k]).min(frame.areas.len() - 1);
        let part = PolygonSet::union_all(near.filter(|&i| i != k).map(|i| &frame.areas[i]));
        let beside = frame.areas[k].offset(frame.clearance, Join::WALL);
        let area = PolygonSet::union_all(needs).offset(-frame.width / 2.0, Join::WALL);
        area.difference(&part).difference(&beside)
    };
    let mut dense = BTreeMap::new();
    for (k, needs) in below {
        let area = area_of(k, needs);
        if !area.is_empty() {
            dense.insert(k, Dense { area });
        }
    }
    dense
}

/// Lays the lines of layer `k` and takes the plates' beads that cross them out of `lines`, unless
/// these are needed for coverage: then the dense lines are broken instead.
pub(super) fn lay(
    job: &Job,
    needs: &[Need],
    plates: &[Plate],
    k: usize,
    dense: &Dense,
    lines: &mut [Vec<(f64, Vec<Span>)>; 2],
) -> Vec<Bead> {
    let (along, across) = if k.is_multiple_of(2) { (1, 0) } else { (0, 1) };
    let axis = [Axis::X, Axis::Y][along];
    let width = job.frame.width;
    let mut pieces = scan(&dense.area, axis, width);
    pieces.retain(|(_, spans)| !spans.is_empty());
    let relies = needs.iter().any(|n| n.top == k && !is_held_along(job, n, plates, axis));
    if relies {
        break_lines(&mut pieces, &lines[across], width);
    } else {
        break_lines(&mut lines[across], &pieces, width);
    }
    beside_lines(&mut pieces, &lines[along], width);
    to_beads(pieces, if along == 0 { PlateAxis::X } else { PlateAxis::Y })
}

/// Level lines of an area, a bead's width apart, at whole multiples of it.
fn scan(area: &PolygonSet, axis: Axis, width: f64) -> Vec<(f64, Vec<Span>)> {
    let Some(bounds) = area.bounds() else { return Vec::new() };
    let (low, high) = (turned(axis, bounds.min).x, turned(axis, bounds.max).x);
    let first = (low / width).ceil();
    let count = ((high / width).floor() - first + 1.0).max(0.0) as usize;
    let places: Vec<f64> = (0..count).map(|i| (first + i as f64) * width).collect();
    let lines = level_lines(area, axis, &places);
    places.into_iter().zip(lines).collect()
}

/// The stretches of the lines `axis = places[i]`, ascending, that lie in an area.
pub(super) fn level_lines(area: &PolygonSet, axis: Axis, places: &[f64]) -> Vec<Vec<Span>> {
    let mut hits: Vec<Vec<f64>> = vec![Vec::new(); places.len()];
    for (a, b) in area.contours().iter().flat_map(|c| c.edges()) {
        let (a, b) = (turned(axis, a), turned(axis, b));
        let (from, to) = (a.x.min(b.x), a.x.max(b.x));
        let first = places.partition_point(|&at| at < from);
        let met = places[first..].iter().zip(&mut hits[first..]).take_while(|(at, _)| **at < to);
        for (at, hit) in met {
            hit.push(a.y + (at - a.x) * (b.y - a.y) / (b.x - a.x));
        }
    }
    let pair = |mut hit: Vec<f64>| -> Vec<Span> {
        hit.sort_by(f64::total_cmp);
        hit.chunks_exact(2).map(|c| [c[0], c[1]]).filter(|s| s[0] < s[1]).collect()
    };
    hits.into_iter().map(pair).collect()
}

/// A point as (across the planes, along them).
fn turned(axis: Axis, p: DVec2) -> DVec2 {
    if axis == Axis::X { p } else { dvec2(p.y, p.x) }
}

/// Takes out of `lines` what comes within a width of the crossing `others`.
fn break_lines(lines: &mut [(f64, Vec<Span>)], others: &[(f64, Vec<Span>)], width: f64) {
    for (at, spans) in lines {
        let hit = |other: &&(f64, Vec<Span>)| other.1.iter().any(|&s| spans::meet(s, [*at, *at], width));
        let mut cuts: Vec<Span> = others.iter().filter(hit).map(|o| [o.0 - width, o.0 + width]).collect();
        spans::tidy(&mut cuts);
        *spans = spans::subtract(spans, &cuts);
    }
}

/// Takes out of `lines` what runs beside one of `others` nearer than a width.
fn beside_lines(lines: &mut [(f64, Vec<Span>)], others: &[(f64, Vec<Span>)], width: f64) {
    for (at, spans) in lines {
        for (_, taken) in others.iter().filter(|o| (o.0 - *at).abs() < width - 1e-9) {
            let grown: Vec<Span> = taken.iter().map(|s| [s[0] - width, s[1] + width]).collect();
            *spans = grown.iter().fold(std::mem::take(spans), |left, cut| spans::subtract(&left, &[*cut]));
        }
    }
}

fn to_beads(lines: Vec<(f64, Vec<Span>)>, axis: PlateAxis) -> Vec<Bead> {
    let mut beads = Vec::new();
    for (i, (at, spans)) in lines.into_iter().enumerate() {
        let long = spans.into_iter().filter(|s| s[1] - s[0] > SHORTEST_MM);
        let bead = |s: Span| Bead { role: Role::SupportInterface, axis, at, from: s[0], to: s[1] };
        match i % 2 {
            0 => beads.extend(long.map(bead)),
            _ => {
                let back = long.map(|s| bead([s[1], s[0]])).collect::<Vec<_>>();
                beads.extend(back.into_iter().rev());
            }
        }
    }
    beads
}
