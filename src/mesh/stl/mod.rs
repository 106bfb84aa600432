//! STL files: reading from chunks of any size, binary and text, and writing.
//!
//! A binary file is 80 bytes of header, a little-endian u32 count, then 50 bytes for each triangle:
//! normal, three corners (f32 each), two bytes nobody uses. A text file is `solid NAME`, then
//! `facet normal x y z  outer loop  vertex x y z (three times)  endloop  endfacet`, then
//! `endsolid NAME` (3D Systems, StereoLithography Interface Specification, 1989). Normals are ignored:
//! the corners' order says which side is outside.

mod binary;
mod text;
mod write;

pub use write::{write_binary, write_text};

use super::Mesh;
use super::weld::Welder;
use binary::BinaryReader;
use std::fmt;
use text::TextReader;

/// Why a file is refused. `Display` gives the text that follows the file's name; triangles and
/// lines count from 1.
#[derive(Debug, Clone, PartialEq)]
pub enum StlError {
    /// No bytes at all.
    Empty,
    /// Not an STL file; what it seems to be instead.
    NotStl {
        /// Such as "a ZIP archive, perhaps a 3MF".
        seems: &'static str,
    },
    /// A binary file that ends before its last triangle.
    Truncated {
        /// Triangles by the header's count.
        expected: u32,
        /// Whole triangles in the file.
        found: u64,
        /// Whether the file ends in the middle of a triangle.
        partial: bool,
    },
    /// A text file that ends inside a triangle.
    CutOff {
        /// Number of the incomplete triangle.
        triangle: u64,
    },
    /// A text file that does not follow the grammar.
    Syntax {
        /// Line of the word.
        line: u64,
        /// What the grammar wants there.
        expected: &'static str,
        /// The word that stands there, its beginning if it is long.
        found: String,
    },
    /// A corner is NaN or infinite.
    NonFinite {
        /// Number of the triangle.
        triangle: u64,
    },
    /// A corner lies more than a kilometre from the origin.
    TooFar {
        /// Number of the triangle.
        triangle: u64,
        /// Its largest coordinate, mm.
        reach_mm: f32,
    },
    /// No triangle with an area.
    NoTriangles,
    /// More triangles than 32-bit indices can hold.
    TooMany {
        /// The largest number accepted.
        limit: u64,
    },
}

impl fmt::Display for StlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StlError::Empty => write!(f, "empty: the file has no bytes"),
            StlError::NotStl { seems } => write!(f, "not an STL file: it seems to be {seems}"),
            StlError::Truncated { expected, found, partial } => {
                write!(f, "truncated: header says {expected} triangles, file holds {found}")?;
                if *partial { write!(f, " and a part of the next") } else { Ok(()) }
            }
            StlError::CutOff { triangle } => {
                write!(f, "truncated: the file ends in the middle of triangle {triangle}")
            }
            StlError::Syntax { line, expected, found } => {
                write!(f, "line {line}: expected {expected}, found \"{found}\"")
            }
            StlError::NonFinite { triangle } => {
                write!(f, "triangle {triangle} has a corner that is not a finite number")
            }
            StlError::TooFar { triangle, reach_mm } => write!(
                f,
                "triangle {triangle} reaches {reach_mm} mm from the origin; the limit is {} mm",
                super::weld::REACH_MM
            ),
            StlError::NoTriangles => write!(f, "no triangles: nothing in the file has an area"),
            StlError::TooMany { limit } => write!(f, "too many triangles: the limit is {limit}"),
        }
    }
}

impl std::error::Error for StlError {}

/// How a file was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// 50 bytes for each triangle.
    Binary,
    /// Words and decimal numbers.
    Text,
}

