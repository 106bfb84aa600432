//! Teeth around the good models of `shared/models`, as they lie, after 0.15 mm of elephant foot.

mod common;
#[path = "fixtures/adhesion/picture.rs"]
mod picture;
#[path = "fixtures/adhesion/shapes.rs"]
mod shapes;

use std::fs;

use foothold::adhesion::{AdhesionKind, FirstLayer, lay_foundation};
use foothold::mesh::load;
use foothold::polygon::measure::Bounds;
use foothold::polygon::{Join, PolygonSet};
use foothold::slice::{Axis, slice_mesh};
use serde_json::Value;
use shapes::*;

#[test]
fn guarantees_hold_around_the_good_models() {
    let Some(dir) = common::models_dir() else { return };
    let text = fs::read_to_string(dir.join("manifest.json")).expect("the manifest is readable");
    let manifest: Value = serde_json::from_str(&text).expect("the manifest is JSON");
    let files = manifest["files"].as_array().expect("it lists files");
    let mut broken = Vec::new();
    for file in files.iter().filter(|f| f["kind"] == "good") {
        let name = file["name"].as_str().expect("a file has a name");
        let bytes = fs::read(dir.join(name)).expect("a model of the manifest is there");
        let mesh = load(&bytes).expect("a good model").mesh;
        let bottom = f64::from(mesh.bounds().expect("triangles").min.z);
        let section = slice_mesh(&mesh, Axis::Z, &[bottom + 0.1], 0.005).remove(0).area;
        let outline = section.offset(-0.15, Join::WALL);
        if let Some(found) = broken_around(name, &outline) {
            broken.push(format!("{name}: {found}"));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

fn broken_around(name: &str, outline: &PolygonSet) -> Option<String> {
    let bed: Bounds = outline.bounds()?.grown(30.0);
    let supports = PolygonSet::EMPTY;
    let first = FirstLayer { bed, ..first_layer(outline, &supports) };
    let settings = options(AdhesionKind::Teeth);
    let laid = lay_foundation(&first, &settings).expect("default settings");
    picture::draw(&format!("model-{name}"), outline, &laid);
    println!("{name}: {:?}", laid.figures);
    broken_guarantee(&first, &settings, &laid)
}
