//! Lines as bytes: numbering and checksum of what we send, framing of what comes back.
//!
//! A line on the wire is `N<number> <command>*<checksum>` and a line feed; the checksum is the XOR of
//! every byte before the `*`, in decimal. XOR finds every single wrong byte; of lines that run
//! together it misses one in 256.

use std::fmt;

use serde::Serialize;

/// Why a line cannot be sent.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum LineFault {
    /// Letters or control characters that firmwares do not read, outside a message text.
    NotAscii,
    /// Longer on the wire than the firmware's line buffer; cut off, it would mean something else.
    TooLong {
        /// Bytes of the command alone.
        bytes: usize,
        /// Bytes that fit beside number and checksum.
        limit: usize,
    },
    /// Several lines in one text.
    SeveralLines,
}

impl fmt::Display for LineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LineFault::NotAscii => f.write_str("it holds characters that printers do not read"),
            LineFault::TooLong { bytes, limit } => {
                write!(f, "it is {bytes} bytes long, and the printer reads {limit}")
            }
            LineFault::SeveralLines => f.write_str("it is more than one line"),
        }
    }
}

/// The checksum of a line: XOR of its bytes.
pub(super) fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// The line as it goes over the wire, line feed included.
pub(super) fn numbered(number: u32, command: &str) -> Vec<u8> {
    let mut wire = format!("N{number} {command}").into_bytes();
    let sum = checksum(&wire);
    wire.extend_from_slice(format!("*{sum}\n").as_bytes());
    wire
}

/// Bytes a command of this length takes on the wire at most.
pub(super) fn longest_wire(number: u32, command: usize) -> usize {
    let digits = number.checked_ilog10().unwrap_or(0) as usize + 1;
    "N ".len() + digits + command + "*255\n".len()
}

/// Bytes left for a command in a line of `max_line` bytes (line feed included) with this number.
pub(super) fn room_for_command(number: u32, max_line: usize) -> usize {
    max_line.saturating_sub(longest_wire(number, 0))
}

/// The command in a raw line: comment, blanks, and a number and checksum of its own taken off.
/// Empty when nothing is left.
pub(super) fn strip(raw: &[u8]) -> &[u8] {
    let end = raw.iter().position(|b| *b == b';').unwrap_or(raw.len());
    // `end` is a position in `raw` or its length.
    let line = raw[..end].trim_ascii();
    let Some(rest) = line.strip_prefix(b"N").or_else(|| line.strip_prefix(b"n")) else { return line };
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    if digits == 0 {
        return line;
    }
    // `digits` counts a prefix of `rest`.
    let rest = rest[digits..].trim_ascii();
    let star = rest.iter().rposition(|b| *b == b'*').unwrap_or(rest.len());
    rest[..star].trim_ascii()
}

/// A stripped command as text that fits in `limit` bytes.
///
/// Of a message (`M117`, `M118`) foreign letters become `?` and what is too long is cut, for that
/// changes the display only. Anything else is refused: half a move is another move.
pub(super) fn sendable(command: &[u8], limit: usize) -> Result<String, LineFault> {
    if command.iter().any(|b| matches!(b, b'\n' | b'\r')) {
        return Err(LineFault::SeveralLines);
    }
    let message = matches!(code(command), Some((b'M', 117 | 118)));
    let tidy: Vec<u8> = command.iter().map(|b| if *b == b'\t' { b' ' } else { *b }).collect();
    if !message {
        return match String::from_utf8(tidy) {
            Ok(text) if text.bytes().all(|b| matches!(b, b' '..=b'~')) => {
                if text.len() > limit {
                    Err(LineFault::TooLong { bytes: text.len(), limit })
                } else {
                    Ok(text)
                }
            }
            _ => Err(LineFault::NotAscii),
        };
    }
    let text = String::from_utf8_lossy(&tidy);
    let plain = text.chars().map(|c| if matches!(c, ' '..='~') { c } else { '?' });
    Ok(plain.take(limit).collect::<String>().trim_end().to_owned())
}

/// Letter (upper case) and number a command begins with: `G1 X5` is `(b'G', 1)`.
pub(super) fn code(command: &[u8]) -> Option<(u8, u32)> {
    let (letter, rest) = command.split_first()?;
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).take(6);
    let mut number = None;
    for digit in digits {
        number = Some(number.unwrap_or(0) * 10 + u32::from(digit - b'0'));
    }
    Some((letter.to_ascii_uppercase(), number?))
}

