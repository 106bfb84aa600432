//! What can be wrong with the settings, and what could not be laid as asked.

use std::fmt;

use crate::options::OutOfRange;
use crate::polygon::DVec2;

/// Settings with which nothing sensible can be laid.
#[derive(Debug, Clone, PartialEq)]
pub enum AdhesionError {
    /// One value is outside its range.
    OutOfRange(OutOfRange),
    /// Two values contradict each other.
    Contradiction {
        /// Path of the setting to change, such as `adhesion.teeth.base`.
        setting: &'static str,
        /// Its value, mm.
        found: f64,
        /// What it must be, such as `less than adhesion.teeth.pitch`.
        must_be: &'static str,
        /// The value it is compared with, mm.
        limit: f64,
    },
}

impl AdhesionError {
    /// Path of the setting to change.
    pub fn setting(&self) -> &str {
        match self {
            AdhesionError::OutOfRange(found) => &found.path,
            AdhesionError::Contradiction { setting, .. } => setting,
        }
    }
}

impl fmt::Display for AdhesionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AdhesionError::OutOfRange(found) => found.fmt(f),
            AdhesionError::Contradiction { setting, found, must_be, limit } => {
                write!(f, "{setting}: {found} mm must be {must_be} ({limit} mm)")
            }
        }
    }
}

impl std::error::Error for AdhesionError {}

impl From<OutOfRange> for AdhesionError {
    fn from(found: OutOfRange) -> Self {
        AdhesionError::OutOfRange(found)
    }
}

/// What a warning is about; the word goes into the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WarningCode {
    /// The first layer itself leaves the bed.
    OutlineOffBed,
    /// Beads beyond the bed's edge were cut off.
    AdhesionOffBed,
    /// An island got no tooth at all.
    IslandWithoutTeeth,
    /// Some teeth would have crossed something and were left out.
    TeethLeftOut,
    /// Some teeth bite less than asked, because the part is thin there.
    TeethShallow,
    /// The rail's bead touches the part.
    RailTouchesPart,
    /// No place on the bed for the pull tab.
    NoRoomForTab,
    /// No corner is sharp enough for an ear.
    NoEars,
}

impl WarningCode {
    /// The word of the report.
    pub const fn name(self) -> &'static str {
        match self {
            WarningCode::OutlineOffBed => "outline_off_bed",
            WarningCode::AdhesionOffBed => "adhesion_off_bed",
            WarningCode::IslandWithoutTeeth => "island_without_teeth",
            WarningCode::TeethLeftOut => "teeth_left_out",
            WarningCode::TeethShallow => "teeth_shallow",
            WarningCode::RailTouchesPart => "rail_touches_part",
            WarningCode::NoRoomForTab => "no_room_for_tab",
            WarningCode::NoEars => "no_ears",
        }
    }
}

/// Something that was laid otherwise than asked.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct AdhesionWarning {
    /// What it is about.
    pub code: WarningCode,
    /// For a person; starts with the path of the setting to change.
    pub message: String,
    /// Where on the bed, if at one place.
    pub at: Option<DVec2>,
}

impl AdhesionWarning {
    pub(super) fn new(code: WarningCode, message: String, at: Option<DVec2>) -> Self {
        AdhesionWarning { code, message, at }
    }
}
