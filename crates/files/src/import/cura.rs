//! Cura: a `.curaprofile` is an archive of .ini files, one for the machine and one for each extruder.

use std::collections::BTreeMap;

use serde_json::Value;

use super::code::Placeholders;
use super::table::{Row, Turn, Values, leave_rest, number, switch, take, take_all, take_supports};
use super::{Collector, Imported};
use crate::archive::Archive;
use crate::error::FileError;
use crate::limits::PROFILE_BYTES;

const NAMES: Placeholders = &[
    ("material_print_temperature_layer_0", "first_layer_nozzle_temp"),
    ("material_print_temperature", "nozzle_temp"),
    ("material_bed_temperature_layer_0", "first_layer_bed_temp"),
    ("material_bed_temperature", "bed_temp"),
    ("machine_width", "bed_size_x"),
    ("machine_depth", "bed_size_y"),
    ("machine_height", "printer_height"),
    ("machine_nozzle_size", "nozzle_diameter"),
    ("material_type", "filament_type"),
    ("layer_height_0", "first_layer_height"),
];

const ROWS: &[Row] = &[
    ("layer_height", "layers.height", Turn::Number),
    ("layer_height_0", "layers.first_height", Turn::Number),
    ("wall_line_count", "walls.count", Turn::Number),
    ("line_width", "walls.width", Turn::Number),
    ("wall_line_width", "walls.width", Turn::Number),
    (
        "print_sequence",
        "print.sequence",
        Turn::Word(&[("all_at_once", "by_layer"), ("one_at_a_time", "by_object")]),
    ),
    ("gantry_height", "printer.extruder_clearance_height", Turn::Number),
    ("top_layers", "skin.top_layers", Turn::Number),
    ("bottom_layers", "skin.bottom_layers", Turn::Number),
    ("infill_sparse_density", "infill.density", Turn::Percent),
    (
        "infill_pattern",
        "infill.pattern",
        Turn::Word(&[
            ("grid", "grid"),
            ("lines", "lines"),
            ("zigzag", "lines"),
            ("triangles", "triangles"),
            ("trihexagon", "triangles"),
            ("gyroid", "gyroid"),
            ("honeycomb", "honeycomb"),
            ("concentric", "concentric"),
        ]),
    ),
    (
        "z_seam_type",
        "seam.position",
        Turn::Word(&[
            ("sharpest_corner", "aligned"),
            ("back", "rear"),
            ("shortest", "nearest"),
            ("random", "random"),
        ]),
    ),
    ("material_print_temperature", "filament.nozzle_temp", Turn::Number),
    ("material_print_temperature_layer_0", "filament.first_layer_nozzle_temp", Turn::Number),
    ("material_bed_temperature", "filament.bed_temp", Turn::Number),
    ("material_bed_temperature_layer_0", "filament.first_layer_bed_temp", Turn::Number),
    ("material_diameter", "filament.diameter", Turn::Number),
    ("cool_fan_speed", "filament.fan_speed", Turn::Percent),
    ("bridge_fan_speed", "filament.bridge_fan_speed", Turn::Percent),
    ("speed_wall_0", "speed.outer_wall", Turn::Number),
    ("speed_wall_x", "speed.inner_wall", Turn::Number),
    ("speed_infill", "speed.infill", Turn::Number),
    ("speed_topbottom", "speed.solid_infill", Turn::Number),
    ("speed_roofing", "speed.top_skin", Turn::Number),
    ("speed_support", "speed.support", Turn::Number),
    ("speed_support_interface", "speed.support_interface", Turn::Number),
    ("speed_travel", "speed.travel", Turn::Number),
    ("speed_layer_0", "first_layer.speed", Turn::Number),
    ("speed_ironing", "speed.ironing", Turn::Number),
    ("bridge_wall_speed", "speed.bridge", Turn::Number),
    ("acceleration_print", "printer.acceleration", Turn::Number),
    ("acceleration_travel", "printer.travel_acceleration", Turn::Number),
    ("acceleration_wall_0", "acceleration.outer_wall", Turn::Number),
    ("acceleration_wall_x", "acceleration.inner_wall", Turn::Number),
    ("acceleration_infill", "acceleration.infill", Turn::Number),
    ("acceleration_topbottom", "acceleration.solid_infill", Turn::Number),
    ("acceleration_roofing", "acceleration.top_skin", Turn::Number),
    ("acceleration_support", "acceleration.support", Turn::Number),
    ("acceleration_layer_0", "acceleration.first_layer", Turn::Number),
    ("cool_fan_speed_min", "filament.fan_speed", Turn::Percent),
    ("cool_fan_speed_max", "filament.max_fan_speed", Turn::Percent),
    ("cool_min_layer_time", "cooling.min_layer_time", Turn::Number),
    ("cool_min_layer_time_fan_speed_max", "cooling.fan_below_layer_time", Turn::Number),
    ("cool_min_speed", "cooling.min_speed", Turn::Number),
    ("xy_offset", "walls.horizontal_expansion", Turn::Number),
    ("hole_xy_offset", "walls.hole_expansion", Turn::Number),
    ("magic_spiralize", "layers.spiral_vase", Turn::Switch),
    ("ironing_enabled", "ironing.enabled", Turn::Switch),
    ("ironing_flow", "ironing.flow", Turn::Percent),
    ("ironing_line_spacing", "ironing.spacing", Turn::Number),
    ("infill_overlap", "infill.overlap", Turn::Percent),
    ("min_infill_area", "infill.solid_below_area", Turn::Number),
    ("speed_z_hop", "speed.travel_z", Turn::Number),
    ("retraction_amount", "retraction.length", Turn::Number),
    ("retraction_speed", "retraction.speed", Turn::Number),
    ("retraction_min_travel", "retraction.min_travel", Turn::Number),
    (
        "adhesion_type",
        "adhesion.kind",
        Turn::Word(&[("skirt", "skirt"), ("brim", "brim"), ("raft", "raft"), ("none", "none")]),
    ),
    ("brim_width", "adhesion.brim.width", Turn::Number),
    ("brim_gap", "adhesion.brim.gap", Turn::Number),
    ("skirt_line_count", "adhesion.skirt.loops", Turn::Number),
    ("skirt_gap", "adhesion.skirt.distance", Turn::Number),
    ("skirt_brim_minimal_length", "adhesion.skirt.min_length", Turn::Number),
    ("raft_margin", "adhesion.raft.margin", Turn::Number),
    ("raft_airgap", "adhesion.raft.gap", Turn::Number),
    ("support_angle", "support.overhang_angle_deg", Turn::Number),
    ("support_z_distance", "support.gap_z", Turn::Number),
    ("support_xy_distance", "support.gap_xy", Turn::Number),
    ("machine_nozzle_size", "printer.nozzle_diameter", Turn::Number),
    ("machine_height", "printer.height", Turn::Number),
    ("machine_start_gcode", "printer.start_gcode", Turn::Code(NAMES)),
    ("machine_end_gcode", "printer.end_gcode", Turn::Code(NAMES)),
    (
        "machine_gcode_flavor",
        "printer.flavor",
        Turn::Word(&[
            ("RepRap (Marlin/Sprinter)", "marlin"),
            ("RepRap (RepRap)", "reprap"),
            ("Repetier", "repetier"),
        ]),
    ),
];

