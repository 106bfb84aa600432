//! Beads along the medial axis: strips, rings and junctions whose lengths and areas are known on
//! paper, and shapes on which triangulations like to fail.

use foothold::polygon::trig::sin_cos;
use foothold::polygon::{Contour, DVec2, PolygonSet, by_x_then_y, dvec2, snap};
use foothold::region::{Bead, Path, Role, Width};
use foothold::toolpath::infill::fill_solid;
use foothold::toolpath::medial::{ThinBeads, ThinFill, fill_thin};
use foothold::toolpath::walls::lay_walls;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn area(points: &[(f64, f64)]) -> PolygonSet {
    PolygonSet::from_contours(vec![Contour::new(points.iter().map(|&(x, y)| snap(dvec2(x, y))).collect())])
}

fn bar(a: (f64, f64), b: (f64, f64), width: f64) -> PolygonSet {
    let (a, b) = (dvec2(a.0, a.1), dvec2(b.0, b.1));
    let side = (b - a).normalize().perp() * width / 2.0;
    area(&[a - side, b - side, b + side, a + side].map(|p| (p.x, p.y)))
}

fn disc(radius: f64, corners: usize) -> PolygonSet {
    let corner = |i: usize| {
        let (sin, cos) = sin_cos(TAU * i as f64 / corners as f64);
        (radius * cos, radius * sin)
    };
    area(&(0..corners).map(corner).collect::<Vec<_>>())
}

/// What is extruded, as an area: lengths of the lines times their widths.
fn plastic(beads: &ThinBeads) -> f64 {
    beads.paths.iter().map(Path::area).sum()
}

/// What holds for any input: finite points, widths in range, canonical order, no fallback.
fn assert_sane(beads: &ThinBeads, options: &ThinFill) {
    assert_eq!(beads.fallbacks, []);
    assert!(beads.left_mm2 >= 0.0 && beads.left_mm2.is_finite());
    for path in &beads.paths {
        assert_eq!(path.role, options.role);
        assert!(path.points.len() >= if path.closed { 3 } else { 2 });
        assert!(path.points.iter().all(|p| p.is_finite() && snap(*p) == *p));
        let widths = (0..path.points.len()).map(|i| path.width.at(i));
        assert!(widths.into_iter().all(|w| (options.min_width..=options.max_width).contains(&w)));
        assert!(path.points.windows(2).all(|w| w[0] != w[1]));
        let first = path.points[0];
        let others = if path.closed { &path.points[1..] } else { &path.points[path.points.len() - 1..] };
        assert!(others.iter().all(|&p| by_x_then_y(first, p).is_lt()));
    }
    assert!(beads.paths.is_sorted_by(|a, b| by_x_then_y(a.points[0], b.points[0]).is_le()));
}

fn fill(area: &PolygonSet) -> ThinBeads {
    let options = ThinFill::default();
    let beads = fill_thin(area, &options);
    assert_sane(&beads, &options);
    beads
}

#[test]
fn a_strip_is_one_straight_bead_of_its_width() {
    for width in [0.2, 0.3, 0.45, 0.6, 0.9] {
        let beads = fill(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, width)));
        let [path] = &beads.paths[..] else { panic!("{width}: {} paths", beads.paths.len()) };
        let Width::Uniform(found) = path.width else { panic!("{width}: varying") };
        // Up to 2 % wider: the plastic for the ends, which the line does not reach.
        assert!((width - 2e-4..width * 1.02).contains(&found), "{found}");
        let inset = PI / 8.0 * width;
        assert_eq!(path.points, [snap(dvec2(inset, width / 2.0)), snap(dvec2(20.0 - inset, width / 2.0))]);
        assert_eq!(beads.left_mm2, 0.0);
    }
}

/// Its end is square, and the triangles there have corners of their own.
#[test]
fn a_strip_as_long_as_a_multiple_of_its_width_ends_like_any_other() {
    for length in [4.0, 4.1, 34.0] {
        let beads = fill(&area(&[(0.0, 0.0), (length, 0.0), (length, 0.4), (0.0, 0.4)]));
        assert_eq!(beads.paths.len(), 1);
        let inset = ThinFill::default().end_inset * 0.4;
        let points = &beads.paths[0].points;
        let ends = [points[0].x, length - points[points.len() - 1].x];
        assert!(ends.iter().all(|end| (end - inset).abs() < 0.02), "{length}: {ends:?}");
    }
}

