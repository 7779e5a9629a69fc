//! What the worker finds out about a pixel, and about the fields of a scene.

use super::request::ProbeAt;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::Space;
use crate::layers::parts::readout::ReadOut;
use crate::render::{Synth, cpu, passes};
use crate::scene::Scene;

/// What one pixel does.
#[derive(Clone, Debug, PartialEq)]
pub struct Probed {
    /// Which pixel, and when.
    pub at: ProbeAt,
    /// What it does; `None` if its layer has nothing to say.
    pub read: Option<ReadOut>,
    /// The color that the frame shows there: sRGB, straight alpha.
    pub color: [u8; 4],
}

impl Probed {
    /// The answer, as `plica probe` has it; `None` if there is no such pixel.
    pub fn new(at: ProbeAt, scene: &Scene, synth: &Synth, materials: &Materials) -> Option<Probed> {
        let moment = synth.moment(at.time);
        let making = crate::render::making(scene, materials);
        let look = |layer: usize| {
            let ready = synth.layers.get(layer).map(|ready| &**ready);
            scene.layers.get(layer)?.technique().probe(&making, ready, at.pixel, &moment).ok()
        };
        let in_space = scene.layers.get(at.layer)?.technique().kind().space == Space::World;
        // In space, what hides the others is meant; but sprites hide nothing.
        let own = synth.layers.get(at.layer).filter(|layer| layer.has_sprites()).and_then(|_| look(at.layer)?);
        let read = match own.filter(ReadOut::is_of_something) {
            Some(own) => Some(own),
            None => {
                let seen = in_space.then(|| passes::topmost(synth, at.time, at.pixel)).flatten();
                look(seen.unwrap_or(at.layer))?
            }
        };
        let color = cpu::color_at(synth, at.time, at.pixel);
        Some(Probed { at, read, color: color.unwrap_or_default() })
    }
}

/// The longest vector of every field, in pixels, by its pointer.
pub fn longest(synth: &Synth) -> Vec<(String, f64)> {
    let layers = synth.layers.iter().enumerate();
    let fields = layers.flat_map(|(i, layer)| layer.fields().into_iter().map(move |field| (i, field)));
    fields.map(|(i, field)| (format!("/layers/{i}{}", field.path), field.longest())).collect()
}
