//! Paints scenes through web-sys.

use js_sys::Array;
use wasm_bindgen::{Clamped, JsValue};
use web_sys::{CanvasRenderingContext2d, ImageData};

use crate::picture::{Camera, ModelPicture};
use crate::polygon::{DVec2, dvec2};
use crate::view::svg::{BESIDE_PX, DASH_PX, TEXT_PX};
use crate::view::{Anchor, Ink, Item, LineWidth, Scene};

/// What part of the plane is shown on how many pixels.
pub(super) struct View {
    /// Device pixels per mm.
    scale: f64,
    centre: DVec2,
    /// Size in device pixels.
    size: DVec2,
    /// Device pixels per CSS pixel.
    ratio: f64,
    dark: bool,
}

impl View {
    /// From the six numbers of `Scene.paint`.
    pub(super) fn new(camera: &[f64], dark: bool) -> Option<View> {
        let &[scale, x, y, width, height, ratio] = camera else { return None };
        let size = (dvec2(width, height) * ratio).round();
        Some(View { scale: scale * ratio, centre: dvec2(x, y), size, ratio, dark })
    }
}

/// Fully lit faces of a model.
pub(super) const MODEL_TINT: [u8; 3] = [122, 166, 214];

/// Paints strokes, areas and labels over a cleared canvas.
pub(super) fn paint_scene(
    context: &CanvasRenderingContext2d,
    scene: &Scene,
    view: &View,
) -> Result<(), JsValue> {
    clear(context, view)?;
    let View { scale, centre, size, .. } = view;
    let shift = dvec2(size.x / 2.0 - centre.x * scale, size.y / 2.0 + centre.y * scale);
    context.set_transform(*scale, 0.0, 0.0, -scale, shift.x, shift.y)?;
    context.set_line_cap("round");
    context.set_line_join("round");
    for item in &scene.items {
        paint_item(context, item, view)?;
    }
    context.reset_transform()
}

fn clear(context: &CanvasRenderingContext2d, view: &View) -> Result<(), JsValue> {
    context.reset_transform()?;
    context.clear_rect(0.0, 0.0, view.size.x, view.size.y);
    Ok(())
}

fn paint_item(context: &CanvasRenderingContext2d, item: &Item, view: &View) -> Result<(), JsValue> {
    match item {
        Item::Stroke { points, closed, width, ink } => {
            context.begin_path();
            trace(context, points, *closed);
            context.set_stroke_style_str(ink.colour(view.dark));
            context.set_line_width(match width {
                LineWidth::Mm(mm) => *mm,
                LineWidth::Px(px) => px * view.ratio / view.scale,
            });
            let dash = if ink.is_dashed() { DASH_PX * view.ratio / view.scale } else { 0.0 };
            let pattern = if dash > 0.0 { Array::of2(&dash.into(), &dash.into()) } else { Array::new() };
            context.set_line_dash(&pattern)?;
            context.stroke();
        }
        Item::Area { area, ink } => {
            context.begin_path();
            for contour in area.contours() {
                trace(context, &contour.points, true);
            }
            context.set_fill_style_str(ink.colour(view.dark));
            context.fill();
        }
        Item::Dot { at, radius_px, ink } => {
            context.begin_path();
            let radius = radius_px * view.ratio / view.scale;
            context.arc(at.x, at.y, radius, 0.0, std::f64::consts::TAU)?;
            context.set_fill_style_str(ink.colour(view.dark));
            context.fill();
        }
        Item::Label { at, text, anchor } => {
            context.save();
            context.translate(at.x, at.y)?;
            context.scale(view.ratio / view.scale, -view.ratio / view.scale)?;
            context.set_font(&format!("{TEXT_PX}px sans-serif"));
            context.set_fill_style_str(Ink::Text.colour(view.dark));
            match anchor {
                Anchor::Beside => context.fill_text(text, BESIDE_PX, -BESIDE_PX)?,
                Anchor::Middle => {
                    context.set_text_align("center");
                    context.fill_text(text, 0.0, TEXT_PX / 3.0)?;
                }
            }
            context.restore();
        }
    }
    Ok(())
}

fn trace(context: &CanvasRenderingContext2d, points: &[DVec2], closed: bool) {
    let Some((first, rest)) = points.split_first() else { return };
    context.move_to(first.x, first.y);
    for p in rest {
        context.line_to(p.x, p.y);
    }
    if closed {
        context.close_path();
    }
}

/// Paints a shaded model over a cleared canvas.
pub(super) fn paint_model(
    context: &CanvasRenderingContext2d,
    picture: &ModelPicture,
    view: &View,
) -> Result<(), JsValue> {
    clear(context, view)?;
    let (width, height) = (view.size.x as usize, view.size.y as usize);
    if width == 0 || height == 0 {
        return Ok(());
    }
    let camera = Camera { scale: view.scale, centre: view.centre, width, height };
    let pixels = picture.render(camera, MODEL_TINT);
    let image = ImageData::new_with_u8_clamped_array(Clamped(&pixels), width as u32)?;
    context.put_image_data(&image, 0.0, 0.0)
}
