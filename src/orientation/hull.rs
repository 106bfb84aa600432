//! Candidate directions from the faces of the convex hull: the part is laid on a face.
//!
//! The hull is built by Quickhull [Barber, Dobkin, Huhdanpaa 1996]: every face keeps the points
//! outside it, and the farthest of them becomes the next corner. Nothing here is random, so equal
//! meshes give equal faces.

use glam::DVec3;

use super::direction::{Direction, six};
use crate::mesh::Mesh;
use crate::sort::StableSort;

/// Faces whose normals differ by less than this count as one, degrees; also from the six axes.
pub const MERGE_DEG: f64 = 1.0;

/// cos of [`MERGE_DEG`].
const MERGE_COS: f64 = 0.999_847_695_156_391_2;

/// The largest faces that are kept.
pub const LARGEST_KEPT: usize = 30;

/// Only this many of the largest hull triangles are merged: those of a finely meshed ball beyond
/// are too small to stand on, and merging is quadratic.
const LARGEST_MERGED: usize = 4000;

/// Points nearer to a face than this share of the part's size lie in it: far above the rounding of
/// f64, at or below that of the f32 coordinates.
const FLAT_SHARE: f64 = 1e-7;

/// A flat side of the hull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Area, mm2.
    pub area_mm2: f64,
}

/// Directions that lay the part on one of the hull's sides, ids from 7 in the order of area.
///
/// Of the [`LARGEST_KEPT`] largest sides, those whose cheap facet sum ([`overhang_sum`]) promises
/// the least support are taken, `count` at most. Sides within [`MERGE_DEG`] of an axis are left
/// out: the six directions have them.
pub fn directions(mesh: &Mesh, count: usize) -> Vec<Direction> {
    if count == 0 {
        return Vec::new();
    }
    let is_axis = |up: DVec3| six().iter().any(|d| DVec3::from(d.up).dot(up) > MERGE_COS);
    let mut sides = merged(triangles(mesh));
    sides.truncate(LARGEST_KEPT);
    let ups = sides.iter().map(|side| -side.normal).filter(|&up| !is_axis(up));
    let mut rated: Vec<(usize, DVec3, f64)> =
        ups.enumerate().map(|(place, up)| (place, up, overhang_sum(mesh, up))).collect();
    rated.stable_sort_by(|a, b| a.2.total_cmp(&b.2).then(a.0.cmp(&b.0)));
    rated.truncate(count);
    rated.stable_sort_by_key(|&(place, ..)| place);
    let numbered = rated.into_iter().zip(7..);
    numbered.map(|((_, up, _), id)| Direction { id, up: up.to_array() }).collect()
}

/// A cheap stand-in for the support volume, mm3: facets that lean more than 45 degrees, each with
/// the column of air from its plan view down to the bed, as if nothing stood between.
pub fn overhang_sum(mesh: &Mesh, up: DVec3) -> f64 {
    let bed = mesh.vertices.iter().map(|v| v.as_dvec3().dot(up)).fold(f64::INFINITY, f64::min);
    let column = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|v| v.as_dvec3());
        let twice = (b - a).cross(c - a);
        let down = -twice.dot(up);
        let leans = down > 0.0 && 2.0 * down * down > twice.length_squared();
        if leans { down / 2.0 * ((a + b + c).dot(up) / 3.0 - bed) } else { 0.0 }
    };
    (0..mesh.triangles.len()).map(column).sum()
}

/// Sides with nearly the same normal become one, which keeps the largest one's normal; largest
/// first.
fn merged(mut sides: Vec<Side>) -> Vec<Side> {
    sides.stable_sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    sides.truncate(LARGEST_MERGED);
    let mut found: Vec<Side> = Vec::new();
    for side in sides {
        match found.iter_mut().find(|f| f.normal.dot(side.normal) > MERGE_COS) {
            Some(same) => same.area_mm2 += side.area_mm2,
            None => found.push(side),
        }
    }
    found.stable_sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    found
}

/// The triangles of the convex hull; none when the vertices lie in a plane.
pub fn triangles(mesh: &Mesh) -> Vec<Side> {
    let mut points: Vec<DVec3> = mesh.vertices.iter().map(|v| v.as_dvec3()).collect();
    points.stable_sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    points.dedup();
    let Some(mut hull) = Hull::of_tetrahedron(&points) else { return Vec::new() };
    while let Some(face) = hull.open.pop() {
        hull.add_farthest(face);
    }
    let alive = hull.faces.iter().filter(|face| face.alive);
    alive.map(|face| face.side(&points)).filter(|side| side.area_mm2 > 0.0).collect()
}

