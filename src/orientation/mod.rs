//! Which way up a part needs the least support.
pub mod exact;
pub mod net;
