//! Which way bridges run, read back from the G-code: along the span, whose direction follows from where the
//! mesh's own sections hold it.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/area.rs"]
mod area;
mod common;

use area::{Area, difference, holds, offset, opened, section, size};
use common::{Print, prism, together};
use foothold::mesh::Mesh;
use foothold::mesh::stl::write_binary;
use foothold::region::Role;
use glam::{DVec2, dvec2};

const BARE: [&str; 2] = ["adhesion.kind=none", "first_layer.elephant_foot=0"];

/// Smaller pieces over air are no bridges worth a look, mm2.
const SMALLEST: f64 = 10.0;

/// Shorter pieces of beads are links over what holds the bridge, mm.
const LINK: f64 = 2.0;

/// How far lines may be turned from the span, degrees.
const MOST_TURN: f64 = 3.0;

/// A piece of a layer with nothing below, held at two places.
struct Span {
    piece: Area,
    /// From the middle of the one to that of the other.
    along: DVec2,
}

/// Points along a ring, at most 0.1 mm apart.
fn walk(ring: &[[f64; 2]]) -> Vec<DVec2> {
    let between = |i: usize| {
        let (a, b) = (DVec2::from(ring[i]), DVec2::from(ring[(i + 1) % ring.len()]));
        let count = (a.distance(b) / 0.1).ceil().max(1.0) as usize;
        (0..count).map(move |k| a.lerp(b, k as f64 / count as f64))
    };
    (0..ring.len()).flat_map(between).collect()
}

/// Stretches of a ring on the ground, each by its two ends.
fn anchors(ring: &[[f64; 2]], ground: &Area) -> Vec<[DVec2; 2]> {
    let mut points: Vec<(DVec2, bool)> = walk(ring).into_iter().map(|p| (p, holds(ground, p))).collect();
    let Some(free) = points.iter().position(|p| !p.1) else { return Vec::new() };
    points.rotate_left(free);
    let stretches = points.chunk_by(|a, b| a.1 == b.1).filter(|stretch| stretch[0].1);
    let ends = stretches.map(|stretch| [stretch[0].0, stretch[stretch.len() - 1].0]);
    ends.filter(|[a, b]| a.distance(*b) > 0.5).collect()
}

/// What of each layer hangs in the air between two anchors, and how many anchors other pieces have.
fn spans(print: &Print, layer: usize) -> (Vec<Span>, Vec<usize>) {
    let [here, below] = [layer, layer - 1].map(|k| section(&print.mesh, print.specs[k].slice_z));
    let ground = offset(&below, 0.05);
    let (mut spans, mut others) = (Vec::new(), Vec::new());
    for island in opened(&difference(&here, &below), 0.4) {
        let held = anchors(&island[0], &ground);
        let piece = vec![island];
        if size(&piece) < SMALLEST {
            continue;
        }
        match held[..] {
            [a, b] => spans.push(Span { piece, along: ((b[0] + b[1]) - (a[0] + a[1])).normalize() }),
            _ => others.push(held.len()),
        }
    }
    (spans, others)
}

/// Long pieces of bridge beads whose middle lies in the area, as their ends.
fn lines_in(print: &Print, layer: usize, area: &Area) -> Vec<[DVec2; 2]> {
    let strands = print.file.layers[layer].strands.iter().filter(|s| s.role == Some(Role::Bridge));
    let pieces = strands.flat_map(|s| s.points.windows(2)).map(|w| [w[0], w[1]]);
    pieces.filter(|[a, b]| a.distance(*b) > LINK && holds(area, a.midpoint(*b))).collect()
}

/// Checks every span of the print; returns their directions in degrees by layer.
fn check(name: &str, print: &Print) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    for layer in 1..print.specs.len() {
        for span in spans(print, layer).0 {
            let lines = lines_in(print, layer, &span.piece);
            let degrees = span.along.to_angle().to_degrees().rem_euclid(180.0);
            assert!(!lines.is_empty(), "{name}, layer {layer}: nothing spans at {degrees} degrees");
            for [a, b] in lines {
                let turn = ((b - a).normalize().perp_dot(span.along)).abs().asin().to_degrees();
                let at = format!("{name}, layer {layer}: {a} to {b}");
                assert!(turn < MOST_TURN, "{at} is {turn} degrees off the span at {degrees}");
            }
            found.push((layer, degrees));
        }
    }
    found
}

