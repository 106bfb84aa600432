//! Reading and writing STL: every form that files come in, every fault they are refused for.

mod common;

use common::*;
use foothold::mesh::stl::{Format, Parsed, StlReader, write_binary, write_text};
use foothold::mesh::{Mesh, StlError, load};
use glam::{Vec3, vec3};
use proptest::prelude::*;

fn read(bytes: &[u8]) -> Result<Parsed, StlError> {
    read_in_chunks(bytes, usize::MAX)
}

fn read_in_chunks(bytes: &[u8], chunk: usize) -> Result<Parsed, StlError> {
    let mut reader = StlReader::new();
    for chunk in bytes.chunks(chunk) {
        reader.push(chunk)?;
    }
    reader.finish()
}

fn error(bytes: &[u8]) -> String {
    let error = read(bytes).expect_err("this file is at fault");
    assert_eq!(read_in_chunks(bytes, 1).unwrap_err(), error, "byte by byte");
    error.to_string()
}

/// A tetrahedron with three right angles at the origin: volume 1/6.
fn corner() -> Mesh {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    Mesh { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] }
}

const FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

#[test]
fn binary_and_text_come_back_as_they_were() {
    let ball = sphere(vec3(0.1, 0.2, 0.3), 7.0, 10, 20);
    let binary = read(&write_binary(&ball)).expect("sound");
    let text = read(write_text(&ball, "ball").as_bytes()).expect("sound");
    assert_eq!((binary.format, text.format), (Format::Binary, Format::Text));
    assert_eq!(binary.mesh, text.mesh);
    assert_eq!(binary.mesh.vertices.len(), ball.vertices.len());
    assert_eq!(soup(&binary.mesh), soup(&ball), "the same corners in the same order");
    assert_eq!((binary.triangles, text.triangles), (360, 360));
    assert_eq!(text.solids, ["ball"]);
    assert!(!text.endsolid_missing && text.trailing_bytes == 0 && binary.trailing_bytes == 0);
}

#[test]
fn a_binary_file_has_84_and_50_bytes_a_triangle() {
    let bytes = write_binary(&corner());
    assert_eq!(bytes.len(), 84 + 4 * 50);
    assert_eq!(bytes[80..84], [4, 0, 0, 0]);
    assert_eq!(bytes[84 + 8..84 + 12], (-1.0f32).to_le_bytes(), "the first triangle looks down");
}

#[test]
fn a_binary_header_may_say_solid() {
    let mut bytes = write_binary(&corner());
    bytes[..80].fill(b' ');
    bytes[..14].copy_from_slice(b"solid facet no");
    for chunk in [1, 83, 512, 10_000] {
        let parsed = read_in_chunks(&bytes, chunk).expect("sound");
        assert_eq!((parsed.format, parsed.triangles), (Format::Binary, 4));
    }
}

#[test]
fn normals_and_attributes_do_not_matter() {
    let sound = write_binary(&corner());
    let mut bytes = sound.clone();
    for triangle in 0..4 {
        bytes[84 + 50 * triangle..][..12].copy_from_slice(&[0xff; 12]); // NaN
        bytes[84 + 50 * triangle + 48..][..2].copy_from_slice(&[0x12, 0x80]);
    }
    assert_eq!(read(&bytes), read(&sound));
    let text = format!("solid\n{FACET}endsolid\n").replace("0 0 1", "nan -nan(ind) 1.#QNAN");
    assert_eq!(read(text.as_bytes()).expect("sound").triangles, 1);
}

#[test]
fn bytes_after_the_last_triangle_are_counted() {
    let mut bytes = write_binary(&corner());
    bytes.extend([7; 123]);
    for chunk in [1, 50, 10_000] {
        let parsed = read_in_chunks(&bytes, chunk).expect("sound");
        assert_eq!((parsed.triangles, parsed.trailing_bytes), (4, 123));
    }
    let model = load(&bytes).expect("sound");
    assert_eq!(model.inspection.warnings[0].code, "trailing_bytes");
    assert_eq!(model.inspection.warnings[0].message, "123 bytes after the last of 4 triangles were ignored");
    let text = format!("solid a\n{FACET}endsolid a\nmade by hand\n");
    assert_eq!(read(text.as_bytes()).expect("sound").trailing_bytes, 12);
}