#[test]
fn a_turned_strip_keeps_its_length_and_width() {
    for (x, y) in [(10.0, 7.0), (-3.0, 11.0), (12.0, 0.5)] {
        let beads = fill(&bar((0.0, 0.0), (x, y), 0.45));
        let [Path { width: Width::Uniform(width), .. }] = beads.paths[..] else {
            panic!("{:?}", beads.paths)
        };
        assert!((0.45 - 5e-4..0.45 * 1.03).contains(&width), "{width}");
        let expected = dvec2(x, y).length() - 0.45 * PI / 4.0;
        assert!((beads.paths[0].length() - expected).abs() < 2e-3);
    }
}

#[test]
fn the_end_inset_sets_where_lines_end() {
    let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 0.6));
    for end_inset in [0.0, 0.5, 1.0] {
        let beads = fill_thin(&strip, &ThinFill { end_inset, ..ThinFill::default() });
        assert!((beads.paths[0].length() - (10.0 - 2.0 * end_inset * 0.6)).abs() < 1e-3);
    }
}

#[test]
fn a_ring_is_one_closed_bead() {
    let beads = fill(&disc(5.225, 180).difference(&disc(4.775, 150)));
    let [path] = &beads.paths[..] else { panic!("{} paths", beads.paths.len()) };
    assert!(path.closed && matches!(path.width, Width::Uniform(w) if (w - 0.45).abs() < 0.01));
    assert!((path.length() - TAU * 5.0).abs() < 0.05);
    assert!(path.points.len() < 100, "{} points", path.points.len());
}

#[test]
fn a_frame_is_one_closed_bead() {
    let outer = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 6.0));
    let frame = outer.difference(&PolygonSet::rectangle(dvec2(0.6, 0.6), dvec2(9.4, 5.4)));
    let beads = fill(&frame);
    assert!(beads.paths.len() == 1 && beads.paths[0].closed);
    assert!((plastic(&beads) / frame.area() - 1.0).abs() < 0.01);
}

#[test]
fn a_wedge_varies_with_its_thickness() {
    // From 0.2 to 0.8 mm over 20 mm, so 0.2 + 0.03 x at x.
    let wedge = area(&[(0.0, -0.1), (20.0, -0.4), (20.0, 0.4), (0.0, 0.1)]);
    let beads = fill(&wedge);
    let [path] = &beads.paths[..] else { panic!("{} paths", beads.paths.len()) };
    for (i, p) in path.points.iter().enumerate() {
        assert!(p.y.abs() < 0.01);
        let inner = (0.8..19.2).contains(&p.x);
        assert!(!inner || (path.width.at(i) - (0.2 + 0.03 * p.x)).abs() < 0.02, "{p}: {}", path.width.at(i));
    }
    assert!((plastic(&beads) / wedge.area() - 1.0).abs() < 0.02);
}

#[test]
fn a_needle_ends_where_it_gets_too_thin() {
    // 0.08 x thick at x: 0.1 mm at x = 1.25.
    let beads = fill(&area(&[(0.0, 0.0), (10.0, -0.4), (10.0, 0.4)]));
    assert_eq!(beads.paths.len(), 1);
    assert!((beads.paths[0].points[0].x - 1.25).abs() < 0.05, "{}", beads.paths[0].points[0]);
    assert!((beads.left_mm2 - 1.25 * 0.1 / 2.0).abs() < 0.01, "{}", beads.left_mm2);
}

#[test]
fn at_a_t_the_bar_goes_through_and_the_stem_ends_at_it() {
    let bars = [bar((0.0, 0.0), (10.0, 0.0), 0.5), bar((5.0, 0.0), (5.0, -6.0), 0.5)];
    let shape = PolygonSet::union_all(&bars);
    let beads = fill(&shape);
    let [through, stem] = &beads.paths[..] else { panic!("{} paths", beads.paths.len()) };
    assert!((through.points[0].x - 0.196).abs() < 0.01);
    assert!((through.points[through.points.len() - 1].x - 9.804).abs() < 0.01);
    // The circle at the junction touches the bar's far side and both corners: radius 5/8 of the
    // width. So the stem ends 5/4 widths below the far side at y = 0.25.
    assert!(stem.points.iter().all(|p| (p.x - 5.0).abs() < 0.01));
    let top = stem.points.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    assert!((top - (0.25 - 0.625)).abs() < 0.01, "{top}");
    assert!((plastic(&beads) / shape.area() - 1.0).abs() < 0.02);
}

