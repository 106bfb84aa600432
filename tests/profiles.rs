//! The profiles that ship: each resolves against the settings, names its source, and makes files that
//! stay on its bed and begin and end as its printer wants.

mod common;

use std::fs;
use std::path::Path;

use foothold::gcode::read::Reader;
use foothold::gcode::{BedShape, Flavor, assemble};
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel};
use foothold::polygon::{DVec2, dvec2};
use foothold::settings::Settings;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Profile {
    id: String,
    name: String,
    #[serde(default)]
    vendor: String,
    #[serde(default)]
    usb: String,
    #[serde(default)]
    usb_note: String,
    #[serde(default)]
    sources: Vec<String>,
    #[serde(default)]
    note: String,
    settings: serde_json::Value,
}

fn profiles(kind: &str) -> Vec<Profile> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles").join(kind);
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("the folder is there").flatten().map(|e| e.path()).collect();
    files.sort();
    let read = |path: &Path| {
        let text = fs::read_to_string(path).expect("readable");
        let found: Profile =
            serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(Some(found.id.as_str()), path.file_stem().and_then(|s| s.to_str()));
        found
    };
    files.iter().map(|p| read(p)).collect()
}

fn settings(layers: &[&Profile], sets: &[&str]) -> Settings {
    let files: Vec<String> = layers.iter().map(|p| p.settings.to_string()).collect();
    let name: Vec<&str> = layers.iter().map(|p| p.id.as_str()).collect();
    Settings::resolve(files.iter().map(String::as_str), sets.iter().copied())
        .unwrap_or_else(|e| panic!("{name:?}: {e}"))
}

#[test]
fn each_profile_names_its_source_and_all_combinations_resolve() {
    let (printers, materials, qualities) =
        (profiles("printers"), profiles("materials"), profiles("qualities"));
    assert!(printers.len() >= 13 && materials.len() >= 6 && qualities.len() >= 3);
    for p in printers.iter().chain(&materials) {
        assert!(!p.sources.is_empty() && p.sources.iter().all(|s| s.starts_with("https://")), "{}", p.id);
    }
    for p in &printers {
        assert!(["ok", "limited", "none"].contains(&p.usb.as_str()) && !p.usb_note.is_empty(), "{}", p.id);
        assert!(!p.vendor.is_empty() && !p.name.is_empty(), "{}", p.id);
        for m in &materials {
            for q in &qualities {
                let all = settings(&[p, m, q], &[]);
                foothold::gcode::check_templates(&all.printer).unwrap_or_else(|e| panic!("{}: {e}", p.id));
            }
        }
    }
    assert!(qualities.iter().all(|q| !q.note.is_empty()));
}

/// What a profile says stays within what the printer and the material can take.
#[test]
fn temperatures_and_speeds_keep_the_limits() {
    for m in &profiles("materials") {
        let f = settings(&[m], &[]).filament;
        for temp in [f.nozzle_temp, f.first_layer_nozzle_temp] {
            assert!((f.nozzle_temp_range[0]..=f.nozzle_temp_range[1]).contains(&temp), "{}", m.id);
        }
        for temp in [f.bed_temp, f.first_layer_bed_temp] {
            assert!((f.bed_temp_range[0]..=f.bed_temp_range[1]).contains(&temp), "{}", m.id);
        }
    }
    for p in &profiles("printers") {
        let s = settings(&[p], &[]);
        assert!(
            s.speed.travel <= s.printer.max_speed_xy && s.retraction.speed <= s.printer.max_speed_e,
            "{}",
            p.id
        );
        assert!(s.layers.height < s.printer.nozzle_diameter, "{}", p.id);
    }
}

/// The G-code of a model with these settings.
fn sliced(bytes: &[u8], settings: Settings) -> String {
    let model = NamedModel::new("part", load(bytes).expect("a good mesh"));
    let mut job = Job::new(&[model], settings, &|| 0.0).expect("fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers");
    String::from_utf8(assemble(&finished.joined, &range.texts)).expect("UTF-8")
}

/// Every bead lies on the bed, half its width included, outside the forbidden zones and not too high;
/// and every move ends where the head can go.
#[track_caller]
fn assert_stays_on_bed(name: &str, text: &str, settings: &Settings) {
    let printer = &settings.printer;
    let mut beads = 0;
    // Homing is where the firmware says; the first move after it sets X, Y and Z.
    for step in Reader::new(text.as_bytes()) {
        let [x, y, z] = step.to;
        assert!(z <= printer.height + 1e-9, "{name}: line {} goes up to {z}", step.line);
        if !step.lays_bead() {
            continue;
        }
        beads += 1;
        let to = dvec2(x, y);
        let half = step.width.unwrap_or(0.4) / 2.0;
        let bed = printer.bed();
        let centre = (bed.min + bed.max) / 2.0;
        let outward = match printer.bed_shape {
            BedShape::Rectangle => (to - centre).signum() * half,
            BedShape::Round => (to - centre).normalize_or_zero() * half,
        };
        assert!(printer.is_on_bed(to + outward), "{name}: line {} prints at {to}", step.line);
        let inside =
            |&[x0, y0, x1, y1]: &[f64; 4]| to.cmpgt(dvec2(x0, y0)).all() && to.cmplt(dvec2(x1, y1)).all();
        assert!(!printer.forbidden.iter().any(inside), "{name}: line {} prints at {to}", step.line);
    }
    assert!(beads > 100, "{name}: only {beads} beads");
}

