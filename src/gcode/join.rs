//! One pass over the layers in order: what stands before, between and after them.

use super::events::{EventKind, LayerEvent, PAUSE_LIFT, event_layers};
use super::plan::{Account, Hop, feed_rate, filament_steps, micrometres, z_feed};
use super::start::{PrintFacts, end_code, event_code, follow, start_code};
use super::tool::Change;
use super::writer::Writer;
use super::{
    FILAMENT_STEPS, FilamentOptions, GcodeError, GcodeOptions, LayerSummary, Limits, Move, Place, RoleUse,
    filament_area, label, move_times,
};
use crate::polygon::DVec2;
use crate::region::{Bead, Role};
use std::collections::BTreeMap;

/// Where the prime line begins, mm from the front left corner of the bed; it ends as far from the
/// right edge at the latest. Parts seldom reach so far.
const PRIME_MARGIN: [f64; 2] = [5.0, 3.0];

/// Width of the prime line in nozzle diameters: wide, so that it sticks and carries much.
const PRIME_WIDTH: f64 = 1.5;

/// Height of the first travel behind start code that has not said how high the nozzle is, mm: above clips
/// and what has oozed.
const FIRST_TRAVEL: f64 = 2.0;

/// How far the nozzle rises over all that is printed on the way to the next of models printed one after
/// another, mm: corners that have warped and strings stand up.
const OVER_MODELS: f64 = 2.0;

/// What the file says about itself besides moves.
#[derive(Debug, Clone, Copy, Default)]
pub struct FileNotes<'a> {
    /// Whole comment lines for the head of the file, such as thumbnails.
    pub head: &'a [u8],
    /// All settings as (path, value), for the foot of the file.
    pub settings: &'a [(String, String)],
}

/// A file in pieces.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Joined {
    /// Text of all that is not inside a layer.
    pub glue: Vec<u8>,
    /// The file: these pieces one after another.
    pub pieces: Vec<Piece>,
    /// Sums of the whole file.
    pub totals: Totals,
}

/// A stretch of bytes: `start..end` of the glue or of a layer's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Piece {
    /// Position of the layer in the list given to [`join`]; `None` for the glue.
    pub layer: Option<u32>,
    /// First byte.
    pub start: u32,
    /// One behind the last byte.
    pub end: u32,
}

/// Sums of the whole file, start and end code included.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Totals {
    /// Number of layers.
    pub layers: u32,
    /// Duration of all moves, s. Heating and homing, which no file tells, are left out.
    pub time_s: f64,
    /// Filament, mm.
    pub filament_mm: f64,
    /// Plastic, mm3.
    pub volume_mm3: f64,
    /// Its mass, g.
    pub mass_g: f64,
    /// Its price, in the currency of `filament.cost_per_kg`.
    pub cost: f64,
    /// Length of moves without extrusion, mm.
    pub travel_mm: f64,
    /// Number of retractions.
    pub retractions: u32,
    /// Beads by role, the prime line included.
    pub by_role: BTreeMap<Role, RoleUse>,
}

/// Writes what surrounds the layers. `layers` are all layers in printing order: from the bed upwards, and
/// from the bed again where models are printed one after another.
///
/// Fails only if start or end code use a placeholder wrongly ([`super::check_templates`]).
pub fn join(
    layers: &[LayerSummary],
    options: &GcodeOptions,
    notes: &FileNotes<'_>,
) -> Result<Joined, GcodeError> {
    let facts = PrintFacts {
        layer_count: layers.len(),
        first_layer_height: layers.first().map_or(0.0, |l| l.height),
        print_height: layers.iter().map(|l| l.print_z).fold(0.0, f64::max),
    };
    let start_text = start_code(options, facts)?;
    let end_text = end_code(options, facts)?;
    let mut route = Route::new(options);
    let start = route.start(&start_text, facts);
    let has_two_tools = layers.iter().any(|layer| layer.tools != [0, 0]);
    let tops: Vec<f64> = layers.iter().map(|l| l.print_z).collect();
    let places = event_layers(&options.output.events, &tops);
    let mut ways = Vec::with_capacity(layers.len());
    for (k, layer) in layers.iter().enumerate() {
        let due = places.iter().zip(&options.output.events).filter(|&(&place, _)| place == Some(k));
        let mut stops = due.map(|(_, event)| route.stop_for(event, facts)).collect::<Result<Vec<_>, _>>()?;
        if let Some(start) = next_model(layers, k) {
            stops.push(route.leave_for(start));
        }
        ways.push(Way { stops, ..route.reach(layer) });
    }
    let end = route.end(&end_text);
    let totals = route.totals(layers.len());

    let mut file = FileWriter::new(options, totals.time_s);
    file.head(notes);
    file.text(&start_text);
    if has_two_tools {
        file.preheat_second();
    }
    file.text(&label::definitions(options));
    file.progress(0.0);
    file.way(&start);
    for (k, (layer, way)) in layers.iter().zip(&ways).enumerate() {
        file.layer(k, layer, way);
    }
    file.way(&end);
    file.text(&end_text);
    if has_two_tools {
        file.text("M104 T0 S0 ; both nozzles off\nM104 T1 S0\n");
    }
    file.progress(totals.time_s);
    file.foot(&totals, notes);
    let (glue, pieces) = file.finish();
    Ok(Joined { glue, pieces, totals })
}

