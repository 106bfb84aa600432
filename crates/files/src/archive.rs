//! ZIP archives whose unfolded size is bounded.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Cursor, Error, Read};

use zip::ZipArchive;
use zip::read::ZipFile;

use crate::error::FileError;
use crate::limits::{ELEMENT_BYTES, FILES, UNFOLDED_BYTES, UNFOLDED_FREE, UNFOLDED_RATIO};

/// Whether the bytes begin as a ZIP archive does.
pub(crate) fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

/// An open archive and what may still be unfolded from it.
pub(crate) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Names of its files by the same in small letters.
    names: BTreeMap<String, String>,
    left: u64,
}

impl<'a> Archive<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Archive<'a>, FileError> {
        let broken = |e: zip::result::ZipError| FileError::Archive { cause: e.to_string() };
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
        if zip.len() > FILES {
            return Err(FileError::TooMuch { what: "files in the archive", limit: FILES });
        }
        let by_ratio = UNFOLDED_FREE + UNFOLDED_RATIO * bytes.len() as u64;
        let names = zip.file_names().flatten().map(|n| (n.to_ascii_lowercase(), n.into_owned())).collect();
        Ok(Archive { zip, names, left: by_ratio.min(UNFOLDED_BYTES) })
    }

    /// Names of all files, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.names.values().cloned().collect();
        names.sort();
        names
    }

    /// Whether there is a file of this name, in any case of letters as OPC has it.
    pub(crate) fn find(&self, name: &str) -> Option<String> {
        self.names.get(&name.trim_start_matches('/').to_ascii_lowercase()).cloned()
    }

    /// Hands a file's bytes to `read` as they unfold.
    pub(crate) fn read<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut Bounded<'_, 'a>) -> Result<T, FileError>,
    ) -> Result<T, FileError> {
        let broken = |e: zip::result::ZipError| FileError::Archive { cause: e.to_string() };
        let file = self.zip.by_name(name).map_err(broken)?;
        let mut bounded = Bounded { inner: BufReader::new(file), left: self.left, run: 0, excess: None };
        let result = read(&mut bounded);
        let (left, excess) = (bounded.left, bounded.excess);
        self.left = left;
        match excess {
            Some(Excess::Bytes) => Err(FileError::Bomb { part: name.to_owned() }),
            Some(Excess::Element) => {
                Err(FileError::TooMuch { what: "bytes in one XML element", limit: ELEMENT_BYTES })
            }
            None => result,
        }
    }

    /// A small text file as a whole.
    pub(crate) fn text(&mut self, name: &str, limit: usize) -> Result<String, FileError> {
        let owned = name.to_owned();
        self.read(name, |reader| {
            let mut bytes = Vec::new();
            let broken = |e: Error| FileError::Archive { cause: format!("{owned}: {e}") };
            reader.inner.by_ref().take(limit as u64 + 1).read_to_end(&mut bytes).map_err(broken)?;
            if bytes.len() > limit {
                return Err(FileError::TooMuch { what: "bytes in a profile", limit });
            }
            crate::import::text_of(&bytes)
        })
    }
}

#[derive(Clone, Copy)]
enum Excess {
    Bytes,
    Element,
}

/// A file of an archive that stops with an error where it becomes too large.
pub(crate) struct Bounded<'r, 'a> {
    inner: BufReader<ZipFile<'r, Cursor<&'a [u8]>>>,
    left: u64,
    /// Bytes since the last `>`.
    run: usize,
    excess: Option<Excess>,
}

impl Read for Bounded<'_, '_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let bytes = self.fill_buf()?;
        let count = bytes.len().min(out.len());
        out[..count].copy_from_slice(&bytes[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Bounded<'_, '_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.left == 0 || self.run > ELEMENT_BYTES {
            self.excess = Some(if self.left == 0 { Excess::Bytes } else { Excess::Element });
            return Err(Error::other("too large"));
        }
        self.inner.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        let bytes = &self.inner.buffer()[..count];
        self.run = match bytes.iter().rposition(|&b| b == b'>') {
            Some(at) => count - at - 1,
            None => self.run + count,
        };
        self.left = self.left.saturating_sub(count as u64);
        self.inner.consume(count);
    }
}
