//! Jobs of two extruders: who prints what, where tools change, and that nothing is printed cold.

mod common;

use common::{cuboid, together};
use foothold::gcode::assemble;
use foothold::mesh::{Mesh, load, stl::write_binary};
use foothold::pipeline::{Job, JobError, NamedModel, Report};
use foothold::settings::Settings;
use glam::vec3;

/// A table 8 mm tall with a top 30 x 20 on a leg.
fn table() -> Mesh {
    let leg = cuboid(vec3(0.0, 0.0, 0.0), vec3(8.0, 20.0, 8.1));
    together(&[leg, cuboid(vec3(0.0, 0.0, 8.0), vec3(30.0, 20.0, 10.0))])
}

const TWO: [&str; 7] = [
    "support.method=plates",
    "support.tool=1",
    "printer.extruders=2",
    "filament.nozzle_temp=215",
    "filament.first_layer_nozzle_temp=220",
    "second_filament.nozzle_temp=185",
    "second_filament.first_layer_nozzle_temp=190",
];

fn job(sets: &[&str]) -> Result<Job, JobError> {
    let model = load(&write_binary(&table())).expect("a good mesh");
    let settings = Settings::resolve([], sets.iter().copied()).expect("good settings");
    let mut job = Job::new(&[NamedModel::new("table", model)], settings, &|| 0.0)?;
    job.prepare(&|| 0.0)?;
    Ok(job)
}

/// The file, its ranges `step` layers each, and the report.
fn printed(sets: &[&str], step: usize) -> (String, Report) {
    let mut job = job(sets).expect("good settings");
    let mut texts = Vec::new();
    for first in (0..job.layer_count()).step_by(step) {
        let range = job.slice(first, (first + step).min(job.layer_count()), &|| 0.0);
        job.add(range.meta);
        texts.extend(range.texts);
    }
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    (String::from_utf8(assemble(&finished.joined, &texts)).expect("ASCII"), finished.report)
}

/// One tool of a simulated printer.
#[derive(Debug, Clone, Copy, Default)]
struct Tool {
    target: f64,
    temp: f64,
    /// Filament that is pulled back, mm.
    retracted: f64,
}

/// A printer that heats and cools while it moves, and what it was told.
#[derive(Debug, Default)]
struct Printer {
    tools: [Tool; 2],
    active: usize,
    role: String,
    layer: i32,
    speed: f64,
    place: [f64; 3],
    changes: Vec<i32>,
    /// Beads of a role by each tool.
    beads: std::collections::BTreeMap<(String, usize), u32>,
    /// Whether the tool has laid a bead since it took over.
    is_new: bool,
}

impl Printer {
    /// Heats by 2 and cools by 1 K/s, like an ordinary hot end.
    fn pass(&mut self, seconds: f64) {
        for tool in &mut self.tools {
            let (up, down) = (2.0 * seconds, seconds);
            tool.temp += (tool.target - tool.temp).clamp(-down, up);
        }
    }

    fn run(&mut self, line: &str) {
        if let Some(role) = line.strip_prefix(";TYPE:") {
            role.clone_into(&mut self.role);
        }
        self.layer += i32::from(line == ";LAYER_CHANGE");
        let code = line.split(';').next().unwrap_or_default().trim();
        let mut words = code.split_whitespace();
        let command = words.next().unwrap_or_default();
        let word = |letter: char| {
            let found = code.split_whitespace().skip(1).find_map(|w| w.strip_prefix(letter));
            found.map(|w| w.parse::<f64>().expect("a number"))
        };
        match command {
            "T0" | "T1" => self.change(usize::from(command == "T1")),
            "M104" | "M109" => {
                let tool = word('T').map_or(self.active, |t| t as usize);
                self.tools[tool].target = word('S').expect("a temperature");
                if command == "M109" {
                    self.tools[tool].temp = self.tools[tool].temp.max(self.tools[tool].target);
                }
            }
            "G1" => self.go(word('E'), [word('X'), word('Y'), word('Z')], word('F')),
            _ => {}
        }
    }

    fn change(&mut self, tool: usize) {
        if tool == self.active {
            return;
        }
        let old = &self.tools[self.active];
        assert!((old.retracted - 10.0).abs() < 1e-6, "layer {}: {old:?} oozes", self.layer);
        self.active = tool;
        self.is_new = true;
        self.changes.push(self.layer);
        self.role.clear();
    }

