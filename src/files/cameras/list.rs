//! What a list of pictures with cameras holds, and how its items are read.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use crate::base::error::{Error, Result};
use crate::base::geometry::Xy;
use crate::files::{Limits, paths, scene};
use crate::layers::parts::shots::Shot;

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

/// The text of a file, which is to be `what` it is.
pub(super) fn text_of(path: &Path, reading: &Reading, what: &str) -> Result<String> {
    scene::text_of(&path.display().to_string(), paths::open_named(path)?, reading.limits, what)
}

/// An item of a list as JSON, and what it is called in messages.
pub(super) struct Item<'a> {
    pub(super) file: &'a Path,
    pub(super) called: String,
    pub(super) fields: &'a Map<String, Value>,
}

impl Item<'_> {
    pub(super) fn error(&self, what: impl std::fmt::Display) -> Error {
        Error::at(self.file.display(), format!("{}: {what}", self.called))
    }

    /// A finite number, if the field is there.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>> {
        let Some(value) = self.fields.get(name).filter(|value| !value.is_null()) else { return Ok(None) };
        let number = value.as_f64().filter(|number| number.is_finite());
        number.map(Some).ok_or_else(|| self.error(format!("{name} is no number: {value}")))
    }

    pub(super) fn required(&self, name: &str) -> Result<f64> {
        self.number(name)?.ok_or_else(|| self.error(format!("{name} is missing")))
    }

    pub(super) fn text(&self, name: &str) -> Result<&str> {
        let value = self.fields.get(name).ok_or_else(|| self.error(format!("{name} is missing")))?;
        value.as_str().ok_or_else(|| self.error(format!("{name} is no text: {value}")))
    }

    /// Rows of `N` numbers; more rows than `M` are left out.
    pub(super) fn rows<const N: usize, const M: usize>(&self, name: &str) -> Result<[[f64; N]; M]> {
        let value = self.fields.get(name).ok_or_else(|| self.error(format!("{name} is missing")))?;
        let row = |row: &Value| row.as_array().and_then(|row| numbers(row));
        let rows = value.as_array().filter(|rows| rows.len() >= M).map(|rows| rows.iter().take(M).map(row).collect());
        let rows: Option<Vec<[f64; N]>> = rows.flatten();
        let rows = rows.and_then(|rows| rows.try_into().ok());
        rows.ok_or_else(|| self.error(format!("{name} is not {M} rows of {N} numbers")))
    }

    /// Focal lengths above 0.
    pub(super) fn focal(&self, focal_px: Xy) -> Result<Xy> {
        match focal_px.iter().all(|focal| *focal > 0.0) {
            true => Ok(focal_px),
            false => Err(self.error(format!("a focal length is not above 0 ({focal_px:?})"))),
        }
    }
}

pub(super) fn numbers<const N: usize>(items: &[Value]) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = items.iter().map(Value::as_f64).collect();
    numbers.and_then(|numbers| numbers.try_into().ok())
}

/// Width and height as whole numbers of pixels.
pub(super) fn size(width: f64, height: f64) -> Option<[u32; 2]> {
    let whole = |side: f64| ((1.0..=1e6).contains(&side) && side.fract() == 0.0).then_some(side as u32);
    Some([whole(width)?, whole(height)?])
}

/// The folder that a list names its pictures from.
pub(super) fn folder<'a>(list: &'a Path, reading: &Reading<'a>) -> &'a Path {
    reading.images.unwrap_or_else(|| crate::files::disk::folder_of(list))
}

/// Whether a file that a person named is there.
pub(super) fn is_there(path: &Path) -> bool {
    paths::open_named(path).is_ok()
}
