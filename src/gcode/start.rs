//! Start and end code: the user's templates, filled in, and made safe where they leave something out.

use super::read::{ReadMove, Reader};
use super::{GcodeOptions, Move, Place, PrinterOptions};
use crate::polygon::dvec2;
use std::fmt;

/// Units, positions and extrusion that all later text counts on, whatever the user's code has set.
const KNOWN_STATE: &str = "G21 ; millimetres\nG90 ; absolute positions\nM83 ; relative extrusion\n";

/// Names that templates may use in braces.
pub(super) const PLACEHOLDERS: [&str; 26] = [
    "acceleration",
    "bed_max_x",
    "bed_max_y",
    "bed_min_x",
    "bed_min_y",
    "bed_size_x",
    "bed_size_y",
    "bed_temp",
    "filament_diameter",
    "filament_type",
    "first_layer_bed_temp",
    "first_layer_height",
    "first_layer_nozzle_temp",
    "layer_count",
    "nozzle_diameter",
    "nozzle_temp",
    "park_x",
    "park_y",
    "park_z",
    "pressure_advance",
    "print_height",
    "printer_height",
    "retract_acceleration",
    "smaller_acceleration",
    "travel_acceleration",
    "travel_speed",
];

/// How far the head rises above the print before it goes away ({park_z}), mm.
const PARK_ABOVE: f64 = 10.0;

/// What is wrong with start or end code, or with settings `gcode.*`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum GcodeError {
    /// A word in braces that means nothing.
    UnknownPlaceholder {
        /// Path of the setting.
        setting: &'static str,
        /// Line of the template, from 1.
        line: usize,
        /// The word.
        name: String,
    },
    /// A setting that contradicts another one, or itself.
    Contradiction {
        /// Path of the setting.
        setting: String,
        /// What is wrong.
        cause: String,
    },
    /// `{if ...}` that is not a placeholder, a comparison and a value, or `{else}` or `{endif}` without it.
    BadCondition {
        /// Path of the setting.
        setting: &'static str,
        /// Line of the template, from 1.
        line: usize,
        /// The words in braces.
        words: String,
    },
    /// A brace without its partner in the same line.
    LooseBrace {
        /// Path of the setting.
        setting: &'static str,
        /// Line of the template, from 1.
        line: usize,
    },
}

impl fmt::Display for GcodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GcodeError::UnknownPlaceholder { setting, line, name } => {
                write!(
                    f,
                    "{setting}: line {line}: unknown placeholder {{{name}}}; known are {}",
                    PLACEHOLDERS.join(", ")
                )
            }
            GcodeError::Contradiction { setting, cause } => write!(f, "{setting}: {cause}"),
            GcodeError::BadCondition { setting, line, words } => {
                write!(
                    f,
                    "{setting}: line {line}: {{{words}}}: conditions are {{if NAME > 1}}, with ==, !=, <, >, <= or \
                     >=, then {{else}} and {{endif}}"
                )
            }
            GcodeError::LooseBrace { setting, line } => {
                write!(f, "{setting}: line {line}: a brace without its partner")
            }
        }
    }
}

impl std::error::Error for GcodeError {}

/// Checks the placeholders and conditions of start and end code, so that [`super::join()`] cannot fail
/// later.
pub fn check_templates(printer: &PrinterOptions) -> Result<(), GcodeError> {
    let blank = |name: &str| PLACEHOLDERS.contains(&name).then(String::new);
    for (setting, template) in
        [("printer.start_gcode", &printer.start_gcode), ("printer.end_gcode", &printer.end_gcode)]
    {
        expand(template, setting, blank)?;
    }
    Ok(())
}

/// Facts about the print that templates may ask for.
#[derive(Debug, Clone, Copy)]
pub(super) struct PrintFacts {
    pub(super) layer_count: usize,
    pub(super) first_layer_height: f64,
    pub(super) print_height: f64,
}

