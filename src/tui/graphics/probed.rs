//! What the panes ask of the worker about the picture, and what it finds out about a pixel.

use std::path::PathBuf;
use std::sync::Arc;

use super::protocol::Wanted;
use crate::base::pixels::encode;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::readout::ReadOut;
use crate::layers::ready::Making;
use crate::render::{Synth, cpu};
use crate::scene::Scene;

/// A pixel that is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// The layer.
    pub layer: usize,
    /// Column and row.
    pub pixel: (usize, usize),
    /// Scene time.
    pub time: f64,
}

/// What one pixel does.
#[derive(Clone, Debug, PartialEq)]
pub struct Probed {
    /// What was asked.
    pub asked: Asked,
    /// What it does, if its layer tells.
    pub read: Option<ReadOut>,
    /// The color that the frame shows there: sRGB, straight alpha.
    pub color: [u8; 4],
}

impl Probed {
    /// The answer, as `plica probe` has it; `None` if there is no such pixel.
    pub fn new(asked: Asked, scene: &Scene, synth: &Synth, materials: &Materials) -> Option<Probed> {
        let layer = scene.layers.get(asked.layer)?.technique();
        let (x, y) = asked.pixel;
        let moment = synth.moment(asked.time);
        let read = layer.probe(&Making::plain(scene.timeline.wrap, materials), asked.pixel, &moment).ok()?;
        let within = x < synth.size.0 && y < synth.size.1;
        let color = within.then(|| encode(*cpu::lattice(synth, asked.time, &[x], &[y]).get(0, 0)));
        Some(Probed { asked, read, color: color.unwrap_or_default() })
    }
}

/// The longest vector of every field, in pixels, by its pointer.
pub fn longest(synth: &Synth) -> Vec<(String, f64)> {
    let layers = synth.layers.iter().enumerate();
    let fields = layers.flat_map(|(i, layer)| layer.fields().into_iter().map(move |field| (i, field)));
    fields.map(|(i, field)| (format!("/layers/{i}{}", field.path), field.longest())).collect()
}

/// What the panes want to show.
#[derive(Clone)]
pub struct Request {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its file, which its pictures are relative to.
    pub path: PathBuf,
    /// Scene time.
    pub time: f64,
    /// Whether files may have changed since the last time.
    pub fresh: bool,
    /// The picture, where there is room for it.
    pub picture: Option<Wanted>,
    /// The pixel whose read-out is open.
    pub probe: Option<Asked>,
}

impl PartialEq for Request {
    /// Whether the same is to be seen.
    fn eq(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.path == other.path
            && self.time == other.time
            && self.picture == other.picture
            && self.probe == other.probe
    }
}
