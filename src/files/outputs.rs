//! Everything that a command writes goes through here: [`Guard`] gives out the [`Cleared`]s for drafts. Nothing that an
//! open scene reads is ever replaced, whatever link or spelling leads to it; other files only by the same kind of file,
//! or if forced. All of this is decided before work begins.

use std::collections::BTreeSet;
use std::fs::{self, File, Metadata};
use std::io::{Read, Seek, SeekFrom};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use super::{disk, holder, journal, materials, paths, temporary};
use crate::base::error::{Error, Result};
use crate::layers;
use crate::scene::Scene;

/// A kind of file that is written. Encoders bring theirs; those that several parts of the program write are here.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// What messages call it.
    pub name: &'static str,
    /// Whether a file that is there already is of this kind.
    pub is: fn(&Existing) -> bool,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Kind) -> bool {
        self.name == other.name
    }
}

/// Refuses standard output, where files are written.
///
/// # Errors
/// If a person named it.
pub fn no_stream(path: &Path) -> Result<()> {
    match path.as_os_str() == "-" {
        true => Err(Error::Usage(
            "-o -: this goes to files, not to standard output: name one (./- if it is called so)".into(),
        )),
        false => Ok(()),
    }
}

/// A file that is there already.
pub struct Existing<'a> {
    /// Its path.
    pub path: &'a Path,
    /// Its length in bytes.
    pub length: u64,
    /// Its first bytes.
    pub head: &'a [u8],
}

/// How many first bytes are looked at.
const HEAD: usize = 512;

/// A longer file is no style, in bytes.
const LONGEST_STYLE: u64 = 1 << 20;

/// The first line of a table of jump vectors.
pub const CSV_HEADER: &str = "x,y,dx,dy,length,degrees";

/// PNG, animated or not.
pub const PNG: Kind = Kind { name: "PNG", is: |found| found.head.starts_with(b"\x89PNG\r\n\x1a\n") };
/// A drawing.
pub const SVG: Kind = Kind {
    name: "SVG drawing",
    is: |found| found.head.starts_with(b"<") && found.head.windows(4).any(|four| four == b"<svg"),
};
/// A table of jump vectors, as `plica field` writes it.
pub const CSV: Kind =
    Kind { name: "table that plica field wrote", is: |found| found.head.starts_with(CSV_HEADER.as_bytes()) };
/// A style, as `plica style save` writes it.
pub const STYLE: Kind =
    Kind { name: "style that plica style save wrote", is: |found| found.head.starts_with(b"{") && is_style(found) };
/// OpenEXR.
pub const EXR: Kind = Kind { name: "OpenEXR picture", is: |found| found.head.starts_with(b"\x76\x2f\x31\x01") };

/// Whether a file holds the table of a style, whole; a scene that has one in it is none.
fn is_style(found: &Existing) -> bool {
    let text = if found.length <= LONGEST_STYLE { fs::read_to_string(found.path).ok() } else { None };
    let table = text.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
    let styles = || layers::KINDS.iter().filter_map(|kind| kind.styles);
    table.is_some_and(|table| styles().any(|styles| styles.marks.iter().all(|field| table.get(field).is_some())))
}

/// The kinds above.
pub const KINDS: [Kind; 5] = [PNG, SVG, CSV, STYLE, EXR];

impl Kind {
    /// Whether the file at `path` is of this kind.
    fn is_of(self, path: &Path, length: u64) -> std::io::Result<bool> {
        let mut head = Vec::new();
        File::open(path)?.take(HEAD as u64).read_to_end(&mut head)?;
        Ok((self.is)(&Existing { path, length, head: &head }))
    }
}

/// A file that may be written: the guard has checked it.
#[derive(Clone, Debug)]
pub struct Cleared(PathBuf);

