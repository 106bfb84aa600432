//! All settings: one options struct per stage, nested as users write them.

use std::fmt;

use serde_json::{Map, Value};

use crate::adhesion::AdhesionOptions;
use crate::gcode::{
    AccelerationOptions, CoolingOptions, FilamentOptions, GcodeOptions, OutputOptions, PrintOptions,
    PrinterOptions, RetractionOptions, Sequence, SpeedOptions,
};
use crate::options::{NotASetting, OutOfRange, Setting, join_path};
use crate::orientation::OrientationOptions;
use crate::region::first_layer::FirstLayerOptions;
use crate::region::shell::SkinOptions;
use crate::slice::LayerOptions;
use crate::support::SupportOptions;
use crate::toolpath::infill::InfillOptions;
use crate::toolpath::ironing::IroningOptions;
use crate::toolpath::prime_tower::PrimeTowerOptions;
use crate::toolpath::seam::SeamOptions;
use crate::toolpath::walls::WallOptions;

crate::options! {
    /// Everything a person can choose.
    pub struct Settings {
        /// The machine.
        printer: group PrinterOptions;
        /// The material.
        filament: group FilamentOptions;
        /// The material of the second extruder.
        second_filament: group FilamentOptions;
        /// How the models on a plate are printed.
        print: group PrintOptions;
        /// Heights of the layers.
        layers: group LayerOptions;
        /// What is different on the first layer.
        first_layer: group FirstLayerOptions;
        /// Loops along every outline.
        walls: group WallOptions;
        /// Solid tops and bottoms.
        skin: group SkinOptions;
        /// What fills the inside.
        infill: group InfillOptions;
        /// Smoothing of top skins.
        ironing: group IroningOptions;
        /// Where loops start.
        seam: group SeamOptions;
        /// Which way up the part is printed.
        orientation: group OrientationOptions;
        /// What holds the part on the bed.
        adhesion: group AdhesionOptions;
        /// What holds overhangs.
        support: group SupportOptions;
        /// Where a tool that takes over is purged.
        prime_tower: group PrimeTowerOptions;
        /// Speeds by role.
        speed: group SpeedOptions;
        /// Accelerations by role.
        acceleration: group AccelerationOptions;
        /// Slowing down and blowing so that layers set.
        cooling: group CoolingOptions;
        /// Pulling the filament back for travels.
        retraction: group RetractionOptions;
        /// What the file holds besides the moves of the print.
        gcode: group OutputOptions;
    }
}

/// Why settings could not be used. Each message names the setting's path.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingsError {
    /// A settings file is not JSON.
    NotJson {
        /// What the JSON parser said, with line and column.
        cause: String,
    },
    /// A `path=value` without `=`.
    NotAnAssignment {
        /// The text found.
        text: String,
    },
    /// There is no such setting, or the value cannot be its.
    NotASetting(NotASetting),
    /// The value is out of its range.
    OutOfRange(OutOfRange),
    /// A model has a setting of its own that holds for the plate as a whole.
    OfPlate {
        /// The setting's path.
        path: String,
        /// Whether a model could have it if models were printed one after another.
        by_object: bool,
    },
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SettingsError::NotJson { cause } => write!(f, "settings are not JSON: {cause}"),
            SettingsError::NotAnAssignment { text } => write!(f, "{text}: expected path=value"),
            SettingsError::NotASetting(found) => found.fmt(f),
            SettingsError::OutOfRange(found) => found.fmt(f),
            SettingsError::OfPlate { path, by_object: true } => {
                write!(f, "{path}: a model can have its own with print.sequence=by_object only")
            }
            SettingsError::OfPlate { path, by_object: false } => {
                write!(f, "{path}: holds for the whole plate; a model cannot have its own")
            }
        }
    }
}

impl std::error::Error for SettingsError {}

