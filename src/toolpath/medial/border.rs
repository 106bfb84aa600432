//! The outline with extra points, and the triangles between its sides.

use spade::handles::DirectedEdgeHandle;
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::polygon::simplify::closest_on_segment;
use crate::polygon::{Contour, DVec2, Polygon, by_x_then_y};
use crate::sort::StableSort;

/// No triangle, no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// Edges that [`Triangles::nearest`] walks along the outline at most. The walk ends where the
/// distance grows; the bound is for spirals of tiny edges.
const WALK: usize = 24;

/// The triangles inside an outline.
pub(super) struct Triangles {
    /// Vertices of the outline, mm; every point once.
    points: Vec<DVec2>,
    /// Vertex before and after each on the outline; `NONE` where contours touch.
    beside: Vec<[u32; 2]>,
    /// Directed edges of the outline, area on the left, sorted.
    edges: Vec<[u32; 2]>,
    /// Corners, counter-clockwise.
    corners: Vec<[u32; 3]>,
    /// Triangle across the edge from corner k to k + 1; `NONE` where that edge is outline.
    across: Vec<[u32; 3]>,
}

impl Triangles {
    /// Number of triangles.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Number of inner edges of a triangle: 1 at an end, 2 in a strip, 3 in a junction.
    pub(super) fn inner_edges(&self, triangle: u32) -> usize {
        self.across[triangle as usize].iter().filter(|&&t| t != NONE).count()
    }

    /// The triangle across edge `side`, and that edge's number there.
    pub(super) fn across(&self, triangle: u32, side: usize) -> Option<(u32, usize)> {
        let other = self.across[triangle as usize][side];
        let from = self.corners[triangle as usize][(side + 1) % 3];
        let there = self.corners.get(other as usize)?.iter().position(|&v| v == from)?;
        Some((other, there))
    }

    /// The three corners of a triangle.
    pub(super) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.corners[triangle as usize]
    }

    /// Position of a vertex.
    pub(super) fn point(&self, vertex: u32) -> DVec2 {
        self.points[vertex as usize]
    }

    /// The point of the outline near `vertex` that is nearest to `p`: from the vertex along the
    /// outline, both ways, as long as the distance shrinks.
    pub(super) fn nearest(&self, vertex: u32, p: DVec2) -> DVec2 {
        let mut best = self.point(vertex);
        for way in 0..2 {
            let mut at = vertex;
            for _ in 0..WALK {
                let to = self.beside[at as usize][way];
                if to == NONE {
                    break;
                }
                let candidate = closest_on_segment(p, self.point(at), self.point(to));
                if p.distance_squared(candidate) >= p.distance_squared(best) {
                    break;
                }
                best = candidate;
                at = to;
            }
        }
        best
    }

    /// How far a ray from `p` runs in (unit) `direction` until it meets the outline, mm.
    pub(super) fn ray(&self, p: DVec2, direction: DVec2) -> Option<f64> {
        let side = |v: u32| direction.perp_dot(self.point(v) - p);
        let hit = |&[a, b]: &[u32; 2]| {
            let (sa, sb) = (side(a), side(b));
            // The area lies left of its outline, so a ray leaves where the edge turns to its left.
            let leaves = sa <= 0.0 && sb > 0.0;
            let along = |v: u32| direction.dot(self.point(v) - p);
            leaves.then(|| along(a) + (along(b) - along(a)) * sa / (sa - sb)).filter(|&t| t >= 0.0)
        };
        self.edges.iter().filter_map(hit).min_by(f64::total_cmp)
    }
}

struct Site {
    at: DVec2,
    vertex: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

/// Triangulates the islands after adding points so that no edge is longer than `step` mm; `None`
/// when edges cross.
pub(super) fn triangulate(islands: &[Polygon], step: f64) -> Option<Triangles> {
    let contours = islands.iter().flat_map(Polygon::contours);
    let dense: Vec<Vec<DVec2>> = contours.map(|c| densified(c, step)).collect();
    let (points, rings) = numbered(&dense);
    let outline = Outline::new(points.len(), &rings);
    let spade = triangulated(&points, &outline.edges)?;
    let (corners, across) = inside(&spade, &outline);
    Some(Triangles { points, beside: outline.beside, edges: outline.edges, corners, across })
}

/// Which vertex follows which.
struct Outline {
    /// As in [`Triangles`].
    edges: Vec<[u32; 2]>,
    /// As in [`Triangles`].
    beside: Vec<[u32; 2]>,
}

impl Outline {
    fn new(points: usize, rings: &[Vec<u32>]) -> Outline {
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(points);
        let mut beside = vec![[NONE; 2]; points];
        let mut visits = vec![0_u32; points];
        for ring in rings {
            for (i, &from) in ring.iter().enumerate() {
                let to = ring[(i + 1) % ring.len()];
                edges.push([from, to]);
                (beside[from as usize][1], beside[to as usize][0]) = (to, from);
                visits[from as usize] += 1;
            }
        }
        for (links, _) in beside.iter_mut().zip(visits).filter(|(_, visits)| *visits > 1) {
            *links = [NONE; 2];
        }
        edges.stable_sort_by(Ord::cmp);
        Outline { edges, beside }
    }

