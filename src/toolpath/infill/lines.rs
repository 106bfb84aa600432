//! Parallel lines clipped to an area, and linked along its border where it is filled solidly.
//!
//! In the hatch's own frame lines run along u; line k lies at v = (k + phase) distance, counted from
//! the bed's origin, so that lines of different islands and layers meet.

use std::f64::consts::FRAC_1_SQRT_2;

use super::border::{Border, Piece};
use crate::polygon::{Contour, DVec2, Join, PolygonSet, dvec2};
use crate::region::Bead;
use crate::region::{Path, Role, Width};
use crate::sort::StableSort;

/// Sine of 60 degrees.
const SIN_60: f64 = 0.866_025_403_784_438_6;

/// A family of parallel lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hatch {
    /// Unit vector along the lines.
    direction: DVec2,
    /// Distance between neighbouring lines, mm.
    distance: f64,
    /// Offset of line 0 in distances.
    phase: f64,
}

/// Fitted lines stay this far inside, mm: ten steps of the polygons' grid.
const FIT_SLACK: f64 = 1e-3;

/// Fitted lines lie farther apart or closer together by at most this share.
const MOST_CHANGED: f64 = 0.2;

impl Hatch {
    /// Lines at 45 degrees on even layers, at 135 degrees on odd ones.
    pub fn diagonal(layer: u32, distance: f64) -> Hatch {
        let across = if layer.is_multiple_of(2) { FRAC_1_SQRT_2 } else { -FRAC_1_SQRT_2 };
        Hatch { direction: dvec2(across, FRAC_1_SQRT_2), distance, phase: 0.5 }
    }

    /// Three families at 60 degrees to each other, whose lines meet in single points: triangles.
    pub fn triangles(distance: f64) -> [Hatch; 3] {
        let family = |x: f64, y: f64| Hatch { direction: dvec2(x, y), distance, phase: 0.0 };
        [family(1.0, 0.0), family(0.5, SIN_60), family(-0.5, SIN_60)]
    }

    /// Lines along this unit vector.
    pub fn along(direction: DVec2, distance: f64) -> Hatch {
        Hatch { direction, distance, phase: 0.5 }
    }

    /// As many of these lines as the area holds across, spread evenly over it, so that no strip is left
    /// along its sides; `None` where lines would be moved too far apart or together for that.
    pub fn fitted(self, area: &PolygonSet) -> Option<Hatch> {
        let across = || area.contours().iter().flat_map(|c| &c.points).map(|&p| self.to_frame(p).y);
        // The outermost lines must not run along the border of where lines may run, but inside it.
        let (low, high) = (across().reduce(f64::min)? + FIT_SLACK, across().reduce(f64::max)? - FIT_SLACK);
        let distance = (high - low) / ((high - low) / self.distance).round().max(1.0);
        let change = (distance / self.distance - 1.0).abs();
        (change <= MOST_CHANGED).then(|| Hatch {
            distance,
            phase: (low / distance + 0.5).rem_euclid(1.0),
            ..self
        })
    }

    /// Distance between neighbouring lines, mm.
    pub fn distance(self) -> f64 {
        self.distance
    }

    fn to_frame(self, p: DVec2) -> DVec2 {
        dvec2(p.dot(self.direction), self.direction.perp_dot(p))
    }

    fn to_plane(self, p: DVec2) -> DVec2 {
        self.direction * p.x + self.direction.perp() * p.y
    }

    fn offset_of(self, line: i64) -> f64 {
        (line as f64 + self.phase) * self.distance
    }

    /// Lines whose offset lies in [low, high).
    fn lines_between(self, low: f64, high: f64) -> std::ops::Range<i64> {
        let first_at = |v: f64| (v / self.distance - self.phase).ceil() as i64;
        first_at(low)..first_at(high)
    }
}

/// Where a line of the hatch crosses the border.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    line: i64,
    /// Position along the line.
    u: f64,
    /// Which contour, and which of its edges.
    contour: usize,
    edge: usize,
    /// Sine of the angle between line and edge, in (0, 1].
    sine: f64,
}