fn sized_cube() -> Vec<u8> {
    write_binary(&common::cube(10.0))
}

#[test]
fn each_printer_prints_a_cube_on_its_bed() {
    let materials = profiles("materials");
    let pla = materials.iter().find(|m| m.id == "pla").expect("PLA");
    for p in &profiles("printers") {
        let all = settings(&[p, pla], &[]);
        let text = sliced(&sized_cube(), all.clone());
        assert_stays_on_bed(&p.id, &text, &all);
        assert_begins_and_ends_rightly(&p.id, &text, &all);
        assert_moves_safely(&p.id, &text);
    }
}

#[test]
fn each_printer_prints_a_real_model_on_its_bed() {
    let Some(dir) = common::models_dir() else { return };
    let bytes = fs::read(dir.join("angle_block_mm.stl")).expect("a model");
    for p in &profiles("printers") {
        let all = settings(&[p], &["layers.height=0.28"]);
        let text = sliced(&bytes, all.clone());
        assert_stays_on_bed(&p.id, &text, &all);
        assert_moves_safely(&p.id, &text);
    }
}

/// Lines that must be there, in this order; the documents are named in the profiles.
fn expected(id: &str) -> &'static [&'static str] {
    match id {
        // marlinfw.org: M190 waits for the bed, G28 homes, M109 waits for the nozzle; M420 S1 takes the
        // stored mesh after homing, which switches it off.
        "ender3" | "neptune4" => {
            &["M140 S60", "M190 S60", "G28", "M109 S215", "M104 S0", "M140 S0", "M84 X Y E"]
        }
        "sv06" | "kobra2" => {
            &["M140 S60", "M190 S60", "G28", "M420 S1", "M109 S215", "M104 S0", "M140 S0", "M84 X Y E"]
        }
        "delta" => &["M140 S60", "M190 S60", "G28", "M109 S215", "M104 S0", "M140 S0", "G28", "M84"],
        // Creality's macros for K1 and its kin heat, home and level; END_PRINT undoes it.
        "k1" | "ender3_v3" => {
            &["START_PRINT EXTRUDER_TEMP=215 BED_TEMP=60", "M190 S60", "M109 S215", "END_PRINT"]
        }
        // docs.vorondesign.com: PRINT_START homes and levels the gantry, PRINT_END switches off.
        "voron24" => &["M190 S60", "PRINT_START", "M109 S215", "PRINT_END"],
        // help.prusa3d.com: G28 W homes without levelling, G80 probes the mesh.
        "mk3s" => &["M190 S60", "M109 S215", "G28 W", "G80", "M104 S0", "M140 S0", "M84"],
        // help.prusa3d.com, Buddy firmware: M109 R170 waits for cooling too, G29 probes the mesh.
        "mk4" | "mini" => &["M190 S60", "M109 R170", "G28", "G29", "M109 S215", "M104 S0", "M140 S0", "M84"],
        "a1_mini" | "p1s" => &["M190 S60", "G28", "M109 S215", "M140 S0", "M104 S0", "M106 S0", "M84"],
        other => panic!("{other}: say here how its files begin and end"),
    }
}

#[track_caller]
fn assert_begins_and_ends_rightly(id: &str, text: &str, settings: &Settings) {
    let commands: Vec<&str> = text
        .lines()
        .map(|l| l.split(';').next().unwrap_or_default().trim())
        .filter(|l| !l.is_empty())
        .collect();
    let mut rest = &commands[..];
    for what in expected(id) {
        let at = rest
            .iter()
            .position(|c| c == what)
            .unwrap_or_else(|| panic!("{id}: {what} is missing or out of order"));
        rest = &rest[at + 1..];
    }
    // Nothing is extruded before the nozzle is hot.
    let hot = text.lines().position(|l| l.starts_with("M109 S215")).expect("heats");
    let first = Reader::new(text.as_bytes()).find(|m| m.filament_mm > 0.0).expect("extrudes");
    assert!(first.line as usize > hot + 1, "{id}");
    // Klipper's macros switch off; elsewhere the file does.
    let last: Vec<&str> = commands.iter().rev().take(12).copied().collect();
    let is_off = last.iter().any(|c| c.starts_with("END_PRINT") || c.starts_with("PRINT_END"))
        || (last.contains(&"M104 S0") && last.contains(&"M140 S0"));
    assert!(is_off, "{id}: {last:?}");
    let is_klipper = settings.printer.flavor == Flavor::Klipper;
    assert_eq!(is_klipper, text.contains("SET_VELOCITY_LIMIT"), "{id}");
}

