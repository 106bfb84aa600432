//! The moves of some layers as flat arrays, for a picture in space.

use crate::gcode::read::{ReadMove, Reader, width_of};
use crate::region::Role;

/// Moves in the order of the text. Each array has an entry, or a few, for each move.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moves {
    /// Six numbers a move: x y z where it starts and where it ends, mm; z is the nozzle's.
    pub ends: Vec<f32>,
    /// Two numbers a move: the bead's width and height, mm; width 0 is a travel.
    pub sizes: Vec<f32>,
    /// Position of the role in [`Role::ALL`]; 255 where the text names none, and for travels.
    pub roles: Vec<u8>,
    /// Speed asked for, mm/s.
    pub speeds: Vec<f32>,
    /// Plastic per time, mm3/s.
    pub flows: Vec<f32>,
    /// Duty of the fan, 0 to 255.
    pub fans: Vec<u8>,
    /// Tool.
    pub tools: Vec<u8>,
    /// Moves before the end of each layer of the text; what stands before the first mark belongs to
    /// the first layer.
    pub layers: Vec<u32>,
}

impl Moves {
    /// Reads the text of some layers. `filament_area` in mm2 turns filament into volume.
    pub fn read(text: &[u8], filament_area: f64) -> Moves {
        let mut moves = Moves::default();
        let mut reader = Reader::new(text);
        // The nozzle's place is not known before the first move.
        let mut known = false;
        for step in &mut reader {
            while moves.layers.len() + 1 < step.layer as usize {
                moves.layers.push(moves.speeds.len() as u32);
            }
            if known && (step.moves_in_plane() || step.from[2] != step.to[2]) {
                moves.add(&step, filament_area);
            }
            known |= step.moves_in_plane();
        }
        moves.layers.push(moves.speeds.len() as u32);
        moves
    }

    fn add(&mut self, step: &ReadMove, filament_area: f64) {
        let height = step.height.unwrap_or(0.0);
        let volume = step.filament_mm * filament_area;
        let length = step.length();
        let is_bead = step.lays_bead();
        let width = match step.width {
            _ if !is_bead => 0.0,
            Some(width) => width,
            None => width_of(volume, length, height),
        };
        let role = step.role.filter(|_| is_bead).and_then(|role| Role::ALL.iter().position(|r| *r == role));
        self.ends.extend(step.from.iter().chain(&step.to).map(|x| *x as f32));
        self.sizes.extend([width as f32, height as f32]);
        self.roles.push(role.map_or(u8::MAX, |k| k as u8));
        self.speeds.push(step.speed as f32);
        self.flows.push(if is_bead { (volume / length * step.speed) as f32 } else { 0.0 });
        self.fans.push(step.fan);
        self.tools.push(step.tool);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "M83\nG1 X10 Y0 Z0.2 F6000\n;LAYER_CHANGE\n;TYPE:External perimeter\n;WIDTH:0.5\n\
        ;HEIGHT:0.2\nG1 X20 E0.5 F1200\nM106 S128\nT1\nG1 X20 Y10 E0.5\n;LAYER_CHANGE\n;HEIGHT:0.1\nG1 Z0.3\n\
        M107\nG1 X10 Y10 E0.25\n";

    #[test]
    fn each_move_has_its_bead_speed_flow_fan_and_tool() {
        let moves = Moves::read(TEXT.as_bytes(), 2.0);
        assert_eq!(moves.layers, [2, 4]);
        assert_eq!(moves.ends[..12], [10.0, 0.0, 0.2, 20.0, 0.0, 0.2, 20.0, 0.0, 0.2, 20.0, 10.0, 0.2]);
        assert_eq!(moves.sizes, [0.5, 0.2, 0.5, 0.2, 0.0, 0.1, 0.5, 0.1]);
        assert_eq!(moves.roles, [0, 0, 255, 0]);
        assert_eq!(moves.speeds, [20.0; 4]);
        // 0.5 mm of 2 mm2 over 10 mm at 20 mm/s: 0.1 mm2 at 20 mm/s.
        assert_eq!(moves.flows, [2.0, 2.0, 0.0, 1.0]);
        assert_eq!(moves.fans, [0, 128, 128, 0]);
        assert_eq!(moves.tools, [0, 1, 1, 1]);
    }

    #[test]
    fn a_text_without_moves_is_one_empty_layer() {
        assert_eq!(Moves::read(b"", 1.0), Moves { layers: vec![0], ..Moves::default() });
        assert_eq!(Moves::read(b";LAYER_CHANGE\n;LAYER_CHANGE\n", 1.0).layers, [0]);
    }
}
