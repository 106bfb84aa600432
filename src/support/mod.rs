//! What holds up overhangs: thin crossing plates [Zhao], and full support volumes to compare with
//! and to choose an orientation by.
//!
//! [`plan_supports`] looks at the whole part once and lays every bead; [`Supports::layer_paths`]
//! hands them over layer by layer. `docs/supports.md` tells the method.
//!
//! [Zhao]: B. Zhao, S. Wang, F. Xie, "Research on Automatic Generation Algorithm for the Supporting
//! Structure in FDM Process".

mod beads;
mod cover;
mod error;
mod foot;
mod frame;
mod grid;
mod interface;
pub mod options;
mod pieces;
pub mod plane;
mod plates;
pub mod points;
mod report;
mod section;
mod spans;
mod ties;
mod tile;
pub mod volumes;

pub use beads::Bead;
pub use error::{SupportError, SupportWarning};
pub use options::{GridOptions, PlateOptions, SupportMethod, SupportOptions};
pub use report::{PlateAxis, PlateReport, SupportReport, Uncovered};

use crate::mesh::{Box3, Mesh};
use crate::options::Setting;
use crate::polygon::{DVec2, PolygonSet};
use crate::region::Path;
use crate::slice::{Axis, Gap, LayerSpec};
use cover::Need;
use frame::Frame;
use plane::{Column, Demand, Edge, PlaneSection};
use plates::Plate;
use points::SPoint;
use section::Facets;

/// Told how much is done and of how much; returning false cancels.
pub type Watch<'w> = &'w mut dyn FnMut(u32, u32) -> bool;

/// The part in its layers, in bed coordinates.
#[derive(Debug, Clone, Copy)]
pub struct SupportInput<'a> {
    /// All models; the bed, or the raft's top, is z = 0.
    pub mesh: &'a Mesh,
    /// The part's layers from the lowest up.
    pub layers: &'a [LayerSpec],
    /// The part's section in each of them.
    pub areas: &'a [PolygonSet],
}

/// All supports of a job.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Supports {
    layers: Vec<Vec<Bead>>,
    line_width: f64,
    report: SupportReport,
    warnings: Vec<SupportWarning>,
}

impl Supports {
    /// The beads of the part's layer `k`, in an order with little travel; none above the part.
    pub fn layer_paths(&self, k: usize) -> Vec<Path> {
        let beads = self.layers.get(k).map_or(&[][..], Vec::as_slice);
        beads.iter().map(|bead| bead.path(self.line_width)).collect()
    }

    /// What the supports cover on the bed.
    pub fn bed_area(&self) -> PolygonSet {
        let beads = self.layers.first().map_or(&[][..], Vec::as_slice);
        PolygonSet::from_contours(beads.iter().map(|b| b.outline(self.line_width)).collect())
    }

    /// The figures.
    pub fn report(&self) -> &SupportReport {
        &self.report
    }

    /// What could not be done as asked.
    pub fn warnings(&self) -> &[SupportWarning] {
        &self.warnings
    }
}

/// Refuses settings that contradict each other.
pub fn check_options(options: &SupportOptions) -> Result<(), SupportError> {
    options.check("support")?;
    let PlateOptions { spacing_x, spacing_y, thickness, .. } = options.plates;
    let least = options.line_width * f64::from(thickness);
    let spacings = [
        ("support.plates.spacing_x", spacing_x, least),
        ("support.plates.spacing_y", spacing_y, least),
        ("support.grid.spacing", options.grid.spacing, options.line_width),
    ];
    for (path, found, least) in spacings {
        if found < least {
            return Err(SupportError::SpacingUnderThickness { path, found, least });
        }
    }
    Ok(())
}

/// Plans all supports: planes, added planes, gaps, crossings, feet and interface.
///
/// `watch` is told done and total steps and cancels by returning false.
pub fn plan_supports(
    input: &SupportInput,
    options: &SupportOptions,
    watch: Watch<'_>,
) -> Result<Supports, SupportError> {
    check_options(options)?;
    let (Some(bounds), false) = (input.mesh.bounds(), options.method == SupportMethod::None) else {
        return Ok(Supports::default());
    };
    let facets = Facets::of(input.mesh, options);
    let frame = Frame::new(input.layers, input.areas, options);
    let job = Job { mesh: input.mesh, options, facets, frame, bounds };
    job.plan(watch)
}

