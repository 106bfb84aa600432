//! The printing order of a layer: island after island, walls from inside out, then the fills; within
//! each group always the nearest next.

use super::travel::Way;
use crate::polygon::grid::{EdgeGrid, PointGrid};
use crate::polygon::measure::Bounds;
use crate::polygon::simplify::squared_distance_to_segment;
use crate::polygon::{DVec2, Polygon, PolygonSet};
use crate::region::{Path, Role};

/// Everything to be printed on one layer, in no order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayerParts {
    /// Skirt, brim and their kin: printed first and in the given order.
    pub foundation: Vec<Path>,
    /// Wall loops, each starting at its seam, with their depth: 0 is the outer wall.
    pub walls: Vec<(u32, Path)>,
    /// Infill, skins, gap fill.
    pub fills: Vec<Path>,
}

/// A layer's paths in printing order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayerPaths {
    /// The beads.
    pub paths: Vec<Path>,
    /// The way to each path from the one before. The way to the first path counts as crossing.
    pub ways: Vec<Way>,
}

/// Order of the roles among the fills of an island.
const FILL_ORDER: [Role; 6] =
    [Role::GapFill, Role::Infill, Role::SolidInfill, Role::BottomSkin, Role::TopSkin, Role::Bridge];

/// Puts the parts of a layer in printing order.
///
/// The first island is the one nearest to the bed's origin, whatever other layers do, so that each
/// layer can be ordered alone.
pub fn order_layer(parts: LayerParts, outline: &PolygonSet) -> LayerPaths {
    let mut paths = parts.foundation;
    let mut here = paths.last().map_or(DVec2::ZERO, end_of);
    for island in nearest_first(by_island(parts.walls, parts.fills, outline), here) {
        order_walls(island.walls, &mut here, &mut paths);
        order_fills(island.fills, &mut here, &mut paths);
    }
    let ways = find_ways(&paths, outline);
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
}

impl Island {
    fn bounds(&self) -> Option<Bounds> {
        let paths = self.walls.iter().map(|(_, p)| p).chain(&self.fills);
        paths.filter_map(|p| Bounds::of_points(&p.points)).reduce(Bounds::union)
    }
}

fn by_island(walls: Vec<(u32, Path)>, fills: Vec<Path>, outline: &PolygonSet) -> Vec<Island> {
    let polygons = outline.islands();
    let boxes: Vec<Option<Bounds>> = polygons.iter().map(|p| p.outer.bounds()).collect();
    let mut islands: Vec<Island> = Vec::new();
    islands.resize_with(polygons.len().max(1), Island::default);
    for (depth, path) in walls {
        islands[island_of(&path, &polygons, &boxes)].walls.push((depth, path));
    }
    for path in fills {
        islands[island_of(&path, &polygons, &boxes)].fills.push(path);
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

fn nearest_first(islands: Vec<Island>, start: DVec2) -> Vec<Island> {
    let mut left: Vec<(Bounds, Island)> =
        islands.into_iter().filter_map(|i| Some((i.bounds()?, i))).collect();
    let mut ordered = Vec::with_capacity(left.len());
    let mut here = start;
    while !left.is_empty() {
        let distance = |b: &Bounds| here.clamp(b.min, b.max).distance_squared(here);
        let nearest = (0..left.len()).min_by(|&a, &b| distance(&left[a].0).total_cmp(&distance(&left[b].0)));
        let (bounds, island) = left.remove(nearest.unwrap_or(0));
        here = here.clamp(bounds.min, bounds.max);
        ordered.push(island);
    }
    ordered
}

/// A loop is printed when all loops just inside it are; of those that may be, the nearest.
fn order_walls(walls: Vec<(u32, Path)>, here: &mut DVec2, paths: &mut Vec<Path>) {
    let parents: Vec<Option<usize>> = (0..walls.len()).map(|i| parent_of(&walls, i)).collect();
    let mut waiting_for = vec![0usize; walls.len()];
    for parent in parents.iter().flatten() {
        waiting_for[*parent] += 1;
    }
    let mut left: Vec<Option<Path>> = walls.into_iter().map(|(_, p)| Some(p)).collect();
    for _ in 0..left.len() {
        let start = |i: usize| left[i].as_ref().map(|p| p.points[0].distance_squared(*here));
        let free = (0..left.len()).filter(|&i| waiting_for[i] == 0);
        let nearest = free.filter_map(|i| Some((start(i)?, i))).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((i, path)) = nearest.and_then(|(_, i)| Some((i, left[i].take()?))) else { return };
        if let Some(parent) = parents[i] {
            waiting_for[parent] -= 1;
        }
        *here = end_of(&path);
        paths.push(path);
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

fn order_fills(fills: Vec<Path>, here: &mut DVec2, paths: &mut Vec<Path>) {
    let mut groups: Vec<Vec<Path>> = vec![Vec::new(); FILL_ORDER.len() + 1];
    for path in fills {
        let group = FILL_ORDER.iter().position(|r| *r == path.role).unwrap_or(FILL_ORDER.len());
        groups[group].push(path);
    }
    for group in groups {
        order_nearest(group, here, paths);
    }
}

/// Always the path with the nearest end, entered at that end.
fn order_nearest(group: Vec<Path>, here: &mut DVec2, paths: &mut Vec<Path>) {
    let ends: Vec<DVec2> = group.iter().flat_map(|p| [p.points[0], end_of(p)]).collect();
    let mut grid = PointGrid::new(&ends);
    let mut left: Vec<Option<Path>> = group.into_iter().map(Some).collect();
    while let Some((_, end)) = grid.nearest(*here) {
        let index = end / 2;
        grid.remove(ends[2 * index], 2 * index);
        grid.remove(ends[2 * index + 1], 2 * index + 1);
        // Both ends leave the grid together with their path, so it is still there.
        let Some(path) = left[index].take() else { continue };
        let path = if end % 2 == 1 && !path.closed { path.reversed() } else { path };
        *here = end_of(&path);
        paths.push(path);
    }
}

fn find_ways(paths: &[Path], outline: &PolygonSet) -> Vec<Way> {
    let edges: Vec<(DVec2, DVec2)> = outline.contours().iter().flat_map(|c| c.edges()).collect();
    let grid = EdgeGrid::new(&edges);
    let ways = paths.windows(2).map(|w| (end_of(&w[0]), w[1].points[0]));
    let first = paths.first().map(|_| Way::ACROSS);
    let straight = |(a, b)| Way { via: Vec::new(), crosses_outline: grid.crosses(a, b) };
    first.into_iter().chain(ways.map(straight)).collect()
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
        let ordered = order_layer(LayerParts { walls, ..LayerParts::default() }, &outline);
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
        let ordered = order_layer(LayerParts { fills, ..LayerParts::default() }, &outline);
        let starts: Vec<DVec2> = ordered.paths.iter().map(|p| p.points[0]).collect();
        assert_eq!(starts, [dvec2(0.0, 0.0), dvec2(2.0, 10.0), dvec2(4.0, 0.0)]);
    }

    #[test]
    fn a_way_from_island_to_island_crosses_the_outline() {
        let two = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(5.0, 5.0))
            .union(&PolygonSet::rectangle(dvec2(10.0, 0.0), dvec2(15.0, 5.0)));
        let dash = |x: f64| Path::open(Role::Infill, vec![dvec2(x, 2.0), dvec2(x + 1.0, 2.0)], 0.45);
        let fills = vec![dash(12.0), dash(1.0), dash(3.0)];
        let ordered = order_layer(LayerParts { fills, ..LayerParts::default() }, &two);
        assert_eq!(crossings(&ordered), [true, false, true]);
    }
}