/// The file itself, for native callers: the pieces one after another.
pub fn assemble(joined: &Joined, texts: &[impl AsRef<[u8]>]) -> Vec<u8> {
    let mut file = Vec::new();
    for piece in &joined.pieces {
        let source = piece.layer.map_or(&joined.glue[..], |k| texts[k as usize].as_ref());
        file.extend_from_slice(&source[piece.start as usize..piece.end as usize]);
    }
    file
}

/// A duration in words: `1d 2h 3m 4s`, leading zeros left out, to the nearest second.
pub fn format_duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    let parts = [(whole / 86400, "d"), (whole / 3600 % 24, "h"), (whole / 60 % 60, "m"), (whole % 60, "s")];
    let first = parts.iter().position(|&(n, _)| n > 0).unwrap_or(3);
    parts[first..].iter().map(|(n, unit)| format!("{n}{unit}")).collect::<Vec<_>>().join(" ")
}

/// Where the model begins whose first layer is the `k`th, if others were printed before it.
fn next_model(layers: &[LayerSummary], k: usize) -> Option<Place> {
    let is_first = k > 0 && layers[k].index == 0;
    let stops = layers[k..].iter().filter(|_| is_first).find_map(|layer| layer.stops)?;
    Some(Place::of(stops.start))
}

/// Moves between two stops that belong to no layer.
#[derive(Default)]
struct Way {
    /// Height of the beads among them, micrometres.
    bead_height: Option<i32>,
    /// What happens before the moves: events, and the way to the next of models printed one after
    /// another.
    stops: Vec<Stop>,
    moves: Vec<Move>,
    /// Seconds that pass before the moves (for text of other hands) and with them.
    time_s: f64,
}

/// A stay between two layers.
struct Stop {
    /// Moves before its text.
    moves: Vec<Move>,
    text: String,
    /// Seconds of the moves and of those in the text.
    time_s: f64,
}

/// From where to where the line runs that fills the nozzle; `None` if there is none, or the start code
/// extrudes something itself.
pub fn prime_line(options: &GcodeOptions) -> Option<[DVec2; 2]> {
    let facts = PrintFacts { layer_count: 1, first_layer_height: 0.0, print_height: 0.0 };
    let extrudes = follow(&start_code(options, facts).ok()?, Place::default(), 0).filament > 0;
    let [from, to] = options.printer.prime_line(PRIME_MARGIN);
    (!extrudes && to.x > from.x).then_some([from, to])
}

/// Follows the nozzle from stop to stop and adds up.
struct Route<'a> {
    options: &'a GcodeOptions,
    limits: Limits,
    at: Place,
    z: i32,
    /// Top of the highest layer so far, micrometres.
    highest: i32,
    /// Fan in force; `None` if text of other hands may have changed it.
    fan: Option<u8>,
    tool: u8,
    /// Filament that is pulled back, in steps.
    retracted: i32,
    /// Where the nozzle may be wiped before it leaves; empty for nowhere.
    wipe: Vec<Place>,
    time_s: f64,
    filament_mm: f64,
    /// How much of it by the second tool.
    second_filament_mm: f64,
    travel_mm: f64,
    retractions: u32,
    by_role: BTreeMap<Role, RoleUse>,
}

