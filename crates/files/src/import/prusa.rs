//! PrusaSlicer: `name = value` lines, in a file or as comments at the end of G-code.

use serde_json::Value;

use super::code::Placeholders;
use super::table::{
    FanNames, Relative, Row, Turn, Values, brim_side, first_of, leave_rest, number, take_accelerations,
    take_all, take_bed, take_bed_only, take_fan, take_flow_limit, take_supports, take_threshold,
    take_thumbnails, take_width, thousandths,
};
use super::{Collector, Imported, comment_pairs};

const NAMES: Placeholders = &[
    ("first_layer_temperature", "first_layer_nozzle_temp"),
    ("first_layer_bed_temperature", "first_layer_bed_temp"),
    ("temperature", "nozzle_temp"),
    ("bed_temperature", "bed_temp"),
    ("nozzle_diameter", "nozzle_diameter"),
    ("filament_type", "filament_type"),
    ("filament_diameter", "filament_diameter"),
    ("max_print_height", "printer_height"),
    ("max_layer_z", "print_height"),
    ("first_layer_height", "first_layer_height"),
    ("total_layer_count", "layer_count"),
    ("travel_speed", "travel_speed"),
];

pub(super) const PATTERNS: Turn = Turn::Word(&[
    ("grid", "grid"),
    ("rectilinear", "lines"),
    ("alignedrectilinear", "lines"),
    ("aligned-rectilinear", "lines"),
    ("line", "lines"),
    ("monotonic", "lines"),
    ("triangles", "triangles"),
    ("stars", "triangles"),
    ("tri-hexagon", "triangles"),
    ("gyroid", "gyroid"),
    ("honeycomb", "honeycomb"),
    ("3dhoneycomb", "honeycomb"),
    ("concentric", "concentric"),
]);

pub(super) const SEAMS: Turn = Turn::Word(&[
    ("aligned", "aligned"),
    ("rear", "rear"),
    ("back", "rear"),
    ("nearest", "nearest"),
    ("random", "random"),
]);

pub(super) const FLAVORS: Turn = Turn::Word(&[
    ("marlin", "marlin"),
    ("marlin2", "marlin"),
    ("marlinfirmware", "marlin"),
    ("klipper", "klipper"),
    ("reprapfirmware", "reprap"),
    ("repetier", "repetier"),
]);

/// Lines laid in one direction; other patterns of tops are straight lines here as well.
pub(super) const MONOTONIC: Turn = Turn::Is(&["monotonic", "monotoniclines", "monotonicline"]);

const ARCS: Turn = Turn::Is(&["emit_center"]);

