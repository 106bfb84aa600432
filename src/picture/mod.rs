//! Pictures of models in pixels, drawn on the CPU so that they are the same everywhere, and the files
//! that printers show them from: PNG and QOI thumbnails in the head of the G-code.

mod model;
mod png;
mod qoi;
mod thumbnail;

pub use model::{Camera, ModelPicture, Viewpoint};
pub use png::png;
pub use qoi::qoi;
pub use thumbnail::{Thumbnail, ThumbnailFormat, parse_thumbnails, thumbnail_lines};
