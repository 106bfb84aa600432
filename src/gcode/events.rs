//! What happens between layers by the user's wish: pauses, changes of filament, lines of their own.

use super::GcodeOptions;
use super::start::{GcodeError, PLACEHOLDERS, expand};

/// How far the nozzle rises above the part for a pause, mm.
pub(super) const PAUSE_LIFT: f64 = 5.0;

/// Heights closer than this are the same, mm: sums of binary fractions.
const SAME_HEIGHT: f64 = 1e-6;

crate::options! {
    /// Something that happens before a layer.
    pub struct LayerEvent {
        /// Number of the layer, counted from 0 at the bed.
        layer: Option<u32> = None, "Layer";
        /// Instead of a number: a height, mm; it happens before the first layer that reaches above it.
        z: Option<f64> = None, "Height";
        /// What happens.
        kind: EventKind = EventKind::Pause, "What happens";
        /// Lines of a custom event, with the start code's {placeholders}.
        gcode: String = String::new(), "Lines";
    }
}

crate::words! {
    /// What happens before a layer.
    pub enum EventKind {
        /// The printer waits until it is told to go on, such as for a nut to be laid in.
        #[default]
        Pause = "pause",
        /// The firmware's own change of filament (M600).
        FilamentChange = "filament_change",
        /// Lines of one's own.
        Custom = "custom",
    }
}

impl LayerEvent {
    fn check(&self) -> Result<(), &'static str> {
        match (self.layer, self.z) {
            (None, None) | (Some(_), Some(_)) => return Err("needs either layer or z"),
            (_, Some(z)) if !(0.0..=1e4).contains(&z) => return Err("z is no height on a printer"),
            _ => {}
        }
        match (self.kind, self.gcode.is_empty()) {
            (EventKind::Custom, true) => Err("a custom event needs gcode"),
            (EventKind::Pause | EventKind::FilamentChange, false) => Err("gcode is for custom events"),
            _ => Ok(()),
        }
    }
}

/// Checks the settings `gcode.*`, so that [`super::join()`] cannot fail on them later.
pub fn check_output(options: &GcodeOptions) -> Result<(), GcodeError> {
    let events = &options.output.events;
    let flavor = options.printer.flavor;
    let firmware = flavor.name();
    for (i, event) in events.iter().enumerate() {
        let wrong = |cause: &str| GcodeError::Contradiction {
            setting: format!("gcode.events[{i}]"),
            cause: cause.to_owned(),
        };
        event.check().map_err(wrong)?;
        if event.kind == EventKind::Pause && !flavor.has_pause() {
            return Err(wrong(&format!("the firmware {firmware} is not known to wait for the user")));
        }
        expand(&event.gcode, "gcode.events", |name| PLACEHOLDERS.contains(&name).then(String::new))?;
    }
    Ok(())
}

/// For each event the layer before which it happens, by the tops of all layers, mm; `None` above the
/// print.
pub fn event_layers(events: &[LayerEvent], tops: &[f64]) -> Vec<Option<usize>> {
    let place = |event: &LayerEvent| match (event.layer, event.z) {
        (Some(layer), _) => (layer as usize) < tops.len(),
        (None, Some(z)) => tops.last().is_some_and(|&top| top > z + SAME_HEIGHT),
        (None, None) => false,
    };
    let layer_of = |event: &LayerEvent| match event.layer {
        Some(layer) => layer as usize,
        None => tops.partition_point(|&top| top <= event.z.unwrap_or(0.0) + SAME_HEIGHT),
    };
    events.iter().map(|event| place(event).then(|| layer_of(event))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_find_their_layers() {
        let at_layer = |layer| LayerEvent { layer: Some(layer), ..LayerEvent::default() };
        let at_z = |z| LayerEvent { z: Some(z), ..LayerEvent::default() };
        let tops = [0.2, 0.4, 0.6000000000000001];
        let events = [at_layer(0), at_layer(2), at_layer(3), at_z(0.0), at_z(0.2), at_z(0.3), at_z(0.6)];
        assert_eq!(event_layers(&events, &tops), [Some(0), Some(2), None, Some(0), Some(1), Some(1), None]);
    }

    #[test]
    fn senseless_events_are_named() {
        let message = |event: LayerEvent| {
            let mut options = GcodeOptions::default();
            options.output.events = vec![LayerEvent { layer: Some(1), ..LayerEvent::default() }, event];
            check_output(&options).expect_err("senseless").to_string()
        };
        let none = LayerEvent::default();
        assert_eq!(message(none.clone()), "gcode.events[1]: needs either layer or z");
        let custom = LayerEvent { layer: Some(1), kind: EventKind::Custom, ..none.clone() };
        assert_eq!(message(custom.clone()), "gcode.events[1]: a custom event needs gcode");
        let unknown = LayerEvent { gcode: "G1 X{nowhere}".to_owned(), ..custom };
        assert!(message(unknown).starts_with("gcode.events: line 1: unknown placeholder {nowhere}"));
        let high = LayerEvent { z: Some(f64::NAN), ..none };
        assert_eq!(message(high), "gcode.events[1]: z is no height on a printer");
    }
}