    /// Whether the outline runs from one vertex to the other.
    fn has(&self, from: u32, to: u32) -> bool {
        match self.beside[from as usize][1] {
            NONE => self.edges.binary_search(&[from, to]).is_ok(),
            next => next == to,
        }
    }
}

type Spade = ConstrainedDelaunayTriangulation<Site>;

/// A Delaunay triangulation with all `edges` in it; `None` if they cross.
///
/// Dense outlines mostly need no constraints, which are the slow part. They are added in the order
/// of the edges: spade's bulk loader for them keeps some in a hash set, whose order would decide
/// between equally good triangles.
fn triangulated(points: &[DVec2], edges: &[[u32; 2]]) -> Option<Spade> {
    let sites = points.iter().zip(0..).map(|(&at, vertex)| Site { at, vertex }).collect();
    let mut spade = Spade::bulk_load(sites).ok()?;
    let mut handles = vec![None; points.len()];
    for vertex in spade.vertices() {
        handles[vertex.data().vertex as usize] = Some(vertex.fix());
    }
    let ends = |&[from, to]: &[u32; 2]| handles[from as usize].zip(handles[to as usize]);
    let is_there = |edge| ends(edge).is_some_and(|(f, t)| spade.get_edge_from_neighbors(f, t).is_some());
    if edges.iter().all(is_there) {
        return Some(spade);
    }
    for edge in edges {
        let (from, to) = ends(edge)?;
        if spade.try_add_constraint(from, to).is_empty() && !spade.exists_constraint(from, to) {
            return None;
        }
    }
    Some(spade)
}

/// The contour with each edge cut into equal pieces of at most `step` mm.
///
/// The new points stay off the grid: moved by half a step of it, the sides of a needle would cross.
fn densified(contour: &Contour, step: f64) -> Vec<DVec2> {
    let mut points = Vec::with_capacity(contour.points.len());
    for (a, b) in contour.edges() {
        let pieces = (a.distance(b) / step).ceil().max(1.0);
        points.extend((0..pieces as usize).map(|i| a + (b - a) * (i as f64 / pieces)));
    }
    points.dedup();
    points
}

/// Numbers equal points equally: the points by (x, y), and the rings as numbers.
fn numbered(rings: &[Vec<DVec2>]) -> (Vec<DVec2>, Vec<Vec<u32>>) {
    let mut order: Vec<(DVec2, usize, usize)> = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        order.extend(ring.iter().enumerate().map(|(i, &p)| (p, r, i)));
    }
    order.stable_sort_by(|a, b| by_x_then_y(a.0, b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut points: Vec<DVec2> = Vec::with_capacity(order.len());
    let mut numbers: Vec<Vec<u32>> = rings.iter().map(|r| vec![NONE; r.len()]).collect();
    for (p, r, i) in order {
        if points.last() != Some(&p) {
            points.push(p);
        }
        numbers[r][i] = points.len() as u32 - 1;
    }
    (points, numbers)
}

/// The triangles that can be reached from the left of the outline without crossing it: their
/// corners, and the triangles across their edges.
fn inside(spade: &Spade, outline: &Outline) -> (Vec<[u32; 3]>, Vec<[u32; 3]>) {
    let ends =
        |e: DirectedEdgeHandle<'_, Site, (), CdtEdge<()>, ()>| [e.from(), e.to()].map(|v| v.data().vertex);
    let is_outline = |e: DirectedEdgeHandle<'_, Site, (), CdtEdge<()>, ()>| {
        let [from, to] = ends(e);
        e.is_constraint_edge() || outline.has(from, to) || outline.has(to, from)
    };
    let mut number = vec![NONE; spade.num_all_faces()];
    let mut faces = Vec::new();
    for face in spade.inner_faces() {
        let is_left = |&e: &_| {
            let [from, to] = ends(e);
            outline.has(from, to)
        };
        if face.adjacent_edges().iter().any(is_left) {
            number[face.fix().index()] = faces.len() as u32;
            faces.push(face);
        }
    }
    let mut corners = Vec::with_capacity(faces.len());
    let mut across = Vec::with_capacity(faces.len());
    while let Some(face) = faces.get(corners.len()).copied() {
        corners.push(face.vertices().map(|v| v.data().vertex));
        across.push(face.adjacent_edges().map(|edge| match edge.rev().face().as_inner() {
            Some(other) if !is_outline(edge) => {
                let known = &mut number[other.fix().index()];
                if *known == NONE {
                    *known = faces.len() as u32;
                    faces.push(other);
                }
                *known
            }
            _ => NONE,
        }));
    }
    (corners, across)
}
