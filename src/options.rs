//! How a stage declares its options: once, with unit, range and help.
//!
//! [`options!`](crate::options!) writes the struct, its `Default`, its serde form (unknown keys are errors), its
//! range check and, with the feature `schema`, its JSON Schema, from one list of rows:
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
//! let found = foothold::options::Checked::check(&bad, "walls").unwrap_err();
//! assert_eq!(found.to_string(), "walls.width: 9 is outside 0.1 to 2 mm");
//! ```
//!
//! A row is `name: Type = default, "label", "unit", low..=high;` for numbers and arrays of numbers,
//! `name: Type = default, "label";` for words, switches and text, and `name: group Type;` for a
//! nested options struct.

use std::fmt;

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

/// An options struct whose values can be checked against their declared ranges.
pub trait Checked {
    /// The first value outside its range, if any. `path` is the dotted path of this struct.
    fn check(&self, path: &str) -> Result<(), OutOfRange>;
}

/// The numbers inside a value, so that one rule checks scalars and arrays.
pub trait Numbers {
    /// Every number of the value, as f64.
    fn numbers(&self) -> Vec<f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl Numbers for u32 {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

/// Checks one value against its range; NaN is outside every range.
pub fn check_range(
    value: &impl Numbers,
    path: &str,
    name: &str,
    unit: &'static str,
    range: std::ops::RangeInclusive<f64>,
) -> Result<(), OutOfRange> {
    match value.numbers().into_iter().find(|v| !range.contains(v)) {
        None => Ok(()),
        Some(v) => Err(OutOfRange {
            path: join_path(path, name),
            found: v.to_string(),
            low: *range.start(),
            high: *range.end(),
            unit,
        }),
    }
}

/// `path.name`, or `name` at the root.
pub fn join_path(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

/// Declares an options struct; see the [module](crate::options) for the form of a row.
#[macro_export]
macro_rules! options {
    ($(#[$meta:meta])* pub struct $Name:ident { $($rows:tt)* }) => {
        $crate::options! { @rows [$(#[$meta])*] $Name [] [] [] $($rows)* }
    };
    // A number or an array of numbers, with unit and range.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($checks:tt)*]
        $(#[$doc:meta])* $field:ident : $Type:ty = $default:expr, $label:literal, $unit:literal, $low:literal ..= $high:literal ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])*
                #[cfg_attr(feature = "schema", schemars(title = $label, range(min = $low, max = $high), extend("x-unit" = $unit)))]
                pub $field: $Type,]
            [$($defaults)* $field: $default,]
            [$($checks)* ($field, $unit, $low ..= $high)]
            $($rest)* }
    };
    // A word, a switch or a text.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] $checks:tt
        $(#[$doc:meta])* $field:ident : $Type:ty = $default:expr, $label:literal ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])* #[cfg_attr(feature = "schema", schemars(title = $label))] pub $field: $Type,]
            [$($defaults)* $field: $default,]
            $checks
            $($rest)* }
    };
    // A nested options struct.
    (@rows $m:tt $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($checks:tt)*]
        $(#[$doc:meta])* $field:ident : group $Type:ty ; $($rest:tt)*) => {
        $crate::options! { @rows $m $Name
            [$($fields)* $(#[$doc])* pub $field: $Type,]
            [$($defaults)* $field: <$Type>::default(),]
            [$($checks)* ($field)]
            $($rest)* }
    };
    (@rows [$($meta:tt)*] $Name:ident [$($fields:tt)*] [$($defaults:tt)*] [$($check:tt)*]) => {
        $($meta)*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(default, deny_unknown_fields)]
        pub struct $Name { $($fields)* }

        impl Default for $Name {
            fn default() -> Self {
                $Name { $($defaults)* }
            }
        }

        impl $crate::options::Checked for $Name {
            fn check(&self, path: &str) -> Result<(), $crate::options::OutOfRange> {
                $( $crate::options!(@check self path $check); )*
                let _ = path;
                Ok(())
            }
        }
    };
    (@check $self:ident $path:ident ($field:ident, $unit:literal, $low:literal ..= $high:literal)) => {
        $crate::options::check_range(&$self.$field, $path, stringify!($field), $unit, f64::from($low) ..= f64::from($high))?
    };
    (@check $self:ident $path:ident ($field:ident)) => {
        $crate::options::Checked::check(&$self.$field, &$crate::options::join_path($path, stringify!($field)))?
    };
}
