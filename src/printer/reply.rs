//! What the printer says: one line of text to one [`Reply`].
//!
//! Numbers that decide something must stand alone and whole, so that a garbled line is rather nothing
//! than another number.

use serde::Serialize;

/// Heater readings of one report, degrees Celsius.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Temperatures {
    /// Nozzles in order of their number; a printer with one has one.
    pub tools: Vec<Reading>,
    /// The bed, if it is heated.
    pub bed: Option<Reading>,
    /// The chamber, if it is heated.
    pub chamber: Option<Reading>,
}

/// One heater, degrees Celsius.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Reading {
    /// Measured.
    pub now: f64,
    /// Wanted; 0 is off, `None` where the printer does not say.
    pub target: Option<f64>,
}

/// `ok` and what came with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct OkReply {
    /// Number of the line acknowledged (`ADVANCED_OK`, Repetier).
    pub(super) line: Option<u32>,
    /// Free places of the planner (`P`).
    pub(super) planner: Option<u32>,
    /// Free places of the command queue (`B`).
    pub(super) block: Option<u32>,
    /// The answer to `M105`: temperatures stand behind the `ok`.
    pub(super) report: bool,
}

/// What the printer asks by `//action:`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    Pause,
    Paused,
    Resume,
    Cancel,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Reply {
    Ok(OkReply),
    Resend(u32),
    /// The board has just started.
    Started,
    Busy,
    /// The printer waits for lines (`wait` of Repetier).
    Idle,
    /// A line arrived garbled or out of order; a resend follows. `last` is the last good number.
    Transmission {
        last: Option<u32>,
    },
    /// `Error:` about anything else.
    Fault,
    /// The printer has given up.
    Killed,
    Action(Action),
    /// `FIRMWARE_NAME:...`
    Firmware,
    /// `Cap:NAME:1`
    Capability {
        name: String,
        on: bool,
    },
    /// A report without `ok`.
    Report,
    Other,
}

/// Transmission errors as firmwares word them, lower case.
const TRANSMISSION: [&str; 6] = [
    "checksum mismatch",
    "line number is not last line number+1",
    "no checksum with line number",
    "no line number with checksum",
    "wrong checksum",
    "format error",
];

pub(super) fn parse(line: &str) -> Reply {
    let line = line.trim();
    if let Some(rest) = word(line, "ok") {
        return Reply::Ok(parse_ok(rest));
    }
    if let Some(number) = resend(line) {
        return Reply::Resend(number);
    }
    if line.starts_with("!!") {
        return Reply::Killed;
    }
    if let Some(text) = line.strip_prefix("Error:").or_else(|| line.strip_prefix("error:")) {
        return error(text.trim());
    }
    if let Some(text) = line.strip_prefix("//") {
        return action(text.trim()).map_or(Reply::Other, Reply::Action);
    }
    let told = line.strip_prefix("echo:").unwrap_or(line).trim();
    if told.starts_with("busy:") {
        return Reply::Busy;
    }
    if is_banner(told) {
        return Reply::Started;
    }
    if line == "wait" {
        return Reply::Idle;
    }
    if line.starts_with("FIRMWARE_NAME:") {
        return Reply::Firmware;
    }
    if let Some(capability) = line.strip_prefix("Cap:") {
        let (name, value) = capability.rsplit_once(':').unwrap_or((capability, "0"));
        return Reply::Capability { name: name.to_owned(), on: value.trim() == "1" };
    }
    if is_report(line) { Reply::Report } else { Reply::Other }
}

/// The rest behind `head` where `head` stands alone at the beginning.
fn word<'a>(line: &'a str, head: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(head)?;
    (rest.is_empty() || rest.starts_with(' ')).then(|| rest.trim_start())
}

fn parse_ok(rest: &str) -> OkReply {
    let mut ok = OkReply { report: is_report(rest), ..OkReply::default() };
    for (place, part) in rest.split_ascii_whitespace().enumerate() {
        match part.split_at_checked(1) {
            Some(("N", number)) => ok.line = number.parse().ok(),
            Some(("P", number)) => ok.planner = number.parse().ok(),
            Some(("B", number)) => ok.block = number.parse().ok(),
            _ if place == 0 => ok.line = part.parse().ok(),
            _ => {}
        }
    }
    ok
}