impl Settings {
    /// Defaults, changed by JSON texts in turn (each may hold any part of the settings), then by
    /// assignments such as `walls.count=2`. A value in an assignment is JSON, else a plain word.
    pub fn resolve<'a>(
        files: impl IntoIterator<Item = &'a str>,
        assignments: impl IntoIterator<Item = &'a str>,
    ) -> Result<Settings, SettingsError> {
        let mut settings = Settings::default();
        for text in files {
            settings.take(&parse_json(text)?)?;
        }
        for assignment in assignments {
            settings.take(&parse_assignment(assignment)?)?;
        }
        settings.checked()
    }

    fn take(&mut self, change: &Value) -> Result<(), SettingsError> {
        self.read(change, "").map_err(SettingsError::NotASetting)
    }

    fn checked(self) -> Result<Settings, SettingsError> {
        self.check("").map_err(SettingsError::OutOfRange)?;
        Ok(self)
    }

    /// The settings of a model: its own laid over these, the plate's. What holds for the plate as a whole
    /// is refused.
    pub fn of_model(&self, own: &OwnSettings) -> Result<Settings, SettingsError> {
        if own.is_empty() {
            return Ok(self.clone());
        }
        let mut settings = self.clone();
        settings.take(&Value::Object(own.0.clone()))?;
        let foreign = |path: &String| !is_of_model(path, self.print.sequence);
        if let Some((path, _)) = own.lines().into_iter().find(|(path, _)| foreign(path)) {
            let by_object = is_of_model(&path, Sequence::ByObject);
            return Err(SettingsError::OfPlate { path, by_object });
        }
        settings.checked()
    }

    /// The settings as JSON.
    pub fn to_json(&self) -> String {
        self.json().to_string()
    }

    /// Every setting as its path and its value in JSON (words without quotes), sorted by path.
    pub fn lines(&self) -> Vec<(String, String)> {
        let mut lines = Vec::new();
        flatten(&self.json(), "", &mut lines);
        lines
    }

    /// What the G-code stage needs.
    pub fn gcode_options(&self) -> GcodeOptions {
        GcodeOptions {
            printer: self.printer.clone(),
            filament: self.filament.clone(),
            second_filament: self.second_filament.clone(),
            support_tool: self.support.tool as u8,
            speed: self.speed.clone(),
            retraction: self.retraction.clone(),
            acceleration: self.acceleration.clone(),
            cooling: self.cooling.clone(),
            output: self.gcode.clone(),
            ironing_flow: self.ironing.flow,
            objects: Vec::new(),
            first_layer_speed: self.first_layer.speed,
            seam_gap: self.seam.gap,
        }
    }
}

/// Settings of one model where they differ from those of its plate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OwnSettings(Map<String, Value>);

impl OwnSettings {
    /// From JSON texts and assignments in turn, as [`Settings::resolve`] takes them. Whether there are such
    /// settings is told by [`Settings::of_model`].
    pub fn resolve<'a>(
        files: impl IntoIterator<Item = &'a str>,
        assignments: impl IntoIterator<Item = &'a str>,
    ) -> Result<OwnSettings, SettingsError> {
        let mut own = OwnSettings::default();
        for text in files {
            own.add(parse_json(text)?)?;
        }
        for assignment in assignments {
            own.add(parse_assignment(assignment)?)?;
        }
        Ok(own)
    }

    fn add(&mut self, change: Value) -> Result<(), SettingsError> {
        match change {
            Value::Object(change) => merge(&mut self.0, change),
            other => {
                let cause = format!("expected a group of settings, found {other}");
                let path = "models".to_owned();
                return Err(SettingsError::NotASetting(NotASetting::Wrong { path, cause }));
            }
        }
        Ok(())
    }

    /// Whether the model has none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The settings as JSON.
    pub fn to_json(&self) -> String {
        Value::Object(self.0.clone()).to_string()
    }

    /// Every own setting as its path and its value, like [`Settings::lines`].
    pub fn lines(&self) -> Vec<(String, String)> {
        let mut lines = Vec::new();
        flatten(&Value::Object(self.0.clone()), "", &mut lines);
        lines
    }
}

