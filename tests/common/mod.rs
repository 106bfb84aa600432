//! Shapes whose volume is known on paper, and where the test models are. All shapes are closed,
//! face outward and share their vertices.

// Each test binary includes this file and uses a part of it.
#![allow(dead_code, unreachable_pub)]

pub mod layers;
pub mod ranges;

use foothold::gcode::assemble;
use foothold::gcode::read::{ReadGcode, read};
use foothold::mesh::{Mesh, load};
use foothold::pipeline::{Job, NamedModel};
use foothold::polygon::trig;
use foothold::settings::Settings;
use foothold::slice::LayerSpec;
use glam::{DVec2, Vec3, dvec2, dvec3, vec3};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// The folder of the real models: `FOOTHOLD_MODELS`, or `shared/models` beside the checkout.
/// `None`, said on stderr, where there is none: the test that asks is skipped.
pub fn models_dir() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let beside = ["../shared/models", "../../shared/models"].map(|p| root.join(p));
    let found = std::env::var_os("FOOTHOLD_MODELS")
        .map(PathBuf::from)
        .into_iter()
        .chain(beside)
        .find(|dir| dir.join("manifest.json").is_file());
    if found.is_none() {
        eprintln!("skipped: no folder of models (set FOOTHOLD_MODELS)");
    }
    found
}

/// A print with what it was made from.
pub struct Print {
    pub mesh: Mesh,
    pub specs: Vec<LayerSpec>,
    pub text: Vec<u8>,
    /// The text read back.
    pub file: ReadGcode,
}

/// Slices a file in one range with these settings, each `path=value`.
pub fn print(model: &[u8], sets: &[&str]) -> Print {
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let named = NamedModel::new("part", load(model).expect("it can be read"));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    let (mesh, specs) = (job.mesh().clone(), job.specs().to_vec());
    job.add(range.meta);
    let text = assemble(&job.finish(&|| 0.0).expect("all layers are there").joined, &range.texts);
    let file = read(&text, 1.75);
    assert_eq!((file.malformed, file.layers.len()), (0, specs.len()));
    Print { mesh, specs, text, file }
}

/// A box between two corners; 12 triangles.
pub fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    let outline = [dvec2(min.x.into(), min.y.into()), dvec2(max.x.into(), max.y.into())];
    let [a, b] = outline;
    prism(&[a, dvec2(b.x, a.y), b, dvec2(a.x, b.y)], &[], min.z.into(), max.z.into())
}

/// A cube with edges of `edge` mm on the bed, its corner at the origin.
pub fn cube(edge: f32) -> Mesh {
    cuboid(Vec3::ZERO, Vec3::splat(edge))
}

/// A regular prism around the z axis, standing on the bed: volume n/2 r^2 sin(2 pi/n) h.
pub fn cylinder(radius: f64, height: f64, segments: usize) -> Mesh {
    prism(&circle(DVec2::ZERO, radius, segments), &[], 0.0, height)
}

/// A tube around the z axis, standing on the bed.
pub fn tube(outer: f64, inner: f64, height: f64, segments: usize) -> Mesh {
    let hole = circle(DVec2::ZERO, inner, segments);
    prism(&circle(DVec2::ZERO, outer, segments), &[hole], 0.0, height)
}

/// A sphere of latitudes and longitudes around `centre`: `rings` bands from pole to pole of `segments`
/// pieces each; 2 segments (rings - 1) triangles.
pub fn sphere(centre: Vec3, radius: f64, rings: usize, segments: usize) -> Mesh {
    assert!(rings >= 2 && segments >= 3);
    let point = |ring: usize, segment: usize| {
        let (sin, cos) = trig::sin_cos(PI * ring as f64 / rings as f64);
        let (y, x) = trig::sin_cos(TAU * segment as f64 / segments as f64);
        centre + (radius * dvec3(sin * x, sin * y, -cos)).as_vec3()
    };
    let mut vertices = vec![centre - vec3(0.0, 0.0, radius as f32), centre + vec3(0.0, 0.0, radius as f32)];
    vertices.extend((1..rings).flat_map(|r| (0..segments).map(move |s| (r, s))).map(|(r, s)| point(r, s)));
    let at = |ring: usize, segment: usize| (2 + (ring - 1) * segments + segment % segments) as u32;
    let mut triangles = Vec::new();
    for s in 0..segments {
        triangles.push([0, at(1, s + 1), at(1, s)]);
        for r in 1..rings - 1 {
            triangles.extend(quad([at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)]));
        }
        triangles.push([1, at(rings - 1, s), at(rings - 1, s + 1)]);
    }
    Mesh { vertices, triangles }
}

