//! The choice among directions, and the report that shows it.

use serde::Serialize;

use super::evaluate::DirectionFigures;
use super::net::{DIRECTIONS, Net, ScaledVolumes};
use super::{Candidates, OrientationError, OrientationOptions, exact};
use crate::sort::StableSort;

/// The directions with their figures, and the choice; the object `orientation` of a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OrientationReport {
    /// Height of the uniform layers that the figures were computed with, mm.
    pub layer_height_mm: f64,
    /// By id: the six axes, then sides of the convex hull.
    pub directions: Vec<DirectionFigures>,
    /// O_1 by the network: 1 for each of the six that it takes for a minimum.
    pub o1: [u8; DIRECTIONS],
    /// R by [Karim] eq. (13), from the exact minima.
    pub r: [f64; DIRECTIONS],
    /// O_2, one-hot: the first of the six with the largest R.
    pub o2: [u8; DIRECTIONS],
    /// O_1 by computation; it wins where the network differs.
    pub exact: [u8; DIRECTIONS],
    /// Id of the chosen direction: by O_2, or by the exact rule among all where the hull's sides may
    /// be chosen.
    pub chosen: u32,
    /// What a person should know about the figures; part of the whole report's warnings.
    #[serde(skip)]
    pub remarks: Vec<Remark>,
}

/// Something a person should know about the choice.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// Fixed name of the remark.
    pub code: &'static str,
    /// A sentence for people.
    pub message: String,
}

impl OrientationReport {
    /// Whether the network and the exact rule give the same minima.
    pub fn network_agrees(&self) -> bool {
        self.o1 == self.exact
    }

    /// Figures of the chosen direction.
    pub fn chosen_figures(&self) -> Option<&DirectionFigures> {
        self.directions.iter().find(|d| d.id == self.chosen)
    }
}

/// Chooses among evaluated directions, which may come in any order; all six axes must be there.
pub fn choose(
    figures: Vec<DirectionFigures>,
    options: &OrientationOptions,
) -> Result<OrientationReport, OrientationError> {
    choose_with(&Net::stored(), figures, options)
}

/// [`choose`] with another network.
fn choose_with(
    net: &Net,
    mut figures: Vec<DirectionFigures>,
    options: &OrientationOptions,
) -> Result<OrientationReport, OrientationError> {
    figures.stable_sort_by_key(|f| f.id);
    let bad = |f: &&DirectionFigures| ![f.support_mm3, f.base_mm3, f.total_mm3].iter().all(|v| v.is_finite());
    if let Some(found) = figures.iter().find(bad) {
        return Err(OrientationError::BadFigures { id: found.id });
    }
    let six = first_six(&figures)?;
    let volumes = six.map(|f| f.total_mm3);
    if six.iter().all(|f| f.bed_contact_mm2 == 0.0 && f.total_mm3 == 0.0) {
        return Err(OrientationError::NothingInside);
    }
    let scaled = ScaledVolumes::new(volumes).ok_or(OrientationError::BadFigures { id: 1 })?;
    let (o1, exact) = (net.minima(&scaled), exact::minima(&volumes));
    let r = exact::ratings(&exact, &six.map(|f| f.structures));
    let o2 = exact::first_largest(&r);
    let chosen = match options.candidates {
        Candidates::Axes => o2.iter().zip(1..).find(|(one, _)| **one == 1).map_or(1, |(_, id)| id),
        Candidates::Hull => {
            let volumes: Vec<f64> = figures.iter().map(|f| f.total_mm3).collect();
            let structures: Vec<u32> = figures.iter().map(|f| f.structures).collect();
            figures[exact::best(&volumes, &structures)].id
        }
    };
    mark_pareto(&mut figures);
    let mut remarks = remarks(&figures, o1, exact);
    remarks.extend(small_contact(&figures, chosen));
    let layer_height_mm = options.layer_height;
    Ok(OrientationReport { layer_height_mm, directions: figures, o1, r, o2, exact, chosen, remarks })
}

/// Figures of ids 1 to 6, from figures sorted by id.
fn first_six(figures: &[DirectionFigures]) -> Result<[DirectionFigures; DIRECTIONS], OrientationError> {
    let missing = |id: u32| OrientationError::BadFigures { id };
    for (i, id) in (1..=DIRECTIONS as u32).enumerate() {
        if figures.get(i).is_none_or(|f| f.id != id) {
            return Err(missing(id));
        }
    }
    Ok(std::array::from_fn(|i| figures[i]))
}

/// Marks the directions that no other one beats in volume, structures and height together.
fn mark_pareto(figures: &mut [DirectionFigures]) {
    let costs: Vec<[f64; 3]> =
        figures.iter().map(|f| [f.total_mm3, f64::from(f.structures), f.height_mm]).collect();
    let beats = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).all(|(x, y)| x <= y) && a != b;
    for (figure, own) in figures.iter_mut().zip(&costs) {
        figure.pareto = !costs.iter().any(|other| beats(other, own));
    }
}

fn remarks(figures: &[DirectionFigures], o1: [u8; DIRECTIONS], exact: [u8; DIRECTIONS]) -> Vec<Remark> {
    let mut found = Vec::new();
    if o1 != exact {
        let message = format!(
            "the network takes {} for the minimum, the exact comparison {}; the exact one is used",
            ids(&o1),
            ids(&exact)
        );
        found.push(Remark { code: "orientation_network_differs", message });
    }
    let open = figures.iter().map(|f| f.open_layers).max().unwrap_or(0);
    if open > 0 {
        let message = format!("the model is open: up to {open} layers were closed to compare directions");
        found.push(Remark { code: "orientation_open_mesh", message });
    }
    found
}

