//! Lists of pictures with the cameras that took them, as programs write them that find cameras or render pictures.

mod colmap;
mod ours;
mod transforms;

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::{Limits, paths, scene};
use crate::base::error::{Error, Result};
use crate::base::geometry::Xy;
use crate::layers::parts::shots::Shot;
use crate::scene::json;

/// What such a list holds.
#[derive(Debug, Default)]
pub struct Cameras {
    /// Pictures and their cameras, in the order of the list.
    pub shots: Vec<(PathBuf, Shot)>,
    /// The mesh that they show, if the list tells.
    pub mesh: Option<PathBuf>,
    /// What should be known about it, in words.
    pub notes: Vec<String>,
}

/// How a list is read.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The folder of the pictures, if that is not said by the list.
    pub images: Option<&'a Path>,
    /// Pictures that are for testing count too.
    pub all: bool,
    /// How large files may be.
    pub limits: &'a Limits,
}

/// Reads a list: `cameras.json`, `transforms.json`, or a text model of COLMAP, as a folder or its `images.txt`.
///
/// # Errors
/// If it is none of these, is broken, or its cameras are not pinholes.
pub fn read(path: &Path, reading: &Reading) -> Result<Cameras> {
    if path.is_dir() || path.file_name().is_some_and(|name| name == colmap::IMAGES) {
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

/// The text of a file, which is to be `what` it is.
fn text_of(path: &Path, reading: &Reading, what: &str) -> Result<String> {
    scene::text_of(&path.display().to_string(), paths::open_named(path)?, reading.limits, what)
}

/// An item of a list as JSON, and what it is called in messages.
struct Item<'a> {
    file: &'a Path,
    called: String,
    fields: &'a Map<String, Value>,
}

impl Item<'_> {
    fn error(&self, what: impl std::fmt::Display) -> Error {
        Error::at(self.file.display(), format!("{}: {what}", self.called))
    }

    /// A finite number, if the field is there.
    fn number(&self, name: &str) -> Result<Option<f64>> {
        let Some(value) = self.fields.get(name).filter(|value| !value.is_null()) else { return Ok(None) };
        let number = value.as_f64().filter(|number| number.is_finite());
        number.map(Some).ok_or_else(|| self.error(format!("{name} is no number: {value}")))
    }

    fn required(&self, name: &str) -> Result<f64> {
        self.number(name)?.ok_or_else(|| self.error(format!("{name} is missing")))
    }

    fn text(&self, name: &str) -> Result<&str> {
        let value = self.fields.get(name).ok_or_else(|| self.error(format!("{name} is missing")))?;
        value.as_str().ok_or_else(|| self.error(format!("{name} is no text: {value}")))
    }

    /// Rows of `N` numbers; more rows than `M` are left out.
    fn rows<const N: usize, const M: usize>(&self, name: &str) -> Result<[[f64; N]; M]> {
        let value = self.fields.get(name).ok_or_else(|| self.error(format!("{name} is missing")))?;
        let row = |row: &Value| row.as_array().and_then(|row| numbers(row));
        let rows = value.as_array().filter(|rows| rows.len() >= M).map(|rows| rows.iter().take(M).map(row).collect());
        let rows: Option<Vec<[f64; N]>> = rows.flatten();
        let rows = rows.and_then(|rows| rows.try_into().ok());
        rows.ok_or_else(|| self.error(format!("{name} is not {M} rows of {N} numbers")))
    }

    /// Focal lengths above 0.
    fn focal(&self, focal_px: Xy) -> Result<Xy> {
        match focal_px.iter().all(|focal| *focal > 0.0) {
            true => Ok(focal_px),
            false => Err(self.error(format!("a focal length is not above 0 ({focal_px:?})"))),
        }
    }
}

fn numbers<const N: usize>(items: &[Value]) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = items.iter().map(Value::as_f64).collect();
    numbers.and_then(|numbers| numbers.try_into().ok())
}

/// Width and height as whole numbers of pixels.
fn size(width: f64, height: f64) -> Option<[u32; 2]> {
    let whole = |side: f64| ((1.0..=1e6).contains(&side) && side.fract() == 0.0).then_some(side as u32);
    Some([whole(width)?, whole(height)?])
}

/// The folder that a list names its pictures from.
fn folder<'a>(list: &'a Path, reading: &Reading<'a>) -> &'a Path {
    reading.images.unwrap_or_else(|| super::disk::folder_of(list))
}

/// Whether a file that a person named is there.
fn is_there(path: &Path) -> bool {
    paths::open_named(path).is_ok()
}

#[cfg(test)]
mod tests;
