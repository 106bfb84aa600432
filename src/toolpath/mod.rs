//! Centre lines of beads, in printing order.

pub mod bead;
pub mod infill;
pub mod medial;
pub mod order;
pub mod seam;
pub mod walls;

pub use bead::Bead;
pub use order::{LayerParts, LayerPaths, order_layer};
