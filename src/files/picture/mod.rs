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

mod color;
mod conversion;
mod decoded;
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

pub use decoded::Loaded;
pub(super) use exr::vectors;
pub(super) use png::words;

use decoded::Undecoded;
use kinds::Kind;

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
    fits(upright::size(opened.size, opened.orientation))?;
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
    Ok(upright::size(opened.size, opened.orientation))
}

fn open(file: File, place: &str, limits: &Limits) -> Result<Undecoded> {
    let failed = |error| Error::at(place, error);
    let mut file = match paths::image_of(place) {
        Some(image) => mesh::embedded(file, place, image, limits)?,
        None => file,
    };
    let mut start = Vec::new();
    (&mut file).take(kinds::LOOKED_AT).read_to_end(&mut start).map_err(failed)?;
    let length = file.seek(SeekFrom::End(0)).map_err(failed)?;
    let kind = kinds::kind(&start, &mut file, place).map_err(|unknown| match mesh::instead(&start, place) {
        Some([what, cure]) => Error::at(place, format!("is {what}, not a picture")).cure(cure),
        None => unknown,
    })?;
    file.rewind().map_err(failed)?;
    match kind {
        Kind::Png => png::open(file, place, limits),
        Kind::Jpeg => jpeg::open(file, length, place, limits),
        Kind::Tiff => tiff::open(file, place, limits),
        Kind::Exr => exr::open(file, place, limits),
        Kind::Plain(format) => plain::open(std::io::BufReader::new(file), format, place, limits),
    }
}
