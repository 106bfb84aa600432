//! What holds up overhangs: full support volumes, to compare with and to choose an orientation by.

pub mod volumes;
