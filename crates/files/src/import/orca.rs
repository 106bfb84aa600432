//! OrcaSlicer and Bambu Studio: JSON whose values are words or lists of words.

use serde_json::Value;

use super::code::Placeholders;
use super::prusa::{FLAVORS, PATTERNS, SEAMS};
use super::table::{
    Relative, Row, Turn, Values, brim_side, first_of, leave_rest, number, switch, take, take_all, take_bed,
    take_bed_only, take_supports, take_threshold,
};
use super::{Collector, Imported};
use crate::error::FileError;

const NAMES: Placeholders = &[
    ("nozzle_temperature_initial_layer", "first_layer_nozzle_temp"),
    ("first_layer_temperature", "first_layer_nozzle_temp"),
    ("bed_temperature_initial_layer", "first_layer_bed_temp"),
    ("bed_temperature_initial_layer_single", "first_layer_bed_temp"),
    ("first_layer_bed_temperature", "first_layer_bed_temp"),
    ("hot_plate_temp_initial_layer", "first_layer_bed_temp"),
    ("nozzle_temperature", "nozzle_temp"),
    ("bed_temperature", "bed_temp"),
    ("nozzle_diameter", "nozzle_diameter"),
    ("filament_type", "filament_type"),
    ("filament_diameter", "filament_diameter"),
    ("printable_height", "printer_height"),
    ("max_layer_z", "print_height"),
    ("initial_layer_print_height", "first_layer_height"),
    ("total_layer_count", "layer_count"),
];

const ROWS: &[Row] = &[
    ("layer_height", "layers.height", Turn::Number),
    ("initial_layer_print_height", "layers.first_height", Turn::Number),
    ("wall_loops", "walls.count", Turn::Number),
    ("top_shell_layers", "skin.top_layers", Turn::Number),
    ("bottom_shell_layers", "skin.bottom_layers", Turn::Number),
    ("sparse_infill_density", "infill.density", Turn::Percent),
    ("sparse_infill_pattern", "infill.pattern", PATTERNS),
    ("seam_position", "seam.position", SEAMS),
    ("elefant_foot_compensation", "first_layer.elephant_foot", Turn::Number),
    ("outer_wall_speed", "speed.outer_wall", Turn::Number),
    ("inner_wall_speed", "speed.inner_wall", Turn::Number),
    ("sparse_infill_speed", "speed.infill", Turn::Number),
    ("internal_solid_infill_speed", "speed.solid_infill", Turn::Number),
    ("top_surface_speed", "speed.top_skin", Turn::Number),
    ("gap_infill_speed", "speed.gap_fill", Turn::Number),
    ("bridge_speed", "speed.bridge", Turn::Number),
    ("support_speed", "speed.support", Turn::Number),
    ("support_interface_speed", "speed.support_interface", Turn::Number),
    ("ironing_speed", "speed.ironing", Turn::Number),
    ("travel_speed", "speed.travel", Turn::Number),
    ("travel_speed_z", "speed.travel_z", Turn::Number),
    ("initial_layer_speed", "first_layer.speed", Turn::Number),
    ("default_acceleration", "printer.acceleration", Turn::Number),
    ("travel_acceleration", "printer.travel_acceleration", Turn::Number),
    ("support_top_z_distance", "support.gap_z", Turn::Number),
    ("support_object_xy_distance", "support.gap_xy", Turn::Number),
    ("support_interface_top_layers", "support.interface_layers", Turn::Number),
    ("brim_width", "adhesion.brim.width", Turn::Number),
    ("brim_object_gap", "adhesion.brim.gap", Turn::Number),
    ("skirt_distance", "adhesion.skirt.distance", Turn::Number),
    ("raft_contact_distance", "adhesion.raft.gap", Turn::Number),
    ("printable_height", "printer.height", Turn::Number),
    ("nozzle_diameter", "printer.nozzle_diameter", Turn::Number),
    ("gcode_flavor", "printer.flavor", FLAVORS),
    ("machine_start_gcode", "printer.start_gcode", Turn::Code(NAMES)),
    ("machine_end_gcode", "printer.end_gcode", Turn::Code(NAMES)),
    ("machine_max_speed_x", "printer.max_speed_xy", Turn::Number),
    ("machine_max_speed_z", "printer.max_speed_z", Turn::Number),
    ("machine_max_speed_e", "printer.max_speed_e", Turn::Number),
    ("machine_max_acceleration_z", "printer.z_acceleration", Turn::Number),
    ("machine_max_acceleration_retracting", "printer.retract_acceleration", Turn::Number),
    ("print_sequence", "print.sequence", Turn::Word(&[("by layer", "by_layer"), ("by object", "by_object")])),
    ("extruder_clearance_radius", "printer.extruder_clearance_radius", Turn::Number),
    ("extruder_clearance_height_to_rod", "printer.extruder_clearance_height", Turn::Number),
    ("retraction_length", "retraction.length", Turn::Number),
    ("retraction_speed", "retraction.speed", Turn::Number),
    ("z_hop", "retraction.z_hop", Turn::Number),
    ("retraction_minimum_travel", "retraction.min_travel", Turn::Number),
    ("filament_type", "filament.material", Turn::Text),
    ("filament_diameter", "filament.diameter", Turn::Number),
    ("filament_density", "filament.density", Turn::Number),
    ("filament_cost", "filament.cost_per_kg", Turn::Number),
    ("filament_max_volumetric_speed", "filament.max_volumetric_speed", Turn::Number),
    ("nozzle_temperature", "filament.nozzle_temp", Turn::Number),
    ("nozzle_temperature_initial_layer", "filament.first_layer_nozzle_temp", Turn::Number),
    ("hot_plate_temp", "filament.bed_temp", Turn::Number),
    ("hot_plate_temp_initial_layer", "filament.first_layer_bed_temp", Turn::Number),
    ("fan_max_speed", "filament.fan_speed", Turn::Percent),
    ("overhang_fan_speed", "filament.bridge_fan_speed", Turn::Percent),
    ("close_fan_the_first_x_layers", "filament.fan_first_layers", Turn::Number),
];

