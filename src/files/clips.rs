//! Clips that a person names to make a scene of them: numbered pictures, by a pattern or by their folder, or a video.

use std::io::ErrorKind;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use super::{Limits, disk, paths, picture};
use crate::base::error::{Error, Result};
use crate::base::numbered::{Pattern, Series, series};
use crate::base::problem;
use crate::layers::parts::materials::List;

/// The files of a clip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClipFiles {
    /// The folder that they are in.
    pub folder: PathBuf,
    /// What a scene in that folder calls them: the pattern of their names, or the video.
    pub name: String,
    /// The number of the first frame.
    pub first: u64,
    /// Their names, in order.
    pub files: Vec<String>,
}

impl ClipFiles {
    /// The only one of its numbered files, of which nothing can move yet.
    pub fn alone(&self) -> Option<&str> {
        let [alone] = self.files.as_slice() else { return None };
        (*alone != self.name).then_some(alone)
    }

    /// Whether nothing moves in it, as far as its first, its middle and its last file tell.
    pub fn is_still(&self, limits: &Limits) -> bool {
        let read = |name: &String| paths::read(&self.folder.join(name), limits.memory).ok();
        let [first, .., last] = self.files.as_slice() else { return false };
        let first = read(first);
        first.is_some() && [&self.files[self.files.len() / 2], last].into_iter().all(|name| read(name) == first)
    }
}

/// Whether a file of this name is a video, or a pattern of numbered files.
pub fn is_called(name: &str) -> bool {
    is_video(name) || Pattern::of(name).is_ok_and(|pattern| pattern.is_numbered())
}

fn is_video(name: &str) -> bool {
    paths::kind_of(name) == Some(List::Clips)
}

/// Whether a person means a clip by this path. A file that is called as a pattern would be is that file.
pub fn is_one(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // What stands for a number otherwise than is known is told as that.
    let as_number =
        |spec: &str| spec.trim_start_matches(|c: char| c == '-' || c.is_ascii_digit()).starts_with(['d', 's', 'x']);
    let is_odd = || name.contains("%0") || name.split('%').skip(1).any(as_number);
    let is_pattern = || Pattern::of(&name).map_or_else(|_| is_odd(), |pattern| pattern.is_numbered());
    path.is_dir() || is_video(&name) || !path.is_file() && is_pattern()
}

/// What a clip is called in a scene, by the name of its files: what is before the number, or the name of their folder.
pub fn called<'a>(name: &'a str, folder: &'a str) -> &'a str {
    let stem = name.split('.').next().unwrap_or(name);
    let before = stem.split('%').next().unwrap_or_default().trim_end_matches(['-', '_', ' ']);
    if before.is_empty() { folder } else { before }
}

/// The clip that a person means by this path.
///
/// # Errors
/// If there is no such file; if a folder has no numbered pictures, or several clips.
pub fn find(path: &Path) -> Result<ClipFiles> {
    if path.is_dir() {
        return in_folder(path);
    }
    let (folder, name) = (disk::folder_of(path), path.file_name().unwrap_or_default().to_string_lossy());
    let pattern = Pattern::of(&name).map_err(|what| {
        Error::at(path.display(), what).cure("%04d stands for the number of a frame, as in falls/%04d.jpg")
    })?;
    if !pattern.is_numbered() {
        let (folder, name) = (folder.to_owned(), name.into_owned());
        return Ok(ClipFiles { folder, first: 0, files: vec![name.clone()], name });
    }
    let names = names(folder)?;
    let numbers = numbers(&names, &pattern);
    if numbers.is_empty() {
        return Err(Error::at(path.display(), "there is no such file").cure(meant(path, &pattern, &names)));
    }
    Ok(found(folder, Series { pattern: name.into_owned(), numbers }))
}

/// The numbers that files have by a pattern, ascending.
fn numbers(names: &[String], pattern: &Pattern) -> Vec<u64> {
    let mut numbers: Vec<u64> = names.iter().filter_map(|name| pattern.number(name)).collect();
    numbers.sort_unstable();
    numbers
}

/// What to do about a pattern by which no file is called: others may be there, by another pattern.
fn meant(path: &Path, pattern: &Pattern, names: &[String]) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut there = series(names.iter().map(String::as_str));
    there.retain(|one| one.numbers.len() > 1);
    let like = problem::like(&name, there.iter().map(|one| one.pattern.as_str()));
    let one = match (like, there.as_slice()) {
        (Some(like), all) => all.iter().find(|one| one.pattern == like),
        (None, [one]) => Some(one),
        (None, _) => None,
    };
    match one.and_then(|one| Some((one.file(0)?, one.file(one.numbers.len() - 1)?, &one.pattern))) {
        Some((first, last, other)) => {
            format!("{first} to {last} are there: write {}", path.with_file_name(other).display())
        }
        None => format!("its frames would be called {}, {} and so on", pattern.name(0), pattern.name(1)),
    }
}