/// The bar of a 4: its short end beyond the stem is as wide as long.
#[test]
fn a_stub_beyond_a_crossing_keeps_a_bead() {
    let bars = [bar((0.0, -3.0), (0.0, 3.0), 0.55), bar((-3.0, 0.0), (0.65, 0.0), 0.55)];
    let beads = fill(&PolygonSet::union_all(&bars));
    let is_stub = |path: &&Path| path.points.iter().all(|p| p.x > 0.2 && p.y.abs() < 0.01);
    let stub = beads.paths.iter().find(is_stub).expect("a bead in the stub");
    let end = stub.points.iter().map(|p| p.x).fold(f64::MIN, f64::max);
    assert!((end - (0.65 - PI / 8.0 * 0.55)).abs() < 0.02, "{end}");
}

/// A 1 as on `bridge_test.stl`: its stem goes on to the top, and the flag ends at the stem.
#[test]
fn a_stroke_that_another_meets_below_its_end_goes_on_to_it() {
    let one = area(&[
        (-0.909, -0.576),
        (-0.676, -0.473),
        (-0.461, -0.343),
        (-0.264, -0.185),
        (-0.172, -0.095),
        (-0.172, -2.24),
        (0.399, -2.24),
        (0.399, 0.768),
        (-0.064, 0.768),
        (-0.134, 0.615),
        (-0.23, 0.474),
        (-0.353, 0.344),
        (-0.499, 0.226),
        (-0.642, 0.129),
        (-0.779, 0.054),
        (-0.909, 0.0),
    ]);
    let beads = fill(&one);
    // About 0.3 mm below the middle of the top, as wide as the place is there.
    assert!(beads.paths.iter().any(|path| path.is_near(dvec2(0.08, 0.48), 0.05)), "{beads:?}");
}

/// The arm of a 5: the bead keeps to the middle of the arc up to its ends.
#[test]
fn a_bent_stroke_ends_in_its_bend() {
    let arc = |radius: f64, i: usize| {
        let (sin, cos) = sin_cos(1.25 * PI * i as f64 / 40.0);
        (radius * cos, radius * sin)
    };
    let outer = (0..=40).map(|i| arc(1.0, i));
    let inner = (0..=40).rev().map(|i| arc(0.42, i));
    let shape = area(&outer.chain(inner).collect::<Vec<_>>());
    let beads = fill(&shape);
    let [path] = &beads.paths[..] else { panic!("{beads:?}") };
    for p in [path.points[0], path.points[path.points.len() - 1]] {
        assert!((p.length() - 0.71).abs() < 0.03, "{p} in {beads:?}");
    }
}

/// What is left between the tips of two walls: the bead runs between the horns on both sides of a tip.
#[test]
fn a_forked_end_is_filled_between_its_horns() {
    let shape = area(&[(0.0, 0.0), (3.0, 0.0), (2.9, 0.25), (3.0, 0.5), (0.0, 0.5)]);
    let beads = fill(&shape);
    let [path] = &beads.paths[..] else { panic!("{beads:?}") };
    for p in &path.points {
        assert!((p.y - 0.25).abs() < 0.03, "{beads:?}");
    }
}

/// A half disc: both ends of its line lie in corners, in which a bead as wide as its middle would stick out.
#[test]
fn a_bead_is_as_narrow_at_its_end_as_its_place() {
    let arc = |i: usize| {
        let (sin, cos) = sin_cos(PI * i as f64 / 24.0);
        (0.55 * cos, 0.5 * sin)
    };
    let shape = area(&(0..=24).map(arc).collect::<Vec<_>>());
    for path in &fill(&shape).paths {
        for end in [0, path.points.len() - 1] {
            let (at, radius) = (path.points[end], path.width.at(end) / 2.0);
            let sticks_out = shape.contours()[0].edges().map(|(a, b)| {
                let share = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                radius - at.distance(a.lerp(b, share))
            });
            let most = sticks_out.fold(f64::MIN, f64::max);
            assert!(most < 0.05, "{most} at {at}");
        }
    }
}

