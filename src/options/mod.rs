//! How a stage declares its options: once, with unit, range and help.
//!
//! [`options!`](crate::options!) writes the struct, its `Default`, how its values are read from JSON (unknown keys
//! are errors), written and checked and, with the feature `schema`, its JSON Schema, from one list of rows:
//!
//! ```
//! foothold::options! {
//!     /// Wall loops along every outline.
//!     pub struct WallOptions {
//!         /// Number of loops; 0 prints no walls.
//!         count: u32 = 3, "Walls", "", 0.0..=50.0;
//!         /// Width of a bead.
//!         width: f64 = 0.45, "Line width", "mm", 0.1..=2.0;
//!     }
//! }
//! let bad = WallOptions { width: 9.0, ..WallOptions::default() };
//! let found = foothold::options::Setting::check(&bad, "walls").unwrap_err();
//! assert_eq!(found.to_string(), "walls.width: 9 is outside 0.1 to 2 mm");
//! ```
//!
//! A row is `name: Type = default, "label", "unit", low..=high;` for numbers and arrays of numbers,
//! `name: Type = default, "label";` for words, switches and text, and `name: group Type;` for a
//! nested options struct. [`words!`](crate::words!) declares the words that a setting chooses from.
//!
//! The rows become a table that a few loops walk ([`Group`]): a deserializer is compiled anew for every struct,
//! which made up a tenth of the engine.

pub mod saved;
mod value;

use std::fmt;

use serde_json::{Map, Value};

/// Why a value cannot be a setting's.
#[derive(Debug, Clone, PartialEq)]
pub enum NotASetting {
    /// No setting has this path.
    Unknown {
        /// The path as given.
        path: String,
    },
    /// The value has the wrong type or is not among the choices.
    Wrong {
        /// The setting's path, with the place in a list.
        path: String,
        /// What is wrong with it.
        cause: String,
    },
}

impl fmt::Display for NotASetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotASetting::Unknown { path } => write!(f, "{path}: there is no such setting"),
            NotASetting::Wrong { path, cause } => write!(f, "{path}: {cause}"),
        }
    }
}

impl std::error::Error for NotASetting {}

/// A value outside its range; the message names the setting's path.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Dotted path of the setting, such as `walls.width`.
    pub path: String,
    /// The value found, as text.
    pub found: String,
    /// Smallest allowed value.
    pub low: f64,
    /// Largest allowed value.
    pub high: f64,
    /// Unit of value and range; empty for counts and shares.
    pub unit: &'static str,
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OutOfRange { path, found, low, high, unit } = self;
        write!(f, "{path}: {found} is outside {low} to {high}")?;
        if unit.is_empty() { Ok(()) } else { write!(f, " {unit}") }
    }
}

impl std::error::Error for OutOfRange {}

/// What a setting can hold: a number, a word, a list, or a group of settings.
pub trait Setting {
    /// Takes the value of `json`; a group takes those that are there. `path` is the setting's dotted path.
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting>;

    /// The value as JSON; [`Setting::read`] takes it.
    fn json(&self) -> Value;

    /// Appends the value, bit by bit, to `bytes`; JSON's numbers are not read exactly.
    fn save(&self, bytes: &mut Vec<u8>);

    /// Takes what [`Setting::save`] appended off the front of `bytes`; `None` if it is not there.
    fn load(&mut self, bytes: &mut &[u8]) -> Option<()>;

    /// The numbers that have to keep to the setting's range.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The first value of a group that is outside its range. `path` is the group's dotted path.
    fn check(&self, path: &str) -> Result<(), OutOfRange> {
        let _ = path;
        Ok(())
    }
}

/// A setting that can be an item of a list, which begins as `blank`.
pub trait Item: Setting {
    /// A value to read into.
    fn blank() -> Self;
}

/// A row of an options struct.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Name of the field.
    pub name: &'static str,
    /// Unit of its numbers.
    pub unit: &'static str,
    /// Smallest and largest number allowed.
    pub range: Option<[f64; 2]>,
}

