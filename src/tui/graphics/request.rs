//! What the panes want from the worker.

use std::path::PathBuf;
use std::sync::Arc;

use super::protocol::Wanted;
use crate::render::passes::Asked;
use crate::render::shown::Shown;
use crate::scene::Scene;

/// What the worker is to make for the panes.
#[derive(Clone)]
pub struct Request {
    /// The scene.
    pub scene: Arc<Scene>,
    /// How it is shown.
    pub how: Shown,
    /// The scene's file; its pictures are relative to it.
    pub path: PathBuf,
    /// Scene time.
    pub time: f64,
    /// Whether files may have changed since the last request.
    pub fresh: bool,
    /// The picture; `None` if there is no room for it.
    pub picture: Option<Wanted>,
    /// The pixel whose read-out is open, if it is.
    pub probe: Option<ProbeAt>,
    /// The pass whose numbers are counted, if a curve over it is shown.
    pub counts: Option<CountAt>,
}

impl PartialEq for Request {
    /// Whether both ask for the same; `fresh` does not count.
    fn eq(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.how == other.how
            && self.path == other.path
            && self.time == other.time
            && self.picture == other.picture
            && self.probe == other.probe
            && self.counts == other.counts
    }
}

/// A pixel to be probed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeAt {
    /// The layer.
    pub layer: usize,
    /// Column and row.
    pub pixel: (usize, usize),
    /// Scene time.
    pub time: f64,
}

/// A pass of a frame whose numbers are counted.
#[derive(Clone, Debug, PartialEq)]
pub struct CountAt {
    /// The pass.
    pub of: Asked,
    /// Scene time.
    pub time: f64,
}
