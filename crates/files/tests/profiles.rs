//! Ten profiles written by hand after the formats' documents (`tests/profiles/`): right values and honest
//! lists.

use std::io::{Cursor, Write};
use std::path::Path;

use foothold_files::{FileError, Imported, import};
use serde_json::{Value, json};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

fn file(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/profiles").join(name);
    std::fs::read(path).expect("a fixture")
}

fn imported(name: &str) -> Imported {
    import(&file(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// A .curaprofile of these files.
fn cura(names: &[&str]) -> Imported {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for name in names {
        zip.start_file(name.trim_end_matches(".inst.cfg"), SimpleFileOptions::default()).expect("in memory");
        zip.write_all(&file(name)).expect("in memory");
    }
    import(&zip.finish().expect("in memory").into_inner()).expect("a good profile")
}

fn keys(list: &[foothold_files::import::Entry]) -> Vec<&str> {
    let mut keys: Vec<&str> = list.iter().map(|e| e.key.as_str()).collect();
    keys.dedup();
    keys
}

fn why<'a>(found: &'a Imported, key: &str) -> &'a str {
    let entry = found
        .changed
        .iter()
        .find(|e| e.key == key)
        .unwrap_or_else(|| panic!("{key} is not among the changed"));
    entry.why.as_deref().unwrap_or_default()
}

#[track_caller]
fn assert_settings(found: &Imported, expected: Value) {
    assert_eq!(
        found.settings,
        expected,
        "{}",
        serde_json::to_string_pretty(&found.settings).unwrap_or_default()
    );
}

#[test]
fn widths_that_prusaslicer_chooses_follow_the_nozzle() {
    let text = "nozzle_diameter = 0.6\nextrusion_width = 0\nperimeter_extrusion_width = 0\n\
                support_material_extrusion_width = 0\nlayer_height = 0.3\n";
    let found = import(text.as_bytes()).expect("a profile");
    assert_settings(
        &found,
        json!({
            "printer": { "nozzle_diameter": 0.6 }, "layers": { "height": 0.3 },
            "walls": { "width": 0.675 }, "support": { "line_width": 0.6 }
        }),
    );
    assert_eq!(why(&found, "perimeter_extrusion_width"), "chosen there: 1.125 times the nozzle");
}

#[test]
fn no_limit_of_the_flow_stays_none() {
    let found = import(b"layer_height = 0.2\nperimeters = 2\nfilament_max_volumetric_speed = 0\n")
        .expect("a profile");
    assert_eq!(found.settings["filament"], json!({ "max_volumetric_speed": 1000.0 }));
    assert_eq!(why(&found, "filament_max_volumetric_speed"), "0 is no limit there");
}

#[test]
fn prusa_print() {
    let found = imported("prusa_print.ini");
    assert_eq!(found.slicer, "prusaslicer");
    let mut expected = json!({
        "layers": { "height": 0.15, "first_height": 0.2 },
        "walls": { "count": 2, "width": 0.45 },
        "skin": { "top_layers": 7, "bottom_layers": 5 },
        "infill": { "density": 0.2 },
        "seam": { "position": "rear" },
        "speed": { "outer_wall": 30.0, "inner_wall": 60.0, "infill": 80.0, "solid_infill": 80.0, "top_skin": 40.0 },
        "first_layer": { "speed": 20.0, "line_width": 0.42 },
        "support": { "method": "grid", "everywhere": false, "overhang_angle_deg": 35.0 },
        "adhesion": {
            "kind": "brim", "brim": { "width": 5.0, "side": "outer" }, "skirt": { "distance": 3.0 }
        }
    });
    // A pattern is taken over as soon as there is one of that name.
    if let Some(pattern) = found.settings["infill"].get("pattern") {
        expected["infill"]["pattern"] = pattern.clone();
        assert_eq!(pattern, "gyroid");
    } else {
        assert!(why(&found, "fill_pattern").contains("\"gyroid\" is not among"));
    }
    assert_settings(&found, expected);
    assert_eq!(keys(&found.unknown), ["wipe_tower"]);
    assert_eq!(why(&found, "external_perimeter_speed"), "50 % of 60");
    assert_eq!(why(&found, "skirts"), "only one kind of base layer at a time; left out");
}

#[test]
fn prusa_printer() {
    let found = imported("prusa_printer.ini");
    assert_settings(
        &found,
        json!({
            "printer": {
                "bed_size": [250.0, 210.0], "origin": "corner", "bed_shape": "rectangle", "height": 210.0,
                "nozzle_diameter": 0.4, "flavor": "marlin", "max_speed_xy": 200.0, "acceleration": 1250.0,
                "label_objects": true,
                "start_gcode": "M104 S{first_layer_nozzle_temp} ; hot\nM190 S{first_layer_bed_temp}\n\
                                M109 S{first_layer_nozzle_temp}\nG28 W\nG80\n"
            },
            "retraction": { "length": 0.8, "speed": 35.0, "z_hop": 0.4, "min_travel": 1.0 }
        }),
    );
    assert!(why(&found, "end_gcode").starts_with("its placeholder \"if layer_z < max_print_height\""));
    assert_eq!(why(&found, "machine_max_acceleration_extruding"), "the first of several values");
    assert_eq!(keys(&found.unknown), ["silent_mode"]);
}

#[test]
fn prusa_filament() {
    let found = imported("prusa_filament.ini");
    assert_settings(
        &found,
        json!({ "filament": {
            "material": "PETG", "diameter": 1.75, "density": 1.27, "cost_per_kg": 27.82, "max_volumetric_speed": 8.0,
            "nozzle_temp": 240.0, "first_layer_nozzle_temp": 230.0, "bed_temp": 90.0, "first_layer_bed_temp": 85.0,
            "fan_speed": 0.5, "bridge_fan_speed": 0.5, "fan_first_layers": 3
        } }),
    );
    assert!(found.changed.is_empty() && found.unknown.is_empty());
}

#[test]
fn prusa_gcode() {
    let found = imported("prusa_gcode.gcode");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.3 }, "walls": { "count": 4 }, "infill": { "density": 1.0, "pattern": "lines" },
            "printer": { "bed_size": [180.0, 177.2], "origin": "center", "bed_shape": "round" },
            "adhesion": { "kind": "none" }
        }),
    );
    assert_eq!(why(&found, "temperature"), "filament.nozzle_temp: outside 0 to 500; left as it is");
}