/// The numbers of a clip's files that are nearest to `first` and follow each other without a gap.
pub fn run_near(path: &Path, first: u64) -> Option<RangeInclusive<u64>> {
    let pattern = Pattern::of(path.file_name()?.to_str()?).ok()?;
    let numbers = numbers(&names(disk::folder_of(path)).ok()?, &pattern);
    let runs = numbers.chunk_by(|one, next| one + 1 == *next).filter_map(|run| Some(*run.first()?..=*run.last()?));
    runs.min_by_key(|run| first.abs_diff(first.clamp(*run.start(), *run.end())))
}

/// The patterns of numbered files that begin with `typed`, or whose first file does, relative to `folder` unless absolute.
pub fn complete(folder: &Path, typed: &str) -> Vec<String> {
    let (parent, begun) = typed.rfind('/').map_or(("", typed), |at| typed.split_at(at + 1));
    let Ok(names) = names(&folder.join(paths::typed(parent))) else { return Vec::new() };
    let begins = |one: &Series| {
        let first = one.file(0).is_some_and(|name| name.starts_with(begun));
        one.numbers.len() > 1 && (first || one.pattern.starts_with(begun))
    };
    let found = series(names.iter().map(String::as_str)).into_iter().filter(begins);
    found.map(|one| format!("{parent}{}", one.pattern)).collect()
}

fn in_folder(folder: &Path) -> Result<ClipFiles> {
    let names = names(folder)?;
    let shown = |one: &Series| {
        let first = one.file(0).map(|name| folder.join(name));
        one.numbers.len() > 1 && first.is_some_and(|first| picture::is_one(&first))
    };
    let mut all: Vec<Series> = series(names.iter().map(String::as_str)).into_iter().filter(shown).collect();
    match all.as_slice() {
        [] => Err(no_series(folder, &names)),
        [one] if one.numbers.len() * 2 < names.iter().filter(|name| !name.starts_with('.')).count() => {
            let cure = format!("if they are a clip, name {}", folder.join(&one.pattern).display());
            let what = format!("holds {} numbered pictures among other files", one.numbers.len());
            Err(Error::at(folder.display(), what).cure(cure))
        }
        [_] => Ok(found(folder, all.remove(0))),
        several => {
            let patterns: Vec<&str> = several.iter().map(|one| one.pattern.as_str()).collect();
            let cure = format!("name one of them, as {}", folder.join(patterns[0]).display());
            Err(Error::at(folder.display(), format!("holds several clips: {}", patterns.join(", "))).cure(cure))
        }
    }
}

/// Why a folder has no clip.
fn no_series(folder: &Path, names: &[String]) -> Error {
    let numbered = |name: &&String| picture::is_one(&folder.join(name)) && name.contains(|c: char| c.is_ascii_digit());
    let what = match names.iter().find(numbered) {
        Some(alone) => format!("holds no two pictures with one name and different numbers; {alone} alone is no clip"),
        None => "holds no numbered pictures".to_owned(),
    };
    if paths::kind_of(&folder.to_string_lossy()) == Some(List::Meshes) {
        return Error::at(folder.display(), "is a folder, not a model").cure("name the model in it");
    }
    let cure = "name them as 0001.png, 0002.png and so on, or name a picture, a model or a video";
    Error::at(folder.display(), what).cure(cure)
}

/// The frames of a series up to the first number that is missing.
fn found(folder: &Path, all: Series) -> ClipFiles {
    let first = all.numbers.first().copied().unwrap_or(0);
    let together = all.numbers.iter().zip(first..).take_while(|(found, wanted)| **found == *wanted).count();
    let files = (0..together).filter_map(|i| all.file(i)).collect();
    ClipFiles { folder: folder.to_owned(), name: all.pattern, first, files }
}

