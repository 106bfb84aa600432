//! Every picture of the lessons and of the base layers for one model: `cargo run --example lesson_svg --
//! part.stl FOLDER [path=value]...` writes `teeth-1-outline.svg` and so on, and prints the facts.

use std::error::Error;
use std::fs;
use std::path::Path;

use foothold::mesh::{LoadedModel, StlReader};
use foothold::orientation::orient;
use foothold::pipeline::{Job, NamedModel};
use foothold::settings::Settings;
use foothold::view::{Scene, Step, lesson};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, folder, sets @ ..] = arguments.as_slice() else {
        return Err("usage: lesson_svg MODEL.stl FOLDER [path=value]...".into());
    };
    let folder = Path::new(folder);
    fs::create_dir_all(folder)?;
    let mut reader = StlReader::new();
    reader.push(&fs::read(model)?)?;
    let named = NamedModel::new("part", LoadedModel::new(reader.finish()?)?);
    let settings = Settings::resolve([], sets.iter().map(String::as_str))?;
    let report = orient(&named.model.mesh, &settings.orientation, &mut |_, _| true)?;
    let job = Job::new(&[named], settings, &|| 0.0)?;
    let lessons = [
        ("teeth", lesson::teeth(&job)?),
        ("plates", lesson::plates(&job, "")?),
        ("features", lesson::features(&job, None)),
        ("orientation", lesson::orientation(&report)),
    ];
    for (name, steps) in &lessons {
        write(folder, name, steps)?;
    }
    let alternatives = job.first_print().alternatives(&|| 0.0)?;
    for (kind, picture) in alternatives.kinds.iter().zip(Scene::of_alternatives(&alternatives)) {
        fs::write(folder.join(format!("base-{}.svg", kind.report.kind.name())), picture.to_svg())?;
    }
    println!("recommended: {:?}", alternatives.recommendation);
    Ok(())
}

fn write(folder: &Path, lesson: &str, steps: &[Step]) -> std::io::Result<()> {
    for (number, step) in (1..).zip(steps) {
        for (letter, picture) in ('a'..).zip(&step.pictures) {
            let name = format!("{lesson}-{number}{letter}-{}.svg", step.id);
            fs::write(folder.join(name), picture.to_svg())?;
        }
        println!("{lesson} {}: {:?}", step.id, step.facts);
    }
    Ok(())
}