/// One vertical plane to look at.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanePicture {
    /// The part's section, (u, z) in mm.
    pub section: PolygonSet,
    /// What is to be held, before gaps and cuts.
    pub support: PolygonSet,
    /// The same were every downward surface held, wherever that stands: the paper's region.
    pub at_zero: PolygonSet,
    /// Edges above the bed that face down and lean past the overhang angle.
    pub hanging: Vec<(DVec2, DVec2)>,
    /// The points of [Zhao].
    pub points: Vec<SPoint>,
}

/// Surfaces no higher than this lie on the bed, mm.
const ON_BED_MM: f64 = 1e-3;

/// The plane `axis = at` as the Learn view and `draw --plane` show it.
pub fn examine_plane(mesh: &Mesh, options: &SupportOptions, axis: Axis, at: f64) -> PlanePicture {
    let facets = Facets::of(mesh, options);
    let cuts = section::sections(mesh, &facets, options, axis, &[at]);
    let held = |demand: Demand| {
        let columns: Vec<Column> = cuts.iter().flat_map(|(s, _)| s.columns(demand)).collect();
        plane::region(&columns)
    };
    let edges = cuts.iter().flat_map(|(section, _)| &section.edges);
    let hangs = |e: &&Edge| e.leans && e.to.x > e.from.x && e.from.y.max(e.to.y) > ON_BED_MM;
    let hanging = edges.filter(hangs).map(|e| (e.from, e.to)).collect();
    let area = crate::slice::slice_mesh(mesh, axis, &[at], 0.0).into_iter().next().unwrap_or_default().area;
    PlanePicture {
        points: points::s_points(&area),
        support: held(demand(options, false)),
        at_zero: held(Demand { every: true, everywhere: true, internal: options.internal }),
        hanging,
        section: area,
    }
}

/// One plate as a sheet without thickness, before gaps and cuts.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Normal of its plane.
    pub axis: Axis,
    /// Place of the plane, mm on the bed.
    pub at: f64,
    /// What it fills, (u, z) in mm: u is y in planes x = const, x in planes y = const.
    pub area: PolygonSet,
}

/// The sheets of planned plates, those along x first.
pub fn sheets(mesh: &Mesh, options: &SupportOptions, plates: &[PlateReport]) -> Vec<Sheet> {
    let facets = Facets::of(mesh, options);
    let of_axis = |axis: Axis| {
        let own = plates.iter().filter(|p| p.axis == PlateAxis::of(axis));
        let mut places: Vec<f64> = own.map(|p| p.at_mm).collect();
        // Added planes come last in the report; sections are cut from low to high.
        places.sort_by(f64::total_cmp);
        let cuts = section::sections(mesh, &facets, options, axis, &places);
        let area = |section: &PlaneSection| plane::region(&section.columns(demand(options, false)));
        cuts.iter().zip(places).map(|((s, _), at)| Sheet { axis, at, area: area(s) }).collect::<Vec<_>>()
    };
    [Axis::X, Axis::Y].into_iter().flat_map(of_axis).collect()
}

fn demand(options: &SupportOptions, every: bool) -> Demand {
    Demand { every, everywhere: options.everywhere, internal: options.internal }
}

/// What the steps of a plan share.
pub(crate) struct Job<'a> {
    mesh: &'a Mesh,
    options: &'a SupportOptions,
    facets: Facets,
    frame: Frame<'a>,
    bounds: Box3,
}

