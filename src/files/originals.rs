//! The files that a scene names, for a window on another machine: identified by content hash, sent in small pieces, as
//! they are on the disk. A file stays open while the scene names it, so that its pieces fit together whatever is saved
//! meanwhile.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Seek;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::hash::contents;
use super::materials::{self, Stamp};
use super::{Options, mesh, paths};
use crate::base::error::{Error, Result};
use crate::base::text;
use crate::scene::Scene;

pub use super::hash::Contents;

/// The most bytes of a piece: other messages can go between two pieces.
pub const PIECE: usize = 8 << 10;

/// A file that a scene names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Original {
    /// Its path as written in the scene.
    pub path: String,
    /// What is in it, or why it cannot be read.
    pub file: std::result::Result<Contents, String>,
}

/// All files that one scene names, open.
#[derive(Debug, Default)]
pub struct Originals {
    found: BTreeMap<String, std::result::Result<Arc<Stamped>, String>>,
}

#[derive(Debug)]
struct Stamped {
    stamp: Stamp,
    contents: Contents,
    /// The files that it names itself, as the buffers of a model.
    parts: Vec<String>,
    file: File,
}

impl Originals {
    /// Opens and hashes the files that `scene` names; those that have not changed since `before` are not read again.
    pub fn of(scene_path: &Path, scene: &Scene, options: &Options, before: &Originals) -> Originals {
        let look = |path: &str| {
            let old = before.found.get(path).and_then(|found| found.as_ref().ok());
            (path.to_owned(), look(scene_path, path, options, old).map_err(why))
        };
        let named = materials::paths(scene_path, scene);
        let mut found: BTreeMap<_, _> = named.iter().map(|path| look(path)).collect();
        let parts: BTreeSet<String> = found.values().flatten().flat_map(|found| found.parts.iter().cloned()).collect();
        for part in parts {
            found.entry(part).or_insert_with_key(|part| look(part).1);
        }
        Originals { found }
    }

    /// Every file, in the order of the paths.
    pub fn list(&self) -> Vec<Original> {
        let file = |found: &std::result::Result<Arc<Stamped>, String>| match found {
            Ok(found) => Ok(found.contents.clone()),
            Err(why) => Err(why.clone()),
        };
        self.found.iter().map(|(path, found)| Original { path: path.clone(), file: file(found) }).collect()
    }

    /// At most [`PIECE`] bytes from `offset` of the file with this hash; empty if there is no such file.
    pub fn piece(&self, hash: &str, offset: u64) -> Vec<u8> {
        let mut bytes = vec![0; PIECE];
        let found = self.found.values().flatten().find(|found| found.contents.hash == hash);
        let read = found.map_or(Ok(0), |found| read_full_at(&found.file, &mut bytes, offset));
        bytes.truncate(read.unwrap_or(0));
        bytes
    }
}

fn read_full_at(file: &File, bytes: &mut [u8], offset: u64) -> std::io::Result<usize> {
    let mut read = 0;
    while read < bytes.len() {
        match file.read_at(&mut bytes[read..], offset.saturating_add(read as u64))? {
            0 => break,
            n => read += n,
        }
    }
    Ok(read)
}

fn look(scene_path: &Path, path: &str, options: &Options, old: Option<&Arc<Stamped>>) -> Result<Arc<Stamped>> {
    let mut file = paths::open(scene_path, path, options)?;
    let place = |error| Error::at(path, error);
    let stamp = Stamp::of(&file).map_err(place)?;
    if let Some(old) = old.filter(|old| old.stamp == stamp) {
        return Ok(old.clone());
    }
    let length = file.metadata().map_err(place)?.len();
    if length > options.limits.memory {
        let what = format!("is {} long, at most {} are sent", text::bytes(length), text::bytes(options.limits.memory));
        return Err(Error::at(path, what).cure("make it smaller, or give --limit memory=BYTES"));
    }
    let contents = contents(&mut file).map_err(place)?;
    let parts = if paths::is_model(path) { parts(&mut file, path, options) } else { Vec::new() };
    Ok(Arc::new(Stamped { stamp, contents, parts, file }))
}

