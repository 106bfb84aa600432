//! Moves to text. A part can need 50 MB of it, so numbers are printed by integer arithmetic, each
//! line in a small buffer of its own and then appended at once.

use super::flavor::Dialect;
use super::plan::LayerPlan;
use super::{GcodeOptions, LabelledObject, MARK_EVERY_S, Move, Place, label};
use crate::region::Role;

/// Longest line of a move: letters, signs, 10 digits and a point for each of six words, with room.
const LINE: usize = 112;

/// Name in `;TYPE:` comments, as PrusaSlicer writes them and viewers read them.
pub const fn type_name(role: Role) -> &'static str {
    match role {
        Role::OuterWall => "External perimeter",
        Role::InnerWall => "Perimeter",
        Role::OverhangWall => "Overhang perimeter",
        Role::GapFill => "Gap fill",
        Role::BottomSkin | Role::SolidInfill => "Solid infill",
        Role::TopSkin => "Top solid infill",
        Role::Infill => "Internal infill",
        Role::Bridge => "Bridge infill",
        Role::Ironing => "Ironing",
        Role::Skirt | Role::Brim | Role::Teeth => "Skirt/Brim",
        Role::Raft | Role::Support => "Support material",
        Role::SupportInterface => "Support material interface",
        Role::Prime => "Custom",
        Role::WipeTower => "Wipe tower",
    }
}

/// The text of a layer; `marks` gets the places where progress can be reported.
pub(super) fn write_layer(plan: &LayerPlan, options: &GcodeOptions, marks: &mut Vec<(u32, f64)>) -> Vec<u8> {
    // A line of a bead has some 27 bytes.
    let mut writer = Writer::after(Vec::with_capacity(plan.moves.len() * 28), options);
    let (mut passed, mut marked) = (0.0, 0.0);
    for (&step, &time) in plan.moves.iter().zip(&plan.times) {
        if passed - marked >= MARK_EVERY_S {
            marks.push((writer.out.len() as u32, passed));
            marked = passed;
        }
        writer.write(step);
        passed += time;
    }
    writer.out
}

/// Writes moves, leaving out words that have not changed since it began.
#[derive(Debug)]
pub(super) struct Writer<'a> {
    pub(super) out: Vec<u8>,
    dialect: &'static Dialect,
    objects: &'a [LabelledObject],
    at: Option<Place>,
    feed: Option<u32>,
}

