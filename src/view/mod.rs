//! Pictures: scenes of strokes and labels, made from what the stages give, written as SVG or
//! painted by the wasm layer.

pub mod job;
pub mod legend;
pub mod model;
pub mod moves;
pub mod scene;
pub mod svg;

pub use legend::{LegendEntry, legend};
pub use model::{ModelPicture, Viewpoint};
pub use moves::Moves;
pub use scene::{Ink, Item, LineWidth, Scene};
