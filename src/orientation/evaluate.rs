//! One direction, computed: supports are generated for it, and what they cost is added up.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::direction::{Direction, turned};
use super::layers::{Crossing, LayerStack};
use super::scars::Scars;
use super::{OrientationError, OrientationOptions, Watch};
use crate::mesh::Mesh;
use crate::polygon::DVec2;
use crate::polygon::measure::Bounds;
use crate::polygon::tiles::Tiles;
use crate::slice::{Axis, slice_triangles};
use crate::support::volumes::{Descent, SupportVolumes, VolumeRules};

/// Sections are cut for this many runs of layers at a time, so that memory stays bounded.
const RUNS_AT_A_TIME: usize = 64;

/// Contours may be simplified by this share of the layer height. Coarser is not faster by much, and
/// wrong: with a twentieth a ball of 25 mm needed 10 % more support, for steps near 45 degrees
/// were taken for too long.
const RESOLUTION_SHARE: f64 = 0.01;

/// Below this, mm, simplifying gains nothing: it is the order of the polygon grid.
const FINEST_RESOLUTION: f64 = 5e-4;

/// Support regions are kept in square tiles, as many as there are so many triangles. Between 200 and 800 the
/// times of parts with deep folds differ by less than a tenth; simple parts are one tile.
const TRIANGLES_A_TILE: f64 = 300.0;

/// Plastic that an ordinary nozzle lays down, mm3/s: a bead of 0.45 x 0.2 mm at 60 mm/s.
const SURROGATE_FLOW: f64 = 5.4;

/// Share of a part's volume that is plastic: three walls, skins, 15 % infill.
const SURROGATE_SOLID_SHARE: f64 = 0.4;

/// Travel, lift and the slow outer wall, s per layer.
const SURROGATE_LAYER_S: f64 = 3.0;

/// What a direction costs. Volumes are those of complete supports, [Karim] eq. (9) to (12).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DirectionFigures {
    /// 1 to 6 for the axes, from 7 for faces of the convex hull.
    pub id: u32,
    /// Unit vector of the part as it lies that points up.
    pub up: [f64; 3],
    /// Volume of the supports without the base.
    pub support_mm3: f64,
    /// Volume of the base below part and supports.
    pub base_mm3: f64,
    /// Both together; the network and the exact rule compare these.
    pub total_mm3: f64,
    /// Connected supports, plus one for the base.
    pub structures: u32,
    /// Connected supports narrower than a line, counted apart.
    pub specks: u32,
    /// Length of filament for supports and base, as if printed solid.
    pub support_filament_mm: f64,
    /// Area of the part's own first layer.
    pub bed_contact_mm2: f64,
    /// Height of the part this way up.
    pub height_mm: f64,
    /// Number of layers.
    pub layers: u32,
    /// Printing time from volume and number of layers alone: a quick surrogate to compare
    /// directions by, not the estimate of the finished G-code.
    pub time_surrogate_s: f64,
    /// Surface of the part that supports touch from below or above, and will scar.
    pub scarred_mm2: f64,
    /// Layers whose outline had openings that had to be closed.
    pub open_layers: u32,
    /// No other direction is at least as good in volume, structures and height, and better in one.
    /// Set by [`super::choose`].
    pub pareto: bool,
}

