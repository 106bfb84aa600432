//! The text form: words split at white space, and a small grammar over them.

use super::{BYTE_ORDER_MARK, Format, Parsed, StlError, Welder};

/// Reads a text file word by word.
pub(super) struct TextReader {
    words: Words,
    grammar: Grammar,
}

impl TextReader {
    pub(super) fn new() -> TextReader {
        TextReader { words: Words::default(), grammar: Grammar::new() }
    }

    pub(super) fn push(&mut self, mut bytes: &[u8]) -> Result<(), StlError> {
        while let Some(&first) = bytes.first() {
            if matches!(self.grammar.want, Want::RestOfLine | Want::Ignore) {
                bytes = self.rest_of_line(bytes);
            } else if first.is_ascii_whitespace() || first == VERTICAL_TAB {
                if self.words.begun.is_empty() {
                    self.words.count_line(first);
                    bytes = &bytes[1..];
                } else {
                    let word = std::mem::take(&mut self.words.begun);
                    self.grammar.word(&word, self.words.line)?;
                }
            } else {
                bytes = self.word(bytes)?;
            }
        }
        Ok(())
    }

    /// Handles the word at the start of `bytes`, or keeps it when it may go on in the next chunk.
    fn word<'a>(&mut self, bytes: &'a [u8]) -> Result<&'a [u8], StlError> {
        let end = bytes.iter().position(|b| b.is_ascii_whitespace() || *b == VERTICAL_TAB);
        let (word, rest) = bytes.split_at(end.unwrap_or(bytes.len()));
        if end.is_some() && self.words.begun.is_empty() && word.len() <= LONGEST_WORD {
            self.grammar.word(word, self.words.line)?;
            return Ok(rest);
        }
        self.words.begun.extend_from_slice(word);
        if self.words.begun.len() > LONGEST_WORD {
            let word = std::mem::take(&mut self.words.begun);
            self.grammar.long_word(&word, self.words.line)?;
        }
        Ok(rest)
    }

    /// Takes bytes up to the end of the line as the name of a solid, or as nothing.
    fn rest_of_line<'a>(&mut self, bytes: &'a [u8]) -> &'a [u8] {
        let end = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let (start, rest) = bytes.split_at(end.unwrap_or(bytes.len()));
        if self.grammar.want == Want::Ignore {
            self.grammar.trailing += start.len() as u64;
        } else {
            let room = NAME_BYTES.saturating_sub(self.words.name.len());
            self.words.name.extend_from_slice(&start[..start.len().min(room)]);
        }
        if end.is_some() {
            let name = std::mem::take(&mut self.words.name);
            self.grammar.end_of_line(&name);
        }
        rest
    }

    pub(super) fn finish(mut self) -> Result<Parsed, StlError> {
        let word = std::mem::take(&mut self.words.begun);
        if !word.is_empty() {
            self.grammar.last_word(&word, self.words.line)?;
        }
        if self.grammar.want == Want::RestOfLine {
            let name = std::mem::take(&mut self.words.name);
            self.grammar.end_of_line(&name);
        }
        self.grammar.finish()
    }
}

/// White space in C, but not for `is_ascii_whitespace`.
const VERTICAL_TAB: u8 = 0x0b;

/// No word or number of the grammar comes near this many bytes.
const LONGEST_WORD: usize = 200;

/// Bytes kept of a solid's name.
const NAME_BYTES: usize = 80;

/// Solids whose names are kept.
const MOST_NAMES: usize = 100;

/// Where we are in the file, and what began in an earlier chunk.
#[derive(Default)]
struct Words {
    /// Beginning of a word that may go on in the next chunk.
    begun: Vec<u8>,
    /// Name of the solid so far.
    name: Vec<u8>,
    /// Line ends before this place: CRLF, LF or CR.
    line: u64,
    after_cr: bool,
}

impl Words {
    fn count_line(&mut self, byte: u8) {
        let is_end = byte == b'\r' || (byte == b'\n' && !self.after_cr);
        self.line += u64::from(is_end);
        self.after_cr = byte == b'\r';
    }
}

/// What comes next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Want {
    /// "solid"; a line that begins otherwise is ignored (the file begins with "solid", or we were
    /// not here).
    Solid,
    /// A name, or nothing.
    RestOfLine,
    /// Nothing that matters, up to the end of the line.
    Ignore,
    /// "facet" or "endsolid".
    FacetOrEnd,
    Normal,
    /// One of three numbers that nobody needs.
    NormalNumber(u8),
    Outer,
    Loop,
    /// "vertex" of corner 0..3.
    Vertex(u8),
    /// Number 0..9 of the triangle.
    Coordinate(u8),
    EndLoop,
    EndFacet,
}

/// The state of the grammar, and what was read.
struct Grammar {
    want: Want,
    inside_solid: bool,
    endsolid_missing: bool,
    numbers: [f32; 9],
    welder: Welder,
    solids: Vec<String>,
    trailing: u64,
}

impl Grammar {
    fn new() -> Grammar {
        Grammar {
            want: Want::Solid,
            inside_solid: false,
            endsolid_missing: false,
            numbers: [0.0; 9],
            welder: Welder::new(0),
            solids: Vec::new(),
            trailing: 0,
        }
    }

