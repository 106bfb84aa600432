//! Sparse infill: density, staying inside, nothing laid twice, for every pattern.
#![cfg(not(target_arch = "wasm32"))]

use foothold::polygon::{Contour, DVec2, PolygonSet, dvec2};
use foothold::region::{Bead, Path};
use foothold::toolpath::infill::{InfillLayer, InfillOptions, InfillPattern, fill_sparse, true_lines};
use proptest::prelude::*;

const BEAD: Bead = Bead { width: 0.45, height: 0.2 };

const PATTERNS: [InfillPattern; 6] = [
    InfillPattern::Grid,
    InfillPattern::Lines,
    InfillPattern::Triangles,
    InfillPattern::Gyroid,
    InfillPattern::Honeycomb,
    InfillPattern::Concentric,
];

fn square(side: f64) -> PolygonSet {
    PolygonSet::rectangle(dvec2(40.0, 40.0), dvec2(40.0 + side, 40.0 + side))
}

/// Plastic of the lines as a share of the area, on the mean over places of a square on the bed and over
/// heights that make up a period of a gyroid; at each place the lines are laid for it.
fn density_found(side: f64, options: &InfillOptions) -> f64 {
    // An odd number of heights: the curves are longest at each quarter of a period.
    let (places, heights) = (5u32, 15u32);
    let at_place = |k: u32| {
        let share = f64::from(k) / f64::from(places);
        let area = square(side).translated(dvec2(23.0 * share, 31.0 * (share * 3.0).fract()));
        let lines = true_lines(&vec![area.clone(); 5], BEAD, options);
        let period = 2.456 * BEAD.spacing() / lines.density;
        let fill = |index: u32| {
            let z = period * f64::from(index) / f64::from(heights);
            fill_sparse(&area, BEAD, InfillLayer { index, z }, &lines)
        };
        (0..heights).flat_map(fill).map(|p| p.length()).sum::<f64>()
    };
    let length: f64 = (0..places).map(at_place).sum();
    length * BEAD.spacing() / (side * side * f64::from(places * heights))
}

