//! Which beads hang together, what they stand on, and what is dropped.

use super::frame::Frame;
use super::plates::Plate;
use super::spans::{self, Span};
use crate::sets::Sets;
use crate::slice::Axis;
use crate::sort::StableSort;

/// Pieces that are nowhere longer than this, mm, are dropped unless something rests on them.
const SHORT_MM: f64 = 1.0;

/// A plate without a crossing one buckles when it is taller than this many times its thickness.
pub(super) const SLENDER: f64 = 20.0;

/// What became of the pieces.
#[derive(Debug, Default)]
pub(super) struct Sorted {
    /// Pieces that are left.
    pub(super) pieces: usize,
    /// Pieces dropped because they are short or stand on nothing.
    pub(super) dropped: usize,
    /// Tall pieces of one plate alone.
    pub(super) towers: Vec<Tower>,
}

/// A tall piece of one plate, which nothing keeps from buckling.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tower {
    pub(super) plate: usize,
    pub(super) top: usize,
    /// Its bead in the topmost layer.
    pub(super) span: Span,
}

/// A bead among all.
#[derive(Clone, Copy)]
struct Node {
    plate: u32,
    line: u32,
    layer: u32,
    span: Span,
}

/// Drops what is short or stands on nothing, and counts the rest.
pub(super) fn sort_out(frame: &Frame, plates: &mut [Plate]) -> Sorted {
    let nodes = nodes_of(plates);
    let first_of = connect(frame, plates, &nodes);
    let mut pieces = vec![Piece::default(); nodes.len()];
    for (i, node) in nodes.iter().enumerate() {
        pieces[first_of[i]].add(frame, &plates[node.plate as usize], node);
    }
    let keeps = |p: &Piece| p.stands && (p.length + frame.width >= SHORT_MM || p.is_added);
    for (i, node) in nodes.iter().enumerate() {
        if !keeps(&pieces[first_of[i]]) {
            let line = &mut plates[node.plate as usize].lines[node.line as usize];
            line.beads[node.layer as usize].retain(|s| *s != node.span);
        }
    }
    let roots = (0..nodes.len()).filter(|&i| first_of[i] == i).map(|i| &pieces[i]);
    let mut sorted = Sorted::default();
    for piece in roots {
        if !keeps(piece) {
            sorted.dropped += 1;
            continue;
        }
        sorted.pieces += 1;
        let thickness = plates.first().map_or(0.0, |p| p.lines.len() as f64 * frame.width);
        if let (false, Some(tower)) = (piece.is_crossed, piece.top)
            && frame.layers[tower.top].print_z - piece.bottom > SLENDER * thickness
        {
            sorted.towers.push(tower);
        }
    }
    sorted
}

/// A bead on the bed and the piece it belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct BedBead {
    pub(super) axis: Axis,
    /// Place of its plate, mm.
    pub(super) at: f64,
    pub(super) span: Span,
    pub(super) piece: usize,
}

/// The beads of the lowest layer, piece by number.
pub(super) fn on_bed(frame: &Frame, plates: &[Plate]) -> Vec<BedBead> {
    let nodes = nodes_of(plates);
    let first_of = connect(frame, plates, &nodes);
    let on_bed = nodes.iter().zip(&first_of).filter(|(node, _)| node.layer == 0);
    let bead = |(node, &piece): (&Node, &usize)| {
        let plate = &plates[node.plate as usize];
        BedBead { axis: plate.axis, at: plate.at, span: node.span, piece }
    };
    on_bed.map(bead).collect()
}

/// What is known of a piece.
#[derive(Clone, Default)]
struct Piece {
    stands: bool,
    /// Longest bead, mm.
    length: f64,
    is_added: bool,
    is_crossed: bool,
    plate: Option<u32>,
    bottom: f64,
    top: Option<Tower>,
}

impl Piece {
    /// Adds a bead; they come layer by layer from the bed up within a plate.
    fn add(&mut self, frame: &Frame, plate: &Plate, node: &Node) {
        let layer = node.layer as usize;
        let spec = &frame.layers[layer];
        self.length = self.length.max(node.span[1] - node.span[0]);
        self.is_added |= plate.is_added;
        self.is_crossed |= self.plate.is_some_and(|p| p != node.plate);
        if self.plate.is_none() {
            self.bottom = spec.print_z - spec.height;
        }
        self.plate = Some(node.plate);
        if self.top.is_none_or(|t| t.top <= layer) {
            self.top = Some(Tower { plate: node.plate as usize, top: layer, span: node.span });
        }
        self.stands = self.stands || layer == 0 || rests_on_part(frame, plate, layer, node.span);
    }
}

