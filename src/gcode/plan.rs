//! Paths of one layer, in printing order, to the moves of the machine.

use super::Spiral;
use super::arcs::fit_arc;
use super::cooling::{Fan, Stretch, slow_down};
use super::extrude::{Feeder, filament_area};
use super::tool::{Change, TOOLS};
use super::{
    FILAMENT_STEPS, FilamentOptions, GcodeOptions, LayerInput, LayerSummary, Limits, Move, Place,
    RetractionOptions, RoleUse, Stops, label, move_times,
};
use crate::region::{Bead, Path, Role, Width};
use crate::toolpath::Way;
use std::collections::BTreeMap;

/// Where a bead changes its width it is cut into pieces of one width each, so that flow and the
/// stated width agree; this is the step of width from piece to piece, mm. The bead is then off by at
/// most half of it, 0.01 mm, less than nozzles repeat.
const WIDTH_STEP: f64 = 0.02;

/// Pieces of a bead of changing width are not made shorter than this, mm, or firmwares that read a
/// thousand lines a second stutter at usual speeds.
const SHORTEST_PIECE: f64 = 0.1;

/// Most pieces of one segment, so that a garbled width costs no time; 20 mm of width in steps.
const MOST_PIECES: f64 = 1000.0;

/// A bead of changing width states a new width when the flow departs from the stated one by more
/// than this share: well within the 1 % promised, and few enough lines.
const WIDTH_TOLERANCE: f64 = 0.005;

/// The gap at a seam is no larger than this share of its loop: tiny loops would lack plastic.
const LARGEST_SEAM_GAP: f64 = 0.01;

/// Speed over a wipe as a share of the travel speed, as PrusaSlicer has it.
const WIPE_SPEED: f64 = 0.8;

/// The moves of one layer, from stop to stop.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerPlan {
    /// Place of the layer in the print.
    pub index: u32,
    /// Height of the nozzle and thickness of the layer, mm, as given.
    pub print_z: f64,
    /// See `print_z`.
    pub height: f64,
    /// Where the first bead starts.
    pub start: Place,
    /// Height of the nozzle, micrometres.
    pub z: i32,
    /// Fan at start and end.
    pub fan: [u8; 2],
    /// Tool at start and end.
    pub tools: [u8; 2],
    /// What the machine does; empty if there are no paths.
    pub moves: Vec<Move>,
    /// Seconds of each move.
    pub times: Vec<f64>,
    /// Where the nozzle could go while it pulls the filament back after the last bead: over what it
    /// has just printed.
    pub wipe: Vec<Place>,
}

/// Plans one layer. Paths without length are left out.
pub fn plan_layer(layer: &LayerInput<'_>, options: &GcodeOptions) -> LayerPlan {
    let mut planner = Planner::new(layer, options);
    let across = Way::ACROSS;
    let told = layer.ways.iter().chain(std::iter::repeat(&across));
    let tools = options.tools_of(layer.paths);
    let mut own = layer.own.iter().peekable();
    for (place, ((path, way), tool)) in layer.paths.iter().zip(told).zip(tools).enumerate() {
        while let Some((_, beads)) = own.next_if(|(from, _)| *from <= place) {
            planner.beads = beads;
        }
        planner.path(path, way, tool);
    }
    planner.enter_object(None);
    planner.set_acceleration(options.printer.acceleration);
    let wipe = planner.wipe_way();
    let tools = [planner.first_tool, planner.tool];
    let Planner { start, z, mut moves, .. } = planner;
    let start = start.unwrap_or_default();
    let limits = Limits::of(&options.printer);
    let mut times = move_times(start, z, &moves, &limits);
    let planned_s: f64 = times.iter().sum();
    if slow_down(&mut moves, planned_s, Stretch { start, z, limits: &limits }, &options.cooling) {
        times = move_times(start, z, &moves, &limits);
    }
    let fan = Fan::of(layer.index, planned_s, &options.filament, &options.cooling);
    let fan = fan.blow(&mut moves, &mut times);
    LayerPlan {
        index: layer.index,
        print_z: layer.print_z,
        height: layer.height,
        start,
        z,
        fan,
        tools,
        moves,
        times,
        wipe,
    }
}

/// mm/s as a feed rate in mm/min, rounded down so that limits hold; at least 1.
pub(super) fn feed_rate(speed: f64) -> u32 {
    ((speed * 60.0).floor() as u32).max(1)
}

