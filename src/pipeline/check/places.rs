//! Places of layers that will not print well, found on the way while a range is worked and told once
//! for the whole job: the worst place of each kind and on how many layers there are more.

use serde::{Deserialize, Serialize};

use super::Warning;
use crate::polygon::island::inner_point;
use crate::polygon::{Contour, DVec2, Join, Polygon, PolygonSet};
use crate::region::bridge::Bridge;
use crate::region::overhang::permissible_step;
use crate::region::{Path, Role, Width};
use crate::settings::Settings;
use crate::sort::StableSort;
use crate::support::SupportMethod;
use crate::toolpath::LayerParts;

/// A bead counts as narrower than a line from this share of its width on: outlines are followed to a
/// hundredth of a millimetre or so.
const NARROW_SHARE: f64 = 0.95;

/// Narrow beads shorter than this, in line widths, are tips and corners and no walls.
const WALL_LENGTH: f64 = 10.0;

/// Places without a bead are walls from this mean thickness on, mm; below it they are the hair that is left
/// between an outline and its beads.
const LOST_THICKNESS: f64 = 0.02;

/// Lines that lie in the air side by side before an overhang is told: ceilings of letters and slots a
/// millimetre deep come out well enough.
const LINES_IN_AIR: f64 = 3.0;

/// Overhangs smaller than this are not told, mm2: a few short lines.
const OVERHANG_AREA: f64 = 4.0;

/// Bridges longer than this are told, mm. Bridging tests reach 20 to 60 mm with PLA and a strong fan.
const LONG_BRIDGE: f64 = 30.0;

/// What is wrong with a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Fault {
    /// A wall thinner than a line; the size is how much it lacks, mm.
    ThinWall,
    /// A wall too thin for any bead; the size is its length, mm.
    LostWall,
    /// Lines in the air without supports; the size is their area, mm2.
    Overhang,
    /// A long way from one end of a bridge to the other; the size is its length, mm.
    LongBridge,
}

/// The worst place of its kind on a layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    fault: Fault,
    layer: u32,
    at: DVec2,
    size: f64,
}

impl Finding {
    /// The finding in a file with so many layers before those of its print.
    pub(in super::super) fn raise(&mut self, layers: u32) {
        self.layer += layers;
    }
}

/// What the work on one layer has to say of weak places.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Findings<'a> {
    pub layer: u32,
    pub settings: &'a Settings,
}

impl Findings<'_> {
    /// Walls of one bead that is narrower than a line.
    pub(in super::super) fn thin_walls(self, parts: &LayerParts) -> Option<Finding> {
        if self.layer == 0 {
            // Its lines are of another width, and its outline is drawn in.
            return None;
        }
        let beads = parts.fills.iter().filter(|path| path.role == Role::OuterWall);
        let width = self.settings.walls.width;
        let narrow = |path: &Path| {
            let stretch = NarrowStretch::of(path, NARROW_SHARE * width);
            let is_wall = stretch.length >= WALL_LENGTH * width;
            is_wall.then(|| self.finding(Fault::ThinWall, stretch.at, width - stretch.mean_width()))
        };
        beads.filter_map(narrow).max_by(|a, b| a.size.total_cmp(&b.size))
    }

    /// The longest wall without a bead among the places too thin for one.
    pub(in super::super) fn lost_walls(self, lost: &PolygonSet) -> Option<Finding> {
        if self.layer == 0 || lost.is_empty() {
            return None;
        }
        let wall = |island: Polygon| {
            let length = island.contours().map(Contour::length).sum::<f64>() / 2.0;
            let is_wall =
                length >= WALL_LENGTH * self.settings.walls.width && island.area() >= LOST_THICKNESS * length;
            let at = inner_point(&island).filter(|_| is_wall)?;
            Some(self.finding(Fault::LostWall, at, length))
        };
        lost.islands().into_iter().filter_map(wall).max_by(|a, b| a.size.total_cmp(&b.size))
    }

    /// Air below that is more than [`LINES_IN_AIR`] wide and not spanned by a bridge, and bridges that
    /// are long. `bare` is what nothing carries of a layer that lies on `below`.
    pub(in super::super) fn over_air(
        self,
        bare: &PolygonSet,
        below: &PolygonSet,
        bridges: &[Bridge],
    ) -> Vec<Finding> {
        let Settings { walls, support, .. } = self.settings;
        if support.method != SupportMethod::None {
            // What supports leave uncovered they tell themselves.
            return Vec::new();
        }
        let longest = bridges.iter().max_by(|a, b| a.span.total_cmp(&b.span));
        let long = longest.filter(|b| b.span > LONG_BRIDGE).and_then(|b| {
            let (at, _) = largest(&b.area)?;
            Some(self.finding(Fault::LongBridge, at, b.span))
        });
        let step = permissible_step(self.settings.layers.height, support.overhang_angle_deg);
        let reach = step.max(LINES_IN_AIR * walls.width);
        let wide = |area: &PolygonSet| area.opened(reach / 2.0, Join::WALL);
        let mut hanging = wide(bare);
        if !hanging.is_empty() {
            // Bridges fill what lies inside the walls; those run along with them.
            let beside = f64::from(walls.count + 1) * walls.width;
            let held = bridges.iter().map(|b| b.area.offset(beside, Join::WALL));
            let held = held.fold(below.clone(), |all, b| all.union(&b));
            hanging = wide(&hanging.difference(&held));
        }
        let area = hanging.area();
        // Islands with nothing below at all are told as such.
        let hangs = |(at, one): (DVec2, Polygon)| {
            let touches = !one.into_set().offset(walls.width, Join::WALL).intersection(below).is_empty();
            (touches && area >= OVERHANG_AREA).then(|| self.finding(Fault::Overhang, at, area))
        };
        long.into_iter().chain(largest(&hanging).and_then(hangs)).collect()
    }

    fn finding(self, fault: Fault, at: DVec2, size: f64) -> Finding {
        Finding { fault, layer: self.layer, at, size }
    }
}

