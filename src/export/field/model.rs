//! What a plot is, and an arrow in it.

use kurbo::{Point, Rect, Vec2};

use super::strokes::PlotMark;
use crate::base::pixels::Frame;
use crate::layers::parts::readout::vector;

/// A plot of a vector field.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Width in pixels.
    pub width: f64,
    /// Height in pixels.
    pub height: f64,
    /// The picture beneath, faint: what it shows and the part of the plot it fills.
    pub picture: Option<(Frame, Rect)>,
    /// What is drawn over it, from below to above.
    pub marks: Vec<PlotMark>,
    /// What it shows, in words.
    pub title: String,
}

/// How opaque the picture beneath is.
pub const FAINT: f64 = 0.3;

/// A jump vector at the center of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// The center of the pixel.
    pub at: Point,
    /// Its jump vector, in pixels of the image.
    pub jump: [f32; 2],
}

impl Arrow {
    /// The vector, in pixels of the image.
    pub(super) fn vector(&self) -> Vec2 {
        vector(self.jump)
    }
}
