//! A thousand random first layers: the guarantees of docs/adhesion.md hold for teeth, and no kind
//! panics, leaves the bed or lays a number that is none. A tenth of them by default; all with FOOTHOLD_LONG=1.

#[path = "fixtures/adhesion/picture.rs"]
mod picture;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use foothold::adhesion::{AdhesionKind, BrimSide, Placement, compare, lay_foundation};
use foothold::polygon::{Contour, DVec2, Join, PolygonSet, dvec2};
use shapes::*;

const CASES: u64 = 1000;

/// Every ninth case: with every tenth, half of the eight families of shapes would never come.
const TENTH: usize = 9;

/// A fixed sequence for each case.
struct Dice(u64);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * ((self.0 >> 40) as f64 / (1u64 << 24) as f64)
    }

    fn up_to(&mut self, n: u32) -> u32 {
        (self.between(0.0, f64::from(n)) as u32).min(n - 1)
    }
}

#[test]
fn guarantees_hold_on_random_outlines() {
    assert_none_broken(broken_in);
}

#[test]
fn paths_are_sound_with_random_settings_and_supports() {
    assert_none_broken(broken_with_random_settings);
}

/// Runs the cases, or the one that FOOTHOLD_CASE names.
fn assert_none_broken(broken_in: fn(u64) -> Option<String>) {
    let step = if std::env::var("FOOTHOLD_LONG").is_ok_and(|v| v == "1") { 1 } else { TENTH };
    let only: Option<u64> = std::env::var("FOOTHOLD_CASE").ok().and_then(|v| v.parse().ok());
    let cases: Vec<u64> = only.map_or((0..CASES).step_by(step).collect(), |case| vec![case]);
    let told = |case| broken_in(case).map(|found| format!("case {case}: {found}"));
    let broken: Vec<String> = cases.into_iter().filter_map(told).collect();
    assert!(broken.is_empty(), "{} broken:\n{}", broken.len(), broken.join("\n"));
}

fn broken_with_random_settings(case: u64) -> Option<String> {
    let mut dice = dice_of(case + CASES);
    let outline = turned(&random_outline(&mut dice, case), dice.between(0.0, 6.3));
    let corner = dvec2(dice.between(60.0, 150.0), dice.between(60.0, 150.0));
    let grown = outline.offset(0.4, Join::WALL);
    let supports = rectangle(corner.x, corner.y, dice.between(1.0, 30.0), 1.5).difference(&grown);
    let mut settings = options(AdhesionKind::Teeth);
    let teeth = &mut settings.teeth;
    teeth.offset = dice.between(0.5, 6.0);
    teeth.height = teeth.offset + dice.between(0.05, 3.0);
    teeth.base = dice.between(0.3, 10.0);
    teeth.pitch = teeth.base + dice.between(0.05, 10.0);
    teeth.holes = case.is_multiple_of(2);
    teeth.tab = case.is_multiple_of(3);
    let mut first = first_layer(&outline, &supports);
    // A bed that cuts through the rail, and sometimes through the part.
    first.bed.max = dvec2(dice.between(120.0, 220.0), 220.0);
    let laid = lay_foundation(&first, &settings).expect("valid settings");
    let found = broken_path(&first, &settings, &laid);
    if found.is_some() || std::env::var("FOOTHOLD_CASE").is_ok() {
        picture::draw(&format!("random-settings-{case}"), &outline.union(&supports), &laid);
    }
    found
}

