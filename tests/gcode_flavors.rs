//! What each firmware's documentation asks for, held against whole files.

mod common;

use foothold::gcode::{Flavor, ObjectLabels, assemble};
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;

/// Two cubes of 2 mm, labelled, with different accelerations and pressure advance.
fn file(flavor: Flavor, sets: &[&str]) -> String {
    let word = serde_json::to_string(&flavor).expect("a word");
    let own = [
        format!("printer.flavor={word}"),
        "printer.label_objects=true".to_owned(),
        "printer.travel_acceleration=1200".to_owned(),
        "printer.retract_acceleration=900".to_owned(),
        "filament.pressure_advance=0.04".to_owned(),
        "filament.fan_first_layers=3".to_owned(),
        "adhesion.kind=none".to_owned(),
        // Small layers are not slowed down, so that times are short.
        "cooling.min_layer_time=0".to_owned(),
    ];
    let sets = own.iter().map(String::as_str).chain(sets.iter().copied());
    let settings = Settings::resolve([], sets).expect("good settings");
    let bytes = write_binary(&common::cube(2.0));
    let model = |name: &str| NamedModel::new(name, load(&bytes).expect("a cube"));
    let mut job = Job::new(&[model("left cube"), model("Würfel")], settings, &|| 0.0).expect("fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers");
    String::from_utf8(assemble(&finished.joined, &range.texts)).expect("ASCII")
}

/// Commands without comments.
fn commands(text: &str) -> Vec<&str> {
    text.lines().map(|l| l.split(';').next().unwrap_or_default().trim()).filter(|l| !l.is_empty()).collect()
}

fn count(commands: &[&str], start: &str) -> usize {
    commands.iter().filter(|c| **c == start || c.starts_with(&format!("{start} "))).count()
}

/// marlinfw.org/docs/gcode: M204 P R T (M204.html), M73 P R (M073.html), M107 (M107.html), M900 K
/// (M900.html), M486 T S (M486.html).
#[test]
fn marlin() {
    let text = file(Flavor::Marlin, &[]);
    let all = commands(&text);
    assert!(all.contains(&"M204 P1500 R900 T1200") && all.contains(&"M900 K0.04"), "{text}");
    assert!(all.contains(&"M73 P0 R0") && all.contains(&"M107"), "{text}");
    assert!(all.contains(&"M486 T2"));
    assert_eq!(count(&all, "M486 S0"), 10);
    assert_eq!(count(&all, "M486 S1"), 10);
    assert_eq!(count(&all, "M486 S-1"), 20);
    // Configuration_adv.h: ARC_SUPPORT is on by default.
    assert!(Flavor::Marlin.has_arcs());
}

/// klipper3d.org/G-Codes.html: SET_VELOCITY_LIMIT, SET_PRESSURE_ADVANCE, M107, M73 with
/// [display_status]; Exclude_Object.html: POLYGON is JSON without spaces, NAME has no spaces.
#[test]
fn klipper() {
    let text = file(Flavor::Klipper, &[]);
    let all = commands(&text);
    assert!(
        all.contains(&"SET_VELOCITY_LIMIT ACCEL=1200") && all.contains(&"SET_PRESSURE_ADVANCE ADVANCE=0.04")
    );
    let define = "EXCLUDE_OBJECT_DEFINE NAME=left_cube_0 CENTER=104.000,110.000 \
                  POLYGON=[[103.000,109.000],[105.000,109.000],[105.000,111.000],[103.000,111.000]]";
    assert!(all.contains(&define), "{text}");
    assert_eq!(count(&all, "EXCLUDE_OBJECT_START NAME=left_cube_0"), 10);
    assert_eq!(count(&all, "EXCLUDE_OBJECT_END NAME=left_cube_0"), 10);
    assert_eq!(count(&all, "EXCLUDE_OBJECT_START NAME=W_rfel_1"), 10);
    assert!(!text.contains("M204") && !text.contains("M486") && !text.contains("M900"));
    assert!(!Flavor::Klipper.has_arcs());
}

/// docs.duet3d.com, GCode dictionary: M204 P T, M572 D S, M486 S A, M106 S0 instead of M107
/// (deprecated), M73 P R.
#[test]
fn reprap() {
    let text = file(Flavor::Reprap, &[]);
    let all = commands(&text);
    assert!(all.contains(&"M204 P1500 T1200") && all.contains(&"M572 D0 S0.04"), "{text}");
    assert!(all.contains(&"M106 S0") && all.contains(&"M73 P0 R0"));
    // The default end code says M107, which still works; nothing else does.
    assert_eq!(count(&all, "M107"), 1);
    let named = text.contains("M486 S0\nM486 Aleft_cube_0\nM486 S1\nM486 AW_rfel_1\nM486 S-1\n");
    assert!(named, "{text}");
    assert!(Flavor::Reprap.has_arcs());
}

