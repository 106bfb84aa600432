//! Skirt, brim, raft and teeth beside each other: numbers on paper and the usual ones.

#[path = "fixtures/adhesion/picture.rs"]
mod picture;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use foothold::adhesion::{
    AdhesionError, AdhesionKind, AdhesionOptions, BrimSide, FirstLayer, Foundation, WarningCode, compare,
    lay_foundation,
};
use foothold::polygon::{PolygonSet, dvec2};
use foothold::region::{Path, Role};
use shapes::*;

const NONE: &PolygonSet = &PolygonSet::EMPTY;

fn lay(outline: &PolygonSet, settings: &AdhesionOptions) -> Foundation {
    lay_foundation(&first_layer(outline, NONE), settings).expect("valid settings")
}

/// All four kinds and how they were drawn.
fn all(name: &str, outline: &PolygonSet) -> [Foundation; 4] {
    let found = compare(&first_layer(outline, NONE), &AdhesionOptions::default()).expect("default settings");
    found.map(|a| {
        picture::draw(&format!("{name}-{}", a.kind.name()), outline, &a.foundation);
        a.foundation
    })
}

fn length(paths: &[Path]) -> f64 {
    paths.iter().map(Path::length).sum()
}

#[test]
fn the_frame_of_the_paper() {
    let frame = frame(68.0, 77.0, 84.0, 66.0, 2.0);
    let [skirt, brim, raft, teeth] = all("frame", &frame).map(|f| f.figures);
    assert!(teeth.filament_mm3 < brim.filament_mm3 && brim.filament_mm3 < raft.filament_mm3);
    assert!(teeth.filament_mm3 < 0.12 * brim.filament_mm3, "{} of {}", teeth.filament_mm3, brim.filament_mm3);
    assert!(raft.attachment_mm >= brim.attachment_mm && brim.attachment_mm > teeth.attachment_mm);
    assert!(teeth.attachment_mm > 0.0 && skirt.attachment_mm == 0.0);
    // Outlines 300 and 284 mm: the brim holds the outer one, the raft both.
    assert!(
        (brim.attachment_mm - 300.0).abs() < 1e-6 && (brim.attachment_share - 300.0 / 584.0).abs() < 1e-9
    );
    assert!((raft.attachment_mm - 584.0).abs() < 1e-6 && raft.attachment_share == 1.0);
    // Each of 60 teeth holds where its sides are within 0.3 of the outline: the sides cross it 0.5
    // apart at 58 degrees from it, so 0.5 + 2 * 0.3 / sin(58) = 1.2075.
    assert_eq!(teeth.teeth.map(|t| t.placed), Some(60));
    assert!((teeth.attachment_mm - 60.0 * 1.2075).abs() < 0.1, "{}", teeth.attachment_mm);
}

