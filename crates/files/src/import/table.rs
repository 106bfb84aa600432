//! How single values are turned: one row for each name.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Collector;
use super::code::{Placeholders, translated};

/// How a value is turned.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Turn {
    /// A number stays.
    Number,
    /// Percent, with or without its sign, to a share.
    Percent,
    /// Percent with its sign to a share; a plain number is a length.
    Share,
    /// On or off.
    Switch,
    /// On with one of these words, off with another one.
    Is(&'static [&'static str]),
    /// A word stands for another.
    Word(&'static [(&'static str, &'static str)]),
    /// Text stays.
    Text,
    /// G-code with placeholders.
    Code(Placeholders),
}

/// A name of another slicer, our path, and how the value is turned.
pub(crate) type Row = (&'static str, &'static str, Turn);

/// A name of another slicer, our path, and the name of what a percentage is a share of.
pub(crate) type Relative = (&'static str, &'static str, &'static str);

/// The values of a profile that are not dealt with yet, by name.
pub(crate) type Values = BTreeMap<String, String>;

/// Takes over all values that have a row.
pub(crate) fn take_all(rows: &[Row], relative: &[Relative], found: &mut Values, out: &mut Collector) {
    let bases: Vec<Option<f64>> =
        relative.iter().map(|(.., base)| found.get(*base).and_then(|text| number(first_of(text)))).collect();
    for row in rows {
        if let Some(text) = found.remove(row.0) {
            take(row, &text, out);
        }
    }
    for (&(key, path, _), base) in relative.iter().zip(bases) {
        if let Some(text) = found.remove(key) {
            take_relative(key, &text, path, base, out);
        }
    }
}

/// Lists what is left as unknown, but for what a file says of itself and nobody prints.
pub(crate) fn leave_rest(found: Values, aside: &[&str], out: &mut Collector) {
    for (key, text) in found.into_iter().filter(|(key, _)| !aside.contains(&key.as_str())) {
        out.unknown(&key, &text);
    }
}

/// As much as there may be, mm3/s: no printer reaches it.
const NO_FLOW_LIMIT: f64 = 1000.0;

/// The filament's highest flow; 0 is no limit there.
pub(crate) fn take_flow_limit(found: &mut Values, out: &mut Collector) {
    let (key, path) = ("filament_max_volumetric_speed", "filament.max_volumetric_speed");
    let Some(text) = found.remove(key) else { return };
    match number(first_of(&text)) {
        Some(0.0) => out.change(key, &text, path, Value::from(NO_FLOW_LIMIT), "0 is no limit there"),
        _ => take(&(key, path, Turn::Number), &text, out),
    }
}

/// The switch of supports, which are a grid elsewhere.
pub(crate) fn take_supports(key: &str, found: &mut Values, out: &mut Collector) {
    let Some(text) = found.remove(key) else { return };
    let path = "support.method";
    match switch(&text) {
        Some(true) => out.change(key, &text, path, Value::from("grid"), "supports as a plain grid"),
        Some(false) => out.map(key, &text, path, Value::from("none")),
        None => out.leave(key, &text, "neither on nor off; left as it is"),
    }
}

/// The switch that keeps supports off the part.
pub(crate) fn take_bed_only(key: &str, found: &mut Values, out: &mut Collector) {
    if let Some(text) = found.remove(key) {
        out.map(key, &text, "support.everywhere", Value::from(switch(&text) != Some(true)));
    }
}

/// The angle from which overhangs are held, measured from the bed there and from the vertical here.
pub(crate) fn take_threshold(key: &str, found: &mut Values, out: &mut Collector) {
    let Some(text) = found.remove(key) else { return };
    match number(first_of(&text)) {
        Some(angle) if angle > 0.0 => {
            let why = "measured from the vertical here";
            out.change(key, &text, "support.overhang_angle_deg", Value::from(90.0 - angle), why);
        }
        _ => out.leave(key, &text, "chosen by the slicer; left as it is"),
    }
}

/// Names of what drives the fan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FanNames {
    /// Keeps it on at its least speed on layers that take their time.
    pub(crate) always: &'static str,
    /// Its least speed, percent.
    pub(crate) least: &'static str,
    /// Its speed on short layers, percent.
    pub(crate) most: &'static str,
    /// Slows down short layers, and blows more on them.
    pub(crate) automatic: &'static str,
}