#[test]
fn orca_process() {
    let found = imported("orca_process.json");
    assert_eq!(found.slicer, "orcaslicer");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.2, "first_height": 0.25 }, "walls": { "count": 4, "width": 0.45 },
            "skin": { "top_layers": 6, "bottom_layers": 4 }, "infill": { "density": 0.12, "pattern": "grid" },
            "seam": { "position": "rear" }, "printer": { "nozzle_diameter": 0.4 },
            "speed": { "outer_wall": 120.0, "inner_wall": 200.0, "infill": 250.0 },
            "first_layer": { "speed": 40.0, "line_width": 0.5, "elephant_foot": 0.1 },
            "support": { "method": "grid", "overhang_angle_deg": 60.0, "everywhere": true },
            "adhesion": { "kind": "brim", "brim": { "width": 5.0, "side": "outer" } }
        }),
    );
    assert_eq!(keys(&found.unknown), ["support_type"]);
    assert_eq!(why(&found, "inherits"), "values of the profile it builds on are not in the file");
    assert_eq!(why(&found, "initial_layer_line_width"), "125 % of 0.4");
}

#[test]
fn orca_machine() {
    let found = imported("orca_machine.json");
    assert_settings(
        &found,
        json!({
            "printer": {
                "bed_size": [300.0, 300.0], "origin": "corner", "bed_shape": "rectangle", "height": 260.0,
                "nozzle_diameter": 0.6, "flavor": "klipper", "max_speed_xy": 300.0,
                "start_gcode": "M190 S{first_layer_bed_temp}\nPRINT_START EXTRUDER={first_layer_nozzle_temp}\n"
            },
            "retraction": { "length": 0.5, "speed": 30.0, "z_hop": 0.2, "min_travel": 2.0 }
        }),
    );
    assert!(why(&found, "machine_end_gcode").starts_with("its placeholder \"total_toolchanges\""));
    assert_eq!(keys(&found.unknown), ["single_extruder_multi_material"]);
}

