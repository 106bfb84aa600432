//! A plain grid, to compare plates with: lines along x and y below everything that [Karim] calls
//! externally supported, at one spacing, without added planes.

use super::Job;
use super::cover::{boxes_at, closed_cavities};
use super::interface::level_lines;
use super::plates::{Plate, lines_at, regular_places};
use super::spans;
use crate::polygon::PolygonSet;
use crate::region::overhang::{externally_supported, permissible_step};
use crate::slice::Axis;

/// The lines of the grid as plates, and the volume of the full support regions, mm3.
pub(super) fn plates(job: &Job) -> (Vec<Plate>, f64) {
    let frame = &job.frame;
    let regions = regions(job);
    let volume = regions.iter().zip(frame.layers).map(|(s, l)| s.area() * l.height).sum::<f64>() + 0.0;
    let room: Vec<PolygonSet> = (0..regions.len()).map(|k| with_gaps(job, &regions, k)).collect();
    let spacing = job.options.grid.spacing;
    let mut plates = Vec::new();
    for axis in [Axis::X, Axis::Y] {
        let [low, high] = job.extent(axis);
        let places = regular_places(low, high, spacing);
        let of_place = |at: &f64| Plate {
            axis,
            at: *at,
            is_added: false,
            area_mm2: 0.0,
            air: vec![Vec::new(); frame.layers.len()],
            lines: lines_at(*at, 1, frame),
        };
        let mut lines: Vec<Plate> = places.iter().map(of_place).collect();
        for (k, room) in room.iter().enumerate() {
            for (plate, air) in lines.iter_mut().zip(level_lines(room, axis, &places)) {
                plate.air[k] = air;
            }
            for (plate, held) in lines.iter_mut().zip(level_lines(&regions[k], axis, &places)) {
                plate.area_mm2 += spans::length(&held) * frame.layers[k].height;
            }
        }
        plates.extend(lines);
    }
    (plates, volume)
}

/// S_k = (S_(k+1) u ESF_k) - A_k from the top down ([Karim] eq. 9), boxes and cavities minded.
fn regions(job: &Job) -> Vec<PolygonSet> {
    let (frame, options) = (&job.frame, job.options);
    let count = frame.layers.len();
    let closed = closed_cavities(job);
    let mut regions = vec![PolygonSet::EMPTY; count];
    for k in (0..count.saturating_sub(1)).rev() {
        let (above, below) = (&frame.areas[k + 1], &frame.areas[k]);
        let boxes = |list: &[[f64; 6]]| {
            PolygonSet::union_all(&boxes_at(list, frame.layers[k].slice_z, frame.layers[k + 1].slice_z))
        };
        let step = permissible_step(frame.layers[k + 1].height, options.overhang_angle_deg);
        let enforced = above.difference(below).intersection(&boxes(&options.enforcers));
        let held = externally_supported(above, below, step).union(&enforced);
        let held = held.difference(&boxes(&options.blockers)).difference(&closed[k]);
        regions[k] = regions[k + 1].union(&held).difference(below);
    }
    if !options.everywhere {
        let mut part = PolygonSet::EMPTY;
        for (region, area) in regions.iter_mut().zip(frame.areas) {
            part = part.union(area);
            *region = region.difference(&part);
        }
    }
    regions
}

/// A region without the empty layers above and below the part.
fn with_gaps(job: &Job, regions: &[PolygonSet], k: usize) -> PolygonSet {
    if regions[k].is_empty() {
        return PolygonSet::EMPTY;
    }
    let near = (k - job.frame.below[k])..=(k + job.frame.above[k]);
    let part = PolygonSet::union_all(near.filter(|&i| i != k).map(|i| &job.frame.areas[i]));
    regions[k].difference(&part)
}
