//! Pictures: scenes of strokes and labels, made from what the stages give, written as SVG or
//! painted by the wasm layer.

pub mod base_layer;
pub mod job;
pub mod legend;
pub mod lesson;
pub mod moves;
pub mod plane;
pub mod scene;
pub mod svg;

pub use legend::{LegendEntry, legend};
pub use lesson::Step;
pub use moves::Moves;
pub use plane::PlaneDetail;
pub use scene::{Anchor, Ink, Item, LineWidth, Scene};
pub use svg::Paper;
