//! All layers together: the synthesis of a scene, and its frames on the CPU (the reference) and the GPU.

use std::sync::Arc;

use kurbo::Vec2;

use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::{CENTRE, Moment};
use crate::layers::ready::Ready;
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

/// Everything that a frame of a scene needs except the time.
#[derive(Clone, Debug)]
pub struct Synth {
    /// Width and height of a frame, in pixels.
    pub size: (usize, usize),
    /// The layers, in the scene's order.
    pub layers: Vec<Arc<dyn Ready>>,
}

impl Synth {
    /// What a frame at scene time `t` depends on besides the layers.
    pub fn moment(&self, t: f64) -> Moment {
        Moment { t, size_px: self.size }
    }
}

/// Prepares a scene for rendering at any time. What it has in common with `previous` is reused.
///
/// # Errors
/// If there is no layer, or a picture that a layer names is not among the materials.
pub fn synth(scene: &Scene, materials: &Materials, previous: Option<&Synth>) -> Result<Synth, Problem> {
    synth_at(scene, materials, CENTRE, previous)
}

/// As [`synth`], for n x n places spread evenly over each pixel; [`cpu::frames`] averages their frames.
///
/// # Errors
/// As [`synth`].
pub fn samples(scene: &Scene, materials: &Materials, n: u32) -> Result<Vec<Synth>, Problem> {
    places(n).map(|place| synth_at(scene, materials, place, None)).collect()
}

/// The places of the n x n samples in a pixel.
fn places(n: u32) -> impl Iterator<Item = Vec2> {
    let place = move |k: u32| (f64::from(k) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Vec2::new(place(k % n), place(k / n)))
}

fn no_layers() -> Problem {
    Problem::error("/layers", "a scene without layers has nothing to show").hint("add a picture layer")
}

fn synth_at(scene: &Scene, materials: &Materials, place: Vec2, previous: Option<&Synth>) -> Result<Synth, Problem> {
    let ready = |(i, layer): (usize, &Layer)| {
        let before = previous.and_then(|synth| synth.layers.get(i)).map(|before| &**before);
        let ready = layer.technique().synth(scene.timeline.wrap, materials, place, before);
        ready.map_err(|problem| problem.under(&format!("/layers/{i}")))
    };
    let layers = scene.layers.iter().enumerate().map(ready).collect::<Result<Vec<_>, _>>()?;
    if layers.is_empty() {
        return Err(no_layers());
    }
    Ok(Synth { size: frame_size(scene, materials), layers })
}

/// Width and height of a frame: those of the first picture that a layer gives it, otherwise 1280 x 720.
pub fn frame_size(scene: &Scene, materials: &Materials) -> (usize, usize) {
    let named = scene.layers.iter().find_map(|layer| layer.technique().frame_of());
    let picture = named.and_then(|name| materials.pictures.get(name));
    picture.map_or((1280, 720), |picture| (picture.width(), picture.height()))
}
