//! Where the models stand on the bed.

use std::fmt;

use glam::{DMat4, DVec3, dvec3};

use crate::gcode::PrinterOptions;
use crate::mesh::{Box3, Mesh};

/// Free space between models that are printed together, mm.
const BETWEEN_MODELS: f64 = 10.0;

/// The models do not fit the printer.
#[derive(Debug, Clone, PartialEq)]
pub struct FitError {
    /// Size of all models together as they would stand, mm.
    pub size: DVec3,
    /// Bed width and depth and the printer's height, mm.
    pub room: DVec3,
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (size, room) = (self.size, self.room);
        write!(f, "does not fit the printer: {:.1} x {:.1} x {:.1} mm", size.x, size.y, size.z)?;
        write!(f, " in {} x {} x {} mm", room.x, room.y, room.z)
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
    let bed = dvec3(printer.bed_size[0], printer.bed_size[1], printer.height);
    let corners = lay_out_rows(&boxes, bed.x);
    let ends = corners.iter().zip(&boxes).map(|(c, b)| *c + size_of(b));
    let size = ends.fold(DVec3::ZERO, DVec3::max);
    if size.cmpgt(bed).any() {
        return Err(FitError { size, room: bed });
    }
    let centring = ((bed - size) / 2.0).with_z(0.0);
    let moves = corners.iter().zip(&boxes).map(|(c, b)| *c + centring - b.min.as_dvec3());
    let placements: Vec<DMat4> = moves.map(DMat4::from_translation).collect();
    let mut mesh = Mesh::default();
    for (model, placement) in models.iter().zip(&placements) {
        mesh.append(&model.transformed(placement).expect("what fits the bed is within reach"));
    }
    Ok(Placed { mesh, placements })
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
    fn what_is_too_large_is_named_with_its_size() {
        let error = place_on_bed(&[&block(300.0, 10.0, 5.0)], &PrinterOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "does not fit the printer: 300.0 x 10.0 x 5.0 mm in 220 x 220 x 250 mm"
        );
    }
}
