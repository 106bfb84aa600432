//! `polygon` on random shapes: laws of sets, canonical form, and areas against `i_overlay`, a second
//! library with its own arithmetic.
#![cfg(not(target_arch = "wasm32"))]

use foothold::polygon::simplify::squared_distance_to_segment;
use foothold::polygon::trig::{sin_cos, tan};
use foothold::polygon::{Contour, DVec2, GRID_MM, Join, PolygonSet, by_x_then_y, dvec2, snap};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};
use proptest::prelude::*;

/// How far areas may be off: crossings move to the grid, so each edge sweeps up to a grid step along
/// its length, and slivers below 1e-6 mm2 are dropped.
fn allowance(sets: &[&PolygonSet]) -> f64 {
    let length: f64 = sets.iter().map(|s| s.length()).sum();
    let edges: usize = sets.iter().map(|s| s.vertex_count()).sum();
    2.0 * GRID_MM * length + 1e-6 * edges as f64
}

fn star(centre: DVec2, radii: &[f64]) -> Contour {
    let n = radii.len() as f64;
    let point = |(i, r): (usize, &f64)| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * i as f64 / n);
        snap(centre + dvec2(cos, sin) * *r)
    };
    Contour::new(radii.iter().enumerate().map(point).collect())
}

fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Contour {
    let corners = [dvec2(x, y), dvec2(x + w, y), dvec2(x + w, y + h), dvec2(x, y + h)];
    Contour::new(corners.map(snap).to_vec())
}

/// A bar with teeth, as one contour.
fn comb(at: DVec2, teeth: &[(f64, f64)]) -> Contour {
    let mut points = vec![at, at + dvec2(teeth.len() as f64 * 2.0, 0.0)];
    for (i, &(height, width)) in teeth.iter().enumerate().rev() {
        let x = i as f64 * 2.0;
        points.extend(
            [(x + width, 1.0), (x + width, height), (x, height), (x, 1.0)].map(|(x, y)| at + dvec2(x, y)),
        );
    }
    points.dedup();
    Contour::new(points.into_iter().map(snap).collect())
}

fn centres() -> impl Strategy<Value = DVec2> {
    (-4.0..4.0, -4.0..4.0).prop_map(|(x, y)| dvec2(x, y))
}

fn contours() -> impl Strategy<Value = Vec<Contour>> {
    let stars = (centres(), prop::collection::vec(0.5..8.0, 3..24)).prop_map(|(c, r)| vec![star(c, &r)]);
    let combs =
        (centres(), prop::collection::vec((1.5..6.0, 0.05..1.9), 1..9)).prop_map(|(c, t)| vec![comb(c, &t)]);
    let box_ = (-8.0..8.0, -8.0..8.0, 0.01..8.0, 0.01..8.0).prop_map(|(x, y, w, h)| rectangle(x, y, w, h));
    prop_oneof![stars, combs, prop::collection::vec(box_, 1..9)]
}

fn sets() -> impl Strategy<Value = PolygonSet> {
    contours().prop_map(PolygonSet::from_contours)
}

/// Contours start at their smallest point, are sorted, and no point repeats; islands run
/// counter-clockwise, holes clockwise, and together they are the set.
fn assert_canonical(set: &PolygonSet) -> Result<(), TestCaseError> {
    for contour in set.contours() {
        prop_assert!(contour.points.len() >= 3);
        prop_assert!(contour.points.iter().all(|&p| snap(p) == p), "off the grid");
        prop_assert!(contour.points[1..].iter().all(|&p| by_x_then_y(contour.points[0], p).is_le()));
        prop_assert!(contour.edges().all(|(a, b)| a != b));
    }
    let starts: Vec<DVec2> = set.contours().iter().map(|c| c.points[0]).collect();
    prop_assert!(starts.is_sorted_by(|&a, &b| by_x_then_y(a, b).is_le()));
    let islands = set.islands();
    prop_assert!(islands.iter().all(|i| i.outer.signed_area() > 0.0));
    prop_assert!(islands.iter().flat_map(|i| &i.holes).all(|h| h.signed_area() < 0.0));
    prop_assert_eq!(islands.iter().map(|i| 1 + i.holes.len()).sum::<usize>(), set.contours().len());
    prop_assert!((islands.iter().map(|i| i.area()).sum::<f64>() - set.area()).abs() < 1e-9);
    Ok(())
}

fn assert_near(found: f64, expected: f64, allowed: f64) -> Result<(), TestCaseError> {
    prop_assert!((found - expected).abs() <= allowed, "{found} is not {expected} +- {allowed}");
    Ok(())
}

type TwinShapes = Vec<Vec<[f64; 2]>>;

fn twin(set: &PolygonSet) -> TwinShapes {
    set.contours().iter().map(|c| c.points.iter().map(|p| [p.x, p.y]).collect()).collect()
}

fn twin_area(shapes: &[TwinShapes]) -> f64 {
    let area = |c: &Vec<[f64; 2]>| Contour::new(c.iter().map(|p| dvec2(p[0], p[1])).collect()).signed_area();
    shapes.iter().flatten().map(area).sum::<f64>().abs()
}

