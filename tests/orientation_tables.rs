//! The printed tables of [Karim], to the digit.

mod orientation_shapes;

use foothold::orientation::{OrientationOptions, OrientationReport, orient};
use orientation_shapes::part_model_1;

fn paper() -> OrientationOptions {
    OrientationOptions { layer_height: 0.01, hull_directions: 0, ..OrientationOptions::default() }
}

fn report_of_part_1() -> OrientationReport {
    orient(&part_model_1(), &paper(), &mut |_, _| true).expect("the part is sound")
}

#[test]
fn part_model_1_is_the_part_of_the_print() {
    let mesh = part_model_1();
    assert!((mesh.volume() - 1150.0 * 20.0).abs() < 1e-6);
    let size = mesh.bounds().map(|b| b.max - b.min).expect("it has vertices");
    assert_eq!(size.to_array(), [45.0, 20.0, 40.0]);
}

#[test]
fn table_2_to_the_digit() {
    let report = report_of_part_1();
    let totals = [4045.0, 9045.0, 13040.0, 13040.0, 57.5, 57.5];
    for (figures, total) in report.directions.iter().zip(totals) {
        assert!((figures.total_mm3 - total).abs() < 0.01, "{figures:?}");
    }
    assert_eq!(report.directions.iter().map(|d| d.structures).collect::<Vec<_>>(), [3, 2, 4, 4, 1, 1]);
    assert!(report.directions.iter().all(|d| d.specks == 0));
    assert_eq!(report.o1, [0, 0, 0, 0, 1, 1]);
    assert_eq!(report.exact, report.o1);
    assert_eq!(report.r, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    assert_eq!(report.o2, [0, 0, 0, 0, 1, 0]);
    assert_eq!(report.chosen, 5);
}

#[test]
fn table_2_counts_its_layers() {
    let layers: Vec<u32> = report_of_part_1().directions.iter().map(|d| d.layers).collect();
    assert_eq!(layers, [4000, 4000, 4500, 4500, 2000, 2000]);
}