#[test]
fn at_a_crossing_one_line_goes_through() {
    let bars = [bar((0.0, 0.0), (8.0, 8.0), 0.5), bar((0.0, 8.0), (8.0, 0.0), 0.5)];
    let beads = fill(&PolygonSet::union_all(&bars));
    let mut lengths: Vec<f64> = beads.paths.iter().map(Path::length).collect();
    lengths.sort_by(f64::total_cmp);
    assert_eq!(lengths.len(), 3);
    let whole = 128.0_f64.sqrt();
    assert!((lengths[2] - whole).abs() < 0.5 && lengths[1] < whole / 2.0, "{lengths:?}");
}

#[test]
fn a_strip_too_wide_is_clamped_and_reported() {
    let beads = fill(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(20.0, 1.5)));
    assert_eq!(beads.paths.len(), 1);
    assert_eq!(beads.paths[0].width, Width::Uniform(0.9));
    assert!((beads.left_mm2 - 20.0 * 0.6).abs() < 0.6, "{}", beads.left_mm2);
}

#[test]
fn small_posts_stay_and_specks_go() {
    let post = |size: f64| fill(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(size, size)));
    assert_eq!(post(0.6).paths.len(), 1);
    // A dash with round ends covers the post.
    let dash = &post(0.6).paths[0];
    let covered = dash.area() + PI / 4.0 * dash.width.at(0).powi(2);
    assert!((covered / 0.36 - 1.0).abs() < 0.15, "{covered}");
    assert_eq!(post(0.3).paths, []);
    assert!(post(0.3).left_mm2 > 0.0);
    assert_eq!(fill(&PolygonSet::EMPTY), ThinBeads::default());
}

#[test]
fn corners_are_filled_by_turning_not_by_spurs() {
    let bent = PolygonSet::union_all(&[bar((0.0, 5.0), (0.0, 0.0), 0.5), bar((-0.25, 0.0), (4.0, 0.0), 0.5)]);
    assert_eq!(fill(&bent).paths.len(), 1);
}

#[test]
fn a_comb_has_a_bead_per_tooth() {
    let mut bars = vec![PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(100.0, 0.5))];
    bars.extend(
        (0..100).map(|i| PolygonSet::rectangle(dvec2(i as f64 + 0.2, 0.3), dvec2(i as f64 + 0.6, 4.0))),
    );
    let comb = PolygonSet::union_all(&bars);
    let beads = fill(&comb);
    // The outermost tooth and the bar's stub beyond it may make one line.
    assert!((100..=101).contains(&beads.paths.len()), "{}", beads.paths.len());
    assert!((plastic(&beads) / comb.area() - 1.0).abs() < 0.03);
}

#[test]
fn a_spiral_of_five_thousand_points_is_one_bead() {
    let side = |offset: f64, i: usize| {
        let angle = i as f64 * 0.02;
        let (sin, cos) = sin_cos(angle);
        ((1.0 + 0.2 * angle + offset) * cos, (1.0 + 0.2 * angle + offset) * sin)
    };
    let out = (0..2500).map(|i| side(0.25, i));
    let spiral = area(&out.chain((0..2500).rev().map(|i| side(-0.25, i))).collect::<Vec<_>>());
    let beads = fill(&spiral);
    assert_eq!(beads.paths.len(), 1);
    assert!((plastic(&beads) / spiral.area() - 1.0).abs() < 0.01);
}

#[test]
fn contours_that_touch_give_a_result() {
    let touching = [
        PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(5.0, 0.5)),
        PolygonSet::rectangle(dvec2(5.0, 0.5), dvec2(10.0, 1.0)),
        PolygonSet::rectangle(dvec2(2.0, 0.5), dvec2(2.4, 4.0)),
        PolygonSet::rectangle(dvec2(2.4, 4.0), dvec2(6.0, 4.4)),
    ];
    let shape = PolygonSet::union_all(&touching);
    assert!((plastic(&fill(&shape)) / shape.area() - 1.0).abs() < 0.05);
    let diamond = area(&[(0.5, 0.25), (5.0, 0.0), (9.5, 0.25), (5.0, 0.5)]);
    fill(&PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(10.0, 0.5)).difference(&diamond));
}

