//! Clips: moving pictures that a scene names, all frames of one size.

use std::sync::Arc;

use super::picture::Picture;

/// The frames of a clip, at least one.
#[derive(Clone, Debug)]
pub struct Clip {
    /// Frames a second.
    pub fps: f64,
    /// In the order of time, from the first that the scene takes.
    pub frames: Vec<Arc<Picture>>,
}

impl Clip {
    /// Width and height of its frames, in pixels.
    pub fn size_px(&self) -> (usize, usize) {
        self.frames.first().map_or((0, 0), |frame| (frame.width(), frame.height()))
    }
}
