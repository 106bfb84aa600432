//! G-code text to moves: for the preview, for measuring what a file really says, and for the tests.
//!
//! Understands G0 to G3 (arcs become chords), G20, G21, G28, G90, G91, G92, M82, M83, temperatures, fan,
//! tools, the limits that M201 and M203 to M205 state, and the comments by which PrusaSlicer, SuperSlicer,
//! OrcaSlicer, Bambu Studio and Cura name layers, types, widths and heights. Where none states a height it
//! is what a layer rises above the one below. Everything else is passed over. A line that cannot be
//! understood is left out and reported; no input makes it panic or return a number that is not finite.
//!
//! E is relative after M83 and also while G91 is in force, as in Marlin 1 and Prusa's firmware.

use super::extrude::filament_area;
use crate::polygon::{DVec2, dvec2, trig};
use crate::region::Role;
use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

/// Numbers beyond this are taken for garbage: no printer is ten kilometres long.
const LARGEST: f64 = 1e7;

/// Distance of an arc from its chords, mm: far below what is visible.
const ARC_TOLERANCE: f64 = 0.005;

/// Most chords of one arc, so that a garbled radius costs no time.
const MOST_CHORDS: f64 = 1000.0;

/// Warnings kept in full; later ones are only counted.
const KEPT_WARNINGS: usize = 100;

/// 10^0 to 10^15, all exact in f64.
const POWERS_OF_TEN: [f64; 16] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// Rise of z, mm, that starts a new layer in a file that does not mark its layers.
pub(super) const LAYER_RISE: f64 = 0.005;

/// A file as layers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadGcode {
    /// What stands before the first layer: start code and prime line.
    pub prelude: ReadLayer,
    /// The layers in order; what follows the last one, the end code, belongs to it.
    pub layers: Vec<ReadLayer>,
    /// Lines that could not be understood, at most the first 100.
    pub warnings: Vec<ReadWarning>,
    /// Number of all such lines.
    pub malformed: u32,
}

/// One layer of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadLayer {
    /// Height of the nozzle, mm: where the first bead ends, or as stated if there is none.
    pub z: f64,
    /// Thickness as stated, or else from the layer below, mm.
    pub height: f64,
    /// Beads.
    pub strands: Vec<Strand>,
    /// Moves in the plane without extrusion: from, to.
    pub travels: Vec<[DVec2; 2]>,
    /// How often filament is pulled back, at rest or on the way.
    pub retractions: u32,
}

/// Beads laid without a break and for one purpose.
#[derive(Debug, Clone, PartialEq)]
pub struct Strand {
    /// What they are for, if the file says so in words known here.
    pub role: Option<Role>,
    /// Points of the centre line; one more than segments.
    pub points: Vec<DVec2>,
    /// One for each pair of points.
    pub segments: Vec<Segment>,
}

/// A straight piece of a strand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Width as stated, or else what volume, length and height give, mm.
    pub width: f64,
    /// Plastic, mm3.
    pub volume_mm3: f64,
    /// Speed asked for, mm/s.
    pub speed: f64,
}

/// A line that could not be understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadWarning {
    /// Number of the line, from 1.
    pub line: u32,
}

impl std::fmt::Display for ReadWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: not understood, left out", self.line)
    }
}

impl Strand {
    /// Plastic of all segments, mm3.
    pub fn volume_mm3(&self) -> f64 {
        self.segments.iter().map(|s| s.volume_mm3).sum()
    }
}

/// Reads a whole file. `filament_diameter` in mm turns filament into volume.
pub fn read(text: &[u8], filament_diameter: f64) -> ReadGcode {
    let marked = collect(text, filament_diameter, false);
    if marked.layers.is_empty() { collect(text, filament_diameter, true) } else { marked }
}

/// Sorts moves into layers, by the file's marks or by the height of beads.
fn collect(text: &[u8], filament_diameter: f64, by_height: bool) -> ReadGcode {
    let mut reader = Reader::new(text);
    let mut builder = Builder { area: filament_area(filament_diameter), ..Builder::default() };
    for step in &mut reader {
        let new_height = step.lays_bead() && (step.to[2] - builder.bead_z).abs() >= LAYER_RISE;
        if by_height && (new_height || (step.lays_bead() && builder.layers.is_empty())) {
            builder.begin_layer();
        }
        while !by_height && builder.layers.len() < step.layer as usize {
            builder.begin_layer();
        }
        builder.add(&step);
    }
    while !by_height && builder.layers.len() < reader.labels.layer as usize {
        builder.begin_layer();
    }
    builder.finish(reader)
}

#[derive(Default)]
struct Builder {
    area: f64,
    prelude: ReadLayer,
    layers: Vec<ReadLayer>,
    /// Whether the last move laid a bead, so that the next one may go on with its strand.
    laying: bool,
    /// Whether the filament has been pulled back since it was last pushed.
    pulled_back: bool,
    bead_z: f64,
}

impl Builder {
    fn begin_layer(&mut self) {
        self.layers.push(ReadLayer::default());
        self.laying = false;
    }

