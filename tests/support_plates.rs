//! Plates over the whole part: the numbers of a T on paper, gaps, crossings and coverage.

mod common;

use common::{cuboid, models_dir, prism, together};
use foothold::mesh::Mesh;
use foothold::polygon::simplify::closest_on_segment;
use foothold::polygon::{Contour, DVec2, Join, PolygonSet, dvec2};
use foothold::region::overhang::{need, permissible_step};
use foothold::region::{Path, Role};
use foothold::slice::heights::plan_layers;
use foothold::slice::{Axis, LayerOptions, LayerSpec, slice_mesh};
use foothold::support::{
    PlateAxis, PlateOptions, SupportError, SupportInput, SupportMethod, SupportOptions, Supports,
    plan_supports,
};
use glam::vec3;

struct Sliced {
    mesh: Mesh,
    layers: Vec<LayerSpec>,
    areas: Vec<PolygonSet>,
}

fn sliced(mesh: Mesh) -> Sliced {
    let top = mesh.bounds().expect("the mesh is not empty").max.z;
    let layers = plan_layers(top.into(), &LayerOptions::default());
    let heights: Vec<f64> = layers.iter().map(|l| l.slice_z).collect();
    let areas = slice_mesh(&mesh, Axis::Z, &heights, 0.0125).into_iter().map(|s| s.area).collect();
    Sliced { mesh, layers, areas }
}

impl Sliced {
    fn supports(&self, options: &SupportOptions) -> Supports {
        let input = SupportInput { mesh: &self.mesh, layers: &self.layers, areas: &self.areas };
        plan_supports(&input, options, &mut |_, _| true).expect("the options are sound")
    }
}

fn plates() -> SupportOptions {
    SupportOptions { method: SupportMethod::Plates, ..SupportOptions::default() }
}

/// The options of 2.4: the paper's, without gaps.
fn bare(spacing: f64) -> SupportOptions {
    SupportOptions {
        overhang_angle_deg: 0.0,
        gap_z: 0.0,
        gap_xy: 0.0,
        interface_layers: 0,
        plates: PlateOptions { spacing_x: spacing, spacing_y: spacing, ..PlateOptions::default() },
        ..plates()
    }
}

/// Column 10 x 20 x 30 in the middle, top 40 x 20 x 5 on it, as one solid.
fn t_shape() -> Mesh {
    let profile = [(0, 30), (15, 30), (15, 0), (25, 0), (25, 30), (40, 30), (40, 35), (0, 35)];
    let outline: Vec<DVec2> = profile.iter().map(|&(x, z)| dvec2(f64::from(x), f64::from(z))).collect();
    let mut mesh = prism(&outline, &[], 0.0, 20.0);
    // Drawn in (x, z): (x, y, z) -> (x, 20 - z, y).
    mesh.vertices.iter_mut().for_each(|v| *v = vec3(v.x, 20.0 - v.z, v.y));
    mesh
}

fn paths(supports: &Supports, k: usize, role: Role) -> Vec<Path> {
    supports.layer_paths(k).into_iter().filter(|p| p.role == role).collect()
}

#[test]
fn the_t_shape_of_2_4_has_the_numbers_of_2_4() {
    let supports = sliced(t_shape()).supports(&bare(5.0));
    let report = supports.report();
    let found: Vec<(PlateAxis, f64, f64)> =
        report.plates.iter().map(|p| (p.axis, p.at_mm, p.area_mm2)).collect();
    let x = [2.5, 7.5, 12.5, 27.5, 32.5, 37.5].map(|at| (PlateAxis::X, at, 20.0 * 30.0));
    let y = [2.5, 7.5, 12.5, 17.5].map(|at| (PlateAxis::Y, at, 2.0 * 15.0 * 30.0));
    let expected = [&x[..], &y[..]].concat();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        assert!((found.2 - expected.2).abs() < 1e-6, "{found:?}");
    }
    assert!((report.volume_mm3 - 2764.8).abs() < 1e-6, "{}", report.volume_mm3);
    assert!((report.complete_volume_mm3 - 18000.0).abs() < 1e-6, "{}", report.complete_volume_mm3);
    // One cage on either side of the column.
    assert_eq!((report.pieces, report.planes_added, report.uncovered.len()), (2, 0, 0));
}

