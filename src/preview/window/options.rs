//! How a window opens and behaves, and what messages call it.

use std::path::PathBuf;

/// How a window opens and behaves.
pub struct WindowOptions {
    /// What the scene is called.
    pub name: String,
    /// The beginning of the names of its screenshots.
    pub screenshots: PathBuf,
    /// The largest side of a picture that is given to the GPU, in pixels.
    pub most: usize,
    /// Whether it takes the keyboard when it opens, as a window does that somebody asked for.
    pub takes_keyboard: bool,
    /// Whether what is wrong is said on standard error too, as long as there is no picture.
    pub complains: bool,
}

/// What messages call the window.
pub const PLACE: &str = "window";