/// `Resend: 12`, `Resend:12`, `Resend: N12`, `rs 12`, `rs N12`; nothing may follow.
fn resend(line: &str) -> Option<u32> {
    let rest = line.strip_prefix("Resend:").or_else(|| line.strip_prefix("rs "))?.trim();
    let digits = rest.strip_prefix('N').unwrap_or(rest);
    digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse().ok())?
}

fn error(text: &str) -> Reply {
    let lower = text.to_ascii_lowercase();
    let last = lower.find("last line:").map(|at| last_number(&lower[at + "last line:".len()..]));
    let told = TRANSMISSION.iter().any(|known| lower.contains(known) || known.starts_with(lower.as_str()));
    if told || last.is_some() || lower.contains("expected line") {
        return Reply::Transmission { last: last.flatten() };
    }
    if lower.contains("unknown command") {
        return Reply::Other;
    }
    if lower.contains("halted") || lower.contains("kill") { Reply::Killed } else { Reply::Fault }
}

fn last_number(text: &str) -> Option<u32> {
    text.trim().parse().ok()
}

fn action(text: &str) -> Option<Action> {
    match text.strip_prefix("action:")?.trim() {
        "pause" => Some(Action::Pause),
        "paused" => Some(Action::Paused),
        "resume" | "resumed" => Some(Action::Resume),
        "cancel" => Some(Action::Cancel),
        _ => None,
    }
}

/// Lines that only a starting board writes. Several stand in one banner, so that one garbled line does
/// not hide a reset.
fn is_banner(told: &str) -> bool {
    const HEADS: [&str; 6] =
        ["PowerUp", "External Reset", "Brown out Reset", "Watchdog Reset", "Software Reset", "Free Memory:"];
    told == "start" || HEADS.iter().any(|head| told.starts_with(head))
}

fn is_report(text: &str) -> bool {
    let head = text.trim_start();
    ["T:", "T0:", "B:"].iter().any(|key| head.starts_with(key) || head.contains(&format!(" {key}")))
}

/// Reads `T:200.1 /200.0 B:60.0 /60.0 T0:... T1:... C:30 /0 @:127 B@:0`.
pub(super) fn temperatures(line: &str) -> Option<Temperatures> {
    let mut found = Temperatures::default();
    let mut active = None;
    let spaced = line.replace(" /", "/");
    for part in spaced.split_ascii_whitespace() {
        let Some((key, value)) = part.split_once(':') else { continue };
        let Some(reading) = reading(value) else { continue };
        match key {
            "T" => active = Some(reading),
            "B" => found.bed = Some(reading),
            "C" => found.chamber = Some(reading),
            _ => put_tool(&mut found.tools, key, reading),
        }
    }
    if let (Some(reading), true) = (active, found.tools.is_empty()) {
        found.tools.push(reading);
    }
    let empty = found.tools.is_empty() && found.bed.is_none() && found.chamber.is_none();
    (!empty).then_some(found)
}

fn put_tool(tools: &mut Vec<Reading>, key: &str, reading: Reading) {
    let Some(index) = key.strip_prefix('T').and_then(|n| n.parse::<usize>().ok()) else { return };
    // Tools come in order; a number far ahead is a garbled line.
    if index == tools.len() && index < 16 {
        tools.push(reading);
    }
}

fn reading(value: &str) -> Option<Reading> {
    let (now, target) = value.split_once('/').map_or((value, None), |(now, target)| (now, Some(target)));
    let finite = |text: &str| text.parse::<f64>().ok().filter(|t| t.is_finite());
    Some(Reading { now: finite(now)?, target: target.and_then(finite) })
}