    fn layer(&mut self) -> &mut ReadLayer {
        self.layers.last_mut().unwrap_or(&mut self.prelude)
    }

    fn add(&mut self, step: &ReadMove) {
        let [from, to] = [step.from, step.to].map(|p| dvec2(p[0], p[1]));
        if step.lays_bead() {
            self.pulled_back = false;
            self.bead(step, from, to);
            return;
        }
        if step.moves_in_plane() {
            self.layer().travels.push([from, to]);
        }
        if step.filament_mm < 0.0 && !std::mem::replace(&mut self.pulled_back, true) {
            self.layer().retractions += 1;
        }
        self.pulled_back &= step.filament_mm <= 0.0;
        self.laying &= step.filament_mm == 0.0 && !step.moves_in_plane();
    }

    fn bead(&mut self, step: &ReadMove, from: DVec2, to: DVec2) {
        let volume_mm3 = step.filament_mm * self.area;
        let goes_on = self.laying;
        self.laying = true;
        self.bead_z = step.to[2];
        let layer = self.layer();
        if layer.strands.is_empty() {
            layer.z = step.to[2];
            layer.height = step.height.unwrap_or(0.0);
        }
        let height = step.height.unwrap_or(layer.height);
        let width = step.width.unwrap_or_else(|| width_of(volume_mm3, step.length(), height));
        let segment = Segment { width, volume_mm3, speed: step.speed };
        match layer.strands.last_mut() {
            Some(strand) if goes_on && strand.role == step.role => {
                strand.points.push(to);
                strand.segments.push(segment);
            }
            _ => layer.strands.push(Strand {
                role: step.role,
                points: vec![from, to],
                segments: vec![segment],
            }),
        }
    }

    fn finish(mut self, reader: Reader<'_>) -> ReadGcode {
        let mut below = 0.0;
        for layer in &mut self.layers {
            if layer.height == 0.0 && !layer.strands.is_empty() {
                // Below the layer before it the next model begins.
                layer.height = if layer.z < below { layer.z } else { layer.z - below };
            }
            below = layer.z;
        }
        ReadGcode {
            prelude: self.prelude,
            layers: self.layers,
            warnings: reader.warnings,
            malformed: reader.malformed,
        }
    }
}

/// Width of the bead of this volume, mm; 0 if there is no height to compute it from.
pub fn width_of(volume: f64, length: f64, height: f64) -> f64 {
    if height <= 0.0 || length <= 0.0 {
        return 0.0;
    }
    let area = volume / length;
    let circle = PI * height * height / 4.0;
    if area >= circle { (area - circle) / height + height } else { 4.0 * area / (PI * height) }
}

/// One move of a file: a straight line in space, or filament moved at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadMove {
    /// Number of its line, from 1.
    pub line: u32,
    /// Number of layer marks before it.
    pub layer: u32,
    /// Where it starts: x, y, z in mm.
    pub from: [f64; 3],
    /// Where it ends.
    pub to: [f64; 3],
    /// Filament pushed (positive) or pulled, mm.
    pub filament_mm: f64,
    /// Speed asked for, mm/s; 0 if the file has not said yet.
    pub speed: f64,
    /// Acceleration of beads set last (M204, or Klipper's SET_VELOCITY_LIMIT), mm/s2.
    pub acceleration: Option<f64>,
    /// Type stated last.
    pub role: Option<Role>,
    /// Width stated last, mm.
    pub width: Option<f64>,
    /// Height stated last, or what the layer of a bead rises above the one below, mm.
    pub height: Option<f64>,
    /// Duty of the part's fan, 0 to 255.
    pub fan: u8,
    /// Tool chosen last.
    pub tool: u8,
}

impl ReadMove {
    /// Length of the way, mm.
    pub fn length(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|i| self.to[i] - self.from[i]);
        (x * x + y * y + z * z).sqrt()
    }

    /// Whether x or y changes.
    pub fn moves_in_plane(&self) -> bool {
        self.from[..2] != self.to[..2]
    }

    /// Whether plastic is laid down on the way.
    pub fn lays_bead(&self) -> bool {
        self.filament_mm > 0.0 && self.moves_in_plane()
    }
}

/// Walks through a text move by move.
#[derive(Debug)]
pub struct Reader<'a> {
    rest: &'a [u8],
    pub(super) line: u32,
    pub(super) machine: Machine,
    pub(super) labels: Labels,
    levels: Levels,
    /// Moves of the last line not handed out yet: the chords of an arc.
    pub(super) waiting: VecDeque<ReadMove>,
    /// Lines that could not be understood, the first ones.
    pub warnings: Vec<ReadWarning>,
    /// Number of all such lines.
    pub malformed: u32,
}

