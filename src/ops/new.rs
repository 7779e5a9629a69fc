//! `plica new`: a scene made from pictures, models and clips. A picture becomes a layer with one zone that covers it, a model
//! a mesh with a layer that shows it, a clip falling water; what is in space is seen by a camera.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::Context;
use super::check::made;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::base::pointer::Pointer;
use crate::base::problem::{Problem, Severity};
use crate::base::text::counted;
use crate::files::clips::ClipFiles;
use crate::files::materials::{self, Cache};
use crate::files::{self, clips, disk, models, outputs, paths, sources, write};
use crate::layers::parts::materials::List;
use crate::scene::{Document, Known, Looks, Start, address, check};

/// Make a scene from pictures, models and clips
#[derive(clap::Args)]
pub struct Args {
    /// Pictures (FILE.exr#LAYER is a layer of an OpenEXR), models (.obj, .glb, .gltf) and clips of water, smoke or fire
    /// (falls/%04d.jpg, a folder of numbered pictures, a video), lowest layer first; those in other folders are copied
    /// beside the scene
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The scene file [default: beside the first file, with its name: FILE.plica.json]
    #[arg(short, long, value_name = "SCENE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Writes the scene and prints where it is.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let first = args.files.first().ok_or_else(|| Error::Usage("name a picture, a model or a clip".into()))?;
    let path = args.output.clone().unwrap_or_else(|| beside(first));
    let (_, notes) = create(&path, &args.files, &args.reading.options()?)?;
    notes.iter().for_each(|note| context.messages.say(note));
    context.print(path.display())
}

/// The scene file that belongs to a picture, to a layer of it, to a model or to a clip: beside it, with its name.
pub fn beside(source: &Path) -> PathBuf {
    if sources::list_of(source) == List::Clips {
        return source.with_file_name(format!("{}.plica.json", clip_called(source)));
    }
    let file = source.to_str().map_or(source, |path| Path::new(paths::file_of(path)));
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{stem}.plica.json"))
}

/// What a picture is called in a scene: as its file, and its layer where one is meant.
pub fn called(picture: &Path) -> String {
    let path = picture.to_string_lossy();
    let stem = Path::new(paths::file_of(&path)).file_stem().unwrap_or_default().to_string_lossy();
    paths::layer_of(&path).map_or_else(|| stem.to_string(), |layer| format!("{stem}-{layer}"))
}

/// What a clip is called in a scene: as its files, or their folder.
pub fn clip_called(clip: &Path) -> String {
    let folder = if clip.is_dir() { clip } else { disk::folder_of(clip) };
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let folder = folder.file_name().map_or("clip".into(), |name| name.to_string_lossy());
    let name = clip.file_name().filter(|_| !clip.is_dir()).unwrap_or_default().to_string_lossy();
    clips::called(&name, &folder).to_owned()
}

/// Writes a scene of pictures, models and clips at `path`, which must not exist yet. They are read completely, so that no scene
/// starts with a broken one. Returns the scene, and notes on what in them is not supported.
///
/// # Errors
/// If the scene, or another file with a picture's name, exists already; if a picture cannot be read or copied.
pub fn create(path: &Path, sources: &[PathBuf], options: &files::Options) -> Result<(Document, Vec<String>)> {
    refuse_place(path)?;
    let mut making = Making {
        path,
        options,
        start: Start::default(),
        named: Vec::new(),
        sources: Vec::new(),
        copies: Vec::new(),
        notes: Vec::new(),
    };
    for source in sources {
        making.add(source)?;
    }
    let refused = |problems| Error::Scene { file: path.display().to_string(), problems };
    let materials = making.start.known();
    let document = making.start.document_under(options.rules()).map_err(refused)?;
    let odd = check::check_materials(document.scene(), &materials).into_iter();
    let odd = odd.filter(|problem| problem.severity == Severity::Warning);
    let place = path.display();
    making.notes.extend(odd.map(|odd| format!("{place}: {}", address::of_problem(&document, &odd))));
    let folder = disk::folder_of(path);
    making.copies.iter().try_for_each(|(file, name)| write::copy_into(file, folder, name))?;
    write::write_new(path, document.to_text().as_bytes())?;
    Ok((document, making.notes))
}

