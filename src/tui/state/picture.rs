//! The picture's part of the state.

use std::sync::Arc;

use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::{Graphics, Shown};

/// What there is to see.
#[derive(Clone, Debug, Default)]
pub struct Seeing {
    /// What pictures the terminal takes.
    pub graphics: Graphics,
    /// The picture that the worker made last.
    pub shown: Option<Arc<Shown>>,
    /// Whether the read-out of the pixel under the cursor is open.
    pub probing: bool,
    /// What the worker said about a pixel last.
    pub probed: Option<Arc<Probed>>,
    /// The longest vector of every field, by its pointer.
    pub longest: Vec<(String, f64)>,
    /// Whether the worker synthesises.
    pub synthesising: bool,
}