impl Cleared {
    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

/// A folder whose files may be written: existing files with the same names are from an earlier run.
#[derive(Clone, Debug)]
pub struct ClearedFolder {
    path: PathBuf,
    /// The files of the earlier output.
    pub earlier: BTreeSet<String>,
}

impl ClearedFolder {
    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// A file that must not be replaced.
#[derive(Debug)]
struct Input {
    /// Its folder without links, and its name in lower case: identifies files that do not exist yet.
    place: Option<(PathBuf, String)>,
    /// Device and inode: identifies existing files, whatever their name.
    file: Option<(u64, u64)>,
    /// Why it must not be replaced.
    what: String,
}

/// Knows which files must not be replaced, and allows the rest.
#[derive(Debug, Default)]
pub struct Guard {
    inputs: Vec<Input>,
    force: bool,
    notes: Vec<String>,
}

impl Guard {
    /// A guard; with `force`, files of another kind may be replaced.
    pub fn new(force: bool) -> Guard {
        Guard { force, ..Guard::default() }
    }

    /// Protects the scene at `path` (`-` is standard input), its journal, and every file that it names.
    pub fn protect(&mut self, path: &Path, scene: &Scene) {
        let called = if path == Path::new("-") { "the scene".to_owned() } else { path.display().to_string() };
        if path != Path::new("-") {
            let real = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
            self.keep(path, "is the scene itself".into());
            let journals = [Some(journal::path_beside(&real)), journal::path_in_state(&real)];
            for journal in journals.into_iter().flatten().chain([holder::path_beside(&real)]) {
                self.keep(&journal, format!("belongs to the journal of {called}"));
            }
        }
        // A folder of frames would hold two clips.
        let folders = scene.clips.values().filter_map(|clip| clip.path.rsplit_once('/').map(|(folder, _)| folder));
        folders.for_each(|folder| self.keep(&paths::beside(path, folder), format!("holds a clip of {called}")));
        for name in materials::paths(path, scene).into_iter().chain(materials::ahead(path, scene)) {
            // What follows a # says which part of the file is meant.
            for name in [Some(&*name), name.rsplit_once('#').map(|(file, _)| file)].into_iter().flatten() {
                self.keep(&paths::beside(path, name), format!("is read by {called}"));
            }
        }
    }

    fn keep(&mut self, path: &Path, what: String) {
        let file = fs::metadata(path).ok().map(|found| identity(&found));
        self.inputs.push(Input { place: place(path), file, what });
    }

    /// Why the file at `path` must not be replaced; `None` if it may be.
    fn kept(&self, path: &Path) -> Option<&str> {
        let (found, place) = (fs::metadata(path).ok().map(|found| identity(&found)), place(path));
        let is = |input: &&Input| match (input.file, found) {
            (Some(input), Some(found)) => input == found,
            _ => input.place.is_some() && input.place == place,
        };
        self.inputs.iter().find(is).map(|input| input.what.as_str())
    }

    /// Refuses a file that must not be replaced, a link that leads to none, and standard output.
    ///
    /// # Errors
    /// The message says why.
    pub fn spare(&self, path: &Path) -> Result<()> {
        no_stream(path)?;
        if let Some(what) = paths::dead_link(path) {
            return Err(Error::at(path.display(), what).cure("mend the link, or name another place for the output"));
        }
        match self.kept(path) {
            None => Ok(()),
            Some(what) => Err(Error::at(path.display(), format!("{what}: no output may replace it"))
                .cure("name another place for the output")),
        }
    }

    /// The place at `path`, for a file of this kind.
    ///
    /// # Errors
    /// If the file must not be replaced, or is of another kind and not forced.
    pub fn file(&mut self, path: &Path, kind: Kind) -> Result<Cleared> {
        let place = self.one(path, kind)?;
        self.clear(disk::folder_of(path));
        Ok(place)
    }

