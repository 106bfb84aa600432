//! Models printed together or one after another: which prints there are, and whether the head can
//! reach each without touching those that are done.

use std::fmt;

use super::print::{Body, Print};
use super::{JobError, NamedModel, checked};
use crate::gcode::Sequence;
use crate::mesh::{Box3, Mesh};
use crate::polygon::hull::convex_hull;
use crate::polygon::simplify::squared_distance_to_segment;
use crate::polygon::{Contour, PolygonSet};
use crate::settings::Settings;
use crate::sort::StableSort;

/// Free space between models that are printed together, mm.
const BETWEEN_MODELS: f64 = 10.0;

/// Added to the space between models that are printed one after another, mm: supports' feet and
/// rounding.
const SPARE: f64 = 1.0;

/// What is no higher than this does not meet the head beside the nozzle, mm: nozzles stick out farther.
const BELOW_HEAD: f64 = 1.0;

/// Why models cannot be printed one after another as they stand.
#[derive(Debug, Clone, PartialEq)]
pub enum SequenceError {
    /// The head would hit a model that is done.
    TooNear {
        /// What is printed before.
        done: String,
        /// What is printed later.
        next: String,
        /// Distance between the two, the later one with its base layer, mm.
        distance: f64,
        /// `printer.extruder_clearance_radius`, mm.
        needed: f64,
    },
    /// The base layers of two models overlap.
    BasesMeet {
        /// What is printed before.
        done: String,
        /// What is printed later.
        next: String,
    },
    /// The gantry would hit a model that is done.
    TooTall {
        /// The model.
        name: String,
        /// Its height, mm.
        height: f64,
        /// `printer.extruder_clearance_height`, mm.
        limit: f64,
    },
}

impl fmt::Display for SequenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SequenceError::TooNear { done, next, distance, needed } => write!(
                f,
                "print.sequence: {done} and {next} are {distance:.1} mm apart, base layer included; to print \
                 one after another the head needs {needed} mm (printer.extruder_clearance_radius)"
            ),
            SequenceError::BasesMeet { done, next } => {
                write!(
                    f,
                    "print.sequence: the base layers of {done} and {next} overlap; move the parts apart"
                )
            }
            SequenceError::TooTall { name, height, limit } => write!(
                f,
                "print.sequence: {name} is {height:.1} mm tall; to print one after another all parts but the \
                 tallest must be below {limit} mm (printer.extruder_clearance_height)"
            ),
        }
    }
}

impl std::error::Error for SequenceError {}

/// The prints of models that stand on the bed as `mesh`, one model's triangles after another's, in
/// printing order: all together, or each by itself, the lowest first.
pub(super) fn prints_of(
    models: &[NamedModel],
    mesh: Mesh,
    settings: &Settings,
) -> Result<Vec<Print>, JobError> {
    let mut end = 0;
    let mut triangles = |model: &NamedModel| {
        let start = end;
        end += model.model.mesh.triangles.len() as u32;
        start..end
    };
    if settings.print.sequence == Sequence::ByLayer || models.len() == 1 {
        let body = |m: &NamedModel| Ok(Body::new(settings_of(m, settings)?, triangles(m)));
        let bodies: Vec<Body> = models.iter().map(body).collect::<Result<_, JobError>>()?;
        // Alone on the plate a model may have its own layers and base.
        let alone = models.len() == 1 && settings.print.sequence == Sequence::ByObject;
        let all = if alone { settings_of(&models[0], settings)? } else { settings.clone() };
        return Ok(vec![Print::new(String::new(), mesh, bodies, all)?]);
    }
    check_settings(settings)?;
    let mut print = |(index, model): (usize, &NamedModel)| {
        let own = mesh.subset(triangles(model).map(|t| t as usize));
        let settings = settings_of(model, settings)?;
        let body = Body::new(settings.clone(), 0..own.triangles.len() as u32);
        Print::new(format!("part {} ({})", index + 1, model.name), own, vec![body], settings)
    };
    let mut prints: Vec<Print> = models.iter().enumerate().map(&mut print).collect::<Result<_, _>>()?;
    prints.stable_sort_by(|a, b| a.top().total_cmp(&b.top()));
    Ok(prints)
}

/// The plate's settings with the model's own over them.
fn settings_of(model: &NamedModel, settings: &Settings) -> Result<Settings, JobError> {
    if model.own.is_empty() {
        return Ok(settings.clone());
    }
    let told = |cause| JobError::OwnSettings { model: model.name.clone(), cause };
    checked(settings.of_model(&model.own).map_err(told)?)
}