/// A part stands on little when the square of its height is this many times its area on the bed.
const TALL: f64 = 20.0;

/// Another direction is named when it needs at most this many times the volume...
const LITTLE_MORE: f64 = 1.25;

/// ...and has at least so many times the area on the bed.
const FAR_WIDER: f64 = 4.0;

/// Says that the part would stand on little this way up, which neither volume nor structures tell, and
/// names the direction that a person may like better.
fn small_contact(figures: &[DirectionFigures], chosen: u32) -> Option<Remark> {
    let own = figures.iter().find(|f| f.id == chosen)?;
    if own.height_mm * own.height_mm <= TALL * own.bed_contact_mm2 {
        return None;
    }
    let fits = |f: &&DirectionFigures| {
        f.id != chosen
            && f.total_mm3 <= LITTLE_MORE * own.total_mm3
            && f.bed_contact_mm2 >= FAR_WIDER * own.bed_contact_mm2
    };
    let wider = figures.iter().filter(fits).max_by(|a, b| a.bed_contact_mm2.total_cmp(&b.bed_contact_mm2));
    let (id, contact, height) = (own.id, own.bed_contact_mm2, own.height_mm);
    let stands = format!("direction {id} stands {height:.0} mm high on {contact:.0} mm2");
    let message = match wider {
        Some(f) => {
            let more = 100.0 * (f.total_mm3 - own.total_mm3) / own.total_mm3.max(f64::MIN_POSITIVE);
            let wide = f.bed_contact_mm2;
            format!("{stands}; direction {} needs {more:.0} % more support and stands on {wide:.0} mm2", f.id)
        }
        None => format!("{stands} only"),
    };
    Some(Remark { code: "orientation_small_contact", message })
}

/// "1 and 5" or "none".
fn ids(minima: &[u8; DIRECTIONS]) -> String {
    let ids = minima.iter().zip(1..).filter(|(one, _)| **one == 1).map(|(_, id): (_, u32)| id.to_string());
    let ids: Vec<String> = ids.collect();
    if ids.is_empty() { "none".to_owned() } else { ids.join(" and ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of six directions with these volumes and structures.
    fn figures(volumes: [f64; 6], structures: [u32; 6]) -> Vec<DirectionFigures> {
        let one = |i: usize| DirectionFigures {
            id: i as u32 + 1,
            up: super::super::six()[i].up,
            support_mm3: volumes[i],
            base_mm3: 0.0,
            total_mm3: volumes[i],
            structures: structures[i],
            specks: 0,
            support_filament_mm: 0.0,
            bed_contact_mm2: 100.0,
            height_mm: 10.0,
            layers: 50,
            time_surrogate_s: 0.0,
            scarred_mm2: 0.0,
            open_layers: 0,
            pareto: false,
        };
        (0..6).map(one).collect()
    }

    #[test]
    fn part_model_2_is_printed_as_it_lies() {
        let volumes = [44018.47, 44018.47, 58191.38, 137691.38, 152373.41, 106998.41];
        let report = choose(figures(volumes, [3, 3, 3, 4, 2, 2]), &OrientationOptions::default()).unwrap();
        assert_eq!(report.o1, [1, 1, 0, 0, 0, 0]);
        assert_eq!(report.exact, report.o1);
        assert_eq!(report.o2, [1, 0, 0, 0, 0, 0]);
        assert_eq!(report.chosen, 1);
        assert!(report.network_agrees() && report.remarks.is_empty());
    }

    #[test]
    fn a_part_that_would_stand_on_little_is_told_of_with_the_wider_way_up() {
        let mut found = figures([5713.0, 9000.0, 9000.0, 9000.0, 5261.0, 9000.0], [4; 6]);
        (found[4].height_mm, found[4].bed_contact_mm2, found[0].bed_contact_mm2) = (41.0, 25.0, 642.0);
        let report = choose(found.clone(), &OrientationOptions::default()).unwrap();
        assert_eq!(report.chosen, 5);
        assert_eq!(report.remarks[0].code, "orientation_small_contact");
        assert_eq!(
            report.remarks[0].message,
            "direction 5 stands 41 mm high on 25 mm2; direction 1 needs 9 % more support and stands on 642 mm2"
        );
        found[4].bed_contact_mm2 = 85.0;
        assert!(choose(found, &OrientationOptions::default()).unwrap().remarks.is_empty());
    }

    #[test]
    fn where_the_network_differs_the_exact_rule_wins_and_the_report_says_so() {
        let volumes = [90_000.0, 20_001.0, 20_000.0, 60_000.0, 100_000.0, 80_000.0];
        let report = choose(figures(volumes, [2; 6]), &OrientationOptions::default()).unwrap();
        assert_eq!(report.o1, [0, 1, 1, 0, 0, 0]);
        assert_eq!(report.exact, [0, 0, 1, 0, 0, 0]);
        assert_eq!(report.chosen, 3);
        let remark = &report.remarks[0];
        assert_eq!(remark.code, "orientation_network_differs");
        assert_eq!(
            remark.message,
            "the network takes 2 and 3 for the minimum, the exact comparison 3; the exact one is used"
        );
    }
}
