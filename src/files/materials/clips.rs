//! Clips: which files their frames are, and loading them. Each frame is kept for itself, so that only those that change
//! are read again.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs::File;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;

use super::named::{Named, frames};
use super::sources::{Allowed, Sources, Whereabouts, decode_picture, problem, still_shown};
use super::store::{Loaded, Store};
use crate::base::budget::Share;
use crate::base::clip::Clip;
use crate::base::error::{Error, Result};
use crate::base::picture::Picture;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::files::limits::within;
use crate::files::{self, disk, mesh, paths, picture, video};
use crate::scene::{self, Scene};

/// The clips that were loaded before, and their frames.
#[derive(Debug, Default)]
pub(super) struct Clips {
    frames: Store<Picture>,
    videos: Store<Vec<Arc<Picture>>>,
    made: HashMap<String, Made>,
}

/// A whole clip.
#[derive(Clone, Debug)]
struct Made {
    clip: Arc<Clip>,
    /// The memory of its frames, which it keeps even if some are replaced.
    _shares: Arc<[Arc<Share>]>,
}

impl Sources<'_> {
    /// Loads all clips of `scene`. One that cannot be loaded is replaced by its last good version.
    pub(super) fn clips(
        &self,
        scene: &Scene,
        allowed: Allowed,
        cache: &mut Clips,
        problems: &mut Vec<Problem>,
    ) -> BTreeMap<String, Arc<Clip>> {
        let mut kept = Clips::default();
        for (key, clip) in &scene.clips {
            let named = Named { key, path: &clip.path, at: Pointer("/clips").join(key) + "/path" };
            let old = cache.made.get(key);
            if let Some(path) = clip.frames().ok().filter(|frames| frames.is_video()).map(|frames| frames.path(0)) {
                let file = self.key(&path).join(format!("{} {:?}", clip.first, clip.count));
                let known = kept.videos.get(&file).or_else(|| cache.videos.get(&file));
                let made = match self.load_one(&path, allowed, &video(clip), known) {
                    Ok(video) => {
                        let made = made(clip.fps, &video.value, [video.share.clone()].into(), old);
                        kept.videos.insert(file, video);
                        Some(made)
                    }
                    Err(error) => {
                        problems.push(still_shown(problem(&named, self.no_folder(error, clip)), old.is_some()));
                        old.cloned()
                    }
                };
                kept.made.extend(made.map(|made| (key.clone(), made)));
                continue;
            }
            let loaded = self.clip(clip, allowed, [&cache.frames, &kept.frames], &named, problems);
            let whole: std::result::Result<Vec<_>, _> = loaded.iter().map(|(_, frame)| frame.as_ref()).collect();
            let made = match whole {
                Ok(frames) => {
                    problems.extend(self.gap(clip, frames.len() as u64, &named));
                    let pictures: Vec<_> = frames.iter().map(|frame| frame.value.clone()).collect();
                    Some(made(clip.fps, &pictures, frames.iter().map(|frame| frame.share.clone()).collect(), old))
                }
                Err(error) => {
                    problems.push(still_shown(problem(&named, error), old.is_some()));
                    old.cloned()
                }
            };
            kept.made.extend(made.map(|made| (key.clone(), made)));
            kept.frames.extend(loaded.into_iter().filter_map(|(path, frame)| Some((path, frame.ok()?))));
        }
        *cache = kept;
        cache.made.iter().map(|(key, made)| (key.clone(), made.clip.clone())).collect()
    }

    /// The frames of a clip, each by its key in the cache; with an error among them, perhaps not all.
    fn clip(
        &self,
        clip: &scene::Clip,
        allowed: Allowed,
        known: [&Store<Picture>; 2],
        named: &Named,
        problems: &mut Vec<Problem>,
    ) -> Vec<(PathBuf, Result<Loaded<Picture>>)> {
        let paths = frames(clip, |path| self.is_there(path));
        let [first, rest @ ..] = paths.as_slice() else { return Vec::new() };
        let old = |path: &str| known.into_iter().find_map(|store| store.get(&self.key(path)));
        let one = |path: &str, decode| self.load_one(path, allowed, decode, old(path));
        let start = one(first, &decode_picture).and_then(|start| {
            let new = rest.iter().filter(|path| old(path).is_none()).count() as u64;
            fits(named.path, &start.value, paths.len() as u64, new, allowed).map(|()| start)
        });
        let start = match start {
            Ok(start) => start,
            Err(error) => return vec![(self.key(first), Err(self.no_frame(error, first, clip, 0)))],
        };
        let size = (start.value.width(), start.value.height());
        let like_first = |file: File, place: &str, allowed: Allowed, _: mesh::Opener| {
            let found = |found| same_size(place, found, size);
            let (found, share) = picture::decode_if(file, place, allowed.limits, allowed.budget, found)?;
            Ok((found.picture, found.notes, share))
        };
        allowed.expect(rest.len());
        let load = |(before, path): (usize, &String)| {
            let loaded = one(path, &like_first).map_err(|error| self.no_frame(error, path, clip, before + 1));
            allowed.progress.iter().for_each(|progress| progress.done(1));
            // What was read before, as the first of another clip, say, has not been compared.
            loaded.and_then(|frame| same_size(path, (frame.value.width(), frame.value.height()), size).map(|()| frame))
        };
        let mut all = vec![(self.key(first), Ok(start))];
        all.par_extend(rest.par_iter().enumerate().map(|(i, path)| (self.key(path), load((i, path)))));
        notes(named, paths.iter().zip(all.iter().map(|(_, frame)| frame)), problems);
        all
    }

    /// That a clip of so many frames ends before one that is missing, while later ones are there.
    fn gap(&self, clip: &scene::Clip, count: u64, named: &Named) -> Option<Problem> {
        let Whereabouts::Beside(scene_path) = self.place else { return None };
        let frames = clip.frames().ok().filter(|_| clip.count.is_none())?;
        let first = paths::beside(scene_path, &frames.path(0));
        let names = std::fs::read_dir(disk::folder_of(&first)).ok()?.flatten().map(|entry| entry.file_name());
        let later = names.filter_map(|name| frames.index(name.to_str()?)).filter(|index| *index > count).min()?;
        let (last, missing) = (frames.path(count.checked_sub(1)?), frames.path(count));
        let told = Problem::warning(&named.at, format!("ends at {last}, but {} is there", frames.path(later)));
        Some(told.hint(format!("put {missing} there, or set the clip's count to {count}")))
    }

    /// What to do if the path of a clip is that of a folder.
    fn no_folder(&self, error: Error, clip: &scene::Clip) -> Error {
        let Whereabouts::Beside(scene_path) = self.place else { return error };
        let folder = paths::beside(scene_path, &clip.path);
        if !folder.is_dir() {
            return error;
        }
        let found = files::clips::find(&folder).ok();
        let (name, first) = found.map_or(("%04d.png".into(), 0), |found| (found.name, found.first));
        let from = if first > 0 { format!(", and \"first\": {first}") } else { String::new() };
        error.cure(format!("write {}/{name}{from}", clip.path.trim_end_matches('/')))
    }

    /// What to do if a frame is not there; `before` it are others.
    fn no_frame(&self, error: Error, path: &str, clip: &scene::Clip, before: usize) -> Error {
        let Whereabouts::Beside(scene_path) = self.place else { return error };
        if !paths::is_missing(scene_path, path, self.options) {
            return error;
        }
        if before > 0 {
            // Only a clip that says how many there are counts on one that is not there.
            return error.cure(format!("lower the clip's count to {before}, or put the frame there"));
        }
        let there = files::clips::run_near(&paths::beside(scene_path, &clip.path), clip.first.into());
        let Some((first, last)) = there.map(RangeInclusive::into_inner) else { return error };
        let found = if first == last { format!("number {first} is") } else { format!("numbers {first} to {last} are") };
        error.cure(format!("{found} there: set the clip's first to {first}"))
    }

    fn is_there(&self, path: &str) -> bool {
        match self.place {
            Whereabouts::Beside(scene_path) => paths::beside(scene_path, path).exists(),
            Whereabouts::Copies(copies) => copies.contains_key(path),
        }
    }
}