/// Refuses what is told of the plate as a whole.
fn check_settings(settings: &Settings) -> Result<(), JobError> {
    let with = |what: &str| {
        let cause = format!("models cannot be printed one after another with {what}");
        Err(JobError::contradiction("print.sequence", cause))
    };
    if !settings.gcode.events.is_empty() {
        return with("pauses and other events at layers (gcode.events)");
    }
    if settings.support.tool > 0 {
        return with("supports of a second extruder (support.tool)");
    }
    Ok(())
}

/// Free space that arranging leaves between boxes of models, mm; `own` are the settings of the models
/// that have their own.
pub(super) fn space_between(boxes: &[Box3], settings: &Settings, own: &[Settings]) -> f64 {
    if settings.print.sequence == Sequence::ByLayer {
        return BETWEEN_MODELS;
    }
    let side = |b: &Box3| f64::from((b.max - b.min).truncate().max_element());
    let smallest = boxes.iter().map(side).fold(f64::INFINITY, f64::min);
    let bases = std::iter::once(settings).chain(own);
    let base = bases.map(|s| s.adhesion.reach(smallest, s.first_layer.line_width)).fold(0.0, f64::max);
    // The head beside the base of what is printed later; and bases do not overlap.
    (settings.printer.extruder_clearance_radius + base).max(2.0 * base) + SPARE
}

/// The settings of the models that have their own, laid over those of the plate.
pub(super) fn own_settings(models: &[NamedModel], settings: &Settings) -> Result<Vec<Settings>, JobError> {
    models.iter().filter(|m| !m.own.is_empty()).map(|m| settings_of(m, settings)).collect()
}

/// Refuses prints that the head cannot come to without touching those before them.
pub(super) fn check(prints: &[Print]) -> Result<(), SequenceError> {
    let reaches: Vec<Contour> = prints.iter().map(|print| convex_hull(print.reach(0.0))).collect();
    for (k, done) in prints.iter().enumerate() {
        let printer = &done.settings().printer;
        let limit = printer.extruder_clearance_height;
        if k + 1 < prints.len() && done.top() > limit {
            return Err(SequenceError::TooTall { name: done.name().to_owned(), height: done.top(), limit });
        }
        let stands = convex_hull(done.reach(BELOW_HEAD));
        let needed = printer.extruder_clearance_radius;
        for (next, reach) in prints.iter().zip(&reaches).skip(k + 1) {
            let [done, next] = [done, next].map(|print| print.name().to_owned());
            let distance = distance(&stands, reach);
            if distance < needed {
                return Err(SequenceError::TooNear { done, next, distance, needed });
            }
            if overlap(&reaches[k], reach) {
                return Err(SequenceError::BasesMeet { done, next });
            }
        }
    }
    Ok(())
}

fn overlap(a: &Contour, b: &Contour) -> bool {
    let [a, b] = [a, b].map(|hull| PolygonSet::from_contours(vec![hull.clone()]));
    !a.intersection(&b).is_empty()
}

/// Distance of two convex outlines, mm; 0 where they overlap.
fn distance(a: &Contour, b: &Contour) -> f64 {
    if overlap(a, b) {
        return 0.0;
    }
    // Nowhere nearer than from a corner of one to an edge of the other.
    let from_corners = |a: &Contour, b: &Contour| {
        let to_edges = |p| b.edges().map(move |(from, to)| squared_distance_to_segment(p, from, to));
        a.points.iter().copied().flat_map(to_edges).fold(f64::INFINITY, f64::min)
    };
    from_corners(a, b).min(from_corners(b, a)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn the_distance_of_convex_outlines_is_that_of_their_nearest_points() {
        let square = |x: f64, y: f64| {
            convex_hull(
                [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]
                    .map(|(u, v)| dvec2(x + u, y + v))
                    .to_vec(),
            )
        };
        assert_eq!(distance(&square(0.0, 0.0), &square(25.0, 3.0)), 15.0);
        assert_eq!(distance(&square(0.0, 0.0), &square(13.0, -14.0)), 5.0);
        assert_eq!(distance(&square(0.0, 0.0), &square(9.0, 9.0)), 0.0);
        assert_eq!(
            distance(
                &square(0.0, 0.0),
                &convex_hull(vec![dvec2(12.0, 5.0), dvec2(40.0, 9.0), dvec2(40.0, -9.0)])
            ),
            2.0
        );
    }
}