/// State of the machine that the text drives.
#[derive(Debug, Default)]
pub(super) struct Machine {
    /// Where the nozzle is, mm.
    pub(super) at: [f64; 3],
    /// What G92 adds to the text's coordinates to get there.
    pub(super) shift: [f64; 3],
    /// The text's E.
    pub(super) e: f64,
    /// Feed rate, mm/min.
    pub(super) feed: f64,
    pub(super) acceleration: Option<f64>,
    pub(super) relative: bool,
    pub(super) relative_e: bool,
    pub(super) inches: bool,
    pub(super) fan: u8,
    pub(super) tool: u8,
    /// Temperatures asked for last: nozzle, bed.
    pub(super) temperatures: [f64; 2],
    pub(super) stated: StatedLimits,
}

/// What a file says of its machine, mm, mm/s and mm/s2: M201 and M203 to M205, or Klipper's
/// SET_VELOCITY_LIMIT. The lists are for x and y (the lower one), z, and the filament.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StatedLimits {
    /// Highest accelerations.
    pub max_acceleration: [Option<f64>; 3],
    /// Highest speeds.
    pub max_speed: [Option<f64>; 3],
    /// Acceleration of travels.
    pub travel_acceleration: Option<f64>,
    /// Acceleration of retractions.
    pub retract_acceleration: Option<f64>,
    /// Junction deviation.
    pub junction_deviation: Option<f64>,
}

/// What comments said last.
#[derive(Debug, Default)]
pub(super) struct Labels {
    pub(super) layer: u32,
    /// The comment that marks layers: a file may hold another slicer's as well, and the first one counts.
    mark: Option<&'static str>,
    pub(super) role: Option<Role>,
    pub(super) width: Option<f64>,
    pub(super) height: Option<f64>,
}

/// Heights of layers that the file does not state.
#[derive(Debug, Default)]
struct Levels {
    /// Where the last bead ended.
    z: f64,
    /// Top of the layer below.
    below: f64,
    layer: u32,
}

impl Levels {
    /// What the layer of a bead that ends at `z` rises above the one below.
    fn height(&mut self, z: f64, layer: u32) -> f64 {
        let is_new = if layer > 0 { layer != self.layer } else { (z - self.z).abs() >= LAYER_RISE };
        if is_new {
            // A prime line before the first mark is no layer; neither is what stands higher.
            let is_first = layer > 0 && self.layer == 0;
            self.below = if is_first || z < self.z { 0.0 } else { self.z };
            self.layer = layer;
        }
        self.z = z;
        (z - self.below).max(0.0)
    }
}

impl<'a> Reader<'a> {
    /// A reader with the nozzle at the origin.
    pub fn new(text: &'a [u8]) -> Self {
        Reader::from_place(text, [0.0; 3])
    }

    /// A reader with the nozzle somewhere, mm.
    pub fn from_place(text: &'a [u8], at: [f64; 3]) -> Self {
        Reader {
            rest: text,
            line: 0,
            machine: Machine { at, ..Machine::default() },
            labels: Labels::default(),
            levels: Levels::default(),
            waiting: VecDeque::new(),
            warnings: Vec::new(),
            malformed: 0,
        }
    }

    /// Where the nozzle is now, mm.
    pub fn place(&self) -> [f64; 3] {
        self.machine.at
    }

    /// The next line without its line feed.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = &self.rest[(end + 1).min(self.rest.len())..];
        self.line = self.line.saturating_add(1);
        Some(line.trim_ascii())
    }

    /// Obeys a line; its moves wait to be handed out.
    pub(super) fn take_line(&mut self, line: &[u8]) {
        if let Some(comment) = line.strip_prefix(b";") {
            self.labels.take_comment(comment);
        } else if self.take_command(line).is_none() {
            self.malformed = self.malformed.saturating_add(1);
            if self.warnings.len() < KEPT_WARNINGS {
                self.warnings.push(ReadWarning { line: self.line });
            }
        }
    }

    /// Obeys a line that is not a comment; `None` if it is malformed.
    fn take_command(&mut self, line: &[u8]) -> Option<()> {
        let code = line.split(|&b| b == b';' || b == b'*').next().unwrap_or_default().trim_ascii();
        let code = skip_line_number(code);
        let Some((letter, rest)) = code.split_first() else { return Some(()) };
        match letter.to_ascii_uppercase() {
            b'G' => self.take_g(rest),
            b'M' => {
                self.machine.take_m(rest);
                Some(())
            }
            b'S' | b'P' | b'E' => {
                self.machine.take_macro(code);
                Some(())
            }
            b'T' => {
                self.machine.take_tool(rest);
                Some(())
            }
            // Other macros.
            b'A'..=b'Z' | b'_' | b'(' | b'%' | b'/' | b'@' => Some(()),
            _ => None,
        }
    }

    fn take_g(&mut self, rest: &[u8]) -> Option<()> {
        let (number, rest) = command_number(rest)?;
        match number {
            0 | 1 => {
                let words = Words::parse(rest)?;
                let (to, filament_mm) = self.machine.target(&words);
                self.line_to(to, filament_mm);
            }
            2 | 3 => {
                let words = Words::parse(rest)?;
                self.arc(&words, number == 2)?;
            }
            20 => self.machine.inches = true,
            21 => self.machine.inches = false,
            28 => self.machine.home(rest),
            90 => self.machine.relative = false,
            91 => self.machine.relative = true,
            92 => self.machine.rename(&Words::parse(rest)?),
            _ => {}
        }
        Some(())
    }

    fn line_to(&mut self, to: [f64; 3], filament_mm: f64) {
        let from = std::mem::replace(&mut self.machine.at, to);
        if from == to && filament_mm == 0.0 {
            return;
        }
        let lays_bead = filament_mm > 0.0 && from[..2] != to[..2];
        let layer = self.labels.layer;
        let height = match self.labels.height {
            None if lays_bead => Some(self.levels.height(to[2], layer)),
            stated => stated,
        };
        self.waiting.push_back(ReadMove {
            line: self.line,
            layer,
            from,
            to,
            filament_mm,
            speed: self.machine.feed / 60.0,
            acceleration: self.machine.acceleration,
            role: self.labels.role,
            width: self.labels.width,
            height,
            fan: self.machine.fan,
            tool: self.machine.tool,
        });
    }

    /// An arc in the plane as chords; z and filament run evenly along it.
    fn arc(&mut self, words: &Words, clockwise: bool) -> Option<()> {
        let from = self.machine.at;
        let (to, filament) = self.machine.target(words);
        let center = arc_center(from, to, words, self.machine.scale(), clockwise)?;
        let spoke = dvec2(from[0], from[1]) - center;
        let end_spoke = dvec2(to[0], to[1]) - center;
        let sweep = arc_sweep(spoke, end_spoke, clockwise);
        let chords = chord_count(spoke.length(), sweep.abs());
        for k in 1..chords as u32 {
            let share = f64::from(k) / chords;
            let (sin, cos) = trig::sin_cos(sweep * share);
            let point = center + dvec2(cos, sin).rotate(spoke);
            let z = from[2] + (to[2] - from[2]) * share;
            self.line_to([point.x, point.y, z], filament / chords);
        }
        self.line_to(to, filament / chords);
        Some(())
    }
}

