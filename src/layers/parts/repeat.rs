//! What happens when time starts over: at the seam of a loop, and at the end of every pass before that.

use kurbo::Rect;

/// How close to a jump it is evaluated, in timelines.
pub const BESIDE: f64 = 1e-7;

/// Something in a layer that jumps because time starts over.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// What jumps, relative to the layer.
    pub path: String,
    /// Where it is seen, in pixels of the frame.
    pub bounds: Rect,
    /// The scene time at which it happens; 1 is the seam.
    pub time: f64,
    /// What happens, in words: "s jumps from 1 to 0".
    pub what: String,
    /// What would fix it on its own.
    pub cure: String,
    /// Whether repeating the timeline alone would close the loop.
    pub needs_time_alone: bool,
}

/// How a layer repeats.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repeat {
    /// What jumps.
    pub snaps: Vec<Snap>,
    /// The speeds, in passes per timeline, of everything whose passes end as they begin: the loop closes if all of them
    /// are whole numbers.
    pub speeds: Vec<f64>,
}
