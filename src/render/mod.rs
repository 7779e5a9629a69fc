//! All layers together: the synthesis of a scene, and its frames on the CPU (the reference) and the GPU.

use std::sync::Arc;

use glam::DVec3;
use kurbo::Vec2;

use crate::base::geometry::farther;
use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::ready::{Making, Ready, Texture, Textures};
use crate::layers::timeline::Timeline;
use crate::scene::Scene;
pub use crate::scene::sight::frame_size;

pub mod bands;
mod beside;
pub mod cpu;
#[cfg(feature = "window")]
pub mod gpu;
mod made;
pub mod overlay;
pub mod part;
pub mod passes;
pub mod reduce;
#[cfg(test)]
pub mod samples;
pub mod seams;
pub mod shown;
pub mod sight;
pub mod stage;
#[cfg(test)]
mod tests;
mod whole;

pub use made::Synth;
pub use whole::bytes as stroke_bytes;

use made::LastMade;
use stage::Stage;

/// Prepares a scene for rendering at any time. What it has in common with `previous` is reused.
///
/// # Errors
/// If there is no layer, or a picture that a layer names is not among the materials.
pub fn synth(scene: &Scene, materials: &Materials, previous: Option<&Synth>) -> Result<Synth, Problem> {
    let textures = textures(scene, materials, previous)?;
    synth_at(scene, Making { textures: &textures, ..making(scene, materials) }, previous)
}

/// As [`synth`], for data passes alone.
///
/// # Errors
/// As [`synth`].
pub fn unpainted(scene: &Scene, materials: &Materials) -> Result<Synth, Problem> {
    let textures = textures(scene, materials, None)?;
    synth_at(scene, Making { textures: &textures, painted: false, ..making(scene, materials) }, None)
}

/// As [`synth`], for n x n places spread evenly over each pixel; [`cpu::frames`] averages their frames.
///
/// # Errors
/// As [`synth`].
pub fn samples(scene: &Scene, materials: &Materials, n: u32) -> Result<Vec<Synth>, Problem> {
    let textures = textures(scene, materials, None)?;
    let mut made: Vec<Synth> = Vec::new();
    for place in places(n) {
        let making = Making { place, textures: &textures, ..making(scene, materials) };
        made.push(synth_at(scene, making, made.first())?);
    }
    Ok(made)
}

/// The places of the n x n samples in a pixel.
fn places(n: u32) -> impl Iterator<Item = Vec2> {
    let place = move |k: u32| (f64::from(k) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Vec2::new(place(k % n), place(k / n)))
}

fn no_layers() -> Problem {
    Problem::error("/layers", "a scene without layers has nothing to show").hint("add a layer")
}

/// What the layers of a scene are made with, at the center of each pixel and without layers as textures.
pub fn making<'a>(scene: &Scene, materials: &'a Materials) -> Making<'a> {
    let Timeline { wrap, duration, .. } = scene.timeline;
    let size_px = frame_size(scene, materials);
    let px_per_m = scene.camera.as_ref().map_or(1.0, |camera| camera.px_per_m(size_px));
    Making { duration, size_px, px_per_m, ..Making::plain(wrap, materials) }
}

fn synth_at(scene: &Scene, making: Making, previous: Option<&Synth>) -> Result<Synth, Problem> {
    let Making { materials, textures, .. } = making;
    let ready = |(i, layer): (usize, &Layer)| {
        if let Some(texture) = textures.get(layer.technique().name()) {
            return Ok(texture.layer.clone());
        }
        let before = previous.and_then(|synth| synth.layers.get(i)).map(|before| &**before);
        layer.technique().synth(&making, before).map_err(|problem| problem.under(&format!("/layers/{i}")))
    };
    let layers = scene.layers.iter().enumerate().map(ready).collect::<Result<Vec<_>, _>>()?;
    let (size, stage, stop) = (frame_size(scene, materials), Arc::new(Stage::of(scene)), materials.stop.clone());
    Ok(Synth { size, layers, stage, stop, kept: LastMade::default() })
}

/// The layers that others show as textures. What they have in common with `previous` is reused.
///
/// # Errors
/// As [`synth`]; if there is no layer at all.
fn textures(scene: &Scene, materials: &Materials, previous: Option<&Synth>) -> Result<Textures, Problem> {
    if scene.layers.is_empty() {
        return Err(no_layers());
    }
    let mut made = Textures::new();
    let mut left: Vec<usize> = scene.textures().into_iter().collect();
    // Those that show others come after them; a scene has no circles.
    while let Some(next) = left.iter().position(|&i| scene.shown_by(i).iter().all(|(shown, _)| !left.contains(shown))) {
        let i = left.swap_remove(next);
        let layer = scene.layers[i].technique();
        let making = Making { textures: &made, ..making(scene, materials) };
        let before = previous.and_then(|synth| synth.layers.get(i)).map(|before| &**before);
        let ready = layer.synth(&making, before).map_err(|problem| problem.under(&format!("/layers/{i}")))?;
        let picture = layer.frame_of().and_then(|name| materials.pictures.get(name));
        let size_px = picture.map_or_else(|| frame_size(scene, materials), |own| (own.width(), own.height()));
        made.insert(layer.name().to_owned(), Texture { layer: ready, size_px });
    }
    Ok(made)
}

/// How far all layers in space reach along each of these ways of the world, at so many times of the timeline.
pub fn reach(layers: &[Arc<dyn Ready>], times: u32, ways: &[DVec3]) -> Option<Vec<f64>> {
    let times = (0..times).map(|k| f64::from(k) / f64::from(times));
    times.filter_map(|t| reach_at(layers, t, ways)).reduce(farther)
}

/// The same at one scene time.
pub fn reach_at(layers: &[Arc<dyn Ready>], t: f64, ways: &[DVec3]) -> Option<Vec<f64>> {
    layers.iter().filter_map(|layer| layer.reach(t, ways)).reduce(farther)
}
