//! Foothold: a slicer that runs in a web page.
//!
//! Data flows one way, and each arrow is a function from a plain value to a plain value:
//!
//! ```text
//! STL bytes -> mesh -> slice -> region, adhesion -> toolpath -> gcode -> printer
//! ```
//!
//! - [`mesh`]: triangles in space; reading, welding, checking and repairing an STL.
//! - [`slice`]: the mesh cut by planes: closed contours in the plane.
//! - [`region`]: which area of a layer is for what ([`region::Role`]).
//! - [`adhesion`]: what holds the part on the bed: skirt and its kin.
//! - [`toolpath`]: centre lines of beads in printing order.
//! - [`gcode`]: moves with speed and extrusion, then text.
//! - [`printer`]: the serial protocol, without any I/O.
//! - [`picture`]: models in pixels, thumbnails.
//! - [`settings`], [`pipeline`], [`view`]: the options of all stages, the list of steps, pictures.
//!
//! Units inside are millimetres, seconds, radians and mm/s; other units stand in the name
//! (`angle_deg`). Mesh vertices are `Vec3` (f32, as in STL); everything in the plane is `DVec2`
//! on a grid of [`polygon::GRID_MM`]. Equal input gives equal bytes, natively and as wasm: no clock,
//! no randomness, no hash-map order, no platform sine ([`polygon::trig`]).

pub mod printer;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

#[cfg(feature = "slicer")]
pub mod adhesion;
#[cfg(feature = "slicer")]
pub mod gcode;
#[cfg(feature = "slicer")]
pub mod mesh;
#[cfg(feature = "slicer")]
pub mod options;
#[cfg(feature = "slicer")]
pub mod orientation;
#[cfg(feature = "slicer")]
pub mod picture;
#[cfg(feature = "slicer")]
pub mod pipeline;
#[cfg(feature = "slicer")]
pub mod polygon;
#[cfg(feature = "slicer")]
pub mod region;
#[cfg(feature = "slicer")]
mod sets;
#[cfg(feature = "slicer")]
pub mod settings;
#[cfg(feature = "slicer")]
pub mod slice;
mod sort;
#[cfg(feature = "slicer")]
pub mod support;
#[cfg(feature = "slicer")]
pub mod toolpath;
#[cfg(feature = "slicer")]
pub mod view;
