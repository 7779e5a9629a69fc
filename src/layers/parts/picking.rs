//! A clip from which a layer's pictures are picked: what a person sees of it.

use std::sync::Arc;

use super::marks::Mark;
use crate::base::picture::Picture;

/// What is looked at while pictures are picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
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

/// Where in a layer what is picked from a clip is written; JSON pointers relative to the layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picks {
    /// The node from which one looks at the clip.
    pub node: &'static str,
    /// The list of what is picked.
    pub list: &'static str,
    /// The field of an item with the frame that it is picked from.
    pub frame: &'static str,
    /// That with its place in the frame.
    pub at: &'static str,
    /// That which says whether it is followed through the clip; it is, if that is not written.
    pub track: &'static str,
    /// That with its kind.
    pub kind: &'static str,
    /// The kinds by the words with which they are added, that of most things first.
    pub kinds: &'static [(&'static str, &'static str)],
}
