//! 3MF and OBJ: what they hold, and what is refused. Archives are put together here, so that each shows
//! what it is about.

use std::io::{Cursor, Write};

use foothold_files::limits::XML_DEPTH;
use foothold_files::{FileError, Part, read_model, stl};
use proptest::prelude::*;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const CORE: &str = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
                    xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";

/// Corner (0 0 0) and one on each axis: 4 faces outward.
const TETRA: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
    <vertex x=\"0\" y=\"2\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"3\"/></vertices><triangles>\
    <triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
    <triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"2\" v2=\"0\" v3=\"3\"/></triangles></mesh>";

fn zipped(files: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        zip.start_file(*name, SimpleFileOptions::default()).expect("in memory");
        zip.write_all(text.as_bytes()).expect("in memory");
    }
    zip.finish().expect("in memory").into_inner()
}

fn model(attributes: &str, objects: &str, items: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><model {CORE} {attributes}><resources>{objects}</resources><build>{items}</build></model>"
    )
}

fn threemf(attributes: &str, objects: &str, items: &str) -> Vec<u8> {
    zipped(&[("3D/3dmodel.model", &model(attributes, objects, items))])
}

fn parts(bytes: &[u8]) -> Vec<Part> {
    read_model("a.3mf", bytes).expect("a good file")
}

/// Six times the volume, signed.
fn volume6(part: &Part) -> f64 {
    let corner = |v: u32| part.vertices[v as usize].map(f64::from);
    let six = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [corner(a), corner(b), corner(c)];
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    part.triangles.iter().map(six).sum()
}

fn extent(part: &Part) -> [[f32; 3]; 2] {
    let fold = |f: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|k| part.vertices.iter().map(|v| v[k]).reduce(f).unwrap_or(0.0))
    };
    [fold(f32::min), fold(f32::max)]
}

#[test]
fn one_object_in_millimetres() {
    let found = parts(&threemf(
        "",
        &format!("<object id=\"1\" name=\"wedge\" type=\"model\">{TETRA}</object>"),
        "<item objectid=\"1\"/>",
    ));
    assert_eq!((found.len(), found[0].name.as_str(), found[0].triangles.len()), (1, "wedge", 4));
    assert_eq!(extent(&found[0]), [[0.0; 3], [1.0, 2.0, 3.0]]);
    assert_eq!(volume6(&found[0]), 6.0);
    // 84 bytes and 50 for each triangle; the count stands at 80.
    let bytes = stl::binary(&found[0]);
    assert_eq!((bytes.len(), bytes[80]), (84 + 200, 4));
}

#[test]
fn units_are_the_files() {
    for (unit, mm) in
        [("micron", 0.001), ("centimeter", 10.0), ("inch", 25.4), ("foot", 304.8), ("meter", 1000.0)]
    {
        let object = format!("<object id=\"1\">{TETRA}</object>");
        let found = parts(&threemf(&format!("unit=\"{unit}\""), &object, "<item objectid=\"1\"/>"));
        assert_eq!(extent(&found[0])[1], [mm as f32, (2.0 * mm) as f32, (3.0 * mm) as f32], "{unit}");
    }
}

#[test]
fn items_move_turn_and_mirror() {
    let object = format!("<object id=\"1\">{TETRA}</object>");
    // A quarter turn about z: (x, y) to (-y, x), then 10 along x. Inches move it by 254 mm.
    let turn = "<item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/>";
    let found = parts(&threemf("unit=\"inch\"", &object, turn));
    let [low, high] = extent(&found[0]);
    assert_eq!((low[0], high[0]), (10.0 * 25.4 - 50.8, 254.0));
    assert!((f64::from(high[1]) - 25.4).abs() < 1e-4 && volume6(&found[0]) > 0.0);
    // A mirrored part is turned right side out again.
    let mirror = "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>";
    let found = parts(&threemf("", &object, mirror));
    assert_eq!((extent(&found[0])[0][0], volume6(&found[0])), (-1.0, 6.0));
}

