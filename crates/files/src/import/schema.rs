//! What settings there are, from the JSON Schema that the engine's build writes.

use std::collections::BTreeMap;

use serde_json::Value;

/// Written by the engine; a change of settings is a change of this file.
const SCHEMA: &str = include_str!("../../../../schema/settings.schema.json");

/// What one setting takes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Setting {
    /// "number", "integer", "string", "boolean" or "array".
    pub(crate) kind: String,
    pub(crate) low: Option<f64>,
    pub(crate) high: Option<f64>,
    /// Words it may be; empty if it is no choice.
    pub(crate) choices: Vec<String>,
}

pub(crate) struct Schema {
    settings: BTreeMap<String, Setting>,
}

impl Schema {
    pub(crate) fn new() -> Schema {
        // The file is written by our own build; a broken one knows no settings, and tests notice.
        let root: Value = serde_json::from_str(SCHEMA).unwrap_or_default();
        let mut settings = BTreeMap::new();
        walk(&root, &root, "", &mut settings);
        Schema { settings }
    }

    pub(crate) fn setting(&self, path: &str) -> Option<&Setting> {
        self.settings.get(path)
    }
}

fn walk(root: &Value, group: &Value, path: &str, settings: &mut BTreeMap<String, Setting>) {
    let Some(properties) = group["properties"].as_object() else { return };
    for (name, own) in properties {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let reference = own["$ref"].as_str().or_else(|| own["allOf"][0]["$ref"].as_str());
        let target = reference.and_then(|r| r.rsplit('/').next()).map_or(own, |name| &root["$defs"][name]);
        if target["properties"].is_object() {
            walk(root, target, &path, settings);
        } else {
            settings.insert(path, setting(own, target));
        }
    }
}

fn setting(own: &Value, target: &Value) -> Setting {
    let word = |v: &Value| v.as_str().map(str::to_owned);
    let listed = target["enum"].as_array().into_iter().flatten().filter_map(word);
    let cases = target["oneOf"].as_array().into_iter().flatten();
    let cased = cases.flat_map(|c| {
        let several = c["enum"].as_array().into_iter().flatten().filter_map(word);
        word(&c["const"]).into_iter().chain(several).collect::<Vec<_>>()
    });
    Setting {
        kind: target["type"].as_str().unwrap_or_default().to_owned(),
        low: own["minimum"].as_f64(),
        high: own["maximum"].as_f64(),
        choices: listed.chain(cased).collect(),
    }
}
