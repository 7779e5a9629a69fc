//! Anchors: made by tools, spread by interpolations.

use kurbo::{Point, Vec2};

/// A place with a given jump vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Position in image pixels.
    pub at: Point,
    /// Jump vector in pixels.
    pub jump: Vec2,
    /// Index of the tool that made it, in the zone's motion.
    pub tool: usize,
}
