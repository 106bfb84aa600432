//! Pictures of a job that has not been sliced yet.

use std::fmt;

use super::base_layer::{teeth_items, teeth_key};
use super::plane::PlaneDetail;
use super::scene::Scene;
use super::svg::Paper;
use crate::gcode::LayerSummary;
use crate::gcode::read::{self, ReadLayer};
use crate::pipeline::{Clock, Job};
use crate::polygon::DVec2;
use crate::slice::{Axis, slice_mesh};
use crate::support::{PlanePicture, examine_plane};

/// A plane that cannot be drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaneError {
    /// Not of the form `x=NUMBER` or `y=NUMBER`.
    NotAPlane {
        /// The text found.
        text: String,
    },
    /// The plane does not meet the part.
    Beside {
        /// The plane.
        text: String,
        /// Where the part is along the plane's normal, mm.
        low: f32,
        /// The other end, mm.
        high: f32,
    },
}

impl fmt::Display for PlaneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlaneError::NotAPlane { text } => write!(f, "{text}: expected a plane such as y=12.5"),
            PlaneError::Beside { text, low, high } => {
                write!(f, "{text}: the part reaches from {low} to {high} mm on the bed")
            }
        }
    }
}

impl std::error::Error for PlaneError {}

impl Scene {
    /// Layer `index` of the job, sliced for this picture alone, with the outline it was made from;
    /// `None` if there is no such layer.
    pub fn of_job_layer(job: &Job, index: usize, clock: Clock) -> Option<Scene> {
        let (print, place) = job.print_of(index)?;
        let sliced = job.slice(index, index + 1, clock);
        let layer = read_alone(sliced.texts.first()?, sliced.meta.summaries.first()?, job);
        let section = slice_mesh(print.mesh(), Axis::Z, &[print.specs()[place].slice_z], 0.0).pop()?;
        let mut scene = Scene::of_layer(&layer, &job.settings().printer, Some(&section.area));
        if let Some(teeth) = print.teeth_drawing().filter(|_| place == 0) {
            scene.items.extend(teeth_items(teeth));
            scene = scene.with_key(&teeth_key(teeth), Paper::FILE);
        }
        Some(scene)
    }

    /// The job's parts cut by a vertical plane such as `y=12.5`, in bed coordinates: section, what hangs,
    /// S-, IO- and G-points, and what supports would fill.
    pub fn of_job_plane(job: &Job, plane: &str) -> Result<Scene, PlaneError> {
        Ok(Scene::of_plane(&examine_job_plane(job, plane)?, PlaneDetail::Region))
    }
}

/// The plane of the job that `plane`, such as `y=12.5`, names.
pub fn examine_job_plane(job: &Job, plane: &str) -> Result<PlanePicture, PlaneError> {
    let (axis, at) = parse_plane(plane).ok_or_else(|| PlaneError::NotAPlane { text: plane.to_owned() })?;
    let found = examine_plane(job.mesh(), &job.settings().support, axis, at);
    match job.mesh().bounds() {
        Some(b) if found.section.is_empty() => {
            let (low, high) = (axis.height(b.min), axis.height(b.max));
            Err(PlaneError::Beside { text: plane.to_owned(), low, high })
        }
        _ => Ok(found),
    }
}

/// A layer's text read without the file around it, which sets the extruder's mode and brings the
/// nozzle to the first bead.
fn read_alone(text: &[u8], summary: &LayerSummary, job: &Job) -> ReadLayer {
    let start = summary.stops.map_or(DVec2::ZERO, |stops| stops.start);
    let LayerSummary { print_z, height, .. } = summary;
    let mut whole =
        format!("M83\n;HEIGHT:{height}\nG1 X{:.3} Y{:.3} Z{print_z}\n", start.x, start.y).into_bytes();
    whole.extend_from_slice(text);
    let mut file = read::read(&whole, job.settings().filament.diameter);
    file.layers.pop().unwrap_or(file.prelude)
}

/// Axis and place of a plane such as `y=12.5`.
pub(super) fn parse_plane(text: &str) -> Option<(Axis, f64)> {
    let (name, at) = text.split_once('=')?;
    let axis = match name.trim() {
        "x" => Axis::X,
        "y" => Axis::Y,
        _ => return None,
    };
    at.trim().parse().ok().filter(|at: &f64| at.is_finite()).map(|at| (axis, at))
}
