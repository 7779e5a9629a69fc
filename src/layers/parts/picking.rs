//! A clip from which a layer's pictures are picked: what a person sees of it.

use std::sync::Arc;

use super::marks::Mark;
use crate::base::picture::Picture;

/// What is looked at while pictures are picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// A frame of the clip, by its number.
    Frame(usize),
    /// What is cut out of that frame, over black.
    Cut(usize),
    /// All that is cut out, one after the other.
    Sheet,
}

/// What there is to see.
#[derive(Clone, Debug)]
pub struct Picking {
    /// The picture.
    pub picture: Arc<Picture>,
    /// What is picked, and where it goes; paths are relative to the layer.
    pub marks: Vec<Mark>,
    /// How many frames the clip has.
    pub frames: usize,
    /// How many of them what is picked is followed through.
    pub followed: usize,
    /// The side of the square that is picked, in pixels.
    pub side: f64,
}

/// Where in a layer what is picked from a clip is written; JSON pointers relative to the layer. Items of the list have
/// `frame`, `at`, `kind` and `track`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picks {
    /// The node from which one looks at the clip.
    pub node: &'static str,
    /// The list of what is picked.
    pub list: &'static str,
}
