//! One vertical plane: the slabs against the paper's figure and against booleans.

mod common;

use std::collections::BTreeMap;

use common::models_dir;
use foothold::polygon::{Contour, DVec2, PolygonSet, dvec2};
use foothold::slice::{Axis, slice_loops, slice_mesh};
use foothold::support::plane::{Column, Demand, Edge, PlaneSection, region};
use foothold::support::points::{Foot, PointType, s_points};

/// The slow twin at angle 0: what lies below the area down to the bed, and not in it.
fn twin(area: &PolygonSet) -> PolygonSet {
    let downward = area.contours().iter().flat_map(Contour::edges).filter(|(a, b)| b.x > a.x);
    let shadow = |(a, b): (DVec2, DVec2)| Contour::new(vec![dvec2(a.x, 0.0), dvec2(b.x, 0.0), b, a]);
    PolygonSet::from_contours(downward.map(shadow).collect()).difference(area)
}

fn area_of(columns: &[Column]) -> f64 {
    columns.iter().map(Column::area).sum()
}

/// Fails when the two differ by more than rounding to the polygon grid can explain.
fn assert_equal(columns: &[Column], twin: &PolygonSet, what: &str) {
    let rounding = 2e-4 * (twin.length() + 1.0);
    let (fast, slow) = (area_of(columns), twin.area());
    assert!((fast - slow).abs() <= rounding, "{what}: {fast} by slabs, {slow} by booleans");
    let apart = region(columns).symmetric_difference(twin).area();
    assert!(apart <= 2.0 * rounding, "{what}: {apart} mm2 apart");
}

struct Figure {
    contours: Vec<Contour>,
    letters: BTreeMap<String, DVec2>,
    points: Vec<(String, PointType, Foot)>,
    regions: Vec<Vec<String>>,
}

fn figure() -> Figure {
    let text = include_str!("fixtures/support/figure5.txt");
    let mut figure = Figure { contours: vec![], letters: BTreeMap::new(), points: vec![], regions: vec![] };
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let place = |at: usize| dvec2(words[at].parse().expect("u"), words[at + 1].parse().expect("z"));
        match words[0] {
            "contour" => {
                let corners = (1..words.len()).step_by(3).map(|i| (words[i].to_owned(), place(i + 1)));
                let corners: Vec<(String, DVec2)> = corners.collect();
                figure.contours.push(Contour::new(corners.iter().map(|c| c.1).collect()));
                figure.letters.extend(corners);
            }
            "point" => {
                let kind = if words[2] == "A" { PointType::A } else { PointType::B };
                let foot = if words[3] == "io" { Foot::Io(place(5)) } else { Foot::G(place(5)) };
                figure.points.push((words[1].to_owned(), kind, foot));
                figure.letters.insert(words[4].to_owned(), place(5));
            }
            _ => figure.regions.push(words[1..].iter().map(|w| (*w).to_owned()).collect()),
        }
    }
    figure
}

#[test]
fn figure_5_has_the_points_types_and_feet_of_the_paper() {
    let figure = figure();
    let area = PolygonSet::from_contours(figure.contours.clone());
    let found = s_points(&area);
    assert_eq!(found.len(), figure.points.len());
    for (letter, kind, foot) in &figure.points {
        let at = figure.letters[letter];
        let point = found.iter().find(|s| s.at == at).unwrap_or_else(|| panic!("{letter} is missing"));
        assert_eq!((point.kind, point.foot), (*kind, *foot), "{letter}");
    }
}

#[test]
fn figure_5_has_the_two_regions_of_the_paper() {
    let figure = figure();
    let area = PolygonSet::from_contours(figure.contours.clone());
    let columns = PlaneSection::of_area(&area).columns(Demand::PAPER);
    let outline = |letters: &Vec<String>| Contour::new(letters.iter().map(|l| figure.letters[l]).collect());
    let mut expected: Vec<Contour> = figure.regions.iter().map(outline).collect();
    // The contour of G H J lies whole inside region 1.
    expected.push(figure.contours[2].reversed());
    assert_eq!(region(&columns), PolygonSet::from_contours(expected));
    let islands = region(&columns).islands();
    assert_eq!(islands.iter().map(|i| i.holes.len()).collect::<Vec<_>>(), [0, 1]);
    assert_equal(&columns, &twin(&area), "figure 5");
}

