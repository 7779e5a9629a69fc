//! The hidden files beside a scene that belong to it: its journal, who edits it, a save in progress. No two scenes in a
//! folder share one, whatever their names.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

use super::{disk, hash};

/// The longest file name on most file systems, in bytes.
const LONGEST: usize = 255;

/// The hidden file of a scene for one purpose: `.cat.journal` for `cat.plica.json`, `.cat.json.journal` for `cat.json`.
/// Names that could be mistaken for one of these are marked, and those that would be too long are hashed.
pub fn path(scene_path: &Path, purpose: &str) -> PathBuf {
    let name = scene_path.file_name().unwrap_or_default();
    let bytes = name.as_bytes();
    let stem = bytes.strip_suffix(b".plica.json").filter(|stem| !stem.ends_with(b".json"));
    let (shown, mark) = match stem {
        Some(stem) => (stem, ""),
        None if bytes.ends_with(b".json") && !bytes.ends_with(b".plica.json") => (bytes, ""),
        None => (bytes, "scene-"),
    };
    let mut hidden = OsString::from(".");
    hidden.push(OsStr::from_bytes(shown));
    hidden.push(format!(".{mark}{purpose}"));
    if hidden.len() > LONGEST {
        hidden = format!(".{}.{mark}{purpose}", &hash::of(bytes)[..32]).into();
    }
    disk::folder_of(scene_path).join(hidden)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_scenes_share_one() {
        let long = "n".repeat(240) + ".plica.json";
        let other = "n".repeat(241) + ".plica.json";
        let names: [&[u8]; 12] = [
            b"q",
            b"q.json",
            b"q.plica.json",
            b"q.json.plica.json",
            b"q.json.journal",
            b"q.scene.plica.json",
            b".q.plica.json",
            b"\xff.plica.json",
            b"\xfe.plica.json",
            b"\xff.plica",
            long.as_bytes(),
            other.as_bytes(),
        ];
        let mut seen = BTreeSet::new();
        for name in names {
            for purpose in ["journal", "editor", "saving"] {
                let path = path(&Path::new("/a").join(OsStr::from_bytes(name)), purpose);
                assert!(path.file_name().unwrap().len() <= LONGEST, "{path:?}");
                assert!(seen.insert(path), "{name:?} {purpose}");
            }
        }
        assert_eq!(path(Path::new("cat.plica.json"), "journal"), Path::new("./.cat.journal"));
        assert_eq!(path(Path::new("/a/cat.json"), "editor"), Path::new("/a/.cat.json.editor"));
    }
}