impl Iterator for Reader<'_> {
    type Item = ReadMove;

    fn next(&mut self) -> Option<ReadMove> {
        loop {
            if let Some(step) = self.waiting.pop_front() {
                return Some(step);
            }
            let line = self.next_line()?;
            self.take_line(line);
        }
    }
}

impl Machine {
    fn scale(&self) -> f64 {
        if self.inches { 25.4 } else { 1.0 }
    }

    /// Where the words lead, and the filament moved on the way; takes over F and E.
    fn target(&mut self, words: &Words) -> ([f64; 3], f64) {
        let scale = self.scale();
        if let Some(feed) = words.f {
            self.feed = (feed * scale).max(0.0);
        }
        let mut to = self.at;
        for (i, to) in to.iter_mut().enumerate() {
            if let Some(value) = words.xyz[i] {
                *to = value * scale + if self.relative { *to } else { self.shift[i] };
            }
        }
        (to, self.filament(words.e.map(|e| e * scale)))
    }

    fn filament(&mut self, e: Option<f64>) -> f64 {
        let Some(e) = e else { return 0.0 };
        if self.relative_e || self.relative {
            self.e += e;
            return e;
        }
        e - std::mem::replace(&mut self.e, e)
    }

    /// G28: the named axes, or all, are at 0.
    fn home(&mut self, rest: &[u8]) {
        let named = [b'X', b'Y', b'Z'].map(|axis| rest.iter().any(|b| b.to_ascii_uppercase() == axis));
        let all = named == [false; 3];
        for (axis, &is_named) in named.iter().enumerate() {
            if all || is_named {
                self.at[axis] = 0.0;
                self.shift[axis] = 0.0;
            }
        }
    }

    /// G92: the present place gets other coordinates.
    fn rename(&mut self, words: &Words) {
        let scale = self.scale();
        for i in 0..3 {
            if let Some(value) = words.xyz[i] {
                self.shift[i] = self.at[i] - value * scale;
            }
        }
        if let Some(e) = words.e {
            self.e = e * scale;
        }
    }

    fn take_m(&mut self, rest: &[u8]) {
        match command_number(rest) {
            Some((82, _)) => self.relative_e = false,
            Some((83, _)) => self.relative_e = true,
            Some((201, rest)) => state_axes(&mut self.stated.max_acceleration, rest),
            Some((203, rest)) => state_axes(&mut self.stated.max_speed, rest),
            Some((204, rest)) => {
                // P is for beads; S, in older firmwares, for all moves.
                let value = [b'P', b'S'].iter().find_map(|&letter| word_of(rest, letter));
                state(&mut self.acceleration, value);
                state(&mut self.stated.travel_acceleration, word_of(rest, b'T'));
                state(&mut self.stated.retract_acceleration, word_of(rest, b'R'));
            }
            Some((205, rest)) => state(&mut self.stated.junction_deviation, word_of(rest, b'J')),
            Some((104 | 109, rest)) => self.heat(0, rest),
            Some((140 | 190, rest)) => self.heat(1, rest),
            Some((106, rest)) => {
                let duty = word_of(rest, b'S').unwrap_or(255.0);
                self.fan = duty.clamp(0.0, 255.0) as u8;
            }
            Some((107, _)) => self.fan = 0,
            _ => {}
        }
    }

