//! The pictures of sprites as PNG files in a folder, with a listing.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use super::still;
use crate::base::error::{Error, Result};
use crate::files::draft::DraftFolder;
use crate::files::lines;
use crate::files::outputs::ClearedFolder;
use crate::layers::parts::album::Album;
use crate::render::cpu;

/// The listing.
const LISTING: &str = "sprites.json";

/// Writes an album to the folder at `place`, all of it or nothing; other files of an earlier run are removed. Gives the
/// names of the files.
///
/// # Errors
/// The folder cannot be written.
pub fn write(album: &Album, place: &ClearedFolder) -> Result<Vec<String>> {
    let draft = DraftFolder::create(place)?;
    let mut names = Vec::new();
    for (name, picture) in &album.pictures {
        let file = format!("{name}.png");
        let bytes = still::frame(&cpu::finish(picture)).map_err(|e| Error::at(&file, e))?;
        draft.write(&file, &bytes)?;
        names.push(file);
    }
    let text = serde_json::to_string_pretty(&album.listing).map_err(|e| Error::at(LISTING, e))?;
    draft.write(LISTING, format!("{text}\n").as_bytes())?;
    names.push(LISTING.into());
    draft.keep(&names)?;
    Ok(names)
}

/// Whether a run may write a file of this name.
pub fn may_be(name: &str) -> bool {
    let picture = ["water-", "foam-"].iter().any(|start| name.starts_with(start)) && name.ends_with(".png");
    picture || name == "sheet.png" || name == LISTING
}

/// The files that an earlier run wrote to `folder`: if its listing is there, those that a run may write.
pub fn earlier(folder: &Path) -> BTreeSet<String> {
    let text = lines::read(&folder.join(LISTING)).ok();
    let listing = text.and_then(|text| serde_json::from_str::<Value>(&text).ok());
    let Some(tracks) = listing.as_ref().and_then(|listing| listing["tracks"].as_array()) else {
        return BTreeSet::new();
    };
    let keys = tracks.iter().filter_map(|track| track["keys"].as_array()).flatten();
    let stems: Vec<&str> = keys.filter_map(|key| key["file"].as_str()?.strip_suffix(".png")).collect();
    // The pictures between keys are named after the key before.
    let steps = stems.iter().flat_map(|stem| (1..100).map(move |n| format!("{stem}-{n:02}.png")));
    let own = stems.iter().map(|stem| format!("{stem}.png"));
    let fixed = ["sheet.png", LISTING].map(str::to_owned);
    steps.chain(own).filter(|name| may_be(name)).chain(fixed).collect()
}
