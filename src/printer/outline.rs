//! What a job holds, found by one reading: its lines, layers and times, and what the printer has to be
//! told when a print begins at a layer.

use serde::Serialize;

use super::job::layer_after;
use super::line::{code, strip};
use super::position::{number, words};

/// How far the nozzle rises from the part before it moves sideways, mm.
const LIFT: f64 = 5.0;

/// What a job holds.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Outline {
    /// Lines, comments counted.
    pub lines: u64,
    /// The layers in the order of the file.
    pub layers: Vec<LayerStart>,
    /// When the time left changes (`M73`).
    pub times: Vec<TimeMark>,
    /// The first line that is no plain G-code: a macro of the firmware that the file was made for.
    pub macro_line: Option<MacroLine>,
}

/// Where a layer begins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayerStart {
    /// Index of its first line, from 0.
    pub line: u64,
    /// Height that the file tells for it (`;Z:`), mm.
    pub z: Option<f64>,
    /// What is on when it begins.
    pub heat: Heat,
}

/// From this line on so much is left to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TimeMark {
    /// Index of the line, from 0.
    pub line: u64,
    /// Minutes left.
    pub minutes: u32,
}

/// A line that only firmwares with macros read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MacroLine {
    /// Index of the line, from 0.
    pub line: u64,
    /// Its first word.
    pub word: String,
}

/// Heaters, fan and tool as the lines so far have set them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Heat {
    /// Wanted at the nozzle in use, degrees Celsius; 0 is off.
    pub nozzle: f64,
    /// Wanted at the bed, degrees Celsius; 0 is off.
    pub bed: f64,
    /// Fan of the part, 0 to 255.
    pub fan: f64,
    /// The tool chosen, if one was.
    pub tool: Option<u32>,
}

impl Outline {
    /// Reads all lines.
    pub fn of(lines: impl Iterator<Item = Vec<u8>>) -> Outline {
        let mut outline = Outline::default();
        let (mut heat, mut layer) = (Heat::default(), 0);
        for raw in lines {
            let line = outline.lines;
            outline.lines += 1;
            let begun = layer_after(layer, &raw);
            if begun != layer {
                outline.layers.push(LayerStart { line, z: None, heat });
            }
            layer = begun;
            outline.note_height(&raw);
            outline.note_command(line, strip(&raw), &mut heat);
        }
        outline
    }

    /// `;Z:0.2` behind the begin of a layer.
    fn note_height(&mut self, raw: &[u8]) {
        let Some(text) = raw.trim_ascii_start().strip_prefix(b";Z:") else { return };
        let z = std::str::from_utf8(text.trim_ascii()).ok().and_then(|z| z.parse::<f64>().ok());
        if let Some(layer) = self.layers.last_mut() {
            layer.z = layer.z.or(z.filter(|z| z.is_finite()));
        }
    }

    fn note_command(&mut self, line: u64, command: &[u8], heat: &mut Heat) {
        if command.is_empty() {
            return;
        }
        let text = String::from_utf8_lossy(command);
        match code(command) {
            Some((b'M', 73)) => self.note_time(line, &text),
            Some((b'G' | b'M' | b'T', _)) => heat.follow(&text),
            Some(_) | None if self.macro_line.is_none() => {
                let word: String = text.chars().take_while(|c| !c.is_whitespace()).take(40).collect();
                self.macro_line = Some(MacroLine { line, word });
            }
            Some(_) | None => {}
        }
    }

    fn note_time(&mut self, line: u64, command: &str) {
        let Some((_, minutes)) = words(command).find(|(letter, _)| *letter == b'R') else { return };
        // A float cast saturates: a senseless number stays a number.
        let minutes = minutes as u32;
        if self.times.last().is_none_or(|mark| mark.minutes != minutes) {
            self.times.push(TimeMark { line, minutes });
        }
    }
}

impl Heat {
    /// Takes over what one command sets.
    fn follow(&mut self, command: &str) {
        let value =
            |wanted: &[u8]| words(command).find(|(letter, _)| wanted.contains(letter)).map(|(_, v)| v);
        match code(command.as_bytes()) {
            Some((b'M', 104 | 109)) if self.is_mine(value(b"T")) => {
                self.nozzle = value(b"SR").unwrap_or(self.nozzle);
            }
            Some((b'M', 140 | 190)) => self.bed = value(b"SR").unwrap_or(self.bed),
            Some((b'M', 106)) if value(b"P").is_none_or(|fan| fan == 0.0) => {
                self.fan = value(b"S").unwrap_or(255.0);
            }
            Some((b'M', 107)) if value(b"P").is_none_or(|fan| fan == 0.0) => self.fan = 0.0,
            Some((b'T', tool)) => self.tool = Some(tool),
            Some(_) | None => {}
        }
    }

