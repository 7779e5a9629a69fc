//! A scene that is ready to be drawn, and the strokes of its overlay, which are made again only where something that they
//! show has changed.

use std::sync::Arc;

use kurbo::Size;

use super::camera::Camera;
use super::canvas::Canvas;
use super::marks;
use super::state::State;
use crate::layers::folding;
use crate::render::overlay::{View, field_scale, overlay};
use crate::render::{LayerSynth, Synth};
use crate::scene::Scene;

/// A scene, ready to be drawn.
pub struct Show {
    pub scene: Arc<Scene>,
    /// As large as the picture: for the overlay.
    pub synth: Synth,
    /// As large as the GPU can hold, moving and still.
    pub frames: Synth,
    pub still: Synth,
    /// Pixels of the frames a pixel of the picture.
    pub frame_scale: f64,
}

/// The overlay's strokes, and what they were made for.
#[derive(Default)]
pub struct Cached {
    pub made_for: Option<(View, Camera, Size, bool, u64)>,
    pub canvas: Canvas,
    pub arrow_scale: f64,
    pub revision: u64,
}

impl Cached {
    /// Makes the strokes again where anything that they show has changed.
    pub fn follow(&mut self, state: &State, show: &Show) {
        let key = (state.overlay_view(), state.camera.clone(), state.window, state.shown.grid, self.revision);
        if self.made_for.as_ref() == Some(&key) {
            return;
        }
        let found = overlay(&show.scene, Some(&show.synth), &key.0);
        self.canvas = Canvas::default();
        if state.shown.grid {
            marks::grid(&mut self.canvas, state.picture, &state.camera, state.area());
        }
        self.canvas.strokes.extend(marks::draw(&found, &state.camera, state.area(), state.scale).strokes);
        let scale = |spacing| show.synth.layers.iter().map(move |LayerSynth::Picture(l)| field_scale(l, spacing));
        self.arrow_scale = key.0.field.map_or(1.0, |spacing| scale(spacing).fold(1.0, f64::min));
        self.made_for = Some(key);
    }
}

/// The same picture, nothing moving.
pub fn still(synth: &Synth) -> Synth {
    let layers = synth.layers.iter().map(|LayerSynth::Picture(layer)| {
        LayerSynth::Picture(folding::synth::Synth { picture: layer.picture.clone(), zones: Vec::new() })
    });
    Synth { size: synth.size, layers: layers.collect() }
}
