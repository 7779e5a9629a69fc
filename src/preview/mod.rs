//! The preview: the window in its own process, and the link that feeds it. The link needs no window and no display.

pub mod editor;
pub mod follow;
pub mod keys;
pub mod remote;
pub mod views;
#[cfg(feature = "window")]
pub mod window;
pub mod wire;

use serde::{Deserialize, Serialize};

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
