//! OrcaSlicer and Bambu Studio: JSON whose values are words or lists of words.

use serde_json::Value;

use super::code::Placeholders;
use super::prusa::{FLAVORS, MONOTONIC, PATTERNS, SEAMS};
use super::table::{
    FanNames, Relative, Row, Turn, Values, bed, brim_side, first_of, leave_rest, number, switch, take,
    take_accelerations, take_all, take_bed, take_bed_only, take_fan, take_flow_limit, take_supports,
    take_threshold, take_thumbnails, take_width,
};
use super::{Collector, Imported, comment_pairs};
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
    ("nozzle_temperature", "filament.nozzle_temp", Turn::Number),
    ("nozzle_temperature_initial_layer", "filament.first_layer_nozzle_temp", Turn::Number),
    ("hot_plate_temp", "filament.bed_temp", Turn::Number),
    ("hot_plate_temp_initial_layer", "filament.first_layer_bed_temp", Turn::Number),
    ("overhang_fan_speed", "filament.bridge_fan_speed", Turn::Percent),
    ("close_fan_the_first_x_layers", "filament.fan_first_layers", Turn::Number),
    ("full_fan_speed_layer", "filament.fan_full_layer", Turn::Number),
    ("slow_down_layer_time", "cooling.min_layer_time", Turn::Number),
    ("slow_down_min_speed", "cooling.min_speed", Turn::Number),
    ("fan_cooling_layer_time", "cooling.fan_below_layer_time", Turn::Number),
    ("xy_contour_compensation", "walls.horizontal_expansion", Turn::Number),
    ("xy_hole_compensation", "walls.hole_expansion", Turn::Number),
    ("bridge_flow", "skin.bridge_flow", Turn::Number),
    ("minimum_sparse_infill_area", "infill.solid_below_area", Turn::Number),
    ("infill_wall_overlap", "infill.overlap", Turn::Share),
    ("wipe", "retraction.wipe", Turn::Switch),
    ("wipe_distance", "retraction.wipe_distance", Turn::Number),
    ("retract_length_toolchange", "retraction.tool_change_length", Turn::Number),
    ("spiral_mode", "layers.spiral_vase", Turn::Switch),
    ("ironing_type", "ironing.enabled", Turn::Is(&["top", "topmost", "solid"])),
    ("ironing_flow", "ironing.flow", Turn::Percent),
    ("ironing_spacing", "ironing.spacing", Turn::Number),
    ("top_surface_pattern", "skin.monotonic", MONOTONIC),
    ("enable_arc_fitting", "gcode.arc_fitting", Turn::Switch),
    ("exclude_object", "printer.label_objects", Turn::Switch),
];

const FAN: FanNames = FanNames {
    always: "reduce_fan_stop_start_freq",
    least: "fan_min_speed",
    most: "fan_max_speed",
    automatic: "slow_down_for_layer_cooling",
};

/// (name, path, name of what it may be a share of): widths in percent are shares of the nozzle.
const RELATIVE: &[Relative] = &[
    ("seam_gap", "seam.gap", "nozzle_diameter"),
    ("outer_wall_acceleration", "acceleration.outer_wall", "default_acceleration"),
    ("inner_wall_acceleration", "acceleration.inner_wall", "default_acceleration"),
    ("top_surface_acceleration", "acceleration.top_skin", "default_acceleration"),
    ("internal_solid_infill_acceleration", "acceleration.solid_infill", "default_acceleration"),
    ("sparse_infill_acceleration", "acceleration.infill", "default_acceleration"),
    ("initial_layer_acceleration", "acceleration.first_layer", "default_acceleration"),
    ("bridge_acceleration", "acceleration.bridge", "outer_wall_acceleration"),
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
    let found: Values = map.into_iter().map(|(key, v)| (key, words(&v))).collect();
    let known = found.keys().filter(|k| ROWS.iter().any(|(key, ..)| key == k)).count();
    if known == 0 && !found.contains_key("inherits") {
        return Err(FileError::UnknownProfile);
    }
    Ok(collected(found))
}

/// The settings in G-code of OrcaSlicer or Bambu Studio.
pub(super) fn block(text: &str) -> Option<Values> {
    let (_, block) = text.split_once("; CONFIG_BLOCK_START")?;
    Some(comment_pairs(block.split("; CONFIG_BLOCK_END").next().unwrap_or(block).lines()))
}

pub(super) fn collected(mut found: Values) -> Imported {
    let mut out = Collector::new();
    let brim_width = found.get("brim_width").and_then(|text| number(first_of(text)));
    take_width("inner_wall_line_width", "line_width", &mut found, &mut out);
    take_fan(&FAN, &mut found, &mut out);
    take_flow_limit(&mut found, &mut out);
    take_all(ROWS, RELATIVE, &mut found, &mut out);
    take_thumbnails(&mut found, &mut out);
    take_accelerations(&mut found, &mut out);
    take_specials(&mut found, &mut out);
    take_adhesion(brim_width, &mut found, &mut out);
    leave_rest(found, ASIDE, &mut out);
    out.finish("orcaslicer")
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
    if let Some(text) = found.remove("bed_exclude_area").filter(|text| !text.is_empty()) {
        take_forbidden("bed_exclude_area", &text, out);
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
}

/// One rectangle from the front left corner.
fn take_forbidden(key: &str, text: &str, out: &mut Collector) {
    match bed(text).filter(|_| text.split(',').count() == 4) {
        Some(([x, y], false, false)) => {
            out.map(key, text, "printer.forbidden", Value::from(vec![Value::from(vec![0.0, 0.0, x, y])]));
        }
        _ => out.leave(key, text, "not a rectangle at the corner; left as it is"),
    }
}

/// One kind of base layer here; a raft goes before a brim, a brim before a skirt.
fn take_adhesion(brim_width: Option<f64>, found: &mut Values, out: &mut Collector) {
    let some = |text: &String| number(first_of(text)).is_some_and(|n| n > 0.0);
    let raft = found.remove("raft_layers").filter(some);
    let brim = found.remove("brim_type");
    let skirt = found.remove("skirt_loops").filter(some);
    let side = brim.as_deref().and_then(brim_side).filter(|_| brim_width != Some(0.0));
    let kind = |key: &str, text: &str, kind: &str, out: &mut Collector| {
        out.map(key, text, "adhesion.kind", Value::from(kind));
    };
    let mut rest = Vec::new();
    if let Some(text) = &raft {
        kind("raft_layers", text, "raft", out);
        take(&("raft_layers", "adhesion.raft.layers", Turn::Number), text, out);
        rest.extend(brim.filter(|_| side.is_some()).map(|text| ("brim_type", text)));
        rest.extend(skirt.map(|text| ("skirt_loops", text)));
    } else if let (Some(text), Some(side)) = (&brim, side) {
        match text.as_str() {
            "auto_brim" => {
                let why = "always a brim, where it was one when needed";
                out.change("brim_type", text, "adhesion.kind", Value::from("brim"), why);
            }
            _ => kind("brim_type", text, "brim", out),
        }
        out.map("brim_type", text, "adhesion.brim.side", Value::from(side));
        rest.extend(skirt.map(|text| ("skirt_loops", text)));
    } else if let Some(text) = skirt {
        kind("skirt_loops", &text, "skirt", out);
        take(&("skirt_loops", "adhesion.skirt.loops", Turn::Number), &text, out);
    } else if let Some(text) = brim {
        kind("brim_type", &text, "none", out);
    }
    for (key, text) in rest {
        out.leave(key, &text, "only one kind of base layer at a time; left out");
    }
}
