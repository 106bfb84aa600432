//! Brim teeth step by step [Lv 2022]: outline, offset, simplify, divide, tips, path; then what is printed.

use super::Step;
use crate::adhesion::teeth::simplify::{Limits, simplify_closed};
use crate::adhesion::teeth::vertex::offset_ring;
use crate::adhesion::{AdhesionKind, AdhesionOptions, Foundation, Placement, TeethDrawing, Tooth};
use crate::pipeline::{Job, JobError};
use crate::polygon::measure::Bounds;
use crate::polygon::{Contour, DVec2, Join, PolygonSet, dvec2};
use crate::view::base_layer::{bead, hair_line, outline_strokes, tooth_marks};
use crate::view::scene::{Anchor, Ink, Item, LineWidth, Scene};

/// Steps that show single edges look at so much of the part, mm.
const DETAIL_MM: f64 = 36.0;

/// Radius of the marks on vertices, pixels.
const VERTEX_PX: f64 = 2.6;

/// Free space around the rail, mm.
const MARGIN_MM: f64 = 1.5;

/// The steps for the job's first layer; `adhesion.teeth` gives d, d1, d2, H and the limits.
pub fn teeth(job: &Job) -> Result<Vec<Step>, JobError> {
    let printed = job.first_print().first_outline(AdhesionKind::Teeth);
    let [paper, ours] = [lay(job, Placement::PerEdge)?, lay(job, Placement::AlongContour)?];
    let lesson = Lesson::new(job, &printed, &paper);
    Ok(vec![
        lesson.outline(),
        lesson.offset(),
        lesson.simplify(),
        lesson.divide(),
        lesson.tips(),
        lesson.path(),
        lesson.compare(&ours),
    ])
}

/// One layer of teeth on one rail, as the paper has it.
fn lay(job: &Job, placement: Placement) -> Result<Foundation, JobError> {
    let mut options = AdhesionOptions { kind: AdhesionKind::Teeth, ..job.settings().adhesion.clone() };
    let teeth = &mut options.teeth;
    (teeth.placement, teeth.layers, teeth.rail_lines, teeth.tab) = (placement, 1, 1, false);
    job.first_print().foundation(&options)
}

struct Lesson<'a> {
    options: &'a AdhesionOptions,
    outline: &'a PolygonSet,
    paper: &'a Foundation,
    drawing: TeethDrawing,
    /// The outline shifted by d.
    rails: PolygonSet,
    whole: Bounds,
    detail: Bounds,
}

impl<'a> Lesson<'a> {
    fn new(job: &'a Job, outline: &'a PolygonSet, paper: &'a Foundation) -> Self {
        let options = &job.settings().adhesion;
        let drawing = paper.drawing.clone().unwrap_or_default();
        let rails = drawing.outline.offset(options.teeth.offset, Join::WALL);
        let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        let whole = rails.bounds().or(outline.bounds()).unwrap_or(nothing).grown(MARGIN_MM);
        let detail = detail_of(&drawing.outline, whole);
        Lesson { options, outline, paper, drawing, rails, whole, detail }
    }

    /// Contours that get a rail.
    fn wanted(&self) -> impl Iterator<Item = &Contour> {
        self.rails.contours().iter().filter(|c| self.options.teeth.holes || c.signed_area() > 0.0)
    }

    fn part(&self) -> Vec<Item> {
        let mut items = vec![Item::Area { area: self.outline.clone(), ink: Ink::Part }];
        items.extend(outline_strokes(self.outline, Ink::Outline, 1.5));
        items
    }

    fn outline(&self) -> Step {
        let mut items = self.part();
        let points = self.outline.contours().iter().flat_map(|c| &c.points);
        items.extend(points.map(|&p| dot(p, Ink::Vertex)));
        let facts = [
            ("contours", self.outline.contours().len() as f64),
            ("vertices", self.outline.vertex_count() as f64),
            ("length", self.outline.length()),
        ];
        Step::new("outline", Scene { items, bounds: self.whole }, facts)
    }

    /// Eq. (1) to (8), vertex by vertex; the rail itself comes from the polygon library.
    fn offset(&self) -> Step {
        let d = self.options.teeth.offset;
        let mut items = self.part();
        let mut count = 0;
        for contour in self.drawing.outline.contours().iter().filter(|c| c.signed_area() > 0.0) {
            let moved = offset_ring(contour, d);
            count += moved.points.len();
            let guides = contour.points.iter().zip(&moved.points);
            items.extend(guides.map(|(&p, &q)| hair_line(vec![p, q], false, Ink::Guide)));
            items.extend(moved.points.iter().map(|&q| dot(q, Ink::Vertex)));
        }
        items.extend(self.wanted().map(|c| thick(c.points.clone(), true, Ink::Rail)));
        Step::new(
            "offset",
            Scene { items, bounds: self.detail },
            [("offset", d), ("vertices", count as f64), ("rails", self.wanted().count() as f64)],
        )
    }

    fn simplify(&self) -> Step {
        let mut items = self.part();
        let (mut before, mut after) = (0, 0);
        for (contour, simple) in self.wanted().zip(self.simplified()) {
            before += contour.points.len();
            after += simple.points.len();
            items.push(thick(simple.points.clone(), true, Ink::Rail));
            let dropped = contour.points.iter().filter(|p| !simple.points.contains(p));
            items.extend(dropped.map(|&p| dot(p, Ink::DroppedVertex)));
            items.extend(simple.points.iter().map(|&p| dot(p, Ink::Vertex)));
        }
        let teeth = &self.options.teeth;
        let facts = [
            ("before", before as f64),
            ("after", after as f64),
            ("min_length", teeth.simplify_length),
            ("min_height", teeth.simplify_height),
        ];
        Step::new("simplify", Scene { items, bounds: self.detail }, facts)
    }

