//! The report: what a person or a shop wants to know of a finished job.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::adhesion::{AdhesionFigures, AdhesionKind};
use crate::gcode::RoleUse;
use crate::orientation::OrientationReport;
use crate::polygon::DVec2;
use crate::region::Role;
use crate::support::{self, SupportMethod, Supports};

/// A remark on the job that does not stop it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Warning {
    /// Stable name of the kind of remark.
    pub code: String,
    /// The remark in words.
    pub message: String,
    /// Layer it belongs to, counted from 0.
    pub layer: Option<u32>,
    /// Place in bed coordinates, mm.
    pub at: Option<[f64; 2]>,
    /// Settings that would mend it, as `path=value` with the value in JSON; empty if there are none.
    pub fix: Vec<String>,
}

impl Warning {
    /// A remark on the whole job.
    pub fn on_job(code: &str, message: String) -> Warning {
        Warning { code: code.to_owned(), message, layer: None, at: None, fix: Vec::new() }
    }

    /// A remark on a place of a layer.
    pub fn on_layer(code: &str, message: String, layer: u32, at: DVec2) -> Warning {
        let at = Some([at.x, at.y]);
        Warning { code: code.to_owned(), message, layer: Some(layer), at, fix: Vec::new() }
    }

    /// Puts the remark so many layers higher up in the file.
    pub(super) fn raise(&mut self, layers: u32) {
        self.layer = self.layer.map(|layer| layer + layers);
    }

    /// The remark with one more setting that would mend it.
    pub(super) fn fixed_by(mut self, path: &str, value: impl std::fmt::Display) -> Warning {
        self.fix.push(format!("{path}={value}"));
        self
    }
}

/// Where the time of the computation went, ms, summed over all engines.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Timing {
    /// Reading, welding and checking the models.
    pub parse: f64,
    /// Cutting the mesh.
    pub slice: f64,
    /// Deciding which area is for what.
    pub regions: f64,
    /// Skirt and its kin.
    pub adhesion: f64,
    /// Supports.
    pub support: f64,
    /// Laying and ordering beads.
    pub toolpath: f64,
    /// Moves and text.
    pub gcode: f64,
    /// From the start of the job to its end on the clock, parsing included.
    pub total: f64,
}

impl Timing {
    /// Adds the stages of another engine; the total stays.
    pub fn add(&mut self, other: &Timing) {
        self.parse += other.parse;
        self.slice += other.slice;
        self.regions += other.regions;
        self.adhesion += other.adhesion;
        self.support += other.support;
        self.toolpath += other.toolpath;
        self.gcode += other.gcode;
    }
}

/// The models of the job.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModelReport {
    /// Triangles of all models after cleaning.
    pub triangles: usize,
    /// Smallest and largest corner in bed coordinates, mm.
    pub bounds: [[f64; 3]; 2],
    /// Sum of the models' volumes, mm3.
    pub volume_mm3: f64,
}

/// Filament used.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FilamentReport {
    /// Length, mm.
    pub length_mm: f64,
    /// Volume, mm3.
    pub volume_mm3: f64,
    /// Mass, g.
    pub mass_g: f64,
    /// Price, in the currency of `filament.cost_per_kg`.
    pub cost: f64,
}

/// What holds the part on the bed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AdhesionReport {
    /// Skirt, brim, raft, teeth or none.
    pub kind: AdhesionKind,
    /// Time to work it out, ms.
    pub slicing_ms: f64,
    /// Time to print it, travels left out, s.
    pub time_s: f64,
    /// Material, bed contact, attachment and teeth.
    #[serde(flatten)]
    pub figures: AdhesionFigures,
}

impl AdhesionReport {
    /// Before the G-code is planned: without the time to print.
    pub fn new(kind: AdhesionKind, figures: &AdhesionFigures, slicing_ms: f64) -> AdhesionReport {
        AdhesionReport { kind, slicing_ms, time_s: 0.0, figures: *figures }
    }

    /// With the time that the adhesion roles take.
    pub fn timed(&self, by_role: &BTreeMap<Role, RoleUse>) -> AdhesionReport {
        let time_s = time_of(&[Role::Skirt, Role::Brim, Role::Teeth, Role::Raft], by_role);
        AdhesionReport { time_s, ..*self }
    }
}

/// What holds overhangs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SupportReport {
    /// Time to print supports, travels left out, s.
    pub time_s: f64,
    /// Volumes, pieces, planes and what stays uncovered.
    #[serde(flatten)]
    pub figures: support::SupportReport,
}

impl SupportReport {
    /// Before the G-code is planned: without the time to print; `None` without supports.
    pub fn of(supports: &[Supports]) -> Option<SupportReport> {
        let of_one = |supports: &Supports| {
            let figures = supports.report().clone();
            (figures.method != SupportMethod::None).then_some(SupportReport { time_s: 0.0, figures })
        };
        supports.iter().map(of_one).fold(None, |sum, more| SupportReport::sum(sum, more, 0))
    }

    /// The figures of two, where `more` has `before` layers of the file before it.
    pub(super) fn sum(
        sum: Option<SupportReport>,
        more: Option<SupportReport>,
        before: u32,
    ) -> Option<SupportReport> {
        let Some(mut more) = more else { return sum };
        more.figures.uncovered.iter_mut().for_each(|place| place.layer += before);
        let Some(mut sum) = sum else { return Some(more) };
        sum.time_s += more.time_s;
        sum.figures.add(more.figures);
        Some(sum)
    }

    /// With the time that the support roles take.
    pub fn timed(&self, by_role: &BTreeMap<Role, RoleUse>) -> SupportReport {
        let time_s = time_of(&[Role::Support, Role::SupportInterface], by_role);
        SupportReport { time_s, ..self.clone() }
    }
}

/// Time to print the beads of these roles, s.
fn time_of(roles: &[Role], by_role: &BTreeMap<Role, RoleUse>) -> f64 {
    roles.iter().filter_map(|r| by_role.get(r)).map(|used| used.time_s).sum()
}

/// Figures of a finished job.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Report {
    /// Name and version of the engine.
    pub engine: String,
    /// What was printed.
    pub model: ModelReport,
    /// The 4x4 matrix, row by row, that moved the first model from its file's coordinates to the
    /// bed's, mm.
    pub placement: [[f64; 4]; 4],
    /// The like for every model, in their order.
    pub placements: Vec<[[f64; 4]; 4]>,
    /// Number of layers.
    pub layers: usize,
    /// Filament of the whole job.
    pub filament: FilamentReport,
    /// Estimated printing time, s.
    pub time_s: f64,
    /// Beads by role.
    pub by_role: BTreeMap<Role, RoleUse>,
    /// What holds the part on the bed.
    pub adhesion: AdhesionReport,
    /// What holds overhangs; only with a `support.method`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support: Option<SupportReport>,
    /// The directions compared and the choice; only with `orientation.mode` auto.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orientation: Option<OrientationReport>,
    /// Where the time of the computation went.
    pub timing_ms: Timing,
    /// Remarks, those on the whole job first, then by layer.
    pub warnings: Vec<Warning>,
}
