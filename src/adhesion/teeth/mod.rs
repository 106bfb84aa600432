//! Brim teeth [Lv 2022]: a rail around the outline with teeth that bite into it.
//!
//! Symbols: d = distance of the rail, d1 = base of a tooth, d2 = pitch, H = height from rail to
//! tip; H - d is the bite.

mod along_contour;
mod per_edge;
mod rail;
pub mod simplify;
mod site;
mod spacing;
pub(super) mod tab;
pub mod vertex;
mod windows;

use rail::Rail;
use site::Site;
use windows::Window;

use super::clip::{Line, to_box};
use super::error::{AdhesionError, AdhesionWarning, WarningCode};
use super::ground::{Ground, grown};
use super::options::{Placement, TeethOptions};
use super::segments::{Segment, Segments};
use super::{FirstLayer, Foundation, TeethFigures};
use crate::polygon::{DVec2, Join, PolygonSet, by_x_then_y};
use crate::region::{Path, Role};
use crate::sort::StableSort;

/// By how much crowded rails may be off, mm: a tenth of what a bite may.
const RAIL_TOLERANCE_MM: f64 = 0.002;

/// One tooth: the path leaves the rail at `a`, turns at `tip` and returns to the rail at `b`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Tooth {
    /// Where the path leaves the rail (A_i of eq. 15).
    pub a: DVec2,
    /// Where it turns, inside the part (C_i of eq. 17).
    pub tip: DVec2,
    /// Where it returns to the rail (B_i of eq. 16).
    pub b: DVec2,
    /// Where the tooth's axis meets the outline.
    pub foot: DVec2,
    /// Depth of the tip in the part, mm: its distance from the outline; negative outside.
    pub bite: f64,
    /// Whether the part is thinner than twice the bite asked for, so that this tooth bites less.
    pub shallow: bool,
}

/// What the layer canvas and the Learn view draw.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct TeethDrawing {
    /// The printed outline that everything is measured to (supports included).
    pub outline: PolygonSet,
    /// The rails without teeth, closed, as if the bed had no edge.
    pub rails: Vec<Vec<DVec2>>,
    /// All teeth.
    pub teeth: Vec<Tooth>,
}

/// A tooth on its rail.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PlacedTooth {
    tooth: Tooth,
    /// Index of the rail.
    rail: usize,
    /// Arc length of `a`; below 0 for a base around the rail's start.
    from: f64,
    /// Arc length of `b`.
    to: f64,
}

/// Teeth around everything on the ground. Figures but the counts are filled in by the caller.
pub(super) fn teeth(
    first: &FirstLayer,
    ground: &Ground,
    options: &TeethOptions,
) -> Result<Foundation, AdhesionError> {
    check(options)?;
    let site = Site::new(&ground.area, first.bed, first.line_width, options);
    let offset = grown(&ground.area, options.offset, Join::WALL, RAIL_TOLERANCE_MM);
    let placement = match options.placement {
        Placement::AlongContour => along_contour::place(&site, &offset),
        Placement::PerEdge => along_contour::Placement::all(per_edge::place(&site, &offset)),
    };
    let mut warnings = remarks(first, options, &placement);
    let mut paths = extra_rails(first, &site, &placement.rails);
    let (zigzags, off_bed) = zigzags(first, &site, &placement.rails);
    paths.extend(zigzags);
    if let Some(at) = off_bed {
        let message = "printer.bed_size: the rail of the teeth would leave the bed; it is cut off there";
        warnings.push(AdhesionWarning::new(WarningCode::AdhesionOffBed, message.to_owned(), Some(at)));
    }
    if options.tab {
        let (tabs, missing) = tab::tabs(first, &site, &placement.rails);
        paths.extend(tabs);
        warnings.extend(missing);
    }
    let teeth: Vec<Tooth> = placement.rails.iter().flat_map(|r| &r.1).map(|t| t.tooth).collect();
    let rails = placement.rails.into_iter().map(|r| r.0.points).collect();
    let mut foundation =
        Foundation { layers: vec![paths; options.layers as usize], warnings, ..Foundation::default() };
    foundation.figures.teeth = Some(counted(&teeth, placement.left_out));
    foundation.drawing = Some(TeethDrawing { outline: ground.area.clone(), rails, teeth });
    Ok(foundation)
}

/// What ranges cannot say: d1 < d2 and d < H.
fn check(options: &TeethOptions) -> Result<(), AdhesionError> {
    let contradiction =
        |setting, found, must_be, limit| Err(AdhesionError::Contradiction { setting, found, must_be, limit });
    if options.base >= options.pitch {
        let rule = "less than adhesion.teeth.pitch";
        return contradiction("adhesion.teeth.base", options.base, rule, options.pitch);
    }
    if options.height <= options.offset {
        let rule = "more than adhesion.teeth.offset";
        return contradiction("adhesion.teeth.height", options.height, rule, options.offset);
    }
    Ok(())
}

