//! What the panes ask of the worker about the picture, and what it finds out about a pixel.

use std::path::PathBuf;
use std::sync::Arc;

use super::Wanted;
use crate::base::pixels::encode;
use crate::layers::Layer;
use crate::layers::folding::probe::{Probe, probe};
use crate::layers::folding::{self};
use crate::layers::parts::materials::Materials;
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
    /// What it does; none outside every zone.
    pub probe: Option<Probe>,
    /// The colour that the frame shows there: sRGB, straight alpha.
    pub colour: [u8; 4],
}

impl Probed {
    /// The answer, as `plica probe` has it; `None` if there is no such pixel.
    pub fn new(asked: Asked, scene: &Scene, synth: &Synth, materials: &Materials) -> Option<Probed> {
        let Layer::Picture(layer) = scene.layers.get(asked.layer)?;
        let (x, y) = asked.pixel;
        let probe = probe(layer, scene.timeline.wrap, materials, asked.pixel, asked.time).ok()?;
        let within = x < synth.size.0 && y < synth.size.1;
        let colour = within.then(|| encode(*cpu::lattice(synth, asked.time, &[x], &[y]).get(0, 0)));
        Some(Probed { asked, probe, colour: colour.unwrap_or_default() })
    }
}

/// The longest jump vector of every zone, in pixels.
pub fn longest(synth: &Synth) -> Vec<(usize, usize, f64)> {
    let mut all = Vec::new();
    for (i, layer) in synth.layers.iter().enumerate() {
        for zone in layer.downcast::<folding::synth::Synth>().iter().flat_map(|layer| &layer.zones) {
            let squares = zone.field.jumps.cells().iter().map(|&[x, y]| x * x + y * y);
            all.push((i, zone.index, f64::from(squares.fold(0.0, f32::max)).sqrt()));
        }
    }
    all
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
