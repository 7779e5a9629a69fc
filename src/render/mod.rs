//! Layers over one another: synthesis of a scene, and its frames on the CPU (the reference) and the GPU.

use kurbo::Vec2;

use crate::base::problem::Problem;
use crate::layers::{Layer, Materials, folding};
use crate::scene::Scene;

pub mod bands;
pub mod cpu;
#[cfg(feature = "window")]
pub mod gpu;
pub mod overlay;
pub mod part;
#[cfg(feature = "window")]
pub mod reduce;
pub mod seams;

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

/// Makes a scene ready to be shown at any time. What `previous` has in common with it is taken over.
///
/// # Errors
/// There is no layer, or a picture that a layer names is not among the materials.
pub fn synth(scene: &Scene, materials: &Materials, previous: Option<&Synth>) -> Result<Synth, Problem> {
    synth_at(scene, materials, folding::synth::CENTRE, previous)
}

/// As [`synth`], for n x n places spread evenly over each pixel; [`cpu::picture`] averages their frames.
///
/// # Errors
/// As [`synth`].
pub fn samples(scene: &Scene, materials: &Materials, n: u32) -> Result<Vec<Synth>, Problem> {
    places(n).map(|place| synth_at(scene, materials, place, None)).collect()
}

/// Where the n x n samples of a pixel stand.
fn places(n: u32) -> impl Iterator<Item = Vec2> {
    let place = move |k: u32| (f64::from(k) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Vec2::new(place(k % n), place(k / n)))
}

fn no_layers() -> Problem {
    Problem::error("/layers", "a scene without layers has nothing to show").hint("add a picture layer")
}

fn synth_at(scene: &Scene, materials: &Materials, place: Vec2, previous: Option<&Synth>) -> Result<Synth, Problem> {
    let synth_layer = |(i, layer): (usize, &Layer)| match layer {
        Layer::Picture(layer) => {
            let before = previous.and_then(|p| p.layers.get(i)).map(|LayerSynth::Picture(before)| before);
            folding::synth::synth(layer, scene.timeline.wrap, materials, place, before)
                .map(LayerSynth::Picture)
                .map_err(|problem| problem.under(&format!("/layers/{i}")))
        }
    };
    let layers = scene.layers.iter().enumerate().map(synth_layer).collect::<Result<Vec<_>, _>>()?;
    let Some(LayerSynth::Picture(first)) = layers.first() else {
        return Err(no_layers());
    };
    Ok(Synth { size: (first.picture.width(), first.picture.height()), layers })
}