/// A clip of these frames; the `old` one if it has the same.
fn made(fps: f64, frames: &[Arc<Picture>], shares: Arc<[Arc<Share>]>, old: Option<&Made>) -> Made {
    let same = |old: &&Made| {
        let pairs = || old.clip.frames.iter().zip(frames);
        old.clip.fps == fps && old.clip.frames.len() == frames.len() && pairs().all(|(a, b)| Arc::ptr_eq(a, b))
    };
    let new = || Made { clip: Arc::new(Clip { fps, frames: frames.to_vec() }), _shares: shares };
    old.filter(same).cloned().unwrap_or_else(new)
}

/// Reads the frames of a video that a clip names.
fn video(
    clip: &scene::Clip,
) -> impl Fn(File, &str, Allowed, mesh::Opener) -> Result<(Vec<Arc<Picture>>, Vec<String>, Share)> {
    let wanted = video::Wanted { first: clip.first, count: clip.count };
    move |file, place, Allowed { limits, budget, stop, .. }, _| {
        let (frames, share) = video::decode(file, place, wanted, video::Allowed { limits, budget, stop })?;
        Ok((frames, Vec::new(), share))
    }
}

/// Refuses a clip that is too long or too large, before its frames are read; `new` of them have not been before.
fn fits(place: &str, first: &Picture, count: u64, new: u64, allowed: Allowed) -> Result<()> {
    let (limits, pixels) = (allowed.limits, first.width() as u64 * first.height() as u64);
    within(place, "it has", "frames", "frames", count, limits.frames)?;
    within(place, "its frames have", "pixels together", "clip", pixels.saturating_mul(count), limits.clip)?;
    allowed.budget.take(first.bytes().saturating_mul(new), place).map(drop)
}

fn same_size(place: &str, found: (usize, usize), first: (usize, usize)) -> Result<()> {
    if found == first {
        return Ok(());
    }
    let what = format!("is {} x {}, and the clip's first frame {} x {}", found.0, found.1, first.0, first.1);
    Err(Error::at(place, what).cure("make all frames of one size"))
}

/// Warns of what is not supported; what holds for several frames is told once.
fn notes<'a>(
    named: &Named,
    frames: impl Iterator<Item = (&'a String, &'a Result<Loaded<Picture>>)>,
    problems: &mut Vec<Problem>,
) {
    let mut told = BTreeSet::new();
    for (path, frame) in frames {
        let notes = frame.iter().flat_map(|frame| frame.notes.iter());
        let new: Vec<&String> = notes.filter(|note| told.insert((*note).clone())).collect();
        problems.extend(new.into_iter().map(|note| Problem::warning(&named.at, format!("{path}: {note}"))));
    }
}