/// The crossings of a hatch with an area, in the order in which they lie along the contours, and
/// how they hang together.
struct Weave {
    hatch: Hatch,
    crossings: Vec<Crossing>,
    /// The other end of each crossing's piece of line.
    partner: Vec<usize>,
    /// Neighbours along the contour.
    next: Vec<usize>,
    previous: Vec<usize>,
}

impl Weave {
    fn new(area: &PolygonSet, hatch: Hatch) -> Weave {
        let mut crossings = Vec::new();
        let (mut next, mut previous) = (Vec::new(), Vec::new());
        for (index, contour) in area.contours().iter().enumerate() {
            let first = crossings.len();
            cross_contour(&mut crossings, hatch, index, contour);
            let count = crossings.len() - first;
            next.extend((0..count).map(|i| first + (i + 1) % count));
            previous.extend((0..count).map(|i| first + (i + count - 1) % count));
        }
        let partner = pair_along_lines(&crossings);
        Weave { hatch, crossings, partner, next, previous }
    }

    /// Crossings in the order of lines, and along each line.
    fn in_line_order(&self) -> Vec<usize> {
        sorted_along_lines(&self.crossings)
    }

    fn point(&self, index: usize) -> DVec2 {
        let c = &self.crossings[index];
        self.hatch.to_plane(dvec2(c.u, self.hatch.offset_of(c.line)))
    }
}

fn cross_contour(crossings: &mut Vec<Crossing>, hatch: Hatch, contour: usize, ring: &Contour) {
    for (edge, (a, b)) in ring.edges().enumerate() {
        let (a, b) = (hatch.to_frame(a), hatch.to_frame(b));
        let sine = ((b.y - a.y) / a.distance(b)).abs();
        let at = |line: i64| {
            let u = a.x + (b.x - a.x) * ((hatch.offset_of(line) - a.y) / (b.y - a.y));
            Crossing { line, u, contour, edge, sine }
        };
        let lines = hatch.lines_between(a.y.min(b.y), a.y.max(b.y));
        if a.y < b.y {
            crossings.extend(lines.map(at));
        } else {
            crossings.extend(lines.rev().map(at));
        }
    }
}

fn sorted_along_lines(crossings: &[Crossing]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..crossings.len()).collect();
    order.stable_sort_by(|&a, &b| {
        let (a, b) = (&crossings[a], &crossings[b]);
        a.line.cmp(&b.line).then(a.u.total_cmp(&b.u))
    });
    order
}

/// Along each line crossings go in, out, in, out: each contour crosses it an even number of times.
fn pair_along_lines(crossings: &[Crossing]) -> Vec<usize> {
    let mut partner = vec![0; crossings.len()];
    for pair in sorted_along_lines(crossings).chunks_exact(2) {
        (partner[pair[0]], partner[pair[1]]) = (pair[1], pair[0]);
    }
    partner
}

/// The pieces of the hatch's lines inside the area, line by line.
pub(super) fn hatch(area: &PolygonSet, border: &Border<'_>, hatch: Hatch) -> Vec<Piece> {
    let weave = Weave::new(area, hatch);
    let end = |index: usize| {
        let Crossing { contour, edge, .. } = weave.crossings[index];
        let p = weave.point(index);
        (p, border.place(contour, edge, p))
    };
    let piece = |pair: &[usize]| {
        let [(a, start), (b, stop)] = [end(pair[0]), end(pair[1])];
        Piece { points: vec![a, b], ends: [start, stop] }
    };
    weave.in_line_order().chunks_exact(2).map(piece).collect()
}

/// A link along the border may be this many line distances long; it fills the strip along the border
/// doubly, and where that is slanted more, beads end in wedges.
const LONGEST_LINK: f64 = WEDGE_FROM;

/// Fills the area with lines that lie side by side, linked along the border to long beads. Returns
/// them and what of the area is too narrow for a bead.
///
/// The links run half a spacing inside the border; an end without a link is drawn out to the border,
/// or gets narrower along it where it is slanted. All ways the strip along the border is filled once.
pub fn hatch_linked(area: &PolygonSet, role: Role, bead: Bead, hatch: Hatch) -> (Vec<Path>, PolygonSet) {
    let half = bead.spacing() / 2.0;
    let core = area.offset(-half, Join::WALL);
    let narrow = narrow_places(area, &core.offset(half, Join::WALL), bead);
    let weave = Weave::new(&core, hatch);
    let narrow = narrow.union(&caps(area, &core, &weave, half));
    let mut laid = vec![false; weave.crossings.len()];
    let mut paths = Vec::new();
    for start in weave.in_line_order() {
        if !laid[start] {
            paths.push(lay_from(&weave, &core, bead, start, &mut laid).into_path(role));
        }
    }
    (paths, narrow)
}

