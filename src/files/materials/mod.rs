//! Loads the files that a scene names, pictures, meshes, clips and vector fields, in parallel. A cache keeps what did not change, and
//! the last good version of what cannot be read just now.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::fields::{self, VectorField};
use super::{Limits, Options, mesh, picture};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::problem::{Problem, Severity};
use crate::base::progress::Progress;
use crate::layers::parts::materials::Materials;
use crate::scene::{Scene, check};

mod clips;
mod masks;
mod named;
mod store;
#[cfg(test)]
mod tests;

pub use named::Watched;
pub(super) use named::{ahead, paths};
pub(super) use store::Stamp;

use clips::Clips;
use masks::Masked;
use named::Named;
use store::{Loaded, Store};

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
) -> std::result::Result<(Materials, Vec<Problem>), Vec<Problem>> {
    let (materials, problems) = gather(scene_path, scene, options, cache);
    let failed = problems.iter().any(|problem| problem.severity == Severity::Error);
    if failed { Err(problems) } else { Ok((materials, problems)) }
}

/// As [`load`], for an editor, which continues with what can be loaded: also returns the problems, errors first. A file
/// that cannot be read just now is replaced by its last good version, if that is in the cache.
pub fn gather(scene_path: &Path, scene: &Scene, options: &Options, cache: &mut Cache) -> (Materials, Vec<Problem>) {
    Sources { place: Place::Beside(scene_path), options }.gather(scene, cache)
}

/// Copies of the files that a scene on another machine names, by the path as written in the scene; or why there is no
/// copy.
pub type Copies = BTreeMap<String, std::result::Result<PathBuf, String>>;

/// As [`gather`], for a scene on another machine.
pub fn gather_copies(
    copies: &Copies,
    scene: &Scene,
    options: &Options,
    cache: &mut Cache,
) -> (Materials, Vec<Problem>) {
    Sources { place: Place::Copies(copies), options }.gather(scene, cache)
}

/// Width and height of every picture that `scene` names, from the headers alone, and which files cannot be read.
pub fn sizes(scene_path: &Path, scene: &Scene, options: &Options) -> (BTreeMap<String, (usize, usize)>, Vec<Problem>) {
    let measure = |named: &Named| {
        let file = super::paths::open(scene_path, named.path, options)?;
        picture::header(file, named.path, &options.limits)
    };
    let mut sizes = BTreeMap::new();
    let mut problems = Vec::new();
    for named in named::pictures(scene) {
        match measure(&named) {
            Ok(size) => drop(sizes.insert(named.key.to_owned(), size)),
            Err(error) => problems.push(problem(&named, error)),
        }
    }
    for named in named::meshes(scene).into_iter().chain(named::fields(scene)) {
        problems.extend(super::paths::open(scene_path, named.path, options).err().map(|error| problem(&named, error)));
    }
    for (named, frames) in named::clips(scene_path, scene) {
        let opened = frames.iter().try_for_each(|path| super::paths::open(scene_path, path, options).map(drop));
        problems.extend(opened.err().map(|error| problem(&named, error)));
    }
    (sizes, problems)
}

