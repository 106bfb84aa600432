//! Thumbnails in the head of a G-code file, in the form that PrusaSlicer gave them and printers, Moonraker
//! and OctoPrint read (help.prusa3d.com, "Creating profiles for different printers", "G-code thumbnails";
//! moonraker.readthedocs.io, "File management").

use super::{ModelPicture, Viewpoint, png, qoi};
use crate::mesh::Mesh;

/// Most thumbnails of a file.
const MOST: usize = 8;

/// Longest side, pixels: printers' screens have less.
const LONGEST_SIDE: u32 = 1024;

/// Characters of base64 in a line.
const LINE: usize = 78;

/// Colour of a fully lit face.
const TINT: [u8; 3] = [250, 140, 60];

/// How the pixels are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThumbnailFormat {
    /// `; thumbnail begin`.
    Png,
    /// `; thumbnail_QOI begin`.
    Qoi,
}

/// A thumbnail that is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Thumbnail {
    /// Pixels across.
    pub width: u32,
    /// Pixels up.
    pub height: u32,
    /// How they are packed.
    pub format: ThumbnailFormat,
}

/// The thumbnails of a setting such as `16x16/QOI, 220x124/PNG`; PNG where no format is said. The error says
/// what is wrong with it.
pub fn parse_thumbnails(text: &str) -> Result<Vec<Thumbnail>, String> {
    let words = text.split(',').map(str::trim).filter(|word| !word.is_empty());
    let found: Vec<Thumbnail> = words.map(parse_one).collect::<Result<_, _>>()?;
    if found.len() > MOST { Err(format!("more than {MOST} thumbnails")) } else { Ok(found) }
}

fn parse_one(word: &str) -> Result<Thumbnail, String> {
    let (size, format) = word.split_once('/').unwrap_or((word, "PNG"));
    let format = match format.to_ascii_uppercase().as_str() {
        "PNG" => ThumbnailFormat::Png,
        "QOI" => ThumbnailFormat::Qoi,
        other => return Err(format!("{word}: there is PNG and QOI, not {other}")),
    };
    let side = |text: &str| text.parse().ok().filter(|side| (1..=LONGEST_SIDE).contains(side));
    let sides = size.split_once('x').and_then(|(width, height)| side(width).zip(side(height)));
    let (width, height) = sides.ok_or_else(|| {
        format!("{word}: expected a size such as 220x124, each side of 1 to {LONGEST_SIDE} pixels")
    })?;
    Ok(Thumbnail { width, height, format })
}

/// Comment lines with a picture of the mesh in each of these sizes.
pub fn thumbnail_lines(mesh: &Mesh, thumbnails: &[Thumbnail]) -> String {
    if thumbnails.is_empty() {
        return String::new();
    }
    let picture = ModelPicture::new(mesh, Viewpoint::Iso);
    thumbnails.iter().map(|it| lines_of(&picture, it)).collect()
}

fn lines_of(picture: &ModelPicture, &Thumbnail { width, height, format }: &Thumbnail) -> String {
    let pixels = picture.fitted(width as usize, height as usize, TINT);
    let (tag, file) = match format {
        ThumbnailFormat::Png => ("thumbnail", png(&pixels, width, height)),
        ThumbnailFormat::Qoi => ("thumbnail_QOI", qoi(&pixels, width, height)),
    };
    let text = base64(&file);
    let mut lines = format!(";\n; {tag} begin {width}x{height} {}\n", text.len());
    for line in text.as_bytes().chunks(LINE) {
        lines.push_str("; ");
        lines.extend(line.iter().map(|&b| char::from(b)));
        lines.push('\n');
    }
    lines + &format!("; {tag} end\n;\n\n")
}

/// Base64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let all = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(all >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_formats_are_read() {
        let found = parse_thumbnails(" 16x16/QOI, 220x124 ,").expect("good");
        let small = Thumbnail { width: 16, height: 16, format: ThumbnailFormat::Qoi };
        let large = Thumbnail { width: 220, height: 124, format: ThumbnailFormat::Png };
        assert_eq!(found, [small, large]);
        assert_eq!(parse_thumbnails(""), Ok(Vec::new()));
        for bad in ["16", "0x5", "16x16/JPG", "2000x10", "-1x4", "1x1,".repeat(9).as_str()] {
            assert!(parse_thumbnails(bad).is_err(), "{bad}");
        }
    }

    /// The examples of RFC 4648, section 10.
    #[test]
    fn base64_of_the_standard() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
