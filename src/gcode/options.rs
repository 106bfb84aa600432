//! What printer, filament, speeds and retraction a file is written for.

use super::cooling::CoolingOptions;
use super::events::LayerEvent;
use super::flavor::Flavor;
use super::label::LabelledObject;
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, dvec2};
use crate::region::Role;

/// Start code of [`PrinterOptions`]: bed, home, nozzle, in this order.
const START_GCODE: &str = "\
M140 S{first_layer_bed_temp} ; heat the bed
M190 S{first_layer_bed_temp} ; wait for the bed
G28 ; home all axes
G1 Z5 F600 ; away from the bed while the nozzle heats
M109 S{first_layer_nozzle_temp} ; heat the nozzle and wait
";

/// End code of [`PrinterOptions`]: heaters off, head away, bed forward, motors off.
const END_GCODE: &str = "\
M104 S0 ; nozzle off
M140 S0 ; bed off
M107 ; fan off
G1 Z{park_z} F600 ; away from the part
G1 X{park_x} Y{park_y} F6000 ; present the part
M84 ; motors off
";

crate::words! {
    /// Outline of a bed.
    pub enum BedShape {
        /// A rectangle of `bed_size`.
        #[default]
        Rectangle = "rectangle",
        /// An ellipse with the diameters of `bed_size`: a circle on nearly every delta.
        Round = "round",
    }
}

crate::words! {
    /// Where on the bed X0 Y0 is.
    pub enum Origin {
        /// The front left corner.
        #[default]
        Corner = "corner",
        /// The middle, as on a delta.
        Center = "center",
    }
}

crate::options! {
    /// The machine: its size, its firmware and what it can do.
    pub struct PrinterOptions {
        /// Size of the bed along x and y.
        bed_size: [f64; 2] = [220.0, 220.0], "Bed size", "mm", 10.0..=5000.0;
        /// Outline of the bed.
        bed_shape: BedShape = BedShape::Rectangle, "Bed shape";
        /// Where on the bed X0 Y0 is.
        origin: Origin = Origin::Corner, "Origin";
        /// Rectangles of the bed where nothing may be printed, each as smallest x and y, largest x and y
        /// in the printer's coordinates, mm.
        forbidden: Vec<[f64; 4]> = Vec::new(), "Forbidden zones";
        /// Highest print.
        height: f64 = 250.0, "Print height", "mm", 10.0..=5000.0;
        /// How far the head reaches from the nozzle to any side. Models that are printed one after another
        /// (print.sequence) must be that far apart.
        extruder_clearance_radius: f64 = 45.0, "Clearance around the nozzle", "mm", 0.0..=500.0;
        /// From the nozzle's tip up to what reaches across the bed, such as the gantry. Of models that are
        /// printed one after another only the tallest may be higher.
        extruder_clearance_height: f64 = 25.0, "Clearance below the gantry", "mm", 0.0..=5000.0;
        /// Number of extruders. The second one may print supports (support.tool).
        extruders: u32 = 1, "Extruders", "", 1.0..=2.0;
        /// What a change of tools takes, without heating; only the time estimate needs it.
        tool_change_time: f64 = 5.0, "Time of a tool change", "s", 0.0..=600.0;
        /// Diameter of the nozzle's hole.
        nozzle_diameter: f64 = 0.4, "Nozzle diameter", "mm", 0.1..=3.0;
        /// Hottest that the nozzle may get.
        max_nozzle_temp: f64 = 300.0, "Hottest nozzle", "degrees C", 0.0..=500.0;
        /// Hottest that the bed gets.
        max_bed_temp: f64 = 120.0, "Hottest bed", "degrees C", 0.0..=200.0;
        /// The firmware whose dialect is written.
        flavor: Flavor = Flavor::Marlin, "Firmware";
        /// G-code before the print. Words in braces such as {bed_temp} are replaced. Heating is added
        /// where it is missing, so that nothing is extruded cold.
        start_gcode: String = START_GCODE.to_owned(), "Start G-code";
        /// G-code after the print, with the same {placeholders}. Switching off is added where it is missing.
        end_gcode: String = END_GCODE.to_owned(), "End G-code";
        /// Whether each object's moves are marked, so that the printer can give up one and finish the rest.
        label_objects: bool = false, "Label objects";
        /// Length of the line that fills the nozzle, drawn along the front edge after the start code; 0
        /// draws none. None is drawn either if the start code extrudes something itself.
        prime_length: f64 = 80.0, "Prime line", "mm", 0.0..=1000.0;
        /// Acceleration while printing.
        acceleration: f64 = 1500.0, "Acceleration", "mm/s2", 10.0..=100000.0;
        /// Acceleration of moves without extrusion.
        travel_acceleration: f64 = 1500.0, "Travel acceleration", "mm/s2", 10.0..=100000.0;
        /// Acceleration of the filament in retractions.
        retract_acceleration: f64 = 1500.0, "Retraction acceleration", "mm/s2", 10.0..=100000.0;
        /// Acceleration of the z axis.
        z_acceleration: f64 = 100.0, "Z acceleration", "mm/s2", 1.0..=100000.0;
        /// Highest speed of the x and of the y axis.
        max_speed_xy: f64 = 300.0, "Highest speed x, y", "mm/s", 1.0..=5000.0;
        /// Highest speed of the z axis.
        max_speed_z: f64 = 10.0, "Highest speed z", "mm/s", 0.1..=1000.0;
        /// Highest speed of the filament.
        max_speed_e: f64 = 60.0, "Highest speed of the filament", "mm/s", 0.1..=1000.0;
        /// How far the head may in theory leave a corner on the inside, as Marlin's M205 J; it sets the
        /// speed in corners, and here only the time estimate.
        junction_deviation: f64 = 0.013, "Junction deviation", "mm", 0.001..=0.5;
    }
}

