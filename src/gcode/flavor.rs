//! What differs between firmwares, as data.
//!
//! Sources: Marlin, marlinfw.org/docs/gcode (M73, M204); RepRapFirmware, docs.duet3d.com, "GCode
//! dictionary" (M73, M204); Klipper, klipper3d.org/G-Codes.html (SET_VELOCITY_LIMIT, M73 with
//! `[display_status]`); Prusa, help.prusa3d.com, "Prusa Firmware-specific G-code commands" (M73 Q S).

/// Firmware dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Flavor {
    /// Marlin 1.1.9 and later, and what follows it.
    #[default]
    Marlin,
    /// Klipper.
    Klipper,
    /// RepRapFirmware (Duet).
    Reprap,
    /// Prusa's own firmware.
    Prusa,
}

/// A flavour's own lines; words in braces are filled in by `start::expand`.
#[derive(Debug)]
pub(crate) struct Dialect {
    /// Sets the accelerations that the time estimate counts on.
    pub(crate) accelerations: &'static str,
    /// Sets the acceleration of beads to {bead_acceleration}.
    pub(crate) bead_acceleration: &'static str,
    /// Waits until the user goes on.
    pub(crate) pause: &'static str,
    /// Whether it takes the head away from the part by itself.
    pub(crate) pause_parks: bool,
    /// Whether G2 and G3 can be relied on.
    pub(crate) arcs: bool,
    /// Reports progress: {percent} done, {minutes} to go.
    pub(crate) progress: &'static str,
    /// Whether printing and travelling may accelerate differently.
    pub(crate) travel_acceleration: bool,
}

impl Flavor {
    /// The flavour's own lines.
    pub(crate) const fn dialect(self) -> &'static Dialect {
        match self {
            Flavor::Marlin => &Dialect {
                pause: "M0 ; go on by the button\n",
                pause_parks: false,
                arcs: true,
                accelerations: "M204 P{acceleration} R{retract_acceleration} T{travel_acceleration}\n",
                bead_acceleration: "M204 P{bead_acceleration}\n",
                progress: "M73 P{percent} R{minutes}\n",
                travel_acceleration: true,
            },
            // One acceleration for all moves: the smaller one, as Klipper itself reads M204 P T.
            Flavor::Klipper => &Dialect {
                pause: "PAUSE\n",
                pause_parks: true,
                arcs: false,
                accelerations: "SET_VELOCITY_LIMIT ACCEL={smaller_acceleration}\n",
                bead_acceleration: "SET_VELOCITY_LIMIT ACCEL={bead_acceleration}\n",
                progress: "M73 P{percent} R{minutes}\n",
                travel_acceleration: false,
            },
            // RepRapFirmware's M204 knows P and T only.
            Flavor::Reprap => &Dialect {
                pause: "M226\n",
                pause_parks: true,
                arcs: true,
                accelerations: "M204 P{acceleration} T{travel_acceleration}\n",
                bead_acceleration: "M204 P{bead_acceleration}\n",
                progress: "M73 P{percent} R{minutes}\n",
                travel_acceleration: true,
            },
            // Q and S are the same for the silent mode.
            Flavor::Prusa => &Dialect {
                pause: "M601\n",
                pause_parks: true,
                arcs: true,
                accelerations: "M204 P{acceleration} R{retract_acceleration} T{travel_acceleration}\n",
                bead_acceleration: "M204 P{bead_acceleration}\n",
                progress: "M73 P{percent} R{minutes}\nM73 Q{percent} S{minutes}\n",
                travel_acceleration: true,
            },
        }
    }

    /// Whether the firmware takes G2 and G3 without being set up for them.
    pub const fn has_arcs(self) -> bool {
        self.dialect().arcs
    }
}