/// The start code ready to be written.
pub(super) fn start_code(options: &GcodeOptions, facts: PrintFacts) -> Result<String, GcodeError> {
    let printer = &options.printer;
    let template = &printer.start_gcode;
    let fill = |name: &str| placeholder(name, options, facts);
    let own = expand(template, "printer.start_gcode", fill)?;
    let accelerations = expand(printer.flavor.dialect().accelerations, "printer.flavor", fill)?;
    let heating = Heating::of(template, &own);
    let filament = &options.filament;

    let dialect = printer.flavor.dialect();
    let mut text = format!("{KNOWN_STATE}{} ; fan off\n{accelerations}", dialect.fan_off);
    if filament.pressure_advance > 0.0 {
        text += &expand(dialect.pressure_advance, "printer.flavor", fill)?;
    }
    if !heating.bed && filament.first_layer_bed_temp > 0.0 {
        let temp = filament.first_layer_bed_temp;
        text += &format!("M140 S{temp} ; heat the bed\nM190 S{temp} ; wait for the bed\n");
    }
    let wait = format!("M109 S{} ; heat the nozzle and wait\n", filament.first_layer_nozzle_temp);
    if heating.nozzle == NozzleHeating::TooLate {
        text += &wait;
    }
    push_block(&mut text, &own);
    if heating.nozzle == NozzleHeating::Missing {
        text += &wait;
    }
    text += KNOWN_STATE;
    text += "G92 E0\n";
    Ok(text)
}

/// The lines of an event ready to be written, and the known state behind them.
pub(super) fn event_code(own: &str, options: &GcodeOptions, facts: PrintFacts) -> Result<String, GcodeError> {
    let mut text = String::new();
    push_block(&mut text, &expand(own, "gcode.events", |name| placeholder(name, options, facts))?);
    Ok(text + KNOWN_STATE)
}

/// The end code ready to be written.
pub(super) fn end_code(options: &GcodeOptions, facts: PrintFacts) -> Result<String, GcodeError> {
    let template = &options.printer.end_gcode;
    let own = expand(template, "printer.end_gcode", |name| placeholder(name, options, facts))?;
    let mut text = String::new();
    push_block(&mut text, &own);
    // Macros with a speaking name switch off themselves; that is what they are for.
    if own.lines().any(is_end_macro) {
        return Ok(text);
    }
    for (command, line) in [("M104", "M104 S0 ; nozzle off\n"), ("M140", "M140 S0 ; bed off\n")] {
        if !own.lines().any(|l| command_of(l) == command) {
            text += line;
        }
    }
    if !own.lines().any(|l| matches!(command_of(l).as_str(), "M106" | "M107")) {
        text += &format!("{} ; fan off\n", options.printer.flavor.dialect().fan_off);
    }
    Ok(text)
}

/// Whether a line calls a Klipper macro that ends the print, by the names in use for it
/// (klipper3d.org, `sample-macros.cfg`, and the printers' makers).
fn is_end_macro(line: &str) -> bool {
    matches!(command_of(line).as_str(), "END_PRINT" | "PRINT_END")
}

/// Appends lines, ending with a line feed, without carriage returns. Empty ones, such as conditions
/// leave, are dropped.
fn push_block(text: &mut String, block: &str) {
    for line in block.lines().map(str::trim_end).filter(|line| !line.is_empty()) {
        text.push_str(line);
        text.push('\n');
    }
}

