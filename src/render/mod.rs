//! Layers over one another: synthesis of a scene, and its frames on the CPU (the reference) and the GPU.

pub mod overlay;

use crate::layers::folding;

/// What a frame of a scene needs except the time.
#[derive(Clone, Debug)]
pub struct Synth {
    /// Width and height of a frame, in pixels: those of the first picture layer.
    pub size: (usize, usize),
    /// The layers, in the scene's order.
    pub layers: Vec<LayerSynth>,
}

/// What a frame of one layer needs except the time.
#[derive(Clone, Debug)]
pub enum LayerSynth {
    /// A picture layer.
    Picture(folding::synth::Synth),
}
