//! Loads the files that a scene names, pictures and vector fields, in parallel. A cache keeps what did not change, and
//! the last good version of what cannot be read just now.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs::File;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::fields::{self, VectorField};
use super::{Limits, Options, paths, picture};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::mask;
use crate::base::picture::Picture;
use crate::base::problem::{Problem, Severity};
use crate::layers::parts::materials::{Materials, Of, Use, What};
use crate::scene::{Scene, check, pointer};

/// What was loaded before, by path, for as long as the scene names it.
#[derive(Debug, Default)]
pub struct Cache {
    pictures: Store<Picture>,
    /// What masks without alpha were turned into.
    masks: Vec<Masked>,
    fields: Store<VectorField>,
    /// The memory that is left for the files and what is made from them; by the limits at the first use.
    budget: Option<Budget>,
    /// Cancels the loading.
    pub stop: Option<Arc<AtomicBool>>,
}

impl Cache {
    /// An empty cache; loading ends when `stop` is set.
    pub fn until(stop: Arc<AtomicBool>) -> Self {
        Cache { stop: Some(stop), ..Cache::default() }
    }
}

type Store<T> = HashMap<PathBuf, Loaded<T>>;

/// A loaded file, and the memory that it takes.
#[derive(Debug)]
struct Loaded<T> {
    stamp: Stamp,
    value: Arc<T>,
    /// What in the file could not be honoured, in words.
    notes: Arc<[String]>,
    share: Arc<Share>,
}

/// A mask without alpha, applied to the picture that it is for.
#[derive(Clone, Debug)]
struct Masked {
    mask: Arc<Picture>,
    own: Arc<Picture>,
    made: Arc<Picture>,
    /// Released with the rest.
    _share: Arc<Share>,
}

impl<T> Clone for Loaded<T> {
    fn clone(&self) -> Self {
        Loaded { stamp: self.stamp, value: self.value.clone(), notes: self.notes.clone(), share: self.share.clone() }
    }
}

/// A file's identity and version; another program cannot change the file without changing this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stamp([i128; 5]);

impl Stamp {
    pub(super) fn of(file: &File) -> std::io::Result<Self> {
        let found = file.metadata()?;
        let nanos = |secs: i64, nanos: i64| i128::from(secs) * 1_000_000_000 + i128::from(nanos);
        Ok(Stamp([
            i128::from(found.dev()),
            i128::from(found.ino()),
            i128::from(found.len()),
            nanos(found.mtime(), found.mtime_nsec()),
            nanos(found.ctime(), found.ctime_nsec()),
        ]))
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
        let file = paths::open(scene_path, named.path, options)?;
        picture::header(file, named.path, &options.limits)
    };
    let mut sizes = BTreeMap::new();
    let mut problems = Vec::new();
    for named in named_pictures(scene) {
        match measure(&named) {
            Ok(size) => drop(sizes.insert(named.key.to_owned(), size)),
            Err(error) => problems.push(problem(&named, error)),
        }
    }
    for named in named_fields(scene) {
        problems.extend(paths::open(scene_path, named.path, options).err().map(|error| problem(&named, error)));
    }
    (sizes, problems)
}

/// The files that `scene` names, for watching.
pub fn files(scene_path: &Path, scene: &Scene) -> Vec<PathBuf> {
    let named = named_pictures(scene).into_iter().chain(named_fields(scene));
    named.map(|named| paths::beside(scene_path, named.path)).collect()
}

/// The same, as the paths written in the scene.
pub(super) fn paths(scene: &Scene) -> BTreeSet<&str> {
    named_pictures(scene).into_iter().chain(named_fields(scene)).map(|named| named.path).collect()
}

/// A file that a scene names.
struct Named<'a> {
    /// Its key in [`Materials`].
    key: &'a str,
    /// The path as written.
    path: &'a str,
    /// Where it is written: a JSON pointer.
    at: String,
}

fn named_pictures(scene: &Scene) -> Vec<Named<'_>> {
    let at = |key: &str| pointer::join("/images", key) + "/path";
    scene.images.iter().map(|(key, image)| Named { key, path: &image.path, at: at(key) }).collect()
}