/// Rails with their teeth, in printing order; where the bed's edge cuts them, if it does.
fn zigzags(
    first: &FirstLayer,
    site: &Site,
    rails: &[(Rail, Vec<PlacedTooth>)],
) -> (Vec<Path>, Option<DVec2>) {
    let mut tips: Vec<DVec2> = rails.iter().flat_map(|r| &r.1).map(|t| t.tooth.tip).collect();
    tips.stable_sort_by(|&p, &q| by_x_then_y(p, q));
    let holds = |p: &DVec2| tips.binary_search_by(|&q| by_x_then_y(q, *p)).is_ok();
    let keeps_bare = site.options.placement == Placement::PerEdge;
    let (mut paths, mut off_bed) = (Vec::new(), None);
    for (rail, teeth) in rails {
        let points = rail.zigzag(teeth);
        off_bed =
            off_bed.or_else(|| points.iter().find(|&&p| p.clamp(site.bed.min, site.bed.max) != p).copied());
        let pieces = to_box(Line::ring(points), site.bed).into_iter();
        let kept = pieces.filter(|line| keeps_bare || line.points.iter().any(holds));
        paths.extend(kept.map(|line| path_of(line, first.line_width)));
    }
    (paths, off_bed)
}

fn path_of(line: Line, width: f64) -> Path {
    match line.closed {
        true => Path::closed(Role::Teeth, line.points, width),
        false => Path::open(Role::Teeth, line.points, width),
    }
}

/// Loops outside the rails that carry teeth, outermost first.
fn extra_rails(first: &FirstLayer, site: &Site, rails: &[(Rail, Vec<PlacedTooth>)]) -> Vec<Path> {
    let edges = rails.iter().flat_map(|(rail, _)| rail.edges().map(|(_, a, b)| Segment { a, b, owner: 0 }));
    let index = Segments::new(edges.collect(), first.line_width.max(1.0));
    let loops = |k: u32| {
        let farther = f64::from(k) * first.line_width;
        let set = grown(site.area, site.options.offset + farther, Join::WALL, RAIL_TOLERANCE_MM);
        // A mitred corner of a loop is up to twice as far from its rail as the loop's edges.
        let beside = |p: &DVec2| index.nearest(*p, 2.0 * farther + first.line_width).is_some();
        let kept = set.into_contours().into_iter().filter(|c| c.points.iter().all(beside));
        kept.flat_map(|c| to_box(Line::ring(c.points), site.bed)).collect::<Vec<_>>()
    };
    let lines = (1..site.options.rail_lines).rev().flat_map(loops);
    lines.map(|line| path_of(line, first.line_width)).collect()
}

fn counted(teeth: &[Tooth], left_out: u32) -> TeethFigures {
    let bites = || teeth.iter().map(|t| t.bite);
    TeethFigures {
        placed: teeth.len() as u32,
        left_out,
        shallow: teeth.iter().filter(|t| t.shallow).count() as u32,
        bite_min_mm: bites().reduce(f64::min).unwrap_or(0.0),
        bite_max_mm: bites().reduce(f64::max).unwrap_or(0.0),
    }
}

/// Warnings about teeth that are missing or bite less than asked.
fn remarks(
    first: &FirstLayer,
    options: &TeethOptions,
    placement: &along_contour::Placement,
) -> Vec<AdhesionWarning> {
    let mut found = Vec::new();
    let mut say = |code, message: String, at| found.push(AdhesionWarning::new(code, message, at));
    if let Some((count, at)) = placement.bare {
        let message = format!(
            "adhesion.teeth.base: {count} outline(s) without any tooth: too small, or no room around them"
        );
        say(WarningCode::IslandWithoutTeeth, message, Some(at));
    }
    if placement.left_out > 0 {
        let message = format!(
            "adhesion.teeth.pitch: {} teeth left out, as they would cross something or leave the bed",
            placement.left_out
        );
        say(WarningCode::TeethLeftOut, message, placement.missing_at);
    }
    let mut shallow = placement.rails.iter().flat_map(|r| &r.1).filter(|t| t.tooth.shallow);
    if let Some(tooth) = shallow.next() {
        let message = format!(
            "adhesion.teeth.height: {} teeth bite less than {:.2} mm, where the part is thinner than twice that",
            1 + shallow.count(),
            options.height - options.offset
        );
        say(WarningCode::TeethShallow, message, Some(tooth.tooth.foot));
    }
    if options.offset < first.line_width {
        let message = format!(
            "adhesion.teeth.offset: {} mm is less than a line ({} mm): the rail touches the part",
            options.offset, first.line_width
        );
        say(WarningCode::RailTouchesPart, message, None);
    }
    found
}
