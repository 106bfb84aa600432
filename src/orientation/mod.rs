//! Which way up a part needs the least support, computed from supports really generated.
//!
//! Source: [Karim] K. F. Karim et al., "Feature-Based Support Generation for Optimum Part
//! Deposition Orientation in FDM". For each of six directions, and for the sides of the convex
//! hull, the part is turned and cut into uniform layers; overhangs ([`crate::region::overhang`])
//! become support regions and volumes ([`crate::support::volumes`]). The paper's network
//! ([`net`]) and the exact rule ([`exact`]) choose among the six; where they differ, the exact one
//! wins and a remark says so.
//!
//! [`candidates`], then [`evaluate`] for each (in any worker), then [`choose`]; [`orient`] does
//! all three.

mod direction;
mod error;
mod evaluate;
pub mod exact;
pub mod hull;
mod layers;
pub mod net;
mod report;
mod scars;

pub use direction::{Direction, rotation_for, six};
pub use error::OrientationError;
pub use evaluate::{DirectionFigures, evaluate};
pub use report::{OrientationReport, Remark, choose};

use glam::Vec3;

use crate::mesh::Mesh;
use crate::options::Setting;

/// Told how much is done and of how much; returning false cancels.
pub type Watch<'w> = &'w mut dyn FnMut(u32, u32) -> bool;

/// A coordinate beyond this is refused, mm: ten metres, far past any printer.
const REACH_LIMIT_MM: f64 = 10_000.0;

/// More layers than this are refused.
const LAYER_LIMIT: u32 = 100_000;

/// Sides thinner than this share of the longest one count as flat: what f32 coordinates resolve.
const FLAT_SHARE: f64 = 1e-6;

crate::words! {
    /// What to do about the orientation of a part.
    pub enum OrientationMode {
        /// Print the part as it lies.
        #[default]
        Keep = "keep",
        /// Turn it the way that needs the least support.
        Auto = "auto",
    }
}

crate::words! {
    /// Which of the directions compared may be chosen.
    pub enum Candidates {
        /// The six axes of the part as it lies [Karim].
        #[default]
        Axes = "axes",
        /// The sides of the convex hull as well.
        Hull = "hull",
    }
}

crate::options! {
    /// How directions are compared.
    pub struct OrientationOptions {
        /// Keep the part as it lies, or turn it the way that needs the least support.
        mode: OrientationMode = OrientationMode::Keep, "Orientation";
        /// What may be chosen: one of the six axes, or a side of the convex hull too, which may
        /// leave the part standing askew.
        candidates: Candidates = Candidates::Axes, "Choose among";
        /// Layers of the base below part and supports; each counts with its volume.
        base_layers: u32 = 5, "Base layers", "", 0.0..=50.0;
        /// Surfaces that lean less than this from the vertical hold themselves.
        self_support_angle_deg: f64 = 45.0, "Self-support angle", "degrees", 0.0..=45.0;
        /// Height of the uniform layers that directions are compared by; smaller is slower.
        layer_height: f64 = 0.2, "Layer height for the comparison", "mm", 0.01..=2.0;
        /// Sides of the convex hull that are tried besides the six axes; 0 tries none.
        hull_directions: u32 = 12, "Directions from the hull", "", 0.0..=30.0;
        /// Supports of which no layer is larger than a square of this side are counted as specks.
        speck_width: f64 = 0.45, "Speck width", "mm", 0.0..=5.0;
        /// Diameter of the filament whose length is shown.
        filament_diameter: f64 = 1.75, "Filament diameter", "mm", 0.5..=5.0;
    }
}

impl OrientationOptions {
    /// The same, without the directions that could not be chosen anyway.
    #[must_use]
    pub fn for_choice(&self) -> OrientationOptions {
        let hull_directions = match self.candidates {
            Candidates::Axes => 0,
            Candidates::Hull => self.hull_directions,
        };
        OrientationOptions { hull_directions, ..self.clone() }
    }
}

/// Compares the six directions and the hull's sides, and chooses.
///
/// `watch` is told done and total parts of the work and cancels it by returning false.
pub fn orient(
    mesh: &Mesh,
    options: &OrientationOptions,
    watch: Watch<'_>,
) -> Result<OrientationReport, OrientationError> {
    /// Steps of progress in one direction.
    const STEPS: u32 = 1000;
    let directions = candidates(mesh, options)?;
    let total = directions.len() as u32 * STEPS;
    let evaluate_one = |(i, direction): (usize, &Direction)| {
        let before = i as u32 * STEPS;
        let mut inner = |done: u32, of: u32| {
            watch(before + (f64::from(done) / f64::from(of) * f64::from(STEPS)) as u32, total)
        };
        evaluate(mesh, direction, options, &mut inner)
    };
    let figures = directions.iter().enumerate().map(evaluate_one).collect::<Result<_, _>>()?;
    choose(figures, options)
}

/// The directions worth computing: the six axes, then sides of the convex hull.
pub fn candidates(mesh: &Mesh, options: &OrientationOptions) -> Result<Vec<Direction>, OrientationError> {
    check(mesh, options)?;
    let mut directions = six().to_vec();
    directions.extend(hull::directions(mesh, options.hull_directions as usize));
    Ok(directions)
}

/// Refuses what no direction can be computed for.
fn check(mesh: &Mesh, options: &OrientationOptions) -> Result<(), OrientationError> {
    options.check("orientation")?;
    if mesh.triangles.is_empty() {
        return Err(OrientationError::Empty);
    }
    let vertices = || mesh.triangles.iter().flatten().map(|&v| mesh.vertices[v as usize]);
    if !vertices().all(Vec3::is_finite) {
        return Err(OrientationError::NotFinite);
    }
    let low = vertices().fold(Vec3::INFINITY, Vec3::min).as_dvec3();
    let high = vertices().fold(Vec3::NEG_INFINITY, Vec3::max).as_dvec3();
    let reach_mm = low.abs().max(high.abs()).max_element();
    if reach_mm > REACH_LIMIT_MM {
        return Err(OrientationError::TooLarge { reach_mm, limit_mm: REACH_LIMIT_MM });
    }
    let size = high - low;
    let (thin, long, t) = (size.min_element(), size.max_element(), options.layer_height);
    if thin <= FLAT_SHARE * long {
        return Err(OrientationError::Flat);
    }
    if t > thin {
        return Err(OrientationError::LayerAbovePart { layer_height_mm: t, height_mm: thin });
    }
    if long / t > f64::from(LAYER_LIMIT) {
        return Err(OrientationError::TooManyLayers { layers: long / t, limit: LAYER_LIMIT });
    }
    Ok(())
}