fn distance_to_outline(set: &PolygonSet, p: DVec2) -> f64 {
    let edges = set.contours().iter().flat_map(Contour::edges);
    edges.map(|(a, b)| squared_distance_to_segment(p, a, b)).fold(f64::INFINITY, f64::min).sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn union_and_intersection_share_out_the_areas(a in sets(), b in sets()) {
        let (union, both) = (a.union(&b), a.intersection(&b));
        assert_near(union.area() + both.area(), a.area() + b.area(), allowance(&[&a, &b, &union, &both]))?;
        let (only_a, only_b) = (a.difference(&b), b.difference(&a));
        assert_near(only_a.area() + both.area(), a.area(), allowance(&[&a, &b]))?;
        let one = a.symmetric_difference(&b);
        assert_near(one.area(), only_a.area() + only_b.area(), allowance(&[&a, &b, &one]))?;
        for set in [&union, &both, &only_a, &one] {
            assert_canonical(set)?;
        }
    }

    #[test]
    fn the_parts_of_a_cut_lie_inside_and_do_not_overlap(a in sets(), b in sets()) {
        let (only_a, both) = (a.difference(&b), a.intersection(&b));
        let allowed = allowance(&[&a, &b]);
        assert_near(only_a.intersection(&b).area(), 0.0, allowed)?;
        assert_near(both.difference(&b).area(), 0.0, allowed)?;
        assert_near(only_a.union(&both).area(), a.area(), allowed)?;
        assert_near(a.difference(&a.union(&b)).area(), 0.0, allowed)?;
    }

    #[test]
    fn union_is_idempotent_and_blind_to_order(mut loops in prop::collection::vec(contours(), 1..4)) {
        let loops: Vec<Contour> = loops.drain(..).flatten().collect();
        let once = PolygonSet::from_contours(loops.clone());
        prop_assert_eq!(&PolygonSet::from_contours(once.contours().to_vec()), &once);
        prop_assert_eq!(&PolygonSet::union_all([&once, &once]), &once);
        let turned = loops.iter().rev().map(Contour::reversed).collect();
        let other = PolygonSet::from_contours(turned);
        assert_near(once.symmetric_difference(&other).area(), 0.0, allowance(&[&once]))?;
    }

    #[test]
    fn areas_agree_with_the_twin(a in sets(), b in sets()) {
        let pairs = [
            (a.union(&b), OverlayRule::Union),
            (a.intersection(&b), OverlayRule::Intersect),
            (a.difference(&b), OverlayRule::Difference),
            (a.symmetric_difference(&b), OverlayRule::Xor),
        ];
        for (ours, rule) in pairs {
            let theirs = twin(&a).overlay(&twin(&b), rule, FillRule::NonZero);
            assert_near(ours.area(), twin_area(&theirs), allowance(&[&a, &b]))?;
        }
    }

    #[test]
    fn growing_contains_and_keeps_its_distance(a in sets(), distance in 0.01..1.0) {
        let grown = a.offset(distance, Join::WALL);
        assert_canonical(&grown)?;
        prop_assert!(grown.area() >= a.area());
        assert_near(a.difference(&grown).area(), 0.0, allowance(&[&a]))?;
        for &p in grown.contours().iter().flat_map(|c| &c.points) {
            let found = distance_to_outline(&a, p);
            // A mitre reaches at most twice the distance; a corner that is cut off lies nearer to it.
            prop_assert!(found >= distance - 2.0 * GRID_MM, "{p} is {found} from the outline");
            prop_assert!(found <= 2.0 * distance + 2.0 * GRID_MM, "{p} is {found} from the outline");
        }
    }

    #[test]
    fn shrinking_stays_inside_at_its_distance(a in sets(), distance in 0.01_f64..0.5) {
        let inner = a.offset(-distance, Join::WALL);
        assert_canonical(&inner)?;
        assert_near(inner.difference(&a).area(), 0.0, allowance(&[&a]))?;
        for &p in inner.contours().iter().flat_map(|c| &c.points) {
            prop_assert!(distance_to_outline(&a, p) >= distance - 2.0 * GRID_MM);
        }
    }

    /// With round joins closing would never take anything. A mitre cuts up to twice the distance
    /// into a sharp notch whose bottom was filled on the way out, so up to one distance into the area.
    #[test]
    fn closing_takes_at_most_the_excess_of_a_mitre(a in sets(), radius in 0.01..0.5) {
        let lost = a.difference(&a.closed(radius, Join::WALL));
        for &p in lost.contours().iter().flat_map(|c| &c.points) {
            prop_assert!(distance_to_outline(&a, p) <= radius + 3.0 * GRID_MM);
        }
    }

    #[test]
    fn mitred_convex_shapes_have_the_area_from_paper(
        jitter in prop::collection::vec(-0.3..0.3, 5..14),
        distance in 0.05..1.0,
    ) {
        // Corners on a circle, none turning by more than 120 degrees, so that no mitre is cut:
        // the grown area is A + P d + d^2 sum tan(turn / 2).
        let n = jitter.len() as f64;
        let corner = |(i, j): (usize, &f64)| {
            let (sin, cos) = sin_cos(std::f64::consts::TAU * (i as f64 + j) / n);
            snap(dvec2(cos, sin) * 6.0)
        };
        let corners: Vec<DVec2> = jitter.iter().enumerate().map(corner).collect();
        let a = PolygonSet::from_contours(vec![Contour::new(corners.clone())]);
        let m = corners.len();
        let turns = (0..m).map(|i| {
            let (u, v) = (corners[(i + 1) % m] - corners[i], corners[(i + 2) % m] - corners[(i + 1) % m]);
            foothold::polygon::trig::atan2(u.perp_dot(v), u.dot(v))
        });
        let corner_sum: f64 = turns.map(|turn| tan(turn / 2.0)).sum();
        let expected = a.area() + a.length() * distance + distance * distance * corner_sum;
        let ours = a.offset(distance, Join::WALL);
        assert_near(ours.area(), expected, allowance(&[&ours]))?;
        let style = OutlineStyle::new(distance).line_join(LineJoin::Miter(0.1)).miter_min_turn(0.0);
        assert_near(ours.area(), twin_area(&twin(&a).outline(&style)), 1e-3 * ours.area())?;
        // Shrinking by the same undoes it.
        assert_near(ours.offset(-distance, Join::WALL).symmetric_difference(&a).area(), 0.0, 4.0 * allowance(&[&ours]))?;
    }

    #[test]
    fn simplified_outlines_stay_within_the_tolerance(a in sets(), tolerance in 0.001..0.2) {
        let simple = a.simplified(tolerance);
        assert_canonical(&simple)?;
        prop_assert!(simple.vertex_count() <= 2 * a.vertex_count());
        let margin = tolerance + 2.0 * GRID_MM;
        for &p in simple.contours().iter().flat_map(|c| &c.points) {
            prop_assert!(distance_to_outline(&a, p) <= margin);
        }
        assert_near(simple.symmetric_difference(&a).area(), 0.0, a.length() * margin)?;
    }

    #[test]
    fn clipped_lines_and_their_rest_make_the_line(a in sets(), y in -5.0..5.0) {
        let line = vec![vec![snap(dvec2(-20.0, y)), snap(dvec2(20.0, y))]];
        let frame = PolygonSet::rectangle(dvec2(-30.0, -30.0), dvec2(30.0, 30.0));
        let length = |lines: Vec<Vec<DVec2>>| -> f64 {
            lines.iter().flat_map(|l| l.windows(2)).map(|w| w[0].distance(w[1])).sum()
        };
        let (inside, outside) = (length(a.clip_lines(&line)), length(frame.difference(&a).clip_lines(&line)));
        assert_near(inside + outside, 40.0, 1e-3 * a.vertex_count() as f64)?;
    }
}

