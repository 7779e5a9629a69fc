//! Loads the files of a scene one by one, in parallel: those that have not changed stay as they are.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::named::Named;
use super::store::{Loaded, Stamp, Store};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::problem::Problem;
use crate::base::progress::Progress;
use crate::files::fields::{self, VectorField};
use crate::files::{Limits, Options, mesh, paths, picture};

/// Copies of the files that a scene on another machine names, by the path as written in the scene; or why there is no
/// copy.
pub type Copies = BTreeMap<String, std::result::Result<PathBuf, String>>;

/// Where the files are.
pub(super) enum Whereabouts<'a> {
    /// Beside the scene, or wherever its paths lead.
    Beside(&'a Path),
    /// On this machine, while the scene is on another.
    Copies(&'a Copies),
}

/// The files of a scene.
pub(super) struct Sources<'a> {
    pub(super) place: Whereabouts<'a>,
    pub(super) options: &'a Options,
}

impl Sources<'_> {
    /// The key of a file in the cache.
    pub(super) fn key(&self, path: &str) -> PathBuf {
        match self.place {
            // Layers of one file are separate pictures.
            Whereabouts::Beside(scene_path) => match paths::layer_of(path) {
                None => paths::beside(scene_path, path),
                Some(layer) => paths::beside(scene_path, path).join(format!("#{layer}")),
            },
            Whereabouts::Copies(_) => path.into(),
        }
    }

    pub(super) fn open(&self, path: &str) -> Result<File> {
        match self.place {
            Whereabouts::Beside(scene_path) => paths::open(scene_path, path, self.options),
            Whereabouts::Copies(copies) => match copies.get(path) {
                Some(Ok(copy)) => paths::open_named(copy),
                Some(Err(why)) => Err(Error::at(path, why)),
                None => Err(Error::at(path, "is not here yet")),
            },
        }
    }

    pub(super) fn load<T: Send + Sync>(
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
                    let old = store.get(&file).cloned();
                    problems.push(still_shown(problem(named, error), old.is_some()));
                    old
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

    pub(super) fn load_one<T>(
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
            let path = paths::sibling(path, name);
            let (file, stamp) = self.open_stamped(&path)?;
            beside.borrow_mut().push((path, stamp));
            Ok(file)
        };
        let (value, notes, share) = decode(file, path, allowed, &sibling)?;
        let (notes, share) = (notes.into(), Arc::new(share));
        Ok(Loaded { stamp, beside: beside.take().into(), value: Arc::new(value), notes, share })
    }

    pub(super) fn open_stamped(&self, path: &str) -> Result<(File, Stamp)> {
        let file = self.open(path)?;
        let stamp = Stamp::of(&file).map_err(|error| Error::at(path, error))?;
        Ok((file, stamp))
    }
}

/// What loading may consume, the flag that cancels it, and how far it is.
#[derive(Clone, Copy)]
pub(super) struct Allowed<'a> {
    pub(super) options: &'a Options,
    pub(super) limits: &'a Limits,
    pub(super) budget: &'a Budget,
    pub(super) stop: Option<&'a AtomicBool>,
    pub(super) progress: Option<&'a Progress>,
}

impl Allowed<'_> {
    pub(super) fn expect(&self, files: usize) {
        self.progress.iter().for_each(|progress| progress.expect(files as u64));
    }
}

/// Reads an open file; the path is its name in messages, and the last is for files that it names. Also returns what in
/// is not supported in it, and the memory that it takes.
pub(super) type Decode<'a, T> =
    &'a (dyn Fn(File, &str, Allowed, mesh::Opener) -> Result<(T, Vec<String>, Share)> + Sync);

pub(super) fn decode_mesh(
    file: File,
    place: &str,
    allowed: Allowed,
    sibling: mesh::Opener,
) -> Result<(Mesh, Vec<String>, Share)> {
    mesh::decode(file, place, allowed.options, allowed.budget, sibling)
}

pub(super) fn decode_picture(
    file: File,
    place: &str,
    allowed: Allowed,
    _: mesh::Opener,
) -> Result<(Picture, Vec<String>, Share)> {
    let (found, share) = picture::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((found.picture, found.notes, share))
}

pub(super) fn decode_field(
    file: File,
    place: &str,
    allowed: Allowed,
    _: mesh::Opener,
) -> Result<(VectorField, Vec<String>, Share)> {
    let (field, share) = fields::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((field, Vec::new(), share))
}

/// The problem with a file; tells where its last good version is used in its place.
pub(super) fn still_shown(problem: Problem, old: bool) -> Problem {
    let message = if old { problem.message + ", and what was read before is still shown" } else { problem.message };
    Problem { message, ..problem }
}

pub(super) fn problem(named: &Named, error: impl std::borrow::Borrow<Error>) -> Problem {
    match error.borrow() {
        Error::Failed { place, what, cure } => {
            let problem = Problem::error(&named.at, format!("{place}: {what}"));
            cure.iter().fold(problem, |problem, cure| problem.hint(cure))
        }
        other => Problem::error(&named.at, other.to_string()),
    }
}