    fn simplified(&self) -> impl Iterator<Item = Contour> {
        let teeth = &self.options.teeth;
        let limits = Limits { length: teeth.simplify_length, height: teeth.simplify_height };
        self.wanted().map(move |c| simplify_closed(c, limits))
    }

    /// Every edge of the rail in N parts.
    fn divide(&self) -> Step {
        let mut items = self.part();
        items.extend(self.drawing.rails.iter().map(|r| thick(r.clone(), true, Ink::Rail)));
        for tooth in &self.drawing.teeth {
            items.push(thick(vec![tooth.a, tooth.b], false, Ink::Bite));
            items.extend([dot(tooth.a, Ink::SPointA), dot(tooth.b, Ink::SPointB)]);
        }
        let first =
            self.drawing.teeth.iter().find(|t| is_inside(t.a, self.detail) && is_inside(t.b, self.detail));
        let label = |at, text: &str| Item::Label { at, text: text.to_owned(), anchor: Anchor::Beside };
        items.extend(first.into_iter().flat_map(|t| [label(t.a, "A₁"), label(t.b, "B₁")]));
        let edges: usize = self.drawing.rails.iter().map(Vec::len).sum();
        let too_short = self.drawing.rails.iter().map(|r| self.short_edges(r)).sum::<usize>();
        let teeth = &self.options.teeth;
        let facts = [
            ("edges", edges as f64),
            ("short_edges", too_short as f64),
            ("pitch", teeth.pitch),
            ("base", teeth.base),
            ("teeth", self.drawing.teeth.len() as f64),
        ];
        Step::new("divide", Scene { items, bounds: self.detail }, facts)
    }

    fn short_edges(&self, rail: &[DVec2]) -> usize {
        let next = |i: usize| rail[(i + 1) % rail.len()];
        (0..rail.len()).filter(|&i| rail[i].distance(next(i)) < self.options.teeth.pitch).count()
    }

    fn tips(&self) -> Step {
        let mut items = self.part();
        items.extend(self.drawing.rails.iter().map(|r| hair_line(r.clone(), true, Ink::Rail)));
        items.extend(self.drawing.teeth.iter().map(|t| thick(vec![t.a, t.tip, t.b], false, Ink::Tooth)));
        items.extend(self.drawing.teeth.iter().flat_map(tooth_marks));
        let biting = biting(&self.drawing.teeth);
        let teeth = &self.options.teeth;
        let facts = [
            ("height", teeth.height),
            ("bite", teeth.height - teeth.offset),
            ("teeth", self.drawing.teeth.len() as f64),
            ("biting", biting as f64),
            ("outside", (self.drawing.teeth.len() - biting) as f64),
        ];
        Step::new("tips", Scene { items, bounds: self.detail }, facts)
    }

    fn path(&self) -> Step {
        let length: f64 = self.paper.layers.iter().flatten().map(|p| p.length()).sum();
        let facts = [("length", length), ("filament", self.paper.figures.filament_mm3)];
        Step::new("path", self.printed(self.paper), facts)
    }

    fn printed(&self, laid: &Foundation) -> Scene {
        let mut items = self.part();
        items.extend(laid.layers.iter().flatten().map(bead));
        let teeth = laid.drawing.iter().flat_map(|d| &d.teeth);
        items.extend(teeth.flat_map(tooth_marks));
        Scene { items, bounds: self.whole }
    }

    /// The paper's teeth beside those that are printed.
    fn compare(&self, ours: &Foundation) -> Step {
        let own = ours.drawing.as_ref().map_or(&[][..], |d| &d.teeth);
        let figures = ours.figures.teeth.unwrap_or_default();
        let facts = [
            ("paper", self.drawing.teeth.len() as f64),
            ("paper_biting", biting(&self.drawing.teeth) as f64),
            ("ours", own.len() as f64),
            ("ours_biting", biting(own) as f64),
            ("bite_min", figures.bite_min_mm),
            ("bite_max", figures.bite_max_mm),
        ];
        Step::new("compare", self.printed(self.paper), facts).beside(self.printed(ours))
    }
}

fn biting(teeth: &[Tooth]) -> usize {
    teeth.iter().filter(|t| t.bite > 0.0).count()
}

fn is_inside(p: DVec2, bounds: Bounds) -> bool {
    p.clamp(bounds.min, bounds.max) == p
}

fn dot(at: DVec2, ink: Ink) -> Item {
    Item::Dot { at, radius_px: VERTEX_PX, ink }
}

fn thick(points: Vec<DVec2>, closed: bool, ink: Ink) -> Item {
    Item::Stroke { points, closed, width: LineWidth::Px(2.2), ink }
}

/// A window on the lower left corner of the part, or the whole where that is small.
fn detail_of(outline: &PolygonSet, whole: Bounds) -> Bounds {
    let size = whole.size().min(DVec2::splat(DETAIL_MM));
    let points = outline.contours().iter().flat_map(|c| &c.points);
    let corner = points.copied().min_by(|p, q| (p.x + p.y).total_cmp(&(q.x + q.y)));
    let aim = corner.unwrap_or(whole.min) - size * 0.25;
    let min = aim.clamp(whole.min, dvec2(whole.max.x - size.x, whole.max.y - size.y).max(whole.min));
    Bounds { min, max: min + size }
}
