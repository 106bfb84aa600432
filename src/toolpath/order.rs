//! The printing order of a layer: island after island, walls from inside out, then the fills; each
//! on a short way.

use super::comb::Comb;
use super::route::{Leg, Stop, route};
use super::seam::{SeamPosition, start_nearest_to};
use super::travel::Way;
use crate::polygon::measure::Bounds;
use crate::polygon::simplify::squared_distance_to_segment;
use crate::polygon::{DVec2, Polygon, PolygonSet};
use crate::region::{Path, Role};
use crate::sort::StableSort;

/// Everything to be printed on one layer, in no order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayerParts {
    /// Skirt, brim and their kin: printed first and in the given order.
    pub foundation: Vec<Path>,
    /// Wall loops, each starting at its seam, with their depth: 0 is the outer wall.
    pub walls: Vec<(u32, Path)>,
    /// Infill, skins, gap fill.
    pub fills: Vec<Path>,
    /// Fills whose order and direction are given, such as monotonic lines.
    pub rows: Vec<Vec<Path>>,
    /// What another tool lays: printed last and in the given order.
    pub after: Vec<Path>,
}

/// A layer's paths in printing order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayerPaths {
    /// The beads.
    pub paths: Vec<Path>,
    /// The way to each path from the one before. The way to the first path counts as crossing.
    pub ways: Vec<Way>,
}

/// Roles that are printed last on their island, in this order: what is seen comes on top.
const LAST: [Role; 2] = [Role::TopSkin, Role::Ironing];

/// Puts the parts of a layer in printing order.
///
/// Layers with an even number lead from the front left to the rear right, the others back, whatever
/// was printed before, so that each layer can be ordered alone and still begins near where the one
/// below ends.
pub fn order_layer(parts: LayerParts, outline: &PolygonSet, layer: u32, seam: SeamPosition) -> LayerPaths {
    let corners = outline.bounds().map_or([DVec2::ZERO; 2], |b| [b.min, b.max]);
    let [start, goal] = if layer.is_multiple_of(2) { corners } else { [corners[1], corners[0]] };
    let mut paths = parts.foundation;
    let mut here = paths.last().map_or(start, end_of);
    let polygons = outline.islands();
    let islands = on_short_way(by_island(parts.walls, parts.fills, parts.rows, &polygons), here, goal);
    let mut goals: Vec<DVec2> =
        islands.iter().skip(1).map(|i| i.bounds().map_or(goal, |b| b.centre())).collect();
    goals.push(goal);
    for (mut island, goal) in islands.into_iter().zip(goals) {
        order_walls(std::mem::take(&mut island.walls), seam, &mut here, &mut paths);
        order_fills(&island, &mut here, goal, &mut paths);
    }
    paths.extend(parts.after);
    let ways = find_ways(&paths, &polygons);
    LayerPaths { paths, ways }
}

/// Where the nozzle stands after a path.
fn end_of(path: &Path) -> DVec2 {
    let last = if path.closed { path.points.first() } else { path.points.last() };
    last.copied().unwrap_or_default()
}

#[derive(Default)]
struct Island {
    walls: Vec<(u32, Path)>,
    fills: Vec<Path>,
    rows: Vec<Vec<Path>>,
}

impl Island {
    fn bounds(&self) -> Option<Bounds> {
        let paths = self.walls.iter().map(|(_, p)| p).chain(&self.fills).chain(self.rows.iter().flatten());
        paths.filter_map(|p| Bounds::of_points(&p.points)).reduce(Bounds::union)
    }
}

fn by_island(
    walls: Vec<(u32, Path)>,
    fills: Vec<Path>,
    rows: Vec<Vec<Path>>,
    polygons: &[Polygon],
) -> Vec<Island> {
    let boxes: Vec<Option<Bounds>> = polygons.iter().map(|p| p.outer.bounds()).collect();
    let mut islands: Vec<Island> = Vec::new();
    islands.resize_with(polygons.len().max(1), Island::default);
    for (depth, path) in walls {
        islands[island_of(&path, polygons, &boxes)].walls.push((depth, path));
    }
    for path in fills {
        islands[island_of(&path, polygons, &boxes)].fills.push(path);
    }
    for row in rows {
        if let Some(first) = row.first() {
            islands[island_of(first, polygons, &boxes)].rows.push(row);
        }
    }
    islands
}

