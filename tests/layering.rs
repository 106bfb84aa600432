//! Who may import whom: the `use crate::` lines of each module against the table below.
//!
//! The table is the one of `docs/architecture.md`; every import points up it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// What every module but `printer` may name with `crate::`: the macros that declare options, sets, sorting.
const EVERYWHERE: &[&str] = &["options", "words", "sets", "sort"];

/// The stages in the order in which data flows.
const STAGES: &[&str] =
    &["polygon", "mesh", "slice", "region", "adhesion", "support", "orientation", "toolpath", "gcode"];

/// Module -> further modules it may name.
const MAY_USE: &[(&str, &[&[&str]])] = &[
    ("options", &[]),
    ("sets", &[]),
    ("sort", &[]),
    ("polygon", &[]),
    ("mesh", &[]),
    ("slice", &[&["mesh", "polygon"]]),
    ("region", &[&["polygon", "slice"]]),
    ("adhesion", &[&["polygon", "slice", "region"]]),
    ("support", &[&["mesh", "polygon", "slice", "region"]]),
    ("orientation", &[&["mesh", "slice", "polygon", "region", "support"]]),
    ("toolpath", &[&["polygon", "region"]]),
    ("gcode", &[&["polygon", "toolpath", "region"]]),
    ("picture", &[&["mesh", "polygon"]]),
    ("printer", &[]),
    ("settings", &[STAGES]),
    ("pipeline", &[STAGES, &["settings", "picture"]]),
    ("view", &[STAGES, &["settings", "pipeline", "picture"]]),
    ("wasm", &[STAGES, &["settings", "pipeline", "view", "picture", "printer"]]),
];

#[test]
fn every_import_is_in_the_table() {
    let table: BTreeMap<&str, &[&[&str]]> = MAY_USE.iter().copied().collect();
    let mut wrong = Vec::new();
    for (module, file, text) in sources() {
        let allowed = table.get(module.as_str()).unwrap_or_else(|| panic!("{module} is not in the table"));
        let everywhere: &[&str] = if module == "printer" { &[] } else { EVERYWHERE };
        let is_allowed = |used: &str| everywhere.contains(&used) || allowed.concat().contains(&used);
        for used in modules_named(&text) {
            if used != module && !is_allowed(&used) {
                wrong.push(format!("{file}: {module} must not know {used}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// (module, file, text) of every source file but `lib.rs`, unit tests cut off.
fn sources() -> Vec<(String, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(dir) = open.pop() {
        for entry in fs::read_dir(dir).expect("src is readable").flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("lib.rs") {
                let relative = path.strip_prefix(&root).expect("under src").to_string_lossy().into_owned();
                let module = relative.split(['/', '.']).next().unwrap_or_default().to_owned();
                let text = fs::read_to_string(&path).expect("source is readable");
                let text = text.split("#[cfg(test)]").next().unwrap_or_default().to_owned();
                found.push((module, relative, text));
            }
        }
    }
    found
}

/// Top-level modules named behind `crate::` outside comments.
fn modules_named(text: &str) -> Vec<String> {
    let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1).map(str::to_owned).collect::<Vec<_>>())
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>())
        .filter(|name| !name.is_empty())
        .collect()
}
