//! Synthesis: a picture layer and its materials to everything a frame needs except the time. A pure function.

use std::sync::Arc;

use kurbo::Vec2;

use super::position::Clock;
use crate::base::pixels::{Beyond, Grid, Picture};

/// What a frame of a picture layer needs except the time.
#[derive(Clone, Debug)]
pub struct Synth {
    /// The layer's own picture.
    pub picture: Arc<Picture>,
    /// The zones that reach into the picture, in the layer's order.
    pub zones: Vec<ZoneSynth>,
}

/// One zone, ready to be shown at any time.
#[derive(Clone, Debug)]
pub struct ZoneSynth {
    /// The zone's name.
    pub name: String,
    /// Its index in the layer.
    pub index: usize,
    /// Jump vectors and thresholds of its pixels; shared with earlier syntheses while its inputs stay the same.
    pub field: Arc<Field>,
    /// What samplers read.
    pub source: Source,
    /// When they read it.
    pub clock: Clock,
}

/// What the samplers of a zone read, and how it is laid on what is beneath.
#[derive(Clone, Debug)]
pub struct Source {
    /// The sampler image: the layer's own picture, a named one, or a mask.
    pub picture: Arc<Picture>,
    /// Added to where every sampler reads, in pixels.
    pub offset: Vec2,
    /// What a read beyond the edge gives.
    pub beyond: Beyond,
    /// Whether the read is laid over what is beneath (a named image or a mask) or takes its place (the layer's own).
    pub over: bool,
}

/// A fold rule by regions (folding.md, section 3); a mask needs none, it is a [`Source`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Inside a region a sampler waits at the edge where it entered.
    Cover,
    /// Still inside a region.
    Return,
    /// Still outside every region.
    FlyOver,
}

/// The pixels of a zone: membership, jump vectors, thresholds. Covers the outline's bounding box within the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Column of the box's first pixel in the picture.
    pub x0: usize,
    /// Row of the box's first pixel in the picture.
    pub y0: usize,
    /// Which pixels of the box belong to the zone.
    pub inside: Grid<bool>,
    /// Jump vectors in pixels; zero outside the zone.
    pub jumps: Grid<[f32; 2]>,
    /// Where paths meet the fold regions; none without regions.
    pub folds: Option<Folds>,
}

/// Where the paths of a zone's pixels meet the fold regions, over all s that the position function takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Folds {
    /// What the regions do.
    pub rule: Rule,
    /// Whether each pixel of the box is itself in a region (s = 0).
    pub inside: Grid<bool>,
    /// For pixel i of the box (row by row), `ahead[starts[i]..starts[i + 1]]` are its crossings with s >= 0, ascending.
    pub ahead: Ragged,
    /// The same for s <= 0, descending.
    pub behind: Ragged,
}

/// A list of numbers for every pixel of a box, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ragged {
    /// Where each pixel's numbers begin; one more than there are pixels.
    pub starts: Vec<u32>,
    /// The numbers.
    pub values: Vec<f64>,
}

impl Ragged {
    /// The numbers of pixel `i`.
    pub fn of(&self, i: usize) -> &[f64] {
        &self.values[self.starts[i] as usize..self.starts[i + 1] as usize]
    }
}
