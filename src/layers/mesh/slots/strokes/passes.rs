//! What strokes are made from, as pictures of numbers.

use crate::layers::parts::pass::{Holds, Pass};

/// All of them.
pub const PASSES: &[Pass] = &[NOISE, TONE, INK];

/// A noise.
pub const NOISE: Pass = Pass {
    name: "noise",
    help: "a noise of strokes, as noise:NAME or that of the first mark: its value, its variance there; 0 where none is",
    holds: Holds::Noise,
};
/// The tone.
pub const TONE: Pass =
    Pass { name: "tone", help: "the tone that strokes draw: 0 is dark, 1 is light", holds: Holds::Share };
/// The ink.
pub const INK: Pass = Pass { name: "ink", help: "how much ink of strokes covers a pixel: 0 to 1", holds: Holds::Share };
