//! Where a loop starts and ends.

mod chain;
mod corner;

use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{DVec2, by_x_then_y};
use crate::region::Path;

pub use chain::{SeamLine, chain_seams};
use corner::hiding;

crate::words! {
    /// Which place of a loop becomes its seam.
    pub enum SeamPosition {
        /// In a corner, inward ones first, and in one line from layer to layer.
        #[default]
        Aligned = "aligned",
        /// Where the nozzle is nearest: least travel, seams here and there.
        Nearest = "nearest",
        /// At the rearmost place.
        Rear = "rear",
        /// Scattered, the same way on every run: no line, but dots all over.
        Random = "random",
    }
}

crate::options! {
    /// Where loops start.
    pub struct SeamOptions {
        /// Which place of a loop becomes its start and end.
        position: SeamPosition = SeamPosition::Aligned, "Seam position";
        /// How much of a loop's end is left out, so that it does not press on its start, up to a
        /// hundredth of the loop; 0 closes it fully.
        gap: f64 = 0.05, "Seam gap", "mm", 0.0..=1.0;
    }
}

/// A seam may move along its loop by this much from where the line of seams passes, mm, to reach a
/// corner.
const REACH: f64 = 1.0;

/// A line of seams farther from a loop than this belongs to another one, mm.
const FARTHEST_LINE: f64 = 2.0;

/// Turns outer walls, which have the part on their left, so that they start at their seams. `lines`
/// are the places where the lines of seams pass this layer.
pub fn place_seams(loops: &mut [&mut Path], options: &SeamOptions, lines: &[DVec2], layer: u32) {
    for (number, path) in (0u32..).zip(loops.iter_mut()) {
        match options.position {
            SeamPosition::Nearest => {}
            SeamPosition::Rear => start_at_vertex(path, rearmost(&path.points)),
            SeamPosition::Random => start_at_share(path, scattered(layer, number)),
            SeamPosition::Aligned => match line_of(&path.points, lines) {
                Some(line) => start_beside(path, line),
                None => start_at_vertex(path, best_corner(&path.points)),
            },
        }
    }
}

/// Turns a loop so that it starts at its place nearest to `target`; where it has no vertex there one is
/// added.
pub(super) fn start_nearest_to(path: &mut Path, target: DVec2) {
    let edges = edges(&path.points);
    let closest = edges.map(|(i, a, b)| (i, closest_on_segment(target, a, b)));
    let nearest =
        closest.min_by(|a, b| target.distance_squared(a.1).total_cmp(&target.distance_squared(b.1)));
    if let Some((edge, p)) = nearest {
        start_on_edge(path, edge, p);
    }
}

/// A new vertex nearer to an old one than this would only make a stub, mm.
const SHORTEST_EDGE: f64 = 0.05;

fn start_on_edge(path: &mut Path, edge: usize, p: DVec2) {
    let next = (edge + 1) % path.points.len();
    let (a, b) = (path.points[edge], path.points[next]);
    if p.distance(a) < SHORTEST_EDGE {
        start_at_vertex(path, edge);
    } else if p.distance(b) < SHORTEST_EDGE {
        start_at_vertex(path, next);
    } else {
        path.insert(edge + 1, p);
        start_at_vertex(path, edge + 1);
    }
}

fn start_at_vertex(path: &mut Path, vertex: usize) {
    path.start_at(vertex);
}

fn start_at_share(path: &mut Path, share: f64) {
    let mut left = share * path.length();
    let found = edges(&path.points).find_map(|(i, a, b)| {
        let length = a.distance(b);
        let here = (left <= length && length > 0.0).then(|| (i, a.lerp(b, left / length)));
        left -= length;
        here
    });
    if let Some((edge, p)) = found {
        start_on_edge(path, edge, p);
    }
}

/// A share in [0, 1) that looks random: the first bits of layer and loop number mixed by the
/// finaliser of SplitMix64 (Steele, Lea, Flood 2014).
fn scattered(layer: u32, number: u32) -> f64 {
    let mut bits = ((u64::from(layer) << 32) | u64::from(number)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ (bits >> 31)) as u32 as f64 / 2f64.powi(32)
}

