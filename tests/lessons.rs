//! The lessons' pictures and facts on parts whose numbers are known on paper.

mod common;

use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::orientation::{OrientationOptions, orient};
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;
use foothold::view::lesson;
use foothold::view::{Ink, Item, Paper, Scene, Step};
use glam::{Vec3, dvec2, vec3};

fn job(mesh: &Mesh, sets: &[&str]) -> Job {
    let model = load(&write_binary(mesh)).expect("a good mesh");
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    Job::new(&[NamedModel::new("part", model)], settings, &|| 0.0).expect("it fits")
}

/// Column 10 x 20 x 30 in the middle, top 40 x 20 x 5 on it: a profile in (x, z), 20 long along y.
fn t_shape() -> Mesh {
    let corners = [(15, 0), (25, 0), (25, 30), (40, 30), (40, 35), (0, 35), (0, 30), (15, 30)];
    let profile = corners.map(|(x, z)| dvec2(f64::from(x), f64::from(z)));
    let lying = common::prism(&profile, &[], 0.0, 20.0);
    let upright = |v: &Vec3| vec3(v.x, -v.z, v.y);
    Mesh { vertices: lying.vertices.iter().map(upright).collect(), ..lying }
}

fn dots(scene: &Scene, wanted: Ink) -> usize {
    let is_wanted = |item: &&Item| matches!(item, Item::Dot { ink, .. } if *ink == wanted);
    scene.items.iter().filter(is_wanted).count()
}

fn step<'a>(steps: &'a [Step], id: &str) -> &'a Step {
    steps.iter().find(|s| s.id == id).unwrap_or_else(|| panic!("there is no step {id}"))
}

fn assert_fact(step: &Step, name: &str, expected: f64, within: f64) {
    let found = step.facts[name];
    assert!((found - expected).abs() <= within, "{} {name}: {found}, not {expected}", step.id);
}

#[test]
fn teeth_of_the_worked_example() {
    // 40 x 30: rail 44 x 34, N = 8 and 6, 28 teeth, path 226.185 mm, four tips past the part.
    let block = common::cuboid(Vec3::ZERO, vec3(40.0, 30.0, 5.0));
    let steps = lesson::teeth(&job(&block, &["first_layer.elephant_foot=0"])).expect("good settings");
    let ids: Vec<&str> = steps.iter().map(|s| s.id).collect();
    assert_eq!(ids, ["outline", "offset", "simplify", "divide", "tips", "path", "compare"]);
    assert_fact(step(&steps, "outline"), "length", 140.0, 1e-6);
    assert_fact(step(&steps, "divide"), "teeth", 28.0, 0.0);
    let tips = step(&steps, "tips");
    assert_fact(tips, "biting", 24.0, 0.0);
    assert_fact(tips, "outside", 4.0, 0.0);
    // The picture shows what the facts say.
    assert_eq!(dots(&tips.pictures[0], Ink::Tip), 24);
    assert_eq!(dots(&tips.pictures[0], Ink::TipOutside), 4);
    assert_fact(step(&steps, "path"), "length", 226.185, 5e-4);
    let compare = step(&steps, "compare");
    assert_eq!(compare.pictures.len(), 2);
    assert_eq!(compare.facts["ours"], compare.facts["ours_biting"]);
    assert_eq!(dots(&compare.pictures[1], Ink::Tip) as f64, compare.facts["ours"]);
    assert_eq!(dots(&compare.pictures[1], Ink::TipOutside), 0);
    assert_fact(compare, "bite_min", 0.4, 0.05);
}

#[test]
fn a_fine_circle_has_none_of_the_papers_teeth() {
    let disc = common::cylinder(20.0, 3.0, 256);
    let steps = lesson::teeth(&job(&disc, &[])).expect("good settings");
    let divide = step(&steps, "divide");
    assert_eq!((divide.facts["teeth"], divide.facts["short_edges"]), (0.0, divide.facts["edges"]));
    assert!(step(&steps, "compare").facts["ours"] > 20.0);
}

