//! Settings sent from engine to engine as [`Setting::save`](super::Setting::save) writes them.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Item;

/// For `#[serde(with = "saved")]`.
pub fn serialize<T: Item, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    let mut bytes = Vec::new();
    value.save(&mut bytes);
    bytes.serialize(serializer)
}

/// For `#[serde(with = "saved")]`.
pub fn deserialize<'de, T: Item, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let bytes = Vec::<u8>::deserialize(deserializer)?;
    let (mut value, mut rest) = (T::blank(), bytes.as_slice());
    let whole = value.load(&mut rest).filter(|()| rest.is_empty());
    whole.map(|()| value).ok_or_else(|| D::Error::custom("settings are cut off"))
}