impl<'a> Route<'a> {
    fn new(options: &'a GcodeOptions) -> Self {
        Route {
            options,
            limits: Limits::of(&options.printer),
            at: Place::default(),
            z: 0,
            highest: 0,
            fan: Some(0),
            tool: 0,
            retracted: 0,
            wipe: Vec::new(),
            time_s: 0.0,
            filament_mm: 0.0,
            second_filament_mm: 0.0,
            travel_mm: 0.0,
            retractions: 0,
            by_role: BTreeMap::new(),
        }
    }

    /// The start code, and the prime line unless the code has extruded something itself.
    fn start(&mut self, text: &str, facts: PrintFacts) -> Way {
        let mut time_s = self.other_hands(text);
        let mut moves = Vec::new();
        if self.z == 0 && facts.layer_count > 0 {
            moves.push(Move::Lift { z: micrometres(FIRST_TRAVEL), feed: z_feed(self.options) });
            time_s += self.book(&moves);
        }
        let prime = if self.filament_mm > 0.0 { Vec::new() } else { self.prime_line(facts) };
        let bead_height = (!prime.is_empty()).then(|| micrometres(self.prime_height(facts)));
        time_s += self.book(&prime);
        moves.extend(prime);
        Way { bead_height, time_s, moves, stops: Vec::new() }
    }

    /// As high as the first layer, if that is a height at which a bead can be laid alone, mm.
    fn prime_height(&self, facts: PrintFacts) -> f64 {
        let nozzle = self.options.printer.nozzle_diameter;
        facts.first_layer_height.clamp(nozzle / 4.0, nozzle * 0.75)
    }

    /// The line along the front edge that fills the nozzle.
    fn prime_line(&mut self, facts: PrintFacts) -> Vec<Move> {
        let GcodeOptions { printer, filament, speed, .. } = self.options;
        let [from, to] = printer.prime_line(PRIME_MARGIN);
        if to.x <= from.x || facts.layer_count == 0 {
            return Vec::new();
        }
        let height = self.prime_height(facts);
        let width = printer.nozzle_diameter * PRIME_WIDTH;
        let area = Bead { width, height }.area();
        let feed = feed_rate(speed.prime.min(filament.max_volumetric_speed / area));
        let [from, to] = [from, to].map(Place::of);
        let pushed = area * from.distance(to) / filament_area(filament.diameter);
        let mut moves = vec![Move::Role(Role::Prime), Move::Width(micrometres(width) as u32)];
        let lift = Move::Lift { z: micrometres(height), feed: z_feed(self.options) };
        let travel = Move::Travel { to: from, feed: feed_rate(speed.travel) };
        // Never across the bed below the line's height. Nothing is retracted: the nozzle is empty.
        moves.extend(if self.z < micrometres(height) { [lift, travel] } else { [travel, lift] });
        if self.retracted > 0 {
            let feed = feed_rate(self.options.retraction.speed);
            moves.push(Move::Filament { filament: self.retracted, feed });
        }
        moves.push(Move::Extrude { to, filament: filament_steps(pushed), feed });
        moves
    }

    /// The way to a layer's start. The layer itself is booked as well.
    fn reach(&mut self, layer: &LayerSummary) -> Way {
        let Some(stops) = layer.stops else { return Way::default() };
        let to = Place::of(stops.start);
        let z = micrometres(layer.start_z);
        let distance = self.at.distance(to);
        let mut moves = Vec::new();
        let wipe = &std::mem::take(&mut self.wipe);
        let (from_z, retracted, tool) = (self.z, self.retracted, layer.tools[0]);
        if tool == self.tool {
            let hop = Hop { to, via: &[], from_z, to_z: z, distance, oozes_outside: true, retracted, wipe };
            hop.moves(self.options, &mut moves);
        } else {
            let from = self.tool;
            let change = Change { from, to: tool, layer: layer.index, place: to, from_z, to_z: z, retracted };
            change.moves(self.options, &mut moves);
        }
        if self.fan != Some(layer.fan[0]) {
            moves.push(Move::Fan(layer.fan[0]));
        }
        let time_s = self.book(&moves);
        self.at = Place::of(stops.end);
        self.z = micrometres(layer.print_z);
        self.highest = self.highest.max(self.z);
        self.wipe = layer.wipe.iter().map(|&p| Place::of(p)).collect();
        self.fan = Some(layer.fan[1]);
        self.tool = layer.tools[1];
        self.time_s += layer.time_s;
        self.filament_mm += layer.filament_mm;
        self.second_filament_mm += layer.second_filament_mm;
        self.travel_mm += layer.travel_mm;
        self.retractions += layer.retractions;
        for (&role, &used) in &layer.by_role {
            self.by_role.entry(role).or_default().add(used);
        }
        Way { moves, time_s, ..Way::default() }
    }