    /// Sets a heater; R waits for cooling as well.
    fn heat(&mut self, heater: usize, rest: &[u8]) {
        let value = [b'S', b'R'].iter().find_map(|&letter| word_of(rest, letter));
        self.temperatures[heater] = value.unwrap_or(self.temperatures[heater]);
    }

    /// Klipper's SET_VELOCITY_LIMIT VELOCITY=value ACCEL=value, and the macros that by custom end a print.
    fn take_macro(&mut self, code: &[u8]) {
        let code = code.to_ascii_uppercase();
        let mut words = code.split(u8::is_ascii_whitespace);
        match words.next() {
            Some(b"SET_VELOCITY_LIMIT") => {}
            Some(b"PRINT_END" | b"END_PRINT") => {
                self.temperatures = [0.0; 2];
                return;
            }
            _ => return,
        }
        for word in words {
            let value = |name: &[u8]| word.strip_prefix(name).and_then(number).map(|(value, _)| value);
            state(&mut self.acceleration, value(b"ACCEL="));
            state(&mut self.stated.max_speed[0], value(b"VELOCITY="));
        }
    }

    /// A tool change; anything else that begins with T is passed over.
    fn take_tool(&mut self, rest: &[u8]) {
        if let Some(tool) = std::str::from_utf8(rest).ok().and_then(|it| it.trim().parse().ok()) {
            self.tool = tool;
        }
    }
}

/// Takes over a positive value.
fn state(known: &mut Option<f64>, value: Option<f64>) {
    *known = value.filter(|&v| v > 0.0).or(*known);
}

/// Takes over the words X and Y, Z, and E of a limit.
fn state_axes([xy, z, e]: &mut [Option<f64>; 3], rest: &[u8]) {
    let lower = [b'X', b'Y'].iter().filter_map(|&letter| word_of(rest, letter)).reduce(f64::min);
    state(xy, lower);
    state(z, word_of(rest, b'Z'));
    state(e, word_of(rest, b'E'));
}

impl Labels {
    fn take_comment(&mut self, comment: &[u8]) {
        // Only printable words matter here; a comment in another encoding is none of them.
        let Ok(text) = std::str::from_utf8(comment) else { return };
        let text = text.trim();
        let changes = ["LAYER_CHANGE", "CHANGE_LAYER"].into_iter().find(|mark| text == *mark);
        if let Some(mark) = changes.or(text.starts_with("LAYER:").then_some("LAYER:")) {
            let counts = *self.mark.get_or_insert(mark) == mark;
            self.layer = self.layer.saturating_add(u32::from(counts));
            return;
        }
        let Some((name, value)) = text.split_once(':') else { return };
        let value = value.trim();
        match name {
            "TYPE" | "FEATURE" => self.role = role_named(value),
            "WIDTH" | "LINE_WIDTH" => self.width = length(value),
            "HEIGHT" | "LAYER_HEIGHT" => self.height = length(value),
            _ => {}
        }
    }
}

/// A positive length in mm at the start of a comment's value.
fn length(value: &str) -> Option<f64> {
    number(value.as_bytes()).map(|(value, _)| value).filter(|&v| v > 0.0)
}

/// The role behind a type name of PrusaSlicer, OrcaSlicer or Cura. Several roles share a name; then
/// it is the commonest.
fn role_named(name: &str) -> Option<Role> {
    Some(match name {
        "External perimeter" | "Outer wall" | "WALL-OUTER" => Role::OuterWall,
        "Perimeter" | "Inner wall" | "WALL-INNER" => Role::InnerWall,
        "Overhang perimeter" | "Overhang wall" => Role::OverhangWall,
        "Gap fill" | "Gap infill" => Role::GapFill,
        "Bottom surface" => Role::BottomSkin,
        "Top solid infill" | "Top surface" => Role::TopSkin,
        "Solid infill" | "Internal solid infill" | "SKIN" => Role::SolidInfill,
        "Internal infill" | "Sparse infill" | "FILL" => Role::Infill,
        "Bridge infill" | "Bridge" | "Internal Bridge" | "Internal bridge infill" => Role::Bridge,
        "Ironing" => Role::Ironing,
        "Skirt/Brim" | "Skirt" | "SKIRT" => Role::Skirt,
        "Brim" => Role::Brim,
        "Support material" | "Support" | "SUPPORT" => Role::Support,
        "Support material interface" | "Support interface" | "Support transition" | "SUPPORT-INTERFACE" => {
            Role::SupportInterface
        }
        "Custom" => Role::Prime,
        "Wipe tower" | "Prime tower" | "PRIME-TOWER" => Role::WipeTower,
        _ => return None,
    })
}

/// The words of a move.
#[derive(Debug, Default)]
struct Words {
    xyz: [Option<f64>; 3],
    e: Option<f64>,
    f: Option<f64>,
    ij: [Option<f64>; 2],
    r: Option<f64>,
}

