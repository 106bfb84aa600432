//! Models on a plate printed together or one after another.

crate::words! {
    /// In which order the models on a plate are printed.
    pub enum Sequence {
        /// All models grow together, layer by layer.
        #[default]
        ByLayer = "by_layer",
        /// Each model is finished before the next one is begun, the lowest first. The head needs room
        /// between them.
        ByObject = "by_object",
    }
}

crate::options! {
    /// How the models on a plate are printed.
    pub struct PrintOptions {
        /// All models layer by layer, or each from its first layer to its last before the next one.
        sequence: Sequence = Sequence::ByLayer, "Print sequence";
    }
}
