//! `plica new`: a scene made from pictures and models. A picture becomes a layer with one zone that covers it, a model a
//! mesh with a layer that shows it, seen by a camera.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::files::{self, disk, models, paths, picture, write};
use crate::layers::space::fit::Bounds;
use crate::scene::{Document, Start};

/// Make a scene from pictures and models
#[derive(clap::Args)]
pub struct Args {
    /// Pictures (FILE.exr#LAYER is a layer of an OpenEXR) and models (.obj, .glb, .gltf), lowest layer first; those in other
    /// folders are copied beside the scene
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
    let first = args.files.first().ok_or_else(|| Error::Usage("name a picture or a model".into()))?;
    let path = args.output.clone().unwrap_or_else(|| beside(first));
    let (_, notes) = create(&path, &args.files, &args.reading.options()?)?;
    notes.iter().for_each(|note| context.messages.say(note));
    context.print(path.display())
}

/// The scene file that belongs to a picture, to a layer of it, or to a model: beside it, with its name.
pub fn beside(source: &Path) -> PathBuf {
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

/// Writes a scene of pictures and models at `path`, which must not exist yet. They are read completely, so that no scene
/// starts with a broken one. Returns the scene, and notes on what in them is not supported.
///
/// # Errors
/// If the scene, or another file with a picture's name, exists already; if a picture cannot be read or copied.
pub fn create(path: &Path, sources: &[PathBuf], options: &files::Options) -> Result<(Document, Vec<String>)> {
    refuse_taken(path)?;
    let mut making =
        Making { path, options, start: Start::default(), named: Vec::new(), copies: Vec::new(), notes: Vec::new() };
    for source in sources {
        making.add(source)?;
    }
    let refused = |problems| Error::Scene { file: path.display().to_string(), problems };
    let document = making.start.document().map_err(refused)?;
    let folder = disk::folder_of(path);
    making.copies.iter().try_for_each(|(from, name)| write::copy_into(from, folder, name))?;
    write::write_new(path, document.to_text().as_bytes())?;
    Ok((document, making.notes))
}

fn refuse_taken(path: &Path) -> Result<()> {
    let there = path.symlink_metadata();
    if there.as_ref().is_err_and(|error| error.kind() == ErrorKind::InvalidFilename) {
        return Err(Error::at(path.display(), "is too long a name for a file").cure("name the scene with -o"));
    }
    if there.is_ok() {
        let cure = format!("edit it (plica edit {}), or choose another name with -o", path.display());
        return Err(Error::at(path.display(), "is there already").cure(cure));
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
    /// Files of other folders: the folder, and the name in it.
    copies: Vec<(PathBuf, String)>,
    notes: Vec<String>,
}

impl Making<'_> {
    fn add(&mut self, source: &Path) -> Result<()> {
        let named = file_name(source)?;
        let mut files = vec![paths::file_of(&named).to_owned()];
        let (name, place) = (called(source), source.display());
        let note = |note: String| format!("{place}: {note}");
        let start = std::mem::take(&mut self.start);
        self.start = if models::is_one(source) {
            let model = models::read(source, self.options)?;
            self.notes.extend(model.notes.into_iter().map(note));
            files.splice(0..0, model.beside);
            let picture = model.picture.as_ref().map(|path| (called(Path::new(path)), path.as_str()));
            let bounds = Bounds::around(model.mesh.bounds().into_iter().flat_map(<[_; 2]>::from));
            start.mesh(&name, &named, bounds, picture.as_ref().map(|(name, path)| (&**name, *path)))
        } else {
            let found = picture::read(source, &self.options.limits)?;
            self.notes.extend(found.notes.into_iter().map(note));
            start.picture(&name, &named, (found.picture.width(), found.picture.height()))
        };
        if self.named.contains(&named) {
            return Err(Error::at(place, "has the same file name as another picture").cure("rename one"));
        }
        self.named.push(named);
        if files.iter().any(|file| self.path.file_name().is_some_and(|name| name.eq_ignore_ascii_case(file))) {
            let error = Error::at(self.path.display(), "is the place of a picture");
            return Err(error.cure("choose another name for the scene with -o"));
        }
        if !same_folder(source, self.path) {
            let folder = disk::folder_of(source);
            self.copies.extend(files.into_iter().map(|file| (folder.to_owned(), file)));
        }
        Ok(())
    }
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

fn same_folder(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| disk::folder_of(path).canonicalize().ok();
    folder(a).is_some() && folder(a) == folder(b)
}