/// Like [`hatch_linked`], but monotonic: a line is laid only when those beside it on its lower side
/// are, so that all lines lean on their neighbours the same way and the surface shines evenly. The
/// beads are to be printed in the given order and direction.
pub fn hatch_monotonic(area: &PolygonSet, role: Role, bead: Bead, hatch: Hatch) -> (Vec<Path>, PolygonSet) {
    let half = bead.spacing() / 2.0;
    let core = area.offset(-half, Join::WALL);
    let narrow = narrow_places(area, &core.offset(half, Join::WALL), bead);
    let weave = Weave::new(&core, hatch);
    let narrow = narrow.union(&caps(area, &core, &weave, half));
    let lines = Stack::of(&weave);
    let mut waiting: Vec<usize> = lines.below.clone();
    let mut free: Vec<usize> = (0..waiting.len()).filter(|&i| waiting[i] == 0).collect();
    let mut laid = vec![false; weave.crossings.len()];
    let mut paths: Vec<Path> = Vec::new();
    let mut here = DVec2::ZERO;
    while let Some((at, end)) = lines.nearest_end(&weave, &free, here) {
        let mut line = Line::from_end(&weave, &core, bead, end);
        let (mut at, mut end) = (at, end);
        loop {
            let piece = free.swap_remove(at);
            let out = weave.partner[end];
            (laid[end], laid[out]) = (true, true);
            for &next in &lines.above[piece] {
                waiting[next] -= 1;
                if waiting[next] == 0 {
                    free.push(next);
                }
            }
            let up = nearest_link(&weave, &core, out, &laid).and_then(|(to, link)| {
                let at = free.iter().position(|&f| f == lines.piece_of[to])?;
                Some((at, to, link))
            });
            let Some((next_at, to, link)) = up else {
                line.finish(&weave, &core, bead, out);
                break;
            };
            line.link(weave.point(out), link, weave.point(to));
            (at, end) = (next_at, to);
        }
        let path = line.into_path(role);
        here = path.points.last().copied().unwrap_or(here);
        paths.push(path);
    }
    (paths, narrow)
}

/// The pieces of a weave's lines and which lie side by side.
struct Stack {
    /// The two crossings of each piece, line by line.
    pieces: Vec<[usize; 2]>,
    /// The piece of each crossing.
    piece_of: Vec<usize>,
    /// How many pieces of the line below lie beside each piece.
    below: Vec<usize>,
    /// Those of the line above.
    above: Vec<Vec<usize>>,
}

impl Stack {
    fn of(weave: &Weave) -> Stack {
        let pieces: Vec<[usize; 2]> =
            weave.in_line_order().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        let mut piece_of = vec![0; weave.crossings.len()];
        for (i, piece) in pieces.iter().enumerate() {
            piece.iter().for_each(|&end| piece_of[end] = i);
        }
        let mut stack =
            Stack { below: vec![0; pieces.len()], above: vec![Vec::new(); pieces.len()], pieces, piece_of };
        stack.find_neighbours(weave);
        stack
    }

    /// Sweeps over each two lines that follow each other.
    fn find_neighbours(&mut self, weave: &Weave) {
        let line = |i: usize| weave.crossings[self.pieces[i][0]].line;
        let reach = |i: usize| self.pieces[i].map(|end| weave.crossings[end].u);
        let mut first = 0;
        for upper in 0..self.pieces.len() {
            // Pieces that end before this one begins end before all that follow it on its line.
            while line(first) + 1 < line(upper)
                || line(first) + 1 == line(upper) && reach(first)[1] < reach(upper)[0]
            {
                first += 1;
            }
            let beside =
                (first..upper).take_while(|&i| line(i) + 1 == line(upper) && reach(i)[0] <= reach(upper)[1]);
            for lower in beside.collect::<Vec<_>>() {
                self.above[lower].push(upper);
                self.below[upper] += 1;
            }
        }
    }