#[test]
fn components_make_one_part_and_items_several() {
    let objects = format!(
        "<object id=\"1\">{TETRA}</object><object id=\"2\" name=\"pair\"><components><component objectid=\"1\"/>\
         <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>\
         <object id=\"3\" type=\"support\">{TETRA}</object>"
    );
    let items = "<item objectid=\"2\"/><item objectid=\"1\"/><item objectid=\"3\"/><item objectid=\"1\" printable=\"0\"/>";
    let found = parts(&threemf("", &objects, items));
    assert_eq!(found.iter().map(|p| p.triangles.len()).collect::<Vec<_>>(), [8, 4]);
    assert_eq!((found[0].name.as_str(), extent(&found[0])[1][0]), ("pair", 6.0));
}

#[test]
fn the_production_extension_keeps_objects_in_other_files() {
    let rels = "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"r\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" Target=\"/3D/root.model\"/></Relationships>";
    let root = model(
        "requiredextensions=\"p\"",
        "<object id=\"8\"><components><component p:path=\"/3D/Objects/one.model\" objectid=\"1\" \
         transform=\"1 0 0 0 1 0 0 0 1 7 0 0\"/></components></object>",
        "<item objectid=\"8\"/>",
    );
    let one = model("unit=\"centimeter\"", &format!("<object id=\"1\">{TETRA}</object>"), "");
    let found =
        parts(&zipped(&[("_rels/.rels", rels), ("3D/root.model", &root), ("3D/Objects/one.model", &one)]));
    // The object is in centimetres, the way it is moved in the root's millimetres.
    assert_eq!(extent(&found[0]), [[7.0, 0.0, 0.0], [17.0, 20.0, 30.0]]);
}

fn refusal(bytes: &[u8]) -> FileError {
    read_model("a.3mf", bytes).expect_err("not a good file")
}

#[test]
fn what_is_damaged_is_named() {
    let object = format!("<object id=\"1\">{TETRA}</object>");
    let good = threemf("", &object, "<item objectid=\"1\"/>");
    assert_eq!(refusal(&[]), FileError::Empty);
    assert!(matches!(refusal(&good[..good.len() / 2]), FileError::Archive { .. }));
    assert_eq!(refusal(&zipped(&[("readme.txt", "no model")])), FileError::NotThreeMf);
    assert_eq!(refusal(&threemf("", &object, "")), FileError::NoTriangles);
    let cases = [
        (threemf("", &object, "<item objectid=\"2\"/>"), "object 2, which is not there"),
        (threemf("unit=\"mile\"", &object, ""), "unknown unit \"mile\""),
        (threemf("", &object, "<item objectid=\"1\" transform=\"1 0 0\"/>"), "is not twelve numbers"),
        (threemf("", &object.replace("v3=\"3\"", "v3=\"4\""), ""), "a vertex that is not there"),
        (threemf("", &object.replace("x=\"1\"", "x=\"one\""), ""), "\"one\" is no number"),
        (threemf("", &object.replace("x=\"1\"", "x=\"NaN\""), ""), "needs x, y and z"),
        (threemf("", &format!("{object}{object}"), ""), "two objects 1"),
        (threemf("requiredextensions=\"b\" xmlns:b=\"http://beams\"", &object, ""), "extension http://beams"),
        (
            threemf("", &object, "<item objectid=\"1\" transform=\"1e9 0 0 0 1 0 0 0 1 0 0 0\"/>"),
            "1000000 mm from the origin",
        ),
        (
            threemf(
                "",
                "<object id=\"1\"><components><component objectid=\"1\" p:path=\"/gone.model\"/></components></object>",
                "<item objectid=\"1\"/>",
            ),
            "/gone.model, which is not in",
        ),
    ];
    for (bytes, words) in cases {
        let said = refusal(&bytes).to_string();
        assert!(said.contains(words), "{said}");
    }
    for broken in
        ["<model", "<model><resources>", "<model></resources></model>", "<model unit=millimeter>", ""]
    {
        let error = refusal(&zipped(&[("3D/3dmodel.model", broken)]));
        assert!(matches!(error, FileError::Xml { .. } | FileError::Malformed { .. }), "{broken}: {error:?}");
    }
    let utf16: Vec<u8> = "\u{feff}<model/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let text = holding(&utf16);
    assert!(matches!(refusal(&text), FileError::Encoding { seems: "UTF-16" }));
}

