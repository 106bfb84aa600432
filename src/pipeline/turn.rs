//! Turning models the way they print best.

use glam::{DMat3, DMat4, DVec3};

use super::{JobError, NamedModel, Warning};
use crate::mesh::Mesh;
use crate::orientation::{OrientationMode, OrientationOptions, OrientationReport, orient, rotation_for};
use crate::settings::Settings;

/// Models as they will stand on the bed, before they are placed.
pub(super) struct Turned {
    pub(super) meshes: Vec<Mesh>,
    /// For each model the turn that was applied.
    pub(super) turns: Vec<DMat4>,
    /// Figures of the first model's directions, if a choice was asked for.
    pub(super) report: Option<OrientationReport>,
    pub(super) warnings: Vec<Warning>,
}

/// Turns each model as `orientation.mode` asks.
pub(super) fn turn_models(models: &[NamedModel], settings: &Settings) -> Result<Turned, JobError> {
    let mut turned = Turned { meshes: Vec::new(), turns: Vec::new(), report: None, warnings: Vec::new() };
    for NamedModel { name, model } in models {
        match settings.orientation.mode {
            OrientationMode::Keep => {
                turned.turns.push(DMat4::IDENTITY);
                turned.meshes.push(model.mesh.clone());
            }
            OrientationMode::Auto => {
                let (mesh, turn, report) = turn_best(&model.mesh, &settings.orientation)?;
                let told =
                    report.remarks.iter().map(|r| Warning::on_job(r.code, format!("{name}: {}", r.message)));
                turned.warnings.extend(told);
                turned.turns.push(turn);
                turned.meshes.push(mesh);
                turned.report.get_or_insert(report);
            }
        }
    }
    Ok(turned)
}

fn turn_best(
    mesh: &Mesh,
    options: &OrientationOptions,
) -> Result<(Mesh, DMat4, OrientationReport), JobError> {
    let report = orient(mesh, options, &mut |_, _| true).map_err(JobError::Orientation)?;
    let up = report.chosen_figures().map_or(DVec3::Z, |f| DVec3::from_array(f.up));
    let rotation: DMat3 = rotation_for(up);
    let turn = DMat4::from_mat3(rotation);
    let vertices = mesh.vertices.iter().map(|v| (rotation * v.as_dvec3()).as_vec3()).collect();
    Ok((Mesh { vertices, triangles: mesh.triangles.clone() }, turn, report))
}