    /// Of the free pieces' ends the one nearest to `here`: place in `free`, crossing.
    fn nearest_end(&self, weave: &Weave, free: &[usize], here: DVec2) -> Option<(usize, usize)> {
        let ends = free.iter().enumerate().flat_map(|(at, &piece)| self.pieces[piece].map(|end| (at, end)));
        ends.map(|(at, end)| (weave.point(end).distance_squared(here), at, end))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)))
            .map(|(_, at, end)| (at, end))
    }
}

/// Area under which places too narrow for a bead are not worth a look, mm2.
const NO_NARROW_PLACES: f64 = 0.01;

/// What of `area` the beads do not reach, without slivers.
fn narrow_places(area: &PolygonSet, reached: &PolygonSet, bead: Bead) -> PolygonSet {
    if area.area() - reached.area() < NO_NARROW_PLACES {
        return PolygonSet::EMPTY;
    }
    area.difference(reached).opened(bead.width / 8.0, Join::WALL)
}

/// A cap is worth a bead of its own if it is at least this high and this wide, in line distances.
const LOWEST_CAP: f64 = 0.3;
const NARROWEST_CAP: f64 = 1.0;

/// What of `area` lies beyond lines that have no neighbour on one side: up to a line's distance from
/// the border that runs along them, where the area ends and beside its holes.
fn caps(area: &PolygonSet, core: &PolygonSet, weave: &Weave, half: f64) -> PolygonSet {
    let hatch = weave.hatch;
    let cap = |here: usize| {
        let there = weave.next[here];
        let (a, b) = (&weave.crossings[here], &weave.crossings[there]);
        let turns_back = a.line == b.line && here != there;
        let points = turns_back.then(|| border_between(weave, core, here, there, true))?;
        let level = hatch.offset_of(a.line);
        let heights = points.iter().map(|&p| hatch.to_frame(p).y - level);
        let top = heights.max_by(|p, q| p.abs().total_cmp(&q.abs()))?;
        // A piece of the line ends the area here, or the border bends away from the next line.
        let (bare, height) = if weave.partner[here] == there {
            (level, top)
        } else {
            (level + 2.0 * half * top.signum(), top - 2.0 * half * top.signum())
        };
        let (low, high) = (bare + half * height.signum(), bare + height + 2.0 * half * height.signum());
        let corners =
            [(a.u, low), (b.u, low), (b.u, high), (a.u, high)].map(|(u, v)| hatch.to_plane(dvec2(u, v)));
        let large =
            height.abs() >= LOWEST_CAP * 2.0 * half && (b.u - a.u).abs() >= NARROWEST_CAP * 2.0 * half;
        large.then(|| Contour::new(corners.to_vec()))
    };
    let boxes: Vec<Contour> = (0..weave.crossings.len()).filter_map(cap).collect();
    if boxes.is_empty() { PolygonSet::EMPTY } else { PolygonSet::from_contours(boxes).intersection(area) }
}

/// One bead: line, link, line, ... until no unlaid line is within reach of the end.
fn lay_from(weave: &Weave, core: &PolygonSet, bead: Bead, start: usize, laid: &mut [bool]) -> Line {
    let mut line = Line::from_end(weave, core, bead, start);
    let mut here = start;
    loop {
        let end = weave.partner[here];
        (laid[here], laid[end]) = (true, true);
        match nearest_link(weave, core, end, laid) {
            None => {
                line.finish(weave, core, bead, end);
                return line;
            }
            Some((to, link)) => {
                line.link(weave.point(end), link, weave.point(to));
                here = to;
            }
        }
    }
}

/// A bead in the making.
struct Line {
    points: Vec<DVec2>,
    /// One for each point, mm.
    widths: Vec<f64>,
    usual: f64,
}

impl Line {
    /// Begins at this end of a line.
    fn from_end(weave: &Weave, core: &PolygonSet, bead: Bead, end: usize) -> Line {
        let mut line = Line { points: Vec::new(), widths: Vec::new(), usual: bead.width };
        line.finish(weave, core, bead, end);
        line.points.reverse();
        line.widths.reverse();
        line
    }

