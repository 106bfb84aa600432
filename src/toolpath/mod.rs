//! Centre lines of beads, in printing order.

pub mod medial;
