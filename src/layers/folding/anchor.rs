//! What tools give and interpolations spread.

use kurbo::{Point, Vec2};

/// A place whose jump vector is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Position in image pixels.
    pub at: Point,
    /// Jump vector in pixels.
    pub jump: Vec2,
    /// Index of the tool that gives it, in the zone's motion.
    pub tool: usize,
}