/// An archive whose model holds these bytes.
fn holding(bytes: &[u8]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("3D/3dmodel.model", SimpleFileOptions::default()).expect("in memory");
    zip.write_all(bytes).expect("in memory");
    zip.finish().expect("in memory").into_inner()
}

#[test]
fn bombs_are_refused() {
    // 100 MB of one letter deflate to a thousandth.
    let same = format!("<model {CORE}>{}</model>", ">".repeat(100 << 20));
    let bomb = zipped(&[("3D/3dmodel.model", &same)]);
    assert!(bomb.len() < 200_000);
    assert!(matches!(refusal(&bomb), FileError::Bomb { .. }));
    // One endless element takes no more than its limit.
    let long = format!("<model {CORE} unit=\"{}\"/>", "m".repeat(20 << 20));
    assert!(matches!(refusal(&zipped(&[("3D/3dmodel.model", &long)])), FileError::TooMuch { .. }));
    let deep = format!("<model>{}", "<a>".repeat(XML_DEPTH + 1));
    assert!(matches!(refusal(&zipped(&[("3D/3dmodel.model", &deep)])), FileError::TooMuch { .. }));
}

#[test]
fn objects_within_objects_end() {
    // Each object holds ten of the one before: 10^12 of them.
    let ten = |id: u32| {
        let inner = format!("<component objectid=\"{}\"/>", id - 1).repeat(10);
        format!("<object id=\"{id}\"><components>{inner}</components></object>")
    };
    let objects: String =
        std::iter::once(format!("<object id=\"1\">{TETRA}</object>")).chain((2..14).map(ten)).collect();
    assert!(matches!(refusal(&threemf("", &objects, "<item objectid=\"13\"/>")), FileError::TooMuch { .. }));
    let itself = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    assert!(matches!(refusal(&threemf("", itself, "<item objectid=\"1\"/>")), FileError::TooMuch { .. }));
}

/// What other people might send: each is refused by name, soon, and in little memory.
#[test]
fn hostile_archives_are_refused() {
    let good = format!("<object id=\"1\">{TETRA}</object>");
    let item = "<item objectid=\"1\"/>";
    // Two objects that hold each other, and a chain deeper than any real one.
    let pair = "<object id=\"1\"><components><component objectid=\"2\"/></components></object>\
                <object id=\"2\"><components><component objectid=\"1\"/></components></object>";
    assert!(matches!(refusal(&threemf("", pair, item)), FileError::TooMuch { .. }));
    let link = |id: u32| {
        format!("<object id=\"{id}\"><components><component objectid=\"{}\"/></components></object>", id - 1)
    };
    let chain: String = std::iter::once(good.clone()).chain((2..40).map(link)).collect();
    assert!(matches!(refusal(&threemf("", &chain, "<item objectid=\"39\"/>")), FileError::TooMuch { .. }));
    // Entities that unfold to more entities.
    let laughs = "<?xml version=\"1.0\"?><!DOCTYPE m [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>";
    let named = format!(
        "{laughs}<model {CORE}><resources><object id=\"1\" name=\"&b;\">{TETRA}</object></resources></model>"
    );
    let said = refusal(&zipped(&[("3D/3dmodel.model", &named)])).to_string();
    assert!(said.contains('b') && said.starts_with("3D/3dmodel.model: "), "{said}");
    // Numbers larger than any file, and such that are none.
    for (from, to, words) in [
        ("id=\"1\">", "id=\"99999999999999999999\">", "is no number"),
        ("v1=\"0\" v2=\"2\"", "v1=\"4294967295\" v2=\"2\"", "a vertex that is not there"),
        ("v1=\"0\" v2=\"2\"", "v1=\"-1\" v2=\"2\"", "is no number"),
        ("x=\"1\"", "x=\"1e999\"", "needs x, y and z"),
        ("x=\"1\"", "x=\"0x10\"", "is no number"),
    ] {
        let said = refusal(&threemf("", &good.replacen(from, to, 1), item)).to_string();
        assert!(said.contains(words), "{to}: {said}");
    }
    // Latin-1 where UTF-8 is the rule, and a file that is no text at all.
    let latin = model("", &good.replace("id=\"1\"", "id=\"1\" name=\"W\u{fc}rfel\""), item);
    let latin: Vec<u8> = latin.chars().map(|c| c as u8).collect();
    for bytes in [latin, vec![0xff; 1000], vec![0; 1000]] {
        let error = refusal(&holding(&bytes));
        assert!(matches!(error, FileError::Xml { .. } | FileError::Malformed { .. }), "{error:?}");
    }
    // An archive within an archive is no model.
    let inner = threemf("", &good, item);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("inner.3mf", SimpleFileOptions::default()).expect("in memory");
    zip.write_all(&inner).expect("in memory");
    assert_eq!(refusal(&zip.finish().expect("in memory").into_inner()), FileError::NotThreeMf);
}