/// A triangle of the growing hull.
#[derive(Debug)]
struct Face {
    corners: [usize; 3],
    /// The face across the edge from corner i to corner i + 1.
    neighbours: [usize; 3],
    normal: DVec3,
    /// Points outside this face and no earlier one.
    outside: Vec<usize>,
    alive: bool,
}

impl Face {
    fn side(&self, points: &[DVec3]) -> Side {
        let [a, b, c] = self.corners.map(|i| points[i]);
        Side { normal: self.normal, area_mm2: (b - a).cross(c - a).length() / 2.0 }
    }
}

struct Hull<'p> {
    points: &'p [DVec3],
    faces: Vec<Face>,
    /// Faces that may have points outside.
    open: Vec<usize>,
    /// Points nearer to a face lie in it, mm.
    flat: f64,
}

impl<'p> Hull<'p> {
    /// Starts from four corners that span space, or `None` when there are none.
    fn of_tetrahedron(points: &'p [DVec3]) -> Option<Self> {
        let size = points.last()?.distance(*points.first()?);
        let farthest = |measure: &dyn Fn(DVec3) -> f64| {
            let best = (0..points.len()).max_by(|&i, &j| measure(points[i]).total_cmp(&measure(points[j])));
            best.map(|i| (i, measure(points[i])))
        };
        let a = 0;
        let (b, length) = farthest(&|p| p.distance(points[a]))?;
        let flat = FLAT_SHARE * length.max(size);
        let along = (points[b] - points[a]).normalize_or_zero();
        let (c, width) = farthest(&|p| (p - points[a]).cross(along).length())?;
        let normal = (points[b] - points[a]).cross(points[c] - points[a]).normalize_or_zero();
        let (d, depth) = farthest(&|p| (p - points[a]).dot(normal).abs())?;
        if width <= flat || depth <= flat {
            return None;
        }
        let mut hull = Hull { points, faces: Vec::new(), open: Vec::new(), flat };
        let below = (points[d] - points[a]).dot(normal) < 0.0;
        let [a, b, c] = if below { [a, b, c] } else { [a, c, b] };
        hull.add_tetrahedron([a, b, c, d]);
        Some(hull)
    }

    /// `corners[3]` lies behind the first three.
    fn add_tetrahedron(&mut self, [a, b, c, d]: [usize; 4]) {
        let faces = [[a, b, c], [b, a, d], [c, b, d], [a, c, d]];
        let neighbours = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        for (corners, neighbours) in faces.into_iter().zip(neighbours) {
            self.push(corners, neighbours);
        }
        self.share_out((0..self.points.len()).collect(), &[0, 1, 2, 3]);
    }

    fn push(&mut self, corners: [usize; 3], neighbours: [usize; 3]) -> usize {
        let [a, b, c] = corners.map(|i| self.points[i]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        self.faces.push(Face { corners, neighbours, normal, outside: Vec::new(), alive: true });
        self.faces.len() - 1
    }

    /// Height of a point above a face, mm.
    fn above(&self, face: usize, point: usize) -> f64 {
        let face = &self.faces[face];
        face.normal.dot(self.points[point] - self.points[face.corners[0]])
    }

    /// Gives each point to the first of the faces it lies outside of; the others are inside.
    fn share_out(&mut self, points: Vec<usize>, faces: &[usize]) {
        for point in points {
            if let Some(&face) = faces.iter().find(|&&face| self.above(face, point) > self.flat) {
                self.faces[face].outside.push(point);
            }
        }
        self.open.extend(faces.iter().filter(|&&face| !self.faces[face].outside.is_empty()));
    }

    /// Makes the point farthest outside the face a corner: the faces it sees are replaced by a cone
    /// from it to their horizon.
    fn add_farthest(&mut self, face: usize) {
        if !self.faces[face].alive {
            return;
        }
        let outside = &self.faces[face].outside;
        let farthest =
            outside.iter().copied().max_by(|&i, &j| self.above(face, i).total_cmp(&self.above(face, j)));
        let Some(tip) = farthest else { return };
        let (seen, horizon) = self.horizon(face, tip);
        let orphans: Vec<usize> = seen
            .iter()
            .flat_map(|&f| std::mem::take(&mut self.faces[f].outside))
            .filter(|&p| p != tip)
            .collect();
        let first = self.faces.len();
        let n = horizon.len();
        for (i, edge) in horizon.into_iter().enumerate() {
            let (before, after) = (first + (i + n - 1) % n, first + (i + 1) % n);
            let new = self.push([edge.from, edge.to, tip], [edge.beyond, after, before]);
            self.faces[edge.beyond].neighbours[edge.beyond_side] = new;
        }
        let cone: Vec<usize> = (first..first + n).collect();
        self.share_out(orphans, &cone);
    }

    /// The faces that the point sees, starting from one of them, and the edges around them in
    /// order. Seen faces die.
    fn horizon(&mut self, start: usize, tip: usize) -> (Vec<usize>, Vec<HorizonEdge>) {
        let (mut seen, mut edges) = (vec![start], Vec::new());
        self.faces[start].alive = false;
        // Depth first, edges in turn: the horizon comes out in order.
        let mut walk = vec![(start, 0, 0)];
        while let Some((face, first, turn)) = walk.pop() {
            if turn == 3 {
                continue;
            }
            walk.push((face, first, turn + 1));
            let side = (first + turn) % 3;
            let beyond = self.faces[face].neighbours[side];
            if !self.faces[beyond].alive {
                continue;
            }
            let (from, to) = (self.faces[face].corners[side], self.faces[face].corners[(side + 1) % 3]);
            let corners = self.faces[beyond].corners;
            // Neighbours share the edge the other way round.
            let beyond_side = (0..3).find(|&i| corners[i] == to && corners[(i + 1) % 3] == from).unwrap_or(0);
            if self.above(beyond, tip) > self.flat {
                self.faces[beyond].alive = false;
                seen.push(beyond);
                walk.push((beyond, beyond_side + 1, 0));
            } else {
                edges.push(HorizonEdge { from, to, beyond, beyond_side });
            }
        }
        (seen, edges)
    }
}

/// An edge between a face that the new point sees and one that it does not.
#[derive(Debug)]
struct HorizonEdge {
    from: usize,
    to: usize,
    /// The face that stays, and which of its edges this is.
    beyond: usize,
    beyond_side: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, vec3};

