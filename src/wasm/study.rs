//! What the page's panels and lessons show: pictures with their figures, as JSON.

use serde::Serialize;
use std::collections::BTreeMap;

use super::convert::{job_error, now};
use super::error::{Thrown, internal_error, usage_error};
use crate::adhesion::Recommendation;
use crate::orientation::OrientationReport;
use crate::pipeline::{AdhesionReport, Job};
use crate::polygon::{Contour, PolygonSet};
use crate::slice::Axis;
use crate::support::points::{Foot, PointType};
use crate::support::{SupportMethod, SupportOptions, sheets};
use crate::view::job::examine_job_plane;
use crate::view::{Paper, PlaneDetail, Scene, Step, lesson as lessons};

#[derive(Serialize)]
struct BaseLayer {
    #[serde(flatten)]
    report: AdhesionReport,
    svg: String,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct BaseLayers {
    recommendation: Recommendation,
    kinds: Vec<BaseLayer>,
}

pub(super) fn base_layers(job: &Job, paper: Paper) -> Result<String, Thrown> {
    let found = job.first_print().alternatives(&now).map_err(job_error)?;
    let pictures = Scene::of_alternatives(&found);
    let kind = |(kind, picture): (&crate::pipeline::Alternative, Scene)| BaseLayer {
        report: kind.report,
        svg: picture.to_svg_on(paper),
        warnings: kind.foundation.warnings.iter().map(|w| w.message.clone()).collect(),
    };
    let kinds = found.kinds.iter().zip(pictures).map(kind).collect();
    json(&BaseLayers { recommendation: found.recommendation, kinds })
}

#[derive(Serialize)]
struct PlaneStudy {
    svg: String,
    area_mm2: f64,
    at_zero_mm2: f64,
    s: usize,
    type_a: usize,
    g: usize,
}

pub(super) fn plane(job: &Job, plane: &str, paper: Paper) -> Result<String, Thrown> {
    let found = examine_job_plane(job, plane).map_err(usage_error)?;
    json(&PlaneStudy {
        svg: Scene::of_plane(&found, PlaneDetail::Region).to_svg_on(paper),
        area_mm2: found.support.area() + 0.0,
        at_zero_mm2: found.at_zero.area() + 0.0,
        s: found.points.len(),
        type_a: found.points.iter().filter(|p| p.kind == PointType::A).count(),
        g: found.points.iter().filter(|p| matches!(p.foot, Foot::G(_))).count(),
    })
}

#[derive(Serialize)]
struct Sheet {
    axis: &'static str,
    at_mm: f64,
    /// Islands, each an outer contour and its holes, as flat lists u0, z0, u1, z1, ... in mm.
    islands: Vec<Vec<Vec<f64>>>,
}

pub(super) fn sheets_of(job: &Job) -> Result<String, Thrown> {
    let options = SupportOptions { method: SupportMethod::Plates, ..job.settings().support.clone() };
    let supports = job.first_print().supports(&options).map_err(job_error)?;
    let found = sheets(job.mesh(), &options, &supports.report().plates);
    let sheet = |s: &crate::support::Sheet| Sheet {
        axis: if s.axis == Axis::X { "x" } else { "y" },
        at_mm: s.at,
        islands: islands(&s.area),
    };
    json(&found.iter().map(sheet).collect::<Vec<_>>())
}

fn islands(area: &PolygonSet) -> Vec<Vec<Vec<f64>>> {
    let flat = |c: &Contour| c.points.iter().flat_map(|p| [p.x, p.y]).collect();
    area.islands().iter().map(|i| i.contours().map(flat).collect()).collect()
}

#[derive(Serialize)]
struct LessonStep {
    id: &'static str,
    svgs: Vec<String>,
    facts: BTreeMap<&'static str, f64>,
}

pub(super) fn lesson(job: &Job, lesson: &str, at: &str, paper: Paper) -> Result<String, Thrown> {
    let steps = match lesson {
        "teeth" => lessons::teeth(job).map_err(job_error)?,
        "plates" => lessons::plates(job, at).map_err(job_error)?,
        "features" => lessons::features(job, at.parse::<usize>().ok().map(|layer| layer.saturating_sub(1))),
        other => return Err(usage_error(format!("{other}: there is no such lesson"))),
    };
    steps_json(steps, paper)
}

pub(super) fn orientation_steps(report: &OrientationReport, paper: Paper) -> Result<String, Thrown> {
    steps_json(lessons::orientation(report), paper)
}

fn steps_json(steps: Vec<Step>, paper: Paper) -> Result<String, Thrown> {
    let step = |step: Step| LessonStep {
        id: step.id,
        svgs: step.pictures.iter().map(|p| p.to_svg_on(paper)).collect(),
        facts: step.facts,
    };
    json(&steps.into_iter().map(step).collect::<Vec<_>>())
}

fn json(value: &impl Serialize) -> Result<String, Thrown> {
    serde_json::to_string(value).map_err(internal_error)
}