/// The island around the middle of the path's first edge; the first one for a path in none.
fn island_of(path: &Path, islands: &[Polygon], boxes: &[Option<Bounds>]) -> usize {
    if islands.len() < 2 {
        return 0;
    }
    let probe = (path.points[0] + path.points[1 % path.points.len()]) / 2.0;
    let near = |i: &usize| boxes[*i].is_some_and(|b| b.contains(Bounds { min: probe, max: probe }));
    let inside =
        |i: &usize| islands[*i].outer.contains(probe) && !islands[*i].holes.iter().any(|h| h.contains(probe));
    (0..islands.len()).filter(near).find(inside).unwrap_or(0)
}

/// The islands on a short way by the middles of their boxes.
fn on_short_way(islands: Vec<Island>, start: DVec2, goal: DVec2) -> Vec<Island> {
    let mut used: Vec<(Bounds, Option<Island>)> =
        islands.into_iter().filter_map(|i| Some((i.bounds()?, Some(i)))).collect();
    let stops: Vec<Stop> = used.iter().map(|(b, _)| Stop { ends: [b.centre(); 2], turns: true }).collect();
    route(&stops, start, Some(goal)).into_iter().filter_map(|leg| used[leg.stop].1.take()).collect()
}

/// A loop is printed when all loops just inside it are; of those that may be, the nearest. Loops inside
/// others start beside the seam of the one around them.
fn order_walls(mut walls: Vec<(u32, Path)>, seam: SeamPosition, here: &mut DVec2, paths: &mut Vec<Path>) {
    let parents: Vec<Option<usize>> = (0..walls.len()).map(|i| parent_of(&walls, i)).collect();
    let anywhere = seam == SeamPosition::Nearest;
    if !anywhere {
        start_beside_parents(&mut walls, &parents);
    }
    let mut waiting_for = vec![0usize; walls.len()];
    for parent in parents.iter().flatten() {
        waiting_for[*parent] += 1;
    }
    let mut left: Vec<usize> = (0..walls.len()).collect();
    while !left.is_empty() {
        let start = |i: usize| match anywhere {
            true => walls[i].1.points.iter().map(|p| p.distance_squared(*here)).fold(f64::INFINITY, f64::min),
            false => walls[i].1.points[0].distance_squared(*here),
        };
        let free = (0..left.len()).filter(|&k| waiting_for[left[k]] == 0);
        let nearest = free.map(|k| (start(left[k]), k)).min_by(|a, b| a.0.total_cmp(&b.0));
        // Parents lie one step farther out, so that they form no circle and one is always free.
        let Some((_, k)) = nearest else { return };
        let i = left.remove(k);
        if let Some(parent) = parents[i] {
            waiting_for[parent] -= 1;
        }
        let path = if anywhere { entered_near(&walls[i].1, *here) } else { walls[i].1.clone() };
        *here = end_of(&path);
        paths.push(path);
    }
}

fn start_beside_parents(walls: &mut [(u32, Path)], parents: &[Option<usize>]) {
    let mut from_outside: Vec<usize> = (0..walls.len()).collect();
    from_outside.stable_sort_by_key(|&i| walls[i].0);
    for i in from_outside {
        if let Some(parent) = parents[i].filter(|_| walls[i].1.closed) {
            let seam = walls[parent].1.points[0];
            start_nearest_to(&mut walls[i].1, seam);
        }
    }
}

/// The loop one step farther out that runs nearest to this one's start.
fn parent_of(walls: &[(u32, Path)], index: usize) -> Option<usize> {
    let (depth, path) = &walls[index];
    let start = path.points[0];
    let outside = (0..walls.len()).filter(|&i| walls[i].0 + 1 == *depth);
    let distance = |i: usize| {
        let points = &walls[i].1.points;
        let edges = (0..points.len()).map(|e| (points[e], points[(e + 1) % points.len()]));
        edges.map(|(a, b)| squared_distance_to_segment(start, a, b)).fold(f64::INFINITY, f64::min)
    };
    outside.map(|i| (distance(i), i)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, i)| i)
}

/// Fills and rows of an island: all roles together on a short way, those that lie on top after them.
fn order_fills(island: &Island, here: &mut DVec2, goal: DVec2, paths: &mut Vec<Path>) {
    let single = island.fills.iter().map(std::slice::from_ref);
    let all: Vec<&[Path]> = single.chain(island.rows.iter().map(Vec::as_slice)).collect();
    let rank = |paths: &[Path]| LAST.iter().position(|r| *r == paths[0].role).map_or(0, |place| place + 1);
    for wanted in 0..=LAST.len() {
        let group: Vec<&[Path]> = all.iter().copied().filter(|paths| rank(paths) == wanted).collect();
        let is_last = !all.iter().any(|paths| rank(paths) > wanted);
        lay_on_short_way(&group, here, is_last.then_some(goal), paths);
    }
}

