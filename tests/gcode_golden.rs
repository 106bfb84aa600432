//! A whole run against `golden/`: a readable summary and a fingerprint of the text. The wasm build is
//! held against the same file by `tests/web.rs`, so the two agree byte for byte.
//!
//! `UPDATE_GOLDEN=1 cargo test --test gcode_golden` writes the file anew; look at what changed, and
//! say why in the commit.

mod common;

use std::fmt::Write;

use foothold::gcode::assemble;
use foothold::mesh::{load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel, Report};
use foothold::settings::Settings;

fn run() -> (Vec<u8>, Report) {
    let model = load(&write_binary(&common::medley())).expect("a good mesh");
    let named = NamedModel::new("medley", model);
    let mut job = Job::new(&[named], Settings::default(), &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    (assemble(&finished.joined, &range.texts), finished.report)
}

fn summary(file: &[u8], report: &Report) -> String {
    let mut text = format!("layers {}\ntime_s {:.1}\n", report.layers, report.time_s);
    for (role, used) in &report.by_role {
        let _ = writeln!(text, "{} {:.1} mm {:.2} mm3", role.name(), used.length_mm, used.volume_mm3);
    }
    let _ = writeln!(text, "filament_mm {:.2}", report.filament.length_mm);
    let _ = writeln!(text, "bytes {}", file.len());
    let _ = writeln!(text, "fingerprint {:016x}", common::fingerprint(file));
    text
}

#[test]
fn the_medley_is_as_it_was() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/medley.txt");
    let (file, report) = run();
    let found = summary(&file, &report);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &found).expect("the folder is there");
    }
    assert_eq!(found, std::fs::read_to_string(path).expect("a golden file"));
}