crate::options! {
    /// The material.
    pub struct FilamentOptions {
        /// Name of the material, for file names and {filament_type}.
        material: String = "PLA".to_owned(), "Material";
        /// Diameter of the filament.
        diameter: f64 = 1.75, "Filament diameter", "mm", 0.5..=5.0;
        /// Nozzle temperature from the second layer on.
        nozzle_temp: f64 = 210.0, "Nozzle temperature", "degrees C", 0.0..=500.0;
        /// Bed temperature from the second layer on; 0 leaves the bed cold.
        bed_temp: f64 = 60.0, "Bed temperature", "degrees C", 0.0..=200.0;
        /// Nozzle temperature on the first layer.
        first_layer_nozzle_temp: f64 = 210.0, "First layer nozzle temperature", "degrees C", 0.0..=500.0;
        /// Bed temperature on the first layer; 0 leaves the bed cold.
        first_layer_bed_temp: f64 = 60.0, "First layer bed temperature", "degrees C", 0.0..=200.0;
        /// Nozzle temperature while another tool prints; 0 keeps it as hot as for printing.
        standby_temp: f64 = 0.0, "Standby temperature", "degrees C", 0.0..=500.0;
        /// Nozzle temperatures that suit the material, lowest and highest.
        nozzle_temp_range: [f64; 2] = [190.0, 230.0], "Nozzle temperatures that suit", "degrees C", 0.0..=500.0;
        /// Bed temperatures that suit the material, lowest and highest.
        bed_temp_range: [f64; 2] = [0.0, 70.0], "Bed temperatures that suit", "degrees C", 0.0..=200.0;
        /// Mass per volume.
        density: f64 = 1.24, "Density", "g/cm3", 0.1..=20.0;
        /// Price of a kilogram, in any currency.
        cost_per_kg: f64 = 20.0, "Cost per kilogram", "", 0.0..=100000.0;
        /// Most plastic that the nozzle melts in a second; speeds are lowered to keep within it.
        max_volumetric_speed: f64 = 12.0, "Highest volumetric speed", "mm3/s", 0.1..=1000.0;
        /// Fan while printing, as a share of full speed.
        fan_speed: f64 = 1.0, "Fan", "", 0.0..=1.0;
        /// Fan on layers that take `cooling.min_layer_time` or less, as a share of full speed; less than
        /// `fan_speed` counts as that.
        max_fan_speed: f64 = 0.0, "Fan on short layers", "", 0.0..=1.0;
        /// Fan on bridges and overhanging walls, as a share of full speed.
        bridge_fan_speed: f64 = 1.0, "Fan on bridges", "", 0.0..=1.0;
        /// Linear (pressure) advance, set at the start; 0 leaves the printer's own. The unit is the
        /// firmware's: s nearly everywhere.
        pressure_advance: f64 = 0.0, "Pressure advance", "s", 0.0..=5.0;
        /// Number of layers at the bottom that are printed without fan.
        fan_first_layers: u32 = 1, "Layers without fan", "", 0.0..=1000.0;
        /// Number of the layer, counted from 1, at which the fan has risen to its speed; layers before
        /// it and after those without fan get an even share. 0 turns the fan on at once.
        fan_full_layer: u32 = 0, "Layer of full fan", "", 0.0..=1000.0;
    }
}

