//! The preview: the window in its own process, and the link that feeds it. The link needs no window and no display.

pub mod editor;
pub mod follow;
pub mod keys;
pub mod remote;
mod views;
#[cfg(feature = "window")]
pub mod window;
pub mod wire;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::base::error::Error;
use crate::base::problem::Problem;
use crate::scene::Scene;

/// How the animation runs: the same in the editor and all of its windows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transport {
    /// Whether it runs on from `time`.
    pub playing: bool,
    /// Scene time, in seconds.
    pub time: f64,
    /// Seconds of the scene a second.
    pub speed: f64,
}

impl Default for Transport {
    fn default() -> Self {
        Transport { playing: false, time: 0.0, speed: 1.0 }
    }
}

/// What is wrong, one by one, with the scene that messages call `scene`.
fn problems(error: Error, scene: &str) -> Vec<Problem> {
    match error {
        Error::Scene { problems, .. } => problems,
        Error::Failed { place, what, cure } => {
            let place = if place == scene { String::new() } else { place };
            let problem = Problem::error(place, what);
            vec![cure.into_iter().fold(problem, Problem::hint)]
        }
        other => vec![Problem::error("", other.to_string())],
    }
}

/// What reaches a window, from the editor that has the scene open or from the file.
#[derive(Clone, Debug)]
pub enum Update {
    /// The scene to show from now on. A window answers it with [`Reply::Shown`]; until then further edits are joined.
    Scene {
        /// The scene.
        scene: Arc<Scene>,
        /// Its revision in the editor; counted by loads where the file is followed.
        revision: u64,
    },
    /// JSON pointer of what is selected in the editor (`/layers/0/zones/2/motion/1`).
    Selection(Option<String>),
    /// Whether the animation runs, and where it is.
    Transport(Transport),
    /// An overlay or zoom command, by its name in the key table.
    View(String),
    /// How the scene is followed: a line for the person.
    Notice(String),
    /// How far something is that takes long: a line for the person. Empty: it is done.
    Progress(String),
    /// All that is wrong with what is followed: the scene cannot be read, the link was lost, ... Empty: all is well again.
    Problems(Vec<Problem>),
    /// The editor wants the window gone.
    Closed,
}

/// What a window tells its editor; goes nowhere where a file is followed.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// The scene of this revision is synthesised and shown.
    Shown {
        /// As in [`Update::Scene`].
        revision: u64,
        /// What the synthesis took, in milliseconds.
        synth_ms: f64,
    },
    /// How the window is doing.
    Report {
        /// Frames a second.
        fps: f64,
        /// The graphics adapter's name.
        adapter: String,
        /// One line for the editor's status, empty where all is well.
        notice: String,
    },
    /// The pointer stands here, in pixels of the picture.
    Pointer {
        /// From the left edge.
        x: f64,
        /// From the top edge.
        y: f64,
    },
    /// The animation was started or stopped in the window, or moved.
    Transport(Transport),
    /// A request by command name, from a key pressed in the window; only the editor edits.
    Command(String),
}
