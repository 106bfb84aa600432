//! The layers that supports are laid in, and how far they keep from the part.

use super::options::SupportOptions;
use super::plane::Column;
use super::spans::{self, Span};
use crate::polygon::{DVec2, PolygonSet};
use crate::slice::{Axis, LayerSpec};

/// Vertical tolerance, mm: a gap of 0.2 is one layer of 0.2 whatever rounding says.
const HEIGHT_SLACK_MM: f64 = 1e-6;

/// Planes are cut as if they lay this much lower, mm, as everywhere in `slice`.
const CUT_BELOW_MM: f64 = 1e-9;

/// Layers, gaps and line width.
pub(super) struct Frame<'a> {
    pub(super) layers: &'a [LayerSpec],
    pub(super) areas: &'a [PolygonSet],
    /// Width of a line, mm.
    pub(super) width: f64,
    /// From a bead's centre line to the part's outline, mm.
    pub(super) clearance: f64,
    /// Empty layers above each layer's supports.
    pub(super) above: Vec<usize>,
    /// Empty layers below each layer's supports where they stand on the part.
    pub(super) below: Vec<usize>,
}

impl<'a> Frame<'a> {
    pub(super) fn new(layers: &'a [LayerSpec], areas: &'a [PolygonSet], options: &SupportOptions) -> Self {
        let count = layers.len();
        let needed = |heights: &mut dyn Iterator<Item = f64>| {
            let left = heights.scan(options.gap_z - HEIGHT_SLACK_MM, |missing, height| {
                let before = *missing;
                *missing -= height;
                Some(before)
            });
            left.take_while(|&missing| missing > 0.0).count()
        };
        let heights = |range: std::ops::Range<usize>| range.map(|i| layers[i].height);
        Frame {
            layers,
            areas,
            width: options.line_width,
            clearance: options.gap_xy + options.line_width / 2.0,
            above: (0..count).map(|k| needed(&mut heights(k + 1..count))).collect(),
            below: (0..count).map(|k| needed(&mut heights(0..k).rev())).collect(),
        }
    }

    /// The layer below the gap under the part's layer `k + 1`, if there is one.
    pub(super) fn top_under(&self, k: usize) -> Option<usize> {
        (0..=k).rev().find(|&j| j + self.above[j] <= k)
    }

    /// The columns cut by every layer, gaps above and below taken off.
    pub(super) fn air(&self, columns: &[Column]) -> Vec<Vec<Span>> {
        let mut air: Vec<Vec<Span>> = vec![Vec::new(); self.layers.len()];
        for column in columns {
            let low = column.floor[0].min(column.floor[1]);
            let high = column.ceiling[0].max(column.ceiling[1]);
            let first = self.layers.partition_point(|l| l.slice_z - CUT_BELOW_MM <= low);
            for (layer, spans) in self.layers.iter().zip(&mut air).skip(first) {
                let z = layer.slice_z - CUT_BELOW_MM;
                if z >= high {
                    break;
                }
                if let Some(span) = column.at_height(z) {
                    match spans.last_mut() {
                        Some(last) if last[1] == span[0] => last[1] = span[1],
                        _ => spans.push(span),
                    }
                }
            }
        }
        air.iter_mut().for_each(spans::tidy);
        self.eroded(&air)
    }

    fn eroded(&self, air: &[Vec<Span>]) -> Vec<Vec<Span>> {
        let erode = |k: usize| {
            let near = (k - self.below[k])..=(k + self.above[k]);
            let others = near.filter(|&i| i != k && air.get(i) != Some(&air[k]));
            others.fold(air[k].clone(), |left, i| {
                spans::intersect(&left, air.get(i).map_or(&[], Vec::as_slice))
            })
        };
        (0..air.len()).map(|k| if air[k].is_empty() { Vec::new() } else { erode(k) }).collect()
    }

    /// Centre lines of beads in stretches of air at layer `k`, for lines `axis = places[i]`,
    /// ascending: shortened by half a bead and kept clear of the part's outline.
    pub(super) fn clear(&self, k: usize, axis: Axis, places: &[f64], air: &[&[Span]]) -> Vec<Vec<Span>> {
        let mut taken: Vec<Vec<Span>> = vec![Vec::new(); places.len()];
        let reach = self.clearance;
        for (a, b) in self.areas[k].contours().iter().flat_map(|c| c.edges()) {
            let (a, b) = (across_along(axis, a), across_along(axis, b));
            let (low, high) = (a.x.min(b.x) - reach, a.x.max(b.x) + reach);
            let first = places.partition_point(|&p| p <= low);
            let met = places[first..].iter().zip(first..).take_while(|(p, _)| **p < high);
            for (&place, i) in met.filter(|(_, i)| !air[*i].is_empty()) {
                taken[i].extend(near_segment(a, b, place, reach));
            }
        }
        let keep = |(spans_of, mut cut): (&&[Span], Vec<Span>)| {
            spans::tidy(&mut cut);
            spans::subtract(&spans::shrink(spans_of, self.width / 2.0), &cut)
        };
        air.iter().zip(taken).map(keep).collect()
    }
}

/// A point of a layer as (along the plane's normal, along the plane).
fn across_along(axis: Axis, p: DVec2) -> DVec2 {
    if axis == Axis::X { p } else { DVec2::new(p.y, p.x) }
}

/// The stretch of the line x = `place` nearer than `reach` to the segment a-b, along y.
fn near_segment(a: DVec2, b: DVec2, place: f64, reach: f64) -> Option<Span> {
    let mut hull = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |y: f64| hull = [hull[0].min(y), hull[1].max(y)];
    for end in [a, b] {
        let off = place - end.x;
        let half = reach * reach - off * off;
        if half >= 0.0 {
            add(end.y - half.sqrt());
            add(end.y + half.sqrt());
        }
    }
    let side = (b - a).normalize_or_zero().perp() * reach;
    for (p, q) in [(a + side, b + side), (a - side, b - side)] {
        if (p.x > place) != (q.x > place) {
            add(p.y + (place - p.x) * (q.y - p.y) / (q.x - p.x));
        }
    }
    (hull[0] < hull[1]).then_some(hull)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn a_line_keeps_its_distance_from_an_edge_and_its_ends() {
        let near = |place: f64| near_segment(dvec2(0.0, 0.0), dvec2(10.0, 0.0), place, 1.0);
        assert_eq!(near(5.0), Some([-1.0, 1.0]));
        let beyond = near(10.6).expect("the end is near");
        assert!((beyond[1] - 0.8).abs() < 1e-12 && (beyond[0] + 0.8).abs() < 1e-12);
        assert_eq!(near(11.5), None);
        let upright = near_segment(dvec2(0.0, 0.0), dvec2(0.0, 10.0), 0.6, 1.0);
        assert!(upright.is_some_and(|s| (s[0] + 0.8).abs() < 1e-12 && (s[1] - 10.8).abs() < 1e-12));
    }
}