#[test]
fn islands_keep_their_own_holes() {
    let square = |x: f64, r: f64| PolygonSet::rectangle(dvec2(x - r, -r), dvec2(x + r, r));
    // A frame with a frame inside, and a plain square beside.
    let nested = square(0.0, 10.0)
        .difference(&square(0.0, 8.0))
        .union(&square(0.0, 6.0).difference(&square(0.0, 4.0)));
    let islands = nested.union(&square(20.0, 3.0)).islands();
    let found: Vec<(f64, usize)> = islands.iter().map(|i| (i.area(), i.holes.len())).collect();
    assert_eq!(found, [(400.0 - 256.0, 1), (144.0 - 64.0, 1), (36.0, 0)]);
    assert!(PolygonSet::EMPTY.islands().is_empty());
}

#[test]
fn a_hole_that_touches_the_outline_in_a_point_stays_a_hole_or_becomes_a_notch() {
    let diamond =
        Contour::new([(0.0, -5.0), (3.0, 0.0), (0.0, 3.0), (-3.0, 0.0)].map(|(x, y)| dvec2(x, y)).to_vec());
    let diamond = PolygonSet::from_contours(vec![diamond]);
    let cut = PolygonSet::rectangle(dvec2(-5.0, -5.0), dvec2(5.0, 5.0)).difference(&diamond);
    let islands = cut.islands();
    // The diamond's diagonals are 6 and 8: area 24.
    assert!((islands.iter().map(|i| i.area()).sum::<f64>() - 76.0).abs() < 1e-9);
    assert_eq!(islands.len(), 1);
}

#[test]
fn squares_that_share_a_corner_are_two_islands_or_one() {
    let a = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(1.0, 1.0));
    let b = PolygonSet::rectangle(dvec2(1.0, 1.0), dvec2(2.0, 2.0));
    let islands = a.union(&b).islands();
    assert!((1..=2).contains(&islands.len()));
    assert_eq!(islands.iter().map(|i| i.area()).sum::<f64>(), 2.0);
}
