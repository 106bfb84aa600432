//! Centre lines of beads, in printing order.

pub mod bead;
pub mod infill;
pub mod walls;