/// The fan: a speed for all layers and one for short ones.
pub(crate) fn take_fan(names: &FanNames, found: &mut Values, out: &mut Collector) {
    let always = found.remove(names.always);
    let automatic = found.remove(names.automatic);
    let (least, most) = (found.remove(names.least), found.remove(names.most));
    let (usual, short) = ("filament.fan_speed", "filament.max_fan_speed");
    let is_off = |text: &Option<String>| text.as_deref().and_then(switch) == Some(false);
    match (&least, is_off(&always)) {
        (Some(text), false) => take(&(names.least, usual, Turn::Percent), text, out),
        (Some(text), true) => {
            out.change(
                names.least,
                text,
                usual,
                Value::from(0.0),
                "the fan rests on layers that take their time",
            );
        }
        (None, _) => {}
    }
    if let Some(text) = &most {
        // Alone it is all that is known of the fan.
        let path = if least.is_some() { short } else { usual };
        match is_off(&automatic) {
            true if least.is_some() => out.leave(names.most, text, "automatic cooling is switched off"),
            _ => take(&(names.most, path, Turn::Percent), text, out),
        }
    }
    if let Some(text) = automatic.filter(|text| switch(text) == Some(false)) {
        let why = "short layers are not slowed down";
        out.change(names.automatic, &text, "cooling.min_layer_time", Value::from(0.0), why);
        found.retain(|key, _| !["slowdown_below_layer_time", "slow_down_layer_time"].contains(&key.as_str()));
    }
}

/// Sizes of thumbnails, each with its format or with `format` for all.
pub(crate) fn take_thumbnails(found: &mut Values, out: &mut Collector) {
    let format = found.remove("thumbnails_format").unwrap_or_else(|| "PNG".to_owned());
    let Some(text) = found.remove("thumbnails") else { return };
    let sizes: Vec<String> = text
        .split(',')
        .map(str::trim)
        .filter(|size| !size.is_empty())
        .map(|size| if size.contains('/') { size.to_owned() } else { format!("{size}/{format}") })
        .collect();
    let is_known = |size: &String| {
        let (pixels, format) = size.split_once('/').unwrap_or_default();
        let sides = pixels.split_once('x').map(|(x, y)| [x, y]).unwrap_or_default();
        ["PNG", "QOI"].contains(&format)
            && sides.iter().all(|side| !side.is_empty() && side.bytes().all(|b| b.is_ascii_digit()))
    };
    match sizes.iter().all(is_known) {
        true => out.map("thumbnails", &text, "gcode.thumbnails", Value::from(sizes.join(", "))),
        false => out.leave("thumbnails", &text, "only PNG and QOI are written; left as it is"),
    }
}

/// The accelerations of all beads and of travels, called the same in PrusaSlicer and OrcaSlicer.
pub(crate) fn take_accelerations(found: &mut Values, out: &mut Collector) {
    for (asked, most, path) in [
        ("default_acceleration", "machine_max_acceleration_extruding", "printer.acceleration"),
        ("travel_acceleration", "machine_max_acceleration_travel", "printer.travel_acceleration"),
    ] {
        take_acceleration(asked, most, path, found, out);
    }
}

/// What the profile asks for goes before what the machine can do.
fn take_acceleration(
    asked: &'static str,
    most: &'static str,
    path: &'static str,
    found: &mut Values,
    out: &mut Collector,
) {
    let is_asked = |text: &String| number(first_of(text)).is_some_and(|x| x > 0.0);
    match found.remove(asked) {
        Some(text) if is_asked(&text) => {
            take(&(asked, path, Turn::Number), &text, out);
            if let Some(limit) = found.remove(most) {
                out.leave(most, &limit, &format!("{asked} goes before it"));
            }
        }
        Some(text) => out.leave(asked, &text, "chosen by the slicer; left as it is"),
        None => {}
    }
    if let Some(limit) = found.remove(most) {
        take(&(most, path, Turn::Number), &limit, out);
    }
}

/// Walls whose own width is 0 or missing have that of all lines.
pub(crate) fn take_width(own: &str, all: &str, found: &mut Values, out: &mut Collector) {
    let Some(width) = found.get(all).cloned() else { return };
    let is_chosen = |text: &str| number(first_of(text).trim_end_matches('%')).is_some_and(|x| x > 0.0);
    if is_chosen(&width) && !found.get(own).is_some_and(|text| is_chosen(text)) {
        found.remove(all);
        out.leave(all, &width, "stands for the walls' width, which has no value of its own");
        found.insert(own.to_owned(), width);
    }
}

/// Our side of a brim of this type; `None` for no brim.
pub(crate) fn brim_side(brim_type: &str) -> Option<&'static str> {
    match brim_type {
        "outer_only" | "auto_brim" | "brim_ears" => Some("outer"),
        "inner_only" => Some("inner"),
        "outer_and_inner" => Some("both"),
        _ => None,
    }
}

/// Takes over a value by its row. `text` may be a list, of which the first is for the first tool.
pub(crate) fn take(row: &Row, text: &str, out: &mut Collector) {
    let &(key, path, turn) = row;
    match turn {
        Turn::Text => out.map(key, text, path, Value::from(text)),
        Turn::Code(placeholders) => match translated(text, placeholders) {
            Ok(code) => out.map(key, text, path, Value::from(code)),
            Err(why) => out.leave(key, text, &why),
        },
        Turn::Word(words) => {
            let word = words.iter().find(|(theirs, _)| *theirs == text);
            match word {
                Some((_, ours)) => out.map(key, text, path, Value::from(*ours)),
                None => out.leave(key, text, &format!("{path}: nothing here stands for it; left as it is")),
            }
        }
        Turn::Switch => match switch(text) {
            Some(on) => out.map(key, text, path, Value::from(on)),
            None => out.leave(key, text, "neither on nor off; left as it is"),
        },
        Turn::Is(words) => out.map(key, text, path, Value::from(words.contains(&text))),
        Turn::Number | Turn::Percent | Turn::Share => number_by_row(row, text, out),
    }
}