/// mm of filament in the text's steps.
pub(super) fn filament_steps(length: f64) -> i32 {
    (length * FILAMENT_STEPS).round() as i32
}

/// mm as micrometres.
pub(super) fn micrometres(length: f64) -> i32 {
    (length * 1000.0).round() as i32
}

/// Feed rate of moves along z.
pub(super) fn z_feed(options: &GcodeOptions) -> u32 {
    feed_rate(options.speed.travel_z.min(options.printer.max_speed_z))
}

struct Planner<'a> {
    options: &'a GcodeOptions,
    /// By these the beads of the model are laid that is printed.
    beads: &'a GcodeOptions,
    index: u32,
    height: f64,
    z: i32,
    spiral: Option<Climb>,
    stated_height: f64,
    feeder: Feeder,
    /// State of the machine while the moves are laid down.
    start: Option<Place>,
    first_tool: u8,
    tool: u8,
    at: Place,
    /// What is known of the way to the next bead.
    via: Vec<Place>,
    crosses_outline: bool,
    /// The labelled object that is being printed.
    object: Option<usize>,
    role: Option<Role>,
    stated_width: Option<u32>,
    acceleration: u32,
    /// The path printed last.
    printed: Printed,
    moves: Vec<Move>,
}

/// How far the nozzle has come up a turn of a spiral.
#[derive(Clone, Copy)]
struct Climb {
    is_first: bool,
    /// Length of the turn and of what is laid of it, mm.
    length: f64,
    laid: f64,
    /// Heights at its start and end, mm.
    bottom: f64,
    top: f64,
}

impl Climb {
    fn of(spiral: Spiral, layer: &LayerInput<'_>) -> Climb {
        Climb {
            is_first: spiral == Spiral::First,
            length: layer.paths.iter().map(Path::length).sum(),
            laid: 0.0,
            bottom: layer.print_z - layer.height,
            top: layer.print_z,
        }
    }

    /// Goes on by `step` mm: the height there, and the bead's share of its full flow on the way.
    fn rise(&mut self, step: f64) -> (i32, f64) {
        let share = |laid: f64| (laid / self.length).clamp(0.0, 1.0);
        let (from, to) = (share(self.laid), share(self.laid + step));
        self.laid += step;
        let flow = if self.is_first { (from + to) / 2.0 } else { 1.0 };
        (micrometres(self.bottom + (self.top - self.bottom) * to), flow)
    }
}

/// A path that has just been printed.
#[derive(Default)]
struct Printed {
    places: Vec<Place>,
    closed: bool,
}

impl<'a> Planner<'a> {
    fn new(layer: &LayerInput<'_>, options: &'a GcodeOptions) -> Self {
        let points: usize = layer.paths.iter().map(|p| p.points.len() + 1).sum();
        Planner {
            options,
            beads: options,
            index: layer.index,
            height: layer.height,
            z: micrometres(layer.print_z - if layer.spiral.is_some() { layer.height } else { 0.0 }),
            spiral: layer.spiral.map(|spiral| Climb::of(spiral, layer)),
            stated_height: layer.height,
            feeder: Feeder::new(options.filament.diameter),
            start: None,
            first_tool: 0,
            tool: 0,
            at: Place::default(),
            via: Vec::new(),
            crosses_outline: false,
            object: None,
            role: None,
            stated_width: None,
            acceleration: options.printer.bead_acceleration(options.printer.acceleration),
            printed: Printed::default(),
            moves: Vec::with_capacity(points + 5 * layer.paths.len()),
        }
    }