    /// An event: the nozzle leaves the part, unless the lines are the user's own.
    fn stop_for(&mut self, event: &LayerEvent, facts: PrintFacts) -> Result<Stop, GcodeError> {
        let dialect = self.options.printer.flavor.dialect();
        let (label, command) = match event.kind {
            EventKind::Custom => {
                let text = format!(";CUSTOM_GCODE\n{}", event_code(&event.gcode, self.options, facts)?);
                self.fan = None;
                self.wipe.clear();
                let time_s = self.other_hands(&text);
                return Ok(Stop { moves: Vec::new(), text, time_s });
            }
            EventKind::Pause => (";PAUSE_PRINT\n", dialect.pause),
            EventKind::FilamentChange => (";COLOR_CHANGE\n", "M600\n"),
        };
        let parks = event.kind == EventKind::FilamentChange || dialect.pause_parks;
        let moves = self.leave_part(parks);
        Ok(Stop { time_s: self.book(&moves), moves, text: format!("{label}{command}") })
    }

    /// Retracts and rises above the part, and goes to the back of the bed unless the firmware parks.
    fn leave_part(&mut self, firmware_parks: bool) -> Vec<Move> {
        let mut moves = self.rise_to(self.z + micrometres(PAUSE_LIFT));
        if !firmware_parks {
            let to = Place::of(self.options.printer.parking());
            moves.push(Move::Travel { to, feed: feed_rate(self.options.speed.travel) });
        }
        moves
    }

    /// Goes high over all that is printed to above the place where the next model begins, and waits there
    /// for the temperatures of a first layer.
    fn leave_for(&mut self, start: Place) -> Stop {
        let mut moves = self.rise_to(self.highest + micrometres(OVER_MODELS));
        moves.push(Move::Travel { to: start, feed: feed_rate(self.options.speed.travel) });
        Stop { time_s: self.book(&moves), moves, text: first_temperatures(&self.options.filament) }
    }

    /// Retracts, and rises to this height as far as the printer goes, but never goes down.
    fn rise_to(&mut self, height: i32) -> Vec<Move> {
        let GcodeOptions { printer, retraction, .. } = self.options;
        let mut moves = Vec::new();
        let pulled = filament_steps(retraction.length) - self.retracted;
        if pulled > 0 {
            moves.push(Move::Filament { filament: -pulled, feed: feed_rate(retraction.speed) });
        }
        let z = height.min(micrometres(printer.height)).max(self.z);
        if z > self.z {
            moves.push(Move::Lift { z, feed: z_feed(self.options) });
        }
        self.wipe.clear();
        moves
    }

    /// A last retraction, and the end code.
    fn end(&mut self, text: &str) -> Way {
        let retraction = &self.options.retraction;
        let pulled = filament_steps(retraction.length) - self.retracted;
        let mut moves = Vec::new();
        if pulled > 0 {
            moves.push(Move::Filament { filament: -pulled, feed: feed_rate(retraction.speed) });
        }
        let time_s = self.book(&moves);
        Way { moves, time_s: time_s + self.other_hands(text), ..Way::default() }
    }

    /// Books text of other hands and returns its time.
    fn other_hands(&mut self, text: &str) -> f64 {
        let effect = follow(text, self.at, self.z);
        let (from, tool) = (self.at, self.tool);
        let area = filament_area(self.options.filament_of(tool).diameter);
        let times = move_times(from, self.z, &effect.moves, &self.limits);
        let account = Account::of(from, &effect.moves, &times, tool, self.options);
        let filament_mm = f64::from(effect.filament) / FILAMENT_STEPS;
        if effect.filament > 0 {
            let beads = account.by_role.values().fold(RoleUse::default(), |mut sum, &used| {
                sum.add(used);
                sum
            });
            let prime = RoleUse { volume_mm3: filament_mm * area, ..beads };
            self.by_role.entry(Role::Prime).or_default().add(prime);
        }
        self.filament_mm += filament_mm;
        self.travel_mm += account.travel_mm;
        self.retractions += account.retractions;
        self.time_s += account.time_s;
        (self.at, self.z, self.retracted) = (effect.at, effect.z, effect.retracted);
        account.time_s
    }

