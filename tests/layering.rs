//! Who may import whom: the `use crate::` lines of each module against the table below.
//!
//! The table is the one of `docs/architecture.md`; every import points up it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Module -> modules it may name with `crate::`. `options` holds the macro that declares options.
const MAY_USE: &[(&str, &[&str])] = &[
    ("options", &[]),
    ("polygon", &[]),
    ("mesh", &["options"]),
    ("slice", &["options", "mesh", "polygon"]),
    ("region", &["options", "polygon", "slice"]),
    ("adhesion", &["options", "polygon", "slice", "region"]),
    ("support", &["options", "mesh", "polygon", "slice", "region"]),
    ("orientation", &["options", "mesh", "slice", "polygon", "region", "support"]),
    ("toolpath", &["options", "polygon", "region"]),
    ("gcode", &["options", "polygon", "toolpath", "region"]),
    ("printer", &[]),
    (
        "settings",
        &[
            "options",
            "mesh",
            "slice",
            "region",
            "adhesion",
            "support",
            "orientation",
            "toolpath",
            "gcode",
            "polygon",
        ],
    ),
    (
        "pipeline",
        &[
            "options",
            "polygon",
            "mesh",
            "slice",
            "region",
            "adhesion",
            "support",
            "orientation",
            "toolpath",
            "gcode",
            "settings",
        ],
    ),
    (
        "view",
        &[
            "options",
            "polygon",
            "mesh",
            "slice",
            "region",
            "adhesion",
            "support",
            "orientation",
            "toolpath",
            "gcode",
            "settings",
            "pipeline",
        ],
    ),
    (
        "wasm",
        &[
            "options",
            "polygon",
            "mesh",
            "slice",
            "region",
            "adhesion",
            "support",
            "orientation",
            "toolpath",
            "gcode",
            "settings",
            "pipeline",
            "view",
            "printer",
        ],
    ),
];

#[test]
fn every_import_is_in_the_table() {
    let table: BTreeMap<&str, &[&str]> = MAY_USE.iter().copied().collect();
    let mut wrong = Vec::new();
    for (module, file, text) in sources() {
        let allowed = table.get(module.as_str()).unwrap_or_else(|| panic!("{module} is not in the table"));
        for used in modules_named(&text) {
            if used != module && !allowed.contains(&used.as_str()) {
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
        .filter(|name| !name.is_empty() && name != "options")
        .collect()
}
