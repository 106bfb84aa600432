//! Figures of a G-code file of any slicer, and where its layers begin, from chunks of any size: for
//! `foothold inspect` and for the preview. Memory is bounded whatever the bytes are: of the text only
//! the line under way is kept, and of each layer what reading it alone needs.
//!
//! Times are those of our planner with the limits that the file states (M201 to M205), each layer from
//! stop to stop; heating, homing and what macros do are left out.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use serde::Serialize;

use super::read::{LAYER_RISE, ReadMove, Reader};
use super::{
    FILAMENT_STEPS, FilamentOptions, Limits, Move, Place, PrinterOptions, RoleUse, filament_area, move_times,
    type_name,
};
use crate::polygon::dvec2;

/// Longest line, bytes: thumbnails have short ones, and so have settings in Cura's files.
const LONGEST_LINE: usize = 1 << 20;

/// Most layers: ten metres of 0.05 mm.
const MOST_LAYERS: usize = 200_000;

/// Moves that are planned at once; longer layers are cut.
const PLANNED_MOVES: usize = 100_000;

/// Different temperatures that are told at most.
const TOLD_TEMPERATURES: usize = 8;

/// Places farther from the origin than this are no printer's, and would not fit [`Place`], mm.
const FARTHEST: f64 = 1e6;

/// What beads without a known type are called.
const UNNAMED: &str = "unnamed";

/// Why a file is no G-code that can be shown. `Display` gives the text that follows the file's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GcodeFileError {
    /// No bytes at all.
    Empty,
    /// Prusa's binary format.
    Bgcode,
    /// Other bytes than text.
    Binary,
    /// A line that no slicer writes.
    LongLine {
        /// Its number, from 1.
        line: u32,
    },
    /// More layers than any print has.
    TooManyLayers,
    /// A text that lays nothing down.
    NoMoves,
}

impl fmt::Display for GcodeFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GcodeFileError::Empty => write!(f, "empty: the file has no bytes"),
            GcodeFileError::Bgcode => {
                write!(f, "binary G-code (bgcode) is not read; save it as text, without \"Binary G-code\"")
            }
            GcodeFileError::Binary => write!(f, "no text: not a G-code file"),
            GcodeFileError::LongLine { line } => write!(f, "line {line} has over a megabyte: not G-code"),
            GcodeFileError::TooManyLayers => write!(f, "more than {MOST_LAYERS} layers"),
            GcodeFileError::NoMoves => write!(f, "no beads are laid down: not a G-code file for printing"),
        }
    }
}

impl std::error::Error for GcodeFileError {}

/// Filament of a file.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FilamentFigures {
    /// Length, mm.
    pub length_mm: f64,
    /// Volume, mm3.
    pub volume_mm3: f64,
    /// Mass, g.
    pub mass_g: f64,
    /// Price, in the currency of `filament.cost_per_kg`.
    pub cost: f64,
    /// Diameter that the file states, or else that of the settings, mm.
    pub diameter_mm: f64,
}

/// Something worth knowing of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GcodeRemark {
    /// Stable name of the kind of remark.
    pub code: &'static str,
    /// The remark in words.
    pub message: String,
}

/// Figures of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GcodeFigures {
    /// The program that says it wrote the file; empty if none does.
    pub generator: String,
    /// Whose block of settings the file holds; empty without one.
    pub settings: &'static str,
    /// Number of lines.
    pub lines: u32,
    /// Number of layers.
    pub layers: usize,
    /// Height of the first layer and the second, mm.
    pub layer_heights: Vec<f64>,
    /// Smallest and largest corner of the beads' centre lines in the layers, mm.
    pub bounds: [[f64; 3]; 2],
    /// What is used.
    pub filament: FilamentFigures,
    /// Duration of all moves by our planner, s.
    pub time_s: f64,
    /// What the file itself says of its duration; empty if nothing.
    pub stated_time: String,
    /// Length of moves without extrusion, mm.
    pub travel_mm: f64,
    /// Number of retractions.
    pub retractions: u32,
    /// Number of tools.
    pub tools: usize,
    /// Temperatures of the nozzle in the order in which they are asked for, degrees C.
    pub nozzle_temps: Vec<f64>,
    /// The like of the bed.
    pub bed_temps: Vec<f64>,
    /// Beads by role, start code included.
    pub by_role: BTreeMap<&'static str, RoleUse>,
    /// Remarks.
    pub warnings: Vec<GcodeRemark>,
}

