//! Files of other programs: 3MF and OBJ models to triangles in mm, profiles of other slicers to
//! settings. A second wasm module, loaded when such a file is opened.
//!
//! Nothing here knows the engine: a [`Part`] is written as a binary STL ([`stl`]), which every engine
//! reads. Whatever the bytes are, the result is a value or a [`FileError`]; memory is bounded by
//! [`limits`].

mod archive;
mod error;
pub mod import;
pub mod limits;
mod obj;
pub mod stl;
mod threemf;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

pub use error::FileError;
pub use import::{Imported, import};

/// One printable part of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// Its name in the file; empty if it has none.
    pub name: String,
    /// Corners, mm.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of each triangle, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Reads a model: 3MF by its content, OBJ by its name or content. Parts are in the file's order, each
/// with at least one triangle.
pub fn read_model(name: &str, bytes: &[u8]) -> Result<Vec<Part>, FileError> {
    if bytes.is_empty() {
        return Err(FileError::Empty);
    }
    let parts = if archive::is_zip(bytes) {
        threemf::read(bytes)?
    } else if is_obj(name, bytes) {
        vec![obj::read(bytes)?]
    } else {
        return Err(FileError::UnknownFormat);
    };
    if parts.is_empty() { Err(FileError::NoTriangles) } else { Ok(parts) }
}

fn is_obj(name: &str, bytes: &[u8]) -> bool {
    let named = name.len() >= 4 && name.as_bytes()[name.len() - 4..].eq_ignore_ascii_case(b".obj");
    named && !bytes.starts_with(b"solid ")
}