pub(super) fn import(bytes: &[u8]) -> Result<Imported, FileError> {
    let mut archive = Archive::open(bytes)?;
    let mut found = BTreeMap::new();
    let mut recognised = false;
    for name in archive.names() {
        let text = archive.text(&name, PROFILE_BYTES)?;
        let is_profile = text.contains("[general]") && text.contains("[values]");
        recognised |= is_profile;
        if is_profile {
            // The first of two files that state the same wins: the machine's, then the first extruder's.
            for (key, value) in values(&text) {
                found.entry(key).or_insert(value);
            }
        }
    }
    if !recognised {
        return Err(FileError::UnknownProfile);
    }
    Ok(collected(found))
}

/// The settings at the end of Cura's G-code: JSON of the same texts as in a profile, cut into comments, its
/// backslashes doubled. `None` for other files.
pub(super) fn block(text: &str) -> Result<Option<Values>, FileError> {
    let cut: String = text.lines().filter_map(|line| line.strip_prefix(";SETTING_3 ")).collect();
    if cut.is_empty() {
        return Ok(None);
    }
    let malformed =
        |e: serde_json::Error| FileError::Malformed { place: "SETTING_3".to_owned(), cause: e.to_string() };
    let root: Value = serde_json::from_str(&cut.replace("\\\\", "\\")).map_err(malformed)?;
    let mut found = BTreeMap::new();
    let extruders = root["extruder_quality"].as_array().into_iter().flatten();
    for text in std::iter::once(&root["global_quality"]).chain(extruders).filter_map(Value::as_str) {
        for (key, value) in values(text) {
            found.entry(key).or_insert(value);
        }
    }
    Ok(Some(found))
}

