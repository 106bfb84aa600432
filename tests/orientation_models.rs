//! Real models: the chosen direction needs no more than the one they came in.
//!
//! The models lie beside the checkout and are not part of it; without them nothing is tested.

mod common;

use foothold::mesh::load;
use foothold::orientation::{OrientationOptions, OrientationReport, orient};

/// Sound models of the collection.
const MODELS: [&str; 14] = [
    "cal_cube.stl",
    "bridge_test.stl",
    "hole_test.stl",
    "overhang.stl",
    "support_test.stl",
    "thin_wall.stl",
    "retract_tower.stl",
    "xy_calibration.stl",
    "tolerance.stl",
    "featuretype_mm.stl",
    "idler_riser_mm.stl",
    "angle_block_mm.stl",
    "own_arch_ascii.stl",
    "own_hinge.stl",
];

fn report(path: &std::path::Path, options: &OrientationOptions) -> OrientationReport {
    let bytes = std::fs::read(path).expect("the model can be read");
    let model = load(&bytes).expect("the model is sound");
    orient(&model.mesh, options, &mut |_, _| true).expect("the model can be oriented")
}

#[test]
fn the_chosen_direction_needs_no_more_than_the_original() {
    let Some(folder) = common::models_dir() else { return };
    let long = std::env::var_os("FOOTHOLD_LONG").is_some();
    let hull_directions = if long { 30 } else { 0 };
    let options = OrientationOptions { hull_directions, ..OrientationOptions::default() };
    println!(
        "| model | original: support + base, structures | chosen | support + base, structures | saved | best of the hull |"
    );
    println!("|---|---|---|---|---|---|");
    for name in MODELS {
        let found = report(&folder.join(name), &options);
        let original = &found.directions[0];
        let chosen = found.chosen_figures().expect("the chosen one is among them");
        let hull = found.directions[6..].iter().min_by(|a, b| a.total_mm3.total_cmp(&b.total_mm3));
        let hull = hull.map_or(String::new(), |d| {
            format!("{}: {:.0} + {:.0}, {}", d.id, d.support_mm3, d.base_mm3, d.structures)
        });
        println!(
            "| {name} | {:.1} + {:.1}, {} | {} | {:.1} + {:.1}, {} | {:.0} % | {hull} |",
            original.support_mm3,
            original.base_mm3,
            original.structures,
            found.chosen,
            chosen.support_mm3,
            chosen.base_mm3,
            chosen.structures,
            100.0 * (1.0 - chosen.total_mm3 / original.total_mm3),
        );
        assert!(chosen.total_mm3 <= original.total_mm3 + 0.01, "{name}");
        assert_eq!(found.o1, found.exact, "{name}: the network differs");
    }
}