#[test]
fn bridges_of_a_real_model_run_along_their_spans() {
    let Some(folder) = common::models_dir() else { return };
    let print = common::print(&std::fs::read(folder.join("bridge_test.stl")).expect("the model"), &BARE);
    let found = check("bridge_test.stl", &print);
    // Ten beams, one every ten layers, each turned by 20 degrees from the one below.
    let layers: Vec<usize> = found.iter().map(|f| f.0).collect();
    assert_eq!(layers, (0..10).map(|k| 5 + 10 * k).collect::<Vec<_>>());
    for (k, (layer, degrees)) in found.into_iter().enumerate() {
        let turn = (degrees - 20.0 * k as f64 + 90.0).rem_euclid(180.0) - 90.0;
        assert!(turn.abs() < MOST_TURN, "layer {layer}: {degrees}");
    }
}

/// A bar between two corners, turned by some degrees.
fn bar(corners: [(f64, f64); 2], heights: [f64; 2], degrees: f64) -> Mesh {
    let [(x0, y0), (x1, y1)] = corners;
    let turn = DVec2::from_angle(degrees.to_radians());
    let outline = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| turn.rotate(dvec2(x, y)));
    prism(&outline, &[], heights[0], heights[1])
}

fn printed(parts: &[Mesh]) -> Print {
    common::print(&write_binary(&together(parts)), &BARE)
}

/// Where decks begin, in layers.
const DECK: usize = 15;

#[test]
fn a_beam_turned_by_any_angle_is_spanned_from_pillar_to_pillar() {
    for degrees in [0.0, 17.0, 30.0, 45.0, 73.0, 90.0, 121.0, 158.0] {
        let print = printed(&[
            bar([(0.0, 0.0), (5.0, 8.0)], [0.0, 4.0], degrees),
            bar([(25.0, 0.0), (30.0, 8.0)], [0.0, 4.0], degrees),
            bar([(1.0, 0.5), (29.0, 7.5)], [3.0, 4.0], degrees),
        ]);
        let found = check("beam", &print);
        assert_eq!(found.len(), 1, "{degrees}");
        let (layer, along) = found[0];
        let turn = (along - degrees + 90.0).rem_euclid(180.0) - 90.0;
        assert!(layer == DECK && turn.abs() < 0.5, "{degrees}: layer {layer}, {along}");
    }
}

#[test]
fn both_arms_of_an_angle_over_three_pillars_run_along_themselves() {
    let pillar = |x: f64, y: f64| bar([(x, y), (x + 6.0, y + 6.0)], [0.0, 4.0], 25.0);
    let print = printed(&[
        pillar(0.0, 0.0),
        pillar(24.0, 0.0),
        pillar(0.0, 24.0),
        bar([(1.0, 0.5), (29.0, 5.5)], [3.0, 4.0], 25.0),
        bar([(0.5, 1.0), (5.5, 29.0)], [3.0, 4.0], 25.0),
    ]);
    let mut found = check("angle", &print);
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    assert_eq!(found.len(), 2);
    for ((layer, along), expected) in found.into_iter().zip([25.0, 115.0]) {
        assert!(layer == DECK && (along - expected).abs() < 0.5, "layer {layer}: {along}");
    }
}

#[test]
fn what_is_held_at_one_side_only_is_no_bridge() {
    let print = printed(&[
        bar([(0.0, 0.0), (10.0, 8.0)], [0.0, 4.0], 35.0),
        bar([(1.0, 0.5), (18.0, 7.5)], [3.0, 4.0], 35.0),
    ]);
    let (spans, others) = spans(&print, DECK);
    assert!(spans.is_empty());
    assert_eq!(others, [1]);
    let everything = section(&print.mesh, print.specs[DECK].slice_z);
    assert!(lines_in(&print, DECK, &everything).is_empty());
}
