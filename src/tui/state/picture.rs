//! The picture: which part of it shows, and what the threads have made of the scene.

use std::sync::Arc;

use crate::render::Synth;
use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::sight::Placing;
use crate::tui::graphics::{Graphics, Shown};

/// The picture and its read-out; what the threads have made is old while they work on.
#[derive(Clone)]
pub struct Picture {
    /// The cursor and zoom of the picture.
    pub placing: Placing,
    /// Width and height of the picture, once known.
    pub size: Option<(usize, usize)>,
    /// What pictures the terminal takes.
    pub graphics: Graphics,
    /// The picture that the worker made last.
    pub shown: Option<Arc<Shown>>,
    /// Whether the read-out of the pixel under the cursor is open.
    pub probing: bool,
    /// What the worker said about a pixel last.
    pub probed: Option<Arc<Probed>>,
    /// Whether the worker synthesises.
    pub synthesising: bool,
    /// What a frame needs.
    pub synth: Option<Arc<Synth>>,
    /// How long the last synthesis took.
    pub synth_ms: Option<f64>,
    /// The longest vector of every field, by its pointer.
    pub longest: Vec<(String, f64)>,
}

impl Picture {
    /// Nothing made yet, all of it in sight.
    pub fn new(placing: Placing) -> Picture {
        Picture {
            placing,
            size: None,
            graphics: Graphics::default(),
            shown: None,
            probing: false,
            probed: None,
            synthesising: false,
            synth: None,
            synth_ms: None,
            longest: Vec::new(),
        }
    }

    /// Moves the cursor, within the picture if its size is known.
    pub fn step(&mut self, by: kurbo::Vec2) {
        self.placing.step(by, self.size);
    }
}
