//! The settings under `support`.

crate::words! {
    /// What holds up overhangs.
    pub enum SupportMethod {
        /// Nothing.
        #[default]
        None = "none",
        /// Thin crossing plates [Zhao].
        Plates = "plates",
        /// A plain grid below everything that hangs, to compare with.
        Grid = "grid",
    }
}

crate::options! {
    /// Supports below overhangs.
    pub struct SupportOptions {
        /// What holds up overhangs.
        method: SupportMethod = SupportMethod::None, "Supports";
        /// Surfaces that lean less than this from the vertical hold themselves; 0 supports every
        /// downward surface.
        overhang_angle_deg: f64 = 45.0, "Overhang angle", "degrees", 0.0..=89.0;
        /// Air above and below supports, rounded up to whole layers.
        gap_z: f64 = 0.2, "Vertical gap", "mm", 0.0..=5.0;
        /// Air between supports and the part beside them.
        gap_xy: f64 = 0.4, "Sideways gap", "mm", 0.0..=5.0;
        /// Dense layers below the part; 0 lets it lie on the bare supports.
        interface_layers: u32 = 2, "Interface layers", "", 0.0..=20.0;
        /// Supports may also stand on the part; off: only on the bed.
        everywhere: bool = true, "Also on the part";
        /// Also in cavities that are closed all around and could never be emptied.
        internal: bool = false, "Also in closed cavities";
        /// The extruder that prints supports: 0, or 1 for a second material.
        tool: u32 = 0, "Extruder for supports", "", 0.0..=1.0;
        /// Width of a support's line.
        line_width: f64 = 0.4, "Line width", "mm", 0.1..=2.0;
        /// Thin crossing plates.
        plates: group PlateOptions;
        /// A plain grid.
        grid: group GridOptions;
        /// Boxes [x0, y0, z0, x1, y1, z1], mm on the bed, in which every downward surface is held.
        enforcers: Vec<[f64; 6]> = Vec::new(), "Boxes with supports";
        /// Boxes [x0, y0, z0, x1, y1, z1], mm on the bed, in which nothing is held; they win.
        blockers: Vec<[f64; 6]> = Vec::new(), "Boxes without supports";
    }
}

crate::options! {
    /// Thin crossing plates; names as in [Zhao].
    pub struct PlateOptions {
        /// Distance between the planes x = const; at least a plate's thickness.
        spacing_x: f64 = 4.0, "Spacing along x", "mm", 0.1..=100.0;
        /// Distance between the planes y = const; at least a plate's thickness.
        spacing_y: f64 = 4.0, "Spacing along y", "mm", 0.1..=100.0;
        /// Pieces that stand on the bed no farther apart than this are joined by low walls, so that they
        /// come off together; 0 joins none.
        join_distance: f64 = 20.0, "Join pieces up to", "mm", 0.0..=200.0;
        /// Lines side by side in a plate.
        thickness: u32 = 1, "Thickness in lines", "", 1.0..=3.0;
    }
}

crate::options! {
    /// A plain grid of lines.
    pub struct GridOptions {
        /// Distance between lines; at least a line's width.
        spacing: f64 = 2.5, "Spacing", "mm", 0.1..=100.0;
    }
}
