//! Centre lines of beads, in printing order.

mod comb;
pub mod infill;
pub mod ironing;
pub mod medial;
pub mod order;
pub mod overhang;
pub mod prime_tower;
mod route;
pub mod seam;
pub mod spots;
pub mod travel;
pub mod walls;

pub use order::{LayerParts, LayerPaths, order_layer};
pub use travel::Way;