/// Whether the part lies below the bead, no deeper than the sideways gap to a slope of 45 degrees
/// lets it start above the landing.
fn rests_on_part(frame: &Frame, plate: &Plate, layer: usize, span: Span) -> bool {
    let depth = ((frame.clearance + frame.width / 2.0) / frame.layers[layer].height).ceil() as usize;
    (layer.saturating_sub(depth)..=layer).any(|k| {
        k > 0
            && plate.air[k] != plate.air[k - 1]
            && plate.landing(k).iter().any(|&l| spans::meet(l, span, 0.0))
    })
}

fn nodes_of(plates: &[Plate]) -> Vec<Node> {
    let mut nodes = Vec::new();
    for (p, plate) in plates.iter().enumerate() {
        for (l, line) in plate.lines.iter().enumerate() {
            for (k, beads) in line.beads.iter().enumerate() {
                let node = |&span: &Span| Node { plate: p as u32, line: l as u32, layer: k as u32, span };
                nodes.extend(beads.iter().map(node));
            }
        }
    }
    nodes
}

/// For each node the first one of its piece.
fn connect(frame: &Frame, plates: &[Plate], nodes: &[Node]) -> Vec<usize> {
    let mut sets = Sets::new(nodes.len());
    let first = first_nodes(plates);
    let id = |plate: usize, line: usize, layer: usize, place: usize| first[plate][line][layer] + place;
    for (p, plate) in plates.iter().enumerate() {
        for (l, line) in plate.lines.iter().enumerate() {
            for (k, beads) in line.beads.iter().enumerate() {
                for (i, &span) in beads.iter().enumerate() {
                    let above = line.beads.get(k + 1).map_or(&[][..], Vec::as_slice);
                    join_met(&mut sets, id(p, l, k, i), span, above, id(p, l, k, 0) + beads.len());
                    if let Some(beside) = plate.lines.get(l + 1) {
                        join_met(&mut sets, id(p, l, k, i), span, &beside.beads[k], id(p, l + 1, k, 0));
                    }
                }
            }
        }
    }
    for k in 0..frame.layers.len() {
        each_crossing(frame, plates, k, |[p, l, i], [q, m, j]| {
            sets.join(id(p, l, k, i), id(q, m, k, j));
        });
    }
    sets.roots()
}

/// The number of the first bead of each plate, line and layer.
fn first_nodes(plates: &[Plate]) -> Vec<Vec<Vec<usize>>> {
    let mut next = 0;
    let mut number = |beads: &Vec<Span>| {
        let first = next;
        next += beads.len();
        first
    };
    let mut of_plate = |plate: &Plate| -> Vec<Vec<usize>> {
        plate.lines.iter().map(|line| line.beads.iter().map(&mut number).collect()).collect()
    };
    plates.iter().map(&mut of_plate).collect()
}

/// Calls with (plate, line, bead) of both beads wherever two plates cross or touch in layer `k`.
fn each_crossing(frame: &Frame, plates: &[Plate], k: usize, mut visit: impl FnMut([usize; 3], [usize; 3])) {
    let of_axis = |axis: Axis| -> Vec<(f64, usize, usize)> {
        let lines =
            plates.iter().enumerate().filter(move |(_, p)| p.axis == axis).flat_map(move |(p, plate)| {
                plate
                    .lines
                    .iter()
                    .enumerate()
                    .filter(move |(_, l)| !l.beads[k].is_empty())
                    .map(move |(l, line)| (line.at, p, l))
            });
        let mut lines: Vec<_> = lines.collect();
        lines.stable_sort_by(|a, b| a.0.total_cmp(&b.0));
        lines
    };
    let (along_y, along_x) = (of_axis(Axis::X), of_axis(Axis::Y));
    for &(x, p, l) in &along_y {
        for (i, &span) in plates[p].lines[l].beads[k].iter().enumerate() {
            let first = along_x.partition_point(|line| line.0 < span[0] - frame.width);
            for &(_, q, m) in along_x[first..].iter().take_while(|line| line.0 < span[1] + frame.width) {
                let others = plates[q].lines[m].beads[k].iter().enumerate();
                for (j, _) in others.filter(|(_, other)| spans::meet(**other, [x, x], frame.width)) {
                    visit([p, l, i], [q, m, j]);
                }
            }
        }
    }
}

fn join_met(sets: &mut Sets, node: usize, span: Span, others: &[Span], first: usize) {
    for (other, id) in others.iter().zip(first..) {
        if spans::meet(span, *other, 0.0) {
            sets.join(node, id);
        }
    }
}
