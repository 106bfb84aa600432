//! Support features step by step [Karim]: two layers, what may overhang, what hangs, regions growing down,
//! structures.

use std::collections::BTreeMap;

use super::Step;
use super::stack::{Stack, shown};
use crate::pipeline::Job;
use crate::polygon::measure::Bounds;
use crate::polygon::{DVec2, Polygon, PolygonSet};
use crate::region::overhang::{externally_supported, permissible_overhang, permissible_step};
use crate::support::volumes::{Descent, SupportVolumes, VolumeRules};
use crate::view::base_layer::outline_strokes;
use crate::view::scene::{Ink, Item, Scene};

/// Free space around two layers, mm.
const MARGIN_MM: f64 = 3.0;

/// The steps for layer `below` (counted from 0) and the one above it, or for the layer over which most
/// hangs.
pub fn features(job: &Job, below: Option<usize>) -> Vec<Step> {
    let lesson = Lesson::new(job, below);
    vec![lesson.layers(), lesson.grown(), lesson.overhang(), lesson.regions(), lesson.structures()]
}

struct Lesson<'a> {
    job: &'a Job,
    areas: Vec<PolygonSet>,
    /// ESF over each layer.
    hanging: Vec<PolygonSet>,
    /// Components of S_k with the number of their structure.
    supports: Vec<Vec<(Polygon, usize)>>,
    volumes: SupportVolumes,
    /// t tan(alpha), mm.
    step: f64,
    below: usize,
}

impl<'a> Lesson<'a> {
    fn new(job: &'a Job, below: Option<usize>) -> Self {
        let settings = job.settings();
        let areas = job.first_print().areas();
        let rules = VolumeRules {
            layer_height: settings.layers.height,
            self_support_angle_deg: settings.orientation.self_support_angle_deg,
            base_layers: settings.orientation.base_layers,
            section_tolerance: 0.0,
            speck_width: settings.orientation.speck_width,
        };
        let step = permissible_step(rules.layer_height, rules.self_support_angle_deg);
        let pairs = areas.windows(2).map(|w| externally_supported(&w[1], &w[0], step));
        let hanging: Vec<PolygonSet> = pairs.collect();
        let size = |k: &usize| hanging[*k].area();
        let most = (0..hanging.len()).max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a)));
        let last = hanging.len().saturating_sub(1);
        let below = below.or(most.filter(|k| size(k) > 0.0)).unwrap_or(last / 2).min(last);
        let (supports, volumes) = descend(&areas, rules);
        Lesson { job, areas, hanging, supports, volumes, step, below }
    }

    fn layer(&self, k: usize) -> &PolygonSet {
        const NONE: &PolygonSet = &PolygonSet::EMPTY;
        self.areas.get(k).unwrap_or(NONE)
    }

    /// The layer below with its border, and what lies over it.
    fn two_layers(&self, over: Vec<Item>) -> Scene {
        let (below, above) = (self.layer(self.below), self.layer(self.below + 1));
        let mut items = vec![Item::Area { area: below.clone(), ink: Ink::Part }];
        items.extend(over);
        items.extend(outline_strokes(below, Ink::Outline, 1.5));
        let nothing = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
        let extents = below.bounds().into_iter().chain(above.bounds());
        Scene { items, bounds: extents.reduce(Bounds::union).unwrap_or(nothing).grown(MARGIN_MM) }
    }

    fn above(&self) -> Vec<Item> {
        let above = self.layer(self.below + 1);
        let mut items = vec![Item::Area { area: above.clone(), ink: Ink::Above }];
        items.extend(outline_strokes(above, Ink::Travel, 1.5));
        items
    }

    fn layers(&self) -> Step {
        let facts = [
            // Counted from 1, as everywhere on the page.
            ("layer", self.below as f64 + 1.0),
            ("below", self.layer(self.below).area()),
            ("above", self.layer(self.below + 1).area() + 0.0),
        ];
        Step::new("layers", self.two_layers(self.above()), facts)
    }

    fn grown(&self) -> Step {
        let grown = permissible_overhang(self.layer(self.below), self.step);
        let settings = self.job.settings();
        let facts = [
            ("angle", settings.orientation.self_support_angle_deg),
            ("height", settings.layers.height),
            ("step", self.step),
            ("grown", grown.area()),
        ];
        let mut over = vec![Item::Area { area: grown, ink: Ink::Grown }];
        over.extend(outline_strokes(self.layer(self.below + 1), Ink::Travel, 1.5));
        Step::new("grown", self.two_layers(over), facts)
    }

    fn overhang(&self) -> Step {
        let reaching = self.layer(self.below + 1).difference(self.layer(self.below));
        let nothing = PolygonSet::EMPTY;
        let features = self.hanging.get(self.below).unwrap_or(&nothing);
        let islands = |area: &PolygonSet| area.islands().len() as f64;
        let facts = [
            ("pieces", islands(&reaching)),
            ("features", islands(features)),
            ("area", features.area() + 0.0),
            ("held", (reaching.area() - features.area()).max(0.0)),
        ];
        let mut over = vec![
            Item::Area { area: reaching.clone(), ink: Ink::Above },
            Item::Area { area: features.clone(), ink: Ink::Hanging },
        ];
        over.extend(outline_strokes(self.layer(self.below + 1), Ink::Travel, 1.0));
        Step::new("overhang", self.two_layers(over), facts)
    }

    fn regions(&self) -> Step {
        let picture = self.pile(|_| Ink::Held);
        let layers = self.supports.iter().filter(|s| !s.is_empty()).count();
        Step::new("regions", picture, [("layers", layers as f64), ("volume", self.volumes.support_mm3)])
    }

    fn structures(&self) -> Step {
        let mut numbers: BTreeMap<usize, u8> = BTreeMap::new();
        for (_, structure) in self.supports.iter().flatten() {
            let next = numbers.len() as u8;
            numbers.entry(*structure).or_insert(next);
        }
        let SupportVolumes { support_mm3, base_mm3, structures, specks, .. } = self.volumes;
        let facts = [
            ("structures", f64::from(structures)),
            ("specks", f64::from(specks)),
            ("support", support_mm3),
            ("base", base_mm3),
            ("total", support_mm3 + base_mm3),
        ];
        Step::new("structures", self.pile(|structure| Ink::Structure(numbers[&structure])), facts)
    }

    /// Layers of part and supports, piled up.
    fn pile(&self, ink: impl Fn(usize) -> Ink) -> Scene {
        let heights = self.job.first_print().part_heights();
        let mut stack = Stack::new();
        for k in shown(self.areas.len()) {
            stack.level(&self.areas[k], heights[k], Ink::Part);
            for (polygon, structure) in &self.supports[k] {
                stack.level(&polygon.clone().into_set(), heights[k], ink(*structure));
            }
        }
        stack.into_scene()
    }
}

/// S_k of every layer from the top down, and the volumes.
fn descend(areas: &[PolygonSet], rules: VolumeRules) -> (Vec<Vec<(Polygon, usize)>>, SupportVolumes) {
    let mut descent = Descent::new(rules);
    let mut found: Vec<Vec<(Polygon, usize)>> = Vec::with_capacity(areas.len());
    for area in areas.iter().rev() {
        descent.enter(area.clone(), 1);
        found.push(descent.components().collect());
    }
    found.reverse();
    for (_, mark) in found.iter_mut().flatten() {
        *mark = descent.structure_of(*mark);
    }
    (found, descent.finish())
}
