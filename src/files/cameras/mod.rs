//! Lists of pictures with the cameras that took them, as programs write them that find cameras or render pictures.

mod colmap;
mod list;
mod ours;
mod transforms;

pub use list::{Cameras, Reading};

use list::text_of;

use std::path::Path;

use serde_json::Value;

use crate::base::error::{Error, Result};
use crate::scene::json;

/// Reads a list: `cameras.json`, `transforms.json`, or a text model of COLMAP, as a folder or one of its two files.
///
/// # Errors
/// If it is none of these, is broken, or its cameras are not pinholes.
pub fn read(path: &Path, reading: &Reading) -> Result<Cameras> {
    if path.is_dir() || path.file_name().is_some_and(|name| name == colmap::IMAGES || name == colmap::CAMERAS) {
        return colmap::read(path, reading);
    }
    if path.extension().is_some_and(|end| end == "bin") {
        return Err(colmap::binary(path));
    }
    let text = text_of(path, reading, "a list of cameras is a JSON file")?;
    let unknown = || {
        let error = Error::at(path.display(), "is no list of cameras that is known");
        error.cure("cameras.json, transforms.json, or the folder of a COLMAP text model")
    };
    let list = json::parse(&text)
        .map_err(|problem| if text.starts_with('{') { Error::at(path.display(), problem) } else { unknown() })?;
    if list.get("views").is_some_and(Value::is_array) {
        ours::read(path, &list, reading)
    } else if list.get("frames").is_some_and(Value::is_array) {
        transforms::read(path, &list, reading)
    } else {
        Err(unknown())
    }
}

#[cfg(test)]
mod tests;
