//! Pictures of numbers, one file per frame: OpenEXR with the numbers themselves, or PNG to look at.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use super::numbered::{PICTURES, Pattern};
use super::{floats, still};
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, Linear};
use crate::files::draft::DraftFile;
use crate::files::outputs::{self, Cleared, Guard, Kind};
use crate::files::write;

/// The files of the frames of a pass, by their numbers.
pub struct Files {
    places: BTreeMap<u64, Cleared>,
    kind: Kind,
}

impl Files {
    /// The files for frames of these numbers: one for each, by a pattern such as `%04d.exr`, or a single one.
    ///
    /// # Errors
    /// A wrong command line, or a file that the guard refuses.
    pub fn new(path: &Path, numbers: &[u64], guard: &mut Guard) -> Result<Files> {
        outputs::no_stream(path)?;
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let kind = match extension.as_str() {
            "exr" => outputs::EXR,
            "png" => outputs::PNG,
            _ => {
                let number = if numbers.len() > 1 { "-%04d" } else { "" };
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let as_exr = path.with_file_name(format!("{}{number}.exr", stem.split('%').next().unwrap_or_default()));
                return Err(Error::Usage(format!(
                    "{}: a pass is written as .exr or, to look at, .png (as -o {})",
                    path.display(),
                    as_exr.display()
                )));
            }
        };
        let Some(pattern) = Pattern::parse(path, &PICTURES, "passes are OpenEXR or PNG files")? else {
            let [number] = numbers else {
                let cure = "--frames 0 renders the first, a pattern such as %04d.exr numbers them";
                let what = format!("{} frames do not fit one file ({cure})", numbers.len());
                return Err(Error::Usage(format!("{}: {what}", path.display())));
            };
            return Ok(Files { places: [(*number, guard.file(path, kind)?)].into(), kind });
        };
        let names: Vec<String> = numbers.iter().map(|&number| pattern.name(number)).collect();
        let places = guard.files(pattern.folder()?, &names, kind)?;
        Ok(Files { places: numbers.iter().copied().zip(places).collect(), kind })
    }

    /// Whether the files have the numbers themselves, not a view of them.
    pub fn are_numbers(&self) -> bool {
        self.kind == outputs::EXR
    }

    /// Where the files are.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.places.values().map(Cleared::path)
    }

    /// Writes the frame of this number, with `alpha` or without; a PNG has the `view` of it.
    ///
    /// # Errors
    /// If it cannot be encoded or written.
    pub fn write(&self, number: u64, picture: &Linear, alpha: bool, view: impl Fn() -> Frame) -> Result<()> {
        let Some(place) = self.places.get(&number) else {
            return Err(Error::at(format!("frame {number}"), "has no place"));
        };
        let failed = |error: &(dyn std::error::Error + 'static)| write::failed(place.path().display(), error);
        let bytes = match self.are_numbers() {
            true if alpha => floats::rgba(picture).map_err(|e| failed(&e))?,
            true => floats::rgb(picture).map_err(|e| failed(&e))?,
            false => still::frame(&view()).map_err(|e| failed(&e))?,
        };
        let mut draft = DraftFile::create(place)?;
        draft.write_all(&bytes).map_err(|e| failed(&e))?;
        draft.keep()
    }
}