#[test]
fn text_comes_in_many_hands() {
    let plain = format!("solid a b\n{FACET}endsolid a b\n");
    let expected = read(plain.as_bytes()).expect("sound").mesh;
    let variants = [
        plain.to_uppercase(),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        plain.replace(' ', "\t \t").replace('\n', "\n\n  "),
        plain
            .replace("vertex 1 0 0", "vertex +1.0E+00 -0.0 0e-5")
            .replace("vertex 0 1 0", "vertex .0 10.e-1 0"),
        format!("\u{feff}\n  {plain}"),
        plain.trim_end().to_owned(),
        plain.replace("endsolid a b", "endsolid"),
        plain.replace("solid a b", "solid"),
    ];
    for text in variants {
        for chunk in [1, 3, 10_000] {
            let parsed = read_in_chunks(text.as_bytes(), chunk).unwrap_or_else(|e| panic!("{e} in {text:?}"));
            assert_eq!(parsed.mesh, expected, "{text:?}");
            assert!(!parsed.endsolid_missing, "{text:?}");
        }
    }
}

#[test]
fn several_solids_are_one_mesh() {
    let shifted = FACET.replace("vertex 1 0 0", "vertex 2 0 0");
    let text =
        format!("solid one\n{FACET}endsolid one\nsolid two of\ttwo \r\n{shifted}endsolid\nsolid\nendsolid\n");
    let parsed = read(text.as_bytes()).expect("sound");
    assert_eq!((parsed.triangles, parsed.mesh.vertices.len()), (2, 4));
    assert_eq!(parsed.solids, ["one", "two of\ttwo", ""]);
}

#[test]
fn a_missing_endsolid_is_a_remark() {
    let open = format!("solid a\n{FACET}");
    for text in [open.clone(), format!("{open}endso"), format!("{open}solid b\n{FACET}endsolid b\n")] {
        let parsed = read(text.as_bytes()).unwrap_or_else(|e| panic!("{e} in {text:?}"));
        assert!(parsed.endsolid_missing, "{text:?}");
    }
    let model = load(open.as_bytes()).expect("sound");
    assert_eq!(model.inspection.warnings[0].code, "endsolid_missing");
}

#[test]
fn a_text_file_cut_anywhere_inside_a_triangle_is_refused() {
    let before = format!("solid a\n{FACET}");
    let text = format!("{before}{FACET}");
    let last_word = text.len() - 1; // without the line end the last word is whole
    for end in before.len() + 1..last_word {
        let found = error(&text.as_bytes()[..end]);
        assert_eq!(found, "truncated: the file ends in the middle of triangle 2", "{:?}", &text[..end]);
    }
    assert_eq!(read(&text.as_bytes()[..last_word]).expect("whole").triangles, 2);
}

#[test]
fn a_binary_file_cut_short_says_what_it_holds() {
    let bytes = write_binary(&sphere(Vec3::ZERO, 5.0, 16, 8)); // 2 x 8 x 15 triangles
    let found = |triangles: usize, part: usize| error(&bytes[..84 + 50 * triangles + part]);
    assert_eq!(found(87, 0), "truncated: header says 240 triangles, file holds 87");
    assert_eq!(found(239, 49), "truncated: header says 240 triangles, file holds 239 and a part of the next");
    assert_eq!(found(0, 0), "truncated: header says 240 triangles, file holds 0");
    let by_size = load(&bytes[..84 + 50 * 87]).unwrap_err();
    assert_eq!(by_size, StlError::Truncated { expected: 240, found: 87, partial: false });
}

#[test]
fn a_boastful_count_takes_no_memory() {
    let mut bytes = write_binary(&corner());
    bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(error(&bytes), "truncated: header says 4294967295 triangles, file holds 4");
}