#[test]
fn no_spot_is_printed_twice() {
    let part = sliced(t_shape());
    for options in [
        plates(),
        bare(5.0),
        SupportOptions { plates: PlateOptions { thickness: 2, ..plates().plates }, ..plates() },
    ] {
        let supports = part.supports(&options);
        for k in [0, 1, 2, 77, 78, 145, 146, 147, 148] {
            assert!(laid_twice(&supports, k) < 1e-3, "layer {k}: {} mm2", laid_twice(&supports, k));
            assert!(!supports.layer_paths(k).is_empty());
        }
    }
}

/// Area of a layer's beads less the area they cover, mm2.
fn laid_twice(supports: &Supports, k: usize) -> f64 {
    let beads: Vec<Contour> = supports.layer_paths(k).iter().map(|p| rectangle(p, 0.4)).collect();
    let laid: f64 = beads.iter().map(Contour::signed_area).sum();
    laid - PolygonSet::from_contours(beads).area()
}

fn rectangle(path: &Path, width: f64) -> Contour {
    let (a, b) = (path.points[0], path.points[1]);
    let (low, high) = (a.min(b) - width / 2.0, a.max(b) + width / 2.0);
    Contour::new(vec![low, dvec2(high.x, low.y), high, dvec2(low.x, high.y)])
}

#[test]
fn a_plate_keeps_its_gaps_and_stands_on_a_wide_foot() {
    let part = sliced(t_shape());
    let supports = part.supports(&plates());
    // The top hangs at z = 30: layer 150 is its first, layer 149 stays empty.
    assert!(supports.layer_paths(149).is_empty());
    assert!(!supports.layer_paths(148).is_empty());
    for k in 0..149 {
        for path in supports.layer_paths(k) {
            for p in &path.points {
                // 0.4 mm of air and half a bead from the column, half a bead within the shadow.
                assert!(
                    (p.x <= 14.4 + 1e-9 || p.x >= 25.6 - 1e-9) && p.x >= 0.2 - 1e-9 && p.x <= 39.8 + 1e-9
                );
            }
        }
    }
    let places = |k: usize| {
        let along_y =
            paths(&supports, k, Role::Support).into_iter().filter(|p| p.points[0].x == p.points[1].x);
        let mut places: Vec<f64> = along_y.map(|p| p.points[0].x).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        places
    };
    assert_eq!(places(1), [2.0, 6.0, 10.0, 14.0, 26.0, 30.0, 34.0, 38.0]);
    assert_eq!(places(0).len(), 3 * places(1).len());
    assert!(supports.bed_area().area() > 2.5 * 0.4 * 19.0 * 8.0);
}

#[test]
fn a_wall_that_leans_30_degrees_gets_none_however_it_is_cut() {
    // A parallelogram standing on its short side, turned about z so that planes cut it obliquely.
    let outline = [(0.0, 0.0), (10.0, 0.0), (10.0 + 17.32, 30.0), (17.32, 30.0)].map(|(x, z)| dvec2(x, z));
    let mut mesh = prism(&outline, &[], 0.0, 30.0);
    let (sin, cos) = foothold::polygon::trig::sin_cos(1.2);
    let (sin, cos) = (sin as f32, cos as f32);
    for v in &mut mesh.vertices {
        let (x, y, z) = (v.x, -v.z, v.y);
        *v = vec3(x * cos - y * sin + 50.0, x * sin + y * cos + 50.0, z);
    }
    let report = sliced(mesh.clone()).supports(&plates()).report().clone();
    assert_eq!((report.plates.len(), report.pieces, report.volume_mm3), (0, 0, 0.0));
    let all = sliced(mesh).supports(&SupportOptions { overhang_angle_deg: 29.0, ..plates() });
    assert!(all.report().plates.len() > 5);
}

