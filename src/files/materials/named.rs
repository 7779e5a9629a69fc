//! The files that a scene names, and where.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::files;
use crate::layers::parts::materials::{Of, Use, What};
use crate::scene::{Scene, pointer};

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
    Named { key, path, at: pointer::join(list, key) + "/path" }
}

pub(super) fn fields(scene: &Scene) -> Vec<Named<'_>> {
    let fields = scene.uses().filter_map(|Use { at, of, what }| match (of, what) {
        (Of::Path(path), What::Vectors) => Some(Named { key: path, path, at }),
        (Of::Name(..), _) | (Of::Path(_), What::Picture | What::Mask { .. } | What::Mesh | What::Layer) => None,
    });
    fields.collect()
}

fn all(scene: &Scene) -> impl Iterator<Item = Named<'_>> {
    pictures(scene).into_iter().chain(meshes(scene)).chain(fields(scene))
}

/// The files that `scene` names, for watching.
pub fn files(scene_path: &Path, scene: &Scene) -> Vec<PathBuf> {
    all(scene).map(|named| files::paths::beside(scene_path, named.path)).collect()
}

/// The same, as the paths written in the scene.
pub(in crate::files) fn paths(scene: &Scene) -> BTreeSet<&str> {
    all(scene).map(|named| named.path).collect()
}