    fn filament(&self) -> &'a FilamentOptions {
        self.options.filament_of(self.tool)
    }

    /// Beads from here on are of this tool's material.
    fn take_tool(&mut self, tool: u8) {
        self.tool = tool;
        self.feeder = Feeder::new(self.filament().diameter);
        self.role = None;
    }

    fn path(&mut self, path: &Path, way: &Way, tool: u8) {
        // A path too small to print leaves its way to the next one.
        self.crosses_outline |= way.crosses_outline;
        self.via.extend(way.via.iter().map(|&p| Place::of(p)));
        let places: Vec<Place> = path.points.iter().map(|&p| Place::of(p)).collect();
        let Some((&first, rest)) = places.split_first() else { return };
        if rest.iter().all(|&p| p == first) {
            return;
        }
        let object = label::object_at(&self.options.objects, path.role, path.points[0]);
        if object != self.object {
            self.enter_object(None);
        }
        self.come_to(first, tool);
        self.enter_object(object);
        self.set_role(path.role);
        match &path.width {
            Width::Uniform(width) => self.uniform(path, &places, *width),
            Width::Varying(widths) => self.varying(path, &places, widths),
        }
        self.printed = Printed { places, closed: path.closed };
    }

    /// Says whose moves end and whose begin. The way between two objects belongs to neither.
    fn enter_object(&mut self, object: Option<usize>) {
        if object == self.object {
            return;
        }
        let mark = |place: usize, begins: bool| Move::Object { place: place as u32, begins };
        self.moves.extend(self.object.map(|place| mark(place, false)));
        self.moves.extend(object.map(|place| mark(place, true)));
        self.object = object;
    }

    /// Beads of one width along the whole path.
    fn uniform(&mut self, path: &Path, places: &[Place], width: f64) {
        let area = Bead { width, height: self.bead_height(path.role) }.area();
        let feed = self.bead_feed(path.role, path.hang, area);
        self.state_width(micrometres(width).max(0) as u32);
        let mut line: Vec<Place> = places.iter().copied().chain(self.closing_end(path, places)).collect();
        line.dedup();
        let mut rest = &line[..];
        while rest.len() > 1 {
            let step = self.arc(rest, area, feed).unwrap_or_else(|| {
                self.bead(rest[1], area, feed);
                1
            });
            rest = &rest[step..];
        }
    }

    /// A bead along as many of these places as lie on an arc; how many pieces it replaces. It has the
    /// plastic of all of them.
    fn arc(&mut self, places: &[Place], area: f64, feed: u32) -> Option<usize> {
        let GcodeOptions { output, printer, .. } = self.options;
        let fits_arcs = output.arc_fitting && printer.flavor.has_arcs();
        let straight = !fits_arcs || self.spiral.is_some();
        let (last, curve) = (!straight).then(|| fit_arc(places, output.arc_tolerance)).flatten()?;
        let pieces = places[..=last].windows(2);
        let filament = pieces.map(|w| self.feeder.filament(area * w[0].distance(w[1]))).sum();
        self.moves.push(Move::Arc { curve, filament, feed });
        self.at = curve.to;
        Some(last)
    }

    /// Beads whose width changes linearly from point to point. Missing widths repeat the last one.
    fn varying(&mut self, path: &Path, places: &[Place], widths: &[f64]) {
        let width = |i: usize| widths.get(i).or(widths.last()).copied().unwrap_or(0.0);
        for (i, &to) in places.iter().enumerate().skip(1) {
            self.tapered(path, to, [width(i - 1), width(i)]);
        }
        if let Some(end) = self.closing_end(path, places) {
            self.tapered(path, end, [width(places.len() - 1), width(0)]);
        }
    }

    /// Where a closed path ends: at its start, walls a little before it, so that the end does not
    /// press on the start. `None` for an open path, and where nothing is left of the last edge.
    fn closing_end(&self, path: &Path, places: &[Place]) -> Option<Place> {
        let (&first, &last) = (places.first()?, places.last()?);
        let gap = match path.role {
            Role::OuterWall | Role::InnerWall | Role::OverhangWall => {
                self.beads.seam_gap.min(LARGEST_SEAM_GAP * path.length())
            }
            _ => 0.0,
        };
        let length = last.distance(first);
        let is_left = path.closed && (gap == 0.0 || length > gap);
        is_left.then(|| if gap == 0.0 { first } else { Place::of(first.mm().lerp(last.mm(), gap / length)) })
    }

    /// A straight bead from `from` to `to` wide, in pieces of one width each.
    fn tapered(&mut self, path: &Path, to: Place, [from_width, to_width]: [f64; 2]) {
        let (start, end) = (self.at.mm(), to.mm());
        let wanted = ((to_width - from_width).abs() / WIDTH_STEP).ceil();
        let room = (start.distance(end) / SHORTEST_PIECE).floor();
        let pieces = wanted.min(room).clamp(1.0, MOST_PIECES) as u32;
        for k in 0..pieces {
            let share = |part: f64| (f64::from(k) + part) / f64::from(pieces);
            let width = from_width + (to_width - from_width) * share(0.5);
            let area = Bead { width, height: self.bead_height(path.role) }.area();
            self.state_nearly(width, area);
            let piece_end = if k + 1 == pieces { to } else { Place::of(start.lerp(end, share(1.0))) };
            self.bead(piece_end, area, self.bead_feed(path.role, path.hang, area));
        }
    }

    fn bead(&mut self, to: Place, area: f64, feed: u32) {
        if to == self.at {
            return;
        }
        let length = self.at.distance(to);
        let climb = self.spiral.as_mut().map(|climb| climb.rise(length));
        let flow = climb.map_or(1.0, |(_, flow)| flow);
        let filament = self.feeder.filament(area * length * flow);
        self.moves.push(match climb {
            Some((z, _)) => Move::Climb { to, z, filament, feed },
            None => Move::Extrude { to, filament, feed },
        });
        self.at = to;
    }

    /// Height of a role's beads, mm.
    fn bead_height(&self, role: Role) -> f64 {
        if role == Role::Ironing { self.height * self.beads.ironing_flow } else { self.height }
    }

    /// Feed rate of a bead: its role's, the first layer's and the nozzle's limit.
    fn bead_feed(&self, role: Role, hang: f64, area: f64) -> u32 {
        let speed = &self.beads.speed;
        let wanted = match role {
            Role::OverhangWall => speed.outer_wall + (speed.overhang_wall - speed.outer_wall) * hang,
            _ => speed.of(role),
        };
        let layer = if self.index == 0 { self.beads.first_layer_speed } else { f64::INFINITY };
        // An area of 0 gives an infinite limit, which the others overrule.
        let melted = self.filament().max_volumetric_speed / area;
        feed_rate(wanted.min(layer).min(melted))
    }

    fn set_role(&mut self, role: Role) {
        if self.role != Some(role) {
            self.role = Some(role);
            self.stated_width = None;
            self.moves.push(Move::Role(role));
        }
        let height = self.bead_height(role);
        if self.stated_height != height {
            self.stated_height = height;
            self.moves.push(Move::Height(micrometres(height) as u32));
        }
        let first = if self.index == 0 { self.beads.acceleration.first_layer } else { 0.0 };
        let own = [first, self.beads.acceleration.of(role), self.options.printer.acceleration];
        self.set_acceleration(own.into_iter().find(|&a| a > 0.0).unwrap_or_default());
    }

    fn set_acceleration(&mut self, acceleration: f64) {
        let whole = self.options.printer.bead_acceleration(acceleration);
        if self.acceleration != whole && self.start.is_some() {
            self.moves.push(Move::Acceleration(whole));
            self.acceleration = whole;
        }
    }

    fn state_width(&mut self, width: u32) {
        if self.stated_width != Some(width) {
            self.stated_width = Some(width);
            self.moves.push(Move::Width(width));
        }
    }

    /// States a width unless the stated one gives nearly the same flow.
    fn state_nearly(&mut self, width: f64, area: f64) {
        let stated = self
            .stated_width
            .map(|w| Bead { width: f64::from(w) / 1000.0, height: self.stated_height }.area());
        if stated.is_none_or(|s| (s - area).abs() > WIDTH_TOLERANCE * area) {
            self.state_width(micrometres(width).max(0) as u32);
        }
    }

    /// With the right tool to where a bead begins.
    fn come_to(&mut self, place: Place, tool: u8) {
        if self.start.is_none() {
            self.take_tool(tool);
            self.first_tool = tool;
            self.start = Some(place);
        } else if self.tool != tool {
            let (from, layer, z) = (self.tool, self.index, self.z);
            let change = Change { from, to: tool, layer, place, from_z: z, to_z: z, retracted: 0 };
            change.moves(self.options, &mut self.moves);
            self.take_tool(tool);
            self.printed = Printed::default();
        } else {
            return self.go_to(place);
        }
        self.via.clear();
        self.crosses_outline = false;
        self.at = place;
    }

    fn go_to(&mut self, to: Place) {
        if self.at != to {
            let stops = || std::iter::once(self.at).chain(self.via.iter().copied());
            let distance = stops().zip(stops().skip(1).chain([to])).map(|(a, b)| a.distance(b)).sum();
            let wipe = &self.wipe_way();
            let travel = Hop {
                to,
                via: &self.via,
                from_z: self.z,
                to_z: self.z,
                distance,
                oozes_outside: self.crosses_outline,
                retracted: 0,
                wipe,
            };
            travel.moves(self.options, &mut self.moves);
        }
        self.via.clear();
        self.crosses_outline = false;
        self.at = to;
    }

    /// The way over the path printed last along which the nozzle may be wiped: on along a loop, back
    /// along a line.
    fn wipe_way(&self) -> Vec<Place> {
        let RetractionOptions { wipe, wipe_distance, .. } = self.options.retraction;
        let Printed { places, closed } = &self.printed;
        let Some((&first, rest)) = places.split_first().filter(|_| wipe) else { return Vec::new() };
        match closed {
            true => cut_way(first, rest.iter().chain([&first]), wipe_distance),
            false => cut_way(places[places.len() - 1], places.iter().rev().skip(1), wipe_distance),
        }
    }
}

