//! What holds the part on the bed: skirt, brim, raft, and teeth [Lv 2022].
//!
//! [`lay_foundation`] takes the printed first layer and gives the centre lines of the beads that go
//! around or below it, with the figures of the report and a drawing for the Learn view.
//!
//! [Lv 2022]: N. Lv, Y. Li, Y. Qiao, "Generation Algorithm of a Novel Platform Attached Support
//! Structure for FDM", 2022.

pub mod error;
pub mod options;
pub mod teeth;

pub use error::{AdhesionError, AdhesionWarning, WarningCode};
pub use options::{
    AdhesionKind, AdhesionOptions, BrimOptions, BrimSide, Placement, RaftOptions, SkirtOptions, TeethOptions,
};
pub use teeth::{TeethDrawing, Tooth};

use crate::polygon::PolygonSet;
use crate::polygon::measure::Bounds;
use crate::region::Path;

/// The first layer as it will be printed, in bed coordinates.
#[derive(Debug, Clone, Copy)]
pub struct FirstLayer<'a> {
    /// The part's outline after elephant-foot compensation.
    pub outline: &'a PolygonSet,
    /// Area of the supports that stand on the bed; may be empty.
    pub supports: &'a PolygonSet,
    /// The printable area of the bed.
    pub bed: Bounds,
    /// `first_layer.line_width`, mm: beads of skirt and teeth.
    pub line_width: f64,
    /// `layers.first_height`, mm.
    pub height: f64,
}

/// What is laid around or below the part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Foundation {
    /// Beads beside the part by layer, first layer first, in printing order; printed before the
    /// part's own beads of that layer.
    pub layers: Vec<Vec<Path>>,
    /// Layers below the part, lowest first.
    pub raft: Vec<RaftLayer>,
    /// Distance by which the raft lifts the part: its layers and the air gap, mm.
    pub lift: f64,
    /// The report's figures.
    pub figures: AdhesionFigures,
    /// Rail, teeth and bites to look at; only for teeth.
    pub drawing: Option<TeethDrawing>,
    /// What could not be done as asked.
    pub warnings: Vec<AdhesionWarning>,
}

/// One layer below the part.
#[derive(Debug, Clone, PartialEq)]
pub struct RaftLayer {
    /// Thickness, mm.
    pub height: f64,
    /// Beads in printing order.
    pub paths: Vec<Path>,
}

/// The figures of `adhesion` in the report (time is known after the G-code is planned).
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct AdhesionFigures {
    /// Volume of all beads, mm3.
    pub filament_mm3: f64,
    /// Length times width of the beads that lie on the bed, mm2.
    pub bed_contact_mm2: f64,
    /// Length of the part's outlines that the beads hold, mm; a raft holds all of it.
    pub attachment_mm: f64,
    /// The same as a share of all outlines, 0 to 1.
    pub attachment_share: f64,
    /// Counts and depths of teeth; only for teeth.
    pub teeth: Option<TeethFigures>,
}

/// How many teeth there are and how deep they bite.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct TeethFigures {
    /// Teeth that are printed.
    pub placed: u32,
    /// Teeth that the reachable outline has length for but that would cross something.
    pub left_out: u32,
    /// Placed teeth that bite less, because the part is thinner than twice the bite.
    pub shallow: u32,
    /// Smallest depth of a tip in the part, mm; negative for a tip outside; 0 without teeth.
    pub bite_min_mm: f64,
    /// Largest depth of a tip in the part, mm; 0 without teeth.
    pub bite_max_mm: f64,
}
