//! The exported API in headless Node: same bytes by every way, errors with their names, and the
//! bytes of the native build (`tests/gcode_golden.rs` holds the same golden file against that).
#![cfg(target_arch = "wasm32")]

mod common;

use foothold::mesh::stl::write_binary;
use foothold::wasm::{
    Chunk, Job, Model, ModelReader, Outline, Printer, SharedMesh, default_settings, resolve_settings,
    slice_share,
};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::wasm_bindgen_test;

fn model(bytes: &[u8], chunk: usize) -> Model {
    let mut reader = ModelReader::new(Some(bytes.len() as f64));
    for piece in bytes.chunks(chunk) {
        reader.push(piece).expect("good bytes");
    }
    reader.finish().expect("a good model")
}

fn job(settings: &str) -> Job {
    let stl = write_binary(&common::medley());
    let mut job =
        Job::new(vec![model(&stl, 777)], vec!["medley".to_owned()], settings, &[], vec![]).expect("it fits");
    job.prepare().expect("good settings");
    job
}

/// Takes in a worked range; gives the text of each of its layers.
fn take(job: &mut Job, mut chunk: Chunk) -> Vec<Vec<u8>> {
    job.add(&chunk.meta()).expect("good figures");
    let (text, offsets) = (chunk.text(), chunk.layer_offsets());
    offsets.windows(2).map(|w| text[w[0] as usize..w[1] as usize].to_vec()).collect()
}

fn finish(mut job: Job, layers: &[Vec<u8>]) -> Vec<u8> {
    let result = job.finish().expect("all layers are there");
    let glue = result.glue();
    let piece = |p: &[u32]| {
        let source = if p[0] == 0 { &glue } else { &layers[p[0] as usize - 1] };
        source[p[1] as usize..p[2] as usize].to_vec()
    };
    result.pieces().chunks(3).flat_map(piece).collect()
}

fn error_name(thrown: impl Into<JsValue>) -> (String, String) {
    let error: js_sys::Error = thrown.into().unchecked_into();
    (error.name().into(), error.message().into())
}

#[wasm_bindgen_test]
fn own_ranges_and_shares_give_the_golden_bytes() {
    let golden = include_str!("golden/medley.txt");
    let mut whole = job(&default_settings());
    let count = whole.layer_count().expect("a running job");
    let chunk = whole.slice(0, count).expect("sliced");
    let layers = take(&mut whole, chunk);
    let file = finish(whole, &layers);
    let fingerprint = format!("fingerprint {:016x}", common::fingerprint(&file));
    assert!(golden.contains(&fingerprint), "{fingerprint} is not that of the native build:\n{golden}");

    let mut shared = job(&default_settings());
    let mut layers = Vec::new();
    for first in (0..count).step_by(16) {
        let share = shared.share(first, (first + 16).min(count)).expect("shared");
        layers.extend(take(&mut shared, slice_share(&share).expect("sliced")));
    }
    assert!(finish(shared, &layers) == file);
}

#[wasm_bindgen_test]
fn the_report_is_json_and_the_job_is_over_after_it() {
    let mut job = job(&default_settings());
    let count = job.layer_count().expect("a running job");
    let chunk = job.slice(0, count).expect("sliced");
    take(&mut job, chunk);
    let report = job.finish().expect("all layers are there").report().expect("JSON");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["layers"].as_u64(), Some(count as u64));
    assert!(report["time_s"].as_f64().expect("a number") > 60.0);
    let Err(again) = job.finish() else { panic!("finished twice") };
    assert_eq!(error_name(again).0, "InternalError");
}

