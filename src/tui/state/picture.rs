//! The picture: which part of it shows, and what the threads have made of the scene.

use std::sync::Arc;

use kurbo::{Point, Vec2};

use crate::render::Synth;
use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::viewport::Viewport;
use crate::tui::graphics::{Graphics, TerminalPicture};

/// The picture and its read-out; what the threads have made is old while they work on.
#[derive(Clone)]
pub struct Picture {
    /// The cursor, in pixels of the picture; on the center of a pixel unless a number has set it.
    pub cursor: Point,
    /// Which part is visible.
    pub viewport: Viewport,
    /// Width and height of the picture, once known.
    pub size: Option<(usize, usize)>,
    /// What pictures the terminal takes.
    pub graphics: Graphics,
    /// The picture that the worker made last.
    pub latest: Option<Arc<TerminalPicture>>,
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
    /// Nothing made yet, the cursor at a place, all of the picture visible.
    pub fn new(cursor: Point) -> Picture {
        Picture {
            cursor,
            viewport: Viewport { zoom: None, center: cursor },
            size: None,
            graphics: Graphics::default(),
            latest: None,
            probing: false,
            probed: None,
            synthesising: false,
            synth: None,
            synth_ms: None,
            longest: Vec::new(),
        }
    }

    /// Moves the cursor, within the picture if its size is known.
    pub fn step(&mut self, by: Vec2) {
        let moved = self.cursor + by;
        let (w, h) = self.size.map_or((1e6, 1e6), |(w, h)| (w as f64, h as f64));
        self.cursor = Point::new(moved.x.clamp(0.5, (w - 0.5).max(0.5)), moved.y.clamp(0.5, (h - 0.5).max(0.5)));
    }
}
