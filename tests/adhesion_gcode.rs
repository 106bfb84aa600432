//! What the report says of base layers against what a reader of the G-code measures.

mod common;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use foothold::adhesion::AdhesionKind;
use foothold::gcode::assemble;
use foothold::gcode::read::{ReadGcode, Strand, read};
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, Report};
use foothold::polygon::DVec2;
use foothold::region::Role;
use foothold::settings::Settings;
use glam::{Vec3, vec3};
use shapes::*;

/// A block of 40 x 30 mm, two layers high, with this base layer.
fn printed(kind: AdhesionKind) -> (ReadGcode, Report) {
    let model = load(&write_binary(&common::cuboid(Vec3::ZERO, vec3(40.0, 30.0, 0.4)))).expect("a block");
    let sets = [format!("adhesion.kind={}", kind.name())];
    let settings = Settings::resolve([], sets.iter().map(String::as_str)).expect("good settings");
    let diameter = settings.filament.diameter;
    let mut job = Job::new(&[NamedModel::new("block", model)], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    (read(&assemble(&finished.joined, &range.texts), diameter), finished.report)
}

/// Beads of base layers: the file has one word for skirt, brim and teeth, and one for raft and supports.
fn base_strands(file: &ReadGcode, layer: usize) -> impl Iterator<Item = &Strand> {
    let roles = [Role::Skirt, Role::Brim, Role::Teeth, Role::Raft, Role::Support];
    file.layers[layer].strands.iter().filter(move |s| s.role.is_some_and(|r| roles.contains(&r)))
}

fn edges_of(strand: &Strand) -> impl Iterator<Item = (DVec2, DVec2)> {
    strand.points.windows(2).map(|w| (w[0], w[1]))
}

fn assert_close(found: f64, expected: f64, share: f64, what: &str) {
    assert!((found - expected).abs() <= share * expected.abs().max(1.0), "{what}: {found}, not {expected}");
}

#[test]
fn the_report_says_what_the_gcode_holds() {
    // Drawn in by 0.15 against the elephant foot, in the middle of a bed of 220 x 220.
    let outline = rectangle(90.15, 95.15, 39.7, 29.7);
    for kind in AdhesionKind::LAID {
        let (file, report) = printed(kind);
        let name = kind.name();
        let layers = 0..file.layers.len();
        let volume: f64 = layers.flat_map(|k| base_strands(&file, k)).map(Strand::volume_mm3).sum();
        assert_close(report.adhesion.figures.filament_mm3, volume, 0.005, &format!("{name}, filament"));
        let lowest: Vec<&Strand> = base_strands(&file, 0).collect();
        let contact: f64 = lowest
            .iter()
            .flat_map(|s| edges_of(s).zip(&s.segments))
            .map(|((a, b), segment)| a.distance(b) * segment.width)
            .sum();
        assert_close(
            report.adhesion.figures.bed_contact_mm2,
            contact,
            0.005,
            &format!("{name}, bed contact"),
        );
        let role = match kind {
            AdhesionKind::Skirt => Role::Skirt,
            AdhesionKind::Brim => Role::Brim,
            AdhesionKind::Raft => Role::Raft,
            AdhesionKind::Teeth => Role::Teeth,
            AdhesionKind::None => unreachable!("it lays nothing"),
        };
        let used = &report.by_role[&role];
        assert_close(used.volume_mm3, volume, 0.005, &format!("{name}, volume by role"));
        assert_eq!(report.adhesion.time_s, used.time_s);
        if kind == AdhesionKind::Raft {
            // The part stands on it with its whole outline, not drawn in.
            assert_close(report.adhesion.figures.attachment_mm, 140.0, 1e-6, "raft, attachment");
            continue;
        }
        let near: Vec<(DVec2, DVec2)> = lowest.iter().flat_map(|s| edges_of(s)).collect();
        let width = lowest[0].segments[0].width;
        let held: f64 =
            outline.contours().iter().map(|c| sampled_length_within(c, &near, width / 2.0 + 0.05)).sum();
        assert_close(report.adhesion.figures.attachment_mm, held, 0.02, &format!("{name}, attachment"));
        let share = report.adhesion.figures.attachment_share;
        assert_close(share, report.adhesion.figures.attachment_mm / outline.length(), 1e-3, name);
        if kind == AdhesionKind::Teeth {
            assert_tips_bite(&lowest, &outline, report.adhesion.figures.teeth.expect("teeth").placed);
        }
    }
}

/// Every tip that the file holds lies 0.4 deep, and there are as many as the report counts.
fn assert_tips_bite(strands: &[&Strand], outline: &foothold::polygon::PolygonSet, placed: u32) {
    let all = edges(outline);
    let tips: Vec<DVec2> =
        strands.iter().flat_map(|s| &s.points).copied().filter(|&p| outline.contains(p)).collect();
    let depths: Vec<f64> = tips.iter().map(|&tip| to_edges(tip, &all)).collect();
    assert!(depths.iter().all(|depth| (depth - 0.4).abs() < 0.05), "{depths:?}");
    assert_eq!(tips.len(), placed as usize);
}