/// Paths alone may be printed from either end, rows of several as they are.
fn lay_on_short_way(group: &[&[Path]], here: &mut DVec2, goal: Option<DVec2>, paths: &mut Vec<Path>) {
    let stop =
        |row: &&[Path]| Stop { ends: [row[0].points[0], end_of(&row[row.len() - 1])], turns: row.len() == 1 };
    let stops: Vec<Stop> = group.iter().map(stop).collect();
    for Leg { stop, turned } in route(&stops, *here, goal) {
        match group[stop] {
            [alone] if alone.closed => paths.push(entered_near(alone, *here)),
            [alone] if turned => paths.push(alone.clone().reversed()),
            row => paths.extend_from_slice(row),
        }
        *here = paths.last().map_or(*here, end_of);
    }
}

/// A closed path from the vertex where the nozzle is nearest.
fn entered_near(path: &Path, here: DVec2) -> Path {
    if !path.closed {
        return path.clone();
    }
    let distance = |i: &usize| path.points[*i].distance_squared(here);
    let nearest = (0..path.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut entered = path.clone();
    entered.start_at(nearest.unwrap_or(0));
    entered
}

/// Combed ways; the rails are the outer walls, which run half a bead inside the outline.
fn find_ways(paths: &[Path], outline: &[Polygon]) -> Vec<Way> {
    let outer = |closed: bool| {
        let of_kind = paths.iter().filter(move |p| p.role == Role::OuterWall && p.closed == closed);
        of_kind.map(|p| p.points.as_slice()).collect()
    };
    let comb = Comb::new(outline, outer(true), outer(false));
    let ways = paths.windows(2).map(|w| comb.way(end_of(&w[0]), w[1].points[0]));
    let first = paths.first().map(|_| Way::ACROSS);
    first.into_iter().chain(ways).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    fn ring(side: f64, role: Role) -> Path {
        let c = |x: f64, y: f64| dvec2(50.0 + side * x, 50.0 + side * y);
        Path::closed(role, vec![c(-0.5, -0.5), c(0.5, -0.5), c(0.5, 0.5), c(-0.5, 0.5)], 0.45)
    }

    fn crossings(layer: &LayerPaths) -> Vec<bool> {
        layer.ways.iter().map(|w| w.crosses_outline).collect()
    }

    #[test]
    fn inner_walls_come_before_the_outer_one() {
        let outline = PolygonSet::rectangle(dvec2(40.0, 40.0), dvec2(60.0, 60.0));
        let walls = vec![
            (0, ring(19.5, Role::OuterWall)),
            (1, ring(18.7, Role::InnerWall)),
            (2, ring(17.9, Role::InnerWall)),
        ];
        let ordered =
            order_layer(LayerParts { walls, ..LayerParts::default() }, &outline, 0, SeamPosition::Aligned);
        let lengths: Vec<f64> =
            ordered.paths.iter().map(|p| (p.length() / 4.0 * 10.0).round() / 10.0).collect();
        assert_eq!(lengths, [17.9, 18.7, 19.5]);
        assert_eq!(crossings(&ordered), [true, false, false]);
    }

    #[test]
    fn open_lines_are_entered_at_their_nearer_end() {
        let line = |x: f64| Path::open(Role::Infill, vec![dvec2(x, 0.0), dvec2(x, 10.0)], 0.45);
        let outline = PolygonSet::rectangle(dvec2(-1.0, -1.0), dvec2(9.0, 11.0));
        let fills = vec![line(4.0), line(0.0), line(2.0)];
        let ordered =
            order_layer(LayerParts { fills, ..LayerParts::default() }, &outline, 0, SeamPosition::Aligned);
        let starts: Vec<DVec2> = ordered.paths.iter().map(|p| p.points[0]).collect();
        assert_eq!(starts, [dvec2(0.0, 0.0), dvec2(2.0, 10.0), dvec2(4.0, 0.0)]);
    }

    #[test]
    fn a_way_from_island_to_island_crosses_the_outline() {
        let two = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(5.0, 5.0))
            .union(&PolygonSet::rectangle(dvec2(10.0, 0.0), dvec2(15.0, 5.0)));
        let dash = |x: f64| Path::open(Role::Infill, vec![dvec2(x, 2.0), dvec2(x + 1.0, 2.0)], 0.45);
        let fills = vec![dash(12.0), dash(1.0), dash(3.0)];
        let ordered =
            order_layer(LayerParts { fills, ..LayerParts::default() }, &two, 0, SeamPosition::Aligned);
        assert_eq!(crossings(&ordered), [true, false, true]);
    }
}
