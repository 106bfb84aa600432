//! What a file may hold at most, so that a hostile one cannot take all memory. Real ones stay far below.

/// Bytes that an archive may unfold to in all: the models of the largest printers have a tenth.
pub const UNFOLDED_BYTES: u64 = 1 << 30;

/// How many times larger than the archive its parts may be. Deflate reaches 1032; XML of meshes 4 to 20.
pub const UNFOLDED_RATIO: u64 = 200;

/// Unfolded bytes that are fine whatever the ratio.
pub const UNFOLDED_FREE: u64 = 1 << 20;

/// Files in an archive.
pub const FILES: usize = 10_000;

/// Bytes between two `>` of XML.
pub const ELEMENT_BYTES: usize = 1 << 20;

/// XML elements within each other.
pub const XML_DEPTH: usize = 64;

/// Triangles of a file, after copies are made.
pub const TRIANGLES: usize = 20_000_000;

/// Corners of a file, after copies are made.
pub const VERTICES: usize = 20_000_000;

/// Corners looked at while faces that are not convex are cut into triangles, in a file.
pub const EAR_STEPS: usize = 200_000_000;

/// Components within each other.
pub const COMPONENT_DEPTH: usize = 16;

/// Components and build items followed in all.
pub const COMPONENTS: usize = 10_000;

/// Bytes of a profile.
pub const PROFILE_BYTES: usize = 8 << 20;

/// Farthest corner from the origin, mm; the same as for STL files.
pub const REACH_MM: f64 = 1e6;
