//! Teeth along the contour keep the guarantees of docs/adhesion.md, shape by shape.

#[path = "fixtures/adhesion/picture.rs"]
mod picture;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use foothold::adhesion::{AdhesionKind, Foundation, WarningCode};
use foothold::polygon::{PolygonSet, dvec2};
use shapes::*;

/// Lays teeth, draws them when FOOTHOLD_PICTURES is set, and checks all guarantees.
fn checked(name: &str, outline: &PolygonSet) -> Foundation {
    let supports = PolygonSet::EMPTY;
    let first = first_layer(outline, &supports);
    let laid = laid(outline, AdhesionKind::Teeth);
    picture::draw(name, outline, &laid);
    let broken = broken_guarantee(&first, &options(AdhesionKind::Teeth), &laid);
    assert_eq!(broken, None, "{name}");
    laid
}

fn placed(laid: &Foundation) -> u32 {
    laid.figures.teeth.expect("teeth were laid").placed
}

#[test]
fn a_rectangle_has_a_tooth_every_pitch() {
    // 140 mm in pitches of 5.
    let laid = checked("rectangle", &rectangle(90.0, 90.0, 40.0, 30.0));
    assert_eq!(placed(&laid), 28);
    assert_eq!(laid.figures.teeth.map(|t| (t.left_out, t.shallow)), Some((0, 0)));
}

#[test]
fn a_fine_circle_has_teeth_all_round() {
    for n in [12, 60, 5000] {
        let laid = checked(&format!("circle{n}"), &circle(dvec2(110.0, 110.0), 20.0, n));
        // 125.66 / 5.
        assert_eq!(placed(&laid), 25, "{n}");
    }
}

#[test]
fn rings_letters_and_frames() {
    checked("ring", &ring(dvec2(110.0, 110.0), 25.0, 18.0));
    checked("thin-ring", &ring(dvec2(110.0, 110.0), 25.0, 24.4));
    checked("frame", &frame(60.0, 60.0, 84.0, 66.0, 2.0));
    for which in "ABCEHOST".chars() {
        checked(&format!("letter-{which}"), &letter(which, 90.0, 90.0, 4.0));
        checked(&format!("small-{which}"), &letter(which, 90.0, 90.0, 1.5));
    }
}

#[test]
fn stars_combs_spirals_and_waves() {
    checked("star5", &star(dvec2(110.0, 110.0), 5, 30.0, 12.0));
    checked("star24", &star(dvec2(110.0, 110.0), 24, 30.0, 24.0));
    // No side of the rail has room for a base: teeth stand around its corners.
    let short = checked("short-spikes", &star(dvec2(110.0, 110.0), 23, 28.0, 24.0));
    assert!(placed(&short) >= 15, "{}", placed(&short));
    checked("comb", &comb(60.0, 90.0, 8, 2.0, 6.0, 20.0));
    checked("narrow-comb", &comb(60.0, 90.0, 12, 2.0, 3.0, 20.0));
    checked("spiral", &spiral(dvec2(110.0, 110.0), 3.0, 5.0, 9.0, 2.5));
    checked("wave", &wave(dvec2(110.0, 110.0), 45.0, 6.0, 14.0, 4000));
}

#[test]
fn neighbours_share_a_rail() {
    let pair = |gap: f64| rectangle(80.0, 90.0, 20.0, 25.0).union(&rectangle(100.0 + gap, 90.0, 20.0, 25.0));
    for gap in [0.5, 3.0, 3.9, 4.1, 5.0, 9.0] {
        checked(&format!("pair{gap}"), &pair(gap));
    }
}

#[test]
fn at_the_beds_edge_teeth_are_left_out_and_told() {
    let laid = checked("bed-edge", &rectangle(0.5, 60.0, 40.0, 30.0));
    let codes: Vec<WarningCode> = laid.warnings.iter().map(|w| w.code).collect();
    assert!(codes.contains(&WarningCode::AdhesionOffBed) && codes.contains(&WarningCode::TeethLeftOut));
    let figures = laid.figures.teeth.expect("teeth were laid");
    // The side of 30 mm at the edge has none of its six.
    assert!((5..=7).contains(&figures.left_out), "{figures:?}");
}
