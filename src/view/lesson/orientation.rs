//! The choice of an orientation step by step [Karim]: six volumes, the matrix, the network, the choice.

use super::Step;
use crate::orientation::net::{DIRECTIONS, HIDDEN, Net, ScaledVolumes};
use crate::orientation::{DirectionFigures, OrientationReport};
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, PolygonSet, dvec2};
use crate::view::scene::{Anchor, Ink, Item, LineWidth, Scene};

/// Names of directions 1 to 6.
const AXES: [&str; DIRECTIONS] = ["+z", "−z", "+x", "−x", "+y", "−y"];

/// Width of a picture, in its own units; there are no millimetres here.
const WIDE: f64 = 120.0;

/// The steps for the six directions of a report; none when it lacks one or the network cannot take it.
pub fn orientation(report: &OrientationReport) -> Vec<Step> {
    let Some(six) = report.directions.first_chunk::<DIRECTIONS>() else { return Vec::new() };
    let Some(scaled) = ScaledVolumes::new(six.map(|f| f.total_mm3)) else { return Vec::new() };
    let chosen = (report.chosen as usize).saturating_sub(1).min(DIRECTIONS - 1);
    let mut items = vec![volumes(six, chosen), matrix(&scaled, chosen), network(&scaled, chosen)];
    items.push(choice(six, report));
    items
}

fn volumes(six: &[DirectionFigures; DIRECTIONS], chosen: usize) -> Step {
    /// Height of a row and of its bar.
    const ROW: f64 = 11.0;
    const BAR: f64 = 7.0;
    const LEFT: f64 = 12.0;
    const RIGHT: f64 = 30.0;
    let largest = six.iter().map(|f| f.total_mm3).fold(1e-9, f64::max);
    let mut items = Vec::new();
    for (i, figures) in six.iter().enumerate() {
        let y = -ROW * i as f64;
        let length = ((WIDE - LEFT - RIGHT) * figures.total_mm3 / largest).max(0.3);
        let ink = if i == chosen { Ink::Chosen } else { Ink::Share(tenths(figures.total_mm3 / largest)) };
        items.push(rectangle(dvec2(LEFT, y - BAR / 2.0), dvec2(length, BAR), ink));
        items.push(text(dvec2(LEFT / 2.0, y), AXES[i].to_owned()));
        items.push(text(dvec2(WIDE - RIGHT / 2.0, y), cubic(figures.total_mm3)));
    }
    let smallest = six.iter().map(|f| f.total_mm3).fold(f64::INFINITY, f64::min);
    let facts = [("smallest", smallest), ("largest", largest), ("chosen", chosen as f64 + 1.0)];
    Step::new("volumes", framed(items, dvec2(0.0, -5.5 * ROW), dvec2(WIDE, ROW / 2.0)), facts)
}

/// Table 1: row i is the volumes in rotation, its own first.
fn matrix(scaled: &ScaledVolumes, chosen: usize) -> Step {
    const CELL: f64 = 17.0;
    const LEFT: f64 = 14.0;
    let mut items = Vec::new();
    for (row, name) in AXES.into_iter().enumerate() {
        let y = -CELL * row as f64;
        items.push(text(dvec2(LEFT / 2.0, y), name.to_owned()));
        for (column, share) in scaled.row(row).into_iter().enumerate() {
            let corner = dvec2(LEFT + CELL * column as f64, y - CELL / 2.0);
            items.push(rectangle(corner, DVec2::splat(CELL - 0.6), Ink::Share(tenths(share))));
            items.push(text(corner + CELL / 2.0, format!("{share:.3}")));
        }
    }
    let y = -CELL * (chosen as f64 + 0.5);
    let frame = [(LEFT, y), (LEFT + 6.0 * CELL, y), (LEFT + 6.0 * CELL, y + CELL), (LEFT, y + CELL)];
    let points = frame.map(|(x, y)| dvec2(x, y)).to_vec();
    items.push(Item::Stroke { points, closed: true, width: LineWidth::Px(2.5), ink: Ink::Chosen });
    let low = dvec2(0.0, -5.5 * CELL);
    let facts = [("row", chosen as f64 + 1.0), ("own", scaled.row(chosen)[0])];
    Step::new("matrix", framed(items, low, dvec2(LEFT + 6.0 * CELL, CELL / 2.0)), facts)
}

