//! Thin plates step by step [Zhao]: plane, contour, points, region, crossing.

use super::Step;
use super::stack::{Stack, shown};
use crate::pipeline::{Job, JobError};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet, dvec2};
use crate::slice::Axis;
use crate::support::points::{Foot, PointType};
use crate::support::{PlanePicture, SupportMethod, SupportOptions, Supports, examine_plane, sheets};
use crate::view::base_layer::{bead, outline_strokes};
use crate::view::job::parse_plane;
use crate::view::plane::PlaneDetail;
use crate::view::scene::{Ink, Item, LineWidth, Scene};

/// Free space around the view from above, mm.
const MARGIN_MM: f64 = 3.0;

/// The steps for a plane such as `y=110`, or for the plane through the middle of the part.
pub fn plates(job: &Job, plane: &str) -> Result<Vec<Step>, JobError> {
    let options = SupportOptions { method: SupportMethod::Plates, ..job.settings().support.clone() };
    let areas = job.first_print().areas();
    let supports = job.first_print().supports(&options)?;
    let (axis, at) = parse_plane(plane).unwrap_or_else(|| (Axis::Y, middle(job)));
    let picture = examine_plane(job.mesh(), &options, axis, at);
    Ok(vec![
        plane_step(&areas, &supports, axis, at),
        contour_step(&picture),
        points_step(&picture),
        region_step(&picture, &options),
        crossing_step(job, &areas, &supports, &options),
    ])
}

fn middle(job: &Job) -> f64 {
    job.mesh().bounds().map_or(0.0, |b| f64::from((b.min.y + b.max.y) / 2.0))
}

/// From above: the part, the planes, and the one that is looked at.
fn plane_step(areas: &[PolygonSet], supports: &Supports, axis: Axis, at: f64) -> Step {
    let shadow = PolygonSet::union_all(shown(areas.len()).map(|k| &areas[k]));
    let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
    let bounds = shadow.bounds().unwrap_or(nothing).grown(MARGIN_MM);
    let mut items = vec![Item::Area { area: shadow.clone(), ink: Ink::Part }];
    items.extend(outline_strokes(&shadow, Ink::Outline, 1.2));
    let line = |axis: Axis, at: f64, ink, px| {
        let (a, b) = match axis {
            Axis::X => (dvec2(at, bounds.min.y), dvec2(at, bounds.max.y)),
            Axis::Y | Axis::Z => (dvec2(bounds.min.x, at), dvec2(bounds.max.x, at)),
        };
        Item::Stroke { points: vec![a, b], closed: false, width: LineWidth::Px(px), ink }
    };
    let plates = &supports.report().plates;
    items.extend(plates.iter().map(|p| line(p.axis.into(), p.at_mm, Ink::Guide, 1.2)));
    items.push(line(axis, at, Ink::Plane, 3.0));
    let facts = [("planes", plates.len() as f64), ("at", at), ("along_x", f64::from(axis == Axis::X))];
    Step::new("plane", Scene { items, bounds }, facts)
}

fn contour_step(picture: &PlanePicture) -> Step {
    let hanging: f64 = picture.hanging.iter().map(|(a, b)| a.distance(*b)).sum();
    let facts = [
        ("contours", picture.section.contours().len() as f64),
        ("area", picture.section.area()),
        ("hanging", hanging),
    ];
    Step::new("contour", Scene::of_plane(picture, PlaneDetail::Section), facts)
}

fn points_step(picture: &PlanePicture) -> Step {
    let points = &picture.points;
    let of_type = |kind| points.iter().filter(|p| p.kind == kind).count() as f64;
    let on_bed = points.iter().filter(|p| matches!(p.foot, Foot::G(_))).count() as f64;
    let facts = [
        ("s", points.len() as f64),
        ("type_a", of_type(PointType::A)),
        ("type_b", of_type(PointType::B)),
        ("io", points.len() as f64 - on_bed),
        ("g", on_bed),
    ];
    Step::new("points", Scene::of_plane(picture, PlaneDetail::Points), facts)
}

fn region_step(picture: &PlanePicture, options: &SupportOptions) -> Step {
    let facts = [
        ("area", picture.support.area() + 0.0),
        ("at_zero", picture.at_zero.area() + 0.0),
        ("angle", options.overhang_angle_deg),
    ];
    Step::new("region", Scene::of_plane(picture, PlaneDetail::Region), facts)
}

/// All plates as sheets, and the layer in which most of them cross.
fn crossing_step(job: &Job, areas: &[PolygonSet], supports: &Supports, options: &SupportOptions) -> Step {
    let report = supports.report();
    let facts = [
        ("plates", report.plates.len() as f64),
        ("added", report.planes_added as f64),
        ("pieces", report.pieces as f64),
        ("volume", report.volume_mm3),
        ("complete", report.complete_volume_mm3),
    ];
    let mut stack = Stack::new();
    for k in shown(areas.len()) {
        stack.level(&areas[k], job.first_print().part_heights()[k], Ink::Part);
    }
    for sheet in sheets(job.mesh(), options, &report.plates) {
        stack.upright(&sheet.area, sheet.axis, sheet.at, Ink::Sheet);
    }
    let step = Step::new("crossing", stack.into_scene(), facts);
    let most = (0..areas.len()).max_by_key(|&k| (supports.layer_paths(k).len(), areas.len() - k));
    match most {
        Some(layer) if !report.plates.is_empty() => {
            step.beside(layer_from_above(&areas[layer], supports, layer))
        }
        _ => step,
    }
}

fn layer_from_above(area: &PolygonSet, supports: &Supports, layer: usize) -> Scene {
    let mut items = vec![Item::Area { area: area.clone(), ink: Ink::Part }];
    items.extend(outline_strokes(area, Ink::Outline, 1.2));
    let beads = supports.layer_paths(layer);
    items.extend(beads.iter().map(bead));
    let extent = Bounds::of_points(beads.iter().flat_map(|b| &b.points));
    let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
    let bounds = area.bounds().into_iter().chain(extent).reduce(Bounds::union).unwrap_or(nothing);
    Scene { items, bounds: bounds.grown(MARGIN_MM) }
}