/// Commands that may keep the printer silent for minutes.
pub(super) fn may_take_long(command: &str) -> bool {
    match code(command.as_bytes()) {
        Some((b'G', number)) => matches!(number, 4 | 12 | 26 | 27..=35 | 76 | 80 | 425),
        Some((b'M', number)) => matches!(
            number,
            0 | 1 | 48 | 109 | 125 | 190 | 191 | 192 | 226 | 303 | 306 | 400 | 600..=603 | 701 | 702 | 997
        ),
        Some((b'T', _)) => true,
        Some(_) | None => false,
    }
}

/// Commands that wait for a heater and that `M108` breaks off.
pub(super) fn waits_for_heat(command: &str) -> bool {
    matches!(code(command.as_bytes()), Some((b'M', 109 | 190 | 191 | 192 | 303)))
}

/// Cuts the incoming bytes into lines. Holds `MAX_REPLY` bytes at most; a longer line is thrown away
/// up to its end.
#[derive(Debug, Default)]
pub(super) struct Framer {
    buffer: Vec<u8>,
    overlong: bool,
    /// Lines thrown away so far.
    pub(super) dropped: u64,
}

/// The longest reply kept, bytes. `M115` of a chatty firmware takes some 300.
pub(super) const MAX_REPLY: usize = 1024;

impl Framer {
    /// Takes one byte; gives the line when this byte ended one that is not blank.
    pub(super) fn push(&mut self, byte: u8) -> Option<String> {
        if byte != b'\n' && byte != b'\r' {
            self.overlong |= self.buffer.len() >= MAX_REPLY;
            if !self.overlong {
                self.buffer.push(byte);
            }
            return None;
        }
        let overlong = std::mem::take(&mut self.overlong);
        if overlong {
            self.dropped += 1;
            self.buffer.clear();
            return None;
        }
        let line = String::from_utf8_lossy(self.buffer.trim_ascii()).into_owned();
        self.buffer.clear();
        (!line.is_empty()).then_some(line)
    }

    /// Forgets a line begun.
    pub(super) fn clear(&mut self) {
        self.buffer.clear();
        self.overlong = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_one_of_the_documents() {
        // RepRap wiki, "G-code", checking: `N3 T0*57`, `N4 G92 E0*67`, `N5 G28*22`.
        assert_eq!(numbered(3, "T0"), b"N3 T0*57\n");
        assert_eq!(numbered(4, "G92 E0"), b"N4 G92 E0*67\n");
        assert_eq!(numbered(5, "G28"), b"N5 G28*22\n");
    }

    #[test]
    fn comments_numbers_and_blanks_come_off() {
        assert_eq!(strip(b"  G1 X1 ; go\r\n"), b"G1 X1");
        assert_eq!(strip(b"; only a comment"), b"");
        assert_eq!(strip(b" \t "), b"");
        assert_eq!(strip(b"N12 G1 X1*33"), b"G1 X1");
        assert_eq!(strip(b"N12G1 X1 *33 ; x"), b"G1 X1");
        assert_eq!(strip(b"NOTHING"), b"NOTHING");
        assert_eq!(strip("G1 ; sch\u{f6}n".as_bytes()), b"G1");
    }

    #[test]
    fn a_move_is_never_cut_but_a_message_is() {
        assert_eq!(sendable(b"G1 X12345", 9), Ok("G1 X12345".to_owned()));
        assert_eq!(sendable(b"G1 X12345", 8), Err(LineFault::TooLong { bytes: 9, limit: 8 }));
        assert_eq!(sendable(b"M117 hello", 8), Ok("M117 hel".to_owned()));
        assert_eq!(sendable("M117 \u{fc}ber".as_bytes(), 40), Ok("M117 ?ber".to_owned()));
        assert_eq!(sendable(b"G1 X\xff", 40), Err(LineFault::NotAscii));
        assert_eq!(sendable(b"G1\nM112", 40), Err(LineFault::SeveralLines));
    }

    #[test]
    fn the_longest_command_fills_the_line_and_not_one_byte_more() {
        for number in [0, 9, 10, 99, 12_345, u32::MAX] {
            let command = "X".repeat(room_for_command(number, 96));
            let length = numbered(number, &command).len();
            assert!((94..=96).contains(&length), "{number}: {length}");
        }
    }

    #[test]
    fn an_endless_line_is_dropped_and_the_next_one_read() {
        let mut framer = Framer::default();
        for _ in 0..100_000 {
            assert_eq!(framer.push(b'x'), None);
            assert!(framer.buffer.len() <= MAX_REPLY);
        }
        assert_eq!(framer.push(b'\n'), None);
        assert_eq!(framer.dropped, 1);
        assert_eq!(framer.push(b'o'), None);
        assert_eq!(framer.push(b'k'), None);
        assert_eq!(framer.push(b'\n'), Some("ok".to_owned()));
    }
}
