//! One layer of a G-code file as a picture: `cargo run --example layer_svg -- part.gcode LAYER
//! out.svg`.

use std::error::Error;

use foothold::gcode::{FilamentOptions, PrinterOptions, read};
use foothold::view::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [gcode, layer, out] = arguments.as_slice() else {
        return Err("usage: layer_svg FILE.gcode LAYER OUT.svg".into());
    };
    let file = read::read(&std::fs::read(gcode)?, FilamentOptions::default().diameter);
    let layer = file.layers.get(layer.parse::<usize>()?).ok_or("there is no such layer")?;
    std::fs::write(out, Scene::of_layer(layer, &PrinterOptions::default(), None).to_svg())?;
    Ok(())
}
