//! An STL file to G-code, natively: `cargo run --release --example slice_file -- part.stl out.gcode
//! [path=value]...`. Prints the report.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use foothold::gcode::assemble;
use foothold::mesh;
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, out, sets @ ..] = arguments.as_slice() else {
        return Err("usage: slice_file MODEL.stl OUT.gcode [path=value]...".into());
    };
    let begin = Instant::now();
    let clock = || begin.elapsed().as_secs_f64() * 1000.0;
    let settings = Settings::resolve([], sets.iter().map(String::as_str))?;
    let name = Path::new(model).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let model = NamedModel::new(name, mesh::load(&std::fs::read(model)?)?);
    let parsed = clock();
    let mut job = Job::new(&[model], settings, &clock)?;
    job.add_parse_time(parsed);
    job.prepare(&clock)?;
    let range = job.slice(0, job.layer_count(), &clock);
    job.add(range.meta);
    let finished = job.finish(&clock)?;
    std::fs::write(out, assemble(&finished.joined, &range.texts))?;
    println!("{}", serde_json::to_string_pretty(&finished.report)?);
    Ok(())
}
