//! Beads of each layer: crossings broken in turn, feet on the bed, interface below the part.

use serde::{Deserialize, Serialize};

use super::Job;
use super::cover::{Need, in_plan};
use super::frame::Frame;
use super::interface::{self, Dense};
use super::plates::{Plate, lines_at};
use super::report::PlateAxis;
use super::spans::{self, Span};
use crate::polygon::Contour;
use crate::region::{Path, Role};
use crate::slice::Axis;
use crate::sort::StableSort;

/// Shorter centre lines, mm, are not worth a stop of the nozzle.
const SHORTEST_MM: f64 = 0.05;

/// A straight bead along one of the two axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bead {
    /// Support or support interface.
    pub role: Role,
    /// The plane it lies in: a bead in a plane x = const runs along y.
    pub axis: PlateAxis,
    /// Place of the plane, mm.
    pub at: f64,
    /// First and last point along the plane, mm; may run backwards.
    pub from: f64,
    /// See `from`.
    pub to: f64,
}

impl Bead {
    fn ends(&self) -> [crate::polygon::DVec2; 2] {
        let axis = if self.axis == PlateAxis::X { Axis::X } else { Axis::Y };
        [self.from, self.to].map(|u| in_plan(axis, self.at, u))
    }

    pub(super) fn path(&self, width: f64) -> Path {
        Path::open(self.role, self.ends().to_vec(), width)
    }

    /// The rectangle that the bead covers, half a width past its ends.
    pub(super) fn outline(&self, width: f64) -> Contour {
        let [a, b] = self.ends();
        let (low, high) = (a.min(b) - width / 2.0, a.max(b) + width / 2.0);
        Contour::new(vec![
            low,
            crate::polygon::dvec2(high.x, low.y),
            high,
            crate::polygon::dvec2(low.x, high.y),
        ])
    }
}

/// Lines along one axis in one layer, ascending: place and stretches.
type Lines = Vec<(f64, Vec<Span>)>;

/// The beads of every layer, and the volume of the plates alone, mm3.
pub(super) fn assemble(job: &Job, needs: &[Need], plates: &[Plate]) -> (Vec<Vec<Bead>>, f64) {
    let frame = &job.frame;
    let dense = interface::areas(job, needs);
    let mut volume = 0.0;
    let layer = |k: usize| {
        let mut lines = [Axis::X, Axis::Y].map(|axis| lines_of(plates, axis, k));
        break_crossings(&mut lines, k % 2, frame.width);
        let in_layer: f64 = lines.iter().flatten().map(|(_, s)| material(s, frame.width)).sum();
        volume += in_layer * frame.width * frame.layers[k].height;
        if k == 0 {
            lines = [Axis::X, Axis::Y].map(|axis| with_feet(frame, plates, axis, lines_of(plates, axis, 0)));
            break_crossings(&mut lines, 0, frame.width);
        }
        let interface = dense
            .get(&k)
            .map_or(Vec::new(), |d: &Dense| interface::lay(job, needs, plates, k, d, &mut lines));
        let mut beads = in_order(&lines);
        beads.extend(interface);
        beads
    };
    let layers = (0..frame.layers.len()).map(layer).collect();
    (layers, volume)
}

/// Length of the plastic, which reaches half a width past each centre line.
fn material(spans: &[Span], width: f64) -> f64 {
    spans::length(spans) + width * spans.len() as f64
}

fn lines_of(plates: &[Plate], axis: Axis, k: usize) -> Lines {
    let of_axis = plates.iter().filter(|p| p.axis == axis).flat_map(|p| &p.lines);
    let mut lines: Lines =
        of_axis.filter(|l| !l.beads[k].is_empty()).map(|l| (l.at, l.beads[k].clone())).collect();
    lines.stable_sort_by(|a, b| a.0.total_cmp(&b.0));
    lines
}

/// Breaks the lines of one axis where those of the other run, so that no spot is printed twice.
fn break_crossings(lines: &mut [Lines; 2], broken: usize, width: f64) {
    let whole = std::mem::take(&mut lines[1 - broken]);
    for (at, spans) in &mut lines[broken] {
        let hit = |other: &&(f64, Vec<Span>)| other.1.iter().any(|&s| spans::meet(s, [*at, *at], width));
        let mut cuts: Vec<Span> = whole.iter().filter(hit).map(|o| [o.0 - width, o.0 + width]).collect();
        spans::tidy(&mut cuts);
        // A bead that is short by itself is a pin, whole in every layer.
        let broken = spans::subtract(spans, &cuts);
        let is_whole = |s: &Span| spans.contains(s);
        *spans = broken.iter().copied().filter(|s| s[1] - s[0] > SHORTEST_MM || is_whole(s)).collect();
    }
    lines[1 - broken] = whole;
}

/// The first layer's lines with one more on either side, where there is room.
fn with_feet(frame: &Frame, plates: &[Plate], axis: Axis, mut lines: Lines) -> Lines {
    for plate in plates.iter().filter(|p| p.axis == axis) {
        let count = plate.lines.len() as u32;
        if count > 2 {
            continue;
        }
        let beads = plate.lines.iter().fold(Vec::new(), |all, l| spans::unite(&all, &l.beads[0]));
        let wide = lines_at(plate.at, count + 2, frame);
        for at in [wide[0].at, wide[wide.len() - 1].at] {
            let is_taken = lines.iter().any(|(other, spans)| {
                (other - at).abs() < frame.width - 1e-9
                    && spans.iter().any(|s| beads.iter().any(|b| spans::meet(*s, *b, frame.width)))
            });
            if !is_taken && !beads.is_empty() {
                // As long as the plate's own bead, and as clear of the part.
                let air = frame.clear(0, axis, &[at], &[&spans_grown(&beads, frame.width / 2.0)]).remove(0);
                lines.push((at, air));
            }
        }
    }
    lines.stable_sort_by(|a, b| a.0.total_cmp(&b.0));
    lines
}

fn spans_grown(spans: &[Span], by: f64) -> Vec<Span> {
    let mut grown = spans.iter().map(|s| [s[0] - by, s[1] + by]).collect();
    spans::tidy(&mut grown);
    grown
}

/// To and fro: every other line runs backwards.
fn in_order(lines: &[Lines; 2]) -> Vec<Bead> {
    let mut beads = Vec::new();
    for (axis, lines) in [PlateAxis::X, PlateAxis::Y].into_iter().zip(lines) {
        for (i, (at, spans)) in lines.iter().enumerate() {
            let bead = |s: &Span| Bead { role: Role::Support, axis, at: *at, from: s[0], to: s[1] };
            let back = |s: &Span| Bead { from: s[1], to: s[0], ..bead(s) };
            match i % 2 {
                0 => beads.extend(spans.iter().map(bead)),
                _ => beads.extend(spans.iter().rev().map(back)),
            }
        }
    }
    beads
}

/// Area of the plates' ends that face the part: what a layer has and the next one has not.
pub(super) fn contact(frame: &Frame, plates: &[Plate]) -> f64 {
    let mut length = 0.0;
    for line in plates.iter().flat_map(|p| &p.lines) {
        for (k, beads) in line.beads.iter().enumerate() {
            let above = line.beads.get(k + 1).map_or(&[][..], Vec::as_slice);
            length += spans::length(&spans::subtract(beads, above));
            if let Some(below) = k.checked_sub(1) {
                length += spans::length(&spans::subtract(beads, &line.beads[below]));
            }
        }
    }
    length * frame.width
}
