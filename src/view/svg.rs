//! A scene as SVG text, y upward as on the bed.

use std::fmt::Write;

use super::scene::{Item, LineWidth, Scene};
use crate::polygon::{DVec2, PolygonSet};

/// Longer side of the picture, pixels.
const PICTURE_PX: f64 = 1000.0;

impl Scene {
    /// The scene as a self-contained SVG file on light ground.
    pub fn to_svg(&self) -> String {
        let size = self.bounds.size();
        let scale = PICTURE_PX / size.max_element();
        let (width, height) = (size.x * scale, size.y * scale);
        let (left, top) = (self.bounds.min.x, -self.bounds.max.y);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"{left:.4} {top:.4} {:.4} {:.4}\">\n",
            size.x, size.y
        );
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.4}\" y=\"{top:.4}\" width=\"{:.4}\" height=\"{:.4}\" fill=\"#fff\"/>",
            size.x, size.y
        );
        svg.push_str("<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
        for item in &self.items {
            write_item(&mut svg, item, scale);
        }
        svg.push_str("</g>\n</svg>\n");
        svg
    }
}

fn write_item(svg: &mut String, item: &Item, scale: f64) {
    match item {
        Item::Stroke { points, closed, width, ink } => {
            let width = match width {
                LineWidth::Mm(mm) => *mm,
                LineWidth::Px(px) => px / scale,
            };
            let colour = ink.colour(false);
            let _ = writeln!(
                svg,
                "<path d=\"{}\" stroke=\"{colour}\" stroke-width=\"{width:.4}\"/>",
                path_data(points, *closed)
            );
        }
        Item::Area { area, ink } => {
            let colour = ink.colour(false);
            let _ =
                writeln!(svg, "<path d=\"{}\" fill=\"{colour}\" fill-rule=\"evenodd\"/>", area_data(area));
        }
        Item::Label { at, text } => {
            let size = 14.0 / scale;
            let text = text.replace('&', "&amp;").replace('<', "&lt;");
            let _ = writeln!(
                svg,
                "<text x=\"{:.4}\" y=\"{:.4}\" font-family=\"sans-serif\" font-size=\"{size:.4}\" fill=\"#202124\">{text}</text>",
                at.x, -at.y
            );
        }
    }
}

fn area_data(area: &PolygonSet) -> String {
    area.contours().iter().map(|c| path_data(&c.points, true)).collect()
}

fn path_data(points: &[DVec2], closed: bool) -> String {
    let mut data = String::new();
    for (i, p) in points.iter().enumerate() {
        let _ = write!(data, "{}{:.4} {:.4}", if i == 0 { 'M' } else { 'L' }, p.x, -p.y);
    }
    if closed {
        data.push('Z');
    }
    data
}