#[test]
fn orca_filament() {
    let found = imported("orca_filament.json");
    assert_settings(
        &found,
        json!({ "filament": {
            "material": "ASA", "nozzle_temp": 255.0, "first_layer_nozzle_temp": 260.0, "bed_temp": 100.0,
            "first_layer_bed_temp": 105.0, "density": 1.07, "cost_per_kg": 25.0, "max_volumetric_speed": 18.0,
            "fan_speed": 0.3, "bridge_fan_speed": 0.5, "fan_first_layers": 3, "pressure_advance": 0.035,
            "nozzle_temp_range": [240.0, 280.0]
        } }),
    );
    assert_eq!(keys(&found.unknown), ["chamber_temperature"]);
}

#[test]
fn cura_quality_and_extruder() {
    let found = cura(&["cura_fine.inst.cfg", "cura_extruder.inst.cfg"]);
    assert_eq!(found.slicer, "cura");
    let mut settings = found.settings.clone();
    // Patterns and seams are taken over as soon as there are some of their names.
    let group = settings.as_object_mut().expect("settings");
    group.remove("seam");
    assert_eq!(
        settings,
        json!({
            "layers": { "height": 0.3 }, "walls": { "count": 2, "width": 0.42 },
            "infill": { "density": 0.18, "pattern": "lines" }, "speed": { "infill": 55.0 },
            "filament": {
                "nozzle_temp": 205.0, "first_layer_nozzle_temp": 205.0, "bed_temp": 70.0, "first_layer_bed_temp": 70.0,
                "fan_first_layers": 2
            },
            "first_layer": { "elephant_foot": 0.2 },
            "support": { "method": "grid", "everywhere": false },
            "adhesion": { "kind": "brim", "brim": { "width": 6.0 } }
        })
    );
    assert_eq!(why(&found, "retraction_amount"), "a formula; left as it is");
    assert_eq!(why(&found, "retraction_hop"), "switched off in the profile");
    assert_eq!(why(&found, "line_width"), "wall_line_width goes before it");
    assert_eq!(keys(&found.unknown), ["zig_zaggify_infill"]);
}

#[test]
fn cura_machine() {
    let found = cura(&["cura_machine.inst.cfg"]);
    assert_settings(
        &found,
        json!({ "printer": {
            "bed_size": [200.0, 200.0], "height": 300.0, "bed_shape": "round", "origin": "center", "flavor": "reprap",
            "start_gcode": "G28\nM109 S{first_layer_nozzle_temp}\nG1 Z10 F3000\n", "end_gcode": "M104 S0\n"
        } }),
    );
}

/// Cura's users state thicknesses.
#[test]
fn cura_thicknesses() {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("fine", SimpleFileOptions::default()).expect("in memory");
    let text = "[general]\nversion = 4\n\n[values]\nlayer_height = 0.16\nline_width = 0.4\nwall_thickness = 1.2\n\
                top_bottom_thickness = 0.8\ntop_layers = 7\nxy_offset = -0.03\nacceleration_enabled = False\n\
                acceleration_print = 900\n";
    zip.write_all(text.as_bytes()).expect("in memory");
    let found = import(&zip.finish().expect("in memory").into_inner()).expect("a good profile");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.16 },
            "walls": { "count": 3, "width": 0.4, "horizontal_expansion": -0.03 },
            "skin": { "top_layers": 7, "bottom_layers": 5 }
        }),
    );
    assert_eq!(why(&found, "wall_thickness"), "in steps of the line width, 0.4 mm");
    assert_eq!(why(&found, "acceleration_enabled"), "accelerations are the printer's own");
}

