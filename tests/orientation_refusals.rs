//! Models and settings that no orientation can be proposed for, and those that come with a remark.

mod orientation_shapes;

use foothold::mesh::Mesh;
use foothold::orientation::{
    OrientationError, OrientationOptions, OrientationReport, candidates, choose, evaluate, orient,
};
use orientation_shapes::{cuboid, frustum};

fn options() -> OrientationOptions {
    OrientationOptions { hull_directions: 0, ..OrientationOptions::default() }
}

fn run(mesh: &Mesh) -> Result<OrientationReport, OrientationError> {
    orient(mesh, &options(), &mut |_, _| true)
}

fn message(mesh: &Mesh) -> String {
    run(mesh).expect_err("the model cannot be used").to_string()
}

#[test]
fn an_empty_model() {
    assert_eq!(run(&Mesh::default()), Err(OrientationError::Empty));
    assert_eq!(message(&Mesh::default()), "the model has no triangles");
}

#[test]
fn a_flat_model() {
    let mut flat = cuboid([0.0; 3], [10.0; 3]);
    flat.vertices.iter_mut().for_each(|v| v.z = 3.0);
    assert_eq!(run(&flat), Err(OrientationError::Flat));
}

#[test]
fn a_sheet_that_stands_askew_encloses_nothing() {
    let mut sheet = cuboid([0.0, 0.0, 0.0], [10.0, 10.0, 10.0]);
    sheet.vertices.iter_mut().for_each(|v| v.z = v.x + v.y);
    assert_eq!(run(&sheet), Err(OrientationError::NothingInside));
}

#[test]
fn a_giant_model_is_refused_with_its_size() {
    let giant = cuboid([0.0, 0.0, 0.0], [20_000.0, 10.0, 10.0]);
    assert_eq!(message(&giant), "the model reaches 20000 mm from the origin; the limit is 10000 mm");
    let tall = OrientationOptions { layer_height: 0.01, ..options() };
    let found = orient(&cuboid([0.0, 0.0, 0.0], [5000.0, 1.0, 1.0]), &tall, &mut |_, _| true);
    assert!(matches!(found, Err(OrientationError::TooManyLayers { .. })), "{found:?}");
}

#[test]
fn a_vertex_that_is_no_number() {
    for bad in [f32::NAN, f32::INFINITY] {
        let mut mesh = cuboid([0.0, 0.0, 0.0], [10.0, 10.0, 10.0]);
        mesh.vertices[3].y = bad;
        assert_eq!(run(&mesh), Err(OrientationError::NotFinite));
    }
}

#[test]
fn layers_thicker_than_the_part() {
    let thin = cuboid([0.0, 0.0, 0.0], [10.0, 10.0, 0.125]);
    assert_eq!(
        message(&thin),
        "layers of 0.2 mm are thicker than the part, which measures 0.125 mm on one side"
    );
}

#[test]
fn options_out_of_range() {
    let steep = OrientationOptions { self_support_angle_deg: 60.0, ..options() };
    let found = orient(&cuboid([0.0; 3], [10.0; 3]), &steep, &mut |_, _| true).unwrap_err().to_string();
    assert_eq!(found, "orientation.self_support_angle_deg: 60 is outside 0 to 45 degrees");
}

#[test]
fn an_open_model_gets_figures_and_a_remark() {
    let mut open = cuboid([0.0; 3], [10.0; 3]);
    open.triangles.pop();
    let report = run(&open).expect("an opening is closed");
    assert!(report.remarks.iter().any(|r| r.code == "orientation_open_mesh"), "{:?}", report.remarks);
    assert!(report.directions.iter().all(|d| d.total_mm3.is_finite()));
}

#[test]
fn figures_that_are_no_numbers_never_reach_the_network() {
    let mesh = cuboid([0.0; 3], [10.0; 3]);
    let all = candidates(&mesh, &options()).unwrap();
    let figures: Vec<_> =
        all.iter().map(|d| evaluate(&mesh, d, &options(), &mut |_, _| true).unwrap()).collect();
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let mut spoiled = figures.clone();
        spoiled[3].total_mm3 = bad;
        assert!(matches!(choose(spoiled, &options()), Err(OrientationError::BadFigures { .. })));
    }
    let missing = figures[1..].to_vec();
    assert_eq!(choose(missing, &options()), Err(OrientationError::BadFigures { id: 1 }));
}

#[test]
fn cancelling_stops_at_once_and_progress_reaches_the_end() {
    let mesh = frustum(5.0, 15.0, 20.0);
    let mut calls = 0;
    let stopped = orient(&mesh, &options(), &mut |_, _| {
        calls += 1;
        calls < 10
    });
    assert_eq!((stopped, calls), (Err(OrientationError::Cancelled), 10));
    let (mut last, mut rising) = ((0, 1), true);
    orient(&mesh, &options(), &mut |done, total| {
        rising &= done >= last.0;
        last = (done, total);
        true
    })
    .unwrap();
    assert!(rising);
    assert_eq!(last.0, last.1);
}

fn job_of(mesh: &Mesh, sets: &[&str]) -> Result<foothold::pipeline::Job, foothold::pipeline::JobError> {
    use foothold::pipeline::{Job, NamedModel};
    let model = foothold::mesh::load(&foothold::mesh::stl::write_binary(mesh)).expect("a good mesh");
    let settings = foothold::settings::Settings::resolve([], sets.iter().copied()).expect("good settings");
    Job::new(&[NamedModel::new("part", model)], settings, &|| 0.0)
}

#[test]
fn a_part_that_cannot_be_compared_is_printed_as_it_lies() {
    let sheet = cuboid([0.0; 3], [10.0, 20.0, 0.15]);
    let mut job =
        job_of(&sheet, &["orientation.mode=auto", "layers.first_height=0.15"]).expect("it lies flat");
    job.prepare(&|| 0.0).expect("good settings");
    job.add(job.slice(0, job.layer_count(), &|| 0.0).meta);
    let report = job.finish(&|| 0.0).expect("all layers are there").report;
    let told: Vec<&str> = report.warnings.iter().map(|w| w.code.as_str()).collect();
    assert_eq!(told, ["orientation_kept"]);
    assert_eq!(
        report.warnings[0].message,
        "part: layers of 0.2 mm are thicker than the part, which measures 0.15000000596046448 mm on one side; \
         it is printed as it lies"
    );
    assert!(report.orientation.is_none());
}
