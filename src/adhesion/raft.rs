//! Layers below the part, and the air gap that lets it come off.

use super::error::{AdhesionWarning, WarningCode};
use super::ground::{Ground, grown, simplified_by};
use super::options::RaftOptions;
use super::{FirstLayer, Foundation, RaftLayer};
use crate::polygon::{DVec2, Join, PolygonSet, dvec2};
use crate::region::{Path, Role};

/// Neighbouring lines are joined at their ends when these are at most this many spacings apart: along a
/// border that leans up to 70 degrees from the lines' normal.
const JOIN_SPACINGS: f64 = 3.0;

/// A raft's border need not follow the part closer than this, mm; each vertex of a wavy part would be a
/// corner of the border.
const BORDER_TOLERANCE_MM: f64 = 0.05;

/// A sparse base layer on the bed and dense interface layers on it, lines crossing from layer to layer.
pub(super) fn raft(first: &FirstLayer, ground: &Ground, options: &RaftOptions) -> Foundation {
    let whole = grown(
        &simplified_by(&ground.area, BORDER_TOLERANCE_MM),
        options.margin,
        Join::Square,
        BORDER_TOLERANCE_MM,
    );
    let whole = simplified_by(&whole, BORDER_TOLERANCE_MM);
    let bed = PolygonSet::rectangle(first.bed.min, first.bed.max);
    let fits = whole.bounds().is_none_or(|b| first.bed.contains(b));
    let footprint = if fits { whole } else { whole.intersection(&bed) };
    let layer = |index: u32| {
        let is_base = index == 0 && options.layers > 1;
        let (width, density) = match is_base {
            true => (options.base_line_width, options.base_density),
            false => (options.interface_line_width, options.interface_density),
        };
        let height = if index == 0 { first.height } else { options.layer_height };
        RaftLayer { height, paths: layer_paths(&footprint, width, width / density, index % 2 == 1) }
    };
    let raft: Vec<RaftLayer> =
        if footprint.is_empty() { Vec::new() } else { (0..options.layers).map(layer).collect() };
    let lift = if raft.is_empty() { 0.0 } else { raft.iter().map(|l| l.height).sum::<f64>() + options.gap };
    let message = "adhesion.raft.margin: the raft would leave the bed; it is cut off there".to_owned();
    let warning = AdhesionWarning::new(WarningCode::AdhesionOffBed, message, None);
    let warnings = if fits { Vec::new() } else { vec![warning] };
    Foundation { layers: vec![Vec::new()], raft, lift, warnings, ..Foundation::default() }
}

/// A loop along the border, then lines along x or, when `turned`, along y.
fn layer_paths(footprint: &PolygonSet, width: f64, spacing: f64, turned: bool) -> Vec<Path> {
    let border = footprint.offset(-width / 2.0, Join::WALL);
    let inside = footprint.offset(-width, Join::WALL);
    let loops = border.contours().iter().map(|c| Path::closed(Role::Raft, c.points.clone(), width));
    let lines = hatch(&inside, spacing, turned);
    loops.chain(lines.into_iter().map(|points| Path::open(Role::Raft, points, width))).collect()
}

/// Lines `spacing` apart across an area, joined at their ends to long lines that run to and fro.
fn hatch(area: &PolygonSet, spacing: f64, turned: bool) -> Vec<Vec<DVec2>> {
    let swap = |p: DVec2| if turned { dvec2(p.y, p.x) } else { p };
    let Some(bounds) = area.bounds() else { return Vec::new() };
    let (low, high) = (swap(bounds.min).y, swap(bounds.max).y);
    let rows = ((high - low) / spacing).ceil().max(1.0) as u32;
    // The same distance at both ends.
    let start = (low + high - f64::from(rows - 1) * spacing) / 2.0;
    let crossings = row_crossings(area, start, spacing, rows, swap);
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for (row, mut xs) in crossings.into_iter().enumerate() {
        xs.sort_by(f64::total_cmp);
        let y = start + row as f64 * spacing;
        let mut next = Vec::new();
        for pair in xs.chunks_exact(2) {
            let ends = (dvec2(pair[0], y), dvec2(pair[1], y));
            let index = match open.iter().position(|&i| follows(&lines[i], ends, spacing)) {
                Some(at) => open.swap_remove(at),
                None => {
                    lines.push(Vec::new());
                    lines.len() - 1
                }
            };
            let forward = lines[index].last().is_none_or(|&p| p.distance(ends.0) <= p.distance(ends.1));
            lines[index].extend(if forward { [ends.0, ends.1] } else { [ends.1, ends.0] });
            next.push(index);
        }
        open = next;
    }
    lines.into_iter().map(|line| line.into_iter().map(swap).collect()).collect()
}

fn follows(line: &[DVec2], ends: (DVec2, DVec2), spacing: f64) -> bool {
    let nearest = |p: &DVec2| p.distance(ends.0).min(p.distance(ends.1));
    line.last().is_some_and(|p| nearest(p) <= JOIN_SPACINGS * spacing)
}

/// Where the border crosses each row; an edge counts for rows from its lower end up to, not with, its
/// upper one.
fn row_crossings(
    area: &PolygonSet,
    start: f64,
    spacing: f64,
    rows: u32,
    swap: impl Fn(DVec2) -> DVec2,
) -> Vec<Vec<f64>> {
    let mut found = vec![Vec::new(); rows as usize];
    for (a, b) in area.contours().iter().flat_map(|c| c.edges()) {
        let (a, b) = (swap(a), swap(b));
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        let row = |y: f64| ((y - start) / spacing).ceil().clamp(0.0, f64::from(rows)) as usize;
        for (k, xs) in found.iter_mut().enumerate().take(row(b.y)).skip(row(a.y)) {
            let y = start + k as f64 * spacing;
            xs.push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
        }
    }
    found
}