#[test]
fn density_is_true_on_squares() {
    let mut wrong = Vec::new();
    for (side, percents) in [(100.0, vec![5, 10, 15, 20, 40, 60]), (40.0, vec![5, 10, 15, 20, 40, 60])] {
        for pattern in PATTERNS {
            for &percent in &percents {
                let density = f64::from(percent) / 100.0;
                let options = InfillOptions { density, pattern, ..InfillOptions::default() };
                let found = density_found(side, &options);
                if (found / density - 1.0).abs() > 0.03 {
                    wrong.push(format!("{pattern:?} {percent} % in {side} mm: {:.2} %", 100.0 * found));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_lines_of_a_square_hang_together() {
    for pattern in PATTERNS {
        let options = InfillOptions { pattern, ..InfillOptions::default() };
        let layer = InfillLayer { index: 0, z: 0.2 };
        let count = |anchor_max: f64| {
            let options = InfillOptions { anchor_max, ..options.clone() };
            fill_sparse(&square(50.0), BEAD, layer, &options).len()
        };
        let (joined, single) = (count(20.0), count(0.0));
        // Loops are joined already.
        assert!(
            pattern == InfillPattern::Concentric || joined * 5 <= single,
            "{pattern:?}: {joined}, {single}"
        );
    }
}

fn shapes() -> impl Strategy<Value = PolygonSet> {
    let boxes = prop::collection::vec((0.0..40.0f64, 0.0..40.0f64, 1.0..25.0f64, 1.0..25.0f64), 1..6);
    let star = prop::collection::vec(4.0..20.0f64, 5..16).prop_map(|radii| {
        let n = radii.len() as f64;
        let point = |(i, r): (usize, &f64)| {
            let (sin, cos) = foothold::polygon::trig::sin_cos(std::f64::consts::TAU * i as f64 / n);
            dvec2(20.0 + r * cos, 20.0 + r * sin)
        };
        PolygonSet::from_contours(vec![Contour::new(radii.iter().enumerate().map(point).collect())])
    });
    let holes = prop::collection::vec((0.0..40.0f64, 0.0..40.0f64, 0.5..6.0f64, 0.5..6.0f64), 0..4);
    let unite = |list: Vec<(f64, f64, f64, f64)>| {
        let rectangle =
            |&(x, y, w, h): &(f64, f64, f64, f64)| PolygonSet::rectangle(dvec2(x, y), dvec2(x + w, y + h));
        PolygonSet::union_all(&list.iter().map(rectangle).collect::<Vec<_>>())
    };
    let outer = prop_oneof![boxes.prop_map(unite), star];
    (outer, holes.prop_map(unite)).prop_map(|(outer, holes)| outer.difference(&holes))
}

/// Points along a path, every `step` mm.
fn samples(path: &Path, step: f64) -> Vec<DVec2> {
    let between = |w: &[DVec2]| {
        let count = (w[0].distance(w[1]) / step).ceil().max(1.0) as usize;
        let (a, b) = (w[0], w[1]);
        (0..=count).map(move |i| a.lerp(b, i as f64 / count as f64)).collect::<Vec<_>>()
    };
    path.points.windows(2).flat_map(between).collect()
}

/// How far corners of offset outlines may wander where they are snapped to the grid of 1e-4 mm and meet at
/// small angles, mm.
const SNAP: f64 = 0.005;

/// How far a point lies inside an area's border; negative outside.
fn depth(area: &PolygonSet, p: DVec2) -> f64 {
    let edges = area.contours().iter().flat_map(|c| c.edges());
    let distance = |(a, b): (DVec2, DVec2)| {
        let share = (p - a).dot(b - a) / (b - a).length_squared();
        p.distance(a.lerp(b, share.clamp(0.0, 1.0)))
    };
    let least = edges.map(distance).fold(f64::INFINITY, f64::min);
    if area.contains(p) { least } else { -least }
}

/// As many cases as `PROPTEST_CASES` says, or a tenth of the heavy set.
fn cases() -> ProptestConfig {
    let long = std::env::var_os("FOOTHOLD_LONG").is_some();
    let of_environment = std::env::var_os("PROPTEST_CASES").is_some();
    let usual = ProptestConfig::default();
    if of_environment { usual } else { ProptestConfig { cases: if long { 1000 } else { 100 }, ..usual } }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn lines_stay_inside_their_area_and_overlap(
        area in shapes(), pattern in 0..6usize, density in 0.05..0.7f64, z in 0.0..20.0f64, index in 0..9u32,
    ) {
        let options = InfillOptions { density, pattern: PATTERNS[pattern], ..InfillOptions::default() };
        let paths = fill_sparse(&area, BEAD, InfillLayer { index, z }, &options);
        let least = BEAD.width / 2.0 - options.overlap * BEAD.width;
        for p in paths.iter().flat_map(|p| samples(p, 0.5)) {
            let depth = depth(&area, p);
            prop_assert!(depth > least - SNAP, "{p} lies {depth} mm inside, not {least}");
        }
    }

    #[test]
    fn no_line_is_laid_twice(area in shapes(), pattern in 1..6usize, density in 0.05..0.4f64, z in 0.0..20.0f64) {
        let options = InfillOptions { density, pattern: PATTERNS[pattern], ..InfillOptions::default() };
        let paths = fill_sparse(&area, BEAD, InfillLayer { index: 0, z }, &options);
        let mut edges: Vec<(i64, i64, i64, i64)> = Vec::new();
        let edges_laid = paths.iter().flat_map(|p| p.points.windows(2));
        // Shorter ones are alike by rounding alone.
        for w in edges_laid.filter(|w| w[0].distance(w[1]) > SNAP) {
            let [a, b] = [w[0], w[1]].map(|p| ((p.x * 1e3).round() as i64, (p.y * 1e3).round() as i64));
            if a != b {
                edges.push((a.min(b).0, a.min(b).1, a.max(b).0, a.max(b).1));
            }
        }
        let count = edges.len();
        edges.sort_unstable();
        edges.dedup();
        prop_assert_eq!(edges.len(), count);
    }
}
