//! The figures of the report.

use super::attachment::length_within;
use super::ground::Ground;
use super::segments::{Segment, Segments};
use super::{AdhesionFigures, FirstLayer, Foundation};
use crate::polygon::{Contour, DVec2};
use crate::region::{Bead, Path, Width};

/// An outline this much farther from a centre line than half its width still holds, mm.
const TOUCH_MM: f64 = 0.05;

/// Cell of the beads' index, mm.
const CELL_MM: f64 = 1.0;

/// Fills in everything but the counts of teeth.
pub(super) fn measure(first: &FirstLayer, ground: &Ground, foundation: &mut Foundation) {
    let outlines: f64 = ground.part.iter().map(Contour::length).sum();
    let held = match foundation.raft.is_empty() {
        true => foundation.layers.first().map_or(0.0, |beads| attachment(&ground.part, beads)),
        false => outlines,
    };
    let on_bed = foundation.raft.first().map(|l| &l.paths).or(foundation.layers.first());
    let beside = foundation
        .layers
        .iter()
        .enumerate()
        .map(|(k, beads)| volume(beads, if k == 0 { first.height } else { first.next_height }));
    let below = foundation.raft.iter().map(|layer| volume(&layer.paths, layer.height));
    foundation.figures = AdhesionFigures {
        filament_mm3: beside.chain(below).sum(),
        bed_contact_mm2: on_bed.map_or(0.0, |beads| beads.iter().map(|p| p.length() * width(p)).sum()),
        attachment_mm: held,
        attachment_share: if outlines > 0.0 { held / outlines } else { 0.0 },
        teeth: foundation.figures.teeth,
    };
}

/// Length of the outlines within half a line and [`TOUCH_MM`] of a centre line, mm. The beads of a kind
/// all have one width.
fn attachment(part: &[Contour], beads: &[Path]) -> f64 {
    let Some(first) = beads.first() else { return 0.0 };
    let reach = width(first) / 2.0 + TOUCH_MM;
    let segments: Vec<Segment> =
        beads.iter().flat_map(edges).map(|(a, b)| Segment { a, b, owner: 0 }).collect();
    length_within(part, &Segments::new(segments, CELL_MM), reach).iter().sum()
}

fn edges(path: &Path) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let closing = match (path.closed, path.points.first(), path.points.last()) {
        (true, Some(&a), Some(&b)) => Some((b, a)),
        _ => None,
    };
    path.points.windows(2).map(|w| (w[0], w[1])).chain(closing)
}

/// Volume of beads, mm3: cross-section times length.
fn volume(beads: &[Path], height: f64) -> f64 {
    beads.iter().map(|p| p.length() * Bead { width: width(p), height }.area()).sum()
}

/// Width of a bead; adhesion lays uniform ones only.
fn width(path: &Path) -> f64 {
    match &path.width {
        Width::Uniform(w) => *w,
        Width::Varying(widths) => widths.first().copied().unwrap_or(0.0),
    }
}
