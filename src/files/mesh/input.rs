//! The bytes that a mesh is read from.

use std::fs::File;
use std::io::Read;

use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::files::Limits;
use crate::files::limits::within;

/// Opens a file that a mesh names, by a path relative to it, if the scene may read it.
pub type Opener<'a> = &'a dyn Fn(&str) -> Result<File>;

/// All of an open file, if it is within the limit, and the memory that it takes.
pub(super) fn whole(file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(Vec<u8>, Share)> {
    let length = file.metadata().map_err(|error| Error::at(place, error))?.len();
    within(place, "has", "bytes", "mesh", length, limits.mesh)?;
    let share = budget.take(length, place)?;
    let mut bytes = Vec::with_capacity(length as usize);
    // One that grows meanwhile is read as long as it was.
    file.take(length).read_to_end(&mut bytes).map_err(|error| Error::at(place, error))?;
    Ok((bytes, share))
}

/// A text without its byte order mark.
pub(super) fn text(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