/// A torus around the z axis, its middle at the origin: the tube of radius `tube` runs at distance
/// `ring`. Volume of the smooth one 2 pi^2 R r^2.
pub fn torus(ring: f64, tube: f64, ring_segments: usize, tube_segments: usize) -> Mesh {
    let mut vertices = Vec::new();
    for i in 0..ring_segments {
        let (y, x) = trig::sin_cos(TAU * i as f64 / ring_segments as f64);
        for j in 0..tube_segments {
            let (up, out) = trig::sin_cos(TAU * j as f64 / tube_segments as f64);
            let distance = ring + tube * out;
            vertices.push(dvec3(distance * x, distance * y, tube * up).as_vec3());
        }
    }
    let at = |i: usize, j: usize| (i % ring_segments * tube_segments + j % tube_segments) as u32;
    let cells = (0..ring_segments).flat_map(|i| (0..tube_segments).map(move |j| (i, j)));
    let triangles = cells.flat_map(|(i, j)| quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    Mesh { triangles: triangles.collect(), vertices }
}

/// A frustum on the bed over a convex outline (counter-clockwise): its top is the outline shrunk by
/// `share` towards the origin. `share` 0 makes a pyramid or cone, 1 a prism. Volume A h (1 + s + s^2) / 3.
pub fn frustum(outline: &[DVec2], height: f64, share: f64) -> Mesh {
    if share == 0.0 {
        return pyramid(outline, height);
    }
    let mut mesh = prism(outline, &[], 0.0, height);
    for v in mesh.vertices.iter_mut().filter(|v| v.z > 0.0) {
        *v = vec3(v.x * share as f32, v.y * share as f32, v.z);
    }
    mesh
}

/// A pyramid on the bed with its tip above the origin.
fn pyramid(outline: &[DVec2], height: f64) -> Mesh {
    let n = outline.len() as u32;
    let mut mesh =
        Mesh { vertices: outline.iter().map(|&p| at_height(p, 0.0)).collect(), triangles: Vec::new() };
    mesh.vertices.push(vec3(0.0, 0.0, height as f32));
    for i in 0..n {
        mesh.triangles.push([i, (i + 1) % n, n]);
    }
    mesh.triangles.extend(triangulate(outline, &[]).into_iter().map(|[a, b, c]| [a, c, b]));
    mesh
}

/// An L-shaped bracket: legs of `leg` mm and `thickness`, `depth` wide, the upright one along z.
/// Volume depth * thickness * (2 leg - thickness).
pub fn bracket(leg: f64, thickness: f64, depth: f64) -> Mesh {
    let l = [(0.0, 0.0), (leg, 0.0), (leg, thickness), (thickness, thickness), (thickness, leg), (0.0, leg)];
    let outline = l.map(|(x, y)| dvec2(x, y));
    let mut mesh = prism(&outline, &[], 0.0, depth);
    for v in &mut mesh.vertices {
        *v = vec3(v.x, depth as f32 - v.z, v.y); // laid on its back: (x, y, z) -> (x, depth - z, y)
    }
    mesh
}

/// The outline (counter-clockwise) less the holes (clockwise or not), drawn up from `bottom` to `top`.
pub fn prism(outline: &[DVec2], holes: &[Vec<DVec2>], bottom: f64, top: f64) -> Mesh {
    let holes: Vec<Vec<DVec2>> = holes.iter().map(|h| clockwise(h)).collect();
    let loops: Vec<&[DVec2]> = std::iter::once(outline).chain(holes.iter().map(Vec::as_slice)).collect();
    let points: Vec<DVec2> = loops.concat();
    let n = points.len() as u32;
    let vertices = [bottom, top].into_iter().flat_map(|z| points.iter().map(move |&p| at_height(p, z)));
    let mut mesh = Mesh { vertices: vertices.collect(), triangles: Vec::new() };
    let mut first = 0;
    for one in &loops {
        let len = one.len() as u32;
        for i in 0..len {
            let (a, b) = (first + i, first + (i + 1) % len);
            mesh.triangles.extend(quad([a, b, b + n, a + n]));
        }
        first += len;
    }
    for [a, b, c] in triangulate(outline, &holes) {
        mesh.triangles.push([a, c, b]);
        mesh.triangles.push([a + n, b + n, c + n]);
    }
    mesh
}

/// A regular polygon, counter-clockwise; its first point lies to the right of `centre`.
pub fn circle(centre: DVec2, radius: f64, segments: usize) -> Vec<DVec2> {
    let point = |i: usize| trig::sin_cos(TAU * i as f64 / segments as f64);
    (0..segments).map(|i| centre + radius * dvec2(point(i).1, point(i).0)).collect()
}

/// Area of a regular polygon with this circumradius.
pub fn circle_area(radius: f64, segments: usize) -> f64 {
    segments as f64 / 2.0 * radius * radius * (TAU / segments as f64).sin()
}

/// The same surface as a list of single triangles: nothing is shared.
pub fn soup(mesh: &Mesh) -> Mesh {
    let vertices: Vec<Vec3> = (0..mesh.triangles.len()).flat_map(|t| mesh.corners(t)).collect();
    let triangles = (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh { vertices, triangles }
}

/// The mesh moved by a vector.
pub fn moved(mesh: &Mesh, by: Vec3) -> Mesh {
    Mesh { vertices: mesh.vertices.iter().map(|&v| v + by).collect(), triangles: mesh.triangles.clone() }
}

/// The mesh inside out.
pub fn inverted(mesh: &Mesh) -> Mesh {
    Mesh { triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..mesh.clone() }
}

/// Several meshes as one.
pub fn together(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|m| all.append(m));
    all
}

/// Whether each edge has one triangle in each direction: the mesh is closed and consistent.
pub fn is_closed(mesh: &Mesh) -> bool {
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from, to)).or_default() += 1;
        }
    }
    edges.iter().all(|(&(from, to), &count)| count == 1 && edges.get(&(to, from)) == Some(&1))
}

