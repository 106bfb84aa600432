//! Why a file is refused.

use std::fmt;

/// Why a file is refused. `Display` gives the text that follows the file's name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileError {
    /// No bytes at all.
    Empty,
    /// No format that is read here.
    UnknownFormat,
    /// A ZIP archive that cannot be opened, such as one that is cut off.
    Archive {
        /// What is wrong with it.
        cause: String,
    },
    /// An archive that has no 3D model.
    NotThreeMf,
    /// An archive that unfolds to more than [`crate::limits`] allow.
    Bomb {
        /// File inside the archive.
        part: String,
    },
    /// XML that cannot be read.
    Xml {
        /// File inside the archive.
        part: String,
        /// What is wrong and where.
        cause: String,
    },
    /// Something the format demands is missing or wrong.
    Malformed {
        /// File inside the archive, or the line of a text file.
        place: String,
        /// What is wrong.
        cause: String,
    },
    /// The file needs an extension of the format that is not known here.
    Extension {
        /// Its name.
        name: String,
    },
    /// More than [`crate::limits`] allow.
    TooMuch {
        /// What there is too much of.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// Nothing to print.
    NoTriangles,
    /// A text that is not in UTF-8.
    Encoding {
        /// What it seems to be instead.
        seems: &'static str,
    },
    /// A profile of no slicer that is known here.
    UnknownProfile,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FileError::Empty => write!(f, "empty: the file has no bytes"),
            FileError::UnknownFormat => write!(f, "neither STL, 3MF nor OBJ"),
            FileError::Archive { cause } => write!(f, "damaged ZIP archive: {cause}"),
            FileError::NotThreeMf => write!(f, "a ZIP archive without a 3D model: not a 3MF file"),
            FileError::Bomb { part } => {
                write!(f, "{part} unfolds to far more than a model needs: refused")
            }
            FileError::Xml { part, cause } => write!(f, "{part}: not readable as XML: {cause}"),
            FileError::Malformed { place, cause } => write!(f, "{place}: {cause}"),
            FileError::Extension { name } => {
                write!(f, "needs the 3MF extension {name}, which is not supported")
            }
            FileError::TooMuch { what, limit } => write!(f, "more than {limit} {what}"),
            FileError::NoTriangles => write!(f, "no triangles: there is nothing to print"),
            FileError::Encoding { seems } => write!(f, "not UTF-8 text: it seems to be {seems}"),
            FileError::UnknownProfile => {
                write!(f, "no profile of PrusaSlicer, OrcaSlicer or Cura was recognised")
            }
        }
    }
}

impl std::error::Error for FileError {}