    /// Goes over a link.
    fn link(&mut self, from: DVec2, between: Vec<DVec2>, to: DVec2) {
        self.points.push(from);
        self.points.extend(between);
        self.points.push(to);
        self.widths.resize(self.points.len(), self.usual);
    }

    /// Ends at this end of a line: drawn out, or along the wedge where the border is slanted.
    fn finish(&mut self, weave: &Weave, core: &PolygonSet, bead: Bead, end: usize) {
        let wedge = wedge(weave, core, bead, end);
        if wedge.is_empty() {
            self.points.push(drawn_out(weave, end, bead.spacing() / 2.0));
            self.widths.push(bead.width);
        } else {
            self.points.push(weave.point(end));
            self.widths.push(bead.width);
            self.points.extend(wedge.iter().map(|w| w.0));
            self.widths.extend(wedge.iter().map(|w| w.1));
        }
    }

    fn into_path(self, role: Role) -> Path {
        let is_uniform = self.widths.iter().all(|&w| w == self.usual);
        let width = if is_uniform { Width::Uniform(self.usual) } else { Width::Varying(self.widths) };
        Path { role, points: self.points, closed: false, width, hang: 0.0 }
    }
}

/// From this many line distances between the ends of neighbouring lines on, measured along the border,
/// the wedge between them is filled by a bead that gets narrower: at a slant of 30 degrees.
const WEDGE_FROM: f64 = 2.0;

/// The bead in a wedge gets as narrow as this share of its width: no nozzle does with much less.
const WEDGE_TO: f64 = 0.5;

/// Where the border is slanted to a line, a wedge stays open beyond the line's end: between the border
/// and the next line, which ends farther out. The way through its middle with the bead's widths, as far
/// as a bead fits.
///
/// With y how far the border of the core, s/2 inside that of the area, has moved from the line towards
/// the next one, and c the cosine of its slant, the wedge is s/2 + (s/2 - y) c thick.
fn wedge(weave: &Weave, core: &PolygonSet, bead: Bead, end: usize) -> Vec<(DVec2, f64)> {
    let Some((to, border)) = farther_neighbour(weave, core, end) else { return Vec::new() };
    let half = bead.spacing() / 2.0;
    let (hatch, start) = (weave.hatch, weave.point(end));
    let away = if weave.crossings[to].line > weave.crossings[end].line { -1.0 } else { 1.0 };
    let level = hatch.to_frame(start).y;
    let stops: Vec<DVec2> = border.into_iter().chain([weave.point(to)]).collect();
    let mut found = Vec::new();
    let (mut from, mut last) = (start, (start, bead.spacing()));
    for stop in stops {
        let along = (stop - from).normalize_or_zero();
        let turned = hatch.to_frame(along.perp());
        let outward = if turned.y * away < 0.0 { -along.perp() } else { along.perp() };
        let thickness = half + (half - (level - hatch.to_frame(stop).y) * away) * turned.y.abs();
        let at = stop + outward * (half - thickness / 2.0);
        let thinnest = WEDGE_TO * bead.width - bead.overlap();
        if thickness < thinnest {
            let share = (last.1 - thinnest) / (last.1 - thickness);
            found.push((last.0.lerp(at, share), WEDGE_TO * bead.width));
            return found;
        }
        found.push((at, thickness + bead.overlap()));
        (from, last) = (stop, (at, thickness));
    }
    found
}

/// The end of a neighbouring line that lies next along the border and farther out, if that is far, and
/// the border's vertices in between.
fn farther_neighbour(weave: &Weave, core: &PolygonSet, end: usize) -> Option<(usize, Vec<DVec2>)> {
    let (here, start) = (weave.crossings[end], weave.point(end));
    let outward = start - weave.point(weave.partner[end]);
    let ways = [(weave.next[end], true), (weave.previous[end], false)];
    let farther = ways.into_iter().find(|&(to, _)| {
        let beside = (weave.crossings[to].line - here.line).abs() == 1;
        let way = weave.point(to) - start;
        beside && way.dot(outward) > 0.0 && way.length() > WEDGE_FROM * weave.hatch.distance
    });
    farther.map(|(to, forward)| (to, border_between(weave, core, end, to, forward)))
}

