//! Loads the files that a scene names, pictures, meshes, clips and vector fields, in parallel. A cache keeps what did not change, and
//! the last good version of what cannot be read just now.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::fields::VectorField;
use super::{Options, mesh, picture};
use crate::base::budget::Budget;
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::problem::{Problem, Severity};
use crate::base::progress::Progress;
use crate::layers::parts::materials::Materials;
use crate::scene::{Document, Scene, check};

mod clips;
mod masks;
mod named;
mod sources;
mod store;
#[cfg(test)]
mod tests;

pub use named::Watched;
pub(super) use named::{ahead, paths};
pub use sources::Copies;
pub(super) use store::Stamp;

use clips::Clips;
use masks::Masked;
use named::Named;
use sources::{Allowed, Sources, Whereabouts, decode_field, decode_mesh, decode_picture, problem};
use store::Store;

/// What was loaded before, by path, for as long as the scene names it.
#[derive(Debug, Default)]
pub struct Cache {
    pictures: Store<Picture>,
    /// What masks without alpha were turned into.
    masks: Vec<Masked>,
    meshes: Store<Mesh>,
    clips: Clips,
    fields: Store<VectorField>,
    /// The memory that is left for the files and what is made from them; by the limits at the first use.
    budget: Option<Budget>,
    /// Cancels the loading.
    pub stop: Option<Arc<AtomicBool>>,
    /// Counts the files that are read.
    pub progress: Option<Arc<Progress>>,
}

impl Cache {
    /// An empty cache; loading ends when `stop` is set.
    pub fn until(stop: Arc<AtomicBool>) -> Self {
        Cache { stop: Some(stop), ..Cache::default() }
    }
}

/// Loads all files that `scene` names; those that have not changed come from `cache`. Also returns warnings.
///
/// # Errors
/// Every file that cannot be loaded or does not fit, as a problem at the path in the scene that names it.
pub fn load(
    scene_path: &Path,
    scene: &Scene,
    options: &Options,
    cache: &mut Cache,
) -> Result<(Materials, Vec<Problem>), Vec<Problem>> {
    let (materials, problems) = gather(scene_path, scene, options, cache);
    let failed = problems.iter().any(|problem| problem.severity == Severity::Error);
    if failed { Err(problems) } else { Ok((materials, problems)) }
}

/// As [`load`], for an editor, which continues with what can be loaded: also returns the problems, errors first. A file
/// that cannot be read just now is replaced by its last good version, if that is in the cache.
pub fn gather(scene_path: &Path, scene: &Scene, options: &Options, cache: &mut Cache) -> (Materials, Vec<Problem>) {
    Sources { place: Whereabouts::Beside(scene_path), options }.gather(scene, cache)
}

/// As [`gather`], for a scene on another machine.
pub fn gather_copies(
    copies: &Copies,
    scene: &Scene,
    options: &Options,
    cache: &mut Cache,
) -> (Materials, Vec<Problem>) {
    Sources { place: Whereabouts::Copies(copies), options }.gather(scene, cache)
}

/// Width and height of every picture that `scene` names, from the headers alone, and which files cannot be read.
pub fn sizes(scene_path: &Path, scene: &Scene, options: &Options) -> (BTreeMap<String, (usize, usize)>, Vec<Problem>) {
    headers(scene_path, scene, options, |_| true)
}

/// The problems of the files that `after` names, and `before` not at the same place, as far as their beginnings tell.
pub fn unread(scene_path: &Path, [before, after]: [&Document; 2], options: &Options) -> Vec<Problem> {
    let is_new = |at: &str| before.json().pointer(at) != after.json().pointer(at);
    headers(scene_path, after.scene(), options, |named| is_new(&named.at)).1
}

/// [`sizes`] of those that are `wanted`.
fn headers(
    scene_path: &Path,
    scene: &Scene,
    options: &Options,
    wanted: impl Fn(&Named) -> bool,
) -> (BTreeMap<String, (usize, usize)>, Vec<Problem>) {
    let open = |path: &str| super::paths::open(scene_path, path, options);
    let measure = |path: &str| picture::header(open(path)?, path, &options.limits);
    let mut sizes = BTreeMap::new();
    let mut problems = Vec::new();
    for named in named::pictures(scene).into_iter().filter(&wanted) {
        match measure(named.path) {
            Ok(size) => drop(sizes.insert(named.key.to_owned(), size)),
            Err(error) => problems.push(problem(&named, error)),
        }
    }
    for named in named::meshes(scene).into_iter().filter(&wanted) {
        let begins = open(named.path).and_then(|file| mesh::expect(&file, named.path));
        problems.extend(begins.err().map(|error| problem(&named, error)));
    }
    for named in named::fields(scene).into_iter().filter(&wanted) {
        problems.extend(open(named.path).err().map(|error| problem(&named, error)));
    }
    for (named, frames) in named::clips(scene_path, scene).into_iter().filter(|(named, _)| wanted(named)) {
        let is_video = scene.clips[named.key].frames().is_ok_and(|frames| frames.is_video());
        let begins = |path: &String| match is_video {
            true => super::sources::expect_video(&open(path)?, path),
            false => open(path).map(drop),
        };
        problems.extend(frames.iter().try_for_each(begins).err().map(|error| problem(&named, error)));
    }
    (sizes, problems)
}

impl Sources<'_> {
    fn gather(&self, scene: &Scene, cache: &mut Cache) -> (Materials, Vec<Problem>) {
        let mut problems = Vec::new();
        let budget = cache.budget.get_or_insert_with(|| self.options.limits.budget()).clone();
        let stop = cache.stop.clone();
        let progress = cache.progress.take();
        let limits = &self.options.limits;
        let allowed = Allowed {
            options: self.options,
            limits,
            budget: &budget,
            stop: stop.as_deref(),
            progress: progress.as_deref(),
        };
        let pictures = self.load(&named::pictures(scene), allowed, &decode_picture, &mut cache.pictures, &mut problems);
        let meshes = self.load(&named::meshes(scene), allowed, &decode_mesh, &mut cache.meshes, &mut problems);
        self.check_pictures(scene, &meshes, &mut problems);
        let fields = self.load(&named::fields(scene), allowed, &decode_field, &mut cache.fields, &mut problems);
        let clips = self.clips(scene, allowed, &mut cache.clips, &mut problems);
        let mut materials = Materials { pictures, meshes, fields, clips, stop, budget, ..Materials::default() };
        problems.extend(check::check_materials(scene, &materials));
        masks::lay(scene, &mut materials, &mut cache.masks, &mut problems);
        problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
        (materials, problems)
    }

    /// Warns of models whose own picture is not there, where the scene does not name that itself.
    fn check_pictures(&self, scene: &Scene, meshes: &BTreeMap<String, Arc<Mesh>>, problems: &mut Vec<Problem>) {
        // Only what is named goes to other machines.
        if matches!(self.place, Whereabouts::Copies(_)) {
            return;
        }
        for named in named::meshes(scene) {
            let mesh = meshes.get(named.key).filter(|mesh| mesh.without_uv.is_none());
            let Some(picture) = mesh.and_then(|mesh| mesh.picture.as_deref()) else { continue };
            let path = super::paths::sibling(named.path, picture);
            let is_named = scene.images.values().any(|image| image.path == path);
            if let Some(error) = self.open(&path).err().filter(|_| !is_named) {
                let Problem { message, hint, .. } = problem(&named, error);
                let told = Problem::warning(&named.at, format!("{}: its picture {message}", named.path));
                problems.push(Problem { hint, ..told });
            }
        }
    }
}
