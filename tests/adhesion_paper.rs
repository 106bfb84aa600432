//! Brim teeth as [Lv 2022] has them: the worked example, the errata and the flaws of the printed method.

#[path = "fixtures/adhesion/picture.rs"]
mod picture;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use foothold::adhesion::{
    AdhesionKind, AdhesionOptions, Foundation, Placement, TeethDrawing, lay_foundation,
};
use foothold::polygon::{PolygonSet, dvec2};
use shapes::*;

fn per_edge(outline: &PolygonSet) -> Foundation {
    let mut settings = options(AdhesionKind::Teeth);
    settings.teeth.placement = Placement::PerEdge;
    lay(outline, &settings)
}

fn lay(outline: &PolygonSet, settings: &AdhesionOptions) -> Foundation {
    lay_foundation(&first_layer(outline, &PolygonSet::EMPTY), settings).expect("valid settings")
}

fn drawing(laid: &Foundation) -> &TeethDrawing {
    laid.drawing.as_ref().expect("teeth are drawn")
}

/// The part of the worked example.
fn example() -> PolygonSet {
    rectangle(90.0, 90.0, 40.0, 30.0)
}

#[test]
fn worked_example_28_teeth_on_a_path_of_226_185_mm() {
    let laid = per_edge(&example());
    picture::draw("per-edge", &example(), &laid);
    let teeth = &drawing(&laid).teeth;
    assert_eq!(teeth.len(), 28, "8 + 6 + 8 + 6");
    assert_eq!(laid.layers[0].len(), 1);
    let path = &laid.layers[0][0];
    assert!(path.closed);
    assert!((path.length() - 226.185).abs() < 5e-4, "{}", path.length());
    let rail = &drawing(&laid).rails[0];
    assert_eq!(rail.len(), 4, "square corners");
    let length: f64 = (0..4).map(|i| rail[i].distance(rail[(i + 1) % 4])).sum();
    assert!((length - 2.0 * (44.0 + 34.0)).abs() < 1e-9);
}

#[test]
fn worked_example_every_tooth_is_h_high_and_its_base_is_not_d1() {
    // Erratum: |s| d1 / d2 = 44 / 8 * 0.6 = 3.3 and 34 / 6 * 0.6 = 3.4.
    let laid = per_edge(&example());
    for tooth in &drawing(&laid).teeth {
        let base = tooth.a.distance(tooth.b);
        let level = tooth.a.y == tooth.b.y;
        assert!((base - if level { 3.3 } else { 3.4 }).abs() < 1e-9, "{base}");
        assert!((tooth.tip.distance((tooth.a + tooth.b) / 2.0) - 2.4).abs() < 1e-9);
    }
}

#[test]
fn erratum_the_base_grows_to_twice_d1_just_below_two_pitches() {
    // A rail of 9.9: one tooth with a base of 9.9 * 0.6 = 5.94.
    let laid = per_edge(&rectangle(90.0, 90.0, 5.9, 5.9));
    assert_eq!(drawing(&laid).teeth.len(), 4);
    assert!(drawing(&laid).teeth.iter().all(|t| (t.a.distance(t.b) - 5.94).abs() < 1e-9));
}

#[test]
fn flaw_1_four_of_28_tips_point_past_the_part() {
    let laid = per_edge(&example());
    let mut past: Vec<f64> = drawing(&laid)
        .teeth
        .iter()
        .filter(|t| t.bite < 0.0)
        .map(|t| {
            let beyond = (t.tip - dvec2(130.0, 120.0)).max(dvec2(90.0, 90.0) - t.tip);
            beyond.x.max(beyond.y)
        })
        .collect();
    past.sort_by(f64::total_cmp);
    assert_eq!(past.len(), 4);
    for (found, expected) in past.iter().zip([0.3, 0.3, 0.35, 0.35]) {
        assert!((found - expected).abs() < 1e-9, "{past:?}");
    }
    // The other 24 bite 0.4, and the contour placement has none outside.
    assert_eq!(drawing(&laid).teeth.iter().filter(|t| (t.bite - 0.4).abs() < 1e-9).count(), 24);
    let ours = laid_default(&example());
    assert!(drawing(&ours).teeth.iter().all(|t| (t.bite - 0.4).abs() < 0.05));
}

fn laid_default(outline: &PolygonSet) -> Foundation {
    lay(outline, &options(AdhesionKind::Teeth))
}

#[test]
fn flaw_2_a_fine_circle_has_no_tooth_per_edge_and_25_along_the_contour() {
    let circle = circle(dvec2(110.0, 110.0), 20.0, 720);
    let laid = per_edge(&circle);
    assert!(drawing(&laid).teeth.is_empty());
    assert_eq!(laid.figures.attachment_mm, 0.0);
    assert_eq!(laid.layers[0].len(), 1, "the rail is there, to look at");
    assert_eq!(drawing(&laid_default(&circle)).teeth.len(), 25);
}

#[test]
fn flaw_3_long_teeth_per_edge_close_a_small_hole_and_cross() {
    // A ring wall of 2 mm, teeth that bite 3 mm: tips end in the hole.
    let thin = frame(90.0, 90.0, 30.0, 30.0, 2.0);
    let mut settings = options(AdhesionKind::Teeth);
    settings.teeth.height = 5.0;
    settings.teeth.placement = Placement::PerEdge;
    let through = lay(&thin, &settings);
    assert!(drawing(&through).teeth.iter().any(|t| t.bite < 0.0 && thin.contains(t.foot)));
    // Along the contour they stop half-way through the wall, and are counted as shallow.
    settings.teeth.placement = Placement::AlongContour;
    let stopped = lay(&thin, &settings);
    let figures = stopped.figures.teeth.expect("teeth");
    assert_eq!(figures.shallow, figures.placed);
    assert!(figures.placed >= 20 && (figures.bite_max_mm - 1.0).abs() < 0.05, "{figures:?}");
    assert_eq!(broken_guarantee(&first_layer(&thin, &PolygonSet::EMPTY), &settings, &stopped), None);
}

#[test]
fn a_notched_part_gets_its_inner_corner_right() {
    // The rail of an L runs into the notch: two edges end there. Per edge, all tips on the L's own
    // sides bite 0.4 but those past a convex corner.
    let l = rectangle(90.0, 90.0, 40.0, 15.0).union(&rectangle(90.0, 90.0, 15.0, 40.0));
    let laid = per_edge(&l);
    let teeth = &drawing(&laid).teeth;
    // Rail edges 44, 19, 25, 25, 19, 44: 8 + 3 + 5 + 5 + 3 + 8.
    assert_eq!(teeth.len(), 32);
    assert!(teeth.iter().all(|t| t.bite < 0.0 || (t.bite - 0.4).abs() < 1e-9));
}