#[test]
fn a_closed_cavity_stays_empty_and_a_through_hole_is_held() {
    let hollow = |open: bool| {
        let shell = cuboid(vec3(0.0, 0.0, 0.0), vec3(30.0, 30.0, 20.0));
        let air = cuboid(vec3(5.0, 5.0, 5.0), vec3(25.0, 25.0, 15.0));
        let tunnel = [(0, 0), (30, 0), (30, 20), (0, 20)].map(|(x, z)| dvec2(f64::from(x), f64::from(z)));
        let hole = [(5, 5), (25, 5), (25, 15), (5, 15)].map(|(x, z)| dvec2(f64::from(x), f64::from(z)));
        if open {
            let mut mesh = prism(&tunnel, &[hole.to_vec()], 0.0, 30.0);
            mesh.vertices.iter_mut().for_each(|v| *v = vec3(v.x, 30.0 - v.z, v.y));
            mesh
        } else {
            together(&[shell, common::inverted(&air)])
        }
    };
    let closed = sliced(hollow(false)).supports(&plates()).report().clone();
    assert_eq!((closed.volume_mm3, closed.plates.len(), closed.uncovered.len()), (0.0, 0, 0));
    let internal = SupportOptions { internal: true, ..plates() };
    assert!(sliced(hollow(false)).supports(&internal).report().volume_mm3 > 100.0);
    let open = sliced(hollow(true));
    assert!(open.supports(&plates()).report().volume_mm3 > 100.0);
    // It stands on the part: nothing when only the bed may carry, and that is said.
    let from_bed = open.supports(&SupportOptions { everywhere: false, ..plates() });
    assert_eq!(from_bed.report().volume_mm3, 0.0);
    assert!(from_bed.report().uncovered.iter().map(|u| u.area_mm2).sum::<f64>() > 400.0);
}

#[test]
fn a_peg_between_the_planes_gets_planes_of_its_own() {
    // A roof 40 x 40 at z = 20 on a wall, with a peg 1.6 x 1.6 hanging from it between the planes.
    let wall = cuboid(vec3(0.0, 0.0, 0.0), vec3(10.0, 40.0, 20.0));
    let roof = cuboid(vec3(0.0, 0.0, 19.9), vec3(40.0, 40.0, 22.0));
    let peg = cuboid(vec3(23.2, 23.2, 12.0), vec3(24.8, 24.8, 20.0));
    let part = sliced(together(&[wall, roof, peg]));
    let report = part.supports(&plates()).report().clone();
    assert!(report.planes_added >= 1 && report.uncovered.is_empty(), "{report:?}");
    // The first layer of the peg is 60; its gap is layer 59.
    let beads = paths(&part.supports(&plates()), 58, Role::Support);
    let below = |p: &Path| closest_on_segment(dvec2(24.0, 24.0), p.points[0], p.points[1]);
    assert!(beads.iter().any(|p| below(p).distance(dvec2(24.0, 24.0)) < 0.5));
}

#[test]
fn a_tall_plate_alone_gets_one_across_it() {
    // A bar 1 mm wide between two posts: no regular plane y = const fits, one is added along the
    // bar, 19 mm tall and 0.4 thick. Alone it would buckle at 20 x 0.4 = 8 mm.
    let gate = [(0, 0), (1, 0), (1, 20), (4, 20), (4, 0), (5, 0), (5, 22), (0, 22)];
    let outline: Vec<DVec2> = gate.iter().map(|&(x, z)| dvec2(f64::from(x), f64::from(z))).collect();
    let mut mesh = prism(&outline, &[], 0.0, 1.0);
    mesh.vertices.iter_mut().for_each(|v| *v = vec3(v.x, 1.0 - v.z, v.y));
    let wide = PlateOptions { spacing_x: 20.0, spacing_y: 20.0, ..PlateOptions::default() };
    let part = sliced(mesh);
    let found = part.supports(&SupportOptions { plates: wide, ..plates() });
    let axes = |axis| found.report().plates.iter().filter(|p| p.axis == axis).count();
    // One plate along the bar, and one across that one's middle.
    assert_eq!((axes(PlateAxis::X), axes(PlateAxis::Y), found.report().pieces), (1, 1, 1));
    assert!(found.warnings().is_empty(), "{:?}", found.warnings());
}

