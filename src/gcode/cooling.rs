//! Small layers are printed slowly enough to set before the next one, and the fan blows the more the
//! less time they take.
//!
//! Both look at one layer alone: its time from stop to stop, the way to it left out.

use super::estimate::{Limits, move_times};
use super::plan::feed_rate;
use super::{FilamentOptions, Move, Place};
use crate::region::Role;

crate::options! {
    /// What is done so that a layer sets before the next one is laid on it.
    pub struct CoolingOptions {
        /// Layers that would take less are printed more slowly, the fastest beads first; 0 slows
        /// nothing. Bridges keep their speed.
        min_layer_time: f64 = 8.0, "Shortest layer time", "s", 0.0..=1000.0;
        /// No bead is slowed below this speed, even if its layer then takes less than the shortest
        /// layer time.
        min_speed: f64 = 10.0, "Lowest speed", "mm/s", 0.1..=1000.0;
        /// Layers that take less get more than the usual fan: from `filament.fan_speed` here to
        /// `filament.max_fan_speed` at the shortest layer time.
        fan_below_layer_time: f64 = 60.0, "More fan below", "s", 0.0..=1000.0;
    }
}

/// Moves from a stop to a stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub(super) start: Place,
    /// Height at the start, micrometres.
    pub(super) z: i32,
    pub(super) limits: &'a Limits,
}

impl Stretch<'_> {
    fn seconds(&self, moves: &[Move]) -> f64 {
        move_times(self.start, self.z, moves, self.limits).iter().sum()
    }
}

/// Lowers the speed of the fastest beads to the highest common one at which the moves take
/// `min_layer_time`, or to `min_speed` where even that is too short. `planned_s` is the time they
/// take as they are. Returns whether a speed was changed.
pub(super) fn slow_down(
    moves: &mut [Move],
    planned_s: f64,
    stretch: Stretch<'_>,
    options: &CoolingOptions,
) -> bool {
    if planned_s >= options.min_layer_time {
        return false;
    }
    let beads = slowable(moves);
    let mut low = feed_rate(options.min_speed);
    let mut high = beads.iter().map(|&(_, feed)| feed).max().unwrap_or(0);
    if high <= low {
        return false;
    }
    let mut lasts_at = |cap: u32| {
        cap_feeds(moves, &beads, cap);
        stretch.seconds(moves) >= options.min_layer_time
    };
    if lasts_at(low) {
        // The layer lasts long enough at `low` and not at `high`; a slower bead never takes less time.
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *(if lasts_at(middle) { &mut low } else { &mut high }) = middle;
        }
    }
    cap_feeds(moves, &beads, low);
    true
}

/// Indices and feed rates of the beads that may be slowed: a bridge that is laid slowly sags.
fn slowable(moves: &[Move]) -> Vec<(usize, u32)> {
    let mut is_bridge = false;
    let mut found = Vec::new();
    for (i, step) in moves.iter().enumerate() {
        match *step {
            Move::Role(role) => is_bridge = role == Role::Bridge,
            Move::Extrude { feed, .. } | Move::Climb { feed, .. } | Move::Arc { feed, .. } if !is_bridge => {
                found.push((i, feed));
            }
            _ => {}
        }
    }
    found
}

fn cap_feeds(moves: &mut [Move], beads: &[(usize, u32)], cap: u32) {
    for &(i, wanted) in beads {
        if let Move::Extrude { feed, .. } | Move::Climb { feed, .. } | Move::Arc { feed, .. } = &mut moves[i]
        {
            *feed = wanted.min(cap);
        }
    }
}

/// Fan of one layer, 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fan {
    usual: u8,
    bridge: u8,
}

impl Fan {
    /// Fan of layer `index`, which takes `planned_s` before it is slowed down.
    pub(super) fn of(
        index: u32,
        planned_s: f64,
        filament: &FilamentOptions,
        cooling: &CoolingOptions,
    ) -> Fan {
        let ramp = ramp(index, filament);
        let duty = |share: f64| (share * ramp * 255.0).round() as u8;
        let most = filament.max_fan_speed.max(filament.fan_speed);
        let room = cooling.fan_below_layer_time - cooling.min_layer_time;
        let haste = match planned_s {
            s if s >= cooling.fan_below_layer_time => 0.0,
            s if s <= cooling.min_layer_time => 1.0,
            s => (cooling.fan_below_layer_time - s) / room,
        };
        let usual = filament.fan_speed + (most - filament.fan_speed) * haste;
        Fan { usual: duty(usual), bridge: duty(filament.bridge_fan_speed) }
    }