const ROWS: &[Row] = &[
    ("layer_height", "layers.height", Turn::Number),
    ("perimeters", "walls.count", Turn::Number),
    ("top_solid_layers", "skin.top_layers", Turn::Number),
    ("bottom_solid_layers", "skin.bottom_layers", Turn::Number),
    ("fill_density", "infill.density", Turn::Percent),
    ("fill_pattern", "infill.pattern", PATTERNS),
    ("seam_position", "seam.position", SEAMS),
    ("elefant_foot_compensation", "first_layer.elephant_foot", Turn::Number),
    ("nozzle_diameter", "printer.nozzle_diameter", Turn::Number),
    ("max_print_height", "printer.height", Turn::Number),
    ("complete_objects", "print.sequence", Turn::Word(&[("0", "by_layer"), ("1", "by_object")])),
    ("extruder_clearance_radius", "printer.extruder_clearance_radius", Turn::Number),
    ("extruder_clearance_height", "printer.extruder_clearance_height", Turn::Number),
    ("gcode_flavor", "printer.flavor", FLAVORS),
    ("start_gcode", "printer.start_gcode", Turn::Code(NAMES)),
    ("end_gcode", "printer.end_gcode", Turn::Code(NAMES)),
    ("machine_max_feedrate_x", "printer.max_speed_xy", Turn::Number),
    ("machine_max_feedrate_z", "printer.max_speed_z", Turn::Number),
    ("machine_max_feedrate_e", "printer.max_speed_e", Turn::Number),
    ("machine_max_acceleration_retracting", "printer.retract_acceleration", Turn::Number),
    ("machine_max_acceleration_z", "printer.z_acceleration", Turn::Number),
    ("filament_type", "filament.material", Turn::Text),
    ("filament_diameter", "filament.diameter", Turn::Number),
    ("filament_density", "filament.density", Turn::Number),
    ("filament_cost", "filament.cost_per_kg", Turn::Number),
    ("temperature", "filament.nozzle_temp", Turn::Number),
    ("first_layer_temperature", "filament.first_layer_nozzle_temp", Turn::Number),
    ("bed_temperature", "filament.bed_temp", Turn::Number),
    ("first_layer_bed_temperature", "filament.first_layer_bed_temp", Turn::Number),
    ("bridge_fan_speed", "filament.bridge_fan_speed", Turn::Percent),
    ("disable_fan_first_layers", "filament.fan_first_layers", Turn::Number),
    ("retract_length", "retraction.length", Turn::Number),
    ("retract_speed", "retraction.speed", Turn::Number),
    ("retract_lift", "retraction.z_hop", Turn::Number),
    ("retract_before_travel", "retraction.min_travel", Turn::Number),
    ("perimeter_speed", "speed.inner_wall", Turn::Number),
    ("infill_speed", "speed.infill", Turn::Number),
    ("bridge_speed", "speed.bridge", Turn::Number),
    ("gap_fill_speed", "speed.gap_fill", Turn::Number),
    ("support_material_speed", "speed.support", Turn::Number),
    ("ironing_speed", "speed.ironing", Turn::Number),
    ("travel_speed", "speed.travel", Turn::Number),
    ("travel_speed_z", "speed.travel_z", Turn::Number),
    ("support_material_xy_spacing", "support.gap_xy", Turn::Number),
    ("support_material_contact_distance", "support.gap_z", Turn::Number),
    ("support_material_interface_layers", "support.interface_layers", Turn::Number),
    ("brim_width", "adhesion.brim.width", Turn::Number),
    ("brim_separation", "adhesion.brim.gap", Turn::Number),
    ("skirt_distance", "adhesion.skirt.distance", Turn::Number),
    ("min_skirt_length", "adhesion.skirt.min_length", Turn::Number),
    ("raft_contact_distance", "adhesion.raft.gap", Turn::Number),
    ("perimeter_acceleration", "acceleration.inner_wall", Turn::Number),
    ("external_perimeter_acceleration", "acceleration.outer_wall", Turn::Number),
    ("infill_acceleration", "acceleration.infill", Turn::Number),
    ("solid_infill_acceleration", "acceleration.solid_infill", Turn::Number),
    ("top_solid_infill_acceleration", "acceleration.top_skin", Turn::Number),
    ("bridge_acceleration", "acceleration.bridge", Turn::Number),
    ("first_layer_acceleration", "acceleration.first_layer", Turn::Number),
    ("slowdown_below_layer_time", "cooling.min_layer_time", Turn::Number),
    ("min_print_speed", "cooling.min_speed", Turn::Number),
    ("fan_below_layer_time", "cooling.fan_below_layer_time", Turn::Number),
    ("full_fan_speed_layer", "filament.fan_full_layer", Turn::Number),
    ("xy_size_compensation", "walls.horizontal_expansion", Turn::Number),
    ("bridge_flow_ratio", "skin.bridge_flow", Turn::Number),
    ("solid_infill_below_area", "infill.solid_below_area", Turn::Number),
    ("infill_overlap", "infill.overlap", Turn::Share),
    ("infill_anchor_max", "infill.anchor_max", Turn::Number),
    ("retract_length_toolchange", "retraction.tool_change_length", Turn::Number),
    ("wipe", "retraction.wipe", Turn::Switch),
    ("spiral_vase", "layers.spiral_vase", Turn::Switch),
    ("ironing", "ironing.enabled", Turn::Switch),
    ("ironing_flowrate", "ironing.flow", Turn::Percent),
    ("ironing_spacing", "ironing.spacing", Turn::Number),
    ("top_fill_pattern", "skin.monotonic", MONOTONIC),
    ("arc_fitting", "gcode.arc_fitting", ARCS),
];

const FAN: FanNames =
    FanNames { always: "fan_always_on", least: "min_fan_speed", most: "max_fan_speed", automatic: "cooling" };

/// (name, path, name of what it may be a share of).
const RELATIVE: &[Relative] = &[
    ("first_layer_height", "layers.first_height", "layer_height"),
    ("external_perimeter_speed", "speed.outer_wall", "perimeter_speed"),
    ("solid_infill_speed", "speed.solid_infill", "infill_speed"),
    ("top_solid_infill_speed", "speed.top_skin", "solid_infill_speed"),
    ("support_material_interface_speed", "speed.support_interface", "support_material_speed"),
    ("first_layer_speed", "first_layer.speed", ""),
    ("perimeter_extrusion_width", "walls.width", "layer_height"),
    ("first_layer_extrusion_width", "first_layer.line_width", "first_layer_height"),
    ("support_material_extrusion_width", "support.line_width", "layer_height"),
];

/// What a file says of itself and nobody prints.
const ASIDE: &[&str] = &[
    "inherits",
    "printer_settings_id",
    "print_settings_id",
    "filament_settings_id",
    "filament_colour",
    "notes",
];