/// Replaces the words in braces and keeps or drops what stands between `{if NAME > 1}`, `{else}` and
/// `{endif}`. Line feeds are kept all, so that lines of template and text correspond.
pub(super) fn expand(
    template: &str,
    setting: &'static str,
    value: impl Fn(&str) -> Option<String>,
) -> Result<String, GcodeError> {
    let mut out = String::with_capacity(template.len());
    let mut open: Vec<Branch> = Vec::new();
    let mut last = 1;
    for (line, mut rest) in (1..).zip(template.split_inclusive('\n')) {
        last = line;
        let loose = || GcodeError::LooseBrace { setting, line };
        let bad = |words: &str| GcodeError::BadCondition { setting, line, words: words.to_owned() };
        while let Some((before, after)) = rest.split_once('{') {
            let (words, behind) = after.split_once('}').ok_or_else(loose)?;
            let words = words.trim();
            push_if_kept(&mut out, before, &open);
            match words.split_whitespace().next() {
                Some("if") => {
                    open.push(Branch { holds: condition(words, setting, line, &value)?, in_else: false })
                }
                Some("else") if words == "else" => {
                    let branch = open.last_mut().filter(|b| !b.in_else).ok_or_else(|| bad(words))?;
                    *branch = Branch { holds: !branch.holds, in_else: true };
                }
                Some("endif") if words == "endif" => {
                    open.pop().ok_or_else(|| bad(words))?;
                }
                _ => {
                    let unknown = || GcodeError::UnknownPlaceholder { setting, line, name: words.to_owned() };
                    let filled = value(words).ok_or_else(unknown)?;
                    push_if_kept(&mut out, &filled, &open);
                }
            }
            rest = behind;
        }
        if rest.contains('}') {
            return Err(loose());
        }
        push_if_kept(&mut out, rest, &open);
    }
    if open.is_empty() {
        return Ok(out);
    }
    Err(GcodeError::BadCondition { setting, line: last, words: "endif missing".to_owned() })
}

/// An `{if}` that is not closed yet.
struct Branch {
    /// Whether what stands here is kept.
    holds: bool,
    in_else: bool,
}

fn push_if_kept(out: &mut String, text: &str, open: &[Branch]) {
    match open.iter().all(|b| b.holds) {
        true => out.push_str(text),
        false => out.extend(text.matches('\n')),
    }
}

/// Whether `if NAME OP VALUE` holds: as numbers if both sides are, else as words.
fn condition(
    words: &str,
    setting: &'static str,
    line: usize,
    value: &impl Fn(&str) -> Option<String>,
) -> Result<bool, GcodeError> {
    let bad = || GcodeError::BadCondition { setting, line, words: words.to_owned() };
    let [_, name, op, right] = words.split_whitespace().collect::<Vec<_>>()[..] else { return Err(bad()) };
    let left =
        value(name).ok_or_else(|| GcodeError::UnknownPlaceholder { setting, line, name: name.to_owned() })?;
    let right = right.trim_matches('"');
    let order = match (left.parse::<f64>(), right.parse::<f64>()) {
        (Ok(a), Ok(b)) => a.total_cmp(&b),
        _ => left.as_str().cmp(right),
    };
    match op {
        "==" => Ok(order.is_eq()),
        "!=" => Ok(order.is_ne()),
        "<" => Ok(order.is_lt()),
        ">" => Ok(order.is_gt()),
        "<=" => Ok(order.is_le()),
        ">=" => Ok(order.is_ge()),
        _ => Err(bad()),
    }
}