crate::options! {
    /// How fast each kind of bead is printed. The first layer has its own, lower limit, and
    /// `filament.max_volumetric_speed` holds everywhere.
    pub struct SpeedOptions {
        /// The loop that is seen from outside.
        outer_wall: f64 = 30.0, "Outer wall", "mm/s", 1.0..=2000.0;
        /// Loops inside the outer wall.
        inner_wall: f64 = 50.0, "Inner walls", "mm/s", 1.0..=2000.0;
        /// Stretches of wall with nothing below them. Stretches of which a half or three quarters hang
        /// over are that much on the way from the outer wall's speed to this one.
        overhang_wall: f64 = 20.0, "Overhanging walls", "mm/s", 1.0..=2000.0;
        /// Beads that fill what is left between others.
        gap_fill: f64 = 30.0, "Gap fill", "mm/s", 1.0..=2000.0;
        /// Solid areas with nothing below.
        bottom_skin: f64 = 40.0, "Bottom skin", "mm/s", 1.0..=2000.0;
        /// Solid areas with nothing above.
        top_skin: f64 = 30.0, "Top skin", "mm/s", 1.0..=2000.0;
        /// Solid areas between skins and infill.
        solid_infill: f64 = 50.0, "Solid infill", "mm/s", 1.0..=2000.0;
        /// Sparse infill.
        infill: f64 = 60.0, "Infill", "mm/s", 1.0..=2000.0;
        /// Lines held at both ends only.
        bridge: f64 = 25.0, "Bridges", "mm/s", 1.0..=2000.0;
        /// Smoothing pass over a top.
        ironing: f64 = 15.0, "Ironing", "mm/s", 1.0..=2000.0;
        /// Loops around everything that touch nothing.
        skirt: f64 = 40.0, "Skirt", "mm/s", 1.0..=2000.0;
        /// Loops that touch the first layer.
        brim: f64 = 40.0, "Brim", "mm/s", 1.0..=2000.0;
        /// The tear-off brim of teeth.
        teeth: f64 = 40.0, "Teeth", "mm/s", 1.0..=2000.0;
        /// Layers below the part.
        raft: f64 = 40.0, "Raft", "mm/s", 1.0..=2000.0;
        /// Supports.
        support: f64 = 50.0, "Support", "mm/s", 1.0..=2000.0;
        /// Dense support layers next to the part.
        support_interface: f64 = 40.0, "Support interface", "mm/s", 1.0..=2000.0;
        /// The line that fills the nozzle.
        prime: f64 = 20.0, "Prime line", "mm/s", 1.0..=2000.0;
        /// Where a tool is cleaned.
        wipe_tower: f64 = 50.0, "Wipe tower", "mm/s", 1.0..=2000.0;
        /// Moves without extrusion.
        travel: f64 = 150.0, "Travel", "mm/s", 1.0..=2000.0;
        /// Moves of the z axis, as far as the printer allows.
        travel_z: f64 = 10.0, "Travel along z", "mm/s", 0.1..=1000.0;
    }
}

crate::options! {
    /// Filament pulled back for travels.
    pub struct RetractionOptions {
        /// How far the filament is pulled back; 0 never retracts.
        length: f64 = 0.8, "Retraction length", "mm", 0.0..=50.0;
        /// Speed of the filament, back and forth.
        speed: f64 = 35.0, "Retraction speed", "mm/s", 0.1..=500.0;
        /// How far the nozzle is lifted for a travel with retraction; 0 stays on the layer.
        z_hop: f64 = 0.0, "Z hop", "mm", 0.0..=10.0;
        /// How far the filament is pulled back before another tool takes over.
        tool_change_length: f64 = 10.0, "Retraction before a tool change", "mm", 0.0..=100.0;
        /// Shorter travels are made without retraction.
        min_travel: f64 = 1.5, "Shortest travel with retraction", "mm", 0.0..=1000.0;
        /// Moves the nozzle over the bead just printed while the filament is pulled back, so that what
        /// oozes is left there.
        wipe: bool = false, "Wipe";
        /// How far it moves.
        wipe_distance: f64 = 2.0, "Wipe distance", "mm", 0.0..=100.0;
    }
}

