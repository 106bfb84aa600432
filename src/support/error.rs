//! Why supports cannot be planned, and what could not be done as asked.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::cover::in_plan;
use super::frame::Frame;
use super::pieces::Tower;
use super::plane::PlaneSection;
use super::plates::Plate;
use super::report::{PlateAxis, Uncovered};
use crate::options::OutOfRange;
use crate::slice::{Axis, Gap};

/// Why supports cannot be planned.
#[derive(Debug, Clone, PartialEq)]
pub enum SupportError {
    /// An option outside its range.
    Options(OutOfRange),
    /// Planes nearer to each other than a plate is thick.
    SpacingUnderThickness {
        /// The setting's path.
        path: &'static str,
        /// The spacing found, mm.
        found: f64,
        /// The smallest one for this line width and thickness, mm.
        least: f64,
    },
    /// The watcher said to stop.
    Cancelled,
}

impl fmt::Display for SupportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SupportError::Options(found) => found.fmt(f),
            SupportError::SpacingUnderThickness { path, found, least } => {
                write!(f, "{path}: {found} is less than a plate is thick, {least} mm")
            }
            SupportError::Cancelled => write!(f, "cancelled"),
        }
    }
}

impl std::error::Error for SupportError {}

impl From<OutOfRange> for SupportError {
    fn from(found: OutOfRange) -> Self {
        SupportError::Options(found)
    }
}

/// A remark on the supports that does not stop the job.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SupportWarning {
    /// Stable name of the kind of remark.
    pub code: String,
    /// The remark in words.
    pub message: String,
    /// The part's layer it belongs to, counted from 0.
    pub layer: Option<u32>,
    /// Place on the bed, mm.
    pub at: Option<[f64; 2]>,
}

impl SupportWarning {
    pub(super) fn uncovered(place: &Uncovered) -> SupportWarning {
        SupportWarning {
            code: "support_uncovered".to_owned(),
            message: format!("{:.2} mm2 hang without support: there is no room for a plate", place.area_mm2),
            layer: Some(place.layer),
            at: Some(place.at),
        }
    }

    pub(super) fn slender(frame: &Frame, plates: &[Plate], tower: &Tower) -> SupportWarning {
        let plate = &plates[tower.plate];
        let top = frame.layers[tower.top].print_z;
        SupportWarning {
            code: "support_slender".to_owned(),
            message: format!("a plate {top:.1} mm tall has no room for one across it and may buckle"),
            layer: Some(tower.top as u32),
            at: Some(in_plan(plate.axis, plate.at, (tower.span[0] + tower.span[1]) / 2.0).to_array()),
        }
    }

    /// One remark for an axis, about the plane with the widest opening.
    pub(super) fn open_planes(
        axis: Axis,
        places: &[f64],
        cuts: &[(PlaneSection, Vec<Gap>)],
    ) -> Option<SupportWarning> {
        let gaps = cuts.iter().zip(places).flat_map(|((_, gaps), &at)| gaps.iter().map(move |g| (g, at)));
        let (gap, at) = gaps.max_by(|a, b| a.0.length.total_cmp(&b.0.length))?;
        let (name, at_mm) = match PlateAxis::of(axis) {
            PlateAxis::X => ("x", [at, gap.at.x]),
            PlateAxis::Y => ("y", [gap.at.x, at]),
        };
        let open = cuts.iter().filter(|(_, gaps)| !gaps.is_empty()).count();
        let message = format!(
            "the mesh is open in {open} plane(s) {name} = const; the widest gap, {:.2} mm in {name} = {at:.2} at z = {:.2}, was closed by a straight line",
            gap.length, gap.at.y
        );
        Some(SupportWarning { code: "support_open_plane".to_owned(), message, layer: None, at: Some(at_mm) })
    }
}
