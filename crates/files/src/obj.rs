//! Wavefront OBJ: `v x y z` and `f`, the rest is looks. One file is one part in mm: OBJ knows no unit,
//! and its groups are pieces of one thing.
//!
//! Source: "Object Files (.obj)", Wavefront Advanced Visualizer manual, appendix B1.

use crate::Part;
use crate::error::FileError;
use crate::limits::{EAR_STEPS, REACH_MM, TRIANGLES, VERTICES};

/// Corners of a face at most.
const FACE_CORNERS: usize = 100_000;

pub(crate) fn read(bytes: &[u8]) -> Result<Part, FileError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(FileError::Encoding { seems: "UTF-16" });
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let (mut part, mut steps) = (Part::default(), EAR_STEPS);
    let mut lines = bytes.split(|&b| b == b'\n').zip(1_usize..);
    while let Some((line, number)) = lines.next() {
        let mut line = trimmed(line).to_vec();
        while line.last() == Some(&b'\\') {
            line.pop();
            let Some((next, _)) = lines.next() else { break };
            line.push(b' ');
            line.extend_from_slice(trimmed(next));
        }
        take_line(&line, number, &mut part, &mut steps)?;
    }
    if part.triangles.is_empty() {
        return Err(FileError::NoTriangles);
    }
    Ok(part)
}

fn trimmed(line: &[u8]) -> &[u8] {
    let code = line.split(|&b| b == b'#').next().unwrap_or_default();
    code.trim_ascii()
}

/// Takes over one line; `steps` may still be spent on cutting faces.
fn take_line(line: &[u8], number: usize, part: &mut Part, steps: &mut usize) -> Result<(), FileError> {
    let malformed =
        |cause: &str| FileError::Malformed { place: format!("line {number}"), cause: cause.to_owned() };
    let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
    match words.next() {
        Some(b"v") => {
            let mut corner = [0.0_f32; 3];
            for x in &mut corner {
                let word = words.next().ok_or_else(|| malformed("a vertex needs three numbers"))?;
                *x = coordinate(word)
                    .ok_or_else(|| malformed("a vertex with a number that cannot be used"))?;
            }
            if part.vertices.len() >= VERTICES {
                return Err(FileError::TooMuch { what: "vertices", limit: VERTICES });
            }
            part.vertices.push(corner);
        }
        Some(b"f") => {
            let mut face = Vec::new();
            for word in words {
                let index = index(word, part.vertices.len())
                    .ok_or_else(|| malformed("a face names a vertex that is not there"))?;
                if face.len() >= FACE_CORNERS {
                    return Err(FileError::TooMuch { what: "corners of a face", limit: FACE_CORNERS });
                }
                face.push(index);
            }
            if face.len() < 3 {
                return Err(malformed("a face needs three corners"));
            }
            if part.triangles.len() + face.len() > TRIANGLES {
                return Err(FileError::TooMuch { what: "triangles", limit: TRIANGLES });
            }
            if !triangulate(&face, &part.vertices, &mut part.triangles, steps) {
                return Err(malformed("faces with so many corners that are not convex: export triangles"));
            }
        }
        Some(b"curv" | b"curv2" | b"surf" | b"cstype") => {
            return Err(malformed("free-form curves and surfaces are not supported: export triangles"));
        }
        _ => {}
    }
    Ok(())
}

fn coordinate(word: &[u8]) -> Option<f32> {
    let value: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (value.abs() <= REACH_MM).then_some(value as f32)
}

/// `7`, `7/1`, `7//3` or `-1`: from 1, or back from the last vertex.
fn index(word: &[u8], count: usize) -> Option<u32> {
    let first = word.split(|&b| b == b'/').next()?;
    let number: i64 = std::str::from_utf8(first).ok()?.parse().ok()?;
    let at = if number < 0 { count as i64 + number } else { number - 1 };
    (0..count as i64).contains(&at).then_some(at as u32)
}

/// Cuts a flat face into triangles: triangles and convex faces as a fan, others by cutting ears. Whether
/// `steps` were enough: cutting ears takes up to the third power of the corners.
fn triangulate(face: &[u32], vertices: &[[f32; 3]], out: &mut Vec<[u32; 3]>, steps: &mut usize) -> bool {
    if face.len() == 3 {
        out.push([face[0], face[1], face[2]]);
        return true;
    }
    let flat = flattened(face, vertices);
    let turn = |i: usize, j: usize, k: usize| cross(flat[i], flat[j], flat[k]);
    let n = face.len();
    if (0..n).all(|i| turn(i, (i + 1) % n, (i + 2) % n) >= 0.0) {
        out.extend((1..n - 1).map(|i| [face[0], face[i], face[i + 1]]));
        return true;
    }
    let mut ring: Vec<usize> = (0..n).collect();
    while ring.len() > 3 {
        let m = ring.len();
        let mut is_ear = |&i: &usize| {
            let [a, b, c] = [ring[(i + m - 1) % m], ring[i], ring[(i + 1) % m]];
            let inside = |&p: &usize| {
                ![a, b, c].contains(&p)
                    && turn(a, b, p) >= 0.0
                    && turn(b, c, p) >= 0.0
                    && turn(c, a, p) >= 0.0
            };
            *steps = steps.saturating_sub(1);
            if *steps == 0 || turn(a, b, c) <= 0.0 {
                return false;
            }
            let hit = ring.iter().position(inside);
            *steps = steps.saturating_sub(hit.unwrap_or(m));
            hit.is_none()
        };
        // A face that crosses itself has no ear; any corner then does.
        let ear = (0..m).find(&mut is_ear).unwrap_or(0);
        if *steps == 0 {
            return false;
        }
        out.push([ring[(ear + m - 1) % m], ring[ear], ring[(ear + 1) % m]].map(|i| face[i]));
        ring.remove(ear);
    }
    out.push([ring[0], ring[1], ring[2]].map(|i| face[i]));
    true
}

/// The face seen along the axis that it faces most, counter-clockwise (Newell's normal).
fn flattened(face: &[u32], vertices: &[[f32; 3]]) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 3]> = face.iter().map(|&v| vertices[v as usize].map(f64::from)).collect();
    let mut normal = [0.0_f64; 3];
    for (i, p) in points.iter().enumerate() {
        let q = points[(i + 1) % points.len()];
        for (k, n) in normal.iter_mut().enumerate() {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            *n += (p[a] - q[a]) * (p[b] + q[b]);
        }
    }
    let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let (a, b) = if normal[axis] >= 0.0 { (a, b) } else { (b, a) };
    points.iter().map(|p| [p[a], p[b]]).collect()
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
