//! Loaded files, kept for as long as a scene names them.

use std::collections::HashMap;
use std::fs::File;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::Arc;

use crate::base::budget::Share;

/// Loaded files of one kind.
pub(super) type Store<T> = HashMap<PathBuf, Loaded<T>>;

/// A loaded file, and the memory that it takes.
#[derive(Debug)]
pub(super) struct Loaded<T> {
    pub(super) stamp: Stamp,
    /// The files that were read beside it: their paths, and what they were.
    pub(super) beside: Arc<[(String, Stamp)]>,
    pub(super) value: Arc<T>,
    /// What in the file could not be honoured, in words.
    pub(super) notes: Arc<[String]>,
    pub(super) share: Arc<Share>,
}

impl<T> Clone for Loaded<T> {
    fn clone(&self) -> Self {
        Loaded {
            stamp: self.stamp,
            beside: self.beside.clone(),
            value: self.value.clone(),
            notes: self.notes.clone(),
            share: self.share.clone(),
        }
    }
}

/// A file's identity and version; another program cannot change the file without changing this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::files) struct Stamp([i128; 5]);

impl Stamp {
    pub(in crate::files) fn of(file: &File) -> std::io::Result<Self> {
        let found = file.metadata()?;
        let nanos = |secs: i64, nanos: i64| i128::from(secs) * 1_000_000_000 + i128::from(nanos);
        Ok(Stamp([
            i128::from(found.dev()),
            i128::from(found.ino()),
            i128::from(found.len()),
            nanos(found.mtime(), found.mtime_nsec()),
            nanos(found.ctime(), found.ctime_nsec()),
        ]))
    }
}
