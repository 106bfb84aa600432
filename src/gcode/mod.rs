//! Paths to G-code: moves with speed and extrusion first, text last.
//!
//! Two steps, so that any worker can write any layer:
//!
//! 1. [`layer_gcode`] turns the paths of one layer, in printing order, into text and a
//!    [`LayerSummary`]. It knows nothing of other layers. The text starts and ends at a full stop,
//!    on the layer's height, with the filament not retracted and relative extrusion (M83); it sets
//!    feed rate, type and width itself.
//! 2. [`join()`] reads the summaries in order and writes what lies between the layers: start code,
//!    travels, progress, end code, totals. It never sees a layer's text: its result is a list of
//!    [`Piece`]s whose concatenation is the file.
//!
//! Inside a layer positions are whole micrometres, filament is counted in whole 1e-5 mm and feed
//! rates in whole mm/min: exactly what the text says, so that lengths, volumes and times are those
//! of the machine and not of numbers lost in rounding. The formulas and their sources are in
//! `docs/gcode.md`.

mod arcs;
mod cooling;
mod estimate;
mod events;
mod extrude;
mod flavor;
pub mod inspect;
mod join;
mod label;
mod options;
mod plan;
pub mod read;
mod sequence;
mod start;
mod tool;
mod writer;

use std::collections::BTreeMap;

pub use arcs::Curve;
pub use cooling::CoolingOptions;
pub use estimate::{Limits, move_times};
pub use events::{EventKind, LayerEvent, check_output, event_layers};
pub use extrude::filament_area;
pub use flavor::{Flavor, ObjectLabels};
pub use join::{FileNotes, Joined, Piece, Totals, assemble, format_duration, join, prime_line};
pub use label::{LabelledObject, labelled_objects};
pub use options::{
    AccelerationOptions, BedShape, FilamentOptions, GcodeOptions, Origin, OutputOptions, PrinterOptions,
    RetractionOptions, SpeedOptions,
};
pub use plan::plan_layer;
pub use sequence::{PrintOptions, Sequence};
pub use start::{GcodeError, check_templates};
pub use tool::TOOLS;
pub use writer::type_name;

use crate::polygon::{DVec2, dvec2};
use crate::region::{Path, Role};
use crate::toolpath::Way;

/// How the nozzle rises on a layer of a spiral.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spiral {
    /// The first turn, on a flat layer: the bead grows from nothing to the layer's height.
    First,
    /// A turn above another one.
    Next,
}

/// One layer to be written.
#[derive(Debug, Clone, Copy)]
pub struct LayerInput<'a> {
    /// Place in the print, 0 at the bed.
    pub index: u32,
    /// Height of the nozzle while printing: the top of the layer, mm.
    pub print_z: f64,
    /// Thickness of the layer, mm.
    pub height: f64,
    /// Whether the nozzle rises from the layer's bottom to its top along the beads, as a vase's does.
    pub spiral: Option<Spiral>,
    /// Beads in printing order.
    pub paths: &'a [Path],
    /// The way to each path. A path without an entry is reached straight across an outline.
    pub ways: &'a [Way],
    /// Beads by other options than the layer's: from the path at the first place on, by these, and so
    /// on. What holds for the layer as a whole (printer, material, travels, cooling) stays the layer's.
    pub own: &'a [(usize, &'a GcodeOptions)],
}

/// A layer's text and what the rest of the program needs to know about it.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerGcode {
    /// Lines of G-code, each with its line feed; empty for a layer without paths.
    pub text: Vec<u8>,
    /// Figures of the layer; small, and moved between workers apart from the text.
    pub summary: LayerSummary,
}

/// What [`join()`] and the report need of a layer.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct LayerSummary {
    /// Place in the print, 0 at the bed; of models printed one after another each begins anew.
    pub index: u32,
    /// Height of the nozzle while printing, mm.
    pub print_z: f64,
    /// Thickness of the layer, mm.
    pub height: f64,
    /// Height of the nozzle at the start, mm: `print_z`, or the layer's bottom on a spiral.
    pub start_z: f64,
    /// Length of the layer's text in bytes.
    pub text_len: u32,
    /// Where the text takes over and lets go; `None` if there is no text.
    pub stops: Option<Stops>,
    /// Fan that the layer needs at its start and leaves at its end, 0 to 255.
    pub fan: [u8; 2],
    /// Tool that the layer needs at its start and leaves at its end.
    pub tools: [u8; 2],
    /// Duration from stop to stop, s.
    pub time_s: f64,
    /// Filament printed, mm. What a retraction pulls back is pushed again and does not count.
    pub filament_mm: f64,
    /// How much of it by the second tool, mm.
    pub second_filament_mm: f64,
    /// Length of moves without extrusion, mm.
    pub travel_mm: f64,
    /// Number of retractions.
    pub retractions: u32,
    /// Beads by role; roles without beads are left out.
    pub by_role: BTreeMap<Role, RoleUse>,
    /// Places over which the nozzle may be wiped after the last bead, the end of that bead first, mm;
    /// empty without `retraction.wipe`.
    pub wipe: Vec<DVec2>,
    /// Where progress may be reported: byte offsets of line starts, and the seconds since the
    /// layer's start that have passed there; about every [`MARK_EVERY_S`].
    pub marks: Vec<(u32, f64)>,
}

