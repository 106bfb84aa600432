//! The figures of supports.

use serde::{Deserialize, Serialize};

use super::options::SupportMethod;
use super::plates::Plate;
use crate::slice::Axis;

/// `support` in the report; the pipeline adds the time that printing takes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SupportReport {
    /// None or plates.
    pub method: SupportMethod,
    /// Geometric union of the plates, without feet and interface, mm3.
    pub volume_mm3: f64,
    /// Everything below the surfaces that are held, mm3.
    pub complete_volume_mm3: f64,
    /// Connected structures.
    pub pieces: usize,
    /// Pieces left out because they are short or stand on nothing.
    pub dropped: usize,
    /// Planes put in for what the regular ones do not reach.
    pub planes_added: usize,
    /// What hangs all the same.
    pub uncovered: Vec<Uncovered>,
    /// Every plane with something to hold.
    pub plates: Vec<PlateReport>,
    /// Plates' ends, below and above, that face the part across the gap, mm2.
    pub contact_mm2: f64,
}

impl SupportReport {
    /// Adds the supports of other models; the method stays.
    pub fn add(&mut self, other: SupportReport) {
        self.volume_mm3 += other.volume_mm3;
        self.complete_volume_mm3 += other.complete_volume_mm3;
        self.pieces += other.pieces;
        self.dropped += other.dropped;
        self.planes_added += other.planes_added;
        self.uncovered.extend(other.uncovered);
        self.plates.extend(other.plates);
        self.contact_mm2 += other.contact_mm2;
    }
}

/// A place that hangs in the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Uncovered {
    /// The part's layer that hangs, counted from 0.
    pub layer: u32,
    /// Place on the bed, mm.
    pub at: [f64; 2],
    /// Its area, mm2.
    pub area_mm2: f64,
}

/// Normal of a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum PlateAxis {
    /// The plane x = const.
    X,
    /// The plane y = const.
    Y,
}

impl From<PlateAxis> for Axis {
    fn from(axis: PlateAxis) -> Axis {
        match axis {
            PlateAxis::X => Axis::X,
            PlateAxis::Y => Axis::Y,
        }
    }
}

impl PlateAxis {
    pub(super) fn of(axis: Axis) -> PlateAxis {
        if axis == Axis::X { PlateAxis::X } else { PlateAxis::Y }
    }
}

/// One plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlateReport {
    /// Normal of the plane.
    pub axis: PlateAxis,
    /// Its place on the bed, mm.
    pub at_mm: f64,
    /// Area of its support region before gaps, cuts and drops, mm2.
    pub area_mm2: f64,
}

/// The entry of a plane that holds something.
pub(super) fn of_plate(plate: &Plate) -> Option<PlateReport> {
    let axis = PlateAxis::of(plate.axis);
    (plate.area_mm2 > 0.0).then_some(PlateReport { axis, at_mm: plate.at, area_mm2: plate.area_mm2 })
}
