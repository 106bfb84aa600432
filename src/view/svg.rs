//! A scene as SVG text, y upward as on the bed.

use std::fmt::Write;

use super::scene::{Anchor, Ink, Item, LineWidth, Scene};
use crate::polygon::{DVec2, PolygonSet};

/// What a picture is made for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper {
    /// Longer side of the picture, pixels: letters and marks keep their size on it.
    pub side_px: f64,
    /// Colours for dark ground.
    pub dark: bool,
    /// Whether the ground is painted; without, the page shows through.
    pub ground: bool,
}

impl Paper {
    /// A file of its own: 1000 pixels on white ground.
    pub const FILE: Paper = Paper { side_px: 1000.0, dark: false, ground: true };

    /// A picture within a page.
    pub const fn inline(side_px: f64, dark: bool) -> Paper {
        Paper { side_px, dark, ground: false }
    }
}

/// Height of letters, pixels.
pub const TEXT_PX: f64 = 14.0;

/// How far a letter beside a point keeps from it to the right and above, pixels.
pub const BESIDE_PX: f64 = 6.0;

impl Scene {
    /// The scene as a self-contained SVG file on light ground.
    pub fn to_svg(&self) -> String {
        self.to_svg_on(Paper::FILE)
    }

    /// The scene as SVG text for `paper`. Every element's class is its ink's name.
    pub fn to_svg_on(&self, paper: Paper) -> String {
        let size = self.bounds.size();
        let scale = paper.side_px / size.max_element();
        let (width, height) = (size.x * scale, size.y * scale);
        let (left, top) = (self.bounds.min.x, -self.bounds.max.y);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"{left:.4} {top:.4} {:.4} {:.4}\">\n",
            size.x, size.y
        );
        if paper.ground {
            let _ = writeln!(
                svg,
                "<rect x=\"{left:.4}\" y=\"{top:.4}\" width=\"{:.4}\" height=\"{:.4}\" fill=\"#fff\"/>",
                size.x, size.y
            );
        }
        svg.push_str("<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
        for item in &self.items {
            write_item(&mut svg, item, scale, paper.dark);
        }
        svg.push_str("</g>\n</svg>\n");
        svg
    }
}

fn write_item(svg: &mut String, item: &Item, scale: f64, dark: bool) {
    // Writing to a string cannot fail.
    let _ = match item {
        Item::Stroke { points, closed, width, ink } => {
            let width = match width {
                LineWidth::Mm(mm) => *mm,
                LineWidth::Px(px) => px / scale,
            };
            let dash = if ink.is_dashed() {
                format!(" stroke-dasharray=\"{:.4}\"", DASH_PX / scale)
            } else {
                String::new()
            };
            writeln!(
                svg,
                "<path class=\"{}\" d=\"{}\" stroke=\"{}\" stroke-width=\"{width:.4}\"{dash}/>",
                ink.name(),
                path_data(points, *closed),
                ink.colour(dark)
            )
        }
        Item::Area { area, ink } => writeln!(
            svg,
            "<path class=\"{}\" d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\"/>",
            ink.name(),
            area_data(area),
            ink.colour(dark)
        ),
        Item::Dot { at, radius_px, ink } => writeln!(
            svg,
            "<circle class=\"{}\" cx=\"{:.4}\" cy=\"{:.4}\" r=\"{:.4}\" fill=\"{}\"/>",
            ink.name(),
            at.x,
            -at.y,
            radius_px / scale,
            ink.colour(dark)
        ),
        Item::Label { at, text, anchor } => write_label(svg, *at, text, *anchor, scale, dark),
    };
}

/// Length of a dash and of the gap behind it, pixels.
pub const DASH_PX: f64 = 4.0;

fn write_label(
    svg: &mut String,
    at: DVec2,
    text: &str,
    anchor: Anchor,
    scale: f64,
    dark: bool,
) -> std::fmt::Result {
    let (right, up, side) = match anchor {
        Anchor::Beside => (BESIDE_PX, BESIDE_PX, "start"),
        // A third of the height brings digits to the middle.
        Anchor::Middle => (0.0, -TEXT_PX / 3.0, "middle"),
    };
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    writeln!(
        svg,
        "<text class=\"text\" x=\"{:.4}\" y=\"{:.4}\" text-anchor=\"{side}\" font-family=\"sans-serif\" \
         font-size=\"{:.4}\" fill=\"{}\">{text}</text>",
        at.x + right / scale,
        -at.y - up / scale,
        TEXT_PX / scale,
        Ink::Text.colour(dark)
    )
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