    fn cloud(vertices: Vec<Vec3>) -> Mesh {
        Mesh { vertices, triangles: Vec::new() }
    }

    fn cube() -> Vec<Vec3> {
        (0..8).map(|i| vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 10.0).collect()
    }

    #[test]
    fn a_cube_with_points_in_and_on_it_has_six_sides() {
        let mut points = cube();
        points.extend([vec3(5.0, 5.0, 5.0), vec3(5.0, 5.0, 0.0), vec3(10.0, 3.0, 4.0), vec3(0.0, 0.0, 5.0)]);
        let sides = merged(triangles(&cloud(points)));
        assert_eq!(sides.len(), 6);
        assert!(sides.iter().all(|side| (side.area_mm2 - 100.0).abs() < 1e-9));
        assert!(directions(&cloud(cube()), 30).is_empty(), "the six axes have them");
    }

    #[test]
    fn every_point_lies_behind_every_side_of_a_cloud() {
        // A spiral over a ball with a dent, and its inside.
        let spot = |i: u32| {
            let z = 1.0 - f64::from(i) / 200.0;
            let (sin, cos) = crate::polygon::trig::sin_cos(f64::from(i) * 2.4);
            let r = (1.0 - z * z).max(0.0).sqrt() * if i.is_multiple_of(7) { 0.8 } else { 1.0 };
            vec3((r * cos) as f32, (r * sin) as f32, z as f32) * 20.0
        };
        let mesh = cloud((0..400).map(spot).collect());
        let points: Vec<DVec3> = mesh.vertices.iter().map(|v| v.as_dvec3()).collect();
        let sides = triangles(&mesh);
        let reach = |n: DVec3| points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max);
        // Twice the hull's volume by its sides' reach, against the ball's: no side is missing.
        let volume: f64 = sides.iter().map(|s| s.area_mm2 * reach(s.normal) / 3.0).sum();
        assert!((0.9..1.0).contains(&(volume / 33510.3)), "{volume}");
        // The normals of a closed surface, weighted by area, add up to nothing.
        let sum: DVec3 = sides.iter().map(|s| s.normal * s.area_mm2).sum();
        assert!(sum.length() < 1e-6, "{sum}");
    }

    #[test]
    fn flat_and_tiny_clouds_have_no_hull() {
        assert!(triangles(&cloud(vec![])).is_empty());
        assert!(triangles(&cloud(vec![Vec3::ZERO; 5])).is_empty());
        assert!(triangles(&cloud(cube().into_iter().filter(|p| p.z == 0.0).collect())).is_empty());
    }

    #[test]
    fn a_cut_corner_is_a_direction() {
        let mut points = cube();
        points.pop();
        points.extend([vec3(7.0, 10.0, 10.0), vec3(10.0, 7.0, 10.0), vec3(10.0, 10.0, 7.0)]);
        let found = directions(&cloud(points), 30);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].id, 7);
        assert!((DVec3::from(found[0].up) - DVec3::splat(-1.0).normalize()).length() < 1e-9);
    }
}
