//! Where the models stand on the bed.

use std::fmt;

use glam::{DMat3, DMat4, DVec3, dvec3};

use super::check::Stand;
use super::sequence;
use crate::gcode::{BedShape, PrinterOptions};
use crate::mesh::{Box3, Edit, Mesh, TransformError};
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2, PolygonSet, dvec2, trig};
use crate::settings::Settings;

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
        /// Whether the bed is round.
        round: bool,
        /// What would make it fit.
        hint: FitHint,
    },
    /// Where the caller put it, a model stands outside.
    Outside {
        /// Position of the model in the list, from 0.
        index: usize,
        /// What it reaches over, mm.
        reach: [DVec3; 2],
        /// The printer's room, lowest and highest corner, mm.
        room: [DVec3; 2],
        /// Whether the bed is round.
        round: bool,
    },
    /// A placement that cannot be applied.
    Placement {
        /// Position of the model in the list, from 0.
        index: usize,
        /// Why not.
        cause: TransformError,
    },
}

/// What would make a model fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FitHint {
    /// Turning it about the vertical axis by this angle.
    Turned {
        /// Whole degrees, counter-clockwise.
        degrees: u32,
    },
    /// Laying it down, so that this axis of its file points up.
    Laid {
        /// "x" or "y".
        up: &'static str,
    },
    /// Nothing but making it smaller.
    Scaled {
        /// Largest size that fits, in whole percent.
        percent: u32,
    },
}