    /// Books moves of our own and returns their time.
    fn book(&mut self, moves: &[Move]) -> f64 {
        let times = move_times(self.at, self.z, moves, &self.limits);
        let account = Account::of(self.at, moves, &times, self.tool, self.options);
        for &step in moves {
            match step {
                Move::Lift { z, .. } | Move::Climb { z, .. } => self.z = z,
                Move::Filament { filament, .. } | Move::Wipe { filament, .. } => self.retracted -= filament,
                Move::Fan(fan) => self.fan = Some(fan),
                Move::Tool { to, .. } => self.tool = to,
                Move::Role(_)
                | Move::Width(_)
                | Move::Height(_)
                | Move::Acceleration(_)
                | Move::Object { .. }
                | Move::Extrude { .. }
                | Move::Arc { .. }
                | Move::Travel { .. } => {}
            }
        }
        self.at = account.end;
        self.filament_mm += account.filament_mm();
        self.travel_mm += account.travel_mm;
        self.retractions += account.retractions;
        self.time_s += account.time_s;
        for (role, used) in account.by_role {
            self.by_role.entry(role).or_default().add(used);
        }
        account.time_s
    }

    fn totals(self, layers: usize) -> Totals {
        let lengths = [self.filament_mm - self.second_filament_mm, self.second_filament_mm];
        let (mut volume_mm3, mut mass_g, mut cost) = (0.0, 0.0, 0.0);
        for (tool, length) in (0..).zip(lengths) {
            let filament = self.options.filament_of(tool);
            let volume = length * filament_area(filament.diameter);
            let mass = volume / 1000.0 * filament.density;
            volume_mm3 += volume;
            mass_g += mass;
            cost += mass / 1000.0 * filament.cost_per_kg;
        }
        Totals {
            layers: layers as u32,
            time_s: self.time_s,
            filament_mm: self.filament_mm,
            volume_mm3,
            mass_g,
            cost,
            travel_mm: self.travel_mm,
            retractions: self.retractions,
            by_role: self.by_role,
        }
    }
}

/// Goes back to the temperatures of a first layer where later ones have others, and waits for them.
fn first_temperatures(filament: &FilamentOptions) -> String {
    let FilamentOptions { first_layer_nozzle_temp, first_layer_bed_temp, .. } = filament;
    let mut text = String::new();
    if filament.bed_temp != *first_layer_bed_temp {
        text += &format!("M190 S{first_layer_bed_temp}\n");
    }
    if filament.nozzle_temp != *first_layer_nozzle_temp {
        text += &format!("M109 S{first_layer_nozzle_temp}\n");
    }
    text
}

/// Puts the file together.
struct FileWriter<'a> {
    options: &'a GcodeOptions,
    glue: Vec<u8>,
    /// End of the glue that is in a piece already.
    placed: usize,
    pieces: Vec<Piece>,
    total_s: f64,
    passed_s: f64,
    /// Percent and minutes reported last.
    reported: Option<(u32, u32)>,
    /// The tool that prints.
    tool: u8,
}

impl<'a> FileWriter<'a> {
    fn new(options: &'a GcodeOptions, total_s: f64) -> Self {
        FileWriter {
            options,
            glue: Vec::new(),
            placed: 0,
            pieces: Vec::new(),
            total_s,
            passed_s: 0.0,
            reported: None,
            tool: 0,
        }
    }

    fn text(&mut self, text: &str) {
        self.glue.extend_from_slice(text.as_bytes());
    }

    fn head(&mut self, notes: &FileNotes<'_>) {
        self.text(concat!("; generated by Foothold ", env!("CARGO_PKG_VERSION"), "\n\n"));
        self.glue.extend_from_slice(notes.head);
    }

    fn way(&mut self, way: &Way) {
        if let Some(height) = way.bead_height {
            let mut writer = Writer::after(std::mem::take(&mut self.glue), self.options);
            writer.length_comment(b";HEIGHT:", height);
            self.glue = writer.out;
        }
        self.moves(&way.moves);
        self.passed_s += way.time_s;
    }

    fn moves(&mut self, moves: &[Move]) {
        let mut writer = Writer::after(std::mem::take(&mut self.glue), self.options);
        for &step in moves {
            writer.write(step);
        }
        self.glue = writer.out;
    }

