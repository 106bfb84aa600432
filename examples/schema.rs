//! Writes the JSON Schemas of the settings and of what the engine hands out:
//! `cargo run --features schema --example schema -- FOLDER`.

use std::error::Error;
use std::path::Path;

use foothold::gcode::Sequence;
use foothold::gcode::inspect::GcodeFigures;
use foothold::mesh::Inspection;
use foothold::pipeline::Report;
use foothold::printer::{Event, Outline};
use foothold::settings::{Settings, is_of_model};
use schemars::Schema;
use schemars::schema_for;
use serde_json::json;

/// With the paths of settings that a model can have of its own, as `x-of-model`.
fn settings() -> Schema {
    let paths = Settings::default().lines();
    let own = |sequence| -> Vec<&str> {
        paths.iter().map(|(path, _)| path.as_str()).filter(|path| is_of_model(path, sequence)).collect()
    };
    let all = json!({ "by_layer": own(Sequence::ByLayer), "by_object": own(Sequence::ByObject) });
    let mut schema = schema_for!(Settings);
    schema.insert("x-of-model".to_owned(), all);
    schema
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: schema FOLDER")?;
    let schemas: [(&str, Schema); 6] = [
        ("settings", settings()),
        ("report", schema_for!(Report)),
        ("inspection", schema_for!(Inspection)),
        ("gcode-figures", schema_for!(GcodeFigures)),
        ("printer-event", schema_for!(Event)),
        ("printer-outline", schema_for!(Outline)),
    ];
    for (name, schema) in schemas {
        let text = serde_json::to_string_pretty(&schema)? + "\n";
        std::fs::write(Path::new(&folder).join(format!("{name}.schema.json")), text)?;
    }
    Ok(())
}