/// Where a layer begins, and what must be said before it so that it can be read alone.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerStart {
    /// Byte of the file.
    pub offset: u64,
    /// G-code that brings a reader into the state in which the layer begins.
    pub head: String,
    /// Duration, s.
    pub time_s: f64,
    /// Where its first bead ends, mm.
    z: f64,
    /// Its thickness, mm; 0 while nothing was laid.
    height: f64,
}

/// A file read to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedGcode {
    /// The figures.
    pub figures: GcodeFigures,
    /// Its layers; what stands before the first one belongs to none.
    pub layers: Vec<LayerStart>,
}

/// Reads a file chunk by chunk.
#[derive(Debug)]
pub struct Inspector {
    reader: Reader<'static>,
    /// A line that goes on in the next chunk.
    partial: Vec<u8>,
    /// Bytes before the line under way.
    offset: u64,
    filament: FilamentOptions,
    figures: GcodeFigures,
    layers: Vec<LayerStart>,
    bead_z: f64,
    /// Filament pushed so far, and the most that this has been, mm.
    pushed: [f64; 2],
    pulled_back: bool,
    tools: [bool; 256],
    any_move: bool,
    planner: Planner,
}

impl Inspector {
    /// Begins a file; `filament` is taken where it says nothing of its own.
    pub fn new(filament: FilamentOptions) -> Inspector {
        Inspector {
            reader: Reader::new(b""),
            partial: Vec::new(),
            offset: 0,
            filament,
            figures: no_figures(),
            layers: Vec::new(),
            bead_z: 0.0,
            pushed: [0.0; 2],
            pulled_back: false,
            tools: [false; 256],
            any_move: false,
            planner: Planner::new(),
        }
    }

    /// Takes the next bytes.
    pub fn push(&mut self, chunk: &[u8]) -> Result<(), GcodeFileError> {
        if self.offset == 0 && self.partial.is_empty() && chunk.starts_with(b"GCDE") {
            return Err(GcodeFileError::Bgcode);
        }
        if chunk.contains(&0) {
            return Err(GcodeFileError::Binary);
        }
        let mut rest = chunk;
        while let Some(end) = rest.iter().position(|&b| b == b'\n') {
            let (line, after) = rest.split_at(end + 1);
            if self.partial.is_empty() {
                self.line(line)?;
            } else {
                let mut whole = std::mem::take(&mut self.partial);
                whole.extend_from_slice(line);
                self.line(&whole)?;
                whole.clear();
                self.partial = whole;
            }
            rest = after;
        }
        self.partial.extend_from_slice(rest);
        if self.partial.len() > LONGEST_LINE {
            return Err(GcodeFileError::LongLine { line: self.reader.line + 1 });
        }
        Ok(())
    }

    /// The figures, after the last chunk.
    pub fn finish(mut self) -> Result<InspectedGcode, GcodeFileError> {
        let last = std::mem::take(&mut self.partial);
        if !last.is_empty() {
            self.line(&last)?;
        }
        if self.offset == 0 {
            return Err(GcodeFileError::Empty);
        }
        if !self.any_move || self.layers.is_empty() {
            return Err(GcodeFileError::NoMoves);
        }
        self.plan();
        self.sum_up();
        for layer in &mut self.layers {
            if layer.height > 0.0 {
                // Written to a String, which cannot fail.
                let _ = writeln!(layer.head, ";Z:{:.3}\n;HEIGHT:{:.5}", layer.z, layer.height);
            }
        }
        Ok(InspectedGcode { figures: self.figures, layers: self.layers })
    }

    fn line(&mut self, line: &[u8]) -> Result<(), GcodeFileError> {
        let before = self.reader.labels.layer;
        let trimmed = line.trim_ascii();
        if let Some(comment) = trimmed.strip_prefix(b";")
            && let Ok(comment) = std::str::from_utf8(comment)
        {
            self.comment(comment.trim());
        }
        let head = self.head_if_needed(trimmed);
        self.reader.line = self.reader.line.saturating_add(1);
        self.reader.take_line(trimmed);
        if self.reader.labels.layer != before {
            if before == 0 {
                // Heights taken for layers so far were the start code's.
                self.layers.clear();
                self.figures.bounds = no_bounds();
            }
            self.begin_layer(head)?;
        } else if self.reader.labels.layer == 0 && self.begins_by_height() {
            self.begin_layer(format!("{head};LAYER_CHANGE\n"))?;
        }
        self.heated();
        while let Some(step) = self.reader.waiting.pop_front() {
            self.step(&step);
        }
        self.offset += line.len() as u64;
        Ok(())
    }