fn named_fields(scene: &Scene) -> Vec<Named<'_>> {
    let fields = scene.uses().filter_map(|Use { at, of, what }| match (of, what) {
        (Of::Path(path), What::Vectors) => Some(Named { key: path, path, at }),
        (Of::Name(..), _) | (Of::Path(_), What::Picture | What::Mask { .. } | What::Mesh | What::Layer) => None,
    });
    fields.collect()
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
        let allowed = Allowed { limits: &self.options.limits, budget: &budget, stop: stop.as_deref() };
        let pictures = self.load(&named_pictures(scene), allowed, decode_picture, &mut cache.pictures, &mut problems);
        let fields = self.load(&named_fields(scene), allowed, decode_field, &mut cache.fields, &mut problems);
        let mut materials = Materials { pictures, fields, stop, budget, ..Materials::default() };
        problems.extend(check::check_materials(scene, &materials));
        lay_masks(scene, &mut materials, &mut cache.masks, &mut problems);
        problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
        (materials, problems)
    }

    /// The key of a file in the cache.
    fn key(&self, path: &str) -> PathBuf {
        match self.place {
            // Layers of one file are separate pictures.
            Place::Beside(scene_path) => match paths::layer_of(path) {
                None => paths::beside(scene_path, path),
                Some(layer) => paths::beside(scene_path, path).join(format!("#{layer}")),
            },
            Place::Copies(_) => path.into(),
        }
    }

    fn open(&self, path: &str) -> Result<File> {
        match self.place {
            Place::Beside(scene_path) => paths::open(scene_path, path, self.options),
            Place::Copies(copies) => match copies.get(path) {
                Some(Ok(copy)) => paths::open_named(copy),
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
        let loaded: HashMap<PathBuf, Result<Loaded<T>>> = files
            .into_par_iter()
            .map(|(file, path)| {
                let loaded = self.load_one(path, allowed, decode, store.get(&file));
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
        let file = self.open(path)?;
        let stamp = Stamp::of(&file).map_err(|error| Error::at(path, error))?;
        if let Some(old) = old.filter(|old| old.stamp == stamp) {
            return Ok(old.clone());
        }
        let (value, notes, share) = decode(file, path, allowed)?;
        Ok(Loaded { stamp, value: Arc::new(value), notes: notes.into(), share: Arc::new(share) })
    }
}

/// What loading may consume, and the flag that cancels it.
#[derive(Clone, Copy)]
struct Allowed<'a> {
    limits: &'a Limits,
    budget: &'a Budget,
    stop: Option<&'a AtomicBool>,
}

/// Reads an open file; the path is its name in messages. Also returns what in it could not be honoured, and the memory
/// that it takes.
type Decode<T> = fn(File, &str, Allowed) -> Result<(T, Vec<String>, Share)>;

fn decode_picture(file: File, place: &str, allowed: Allowed) -> Result<(Picture, Vec<String>, Share)> {
    let (found, share) = picture::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((found.picture, found.notes, share))
}

fn decode_field(file: File, place: &str, allowed: Allowed) -> Result<(VectorField, Vec<String>, Share)> {
    let (field, share) = fields::decode(file, place, allowed.limits, allowed.budget)?;
    Ok((field, Vec::new(), share))
}

/// Applies masks without alpha to their pictures once, not every time they are read.
fn lay_masks(scene: &Scene, materials: &mut Materials, known: &mut Vec<Masked>, problems: &mut Vec<Problem>) {
    let mut kept: Vec<Masked> = Vec::new();
    for Use { at, of, what } in scene.uses() {
        let (Of::Name(_, name), What::Mask { on }) = (of, what) else { continue };
        let (Some(mask), Some(own)) = (materials.pictures.get(name), materials.pictures.get(on)) else { continue };
        if mask.channels().have_alpha() || !mask::fits(own, mask) {
            continue;
        }
        let same = |m: &&Masked| Arc::ptr_eq(&m.mask, mask) && Arc::ptr_eq(&m.own, own);
        let masked = match known.iter().chain(&kept).find(same) {
            Some(masked) => masked.clone(),
            None => match materials.budget.try_take(mask::bytes(own, mask)) {
                Ok(share) => {
                    let made = Arc::new(mask::by_brightness(own, mask));
                    Masked { mask: mask.clone(), own: own.clone(), made, _share: Arc::new(share) }
                }
                Err(short) => {
                    problems.push(short.problem(at));
                    continue;
                }
            },
        };
        materials.masks.insert((name.to_owned(), on.to_owned()), masked.made.clone());
        kept.push(masked);
    }
    *known = kept;
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

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageBuffer, Luma};

    fn scene(images: &[(&str, &str)], field: Option<&str>) -> Scene {
        let images: serde_json::Map<_, _> =
            images.iter().map(|(name, path)| (name.to_string(), serde_json::json!({ "path": path }))).collect();
        let motion: Vec<_> = field.iter().map(|path| serde_json::json!({ "tool": "field", "path": path })).collect();
        let outline = serde_json::json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 1, "height": 1 });
        serde_json::from_value(serde_json::json!({ "plica": 1, "images": images, "layers": [{
            "kind": "picture", "name": "l", "image": "a",
            "zones": [{ "name": "z", "outline": outline, "motion": motion }]
        }] }))
        .unwrap()
    }

    fn paint(folder: &Path, name: &str, width: u32) {
        let image: DynamicImage = ImageBuffer::from_pixel(width, 1, Luma([9u8])).into();
        image.save(folder.join(name)).unwrap();
    }

    #[test]
    fn what_did_not_change_is_not_loaded_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.plica.json");
        paint(folder.path(), "a.png", 2);
        paint(folder.path(), "b.png", 3);
        let scene = scene(&[("a", "a.png"), ("b", "b.png"), ("again", "a.png")], None);
        let mut cache = Cache::default();
        let options = Options::default();
        let (first, _) = load(&path, &scene, &options, &mut cache).unwrap();
        assert!(Arc::ptr_eq(&first.pictures["a"], &first.pictures["again"]));
        paint(folder.path(), "b.png", 4);
        let (second, _) = load(&path, &scene, &options, &mut cache).unwrap();
        assert!(Arc::ptr_eq(&first.pictures["a"], &second.pictures["a"]));
        assert_eq!(second.pictures["b"].width(), 4);
        std::fs::write(folder.path().join("b.png"), "half a pict").unwrap();
        for _ in 0..2 {
            let (third, problems) = gather(&path, &scene, &options, &mut cache);
            assert!(Arc::ptr_eq(&third.pictures["b"], &second.pictures["b"]), "the last good one");
            assert_eq!(problems.iter().map(|p| p.path.as_str()).collect::<Vec<_>>(), ["/images/b/path"]);
        }
        assert_eq!(files(&path, &scene).len(), 3);
    }

    #[test]
    fn every_problem_has_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.plica.json");
        paint(folder.path(), "good.png", 2);
        let scene = scene(&[("a", "missing.png"), ("b/c~d", "../out.png"), ("good", "good.png")], Some("v.flo"));
        let problems = load(&path, &scene, &Options::default(), &mut Cache::default()).unwrap_err();
        let places = |problems: &[Problem]| problems.iter().map(|p| p.path.clone()).collect::<Vec<_>>();
        let expected = ["/images/a/path", "/images/b~1c~0d/path", "/layers/0/zones/0/motion/0/path"];
        assert_eq!(places(&problems), expected);
        assert!(problems[1].hint.as_ref().unwrap().contains("--allow-outside"));
        let (sizes, problems) = sizes(&path, &scene, &Options::default());
        assert_eq!(sizes, BTreeMap::from([("good".to_owned(), (2, 1))]));
        assert_eq!(places(&problems), expected, "fields are looked for too");
    }

    #[test]
    fn copies_stand_for_files_on_another_machine() {
        let folder = tempfile::tempdir().unwrap();
        paint(folder.path(), "0.png", 2);
        paint(folder.path(), "1.png", 3);
        let scene = scene(&[("a", "a.png"), ("b", "../b.png"), ("c", "c.png")], None);
        let mut cache = Cache::default();
        let mut copies =
            Copies::from([("a.png".into(), Ok(folder.path().join("0.png"))), ("c.png".into(), Err("no".into()))]);
        let mut look = |copies: &Copies| {
            let (materials, problems) = gather_copies(copies, &scene, &Options::default(), &mut cache);
            (
                materials.pictures.get("a").map(|a| a.width()),
                problems.iter().map(|p| p.message.clone()).collect::<Vec<_>>(),
            )
        };
        let missing = vec!["../b.png: is not here yet".to_owned(), "c.png: no".to_owned()];
        assert_eq!(look(&copies), (Some(2), missing.clone()));
        copies.insert("a.png".into(), Ok(folder.path().join("1.png")));
        assert_eq!(look(&copies), (Some(3), missing));
        copies.insert("a.png".into(), Err("gone".into()));
        assert_eq!(look(&copies).0, Some(3), "the last good one");
    }
}
