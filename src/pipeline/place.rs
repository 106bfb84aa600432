//! Where the models stand on the bed.

use std::fmt;

use glam::{DMat4, DVec3, dvec3};

use crate::gcode::PrinterOptions;
use crate::mesh::{Box3, Mesh, TransformError};

/// Free space between models that are printed together, mm.
const BETWEEN_MODELS: f64 = 10.0;

/// How far a model may stand over the edge of the bed by rounding, mm.
const EDGE_TOLERANCE: f64 = 1e-3;

/// The models do not fit the printer.
#[derive(Debug, Clone, PartialEq)]
pub enum FitError {
    /// Arranged by us, they need more room than there is.
    TooLarge {
        /// Size of all models together as they would stand, mm.
        size: DVec3,
        /// Bed width and depth and the printer's height, mm.
        room: DVec3,
    },
    /// Where the caller put it, a model stands outside.
    Outside {
        /// Position of the model in the list, from 0.
        index: usize,
        /// What it reaches over, mm.
        reach: [DVec3; 2],
        /// Bed width and depth and the printer's height, mm.
        room: DVec3,
    },
    /// A placement that cannot be applied.
    Placement {
        /// Position of the model in the list, from 0.
        index: usize,
        /// Why not.
        cause: TransformError,
    },
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FitError::TooLarge { size, room } => {
                write!(f, "does not fit the printer: {:.1} x {:.1} x {:.1} mm", size.x, size.y, size.z)?;
                write!(f, " in {} x {} x {} mm", room.x, room.y, room.z)
            }
            FitError::Outside { index, reach: [low, high], room } => {
                write!(f, "does not fit the printer: part {} reaches", index + 1)?;
                write!(f, " from ({:.1}, {:.1}, {:.1})", low.x, low.y, low.z)?;
                write!(f, " to ({:.1}, {:.1}, {:.1}) mm,", high.x, high.y, high.z)?;
                write!(f, " the room from (0, 0, 0) to ({}, {}, {})", room.x, room.y, room.z)
            }
            FitError::Placement { index, cause } => write!(f, "part {}: {cause}", index + 1),
        }
    }
}

impl std::error::Error for FitError {}

/// Models standing on the bed as one mesh, and how each was moved there.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// All models, in bed coordinates, mm.
    pub mesh: Mesh,
    /// For each model the matrix from its file's coordinates to the bed's.
    pub placements: Vec<DMat4>,
}

/// Drops the models on the bed, row by row in their order, the whole group centred. Empty models
/// are not allowed.
pub fn place_on_bed(models: &[&Mesh], printer: &PrinterOptions) -> Result<Placed, FitError> {
    let boxes: Vec<Box3> = models.iter().filter_map(|m| m.bounds()).collect();
    let moves = arrange(&boxes, printer)?;
    let placements: Vec<DMat4> = moves.into_iter().map(DMat4::from_translation).collect();
    let mut mesh = Mesh::default();
    for (model, placement) in models.iter().zip(&placements) {
        mesh.append(&model.transformed(placement).expect("what fits the bed is within reach"));
    }
    Ok(Placed { mesh, placements })
}

/// The moves that bring boxes to the bed, row by row in their order, the whole group centred.
pub fn arrange(boxes: &[Box3], printer: &PrinterOptions) -> Result<Vec<DVec3>, FitError> {
    let room = room_of(printer);
    let corners = lay_out_rows(boxes, room.x);
    let ends = corners.iter().zip(boxes).map(|(c, b)| *c + size_of(b));
    let size = ends.fold(DVec3::ZERO, DVec3::max);
    if size.cmpgt(room).any() {
        return Err(FitError::TooLarge { size, room });
    }
    let centring = ((room - size) / 2.0).with_z(0.0);
    Ok(corners.iter().zip(boxes).map(|(c, b)| *c + centring - b.min.as_dvec3()).collect())
}

/// The models as `placements` say, one each; all of them must stand inside the printer.
pub fn place_as_told(
    models: &[&Mesh],
    placements: &[DMat4],
    printer: &PrinterOptions,
) -> Result<Placed, FitError> {
    let room = room_of(printer);
    let mut mesh = Mesh::default();
    for (index, (model, placement)) in models.iter().zip(placements).enumerate() {
        let placed = model.transformed(placement).map_err(|cause| FitError::Placement { index, cause })?;
        if let Some(b) = placed.bounds() {
            let reach = [b.min.as_dvec3(), b.max.as_dvec3()];
            let [low, high] = [reach[0] + EDGE_TOLERANCE, reach[1] - EDGE_TOLERANCE];
            if low.cmplt(DVec3::ZERO).any() || high.cmpgt(room).any() {
                return Err(FitError::Outside { index, reach, room });
            }
        }
        mesh.append(&placed);
    }
    Ok(Placed { mesh, placements: placements.to_vec() })
}