    /// The same for many files in `folder`.
    ///
    /// # Errors
    /// As [`Guard::file`].
    pub fn files(&mut self, folder: &Path, names: &[String], kind: Kind) -> Result<Vec<Cleared>> {
        let places = names.iter().map(|name| self.one(&folder.join(name), kind)).collect::<Result<_>>()?;
        self.clear(folder);
        Ok(places)
    }

    fn one(&self, path: &Path, kind: Kind) -> Result<Cleared> {
        self.spare(path)?;
        let place = Cleared(path.to_owned());
        let Ok(found) = fs::metadata(path) else { return Ok(place) };
        if self.force || !found.is_file() || found.len() == 0 {
            return Ok(place);
        }
        match kind.is_of(path, found.len()) {
            Ok(true) => Ok(place),
            Ok(false) => Err(in_the_way(path, format!("is there already and is no {}", kind.name))),
            Err(error) => Err(in_the_way(path, format!("is there already and cannot be read: {error}"))),
        }
    }

    /// The folder at `path`, for a set of files. `may_write` says which names the set may contain; `earlier` are the
    /// names of an earlier output of the same command there.
    ///
    /// # Errors
    /// If a file with such a name must not be replaced, or is not from an earlier output and not forced.
    pub fn folder(
        &mut self,
        path: &Path,
        may_write: &dyn Fn(&str) -> bool,
        earlier: BTreeSet<String>,
    ) -> Result<ClearedFolder> {
        self.spare(path)?;
        for entry in fs::read_dir(path).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if may_write(&name) || earlier.contains(&name) {
                self.spare(&path.join(&name))?;
            }
            if may_write(&name) && !earlier.contains(&name) && !self.force {
                let what = "is there already, and no earlier output names it";
                return Err(in_the_way(&path.join(&name), what.into()));
            }
        }
        self.clear(path);
        self.clear(disk::folder_of(path));
        Ok(ClearedFolder { path: path.to_owned(), earlier })
    }

    fn clear(&mut self, folder: &Path) {
        let folder = if folder == Path::new("") { Path::new(".") } else { folder };
        let count = temporary::remove_stale(folder);
        if count > 0 {
            let what = if count == 1 { "an unfinished output" } else { "unfinished outputs" };
            self.notes.push(format!("{}: cleared {what} of a run that was killed ({count})", folder.display()));
        }
    }

    /// Notes for the person, one line each; each is returned only once.
    pub fn notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }
}

fn in_the_way(path: &Path, what: String) -> Error {
    Error::at(path.display(), what).cure("name another one, or give --force to replace it")
}

/// Whether two paths name one file by the same name.
pub fn is_same(one: &Path, other: &Path) -> bool {
    let folder = |path: &Path| fs::canonicalize(disk::folder_of(path)).ok();
    one.file_name() == other.file_name() && folder(one).is_some() && folder(one) == folder(other)
}

fn identity(found: &Metadata) -> (u64, u64) {
    (found.dev(), found.ino())
}

fn place(path: &Path) -> Option<(PathBuf, String)> {
    let folder = fs::canonicalize(disk::folder_of(path)).ok()?;
    Some((folder, path.file_name()?.to_string_lossy().to_lowercase()))
}

/// The paths that a scene saved at `path` would name but not find, as written.
pub fn missing(path: &Path, scene: &Scene) -> Vec<String> {
    let named = materials::paths(path, scene).into_iter();
    let there = |name: &str| paths::beside(path, name.rsplit_once('#').map_or(name, |(file, _)| file)).exists();
    named.filter(|name| !there(name) && !paths::beside(path, name).exists()).collect()
}

/// Whether a scene at `path` reads the picture at `picture`: this layer of it, where one is named.
pub fn reads(path: &Path, scene: &Scene, picture: &Path) -> bool {
    let wanted = picture.to_string_lossy();
    let (file, layer) = (Path::new(paths::file_of(&wanted)), paths::layer_of(&wanted));
    let is_file = |other: &Path| match (fs::metadata(file), fs::metadata(other)) {
        (Ok(one), Ok(two)) => identity(&one) == identity(&two),
        (one, two) => one.is_err() && two.is_err() && is_same(file, other),
    };
    let fits = |name: &String| layer.is_none() || paths::layer_of(name) == layer;
    materials::paths(path, scene).into_iter().filter(fits).any(|name| is_file(&paths::beside(path, &name)))
}