/// Groups and single settings that a model can have of its own while all models grow together.
const OF_MODEL: [&str; 22] = [
    "walls",
    "skin",
    "infill",
    "ironing",
    "seam",
    "support",
    "speed.outer_wall",
    "speed.inner_wall",
    "speed.overhang_wall",
    "speed.gap_fill",
    "speed.bottom_skin",
    "speed.top_skin",
    "speed.solid_infill",
    "speed.infill",
    "speed.bridge",
    "speed.ironing",
    "acceleration.outer_wall",
    "acceleration.inner_wall",
    "acceleration.bridge",
    "acceleration.top_skin",
    "acceleration.solid_infill",
    "acceleration.infill",
];

/// Groups that come to those when each model is printed by itself.
const OF_MODEL_BY_OBJECT: [&str; 3] = ["layers", "first_layer", "adhesion"];

/// Settings in these groups that stay the plate's.
const OF_PLATE: [&str; 1] = ["support.tool"];

/// Whether a model can have the setting of its own.
pub fn is_of_model(path: &str, sequence: Sequence) -> bool {
    let covers =
        |group: &&str| path.strip_prefix(*group).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    let by_object = sequence == Sequence::ByObject && OF_MODEL_BY_OBJECT.iter().any(covers);
    !OF_PLATE.contains(&path) && (by_object || OF_MODEL.iter().any(covers))
}

fn parse_json(text: &str) -> Result<Value, SettingsError> {
    serde_json::from_str(text).map_err(|e| SettingsError::NotJson { cause: e.to_string() })
}

/// `a.b=1` as `{"a": {"b": 1}}`.
fn parse_assignment(text: &str) -> Result<Value, SettingsError> {
    let Some((path, value)) = text.split_once('=') else {
        return Err(SettingsError::NotAnAssignment { text: text.to_owned() });
    };
    let value = serde_json::from_str(value).unwrap_or_else(|_| Value::String(value.to_owned()));
    let nest = |inner, key: &str| {
        let mut group = Map::new();
        group.insert(key.to_owned(), inner);
        Value::Object(group)
    };
    Ok(path.rsplit('.').fold(value, nest))
}

/// Puts `change` over `tree`, group by group.
fn merge(tree: &mut Map<String, Value>, change: Map<String, Value>) {
    for (key, value) in change {
        match (tree.get_mut(&key), value) {
            (Some(Value::Object(old)), Value::Object(new)) => merge(old, new),
            (_, value) => {
                tree.insert(key, value);
            }
        }
    }
}

