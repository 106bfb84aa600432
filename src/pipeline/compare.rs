//! What each kind of base layer would come to on the same part.

use super::report::AdhesionReport;
use super::{Clock, JobError, Print};
use crate::adhesion::{AdhesionKind, AdhesionOptions, Foundation, Recommendation, Warping, recommend};
use crate::gcode::{LayerInput, layer_gcode};
use crate::polygon::PolygonSet;
use crate::region::Path;

/// One kind of base layer on the part, with what it lays.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// Its figures.
    pub report: AdhesionReport,
    /// Its beads.
    pub foundation: Foundation,
    /// The part's first layer on or beside it.
    pub outline: PolygonSet,
}

/// All kinds beside each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternatives {
    /// Nothing, skirt, brim, raft and teeth.
    pub kinds: Vec<Alternative>,
    /// What suits the first layer and the material, and why.
    pub recommendation: Recommendation,
}

impl Print {
    /// Skirt, brim, raft and teeth beside each other, whatever the settings ask for: material, time,
    /// bed contact and attachment of each, for the part without supports.
    pub fn compare(&self, clock: Clock) -> Result<Vec<AdhesionReport>, JobError> {
        let kinds = self.alternatives(clock)?.kinds.into_iter().map(|a| a.report);
        Ok(kinds.filter(|r| r.kind != AdhesionKind::None).collect())
    }

    /// Every kind with its beads, for the part without supports.
    pub fn alternatives(&self, clock: Clock) -> Result<Alternatives, JobError> {
        // Beside the part, and on a raft.
        let outlines = [AdhesionKind::None, AdhesionKind::Raft].map(|kind| self.first_outline(kind));
        let outline_of = |kind| &outlines[usize::from(kind == AdhesionKind::Raft)];
        let kinds = AdhesionKind::ALL.into_iter().map(|kind| self.try_kind(kind, outline_of(kind), clock));
        let kinds = kinds.collect::<Result<_, _>>()?;
        let no_supports = PolygonSet::EMPTY;
        let first = self.first_layer(&outlines[0], &no_supports);
        let warping = Warping::of_material(&self.settings().filament.material);
        Ok(Alternatives { kinds, recommendation: recommend(&first, warping) })
    }

    fn try_kind(
        &self,
        kind: AdhesionKind,
        outline: &PolygonSet,
        clock: Clock,
    ) -> Result<Alternative, JobError> {
        let options = AdhesionOptions { kind, ..self.settings().adhesion.clone() };
        let started = clock();
        let foundation = self.lay_foundation(&options, outline, &PolygonSet::EMPTY)?;
        let report = AdhesionReport::new(kind, &foundation.figures, clock() - started);
        let report = AdhesionReport { time_s: self.time_of(&foundation), ..report };
        Ok(Alternative { report, foundation, outline: outline.clone() })
    }

    /// Time to print the beads of a foundation by themselves, s, travels left out.
    fn time_of(&self, foundation: &Foundation) -> f64 {
        let layers = &self.settings().layers;
        let beside = (0u32..).zip(&foundation.layers);
        let beside =
            beside.map(|(i, paths)| (i, if i == 0 { layers.first_height } else { layers.height }, paths));
        let below = (0u32..).zip(&foundation.raft).map(|(i, layer)| (i, layer.height, &layer.paths));
        beside.chain(below).map(|(index, height, paths)| self.bead_time(index, height, paths)).sum()
    }

    fn bead_time(&self, index: u32, height: f64, paths: &[Path]) -> f64 {
        let input = LayerInput { index, print_z: height, height, spiral: None, paths, ways: &[], own: &[] };
        let mut options = self.settings().gcode_options();
        // The layer's other beads would make it last.
        options.cooling.min_layer_time = 0.0;
        let used = layer_gcode(&input, &options).summary.by_role;
        used.values().map(|u| u.time_s).sum()
    }
}