/// An options struct as a table: as many values as [`Group::ROWS`].
pub trait Group {
    /// Its rows, in the order in which they were declared.
    const ROWS: &'static [Row];

    /// The value of each row.
    fn values(&self) -> Vec<&dyn Setting>;

    /// The value of each row.
    fn values_mut(&mut self) -> Vec<&mut dyn Setting>;
}

impl<G: Group + Default> Item for G {
    fn blank() -> G {
        G::default()
    }
}

impl<G: Group> Setting for G {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        read_group(G::ROWS, self.values_mut(), json, path)
    }

    fn json(&self) -> Value {
        group_json(G::ROWS, self.values())
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        save_group(self.values(), bytes);
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        load_group(self.values_mut(), bytes)
    }

    fn check(&self, path: &str) -> Result<(), OutOfRange> {
        check_group(G::ROWS, self.values(), path)
    }
}

fn read_group(
    rows: &[Row],
    values: Vec<&mut dyn Setting>,
    json: &Value,
    path: &str,
) -> Result<(), NotASetting> {
    let Value::Object(found) = json else { return wrong(path, "a group of settings", json) };
    let is_row = |key: &&String| rows.iter().any(|row| row.name == key.as_str());
    if let Some(key) = found.keys().find(|key| !is_row(key)) {
        return Err(NotASetting::Unknown { path: join_path(path, key) });
    }
    rows.iter().zip(values).try_for_each(|(row, value)| match found.get(row.name) {
        Some(json) => value.read(json, &join_path(path, row.name)),
        None => Ok(()),
    })
}

fn group_json(rows: &[Row], values: Vec<&dyn Setting>) -> Value {
    let mut group = Map::new();
    for (row, value) in rows.iter().zip(values) {
        group.insert(row.name.to_owned(), value.json());
    }
    Value::Object(group)
}

fn save_group(values: Vec<&dyn Setting>, bytes: &mut Vec<u8>) {
    values.into_iter().for_each(|value| value.save(bytes));
}

fn load_group(values: Vec<&mut dyn Setting>, bytes: &mut &[u8]) -> Option<()> {
    values.into_iter().try_for_each(|value| value.load(bytes))
}

fn check_group(rows: &[Row], values: Vec<&dyn Setting>, path: &str) -> Result<(), OutOfRange> {
    rows.iter().zip(values).try_for_each(|(row, value)| {
        let path = join_path(path, row.name);
        match row.range {
            Some(range) => check_range(&value.numbers(), &path, row.unit, range),
            None => value.check(&path),
        }
    })
}

/// Checks numbers against a range; NaN is outside every range. `path` is the setting's.
pub fn check_range(
    numbers: &[f64],
    path: &str,
    unit: &'static str,
    [low, high]: [f64; 2],
) -> Result<(), OutOfRange> {
    match numbers.iter().find(|v| !(low..=high).contains(*v)) {
        None => Ok(()),
        Some(v) => Err(OutOfRange { path: path.to_owned(), found: v.to_string(), low, high, unit }),
    }
}

