//! Two tools: which one begins a layer, and the prime tower where they change.

use std::fmt;

use crate::mesh::Mesh;
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, dvec2};
use crate::region::{Path, Role};
use crate::settings::Settings;
use crate::slice::LayerSpec;
use crate::toolpath::prime_tower::tower_loops;

/// Free space around a prime tower, mm.
const AROUND_TOWER: f64 = 5.0;

/// Side of the cells in which free space on the bed is looked for, mm.
const CELL_MM: f64 = 1.0;

/// Depth of the strip along the front edge that the prime line needs, mm.
const FRONT_STRIP: f64 = 6.0;

/// Why a job cannot use two tools.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToolError {
    /// The printer has no second extruder.
    NoSecondTool,
    /// The prime tower finds no place on the bed.
    NoRoomForTower {
        /// Side of the square it needs, mm.
        size: f64,
    },
}

impl fmt::Display for ToolError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ToolError::NoSecondTool => {
                write!(f, "support.tool: 1 is the second extruder, but printer.extruders is 1")
            }
            ToolError::NoRoomForTower { size } => {
                write!(f, "prime_tower.size: the bed has no free place of {size} x {size} mm for the tower")
            }
        }
    }
}

impl std::error::Error for ToolError {}

/// Refuses a tool that is not there.
pub(super) fn check_tools(settings: &Settings) -> Result<(), ToolError> {
    let is_missing = settings.support.tool >= settings.printer.extruders;
    if is_missing { Err(ToolError::NoSecondTool) } else { Ok(()) }
}

/// Puts what the second tool lays before or after everything else of its layer, in turn, so that
/// tools change once a layer, and a prime tower on every layer up to the last change. Returns what
/// comes last in each layer; `laid` keeps what comes first.
pub(super) fn order_tools(
    laid: &mut [Vec<Path>],
    mesh: &Mesh,
    specs: &[LayerSpec],
    settings: &Settings,
) -> Result<Vec<Vec<Path>>, ToolError> {
    let mut after = vec![Vec::new(); laid.len()];
    let is_second = |path: &Path| matches!(path.role, Role::Support | Role::SupportInterface);
    let Some(last) = laid.iter().rposition(|paths| settings.support.tool > 0 && paths.iter().any(is_second))
    else {
        return Ok(after);
    };
    let corner = free_place(laid, mesh, settings)?;
    let tower = |k: usize| tower_loops(corner, &settings.prime_tower, settings.layers.height, k == 0);
    let mut second_begins = false;
    for (k, (before, after)) in laid.iter_mut().zip(&mut after).enumerate().take(last + 1) {
        let (second, first): (Vec<Path>, Vec<Path>) = before.drain(..).partition(is_second);
        if second_begins {
            // A layer without supports comes back to the first tool at once.
            *before = [second, tower(k), first].concat();
            second_begins = false;
        } else if second.is_empty() {
            *before = [tower(k), first].concat();
        } else {
            *before = first;
            *after = [tower(k), second].concat();
            second_begins = true;
        }
    }
    if second_begins && last + 1 < specs.len() {
        laid[last + 1].splice(..0, tower(last + 1));
    }
    Ok(after)
}

/// The lower left corner of a free square for the tower, as near to the part as there is one.
fn free_place(laid: &[Vec<Path>], mesh: &Mesh, settings: &Settings) -> Result<DVec2, ToolError> {
    let tower = &settings.prime_tower;
    let printer = &settings.printer;
    let bed = printer.bed();
    let room = tower.size + 2.0 * tower.brim_width;
    let mut cells = Cells::new(bed);
    cells.take(Bounds { min: bed.min, max: dvec2(bed.max.x, bed.min.y + FRONT_STRIP) });
    cells.take_where(|p| !printer.is_on_bed(p));
    printer.forbidden_zones().for_each(|zone| cells.take(zone));
    let flat = |v: glam::Vec3| dvec2(v.x.into(), v.y.into());
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t).map(flat);
        cells.take_all(&corners);
    }
    laid.iter().flatten().for_each(|path| cells.take_path(path));
    let centre = mesh.bounds().map_or((bed.min + bed.max) / 2.0, |b| (flat(b.min) + flat(b.max)) / 2.0);
    let corner = cells.nearest_free(room, centre).ok_or(ToolError::NoRoomForTower { size: room })?;
    Ok(corner + tower.brim_width)
}

/// The bed in cells, and how many things take each.
struct Cells {
    /// Where the first cell begins.
    origin: DVec2,
    columns: usize,
    rows: usize,
    /// Changes of the count from cell to cell; one row and column more than cells.
    changes: Vec<i32>,
}

