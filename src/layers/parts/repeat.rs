//! What happens where time starts anew: at the seam of a loop, and wherever a pass ends before.

use kurbo::Rect;

/// How near to a jump it is looked at, in timelines.
pub const BESIDE: f64 = 1e-7;

/// Something of a layer that jumps because time starts anew.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// What jumps, relative to the layer.
    pub path: String,
    /// Where it is seen, in pixels of the frame.
    pub bounds: Rect,
    /// The scene time at which it happens; 1 is the seam.
    pub time: f64,
    /// How, in words: "s jumps from 1 to 0".
    pub what: String,
    /// What would mend it, by itself.
    pub cure: String,
    /// Whether more timelines, and nothing else, would close the loop.
    pub needs_time_alone: bool,
}

/// How a layer repeats.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repeat {
    /// What jumps.
    pub snaps: Vec<Snap>,
    /// Passes in a timeline of everything whose passes end as they begin: where all of them are whole numbers, it closes.
    pub speeds: Vec<f64>,
}
