//! The figures of the report.

use super::attachment::length_within;
use super::ground::Ground;
use super::segments::{Segment, Segments};
use super::{AdhesionFigures, FirstLayer, Foundation, TeethFigures};
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

impl AdhesionFigures {
    /// The figures of several first layers, each with the length of its outlines, mm.
    pub fn sum(of: &[(AdhesionFigures, f64)]) -> AdhesionFigures {
        if let [(figures, _)] = of {
            return *figures;
        }
        let outlines: f64 = of.iter().map(|(_, length)| length).sum();
        let add =
            |value: fn(&AdhesionFigures) -> f64| of.iter().map(|(figures, _)| value(figures)).sum::<f64>();
        let held: f64 = of.iter().map(|(figures, length)| figures.attachment_share * length).sum();
        AdhesionFigures {
            filament_mm3: add(|f| f.filament_mm3),
            bed_contact_mm2: add(|f| f.bed_contact_mm2),
            attachment_mm: add(|f| f.attachment_mm),
            attachment_share: if outlines > 0.0 { held / outlines } else { 0.0 },
            teeth: of.iter().filter_map(|(figures, _)| figures.teeth).reduce(TeethFigures::add),
        }
    }
}

impl TeethFigures {
    /// The counts of both; without placed teeth there is no bite to compare.
    fn add(self, other: TeethFigures) -> TeethFigures {
        let (low, high) = match (self.placed, other.placed) {
            (0, _) => (other.bite_min_mm, other.bite_max_mm),
            (_, 0) => (self.bite_min_mm, self.bite_max_mm),
            _ => (self.bite_min_mm.min(other.bite_min_mm), self.bite_max_mm.max(other.bite_max_mm)),
        };
        TeethFigures {
            placed: self.placed + other.placed,
            left_out: self.left_out + other.left_out,
            shallow: self.shallow + other.shallow,
            bite_min_mm: low,
            bite_max_mm: high,
        }
    }
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