/// The lowest that the head may travel before the first layer, mm.
const LOWEST_FIRST_TRAVEL: f64 = 2.0;

/// What any owner asks of the lines around the print, whatever the printer: home before the first move,
/// never across the bed at the height of a layer, fill the nozzle; then pull back, rise before going away,
/// and leave heaters, fan and motors off.
#[track_caller]
fn assert_moves_safely(id: &str, text: &str) {
    let code = |line: &str| line.split(';').next().unwrap_or_default().trim().to_owned();
    let lines: Vec<String> = text.lines().map(code).collect();
    let part = text.lines().position(|l| l == ";LAYER_CHANGE").expect("layers");
    let is_move = |l: &String| l.starts_with("G0 ") || l.starts_with("G1 ");
    let homes = |l: &String| ["G28", "START_PRINT", "PRINT_START"].iter().any(|word| l.starts_with(word));
    let homed = lines.iter().position(homes).expect("homes");
    assert!(lines.iter().position(is_move).is_some_and(|first| first > homed), "{id} moves before it homes");

    let before: Vec<_> =
        Reader::new(text.as_bytes()).take_while(|step| (step.line as usize) <= part).collect();
    for step in before.iter().filter(|step| step.moves_in_plane() && step.filament_mm <= 0.0) {
        assert!(step.to[2] >= LOWEST_FIRST_TRAVEL, "{id}: line {} travels at {}", step.line, step.to[2]);
    }
    let primed: f64 = before.iter().map(|step| step.filament_mm).sum();
    // The macro of K1 draws a line of its own.
    assert!(primed > 2.0 || id == "k1", "{id}: {primed} mm of filament before the part");

    let steps: Vec<_> = Reader::new(text.as_bytes()).collect();
    let last = steps.iter().rposition(|step| step.filament_mm > 0.0 && step.moves_in_plane()).expect("beads");
    let after = &steps[last + 1..];
    let pulled: f64 = after.iter().map(|step| step.filament_mm).sum();
    assert!(pulled < 0.0 && after[0].filament_mm < 0.0, "{id}: {pulled} mm after the last bead");
    let top = steps[last].to[2];
    for step in after.iter().filter(|step| step.moves_in_plane()) {
        assert!(step.from[2] >= top + 2.0, "{id}: line {} leaves at {}", step.line, step.from[2]);
    }
    let end = &lines[steps[last].line as usize..];
    let says = |word: &str| end.iter().any(|l| l == word || l.starts_with(&format!("{word} ")));
    let by_macro = says("END_PRINT") || says("PRINT_END");
    assert!(by_macro || (says("M84") && (says("M107") || says("M106 S0"))), "{id}: {end:?}");
}

/// A disc nearly as wide as a round bed, and a cube 1 mm beside a zone where nothing may be printed.
#[test]
fn base_layers_keep_off_what_is_no_bed() {
    let printers = profiles("printers");
    let of = |id: &str| printers.iter().find(|p| p.id == id).expect("a printer");
    let disc = write_binary(&common::cylinder(88.5, 0.6, 120));
    for kind in ["skirt", "brim", "raft", "teeth"] {
        let kind = &format!("adhesion.kind={kind}");
        let round = settings(&[of("delta")], &[kind, "printer.prime_length=0"]);
        assert_stays_on_bed(kind, &sliced(&disc, round.clone()), &round);
        // The cube stands at 105 to 115.
        let zoned = settings(&[of("ender3")], &[kind, "printer.forbidden=[[90,10,104,220]]"]);
        assert_stays_on_bed(kind, &sliced(&sized_cube(), zoned.clone()), &zoned);
    }
}

/// On a delta the origin is the centre, and corners of the square around the bed are no place to print.
#[test]
fn the_delta_prints_around_its_origin() {
    let printers = profiles("printers");
    let delta = printers.iter().find(|p| p.id == "delta").expect("a delta");
    let all = settings(&[delta], &[]);
    assert!(all.printer.is_on_bed(DVec2::ZERO) && !all.printer.is_on_bed(dvec2(80.0, 80.0)));
    let text = sliced(&sized_cube(), all);
    let beads: Vec<DVec2> = Reader::new(text.as_bytes())
        .filter(|m| m.lays_bead() && m.layer > 2)
        .map(|m| dvec2(m.to[0], m.to[1]))
        .collect();
    assert!(beads.iter().all(|p| p.abs().max_element() < 5.0) && beads.iter().any(|p| p.x < -4.0));
}
