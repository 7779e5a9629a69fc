//! The files that a scene names, and where.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::Stamp;
use crate::base::pointer::Pointer;
use crate::files::{self, Options, mesh};
use crate::layers::parts::materials::{Of, Use, What};
use crate::scene::{Clip, Scene};

/// A file that a scene names.
pub(super) struct Named<'a> {
    /// Its key among the materials.
    pub(super) key: &'a str,
    /// The path as written.
    pub(super) path: &'a str,
    /// Where it is written: a JSON pointer.
    pub(super) at: String,
}

pub(super) fn pictures(scene: &Scene) -> Vec<Named<'_>> {
    scene.images.iter().map(|(key, image)| listed("/images", key, &image.path)).collect()
}

pub(super) fn meshes(scene: &Scene) -> Vec<Named<'_>> {
    scene.meshes.iter().map(|(key, mesh)| listed("/meshes", key, &mesh.path)).collect()
}

fn listed<'a>(list: &str, key: &'a str, path: &'a str) -> Named<'a> {
    Named { key, path, at: Pointer(list).join(key) + "/path" }
}

pub(super) fn fields(scene: &Scene) -> Vec<Named<'_>> {
    let fields = scene.uses().filter_map(|Use { at, of, what }| match (of, what) {
        (Of::Path(path), What::Vectors) => Some(Named { key: path, path, at }),
        (Of::Name(..), _)
        | (Of::Path(_), What::Picture | What::Mask { .. } | What::Mesh | What::Clip | What::Shape | What::Layer) => {
            None
        }
    });
    fields.collect()
}

/// The paths of a clip's frames, or of its video; without a count, as many as are there one after the other, and at least the first.
pub(super) fn frames(clip: &Clip, is_there: impl Fn(&str) -> bool) -> Vec<String> {
    let Ok(frames) = clip.frames() else { return Vec::new() };
    if frames.is_video() {
        return vec![frames.path(0)];
    }
    let paths = (0..clip.count.map_or(Clip::MOST, u64::from)).map(|index| frames.path(index));
    match clip.count {
        Some(_) => paths.collect(),
        None => paths.enumerate().take_while(|(i, path)| *i == 0 || is_there(path)).map(|(_, path)| path).collect(),
    }
}

/// The path of the frame that would make a clip longer if it were there.
fn next(clip: &Clip, is_there: impl Fn(&str) -> bool) -> Option<String> {
    let count = frames(clip, is_there).len() as u64;
    clip.frames().ok().filter(|frames| clip.count.is_none() && !frames.is_video()).map(|frames| frames.path(count))
}

/// The clips, each with the paths of its frames beside the scene.
pub(super) fn clips<'a>(scene_path: &Path, scene: &'a Scene) -> Vec<(Named<'a>, Vec<String>)> {
    let all = |clip| frames(clip, |path| is_there(scene_path, path));
    scene.clips.iter().map(|(key, clip)| (listed("/clips", key, &clip.path), all(clip))).collect()
}

fn is_there(scene_path: &Path, path: &str) -> bool {
    files::paths::beside(scene_path, path).exists()
}

/// What tells which files to watch. A model is read only where it has changed.
#[derive(Debug, Default)]
pub struct Watched {
    /// The files that models are made from besides their own, and those of their pictures, by the path of the model.
    models: BTreeMap<String, (Stamp, Vec<String>)>,
}

impl Watched {
    /// The files that `scene` names, and those that its models name.
    pub fn files(&mut self, scene_path: &Path, scene: &Scene, options: &Options) -> Vec<PathBuf> {
        let before = std::mem::take(&mut self.models);
        let models = meshes(scene).into_iter().map(|named| named.path).filter(|path| files::paths::is_model(path));
        self.models =
            models.filter_map(|path| Some((path.to_owned(), model(scene_path, path, options, &before)?))).collect();
        let parts = self.models.values().flat_map(|(_, parts)| parts.iter().cloned());
        let named = paths(scene_path, scene).into_iter().chain(ahead(scene_path, scene));
        let all: BTreeSet<String> = named.chain(parts).collect();
        all.iter().map(|path| files::paths::beside(scene_path, path)).collect()
    }
}

/// What a model is made from and shows besides its own file; what is wrong with it shows when it is loaded.
fn model(
    scene_path: &Path,
    path: &str,
    options: &Options,
    before: &BTreeMap<String, (Stamp, Vec<String>)>,
) -> Option<(Stamp, Vec<String>)> {
    let open = || files::paths::open(scene_path, path, options);
    let file = open().ok()?;
    let stamp = Stamp::of(&file).ok()?;
    if let Some(known) = before.get(path).filter(|(old, _)| *old == stamp) {
        return Some(known.clone());
    }
    let mut named = mesh::parts(file, path, options).unwrap_or_default();
    // A picture may come later, or change: what is said of the model then changes too.
    let pictures = open().and_then(|file| mesh::pictures(file, path, options)).unwrap_or_default();
    named.extend(pictures.into_iter().filter(|picture| files::paths::image_of(picture).is_none()));
    Some((stamp, named))
}

/// The files that `scene` names, as the paths written in it, without those that are not there yet.
pub(in crate::files) fn paths(scene_path: &Path, scene: &Scene) -> BTreeSet<String> {
    let single = pictures(scene).into_iter().chain(meshes(scene)).chain(fields(scene));
    let frames = clips(scene_path, scene).into_iter().flat_map(|(_, frames)| frames);
    single.map(|named| named.path.to_owned()).chain(frames).collect()
}

/// The files that would make clips of `scene` longer if they were there.
pub(in crate::files) fn ahead(scene_path: &Path, scene: &Scene) -> Vec<String> {
    scene.clips.values().filter_map(|clip| next(clip, |path| is_there(scene_path, path))).collect()
}
