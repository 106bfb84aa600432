//! Checks before printing. Here those that need no slicing: settings that contradict printer or
//! material, places on the bed where nothing may stand, parts that do not stand on it.

mod places;

pub use places::Finding;
pub(super) use places::{Findings, told};

use super::Warning;
use crate::gcode;
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2, Polygon, PolygonSet};
use crate::settings::Settings;
use crate::support::SupportMethod;

/// A part as it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    /// Its box on the bed.
    pub footprint: Bounds,
    /// Its lowest point, mm above the bed.
    pub lowest: f64,
}

/// What is wrong with settings and places, each with settings that would mend it where there are any.
pub(super) fn check(settings: &Settings, stands: &[Stand]) -> Vec<Warning> {
    let mut found = temperatures(settings);
    found.extend(pressure_advance(settings));
    found.extend(arcs(settings));
    found.extend(stands.iter().flat_map(|it| forbidden(settings, it.footprint)));
    found.extend(stands.iter().flat_map(|it| off_bed(settings, it)));
    found.extend(prime_line(settings, stands));
    found
}

/// Arcs for a firmware that is not known to take them.
fn arcs(settings: &Settings) -> Option<Warning> {
    let message = "gcode.arc_fitting: this firmware is not known to take arcs; straight pieces are written";
    (settings.gcode.arc_fitting && !settings.printer.flavor.has_arcs())
        .then(|| Warning::on_job("no_arcs", message.to_owned()).fixed_by("gcode.arc_fitting", false))
}

/// A part whose first layer would be laid in the air.
fn off_bed(settings: &Settings, part: &Stand) -> Option<Warning> {
    // Layers are cut at half their height.
    let hangs =
        part.lowest > settings.layers.first_height / 2.0 && settings.support.method == SupportMethod::None;
    let message =
        format!("the part does not touch the bed: its lowest point is {:.2} mm above it", part.lowest);
    hangs.then(|| Warning::on_layer("not_on_bed", message, 0, part.footprint.centre()))
}

/// Temperatures that the material does not suit, or the printer does not reach.
fn temperatures(settings: &Settings) -> Vec<Warning> {
    let (filament, printer) = (&settings.filament, &settings.printer);
    let (nozzle, bed) = (filament.nozzle_temp_range, filament.bed_temp_range);
    let rows = [
        ("nozzle_temp", "nozzle", filament.nozzle_temp, nozzle, printer.max_nozzle_temp),
        (
            "first_layer_nozzle_temp",
            "nozzle",
            filament.first_layer_nozzle_temp,
            nozzle,
            printer.max_nozzle_temp,
        ),
        ("bed_temp", "bed", filament.bed_temp, bed, printer.max_bed_temp),
        ("first_layer_bed_temp", "bed", filament.first_layer_bed_temp, bed, printer.max_bed_temp),
    ];
    let judge = |(name, part, temp, [low, high], most): (&str, &str, f64, [f64; 2], f64)| {
        let path = format!("filament.{name}");
        if temp > most {
            let message =
                format!("{path}: {temp} degrees C are more than this printer's {part} may have, {most}");
            return Some(Warning::on_job("too_hot_for_printer", message).fixed_by(&path, most));
        }
        if (low..=high).contains(&temp) {
            return None;
        }
        let material = &filament.material;
        let message = format!("{path}: {temp} degrees C do not suit {material}: {low} to {high} do");
        let code = if part == "nozzle" { "nozzle_temperature" } else { "bed_temperature" };
        Some(Warning::on_job(code, message).fixed_by(&path, temp.clamp(low, high.max(low)).min(most)))
    };
    rows.into_iter().filter_map(judge).collect()
}

/// Pressure advance that the firmware cannot be told.
fn pressure_advance(settings: &Settings) -> Option<Warning> {
    let asked = settings.filament.pressure_advance > 0.0;
    let message =
        "filament.pressure_advance: this firmware has no command for it; the printer's own value stays";
    (asked && !settings.printer.flavor.has_pressure_advance()).then(|| {
        Warning::on_job("no_pressure_advance", message.to_owned()).fixed_by("filament.pressure_advance", 0)
    })
}

/// Where two boxes overlap.
fn meet(a: Bounds, b: Bounds) -> Option<DVec2> {
    let (low, high) = (a.min.max(b.min), a.max.min(b.max));
    low.cmplt(high).all().then_some((low + high) / 2.0)
}

/// A prime line that a model would be printed on, or that crosses a forbidden zone.
fn prime_line(settings: &Settings, stands: &[Stand]) -> Option<Warning> {
    let ends = gcode::prime_line(&settings.gcode_options())?;
    let half = DVec2::splat(settings.printer.nozzle_diameter / 2.0);
    let line = Bounds { min: ends[0] - half, max: ends[1] + half };
    let on_part = stands.iter().find_map(|it| meet(it.footprint, line)).map(|at| ("the part", at));
    let in_zone = || settings.printer.forbidden_zones().find_map(|zone| meet(zone, line));
    let (what, at) = on_part.or_else(|| Some(("a zone where this printer must not print", in_zone()?)))?;
    let message = format!("the line that fills the nozzle runs through {what}");
    Some(Warning::on_layer("prime_line", message, 0, at).fixed_by("printer.prime_length", 0))
}

/// A model whose box reaches into a forbidden zone.
fn forbidden(settings: &Settings, model: Bounds) -> Option<Warning> {
    let reached = settings.printer.forbidden_zones().find_map(|zone| meet(model, zone))?;
    let message = "the part reaches into a zone of the bed where this printer must not print".to_owned();
    Some(Warning::on_layer("forbidden_zone", message, 0, reached))
}

fn length(island: &Polygon) -> f64 {
    island.contours().map(Contour::length).sum()
}

/// The islands of a layer, and some more, in which no circle of that radius, mm, finds room: an island is at most as
/// large as its outline times the radius of the largest circle in it.
pub(super) fn narrow(area: &PolygonSet, radius: f64) -> PolygonSet {
    let islands = area.islands().into_iter().filter(|it| it.area() <= radius * length(it));
    PolygonSet::from_contours(islands.flat_map(|it| it.into_set().into_contours()).collect())
}

/// The islands of a layer that nothing below holds, each told at a point of it.
pub(super) fn floating(area: &PolygonSet, below: &PolygonSet, layer: u32) -> Vec<Warning> {
    if area.is_empty() {
        return Vec::new();
    }
    let held = area.intersection(below);
    let islands = area.islands().into_iter().map(|island| island.into_set());
    let loose = islands.filter(|island| held.is_empty() || island.intersection(&held).is_empty());
    let tell = |island: PolygonSet| {
        let at = island.contours().first()?.points.first().copied()?;
        let message = "an island begins in the air here: it needs supports".to_owned();
        let warning = Warning::on_layer("floating_island", message, layer, at);
        Some(warning.fixed_by("support.method", "\"plates\""))
    };
    loose.filter_map(tell).collect()
}
