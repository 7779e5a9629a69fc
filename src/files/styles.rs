//! Style files: tables of everything that is in force in a layer. Those in the person's folder for settings have names.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::limits::Limits;
use super::{paths, scene};
use crate::base::error::{Error, Result};
use crate::base::system::folders;
use crate::scene::json;

/// The person's own styles: their names, in order, and their files.
pub fn own() -> Vec<(String, PathBuf)> {
    let folder = folders::config().map(|folder| folder.join("styles"));
    let files = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let named = |path: PathBuf| {
        let name = path.file_name()?.to_str()?.strip_suffix(".json")?.to_owned();
        Some((name, path)).filter(|(_, path)| path.is_file())
    };
    let mut all: Vec<(String, PathBuf)> = files.filter_map(|entry| named(entry.path())).collect();
    all.sort();
    all
}

/// The table in a style file.
///
/// # Errors
/// If it cannot be read, or is no style.
pub fn read(path: &Path, limits: &Limits) -> Result<Value> {
    let place = path.display();
    let text = scene::text_of(&place.to_string(), paths::open_named(path)?, limits, "a style is a JSON file")?;
    let table = json::parse(&text).map_err(|problem| Error::at(&place, problem))?;
    if !table.is_object() || table.get("plica").is_some() {
        return Err(Error::at(place, "is no style").cure("plica style save writes one"));
    }
    Ok(table)
}
