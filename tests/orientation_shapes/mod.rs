//! Solids for the orientation tests, built triangle by triangle.
#![allow(dead_code, reason = "each test file uses some of them")]

use foothold::mesh::Mesh;
use foothold::polygon::trig::sin_cos;
use glam::{DMat3, DVec2, DVec3, Vec3, dvec2, dvec3, vec3};

/// Profile of part model 1 in (x, z); extruded 20 along y it has the figures of [Karim] Table 2.
pub const PART_MODEL_1: [[f64; 2]; 20] = [
    [0.0, 0.0],
    [7.5, 0.0],
    [7.5, 10.0],
    [17.5, 10.0],
    [17.5, 0.0],
    [27.5, 0.0],
    [27.5, 10.0],
    [37.5, 10.0],
    [37.5, 0.0],
    [45.0, 0.0],
    [45.0, 40.0],
    [35.0, 40.0],
    [35.0, 20.0],
    [25.0, 20.0],
    [25.0, 30.0],
    [20.0, 30.0],
    [20.0, 20.0],
    [10.0, 20.0],
    [10.0, 40.0],
    [0.0, 40.0],
];

pub fn part_model_1() -> Mesh {
    prism(&PART_MODEL_1, 20.0)
}

/// A profile in (x, z), counter-clockwise, extruded from y = 0 to `length`.
pub fn prism(profile: &[[f64; 2]], length: f64) -> Mesh {
    let n = profile.len() as u32;
    let at = |y: f64| profile.iter().map(move |&[x, z]| vec3(x as f32, y as f32, z as f32));
    let vertices: Vec<Vec3> = at(0.0).chain(at(length)).collect();
    let ring: Vec<DVec2> = profile.iter().map(|&[x, z]| dvec2(x, z)).collect();
    let mut triangles = Vec::new();
    for [a, b, c] in ears(&ring) {
        // Seen from -y, x goes to the right and z up: the near end keeps the profile's turn.
        triangles.push([a, b, c]);
        triangles.push([a + n, c + n, b + n]);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, i + n, j + n], [i, j + n, j]]);
    }
    Mesh { vertices, triangles }
}

/// Ear clipping of a simple counter-clockwise polygon.
fn ears(ring: &[DVec2]) -> Vec<[u32; 3]> {
    let mut left: Vec<usize> = (0..ring.len()).collect();
    let mut found = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let corner = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let is_ear = |&i: &usize| {
            let [a, b, c] = corner(i).map(|k| ring[k]);
            let turn = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
            let inside = |p: DVec2| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            let others = || left.iter().filter(|k| !corner(i).contains(k));
            turn(a, b, c) > 0.0 && !others().any(|&k| inside(ring[k]))
        };
        let i = (0..n).find(is_ear).expect("a simple polygon has an ear");
        found.push(corner(i).map(|k| k as u32));
        left.remove(i);
    }
    found.push([left[0] as u32, left[1] as u32, left[2] as u32]);
    found
}

/// An axis-parallel box.
pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let profile = [[low[0], low[2]], [high[0], low[2]], [high[0], high[2]], [low[0], high[2]]];
    let mut mesh = prism(&profile, high[1] - low[1]);
    mesh.vertices.iter_mut().for_each(|v| v.y += low[1] as f32);
    mesh
}

/// Several bodies in one mesh.
pub fn together(parts: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for part in parts {
        let n = all.vertices.len() as u32;
        all.vertices.extend(&part.vertices);
        all.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + n)));
    }
    all
}

/// The same surface looking the other way: the wall of a cavity.
pub fn inside_out(mut mesh: Mesh) -> Mesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}

/// A square frustum standing on its small end: `bottom` and `top` are half sides.
pub fn frustum(bottom: f64, top: f64, height: f64) -> Mesh {
    let mut mesh = cuboid([-1.0, -1.0, 0.0], [1.0, 1.0, height]);
    for v in &mut mesh.vertices {
        let side = if v.z > 0.0 { top } else { bottom } as f32;
        (v.x, v.y) = (v.x * side, v.y * side);
    }
    mesh
}

/// A ball of triangles with bumps of height `bump` (share of the radius), poles along z.
pub fn bumpy_ball(radius: f64, bump: f64, rings: u32) -> Mesh {
    let around = 2 * rings;
    let spot = |i: u32, j: u32| {
        let (sin_t, cos_t) = sin_cos(std::f64::consts::PI * f64::from(i) / f64::from(rings));
        let (sin_p, cos_p) = sin_cos(std::f64::consts::TAU * f64::from(j) / f64::from(around));
        let n = dvec3(sin_t * cos_p, sin_t * sin_p, cos_t);
        let wave = sin_cos(9.0 * n.x + 1.0).0 * sin_cos(8.0 * n.y).0 * sin_cos(7.0 * n.z + 2.0).0;
        (n * radius * (1.0 + bump * wave)).as_vec3()
    };
    let mut vertices = vec![spot(0, 0)];
    vertices.extend((1..rings).flat_map(|i| (0..around).map(move |j| spot(i, j))));
    vertices.push(spot(rings, 0));
    let last = vertices.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * around + j % around;
    let mut triangles: Vec<[u32; 3]> = (0..around).map(|j| [0, at(1, j), at(1, j + 1)]).collect();
    for i in 1..rings - 1 {
        triangles.extend((0..around).flat_map(|j| {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
            [[a, c, d], [a, d, b]]
        }));
    }
    triangles.extend((0..around).map(|j| [last, at(rings - 1, j + 1), at(rings - 1, j)]));
    Mesh { vertices, triangles }
}

/// Eight sides, half-diagonal `r`.
pub fn octahedron(r: f64) -> Mesh {
    let vertices = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z].map(|v| (v * r).as_vec3());
    let top = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
    let mut triangles = top.to_vec();
    triangles.extend(top.map(|[a, b, _]| [b, a, 5]));
    Mesh { vertices: vertices.to_vec(), triangles }
}

/// The mesh under a rotation.
pub fn rotated(mesh: &Mesh, rotation: DMat3) -> Mesh {
    let vertices = mesh.vertices.iter().map(|v| (rotation * v.as_dvec3()).as_vec3()).collect();
    Mesh { vertices, triangles: mesh.triangles.clone() }
}

/// A rotation at random, evenly over all: a unit quaternion from four numbers in [0, 1).
pub fn random_rotation(mut random: impl FnMut() -> f64) -> DMat3 {
    loop {
        let [x, y, z, w] = std::array::from_fn(|_| 2.0 * random() - 1.0);
        let length = (x * x + y * y + z * z + w * w).sqrt();
        if (0.1..1.0).contains(&length) {
            return DMat3::from_quat(glam::DQuat::from_xyzw(x, y, z, w).normalize());
        }
    }
}

/// SplitMix64 as numbers in [0, 1).
pub fn random_from(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
