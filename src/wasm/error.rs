//! Rust errors as JavaScript's: `Error` objects with a stable name.

use std::fmt::Display;

use js_sys::Error;
use wasm_bindgen::JsValue;

/// A JavaScript error on its way out.
#[derive(Debug)]
pub struct Thrown(Error);

impl From<Thrown> for JsValue {
    fn from(thrown: Thrown) -> JsValue {
        thrown.0.into()
    }
}

impl Thrown {
    /// The error with one more property.
    #[cfg(feature = "slicer")]
    pub(super) fn with(self, name: &str, value: &str) -> Thrown {
        // Fails on objects that are frozen; this one is new.
        let _ = js_sys::Reflect::set(&self.0, &name.into(), &value.into());
        self
    }
}

pub(super) fn thrown(name: &str, cause: impl Display) -> Thrown {
    let error = Error::new(&cause.to_string());
    error.set_name(name);
    Thrown(error)
}

/// A wrong argument from the page or the command line.
pub(super) fn usage_error(cause: impl Display) -> Thrown {
    thrown("UsageError", cause)
}

/// A fault of this program.
pub(super) fn internal_error(cause: impl Display) -> Thrown {
    thrown("InternalError", cause)
}
