//! `plica new`: a scene made from pictures; each becomes a layer with one zone that covers it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::files::{self, disk, paths, picture, write};
use crate::scene::{Document, build::unique_name};

/// Make a scene from pictures
#[derive(clap::Args)]
pub struct Args {
    /// The pictures, lowest layer first (FILE.exr#LAYER is a layer of an OpenEXR); those in other folders are copied beside the
    /// scene
    #[arg(required = true)]
    images: Vec<PathBuf>,
    /// The scene file [default: beside the first picture, PICTURE.plica.json]
    #[arg(short, long, value_name = "SCENE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Writes the scene and prints where it is.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let first = args.images.first().ok_or_else(|| Error::Usage("name a picture".into()))?;
    let path = args.output.clone().unwrap_or_else(|| beside(first));
    let (_, notes) = create(&path, &args.images, &args.reading.options()?)?;
    notes.iter().for_each(|note| context.messages.say(note));
    context.print(path.display())
}

/// The scene file that belongs to a picture, or to a layer of it: beside it, with its name.
pub fn beside(picture: &Path) -> PathBuf {
    let file = without_layer(picture);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{stem}.plica.json"))
}

/// What a picture is called in a scene: as its file, and its layer where one is meant.
pub fn called(picture: &Path) -> String {
    let path = picture.to_string_lossy();
    let stem = Path::new(paths::file_of(&path)).file_stem().unwrap_or_default().to_string_lossy();
    paths::layer_of(&path).map_or_else(|| stem.to_string(), |layer| format!("{stem}-{layer}"))
}

fn without_layer(picture: &Path) -> PathBuf {
    picture.to_str().map_or(picture, |path| Path::new(paths::file_of(path))).to_owned()
}

/// Writes a scene of `images` at `path`, which must not exist yet. The pictures are read completely, so that no scene
/// starts with a broken one. Returns the scene, and notes on what in the pictures could not be honoured.
///
/// # Errors
/// If the scene, or another file with a picture's name, exists already; if a picture cannot be read or copied.
pub fn create(path: &Path, images: &[PathBuf], options: &files::Options) -> Result<(Document, Vec<String>)> {
    let there = path.symlink_metadata();
    if there.as_ref().is_err_and(|error| error.kind() == ErrorKind::InvalidFilename) {
        return Err(Error::at(path.display(), "is too long a name for a file").cure("name the scene with -o"));
    }
    if there.is_ok() {
        let cure = format!("edit it (plica edit {}), or choose another name with -o", path.display());
        return Err(Error::at(path.display(), "is there already").cure(cure));
    }
    let mut pictures: Vec<(String, String, usize, usize)> = Vec::new();
    let (mut copies, mut notes) = (Vec::new(), Vec::new());
    for image in images {
        let named = file_name(image)?;
        let file = paths::file_of(&named).to_owned();
        let found = picture::read(image, &options.limits)?;
        let (width, height) = (found.picture.width(), found.picture.height());
        notes.extend(found.notes.iter().map(|note| format!("{}: {note}", image.display())));
        if pictures.iter().any(|(_, other, ..)| *other == named) {
            return Err(Error::at(image.display(), "has the same file name as another picture").cure("rename one"));
        }
        if path.file_name().is_some_and(|name| name.eq_ignore_ascii_case(&file)) {
            let error = Error::at(path.display(), "is the place of a picture");
            return Err(error.cure("choose another name for the scene with -o"));
        }
        if !same_folder(image, path) {
            copies.push((without_layer(image), path.with_file_name(&file)));
        }
        let name = unique_name(&called(image), |name| pictures.iter().any(|(other, ..)| other == name));
        pictures.push((name, named, width, height));
    }
    let borrowed: Vec<_> = pictures.iter().map(|(n, f, w, h)| (n.as_str(), f.as_str(), *w, *h)).collect();
    let refused = |problems| Error::Scene { file: path.display().to_string(), problems };
    let document = Document::new(&borrowed).map_err(refused)?;
    copies.iter().try_for_each(|(from, to)| write::copy_new(from, to))?;
    write::write_new(path, document.to_text().as_bytes())?;
    Ok((document, notes))
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
