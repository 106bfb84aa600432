//! Foothold: a slicer that runs in a web page. See `docs/architecture.md`.

pub mod printer;