fn room_of(printer: &PrinterOptions) -> DVec3 {
    dvec3(printer.bed_size[0], printer.bed_size[1], printer.height)
}

fn size_of(b: &Box3) -> DVec3 {
    b.max.as_dvec3() - b.min.as_dvec3()
}

/// Lower corners of the boxes in rows no longer than `width`, as far as single boxes allow.
fn lay_out_rows(boxes: &[Box3], width: f64) -> Vec<DVec3> {
    let (mut x, mut y, mut row_depth) = (0.0, 0.0, 0.0f64);
    let mut place = |b: &Box3| {
        let size = size_of(b);
        if x > 0.0 && x + size.x > width {
            (x, y, row_depth) = (0.0, y + row_depth + BETWEEN_MODELS, 0.0);
        }
        let corner = dvec3(x, y, 0.0);
        x += size.x + BETWEEN_MODELS;
        row_depth = row_depth.max(size.y);
        corner
    };
    boxes.iter().map(&mut place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn block(x: f32, y: f32, z: f32) -> Mesh {
        let vertices = vec![Vec3::new(-1.0, 2.0, 5.0), Vec3::new(x - 1.0, y + 2.0, z + 5.0)];
        Mesh { vertices, triangles: vec![[0, 1, 0]] }
    }

    #[test]
    fn one_model_stands_in_the_middle() {
        let placed = place_on_bed(&[&block(20.0, 10.0, 5.0)], &PrinterOptions::default()).unwrap();
        assert_eq!(placed.mesh.vertices, [Vec3::new(100.0, 105.0, 0.0), Vec3::new(120.0, 115.0, 5.0)]);
        assert_eq!(placed.placements[0].w_axis.truncate(), dvec3(101.0, 103.0, -5.0));
    }

    #[test]
    fn three_models_stand_apart_in_rows() {
        let part = block(100.0, 20.0, 5.0);
        let placed = place_on_bed(&[&part, &part, &part], &PrinterOptions::default()).unwrap();
        let corners: Vec<(f32, f32)> = placed.mesh.vertices.iter().step_by(2).map(|v| (v.x, v.y)).collect();
        assert_eq!(corners, [(5.0, 85.0), (115.0, 85.0), (5.0, 115.0)]);
    }

    #[test]
    fn placed_by_hand_or_by_us_at_the_same_place_is_the_same() {
        let part = block(20.1, 10.3, 5.7);
        let printer = PrinterOptions::default();
        let arranged = place_on_bed(&[&part, &part], &printer).unwrap();
        let told = place_as_told(&[&part, &part], &arranged.placements, &printer).unwrap();
        assert_eq!(arranged, told);
    }

    #[test]
    fn a_part_over_the_edge_is_named() {
        let part = block(20.0, 10.0, 5.0);
        let inside = DMat4::from_translation(dvec3(1.0, -2.0, -5.0));
        let outside = DMat4::from_translation(dvec3(0.0, -2.0, -5.0));
        let printer = PrinterOptions::default();
        let error = place_as_told(&[&part, &part], &[inside, outside], &printer).unwrap_err();
        assert_eq!(
            error.to_string(),
            "does not fit the printer: part 2 reaches from (-1.0, 0.0, 0.0) to (19.0, 10.0, 5.0) mm, \
             the room from (0, 0, 0) to (220, 220, 250)"
        );
        let flat = DMat4::from_scale(dvec3(1.0, 1.0, 0.0));
        let error = place_as_told(&[&part], &[inside * flat], &printer).unwrap_err();
        assert_eq!(error, FitError::Placement { index: 0, cause: TransformError::NotInvertible });
    }

    #[test]
    fn what_is_too_large_is_named_with_its_size() {
        let error = place_on_bed(&[&block(300.0, 10.0, 5.0)], &PrinterOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "does not fit the printer: 300.0 x 10.0 x 5.0 mm in 220 x 220 x 250 mm"
        );
    }
}