impl Cells {
    fn new(bed: Bounds) -> Cells {
        let [columns, rows] = ((bed.max - bed.min) / CELL_MM).to_array().map(|n| n.floor() as usize);
        Cells { origin: bed.min, columns, rows, changes: vec![0; (columns + 1) * (rows + 1)] }
    }

    /// Takes a box and the free space around it.
    fn take(&mut self, taken: Bounds) {
        let taken = taken.grown(AROUND_TOWER);
        let taken = Bounds { min: taken.min - self.origin, max: taken.max - self.origin };
        let cell = |v: f64, count: usize| (v / CELL_MM).clamp(0.0, count as f64);
        let [x0, y0] = [cell(taken.min.x, self.columns).floor(), cell(taken.min.y, self.rows).floor()];
        let [x1, y1] = [cell(taken.max.x, self.columns).ceil(), cell(taken.max.y, self.rows).ceil()];
        for (x, y, change) in [(x0, y0, 1), (x1, y0, -1), (x0, y1, -1), (x1, y1, 1)] {
            self.changes[y as usize * (self.columns + 1) + x as usize] += change;
        }
    }

    /// Takes the cells that have a corner where nothing may stand.
    fn take_where(&mut self, closed: impl Fn(DVec2) -> bool) {
        let (origin, columns) = (self.origin, self.columns);
        for (x, y) in (0..self.rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            let corner = |dx: usize, dy: usize| origin + dvec2((x + dx) as f64, (y + dy) as f64) * CELL_MM;
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if corners.into_iter().any(&closed) {
                self.take_all(&corners);
            }
        }
    }

    fn take_all(&mut self, points: &[DVec2]) {
        if let Some(bounds) = Bounds::of_points(points) {
            self.take(bounds);
        }
    }

    fn take_path(&mut self, path: &Path) {
        path.points.windows(2).for_each(|ends| self.take_all(ends));
        if let (true, Some(first), Some(last)) = (path.closed, path.points.first(), path.points.last()) {
            self.take_all(&[*first, *last]);
        }
    }

    /// The lower left corner of the free square of side `room` whose middle is nearest to `centre`.
    fn nearest_free(&self, room: f64, centre: DVec2) -> Option<DVec2> {
        let width = self.columns + 1;
        let sums = |values: &[i32]| {
            let mut sums = values.to_vec();
            for i in 0..sums.len() {
                let left = if i % width > 0 { sums[i - 1] } else { 0 };
                let (below, corner) = match i.checked_sub(width) {
                    Some(b) => (sums[b], if i % width > 0 { sums[b - 1] } else { 0 }),
                    None => (0, 0),
                };
                sums[i] += left + below - corner;
            }
            sums
        };
        let taken: Vec<i32> = sums(&self.changes).iter().map(|&count| i32::from(count > 0)).collect();
        let taken = sums(&taken);
        let side = (room / CELL_MM).ceil() as usize;
        let before = |x: usize, y: usize| match (x.checked_sub(1), y.checked_sub(1)) {
            (Some(x), Some(y)) => taken[y * width + x],
            _ => 0,
        };
        let is_free = |&(x, y): &(usize, usize)| {
            before(x + side, y + side) - before(x, y + side) - before(x + side, y) + before(x, y) == 0
        };
        let xs = 0..(self.columns + 1).saturating_sub(side);
        let places = (0..(self.rows + 1).saturating_sub(side)).flat_map(|y| xs.clone().map(move |x| (x, y)));
        let corner = |(x, y): (usize, usize)| self.origin + dvec2(x as f64, y as f64) * CELL_MM;
        let distance = |place: &(usize, usize)| (corner(*place) + room / 2.0).distance_squared(centre);
        places.filter(is_free).min_by(|a, b| distance(a).total_cmp(&distance(b))).map(corner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_free_square_keeps_its_distance_and_stays_on_the_bed() {
        let mut cells = Cells::new(Bounds { min: DVec2::ZERO, max: dvec2(100.0, 60.0) });
        cells.take(Bounds { min: dvec2(40.0, 0.0), max: dvec2(60.0, 60.0) });
        let corner = cells.nearest_free(20.0, dvec2(52.0, 30.0)).expect("there is room");
        assert_eq!(corner, dvec2(65.0, 20.0));
        assert_eq!(cells.nearest_free(34.0, dvec2(52.0, 30.0)).map(|c| c.x), Some(65.0));
        assert_eq!(cells.nearest_free(36.0, dvec2(52.0, 30.0)), None);
        cells.take(Bounds { min: DVec2::ZERO, max: dvec2(100.0, 60.0) });
        assert_eq!(cells.nearest_free(1.0, DVec2::ZERO), None);
    }
}
