//! Lines that fill an area: solid, or sparse in a pattern.

mod border;
mod concentric;
mod gyroid;
mod honeycomb;
pub mod lines;

use crate::polygon::{Join, Polygon, PolygonSet};
use crate::region::Bead;
use crate::region::{Path, Role};
use border::{Border, Piece};
use lines::Hatch;

crate::words! {
    /// How sparse infill is laid.
    pub enum InfillPattern {
        /// Lines in both diagonal directions on every layer.
        #[default]
        Grid = "grid",
        /// Lines in one diagonal direction, turned by 90 degrees from layer to layer.
        Lines = "lines",
        /// Lines in three directions on every layer, which meet in points: stiff walls in between.
        Triangles = "triangles",
        /// A wavy surface that holds in all directions and never crosses itself.
        Gyroid = "gyroid",
        /// Hexagons, the same on every layer.
        Honeycomb = "honeycomb",
        /// Loops that follow the walls: for soft materials.
        Concentric = "concentric",
    }
}

crate::options! {
    /// What fills the part inside its walls and skins.
    pub struct InfillOptions {
        /// Share of the inside that is filled with material; 0 leaves it hollow, 1 makes it solid. What
        /// joins the lines counts, so that lines lie a little farther apart in small parts.
        density: f64 = 0.15, "Infill density", "", 0.0..=1.0;
        /// Sparse areas smaller than this are filled solidly.
        solid_below_area: f64 = 15.0, "Solid infill below", "mm2", 0.0..=10000.0;
        /// How the lines run.
        pattern: InfillPattern = InfillPattern::Grid, "Infill pattern";
        /// How far sparse infill reaches into the innermost wall, as a share of its line width; 0 lets
        /// it touch.
        overlap: f64 = 0.25, "Infill overlap", "", 0.0..=0.5;
        /// Longest way along the walls on which neighbouring lines are joined; 0 joins none.
        anchor_max: f64 = 20.0, "Longest join of infill lines", "mm", 0.0..=1000.0;
    }
}

/// A layer as far as patterns look at it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfillLayer {
    /// Place in the print, 0 at the bed.
    pub index: u32,
    /// Height of the nozzle, mm.
    pub z: f64,
}

/// Ends of sparse infill that are not joined follow the wall this far, in line widths.
const ANCHOR: f64 = 2.0;

/// Shorter pieces of sparse infill hold nothing and only cost time, mm.
const SHORTEST_SPARSE_LINE: f64 = 0.8;

/// Fills `area` solidly, in the diagonal direction of this layer; returns the beads and what is too
/// narrow for them.
pub fn fill_solid(area: &PolygonSet, role: Role, bead: Bead, layer: u32) -> (Vec<Path>, PolygonSet) {
    lines::hatch_linked(area, role, bead, Hatch::diagonal(layer, bead.spacing()))
}

/// Fills a surface that is seen: like [`fill_solid`], but monotonic. Each island of the area gives one
/// row of beads to be printed in the given order and direction.
pub fn fill_surface(area: &PolygonSet, role: Role, bead: Bead, layer: u32) -> (Vec<Vec<Path>>, PolygonSet) {
    let hatch = Hatch::diagonal(layer, bead.spacing());
    let islands = area.islands().into_iter().map(Polygon::into_set);
    let (rows, narrow): (Vec<_>, Vec<_>) =
        islands.map(|island| lines::hatch_monotonic(&island, role, bead, hatch)).unzip();
    (rows.into_iter().filter(|row| !row.is_empty()).collect(), PolygonSet::union_all(&narrow))
}

/// Fills `area` with lines that take up `options.density` of it, joined along its border. What joins
/// them comes on top; [`true_lines`] allows for it.
pub fn fill_sparse(area: &PolygonSet, bead: Bead, layer: InfillLayer, options: &InfillOptions) -> Vec<Path> {
    let density = options.density;
    if density <= 0.0 {
        return Vec::new();
    }
    let inside = centre_lines(area, bead, options.overlap);
    if options.pattern == InfillPattern::Concentric {
        let loops = concentric::loops(&inside, bead.spacing() / density);
        return loops.into_iter().map(|c| Path::closed(Role::Infill, c.points, bead.width)).collect();
    }
    let border = Border::of(&inside);
    let pieces = pattern_pieces(&inside, &border, bead.spacing(), layer, density, options.pattern);
    let anchor = (ANCHOR * bead.width).min(options.anchor_max);
    let joined = border.join(pieces, options.anchor_max, anchor);
    let paths = joined.into_iter().map(|points| Path::open(Role::Infill, points, bead.width));
    paths.filter(|path| path.length() >= SHORTEST_SPARSE_LINE).collect()
}

/// Where the centre lines of sparse beads may run: beads overlap the area's border by this share of
/// their width, and places too narrow for one are left out.
fn centre_lines(area: &PolygonSet, bead: Bead, overlap: f64) -> PolygonSet {
    let (half, into_wall) = (bead.width / 2.0, bead.width * overlap);
    let opened = area.offset(-half, Join::WALL).offset(into_wall, Join::WALL);
    // At a corner that is cut off by a short edge the mitre would run on beyond it.
    opened.intersection(&area.offset(into_wall - half, Join::WALL))
}