#[test]
fn a_grid_holds_the_t_shape_too() {
    let grid = SupportOptions { method: SupportMethod::Grid, ..plates() };
    let report = sliced(t_shape()).supports(&grid).report().clone();
    // [Karim]: all below the two overhangs, 2 x 15 x 20 x 30.
    assert!((report.complete_volume_mm3 - 18000.0).abs() < 1.0, "{}", report.complete_volume_mm3);
    assert_eq!((report.pieces, report.planes_added, report.uncovered.len()), (2, 0, 0));
    // Lines every 2.5 mm instead of every 4.
    let plates = sliced(t_shape()).supports(&plates()).report().volume_mm3;
    assert!(report.volume_mm3 > 1.3 * plates, "{} against {plates}", report.volume_mm3);
    let bed = SupportOptions { blockers: vec![[-1.0, -1.0, 0.0, 41.0, 21.0, 40.0]], ..grid };
    assert_eq!(sliced(t_shape()).supports(&bed).report().volume_mm3, 0.0);
}

#[test]
fn boxes_decide() {
    let part = sliced(t_shape());
    let left = [-1.0, -1.0, 0.0, 16.0, 21.0, 40.0];
    let blocked = part.supports(&SupportOptions { blockers: vec![left], ..bare(5.0) });
    let volume = blocked.report().volume_mm3;
    assert!((volume - 2764.8 / 2.0).abs() < 1e-6, "{volume}");
    assert!(blocked.report().uncovered.is_empty());
    let steep = SupportOptions { overhang_angle_deg: 89.0, enforcers: vec![left], ..bare(5.0) };
    assert!(part.supports(&steep).report().volume_mm3 >= volume);
}

#[test]
fn what_contradicts_itself_is_refused_by_name() {
    let part = sliced(t_shape());
    let input = SupportInput { mesh: &part.mesh, layers: &part.layers, areas: &part.areas };
    let thick = PlateOptions { spacing_x: 1.0, thickness: 3, ..PlateOptions::default() };
    let refused = plan_supports(&input, &SupportOptions { plates: thick, ..plates() }, &mut |_, _| true);
    let message = refused.expect_err("1.0 is less than 3 lines").to_string();
    assert!(
        message.starts_with("support.plates.spacing_x: 1 is less than a plate is thick, 1.2"),
        "{message}"
    );
    let stopped = plan_supports(&input, &plates(), &mut |_, _| false);
    assert_eq!(stopped, Err(SupportError::Cancelled));
}

/// Every point of every need is within half a spacing of the centre line of a support bead in the
/// layer below the gap, measured anew from the paths at points 0.25 mm apart. Spots of a fifth of
/// a mm may be left.
fn assert_covered(name: &str, part: &Sliced, supports: &Supports) {
    let mut checked = 0;
    for k in 1..part.layers.len() - 1 {
        let area = need(&part.areas[k + 1], &part.areas[k], permissible_step(0.2, 45.0), 0.2);
        let Some(bounds) = area.bounds() else { continue };
        let beads = paths(supports, k - 1, Role::Support);
        let steps = (bounds.size() / 0.25).ceil();
        let points = (0..=steps.y as u32).flat_map(|j| (0..=steps.x as u32).map(move |i| (i, j)));
        let points = points.map(|(i, j)| bounds.min + 0.25 * dvec2(f64::from(i), f64::from(j)));
        for p in points.filter(|&p| area.contains(p)) {
            let distance = |b: &Path| closest_on_segment(p, b.points[0], b.points[1]).distance(p);
            let nearest = beads.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest < 2.2, "{name} layer {k}: {p} is {nearest} mm from a bead");
            checked += 1;
        }
    }
    assert!(checked > 10, "{name}: {checked} points of need");
}

#[test]
fn real_models_are_covered_kept_clear_of_and_held_by_a_quarter() {
    let Some(dir) = models_dir() else { return };
    for name in ["support_test", "overhang", "own_arch_ascii", "own_hinge", "bridge_test"] {
        let bytes = std::fs::read(dir.join(name).with_extension("stl")).expect("the model is there");
        let mut mesh = foothold::mesh::load(&bytes).expect("the model is sound").mesh;
        let low = mesh.bounds().expect("the model is not empty").min;
        mesh.vertices.iter_mut().for_each(|v| *v -= low);
        let part = sliced(mesh);
        let supports = part.supports(&plates());
        let report = supports.report();
        let share = report.volume_mm3 / report.complete_volume_mm3;
        println!(
            "{name}: {:.1} of {:.1} mm3 = {:.1} %, {} pieces, {} dropped, {} planes added, {} uncovered",
            report.volume_mm3,
            report.complete_volume_mm3,
            100.0 * share,
            report.pieces,
            report.dropped,
            report.planes_added,
            report.uncovered.len(),
        );
        assert!(report.uncovered.is_empty(), "{name}: {:?}", report.uncovered);
        assert!(share <= 0.24, "{name}: {share}");
        assert_covered(name, &part, &supports);
        assert_clear(name, &part, &supports);
        for k in 0..part.layers.len() {
            let twice = laid_twice(&supports, k);
            assert!(twice < 0.01, "{name} layer {k}: {twice} mm2 are laid twice");
        }
    }
}