    fn go(&mut self, filament: Option<f64>, to: [Option<f64>; 3], feed: Option<f64>) {
        self.speed = feed.map_or(self.speed, |f| f / 60.0);
        let next: [f64; 3] = std::array::from_fn(|i| to[i].unwrap_or(self.place[i]));
        let length = (0..3).map(|i| (next[i] - self.place[i]).powi(2)).sum::<f64>().sqrt();
        self.place = next;
        self.pass(length / self.speed.max(1.0));
        let Some(filament) = filament else { return };
        let tool = &mut self.tools[self.active];
        let least = [213.0, 183.0][self.active];
        assert!(tool.temp >= least, "layer {}: tool {} at {:.0} degrees", self.layer, self.active, tool.temp);
        if length == 0.0 {
            // A tool that was never pulled back is primed by the way.
            tool.retracted = (tool.retracted - filament).max(0.0);
            return;
        }
        assert!(tool.retracted < 1e-6, "layer {}: tool {} starts empty", self.layer, self.active);
        if self.is_new {
            assert_eq!(self.role, "Wipe tower", "layer {}: tool {}", self.layer, self.active);
        }
        self.is_new = false;
        *self.beads.entry((self.role.clone(), self.active)).or_default() += 1;
    }
}

fn simulated(text: &str) -> Printer {
    let mut printer = Printer { layer: -1, ..Printer::default() };
    text.lines().for_each(|line| printer.run(line));
    printer
}

#[test]
fn tools_change_on_the_tower_once_a_layer_and_never_print_cold() {
    let standby = [&TWO[..], &["second_filament.standby_temp=120", "filament.standby_temp=150"]].concat();
    for sets in [&TWO[..], &standby] {
        let (text, report) = printed(sets, 1000);
        let printer = simulated(&text);
        let supported = 39; // The top begins at layer 40, layer 39 is the gap.
        assert_eq!(printer.changes, (0..supported).chain(Some(supported)).collect::<Vec<i32>>());
        for ((role, tool), count) in &printer.beads {
            let right = match role.as_str() {
                "Support material" | "Support material interface" => *tool == 1,
                "Wipe tower" => true,
                _ => *tool == 0,
            };
            assert!(right, "{count} beads of {role} by tool {tool}");
        }
        assert!(printer.tools.iter().all(|t| t.target == 0.0), "hot after the end");
        let tower = report.by_role[&foothold::region::Role::WipeTower];
        // Each change leaves at least what was asked for; the first layer has a brim.
        assert!(tower.volume_mm3 > 15.0 * f64::from(supported));
        assert!(text.contains("M104 T1 S190"), "the second nozzle is heated early");
        assert_eq!(text.contains("M104 T0 S150\nT1\n"), sets.len() > TWO.len());
    }
}

#[test]
fn the_time_counts_changes_and_ranges_do_not_matter() {
    let (whole, report) = printed(&TWO, 1000);
    let (ranges, _) = printed(&TWO, 7);
    assert!(whole == ranges);
    let slow = [&TWO[..], &["printer.tool_change_time=25"]].concat();
    let more = printed(&slow, 1000).1.time_s - report.time_s;
    assert!((more - 20.0 * 40.0).abs() < 1e-6, "{more}");
}

#[test]
fn materials_are_weighed_apart() {
    let (_, same) = printed(&TWO, 1000);
    let heavy = [&TWO[..], &["second_filament.density=2.48"]].concat();
    let (_, heavy) = printed(&heavy, 1000);
    let plain = same.filament.volume_mm3 / 1000.0 * 1.24;
    assert!((same.filament.mass_g - plain).abs() < 1e-9);
    // All supports and about half of the tower.
    let volume = |role| same.by_role[&role].volume_mm3;
    use foothold::region::Role;
    let supports = volume(Role::Support) + volume(Role::SupportInterface);
    let second = (heavy.filament.mass_g - plain) / 1.24 * 1000.0;
    assert!(second > supports + 0.4 * volume(Role::WipeTower), "{second}");
    assert!(second < supports + 0.7 * volume(Role::WipeTower), "{second}");
}

#[test]
fn one_tool_needs_no_tower() {
    let (text, report) = printed(&["support.method=plates", "printer.extruders=2"], 1000);
    assert!(!text.lines().any(|l| l.starts_with('T') || l == ";TYPE:Wipe tower"));
    assert!(!report.by_role.contains_key(&foothold::region::Role::WipeTower));
    let unused = printed(&["support.tool=1", "printer.extruders=2"], 1000).0;
    assert!(!unused.contains("\nT1"));
}

#[test]
fn what_two_tools_cannot_do_is_refused_by_name() {
    let refused = |sets: &[&str]| job(sets).map(|_| ()).expect_err("refused").to_string();
    assert_eq!(
        refused(&["support.tool=1"]),
        "support.tool: 1 is the second extruder, but printer.extruders is 1"
    );
    let crowded = [&TWO[..], &["printer.bed_size=[40,40]"]].concat();
    assert_eq!(refused(&crowded), "prime_tower.size: the bed has no free place of 26 x 26 mm for the tower");
}
