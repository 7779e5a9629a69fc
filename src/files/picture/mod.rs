//! Pictures from files, kept as they were read. The header is read first and checked against the limits, so that a huge
//! picture is refused before memory is taken for it.
//!
//! 8 and 16 bits per channel are sRGB with straight alpha unless the file says otherwise; floating point (OpenEXR, HDR,
//! TIFF) is linear light, with premultiplied alpha. Color profiles are applied (`color.rs`); what cannot be applied is
//! reported. A photograph is turned upright by its EXIF orientation, as in every viewer. Of an animation, the first
//! frame is read.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::{Limits, mesh, paths};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::picture::Picture;

mod color;
mod conversion;
mod exr;
mod icc;
mod ifd;
mod jpeg;
pub(super) mod kinds;
mod limits;
mod plain;
mod png;
#[cfg(test)]
mod tests;
mod tiff;
mod upright;

pub(super) use exr::vectors;
pub(super) use png::words;

use kinds::Kind;

/// A picture, and what in its file could not be honoured, in words.
#[derive(Debug)]
pub struct Loaded {
    /// The picture, upright.
    pub picture: Picture,
    /// Each completes a message that begins with the file, as "its color profile is broken and was not applied".
    pub notes: Vec<String>,
}

/// A file whose header has been read and is within the limits.
struct Opened {
    /// Width and height as in the file, not turned.
    size: (usize, usize),
    /// The orientation by EXIF, 1 to 8.
    orientation: u8,
    /// The most bytes that decoding takes.
    bytes: u64,
    decode: Box<dyn FnOnce() -> Result<Decoded>>,
}

impl Opened {
    fn upright(&self) -> (usize, usize) {
        upright::size(self.size, self.orientation)
    }
}

/// Samples as decoded, and what the file says about their color.
struct Decoded {
    size: (usize, usize),
    model: Model,
    samples: Raw,
    color: Color,
    notes: Vec<String>,
}

impl Decoded {
    /// Bytes needed in addition to the samples while they are turned or converted.
    fn takes_beside(&self, orientation: u8) -> u64 {
        let turned = if orientation > 1 { self.samples.bytes() } else { 0 };
        let words = matches!(self.color, Color::Icc(_)) || matches!(self.model, Model::Cmyk | Model::Lab);
        let pixels = self.size.0 as u64 * self.size.1 as u64;
        turned.max(if words { pixels * 8 } else { 0 })
    }
}

/// What the samples of a pixel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Model {
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
    fn count(self) -> usize {
        match self {
            Model::Grey => 1,
            Model::GreyAlpha => 2,
            Model::Rgb | Model::Lab => 3,
            Model::Rgba | Model::Cmyk => 4,
        }
    }

    /// The index of the alpha sample.
    fn alpha(self) -> Option<usize> {
        matches!(self, Model::GreyAlpha | Model::Rgba).then(|| self.count() - 1)
    }

    fn of(count: usize) -> Option<Model> {
        [Model::Grey, Model::GreyAlpha, Model::Rgb, Model::Rgba].into_iter().find(|model| model.count() == count)
    }
}

/// Samples row by row. Integers have straight alpha; the others are linear and premultiplied.
#[derive(Clone, Debug)]
enum Raw {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    /// Bits of half floats.
    Halves(Vec<u16>),
    Floats(Vec<f32>),
}

impl Raw {
    fn bytes(&self) -> u64 {
        match self {
            Raw::Bytes(all) => all.len() as u64,
            Raw::Words(all) | Raw::Halves(all) => all.len() as u64 * 2,
            Raw::Floats(all) => all.len() as u64 * 4,
        }
    }
}

/// What a file says about the color of its integer samples.
#[derive(Clone, Debug, PartialEq)]
enum Color {
    Untagged,
    Icc(Vec<u8>),
    Spoken(conversion::Spoken),
}

/// Reads the picture at `path` (`a.exr#beauty` is a layer of it, `a.glb#0` a picture in it), within the limits.
///
/// # Errors
/// If it cannot be opened, is no picture, is broken, or is larger than the limits allow.
pub fn read(path: &Path, limits: &Limits) -> Result<Loaded> {
    decode(paths::open_picture(path)?, &path.display().to_string(), limits, &limits.budget()).map(|(found, _)| found)
}

/// Width and height of the picture at `path`, as [`read`] would return it; only the header is read.
///
/// # Errors
/// As [`read`], as far as the header shows.
pub fn size(path: &Path, limits: &Limits) -> Result<(usize, usize)> {
    header(paths::open_picture(path)?, &path.display().to_string(), limits)
}

/// Whether the file at `path` begins as a picture does that can be read.
pub fn is_one(path: &Path) -> bool {
    let mut start = Vec::new();
    let Ok(mut file) = paths::open_picture(path) else { return false };
    let read = (&mut file).take(kinds::LOOKED_AT).read_to_end(&mut start);
    read.is_ok() && kinds::kind(&start, &mut file, &path.display().to_string()).is_ok()
}

/// The picture in an open file and the memory that it takes; `place` is its name in messages.
///
/// # Errors
/// As [`read`].
pub fn decode(file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(Loaded, Share)> {
    decode_if(file, place, limits, budget, |_| Ok(()))
}

/// As [`decode`], if the picture's width and height will do.
///
/// # Errors
/// As [`decode`], and those of `fits`.
pub fn decode_if(
    file: File,
    place: &str,
    limits: &Limits,
    budget: &Budget,
    fits: impl Fn((usize, usize)) -> Result<()>,
) -> Result<(Loaded, Share)> {
    let opened = open(file, place, limits)?;
    fits(opened.upright())?;
    let mut share = budget.take(opened.bytes, place)?;
    let orientation = opened.orientation;
    let mut decoded = (opened.decode)()?;
    let _beside = budget.take(decoded.takes_beside(orientation), place)?;
    decoded.size = upright::turn(&mut decoded.samples, decoded.model.count(), decoded.size, orientation);
    let found = color::apply(decoded).ok_or_else(|| Error::at(place, "has a kind of pixels that is not known"))?;
    share.shrink(found.picture.bytes());
    Ok((found, share))
}

/// Width and height of the picture in an open file, upright.
///
/// # Errors
/// As [`size`].
pub fn header(file: File, place: &str, limits: &Limits) -> Result<(usize, usize)> {
    let opened = open(file, place, limits)?;
    let _none_is_kept = limits.budget().take(opened.bytes, place)?;
    Ok(opened.upright())
}

fn open(file: File, place: &str, limits: &Limits) -> Result<Opened> {
    let failed = |error| Error::at(place, error);
    let mut file = match paths::image_of(place) {
        Some(image) => mesh::embedded(file, place, image, limits)?,
        None => file,
    };
    let mut start = Vec::new();
    (&mut file).take(kinds::LOOKED_AT).read_to_end(&mut start).map_err(failed)?;
    let length = file.seek(SeekFrom::End(0)).map_err(failed)?;
    let kind = kinds::kind(&start, &mut file, place)?;
    file.rewind().map_err(failed)?;
    match kind {
        Kind::Png => png::open(file, place, limits),
        Kind::Jpeg => jpeg::open(file, length, place, limits),
        Kind::Tiff => tiff::open(file, place, limits),
        Kind::Exr => exr::open(file, place, limits),
        Kind::Plain(format) => plain::open(std::io::BufReader::new(file), format, place, limits),
    }
}