/// A point inside the largest island, and the island.
fn largest(area: &PolygonSet) -> Option<(DVec2, Polygon)> {
    let island = area.islands().into_iter().max_by(|a, b| a.area().total_cmp(&b.area()))?;
    Some((inner_point(&island)?, island))
}

/// What of a bead is narrower than a limit.
struct NarrowStretch {
    length: f64,
    area: f64,
    /// The middle of its longest piece.
    at: DVec2,
}

impl NarrowStretch {
    fn of(path: &Path, limit: f64) -> NarrowStretch {
        let mut found = NarrowStretch { length: 0.0, area: 0.0, at: DVec2::ZERO };
        if matches!(path.width, Width::Uniform(width) if width >= limit) {
            return found;
        }
        let mut longest = 0.0;
        let count = path.points.len();
        let edges = if path.closed { count } else { count.saturating_sub(1) };
        for i in 0..edges {
            let next = (i + 1) % count;
            let width = (path.width.at(i) + path.width.at(next)) / 2.0;
            let length = path.points[i].distance(path.points[next]);
            if width < limit {
                found.length += length;
                found.area += length * width;
                if length > longest {
                    longest = length;
                    found.at = (path.points[i] + path.points[next]) / 2.0;
                }
            }
        }
        found
    }

    fn mean_width(&self) -> f64 {
        self.area / self.length
    }
}

/// One warning for each kind of fault: its worst place, the lowest of equal ones.
pub(in super::super) fn told(findings: &mut [Finding], settings: &Settings) -> Vec<Warning> {
    findings
        .stable_sort_by(|a, b| (a.fault, a.layer).cmp(&(b.fault, b.layer)).then(b.size.total_cmp(&a.size)));
    let kinds = findings.chunk_by(|a, b| a.fault == b.fault);
    kinds.filter_map(|kind| warning_of(kind, settings)).collect()
}

fn warning_of(kind: &[Finding], settings: &Settings) -> Option<Warning> {
    // `max_by` would take the last, the highest, of equal ones.
    let worst = kind.iter().reduce(|a, b| if b.size > a.size { b } else { a })?;
    let layers = kind.chunk_by(|a, b| a.layer == b.layer).count();
    let more = if layers > 1 { format!(" (on {layers} layers)") } else { String::new() };
    let width = settings.walls.width;
    let plates = |it: Warning| it.fixed_by("support.method", "\"plates\"");
    let tell =
        |code: &str, text: String| Warning::on_layer(code, format!("{text}{more}"), worst.layer, worst.at);
    Some(match worst.fault {
        Fault::ThinWall => {
            let text = format!(
                "a wall is thinner than a line here: {:.2} of {width} mm; it is printed as one narrow line",
                width - worst.size
            );
            tell("thin_wall", text).fixed_by("walls.horizontal_expansion", thicker(worst.size, settings))
        }
        Fault::LostWall => {
            let text = "a wall is too thin for any line here: it is left out".to_owned();
            tell("lost_wall", text).fixed_by("walls.horizontal_expansion", thicker(width, settings))
        }
        Fault::Overhang => {
            let text = format!("{:.0} mm2 hang in the air here without supports", worst.size);
            plates(tell("overhang", text))
        }
        Fault::LongBridge => {
            let text = format!("a bridge of {:.0} mm will sag here", worst.size);
            plates(tell("long_bridge", text))
        }
    })
}

/// The expansion that makes a wall thicker by `lack` mm, to the nearest hundredth.
fn thicker(lack: f64, settings: &Settings) -> f64 {
    ((settings.walls.horizontal_expansion + lack / 2.0) * 100.0).round() / 100.0
}