/// The value behind `KEY:` in the one long line of `M115`, up to the next ` KEY:`.
pub(super) fn firmware_field(line: &str, key: &str) -> Option<String> {
    let at = line.find(&format!("{key}:"))?;
    // `find` gave the start of `key:`, which is ASCII.
    let rest = &line[at + key.len() + 1..];
    let mut value = String::new();
    for part in rest.split(' ') {
        let head = part.split(':').next().unwrap_or_default();
        let is_key =
            part.contains(':') && head.len() > 2 && head.bytes().all(|b| b.is_ascii_uppercase() || b == b'_');
        if is_key {
            break;
        }
        value.push_str(part);
        value.push(' ');
    }
    let value = value.trim().to_owned();
    (!value.is_empty()).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ok_in_all_its_forms() {
        let plain = OkReply::default();
        assert_eq!(parse("ok"), Reply::Ok(plain));
        assert_eq!(
            parse("ok N12 P15 B3"),
            Reply::Ok(OkReply { line: Some(12), planner: Some(15), block: Some(3), report: false })
        );
        assert_eq!(parse("ok 103256"), Reply::Ok(OkReply { line: Some(103_256), ..plain }));
        assert_eq!(parse("ok T:20.1 /0.0 B:19 /0"), Reply::Ok(OkReply { report: true, ..plain }));
        assert_eq!(parse("okay"), Reply::Other);
        assert_eq!(parse("okok"), Reply::Other);
    }

    #[test]
    fn a_garbled_resend_is_no_other_number() {
        assert_eq!(parse("Resend: 123"), Reply::Resend(123));
        assert_eq!(parse("rs N7"), Reply::Resend(7));
        assert_eq!(parse("Resend:1x3"), Reply::Other);
        assert_eq!(parse("Resend: 1 3"), Reply::Other);
        assert_eq!(parse("Resend:"), Reply::Other);
        assert_eq!(parse("Resend: 99999999999999"), Reply::Other);
    }

    #[test]
    fn errors_are_told_apart() {
        let last = |n| Reply::Transmission { last: n };
        assert_eq!(parse("Error:checksum mismatch, Last Line: 4"), last(Some(4)));
        assert_eq!(parse("Error:Line Number is not Last Line Number+1, Last Line: 4"), last(Some(4)));
        assert_eq!(parse("Error:No Checksum with line number, Last Line: 4"), last(Some(4)));
        assert_eq!(parse("Error:No Line Number with checksum, Last Line: 4"), last(Some(4)));
        assert_eq!(parse("Error:something new, Last Line: 4"), last(Some(4)));
        assert_eq!(parse("Error:check"), last(None), "cut off by a garbled line feed");
        assert_eq!(parse("echo:Unknown command: \"M9999\""), Reply::Other);
        assert_eq!(parse("Error:Unknown command: \"M9999\""), Reply::Other);
        assert_eq!(parse("Error:MINTEMP triggered, system stopped! Heater_ID: 0"), Reply::Fault);
        assert_eq!(parse("Error:Printer halted. kill() called!"), Reply::Killed);
        assert_eq!(parse("!! Shutdown"), Reply::Killed);
    }

    #[test]
    fn temperatures_of_one_and_of_two_nozzles() {
        let one = temperatures("ok T:201.3 /200.0 B:60.0 /60.0 @:64 B@:0").expect("a report");
        assert_eq!(one.tools, vec![Reading { now: 201.3, target: Some(200.0) }]);
        assert_eq!(one.bed, Some(Reading { now: 60.0, target: Some(60.0) }));
        let two = temperatures("T:20 /0 B:19.5 /0 T0:20 /0 T1:21 /0 @:0").expect("a report");
        assert_eq!(two.tools.len(), 2);
        assert_eq!(two.tools[1].now, 21.0);
        let wait = temperatures("T:150.2 E:0 W:?").expect("heating");
        assert_eq!(wait.tools, vec![Reading { now: 150.2, target: None }]);
        assert_eq!(temperatures("echo:busy: processing"), None);
    }

    #[test]
    fn the_name_of_the_firmware_may_hold_blanks() {
        let line = "FIRMWARE_NAME:Marlin 2.1.2 (Jan 1 2024 10:00:00) SOURCE_CODE_URL:x MACHINE_TYPE:Ender 3 EXTRUDER_COUNT:1";
        assert_eq!(firmware_field(line, "MACHINE_TYPE").as_deref(), Some("Ender 3"));
        assert_eq!(
            firmware_field(line, "FIRMWARE_NAME").as_deref(),
            Some("Marlin 2.1.2 (Jan 1 2024 10:00:00)")
        );
        assert_eq!(firmware_field(line, "UUID"), None);
    }
}
