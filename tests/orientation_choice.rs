//! What is held, what is not, and which way up is chosen.

mod common;
mod orientation_shapes;

use foothold::orientation::{
    Candidates, OrientationOptions, OrientationReport, candidates, choose, evaluate, orient,
};
use glam::DVec3;
use orientation_shapes::{
    cuboid, frustum, inside_out, octahedron, part_model_1, prism, random_from, random_rotation, rotated,
    together,
};

fn report(mesh: &foothold::mesh::Mesh, options: &OrientationOptions) -> OrientationReport {
    orient(mesh, options, &mut |_, _| true).expect("the model is sound")
}

fn at(layer_height: f64) -> OrientationOptions {
    OrientationOptions { layer_height, hull_directions: 0, ..OrientationOptions::default() }
}

/// Half sides of a frustum that opens upward by this angle from the vertical over 20 mm.
fn leaning(angle_deg: f64) -> foothold::mesh::Mesh {
    frustum(10.0, 10.0 + 20.0 * foothold::polygon::trig::tan(angle_deg.to_radians()), 20.0)
}

#[test]
fn a_frustum_of_44_degrees_holds_itself() {
    // With round joins the corners poke out and whole rings count: 3,636 mm3 in one trial.
    for layer_height in [0.05, 0.1, 0.2, 0.3] {
        for angle in [30.0, 44.0, 45.0] {
            let figures = report(&leaning(angle), &at(layer_height)).directions[0];
            assert_eq!(figures.support_mm3, 0.0, "{angle} degrees, layers of {layer_height}");
            assert_eq!(figures.structures, 1);
        }
    }
}

#[test]
fn a_frustum_of_46_degrees_does_not() {
    for layer_height in [0.05, 0.1, 0.2, 0.3] {
        let figures = report(&leaning(46.0), &at(layer_height)).directions[0];
        // Half the frustum's own overhang volume: the prism over the top minus the frustum.
        let (a, b) = (20.0, 20.0 + 40.0 * 1.0355303);
        let expected = b * b * 20.0 - 20.0 / 3.0 * (a * a + a * b + b * b);
        assert!((figures.support_mm3 / expected - 1.0).abs() < 0.02, "{} {expected}", figures.support_mm3);
        assert_eq!(figures.structures, 2);
    }
}

#[test]
fn a_cone_of_45_degrees_holds_itself_however_finely_it_is_meshed() {
    // Its sections are simplified before they are compared, each in its own way.
    for sides in [32, 128, 512] {
        let circle = common::circle(glam::DVec2::ZERO, 10.0, sides);
        let figures = report(&common::frustum(&circle, 20.0, 3.0), &at(0.2)).directions[0];
        assert_eq!(figures.support_mm3, 0.0, "{sides} sides");
    }
}

#[test]
fn a_smaller_self_support_angle_asks_for_more() {
    let strict = OrientationOptions { self_support_angle_deg: 30.0, ..at(0.2) };
    assert!(report(&leaning(44.0), &strict).directions[0].support_mm3 > 1000.0);
    let bare = OrientationOptions { self_support_angle_deg: 0.0, ..at(0.2) };
    assert!(report(&leaning(5.0), &bare).directions[0].support_mm3 > 100.0);
}

#[test]
fn the_layers_of_a_slanted_support_hang_together() {
    // Turned at random, part model 1 once had 129 structures: one for each layer of a slanted face.
    for seed in 1..4 {
        let turn = random_rotation(random_from(seed));
        let found = report(&rotated(&part_model_1(), turn), &at(0.2));
        assert!(
            found.directions.iter().all(|d| d.structures <= 4 && d.specks <= 2),
            "{:#?}",
            found.directions
        );
    }
}

#[test]
fn a_t_shape_lies_down() {
    let t = prism(
        &[
            [0.0, 30.0],
            [15.0, 30.0],
            [15.0, 0.0],
            [25.0, 0.0],
            [25.0, 30.0],
            [40.0, 30.0],
            [40.0, 35.0],
            [0.0, 35.0],
        ],
        20.0,
    );
    let found = report(&t, &at(0.2));
    assert!((found.directions[0].support_mm3 - 18_000.0).abs() < 1e-6);
    assert_eq!(found.directions[0].structures, 3);
    // Head down nothing hangs; on its side the column is short of the flange by 15.
    assert_eq!(found.directions[1].support_mm3, 0.0);
    assert_eq!(found.exact, found.o1);
    assert!(found.directions.iter().all(|d| d.total_mm3 >= found.chosen_figures().unwrap().total_mm3 - 0.01));
}