/// Numbers in [0, 1) from a seed (Marsaglia's xorshift64*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A star around a point above the bed; on whole mm every other time, so that borders meet.
    fn shape(&mut self) -> PolygonSet {
        let centre = dvec2(self.within(-30.0, 30.0), self.within(5.0, 50.0));
        let (corners, size) = (3 + (self.next() * 9.0) as usize, self.within(2.0, 20.0));
        let is_whole = self.next() < 0.5;
        let corner = |i: usize, random: &mut Random| {
            let (sin, cos) =
                foothold::polygon::trig::sin_cos(std::f64::consts::TAU * i as f64 / corners as f64);
            let p = centre + dvec2(cos, sin) * size * random.within(0.2, 1.0);
            let p = dvec2(p.x, p.y.max(0.0));
            if is_whole { p.round() } else { p }
        };
        let points = (0..corners).map(|i| corner(i, self)).collect();
        PolygonSet::from_contours(vec![Contour::new(points)])
    }

    fn section(&mut self) -> PolygonSet {
        let (solids, holes) = (1 + (self.next() * 6.0) as usize, (self.next() * 4.0) as usize);
        let solid = (0..solids).fold(PolygonSet::EMPTY, |area, _| area.union(&self.shape()));
        (0..holes).fold(solid, |area, _| area.difference(&self.shape()))
    }
}

#[test]
fn slabs_and_booleans_agree_on_random_contours() {
    let step = if std::env::var_os("FOOTHOLD_LONG").is_some() { 1 } else { 10 };
    for seed in (1..=1000u64).step_by(step) {
        let area = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)).section();
        let columns = PlaneSection::of_area(&area).columns(Demand::PAPER);
        assert_equal(&columns, &twin(&area), &format!("seed {seed}"));
    }
}

#[test]
fn slabs_and_booleans_agree_on_every_plane_of_real_models() {
    let Some(dir) = models_dir() else { return };
    let mut planes = 0;
    for name in ["support_test", "overhang", "own_arch_ascii", "own_hinge", "bridge_test"] {
        let bytes = std::fs::read(dir.join(name).with_extension("stl")).expect("the model is there");
        let mut mesh = foothold::mesh::load(&bytes).expect("the model is sound").mesh;
        let bounds = mesh.bounds().expect("the model is not empty");
        mesh.vertices.iter_mut().for_each(|v| *v -= bounds.min);
        let size = bounds.max - bounds.min;
        for (axis, length) in [(Axis::X, size.x), (Axis::Y, size.y)] {
            let places = (0..).map(|i| 2.0 + 4.0 * f64::from(i));
            let heights: Vec<f64> = places.take_while(|&at| at < f64::from(length)).collect();
            let areas = slice_mesh(&mesh, axis, &heights, 0.0);
            for ((loops, _), (section, at)) in
                slice_loops(&mesh, axis, &heights).into_iter().zip(areas.iter().zip(&heights))
            {
                let edge = |(from, to)| Edge { from, to, leans: true, is_cavity: false };
                let contours = loops.into_iter().map(|l| Contour::new(l.points));
                let edges = contours.flat_map(|c| c.edges().map(edge).collect::<Vec<_>>()).collect();
                let columns = PlaneSection { edges, zones: vec![] }.columns(Demand::PAPER);
                assert_equal(&columns, &twin(&section.area), &format!("{name} {axis:?} {at}"));
                planes += 1;
            }
        }
    }
    assert!(planes > 50, "{planes} planes were compared");
}