#[test]
fn corners_that_are_no_place_are_refused() {
    let with = |triangle: usize, number: usize, value: f32| {
        let mut bytes = write_binary(&corner());
        bytes[84 + 50 * triangle + 12 + 4 * number..][..4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(error(&with(2, 8, value)), "triangle 3 has a corner that is not a finite number");
    }
    let far = error(&with(0, 0, -2_500_000.0));
    assert_eq!(far, "triangle 1 reaches 2500000 mm from the origin; the limit is 1000000 mm");
    assert!(read(&with(0, 0, -1_000_000.0)).is_ok());
    for number in ["nan", "inf", "-Infinity", "1e39"] {
        let text = format!("solid\n{FACET}{FACET}endsolid").replacen(
            "vertex 0 0 0",
            &format!("vertex 0 0 {number}"),
            1,
        );
        assert_eq!(error(text.as_bytes()), "triangle 1 has a corner that is not a finite number");
    }
}

#[test]
fn files_without_triangles_are_refused() {
    assert_eq!(error(b""), "empty: the file has no bytes");
    let nothing = "no triangles: nothing in the file has an area";
    assert_eq!(error(b"solid a\nendsolid a\n"), nothing);
    assert_eq!(error(b"solid"), nothing);
    assert_eq!(error(&write_binary(&Mesh::default())), nothing);
    let point = FACET.replace("vertex 1 0 0", "vertex 0 0 0");
    assert_eq!(error(format!("solid\n{point}endsolid").as_bytes()), nothing);
    let line = FACET.replace("vertex 1 0 0", "vertex 0 3 0");
    assert_eq!(load(format!("solid\n{line}endsolid").as_bytes()), Err(StlError::NoTriangles));
}

#[test]
fn files_of_another_kind_are_named() {
    assert_eq!(
        error(b"PK\x03\x04 and so on"),
        "not an STL file: it seems to be a ZIP archive, perhaps a 3MF"
    );
    assert_eq!(error(b"v 0 0 0\nf 1 2 3\n"), "not an STL file: it seems to be text of another kind");
    assert_eq!(error(&[0; 83]), "not an STL file: it seems to be something shorter than an STL header");
}

#[test]
fn syntax_errors_name_line_and_word() {
    let faulty = |from: &str, to: &str| {
        let text = format!("solid a\r\n{FACET}endsolid a\n").replace(from, to);
        error(text.as_bytes())
    };
    assert_eq!(faulty("vertex 1 0 0", "vertex 1 o 0"), "line 5: expected a number, found \"o\"");
    assert_eq!(faulty("vertex 1 0 0", "vertex 1,5 0 0"), "line 5: expected a number, found \"1,5\"");
    assert_eq!(faulty("vertex 0 1 0\n", ""), "line 6: expected vertex, found \"endloop\"");
    assert_eq!(faulty("endloop", "vertex 1 1 1\nendloop"), "line 7: expected endloop, found \"vertex\"");
    assert_eq!(faulty("endfacet", "end"), "line 8: expected endfacet, found \"end\"");
    assert_eq!(
        faulty("facet normal", "facets normal"),
        "line 2: expected facet or endsolid, found \"facets\""
    );
    assert_eq!(
        faulty("normal", &"n".repeat(500)),
        format!("line 2: expected normal, found \"{}\"", "n".repeat(24))
    );
    let outside = format!("solid a\n{FACET}endsolid a\n{FACET}");
    assert_eq!(error(outside.as_bytes()), "line 10: expected solid, found \"facet\"");
}

/// A file that is mostly sound: random text, or a sound file with some bytes changed or cut off.
fn mangled() -> impl Strategy<Value = Vec<u8>> {
    let words = prop::sample::select(vec![
        "solid", "facet", "normal", "outer", "loop", "vertex", "endloop", "endfacet", "endsolid", "1",
        "-2.5e3", "nan", "\n", "\r\n", "\t", "x", FACET, "\u{e9}", "\0",
    ]);
    let text =
        prop::collection::vec(words, 0..60).prop_map(|w| format!("solid {}", w.join(" ")).into_bytes());
    let ball = sphere(Vec3::ZERO, 5.0, 4, 5);
    let sound = prop::sample::select(vec![write_binary(&ball), write_text(&ball, "ball").into_bytes()]);
    let flips = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4);
    let broken = (sound, flips, any::<prop::sample::Index>(), any::<bool>()).prop_map(
        |(mut bytes, flips, cut, cuts)| {
            for (place, value) in flips {
                let place = place.index(bytes.len());
                bytes[place] = value;
            }
            if cuts {
                bytes.truncate(cut.index(bytes.len()));
            }
            bytes
        },
    );
    prop_oneof![text, broken.clone(), broken, prop::collection::vec(any::<u8>(), 0..700)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_give_a_value_or_an_error_whatever_the_chunks(bytes in mangled(), chunk in 1usize..200) {
        let whole = read(&bytes);
        prop_assert_eq!(&read_in_chunks(&bytes, chunk), &whole);
        prop_assert_eq!(&read_in_chunks(&bytes, 1), &whole);
        let model = load(&bytes);
        prop_assert!(model.is_err() || whole.is_ok());
        if let Ok(model) = model {
            let inspection = &model.inspection;
            prop_assert!(model.mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < inspection.vertices));
            prop_assert!(model.mesh.vertices.iter().all(|v| v.is_finite()));
            prop_assert!(inspection.volume_mm3.is_finite() && inspection.area_mm2.is_finite());
        }
    }

    #[test]
    fn any_mesh_comes_back(corners in prop::collection::vec(prop::array::uniform9(-1e3f32..1e3), 1..20)) {
        let vertices: Vec<Vec3> = corners.iter().flatten().copied().collect::<Vec<_>>().chunks(3).map(Vec3::from_slice).collect();
        let triangles = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = Mesh { vertices, triangles };
        let binary = read(&write_binary(&mesh)).expect("sound");
        let text = read(write_text(&mesh, "any").as_bytes()).expect("sound");
        prop_assert_eq!(soup(&binary.mesh), soup(&mesh));
        prop_assert_eq!(text.mesh, binary.mesh);
    }
}