/// Wherever an archive ends too early, it is called damaged.
#[test]
fn archives_cut_anywhere_are_damaged() {
    let object = format!("<object id=\"1\">{TETRA}</object>");
    let good = zipped(&[
        ("[Content_Types].xml", "<Types/>"),
        ("3D/3dmodel.model", &model("", &object, "<item objectid=\"1\"/>")),
        ("Metadata/notes.txt", &"notes ".repeat(1000)),
    ]);
    for percent in 1..100 {
        let error = refusal(&good[..good.len() * percent / 100]);
        assert!(matches!(error, FileError::Archive { .. }), "{percent} %: {error:?}");
    }
}

/// Ten thousand files and ten thousand components that name them are looked up, not searched for.
#[test]
fn many_files_and_components_take_no_time() {
    let names: Vec<String> = (0..9_000).map(|k| format!("3D/part{k}.model")).collect();
    let one = model("", &format!("<object id=\"1\">{TETRA}</object>"), "");
    let component = "<component objectid=\"1\" p:path=\"/3D/PART8999.model\"/>".repeat(9_000);
    let root = model(
        "",
        &format!("<object id=\"2\"><components>{component}</components></object>"),
        "<item objectid=\"2\"/>",
    );
    let mut files: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), one.as_str())).collect();
    files.push(("3D/3dmodel.model", &root));
    assert_eq!(parts(&zipped(&files))[0].triangles.len(), 36_000);
}

/// A face that crosses itself everywhere would take the third power of its corners.
#[test]
fn faces_that_never_end_are_refused() {
    let corners = 30_000;
    let mut text = String::new();
    for k in 0..corners {
        // A zigzag between two lines, its corners in an order that crosses all others.
        let x = (k * 7_919) % corners;
        text += &format!("v {x} {} 0\n", k % 2);
    }
    text += "f";
    (1..=corners).for_each(|k| text += &format!(" {k}"));
    let said = read_model("a.obj", text.as_bytes()).expect_err("too much").to_string();
    assert!(said.starts_with("line 30001: ") && said.ends_with("not convex: export triangles"), "{said}");
    // A byte order mark is no vertex.
    let marked = format!("\u{feff}{}", OBJ.trim_start_matches("# a tetrahedron\no wedge\n"));
    assert_eq!(read_model("a.obj", marked.as_bytes()).expect("good")[0].vertices.len(), 4);
}

const OBJ: &str = "# a tetrahedron\no wedge\nv 0 0 0\nv 1 0 0 1.0\nv 0 2 0\nv 0 0 3\nvn 0 0 1\nusemtl red\nf 1 3 2\nf 1/1/1 2/2/2 4/3/3\nf -3//1 -2//1 -1//1\nf 3 \\\n 1 4\n";

#[test]
fn obj_with_every_way_to_name_a_corner() {
    let found = read_model("wedge.OBJ", OBJ.as_bytes()).expect("good");
    assert_eq!((found.len(), found[0].triangles.len(), volume6(&found[0])), (1, 4, 6.0));
}