/// The first `length` mm of a way that leads from `at` over `places`, `at` included.
fn cut_way<'a>(mut at: Place, places: impl Iterator<Item = &'a Place>, length: f64) -> Vec<Place> {
    let mut left = length;
    let mut way = vec![at];
    for &to in places.filter(|_| length > 0.0) {
        let step = at.distance(to);
        if step >= left {
            way.push(Place::of(at.mm().lerp(to.mm(), left / step)));
            break;
        }
        way.push(to);
        left -= step;
        at = to;
    }
    way
}

/// A move without extrusion, with what goes before and after it.
pub(super) struct Hop<'a> {
    pub(super) to: Place,
    /// Places on the way.
    pub(super) via: &'a [Place],
    /// Heights of the nozzle before and after, micrometres.
    pub(super) from_z: i32,
    pub(super) to_z: i32,
    /// How far it is, mm.
    pub(super) distance: f64,
    /// Whether the way leaves the part, so that what oozes would show.
    pub(super) oozes_outside: bool,
    /// Filament that is pulled back already.
    pub(super) retracted: i32,
    /// Places to go over while the filament is pulled back, from where the nozzle is; empty pulls it
    /// at rest.
    pub(super) wipe: &'a [Place],
}

impl Hop<'_> {
    /// Retracts and lifts if the way leaves the part and is long enough, travels, and undoes both.
    pub(super) fn moves(&self, options: &GcodeOptions, moves: &mut Vec<Move>) {
        let retraction = &options.retraction;
        let reaches = self.distance >= retraction.min_travel && retraction.length > 0.0;
        let long = reaches && self.oozes_outside && self.distance > 0.0;
        let pulled =
            if long { filament_steps(retraction.length).max(self.retracted) } else { self.retracted };
        let hop = if long { micrometres(retraction.z_hop) } else { 0 };
        let travel_z = self.from_z.max(self.to_z) + hop;
        let z_feed = z_feed(options);
        let filament_feed = feed_rate(retraction.speed);
        if pulled > self.retracted {
            self.retract(pulled - self.retracted, options, moves);
        }
        if travel_z != self.from_z {
            moves.push(Move::Lift { z: travel_z, feed: z_feed });
        }
        if self.distance > 0.0 {
            let feed = feed_rate(options.speed.travel);
            moves.extend(self.via.iter().map(|&to| Move::Travel { to, feed }));
            moves.push(Move::Travel { to: self.to, feed });
        }
        if travel_z != self.to_z {
            moves.push(Move::Lift { z: self.to_z, feed: z_feed });
        }
        if pulled > 0 {
            moves.push(Move::Filament { filament: pulled, feed: filament_feed });
        }
    }

    /// Pulls `filament` steps back: as many of them on the way over the wipe as the filament's speed
    /// allows, those before at rest.
    fn retract(&self, filament: i32, options: &GcodeOptions, moves: &mut Vec<Move>) {
        let speed = options.retraction.speed;
        let wipe_speed = options.speed.travel * WIPE_SPEED;
        let lengths: Vec<f64> = self.wipe.windows(2).map(|w| w[0].distance(w[1])).collect();
        let length: f64 = lengths.iter().sum();
        let on_the_way = filament_steps(length / wipe_speed * speed).min(filament);
        if filament > on_the_way {
            moves.push(Move::Filament { filament: on_the_way - filament, feed: feed_rate(speed) });
        }
        let (mut gone, mut pulled) = (0.0, 0);
        for (&to, step) in self.wipe.iter().skip(1).zip(lengths) {
            gone += step;
            let until_here = (f64::from(on_the_way) * gone / length).round() as i32;
            moves.push(Move::Wipe { to, filament: pulled - until_here, feed: feed_rate(wipe_speed) });
            pulled = until_here;
        }
    }
}