/// (name, path, name of what it may be a share of): widths in percent are shares of the nozzle.
const WIDTHS: &[Relative] = &[
    ("inner_wall_line_width", "walls.width", "nozzle_diameter"),
    ("initial_layer_line_width", "first_layer.line_width", "nozzle_diameter"),
    ("support_line_width", "support.line_width", "nozzle_diameter"),
];

const ASIDE: &[&str] = &[
    "type",
    "name",
    "from",
    "version",
    "setting_id",
    "filament_id",
    "instantiation",
    "is_custom_defined",
    "print_settings_id",
    "printer_settings_id",
    "filament_settings_id",
];

pub(super) fn import(text: &str) -> Result<Imported, FileError> {
    let malformed = |cause: String| FileError::Malformed { place: "JSON".to_owned(), cause };
    let root: Value = serde_json::from_str(text).map_err(|e| malformed(e.to_string()))?;
    let Value::Object(map) = root else { return Err(FileError::UnknownProfile) };
    let mut found: Values = map.into_iter().map(|(key, v)| (key, words(&v))).collect();
    let known = found.keys().filter(|k| ROWS.iter().any(|(key, ..)| key == k)).count();
    if known == 0 && !found.contains_key("inherits") {
        return Err(FileError::UnknownProfile);
    }
    let mut out = Collector::new();
    take_all(ROWS, WIDTHS, &mut found, &mut out);
    take_specials(&mut found, &mut out);
    leave_rest(found, ASIDE, &mut out);
    Ok(out.finish("orcaslicer"))
}

/// A value as one line: lists joined by commas, as in .ini files.
fn words(value: &Value) -> String {
    match value {
        Value::String(word) => word.clone(),
        Value::Array(list) => list.iter().map(words).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

fn take_specials(found: &mut Values, out: &mut Collector) {
    if let Some(text) = found.remove("inherits")
        && !text.is_empty()
    {
        out.leave("inherits", &text, "values of the profile it builds on are not in the file");
    }
    if let Some(text) = found.remove("printable_area") {
        take_bed("printable_area", &text, out);
    }
    if let Some(text) = found.remove("pressure_advance") {
        match found.remove("enable_pressure_advance").as_deref().and_then(switch) {
            Some(false) => out.leave("pressure_advance", &text, "switched off in the profile"),
            _ => take(&("pressure_advance", "filament.pressure_advance", Turn::Number), &text, out),
        }
    }
    if let (Some(low), Some(high)) =
        (found.remove("nozzle_temperature_range_low"), found.remove("nozzle_temperature_range_high"))
        && let (Some(a), Some(b)) = (number(first_of(&low)), number(first_of(&high)))
    {
        out.map(
            "nozzle_temperature_range",
            &format!("{low} to {high}"),
            "filament.nozzle_temp_range",
            Value::from(vec![a, b]),
        );
    }
    take_supports("enable_support", found, out);
    take_bed_only("support_on_build_plate_only", found, out);
    take_threshold("support_threshold_angle", found, out);
    take_adhesion(found, out);
}

fn take_adhesion(found: &mut Values, out: &mut Collector) {
    let raft = found.remove("raft_layers").filter(|t| number(first_of(t)).is_some_and(|n| n > 0.0));
    let brim = found.remove("brim_type");
    let skirt = found.remove("skirt_loops").filter(|t| number(first_of(t)).is_some_and(|n| n > 0.0));
    let side = brim.as_deref().and_then(brim_side);
    if let Some(text) = raft {
        out.map("raft_layers", &text, "adhesion.kind", Value::from("raft"));
        out.map(
            "raft_layers",
            &text,
            "adhesion.raft.layers",
            Value::from(number(first_of(&text)).unwrap_or(2.0)),
        );
    } else if let (Some(text), Some(side)) = (&brim, side) {
        match text.as_str() {
            "auto_brim" => out.change(
                "brim_type",
                text,
                "adhesion.kind",
                Value::from("brim"),
                "always a brim, where it was one when needed",
            ),
            _ => out.map("brim_type", text, "adhesion.kind", Value::from("brim")),
        }
        out.map("brim_type", text, "adhesion.brim.side", Value::from(side));
    } else if let Some(text) = skirt {
        out.map("skirt_loops", &text, "adhesion.kind", Value::from("skirt"));
        out.map(
            "skirt_loops",
            &text,
            "adhesion.skirt.loops",
            Value::from(number(first_of(&text)).unwrap_or(1.0)),
        );
    } else if let Some(text) = brim {
        out.map("brim_type", &text, "adhesion.kind", Value::from("none"));
    }
}