/// Fails unless `found` is within `share` of `expected`.
#[track_caller]
pub fn assert_near(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs(), "{found} is not {expected} within {share}");
}

fn at_height(p: DVec2, z: f64) -> Vec3 {
    p.extend(z).as_vec3()
}

/// Two triangles for the corners a, b, c, d counter-clockwise.
fn quad([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

fn clockwise(points: &[DVec2]) -> Vec<DVec2> {
    let twice: f64 = (0..points.len()).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum();
    if twice > 0.0 { points.iter().rev().copied().collect() } else { points.to_vec() }
}

/// Triangles (counter-clockwise) of an outline with clockwise holes, by cutting ears. The numbers
/// count the outline's points, then the holes'. Slow, and for outlines without self-contact only.
fn triangulate(outline: &[DVec2], holes: &[Vec<DVec2>]) -> Vec<[u32; 3]> {
    let points: Vec<DVec2> = outline.iter().chain(holes.iter().flatten()).copied().collect();
    let mut ring: Vec<usize> = (0..outline.len()).collect();
    let mut first = outline.len();
    let mut loops: Vec<Vec<usize>> = Vec::new();
    for hole in holes {
        loops.push((first..first + hole.len()).collect());
        first += hole.len();
    }
    // From right to left, so that a bridge never crosses a hole not yet joined (Eberly, 2002).
    let rightmost = |l: &Vec<usize>| l.iter().map(|&i| points[i].x).fold(f64::MIN, f64::max);
    loops.sort_by(|a, b| rightmost(b).total_cmp(&rightmost(a)));
    for hole in loops {
        join_hole(&points, &mut ring, hole);
    }
    cut_ears(&points, ring)
}

/// Joins a hole to the ring by a bridge from its rightmost point to a ring point that sees it.
fn join_hole(points: &[DVec2], ring: &mut Vec<usize>, mut hole: Vec<usize>) {
    let start = (0..hole.len())
        .max_by(|&a, &b| points[hole[a]].x.total_cmp(&points[hole[b]].x))
        .expect("a hole has points");
    hole.rotate_left(start);
    let from = points[hole[0]];
    let sees = |place: &usize| {
        let to = points[ring[*place]];
        let crossed = (0..ring.len())
            .any(|i| properly_cross(from, to, points[ring[i]], points[ring[(i + 1) % ring.len()]]));
        to.x > from.x && !crossed && in_corner(points, ring, *place, from)
    };
    let nearest = (0..ring.len())
        .filter(sees)
        .min_by(|&a, &b| from.distance(points[ring[a]]).total_cmp(&from.distance(points[ring[b]])));
    let place = nearest.expect("a hole inside the outline is seen from its right");
    let bridge: Vec<usize> = hole.iter().copied().chain([hole[0], ring[place]]).collect();
    ring.splice(place + 1..place + 1, bridge);
}

/// Whether `p` lies between the two edges at a corner of the ring, on the inner side.
fn in_corner(points: &[DVec2], ring: &[usize], place: usize, p: DVec2) -> bool {
    let n = ring.len();
    let [before, at, after] = [place + n - 1, place, place + 1].map(|i| points[ring[i % n]]);
    let left_of = |a: DVec2, b: DVec2| (b - a).perp_dot(p - a) > 0.0;
    let is_convex = (at - before).perp_dot(after - at) > 0.0;
    let (first, second) = (left_of(before, at), left_of(at, after));
    if is_convex { first && second } else { first || second }
}

fn properly_cross(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

fn cut_ears(points: &[DVec2], mut ring: Vec<usize>) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    while ring.len() > 3 {
        let n = ring.len();
        let ear = (0..n).find(|&i| is_ear(points, &ring, i)).expect("a simple outline has an ear");
        triangles.push([ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]].map(|i| i as u32));
        ring.remove(ear);
    }
    triangles.push([ring[0], ring[1], ring[2]].map(|i| i as u32));
    triangles
}

fn is_ear(points: &[DVec2], ring: &[usize], place: usize) -> bool {
    let n = ring.len();
    let corners = [place + n - 1, place, place + 1].map(|i| ring[i % n]);
    let [a, b, c] = corners.map(|i| points[i]);
    let is_left = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) >= 0.0;
    let holds = |p: DVec2| is_left(a, b, p) && is_left(b, c, p) && is_left(c, a, p);
    let others = ring.iter().filter(|i| ![a, b, c].contains(&points[**i]));
    (b - a).perp_dot(c - b) > 0.0 && !others.into_iter().any(|&i| holds(points[i]))
}

/// A part with a bit of everything: a bracket, a ball, a ring and a thin wall, apart on the bed.
pub fn medley() -> Mesh {
    together(&[
        bracket(20.0, 5.0, 8.0),
        moved(&sphere(Vec3::new(0.0, 0.0, 6.0), 6.0, 24, 36), Vec3::new(40.0, 0.0, 0.0)),
        moved(&torus(8.0, 3.0, 48, 24), Vec3::new(0.0, 30.0, 3.0)),
        moved(&cuboid(Vec3::ZERO, Vec3::new(15.0, 0.7, 8.0)), Vec3::new(30.0, 30.0, 0.0)),
    ])
}

/// FNV-1a over bytes, 64 bits: a short name for a long text.
pub fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
}
