//! A part gives the same bytes of G-code whether it comes as STL, 3MF or OBJ.

mod common;

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use foothold::gcode::assemble;
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;
use foothold_files::{read_model, stl};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

fn gcode(stl: &[u8]) -> Vec<u8> {
    let settings = Settings::resolve([], ["layers.height=0.3"]).expect("good settings");
    let named = NamedModel::new("part", load(stl).expect("a good mesh"));
    let mut job = Job::new(&[named], settings, &|| 0.0).expect("it fits");
    job.prepare(&|| 0.0).expect("good settings");
    let range = job.slice(0, job.layer_count(), &|| 0.0);
    job.add(range.meta);
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    assemble(&finished.joined, &range.texts)
}

fn as_obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("o part\n");
    for v in &mesh.vertices {
        let _ = writeln!(text, "v {} {} {}", v.x, v.y, v.z);
    }
    for t in &mesh.triangles {
        let _ = writeln!(text, "f {}// {}// {}//", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    text.into_bytes()
}

fn as_3mf(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from(
        "<model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\
         <resources><object id=\"1\" type=\"model\"><mesh><vertices>",
    );
    for v in &mesh.vertices {
        let _ = write!(text, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", v.x, v.y, v.z);
    }
    text += "</vertices><triangles>";
    for t in &mesh.triangles {
        let _ = write!(text, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t[0], t[1], t[2]);
    }
    text += "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>";
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("3D/3dmodel.model", SimpleFileOptions::default()).expect("in memory");
    zip.write_all(text.as_bytes()).expect("in memory");
    zip.finish().expect("in memory").into_inner()
}

#[track_caller]
fn assert_same(mesh: &Mesh) {
    let expected = gcode(&write_binary(mesh));
    for (name, bytes) in [("part.obj", as_obj(mesh)), ("part.3mf", as_3mf(mesh))] {
        let parts = read_model(name, &bytes).expect("a good file");
        assert_eq!(parts.len(), 1);
        assert!(gcode(&stl::binary(&parts[0])) == expected, "{name} gives other bytes");
    }
}

#[test]
fn a_part_with_a_bit_of_everything() {
    assert_same(&common::medley());
}

#[test]
fn a_real_model() {
    let Some(dir) = common::models_dir() else { return };
    let bytes = std::fs::read(dir.join("angle_block_mm.stl")).expect("a model");
    assert_same(&load(&bytes).expect("a good model").mesh);
}