#[test]
fn plates_under_a_t() {
    let sets = ["support.plates.spacing_x=5", "support.plates.spacing_y=5", "support.overhang_angle_deg=0"];
    // The part stands in the middle of the bed: y = 110 cuts it half-way, x from 90 to 130.
    let steps = lesson::plates(&job(&t_shape(), &sets), "y=110").expect("good settings");
    let ids: Vec<&str> = steps.iter().map(|s| s.id).collect();
    assert_eq!(ids, ["plane", "contour", "points", "region", "crossing"]);
    // Four planes across y, six of the eight across x.
    assert_fact(step(&steps, "plane"), "planes", 10.0, 0.0);
    assert_fact(step(&steps, "contour"), "hanging", 30.0, 1e-3);
    let points = step(&steps, "points");
    // Both ends of the top, over the bed.
    assert_fact(points, "s", 2.0, 0.0);
    assert_fact(points, "g", 2.0, 0.0);
    assert_eq!(dots(&points.pictures[0], Ink::SPointA), 2);
    assert_eq!(dots(&points.pictures[0], Ink::GPoint), 2);
    assert_fact(step(&steps, "region"), "area", 900.0, 1e-3);
    let crossing = step(&steps, "crossing");
    assert_fact(crossing, "complete", 18_000.0, 180.0);
    assert_fact(crossing, "plates", 10.0, 0.0);
    let sheets = crossing.pictures[0].items.iter();
    let sheets = sheets.filter(|i| matches!(i, Item::Area { ink: Ink::Sheet, .. })).count();
    assert_eq!(sheets, 10);
}

#[test]
fn features_of_a_t() {
    let steps = lesson::features(&job(&t_shape(), &[]), None);
    let ids: Vec<&str> = steps.iter().map(|s| s.id).collect();
    assert_eq!(ids, ["layers", "grown", "overhang", "regions", "structures"]);
    // Layer 150 is the last of the column: 10 x 20 under 40 x 20.
    let layers = step(&steps, "layers");
    assert_fact(layers, "layer", 150.0, 0.0);
    assert_fact(layers, "below", 200.0, 1e-6);
    assert_fact(layers, "above", 800.0, 1e-6);
    // Grown by 0.2 all round at 45 degrees.
    assert_fact(step(&steps, "grown"), "grown", 10.4 * 20.4, 0.05);
    let overhang = step(&steps, "overhang");
    assert_fact(overhang, "features", 2.0, 0.0);
    assert_fact(overhang, "area", 600.0, 1e-3);
    assert_fact(overhang, "held", 0.0, 1e-3);
    // Two supports of 15 x 20 x 30 and the base of 5 layers under 40 x 20.
    assert_fact(step(&steps, "regions"), "volume", 18_000.0, 1.0);
    let structures = step(&steps, "structures");
    assert_fact(structures, "structures", 3.0, 0.0);
    assert_fact(structures, "base", 5.0 * 0.2 * 800.0, 0.5);
    let colours = structures.pictures[0].items.iter().filter_map(|item| match item {
        Item::Area { ink: Ink::Structure(index), .. } => Some(*index),
        _ => None,
    });
    assert_eq!(colours.collect::<std::collections::BTreeSet<u8>>().len(), 2);
}

#[test]
fn orientation_of_a_t() {
    let model = load(&write_binary(&t_shape())).expect("a good mesh");
    let options = OrientationOptions { hull_directions: 0, ..OrientationOptions::default() };
    let report = orient(&model.mesh, &options, &mut |_, _| true).expect("a good part");
    let steps = lesson::orientation(&report);
    let ids: Vec<&str> = steps.iter().map(|s| s.id).collect();
    assert_eq!(ids, ["volumes", "matrix", "network", "choice"]);
    let choice = step(&steps, "choice");
    assert_fact(choice, "chosen", f64::from(report.chosen), 0.0);
    // Upside down or on a side it needs no support but the base.
    assert!(choice.facts["volume"] < step(&steps, "volumes").facts["largest"] / 5.0);
    let cells = step(&steps, "matrix").pictures[0].items.iter();
    assert_eq!(cells.filter(|i| matches!(i, Item::Area { ink: Ink::Share(_), .. })).count(), 36);
    assert!(
        lesson::orientation(&foothold::orientation::OrientationReport { directions: vec![], ..report })
            .is_empty()
    );
}

#[test]
fn pictures_are_well_formed_and_escaped() {
    let steps = lesson::plates(&job(&t_shape(), &[]), "").expect("good settings");
    for picture in steps.iter().flat_map(|s| &s.pictures) {
        for dark in [false, true] {
            let svg = picture.to_svg_on(Paper::inline(400.0, dark));
            assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            assert!(!svg.contains("#fff\""), "no ground of its own");
        }
    }
}
