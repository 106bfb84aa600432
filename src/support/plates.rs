//! Plates: where their planes stand, and the centre lines of their beads in every layer.

use super::frame::Frame;
use super::plane::Column;
use super::spans::{self, Span};
use crate::slice::Axis;
use crate::sort::StableSort;

/// The plates of one plane.
pub(super) struct Plate {
    /// Normal of the plane.
    pub(super) axis: Axis,
    /// Place of the plane along its normal, mm.
    pub(super) at: f64,
    /// Whether it was put in for what regular planes do not reach.
    pub(super) is_added: bool,
    /// Area of its support region before gaps, cuts and drops, mm2.
    pub(super) area_mm2: f64,
    /// Per layer: where there is room, gaps above and below taken off.
    pub(super) air: Vec<Vec<Span>>,
    /// Its lines, side by side.
    pub(super) lines: Vec<Line>,
}

/// One line of a plate: a stack of straight beads.
pub(super) struct Line {
    /// Place along the plane's normal, mm.
    pub(super) at: f64,
    /// Per layer: centre lines of beads before crossings are broken.
    pub(super) beads: Vec<Vec<Span>>,
}

impl Plate {
    /// The plate of a regular plane.
    pub(super) fn of_columns(axis: Axis, at: f64, columns: &[Column], frame: &Frame, lines: u32) -> Plate {
        let area_mm2 = columns.iter().map(Column::area).sum();
        Plate {
            axis,
            at,
            is_added: false,
            area_mm2,
            air: frame.air(columns),
            lines: lines_at(at, lines, frame),
        }
    }

    /// Where the plate comes to rest on the part: room at a layer that is none at the one below.
    pub(super) fn landing(&self, layer: usize) -> Vec<Span> {
        match layer.checked_sub(1) {
            Some(below) => spans::subtract(&self.air[layer], &self.air[below]),
            None => self.air[layer].clone(),
        }
    }
}

/// Empty lines beside each other around the plane at `at`.
pub(super) fn lines_at(at: f64, count: u32, frame: &Frame) -> Vec<Line> {
    let first = at - f64::from(count - 1) / 2.0 * frame.width;
    let place = |i: u32| first + f64::from(i) * frame.width;
    (0..count).map(|i| Line { at: place(i), beads: vec![Vec::new(); frame.layers.len()] }).collect()
}

/// Places of regular planes between `low` and `high`: the first half a spacing in.
pub(super) fn regular_places(low: f64, high: f64, spacing: f64) -> Vec<f64> {
    let place = |i: u32| low + spacing / 2.0 + f64::from(i) * spacing;
    (0..).map(place).take_while(|&at| at < high).collect()
}

/// Lays the beads of those plates that `choose` names, clear of the part's outlines.
pub(super) fn lay(frame: &Frame, plates: &mut [Plate], choose: impl Fn(usize) -> bool) {
    for axis in [Axis::X, Axis::Y] {
        let chosen = plates.iter().enumerate().filter(|(i, p)| choose(*i) && p.axis == axis);
        let of_plate = |(i, p): (usize, &Plate)| {
            p.lines.iter().map(|l| l.at).zip(0..).map(move |(at, l)| (at, i, l)).collect::<Vec<_>>()
        };
        let mut lines: Vec<(f64, usize, usize)> = chosen.flat_map(of_plate).collect();
        lines.stable_sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let places: Vec<f64> = lines.iter().map(|l| l.0).collect();
        for k in 0..frame.layers.len() {
            let air: Vec<&[Span]> =
                lines.iter().map(|&(_, plate, _)| plates[plate].air[k].as_slice()).collect();
            if air.iter().all(|a| a.is_empty()) {
                continue;
            }
            for (beads, &(_, plate, line)) in frame.clear(k, axis, &places, &air).into_iter().zip(&lines) {
                plates[plate].lines[line].beads[k] = beads;
            }
        }
    }
}