impl Job<'_> {
    fn plan(&self, watch: Watch<'_>) -> Result<Supports, SupportError> {
        const STEPS: u32 = 5;
        let mut step = |done: u32| if watch(done, STEPS) { Ok(()) } else { Err(SupportError::Cancelled) };
        step(0)?;
        let mut warnings = Vec::new();
        let adds_planes = self.options.method == SupportMethod::Plates;
        let (mut plates, complete_volume_mm3) = match self.options.method {
            SupportMethod::None => (Vec::new(), 0.0),
            SupportMethod::Plates => (self.regular_plates(&mut warnings), self.complete_volume()),
            SupportMethod::Grid => grid::plates(self),
        };
        step(1)?;
        plates::lay(&self.frame, &mut plates, |_| true);
        step(2)?;
        let needs = cover::needs(self);
        step(3)?;
        let first = pieces::sort_out(&self.frame, &mut plates);
        let mut sorted = if adds_planes { self.complete(&needs, &mut plates, first) } else { first };
        sorted.towers.retain(|tower| !foot::widen(self, &mut plates, tower));
        step(4)?;
        let (layers, volume_mm3) = beads::assemble(self, &needs, &plates);
        let report = SupportReport {
            method: self.options.method,
            volume_mm3,
            complete_volume_mm3,
            pieces: sorted.pieces,
            dropped: sorted.dropped,
            planes_added: plates.iter().filter(|p| p.is_added).count(),
            uncovered: cover::report_uncovered(self, &needs, &plates),
            plates: plates.iter().filter_map(report::of_plate).collect(),
            contact_mm2: beads::contact(&self.frame, &plates),
        };
        warnings.extend(report.uncovered.iter().map(SupportWarning::uncovered));
        warnings.extend(sorted.towers.iter().map(|t| SupportWarning::slender(&self.frame, &plates, t)));
        step(STEPS)?;
        Ok(Supports { layers, line_width: self.frame.width, report, warnings })
    }

    /// The extent of the part along an axis, mm.
    fn extent(&self, axis: Axis) -> [f64; 2] {
        [self.bounds.min, self.bounds.max].map(|v| axis.height(v).into())
    }

    fn spacing(&self, axis: Axis) -> f64 {
        let plates = &self.options.plates;
        match (self.options.method, axis) {
            (SupportMethod::Grid, _) => self.options.grid.spacing,
            (_, Axis::X) => plates.spacing_x,
            (_, Axis::Y | Axis::Z) => plates.spacing_y,
        }
    }

    fn sections(&self, axis: Axis, places: &[f64]) -> Vec<(PlaneSection, Vec<Gap>)> {
        section::sections(self.mesh, &self.facets, self.options, axis, places)
    }

    fn regular_plates(&self, warnings: &mut Vec<SupportWarning>) -> Vec<Plate> {
        let mut plates = Vec::new();
        for axis in [Axis::X, Axis::Y] {
            let [low, high] = self.extent(axis);
            let places = plates::regular_places(low, high, self.spacing(axis));
            let cuts = self.sections(axis, &places);
            warnings.extend(SupportWarning::open_planes(axis, &places, &cuts));
            let lines = self.options.plates.thickness;
            for ((section, _), at) in cuts.iter().zip(places) {
                let columns = section.columns(demand(self.options, false));
                plates.push(Plate::of_columns(axis, at, &columns, &self.frame, lines));
            }
        }
        plates
    }

    /// Adds planes for what hangs and for what may buckle.
    fn complete(&self, needs: &[Need], plates: &mut Vec<Plate>, first: pieces::Sorted) -> pieces::Sorted {
        cover::add_planes(self, needs, plates, false);
        let braced = self.brace(plates);
        // What was added may stand on nothing; the other direction may do better.
        cover::add_planes(self, needs, plates, true);
        let last = pieces::sort_out(&self.frame, plates);
        ties::join(self, plates);
        // A low wall keeps no tower from buckling: those found before it stay.
        let joined = pieces::sort_out(&self.frame, plates);
        let dropped = first.dropped + braced.dropped + last.dropped + joined.dropped;
        pieces::Sorted { dropped, pieces: joined.pieces, towers: last.towers }
    }

    /// Gives lonely towers a crossing plate; drops what stands on nothing.
    fn brace(&self, plates: &mut Vec<Plate>) -> pieces::Sorted {
        let sorted = pieces::sort_out(&self.frame, plates);
        if sorted.towers.is_empty() {
            return sorted;
        }
        cover::cross(self, &sorted.towers, plates);
        let again = pieces::sort_out(&self.frame, plates);
        pieces::Sorted { dropped: sorted.dropped + again.dropped, ..again }
    }

    /// Volume of all air that is to be held, mm3: areas of planes so near to each other that it
    /// makes no difference, times their distance.
    fn complete_volume(&self) -> f64 {
        /// Distance of the planes that measure, mm.
        const STEP_MM: f64 = 0.5;
        let [low, high] = self.extent(Axis::X);
        let count = ((high - low) / STEP_MM).ceil().max(1.0);
        let places = plates::regular_places(low, high, (high - low) / count);
        let area = |(section, _): &(PlaneSection, Vec<Gap>)| -> f64 {
            section.columns(demand(self.options, false)).iter().map(Column::area).sum()
        };
        // `+ 0.0`: the sum of nothing is -0.0.
        self.sections(Axis::X, &places).iter().map(area).sum::<f64>() * (high - low) / count + 0.0
    }
}