impl LayerPlan {
    /// Adds up the moves.
    pub(super) fn summary(&self, options: &GcodeOptions) -> LayerSummary {
        let account = Account::of(self.start, &self.moves, &self.times, self.tools[0], options);
        LayerSummary {
            index: self.index,
            print_z: self.print_z,
            height: self.height,
            start_z: f64::from(self.z) / 1000.0,
            stops: (!self.moves.is_empty()).then(|| Stops { start: self.start.mm(), end: account.end.mm() }),
            fan: self.fan,
            tools: self.tools,
            time_s: account.time_s,
            filament_mm: account.filament_mm(),
            second_filament_mm: account.filament[1] as f64 / FILAMENT_STEPS,
            travel_mm: account.travel_mm,
            retractions: account.retractions,
            by_role: account.by_role,
            wipe: self.wipe.iter().map(|p| p.mm()).collect(),
            ..LayerSummary::default()
        }
    }
}

/// What a row of moves adds up to.
#[derive(Debug, Default)]
pub(super) struct Account {
    pub(super) end: Place,
    pub(super) time_s: f64,
    /// Filament of beads, in steps, by tool.
    pub(super) filament: [i64; TOOLS],
    pub(super) travel_mm: f64,
    pub(super) retractions: u32,
    pub(super) by_role: BTreeMap<Role, RoleUse>,
}

