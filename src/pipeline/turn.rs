//! Turning models the way they print best.

use glam::{DMat3, DMat4, DVec2, DVec3};

use super::{FitError, JobError, NamedModel, Warning};
use crate::mesh::transform::{centre_at, drop_to_bed};
use crate::mesh::{LoadedModel, Mesh};
use crate::orientation::{
    OrientationError, OrientationMode, OrientationOptions, OrientationReport, orient, rotation_for,
};
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
    for model in models {
        let turn = match settings.orientation.mode {
            OrientationMode::Keep => DMat4::IDENTITY,
            OrientationMode::Auto => best_turn(model, &settings.orientation, &mut turned)?,
        };
        let mesh = model.model.mesh.transformed(&turn);
        turned.meshes.push(mesh.expect("parts that are turned are refused far within reach"));
        turned.turns.push(turn);
    }
    Ok(turned)
}

/// Turns models that stand on the bed already as `orientation.mode` asks: the turns of the result are
/// the placements, and its meshes are left out.
pub(super) fn turn_standing(
    models: &[NamedModel],
    placements: &[DMat4],
    settings: &Settings,
) -> Result<Turned, JobError> {
    if settings.orientation.mode == OrientationMode::Keep {
        let turns = placements.to_vec();
        return Ok(Turned { meshes: Vec::new(), turns, report: None, warnings: Vec::new() });
    }
    let standing = models.iter().zip(placements).enumerate().map(|(index, (named, placement))| {
        let told = |cause| JobError::Fit(FitError::Placement { index, cause });
        let mesh = named.model.mesh.transformed(placement).map_err(told)?;
        let model = LoadedModel { mesh, ..named.model.clone() };
        // Directions that were compared before hold while the part stands as in its file.
        let unturned = DMat3::from_mat4(*placement) == DMat3::IDENTITY;
        let orientation = named.orientation.clone().filter(|_| unturned);
        Ok(NamedModel { orientation, ..NamedModel::new(named.name.clone(), model) })
    });
    let standing: Vec<NamedModel> = standing.collect::<Result<_, JobError>>()?;
    let turned = turn_models(&standing, settings)?;
    let ends = standing.iter().zip(&turned.meshes).zip(turned.turns.iter().zip(placements));
    let turns = ends.map(|((before, after), (turn, placement))| {
        let middle =
            before.model.mesh.bounds().map_or(DVec3::ZERO, |b| (b.min.as_dvec3() + b.max.as_dvec3()) / 2.0);
        drop_to_bed(after) * centre_at(after, DVec2::new(middle.x, middle.y)) * *turn * *placement
    });
    Ok(Turned { turns: turns.collect(), meshes: Vec::new(), ..turned })
}

/// The turn of the chosen direction; a part that no directions can be compared for stays as it lies.
fn best_turn(
    NamedModel { name, model, orientation, .. }: &NamedModel,
    options: &OrientationOptions,
    told: &mut Turned,
) -> Result<DMat4, JobError> {
    let known = orientation.clone().map(Ok);
    let report = match known.unwrap_or_else(|| orient(&model.mesh, &options.for_choice(), &mut |_, _| true)) {
        Ok(report) => report,
        Err(cause) if keeps_the_part(&cause) => {
            let message = format!("{name}: {cause}; it is printed as it lies");
            told.warnings.push(Warning::on_job("orientation_kept", message));
            return Ok(DMat4::IDENTITY);
        }
        Err(cause) => return Err(JobError::Orientation(cause)),
    };
    let remarks = report.remarks.iter();
    told.warnings.extend(remarks.map(|r| Warning::on_job(r.code, format!("{name}: {}", r.message))));
    let up = report.chosen_figures().map_or(DVec3::Z, |f| DVec3::from_array(f.up));
    told.report.get_or_insert(report);
    Ok(DMat4::from_mat3(rotation_for(up)))
}

/// Whether a part can be printed all the same, as it lies.
fn keeps_the_part(cause: &OrientationError) -> bool {
    matches!(cause, OrientationError::LayerAbovePart { .. } | OrientationError::TooManyLayers { .. })
}