/// Spacing of [`LayerSummary::marks`], s. Hosts show minutes; a sixth of one is fine enough.
pub const MARK_EVERY_S: f64 = 10.0;

/// Where a layer's text starts and ends, mm.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stops {
    /// Start of the first bead.
    pub start: DVec2,
    /// End of the last bead.
    pub end: DVec2,
}

/// What the beads of one role add up to.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RoleUse {
    /// Length of the beads, mm.
    pub length_mm: f64,
    /// Plastic in them, mm3.
    pub volume_mm3: f64,
    /// Time to print them, travels left out, s.
    pub time_s: f64,
}

impl RoleUse {
    /// Adds another sum to this one.
    pub fn add(&mut self, other: RoleUse) {
        self.length_mm += other.length_mm;
        self.volume_mm3 += other.volume_mm3;
        self.time_s += other.time_s;
    }
}

/// A place in the plane, in whole micrometres: what X and Y words with three decimals can say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// Micrometres along x.
    pub x: i32,
    /// Micrometres along y.
    pub y: i32,
}

impl Place {
    /// The place nearest to a point in mm.
    pub fn of(point: DVec2) -> Place {
        // `as` saturates far outside any bed and turns NaN into 0: no panic, no surprise.
        Place { x: (point.x * 1000.0).round() as i32, y: (point.y * 1000.0).round() as i32 }
    }

    /// The place in mm.
    pub fn mm(self) -> DVec2 {
        dvec2(f64::from(self.x), f64::from(self.y)) / 1000.0
    }

    /// The way to another place, mm.
    pub fn way(self, to: Place) -> DVec2 {
        dvec2(f64::from(to.x) - f64::from(self.x), f64::from(to.y) - f64::from(self.y)) * 0.001
    }

    /// Distance in mm.
    pub fn distance(self, other: Place) -> f64 {
        self.way(other).length()
    }
}

/// One step of the machine, in the units of the text.
///
/// Feed rates are mm/min, filament 1e-5 mm, heights and widths micrometres.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Move {
    /// Beads from here on are for this role; takes no time.
    Role(Role),
    /// Beads from here on are this wide; takes no time.
    Width(u32),
    /// Beads from here on are this high; takes no time.
    Height(u32),
    /// Fan speed, 0 to 255; takes no time.
    Fan(u8),
    /// Beads from here on accelerate by so many mm/s2; takes no time.
    Acceleration(u32),
    /// Moves of the labelled object at this place in the list begin or end; takes no time.
    Object {
        /// Place in [`GcodeOptions::objects`].
        place: u32,
        /// Whether its moves begin.
        begins: bool,
    },
    /// A straight bead.
    Extrude {
        /// Where it ends.
        to: Place,
        /// Filament pushed.
        filament: i32,
        /// Feed rate.
        feed: u32,
    },
    /// A straight bead on which the nozzle rises.
    Climb {
        /// Where it ends.
        to: Place,
        /// Height of the nozzle there.
        z: i32,
        /// Filament pushed.
        filament: i32,
        /// Feed rate.
        feed: u32,
    },
    /// A bead along an arc.
    Arc {
        /// The arc, from where the nozzle is.
        curve: Curve,
        /// Filament pushed.
        filament: i32,
        /// Feed rate.
        feed: u32,
    },
    /// A straight move in the plane without extrusion.
    Travel {
        /// Where it ends.
        to: Place,
        /// Feed rate.
        feed: u32,
    },
    /// A straight move over a bead while filament is pulled back.
    Wipe {
        /// Where it ends.
        to: Place,
        /// Filament pulled, negative.
        filament: i32,
        /// Feed rate.
        feed: u32,
    },
    /// Filament pulled back (negative) or pushed at rest.
    Filament {
        /// How far.
        filament: i32,
        /// Feed rate.
        feed: u32,
    },
    /// Another tool takes over, and is waited for until it is hot; temperatures in whole degrees C.
    Tool {
        /// The tool that prints so far.
        from: u8,
        /// The tool that prints from here on.
        to: u8,
        /// Nozzle temperature of the new tool.
        nozzle: u16,
        /// Nozzle temperature of the old tool while it waits; 0 leaves it as hot as it is.
        standby: u16,
    },
    /// The nozzle goes to this height.
    Lift {
        /// The height.
        z: i32,
        /// Feed rate.
        feed: u32,
    },
}

/// Units of [`Move`]'s filament per mm.
pub(crate) const FILAMENT_STEPS: f64 = 1e5;

/// Text and figures of one layer. Depends on nothing but its arguments.
pub fn layer_gcode(layer: &LayerInput<'_>, options: &GcodeOptions) -> LayerGcode {
    let plan = plan_layer(layer, options);
    let mut summary = plan.summary(options);
    let text = writer::write_layer(&plan, options, &mut summary.marks);
    summary.text_len = u32::try_from(text.len()).expect("a layer's text is far below 4 GiB");
    LayerGcode { text, summary }
}
