//! A model as a shaded picture, drawn triangle by triangle into pixels with a depth buffer.

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::mesh::Mesh;
use crate::polygon::measure::Bounds;

/// Where the eye is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Viewpoint {
    /// From the front left and above.
    Iso,
    /// From straight above.
    Top,
    /// From the front.
    Front,
}

impl Viewpoint {
    /// Unit vectors to the right, up and towards the eye.
    pub(crate) fn frame(self) -> [DVec3; 3] {
        match self {
            Viewpoint::Top => [DVec3::X, DVec3::Y, DVec3::Z],
            Viewpoint::Front => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
            Viewpoint::Iso => {
                let eye = dvec3(-0.45, -0.75, 0.5).normalize();
                let right = DVec3::Z.cross(eye).normalize();
                [right, eye.cross(right), eye]
            }
        }
    }
}

/// A front-facing triangle on the picture plane.
#[derive(Debug, Clone, Copy)]
struct Facet {
    /// Corners: to the right, up, towards the eye, mm.
    corners: [[f32; 3]; 3],
    /// Brightness, 0 to 1.
    light: f32,
}

/// A model seen from one side, ready to be drawn at any scale.
#[derive(Debug, Clone)]
pub struct ModelPicture {
    facets: Vec<Facet>,
    bounds: Bounds,
}

/// What part of the picture plane goes where.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// Pixels per mm.
    pub scale: f64,
    /// Point of the picture plane in the middle of the image, mm.
    pub centre: DVec2,
    /// Size of the image, pixels.
    pub width: usize,
    /// Size of the image, pixels.
    pub height: usize,
}

impl ModelPicture {
    /// The mesh seen from `viewpoint`.
    pub fn new(mesh: &Mesh, viewpoint: Viewpoint) -> ModelPicture {
        let [right, up, eye] = viewpoint.frame();
        let sun = (eye + 0.5 * up - 0.35 * right).normalize();
        let facet = |index: usize| {
            let corners = mesh.corners(index).map(|v| v.as_dvec3());
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            let light = (0.25 + 0.75 * normal.dot(sun).max(0.0)) as f32;
            let seen = |c: DVec3| [c.dot(right) as f32, c.dot(up) as f32, c.dot(eye) as f32];
            (normal.dot(eye) > 0.0).then(|| Facet { corners: corners.map(seen), light })
        };
        let facets: Vec<Facet> = (0..mesh.triangles.len()).filter_map(facet).collect();
        let points: Vec<DVec2> =
            facets.iter().flat_map(|f| f.corners.map(|c| dvec2(c[0].into(), c[1].into()))).collect();
        let bounds = Bounds::of_points(&points).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE });
        ModelPicture { facets, bounds }
    }

    /// What the picture shows, mm on its plane.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The whole model on an image of this size, see [`ModelPicture::render`].
    pub fn fitted(&self, width: usize, height: usize, tint: [u8; 3]) -> Vec<u8> {
        /// Share of the image that the model may take.
        const FILL: f64 = 0.92;
        let room = dvec2(width as f64, height as f64) / self.bounds.size().max(DVec2::splat(1e-6));
        let camera = Camera { scale: FILL * room.min_element(), centre: self.bounds.centre(), width, height };
        self.render(camera, tint)
    }

    /// RGBA pixels, row by row from the top; clear where nothing is seen. `tint` is the colour of a
    /// fully lit face.
    pub fn render(&self, camera: Camera, tint: [u8; 3]) -> Vec<u8> {
        let mut pixels = vec![0u8; camera.width * camera.height * 4];
        let mut depths = vec![f32::NEG_INFINITY; camera.width * camera.height];
        for facet in &self.facets {
            draw(facet, camera, |place, depth| {
                if depth > depths[place] {
                    depths[place] = depth;
                    let shaded = tint.map(|c| (f32::from(c) * facet.light) as u8);
                    pixels[4 * place..4 * place + 4].copy_from_slice(&[shaded[0], shaded[1], shaded[2], 255]);
                }
            });
        }
        pixels
    }
}

/// Calls `plot` with place and depth of each pixel whose middle the facet covers.
fn draw(facet: &Facet, camera: Camera, mut plot: impl FnMut(usize, f32)) {
    let to_pixel = |c: [f32; 3]| {
        let x = (f64::from(c[0]) - camera.centre.x) * camera.scale + camera.width as f64 / 2.0;
        let y = camera.height as f64 / 2.0 - (f64::from(c[1]) - camera.centre.y) * camera.scale;
        dvec2(x, y)
    };
    let [a, b, c] = facet.corners.map(to_pixel);
    let twice_area = (b - a).perp_dot(c - a);
    if twice_area == 0.0 {
        return;
    }
    let limit = dvec2(camera.width as f64, camera.height as f64);
    let low = a.min(b).min(c).max(DVec2::ZERO).floor();
    let high = a.max(b).max(c).min(limit).ceil();
    for row in low.y as usize..high.y as usize {
        for column in low.x as usize..high.x as usize {
            let p = dvec2(column as f64 + 0.5, row as f64 + 0.5);
            let shares = [(b - p).perp_dot(c - p), (c - p).perp_dot(a - p), (a - p).perp_dot(b - p)];
            let shares = shares.map(|s| s / twice_area);
            if shares.iter().all(|&s| s >= 0.0) {
                let depth: f64 = shares.iter().zip(facet.corners).map(|(s, c)| s * f64::from(c[2])).sum();
                plot(row * camera.width + column, depth as f32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_facet_covers_its_pixels_and_the_nearer_one_wins() {
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let vertices = vec![corner(0.0, 0.0, 0.0), corner(10.0, 0.0, 0.0), corner(0.0, 10.0, 0.0)];
        let tilted = vec![corner(0.0, 0.0, 5.0), corner(10.0, 0.0, 5.0), corner(0.0, 10.0, 9.0)];
        let mesh = Mesh { vertices: [vertices, tilted].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]] };
        let picture = ModelPicture::new(&mesh, Viewpoint::Top);
        let camera = Camera { scale: 2.0, centre: dvec2(5.0, 5.0), width: 20, height: 20 };
        let pixels = picture.render(camera, [200, 200, 200]);
        let covered = pixels.chunks_exact(4).filter(|p| p[3] == 255).count();
        assert!((190..=210).contains(&covered), "{covered}");
        let flat_light = ModelPicture::new(&Mesh { triangles: vec![[0, 1, 2]], ..mesh }, Viewpoint::Top);
        let flat = flat_light.render(camera, [200, 200, 200]);
        let place = 4 * (15 * 20 + 4);
        assert_ne!(pixels[place], flat[place], "the nearer, tilted facet hides the flat one");
    }
}
