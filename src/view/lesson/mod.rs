//! The methods step by step on a part: pictures with the numbers that tell what they show.
//!
//! A step has pictures and facts; the words around them are the page's.

mod features;
mod orientation;
mod plates;
mod stack;
mod teeth;

use std::collections::BTreeMap;

pub use features::features;
pub use orientation::orientation;
pub use plates::plates;
pub use teeth::teeth;

use super::Scene;

/// One step of a lesson.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Fixed word by which the page finds its sentences.
    pub id: &'static str,
    /// One picture, or two to compare.
    pub pictures: Vec<Scene>,
    /// Numbers of the sentences, by fixed names; lengths in mm, areas in mm2, volumes in mm3.
    pub facts: BTreeMap<&'static str, f64>,
}

impl Step {
    fn new<const N: usize>(id: &'static str, picture: Scene, facts: [(&'static str, f64); N]) -> Step {
        Step { id, pictures: vec![picture], facts: facts.into_iter().collect() }
    }

    fn beside(mut self, picture: Scene) -> Step {
        self.pictures.push(picture);
        self
    }
}