/// Refuses a place where a scene cannot be written, before anything is copied beside it.
fn refuse_place(path: &Path) -> Result<()> {
    outputs::no_stream(path)?;
    let folder = disk::folder_of(path);
    if !folder.is_dir() {
        return Err(Error::at(path.display(), format!("there is no folder {}", folder.display())).cure("make it first"));
    }
    let there = path.symlink_metadata();
    if there.as_ref().is_err_and(|error| error.kind() == ErrorKind::InvalidFilename) {
        return Err(Error::at(path.display(), "is too long a name for a file").cure("name the scene with -o"));
    }
    if path.is_dir() {
        let cure = format!("name a file in it, as {}", path.join("NAME.plica.json").display());
        return Err(Error::at(path.display(), "is a folder").cure(cure));
    }
    if there.is_ok() {
        let cure = format!("edit it (plica edit {}), or choose another name with -o", path.display());
        return Err(Error::at(path.display(), "is there already").cure(cure));
    }
    if path.to_str().and_then(paths::kind_of).is_some() {
        let error = Error::at(path.display(), "is what a picture, a model or a video is called");
        return Err(error.cure("call the scene NAME.plica.json with -o"));
    }
    Ok(())
}

/// A scene in the making, with the files that are copied beside it.
struct Making<'a> {
    path: &'a Path,
    options: &'a files::Options,
    start: Start,
    /// The names of its sources as they stand in it.
    named: Vec<String>,
    /// The sources themselves.
    sources: Vec<PathBuf>,
    /// Files of other folders, and their names beside the scene.
    copies: Copies,
    notes: Vec<String>,
}

impl Making<'_> {
    fn add(&mut self, source: &Path) -> Result<()> {
        let list = sources::list_of(source);
        if list == List::Clips {
            return self.add_clip(source);
        }
        let named = file_name(source)?;
        let mut files = vec![paths::file_of(&named).to_owned()];
        let (name, place) = (called(source), source.display());
        let note = |note: String| format!("{place}: {note}");
        let start = std::mem::take(&mut self.start);
        self.start = if list == List::Meshes {
            let model = models::read(source, self.options)?;
            self.notes.extend(model.notes.into_iter().map(note));
            files.splice(0..0, model.beside);
            let picture = model.picture.as_ref().map(|path| called(Path::new(path)));
            let looks = Looks {
                picture: picture.as_deref().zip(model.picture.as_deref()),
                color: model.color.as_deref(),
                both_sides: model.both_sides,
            };
            start.mesh(&name, &named, Some(model.mesh), looks)
        } else {
            let found = sources::picture(source, &self.options.limits)?;
            self.notes.extend(found.notes.into_iter().map(note));
            start.picture(&name, &named, (found.picture.width(), found.picture.height()))
        };
        self.name(source, named)?;
        if files.iter().any(|file| self.path.file_name().is_some_and(|name| name.eq_ignore_ascii_case(file))) {
            let error = Error::at(self.path.display(), "is the place of a picture");
            return Err(error.cure("choose another name for the scene with -o"));
        }
        if !same_folder(source, self.path) {
            self.copies.extend(copies(source, files)?);
        } else if files.iter().any(|file| !write::is_below(file)) {
            self.notes.push(format!(
                "{place}: names files outside its folder: the scene needs --allow-outside wherever it is opened"
            ));
        }
        Ok(())
    }

    /// Adds a clip, after it was read completely. Numbered pictures of another folder get one of their own beside the scene.
    fn add_clip(&mut self, source: &Path) -> Result<()> {
        let found = clips::find(source)?;
        let (name, place) = (clip_called(source), source.display());
        let (known, problems) = self.measure(source, &found)?;
        self.notes.extend(problems.into_iter().map(|Problem { message, hint, .. }| {
            hint.into_iter().fold(Error::at(&place, message), Error::cure).to_string()
        }));
        let still = |alone| format!("{place}: nothing moves in {alone} alone (put the next frames beside it)");
        self.notes.extend(found.alone().map(still));
        let path = match below(&found.folder, self.path) {
            Some(folder) => folder.join(&found.name),
            None => {
                let (path, copies) = clip_copies(&found, &name);
                self.copies.extend(copies);
                path
            }
        };
        let path =
            path.to_str().ok_or_else(|| Error::at(source.display(), "has a name that is no text").cure("rename it"))?;
        self.name(source, path.to_owned())?;
        self.start = std::mem::take(&mut self.start).clip(&name, path, found.first, Some(known));
        if let Some(fitted) = self.start.fitted() {
            let Known { size_px: (width, height), frames, .. } = known;
            self.notes.push(format!(
                "{place}: has {} of {width} x {height}: its layer begins with {fitted}",
                counted(frames, "frame")
            ));
        }
        Ok(())
    }

    /// What is known of a clip that was read completely, and what a check would tell of it.
    ///
    /// # Errors
    /// It cannot be read, or no layer fits it.
    fn measure(&self, source: &Path, found: &ClipFiles) -> Result<(Known, Vec<Problem>)> {
        let refused = |problems| refused(source, problems);
        let called = source.display().to_string();
        let alone = |known| Start::default().clip(&called, &found.name, found.first, known).document();
        let document = alone(None).map_err(refused)?;
        let mut cache = Cache::default();
        let (materials, problems) =
            materials::gather(&found.folder.join("scene"), document.scene(), self.options, &mut cache);
        // Whether a layer fits is only known after the clip.
        let of_clip = |problem: &Problem| !Pointer(&problem.path).is_within("/layers");
        let (mut problems, _): (Vec<Problem>, Vec<Problem>) = problems.into_iter().partition(of_clip);
        let Some(clip) = materials.clips.get(&called) else { return Err(refused(problems)) };
        let mut known = Known { size_px: clip.size_px(), frames: clip.frames.len(), is_still: false };
        let mut fitted = alone(Some(known)).map_err(refused)?;
        let failed = |problem: &Problem| problem.severity == Severity::Error;
        let mut told = made(fitted.scene(), &materials);
        if told.iter().any(failed) {
            known.is_still = true;
            fitted = alone(Some(known)).map_err(refused)?;
            told = made(fitted.scene(), &materials);
        }
        problems.extend(check::check_materials(fitted.scene(), &materials));
        if problems.iter().any(failed) {
            return Err(refused(problems));
        }
        // What a person has to do by hand is no reason to make no scene.
        problems.extend(told);
        Ok((known, problems))
    }

    /// Notes what a source is called in the scene, which no other one may be.
    fn name(&mut self, source: &Path, named: String) -> Result<()> {
        if self.named.contains(&named) {
            let other = self.sources.iter().find(|other| {
                let real = |path: &Path| path.canonicalize().ok();
                other.as_path() == source || real(other).is_some_and(|other| Some(other) == real(source))
            });
            let (what, cure) = match other {
                Some(_) => ("is named twice", "name it once, and duplicate its layer in the scene"),
                None => ("has the same file name as another one", "rename one"),
            };
            return Err(Error::at(source.display(), what).cure(cure));
        }
        self.named.push(named);
        self.sources.push(source.to_owned());
        Ok(())
    }
}