    fn is_mine(&self, tool: Option<f64>) -> bool {
        tool.is_none_or(|tool| tool == f64::from(self.tool.unwrap_or(0)))
    }

    /// Commands before the first line of a layer, on a board that forgot everything while the nozzle
    /// stands at height `z` (mm) over the bed, at or beside the part: heat, so that the nozzle comes loose;
    /// lift; home X and Y, for homing Z would drive into the part; count Z from `z`; fill the nozzle with
    /// `purge` mm of filament.
    pub fn restart_lines(&self, z: f64, purge: f64) -> Vec<String> {
        let mut lines = Vec::new();
        lines.extend(self.tool.map(|tool| format!("T{tool}")));
        if self.bed > 0.0 {
            lines.push(format!("M140 S{}", number(self.bed)));
        }
        if self.nozzle > 0.0 {
            lines.push(format!("M109 S{}", number(self.nozzle)));
        }
        lines.extend(["G21", "G91"].map(str::to_owned));
        lines.push(format!("G1 Z{} F600", number(LIFT)));
        lines.extend(["G90", "G28 X Y"].map(str::to_owned));
        lines.push(format!("G92 Z{}", number(z + LIFT)));
        if self.bed > 0.0 {
            lines.push(format!("M190 S{}", number(self.bed)));
        }
        if self.nozzle > 0.0 && purge > 0.0 {
            lines.extend(["M83".to_owned(), format!("G1 E{} F150", number(purge))]);
        }
        if self.fan > 0.0 {
            lines.push(format!("M106 S{}", number(self.fan)));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(text: &str) -> Outline {
        Outline::of(text.lines().map(|line| line.as_bytes().to_vec()))
    }

    #[test]
    fn layers_times_and_heat_are_found() {
        let found = outline(
            "; head\nM140 S60\nM190 S60\nM104 S215 T1\nM109 S210\nM73 P0 R12\n;LAYER_CHANGE\n;Z:0.2\nG1 X1\n\
             M106 S127.5\nM73 P40 R12\nM73 P50 R6\n;LAYER_CHANGE\n;Z:0.4\nM107\nG1 X2",
        );
        let heat = Heat { nozzle: 210.0, bed: 60.0, fan: 0.0, tool: None };
        assert_eq!(found.lines, 16);
        assert_eq!(
            found.layers,
            [
                LayerStart { line: 6, z: Some(0.2), heat },
                LayerStart { line: 12, z: Some(0.4), heat: Heat { fan: 127.5, ..heat } },
            ]
        );
        assert_eq!(found.times, [TimeMark { line: 5, minutes: 12 }, TimeMark { line: 11, minutes: 6 }]);
        assert_eq!(found.macro_line, None);
    }

    #[test]
    fn a_macro_is_named() {
        let found = outline("; klipper\nG28\nSTART_PRINT BED=60\nEXCLUDE_OBJECT NAME=a");
        assert_eq!(found.macro_line, Some(MacroLine { line: 2, word: "START_PRINT".to_owned() }));
    }

    #[test]
    fn a_restart_heats_lifts_homes_beside_the_part_and_purges() {
        let heat = Heat { nozzle: 210.0, bed: 60.0, fan: 255.0, tool: None };
        assert_eq!(
            heat.restart_lines(3.4, 20.0),
            [
                "M140 S60",
                "M109 S210",
                "G21",
                "G91",
                "G1 Z5 F600",
                "G90",
                "G28 X Y",
                "G92 Z8.4",
                "M190 S60",
                "M83",
                "G1 E20 F150",
                "M106 S255",
            ]
        );
        let cold = Heat::default().restart_lines(0.2, 20.0);
        assert_eq!(
            cold,
            ["G21", "G91", "G1 Z5 F600", "G90", "G28 X Y", "G92 Z5.2"],
            "nothing cold is pushed"
        );
    }

    #[test]
    fn noise_is_read_to_its_end() {
        let noise: Vec<u8> = (0..20_000_u32).map(|i| ((i * 7919) >> 3) as u8).collect();
        let lines = noise.split(|b| *b == b'\n').map(<[u8]>::to_vec);
        let count = lines.clone().count() as u64;
        assert_eq!(Outline::of(lines).lines, count);
    }
}