impl Account {
    pub(super) fn of(
        start: Place,
        moves: &[Move],
        times: &[f64],
        mut tool: u8,
        options: &GcodeOptions,
    ) -> Account {
        let area = |tool: u8| filament_area(options.filament_of(tool).diameter);
        let mut sum = Account { end: start, ..Account::default() };
        let mut role = Role::Prime;
        let mut beads = BeadSum::default();
        let mut pulled_back = false;
        for (&step, &time) in moves.iter().zip(times) {
            sum.time_s += time;
            match step {
                Move::Role(next) => {
                    sum.close(role, std::mem::take(&mut beads), tool, area(tool));
                    role = next;
                }
                Move::Tool { to, .. } => {
                    sum.close(role, std::mem::take(&mut beads), tool, area(tool));
                    tool = to;
                }
                Move::Extrude { to, filament, .. } | Move::Climb { to, filament, .. } => {
                    beads.filament += i64::from(filament);
                    beads.length += sum.end.distance(to);
                    beads.time += time;
                    sum.end = to;
                }
                Move::Arc { curve, filament, .. } => {
                    beads.filament += i64::from(filament);
                    beads.length += curve.shape(sum.end).length;
                    beads.time += time;
                    sum.end = curve.to;
                }
                Move::Travel { to, .. } => {
                    sum.travel_mm += sum.end.distance(to);
                    sum.end = to;
                }
                Move::Wipe { to, .. } => {
                    sum.travel_mm += sum.end.distance(to);
                    sum.end = to;
                    sum.retractions += u32::from(!std::mem::replace(&mut pulled_back, true));
                }
                Move::Filament { filament, .. } => {
                    let before = std::mem::replace(&mut pulled_back, filament < 0);
                    sum.retractions += u32::from(filament < 0 && !before);
                }
                Move::Width(_)
                | Move::Height(_)
                | Move::Fan(_)
                | Move::Acceleration(_)
                | Move::Object { .. }
                | Move::Lift { .. } => {}
            }
        }
        sum.close(role, beads, tool, area(tool));
        sum
    }

    /// Filament of all tools, mm.
    pub(super) fn filament_mm(&self) -> f64 {
        self.filament.iter().sum::<i64>() as f64 / FILAMENT_STEPS
    }

    /// Books the beads since the last change of role or tool.
    fn close(&mut self, role: Role, beads: BeadSum, tool: u8, filament_area: f64) {
        if beads.length > 0.0 {
            let volume_mm3 = beads.filament as f64 / FILAMENT_STEPS * filament_area;
            let used = RoleUse { length_mm: beads.length, volume_mm3, time_s: beads.time };
            self.by_role.entry(role).or_default().add(used);
        }
        self.filament[usize::from(tool)] += beads.filament;
    }
}

#[derive(Default)]
struct BeadSum {
    filament: i64,
    length: f64,
    time: f64,
}