    /// Takes the next word; `line` counts from 0.
    fn word(&mut self, word: &[u8], line: u64) -> Result<(), StlError> {
        let is = |keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
        self.want = match self.want {
            Want::Solid => return self.outside(word, line),
            Want::FacetOrEnd if is("facet") => Want::Normal,
            Want::FacetOrEnd if is("endsolid") => self.end_solid(),
            Want::FacetOrEnd if is("solid") => {
                self.endsolid_missing = true;
                self.begin_solid()
            }
            Want::Normal if is("normal") => Want::NormalNumber(0),
            Want::NormalNumber(2) => Want::Outer,
            Want::NormalNumber(i) => Want::NormalNumber(i + 1),
            Want::Outer if is("outer") => Want::Loop,
            Want::Loop if is("loop") => Want::Vertex(0),
            Want::Vertex(corner) if is("vertex") => Want::Coordinate(3 * corner),
            Want::Coordinate(i) => {
                let Some(number) = parse_number(word) else { return Err(self.syntax_error(word, line)) };
                self.numbers[usize::from(i)] = number;
                after_coordinate(i)
            }
            Want::EndLoop if is("endloop") => Want::EndFacet,
            Want::EndFacet if is("endfacet") => {
                let [ax, ay, az, bx, by, bz, cx, cy, cz] = self.numbers;
                self.welder.add([[ax, ay, az], [bx, by, bz], [cx, cy, cz]])?;
                Want::FacetOrEnd
            }
            _ => return Err(self.syntax_error(word, line)),
        };
        Ok(())
    }

    /// Outside of solids: another solid begins, or bytes that mean nothing. A facet out here is a
    /// fault, for ignoring it would lose a piece of the part.
    fn outside(&mut self, word: &[u8], line: u64) -> Result<(), StlError> {
        let word_without_mark = word.strip_prefix(BYTE_ORDER_MARK).unwrap_or(word);
        if word_without_mark.eq_ignore_ascii_case(b"solid") {
            self.want = self.begin_solid();
        } else if word.eq_ignore_ascii_case(b"facet") {
            return Err(self.syntax_error(word, line));
        } else {
            self.ignore(word);
        }
        Ok(())
    }

    /// A word longer than any of the grammar.
    fn long_word(&mut self, word: &[u8], line: u64) -> Result<(), StlError> {
        if self.want != Want::Solid {
            return Err(self.syntax_error(word, line));
        }
        self.ignore(word);
        Ok(())
    }

    fn ignore(&mut self, word: &[u8]) {
        self.trailing += word.len() as u64;
        self.want = Want::Ignore;
    }

    fn begin_solid(&mut self) -> Want {
        self.inside_solid = true;
        Want::RestOfLine
    }

    fn end_solid(&mut self) -> Want {
        self.inside_solid = false;
        Want::RestOfLine
    }

    /// The line of a "solid" or "endsolid" is over.
    fn end_of_line(&mut self, name: &[u8]) {
        if !self.inside_solid {
            self.want = Want::Solid;
            return;
        }
        self.want = Want::FacetOrEnd;
        if self.solids.len() < MOST_NAMES {
            self.solids.push(String::from_utf8_lossy(name).trim().to_owned());
        }
    }

    /// The last word of a file that ends right behind it: it may be the beginning of another one.
    fn last_word(&mut self, word: &[u8], line: u64) -> Result<(), StlError> {
        let begins = |keyword: &str| {
            keyword.len() > word.len() && keyword.as_bytes()[..word.len()].eq_ignore_ascii_case(word)
        };
        match self.want {
            Want::FacetOrEnd if begins("endsolid") => Ok(()),
            Want::FacetOrEnd if begins("facet") => Err(self.cut_off()),
            Want::Coordinate(_) => Err(self.cut_off()),
            _ if begins(self.wanted()) => Err(self.cut_off()),
            _ => self.word(word, line),
        }
    }

    fn finish(self) -> Result<Parsed, StlError> {
        match self.want {
            Want::Solid | Want::FacetOrEnd | Want::RestOfLine | Want::Ignore => {}
            _ => return Err(self.cut_off()),
        }
        Ok(Parsed {
            triangles: self.welder.read(),
            degenerate: self.welder.degenerate(),
            mesh: self.welder.finish(),
            format: Format::Text,
            solids: self.solids,
            trailing_bytes: self.trailing,
            endsolid_missing: self.endsolid_missing || self.inside_solid,
        })
    }

    fn cut_off(&self) -> StlError {
        StlError::CutOff { triangle: self.welder.read() + 1 }
    }

    /// What the grammar wants, in the file's own words.
    fn wanted(&self) -> &'static str {
        match self.want {
            Want::Solid | Want::RestOfLine | Want::Ignore => "solid",
            Want::FacetOrEnd => "facet or endsolid",
            Want::Normal => "normal",
            Want::NormalNumber(_) | Want::Coordinate(_) => "a number",
            Want::Outer => "outer",
            Want::Loop => "loop",
            Want::Vertex(_) => "vertex",
            Want::EndLoop => "endloop",
            Want::EndFacet => "endfacet",
        }
    }

    #[cold]
    fn syntax_error(&self, word: &[u8], line: u64) -> StlError {
        /// Characters of a word that are shown.
        const SHOWN: usize = 24;
        let found = String::from_utf8_lossy(word).chars().take(SHOWN).collect();
        StlError::Syntax { line: line + 1, expected: self.wanted(), found }
    }
}

/// What follows number `i` (0..9) of a triangle.
fn after_coordinate(i: u8) -> Want {
    match i {
        8 => Want::EndLoop,
        2 | 5 => Want::Vertex((i + 1) / 3),
        _ => Want::Coordinate(i + 1),
    }
}

/// A decimal number with or without sign, point and exponent; "nan" and "inf" are numbers too (and
/// refused later as not finite).
fn parse_number(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
