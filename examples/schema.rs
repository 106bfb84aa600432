//! Writes the JSON Schemas of the settings and of what the engine hands out:
//! `cargo run --features schema --example schema -- FOLDER`.

use std::error::Error;
use std::path::Path;

use foothold::mesh::Inspection;
use foothold::pipeline::Report;
use foothold::printer::{Event, Outline};
use foothold::settings::Settings;
use schemars::Schema;
use schemars::schema_for;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: schema FOLDER")?;
    let schemas: [(&str, Schema); 5] = [
        ("settings", schema_for!(Settings)),
        ("report", schema_for!(Report)),
        ("inspection", schema_for!(Inspection)),
        ("printer-event", schema_for!(Event)),
        ("printer-outline", schema_for!(Outline)),
    ];
    for (name, schema) in schemas {
        let text = serde_json::to_string_pretty(&schema)? + "\n";
        std::fs::write(Path::new(&folder).join(format!("{name}.schema.json")), text)?;
    }
    Ok(())
}
