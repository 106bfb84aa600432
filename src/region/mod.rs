//! What each area of a layer is for.

mod bead;
pub mod bridge;
pub mod first_layer;
pub mod overhang;
mod path;
mod reach;
pub mod shell;

use crate::polygon::PolygonSet;
pub use bead::Bead;
pub use path::{Path, Width};

/// An area of a layer and what it is for.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// What the area is for.
    pub role: Role,
    /// The area, mm.
    pub area: PolygonSet,
}

/// What a region or a path is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Role {
    /// The loop that is seen from outside.
    OuterWall,
    /// Loops inside the outer wall.
    InnerWall,
    /// A stretch of wall with too little below it.
    OverhangWall,
    /// What is left between beads, filled with a bead of fitting width.
    GapFill,
    /// Solid area with nothing below.
    BottomSkin,
    /// Solid area with nothing above.
    TopSkin,
    /// Solid area between skins and infill.
    SolidInfill,
    /// Sparse infill.
    Infill,
    /// Lines held at both ends only.
    Bridge,
    /// Smoothing pass over a top.
    Ironing,
    /// Loops around everything that touch nothing.
    Skirt,
    /// Loops that touch the first layer.
    Brim,
    /// The tear-off brim of teeth.
    Teeth,
    /// Layers below the part.
    Raft,
    /// Supports.
    Support,
    /// Dense support layers next to the part.
    SupportInterface,
    /// The line that fills the nozzle before the print.
    Prime,
    /// Where a tool is cleaned after a change.
    WipeTower,
}

impl Role {
    /// All roles, in the order of the report.
    pub const ALL: [Role; 18] = [
        Role::OuterWall,
        Role::InnerWall,
        Role::OverhangWall,
        Role::GapFill,
        Role::BottomSkin,
        Role::TopSkin,
        Role::SolidInfill,
        Role::Infill,
        Role::Bridge,
        Role::Ironing,
        Role::Skirt,
        Role::Brim,
        Role::Teeth,
        Role::Raft,
        Role::Support,
        Role::SupportInterface,
        Role::Prime,
        Role::WipeTower,
    ];

    /// The role's name in reports and settings, such as `outer_wall`.
    pub const fn name(self) -> &'static str {
        match self {
            Role::OuterWall => "outer_wall",
            Role::InnerWall => "inner_wall",
            Role::OverhangWall => "overhang_wall",
            Role::GapFill => "gap_fill",
            Role::BottomSkin => "bottom_skin",
            Role::TopSkin => "top_skin",
            Role::SolidInfill => "solid_infill",
            Role::Infill => "infill",
            Role::Bridge => "bridge",
            Role::Ironing => "ironing",
            Role::Skirt => "skirt",
            Role::Brim => "brim",
            Role::Teeth => "teeth",
            Role::Raft => "raft",
            Role::Support => "support",
            Role::SupportInterface => "support_interface",
            Role::Prime => "prime",
            Role::WipeTower => "wipe_tower",
        }
    }
}