/// help.prusa3d.com, Prusa Firmware-specific G-code commands: M73 P R for the normal and Q S for
/// the silent mode, M486 S A, M900 K, M204 P R T.
#[test]
fn prusa() {
    let text = file(Flavor::Prusa, &[]);
    let all = commands(&text);
    assert!(text.contains("M73 P0 R0\nM73 Q0 S0\n") && text.contains("M73 P100 R0\nM73 Q100 S0\n"), "{text}");
    assert!(all.contains(&"M204 P1500 R900 T1200"));
    // The i3 printers know the one, those with Buddy firmware 5.1 and later the other.
    assert!(text.contains("M900 K0.04\nM572 S0.04\n"), "{text}");
    assert!(text.contains("M486 S0\nM486 Aleft_cube_0\n"));
    assert!(Flavor::Prusa.has_arcs());
}

/// Repetier-Firmware's list of codes: M201 printing, M202 travel acceleration; M204 sets PID values and
/// must not be sent; there is no M73 and no M486, and M900 means nothing.
#[test]
fn repetier() {
    let text = file(Flavor::Repetier, &[]);
    let all = commands(&text);
    assert!(text.contains("M201 X1500 Y1500\nM202 X1200 Y1200\n"), "{text}");
    for never in ["M204", "M73", "M486", "M900", "EXCLUDE_OBJECT_START"] {
        assert_eq!(count(&all, never), 0, "{never}");
    }
    assert_eq!(Flavor::Repetier.labels(), ObjectLabels::None);
    assert!(!Flavor::Repetier.has_pressure_advance());
}

/// github.com/rjduran/bambu-gcode-reference: M204 S, M73 P R, M106 S for the part fan, M900 K, G2 and G3.
#[test]
fn bambu() {
    let text = file(Flavor::Bambu, &[]);
    let all = commands(&text);
    assert!(
        all.contains(&"M204 S1200") && all.contains(&"M900 K0.04") && all.contains(&"M73 P0 R0"),
        "{text}"
    );
    assert!(all.contains(&"M106 S0") && count(&all, "M486") == 0);
    assert!(Flavor::Bambu.has_arcs());
}

/// Temperatures and retraction are said alike everywhere: M140, M190, M104 and M109 with S (all of the
/// lists above), and E moves after M83.
#[test]
fn all_heat_and_retract_alike() {
    for flavor in Flavor::ALL {
        let text = file(flavor, &["filament.nozzle_temp=200", "filament.first_layer_nozzle_temp=215"]);
        let place = |what: &str| {
            commands(&text).iter().position(|c| *c == what).unwrap_or_else(|| panic!("{what} {flavor:?}"))
        };
        let order =
            ["M140 S60", "M190 S60", "G28", "M109 S215", "M104 S200", "M104 S0", "M140 S0"].map(place);
        assert!(order.is_sorted(), "{flavor:?}: {order:?}");
        assert!(text.contains("\nM83 ") && text.contains("\nG1 E-0.8 F2100\n"), "{flavor:?}");
    }
}

/// Repetier-Firmware's list of codes has no command that waits for the user; Bambu's M400 U1 does.
#[test]
fn pauses_only_where_there_are_any() {
    let pause = "gcode.events=[{\"layer\":2,\"kind\":\"pause\"}]";
    assert!(file(Flavor::Bambu, &[pause]).contains("\nM400 U1\n"));
    let settings = Settings::resolve([], ["printer.flavor=\"repetier\"", pause]).expect("good settings");
    let cube = NamedModel::new("cube", load(&write_binary(&common::cube(2.0))).expect("a cube"));
    let error = Job::new(&[cube], settings, &|| 0.0).expect_err("no pause");
    let message = "gcode.events[0]: the firmware repetier is not known to wait for the user";
    assert_eq!(error.to_string(), message);
}

/// Nothing is said of objects and pressure advance unless it is asked for.
#[test]
fn defaults_add_nothing() {
    for flavor in Flavor::ALL {
        let text = file(flavor, &["printer.label_objects=false", "filament.pressure_advance=0"]);
        for never in ["M486", "EXCLUDE_OBJECT", "M900", "M572", "SET_PRESSURE"] {
            assert!(!text.contains(never), "{flavor:?} says {never}");
        }
    }
}