/// The pairs of an .ini file, or of the comments at the end of G-code; `None` if it is neither.
pub(super) fn pairs(text: &str) -> Option<Values> {
    let block = text.split_once("; prusaslicer_config = begin").map(|(_, b)| b);
    let block = block.map(|b| b.split("; prusaslicer_config = end").next().unwrap_or(b));
    let pair = |line: &str| {
        let (key, value) = line.split_once('=')?;
        let key = key.trim();
        let is_name = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        is_name.then(|| (key.to_owned(), value.trim().to_owned()))
    };
    let found: Values = match block {
        Some(block) => comment_pairs(block.lines()),
        None => text.lines().filter_map(pair).collect(),
    };
    let known = found.keys().filter(|k| ROWS.iter().any(|(key, ..)| key == k)).count();
    (block.is_some() || known >= 2).then_some(found)
}

pub(super) fn import(mut found: Values) -> Imported {
    let mut out = Collector::new();
    let brim_width = found.get("brim_width").and_then(|text| number(first_of(text)));
    take_width("perimeter_extrusion_width", "extrusion_width", &mut found, &mut out);
    take_automatic_widths(&mut found, &mut out);
    take_fan(&FAN, &mut found, &mut out);
    take_flow_limit(&mut found, &mut out);
    take_all(ROWS, RELATIVE, &mut found, &mut out);
    take_thumbnails(&mut found, &mut out);
    take_accelerations(&mut found, &mut out);
    if let Some(text) = found.remove("bed_shape") {
        take_bed("bed_shape", &text, &mut out);
    }
    if let Some(text) = found.remove("gcode_label_objects") {
        out.map(
            "gcode_label_objects",
            &text,
            "printer.label_objects",
            Value::from(!["0", "disabled"].contains(&&*text)),
        );
    }
    take_supports("support_material", &mut found, &mut out);
    take_bed_only("support_material_buildplate_only", &mut found, &mut out);
    take_threshold("support_material_threshold", &mut found, &mut out);
    take_adhesion(brim_width, &mut found, &mut out);
    leave_rest(found, ASIDE, &mut out);
    out.finish("prusaslicer")
}

/// Widths of 0 are derived from the nozzle there: (name, path, widths of the nozzle).
const AUTOMATIC: [(&str, &str, f64); 2] = [
    ("perimeter_extrusion_width", "walls.width", 1.125),
    ("support_material_extrusion_width", "support.line_width", 1.0),
];

/// Takes over widths of 0 as what they come to, if the profile knows the nozzle.
fn take_automatic_widths(found: &mut Values, out: &mut Collector) {
    let number_of = |key: &str, found: &Values| found.get(key).and_then(|text| number(first_of(text)));
    let Some(nozzle) = number_of("nozzle_diameter", found) else { return };
    for (key, path, share) in AUTOMATIC {
        if number_of(key, found) != Some(0.0) {
            continue;
        }
        if let Some(text) = found.remove(key) {
            let why = format!("chosen there: {share} times the nozzle");
            out.change(key, &text, path, Value::from(thousandths(share * nozzle)), &why);
        }
    }
}

/// One kind of base layer here; a raft goes before a brim, a brim before a skirt.
fn take_adhesion(brim_width: Option<f64>, found: &mut Values, out: &mut Collector) {
    let mut taken = false;
    let mut settle = |key: &str, text: &str, kind: &str, out: &mut Collector| {
        let is_first = !std::mem::replace(&mut taken, true);
        match is_first {
            true => out.map(key, text, "adhesion.kind", Value::from(kind)),
            false => out.leave(key, text, "only one kind of base layer at a time; left out"),
        }
        is_first
    };
    if let Some(text) = found.remove("raft_layers") {
        let count = number(first_of(&text)).unwrap_or(0.0);
        if count > 0.0 && settle("raft_layers", &text, "raft", out) {
            out.map("raft_layers", &text, "adhesion.raft.layers", Value::from(count));
        }
    }
    if let Some(text) = found.remove("brim_type") {
        let side = brim_side(&text);
        if let (Some(side), false) = (side, brim_width == Some(0.0))
            && settle("brim_type", &text, "brim", out)
        {
            out.map("brim_type", &text, "adhesion.brim.side", Value::from(side));
        }
    }
    if let Some(text) = found.remove("skirts") {
        match number(first_of(&text)) {
            Some(loops) if loops > 0.0 => {
                if settle("skirts", &text, "skirt", out) {
                    out.map("skirts", &text, "adhesion.skirt.loops", Value::from(loops));
                }
            }
            _ => {
                settle("skirts", &text, "none", out);
            }
        }
    }
}