impl FitHint {
    /// The change to every part that does it.
    pub fn edit(self) -> Edit {
        match self {
            FitHint::Turned { degrees } => Edit::Turn { axis: 2, angle_deg: f64::from(degrees) },
            FitHint::Laid { up: "x" } => Edit::TurnUp { up: [1.0, 0.0, 0.0] },
            FitHint::Laid { .. } => Edit::TurnUp { up: [0.0, 1.0, 0.0] },
            FitHint::Scaled { percent } => Edit::Scale { factors: [f64::from(percent) / 100.0; 3] },
        }
    }
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let on_round = |round: &bool| if *round { " with a round bed" } else { "" };
        match self {
            FitError::TooLarge { size, room, round, hint } => {
                write!(f, "does not fit the printer: {:.1} x {:.1} x {:.1} mm", size.x, size.y, size.z)?;
                write!(f, " in {} x {} x {} mm{}", room.x, room.y, room.z, on_round(round))?;
                match hint {
                    FitHint::Turned { degrees } => write!(f, "; turned by {degrees} degrees it fits"),
                    FitHint::Laid { up } => write!(f, "; it fits lying, with its {up} axis up"),
                    FitHint::Scaled { percent } => write!(f, "; at {percent} % of its size it fits"),
                }
            }
            FitError::Outside { index, reach: [low, high], room: [from, to], round } => {
                write!(f, "does not fit the printer: part {} reaches", index + 1)?;
                write!(f, " from ({:.1}, {:.1}, {:.1})", low.x, low.y, low.z)?;
                write!(f, " to ({:.1}, {:.1}, {:.1}) mm,", high.x, high.y, high.z)?;
                write!(f, " the room from ({}, {}, {})", from.x, from.y, from.z)?;
                write!(f, " to ({}, {}, {}){}", to.x, to.y, to.z, on_round(round))
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
    /// For each model where it stands.
    pub stands: Vec<Stand>,
}

/// Drops the models on the bed, row by row in their order, the whole group centred. Empty models
/// are not allowed. `own` are the settings of models that have their own.
pub fn place_on_bed(models: &[&Mesh], settings: &Settings, own: &[Settings]) -> Result<Placed, FitError> {
    let printer = &settings.printer;
    let boxes: Vec<Box3> = models.iter().filter_map(|m| m.bounds()).collect();
    let (moves, size) = rows(&boxes, settings, own);
    let too_large = || {
        let of_model = |(m, by): (&&Mesh, &DVec3)| {
            let by = *by;
            m.vertices.iter().map(move |v| v.as_dvec3() + by).collect::<Vec<_>>()
        };
        let points: Vec<DVec3> = models.iter().zip(&moves).flat_map(of_model).collect();
        too_large(size, &points, models.len() == 1, printer)
    };
    if size.cmpgt(room_of(printer)).any() {
        return Err(too_large());
    }
    let placements: Vec<DMat4> = moves.iter().copied().map(DMat4::from_translation).collect();
    let (mut mesh, mut stands) = (Mesh::default(), Vec::new());
    for (model, placement) in models.iter().zip(&placements) {
        let placed = model.transformed(placement).expect("what fits the bed is within reach");
        if !stands_on_bed(&placed, printer) {
            return Err(too_large());
        }
        stands.push(stand_of(&placed));
        mesh.append(&placed);
    }
    Ok(Placed { mesh, placements, stands })
}

/// What a model covers of the bed; nothing at all for an empty one.
fn stand_of(placed: &Mesh) -> Stand {
    let box_of = |b: Box3| [b.min, b.max].map(|v| v.as_dvec3());
    let [low, high] = placed.bounds().map_or_else(Default::default, box_of);
    Stand { footprint: Bounds { min: low.truncate(), max: high.truncate() }, lowest: low.z }
}

/// Whether no point is beside a round bed; boxes tell for others.
fn stands_on_bed(mesh: &Mesh, printer: &PrinterOptions) -> bool {
    printer.bed_shape == BedShape::Rectangle
        || mesh.vertices.iter().all(|v| printer.is_on_bed(v.as_dvec3().truncate()))
}

/// Corners of the polygon that stands for a round bed, inside it by up to 0.02 mm on a bed of 500 mm.
const ROUND_CORNERS: u32 = 360;

/// What of the box around the bed nothing may be printed on.
pub(super) fn closed_bed(printer: &PrinterOptions) -> PolygonSet {
    let Bounds { min, max } = printer.bed();
    let zones = printer.forbidden_zones().map(|zone| PolygonSet::rectangle(zone.min, zone.max));
    let mut closed = PolygonSet::union_all(&zones.collect::<Vec<_>>());
    if printer.bed_shape == BedShape::Round {
        let corner = |k: u32| {
            let (sin, cos) = trig::sin_cos(f64::from(k) * std::f64::consts::TAU / f64::from(ROUND_CORNERS));
            (min + max) / 2.0 + dvec2(cos, sin) * (max - min) / 2.0
        };
        let bed = Contour::new((0..ROUND_CORNERS).map(corner).collect());
        let around = PolygonSet::rectangle(min, max).difference(&PolygonSet::from_contours(vec![bed]));
        closed = closed.union(&around);
    }
    closed
}

/// Steps in which turning is tried, degrees.
const TURN_STEP: u32 = 5;

/// The error for models with these points, arranged side by side.
fn too_large(size: DVec3, points: &[DVec3], single: bool, printer: &PrinterOptions) -> FitError {
    let round = printer.bed_shape == BedShape::Round;
    FitError::TooLarge { size, room: room_of(printer), round, hint: hint(points, single, printer) }
}

/// What would make the placed models fit. Several are only made smaller: turning them is arranging.
fn hint(points: &[DVec3], single: bool, printer: &PrinterOptions) -> FitHint {
    let largest = |turn: DMat3| largest_scale(points.iter().map(|&p| turn * p), printer);
    if single {
        let about_z = |degrees: u32| {
            let (sin, cos) = trig::sin_cos(f64::from(degrees).to_radians());
            DMat3::from_cols(dvec3(cos, sin, 0.0), dvec3(-sin, cos, 0.0), DVec3::Z)
        };
        let turns = (1..180 / TURN_STEP).map(|k| k * TURN_STEP);
        // A quarter first: it is the turn that is easiest to do.
        if let Some(degrees) = std::iter::once(90).chain(turns).find(|&d| largest(about_z(d)) >= 1.0) {
            return FitHint::Turned { degrees };
        }
        // Where x, y and z go.
        let lying = [("x", [DVec3::Z, DVec3::X, DVec3::Y]), ("y", [DVec3::X, DVec3::Z, DVec3::NEG_Y])];
        if let Some((up, _)) =
            lying.into_iter().find(|(_, [a, b, c])| largest(DMat3::from_cols(*a, *b, *c)) >= 1.0)
        {
            return FitHint::Laid { up };
        }
    }
    FitHint::Scaled { percent: (largest(DMat3::IDENTITY) * 100.0).floor().max(0.0) as u32 }
}

/// The scale at which the points just fit, their box in the middle of the bed.
fn largest_scale(points: impl Iterator<Item = DVec3> + Clone, printer: &PrinterOptions) -> f64 {
    let low = points.clone().fold(DVec3::INFINITY, DVec3::min);
    let high = points.clone().fold(DVec3::NEG_INFINITY, DVec3::max);
    let half = DVec2::from_array(printer.bed_size) / 2.0;
    let centre = ((low + high) / 2.0).truncate();
    let across = match printer.bed_shape {
        BedShape::Rectangle => (half / ((high - low).truncate() / 2.0)).min_element(),
        BedShape::Round => {
            points.map(|p| ((p.truncate() - centre) / half).length()).fold(0.0, f64::max).recip()
        }
    };
    across.min(printer.height / (high.z - low.z))
}

/// The moves that bring boxes to the bed, row by row in their order, the whole group centred. Of a
/// round bed only the square around it is looked at. `own` are the settings of models that have their own.
pub fn arrange(boxes: &[Box3], settings: &Settings, own: &[Settings]) -> Result<Vec<DVec3>, FitError> {
    let printer = &settings.printer;
    let (moves, size) = rows(boxes, settings, own);
    if size.cmpgt(room_of(printer)).any() {
        let corners = |(b, by): (&Box3, &DVec3)| corners_of(b).map(|p| p + *by);
        let points: Vec<DVec3> = boxes.iter().zip(&moves).flat_map(corners).collect();
        return Err(too_large(size, &points, boxes.len() == 1, printer));
    }
    Ok(moves)
}

/// The moves that bring boxes to the bed whether or not they fit, and the size of the whole group.
fn rows(boxes: &[Box3], settings: &Settings, own: &[Settings]) -> (Vec<DVec3>, DVec3) {
    let printer = &settings.printer;
    let room = room_of(printer);
    let corners = lay_out_rows(boxes, room.x, sequence::space_between(boxes, settings, own));
    let ends = corners.iter().zip(boxes).map(|(c, b)| *c + size_of(b));
    let size = ends.fold(DVec3::ZERO, DVec3::max);
    let to_middle = printer.bed().min.extend(0.0) + ((room - size) / 2.0).with_z(0.0);
    (corners.iter().zip(boxes).map(|(c, b)| *c + to_middle - b.min.as_dvec3()).collect(), size)
}

/// The models as `placements` say, one each; all of them must stand inside the printer.
pub fn place_as_told(
    models: &[&Mesh],
    placements: &[DMat4],
    printer: &PrinterOptions,
) -> Result<Placed, FitError> {
    let front_left = printer.bed().min.extend(0.0);
    let room = [front_left, front_left + room_of(printer)];
    let round = printer.bed_shape == BedShape::Round;
    let (mut mesh, mut stands) = (Mesh::default(), Vec::new());
    for (index, (model, placement)) in models.iter().zip(placements).enumerate() {
        let placed = model.transformed(placement).map_err(|cause| FitError::Placement { index, cause })?;
        if let Some(b) = placed.bounds() {
            let reach = [b.min.as_dvec3(), b.max.as_dvec3()];
            let [low, high] = [reach[0] + EDGE_TOLERANCE, reach[1] - EDGE_TOLERANCE];
            let beside = low.cmplt(room[0]).any() || high.cmpgt(room[1]).any();
            if beside || !stands_on_bed(&placed, printer) {
                return Err(FitError::Outside { index, reach, room, round });
            }
        }
        stands.push(stand_of(&placed));
        mesh.append(&placed);
    }
    Ok(Placed { mesh, placements: placements.to_vec(), stands })
}

/// Width and depth of the smallest rectangle around the bed, and the printer's height, mm.
fn room_of(printer: &PrinterOptions) -> DVec3 {
    DVec2::from_array(printer.bed_size).extend(printer.height)
}

fn corners_of(b: &Box3) -> [DVec3; 8] {
    let [low, high] = [b.min.as_dvec3(), b.max.as_dvec3()];
    let pick = |k: usize, bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
    std::array::from_fn(|k| {
        dvec3(pick(k, 0, low.x, high.x), pick(k, 1, low.y, high.y), pick(k, 2, low.z, high.z))
    })
}

fn size_of(b: &Box3) -> DVec3 {
    b.max.as_dvec3() - b.min.as_dvec3()
}

/// Lower corners of the boxes, `apart` from one another, in rows no longer than `width`, as far as
/// single boxes allow.
fn lay_out_rows(boxes: &[Box3], width: f64, apart: f64) -> Vec<DVec3> {
    let (mut x, mut y, mut row_depth) = (0.0, 0.0, 0.0f64);
    let mut place = |b: &Box3| {
        let size = size_of(b);
        if x > 0.0 && x + size.x > width {
            (x, y, row_depth) = (0.0, y + row_depth + apart, 0.0);
        }
        let corner = dvec3(x, y, 0.0);
        x += size.x + apart;
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

    fn of_printer(printer: &PrinterOptions) -> Settings {
        Settings { printer: printer.clone(), ..Settings::default() }
    }

    #[test]
    fn one_model_stands_in_the_middle() {
        let placed = place_on_bed(&[&block(20.0, 10.0, 5.0)], &Settings::default(), &[]).unwrap();
        assert_eq!(placed.mesh.vertices, [Vec3::new(100.0, 105.0, 0.0), Vec3::new(120.0, 115.0, 5.0)]);
        assert_eq!(placed.placements[0].w_axis.truncate(), dvec3(101.0, 103.0, -5.0));
    }

    #[test]
    fn three_models_stand_apart_in_rows() {
        let part = block(100.0, 20.0, 5.0);
        let placed = place_on_bed(&[&part, &part, &part], &Settings::default(), &[]).unwrap();
        let corners: Vec<(f32, f32)> = placed.mesh.vertices.iter().step_by(2).map(|v| (v.x, v.y)).collect();
        assert_eq!(corners, [(5.0, 85.0), (115.0, 85.0), (5.0, 115.0)]);
    }

    #[test]
    fn placed_by_hand_or_by_us_at_the_same_place_is_the_same() {
        let part = block(20.1, 10.3, 5.7);
        let printer = PrinterOptions::default();
        let arranged = place_on_bed(&[&part, &part], &Settings::default(), &[]).unwrap();
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
        let error = place_on_bed(&[&block(300.0, 10.0, 5.0)], &Settings::default(), &[]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "does not fit the printer: 300.0 x 10.0 x 5.0 mm in 220 x 220 x 250 mm; turned by 45 degrees it fits"
        );
    }

    fn hint_for(mesh: &Mesh, printer: &PrinterOptions) -> FitHint {
        match place_on_bed(&[mesh], &of_printer(printer), &[]) {
            Err(FitError::TooLarge { hint, .. }) => hint,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_least_trouble_is_proposed() {
        let bed = PrinterOptions { bed_size: [200.0, 100.0], height: 300.0, ..PrinterOptions::default() };
        assert_eq!(hint_for(&block(90.0, 190.0, 5.0), &bed), FitHint::Turned { degrees: 90 });
        assert_eq!(hint_for(&block(250.0, 90.0, 50.0), &bed), FitHint::Laid { up: "x" });
        assert_eq!(hint_for(&block(150.0, 250.0, 90.0), &bed), FitHint::Laid { up: "y" });
        assert_eq!(hint_for(&block(400.0, 400.0, 400.0), &bed), FitHint::Scaled { percent: 25 });
        // On a round bed of 200 mm a square's diagonal may have 200 mm.
        let round = PrinterOptions { bed_size: [200.0, 200.0], bed_shape: BedShape::Round, ..bed };
        assert!(place_on_bed(&[&square(141.0)], &of_printer(&round), &[]).is_ok());
        assert_eq!(hint_for(&square(150.0), &round), FitHint::Scaled { percent: 94 });
    }

    /// A square on the bed with all four corners and a tip too high to lay it down.
    fn square(side: f32) -> Mesh {
        let corner = |x: f32, y: f32| Vec3::new(x * side, y * side, 0.0);
        let vertices =
            vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0), Vec3::Z * 290.0];
        Mesh { vertices, triangles: vec![[0, 1, 2]] }
    }

    #[test]
    fn the_origin_may_be_in_the_middle() {
        let printer = PrinterOptions { origin: crate::gcode::Origin::Center, ..PrinterOptions::default() };
        let placed = place_on_bed(&[&block(20.0, 10.0, 5.0)], &of_printer(&printer), &[]).unwrap();
        assert_eq!(placed.mesh.vertices, [Vec3::new(-10.0, -5.0, 0.0), Vec3::new(10.0, 5.0, 5.0)]);
    }
}