/// The pairs below `[values]`. Lines that are indented go on with the one before.
fn values(text: &str) -> Vec<(String, String)> {
    let below = text.split_once("[values]").map_or("", |(_, rest)| rest);
    let mut pairs: Vec<(String, String)> = Vec::new();
    for line in below.lines().take_while(|line| !line.starts_with('[')) {
        match (line.starts_with([' ', '\t']), pairs.last_mut(), line.split_once('=')) {
            (true, Some((_, value)), _) => {
                value.push('\n');
                value.push_str(line.trim());
            }
            (false, _, Some((key, value))) => pairs.push((key.trim().to_owned(), value.trim().to_owned())),
            _ => {}
        }
    }
    pairs
}

pub(super) fn collected(mut found: Values) -> Imported {
    let mut out = Collector::new();
    let formulas: Vec<String> =
        found.iter().filter(|(_, v)| v.starts_with('=')).map(|(k, _)| k.clone()).collect();
    for key in formulas {
        let text = found.remove(&key).unwrap_or_default();
        out.leave(&key, &text, "a formula; left as it is");
    }
    if found.contains_key("wall_line_width")
        && let Some(text) = found.remove("line_width")
    {
        out.leave("line_width", &text, "wall_line_width goes before it");
    }
    if let Some(text) = found.remove("acceleration_enabled").filter(|text| switch(text) == Some(false)) {
        out.leave("acceleration_enabled", &text, "accelerations are the printer's own");
        found.retain(|key, _| !key.starts_with("acceleration_"));
    }
    take_thicknesses(&mut found, &mut out);
    take_first_temperatures(&mut found, &mut out);
    take_all(ROWS, &[], &mut found, &mut out);
    if let Some(text) = found.remove("cool_fan_enabled").filter(|text| switch(text) == Some(false)) {
        out.map("cool_fan_enabled", &text, "filament.fan_speed", Value::from(0.0));
    }
    take_speed(&mut found, &mut out);
    take_retraction(&mut found, &mut out);
    take_first_layers(&mut found, &mut out);
    take_supports("support_enable", &mut found, &mut out);
    if let Some(text) = found.remove("support_type") {
        out.map("support_type", &text, "support.everywhere", Value::from(text != "buildplate"));
    }
    take_machine(&mut found, &mut out);
    leave_rest(found, &[], &mut out);
    out.finish("cura")
}

/// One speed for all stands for that of infill: the others have settings of their own.
fn take_speed(found: &mut Values, out: &mut Collector) {
    let key = "speed_print";
    let Some(text) = found.remove(key) else { return };
    let why = "speeds of walls and skins stay as they are";
    match number(&text) {
        Some(speed) => out.change(key, &text, "speed.infill", Value::from(speed), why),
        None => out.leave(key, &text, "not a number; left as it is"),
    }
}