/// Files, each with the name that a copy of it has beside a scene.
pub type Copies = Vec<(PathBuf, String)>;

/// The copies that a scene of another folder needs of a picture or a model at `source`: it is in these files of its folder.
///
/// # Errors
/// If one of them is not there or below.
pub fn copies(source: &Path, files: Vec<String>) -> Result<Copies> {
    if let Some(outside) = files.iter().find(|file| !write::is_below(file)) {
        let what = format!("names {outside}, which is not in its folder and cannot be copied with it");
        return Err(Error::at(source.display(), what).cure("make the scene beside it"));
    }
    let folder = disk::folder_of(source);
    Ok(files.into_iter().map(|file| (folder.join(&file), file)).collect())
}

/// What a scene of another folder calls a clip, and the copies that it needs: numbered pictures get a folder of their own, with
/// this name.
pub fn clip_copies(found: &ClipFiles, name: &str) -> (PathBuf, Copies) {
    let folder = if found.files == [found.name.clone()] { Path::new("") } else { Path::new(name) };
    let copy = |file: &String| (found.folder.join(file), folder.join(file).to_string_lossy().into_owned());
    (folder.join(&found.name), found.files.iter().map(copy).collect())
}

/// The name of a picture's file as it stands in a scene.
///
/// # Errors
/// No scene can have it.
pub fn file_name(image: &Path) -> Result<String> {
    let refused = |what: &str| Error::at(image.display(), what).cure("rename it");
    let name = image.file_name().and_then(|name| name.to_str()).ok_or_else(|| refused("has a name that is no text"))?;
    if name.contains(char::is_control) {
        return Err(refused("has control characters in its name"));
    }
    Ok(name.to_owned())
}

/// What is wrong with a clip, told as that of its files.
fn refused(clip: &Path, problems: Vec<Problem>) -> Error {
    let first = problems.into_iter().next();
    let Problem { message, hint, .. } = first.unwrap_or_else(|| Problem::error("", "cannot be read"));
    // A video names itself.
    let own = clip.file_name().map(|name| format!("{}: ", name.to_string_lossy())).unwrap_or_default();
    let error = Error::at(clip.display(), message.strip_prefix(&own).unwrap_or(&message));
    hint.into_iter().fold(error, Error::cure)
}

/// The way from the folder of a scene down to another folder, if it is there or below.
fn below(folder: &Path, scene: &Path) -> Option<PathBuf> {
    let scene = disk::folder_of(scene).canonicalize().ok()?;
    Some(folder.canonicalize().ok()?.strip_prefix(scene).ok()?.to_owned())
}

fn same_folder(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| disk::folder_of(path).canonicalize().ok();
    folder(a).is_some() && folder(a) == folder(b)
}
