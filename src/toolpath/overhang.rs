//! Stretches of wall with too little below them.

use super::LayerPaths;
use super::travel::Way;
use crate::polygon::grid::EdgeGrid;
use crate::polygon::strips::Strips;
use crate::polygon::{DVec2, Join, PolygonSet};
use crate::region::{Path, Role, Width};

/// Steps of the share that hangs over: each has its own speed.
const STEPS: f64 = 4.0;

/// Walls count as overhanging from the step above this share on.
const HELD_ENOUGH: f64 = 0.5;

/// Distance of the points at which long edges are looked at, mm.
const STEP_MM: f64 = 0.8;

/// Shorter stretches go with the one before, mm.
const SHORTEST_STRETCH: f64 = 0.8;

/// Cuts the walls of a layer where more or less of them hangs over the layer `below`, and gives the
/// overhanging stretches their role and share. `bare` is what of the layer is not carried, wide strips
/// only: elsewhere walls are held well enough. The order of the beads stays.
pub fn mark_overhangs(paths: LayerPaths, below: &PolygonSet, bare: &PolygonSet, width: f64) -> LayerPaths {
    if bare.is_empty() {
        return paths;
    }
    let edges: Vec<(DVec2, DVec2)> = below.contours().iter().flat_map(|c| c.edges()).collect();
    let bare = bare.offset(width / 2.0, Join::WALL);
    let layer =
        Below { edges: EdgeGrid::new(&edges), inside: Strips::new(below), bare: Strips::new(&bare), width };
    let mut marked = LayerPaths::default();
    for (path, way) in paths.paths.into_iter().zip(paths.ways) {
        let pieces = match path.role {
            Role::OuterWall | Role::InnerWall => layer.cut(path),
            _ => vec![path],
        };
        // What follows a stretch starts where that ends.
        marked.ways.push(way);
        marked.ways.extend(pieces.iter().skip(1).map(|_| Way::default()));
        marked.paths.extend(pieces);
    }
    marked
}

struct Below {
    edges: EdgeGrid,
    inside: Strips,
    bare: Strips,
    width: f64,
}

impl Below {
    /// The step of the share of a bead's width at `p` that has nothing below; 0 where that is little.
    fn step(&self, p: DVec2) -> u8 {
        if !self.bare.contain(p) {
            return 0;
        }
        let distance = self.edges.nearest(p, self.width / 2.0).map_or(self.width / 2.0, |q| q.distance(p));
        let outward = if self.inside.contain(p) { -distance } else { distance };
        let share = (0.5 + outward / self.width).clamp(0.0, 1.0);
        if share <= HELD_ENOUGH { 0 } else { (share * STEPS).ceil() as u8 }
    }

    fn cut(&self, path: Path) -> Vec<Path> {
        let n = path.points.len();
        if n < 2 || !path.points.iter().any(|&p| self.bare.contain(p)) && !self.passes_bare(&path) {
            return vec![path];
        }
        let stretches = self.stretches(&path);
        match &stretches[..] {
            [Stretch { step: 0, .. }] => vec![path],
            [one] => vec![one.mark(path)],
            _ => {
                let varies = matches!(path.width, Width::Varying(_));
                stretches.into_iter().map(|stretch| stretch.into_path(&path, varies)).collect()
            }
        }
    }

    fn passes_bare(&self, path: &Path) -> bool {
        let n = path.points.len();
        (0..n).any(|i| {
            inner_points(path.points[i], path.points[(i + 1) % n]).any(|(p, _)| self.bare.contain(p))
        })
    }

    /// The path cut where its step changes.
    fn stretches(&self, path: &Path) -> Vec<Stretch> {
        let n = path.points.len();
        let edges = if path.closed { n } else { n - 1 };
        let mut stretches: Vec<Stretch> = Vec::new();
        let mut here = Stop { at: path.points[0], width: path.width.at(0), is_corner: true };
        for i in 0..edges {
            let j = (i + 1) % n;
            let (a, b) = (path.points[i], path.points[j]);
            let width = |share: f64| path.width.at(i) + (path.width.at(j) - path.width.at(i)) * share;
            let inner =
                inner_points(a, b).map(|(at, share)| Stop { at, width: width(share), is_corner: false });
            for stop in inner.chain([Stop { at: b, width: path.width.at(j), is_corner: true }]) {
                let step = self.step((here.at + stop.at) / 2.0);
                extend(&mut stretches, here, stop, step);
                here = stop;
            }
        }
        merged(stretches)
    }
}

