//! The bytes that a mesh is read from.

use std::fs::File;
use std::io::{Read, Seek};

use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::files::Limits;
use crate::files::limits::within;

/// Opens a file that a mesh names, by a path relative to it, if the scene may read it.
pub type Opener<'a> = &'a dyn Fn(&str) -> Result<File>;

/// How many first bytes tell the kind of a file: an OBJ may begin with a long comment.
const LOOKED_AT: u64 = 64 << 10;

/// The first bytes of an open file, which stays where it was: at its beginning.
pub(super) fn start(mut file: &File, place: &str) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = file.take(LOOKED_AT).read_to_end(&mut bytes).and_then(|_| file.rewind());
    read.map_err(|error| Error::at(place, error))?;
    Ok(bytes)
}

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

/// What is said of a file that would be text, and has bytes that no text has.
pub(super) fn not_text(place: &str) -> Error {
    Error::at(place, "is not text: it holds NUL bytes").cure("copy it again from where it came, or export it again")
}

/// A text without its byte order mark.
pub(super) fn text(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
