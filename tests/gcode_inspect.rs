//! G-code files of other slicers and our own: their figures, layers that can be read alone, and what is
//! refused.

mod common;

use foothold::gcode::inspect::{GcodeFileError, InspectedGcode, Inspector};
use foothold::gcode::read::{Strand, read};
use foothold::gcode::{FilamentOptions, assemble};
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;
use proptest::prelude::*;

const PRUSA: &str = include_str!("fixtures/gcode/prusaslicer.gcode");
const CURA: &str = include_str!("fixtures/gcode/cura.gcode");
const ORCA: &str = include_str!("fixtures/gcode/orcaslicer.gcode");

fn inspected(chunks: &[&[u8]]) -> Result<InspectedGcode, GcodeFileError> {
    let mut inspector = Inspector::new(FilamentOptions::default());
    chunks.iter().try_for_each(|chunk| inspector.push(chunk))?;
    inspector.finish()
}

fn whole(text: &str) -> InspectedGcode {
    inspected(&[text.as_bytes()]).expect("good G-code")
}

/// Two squares of 20 mm, one over the other, each side with 0.6 mm of filament, as each slicer says it.
#[test]
fn the_same_print_has_the_same_figures_in_every_dialect() {
    for (text, generator, settings, nozzle, bed) in [
        (PRUSA, "PrusaSlicer 2.9.2", "PrusaSlicer", 215.0, 60.0),
        (CURA, "Cura_SteamEngine 5.10.0", "Cura", 200.0, 60.0),
        (ORCA, "OrcaSlicer 2.3.0", "OrcaSlicer", 220.0, 65.0),
    ] {
        let found = whole(text).figures;
        assert_eq!((&found.generator[..], found.settings), (generator, settings));
        assert_eq!((found.layers, found.tools, &found.warnings[..]), (2, 1, &[][..]), "{generator}");
        assert_eq!(found.bounds, [[100.0, 100.0, 0.2], [120.0, 120.0, 0.4]], "{generator}");
        assert_eq!((&found.nozzle_temps[..], &found.bed_temps[..]), (&[nozzle][..], &[bed][..]));
        let walls = found.by_role["outer_wall"];
        assert!((walls.length_mm - 160.0).abs() < 1e-9, "{generator}");
        // 4.8 mm of 2.4052819 mm2.
        assert!((walls.volume_mm3 - 11.545_353).abs() < 1e-5, "{generator} {}", walls.volume_mm3);
        let heights: Vec<f64> = found.layer_heights.iter().map(|h| (h * 1000.0).round()).collect();
        assert_eq!(heights, [200.0, 200.0], "{generator}");
        // 20 mm at 30 mm/s take 0.67 s and the ramps of corners a little more; 8 of them.
        assert!((5.33..6.5).contains(&walls.time_s), "{generator} {}", walls.time_s);
        assert_eq!(found.lines as usize, text.lines().count());
    }
}

#[test]
fn filament_and_stated_times_are_told() {
    let prusa = whole(PRUSA).figures;
    // An intro line of 9 mm; the last retraction takes nothing away.
    assert!((prusa.filament.length_mm - 13.8).abs() < 1e-9, "{}", prusa.filament.length_mm);
    assert!((prusa.filament.mass_g - 13.8 * 2.405_281_9 * 1.24e-3).abs() < 1e-6);
    assert_eq!(prusa.stated_time, "12s");
    assert_eq!(prusa.by_role["unnamed"].length_mm, 60.0);
    let cura = whole(CURA).figures;
    assert_eq!(cura.stated_time, "1h 2m 5s");
    assert_eq!(cura.retractions, 2);
    assert!((cura.filament.length_mm - 4.8).abs() < 1e-9, "{}", cura.filament.length_mm);
}

#[test]
fn faster_limits_in_the_file_make_it_faster() {
    // At 1250 mm/s2 a side takes 0.69 s, at 100 mm/s2 0.93 s: ramps of 4.5 mm at both ends.
    let walls = |text: &str| whole(text).figures.by_role["outer_wall"].time_s;
    let ratio = walls(&PRUSA.replace("M204 P1250", "M204 P100")) / walls(PRUSA);
    assert!((1.25..1.45).contains(&ratio), "{ratio}");
}

fn strands(text: &[u8]) -> Vec<Vec<Strand>> {
    read(text, 1.75).layers.into_iter().map(|layer| layer.strands).collect()
}

/// What a preview does: any layer, with its head, shows what it is in the whole file.
fn layers_read_alone_are_those_of_the_file(text: &str) {
    let found = whole(text);
    let in_file = strands(text.as_bytes());
    assert_eq!(found.layers.len(), in_file.len());
    for (k, layer) in found.layers.iter().enumerate() {
        let end = found.layers.get(k + 1).map_or(text.len(), |next| next.offset as usize);
        let alone = format!("{}{}", layer.head, &text[layer.offset as usize..end]);
        let alone = strands(alone.as_bytes());
        assert_eq!(alone.len(), 1, "layer {k}");
        for (alone, whole) in alone[0].iter().zip(&in_file[k]) {
            assert_eq!((alone.role, alone.points.len()), (whole.role, whole.points.len()));
            for (a, b) in alone.points.iter().zip(&whole.points) {
                assert!(a.distance(*b) < 1e-4, "{a} {b}");
            }
            assert!((alone.volume_mm3() - whole.volume_mm3()).abs() < 1e-4);
            assert!(
                alone.segments.iter().zip(&whole.segments).all(|(a, b)| (a.width - b.width).abs() < 1e-4)
            );
        }
    }
}