    /// The state before a line that may begin a layer: a mark, or a move while there are no marks.
    fn head_if_needed(&self, line: &[u8]) -> String {
        let may_begin = match line.first() {
            Some(b';') => line.windows(5).any(|w| w == b"LAYER"),
            Some(_) => self.reader.labels.layer == 0,
            None => false,
        };
        if may_begin { head_of(&self.reader) } else { String::new() }
    }

    /// Whether the line's moves lay a bead at another height than the last one.
    fn begins_by_height(&self) -> bool {
        let mut beads = self.reader.waiting.iter().filter(|step| step.lays_bead());
        beads.next().is_some_and(|b| self.layers.is_empty() || (b.to[2] - self.bead_z).abs() >= LAYER_RISE)
    }

    fn begin_layer(&mut self, head: String) -> Result<(), GcodeFileError> {
        if self.layers.len() >= MOST_LAYERS {
            return Err(GcodeFileError::TooManyLayers);
        }
        self.plan();
        self.layers.push(LayerStart { offset: self.offset, head, time_s: 0.0, z: 0.0, height: 0.0 });
        Ok(())
    }

    fn comment(&mut self, text: &str) {
        let figures = &mut self.figures;
        if figures.generator.is_empty() {
            figures.generator = generator_of(text).chars().take(80).collect();
        }
        if figures.settings.is_empty() {
            figures.settings = settings_of(text);
        }
        let Some((name, value)) = text.split_once(['=', ':']) else { return };
        let (name, value) = (name.trim(), value.trim());
        let number = || value.split([',', ';']).next().and_then(|v| v.trim().parse::<f64>().ok());
        let positive =
            |known: &mut f64| *known = number().filter(|&v| v > 0.0 && v < 100.0).unwrap_or(*known);
        match name {
            "filament_diameter" | "filament.diameter" => positive(&mut self.filament.diameter),
            "filament_density" | "filament.density" => positive(&mut self.filament.density),
            "estimated printing time (normal mode)" | "total estimated time" => {
                figures.stated_time = value.chars().take(40).collect();
            }
            // Cura counts seconds.
            "TIME" => figures.stated_time = number().map(super::format_duration).unwrap_or_default(),
            _ => {}
        }
    }

    /// Temperatures that the line has asked for.
    fn heated(&mut self) {
        let lists = [&mut self.figures.nozzle_temps, &mut self.figures.bed_temps];
        for (list, asked) in lists.into_iter().zip(self.reader.machine.temperatures) {
            if asked > 0.0 && list.last() != Some(&asked) && list.len() < TOLD_TEMPERATURES {
                list.push(asked);
            }
        }
    }

    fn step(&mut self, step: &ReadMove) {
        self.any_move = true;
        self.tools[usize::from(step.tool)] |= step.filament_mm > 0.0;
        let figures = &mut self.figures;
        let [sum, most] = self.pushed;
        self.pushed = [sum + step.filament_mm, most.max(sum + step.filament_mm)];
        if step.lays_bead() {
            self.pulled_back = false;
            self.bead_z = step.to[2];
            let name = step.role.map_or(UNNAMED, |role| role.name());
            let used = RoleUse { length_mm: step.length(), volume_mm3: step.filament_mm, time_s: 0.0 };
            figures.by_role.entry(name).or_default().add(used);
            if let Some(layer) = self.layers.last_mut() {
                for p in [step.from, step.to] {
                    figures.bounds[0] = std::array::from_fn(|i| figures.bounds[0][i].min(p[i]));
                    figures.bounds[1] = std::array::from_fn(|i| figures.bounds[1][i].max(p[i]));
                }
                if layer.height == 0.0 {
                    (layer.z, layer.height) = (step.to[2], step.height.unwrap_or(0.0));
                }
            }
        } else {
            if step.moves_in_plane() {
                figures.travel_mm += step.length();
            }
            if step.filament_mm < 0.0 && !std::mem::replace(&mut self.pulled_back, true) {
                figures.retractions += 1;
            }
            self.pulled_back &= step.filament_mm <= 0.0;
        }
        self.planner.add(step);
        if self.planner.moves.len() >= PLANNED_MOVES {
            self.plan();
        }
    }

    /// Plans the moves so far, to a stop.
    fn plan(&mut self) {
        let [x, y, z] = self.reader.waiting.front().map_or(self.reader.machine.at, |step| step.from);
        let limits = limits_of(&self.reader);
        let time_s = self.planner.plan(&limits, &mut self.figures.by_role);
        self.planner.start = (Place::of(dvec2(within(x), within(y))), micrometres(z));
        self.figures.time_s += time_s;
        if let Some(layer) = self.layers.last_mut() {
            layer.time_s += time_s;
        }
    }