/// `path.name`, or `name` at the root.
pub fn join_path(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

fn wrong<T>(path: &str, expected: &str, found: &Value) -> Result<T, NotASetting> {
    let cause = format!("expected {expected}, found {found}");
    Err(NotASetting::Wrong { path: path.to_owned(), cause })
}

/// The place in `words` of the word in `json`.
pub fn read_word(words: &[&str], json: &Value, path: &str) -> Result<usize, NotASetting> {
    let found = words.iter().position(|word| Some(*word) == json.as_str());
    found.map_or_else(|| wrong(path, &format!("one of {}", words.join(", ")), json), Ok)
}

/// Declares the words that a setting chooses from, an enum with a word for each variant:
///
/// ```
/// foothold::words! {
///     /// Which side up.
///     pub enum Side {
///         /// As drawn.
///         #[default]
///         Top = "top",
///         /// Upside down.
///         Bottom = "bottom",
///     }
/// }
/// assert_eq!(Side::Bottom.name(), "bottom");
/// ```
#[macro_export]
macro_rules! words {
    ($(#[$meta:meta])* pub enum $Name:ident { $( $(#[$doc:meta])* $Variant:ident = $word:literal, )* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum $Name { $( $(#[$doc])* #[serde(rename = $word)] $Variant, )* }

        impl $Name {
            /// All of them, in the order in which they were declared.
            pub const ALL: [$Name; $Name::WORDS.len()] = [$( $Name::$Variant ),*];
            /// The word of each.
            const WORDS: &'static [&'static str] = &[$( $word ),*];

            /// The word of settings and reports.
            pub const fn name(self) -> &'static str {
                $Name::WORDS[self as usize]
            }
        }

        impl $crate::options::Setting for $Name {
            fn read(
                &mut self,
                json: &serde_json::Value,
                path: &str,
            ) -> Result<(), $crate::options::NotASetting> {
                *self = $Name::ALL[$crate::options::read_word($Name::WORDS, json, path)?];
                Ok(())
            }

            fn json(&self) -> serde_json::Value {
                serde_json::Value::from(self.name())
            }

            fn save(&self, bytes: &mut Vec<u8>) {
                bytes.push(*self as u8);
            }

            fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
                let (place, rest) = bytes.split_first()?;
                *self = *$Name::ALL.get(usize::from(*place))?;
                *bytes = rest;
                Some(())
            }
        }
    };
}

/// Declares an options struct; see the [module](crate::options) for the form of a row.
#[macro_export]
macro_rules! options {
    ($(#[$meta:meta])* pub struct $Name:ident { $($rows:tt)* }) => {
        $crate::options! { @rows [$(#[$meta])*] $Name [] [] [] $($rows)* }
    };
    // A number or an array of numbers, with unit and range.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($table:tt)*]
        $(#[$doc:meta])* $field:ident : $Type:ty = $default:expr, $label:literal, $unit:literal, $low:literal ..= $high:literal ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])*
                #[cfg_attr(feature = "schema", schemars(title = $label, range(min = $low, max = $high), extend("x-unit" = $unit)))]
                pub $field: $Type,]
            [$($defaults)* $field: $default,]
            [$($table)* ($field, $unit, Some([$low as f64, $high as f64]))]
            $($rest)* }
    };
    // A word, a switch or a text.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($table:tt)*]
        $(#[$doc:meta])* $field:ident : $Type:ty = $default:expr, $label:literal ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])* #[cfg_attr(feature = "schema", schemars(title = $label))] pub $field: $Type,]
            [$($defaults)* $field: $default,]
            [$($table)* ($field, "", None)]
            $($rest)* }
    };
    // A nested options struct.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($table:tt)*]
        $(#[$doc:meta])* $field:ident : group $Type:ty ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])* pub $field: $Type,]
            [$($defaults)* $field: <$Type>::default(),]
            [$($table)* ($field, "", None)]
            $($rest)* }
    };
    (@rows [$($meta:tt)*] $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$(($field:ident, $unit:literal, $range:expr))*]) => {
        $($meta)*
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "schema", derive(serde::Serialize, schemars::JsonSchema))]
        #[cfg_attr(feature = "schema", schemars(default, deny_unknown_fields))]
        pub struct $Name { $($fields)* }

        impl Default for $Name {
            fn default() -> Self {
                $Name { $($defaults)* }
            }
        }

        impl $crate::options::Group for $Name {
            const ROWS: &'static [$crate::options::Row] = &[
                $( $crate::options::Row { name: stringify!($field), unit: $unit, range: $range } ),*
            ];

            fn values(&self) -> Vec<&dyn $crate::options::Setting> {
                vec![$( &self.$field ),*]
            }

            fn values_mut(&mut self) -> Vec<&mut dyn $crate::options::Setting> {
                vec![$( &mut self.$field ),*]
            }
        }
    };
}