impl<'a> Writer<'a> {
    /// A writer that goes on behind `out`, without knowing what the machine did there.
    pub(super) fn after(out: Vec<u8>, options: &'a GcodeOptions) -> Writer<'a> {
        let dialect = options.printer.flavor.dialect();
        Writer { out, dialect, objects: &options.objects, at: None, feed: None }
    }

    /// Appends one move.
    pub(super) fn write(&mut self, step: Move) {
        match step {
            Move::Role(role) => self.comment(b";TYPE:", type_name(role).as_bytes()),
            Move::Width(width) => self.line(|line| line.text(b";WIDTH:").thousandths(i64::from(width))),
            Move::Height(height) => self.line(|line| line.text(b";HEIGHT:").thousandths(i64::from(height))),
            Move::Fan(0) => self.comment(self.dialect.fan_off.as_bytes(), b""),
            Move::Fan(duty) => self.line(|line| line.text(b"M106 S").integer(u32::from(duty))),
            Move::Object { place, begins } => {
                let line = label::mark(self.dialect.labels, self.objects, place as usize, begins);
                self.out.extend_from_slice(line.as_bytes());
            }
            Move::Acceleration(acceleration) => {
                let line = self.dialect.bead_acceleration;
                let line = line.replace("{bead_acceleration}", &acceleration.to_string());
                self.out.extend_from_slice(line.as_bytes());
            }
            Move::Extrude { to, filament, feed } | Move::Wipe { to, filament, feed } => {
                let (at, feed) = (self.at.replace(to), self.new_feed(feed));
                self.line(|line| {
                    line.text(b"G1")
                        .place(at, to)
                        .text(b" E")
                        .hundred_thousandths(i64::from(filament))
                        .feed(feed)
                });
            }
            Move::Climb { to, z, filament, feed } => {
                let (at, feed) = (self.at.replace(to), self.new_feed(feed));
                self.line(|line| {
                    line.text(b"G1")
                        .place(at, to)
                        .text(b" Z")
                        .thousandths(i64::from(z))
                        .text(b" E")
                        .hundred_thousandths(i64::from(filament))
                        .feed(feed)
                });
            }
            Move::Arc { curve, filament, feed } => {
                let feed = self.new_feed(feed);
                self.at = Some(curve.to);
                self.line(|line| {
                    line.text(if curve.clockwise { b"G2" } else { b"G3" })
                        .place(None, curve.to)
                        .text(b" I")
                        .thousandths(i64::from(curve.offset.x))
                        .text(b" J")
                        .thousandths(i64::from(curve.offset.y))
                        .text(b" E")
                        .hundred_thousandths(i64::from(filament))
                        .feed(feed)
                });
            }
            Move::Travel { to, feed } => {
                let (at, feed) = (self.at.replace(to), self.new_feed(feed));
                self.line(|line| line.text(b"G1").place(at, to).feed(feed));
            }
            Move::Filament { filament, feed } => {
                let feed = self.new_feed(feed);
                self.line(|line| line.text(b"G1 E").hundred_thousandths(i64::from(filament)).feed(feed));
            }
            Move::Tool { from, to, nozzle, standby } => self.tool(from, to, nozzle, standby),
            Move::Lift { z, feed } => {
                let feed = self.new_feed(feed);
                self.line(|line| line.text(b"G1 Z").thousandths(i64::from(z)).feed(feed));
            }
        }
    }

    /// Temperatures by tool number where the old tool cools; the new one is the active one by then.
    fn tool(&mut self, from: u8, to: u8, nozzle: u16, standby: u16) {
        if standby > 0 {
            self.line(|line| line.text(b"M104 T").integer(from.into()).text(b" S").integer(standby.into()));
        }
        self.line(|line| line.text(b"T").integer(to.into()));
        self.line(|line| line.text(b"M109 S").integer(nozzle.into()));
        // Firmwares may move for the change.
        (self.at, self.feed) = (None, None);
    }

    /// Appends a comment of one name and one value, both without line feeds.
    pub(super) fn comment(&mut self, name: &[u8], value: &[u8]) {
        self.out.extend_from_slice(name);
        self.out.extend_from_slice(value);
        self.out.push(b'\n');
    }

    /// Appends a comment of a name and a length in micrometres, as mm.
    pub(super) fn length_comment(&mut self, name: &[u8], micrometres: i32) {
        self.line(|line| line.text(name).thousandths(i64::from(micrometres)));
    }

    /// The feed rate if it has to be written.
    fn new_feed(&mut self, feed: u32) -> Option<u32> {
        (self.feed.replace(feed) != Some(feed)).then_some(feed)
    }

    fn line(&mut self, fill: impl FnOnce(&mut Line) -> &mut Line) {
        let mut line = Line { bytes: [0; LINE], len: 0 };
        fill(&mut line).byte(b'\n');
        self.out.extend_from_slice(&line.bytes[..line.len]);
    }
}

/// One line being put together. Numbers have at most 20 characters and there are at most six, so
/// that [`LINE`] is never full.
struct Line {
    bytes: [u8; LINE],
    len: usize,
}

impl Line {
    fn byte(&mut self, byte: u8) -> &mut Self {
        self.bytes[self.len] = byte;
        self.len += 1;
        self
    }

    fn text(&mut self, text: &[u8]) -> &mut Self {
        self.bytes[self.len..self.len + text.len()].copy_from_slice(text);
        self.len += text.len();
        self
    }

    /// X and Y words, without the one that stays as it was.
    fn place(&mut self, from: Option<Place>, to: Place) -> &mut Self {
        if from.is_none_or(|f| f.x != to.x) {
            self.text(b" X").thousandths(i64::from(to.x));
        }
        if from.is_none_or(|f| f.y != to.y) {
            self.text(b" Y").thousandths(i64::from(to.y));
        }
        self
    }