impl Words {
    fn parse(mut rest: &[u8]) -> Option<Words> {
        let mut words = Words::default();
        loop {
            rest = rest.trim_ascii_start();
            let Some((letter, after)) = rest.split_first() else { return Some(words) };
            let after = after.trim_ascii_start();
            let (value, used) = number(after)?;
            match letter.to_ascii_uppercase() {
                b'X' => words.xyz[0] = Some(value),
                b'Y' => words.xyz[1] = Some(value),
                b'Z' => words.xyz[2] = Some(value),
                b'E' => words.e = Some(value),
                b'F' => words.f = Some(value),
                b'I' => words.ij[0] = Some(value),
                b'J' => words.ij[1] = Some(value),
                b'R' => words.r = Some(value),
                b'A'..=b'Z' => {}
                _ => return None,
            }
            rest = &after[used..];
        }
    }
}

/// The value of the word with this letter, among words with spaces between them.
fn word_of(rest: &[u8], letter: u8) -> Option<f64> {
    let mut words = rest.split(u8::is_ascii_whitespace);
    words
        .find_map(|w| {
            w.split_first().filter(|(l, _)| l.eq_ignore_ascii_case(&letter)).and_then(|(_, v)| number(v))
        })
        .map(|(value, _)| value)
}

/// Drops a leading line number, as in `N12 G1 X3`.
fn skip_line_number(code: &[u8]) -> &[u8] {
    match code.split_first() {
        Some((b'N' | b'n', rest)) if rest.first().is_some_and(u8::is_ascii_digit) => {
            let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
            rest[digits..].trim_ascii_start()
        }
        _ => code,
    }
}

/// The whole number of a command and what follows it. Sub-commands such as G92.1 are none of ours.
fn command_number(rest: &[u8]) -> Option<(u32, &[u8])> {
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    if digits == 0 || digits > 6 {
        return None;
    }
    let number = rest[..digits].iter().fold(0, |n, b| n * 10 + u32::from(b - b'0'));
    let sub_command = rest.get(digits) == Some(&b'.');
    Some((if sub_command { u32::MAX } else { number }, &rest[digits..]))
}

/// A decimal number at the start of `text` and the bytes it takes. No exponents: E is a word.
fn number(text: &[u8]) -> Option<(f64, usize)> {
    let signed = matches!(text.first(), Some(b'+' | b'-'));
    let (mut mantissa, mut digits, mut decimals) = (0_u64, 0_u32, 0_u32);
    let mut point = false;
    let mut used = usize::from(signed);
    for &byte in &text[used..] {
        match byte {
            b'0'..=b'9' => {
                // Wraps only where the text has so many digits that the mantissa is not used.
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                digits += 1;
                decimals += u32::from(point);
            }
            b'.' if !point => point = true,
            _ => break,
        }
        used += 1;
    }
    if digits == 0 {
        return None;
    }
    // Up to 15 digits mantissa and power of ten are exact and their quotient rightly rounded.
    let size = if digits <= 15 {
        mantissa as f64 / POWERS_OF_TEN[decimals as usize]
    } else {
        std::str::from_utf8(&text[usize::from(signed)..used]).ok()?.parse().ok()?
    };
    let value = if text[0] == b'-' { -size } else { size };
    (size <= LARGEST).then_some((value, used))
}

/// Centre of an arc from I and J, or from R (Marlin, marlinfw.org/docs/gcode/G002-G003.html).
fn arc_center(from: [f64; 3], to: [f64; 3], words: &Words, scale: f64, clockwise: bool) -> Option<DVec2> {
    let start = dvec2(from[0], from[1]);
    if let Some(radius) = words.r {
        let chord = dvec2(to[0], to[1]) - start;
        let half = chord.length() / 2.0;
        if half == 0.0 {
            return None;
        }
        let rise = (radius * radius * scale * scale - half * half).max(0.0).sqrt();
        // A positive radius is the shorter arc: its centre is right of the chord when clockwise.
        let side = if clockwise == (radius > 0.0) { -1.0 } else { 1.0 };
        return Some(start + chord / 2.0 + chord.perp() / (2.0 * half) * (rise * side));
    }
    if words.ij == [None; 2] {
        return None;
    }
    Some(start + dvec2(words.ij[0].unwrap_or(0.0), words.ij[1].unwrap_or(0.0)) * scale)
}

/// Signed angle from one spoke to the other; a full turn if they are the same.
fn arc_sweep(from: DVec2, to: DVec2, clockwise: bool) -> f64 {
    let angle = trig::atan2(from.perp_dot(to), from.dot(to));
    match clockwise {
        true if angle >= 0.0 => angle - TAU,
        false if angle <= 0.0 => angle + TAU,
        _ => angle,
    }
}