/// Where the files are.
enum Place<'a> {
    /// Beside the scene, or wherever its paths lead.
    Beside(&'a Path),
    /// On this machine, while the scene is on another.
    Copies(&'a Copies),
}

struct Sources<'a> {
    place: Place<'a>,
    options: &'a Options,
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
        if matches!(self.place, Place::Copies(_)) {
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

    /// The key of a file in the cache.
    fn key(&self, path: &str) -> PathBuf {
        match self.place {
            // Layers of one file are separate pictures.
            Place::Beside(scene_path) => match super::paths::layer_of(path) {
                None => super::paths::beside(scene_path, path),
                Some(layer) => super::paths::beside(scene_path, path).join(format!("#{layer}")),
            },
            Place::Copies(_) => path.into(),
        }
    }

    fn open(&self, path: &str) -> Result<File> {
        match self.place {
            Place::Beside(scene_path) => super::paths::open(scene_path, path, self.options),
            Place::Copies(copies) => match copies.get(path) {
                Some(Ok(copy)) => super::paths::open_named(copy),
                Some(Err(why)) => Err(Error::at(path, why)),
                None => Err(Error::at(path, "is not here yet")),
            },
        }
    }

    fn load<T: Send + Sync>(
        &self,
        named: &[Named],
        allowed: Allowed,
        decode: Decode<T>,
        store: &mut Store<T>,
        problems: &mut Vec<Problem>,
    ) -> BTreeMap<String, Arc<T>> {
        // Each file is decoded once, however often it is named.
        let files: BTreeMap<PathBuf, &str> = named.iter().map(|named| (self.key(named.path), named.path)).collect();
        allowed.expect(files.len());
        let loaded: HashMap<PathBuf, Result<Loaded<T>>> = files
            .into_par_iter()
            .map(|(file, path)| {
                let loaded = self.load_one(path, allowed, decode, store.get(&file));
                allowed.progress.iter().for_each(|progress| progress.done(1));
                (file, loaded)
            })
            .collect();
        let mut kept = Store::new();
        let mut materials = BTreeMap::new();
        for named in named {
            let file = self.key(named.path);
            let entry = match &loaded[&file] {
                Ok(entry) => {
                    let warning = |note: &String| Problem::warning(&named.at, format!("{}: {note}", named.path));
                    problems.extend(entry.notes.iter().map(warning));
                    Some(entry.clone())
                }
                Err(error) => {
                    problems.push(problem(named, error));
                    store.get(&file).cloned()
                }
            };
            if let Some(entry) = entry {
                materials.insert(named.key.to_owned(), entry.value.clone());
                kept.insert(file, entry);
            }
        }
        *store = kept;
        materials
    }

    fn load_one<T>(
        &self,
        path: &str,
        allowed: Allowed,
        decode: Decode<T>,
        old: Option<&Loaded<T>>,
    ) -> Result<Loaded<T>> {
        if allowed.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            return Err(Error::Interrupted);
        }
        let (file, stamp) = self.open_stamped(path)?;
        let same = |(path, stamp): &(String, Stamp)| self.open_stamped(path).is_ok_and(|(_, now)| now == *stamp);
        if let Some(old) = old.filter(|old| old.stamp == stamp && old.beside.iter().all(same)) {
            return Ok(old.clone());
        }
        let beside = RefCell::new(Vec::new());
        let sibling = |name: &str| {
            let path = super::paths::sibling(path, name);
            let (file, stamp) = self.open_stamped(&path)?;
            beside.borrow_mut().push((path, stamp));
            Ok(file)
        };
        let (value, notes, share) = decode(file, path, allowed, &sibling)?;
        let (notes, share) = (notes.into(), Arc::new(share));
        Ok(Loaded { stamp, beside: beside.take().into(), value: Arc::new(value), notes, share })
    }

    fn open_stamped(&self, path: &str) -> Result<(File, Stamp)> {
        let file = self.open(path)?;
        let stamp = Stamp::of(&file).map_err(|error| Error::at(path, error))?;
        Ok((file, stamp))
    }
}

/// What loading may consume, the flag that cancels it, and how far it is.
#[derive(Clone, Copy)]
struct Allowed<'a> {
    options: &'a Options,
    limits: &'a Limits,
    budget: &'a Budget,
    stop: Option<&'a AtomicBool>,
    progress: Option<&'a Progress>,
}

impl Allowed<'_> {
    fn expect(&self, files: usize) {
        self.progress.iter().for_each(|progress| progress.expect(files as u64));
    }
}

/// Reads an open file; the path is its name in messages, and the last is for files that it names. Also returns what in
/// is not supported in it, and the memory that it takes.
type Decode<'a, T> = &'a (dyn Fn(File, &str, Allowed, mesh::Opener) -> Result<(T, Vec<String>, Share)> + Sync);

fn decode_mesh(file: File, place: &str, allowed: Allowed, sibling: mesh::Opener) -> Result<(Mesh, Vec<String>, Share)> {
    mesh::decode(file, place, allowed.options, allowed.budget, sibling)
}

fn decode_picture(file: File, place: &str, allowed: Allowed, _: mesh::Opener) -> Result<(Picture, Vec<String>, Share)> {
    let (found, share) = picture::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((found.picture, found.notes, share))
}

fn decode_field(
    file: File,
    place: &str,
    allowed: Allowed,
    _: mesh::Opener,
) -> Result<(VectorField, Vec<String>, Share)> {
    let (field, share) = fields::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((field, Vec::new(), share))
}

fn problem(named: &Named, error: impl std::borrow::Borrow<Error>) -> Problem {
    match error.borrow() {
        Error::Failed { place, what, cure } => {
            let problem = Problem::error(&named.at, format!("{place}: {what}"));
            cure.iter().fold(problem, |problem, cure| problem.hint(cure))
        }
        other => Problem::error(&named.at, other.to_string()),
    }
}