fn number_by_row(&(key, path, turn): &Row, text: &str, out: &mut Collector) {
    let first = first_of(text);
    let is_percent = first.ends_with('%');
    let value = match number(first.trim_end_matches('%')) {
        Some(value) => value,
        None => return out.leave(key, text, "not a number; left as it is"),
    };
    let value = match turn {
        Turn::Percent => Value::from(thousandths(value / 100.0)),
        Turn::Share if is_percent => Value::from(thousandths(value / 100.0)),
        Turn::Share => return out.leave(key, text, "a length, and a share here; left as it is"),
        _ if is_percent => return out.leave(key, text, "relative to another value; left as it is"),
        _ => Value::from(value),
    };
    match is_one(text) {
        true => out.map(key, text, path, value),
        false => out.change(key, text, path, value, "the first of several values"),
    }
}

/// Shares without the dust of binary fractions.
pub(crate) fn thousandths(share: f64) -> f64 {
    (share * 1e6).round() / 1e6
}

/// The first of a list such as `0.4,0.4`.
pub(crate) fn first_of(text: &str) -> &str {
    text.split([',', ';']).next().unwrap_or_default().trim()
}

/// Whether all values of a list are the same.
fn is_one(text: &str) -> bool {
    let first = first_of(text);
    text.split([',', ';']).all(|other| other.trim() == first)
}

/// A finite decimal number.
pub(crate) fn number(text: &str) -> Option<f64> {
    let looks =
        text.trim().bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E'));
    text.trim().parse().ok().filter(|x: &f64| looks && x.is_finite())
}

/// A switch as slicers write it.
pub(crate) fn switch(text: &str) -> Option<bool> {
    match first_of(text) {
        "1" | "true" | "True" => Some(true),
        "0" | "false" | "False" => Some(false),
        _ => None,
    }
}

/// Bed outline as corners `0x0,250x0,...`: size, whether the origin is in the middle, whether it is round.
pub(crate) fn bed(text: &str) -> Option<([f64; 2], bool, bool)> {
    let corner = |word: &str| {
        let (x, y) = word.trim().split_once('x')?;
        Some([number(x)?, number(y)?])
    };
    let corners: Vec<[f64; 2]> = text.split(',').map(corner).collect::<Option<_>>()?;
    let span = |k: usize| {
        let low = corners.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(|c| c[k]).fold(f64::NEG_INFINITY, f64::max);
        (low, high - low)
    };
    let ((x, width), (y, depth)) = (span(0), span(1));
    if corners.len() < 3 || width <= 0.0 || depth <= 0.0 {
        return None;
    }
    /// Rounding of corners on a circle, mm.
    const SLACK: f64 = 0.5;
    let centred = (x + width / 2.0).abs() < SLACK && (y + depth / 2.0).abs() < SLACK;
    let cornered = x.abs() < SLACK && y.abs() < SLACK;
    let rounded = |x: f64| (x * 1000.0).round() / 1000.0;
    (centred || cornered).then_some(([rounded(width), rounded(depth)], centred, corners.len() > 8))
}

/// Takes over a bed.
pub(crate) fn take_bed(key: &str, text: &str, out: &mut Collector) {
    match bed(text) {
        None => out.leave(key, text, "its origin is neither a corner nor the middle; left as it is"),
        Some((size, centred, round)) => {
            out.map(key, text, "printer.bed_size", Value::from(size.to_vec()));
            out.map(key, text, "printer.origin", Value::from(if centred { "center" } else { "corner" }));
            out.map(key, text, "printer.bed_shape", Value::from(if round { "round" } else { "rectangle" }));
        }
    }
}

/// A speed or width that may be a share of another one; 0 means that the slicer chooses.
fn take_relative(key: &str, text: &str, path: &str, base: Option<f64>, out: &mut Collector) {
    let first = first_of(text);
    match (number(first.trim_end_matches('%')), first.ends_with('%'), base) {
        (Some(0.0), _, _) => out.leave(key, text, "chosen by the slicer; left as it is"),
        (Some(value), false, _) => out.map(key, text, path, Value::from(value)),
        (Some(share), true, Some(base)) => {
            let value = thousandths(share / 100.0 * base);
            out.change(key, text, path, Value::from(value), &format!("{share} % of {base}"));
        }
        _ => out.leave(key, text, "relative to a value that is not in the profile; left as it is"),
    }
}