/// The pattern's lines inside the area, each on its own.
fn pattern_pieces(
    inside: &PolygonSet,
    border: &Border<'_>,
    spacing: f64,
    layer: InfillLayer,
    density: f64,
    pattern: InfillPattern,
) -> Vec<Piece> {
    let Some(bounds) = inside.bounds() else { return Vec::new() };
    let distance = spacing / density;
    let straight =
        |hatches: &[Hatch]| hatches.iter().flat_map(|&h| lines::hatch(inside, border, h)).collect();
    match pattern {
        InfillPattern::Lines => straight(&[Hatch::diagonal(layer.index, distance)]),
        InfillPattern::Grid => straight(&[0, 1].map(|way| Hatch::diagonal(way, 2.0 * distance))),
        InfillPattern::Triangles => straight(&Hatch::triangles(3.0 * distance)),
        InfillPattern::Gyroid => {
            border.cut(&gyroid::curves(bounds, layer.z, gyroid::LENGTH_PER_PERIOD * distance))
        }
        InfillPattern::Honeycomb => border.cut(&honeycomb::zigzags(bounds, spacing, density)),
        // Loops have no ends to cut or join.
        InfillPattern::Concentric => Vec::new(),
    }
}

/// Lines are laid this much farther apart or closer than the density alone says at most: skins need
/// something to lie on.
const FARTHEST_APART: f64 = 1.25;

/// The same for loops, whose first runs along the walls: even then no gap is wider than a grid's.
const LOOPS_FARTHEST_APART: f64 = 2.0;

/// Density counts as met within this share.
const CLOSE_ENOUGH: f64 = 0.01;

/// Density is missed beyond this share: all distances are tried then.
const MISSED: f64 = 0.03;

/// Distances of lines and longest joins tried. Lines are counted from the bed's origin, so that a part
/// gets a few more or less with every change; the best try is taken.
const TRIES: usize = 6;

/// Evenly spread distances tried where a change of a few percent makes a line more or less.
const EVEN_TRIES: u32 = 16;

/// How to lay lines so that together with what joins them they take up `options.density` of the given
/// areas, which stand for the whole print.
///
/// Lines are laid farther apart or closer until they do; where that would be too far, the longest joins
/// are left out.
pub fn true_lines(areas: &[PolygonSet], bead: Bead, options: &InfillOptions) -> InfillOptions {
    let wanted = options.density;
    let total: f64 = areas.iter().map(PolygonSet::area).sum();
    if total <= 0.0 || wanted <= 0.0 {
        return options.clone();
    }
    let farthest = match options.pattern {
        InfillPattern::Concentric => LOOPS_FARTHEST_APART,
        _ => FARTHEST_APART,
    };
    let (least, most) = (wanted / farthest, (wanted * farthest).min(1.0));
    let mut tries = Tries { areas, bead, wanted: wanted * total, best: (f64::INFINITY, options.clone()) };
    let mut lines = options.clone();
    let share = tries.meet(&mut lines, least, most);
    if lines.density == least && share > 1.0 + CLOSE_ENOUGH {
        let (mut low, mut high) = (0.0, options.anchor_max);
        for _ in 0..TRIES {
            lines.anchor_max = (low + high) / 2.0;
            if tries.share(&lines) > 1.0 { high = lines.anchor_max } else { low = lines.anchor_max }
        }
        if tries.best.0 > CLOSE_ENOUGH {
            // Joins are all equally long: without them lines may lie closer again, and joins be shorter.
            lines.anchor_max = low / farthest;
            tries.meet(&mut lines, least, most);
        }
    }
    if tries.best.0 > MISSED {
        for k in 0..=EVEN_TRIES {
            lines.density = least + (most - least) * f64::from(k) / f64::from(EVEN_TRIES);
            tries.share(&lines);
        }
    }
    tries.best.1
}

/// Ways to lay lines, and the one that comes closest to the density wanted.
struct Tries<'a> {
    areas: &'a [PolygonSet],
    bead: Bead,
    /// Area that the lines shall take up, mm2.
    wanted: f64,
    /// How far the best is off, as a share, and what it is.
    best: (f64, InfillOptions),
}

impl Tries<'_> {
    /// What these lines take up, as a share of what is wanted.
    fn share(&mut self, lines: &InfillOptions) -> f64 {
        let share = laid_length(self.areas, lines, self.bead) * self.bead.spacing() / self.wanted;
        if (share - 1.0).abs() < self.best.0 {
            self.best = ((share - 1.0).abs(), lines.clone());
        }
        share
    }

    /// Changes the distance of lines until they take up what is wanted; returns the share they do.
    fn meet(&mut self, lines: &mut InfillOptions, least: f64, most: f64) -> f64 {
        let mut share = self.share(lines);
        for _ in 0..TRIES {
            let next = (lines.density / share).clamp(least, most);
            if (share - 1.0).abs() < CLOSE_ENOUGH || next == lines.density {
                break;
            }
            lines.density = next;
            share = self.share(lines);
        }
        share
    }
}

/// Length of the lines and joins in these areas, mm; the areas' heights are spread over a period of the
/// gyroid, whose curves are not equally long at all heights.
fn laid_length(areas: &[PolygonSet], lines: &InfillOptions, bead: Bead) -> f64 {
    let step = gyroid::LENGTH_PER_PERIOD * bead.spacing() / lines.density / areas.len() as f64;
    let laid = |(area, index): (&PolygonSet, u32)| {
        fill_sparse(area, bead, InfillLayer { index, z: step * f64::from(index) }, lines)
    };
    areas.iter().zip(0..).flat_map(laid).map(|path| path.length()).sum()
}