crate::options! {
    /// How fast beads of a kind gather speed; 0 takes `printer.acceleration`, as every kind without a
    /// setting of its own does.
    pub struct AccelerationOptions {
        /// All beads of the first layer.
        first_layer: f64 = 0.0, "First layer", "mm/s2", 0.0..=100000.0;
        /// The loop that is seen from outside.
        outer_wall: f64 = 0.0, "Outer wall", "mm/s2", 0.0..=100000.0;
        /// Loops inside the outer wall.
        inner_wall: f64 = 0.0, "Inner walls", "mm/s2", 0.0..=100000.0;
        /// Bridges and overhanging walls.
        bridge: f64 = 0.0, "Bridges", "mm/s2", 0.0..=100000.0;
        /// Top skin and ironing.
        top_skin: f64 = 0.0, "Top skin", "mm/s2", 0.0..=100000.0;
        /// Solid infill and bottom skin.
        solid_infill: f64 = 0.0, "Solid infill", "mm/s2", 0.0..=100000.0;
        /// Sparse infill.
        infill: f64 = 0.0, "Infill", "mm/s2", 0.0..=100000.0;
        /// Supports.
        support: f64 = 0.0, "Support", "mm/s2", 0.0..=100000.0;
    }
}

crate::options! {
    /// What the file holds besides the moves of the print.
    pub struct OutputOptions {
        /// Writes beads that follow a circle as arcs, G2 and G3: smaller files that older boards read
        /// faster. A firmware that is not known to take arcs gets none.
        arc_fitting: bool = false, "Arcs";
        /// How far an arc may be from the straight pieces that it replaces.
        arc_tolerance: f64 = 0.0125, "Arc tolerance", "mm", 0.001..=0.02;
        /// Pictures of the part in the head of the file for printers that show them: sizes in pixels with
        /// PNG or QOI, such as `16x16/QOI, 220x124/PNG`; empty for none.
        thumbnails: String = String::new(), "Thumbnails";
        /// Pauses, changes of filament and lines of your own, each before a layer given by its number
        /// (counted from 0) or by a height: `[{"layer": 10, "kind": "pause"}, {"z": 5, "kind":
        /// "filament_change"}, {"z": 8, "kind": "custom", "gcode": "M117 half-way"}]`.
        events: Vec<LayerEvent> = Vec::new(), "At layers";
    }
}

impl AccelerationOptions {
    /// Acceleration asked for beads of a role, mm/s2; 0 takes the printer's.
    pub fn of(&self, role: Role) -> f64 {
        match role {
            Role::OuterWall => self.outer_wall,
            Role::InnerWall => self.inner_wall,
            Role::Bridge | Role::OverhangWall => self.bridge,
            Role::TopSkin | Role::Ironing => self.top_skin,
            Role::SolidInfill | Role::BottomSkin => self.solid_infill,
            Role::Infill => self.infill,
            Role::Support | Role::SupportInterface => self.support,
            Role::GapFill
            | Role::Skirt
            | Role::Brim
            | Role::Teeth
            | Role::Raft
            | Role::Prime
            | Role::WipeTower => 0.0,
        }
    }
}

impl PrinterOptions {
    /// What is asked of the firmware for beads of this acceleration, whole mm/s2. One that knows a
    /// single value for all moves gets no more than travels may have, as Klipper itself reads M204 P T.
    pub(crate) fn bead_acceleration(&self, acceleration: f64) -> u32 {
        let own = self.flavor.dialect().travel_acceleration;
        let most = if own { f64::INFINITY } else { self.travel_acceleration };
        acceleration.min(most).round() as u32
    }
}

impl PrinterOptions {
    /// The smallest rectangle around the bed, in the printer's coordinates, mm.
    pub fn bed(&self) -> Bounds {
        let size = DVec2::from_array(self.bed_size);
        let min = match self.origin {
            Origin::Corner => DVec2::ZERO,
            Origin::Center => -size / 2.0,
        };
        Bounds { min, max: min + size }
    }

    /// Whether a point is on the bed. Forbidden zones are not looked at.
    pub fn is_on_bed(&self, p: DVec2) -> bool {
        /// Coordinates come from f32 vertices: what touches the edge is on the bed, mm.
        const SLACK: f64 = 1e-3;
        let Bounds { min, max } = self.bed();
        let (centre, half) = ((min + max) / 2.0, (max - min) / 2.0 + SLACK);
        match self.bed_shape {
            BedShape::Rectangle => (p - centre).abs().cmple(half).all(),
            BedShape::Round => ((p - centre) / half).length_squared() <= 1.0,
        }
    }

