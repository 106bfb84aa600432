//! Pictures on a canvas.

use wasm_bindgen::prelude::*;
use web_sys::CanvasRenderingContext2d;

use super::canvas::{self, View};
use super::convert::settings_from;
use super::error::{Thrown, internal_error};
use crate::adhesion::TeethDrawing;
use crate::gcode::read;
use crate::picture::ModelPicture;
use crate::view;
use crate::view::base_layer::teeth_items;

/// A picture of a layer or a model.
#[wasm_bindgen]
pub struct Scene {
    inner: Picture,
}

enum Picture {
    Layer(view::Scene, read::ReadLayer),
    Model(ModelPicture),
}

impl Scene {
    pub(super) fn of_model(picture: ModelPicture) -> Scene {
        Scene { inner: Picture::Model(picture) }
    }
}

#[wasm_bindgen]
impl Scene {
    /// A layer as its G-code says; `settings` is JSON and tells the bed and the filament. `marks` are those
    /// of `Result.marks` on the first layer, else empty.
    pub fn layer(gcode: &[u8], settings: &str, marks: &[u8]) -> Result<Scene, Thrown> {
        let settings = settings_from(settings)?;
        let mut file = read::read(gcode, settings.filament.diameter);
        let layer = file.layers.pop().unwrap_or(file.prelude);
        let mut scene = view::Scene::of_layer(&layer, &settings.printer, None);
        if !marks.is_empty() {
            let teeth: TeethDrawing = postcard::from_bytes(marks).map_err(internal_error)?;
            scene.items.extend(teeth_items(&teeth));
        }
        Ok(Scene { inner: Picture::Layer(scene, layer) })
    }

    /// What is shown, as JSON: a list of `{role, color, length_mm}`.
    pub fn legend(&self) -> Result<String, Thrown> {
        let entries = match &self.inner {
            Picture::Layer(_, layer) => view::legend(layer),
            Picture::Model(_) => Vec::new(),
        };
        serde_json::to_string(&entries).map_err(internal_error)
    }

    /// The box to show: min x, min y, max x, max y, mm.
    pub fn bounds(&self) -> Vec<f64> {
        let b = match &self.inner {
            Picture::Layer(scene, _) => scene.bounds,
            Picture::Model(picture) => picture.bounds(),
        };
        vec![b.min.x, b.min.y, b.max.x, b.max.y]
    }

    /// Paints on the 2D context of a canvas or an `OffscreenCanvas`. `camera` is [CSS pixels per mm,
    /// x and y of the point in the middle, mm, width and height in CSS pixels, device pixels per CSS
    /// pixel]; `theme` is "light" or "dark".
    pub fn paint(&self, ctx: &JsValue, camera: &[f64], theme: &str) -> Result<(), JsValue> {
        // Contexts of canvas and OffscreenCanvas have the same methods.
        let context: &CanvasRenderingContext2d = ctx.unchecked_ref();
        let view = View::new(camera, theme == "dark").ok_or("camera: six numbers are needed")?;
        match &self.inner {
            Picture::Layer(scene, _) => canvas::paint_scene(context, scene, &view),
            Picture::Model(picture) => canvas::paint_model(context, picture, &view),
        }
    }

    /// The picture as SVG; empty for a model.
    pub fn svg(&self) -> String {
        match &self.inner {
            Picture::Layer(scene, _) => scene.to_svg(),
            Picture::Model(_) => String::new(),
        }
    }
}