#[test]
fn cura_damaged() {
    let found = cura(&["cura_damaged.inst.cfg"]);
    assert_settings(&found, json!({ "skin": { "top_layers": 4 } }));
    assert_eq!(
        keys(&found.changed),
        ["infill_pattern", "infill_sparse_density", "layer_height", "machine_start_gcode", "wall_line_count"]
    );
}

/// What PrusaSlicer writes for its own defaults: the brim's type is there, its width is 0.
#[test]
fn prusa_defaults_have_a_skirt_and_no_brim() {
    let text = "brim_type = outer_only\nbrim_width = 0\nskirts = 1\nskirt_distance = 6\nraft_layers = 0\n\
                perimeter_extrusion_width = 0\nextrusion_width = 0.5\nlayer_height = 0.3\n";
    let found = import(text.as_bytes()).expect("a profile");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.3 }, "walls": { "width": 0.5 },
            "adhesion": { "kind": "skirt", "skirt": { "loops": 1, "distance": 6.0 } }
        }),
    );
    assert_eq!(why(&found, "extrusion_width"), "stands for the walls' width, which has no value of its own");
}

#[test]
fn fans_accelerations_and_switches_of_prusa() {
    let text = "cooling = 1\nfan_always_on = 0\nmin_fan_speed = 35\nmax_fan_speed = 100\n\
                slowdown_below_layer_time = 20\nmin_print_speed = 15\nfan_below_layer_time = 100\n\
                default_acceleration = 800\nmachine_max_acceleration_extruding = 1250,960\n\
                travel_acceleration = 0\nmachine_max_acceleration_travel = 1500\nperimeter_acceleration = 500\n\
                ironing = 1\nironing_flowrate = 20%\ninfill_overlap = 0.1\nspiral_vase = 0\nwipe = 1,1\n\
                top_fill_pattern = rectilinear\nthumbnails = 16x16,220x124\nthumbnails_format = QOI\n";
    let found = import(text.as_bytes()).expect("a profile");
    assert_settings(
        &found,
        json!({
            "filament": { "fan_speed": 0.0, "max_fan_speed": 1.0 },
            "cooling": { "min_layer_time": 20.0, "min_speed": 15.0, "fan_below_layer_time": 100.0 },
            "printer": { "acceleration": 800.0, "travel_acceleration": 1500.0 },
            "acceleration": { "inner_wall": 500.0 }, "ironing": { "enabled": true, "flow": 0.2 },
            "layers": { "spiral_vase": false }, "retraction": { "wipe": true }, "skin": { "monotonic": false },
            "gcode": { "thumbnails": "16x16/QOI, 220x124/QOI" }
        }),
    );
    assert_eq!(why(&found, "min_fan_speed"), "the fan rests on layers that take their time");
    assert_eq!(why(&found, "machine_max_acceleration_extruding"), "default_acceleration goes before it");
    assert_eq!(why(&found, "infill_overlap"), "a length, and a share here; left as it is");
    // Always on, and nothing slowed down.
    let text = "cooling = 0\nfan_always_on = 1\nmin_fan_speed = 40\nmax_fan_speed = 100\n\
                slowdown_below_layer_time = 20\nthumbnails = 32x32/JPG\nlayer_height = 0.2\ntemperature = 200\n";
    let found = import(text.as_bytes()).expect("a profile");
    assert_eq!(found.settings["filament"]["fan_speed"], 0.4);
    assert_eq!(found.settings["cooling"], json!({ "min_layer_time": 0.0 }));
    assert_eq!(why(&found, "max_fan_speed"), "automatic cooling is switched off");
    assert_eq!(why(&found, "thumbnails"), "only PNG and QOI are written; left as it is");
}

