//! What the panes want from the worker.

use std::path::PathBuf;
use std::sync::Arc;

use super::protocol::Wanted;
use crate::scene::Scene;

/// What the panes want to show.
#[derive(Clone)]
pub struct Request {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its file, which its pictures are relative to.
    pub path: PathBuf,
    /// Scene time.
    pub time: f64,
    /// Whether files may have changed since the last time.
    pub fresh: bool,
    /// The picture, where there is room for it.
    pub picture: Option<Wanted>,
    /// The pixel whose read-out is open.
    pub probe: Option<ProbeAt>,
}

impl PartialEq for Request {
    /// Whether the same is to be seen.
    fn eq(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.path == other.path
            && self.time == other.time
            && self.picture == other.picture
            && self.probe == other.probe
    }
}

/// A pixel that is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeAt {
    /// The layer.
    pub layer: usize,
    /// Column and row.
    pub pixel: (usize, usize),
    /// Scene time.
    pub time: f64,
}