#[test]
fn the_papers_skirt_is_250_mm_at_a_distance_of_2() {
    let settings = options(AdhesionKind::Skirt);
    let square = rectangle(100.0, 100.0, 20.0, 20.0);
    let laid = lay(&square, &settings);
    let loops = &laid.layers[0];
    // Centre lines 2.25, 2.75 and 3.25 outside: 98 + 102 + 106 mm is the first sum over 250.
    let lengths: Vec<f64> = loops.iter().map(Path::length).collect();
    assert!(lengths.iter().zip([106.0, 102.0, 98.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{lengths:?}");
    assert!(loops.iter().all(|p| p.role == Role::Skirt && p.closed));
    assert_eq!(laid.figures.attachment_mm, 0.0);
    // The loops asked for are there even when one is long enough.
    let mut three = settings.clone();
    (three.skirt.loops, three.skirt.min_length) = (3, 0.0);
    assert_eq!(lay(&square, &three).layers[0].len(), 3);
}

#[test]
fn a_skirt_goes_around_supports_and_all_parts() {
    let parts = rectangle(60.0, 60.0, 10.0, 10.0).union(&rectangle(100.0, 60.0, 10.0, 10.0));
    let supports = rectangle(80.0, 90.0, 5.0, 5.0);
    let laid = lay_foundation(&first_layer(&parts, &supports), &options(AdhesionKind::Skirt)).expect("laid");
    let around = ring_of(laid.layers[0][0].points.clone());
    assert_eq!(laid.layers[0].iter().filter(|p| p.closed).count(), laid.layers[0].len());
    assert!(around.intersection(&parts.union(&supports)) == parts.union(&supports));
}

#[test]
fn the_papers_brim_is_20_lines_of_0_4() {
    let laid = lay(&rectangle(100.0, 100.0, 20.0, 20.0), &options(AdhesionKind::Brim));
    let loops = &laid.layers[0];
    assert_eq!(loops.len(), 20);
    // From outside in: squares of 20 + 2 * 7.8 down to 20 + 2 * 0.2.
    assert!((loops[0].length() - 4.0 * 35.6).abs() < 1e-6);
    assert!((loops[19].length() - 4.0 * 20.4).abs() < 1e-6);
    assert!(loops.windows(2).all(|w| w[0].length() > w[1].length()));
    assert!((laid.figures.attachment_share - 1.0).abs() < 1e-9);
    // Area of the brim: 36 x 36 - 20 x 20, without overlap.
    assert!((laid.figures.bed_contact_mm2 - 896.0).abs() < 1e-6);
    // A gap lets go.
    let mut apart = options(AdhesionKind::Brim);
    apart.brim.gap = 0.2;
    assert_eq!(lay(&rectangle(100.0, 100.0, 20.0, 20.0), &apart).figures.attachment_mm, 0.0);
}

#[test]
fn a_brim_outside_inside_and_both() {
    let frame = frame(60.0, 60.0, 84.0, 66.0, 2.0);
    let with = |side| {
        let mut settings = options(AdhesionKind::Brim);
        settings.brim.side = side;
        let laid = lay(&frame, &settings);
        picture::draw(&format!("brim-{side:?}"), &frame, &laid);
        laid.figures.attachment_mm
    };
    assert!((with(BrimSide::Outer) - 300.0).abs() < 1e-6);
    // In a hole's corner the loop turns 0.2 off both sides: 0.05 mm of each side are out of its reach.
    assert!((with(BrimSide::Inner) - (284.0 - 0.4)).abs() < 1e-6);
    assert!((with(BrimSide::Both) - (584.0 - 0.4)).abs() < 1e-6);
}

#[test]
fn an_outer_brim_of_an_island_in_a_hole_stays_off_the_holes_wall() {
    let part = frame(60.0, 60.0, 60.0, 60.0, 5.0).union(&rectangle(85.0, 85.0, 8.0, 8.0));
    let laid = lay(&part, &options(AdhesionKind::Brim));
    picture::draw("brim-nested", &part, &laid);
    // All of the frame's outside (240) and of the island's (32), nothing of the hole's 200.
    assert!((laid.figures.attachment_mm - 272.0).abs() < 0.01, "{}", laid.figures.attachment_mm);
    // The same for a brim inside holes: the hole's wall alone.
    let mut settings = options(AdhesionKind::Brim);
    settings.brim.side = BrimSide::Inner;
    settings.brim.width = 30.0;
    let inner = lay(&part, &settings);
    picture::draw("brim-nested-inner", &part, &inner);
    assert!((inner.figures.attachment_mm - 200.0).abs() < 0.5, "{}", inner.figures.attachment_mm);
}

#[test]
fn ears_stand_at_sharp_corners_only() {
    let mut settings = options(AdhesionKind::Brim);
    settings.brim.ears = true;
    let square = rectangle(80.0, 80.0, 50.0, 50.0);
    let laid = lay(&square, &settings);
    picture::draw("ears", &square, &laid);
    // Each ear holds 8 mm of two sides, and up to the reach of 0.25 more.
    assert!((64.0..=66.0).contains(&laid.figures.attachment_mm), "{}", laid.figures.attachment_mm);
    // 20 loops at 4 corners; the corners of the six loops beyond 8 / sqrt(2) lie outside the round area,
    // so these are in two pieces.
    assert_eq!(laid.layers[0].len(), 4 * (14 + 2 * 6));
    let round = lay(&circle(dvec2(110.0, 110.0), 20.0, 90), &settings);
    assert!(round.layers[0].is_empty());
    assert_eq!(round.warnings[0].code, WarningCode::NoEars);
}

#[test]
fn the_papers_raft_is_two_layers_of_0_2_and_reaches_15_mm() {
    let laid = lay(&rectangle(100.0, 100.0, 20.0, 20.0), &options(AdhesionKind::Raft));
    picture::draw("raft", &rectangle(100.0, 100.0, 20.0, 20.0), &laid);
    let heights: Vec<f64> = laid.raft.iter().map(|l| l.height).collect();
    assert_eq!(heights, [0.2, 0.2]);
    assert!((laid.lift - 0.6).abs() < 1e-12, "0.4 thick and a gap of 0.2");
    assert!(laid.layers.iter().all(Vec::is_empty));
    // The interface is dense: its beads cover the footprint, 50 x 50 less the cut corners.
    let footprint = rectangle(100.0, 100.0, 20.0, 20.0).offset(15.0, foothold::polygon::Join::Square).area();
    let covered = length(&laid.raft[1].paths) * 0.4;
    assert!((covered / footprint - 1.0).abs() < 0.02, "{covered} of {footprint}");
    // The base covers 70 % and is one long line and a loop.
    assert!((laid.figures.bed_contact_mm2 / footprint - 0.7).abs() < 0.04);
    assert_eq!(laid.raft[0].paths.len(), 2);
}

#[test]
fn supports_on_the_bed_get_their_share() {
    let part = rectangle(60.0, 60.0, 30.0, 30.0);
    let supports = rectangle(120.0, 60.0, 20.0, 20.0);
    for kind in AdhesionKind::LAID {
        let first = first_layer(&part, &supports);
        let laid = lay_foundation(&first, &options(kind)).expect("default settings");
        let alone = lay(&part, &options(kind));
        assert!(laid.figures.filament_mm3 > 1.2 * alone.figures.filament_mm3, "{kind:?}");
        // Attachment is the part's.
        assert!((laid.figures.attachment_mm - alone.figures.attachment_mm).abs() < 1e-6, "{kind:?}");
        if kind == AdhesionKind::Teeth {
            assert_eq!(broken_guarantee(&first, &options(kind), &laid), None);
            assert_eq!(laid.figures.teeth.map(|t| t.placed), Some(24 + 16));
        }
    }
}

#[test]
fn layers_rail_lines_and_tab_of_teeth() {
    let part = rectangle(90.0, 90.0, 40.0, 30.0);
    let mut settings = options(AdhesionKind::Teeth);
    (settings.teeth.layers, settings.teeth.rail_lines, settings.teeth.tab) = (3, 3, true);
    let laid = lay(&part, &settings);
    picture::draw("teeth-tab", &part, &laid);
    assert_eq!(laid.layers.len(), 3);
    assert!(laid.layers.iter().all(|l| *l == laid.layers[0]));
    let closed: Vec<f64> = laid.layers[0].iter().filter(|p| p.closed).map(Path::length).collect();
    // Loops at 3.0 and 2.5, then the zigzag.
    assert!((closed[0] - 2.0 * (46.0 + 36.0)).abs() < 1e-6 && (closed[1] - 2.0 * (45.0 + 35.0)).abs() < 1e-6);
    assert_eq!(closed.len(), 3);
    let tab = laid.layers[0].last().expect("a tab");
    assert!(!tab.closed && tab.length() > 80.0);
    assert_eq!(broken_guarantee(&first_layer(&part, NONE), &settings, &laid), None);
}

#[test]
fn teeth_in_holes_on_request() {
    let ring = ring(dvec2(110.0, 110.0), 25.0, 18.0);
    let mut settings = options(AdhesionKind::Teeth);
    let without = lay(&ring, &settings);
    assert_eq!(without.layers[0].len(), 1);
    settings.teeth.holes = true;
    let with = lay(&ring, &settings);
    picture::draw("ring-holes", &ring, &with);
    assert_eq!(with.layers[0].len(), 2);
    // 157.1 / 5 outside, 113.1 / 5 inside.
    let placed = |laid: &Foundation| laid.figures.teeth.expect("teeth").placed;
    assert_eq!((placed(&without), placed(&with)), (31, 31 + 23));
    assert_eq!(broken_guarantee(&first_layer(&ring, NONE), &settings, &with), None);
}

#[test]
fn contradictions_name_the_setting() {
    let part = rectangle(90.0, 90.0, 40.0, 30.0);
    let error = |change: &dyn Fn(&mut AdhesionOptions)| {
        let mut settings = options(AdhesionKind::Teeth);
        change(&mut settings);
        lay_foundation(&first_layer(&part, NONE), &settings).expect_err("a contradiction").to_string()
    };
    assert_eq!(
        error(&|s| s.teeth.base = 5.0),
        "adhesion.teeth.base: 5 mm must be less than adhesion.teeth.pitch (5 mm)"
    );
    assert_eq!(
        error(&|s| s.teeth.height = 2.0),
        "adhesion.teeth.height: 2 mm must be more than adhesion.teeth.offset (2 mm)"
    );
    for value in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        assert!(error(&|s| s.teeth.pitch = value).starts_with("adhesion.teeth.pitch: "));
        assert!(error(&|s| s.brim.line_width = value).starts_with("adhesion.brim.line_width: "));
        assert!(error(&|s| s.raft.base_density = value).starts_with("adhesion.raft.base_density: "));
        assert!(error(&|s| s.teeth.height = value).starts_with("adhesion.teeth.height: "));
    }
}

#[test]
fn a_line_without_width_is_an_error_too() {
    let part = rectangle(90.0, 90.0, 40.0, 30.0);
    for line_width in [0.0, -0.4, f64::NAN] {
        let first = FirstLayer { line_width, ..first_layer(&part, NONE) };
        let error = lay_foundation(&first, &options(AdhesionKind::Teeth)).expect_err("no line").to_string();
        assert!(error.starts_with("first_layer.line_width: "), "{error}");
    }
}

#[test]
fn contradictions_in_another_kind_do_not_matter() {
    let mut settings: AdhesionOptions = options(AdhesionKind::Skirt);
    settings.teeth.base = 9.0;
    let part = rectangle(90.0, 90.0, 40.0, 30.0);
    let first = first_layer(&part, NONE);
    assert!(lay_foundation(&first, &settings).is_ok());
    assert!(matches!(compare(&first, &settings), Err(AdhesionError::Contradiction { .. })));
}

#[test]
fn teeth_larger_than_the_part_are_told() {
    // A pin of 0.3 mm: its tips end half-way.
    let pin = circle(dvec2(110.0, 110.0), 0.15, 16);
    let laid = lay(&pin, &options(AdhesionKind::Teeth));
    assert_eq!(broken_guarantee(&first_layer(&pin, NONE), &options(AdhesionKind::Teeth), &laid), None);
    let codes: Vec<WarningCode> = laid.warnings.iter().map(|w| w.code).collect();
    assert!(codes.contains(&WarningCode::TeethShallow) || codes.contains(&WarningCode::IslandWithoutTeeth));
    assert!(laid.warnings.iter().all(|w| w.message.starts_with("adhesion.teeth.") && w.at.is_some()));
    // A speck has no bead to bite into.
    let speck = laid_speck();
    assert!(speck.layers[0].is_empty());
    assert_eq!(speck.warnings[0].code, WarningCode::IslandWithoutTeeth);
}

fn laid_speck() -> Foundation {
    lay(&rectangle(110.0, 110.0, 0.03, 0.03), &options(AdhesionKind::Teeth))
}

#[test]
fn at_the_beds_edge_every_kind_stays_on_the_bed() {
    let part = rectangle(0.0, 0.0, 40.0, 30.0).union(&rectangle(200.0, 180.0, 19.5, 39.0));
    let first = first_layer(&part, NONE);
    for kind in AdhesionKind::LAID {
        let laid = lay_foundation(&first, &options(kind)).expect("default settings");
        picture::draw(&format!("edge-{}", kind.name()), &part, &laid);
        let paths = laid.layers.iter().flatten().chain(laid.raft.iter().flat_map(|l| &l.paths));
        for p in paths.flat_map(|p| &p.points) {
            assert_eq!(p.clamp(BED.min, BED.max), *p, "{kind:?}");
        }
        let told = laid.warnings.iter().any(|w| w.code == WarningCode::AdhesionOffBed);
        assert!(told, "{kind:?}");
    }
}

#[test]
fn an_outline_off_the_bed_is_told_with_its_place() {
    let part = rectangle(-5.0, 50.0, 40.0, 30.0);
    for kind in AdhesionKind::LAID {
        let laid = lay(&part, &options(kind));
        let warning = laid.warnings.iter().find(|w| w.code == WarningCode::OutlineOffBed).expect("told");
        assert!(warning.at.is_some_and(|p| p.x < 0.0));
        assert!(warning.message.starts_with("printer.bed_size"));
        let points = laid.layers.iter().flatten().flat_map(|p| &p.points);
        assert!(points.into_iter().all(|p| p.x >= 0.0));
    }
}

#[test]
fn nothing_to_hold_is_nothing_to_lay() {
    for kind in AdhesionKind::LAID {
        let laid = lay(NONE, &options(kind));
        assert!(laid.layers.iter().all(Vec::is_empty) && laid.raft.is_empty() && laid.warnings.is_empty());
        assert_eq!(laid.lift, 0.0);
    }
    let none = lay(&rectangle(90.0, 90.0, 40.0, 30.0), &options(AdhesionKind::None));
    assert_eq!(none.figures.filament_mm3, 0.0);
}

#[test]
fn the_same_layer_gives_the_same_paths() {
    let part = wave(dvec2(110.0, 110.0), 45.0, 6.0, 14.0, 4000);
    let first: FirstLayer = first_layer(&part, NONE);
    for kind in AdhesionKind::LAID {
        let once = lay_foundation(&first, &options(kind)).expect("laid");
        assert_eq!(once, lay_foundation(&first, &options(kind)).expect("laid"));
    }
}

#[test]
fn all_kinds_of_a_few_first_layers_to_look_at() {
    all("star", &star(dvec2(110.0, 110.0), 5, 30.0, 12.0));
    all("pair", &rectangle(80.0, 90.0, 20.0, 25.0).union(&rectangle(103.0, 90.0, 20.0, 25.0)));
    all("ring", &ring(dvec2(110.0, 110.0), 25.0, 18.0));
}