/// The end of a line moved on to the border of the area, which lies `half` outside the core.
fn drawn_out(weave: &Weave, index: usize, half: f64) -> DVec2 {
    let reach = (half / weave.crossings[index].sine).min(2.0 * half);
    let (here, far) = (weave.point(index), weave.point(weave.partner[index]));
    here + (here - far).normalize_or_zero() * reach
}

/// The shorter way along the border from `end` to the end of an unlaid neighbouring line, with the
/// border's vertices in between.
fn nearest_link(weave: &Weave, core: &PolygonSet, end: usize, laid: &[bool]) -> Option<(usize, Vec<DVec2>)> {
    let ways = [(weave.next[end], true), (weave.previous[end], false)];
    let open = ways.into_iter().filter(|&(to, _)| !laid[to] && is_neighbour(weave, end, to));
    let links = open.map(|(to, forward)| (to, border_between(weave, core, end, to, forward)));
    let measured = links.map(|(to, link)| (link_length(weave, end, to, &link), to, link));
    let shortest = measured.min_by(|a, b| a.0.total_cmp(&b.0));
    shortest.filter(|l| l.0 <= LONGEST_LINK * weave.hatch.distance).map(|(_, to, link)| (to, link))
}

fn is_neighbour(weave: &Weave, a: usize, b: usize) -> bool {
    a != b && (weave.crossings[a].line - weave.crossings[b].line).abs() <= 1
}

fn link_length(weave: &Weave, from: usize, to: usize, between: &[DVec2]) -> f64 {
    let stops = std::iter::once(weave.point(from)).chain(between.iter().copied());
    let next = between.iter().copied().chain(std::iter::once(weave.point(to)));
    stops.zip(next).map(|(a, b)| a.distance(b)).sum()
}