/// No bead comes nearer to the part's outline than the sideways gap less 0.05.
fn assert_clear(name: &str, part: &Sliced, supports: &Supports) {
    for (k, area) in part.areas.iter().enumerate() {
        let near = area.offset(0.35, Join::Square);
        let beads: Vec<Contour> = supports.layer_paths(k).iter().map(|p| rectangle(p, 0.4)).collect();
        let hit = PolygonSet::from_contours(beads).intersection(&near).opened(0.02, Join::WALL);
        assert!(hit.area() < 0.01, "{name} layer {k}: {} mm2 too near", hit.area());
    }
}

#[test]
fn pieces_near_each_other_are_joined_by_low_walls() {
    // Two tables beside each other, each on its own leg, without anything between them.
    let row = |y: f32| {
        let leg = cuboid(vec3(0.0, y, 0.0), vec3(4.0, y + 12.0, 20.1));
        together(&[leg, cuboid(vec3(0.0, y, 20.0), vec3(20.0, y + 12.0, 22.0))])
    };
    let part = sliced(together(&[row(0.0), row(20.0)]));
    let with = |join_distance: f64| {
        let options = PlateOptions { join_distance, ..plates().plates };
        part.supports(&SupportOptions { plates: options, ..plates() })
    };
    let (apart, joined) = (with(0.0), with(20.0));
    assert_eq!((apart.report().pieces, joined.report().pieces), (2, 1));
    // One wall of 10 layers, 8 mm and a bead's ends at most.
    let more = joined.report().volume_mm3 - apart.report().volume_mm3;
    assert!(more > 0.0 && more < 10.0 * 0.4 * 0.2 * 9.5, "{more}");
    let blockers = vec![[-5.0, 12.5, 0.0, 30.0, 19.5, 5.0]];
    let blocked = part.supports(&SupportOptions { blockers, ..plates() });
    assert_eq!(blocked.report().pieces, 2);
}

#[test]
fn a_tower_without_room_for_a_plate_across_it_gets_a_thicker_foot() {
    // A bar 0.5 mm wide between two posts, held by a plate 0.6 thick and 29 mm tall: below the bar no
    // bead of that width fits across.
    let gate = [(0, 0), (10, 0), (10, 30), (13, 30), (13, 0), (23, 0), (23, 32), (0, 32)];
    let outline: Vec<DVec2> = gate.iter().map(|&(x, z)| dvec2(f64::from(x), f64::from(z))).collect();
    let mut mesh = prism(&outline, &[], 0.0, 0.5);
    mesh.vertices.iter_mut().for_each(|v| *v = vec3(v.x, 0.5 - v.z, v.y));
    let wide = PlateOptions { spacing_x: 50.0, spacing_y: 50.0, ..PlateOptions::default() };
    let part = sliced(mesh);
    let found = part.supports(&SupportOptions { plates: wide, line_width: 0.6, ..plates() });
    assert!(found.warnings().is_empty(), "{:?}", found.warnings());
    // It may stand alone for 20 x 0.6 = 12 mm; below that it is three lines thick, five on the bed.
    let top = 29.6;
    for (k, layer) in part.layers.iter().enumerate().filter(|(_, l)| l.print_z < top) {
        let lines = paths(&found, k, Role::Support).len();
        let expected = if k == 0 {
            5
        } else if layer.print_z <= top - 12.0 + 0.21 {
            3
        } else {
            1
        };
        assert_eq!(lines, expected, "layer {k}");
    }
}