/// The files that a model names. What is wrong with it shows when it is loaded.
fn parts(file: &mut File, path: &str, options: &Options) -> Vec<String> {
    let copy = file.rewind().and_then(|()| file.try_clone());
    copy.ok().and_then(|file| mesh::parts(file, path, options).ok()).unwrap_or_default()
}

/// The reason alone: the reader knows the path.
fn why(error: Error) -> String {
    match error {
        Error::Failed { what, cure: None, .. } => what,
        Error::Failed { what, cure: Some(cure), .. } => format!("{what} ({cure})"),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(paths: &[&str]) -> Scene {
        let images: serde_json::Map<_, _> =
            paths.iter().map(|path| (path.replace('.', ""), serde_json::json!({ "path": path }))).collect();
        serde_json::from_value(serde_json::json!({ "plica": 1, "images": images })).unwrap()
    }

    fn whole(originals: &Originals, hash: &str) -> Vec<u8> {
        let mut bytes = Vec::new();
        loop {
            match originals.piece(hash, bytes.len() as u64) {
                piece if piece.is_empty() => return bytes,
                piece => bytes.extend(piece),
            }
        }
    }

    #[test]
    fn pieces_make_the_file_that_was_told_of() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.plica.json");
        let long: Vec<u8> = (0..20_000u32).map(|i| (i % 251) as u8).collect();
        std::fs::write(folder.path().join("a.png"), &long).unwrap();
        let (options, scene) = (Options::default(), scene(&["a.png", "../b.png", "c.png"]));
        let first = Originals::of(&path, &scene, &options, &Originals::default());
        let list = first.list();
        let told: Vec<_> = list.iter().map(|one| (one.path.as_str(), one.file.is_ok())).collect();
        assert_eq!(told, [("../b.png", false), ("a.png", true), ("c.png", false)]);
        let contents = list[1].file.clone().unwrap();
        assert_eq!(contents, Contents { hash: super::super::hash::of(&long), bytes: 20_000 });
        assert_eq!(first.piece(&contents.hash, 0).len(), PIECE);
        // Replaced by rename meanwhile: what was announced is still sent completely.
        std::fs::write(folder.path().join("new"), "short").unwrap();
        std::fs::rename(folder.path().join("new"), folder.path().join("a.png")).unwrap();
        assert!(whole(&first, &contents.hash) == long);
        let second = Originals::of(&path, &scene, &options, &first);
        assert_eq!(second.list()[1].file.as_ref().unwrap().bytes, 5);
        assert!(second.piece(&contents.hash, 0).is_empty(), "gone");
        assert!(second.piece("", u64::MAX).is_empty());
    }

    #[test]
    fn a_model_comes_with_its_parts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.plica.json");
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        let buffers = serde_json::json!([{ "uri": "a%20b.bin" }, { "uri": "data:,x" }, { "uri": "../../out.bin" }, {}]);
        let model = serde_json::json!({ "asset": { "version": "2.0" }, "buffers": buffers });
        std::fs::write(folder.path().join("sub/m.gltf"), model.to_string()).unwrap();
        std::fs::write(folder.path().join("sub/a b.bin"), "part").unwrap();
        let meshes = serde_json::json!({ "m": { "path": "sub/m.gltf" } });
        let scene = serde_json::from_value(serde_json::json!({ "plica": 1, "meshes": meshes })).unwrap();
        let (options, mut before) = (Options::default(), Originals::default());
        // The second time nothing is read again.
        for _ in 0..2 {
            before = Originals::of(&path, &scene, &options, &before);
            let list = before.list();
            let told: Vec<_> = list.iter().map(|one| (one.path.as_str(), one.file.is_ok())).collect();
            assert_eq!(told, [("sub/a b.bin", true), ("sub/m.gltf", true)]);
        }
        let part = before.list()[0].file.clone().unwrap();
        assert_eq!(before.piece(&part.hash, 0), b"part");
    }
}