/// The chosen direction's row on its way through the network: units that fire, and what they say.
fn network(scaled: &ScaledVolumes, chosen: usize) -> Step {
    const TALL: f64 = 96.0;
    let net = Net::stored();
    let row = scaled.row(chosen);
    let units = net.units(&row);
    let evidence = net.evidence(&row);
    let place = |x: f64, i: usize, of: usize| dvec2(x, -TALL * (i as f64 + 0.5) / of as f64);
    let strongest = units.iter().map(|u| (u.drive.max(0.0) * u.output).abs()).fold(1e-9, f64::max);
    let out = dvec2(WIDE - 22.0, -TALL / 2.0);
    let line = |a: DVec2, b: DVec2, ink, px: f64| Item::Stroke {
        points: vec![a, b],
        closed: false,
        width: LineWidth::Px(px),
        ink,
    };
    let mut items = Vec::new();
    for (i, unit) in units.iter().enumerate() {
        let hidden = place(WIDE / 2.0, i, HIDDEN);
        for (j, (weight, share)) in unit.weights.iter().zip(row).enumerate() {
            let carried = (weight * share).abs().min(4.0) / 4.0;
            if unit.drive > 0.0 && carried > 0.02 {
                let ink = if *weight > 0.0 { Ink::Chosen } else { Ink::Hanging };
                items.push(line(place(16.0, j, DIRECTIONS), hidden, ink, 2.0 * carried));
            }
        }
        let says = unit.drive.max(0.0) * unit.output;
        if says != 0.0 {
            let ink = if says > 0.0 { Ink::Chosen } else { Ink::Hanging };
            items.push(line(hidden, out, ink, 0.5 + 3.0 * says.abs() / strongest));
        }
        let ink = if unit.drive > 0.0 { Ink::Tip } else { Ink::Bed };
        items.push(Item::Dot { at: hidden, radius_px: 4.0, ink });
    }
    for (j, share) in row.into_iter().enumerate() {
        let at = place(16.0, j, DIRECTIONS);
        items.push(Item::Dot { at, radius_px: 6.0, ink: Ink::Vertex });
        items.push(text(at - dvec2(9.0, 0.0), format!("{share:.2}")));
    }
    items.push(Item::Dot {
        at: out,
        radius_px: 9.0,
        ink: if evidence > 0.0 { Ink::Chosen } else { Ink::Hanging },
    });
    items.push(text(out + dvec2(12.0, 0.0), format!("{evidence:+.2}")));
    let firing = units.iter().filter(|u| u.drive > 0.0).count();
    let facts = [
        ("row", chosen as f64 + 1.0),
        ("hidden", HIDDEN as f64),
        ("firing", firing as f64),
        ("evidence", evidence),
        ("minimum", f64::from(evidence > 0.0)),
    ];
    Step::new("network", framed(items, dvec2(0.0, -TALL), dvec2(WIDE, 0.0)), facts)
}

/// Rows: O_1 by the network, the exact minima, n structures, R and O_2.
fn choice(six: &[DirectionFigures; DIRECTIONS], report: &OrientationReport) -> Step {
    const ROW: f64 = 13.0;
    const LEFT: f64 = 26.0;
    let column = (WIDE - LEFT) / DIRECTIONS as f64;
    let cell = |i: usize, row: f64| dvec2(LEFT + column * (i as f64 + 0.5), -ROW * row);
    let mut items = Vec::new();
    let names = ["", "O₁", "min", "n", "R", "O₂"];
    let chosen = (report.chosen as usize).saturating_sub(1).min(DIRECTIONS - 1);
    let corner = dvec2(LEFT + column * chosen as f64, -5.5 * ROW);
    items.push(rectangle(corner, dvec2(column, 6.0 * ROW), Ink::Share(0)));
    for (row, name) in names.into_iter().enumerate().skip(1) {
        items.push(text(dvec2(LEFT / 2.0, -ROW * row as f64), name.to_owned()));
    }
    for i in 0..DIRECTIONS {
        let cells = [
            AXES[i].to_owned(),
            report.o1[i].to_string(),
            report.exact[i].to_string(),
            six[i].structures.to_string(),
            format!("{:.2}", report.r[i]),
            report.o2[i].to_string(),
        ];
        items.extend(cells.into_iter().enumerate().map(|(row, found)| text(cell(i, row as f64), found)));
    }
    let facts = [
        ("chosen", f64::from(report.chosen)),
        ("agree", f64::from(report.network_agrees())),
        ("structures", f64::from(six[chosen].structures)),
        ("volume", six[chosen].total_mm3),
    ];
    Step::new("choice", framed(items, dvec2(0.0, -5.5 * ROW), dvec2(WIDE, ROW / 2.0)), facts)
}

fn tenths(share: f64) -> u8 {
    (10.0 * share).round().clamp(0.0, 10.0) as u8
}

fn cubic(volume_mm3: f64) -> String {
    if volume_mm3 < 1000.0 { format!("{volume_mm3:.1}") } else { format!("{volume_mm3:.0}") }
}

fn rectangle(corner: DVec2, size: DVec2, ink: Ink) -> Item {
    Item::Area { area: PolygonSet::rectangle(corner, corner + size), ink }
}

fn text(at: DVec2, text: String) -> Item {
    Item::Label { at, text, anchor: Anchor::Middle }
}

fn framed(items: Vec<Item>, min: DVec2, max: DVec2) -> Scene {
    Scene { items, bounds: Bounds { min, max }.grown(2.0) }
}
