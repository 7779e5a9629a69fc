//! Scene files: read within the limits, written atomically.

use std::io::Read;
use std::path::Path;

use super::{Limits, Options, paths, picture, through, write_atomic};
use crate::base::error::{Error, Result};
use crate::layers::parts::materials::List;
use crate::scene::{Document, Scene, json};

/// So many bytes tell whether a file is a scene.
const HEAD: u64 = 512;

/// Reads the scene at `path`; `-` is standard input.
///
/// # Errors
/// If it cannot be read, is larger than the limits allow, or contains errors: all of them.
pub fn open(path: &Path, options: &Options) -> Result<Document> {
    if let Some(kind) = other_kind(path) {
        let cure = format!("plica edit {} makes a scene of it", path.display());
        return Err(Error::at(path.display(), format!("is {kind}, not a scene")).cure(cure));
    }
    parse(path, &read_text(path, &options.limits)?, options)
}

/// The document in the text of the scene at `path`.
///
/// # Errors
/// If it contains errors or exceeds the limits: all problems.
pub fn parse(path: &Path, text: &str, options: &Options) -> Result<Document> {
    let refused = |problems| Error::Scene { file: path.display().to_string(), problems };
    Document::parse_under(text, options.rules()).map_err(refused)
}

/// What the scene at `path` lists of files, though its text has errors; standard input can be read only once.
pub fn lists(path: &Path, options: &Options) -> Option<Scene> {
    let text = (path != Path::new("-")).then(|| read_text(path, &options.limits));
    Document::files_of(&text?.ok()?, &options.rules())
}

/// The text of the scene at `path`; `-` is standard input.
///
/// # Errors
/// If it cannot be read, is no text, or is larger than the limits allow.
pub fn read_text(path: &Path, limits: &Limits) -> Result<String> {
    if path == Path::new("-") {
        return text("standard input", std::io::stdin().lock(), limits);
    }
    let read = text(&path.display().to_string(), paths::open_named(path)?, limits);
    // If a save was cut short, the copy that it left is the file's text.
    match through::left_behind(path) {
        Some(copy) if !read.as_ref().is_ok_and(|text| is_whole(text)) && is_whole(&copy) => Ok(copy),
        _ => read,
    }
}

/// Whether the file at `path` is a scene by what is in it: the beginning of a JSON object (which a `.gltf` is too). Where that
/// does not tell, because it is neither that nor a picture, its name does.
pub fn is_one(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = paths::open_named(path).ok().and_then(|file| file.take(HEAD).read_to_end(&mut head).ok());
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&head).trim_ascii_start();
    let is_object = text
        .strip_prefix(b"{")
        .is_some_and(|text| matches!(text.trim_ascii_start().first(), None | Some(b'"' | b'}')) && !text.contains(&0));
    let is_model = paths::is_model(&path.to_string_lossy());
    read.is_some() && is_object && !is_model
        || path.extension().is_some_and(|end| end == "json") && !picture::is_one(path)
}

/// What a file is that a scene can be made of, if it is no scene.
fn other_kind(path: &Path) -> Option<&'static str> {
    if !path.is_file() || is_one(path) {
        return None;
    }
    match paths::kind_of(&path.to_string_lossy()) {
        Some(List::Meshes) => Some("a model"),
        Some(List::Clips) => Some("a clip"),
        _ => picture::is_one(path).then_some("a picture"),
    }
}

/// Whether a text is complete JSON.
pub(super) fn is_whole(text: &str) -> bool {
    json::parse(text).is_ok()
}

fn text(place: &str, from: impl Read, limits: &Limits) -> Result<String> {
    text_of(place, from, limits, "a scene is a JSON file")
}

/// The text of a file, which is to be `what` it is.
pub(super) fn text_of(place: &str, from: impl Read, limits: &Limits, what: &str) -> Result<String> {
    let mut bytes = Vec::new();
    // One byte more than allowed distinguishes a file that is too large from one that just fits.
    from.take(limits.scene.saturating_add(1)).read_to_end(&mut bytes).map_err(|error| Error::at(place, error))?;
    if bytes.len() as u64 > limits.scene {
        let most = limits.scene;
        return Err(Error::at(place, format!("is larger than {most} bytes")).cure("give --limit scene=BYTES"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Error::at(place, format!("is not text: byte {at} is not UTF-8")).cure(what)
    })
}

/// Writes a scene's text to `path`: atomically, or in place if the file has other hard links, which it keeps.
///
/// # Errors
/// As [`write_atomic`]: the scene is not saved then.
pub fn save(path: &Path, text: &str) -> Result<()> {
    if through::has_other_names(path)? {
        through::write_through(path, text.as_bytes())
    } else {
        write_atomic(path, text.as_bytes())
    }
}