/// What an STL file holds: vertices are welded, nothing else is changed yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Parsed {
    /// The welded mesh; no triangle in it uses a vertex twice.
    pub mesh: Mesh,
    /// Binary or text.
    pub format: Format,
    /// Triangles in the file.
    pub triangles: u64,
    /// Of these, dropped because two corners are the same point.
    pub degenerate: u64,
    /// Names of the solids of a text file, in order; at most the first 100, 80 bytes of each.
    pub solids: Vec<String>,
    /// Bytes after the last triangle, ignored.
    pub trailing_bytes: u64,
    /// Whether a text file lacks an `endsolid`.
    pub endsolid_missing: bool,
}

/// Bytes looked at before choosing between binary and text. A text file has a whole triangle in
/// them; a binary one a header and nine triangles.
const PREFIX_BYTES: usize = 512;

/// Bytes before the first triangle of a binary file.
const HEADER_BYTES: usize = 84;

/// Reads an STL file from chunks of any size.
///
/// Call [`push`](StlReader::push) with the bytes in order, then [`finish`](StlReader::finish). The
/// result does not depend on where the chunks end. After an error the reader is of no further use.
/// Memory is that of the welded mesh and a table of its vertices, not of the file.
///
/// ```
/// use foothold::mesh::stl::StlReader;
/// let text = b"solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
///     endloop\nendfacet\nendsolid t\n";
/// let mut reader = StlReader::new();
/// for chunk in text.chunks(7) {
///     reader.push(chunk)?;
/// }
/// let parsed = reader.finish()?;
/// assert_eq!((parsed.triangles, parsed.solids), (1, vec!["t".to_owned()]));
/// # Ok::<(), foothold::mesh::StlError>(())
/// ```
pub struct StlReader {
    size: Option<u64>,
    state: State,
}

// One value for each file: its size does not matter.
#[allow(clippy::large_enum_variant)]
enum State {
    Prefix(Vec<u8>),
    Binary(BinaryReader),
    Text(TextReader),
}

impl Default for StlReader {
    fn default() -> Self {
        StlReader::new()
    }
}

impl StlReader {
    /// A reader of a file of unknown size.
    pub fn new() -> StlReader {
        StlReader { size: None, state: State::Prefix(Vec::new()) }
    }

    /// A reader of a file of `size` bytes: room is made at once, and a binary file that is too short
    /// for its count is refused at its header, before any other fault in it is looked for.
    pub fn with_size(size: u64) -> StlReader {
        StlReader { size: Some(size), state: State::Prefix(Vec::new()) }
    }

    /// Takes the next bytes of the file.
    pub fn push(&mut self, bytes: &[u8]) -> Result<(), StlError> {
        let State::Prefix(prefix) = &mut self.state else { return self.state.push(bytes) };
        let (start, rest) = bytes.split_at(bytes.len().min(PREFIX_BYTES - prefix.len()));
        prefix.extend_from_slice(start);
        if prefix.len() == PREFIX_BYTES {
            self.decide()?;
        }
        if rest.is_empty() { Ok(()) } else { self.state.push(rest) }
    }

    /// The whole mesh, once all bytes are pushed.
    pub fn finish(mut self) -> Result<Parsed, StlError> {
        if matches!(self.state, State::Prefix(_)) {
            self.decide()?;
        }
        let parsed = match self.state {
            State::Prefix(_) => return Err(StlError::Empty),
            State::Binary(reader) => reader.finish()?,
            State::Text(reader) => reader.finish()?,
        };
        if parsed.mesh.triangles.is_empty() { Err(StlError::NoTriangles) } else { Ok(parsed) }
    }

    /// Chooses the format by the bytes so far and hands them on.
    fn decide(&mut self) -> Result<(), StlError> {
        let State::Prefix(prefix) = &mut self.state else { return Ok(()) };
        let prefix = std::mem::take(prefix);
        self.state = match sniff(&prefix)? {
            Format::Text => State::Text(TextReader::new()),
            Format::Binary => State::Binary(BinaryReader::new(&prefix, self.size)?),
        };
        self.state.push(&prefix)
    }
}

