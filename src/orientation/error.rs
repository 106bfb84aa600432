//! Why no orientation can be proposed.

use std::fmt;

use crate::options::OutOfRange;

/// Why no orientation can be proposed. The message says what to do where something can be done.
#[derive(Debug, Clone, PartialEq)]
pub enum OrientationError {
    /// The mesh has no triangles.
    Empty,
    /// A vertex is not a finite number.
    NotFinite,
    /// A coordinate is beyond what can be worked with.
    TooLarge {
        /// The largest coordinate, mm.
        reach_mm: f64,
        /// The largest one allowed, mm.
        limit_mm: f64,
    },
    /// The part has no thickness.
    Flat,
    /// A layer is thicker than the part in one of the six directions.
    LayerAbovePart {
        /// Layer height, mm.
        layer_height_mm: f64,
        /// The part's smallest extent along an axis, mm.
        height_mm: f64,
    },
    /// So many layers would take too long.
    TooManyLayers {
        /// Layers of the tallest direction.
        layers: f64,
        /// The largest number allowed.
        limit: u32,
    },
    /// No layer of any of the six directions holds any area.
    NothingInside,
    /// One of the six directions is missing, or a figure of it is not a number.
    BadFigures {
        /// The direction.
        id: u32,
    },
    /// An option outside its range.
    Options(OutOfRange),
    /// The watcher said to stop.
    Cancelled,
}

impl fmt::Display for OrientationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OrientationError::Empty => write!(f, "the model has no triangles"),
            OrientationError::NotFinite => write!(f, "a vertex of the model is not a finite number"),
            OrientationError::TooLarge { reach_mm, limit_mm } => {
                write!(f, "the model reaches {reach_mm:.0} mm from the origin; the limit is {limit_mm:.0} mm")
            }
            OrientationError::Flat => write!(f, "the model is flat: it has no thickness to print"),
            OrientationError::LayerAbovePart { layer_height_mm, height_mm } => write!(
                f,
                "layers of {layer_height_mm} mm are thicker than the part, which measures {height_mm} mm on one side"
            ),
            OrientationError::TooManyLayers { layers, limit } => {
                write!(f, "{layers:.0} layers are too many to compare directions; the limit is {limit}")
            }
            OrientationError::NothingInside => {
                write!(f, "the model encloses nothing: no layer of any direction has an area")
            }
            OrientationError::BadFigures { id } => {
                write!(f, "direction {id} is missing or has figures that are no numbers")
            }
            OrientationError::Options(found) => found.fmt(f),
            OrientationError::Cancelled => write!(f, "cancelled"),
        }
    }
}

impl std::error::Error for OrientationError {}

impl From<OutOfRange> for OrientationError {
    fn from(found: OutOfRange) -> Self {
        OrientationError::Options(found)
    }
}