/// Thicknesses of walls and skins, which are numbers of lines and layers here; a number of its own goes before.
fn take_thicknesses(found: &mut Values, out: &mut Collector) {
    let value = |key: &str, found: &Values| found.get(key).and_then(|text| number(text)).filter(|x| *x > 0.0);
    let line = value("wall_line_width", found).or(value("line_width", found));
    let layer = value("layer_height", found);
    let rows = [
        ("wall_thickness", "wall_line_count", "walls.count", line, "line width"),
        ("top_thickness", "top_layers", "skin.top_layers", layer, "layer height"),
        ("bottom_thickness", "bottom_layers", "skin.bottom_layers", layer, "layer height"),
        ("top_bottom_thickness", "top_layers", "skin.top_layers", layer, "layer height"),
        ("top_bottom_thickness", "bottom_layers", "skin.bottom_layers", layer, "layer height"),
    ];
    let mut told = found.clone();
    for (key, own, path, each, what) in rows {
        let Some(text) = found.get(key).cloned() else { continue };
        let why = match (told.contains_key(own), number(&text), each) {
            (true, ..) => format!("{own} goes before it"),
            (false, Some(thickness), Some(each)) => {
                // Dust of binary fractions makes no layer more.
                let count = (thickness / each - 1e-4).ceil().max(0.0);
                out.change(
                    key,
                    &text,
                    path,
                    Value::from(count),
                    &format!("in steps of the {what}, {each} mm"),
                );
                told.insert(own.to_owned(), text);
                continue;
            }
            _ => format!("the profile does not say what the {what} is; left as it is"),
        };
        out.leave(key, &text, &why);
    }
    for (key, ..) in rows {
        found.remove(key);
    }
}

/// The first layer is as hot as the others if nothing else is said.
fn take_first_temperatures(found: &mut Values, out: &mut Collector) {
    for (key, path) in [
        ("material_print_temperature", "filament.first_layer_nozzle_temp"),
        ("material_bed_temperature", "filament.first_layer_bed_temp"),
    ] {
        if let Some(text) = found.get(key).filter(|_| !found.contains_key(&format!("{key}_layer_0")))
            && let Some(value) = number(text)
        {
            out.change(
                key,
                text,
                path,
                Value::from(value),
                "the first layer's too, which has none of its own",
            );
        }
    }
}

/// Switches of retraction and hop, which are lengths of 0 here.
fn take_retraction(found: &mut Values, out: &mut Collector) {
    if let Some(text) = found.remove("retraction_enable")
        && switch(&text) == Some(false)
    {
        out.map("retraction_enable", &text, "retraction.length", Value::from(0.0));
    }
    let Some(text) = found.remove("retraction_hop") else { return };
    match found.remove("retraction_hop_enabled").as_deref().and_then(switch) {
        Some(false) => out.leave("retraction_hop", &text, "switched off in the profile"),
        _ => take(&("retraction_hop", "retraction.z_hop", Turn::Number), &text, out),
    }
}

/// What is different on the first layers.
fn take_first_layers(found: &mut Values, out: &mut Collector) {
    let key = "xy_offset_layer_0";
    if let Some(text) = found.remove(key) {
        let path = "first_layer.elephant_foot";
        match number(&text) {
            Some(x) if x <= 0.0 => {
                out.change(key, &text, path, Value::from(0.0 - x), "counted inwards here");
            }
            _ => out.leave(key, &text, "the first layer cannot be made wider; left as it is"),
        }
    }
    let key = "cool_fan_full_layer";
    if let Some(text) = found.remove(key) {
        let path = "filament.fan_first_layers";
        match number(&text) {
            Some(layer) if layer >= 1.0 => {
                out.change(key, &text, path, Value::from(layer - 1.0), "without a ramp: no fan below it");
            }
            _ => out.leave(key, &text, "not a layer; left as it is"),
        }
    }
}

/// Size, shape and origin of the bed.
fn take_machine(found: &mut Values, out: &mut Collector) {
    let side = |key: &str| found.get(key).and_then(|text| number(text));
    if let (Some(width), Some(depth)) = (side("machine_width"), side("machine_depth")) {
        found.remove("machine_width");
        found.remove("machine_depth");
        let size = format!("{width} x {depth}");
        out.map("machine_width", &size, "printer.bed_size", Value::from(vec![width, depth]));
    }
    if let Some(text) = found.remove("machine_shape") {
        let shape = if text == "elliptic" { "round" } else { "rectangle" };
        out.map("machine_shape", &text, "printer.bed_shape", Value::from(shape));
    }
    if let Some(text) = found.remove("machine_center_is_zero") {
        let origin = if switch(&text) == Some(true) { "center" } else { "corner" };
        out.map("machine_center_is_zero", &text, "printer.origin", Value::from(origin));
    }
}
