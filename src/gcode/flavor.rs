//! What differs between firmwares, as data.
//!
//! Sources:
//! - Marlin: marlinfw.org/docs/gcode (M73, M106, M107, M204, M486, M900) and /docs/configuration
//!   (`ARC_SUPPORT`, on by default; `CANCEL_OBJECTS`).
//! - Klipper: klipper3d.org/G-Codes.html (M106, M107, SET_VELOCITY_LIMIT, SET_PRESSURE_ADVANCE,
//!   EXCLUDE_OBJECT; M73 with `[display_status]`; arcs only with `[gcode_arcs]`, so none are written).
//! - RepRapFirmware: docs.duet3d.com, "GCode dictionary" (M73, M106, M204, M486, M572; M107 is deprecated).
//! - Prusa: help.prusa3d.com, "Prusa Firmware-specific G-code commands" (M73 Q S, M486, M900) for the i3
//!   printers up to MK3S, and "Buddy firmware-specific G-code commands" for MINI and MK4, whose files for
//!   firmware 5.1 and later set pressure advance with M572 S.
//! - Repetier: Repetier-Firmware's list of codes, Repetier.ino and reprap.org/wiki/G-code (M201 print and
//!   M202 travel acceleration; M204 sets PID values there; no M73; M233's unit is not the others' K).
//! - Bambu: the community's lists (github.com/rjduran/bambu-gcode-reference): M73, M106, M204 S, M400 U1
//!   (waits for the user), M900 K, arcs.

crate::words! {
    /// Firmware dialect.
    pub enum Flavor {
        /// Marlin 1.1.9 and later, and what follows it.
        #[default]
        Marlin = "marlin",
        /// Klipper.
        Klipper = "klipper",
        /// RepRapFirmware (Duet).
        Reprap = "reprap",
        /// Prusa's own firmware.
        Prusa = "prusa",
        /// Repetier-Firmware.
        Repetier = "repetier",
        /// Bambu Lab's firmware.
        Bambu = "bambu",
    }
}

/// How a firmware is told which object it prints, so that one can be given up and the rest go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectLabels {
    /// Not at all.
    None,
    /// `M486 T` with their number, `M486 S` with the next one's place.
    M486,
    /// `M486 S`, then `M486 A` with its name.
    NamedM486,
    /// `EXCLUDE_OBJECT_DEFINE`, `_START` and `_END`.
    ExcludeObject,
}

/// A flavour's own lines; words in braces are filled in by `start::expand`.
#[derive(Debug)]
pub(crate) struct Dialect {
    /// Sets the accelerations that the time estimate counts on.
    pub(crate) accelerations: &'static str,
    /// Sets the acceleration of beads to {bead_acceleration}.
    pub(crate) bead_acceleration: &'static str,
    /// Waits until the user goes on; empty where no such command is documented.
    pub(crate) pause: &'static str,
    /// Whether it takes the head away from the part by itself.
    pub(crate) pause_parks: bool,
    /// Whether G2 and G3 can be relied on.
    pub(crate) arcs: bool,
    /// Reports progress: {percent} done, {minutes} to go.
    pub(crate) progress: &'static str,
    /// Whether printing and travelling may accelerate differently.
    pub(crate) travel_acceleration: bool,
    /// Switches the part fan off.
    pub(crate) fan_off: &'static str,
    /// Sets linear (pressure) advance to {pressure_advance}, s; empty where there is none.
    pub(crate) pressure_advance: &'static str,
    /// How objects are named.
    pub(crate) labels: ObjectLabels,
}

/// What Marlin says, and the others vary.
const MARLIN: Dialect = Dialect {
    accelerations: "M204 P{acceleration} R{retract_acceleration} T{travel_acceleration}\n",
    bead_acceleration: "M204 P{bead_acceleration}\n",
    progress: "M73 P{percent} R{minutes}\n",
    travel_acceleration: true,
    fan_off: "M107",
    pressure_advance: "M900 K{pressure_advance}\n",
    labels: ObjectLabels::M486,
    pause: "M0 ; go on by the button\n",
    pause_parks: false,
    arcs: true,
};

impl Flavor {
    /// The flavour's own lines.
    pub(crate) const fn dialect(self) -> &'static Dialect {
        match self {
            Flavor::Marlin => &MARLIN,
            // One acceleration for all moves: the smaller one, as Klipper itself reads M204 P T.
            Flavor::Klipper => &Dialect {
                pause: "PAUSE\n",
                pause_parks: true,
                arcs: false,
                accelerations: "SET_VELOCITY_LIMIT ACCEL={smaller_acceleration}\n",
                bead_acceleration: "SET_VELOCITY_LIMIT ACCEL={bead_acceleration}\n",
                travel_acceleration: false,
                pressure_advance: "SET_PRESSURE_ADVANCE ADVANCE={pressure_advance}\n",
                labels: ObjectLabels::ExcludeObject,
                ..MARLIN
            },
            // RepRapFirmware's M204 knows P and T only.
            Flavor::Reprap => &Dialect {
                pause: "M226\n",
                pause_parks: true,
                accelerations: "M204 P{acceleration} T{travel_acceleration}\n",
                fan_off: "M106 S0",
                pressure_advance: "M572 D0 S{pressure_advance}\n",
                labels: ObjectLabels::NamedM486,
                ..MARLIN
            },
            // Q and S are the same for the silent mode.
            Flavor::Prusa => &Dialect {
                pause: "M601\n",
                pause_parks: true,
                progress: "M73 P{percent} R{minutes}\nM73 Q{percent} S{minutes}\n",
                // The same value in the same unit; a firmware passes over the command that it does not know.
                pressure_advance: "M900 K{pressure_advance}\nM572 S{pressure_advance}\n",
                labels: ObjectLabels::NamedM486,
                ..MARLIN
            },
            Flavor::Repetier => &Dialect {
                accelerations: "M201 X{acceleration} Y{acceleration}\nM202 X{travel_acceleration} Y{travel_acceleration}\n",
                bead_acceleration: "M201 X{bead_acceleration} Y{bead_acceleration}\n",
                progress: "",
                pressure_advance: "",
                labels: ObjectLabels::None,
                pause: "",
                arcs: false,
                ..MARLIN
            },
            Flavor::Bambu => &Dialect {
                accelerations: "M204 S{smaller_acceleration}\n",
                bead_acceleration: "M204 S{bead_acceleration}\n",
                travel_acceleration: false,
                fan_off: "M106 S0",
                labels: ObjectLabels::None,
                pause: "M400 U1\n",
                pause_parks: true,
                ..MARLIN
            },
        }
    }

    /// How this firmware is told which object it prints.
    pub const fn labels(self) -> ObjectLabels {
        self.dialect().labels
    }

    /// Whether the firmware takes G2 and G3 without being set up for them.
    pub const fn has_arcs(self) -> bool {
        self.dialect().arcs
    }

    /// Whether a pause can be written, see [`EventKind::Pause`](super::EventKind::Pause).
    pub const fn has_pause(self) -> bool {
        !self.dialect().pause.is_empty()
    }

    /// Whether `filament.pressure_advance` can be set by G-code.
    pub const fn has_pressure_advance(self) -> bool {
        !self.dialect().pressure_advance.is_empty()
    }
}
