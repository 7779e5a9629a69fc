//! What a small drawing beside the form of something shows of it.

use super::pass::Pass;
use crate::base::pixels::Grid;

/// What a small drawing shows.
pub enum Sketch {
    /// A piece of a pattern.
    Patch(Patch),
    /// A curve from (0, 0) to (1, 1).
    Curve(Curve),
}

/// A piece of a pattern, as it is where it faces the eye.
pub struct Patch {
    /// Lengths that are drawn to scale beside it, in pixels of the picture: the first is how far strokes are apart.
    pub lengths_px: Vec<(&'static str, f64)>,
    /// Makes so many columns and rows of it, 0 (dark) to 1 (light), each so many pixels of the picture wide.
    pub make: Box<dyn Fn((usize, usize), f64) -> Grid<f32>>,
}

/// A curve from (0, 0) to (1, 1).
pub struct Curve {
    /// What it is of, and what it shows of that.
    pub axes: [&'static str; 2],
    /// Its height at a place from 0 to 1, which is from 0 to 1 too.
    pub value: Box<dyn Fn(f64) -> f64>,
    /// The pass of the layer that tells where on the curve each pixel of the frame is.
    pub over: &'static Pass,
}