/// Whose settings `inspect` names in G-code, those `import` reads.
#[test]
fn gcode_of_orca_cura_and_our_own() {
    let orca = "; HEADER_BLOCK_START\n; HEADER_BLOCK_END\n; CONFIG_BLOCK_START\n; bed_exclude_area = 0x0,18x0,18x28,0x28\n\
                ; brim_type = outer_only\n; brim_width = 0\n; skirt_loops = 2\n; layer_height = 0.28\n\
                ; default_acceleration = 6000\n; sparse_infill_acceleration = 50%\n; enable_arc_fitting = 1\n\
                ; CONFIG_BLOCK_END\nG28\n; layer_height = 9\n";
    let found = import(orca.as_bytes()).expect("settings");
    assert_eq!(found.slicer, "orcaslicer");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.28 }, "adhesion": { "kind": "skirt", "skirt": { "loops": 2 } },
            "printer": { "forbidden": [[0.0, 0.0, 18.0, 28.0]], "acceleration": 6000.0 },
            "acceleration": { "infill": 3000.0 }, "gcode": { "arc_fitting": true }
        }),
    );

    let cura = ";FLAVOR:Marlin\nG28\n;End of Gcode\n;SETTING_3 {\"global_quality\": \"[general]\\\\nversion = 4\\\\n\\\\n[values]\\\\nlayer_hei\n\
                ;SETTING_3 ght = 0.16\\\\nadhesion_type = skirt\\\\n\\\\n\", \"extruder_quality\": [\"[general]\\\\n\n\
                ;SETTING_3 [values]\\\\nwall_line_count = 4\\\\nxy_offset = -0.05\\\\n\"]}\n";
    let found = import(cura.as_bytes()).expect("settings");
    assert_eq!(found.slicer, "cura");
    assert_settings(
        &found,
        json!({
            "layers": { "height": 0.16 }, "adhesion": { "kind": "skirt" },
            "walls": { "count": 4, "horizontal_expansion": -0.05 }
        }),
    );
    let cut = &cura.as_bytes()[..cura.len() - 5];
    assert!(matches!(import(cut).unwrap_err(), FileError::Malformed { .. }));

    let own = "; generated by Foothold 0.1.0\nG28\n; filament used [mm] = 12.3\n; adhesion.kind = teeth\n\
               ; gcode.thumbnails = \n; layers.height = 0.2\n; printer.bed_size = [256.0,256.0]\n\
               ; printer.start_gcode = G28\\nM109 S{nozzle_temp} ; hot\n; walls.count = 3\n; walls.colour = 7\n";
    let found = import(own.as_bytes()).expect("settings");
    assert_eq!(found.slicer, "foothold");
    assert_settings(
        &found,
        json!({
            "adhesion": { "kind": "teeth" }, "gcode": { "thumbnails": "" }, "layers": { "height": 0.2 },
            "printer": { "bed_size": [256.0, 256.0], "start_gcode": "G28\nM109 S{nozzle_temp} ; hot" },
            "walls": { "count": 3 }
        }),
    );
    assert_eq!(keys(&found.unknown), ["walls.colour"]);
}

#[test]
fn what_is_no_profile_is_refused() {
    assert_eq!(import(b"").unwrap_err(), FileError::Empty);
    assert_eq!(import(b"solid cube\nfacet").unwrap_err(), FileError::UnknownProfile);
    assert_eq!(import(b"{\"a\": 1}").unwrap_err(), FileError::UnknownProfile);
    assert!(matches!(import(b"{\"layer_height\": ").unwrap_err(), FileError::Malformed { .. }));
    assert!(matches!(
        import("[".repeat(100_000).replace('[', "{\"a\":").as_bytes()).unwrap_err(),
        FileError::Malformed { .. }
    ));
    assert!(matches!(import(b"\xff\xfel\0").unwrap_err(), FileError::Encoding { seems: "UTF-16" }));
    assert!(matches!(
        import(b"layer_height = 0.2\nnotes = caf\xe9").unwrap_err(),
        FileError::Encoding { .. }
    ));
}

/// Every path that rows name is a setting: none falls to the unknown.
#[test]
fn nothing_known_is_called_unknown() {
    for name in [
        "prusa_print.ini",
        "prusa_printer.ini",
        "prusa_filament.ini",
        "orca_process.json",
        "orca_machine.json",
        "orca_filament.json",
    ] {
        let found = imported(name);
        assert!(found.unknown.len() <= 1, "{name}: {:?}", keys(&found.unknown));
        assert!(found.mapped.len() >= 9, "{name}");
    }
}