    fn sum_up(&mut self) {
        let figures = &mut self.figures;
        let area = filament_area(self.filament.diameter);
        for used in figures.by_role.values_mut() {
            // Until here the diameter might have been stated yet.
            used.volume_mm3 *= area;
        }
        let volume_mm3 = self.pushed[1] * area;
        let mass_g = volume_mm3 / 1000.0 * self.filament.density;
        figures.filament = FilamentFigures {
            length_mm: self.pushed[1],
            volume_mm3,
            mass_g,
            cost: mass_g / 1000.0 * self.filament.cost_per_kg,
            diameter_mm: self.filament.diameter,
        };
        figures.lines = self.reader.line;
        figures.layers = self.layers.len();
        figures.layer_heights = self.layers.iter().take(2).map(|l| l.height).collect();
        figures.tools = self.tools.iter().filter(|used| **used).count();
        if figures.bounds[0][0] > figures.bounds[1][0] {
            figures.bounds = [[0.0; 3]; 2];
        }
        figures.warnings = remarks_of(&self.reader);
    }
}

/// Moves that wait to be planned together.
#[derive(Debug)]
struct Planner {
    start: (Place, i32),
    moves: Vec<Move>,
    /// The role of each move that lays a bead.
    names: Vec<Option<&'static str>>,
    acceleration: Option<f64>,
    tool: u8,
}

impl Planner {
    fn new() -> Planner {
        Planner {
            start: (Place::default(), 0),
            moves: Vec::new(),
            names: Vec::new(),
            acceleration: None,
            tool: 0,
        }
    }

    fn push(&mut self, step: Move, name: Option<&'static str>) {
        self.moves.push(step);
        self.names.push(name);
    }

    fn add(&mut self, step: &ReadMove) {
        if step.acceleration != self.acceleration {
            self.acceleration = step.acceleration;
            self.push(Move::Acceleration(step.acceleration.unwrap_or(0.0) as u32), None);
        }
        if step.tool != std::mem::replace(&mut self.tool, step.tool) {
            self.push(Move::Tool { from: 0, to: step.tool, nozzle: 0, standby: 0 }, None);
        }
        // A file that has not said how fast is taken to mean as fast as it can.
        let feed = if step.speed > 0.0 { (step.speed * 60.0).ceil() as u32 } else { u32::MAX };
        let to = Place::of(dvec2(within(step.to[0]), within(step.to[1])));
        let z = micrometres(step.to[2]);
        let filament = (step.filament_mm * FILAMENT_STEPS).round() as i32;
        let rises = step.from[2] != step.to[2];
        if step.lays_bead() {
            let name = Some(step.role.map_or(UNNAMED, |role| role.name()));
            let bead = if rises {
                Move::Climb { to, z, filament, feed }
            } else {
                Move::Extrude { to, filament, feed }
            };
            return self.push(bead, name);
        }
        if rises {
            self.push(Move::Lift { z, feed }, None);
        }
        match (step.moves_in_plane(), filament) {
            (true, 0) => self.push(Move::Travel { to, feed }, None),
            (true, _) => self.push(Move::Wipe { to, filament, feed }, None),
            (false, 0) => {}
            (false, _) => self.push(Move::Filament { filament, feed }, None),
        }
    }

    /// Seconds of the moves that wait, which are done then; those of beads are booked on their roles.
    fn plan(&mut self, limits: &Limits, by_role: &mut BTreeMap<&'static str, RoleUse>) -> f64 {
        let times = move_times(self.start.0, self.start.1, &self.moves, limits);
        for (time, name) in times.iter().zip(&self.names) {
            if let Some(used) = name.and_then(|name| by_role.get_mut(name)) {
                used.time_s += time;
            }
        }
        self.moves.clear();
        self.names.clear();
        // The next moves are planned by themselves and must hear of the acceleration again.
        self.acceleration = None;
        times.iter().sum()
    }
}

/// A coordinate that a [`Place`] can hold, mm.
fn within(x: f64) -> f64 {
    x.clamp(-FARTHEST, FARTHEST)
}

/// Whole micrometres; what is too far saturates.
fn micrometres(mm: f64) -> i32 {
    (mm * 1000.0).round() as i32
}