/// Vertices of the border between two crossings that are neighbours along it; none where the way
/// would go round most of the contour.
fn border_between(weave: &Weave, core: &PolygonSet, from: usize, to: usize, forward: bool) -> Vec<DVec2> {
    let (a, b) = (&weave.crossings[from], &weave.crossings[to]);
    let points = &core.contours()[a.contour].points;
    let n = points.len();
    let (first, last) = if forward { (a.edge, b.edge) } else { (b.edge, a.edge) };
    let wraps = first == last && forward == (to < from);
    let count = if wraps { n } else { (last + n - first) % n };
    let mut between: Vec<DVec2> = (1..=count).map(|i| points[(first + i) % n]).collect();
    if !forward {
        between.reverse();
    }
    between
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAD: Bead = Bead { width: 0.45, height: 0.2 };

    fn plastic(paths: &[Path]) -> f64 {
        paths.iter().map(|p| p.area() - p.length() * BEAD.overlap()).sum()
    }

    #[test]
    fn a_solid_square_gets_its_area_in_plastic() {
        let square = PolygonSet::rectangle(dvec2(3.0, 1.0), dvec2(23.0, 21.0));
        for layer in 0..2 {
            let hatch = Hatch::diagonal(layer, BEAD.spacing());
            let (paths, narrow) = hatch_linked(&square, Role::SolidInfill, BEAD, hatch);
            // One corner of the odd layer lies beyond the last line.
            assert!(narrow.islands().len() <= layer as usize && narrow.area() < 0.18, "{narrow:?}");
            assert!((plastic(&paths) / 400.0 - 1.0).abs() < 0.005, "{}", plastic(&paths));
            assert!(paths.len() <= 3, "{} beads", paths.len());
        }
    }

    /// Lines along the sides of a hole leave a strip of up to a line's distance on each.
    #[test]
    fn strips_beside_a_hole_along_the_lines_are_told() {
        let block = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0));
        for tenth in 0..10 {
            let low = 6.0 + 0.1 * BEAD.spacing() * f64::from(tenth);
            let hole = PolygonSet::rectangle(dvec2(low, 7.0), dvec2(low + 5.5, 13.0));
            let area = block.difference(&hole);
            let hatch = Hatch::along(dvec2(0.0, 1.0), BEAD.spacing());
            let (paths, narrow) = hatch_linked(&area, Role::SolidInfill, BEAD, hatch);
            // Strips lower than LOWEST_CAP stay: on two sides of the hole and of the block.
            let least = LOWEST_CAP * BEAD.spacing() * (2.0 * 6.0 + 2.0 * 20.0);
            let open = area.area() - plastic(&paths) - narrow.area();
            assert!((-1.0..least).contains(&open), "{tenth}: {open} mm2");
            let (paths, narrow) = hatch_monotonic(&area, Role::TopSkin, BEAD, hatch);
            assert!((-1.0..least).contains(&(area.area() - plastic(&paths) - narrow.area())));
        }
    }

    #[test]
    fn fitted_lines_fill_a_strip_of_any_width_from_side_to_side() {
        for tenth in 0..30 {
            let width = 2.0 + 0.1 * BEAD.spacing() * f64::from(tenth);
            let strip = PolygonSet::rectangle(dvec2(3.0, 1.7), dvec2(43.0, 1.7 + width));
            let hatch = Hatch::along(DVec2::X, BEAD.spacing()).fitted(&strip).expect("little changed");
            let bead = Bead { width: BEAD.width + hatch.distance - BEAD.spacing(), ..BEAD };
            let (paths, narrow) = hatch_linked(&strip, Role::Bridge, bead, hatch);
            let filled: f64 = paths.iter().map(|p| p.length() * hatch.distance).sum();
            assert!((filled / strip.area() - 1.0).abs() < 0.02, "{width}: {filled}");
            assert!(narrow.is_empty());
        }
        // A strip of a line and a half is for other beads.
        let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(40.0, 1.45 * BEAD.spacing()));
        assert_eq!(Hatch::along(DVec2::X, BEAD.spacing()).fitted(&strip), None);
    }

    #[test]
    fn lines_stay_inside_and_their_distance_gives_the_density() {
        let square = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(40.0, 40.0));
        let pieces = hatch(&square, &Border::of(&square), Hatch::diagonal(0, 2.0));
        let ends = || pieces.iter().map(|p| (p.points[0], p.points[1]));
        let total: f64 = ends().map(|(a, b)| a.distance(b)).sum();
        assert!((total * 2.0 / 1600.0 - 1.0).abs() < 0.01);
        let grown = square.bounds().map(|b| b.grown(1e-6));
        for (a, b) in ends() {
            assert!((b - a).perp_dot(dvec2(1.0, 1.0)).abs() < 1e-6);
            let piece = crate::polygon::measure::Bounds::of_points(&[a, b]);
            assert!(grown.zip(piece).is_some_and(|(g, p)| g.contains(p)));
        }
    }

    #[test]
    fn monotonic_lines_never_go_back() {
        let ring = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 20.0))
            .difference(&PolygonSet::rectangle(dvec2(6.0, 7.0), dvec2(12.0, 13.0)));
        let hatch = Hatch::diagonal(0, BEAD.spacing());
        let (paths, _) = hatch_monotonic(&ring, Role::TopSkin, BEAD, hatch);
        assert!((plastic(&paths) / ring.area() - 1.0).abs() < 0.01);
        // Wherever two long segments lie side by side the lower one comes first.
        let ends = |p: &Path| {
            p.points.windows(2).map(|w| [w[0], w[1]].map(|q| hatch.to_frame(q))).collect::<Vec<_>>()
        };
        let lines: Vec<[DVec2; 2]> =
            paths.iter().flat_map(ends).filter(|[a, b]| (a.y - b.y).abs() < 1e-6).collect();
        for (i, a) in lines.iter().enumerate() {
            for b in &lines[..i] {
                let apart = a[0].y - b[0].y;
                let beside =
                    a[0].x.min(a[1].x) < b[0].x.max(b[1].x) && b[0].x.min(b[1].x) < a[0].x.max(a[1].x);
                assert!(
                    !beside || apart > -1.5 * BEAD.spacing() && apart > 0.0 || apart < -1.5 * BEAD.spacing()
                );
            }
        }
        assert!(paths.len() <= 6, "{} beads", paths.len());
    }

    #[test]
    fn a_strip_narrower_than_a_bead_is_handed_back() {
        let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 0.3));
        let (paths, narrow) = fill(&strip);
        assert!(paths.is_empty());
        assert!((narrow.area() - 3.0).abs() < 1e-3);
    }

    fn fill(area: &PolygonSet) -> (Vec<Path>, PolygonSet) {
        hatch_linked(area, Role::SolidInfill, BEAD, Hatch::diagonal(0, BEAD.spacing()))
    }
}
