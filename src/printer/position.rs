//! Where the head is and how numbers are meant, followed from the lines sent. Pause needs it to find
//! back.

use super::line::code;

const MM_PER_INCH: f64 = 25.4;

/// The state of motion after the lines followed so far. Millimetres; `None` is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Position {
    /// X, mm.
    pub x: Option<f64>,
    /// Y, mm.
    pub y: Option<f64>,
    /// Z, mm.
    pub z: Option<f64>,
    /// Extruder as an absolute number, mm; counts on through relative moves.
    pub e: f64,
    /// Speed of the last move, mm/min.
    pub feedrate_mm_min: Option<f64>,
    /// `G91`: numbers are distances.
    pub relative: bool,
    /// `M82` or `M83`; without either, E follows `G90` and `G91`.
    pub extruder_relative: Option<bool>,
    /// `G20`: the job counts in inches.
    pub inches: bool,
}

impl Position {
    /// Takes over what one command changes.
    pub(super) fn follow(&mut self, command: &str) {
        match code(command.as_bytes()) {
            Some((b'G', 0..=3)) => self.go(command),
            Some((b'G', 20)) => self.inches = true,
            Some((b'G', 21)) => self.inches = false,
            Some((b'G', 28)) => self.home(command),
            Some((b'G', 90)) => self.relative = false,
            Some((b'G', 91)) => self.relative = true,
            Some((b'G', 92)) => self.set(command),
            Some((b'M', 82)) => self.extruder_relative = Some(false),
            Some((b'M', 83)) => self.extruder_relative = Some(true),
            Some(_) | None => {}
        }
    }

    /// The job has moved the head.
    pub(super) fn is_known(&self) -> bool {
        self.x.is_some() || self.y.is_some() || self.z.is_some()
    }

    /// E moves are distances.
    pub fn e_is_relative(&self) -> bool {
        self.extruder_relative.unwrap_or(self.relative)
    }

    fn unit(&self) -> f64 {
        if self.inches { MM_PER_INCH } else { 1.0 }
    }

    fn go(&mut self, command: &str) {
        let (unit, relative, e_relative) = (self.unit(), self.relative, self.e_is_relative());
        let moved = |old: Option<f64>, value: f64| {
            if relative { old.map(|old| old + value) } else { Some(value) }
        };
        for (letter, value) in words(command) {
            match letter {
                b'X' => self.x = moved(self.x, value * unit),
                b'Y' => self.y = moved(self.y, value * unit),
                b'Z' => self.z = moved(self.z, value * unit),
                b'E' if e_relative => self.e += value * unit,
                b'E' => self.e = value * unit,
                b'F' => self.feedrate_mm_min = Some(value * unit),
                _ => {}
            }
        }
    }

    fn set(&mut self, command: &str) {
        let unit = self.unit();
        for (letter, value) in words(command) {
            match letter {
                b'X' => self.x = Some(value * unit),
                b'Y' => self.y = Some(value * unit),
                b'Z' => self.z = Some(value * unit),
                b'E' => self.e = value * unit,
                _ => {}
            }
        }
    }

    /// Where home is, only the printer knows.
    fn home(&mut self, command: &str) {
        let named = |axis| command.bytes().skip(1).any(|b| b.to_ascii_uppercase() == axis);
        let all = !(named(b'X') || named(b'Y') || named(b'Z'));
        for (axis, value) in [(b'X', &mut self.x), (b'Y', &mut self.y), (b'Z', &mut self.z)] {
            if all || named(axis) {
                *value = None;
            }
        }
    }

    /// Park lines as they are sent: in millimetres, whatever the job counts in.
    pub(super) fn park(&self, lines: &[String]) -> Vec<String> {
        let metric = self.inches.then(|| "G21".to_owned());
        metric.into_iter().chain(lines.iter().cloned()).collect()
    }

    /// The lines back: `lines` with `{x} {y} {z}` filled in (a line that names an unknown one is left
    /// out), then the modes, the extruder's number and the speed as the job left them.
    pub(super) fn way_back(&self, lines: &[String]) -> Vec<String> {
        let mut out: Vec<String> = lines.iter().filter_map(|line| self.fill(line)).collect();
        out.push("G90".to_owned());
        out.push(format!("G92 E{}", number(self.e)));
        if let Some(feedrate) = self.feedrate_mm_min {
            out.push(format!("G1 F{}", number(feedrate)));
        }
        out.extend(self.relative.then(|| "G91".to_owned()));
        out.push(if self.e_is_relative() { "M83" } else { "M82" }.to_owned());
        out.extend(self.inches.then(|| "G20".to_owned()));
        out
    }

    fn fill(&self, line: &str) -> Option<String> {
        let mut line = line.to_owned();
        for (mark, value) in [("{x}", self.x), ("{y}", self.y), ("{z}", self.z)] {
            if line.contains(mark) {
                line = line.replace(mark, &number(value?));
            }
        }
        Some(line)
    }
}

/// Letters and their numbers behind the command word. A letter without a number is left out.
pub(super) fn words(command: &str) -> impl Iterator<Item = (u8, f64)> + '_ {
    let bytes = command.as_bytes();
    let mut at = 1;
    std::iter::from_fn(move || {
        loop {
            let letter = *bytes.get(at)?;
            at += 1;
            if !letter.is_ascii_alphabetic() {
                continue;
            }
            let start = at;
            while bytes.get(at).is_some_and(|b| matches!(b, b'0'..=b'9' | b'.' | b'-' | b'+' | b' ')) {
                at += 1;
            }
            // `start..at` holds ASCII bytes only.
            let value = command[start..at].trim().parse::<f64>();
            if let Ok(value) = value {
                return Some((letter.to_ascii_uppercase(), value));
            }
        }
    })
}

/// Up to five decimals, none that say nothing.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.5}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(lines: &[&str]) -> Position {
        let mut position = Position::default();
        lines.iter().for_each(|line| position.follow(line));
        position
    }

    #[test]
    fn absolute_and_relative_moves_add_up() {
        let p = after(&["G90", "M83", "G1 X10 Y20 Z0.3 F1800 E1.5", "G91", "G1 X-2 Z1 E0.5", "G90", "G0 Y5"]);
        assert_eq!((p.x, p.y, p.z), (Some(8.0), Some(5.0), Some(1.3)));
        assert_eq!((p.e, p.feedrate_mm_min), (2.0, Some(1800.0)));
        assert!(p.e_is_relative() && !p.relative);
    }

    #[test]
    fn home_makes_the_named_axes_unknown() {
        let p = after(&["G1 X1 Y2 Z3", "G28 X"]);
        assert_eq!((p.x, p.y, p.z), (None, Some(2.0), Some(3.0)));
        assert_eq!(after(&["G1 X1 Y2 Z3", "G28"]).z, None);
    }

    #[test]
    fn an_extruder_reset_and_inches_are_followed() {
        let p = after(&["M82", "G1 E10", "G92 E0", "G1 E2", "G20", "G1 X1"]);
        assert_eq!((p.e, p.x), (2.0, Some(25.4)));
    }

    #[test]
    fn the_way_back_ends_in_the_modes_of_the_job() {
        let lines = ["G90".to_owned(), "G1 X{x} Y{y}".to_owned(), "G1 Z{z}".to_owned()];
        let p = after(&["G90", "M82", "G1 X10 Y20.5 E7.25 F1200", "G91"]);
        let expected =
            ["G90", "G1 X10 Y20.5", "G90", "G92 E7.25", "G1 F1200", "G91", "M82"].map(str::to_owned);
        assert_eq!(p.way_back(&lines), expected, "Z was never told, so its line is left out");
    }
}
