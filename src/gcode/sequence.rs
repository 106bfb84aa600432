//! Models on a plate printed together or one after another.

/// In which order the models on a plate are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Sequence {
    /// All models grow together, layer by layer.
    #[default]
    ByLayer,
    /// Each model is finished before the next one is begun, the lowest first. The head needs room
    /// between them.
    ByObject,
}

crate::options! {
    /// How the models on a plate are printed.
    pub struct PrintOptions {
        /// All models layer by layer, or each from its first layer to its last before the next one.
        sequence: Sequence = Sequence::ByLayer, "Print sequence";
    }
}
