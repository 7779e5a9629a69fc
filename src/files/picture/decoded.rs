//! What is read of a picture's file: first its header, then its samples as they are.

use super::conversion;
use crate::base::error::Result;
use crate::base::picture::Picture;

/// A picture, and what in its file could not be honoured, in words.
#[derive(Debug)]
pub struct Loaded {
    /// The picture, upright.
    pub picture: Picture,
    /// Each completes a message that begins with the file, as "its color profile is broken and was not applied".
    pub notes: Vec<String>,
}

/// A file whose header has been read and is within the limits.
pub(super) struct Undecoded {
    /// Width and height as in the file, not turned.
    pub(super) size: (usize, usize),
    /// The orientation by EXIF, 1 to 8.
    pub(super) orientation: u8,
    /// The most bytes that decoding takes.
    pub(super) bytes: u64,
    pub(super) decode: Box<dyn FnOnce() -> Result<Decoded>>,
}

/// Samples as decoded, and what the file says about their color.
pub(super) struct Decoded {
    pub(super) size: (usize, usize),
    pub(super) model: Model,
    pub(super) samples: Raw,
    pub(super) color: Color,
    pub(super) notes: Vec<String>,
}

impl Decoded {
    /// Bytes needed in addition to the samples while they are turned or converted.
    pub(super) fn takes_beside(&self, orientation: u8) -> u64 {
        let turned = if orientation > 1 { self.samples.bytes() } else { 0 };
        let words = matches!(self.color, Color::Icc(_)) || matches!(self.model, Model::Cmyk | Model::Lab);
        let pixels = self.size.0 as u64 * self.size.1 as u64;
        turned.max(if words { pixels * 8 } else { 0 })
    }
}

/// What the samples of a pixel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Model {
    Grey,
    GreyAlpha,
    Rgb,
    Rgba,
    /// Inks; 0 is none.
    Cmyk,
    /// CIE L*a*b*; zero of a and b is the middle code.
    Lab,
}

impl Model {
    pub(super) fn count(self) -> usize {
        match self {
            Model::Grey => 1,
            Model::GreyAlpha => 2,
            Model::Rgb | Model::Lab => 3,
            Model::Rgba | Model::Cmyk => 4,
        }
    }

    /// The index of the alpha sample.
    pub(super) fn alpha(self) -> Option<usize> {
        matches!(self, Model::GreyAlpha | Model::Rgba).then(|| self.count() - 1)
    }

    pub(super) fn of(count: usize) -> Option<Model> {
        [Model::Grey, Model::GreyAlpha, Model::Rgb, Model::Rgba].into_iter().find(|model| model.count() == count)
    }
}

/// Samples row by row. Integers have straight alpha; the others are linear and premultiplied.
#[derive(Clone, Debug)]
pub(super) enum Raw {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    /// Bits of half floats.
    Halves(Vec<u16>),
    Floats(Vec<f32>),
}

impl Raw {
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Raw::Bytes(all) => all.len() as u64,
            Raw::Words(all) | Raw::Halves(all) => all.len() as u64 * 2,
            Raw::Floats(all) => all.len() as u64 * 4,
        }
    }
}

/// What a file says about the color of its integer samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Color {
    Untagged,
    Icc(Vec<u8>),
    Spoken(conversion::Spoken),
}
