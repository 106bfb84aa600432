//! A thicker foot for towers that no crossing plate can hold.

use super::Job;
use super::pieces::{SLENDER, Tower};
use super::plates::{Plate, lines_at};
use super::spans::{self, Span};

/// Gives a tower one more line on either side, where there is room, so high that what stands above
/// is no taller than a plate may be alone. Whether a foot could be given; to be called last, as the
/// lines are laid here.
pub(super) fn widen(job: &Job, plates: &mut Vec<Plate>, tower: &Tower) -> bool {
    let frame = &job.frame;
    let plate = &plates[tower.plate];
    let count = plate.lines.len() as u32;
    let free_mm = SLENDER * f64::from(count) * frame.width;
    let high = frame.layers[tower.top].print_z - free_mm;
    let own = stack(plate, tower);
    let (axis, wide) = (plate.axis, lines_at(plate.at, count + 2, frame));
    let mut is_wide = false;
    for at in [wide[0].at, wide[wide.len() - 1].at] {
        let is_taken =
            |p: &Plate| p.axis == axis && p.lines.iter().any(|l| (l.at - at).abs() < frame.width - 1e-9);
        if plates.iter().any(is_taken) {
            continue;
        }
        let mut lines = lines_at(at, 1, frame);
        for k in (0..=tower.top).filter(|&k| frame.layers[k].print_z <= high + 1e-6) {
            let grown: Vec<Span> =
                own[k].iter().map(|s| [s[0] - frame.width / 2.0, s[1] + frame.width / 2.0]).collect();
            lines[0].beads[k] = frame.clear(k, axis, &[at], &[&grown]).remove(0);
            is_wide |= !lines[0].beads[k].is_empty();
        }
        let air = vec![Vec::new(); frame.layers.len()];
        plates.push(Plate { axis, at, is_added: false, area_mm2: 0.0, air, lines });
    }
    is_wide
}

/// The tower's own beads, layer by layer, from its top down.
fn stack(plate: &Plate, tower: &Tower) -> Vec<Vec<Span>> {
    let mut own = vec![Vec::new(); tower.top + 1];
    let mut above = vec![tower.span];
    for k in (0..=tower.top).rev() {
        let beads = plate.lines.iter().fold(Vec::new(), |all, l| spans::unite(&all, &l.beads[k]));
        above = beads.into_iter().filter(|s| above.iter().any(|a| spans::meet(*s, *a, 0.0))).collect();
        if above.is_empty() {
            break;
        }
        own[k].clone_from(&above);
    }
    own
}