fn flatten(tree: &Value, path: &str, lines: &mut Vec<(String, String)>) {
    match tree {
        Value::Object(map) => {
            map.iter().for_each(|(key, value)| flatten(value, &join_path(path, key), lines))
        }
        Value::String(word) => lines.push((path.to_owned(), word.replace('\n', "\\n"))),
        other => lines.push((path.to_owned(), other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(files: &[&str], sets: &[&str]) -> String {
        Settings::resolve(files.iter().copied(), sets.iter().copied()).unwrap_err().to_string()
    }

    #[test]
    fn later_changes_win_and_the_rest_stays_at_its_default() {
        let files = [r#"{"walls": {"count": 4, "width": 0.5}}"#, r#"{"walls": {"count": 5}}"#];
        let found = Settings::resolve(files, ["infill.density=0.3", "infill.pattern=lines"]).unwrap();
        assert_eq!((found.walls.count, found.walls.width), (5, 0.5));
        assert_eq!(found.infill.density, 0.3);
        assert_eq!(found.layers, Settings::default().layers);
        assert_eq!(Settings::resolve([found.to_json().as_str()], []).unwrap(), found);
    }

    #[test]
    fn what_is_wrong_is_named_by_its_path() {
        assert_eq!(error(&[], &["walls.cuont=2"]), "walls.cuont: there is no such setting");
        assert_eq!(error(&[], &["walls.width=9"]), "walls.width: 9 is outside 0.1 to 2 mm");
        assert_eq!(
            error(&[], &["walls.count=2.5"]),
            "walls.count: expected a whole number from 0 up, found 2.5"
        );
        assert_eq!(
            error(&[], &["seam.position=left"]),
            "seam.position: expected one of aligned, nearest, rear, random, found \"left\""
        );
        assert_eq!(
            error(&[], &[r#"printer.bed_size=[220,"wide"]"#]),
            "printer.bed_size[1]: expected a number, found \"wide\""
        );
        assert_eq!(
            error(&[], &["printer.bed_size=[220]"]),
            "printer.bed_size: expected 2 numbers, found [220]"
        );
        assert_eq!(
            error(&[], &["support.blockers=[[0,0,0,1,1,1],[0,0,0,1,null,1]]"]),
            "support.blockers[1][4]: expected a number, found null"
        );
        assert_eq!(
            error(&[], &[r#"gcode.events=[{"kind":"pause"},{"kind":"dance"}]"#]),
            "gcode.events[1].kind: expected one of pause, filament_change, custom, found \"dance\""
        );
        assert_eq!(
            error(&[], &[r#"gcode.events=[{"level":1}]"#]),
            "gcode.events[0].level: there is no such setting"
        );
        assert_eq!(error(&[], &["walls=2"]), "walls: expected a group of settings, found 2");
        assert_eq!(error(&[], &["walls.count"]), "walls.count: expected path=value");
        assert!(error(&["{"], &[]).starts_with("settings are not JSON"));
    }

    #[test]
    fn settings_reach_another_engine_bit_by_bit() {
        let events =
            r#"{"gcode": {"events": [{"z": 0.30000000000000004, "kind": "custom", "gcode": "M117 ä"}]}}"#;
        let sets = ["printer.forbidden=[[0,0,1,0.1],[5,5,6,6]]", "infill.pattern=gyroid"];
        let mut settings = Settings::resolve([events], sets).unwrap();
        settings.walls.width = 0.1 + 0.35;
        let mut bytes = Vec::new();
        settings.save(&mut bytes);
        let (mut found, mut rest) = (Settings::default(), bytes.as_slice());
        assert_eq!(found.load(&mut rest), Some(()));
        assert_eq!((&found, rest), (&settings, &[][..]));
        for length in 0..bytes.len() {
            assert_eq!(Settings::default().load(&mut &bytes[..length]), None, "{length}");
        }
    }

    fn of_model(plate: &[&str], own: &[&str]) -> Result<Settings, String> {
        let plate = Settings::resolve([], plate.iter().copied()).expect("good settings");
        let own = OwnSettings::resolve([], own.iter().copied()).map_err(|e| e.to_string())?;
        plate.of_model(&own).map_err(|e| e.to_string())
    }

    #[test]
    fn a_model_lays_its_own_over_the_plate() {
        let found = of_model(&["walls.count=4", "infill.density=0.3"], &["infill.density=1"]).unwrap();
        assert_eq!((found.walls.count, found.infill.density), (4, 1.0));
        let files = [r#"{"walls": {"count": 2, "width": 0.5}}"#, r#"{"walls": {"count": 1}}"#];
        let own = OwnSettings::resolve(files, ["skin.top_layers=9"]).unwrap();
        let lines = [("skin.top_layers", "9"), ("walls.count", "1"), ("walls.width", "0.5")];
        assert_eq!(own.lines(), lines.map(|(a, b)| (a.to_owned(), b.to_owned())));
        assert_eq!(OwnSettings::resolve([own.to_json().as_str()], []).unwrap(), own);
    }

    #[test]
    fn what_holds_for_the_plate_is_refused() {
        let refused = |plate: &[&str], own| of_model(plate, &[own]).unwrap_err();
        assert_eq!(
            refused(&[], "layers.height=0.1"),
            "layers.height: a model can have its own with print.sequence=by_object only"
        );
        let whole = "holds for the whole plate; a model cannot have its own";
        for path in ["printer.height=90", "speed.travel=90", "support.tool=1", "print.sequence=by_object"] {
            let name = path.split('=').next().unwrap();
            assert_eq!(refused(&["print.sequence=by_object"], path), format!("{name}: {whole}"));
        }
        assert!(of_model(&["print.sequence=by_object"], &["layers.height=0.1"]).is_ok());
        assert_eq!(refused(&[], "walls.cuont=2"), "walls.cuont: there is no such setting");
        assert_eq!(refused(&[], "walls.width=9"), "walls.width: 9 is outside 0.1 to 2 mm");
        assert!(refused(&[], "walls=9").starts_with("walls: expected a group"));
    }
}
