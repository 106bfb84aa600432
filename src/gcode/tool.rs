//! Two extruders: which one prints what, and the change from one to the other.

use super::plan::{feed_rate, filament_steps, micrometres, z_feed};
use super::{FilamentOptions, GcodeOptions, Move, Place};
use crate::region::{Path, Role};

/// Number of tools that a job can use.
pub const TOOLS: usize = 2;

impl GcodeOptions {
    /// The tool that prints beads of a role; a prime tower is printed by the one that comes to it.
    pub fn tool_of(&self, role: Role) -> u8 {
        match role {
            Role::Support | Role::SupportInterface => self.support_tool,
            _ => 0,
        }
    }

    /// The material of a tool.
    pub fn filament_of(&self, tool: u8) -> &FilamentOptions {
        if tool == 0 { &self.filament } else { &self.second_filament }
    }

    /// The tool of each path of a layer: a prime tower belongs to what is printed after it.
    pub(super) fn tools_of(&self, paths: &[Path]) -> Vec<u8> {
        let mut next = 0;
        let of_path = |path: &Path| {
            next = if path.role == Role::WipeTower { next } else { self.tool_of(path.role) };
            next
        };
        let mut tools: Vec<u8> = paths.iter().rev().map(of_path).collect();
        tools.reverse();
        tools
    }

    /// Nozzle temperature of a tool on a layer, whole degrees.
    pub(super) fn nozzle_temp(&self, tool: u8, layer: u32) -> u16 {
        let filament = self.filament_of(tool);
        let temp = if layer == 0 { filament.first_layer_nozzle_temp } else { filament.nozzle_temp };
        temp.round() as u16
    }
}

/// A change of tools with the way to where the new one begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub(super) from: u8,
    pub(super) to: u8,
    /// The layer that the new tool prints on.
    pub(super) layer: u32,
    pub(super) place: Place,
    /// Heights of the nozzle before and after, micrometres.
    pub(super) from_z: i32,
    pub(super) to_z: i32,
    /// Filament of the old tool that is pulled back already.
    pub(super) retracted: i32,
}

impl Change {
    /// Pulls the old filament out of the hot end, goes to the new place, changes there, waits until
    /// the new tool is hot, and pushes its filament back. The first time that is a prime, as the new
    /// tool was not pulled back before.
    pub(super) fn moves(&self, options: &GcodeOptions, moves: &mut Vec<Move>) {
        let retraction = &options.retraction;
        let length = filament_steps(retraction.tool_change_length);
        let feed = feed_rate(retraction.speed);
        if length != self.retracted {
            moves.push(Move::Filament { filament: self.retracted - length, feed });
        }
        let travel_z = self.from_z.max(self.to_z) + micrometres(retraction.z_hop);
        if travel_z != self.from_z {
            moves.push(Move::Lift { z: travel_z, feed: z_feed(options) });
        }
        moves.push(Move::Travel { to: self.place, feed: feed_rate(options.speed.travel) });
        if travel_z != self.to_z {
            moves.push(Move::Lift { z: self.to_z, feed: z_feed(options) });
        }
        let standby = options.filament_of(self.from).standby_temp.round() as u16;
        let nozzle = options.nozzle_temp(self.to, self.layer);
        moves.push(Move::Tool { from: self.from, to: self.to, nozzle, standby });
        if length != 0 {
            moves.push(Move::Filament { filament: length, feed });
        }
    }
}
