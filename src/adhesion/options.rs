//! The settings under `adhesion`.

crate::words! {
    /// What holds the part on the bed.
    pub enum AdhesionKind {
        /// Nothing but the part itself.
        None = "none",
        /// Loops around everything that touch nothing: they fill the nozzle and show the level.
        Skirt = "skirt",
        /// Loops that touch the outline.
        Brim = "brim",
        /// Layers below the part, with an air gap.
        Raft = "raft",
        /// A rail with teeth that bite into the outline and break off [Lv 2022].
        #[default]
        Teeth = "teeth",
    }
}

impl AdhesionKind {
    /// The kinds that lay something, cheapest hold first.
    pub const LAID: [AdhesionKind; 4] =
        [AdhesionKind::Skirt, AdhesionKind::Brim, AdhesionKind::Raft, AdhesionKind::Teeth];
}

crate::words! {
    /// Which outlines a brim touches.
    pub enum BrimSide {
        /// Around the part.
        #[default]
        Outer = "outer",
        /// Inside its holes.
        Inner = "inner",
        /// Around the part and inside its holes.
        Both = "both",
    }
}

crate::words! {
    /// Where teeth stand along the rail.
    pub enum Placement {
        /// [Lv 2022] to the letter: each edge of the rail by itself. To learn from, not to print with.
        PerEdge = "per_edge",
        /// At equal arc length along smooth stretches, every tip at the same depth in the part.
        #[default]
        AlongContour = "along_contour",
    }
}

crate::options! {
    /// What holds the part on the bed.
    pub struct AdhesionOptions {
        /// What is laid around or below the part.
        kind: AdhesionKind = AdhesionKind::Teeth, "Bed adhesion";
        /// Loops that touch nothing.
        skirt: group SkirtOptions;
        /// Loops that touch the part.
        brim: group BrimOptions;
        /// Layers below the part.
        raft: group RaftOptions;
        /// The brim that tears off.
        teeth: group TeethOptions;
    }
}

crate::options! {
    /// Loops around everything on the bed.
    pub struct SkirtOptions {
        /// From the convex outline of everything on the bed to the edge of the nearest loop.
        distance: f64 = 2.0, "Distance", "mm", 0.0..=100.0;
        /// Loops are added until they are at least this long together; 0 adds none.
        min_length: f64 = 250.0, "Minimum length", "mm", 0.0..=10000.0;
        /// Loops, before any are added for the minimum length.
        loops: u32 = 1, "Loops", "", 1.0..=20.0;
    }
}

crate::options! {
    /// Loops that touch the first layer.
    pub struct BrimOptions {
        /// From the outline (and gap) to the brim's outer edge; rounded to whole lines, at least one.
        width: f64 = 8.0, "Width", "mm", 0.1..=100.0;
        /// Air between outline and brim; 0 lets them touch.
        gap: f64 = 0.0, "Gap", "mm", 0.0..=5.0;
        /// Width of the brim's lines.
        line_width: f64 = 0.4, "Line width", "mm", 0.1..=2.0;
        /// Around the part, in its holes, or both.
        side: BrimSide = BrimSide::Outer, "Side";
        /// Only round pads at sharp convex corners.
        ears: bool = false, "Only at sharp corners";
        /// Corners of the part with a smaller inner angle get an ear.
        ears_max_angle_deg: f64 = 125.0, "Sharpest angle without ear", "deg", 1.0..=179.0;
    }
}

crate::options! {
    /// Layers below the part.
    pub struct RaftOptions {
        /// Layers of the raft: one base layer, the others dense interface; 1 is interface alone.
        layers: u32 = 2, "Layers", "", 1.0..=20.0;
        /// How far the raft reaches beyond the part.
        margin: f64 = 15.0, "Margin", "mm", 0.0..=100.0;
        /// Air between raft and part, so that they come apart.
        gap: f64 = 0.2, "Air gap", "mm", 0.0..=2.0;
        /// Height of the layers above the first.
        layer_height: f64 = 0.2, "Layer height", "mm", 0.01..=2.0;
        /// Width of the base layer's lines.
        base_line_width: f64 = 0.6, "Base line width", "mm", 0.1..=3.0;
        /// Share of the base layer that is covered.
        base_density: f64 = 0.7, "Base density", "", 0.1..=1.0;
        /// Width of the interface's lines.
        interface_line_width: f64 = 0.4, "Interface line width", "mm", 0.1..=2.0;
        /// Share of the interface that is covered.
        interface_density: f64 = 1.0, "Interface density", "", 0.1..=1.0;
    }
}

crate::options! {
    /// The tear-off brim of teeth; symbols as in [Lv 2022].
    pub struct TeethOptions {
        /// d: from the outline to the rail's centre line.
        offset: f64 = 2.0, "Rail distance", "mm", 0.1..=20.0;
        /// d1: length of a tooth's base on the rail; less than the pitch.
        base: f64 = 3.0, "Tooth base", "mm", 0.1..=50.0;
        /// d2: distance from tooth to tooth.
        pitch: f64 = 5.0, "Tooth pitch", "mm", 0.2..=100.0;
        /// H: from the rail to the tip; what exceeds the rail distance is the bite.
        height: f64 = 2.4, "Tooth height", "mm", 0.1..=40.0;
        /// Lmin: shorter edges of the rail may be merged (placement per_edge).
        simplify_length: f64 = 0.5, "Simplify: length", "mm", 0.0..=5.0;
        /// Hmin: and only where they bulge less (placement per_edge).
        simplify_height: f64 = 0.05, "Simplify: height", "mm", 0.0..=1.0;
        /// How teeth are distributed along the rail.
        placement: Placement = Placement::AlongContour, "Placement";
        /// Also in holes and in the counters of letters.
        holes: bool = false, "Teeth in holes";
        /// Layers of teeth on top of each other; more hold nylon and ABS.
        layers: u32 = 1, "Layers", "", 1.0..=3.0;
        /// Loops of rail, so that the strip comes off in one piece.
        rail_lines: u32 = 1, "Rail lines", "", 1.0..=5.0;
        /// A tab on every rail to pull it off by.
        tab: bool = false, "Pull tab";
    }
}

impl AdhesionOptions {
    /// How far the base layer reaches at most beyond parts whose boxes have a side of at least `side` mm;
    /// `line_width` is `first_layer.line_width`, mm.
    pub fn reach(&self, side: f64, line_width: f64) -> f64 {
        let AdhesionOptions { skirt, brim, raft, teeth, .. } = self;
        match self.kind {
            AdhesionKind::None => 0.0,
            AdhesionKind::Skirt => {
                // A loop around a box is at least twice as long as its longer side.
                let for_length = (skirt.min_length / (2.0 * side).max(1.0)).ceil();
                skirt.distance + for_length.max(f64::from(skirt.loops)) * line_width
            }
            AdhesionKind::Brim => brim.gap + brim.width + brim.line_width,
            AdhesionKind::Raft => raft.margin + raft.base_line_width,
            AdhesionKind::Teeth => {
                let tab = if teeth.tab { super::teeth::tab::LENGTH_MM } else { 0.0 };
                teeth.offset + f64::from(teeth.rail_lines) * line_width + tab
            }
        }
    }
}
