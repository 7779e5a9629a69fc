//! What a frame is made from, as pictures of numbers.

/// A picture of what a frame is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Its name in commands.
    pub name: &'static str,
    /// What it shows.
    pub help: &'static str,
    /// What its numbers are.
    pub holds: Holds,
}

/// What the numbers of a pass are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// Light, premultiplied.
    Light,
    /// Coordinates of a vector.
    Vector,
    /// One number, in all three channels; the less, the nearer.
    Number,
    /// How many there are, in all three channels.
    Count,
    /// Three numbers, of which the last is shown as a color: from slow to fast.
    Speed,
    /// One number from 0 to 1, in all three channels.
    Share,
    /// Numbers that only mean something apart; this pass is looked at in place of it.
    Codes(&'static Pass),
    /// A number of mean 0 and variance 1, and what else is known of it.
    Noise,
}

/// A pass, and what of it: some are of things that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Which<'a> {
    /// The pass.
    pub pass: &'a Pass,
    /// The name of what it is of; `None` for the first.
    pub of: Option<&'a str>,
}

/// The finished frame.
pub static COLOR: Pass = Pass { name: "color", help: "the frame: linear light, premultiplied", holds: Holds::Light };
/// How far away the surface is.
pub static DEPTH: Pass =
    Pass { name: "depth", help: "distance along the view, in meters; 0 where nothing is", holds: Holds::Number };
/// How the surface is turned.
pub static NORMAL: Pass = Pass { name: "normal", help: "the normal in the world: x, y, z", holds: Holds::Vector };
/// Which triangle it is.
pub static UV: Pass = Pass {
    name: "uv",
    help: "texture coordinates, and the number of the triangle from 1; 0 where nothing is",
    holds: Holds::Vector,
};
/// Which layer it is.
pub static OBJECT: Pass = Pass {
    name: "object",
    help: "the number of the layer in the list, from 1; 0 where nothing is",
    holds: Holds::Number,
};
/// The surface before anything is drawn on it.
pub static SHADE: Pass =
    Pass { name: "shade", help: "the color of surfaces in their light, premultiplied", holds: Holds::Light };

/// The passes that all layers in space have.
pub static PASSES: [&Pass; 6] = [&COLOR, &DEPTH, &NORMAL, &UV, &OBJECT, &SHADE];
