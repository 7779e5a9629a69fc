//! What of a window comes back when the same scene is opened again: its size and place, what it shows of the picture, and the
//! background. Overlays belong to all windows of a scene; the editor keeps those.

use std::path::Path;

use kurbo::Point;
use serde::{Deserialize, Serialize};

use super::opened::OpenWindow;
use super::state::State;
use crate::files::kept::{self, WINDOWS};

/// The most scenes that are kept, those that were shown last.
const MOST_SCENES: usize = 100;

/// See the top of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// Width and height in physical pixels.
    pub size: Option<(u32, u32)>,
    /// Of the top-left corner on the desktop, in physical pixels, where the system tells.
    pub place: Option<(i32, i32)>,
    /// Zoom, and the place of the picture in the middle; `None` while the picture is fitted.
    pub view: Option<(f64, f64, f64)>,
    /// See [`State::background`].
    pub background: usize,
}

/// Windows by their scenes, the latest last.
type All = Vec<(String, Kept)>;

impl Kept {
    /// What was kept of the window of a scene.
    pub fn of(scene: &Path) -> Kept {
        let mut all: All = serde_json::from_value(kept::read(WINDOWS)).unwrap_or_default();
        let found = all.iter().position(|(own, _)| *own == name(scene));
        found.map(|at| all.swap_remove(at).1).unwrap_or_default()
    }

    /// Takes how a window is now; its size only while it is a window.
    pub fn take(&mut self, opened: &OpenWindow, state: &State) {
        if opened.window.fullscreen().is_none() {
            self.size = Some(opened.window.inner_size().into());
            self.place = opened.window.outer_position().ok().map(Into::into);
        }
        let Point { x, y } = state.viewport.center;
        self.view = (!state.viewport.is_fitted()).then_some((state.viewport.zoom, x, y));
        self.background = state.background;
    }

    /// Keeps it for the next window of a scene.
    pub fn keep(&self, scene: &Path) {
        let mut all: All = serde_json::from_value(kept::read(WINDOWS)).unwrap_or_default();
        all.retain(|(own, _)| *own != name(scene));
        all.push((name(scene), self.clone()));
        all.drain(..all.len().saturating_sub(MOST_SCENES));
        kept::write(WINDOWS, &serde_json::json!(all));
    }
}

/// What a scene is called among those that are kept.
fn name(scene: &Path) -> String {
    std::path::absolute(scene).unwrap_or_else(|_| scene.to_owned()).to_string_lossy().into_owned()
}
