//! What each kind of base layer would come to on the same part.

use super::report::AdhesionReport;
use super::{Clock, Job, JobError};
use crate::adhesion::{AdhesionKind, AdhesionOptions, Foundation};
use crate::gcode::{LayerInput, layer_gcode};
use crate::polygon::PolygonSet;
use crate::region::Path;

impl Job {
    /// Skirt, brim, raft and teeth beside each other, whatever the settings ask for: material, time,
    /// bed contact and attachment of each, for the part without supports.
    pub fn compare(&self, clock: Clock) -> Result<Vec<AdhesionReport>, JobError> {
        AdhesionKind::ALL.into_iter().map(|kind| self.try_kind(kind, clock)).collect()
    }

    fn try_kind(&self, kind: AdhesionKind, clock: Clock) -> Result<AdhesionReport, JobError> {
        let options = AdhesionOptions { kind, ..self.settings.adhesion.clone() };
        let started = clock();
        let foundation = self.lay_foundation(&options, &PolygonSet::EMPTY)?;
        let report = AdhesionReport::new(kind, &foundation.figures, clock() - started);
        Ok(AdhesionReport { time_s: self.time_of(&foundation), ..report })
    }

    /// Time to print the beads of a foundation by themselves, s, travels left out.
    fn time_of(&self, foundation: &Foundation) -> f64 {
        let layers = &self.settings.layers;
        let beside = (0u32..).zip(&foundation.layers);
        let beside =
            beside.map(|(i, paths)| (i, if i == 0 { layers.first_height } else { layers.height }, paths));
        let below = (0u32..).zip(&foundation.raft).map(|(i, layer)| (i, layer.height, &layer.paths));
        beside.chain(below).map(|(index, height, paths)| self.bead_time(index, height, paths)).sum()
    }

    fn bead_time(&self, index: u32, height: f64, paths: &[Path]) -> f64 {
        let input = LayerInput { index, print_z: height, height, paths, ways: &[] };
        let used = layer_gcode(&input, &self.settings.gcode_options()).summary.by_role;
        used.values().map(|u| u.time_s).sum()
    }
}
