//! What the editor keeps from one session to the next, whatever the scene: one small file in the user's state folder. It is a
//! convenience: where it cannot be read or written, nothing is kept.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{paths, write};
use crate::base::system::folders;

/// A longer file is not ours.
const MOST_BYTES: u64 = 4 << 20;

fn place() -> Option<PathBuf> {
    Some(folders::state()?.join("editor.json"))
}

/// What was kept last; `null` if there is nothing.
pub fn read() -> Value {
    place().map(|path| read_from(&path)).unwrap_or_default()
}

fn read_from(path: &Path) -> Value {
    let bytes = paths::read(path, MOST_BYTES).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}

/// Keeps this.
pub fn write(kept: &Value) {
    let Some(path) = place() else { return };
    let written =
        std::fs::create_dir_all(super::disk::folder_of(&path)).map_err(|error| write::failed(path.display(), &error));
    if let Err(error) = written.and_then(|()| write::write_atomic(&path, kept.to_string().as_bytes())) {
        tracing::warn!("{error}");
    }
}