impl State {
    fn push(&mut self, bytes: &[u8]) -> Result<(), StlError> {
        match self {
            State::Prefix(_) => Ok(()),
            State::Binary(reader) => reader.push(bytes),
            State::Text(reader) => reader.push(bytes),
        }
    }
}

/// Tells text from binary by the file's first bytes.
///
/// Many binary files begin with the word "solid". But none goes on for long without a control
/// byte: of a count below 2^24 the last byte is zero. So text is what begins with "solid" and has
/// no control byte.
fn sniff(prefix: &[u8]) -> Result<Format, StlError> {
    if prefix.is_empty() {
        return Err(StlError::Empty);
    }
    if let Some((_, seems)) = OTHER_FORMATS.iter().find(|(magic, _)| prefix.starts_with(magic)) {
        return Err(StlError::NotStl { seems });
    }
    let is_text = !prefix.iter().any(|&b| is_control(b));
    match (is_text, begins_with_solid(prefix)) {
        (true, true) => Ok(Format::Text),
        (true, false) => Err(StlError::NotStl { seems: "text of another kind" }),
        (false, _) if prefix.len() < HEADER_BYTES => {
            Err(StlError::NotStl { seems: "something shorter than an STL header" })
        }
        (false, _) => Ok(Format::Binary),
    }
}

/// First bytes of files that people take for an STL, and what they are.
const OTHER_FORMATS: [(&[u8], &str); 7] = [
    (b"PK\x03\x04", "a ZIP archive, perhaps a 3MF"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"%PDF", "a PDF document"),
    (b"glTF", "a glTF model"),
    (b"\xff\xfe", "text in UTF-16"),
];

/// Whether the first word, behind white space and a byte order mark, is "solid" in any case.
fn begins_with_solid(prefix: &[u8]) -> bool {
    let text = prefix.strip_prefix(BYTE_ORDER_MARK).unwrap_or(prefix).trim_ascii_start();
    let word = text.get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"solid"));
    word && text.get(5).is_none_or(u8::is_ascii_whitespace)
}

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Whether a byte stands in no text: a control code other than the white space ones.
fn is_control(byte: u8) -> bool {
    byte.is_ascii_control() && !matches!(byte, b'\t'..=b'\r')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sniffed(start: &[u8]) -> Result<Format, StlError> {
        let mut bytes = start.to_vec();
        bytes.truncate(PREFIX_BYTES);
        sniff(&bytes)
    }

    #[test]
    fn solid_in_any_case_and_after_blanks_is_text() {
        for start in ["solid x\n", "SOLID\r\n", " \t\n Solid a b c\n", "\u{feff}solid\n", "solid"] {
            assert_eq!(sniffed(start.as_bytes()), Ok(Format::Text), "{start:?}");
        }
    }

    #[test]
    fn a_header_that_says_solid_is_still_binary() {
        let mut bytes = b"solid made of spaces".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(120u32.to_le_bytes());
        assert_eq!(sniffed(&bytes), Ok(Format::Binary));
    }

    #[test]
    fn other_files_are_named() {
        assert_eq!(sniffed(b""), Err(StlError::Empty));
        for (start, seems) in [
            (&b"PK\x03\x04\x14\x00"[..], "a ZIP archive, perhaps a 3MF"),
            (b"# a Wavefront file\nv 0 0 0\n", "text of another kind"),
            (b"solidarity\n", "text of another kind"),
            (b"\x01\x02", "something shorter than an STL header"),
        ] {
            assert_eq!(sniffed(start), Err(StlError::NotStl { seems }));
        }
    }

    #[test]
    fn errors_read_as_the_line_after_the_files_name() {
        let truncated = StlError::Truncated { expected: 120, found: 87, partial: false };
        assert_eq!(truncated.to_string(), "truncated: header says 120 triangles, file holds 87");
        let far = StlError::TooFar { triangle: 3, reach_mm: 2.5e6 };
        assert_eq!(far.to_string(), "triangle 3 reaches 2500000 mm from the origin; the limit is 1000000 mm");
    }
}