#[test]
fn a_needle_of_one_grid_step_is_no_fallback() {
    // Found by random bars: points added to the two sides of the needle and rounded made them cross.
    let found = [
        (11.6164, 6.2689),
        (13.8638, 2.4148),
        (13.9766, 1.1728),
        (14.1738, 1.1907),
        (14.0993, 2.0108),
        (14.816, 0.7819),
        (14.8161, 0.782),
        (14.0993, 2.0111),
        (13.8899, 4.318),
        (13.6926, 4.3001),
        (13.8637, 2.415),
    ];
    assert_eq!(fill(&area(&found)).paths.len(), 1);
}

#[test]
fn role_and_options_reach_the_paths() {
    let options = ThinFill { role: Role::OuterWall, max_width: 0.5, min_width: 0.4, ..ThinFill::default() };
    let strip = PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(5.0, 0.3));
    let beads = fill_thin(&strip, &options);
    assert_sane(&beads, &options);
    assert_eq!(beads.paths[0].width, Width::Uniform(0.4));
}

/// Bars of 0.2 to 0.8 mm at random places; where they cross, junctions of any kind.
fn bars() -> impl Strategy<Value = PolygonSet> {
    let one = (0.0..15.0, 0.0..15.0, -9.0..9.0, -9.0..9.0, 0.2..0.8);
    prop::collection::vec(one, 1..14).prop_map(|bars| {
        let far_enough = bars.iter().filter(|b| dvec2(b.2, b.3).length() > 1.0);
        let sets: Vec<_> = far_enough.map(|&(x, y, dx, dy, w)| bar((x, y), (x + dx, y + dy), w)).collect();
        PolygonSet::union_all(&sets)
    })
}

/// Any area, mostly far too thick: nothing is known but that it must end well.
fn wild() -> impl Strategy<Value = PolygonSet> {
    let grid = (-60_i32..60, -60_i32..60).prop_map(|(x, y)| dvec2(f64::from(x) / 20.0, f64::from(y) / 20.0));
    prop::collection::vec(grid, 3..60)
        .prop_map(|points| PolygonSet::from_contours(vec![Contour::new(points)]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_strips_are_filled(shape in bars()) {
        let options = ThinFill::default();
        let beads = fill_thin(&shape, &options);
        assert_sane(&beads, &options);
        // Crossings at flat angles leave wide places; the rest is filled, up to the round ends.
        let wanted = shape.area() - beads.left_mm2;
        let ends: f64 = beads.paths.iter().map(|p| PI / 4.0 * p.width.at(0).max(p.width.at(p.points.len() - 1)).powi(2)).sum();
        let found = plastic(&beads);
        prop_assert!(found <= 1.15 * wanted && found >= 0.85 * wanted - ends, "{found} of {wanted}");
        prop_assert_eq!(fill_thin(&shape, &options), beads);
    }

    #[test]
    fn any_area_gives_sane_beads(shape in wild()) {
        let options = ThinFill::default();
        assert_sane(&fill_thin(&shape, &options), &options);
    }

    #[test]
    fn walls_and_fills_of_any_area_have_widths_that_a_nozzle_lays(shape in wild(), layer in 0..2u32) {
        let bead = Bead { width: 0.45, height: 0.2 };
        let walls = lay_walls(&shape, bead, 3);
        let (filled, narrow) = fill_solid(&walls.inner, Role::SolidInfill, bead, layer);
        let thin = [&walls.thin_outer, &walls.thin_inner, &narrow];
        let nozzle = ThinFill::for_nozzle(0.4, Role::GapFill);
        let thin = thin.into_iter().flat_map(|area| fill_thin(area, &nozzle).paths);
        for path in walls.loops.into_iter().map(|(_, path)| path).chain(filled).chain(thin) {
            prop_assert!(path.points.len() >= 2 && path.points.iter().all(|p| p.is_finite()));
            let widths = (0..path.points.len()).map(|i| path.width.at(i));
            for width in widths {
                prop_assert!((0.2 - 1e-9..=0.8 + 1e-9).contains(&width), "{width} in {path:?}");
            }
        }
    }

    #[test]
    fn centre_lines_stay_inside(shape in bars()) {
        for path in fill_thin(&shape, &ThinFill::default()).paths {
            let middles = path.points.windows(2).map(|w: &[DVec2]| (w[0] + w[1]) / 2.0);
            prop_assert!(path.points.iter().copied().chain(middles).all(|p| shape.contains(p)));
        }
    }
}