/// The figures of one direction. Directions do not depend on each other, so workers may share them
/// out. `watch` is told layers done and in all, and stops the work by returning false.
pub fn evaluate(
    mesh: &Mesh,
    direction: &Direction,
    options: &OrientationOptions,
    watch: Watch<'_>,
) -> Result<DirectionFigures, OrientationError> {
    super::check(mesh, options)?;
    let turned = turned(mesh, DVec3::from(direction.up))
        .map_err(|_| OrientationError::BadFigures { id: direction.id })?;
    let stack = LayerStack::new(&turned, options.layer_height);
    let mut descent = Descent::in_tiles(rules(options), tiles(&turned));
    let mut scars = Scars::new(&turned, &stack);
    let mut open_layers = 0;
    let mut crossing = Crossing::new(&turned, &stack, RUNS_AT_A_TIME);
    for first in (0..stack.runs.len()).step_by(RUNS_AT_A_TIME).rev() {
        let runs = first..stack.runs.len().min(first + RUNS_AT_A_TIME);
        let heights: Vec<f64> = runs.clone().map(|r| stack.slice_z[stack.runs[r].start]).collect();
        let triangles = crossing.next().iter().copied();
        let sections = slice_triangles(&turned, triangles, Axis::Z, &heights, resolution(options));
        for (run, section) in runs.zip(sections).rev() {
            let layers = stack.runs[run].len() as u32;
            open_layers += if section.gaps.is_empty() { 0 } else { layers };
            descent.enter(section.area, layers);
            scars.look(run, |p| descent.supports(p));
            let done = stack.slice_z.len() - stack.runs[run].start;
            if !watch(done as u32, stack.slice_z.len() as u32) {
                return Err(OrientationError::Cancelled);
            }
        }
    }
    let shape = Shape { part_mm3: mesh.volume().abs(), open_layers, scarred_mm2: scars.touched_mm2(), stack };
    Ok(figures(direction, options, descent.finish(), &shape))
}

fn rules(options: &OrientationOptions) -> VolumeRules {
    VolumeRules {
        layer_height: options.layer_height,
        self_support_angle_deg: options.self_support_angle_deg,
        base_layers: options.base_layers,
        section_tolerance: resolution(options),
        speck_width: options.speck_width,
    }
}

/// Tiles for the support regions of a turned part.
fn tiles(turned: &Mesh) -> Tiles {
    let count = (turned.triangles.len() as f64 / TRIANGLES_A_TILE).sqrt() as usize;
    let flat: Vec<DVec2> = turned.vertices.iter().map(|v| v.as_dvec3().truncate()).collect();
    Bounds::of_points(&flat).map_or_else(Tiles::whole, |bounds| Tiles::over(bounds, count))
}

/// By how much contours may be simplified, mm: so little that a wall at 46 degrees is still
/// told from one at 45.
fn resolution(options: &OrientationOptions) -> f64 {
    let share = options.layer_height * RESOLUTION_SHARE;
    if share < FINEST_RESOLUTION { 0.0 } else { share }
}

/// What the figures need to know of the part this way up.
struct Shape {
    part_mm3: f64,
    open_layers: u32,
    scarred_mm2: f64,
    stack: LayerStack,
}

fn figures(
    direction: &Direction,
    options: &OrientationOptions,
    volumes: SupportVolumes,
    shape: &Shape,
) -> DirectionFigures {
    let total_mm3 = volumes.support_mm3 + volumes.base_mm3;
    let layers = shape.stack.slice_z.len() as u32;
    let plastic_mm3 = total_mm3 + SURROGATE_SOLID_SHARE * shape.part_mm3;
    DirectionFigures {
        id: direction.id,
        up: direction.up,
        support_mm3: volumes.support_mm3,
        base_mm3: volumes.base_mm3,
        total_mm3,
        structures: volumes.structures,
        specks: volumes.specks,
        support_filament_mm: total_mm3 / filament_mm2(options.filament_diameter),
        bed_contact_mm2: volumes.bed_contact_mm2,
        height_mm: shape.stack.height,
        layers,
        time_surrogate_s: plastic_mm3 / SURROGATE_FLOW + SURROGATE_LAYER_S * f64::from(layers),
        scarred_mm2: shape.scarred_mm2,
        open_layers: shape.open_layers,
        pareto: false,
    }
}

/// Cross-section of filament, mm2.
fn filament_mm2(diameter: f64) -> f64 {
    std::f64::consts::PI * diameter * diameter / 4.0
}