fn edges(points: &[DVec2]) -> impl Iterator<Item = (usize, DVec2, DVec2)> + '_ {
    (0..points.len()).map(|i| (i, points[i], points[(i + 1) % points.len()]))
}

fn rearmost(points: &[DVec2]) -> usize {
    let rear = |&a: &usize, &b: &usize| {
        points[b].y.total_cmp(&points[a].y).then_with(|| by_x_then_y(points[a], points[b]))
    };
    (0..points.len()).min_by(rear).unwrap_or(0)
}

/// Without a line to follow: what hides best, of equals the rearmost.
fn best_corner(points: &[DVec2]) -> usize {
    // Rounded, so that equal corners are equal and the rear decides.
    let rated: Vec<i64> = (0..points.len()).map(|i| (hiding(points, i) * 10.0).round() as i64).collect();
    let better = |&a: &usize, &b: &usize| {
        let rear = points[b].y.total_cmp(&points[a].y).then_with(|| by_x_then_y(points[a], points[b]));
        rated[a].cmp(&rated[b]).then(rear)
    };
    (0..points.len()).min_by(better).unwrap_or(0)
}

/// The line of seams that passes nearest to the loop.
fn line_of(points: &[DVec2], lines: &[DVec2]) -> Option<DVec2> {
    let away = |line: DVec2| {
        let closest = edges(points).map(|(_, a, b)| closest_on_segment(line, a, b).distance_squared(line));
        closest.fold(f64::INFINITY, f64::min)
    };
    let measured = lines.iter().map(|&line| (away(line), line));
    let nearest = measured.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.filter(|n| n.0 <= FARTHEST_LINE * FARTHEST_LINE).map(|n| n.1)
}

/// Starts where the line passes, or in a corner close by.
fn start_beside(path: &mut Path, line: DVec2) {
    let cost = |i: usize| hiding(&path.points, i) + path.points[i].distance(line) / REACH;
    let near = (0..path.points.len()).filter(|&i| path.points[i].distance_squared(line) <= REACH * REACH);
    let best = near.map(|i| (cost(i), i)).min_by(|a, b| a.0.total_cmp(&b.0));
    match best {
        Some((cost, i)) if cost < 1.0 => start_at_vertex(path, i),
        _ => start_nearest_to(path, line),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;
    use crate::region::Role;

    fn l() -> Path {
        let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)];
        Path::closed(Role::OuterWall, points.map(|(x, y)| dvec2(x, y)).to_vec(), 0.4)
    }

    fn seam(position: SeamPosition, lines: &[DVec2], layer: u32) -> DVec2 {
        let mut path = l();
        let length = path.length();
        let options = SeamOptions { position, ..SeamOptions::default() };
        place_seams(&mut [&mut path], &options, lines, layer);
        assert!((path.length() - length).abs() < 1e-9, "the loop stays as it was");
        path.points[0]
    }

    #[test]
    fn the_inward_corner_of_an_l_takes_the_seam() {
        assert_eq!(seam(SeamPosition::Aligned, &[], 0), dvec2(4.0, 4.0));
        assert_eq!(seam(SeamPosition::Rear, &[], 0), dvec2(0.0, 10.0));
    }

    #[test]
    fn a_line_of_seams_is_followed_and_drawn_into_a_corner_close_by() {
        assert_eq!(seam(SeamPosition::Aligned, &[dvec2(5.0, -0.3)], 0), dvec2(5.0, 0.0));
        assert_eq!(seam(SeamPosition::Aligned, &[dvec2(4.4, 4.1)], 0), dvec2(4.0, 4.0));
        // Too far away to be the line of this loop.
        assert_eq!(seam(SeamPosition::Aligned, &[dvec2(5.0, -3.0)], 0), dvec2(4.0, 4.0));
    }

    #[test]
    fn random_seams_are_spread_and_the_same_again() {
        let seams: Vec<DVec2> = (0..50).map(|layer| seam(SeamPosition::Random, &[], layer)).collect();
        let again: Vec<DVec2> = (0..50).map(|layer| seam(SeamPosition::Random, &[], layer)).collect();
        assert_eq!(seams, again);
        let low = seams.iter().filter(|p| p.y == 0.0).count();
        assert!((5..25).contains(&low), "{low} of 50 on the lower side, which is a quarter");
    }
}
