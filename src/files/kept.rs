//! What the editor and the window keep from one session to the next: each has one small file in the user's state folder. It is a
//! convenience: where it cannot be read or written, nothing is kept.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{paths, write};
use crate::base::system::folders;

/// A longer file is not ours.
const MOST_BYTES: u64 = 4 << 20;

/// The editor's file.
pub const EDITOR: &str = "editor.json";
/// That of the windows.
pub const WINDOWS: &str = "windows.json";

fn place(file: &str) -> Option<PathBuf> {
    Some(folders::state()?.join(file))
}

/// What was kept last in this file; `null` if there is nothing.
pub fn read(file: &str) -> Value {
    place(file).map(|path| read_from(&path)).unwrap_or_default()
}

fn read_from(path: &Path) -> Value {
    let bytes = paths::read(path, MOST_BYTES).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}

/// Keeps this in this file.
pub fn write(file: &str, kept: &Value) {
    let Some(path) = place(file) else { return };
    let written =
        std::fs::create_dir_all(super::disk::folder_of(&path)).map_err(|error| write::failed(path.display(), &error));
    if let Err(error) = written.and_then(|()| write::write_atomic(&path, kept.to_string().as_bytes())) {
        tracing::warn!("{error}");
    }
}