fn names(folder: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder).map_err(|error| match error.kind() {
        ErrorKind::NotFound => Error::at(folder.display(), "there is no such folder").cure("mend the path"),
        _ => Error::at(folder.display(), error),
    })?;
    Ok(entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            image::RgbaImage::new(2, 2).save(path).unwrap();
        }
        folder
    }

    #[test]
    fn a_clip_of_the_same_picture_over_and_over_is_still() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |number: usize, text: &str| std::fs::write(folder.path().join(format!("{number}.png")), text).unwrap();
        (0..4).for_each(|number| write(number, "same"));
        let is_still = || find(&folder.path().join("%d.png")).unwrap().is_still(&Limits::default());
        assert!(is_still());
        write(3, "other");
        assert!(!is_still());
        (1..4).for_each(|number| std::fs::remove_file(folder.path().join(format!("{number}.png"))).unwrap());
        assert!(!is_still(), "a single picture");
        assert_eq!(find(&folder.path().join("%d.png")).unwrap().alone(), Some("0.png"));
    }

    #[test]
    fn a_pattern_and_its_folder_are_the_same_clip() {
        let folder = folder(&["a/0007.png", "a/0008.png", "a/0010.png", "a/cover.png"]);
        std::fs::write(folder.path().join("a/log1.txt"), "").unwrap();
        std::fs::write(folder.path().join("a/log2.txt"), "").unwrap();
        let by_folder = find(&folder.path().join("a")).unwrap();
        assert_eq!(find(&folder.path().join("a/%04d.png")).unwrap(), by_folder);
        assert_eq!((by_folder.name.as_str(), by_folder.first), ("%04d.png", 7));
        assert_eq!(by_folder.files, ["0007.png", "0008.png"]);
        for (first, run) in [(0, 7..=8), (8, 7..=8), (10, 10..=10), (99, 10..=10)] {
            assert_eq!(run_near(&folder.path().join("a/%04d.png"), first), Some(run), "{first}");
        }
    }

    #[test]
    fn what_is_no_clip_is_told_with_the_cure() {
        let some = ["some/a1.png", "some/a2.png", "some/b.png", "some/c.png", "some/d.png", "some/.hidden.png"];
        let folder = folder(
            &[&some[..], &["none/cat.png", "one/0000.png", "two/a1.png", "two/a2.png", "two/b1.png", "two/b2.png"]]
                .concat(),
        );
        for (name, told) in [
            ("none", "none: holds no numbered pictures (name them as 0001.png"),
            ("one", "one: holds no two pictures with one name and different numbers; 0000.png alone is no clip"),
            ("nosuch/%04d.png", "nosuch: there is no such folder"),
            ("some", "some: holds 2 numbered pictures among other files (if they are a clip, name "),
            ("two", "two: holds several clips: a%d.png, b%d.png (name one of them, as "),
            ("two/%04d.png", "there is no such file (its frames would be called 0000.png, 0001.png and so on)"),
            ("some/%04d.jpg", "there is no such file (a1.png to a2.png are there: write "),
            ("some/a%03d.png", "some/a%d.png)"),
            ("one/%d.png", "there is no such file (its frames"),
            ("two/a%d%d.png", "the name holds two frame numbers (%04d stands for"),
            ("two/%s.png", "\"%s\" is no frame number (%04d stands for"),
            ("two/%-4d.png", "\"%-\" is no frame number (%04d stands for"),
            ("two/%x.png", "\"%x\" is no frame number (%04d stands for"),
            ("two/%0999999999d.png", "\"%0999999999d\" asks for more than 20 digits (%04d stands for"),
            ("two/%99999999999999999999999d.png", "asks for more than 20 digits (%04d stands for"),
        ] {
            let path = folder.path().join(name);
            assert!(is_one(&path) || path.is_dir(), "{name}");
            let error = find(&path).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
        assert!(!is_one(&folder.path().join("none/cat.png")) && is_one(&folder.path().join("none")));
        assert!(is_one(Path::new("x.MP4")) && is_one(Path::new("%d.png")) && !is_one(Path::new("x.png")));
        assert!(is_one(Path::new("x%04x.png")) && !is_one(Path::new("100%.png")));
        let called_so = folder.path().join("none/100%d.obj");
        assert!(is_one(&called_so), "a pattern");
        std::fs::write(&called_so, "").unwrap();
        assert!(!is_one(&called_so), "a file of that name");
    }

    #[test]
    fn patterns_are_completed() {
        let folder = folder(&["a/0007.png", "a/0008.png", "a/x1.png", "a/y1.png", "a/y2.png"]);
        for (typed, expected) in [
            ("a/", &["a/%04d.png", "a/y%d.png"][..]),
            ("a/0", &["a/%04d.png"]),
            ("a/%", &["a/%04d.png"]),
            ("a/x", &[]),
            ("b/", &[]),
        ] {
            assert_eq!(complete(folder.path(), typed), expected, "{typed}");
        }
    }

    #[test]
    fn a_clip_is_called_by_its_files_or_their_folder() {
        for (name, expected) in [("%04d.jpg", "falls"), ("fire-%d.png", "fire"), ("fire.mp4", "fire")] {
            assert_eq!(called(name, "falls"), expected);
        }
    }
}