/// Number of chords that stay within the tolerance: each spans 2 acos(1 - tolerance / radius).
fn chord_count(radius: f64, sweep: f64) -> f64 {
    let step = 2.0 * trig::acos((1.0 - ARC_TOLERANCE / radius).max(0.0));
    // A radius of 0 gives a step of pi; a huge one a step of 0 and an infinite count.
    let count = (sweep / step).ceil();
    if count.is_nan() { 1.0 } else { count.clamp(1.0, MOST_CHORDS) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moves(text: &str) -> Vec<ReadMove> {
        Reader::new(text.as_bytes()).collect()
    }

    fn filament(text: &str) -> Vec<f64> {
        moves(text).iter().map(|m| m.filament_mm).collect()
    }

    #[test]
    fn extrusion_is_absolute_until_m83_or_g91() {
        assert_eq!(filament("G1 X1 E2\nG1 X2 E3\nG92 E0\nG1 X3 E0.5"), [2.0, 1.0, 0.5]);
        assert_eq!(filament("M83\nG90\nG1 X1 E2\nG1 X2 E3"), [2.0, 3.0]);
        assert_eq!(filament("G92 E5\nG91\nG1 E-1\nG90\nG1 E5"), [-1.0, 1.0]);
    }

    #[test]
    fn positions_follow_g91_g92_g20_and_g28() {
        let ends = |text: &str| moves(text).iter().map(|m| m.to).collect::<Vec<_>>();
        assert_eq!(ends("G1 X1 Y2\nG91\nG1 X1 Z3"), [[1.0, 2.0, 0.0], [2.0, 2.0, 3.0]]);
        // After G92 X0 at x = 5, X1 is at 6.
        assert_eq!(
            ends("G1 X5\nG92 X0\nG1 X1\nG28 X\nG1 X1"),
            [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
        );
        assert_eq!(ends("G20\nG1 X1"), [[25.4, 0.0, 0.0]]);
    }

    #[test]
    fn spellings_of_a_move() {
        let usual = moves("G1 X1.5 Y-.25 F600");
        for other in ["g1x1.5y-0.25f600", "N7 G01 X1.50 Y-0.2500 F600*33", "  G1 X 1.5 Y -.25 F600 ; words\r"]
        {
            assert_eq!(moves(other), usual, "{other}");
        }
        assert_eq!((usual[0].to, usual[0].speed), ([1.5, -0.25, 0.0], 10.0));
    }

    #[test]
    fn malformed_lines_are_left_out_and_reported() {
        let found =
            read(b"G1 X1 E1\nG1 X\nG1 X2 Y=3\n?\nG1 X99999999\nSET_FAN S=1\nM117 hi!\nT0\nG1 X3 E2", 1.75);
        assert_eq!(found.warnings.iter().map(|w| w.line).collect::<Vec<_>>(), [2, 3, 4, 5]);
        assert_eq!(found.layers[0].strands[0].points, [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(3.0, 0.0)]);
        assert_eq!(found.warnings[0].to_string(), "line 2: not understood, left out");
    }

    #[test]
    fn arcs_become_chords_that_hug_them() {
        // A quarter circle of radius 10 from (10, 0) to (0, 10), anticlockwise; length 15.70796 mm.
        for quarter in ["G1 X10\nM83\nG3 X0 Y10 I-10 J0 E1", "G1 X10\nM83\nG3 X0 Y10 R10 E1"] {
            let chords = &moves(quarter)[1..];
            let length: f64 = chords.iter().map(ReadMove::length).sum();
            assert!((length - 15.707_96).abs() < 0.02, "{length}");
            assert!((chords.iter().map(|c| c.filament_mm).sum::<f64>() - 1.0).abs() < 1e-12);
            for c in chords {
                let middle = dvec2(c.from[0] + c.to[0], c.from[1] + c.to[1]) / 2.0;
                assert!((10.0 - ARC_TOLERANCE - 1e-9..=10.0).contains(&middle.length()));
            }
            assert_eq!(chords.last().map(|c| c.to), Some([0.0, 10.0, 0.0]));
        }
        let length = |text: &str| moves(text).iter().skip(1).map(ReadMove::length).sum::<f64>();
        // The same ends clockwise: the other three quarters. A full circle returns to its start.
        assert!((length("G1 X10\nG2 X0 Y10 I-10") - 47.123_89).abs() < 0.05);
        assert!((length("G1 X10\nG2 X0 Y10 R-10") - 47.123_89).abs() < 0.05);
        assert!((length("G1 X10\nG2 I-10") - 62.831_85).abs() < 0.07);
    }

    #[test]
    fn layers_and_types_of_other_slicers() {
        let prusa = ";LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\nM83\nG1 Z0.2\n;TYPE:External perimeter\n;WIDTH:0.45\nG1 X9 E1\n";
        let cura = ";Layer height: 0.2\n;LAYER_COUNT:1\n;LAYER:0\nM82\nG0 Z0.2\n;TYPE:WALL-OUTER\nG1 X9 E1\n";
        let bambu = "; CHANGE_LAYER\n; Z_HEIGHT: 0.2\n; LAYER_HEIGHT: 0.2\nG1 Z0.2\n; FEATURE: Outer wall\n; LINE_WIDTH: 0.42\nG1 X9 E1\n";
        for text in [prusa, cura, bambu] {
            let found = read(text.as_bytes(), 1.75);
            assert_eq!(found.layers.len(), 1, "{text}");
            let layer = &found.layers[0];
            assert_eq!((layer.z, layer.height), (0.2, 0.2));
            assert_eq!(layer.strands[0].role, Some(Role::OuterWall));
            assert!((layer.strands[0].volume_mm3() - 2.405_281_9).abs() < 1e-6);
        }
        // Width from volume: 2.4052819 / 9 = 0.2672535 mm2; less pi 0.01 and over 0.2 is 1.1791882 + 0.2.
        let width = read(cura.as_bytes(), 1.75).layers[0].strands[0].segments[0].width;
        assert!((width - 1.379_188).abs() < 1e-5, "{width}");
    }

    #[test]
    fn heights_that_no_comment_states_are_those_between_layers() {
        // A prime line at 0.28 mm is no layer; layers of 0.3 and 0.2 mm, the second with a hop.
        let cura =
            "G1 Z0.28\nG1 X9 E1\n;LAYER:0\nG0 Z0.3\nG1 X1 E2\n;LAYER:1\nG0 Z0.9\nG0 X5\nG0 Z0.5\nG1 X9 E3\n";
        let heights = |text: &str| {
            let beads = moves(text).into_iter().filter(ReadMove::lays_bead);
            beads.map(|m| (m.height.unwrap_or(0.0) * 1000.0).round()).collect::<Vec<_>>()
        };
        assert_eq!(heights(cura), [280.0, 300.0, 200.0]);
        // Without marks each height is a layer; the next object begins at the bed again.
        assert_eq!(
            heights("M83\nG1 Z.3\nG1 X9 E1\nG1 Z.5\nG1 X1 E1\nG1 X2 E1\nG1 Z.3\nG1 X9 E1"),
            [300.0, 200.0, 200.0, 300.0]
        );
    }

    #[test]
    fn marks_of_another_slicer_are_no_layers() {
        let both = ";LAYER_CHANGE\n;LAYER:0\nG1 X1 E1\n;LAYER_CHANGE\n;LAYER:1\nG1 X2 E2\n";
        assert_eq!(read(both.as_bytes(), 1.75).layers.len(), 2);
    }

    #[test]
    fn stated_limits_are_kept() {
        let mut reader = Reader::new(
            b"M201 X1250 Y1000 Z400 E4000\nM203 X180 Y200 Z12 E80\nM204 P900 R1500 T1100\nM205 X8 J0.02\n\
              M104 S215\nM190 R60\nG1 X1 F600\nSET_VELOCITY_LIMIT VELOCITY=300 ACCEL=5000\nG1 X2",
        );
        let accelerations: Vec<_> = reader.by_ref().map(|m| m.acceleration).collect();
        assert_eq!(accelerations, [Some(900.0), Some(5000.0)]);
        let expected = StatedLimits {
            max_acceleration: [Some(1000.0), Some(400.0), Some(4000.0)],
            max_speed: [Some(300.0), Some(12.0), Some(80.0)],
            travel_acceleration: Some(1100.0),
            retract_acceleration: Some(1500.0),
            junction_deviation: Some(0.02),
        };
        assert_eq!((reader.machine.stated, reader.machine.temperatures), (expected, [215.0, 60.0]));
    }

    #[test]
    fn files_without_marks_are_cut_by_height() {
        let found = read(b"M83\nG1 Z0.3\nG1 X9 E1\nG1 Z2\nG1 X1\nG1 Z0.5\nG1 X9 E1\nG1 Y9 E1\n", 1.75);
        let heights: Vec<[f64; 2]> = found.layers.iter().map(|l| [l.z, l.height]).collect();
        assert_eq!(heights, [[0.3, 0.3], [0.5, 0.2]]);
        assert_eq!(found.layers[1].strands[0].segments.len(), 2);
    }

    #[test]
    fn travels_and_retractions_part_strands() {
        let found = read(
            b";LAYER_CHANGE\nM83\nG1 X9 E1\nG1 E-1\nG1 X20\nG1 E1\nG1 X30 E1\n;TYPE:Perimeter\nG1 X40 E1",
            1.75,
        );
        let layer = &found.layers[0];
        assert_eq!(layer.strands.len(), 3);
        assert_eq!((layer.travels.len(), layer.retractions), (1, 1));
    }

    #[test]
    fn long_numbers_are_read_rightly_or_refused() {
        let value = |text: &str| number(text.as_bytes()).map(|(v, _)| v);
        assert_eq!(value("0.1"), Some(0.1));
        assert_eq!(value("-123.456789012345678901"), Some(-123.456_789_012_345_68));
        assert_eq!(value("00000000000000000000012.5"), Some(12.5));
        for bad in ["", "-", ".", "x", "123456789", "9999999999999999999999999999999999999999"] {
            assert_eq!(value(bad), None, "{bad}");
        }
    }
}