    /// Says how far the print is after `at_s` seconds, if hosts would show something new.
    fn progress(&mut self, at_s: f64) {
        let share = if self.total_s > 0.0 { (at_s / self.total_s).clamp(0.0, 1.0) } else { 1.0 };
        let percent = if at_s >= self.total_s { 100 } else { ((share * 100.0) as u32).min(99) };
        let minutes = ((self.total_s - at_s).max(0.0) / 60.0).round() as u32;
        if self.reported.replace((percent, minutes)) != Some((percent, minutes)) {
            let line = self.options.printer.flavor.dialect().progress;
            let line =
                line.replace("{percent}", &percent.to_string()).replace("{minutes}", &minutes.to_string());
            self.text(&line);
        }
    }

    /// The way to a layer and the layer, cut where progress is reported.
    fn layer(&mut self, k: usize, layer: &LayerSummary, way: &Way) {
        let mut writer = Writer::after(std::mem::take(&mut self.glue), self.options);
        writer.comment(b";LAYER_CHANGE", b"");
        writer.length_comment(b";Z:", micrometres(layer.print_z));
        writer.length_comment(b";HEIGHT:", micrometres(layer.height));
        self.glue = writer.out;
        if layer.index == 1 {
            self.later_temperatures();
        }
        self.progress(self.passed_s);
        for stop in &way.stops {
            self.moves(&stop.moves);
            self.text(&stop.text);
            self.passed_s += stop.time_s;
        }
        self.way(way);
        let mut start = 0;
        for &(offset, seconds) in &layer.marks {
            let before = self.glue.len();
            self.progress(self.passed_s + seconds);
            if self.glue.len() > before {
                let report = self.glue.split_off(before);
                self.layer_piece(k, start, offset);
                self.glue.extend(report);
                start = offset;
            }
        }
        self.layer_piece(k, start, layer.text_len);
        self.passed_s += layer.time_s;
        self.tool = layer.tools[1];
    }

    /// Heats the second nozzle while the first one begins, and says who begins.
    fn preheat_second(&mut self) {
        let temp = self.options.nozzle_temp(1, 0);
        self.text(&format!("M104 T1 S{temp} ; heat the second nozzle\nT0\n"));
    }

    /// Temperatures from the second layer on, where they differ; nobody waits for them.
    fn later_temperatures(&mut self) {
        let filament = self.options.filament_of(self.tool);
        if filament.nozzle_temp != filament.first_layer_nozzle_temp {
            self.text(&format!("M104 S{}\n", filament.nozzle_temp));
        }
        if filament.bed_temp != filament.first_layer_bed_temp {
            self.text(&format!("M140 S{}\n", filament.bed_temp));
        }
    }

    fn layer_piece(&mut self, k: usize, start: u32, end: u32) {
        self.glue_piece();
        if start < end {
            self.pieces.push(Piece { layer: Some(k as u32), start, end });
        }
    }

    fn glue_piece(&mut self) {
        if self.placed < self.glue.len() {
            let [start, end] =
                [self.placed, self.glue.len()].map(|n| u32::try_from(n).expect("glue is far below 4 GiB"));
            self.pieces.push(Piece { layer: None, start, end });
            self.placed = self.glue.len();
        }
    }

    /// Figures and settings, as PrusaSlicer writes them and hosts read them.
    fn foot(&mut self, totals: &Totals, notes: &FileNotes<'_>) {
        self.text("\n");
        self.text(&format!("; filament used [mm] = {:.2}\n", totals.filament_mm));
        self.text(&format!("; filament used [cm3] = {:.2}\n", totals.volume_mm3 / 1000.0));
        self.text(&format!("; filament used [g] = {:.2}\n", totals.mass_g));
        self.text(&format!("; filament cost = {:.2}\n", totals.cost));
        let time = format_duration(totals.time_s);
        self.text(&format!("; estimated printing time (normal mode) = {time}\n\n"));
        for (path, value) in notes.settings {
            let one_line = value.replace('\r', "").replace('\n', "\\n");
            self.text(&format!("; {path} = {one_line}\n"));
        }
    }

    fn finish(mut self) -> (Vec<u8>, Vec<Piece>) {
        self.glue_piece();
        (self.glue, self.pieces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_in_words() {
        for (seconds, words) in [
            (0.0, "0s"),
            (3723.4, "1h 2m 3s"),
            (60.0, "1m 0s"),
            (90_061.0, "1d 1h 1m 1s"),
            (3600.0, "1h 0m 0s"),
        ] {
            assert_eq!(format_duration(seconds), words);
        }
    }
}