    fn of_role(self, role: Role) -> u8 {
        match role {
            Role::Bridge | Role::OverhangWall => self.bridge,
            _ => self.usual,
        }
    }

    /// Adds the changes of the fan to the moves, and a time of 0 for each. Returns the fan needed at
    /// the start and left at the end.
    pub(super) fn blow(self, moves: &mut Vec<Move>, times: &mut Vec<f64>) -> [u8; 2] {
        let roles = moves.iter().filter_map(|step| match *step {
            Move::Role(role) => Some(self.of_role(role)),
            _ => None,
        });
        let duties: Vec<u8> = roles.collect();
        let first = duties.first().copied().unwrap_or(self.usual);
        if duties.iter().all(|&duty| duty == first) {
            return [first; 2];
        }
        let mut last = first;
        let planned = std::mem::take(moves).into_iter().zip(std::mem::take(times));
        for (step, time) in planned {
            moves.push(step);
            times.push(time);
            let Move::Role(role) = step else { continue };
            let duty = self.of_role(role);
            if duty != last {
                moves.push(Move::Fan(duty));
                times.push(0.0);
                last = duty;
            }
        }
        [first, last]
    }
}

/// Share of its speed at which the fan runs on a layer: 0 on the first ones, then rising evenly.
fn ramp(index: u32, filament: &FilamentOptions) -> f64 {
    let FilamentOptions { fan_first_layers, fan_full_layer, .. } = *filament;
    if index < fan_first_layers {
        return 0.0;
    }
    // From the first layer with fan to the one numbered `fan_full_layer` (from 1), that one included.
    let steps = fan_full_layer.saturating_sub(fan_first_layers).max(1);
    (f64::from(index + 1 - fan_first_layers) / f64::from(steps)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fan(index: u32, planned_s: f64, filament: &FilamentOptions) -> Fan {
        Fan::of(index, planned_s, filament, &CoolingOptions::default())
    }

    #[test]
    fn the_fan_rises_over_the_first_layers() {
        let filament =
            FilamentOptions { fan_first_layers: 1, fan_full_layer: 4, ..FilamentOptions::default() };
        let duties: Vec<u8> = (0..6).map(|k| fan(k, 100.0, &filament).usual).collect();
        assert_eq!(duties, [0, 85, 170, 255, 255, 255]);
        // A full layer before the first one with fan means no ramp.
        let at_once = FilamentOptions { fan_full_layer: 0, ..filament };
        assert_eq!([0, 1].map(|k| fan(k, 100.0, &at_once).usual), [0, 255]);
    }

    #[test]
    fn the_fan_rises_as_layers_get_short() {
        // From 60 s to 8 s the share rises from 0.4 to 1: at 34 s, half-way, it is 0.7.
        let filament = FilamentOptions { fan_speed: 0.4, max_fan_speed: 1.0, ..FilamentOptions::default() };
        let duties = [100.0, 60.0, 34.0, 8.0, 1.0].map(|s| fan(5, s, &filament).usual);
        assert_eq!(duties, [102, 102, 179, 255, 255]);
        // No less than usual, whatever the other setting says.
        let less = FilamentOptions { max_fan_speed: 0.1, ..filament };
        assert_eq!(fan(5, 1.0, &less).usual, 102);
    }

    #[test]
    fn bridges_and_overhanging_walls_have_their_own_fan() {
        let filament = FilamentOptions { fan_speed: 0.0, max_fan_speed: 0.0, ..FilamentOptions::default() };
        let roles = [Role::InnerWall, Role::OverhangWall, Role::Bridge, Role::Infill];
        let mut moves: Vec<Move> = roles.map(Move::Role).to_vec();
        let mut times = vec![0.0; 4];
        let ends = fan(5, 100.0, &filament).blow(&mut moves, &mut times);
        let expected = [
            Move::Role(Role::InnerWall),
            Move::Role(Role::OverhangWall),
            Move::Fan(255),
            Move::Role(Role::Bridge),
            Move::Role(Role::Infill),
            Move::Fan(0),
        ];
        assert_eq!((&moves[..], times.len(), ends), (&expected[..], 6, [0, 0]));
    }
}
