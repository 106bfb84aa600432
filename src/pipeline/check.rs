//! Checks before printing that need no slicing: settings that contradict printer or material, and
//! places on the bed where nothing may stand.

use super::Warning;
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet};
use crate::settings::Settings;

/// What is wrong with settings and places, each with settings that would mend it where there are any.
pub(super) fn check(settings: &Settings, footprints: &[Bounds]) -> Vec<Warning> {
    let mut found = temperatures(settings);
    found.extend(pressure_advance(settings));
    found.extend(footprints.iter().flat_map(|&b| forbidden(settings, b)));
    found
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

/// A model whose box reaches into a forbidden zone.
fn forbidden(settings: &Settings, model: Bounds) -> Option<Warning> {
    let reached = settings.printer.forbidden.iter().find_map(|&[x0, y0, x1, y1]| {
        let (low, high) = (model.min.max(DVec2::new(x0, y0)), model.max.min(DVec2::new(x1, y1)));
        low.cmplt(high).all().then_some((low + high) / 2.0)
    })?;
    let message = "the part reaches into a zone of the bed where this printer must not print".to_owned();
    Some(Warning::on_layer("forbidden_zone", message, 0, reached))
}

/// The islands of a layer that nothing below holds, each told at a point of it.
pub(super) fn floating(area: &PolygonSet, below: &PolygonSet, layer: u32) -> Vec<Warning> {
    let islands = area.islands().into_iter().map(|island| island.into_set());
    let loose = islands.filter(|island| island.intersection(below).is_empty());
    let tell = |island: PolygonSet| {
        let at = island.contours().first()?.points.first().copied()?;
        let message = "an island begins in the air here: it needs supports".to_owned();
        let warning = Warning::on_layer("floating_island", message, layer, at);
        Some(warning.fixed_by("support.method", "\"plates\""))
    };
    loose.filter_map(tell).collect()
}
