//! What a setting can hold: numbers, switches, texts, lists.

use serde_json::Value;

use super::{Item, NotASetting, Setting, wrong};

/// Takes `N` bytes off the front.
fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (taken, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*taken)
}

/// Takes a length off the front.
fn take_length(bytes: &mut &[u8]) -> Option<usize> {
    Some(u32::from_le_bytes(take(bytes)?) as usize)
}

fn save_length(length: usize, bytes: &mut Vec<u8>) {
    bytes.extend((length as u32).to_le_bytes());
}

impl Setting for f64 {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        *self = json.as_f64().map_or_else(|| wrong(path, "a number", json), Ok)?;
        Ok(())
    }

    fn json(&self) -> Value {
        Value::from(*self)
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        *self = f64::from_le_bytes(take(bytes)?);
        Some(())
    }

    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl Item for f64 {
    fn blank() -> f64 {
        0.0
    }
}

impl Setting for u32 {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        let found = json.as_u64().and_then(|n| u32::try_from(n).ok());
        *self = found.map_or_else(|| wrong(path, "a whole number from 0 up", json), Ok)?;
        Ok(())
    }

    fn json(&self) -> Value {
        Value::from(*self)
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        *self = u32::from_le_bytes(take(bytes)?);
        Some(())
    }

    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }
}

impl Item for u32 {
    fn blank() -> u32 {
        0
    }
}

impl Setting for bool {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        *self = json.as_bool().map_or_else(|| wrong(path, "true or false", json), Ok)?;
        Ok(())
    }

    fn json(&self) -> Value {
        Value::from(*self)
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(*self));
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        *self = take(bytes)? == [1];
        Some(())
    }
}

impl Setting for String {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        *self = json.as_str().map_or_else(|| wrong(path, "a text", json), Ok)?.to_owned();
        Ok(())
    }

    fn json(&self) -> Value {
        Value::from(self.as_str())
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        save_length(self.len(), bytes);
        bytes.extend(self.bytes());
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        let length = take_length(bytes)?;
        let (text, rest) = bytes.split_at_checked(length)?;
        *self = str::from_utf8(text).ok()?.to_owned();
        *bytes = rest;
        Some(())
    }
}

/// `null` for nothing.
impl<T: Item> Setting for Option<T> {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        *self = None;
        if json.is_null() { Ok(()) } else { self.insert(T::blank()).read(json, path) }
    }

    fn json(&self) -> Value {
        self.as_ref().map_or(Value::Null, Setting::json)
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        self.is_some().save(bytes);
        self.iter().for_each(|value| value.save(bytes));
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        *self = None;
        if take(bytes)? == [1] { self.insert(T::blank()).load(bytes) } else { Some(()) }
    }
}

impl<const N: usize> Setting for [f64; N] {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        match json.as_array() {
            Some(items) if items.len() == N => read_items(self, items, path),
            _ => wrong(path, &format!("{N} numbers"), json),
        }
    }

    fn json(&self) -> Value {
        self.iter().map(Setting::json).collect()
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|number| number.save(bytes));
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        self.iter_mut().try_for_each(|number| number.load(bytes))
    }

    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

impl<const N: usize> Item for [f64; N] {
    fn blank() -> [f64; N] {
        [0.0; N]
    }
}

impl<T: Item> Setting for Vec<T> {
    fn read(&mut self, json: &Value, path: &str) -> Result<(), NotASetting> {
        let Some(items) = json.as_array() else { return wrong(path, "a list", json) };
        self.clear();
        self.resize_with(items.len(), T::blank);
        read_items(self, items, path)
    }

    fn json(&self) -> Value {
        self.iter().map(Setting::json).collect()
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        save_length(self.len(), bytes);
        self.iter().for_each(|item| item.save(bytes));
    }

    fn load(&mut self, bytes: &mut &[u8]) -> Option<()> {
        self.clear();
        for _ in 0..take_length(bytes)? {
            let mut item = T::blank();
            item.load(bytes)?;
            self.push(item);
        }
        Some(())
    }
}

fn read_items<T: Setting>(items: &mut [T], found: &[Value], path: &str) -> Result<(), NotASetting> {
    let mut places = (0..).map(|i| format!("{path}[{i}]"));
    let read = |(item, json): (&mut T, &Value)| item.read(json, &places.next().unwrap_or_default());
    items.iter_mut().zip(found).try_for_each(read)
}