#[test]
fn each_layer_can_be_read_alone() {
    for text in [PRUSA, CURA, ORCA] {
        layers_read_alone_are_those_of_the_file(text);
    }
    // Inches, relative places, renamed axes, arcs, no marks.
    layers_read_alone_are_those_of_the_file(
        "G20\nG1 Z0.01 F60\nG1 X1 Y1 E0.1\nG92 X0 Y0\nG91\nG3 X1 Y0 I0.5 J0 E0.1\nG1 Z0.01\nG1 X-1 E0.1\n\
         G90\nM83\nG1 X1 E0.2\nG1 Z0.03\nG2 X0 Y0 R0.5 E.1\nG21\nG1 X9 E1\n",
    );
}

#[test]
fn our_own_files_have_the_figures_of_their_report() {
    let named = NamedModel::new("part", load(&write_binary(&common::medley())).expect("a mesh"));
    let settings =
        Settings::resolve([], ["layers.height=0.3", "retraction.z_hop=0.2"]).expect("good settings");
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers");
    let text = assemble(&finished.joined, &range.texts);
    let found = inspected(&[&text]).expect("good G-code").figures;
    let report = finished.report;
    assert!(found.generator.starts_with("Foothold ") && found.settings == "Foothold");
    assert_eq!(found.layers, report.layers);
    assert_eq!(found.warnings, []);
    assert!((found.filament.length_mm / report.filament.length_mm - 1.0).abs() < 1e-3);
    assert!((found.time_s / report.time_s - 1.0).abs() < 0.02, "{} {}", found.time_s, report.time_s);
    let walls = report.by_role[&foothold::region::Role::OuterWall];
    assert!((found.by_role["outer_wall"].length_mm / walls.length_mm - 1.0).abs() < 1e-3);
    layers_read_alone_are_those_of_the_file(&String::from_utf8(text).expect("ASCII"));
}

#[test]
fn what_is_no_gcode_is_refused_by_name() {
    let refused = |bytes: &[u8]| inspected(&[bytes]).expect_err("no G-code").to_string();
    assert!(refused(b"").starts_with("empty"));
    assert!(refused(b"GCDE\x01\0\0\0").starts_with("binary G-code (bgcode)"));
    assert!(refused(b"G1 X1\n\0\0").starts_with("no text"));
    assert!(refused(b"Dear reader,\nthis is a letter.\n").starts_with("no beads"));
    assert!(refused(&vec![b'x'; 2 << 20]).starts_with("line 1 has over a megabyte"));
    assert!(refused(&b";LAYER_CHANGE\n".repeat(200_001)).starts_with("more than 200000 layers"));
}

#[test]
fn a_file_that_is_cut_off_is_shown_as_far_as_it_goes_and_said_to_be_cut() {
    let cut = &PRUSA[..PRUSA.find("M104 S0").expect("it is there")];
    let codes: Vec<&str> = whole(cut).figures.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["heaters_stay_on"]);
    // Klipper's files leave the heaters to a macro.
    for ended in ["PRINT_END\n", "end_print X=1 ; heaters off\n"] {
        assert_eq!(whole(&format!("{cut}{ended}")).figures.warnings, [], "{ended}");
    }
    let garbled = whole(&PRUSA.replace("G1 X120 Y120 E.6", "G1 X120 Y=3 E.6")).figures;
    assert_eq!(garbled.warnings[0].code, "malformed_lines");
    assert!(garbled.warnings[0].message.starts_with("2 line(s)"), "{}", garbled.warnings[0].message);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn chunks_of_any_size_give_the_same(cuts in prop::collection::vec(0..CURA.len(), 0..6)) {
        let mut cuts = cuts;
        cuts.extend([0, CURA.len()]);
        cuts.sort_unstable();
        let chunks: Vec<&[u8]> = cuts.windows(2).map(|w| &CURA.as_bytes()[w[0]..w[1]]).collect();
        prop_assert_eq!(inspected(&chunks), inspected(&[CURA.as_bytes()]));
    }

    #[test]
    fn no_bytes_make_it_panic_or_count_what_is_not_finite(
        lines in prop::collection::vec("(G[0-3]|G9[0-2]|G2[018]|M8[23]|M20[1-5]|;LAYER:|;TYPE:|T)[ XYZEFIJRS0-9.=-]{0,30}", 0..30),
        noise in prop::collection::vec(1_u8.., 0..40),
    ) {
        let mut text = lines.join("\n").into_bytes();
        text.extend(noise);
        if let Ok(found) = inspected(&[&text]) {
            let figures = found.figures;
            let numbers = [figures.time_s, figures.travel_mm, figures.filament.volume_mm3];
            prop_assert!(numbers.iter().chain(figures.bounds.iter().flatten()).all(|x| x.is_finite()));
        }
    }
}
