//! Profiles of other slicers as settings, with an honest list of what became of each value.
//!
//! Sources: PrusaSlicer `--help-fff` and help.prusa3d.com; OrcaSlicer's wiki (github.com/SoftFever/
//! OrcaSlicer/wiki); Cura's settings as its "Settings Guide" names them. No source of theirs was read.

mod code;
mod cura;
mod orca;
mod own;
mod prusa;
mod schema;
mod table;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::archive::is_zip;
use crate::error::FileError;
use crate::limits::PROFILE_BYTES;
use schema::{Schema, Setting};

/// Settings taken over from a profile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Imported {
    /// "prusaslicer", "orcaslicer", "cura" or "foothold".
    pub slicer: &'static str,
    /// The settings, nested, as a settings file has them.
    pub settings: Value,
    /// Taken over as they are.
    pub mapped: Vec<Entry>,
    /// Taken over with another meaning or value, or left out for a reason; `why` says it.
    pub changed: Vec<Entry>,
    /// Not known here.
    pub unknown: Vec<Entry>,
}

/// What became of one value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// Its name in the profile.
    pub key: String,
    /// Its value there, at most 200 characters.
    pub value: String,
    /// Path of our setting, if it became one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Its value here, as JSON.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// What is different, or why it was left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// Reads a profile: PrusaSlicer's `.ini`, OrcaSlicer's JSON, a `.curaprofile`, or the settings in G-code of
/// any of them or our own, each by its content.
pub fn import(bytes: &[u8]) -> Result<Imported, FileError> {
    if bytes.is_empty() {
        return Err(FileError::Empty);
    }
    if is_zip(bytes) {
        return cura::import(bytes);
    }
    // G-code may be long; its settings stand at the end.
    let tail = &bytes[bytes.len().saturating_sub(PROFILE_BYTES)..];
    let text = match text_of(tail) {
        // A cut in the middle of a character is no fault of the file.
        Err(_) if tail.len() < bytes.len() => String::from_utf8_lossy(tail).into_owned(),
        other => other?,
    };
    if text.trim_start().starts_with('{') {
        return orca::import(&text);
    }
    // Bambu Studio's stand at the head.
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD_BYTES)]);
    if let Some(found) = orca::block(&text).or_else(|| orca::block(&head)) {
        return Ok(orca::collected(found));
    }
    if let Some(found) = cura::block(&text)? {
        return Ok(cura::collected(found));
    }
    if let Some(pairs) = own::pairs(&text) {
        return Ok(own::import(pairs));
    }
    if let Some(pairs) = prusa::pairs(&text) {
        return Ok(prusa::import(pairs));
    }
    Err(FileError::UnknownProfile)
}

/// Settings at the head of G-code end before this many bytes.
const HEAD_BYTES: usize = 1 << 20;

/// The lines `; name = value` of G-code.
fn comment_pairs<'t>(lines: impl Iterator<Item = &'t str>) -> table::Values {
    let pair = |line: &str| {
        let (key, value) = line.strip_prefix(';')?.split_once('=')?;
        let key = key.trim();
        let is_name = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b"_.".contains(&b));
        is_name.then(|| (key.to_owned(), value.trim().to_owned()))
    };
    lines.filter_map(pair).collect()
}

/// Bytes as text, without a byte order mark.
pub(crate) fn text_of(bytes: &[u8]) -> Result<String, FileError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(FileError::Encoding { seems: "UTF-16" });
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let seems = if bytes.contains(&0) { "binary" } else { "an older encoding such as Latin-1" };
    String::from_utf8(bytes.to_vec()).map_err(|_| FileError::Encoding { seems })
}

/// Collects settings, each checked against the schema.
pub(crate) struct Collector {
    schema: Schema,
    settings: Value,
    mapped: Vec<Entry>,
    changed: Vec<Entry>,
    unknown: Vec<Entry>,
}

impl Collector {
    pub(crate) fn new() -> Collector {
        Collector {
            schema: Schema::new(),
            settings: Value::Object(Map::new()),
            mapped: Vec::new(),
            changed: Vec::new(),
            unknown: Vec::new(),
        }
    }

    /// Takes a value over as it is, or says why not.
    pub(crate) fn map(&mut self, key: &str, theirs: &str, path: &str, value: Value) {
        self.set(key, theirs, path, value, None);
    }

    /// Takes a value over with another meaning.
    pub(crate) fn change(&mut self, key: &str, theirs: &str, path: &str, value: Value, why: &str) {
        self.set(key, theirs, path, value, Some(why));
    }

    /// Leaves a known value out for a reason.
    pub(crate) fn leave(&mut self, key: &str, theirs: &str, why: &str) {
        self.changed.push(Entry { why: Some(why.to_owned()), ..entry(key, theirs) });
    }

    pub(crate) fn unknown(&mut self, key: &str, theirs: &str) {
        self.unknown.push(entry(key, theirs));
    }

    fn set(&mut self, key: &str, theirs: &str, path: &str, value: Value, why: Option<&str>) {
        let value = match self.schema.setting(path) {
            None => return self.unknown(key, theirs),
            Some(setting) => match setting.fitting(value) {
                Ok(value) => value,
                Err(why) => return self.leave(key, theirs, &format!("{path}: {why}; left as it is")),
            },
        };
        let taken = Entry { path: Some(path.to_owned()), to: Some(value.to_string()), ..entry(key, theirs) };
        put(&mut self.settings, path, value);
        match why {
            None => self.mapped.push(taken),
            Some(why) => self.changed.push(Entry { why: Some(why.to_owned()), ..taken }),
        }
    }

    pub(crate) fn finish(self, slicer: &'static str) -> Imported {
        let Collector { settings, mut mapped, mut changed, mut unknown, .. } = self;
        for list in [&mut mapped, &mut changed, &mut unknown] {
            list.sort_by(|a, b| a.key.cmp(&b.key));
        }
        Imported { slicer, settings, mapped, changed, unknown }
    }
}

fn entry(key: &str, value: &str) -> Entry {
    let short = |text: &str| text.chars().take(200).collect::<String>();
    Entry { key: short(key), value: short(value), path: None, to: None, why: None }
}

fn put(tree: &mut Value, path: &str, value: Value) {
    let mut at = tree;
    for name in path.split('.') {
        if !at.is_object() {
            *at = Value::Object(Map::new());
        }
        let Value::Object(map) = at else { return };
        at = map.entry(name).or_insert(Value::Null);
    }
    *at = value;
}

impl Setting {
    /// The value if the setting can have it.
    fn fitting(&self, value: Value) -> Result<Value, String> {
        let in_range =
            |x: f64| x.is_finite() && self.low.is_none_or(|l| x >= l) && self.high.is_none_or(|h| x <= h);
        let range =
            || format!("outside {} to {}", self.low.unwrap_or(f64::MIN), self.high.unwrap_or(f64::MAX));
        match &value {
            Value::Number(n) if self.kind == "integer" => {
                let n = n.as_f64().unwrap_or(f64::NAN);
                if n.fract() != 0.0 {
                    return Err(format!("{n} is no whole number"));
                }
                if in_range(n) { Ok(Value::from(n as i64)) } else { Err(range()) }
            }
            Value::Number(n) => {
                if in_range(n.as_f64().unwrap_or(f64::NAN)) {
                    Ok(value)
                } else {
                    Err(range())
                }
            }
            Value::String(word) if !self.choices.is_empty() && !self.choices.contains(word) => {
                Err(format!("\"{word}\" is not among {}", self.choices.join(", ")))
            }
            _ => Ok(value),
        }
    }
}
