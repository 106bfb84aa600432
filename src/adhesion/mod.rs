//! What holds the part on the bed: skirt, brim, raft, and teeth [Lv 2022].
//!
//! [`lay_foundation`] takes the printed first layer and gives the centre lines of the beads that go
//! around or below it, with the figures of the report and a drawing for the Learn view.
//!
//! [Lv 2022]: N. Lv, Y. Li, Y. Qiao, "Generation Algorithm of a Novel Platform Attached Support
//! Structure for FDM", 2022.

mod attachment;
mod brim;
mod clip;
pub mod error;
mod figures;
mod ground;
pub mod options;
mod raft;
pub mod recommend;
mod segments;
mod skirt;
pub mod teeth;

pub use error::{AdhesionError, AdhesionWarning, WarningCode};
pub use options::{
    AdhesionKind, AdhesionOptions, BrimOptions, BrimSide, Placement, RaftOptions, SkirtOptions, TeethOptions,
};
pub use recommend::{Reason, Recommendation, Warping, recommend};
pub use teeth::{TeethDrawing, Tooth};

use ground::Ground;

use crate::options::{Setting, check_range};
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
    /// The box around the bed.
    pub bed: Bounds,
    /// What of it nothing may be printed on: corners beside a round bed, forbidden zones.
    pub closed: &'a PolygonSet,
    /// `first_layer.line_width`, mm: beads of skirt and teeth.
    pub line_width: f64,
    /// `layers.first_height`, mm.
    pub height: f64,
    /// `layers.height`, mm: the second and third layer of teeth.
    pub next_height: f64,
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

/// Lays what `options.kind` asks for around or below the first layer.
///
/// Nothing is laid without an outline. What cannot be laid as asked (a part at the bed's edge, a part
/// smaller than a tooth) is told in [`Foundation::warnings`]; settings that contradict each other
/// are an error.
pub fn lay_foundation(first: &FirstLayer, options: &AdhesionOptions) -> Result<Foundation, AdhesionError> {
    check(first, options)?;
    lay(first, &Ground::of(first), options.kind, options)
}

/// One kind beside the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// What is laid.
    pub kind: AdhesionKind,
    /// What it comes to.
    pub foundation: Foundation,
}

/// Skirt, brim, raft and teeth for the same first layer, in this order, whatever `options.kind` says.
pub fn compare(first: &FirstLayer, options: &AdhesionOptions) -> Result<[Alternative; 4], AdhesionError> {
    check(first, options)?;
    let ground = Ground::of(first);
    let of = |kind| -> Result<Alternative, AdhesionError> {
        Ok(Alternative { kind, foundation: lay(first, &ground, kind, options)? })
    };
    let [skirt, brim, raft, teeth] = AdhesionKind::LAID;
    Ok([of(skirt)?, of(brim)?, of(raft)?, of(teeth)?])
}

/// The ranges of all settings used here. Line width and heights have theirs elsewhere; here they must be
/// such that no path is broken.
fn check(first: &FirstLayer, options: &AdhesionOptions) -> Result<(), AdhesionError> {
    options.check("adhesion")?;
    check_range(&[first.line_width], "first_layer.line_width", "mm", [0.01, 10.0])?;
    check_range(&[first.height], "layers.first_height", "mm", [0.001, 10.0])?;
    check_range(&[first.next_height], "layers.height", "mm", [0.001, 10.0])?;
    Ok(())
}

fn lay(
    first: &FirstLayer,
    ground: &Ground,
    kind: AdhesionKind,
    options: &AdhesionOptions,
) -> Result<Foundation, AdhesionError> {
    let mut foundation = match kind {
        AdhesionKind::None => Foundation::default(),
        AdhesionKind::Skirt => skirt::skirt(first, ground, &options.skirt),
        AdhesionKind::Brim => brim::brim(first, ground, &options.brim),
        AdhesionKind::Raft => raft::raft(first, ground, &options.raft),
        AdhesionKind::Teeth => teeth::teeth(first, ground, &options.teeth)?,
    };
    clip::keep_off(first.closed, first.bed, &mut foundation);
    figures::measure(first, ground, &mut foundation);
    foundation.warnings.extend(off_bed(first, ground));
    Ok(foundation)
}

/// The first layer itself leaves the bed: it cannot be printed there, whatever holds it.
fn off_bed(first: &FirstLayer, ground: &Ground) -> Option<AdhesionWarning> {
    let points = ground.area.contours().iter().flat_map(|c| &c.points);
    let at = points.copied().find(|&p| p.clamp(first.bed.min, first.bed.max) != p)?;
    let message = "printer.bed_size: the first layer leaves the bed".to_owned();
    Some(AdhesionWarning::new(WarningCode::OutlineOffBed, message, Some(at)))
}