fn dice_of(case: u64) -> Dice {
    let mut dice = Dice(case.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
    (0..4).for_each(|_| {
        dice.up_to(2);
    });
    dice
}

fn broken_in(case: u64) -> Option<String> {
    let mut dice = dice_of(case);
    let outline = turned(&random_outline(&mut dice, case), dice.between(0.0, 6.3));
    let mut settings = options(AdhesionKind::Teeth);
    settings.teeth.holes = case.is_multiple_of(7);
    settings.teeth.rail_lines = 1 + u32::from(case.is_multiple_of(5));
    settings.brim.side = [BrimSide::Outer, BrimSide::Inner, BrimSide::Both][(case % 3) as usize];
    settings.brim.ears = case.is_multiple_of(4);
    let supports = PolygonSet::EMPTY;
    let first = first_layer(&outline, &supports);
    let laid = lay_foundation(&first, &settings).expect("valid settings");
    let found = broken_guarantee(&first, &settings, &laid);
    if found.is_some() {
        picture::draw(&format!("random-{case}"), &outline, &laid);
    }
    settings.teeth.placement = Placement::PerEdge;
    let kinds = compare(&first, &settings).expect("valid settings");
    let points = |f: &foothold::adhesion::Foundation| {
        let beads = f.layers.iter().flatten().chain(f.raft.iter().flat_map(|l| &l.paths));
        beads.flat_map(|p| p.points.clone()).collect::<Vec<DVec2>>()
    };
    let astray = kinds.iter().find_map(|a| {
        let out = points(&a.foundation).into_iter().find(|p| p.clamp(BED.min, BED.max) != *p)?;
        Some(format!("{:?} lays {out}", a.kind))
    });
    found.or(astray)
}

fn random_outline(dice: &mut Dice, case: u64) -> PolygonSet {
    let centre = dvec2(110.0, 110.0);
    match case % 8 {
        0 => {
            let outer = dice.between(8.0, 50.0);
            let inner = outer * dice.between(0.2, 0.9);
            star(centre, 3 + dice.up_to(22), outer, inner)
        }
        1 => {
            let (n, prong, gap) = (2 + dice.up_to(9), dice.between(0.5, 5.0), dice.between(0.5, 9.0));
            comb(75.0, 95.0, n, prong, gap, dice.between(3.0, 30.0))
        }
        2 => {
            let thickness = dice.between(0.5, 3.0);
            let step = thickness + dice.between(0.3, 8.0);
            spiral(centre, dice.between(0.7, 3.5), dice.between(2.0, 10.0), step, thickness)
        }
        3 => {
            let unit = dice.between(0.6, 5.0);
            let letters: Vec<PolygonSet> = (0..1 + dice.up_to(4))
                .map(|i| {
                    let which = ['A', 'B', 'C', 'E', 'H', 'O', 'S', 'T'][dice.up_to(8) as usize];
                    letter(which, 60.0 + f64::from(i) * unit * 5.7, 95.0, unit)
                })
                .collect();
            PolygonSet::union_all(&letters)
        }
        4 => {
            let outer = dice.between(3.0, 45.0);
            let n = 3 + dice.up_to(120);
            circle(centre, outer, n).difference(&circle(centre, outer * dice.between(0.3, 0.99), n))
        }
        5 => {
            let (w, h, gap) = (dice.between(3.0, 40.0), dice.between(3.0, 40.0), dice.between(0.1, 6.0));
            rectangle(70.0, 90.0, w, h).union(&circle(
                dvec2(70.0 + w + gap + 12.0, 90.0 + h / 2.0),
                12.0,
                8 + dice.up_to(90),
            ))
        }
        6 => blob(dice, centre),
        _ => {
            let boxes: Vec<PolygonSet> = (0..2 + dice.up_to(7))
                .map(|_| {
                    let corner = dvec2(dice.between(80.0, 130.0), dice.between(80.0, 130.0));
                    rectangle(corner.x, corner.y, dice.between(0.6, 30.0), dice.between(0.6, 30.0))
                })
                .collect();
            PolygonSet::union_all(&boxes)
        }
    }
}

/// A ring of random radii: sharp, uneven corners.
fn blob(dice: &mut Dice, centre: DVec2) -> PolygonSet {
    let n = 5 + dice.up_to(60);
    let at = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        polar(centre, dice.between(10.0, 45.0), angle)
    };
    ring_of((0..n).map(at).collect())
}

fn turned(set: &PolygonSet, angle: f64) -> PolygonSet {
    let centre = dvec2(110.0, 110.0);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let turn = |&p: &DVec2| centre + dvec2(cos, sin).rotate(p - centre);
    PolygonSet::from_contours(
        set.contours().iter().map(|c| Contour::new(c.points.iter().map(turn).collect())).collect(),
    )
}