/// The value of a placeholder; `None` if there is none of this name.
fn placeholder(name: &str, options: &GcodeOptions, facts: PrintFacts) -> Option<String> {
    let GcodeOptions { printer, filament, speed, .. } = options;
    let number = match name {
        "acceleration" => printer.acceleration,
        "bed_max_x" => printer.bed().max.x,
        "bed_max_y" => printer.bed().max.y,
        "bed_min_x" => printer.bed().min.x,
        "bed_min_y" => printer.bed().min.y,
        "bed_size_x" => printer.bed_size[0],
        "bed_size_y" => printer.bed_size[1],
        "bed_temp" => filament.bed_temp,
        "filament_diameter" => filament.diameter,
        // One line, whatever the name holds.
        "filament_type" => return Some(filament.material.replace(char::is_control, " ")),
        "first_layer_bed_temp" => filament.first_layer_bed_temp,
        "first_layer_height" => facts.first_layer_height,
        "first_layer_nozzle_temp" => filament.first_layer_nozzle_temp,
        "layer_count" => return Some(facts.layer_count.to_string()),
        "nozzle_diameter" => printer.nozzle_diameter,
        "nozzle_temp" => filament.nozzle_temp,
        "park_x" => printer.parking().x,
        "park_y" => printer.parking().y,
        "pressure_advance" => filament.pressure_advance,
        "park_z" => (facts.print_height + PARK_ABOVE).min(printer.height).max(facts.print_height),
        "print_height" => facts.print_height,
        "printer_height" => printer.height,
        "retract_acceleration" => printer.retract_acceleration,
        "smaller_acceleration" => printer.acceleration.min(printer.travel_acceleration),
        "travel_acceleration" => printer.travel_acceleration,
        "travel_speed" => speed.travel,
        _ => return None,
    };
    // Micrometres hide what binary fractions add: 0.2 * 3 is 0.6000000000000001.
    Some(((number * 1000.0).round() / 1000.0).to_string())
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NozzleHeating {
    /// The code waits for a hot nozzle before it extrudes.
    Done,
    /// It never waits, nor does it extrude.
    Missing,
    /// It extrudes before it waits, or without waiting.
    TooLate,
}

/// What start code does about temperatures.
///
/// M140 or M190 heat the bed, M109 waits for the nozzle. A command that is handed a temperature by
/// placeholder does so too, except M104, which does not wait: Klipper's macros, such as
/// `PRINT_START EXTRUDER={nozzle_temp}`.
struct Heating {
    bed: bool,
    nozzle: NozzleHeating,
}

impl Heating {
    /// Judges by the template and what it became; lines correspond.
    fn of(template: &str, expanded: &str) -> Heating {
        let heats_bed =
            |line: &str| matches!(command_of(line).as_str(), "M140" | "M190") || names(line, "bed_temp}");
        let waits = |line: &str| match command_of(line).as_str() {
            "M109" => true,
            "M104" => false,
            _ => names(line, "nozzle_temp}"),
        };
        // What a condition has dropped does nothing.
        let said = |line: &str, became: &str| if became.trim().is_empty() { "" } else { line }.to_owned();
        let lines: Vec<String> =
            template.lines().zip(expanded.lines()).map(|(line, became)| said(line, became)).collect();
        let waits_at = lines.iter().position(|line| waits(line));
        let mut steps = Reader::new(expanded.as_bytes());
        let extrudes_at = steps.find(|step| step.filament_mm != 0.0).map(|step| step.line as usize - 1);
        let nozzle = match (waits_at, extrudes_at) {
            (Some(wait), Some(first)) if first < wait => NozzleHeating::TooLate,
            (Some(_), _) => NozzleHeating::Done,
            (None, Some(_)) => NozzleHeating::TooLate,
            (None, None) => NozzleHeating::Missing,
        };
        Heating { bed: lines.iter().any(|line| heats_bed(line)), nozzle }
    }
}

/// Whether the line outside comments uses a placeholder that ends like this.
fn names(line: &str, ending: &str) -> bool {
    line.split(';').next().unwrap_or_default().contains(ending)
}

/// The command of a line in capitals, such as `M109`; empty for a comment.
fn command_of(line: &str) -> String {
    let code = line.split(';').next().unwrap_or_default().trim_start();
    code.chars()
        .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
        .collect::<String>()
        .to_ascii_uppercase()
}

/// What text of other hands, start or end code, does to the machine.
#[derive(Debug)]
pub(super) struct CodeEffect {
    /// Its moves, to be timed.
    pub(super) moves: Vec<Move>,
    /// Where the nozzle is afterwards, and its height in micrometres.
    pub(super) at: Place,
    pub(super) z: i32,
    /// Filament used: the farthest that it was pushed, in steps of 1e-5 mm.
    pub(super) filament: i32,
    /// How far it is pulled back at the end, in steps.
    pub(super) retracted: i32,
}

/// Follows text from a place and height on.
pub(super) fn follow(text: &str, at: Place, z: i32) -> CodeEffect {
    let mut reader = Reader::from_place(text.as_bytes(), [at.mm().x, at.mm().y, f64::from(z) / 1000.0]);
    let mut moves = Vec::new();
    let (mut pushed, mut farthest) = (0.0_f64, 0.0_f64);
    for step in &mut reader {
        pushed += step.filament_mm;
        farthest = farthest.max(pushed);
        push_moves(&step, &mut moves);
    }
    let [x, y, z] = reader.place();
    CodeEffect {
        moves,
        at: Place::of(dvec2(x, y)),
        z: super::plan::micrometres(z),
        filament: super::plan::filament_steps(farthest),
        retracted: super::plan::filament_steps(farthest - pushed),
    }
}

/// A move of the text as moves of the plan: z apart from the plane, which only the timing notices.
fn push_moves(step: &ReadMove, moves: &mut Vec<Move>) {
    // Text that has not set a feed rate moves at the firmware's own; 50 mm/s is as good as any.
    let feed = if step.speed > 0.0 { super::plan::feed_rate(step.speed) } else { 3000 };
    let filament = super::plan::filament_steps(step.filament_mm);
    let to = Place::of(dvec2(step.to[0], step.to[1]));
    if step.from[2] != step.to[2] {
        moves.push(Move::Lift { z: super::plan::micrometres(step.to[2]), feed });
    }
    match (step.moves_in_plane(), filament) {
        (true, f) if f > 0 => moves.push(Move::Extrude { to, filament, feed }),
        (true, _) => moves.push(Move::Travel { to, feed }),
        (false, 0) => {}
        (false, _) => moves.push(Move::Filament { filament, feed }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(start: &str) -> GcodeOptions {
        let printer = PrinterOptions { start_gcode: start.to_owned(), ..PrinterOptions::default() };
        GcodeOptions { printer, ..GcodeOptions::default() }
    }

    const FACTS: PrintFacts = PrintFacts { layer_count: 3, first_layer_height: 0.2, print_height: 0.6 };

    fn started(start: &str) -> String {
        start_code(&options(start), FACTS).expect("good template")
    }

    /// Index of the first line that starts so.
    fn line(text: &str, start: &str) -> Option<usize> {
        text.lines().position(|l| l.starts_with(start))
    }

    #[test]
    fn placeholders_are_filled_in() {
        let text = started("M117 {layer_count} layers of {filament_type}\nG1 X{bed_size_x} Z{ park_z }\n");
        assert!(text.contains("M117 3 layers of PLA\nG1 X220 Z10.6\n"), "{text}");
    }

    #[test]
    fn an_unknown_placeholder_names_setting_line_and_word() {
        let found = start_code(&options("G28\nM109 S{temp}\n"), FACTS).expect_err("unknown");
        assert!(
            found
                .to_string()
                .starts_with("printer.start_gcode: line 2: unknown placeholder {temp}; known are ")
        );
        assert_eq!(check_templates(&options("G28\nM109 S{temp}\n").printer), Err(found));
        assert!(check_templates(&PrinterOptions::default()).is_ok());
        for loose in ["M109 S{bed_temp", "M109 S}"] {
            let found = check_templates(&options(loose).printer).expect_err("loose brace");
            assert_eq!(found.to_string(), "printer.start_gcode: line 1: a brace without its partner");
        }
    }

    #[test]
    fn conditions_choose_lines_and_parts_of_lines() {
        let code = "{if bed_temp > 50}\nM190 S{bed_temp}\n{else}\nM117 cold bed\n{endif}\n\
                    G28{if filament_type == TPU} X{endif}\n{if layer_count != 3}{if nozzle_temp > 1}M300{endif}{endif}\n";
        let text = started(code);
        assert!(text.contains("\nM190 S60\nG28\nM109"), "{text}");
        assert!(!text.contains("M117") && !text.contains("M300") && !text.contains("\n\n"), "{text}");
        let mut cold = options(code);
        cold.filament.bed_temp = 0.0;
        let text = start_code(&cold, FACTS).expect("good");
        // The dropped M190 heats nothing: the first layer's 60 degrees are added.
        assert!(text.contains("M190 S60 ; wait") && text.contains("\nM117 cold bed\nG28\n"), "{text}");
    }

    #[test]
    fn conditions_that_cannot_be_read_are_named() {
        for (code, words) in [
            ("{if bed_temp}", "if bed_temp"),
            ("{if bed_temp ~ 3}{endif}", "if bed_temp ~ 3"),
            ("{else}", "else"),
            ("G28\n{endif}", "endif"),
            ("{if bed_temp > 3}\nG28", "endif missing"),
            ("{if bed_temp > 3}{else}{else}{endif}", "else"),
        ] {
            let found = check_templates(&options(code).printer).expect_err(code);
            assert!(matches!(&found, GcodeError::BadCondition { words: w, .. } if w == words), "{found}");
        }
        let found = check_templates(&options("{if tmp > 3}{endif}").printer).expect_err("unknown");
        assert!(matches!(found, GcodeError::UnknownPlaceholder { .. }));
    }

    #[test]
    fn every_placeholder_has_a_value() {
        for name in PLACEHOLDERS {
            assert!(placeholder(name, &GcodeOptions::default(), FACTS).is_some(), "{name}");
        }
    }

    #[test]
    fn code_that_heats_is_left_alone() {
        let text = started(&PrinterOptions::default().start_gcode);
        assert_eq!(text.matches("M109").count(), 1);
        assert_eq!(text.matches("M190").count(), 1);
        assert!(line(&text, "M190") < line(&text, "G28") && line(&text, "G28") < line(&text, "M109"));
        let macros = started("PRINT_START BED={first_layer_bed_temp} NOZZLE={first_layer_nozzle_temp}");
        assert!(!macros.contains("M109") && !macros.contains("M190"), "{macros}");
    }

    #[test]
    fn missing_heating_is_added() {
        let text = started("G28 ; and no M109");
        assert!(
            line(&text, "M190 S60") < line(&text, "G28") && line(&text, "G28") < line(&text, "M109 S210")
        );
        let without_wait = started("M104 S{nozzle_temp}\nG28");
        assert!(line(&without_wait, "M109 S210") > line(&without_wait, "G28"));
    }

    #[test]
    fn heating_goes_first_where_the_code_extrudes_too_early() {
        for early in ["G28\nG1 X50 E5 F600", "G28\nG1 E3 F60\nM109 S200"] {
            let text = started(early);
            assert!(line(&text, "M109 S210") < line(&text, "G28"), "{text}");
        }
    }

    #[test]
    fn code_that_ends_retracted_is_seen() {
        let effect = follow("G28\nG1 Z0.3\nG92 E0\nG1 X80 E9 F1200\nG1 E8.2 F2100", Place::default(), 0);
        assert_eq!((effect.filament, effect.retracted), (900_000, 80_000));
        assert_eq!((effect.at, effect.z), (Place { x: 80_000, y: 0 }, 300));
    }

    #[test]
    fn end_code_switches_off_what_it_forgot() {
        let printer =
            PrinterOptions { end_gcode: "M104 S0\nG28 X\n".to_owned(), ..PrinterOptions::default() };
        let text = end_code(&GcodeOptions { printer, ..GcodeOptions::default() }, FACTS).expect("good");
        assert_eq!(text, "M104 S0\nG28 X\nM140 S0 ; bed off\nM107 ; fan off\n");
    }
}