#[test]
fn a_cavity_needs_support_inside_and_scars_its_ceiling() {
    let hollow = together(&[cuboid([0.0; 3], [20.0; 3]), inside_out(cuboid([5.0; 3], [15.0; 3]))]);
    let figures = report(&hollow, &at(0.2)).directions[0];
    assert!((figures.support_mm3 - 1000.0).abs() < 1e-6, "{figures:?}");
    assert_eq!(figures.structures, 2);
    // Ceiling and floor, 100 mm2 each.
    assert!((figures.scarred_mm2 - 200.0).abs() < 1e-9);
}

#[test]
fn figures_of_a_part_that_needs_nothing() {
    let figures = report(&cuboid([0.0; 3], [10.0, 20.0, 40.0]), &at(0.2)).directions[0];
    assert_eq!((figures.support_mm3, figures.structures, figures.scarred_mm2), (0.0, 1, 0.0));
    assert!((figures.base_mm3 - 200.0).abs() < 1e-9);
    assert!((figures.bed_contact_mm2 - 200.0).abs() < 1e-9);
    assert_eq!((figures.height_mm, figures.layers), (40.0, 200));
    assert!((figures.support_filament_mm - 200.0 / 2.405282).abs() < 1e-3);
}

#[test]
fn an_octahedron_is_laid_on_a_side() {
    let options = OrientationOptions { hull_directions: 30, ..at(0.2) };
    let found = report(&octahedron(15.0), &options);
    let ids: Vec<u32> = found.directions.iter().map(|d| d.id).collect();
    assert_eq!(ids, (1..=14).collect::<Vec<_>>());
    for figures in &found.directions[6..] {
        assert!((DVec3::from(figures.up).abs() - DVec3::splat(1.0 / 3f64.sqrt())).length() < 1e-6);
        // A side is a triangle of 15 sqrt(2): it stands on nearly all of it.
        assert!((figures.bed_contact_mm2 / 194.86 - 1.0).abs() < 0.03, "{figures:?}");
    }
}

#[test]
fn beaten_directions_are_not_on_the_front() {
    let found = report(&part_model_1(), &at(0.2));
    assert_eq!(
        found.directions.iter().map(|d| d.pareto).collect::<Vec<_>>(),
        [false, false, false, false, true, true]
    );
}

#[test]
fn directions_may_be_computed_anywhere_in_any_order() {
    let (mesh, options) = (part_model_1(), OrientationOptions { hull_directions: 4, ..at(0.2) });
    let mut figures: Vec<_> = candidates(&mesh, &options)
        .unwrap()
        .iter()
        .map(|d| evaluate(&mesh, d, &options, &mut |_, _| true).unwrap())
        .collect();
    figures.reverse();
    assert_eq!(choose(figures, &options).unwrap(), report(&mesh, &options));
}

#[test]
fn the_report_has_the_fields_of_the_product() {
    let text = serde_json::to_value(report(&part_model_1(), &at(0.2))).unwrap();
    let keys: Vec<&str> = text.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys, ["chosen", "directions", "exact", "layer_height_mm", "o1", "o2", "r"]);
    for key in ["id", "up", "support_mm3", "base_mm3", "total_mm3", "structures", "specks"] {
        assert!(!text["directions"][0][key].is_null(), "{key}");
    }
    assert_eq!(text["chosen"], 5);
    assert_eq!(text["o2"], serde_json::json!([0, 0, 0, 0, 1, 0]));
}

#[test]
fn a_side_of_the_hull_is_chosen_only_where_that_is_allowed() {
    let axes = OrientationOptions { hull_directions: 30, ..at(0.2) };
    let hull = OrientationOptions { candidates: Candidates::Hull, ..axes.clone() };
    let askew = rotated(&part_model_1(), random_rotation(random_from(1)));
    let (by_axes, by_hull) = (report(&askew, &axes), report(&askew, &hull));
    assert_eq!(by_axes.directions, by_hull.directions);
    assert!((1..=6).contains(&by_axes.chosen) && by_axes.o2[by_axes.chosen as usize - 1] == 1);
    assert!(by_hull.chosen > 6);
    let least = by_hull.directions.iter().map(|d| d.total_mm3).fold(f64::INFINITY, f64::min);
    assert!(by_hull.chosen_figures().unwrap().total_mm3 <= least + 0.01);
    assert_eq!(axes.for_choice().hull_directions, 0);
    assert_eq!(hull.for_choice(), hull);
}
