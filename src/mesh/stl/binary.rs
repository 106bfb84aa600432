//! The binary form: a header, a count, records of 50 bytes.

use super::{Format, HEADER_BYTES, Parsed, StlError, Welder};
use crate::mesh::weld::{BLOCK, Corners};

/// Bytes of one triangle: normal, three corners, two bytes of attributes.
pub(super) const RECORD_BYTES: usize = 50;

/// Most triangles that room is made for on the word of a header alone.
const TRUSTED_COUNT: u32 = 1 << 16;

/// Reads the records after the header.
pub(super) struct BinaryReader {
    count: u32,
    /// Bytes of the header still to come.
    header_left: usize,
    /// Start of a record whose end is in the next chunk.
    carry: Vec<u8>,
    welder: Welder,
    trailing: u64,
}

impl BinaryReader {
    /// A reader for a file that begins with `prefix` (the header at least), which is not consumed.
    /// Fails when a file of `size` bytes is too short for its count.
    pub(super) fn new(prefix: &[u8], size: Option<u64>) -> Result<BinaryReader, StlError> {
        let count = u32::from_le_bytes([prefix[80], prefix[81], prefix[82], prefix[83]]);
        let room = match size {
            Some(size) => {
                check_size(count, size.saturating_sub(HEADER_BYTES as u64))?;
                count
            }
            None => count.min(TRUSTED_COUNT),
        };
        Ok(BinaryReader {
            count,
            header_left: HEADER_BYTES,
            carry: Vec::with_capacity(RECORD_BYTES),
            welder: Welder::new(room as usize),
            trailing: 0,
        })
    }

    pub(super) fn push(&mut self, bytes: &[u8]) -> Result<(), StlError> {
        let (header, mut bytes) = bytes.split_at(bytes.len().min(self.header_left));
        self.header_left -= header.len();
        if !self.carry.is_empty() {
            let (start, rest) = bytes.split_at(bytes.len().min(RECORD_BYTES - self.carry.len()));
            self.carry.extend_from_slice(start);
            bytes = rest;
            if self.carry.len() < RECORD_BYTES {
                return Ok(());
            }
            let carry = std::mem::take(&mut self.carry);
            self.records(&carry)?;
        }
        self.records(bytes)
    }

    /// Adds the whole records at the start of `bytes` and keeps the rest for the next chunk.
    fn records(&mut self, bytes: &[u8]) -> Result<(), StlError> {
        let wanted = u64::from(self.count) - self.welder.read();
        let (records, rest) = bytes.as_chunks::<RECORD_BYTES>();
        let whole = records.len().min(usize::try_from(wanted).unwrap_or(usize::MAX));
        let mut block = [[[0.0; 3]; 3]; BLOCK];
        for records in records[..whole].chunks(BLOCK) {
            for (place, record) in block.iter_mut().zip(records) {
                *place = corners(record);
            }
            self.welder.add_block(&block[..records.len()])?;
        }
        if self.welder.read() == u64::from(self.count) {
            self.trailing += (bytes.len() - whole * RECORD_BYTES) as u64;
        } else {
            self.carry.extend_from_slice(rest);
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<Parsed, StlError> {
        let read = self.welder.read();
        check_size(self.count, read * RECORD_BYTES as u64 + self.carry.len() as u64)?;
        Ok(Parsed {
            triangles: read,
            degenerate: self.welder.degenerate(),
            mesh: self.welder.finish(),
            format: Format::Binary,
            solids: Vec::new(),
            trailing_bytes: self.trailing,
            endsolid_missing: false,
        })
    }
}

/// Whether `bytes` of records hold `count` of them.
fn check_size(count: u32, bytes: u64) -> Result<(), StlError> {
    let found = bytes / RECORD_BYTES as u64;
    if found >= u64::from(count) {
        return Ok(());
    }
    Err(StlError::Truncated { expected: count, found, partial: !bytes.is_multiple_of(RECORD_BYTES as u64) })
}

/// The three corners of a record; normal and attributes are skipped.
#[inline]
fn corners(record: &[u8; RECORD_BYTES]) -> Corners {
    let number = |at: usize| f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]);
    let corner = |at: usize| [number(at), number(at + 4), number(at + 8)];
    [corner(12), corner(24), corner(36)]
}