/// The first and the last bytes of the file at `path`; fewer if it is shorter.
///
/// # Errors
/// If it is no regular file, or cannot be read.
pub fn ends(path: &Path, first: usize, last: usize) -> Result<(Vec<u8>, Vec<u8>)> {
    let mut file = paths::open_named(path)?;
    let (mut head, mut tail) = (Vec::new(), Vec::new());
    let mut read = || {
        let length = file.metadata()?.len();
        (&mut file).take(first as u64).read_to_end(&mut head)?;
        file.seek(SeekFrom::Start(length.saturating_sub(last as u64)))?;
        (&mut file).take(last as u64).read_to_end(&mut tail)
    };
    read().map_err(|error| Error::at(path.display(), error))?;
    Ok((head, tail))
}

/// The total size of the files at `paths`, in bytes.
pub fn size<'a>(paths: impl IntoIterator<Item = &'a Path>) -> u64 {
    paths.into_iter().filter_map(|path| fs::metadata(path).ok()).map(|found| found.len()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;
    use std::os::unix::fs::symlink;

    const PNG_FILE: &[u8] = b"\x89PNG\r\n\x1a\n and more";

    /// A scene that reads `sub/cat.png`, `missing.flo`, `layers.exr#beauty` and a clip of two frames, in a folder with links
    /// to them.
    fn folder() -> (tempfile::TempDir, Guard) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir(root.join("sub")).unwrap();
        for name in ["sub/cat.png", "layers.exr", "other.png", "sub/0007.png", "sub/0008.png"] {
            fs::write(root.join(name), PNG_FILE).unwrap();
        }
        let text = r#"{"plica": 1, "images": {"cat": {"path": "sub/cat.png"}, "exr": {"path": "layers.exr#beauty"}},
            "clips": {"falls": {"path": "sub/%04d.png", "first": 7}},
            "layers": [{"kind": "picture", "name": "l", "image": "cat", "zones": [{"name": "z",
            "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 2, "height": 2},
            "motion": [{"tool": "field", "path": "missing.flo"}]}]}]}"#;
        fs::write(root.join("s.plica.json"), text).unwrap();
        symlink("sub/cat.png", root.join("link.png")).unwrap();
        symlink("link.png", root.join("chain.png")).unwrap();
        symlink("sub", root.join("folder")).unwrap();
        symlink("s.plica.json", root.join("scene-link.png")).unwrap();
        symlink("away.png", root.join("nowhere.png")).unwrap();
        symlink("loop.png", root.join("loop.png")).unwrap();
        symlink("other.png", root.join("another.png")).unwrap();
        fs::hard_link(root.join("sub/cat.png"), root.join("hard.png")).unwrap();
        let mut guard = Guard::new(true);
        guard.protect(&root.join("s.plica.json"), Document::parse(text).unwrap().scene());
        (folder, guard)
    }

    #[test]
    fn what_a_scene_reads_stays_whatever_it_is_called() {
        let (folder, mut guard) = folder();
        for (name, what) in [
            ("sub/cat.png", Some("is read by")),
            ("folder/cat.png", Some("is read by")),
            ("sub/../sub/cat.png", Some("is read by")),
            ("link.png", Some("is read by")),
            ("chain.png", Some("is read by")),
            ("hard.png", Some("is read by")),
            ("missing.flo", Some("is read by")),
            ("sub/../Missing.FLO", Some("is read by")),
            ("layers.exr", Some("is read by")),
            ("sub/0007.png", Some("is read by")),
            ("folder/0008.png", Some("is read by")),
            ("sub/0009.png", Some("is read by")),
            ("sub/0010.png", None),
            ("sub/0006.png", None),
            ("s.plica.json", Some("the scene itself")),
            ("scene-link.png", Some("the scene itself")),
            (".s.journal", Some("journal")),
            (".s.editor", Some("journal")),
            ("other.png", None),
            ("another.png", None),
            ("nowhere.png", Some("is a link to away.png, which is not there (mend the link, or name another place")),
            ("loop.png", Some("is a link that leads back to itself (mend the link, or name another place")),
            ("sub/missing.flo", None),
            ("new.png", None),
            ("sub/cat2.png", None),
        ] {
            let refused = guard.file(&folder.path().join(name), PNG).err().map(|error| error.to_string());
            match what {
                None => assert_eq!(refused, None, "{name}"),
                Some(what) => assert!(refused.as_ref().is_some_and(|said| said.contains(what)), "{name}: {refused:?}"),
            }
        }
        let text = fs::read_to_string(folder.path().join("s.plica.json")).unwrap();
        let document = Document::parse(&text).unwrap();
        assert_eq!(missing(&folder.path().join("copy.json"), document.scene()), ["missing.flo"]);
        assert_eq!(missing(&folder.path().join("sub/copy.json"), document.scene()).len(), 4);
        let names = ["new.png".to_owned(), "link.png".into()];
        assert!(guard.files(folder.path(), &names, PNG).is_err());
        assert!(guard.folder(folder.path(), &|name| name == "hard.png", BTreeSet::new()).is_err());
        assert!(guard.folder(folder.path(), &|_| false, BTreeSet::from(["hard.png".to_owned()])).is_err());
        guard.folder(folder.path(), &|name| name == "other.png", BTreeSet::new()).unwrap();
    }

    #[test]
    fn other_files_are_replaced_by_their_own_kind_only() {
        let folder = tempfile::tempdir().unwrap();
        let heads: [(&[u8], Option<Kind>); 8] = [
            (PNG_FILE, Some(PNG)),
            (b"<?xml version=\"1.0\"?>\n<svg>", Some(SVG)),
            (b"x,y,dx,dy,length,degrees\n", Some(CSV)),
            (b"x,y\n1,2\n", None),
            (b"\x76\x2f\x31\x01....", Some(EXR)),
            (b"{\"plica\": 1}", None),
            (br#"{"ground": "paper", "noises": {}, "marks": []}"#, Some(STYLE)),
            (br#"{"layers": [{"strokes": {"ground": "paper", "noises": {}, "marks": []}}]}"#, None),
        ];
        for (head, kind) in heads {
            let path = folder.path().join("there");
            fs::write(&path, head).unwrap();
            for own in KINDS {
                let gives = Guard::new(false).file(&path, own);
                assert_eq!(gives.is_ok(), kind == Some(own), "{} over {:?}", own.name, String::from_utf8_lossy(head));
                assert!(Guard::new(true).file(&path, own).is_ok());
                if let Err(error) = gives {
                    assert!(error.to_string().contains("--force"), "{error}");
                }
            }
        }
        let empty = folder.path().join("empty.gif");
        fs::write(&empty, "").unwrap();
        Guard::new(false).file(&empty, PNG).unwrap();
        Guard::new(false).file(Path::new("/dev/null"), PNG).unwrap();
    }

    #[test]
    fn a_folder_gives_its_earlier_output_only() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["colour.png", "mine.png"] {
            fs::write(folder.path().join(name), PNG_FILE).unwrap();
        }
        let earlier = || BTreeSet::from(["colour.png".to_owned()]);
        let gives = |force: bool, name: &'static str| {
            Guard::new(force).folder(folder.path(), &move |other| other == name, earlier()).is_ok()
        };
        assert!(gives(false, "colour.png") && gives(false, "new.png") && gives(true, "mine.png"));
        assert!(!gives(false, "mine.png"));
    }
}