    fn feed(&mut self, feed: Option<u32>) -> &mut Self {
        match feed {
            Some(feed) => self.text(b" F").integer(feed),
            None => self,
        }
    }

    /// A number given in thousandths, trailing zeros dropped.
    fn thousandths(&mut self, value: i64) -> &mut Self {
        let size = self.sign(value);
        self.integer(size / 1000).fraction(digits(size % 1000 * 100))
    }

    /// A number given in hundred thousandths, trailing zeros dropped.
    fn hundred_thousandths(&mut self, value: i64) -> &mut Self {
        let size = self.sign(value);
        self.integer(size / 100_000).fraction(digits(size % 100_000))
    }

    /// Writes the minus of a value that fits 32 bits and returns its size.
    fn sign(&mut self, value: i64) -> u32 {
        if value < 0 {
            self.byte(b'-');
        }
        value.unsigned_abs() as u32
    }

    fn integer(&mut self, value: u32) -> &mut Self {
        // Nearly every number is below 100,000; two halves cover the rest.
        if value >= 100_000 {
            return self.integer(value / 100_000).text(&digits(value % 100_000));
        }
        let digits = digits(value);
        let zeros = digits[..4].iter().take_while(|&&d| d == b'0').count();
        self.text(&digits[zeros..])
    }

    /// The digits behind the point, without those that are 0 to the end.
    fn fraction(&mut self, digits: [u8; 5]) -> &mut Self {
        match digits.iter().rposition(|&d| d != b'0') {
            Some(last) => self.byte(b'.').text(&digits[..=last]),
            None => self,
        }
    }
}

/// The five digits of a number below 100,000. Divisors known to the compiler become multiplications.
fn digits(value: u32) -> [u8; 5] {
    let digit = |n: u32| b'0' + (n % 10) as u8;
    [digit(value / 10_000), digit(value / 1000), digit(value / 100), digit(value / 10), digit(value)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::Curve;

    fn written(moves: &[Move]) -> String {
        let options = GcodeOptions::default();
        let mut writer = Writer::after(Vec::new(), &options);
        moves.iter().for_each(|&m| writer.write(m));
        String::from_utf8(writer.out).expect("ASCII")
    }

    #[test]
    fn words_that_do_not_change_are_left_out() {
        let to = |x, y| Place { x, y };
        let moves = [
            Move::Role(Role::OuterWall),
            Move::Width(450),
            Move::Travel { to: to(10_000, -20_500), feed: 9000 },
            Move::Extrude { to: to(10_000, 20_001), filament: 137_090, feed: 1500 },
            Move::Extrude { to: to(-7, 20_001), filament: 3, feed: 1500 },
            Move::Filament { filament: -80_000, feed: 2100 },
            Move::Lift { z: 200, feed: 600 },
            Move::Fan(255),
            Move::Fan(0),
        ];
        let text = ";TYPE:External perimeter\n;WIDTH:0.45\nG1 X10 Y-20.5 F9000\nG1 Y20.001 E1.3709 F1500\n\
                    G1 X-0.007 E0.00003\nG1 E-0.8 F2100\nG1 Z0.2 F600\nM106 S255\nM107\n";
        assert_eq!(written(&moves), text);
    }

    #[test]
    fn the_longest_line_fits() {
        let to = Place { x: i32::MIN, y: i32::MIN };
        let text = written(&[Move::Extrude { to, filament: i32::MIN, feed: u32::MAX }]);
        assert_eq!(text, "G1 X-2147483.648 Y-2147483.648 E-21474.83648 F4294967295\n");
        let curve = Curve { to, offset: to, clockwise: true };
        let text = written(&[Move::Arc { curve, filament: i32::MIN, feed: u32::MAX }]);
        assert!(
            text.starts_with("G2 X-2147483.648 Y-2147483.648 I-2147483.648 J-2147483.648 E-21474.83648 F")
        );
    }
}