#[wasm_bindgen_test]
fn directions_evaluated_elsewhere_are_the_same_and_turn_the_job() {
    let settings = resolve_settings(vec![], vec!["orientation.mode=auto".to_owned()]).expect("good settings");
    // Upright it covers least of the bed: y becomes up.
    let stl = write_binary(&common::cuboid(glam::Vec3::ZERO, glam::Vec3::new(4.0, 30.0, 10.0)));
    let mut part = model(&stl, 4096);
    let ups = part.directions(&settings, false).expect("a sound part");
    assert_eq!(ups.len(), 18);
    let mesh = SharedMesh::new(&part.share().expect("bytes")).expect("the same mesh");
    let mut figures = Vec::new();
    for (id, up) in (1..).zip(ups.chunks(3)) {
        let here = part.evaluate(&settings, id, up).expect("a sound part");
        assert_eq!(here, mesh.evaluate(&settings, id, up).expect("a sound part"));
        figures.push(js_sys::Uint8Array::from(&here[..]));
    }
    let report = part.choose(&settings, figures).expect("all six are there");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["chosen"], 5);
    let layers = |part: Model| {
        let mut job = Job::new(vec![part], vec!["part".to_owned()], &settings, &[], vec![]).expect("it fits");
        job.prepare().expect("good settings");
        job.layer_count().expect("a running job")
    };
    assert_eq!(layers(part.clone_model()), layers(model(&stl, 4096)));
}

#[wasm_bindgen_test]
fn errors_have_their_names_and_causes() {
    let Err(unknown) = resolve_settings(vec![], vec!["walls.cuont=2".to_owned()]) else { panic!("accepted") };
    assert_eq!(
        error_name(unknown),
        ("SettingsError".to_owned(), "walls.cuont: there is no such setting".to_owned())
    );

    let stl = write_binary(&common::cube(20.0));
    let mut cut = ModelReader::new(None);
    cut.push(&stl[..stl.len() - 60]).expect("good so far");
    let Err(truncated) = cut.finish() else { panic!("accepted") };
    let (name, cause) = error_name(truncated);
    assert_eq!(name, "ModelError");
    assert!(cause.starts_with("truncated: header says 12 triangles, file holds 10"), "{cause}");

    let tall = write_binary(&common::cuboid(glam::Vec3::ZERO, glam::Vec3::new(10.0, 10.0, 300.0)));
    let placed =
        Job::new(vec![model(&tall, 4096)], vec!["tall".to_owned()], &default_settings(), &[], vec![]);
    let Err(tall) = placed else { panic!("accepted") };
    assert_eq!(error_name(tall).0, "FitError");
}

/// A function that gives the text in pieces of five bytes.
fn pieces(text: &str) -> js_sys::Function {
    let bytes = text.as_bytes().to_vec();
    let mut at = 0;
    let next = Closure::<dyn FnMut() -> JsValue>::new(move || {
        let piece = &bytes[at..bytes.len().min(at + 5)];
        at += piece.len();
        if piece.is_empty() { JsValue::UNDEFINED } else { js_sys::Uint8Array::from(piece).into() }
    });
    next.into_js_value().unchecked_into()
}

#[wasm_bindgen_test]
fn the_link_writes_numbered_lines_and_refuses_by_name() {
    let mut printer = Printer::new(None).expect("a link");
    let early = printer.start(0.0, pieces("G28\n"), 0.0).expect_err("started without a printer");
    assert_eq!(error_name(early).0, "CommandError");
    printer.connect(0.0).expect("not connected yet");
    let sent: Vec<u8> = std::iter::from_fn(|| printer.poll_transmit()).flatten().collect();
    // XOR of "N0 M110 N0" is 125.
    assert_eq!(sent, b"\nN0 M110 N0*125\n");
    assert!(printer.poll_timeout().is_some_and(|at| at > 0.0));
    printer.handle_closed(1.0);
    let events = printer.poll_events().expect("JSON").expect("a closed port is told");
    assert!(serde_json::from_str::<serde_json::Value>(&events).is_ok_and(|it| it.is_array()), "{events}");
}

#[wasm_bindgen_test]
fn an_outline_tells_where_layers_begin() {
    let text = "M104 S210\nG28\n;LAYER_CHANGE\n;Z:0.2\nG1 Z0.2\n;LAYER_CHANGE\n;Z:0.4\nG1 Z0.4\n";
    let outline = Outline::new(pieces(text)).json().expect("JSON");
    let outline: serde_json::Value = serde_json::from_str(&outline).expect("JSON");
    assert_eq!(outline["layers"].as_array().map(Vec::len), Some(2), "{outline}");
}