    /// Boxes of the bed where nothing may be printed.
    pub fn forbidden_zones(&self) -> impl Iterator<Item = Bounds> {
        self.forbidden.iter().map(|&[x0, y0, x1, y1]| Bounds { min: dvec2(x0, y0), max: dvec2(x1, y1) })
    }

    /// Where the head goes when the part is done: the back, on the left where there is a corner.
    pub(super) fn parking(&self) -> DVec2 {
        let Bounds { min, max } = self.bed();
        match self.bed_shape {
            BedShape::Rectangle => dvec2(min.x, max.y),
            BedShape::Round => dvec2((min.x + max.x) / 2.0, max.y),
        }
    }

    /// Where the prime line begins and ends: along the front edge, `margin` mm from the edges.
    pub(super) fn prime_line(&self, margin: [f64; 2]) -> [DVec2; 2] {
        let Bounds { min, max } = self.bed();
        match self.bed_shape {
            BedShape::Rectangle => {
                let from = min + DVec2::from_array(margin);
                let length = self.prime_length.min(max.x - min.x - 2.0 * margin[0]);
                [from, from + dvec2(length, 0.0)]
            }
            // A chord near the front, where the bed is 0.6 of its diameter wide.
            BedShape::Round => {
                let (centre, half) = ((min + max) / 2.0, (max - min) / 2.0);
                let reach = (self.prime_length / 2.0).min(0.6 * half.x - margin[0]);
                let y = centre.y - 0.8 * half.y;
                [dvec2(centre.x - reach, y), dvec2(centre.x + reach, y)]
            }
        }
    }
}

impl SpeedOptions {
    /// Speed asked for beads of a role, mm/s.
    pub fn of(&self, role: Role) -> f64 {
        match role {
            Role::OuterWall => self.outer_wall,
            Role::InnerWall => self.inner_wall,
            Role::OverhangWall => self.overhang_wall,
            Role::GapFill => self.gap_fill,
            Role::BottomSkin => self.bottom_skin,
            Role::TopSkin => self.top_skin,
            Role::SolidInfill => self.solid_infill,
            Role::Infill => self.infill,
            Role::Bridge => self.bridge,
            Role::Ironing => self.ironing,
            Role::Skirt => self.skirt,
            Role::Brim => self.brim,
            Role::Teeth => self.teeth,
            Role::Raft => self.raft,
            Role::Support => self.support,
            Role::SupportInterface => self.support_interface,
            Role::Prime => self.prime,
            Role::WipeTower => self.wipe_tower,
        }
    }
}

/// All that this stage needs to know, put together by the pipeline.
#[derive(Debug, Clone, PartialEq)]
pub struct GcodeOptions {
    /// Settings `printer.*`.
    pub printer: PrinterOptions,
    /// Settings `filament.*`.
    pub filament: FilamentOptions,
    /// Settings `second_filament.*`: the material of tool 1.
    pub second_filament: FilamentOptions,
    /// Setting `support.tool`.
    pub support_tool: u8,
    /// Settings `speed.*`.
    pub speed: SpeedOptions,
    /// Settings `retraction.*`.
    pub retraction: RetractionOptions,
    /// Settings `acceleration.*`.
    pub acceleration: AccelerationOptions,
    /// Settings `cooling.*`.
    pub cooling: CoolingOptions,
    /// Settings `gcode.*`.
    pub output: OutputOptions,
    /// Setting `ironing.flow`: beads that iron are so much flatter than their layer. Default 0.15.
    pub ironing_flow: f64,
    /// Objects to be labelled; empty for none.
    pub objects: Vec<LabelledObject>,
    /// Setting `first_layer.speed`, mm/s: no bead of the first layer is printed faster. Default 25.
    pub first_layer_speed: f64,
    /// Setting `seam.gap`, mm: closed walls end this much before their start. Default 0.
    pub seam_gap: f64,
}

impl Default for GcodeOptions {
    fn default() -> Self {
        GcodeOptions {
            printer: PrinterOptions::default(),
            filament: FilamentOptions::default(),
            second_filament: FilamentOptions::default(),
            support_tool: 0,
            speed: SpeedOptions::default(),
            retraction: RetractionOptions::default(),
            acceleration: AccelerationOptions::default(),
            cooling: CoolingOptions::default(),
            output: OutputOptions::default(),
            ironing_flow: 0.15,
            objects: Vec::new(),
            first_layer_speed: 25.0,
            seam_gap: 0.0,
        }
    }
}