#[test]
fn faces_that_are_not_convex_are_cut_rightly() {
    // An L of area 3 seen from above, its back corner first.
    let l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 5 6 1 2 3 4\n";
    let found = &read_model("l.obj", l.as_bytes()).expect("good")[0];
    let area2 = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| found.vertices[v as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    assert_eq!(found.triangles.len(), 4);
    assert!(found.triangles.iter().all(|t| area2(t) > 0.0));
    assert_eq!(found.triangles.iter().map(area2).sum::<f32>(), 6.0);
}

#[test]
fn obj_faults_are_named_with_their_line() {
    let cases = [
        ("v 0 0\n", "line 1: a vertex needs three numbers"),
        ("v 0 0 0\nv 1 1 inf\n", "line 2: a vertex with a number that cannot be used"),
        ("v 0 0 0\nf 1 2 3\n", "line 2: a face names a vertex that is not there"),
        ("v 0 0 0\nf 0 1 1\n", "line 2: a face names a vertex that is not there"),
        ("v 0 0 0\nf 1 1\n", "line 2: a face needs three corners"),
        ("cstype bspline\n", "line 1: free-form curves and surfaces are not supported: export triangles"),
        ("v 0 0 0\n", "no triangles: there is nothing to print"),
        ("\u{0}\u{1}\u{2}", "no triangles: there is nothing to print"),
    ];
    for (text, said) in cases {
        assert_eq!(read_model("a.obj", text.as_bytes()).expect_err(text).to_string(), said);
    }
    assert_eq!(read_model("a.xyz", b"solid").expect_err("STL is not read here"), FileError::UnknownFormat);
}

/// Whatever comes out can be written: every index is there, every number finite.
fn check(found: Result<Vec<Part>, FileError>) {
    for part in found.into_iter().flatten() {
        assert!(part.triangles.iter().flatten().all(|&v| (v as usize) < part.vertices.len()));
        assert!(part.vertices.iter().flatten().all(|x| x.is_finite()));
        assert_eq!(stl::binary(&part).len(), 84 + 50 * part.triangles.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::with_cases(300) })]

    #[test]
    fn bytes_changed_anywhere_do_no_harm(at in 0_usize..2000, byte in any::<u8>(), cut in 0_usize..2000) {
        let object = format!("<object id=\"1\">{TETRA}</object>");
        let mut bytes = threemf("", &object, "<item objectid=\"1\"/>");
        let n = bytes.len();
        bytes[at % n] = byte;
        check(read_model("a.3mf", &bytes));
        check(read_model("a.3mf", &bytes[..cut % n]));
        let mut text = OBJ.as_bytes().to_vec();
        let n = text.len();
        text[at % n] = byte;
        check(read_model("a.obj", &text));
        check(read_model("a.obj", &text[..cut % n]));
    }

    #[test]
    fn xml_changed_anywhere_does_no_harm(at in 0_usize..2000, byte in 32_u8..127, count in 1_usize..4) {
        let object = format!("<object id=\"1\">{TETRA}</object>");
        let mut text = model("", &object, "<item objectid=\"1\"/>").into_bytes();
        let n = text.len();
        for k in 0..count {
            text[(at + 37 * k) % n] = byte;
        }
        check(read_model("a.3mf", &holding(&text)));
    }

    #[test]
    fn any_bytes_do_no_harm(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        check(read_model("a.obj", &bytes));
        check(read_model("a.3mf", &[b"PK\x03\x04".as_slice(), &bytes].concat()));
        let _ = foothold_files::import(&bytes);
        let _ = foothold_files::import(&[b"PK\x03\x04".as_slice(), &bytes].concat());
    }

    #[test]
    fn any_profile_text_does_no_harm(text in "(layer_height|fill_density|bed_shape|start_gcode|perimeters|inherits)? ?=? ?[-0-9a-z%,.;{}\\[\\]x\"\\\\]{0,40}\n{0,2}[ -~]{0,80}") {
        let _ = foothold_files::import(text.as_bytes());
        let _ = foothold_files::import(format!("perimeters = 3\nlayer_height = 0.2\n{text}").as_bytes());
        for begin in ["; CONFIG_BLOCK_START\n; ", ";SETTING_3 ", "; generated by Foothold 1\n; walls.count = 2\n; "] {
            let _ = foothold_files::import(format!("{begin}{text}").as_bytes());
        }
        let json = serde_json::json!({ "layer_height": text, "machine_start_gcode": [text.clone()] });
        let _ = foothold_files::import(json.to_string().as_bytes());
    }
}