/// Points that cut an edge into pieces of at most `STEP_MM`, with their share of the way.
fn inner_points(a: DVec2, b: DVec2) -> impl Iterator<Item = (DVec2, f64)> {
    let count = (a.distance(b) / STEP_MM).ceil().max(1.0) as usize;
    (1..count).map(move |i| i as f64 / count as f64).map(move |share| (a.lerp(b, share), share))
}

/// A point of a path where it is looked at.
#[derive(Clone, Copy)]
struct Stop {
    at: DVec2,
    width: f64,
    /// A point of the path itself, not one within an edge.
    is_corner: bool,
}

/// A stretch of a path on one step.
struct Stretch {
    step: u8,
    stops: Vec<Stop>,
}

fn extend(stretches: &mut Vec<Stretch>, from: Stop, to: Stop, step: u8) {
    match stretches.last_mut() {
        Some(last) if last.step == step => last.stops.push(to),
        _ => stretches.push(Stretch { step, stops: vec![from, to] }),
    }
}

/// The stretches with short ones put to those before.
fn merged(stretches: Vec<Stretch>) -> Vec<Stretch> {
    let mut kept: Vec<Stretch> = Vec::new();
    for stretch in stretches {
        match kept.last_mut() {
            Some(last) if last.step == stretch.step || stretch.length() < SHORTEST_STRETCH => {
                last.stops.extend(&stretch.stops[1..]);
            }
            _ => kept.push(stretch),
        }
    }
    kept
}

impl Stretch {
    fn length(&self) -> f64 {
        self.stops.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
    }

    fn mark(&self, path: Path) -> Path {
        Path { role: Role::OverhangWall, hang: f64::from(self.step) / STEPS, ..path }
    }

    fn into_path(self, whole: &Path, varies: bool) -> Path {
        let last = self.stops.len() - 1;
        let kept = self.stops.iter().enumerate().filter(|(i, stop)| stop.is_corner || *i == 0 || *i == last);
        let (points, widths): (Vec<DVec2>, Vec<f64>) = kept.map(|(_, stop)| (stop.at, stop.width)).unzip();
        let width = if varies { Width::Varying(widths) } else { whole.width.clone() };
        let path = Path { role: whole.role, points, closed: false, width, hang: 0.0 };
        if self.step == 0 { path } else { self.mark(path) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    /// A square loop whose right half lies `over` mm past the edge of the layer below at x = 10.
    fn marked(over: f64) -> Vec<Path> {
        let below = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 20.0));
        let area = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0 + over, 20.0));
        let (x, y) = (10.0 + over - 0.225, 20.0 - 0.225);
        let points = vec![dvec2(0.225, 0.225), dvec2(x, 0.225), dvec2(x, y), dvec2(0.225, y)];
        let paths = vec![Path::closed(Role::OuterWall, points, 0.45)];
        let layer = LayerPaths { paths, ways: vec![Way::ACROSS] };
        mark_overhangs(layer, &below, &area.difference(&below), 0.45).paths
    }

    #[test]
    fn a_wall_beside_its_ground_is_cut_out_by_how_far_it_hangs() {
        assert_eq!(marked(0.2).len(), 1);
        for (over, hang) in [(0.3, 0.75), (0.5, 1.0)] {
            let pieces = marked(over);
            let hanging: Vec<&Path> = pieces.iter().filter(|p| p.role == Role::OverhangWall).collect();
            assert_eq!(hanging.len(), 1, "{pieces:?}");
            assert_eq!(hanging[0].hang, hang);
            assert!((hanging[0].length() - 19.55).abs() < 1.7);
            // Corners and ends only.
            assert!(pieces.iter().all(|piece| piece.points.len() <= 4), "{pieces:?}");
            assert!(
                (pieces.iter().map(Path::length).sum::<f64>() - 2.0 * (9.55 + over + 19.55)).abs() < 1e-9
            );
            let joints = pieces.windows(2).all(|w| w[0].points.last() == w[1].points.first());
            assert!(
                joints && pieces.last().map(|p| p.points[p.points.len() - 1]) == Some(pieces[0].points[0])
            );
        }
    }
}
