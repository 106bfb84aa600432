//! Objects of a print by name, so that a printer can give up one and finish the rest.

use super::flavor::ObjectLabels;
use super::{GcodeOptions, PrinterOptions};
use crate::polygon::DVec2;
use crate::polygon::measure::Bounds;
use crate::region::Role;

/// An object as the printer is told of it.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LabelledObject {
    /// Letters, digits, `_`, `-` and `.`; no two objects have the same.
    pub name: String,
    /// Smallest x and y, mm.
    pub min: DVec2,
    /// Largest x and y, mm.
    pub max: DVec2,
}

/// The objects to be labelled, in order, from their names and boxes; empty where labels are not
/// wanted or the firmware has none.
pub fn labelled_objects<'a>(
    objects: impl IntoIterator<Item = (&'a str, Bounds)>,
    printer: &PrinterOptions,
) -> Vec<LabelledObject> {
    if !printer.label_objects || printer.flavor.labels() == ObjectLabels::None {
        return Vec::new();
    }
    let label = |(k, (name, bounds)): (usize, (&str, Bounds))| LabelledObject {
        name: format!(
            "{}_{k}",
            name.replace(|c: char| !c.is_ascii_alphanumeric() && !"_-.".contains(c), "_")
        ),
        min: bounds.min,
        max: bounds.max,
    };
    objects.into_iter().enumerate().map(label).collect()
}

/// The object that a bead belongs to: the one whose box is nearest to its start. Brims, rafts and
/// supports lie beside the box of their part, and parts stand apart.
pub(super) fn object_at(objects: &[LabelledObject], role: Role, start: DVec2) -> Option<usize> {
    if matches!(role, Role::Skirt | Role::Prime | Role::WipeTower) {
        return None;
    }
    let distance = |o: &LabelledObject| start.distance_squared(start.clamp(o.min, o.max));
    (0..objects.len()).min_by(|&a, &b| distance(&objects[a]).total_cmp(&distance(&objects[b])))
}

/// What the start of the file says about the objects.
pub(super) fn definitions(options: &GcodeOptions) -> String {
    let objects = &options.objects;
    if objects.is_empty() {
        return String::new();
    }
    match options.printer.flavor.labels() {
        ObjectLabels::None => String::new(),
        ObjectLabels::M486 => format!("M486 T{}\n", objects.len()),
        ObjectLabels::NamedM486 => {
            let lines = objects.iter().enumerate();
            let named: String = lines.map(|(k, o)| format!("M486 S{k}\nM486 A{}\n", o.name)).collect();
            named + "M486 S-1\n"
        }
        ObjectLabels::ExcludeObject => objects.iter().map(define).collect(),
    }
}

/// One object for Klipper: its box as a polygon without spaces, as its parser wants it.
fn define(LabelledObject { name, min, max }: &LabelledObject) -> String {
    let centre = (*min + *max) / 2.0;
    let corner = |x: f64, y: f64| format!("[{x:.3},{y:.3}]");
    let corners = [corner(min.x, min.y), corner(max.x, min.y), corner(max.x, max.y), corner(min.x, max.y)];
    format!(
        "EXCLUDE_OBJECT_DEFINE NAME={name} CENTER={:.3},{:.3} POLYGON=[{}]\n",
        centre.x,
        centre.y,
        corners.join(",")
    )
}

/// The line where an object's moves begin or end.
pub(super) fn mark(labels: ObjectLabels, objects: &[LabelledObject], place: usize, begins: bool) -> String {
    let name = objects.get(place).map_or("", |o| &o.name);
    match (labels, begins) {
        (ObjectLabels::None, _) => String::new(),
        (ObjectLabels::M486 | ObjectLabels::NamedM486, true) => format!("M486 S{place}\n"),
        (ObjectLabels::M486 | ObjectLabels::NamedM486, false) => "M486 S-1\n".to_owned(),
        (ObjectLabels::ExcludeObject, true) => format!("EXCLUDE_OBJECT_START NAME={name}\n"),
        (ObjectLabels::ExcludeObject, false) => format!("EXCLUDE_OBJECT_END NAME={name}\n"),
    }
}