/// What the machine can do: as the file has stated so far, else as our default printer.
fn limits_of(reader: &Reader<'_>) -> Limits {
    let stated = reader.machine.stated;
    let usual = Limits::of(&PrinterOptions::default());
    let [most, z, e] = stated.max_acceleration;
    let beads = reader.machine.acceleration.or(most).unwrap_or(usual.acceleration);
    let travel = stated.travel_acceleration.or(most).unwrap_or(beads);
    Limits {
        acceleration: beads,
        travel_acceleration: travel,
        own_travel_acceleration: stated.travel_acceleration.is_some(),
        retract_acceleration: stated.retract_acceleration.or(e).unwrap_or(usual.retract_acceleration),
        z_acceleration: z.unwrap_or(usual.z_acceleration),
        max_speed_xy: stated.max_speed[0].unwrap_or(usual.max_speed_xy),
        max_speed_z: stated.max_speed[1].unwrap_or(usual.max_speed_z),
        max_speed_e: stated.max_speed[2].unwrap_or(usual.max_speed_e),
        junction_deviation: stated.junction_deviation.unwrap_or(usual.junction_deviation),
        tool_change_time: usual.tool_change_time,
    }
}

/// G-code that brings a new reader into this one's state.
fn head_of(reader: &Reader<'_>) -> String {
    let (machine, labels) = (&reader.machine, &reader.labels);
    let [x, y, z] = machine.at;
    let mut head = String::from("G21\nG90\n");
    // Written to a String, which cannot fail.
    let _ = writeln!(head, "G1 X{x:.5} Y{y:.5} Z{z:.5} F{:.3}", machine.feed);
    if machine.shift != [0.0; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| machine.at[i] - machine.shift[i]);
        let _ = writeln!(head, "G92 X{x:.5} Y{y:.5} Z{z:.5}");
    }
    let _ = writeln!(head, "{}\nG92 E{:.5}", if machine.relative_e { "M83" } else { "M82" }, machine.e);
    let _ = writeln!(head, "M106 S{}\nT{}", machine.fan, machine.tool);
    if let Some(role) = labels.role {
        let _ = writeln!(head, ";TYPE:{}", type_name(role));
    }
    if let Some(width) = labels.width {
        let _ = writeln!(head, ";WIDTH:{width:.5}");
    }
    if let Some(height) = labels.height {
        let _ = writeln!(head, ";HEIGHT:{height:.5}");
    }
    head.push_str(if machine.inches { "G20\n" } else { "" });
    head.push_str(if machine.relative { "G91\n" } else { "" });
    head
}

/// The program that a comment names as the file's author.
fn generator_of(comment: &str) -> &str {
    let after = ["generated by ", "Generated by ", "Generated with ", "Sliced by "];
    if let Some(rest) = after.iter().find_map(|words| comment.strip_prefix(words)) {
        // PrusaSlicer and its kin go on with the date.
        return rest.split(" on ").next().unwrap_or(rest);
    }
    if comment.starts_with("BambuStudio ") || comment.starts_with("OrcaSlicer ") { comment } else { "" }
}

/// Whose settings a comment begins.
fn settings_of(comment: &str) -> &'static str {
    match comment {
        "prusaslicer_config = begin" => "PrusaSlicer",
        "CONFIG_BLOCK_START" => "OrcaSlicer",
        _ if comment.starts_with("SETTING_3 ") => "Cura",
        _ if comment.starts_with("adhesion.brim.gap = ") => "Foothold",
        _ => "",
    }
}

fn remarks_of(reader: &Reader<'_>) -> Vec<GcodeRemark> {
    let mut remarks = Vec::new();
    if let (count @ 1.., Some(first)) = (reader.malformed, reader.warnings.first()) {
        let message =
            format!("{count} line(s) were not understood and left out, the first is line {}", first.line);
        remarks.push(GcodeRemark { code: "malformed_lines", message });
    }
    if reader.machine.temperatures.iter().any(|&t| t > 0.0) {
        let message = "the file ends without switching its heaters off: it may be cut off".to_owned();
        remarks.push(GcodeRemark { code: "heaters_stay_on", message });
    }
    remarks
}

fn no_bounds() -> [[f64; 3]; 2] {
    [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]
}

fn no_figures() -> GcodeFigures {
    GcodeFigures {
        generator: String::new(),
        settings: "",
        lines: 0,
        layers: 0,
        layer_heights: Vec::new(),
        bounds: no_bounds(),
        filament: FilamentFigures::default(),
        time_s: 0.0,
        stated_time: String::new(),
        travel_mm: 0.0,
        retractions: 0,
        tools: 0,
        nozzle_temps: Vec::new(),
        bed_temps: Vec::new(),
        by_role: BTreeMap::new(),
        warnings: Vec::new(),
    }
}
