//! Paths that a scene names: they must stay in its folder unless a person allows otherwise, and must be regular files.

use std::fs::File;
use std::io::{self, Read};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

use super::{Options, disk};
use crate::base::error::{Error, Result};
use crate::base::problem;
use crate::base::system::beneath;
use crate::layers::parts::materials::List;

/// Where a path written in a scene points: relative to the scene's folder.
pub fn beside(scene_path: &Path, path: &str) -> PathBuf {
    folder_of_scene(scene_path).join(file_of(path))
}

/// The folder of the scene at `scene_path`, unless that of the file at `path` is the same or below it.
pub fn folder_beside(scene_path: &Path, path: &Path) -> Option<PathBuf> {
    let folder = folder_of_scene(scene_path);
    let [own, other] = [&folder, disk::folder_of(path)].map(|folder| folder.canonicalize().ok());
    let is_below = own.zip(other).is_none_or(|(own, other)| other.starts_with(own));
    (!is_below).then_some(folder)
}

/// The path in a scene of what the file at `path` names relative to itself.
pub fn sibling(path: &str, name: &str) -> String {
    let folder = Path::new(file_of(path)).parent().unwrap_or(Path::new(""));
    folder.join(name).to_string_lossy().into_owned()
}

/// The file of a path written in a scene, without the layer (`a.exr#beauty`) or the picture (`a.glb#0`) in it.
pub fn file_of(path: &str) -> &str {
    parts(path).map_or(path, |(file, _)| file)
}

/// The layer that a path names: only OpenEXR files have layers, and glTF models numbered pictures.
pub fn layer_of(path: &str) -> Option<&str> {
    parts(path).map(|(_, layer)| layer)
}

fn parts(path: &str) -> Option<(&str, &str)> {
    let named = |(file, layer): &(&str, &str)| {
        let is_exr = file.to_ascii_lowercase().ends_with(".exr");
        is_exr && !layer.is_empty() || is_model(file) && layer.parse::<usize>().is_ok()
    };
    path.rsplit_once('#').filter(named)
}

/// The number of the picture that a path names in a model.
pub fn image_of(path: &str) -> Option<usize> {
    parts(path).filter(|(file, _)| is_model(file))?.1.parse().ok()
}

/// Whether it is called as a glTF model is, which may name other files.
pub fn is_model(path: &str) -> bool {
    let name = path.to_ascii_lowercase();
    name.ends_with(".glb") || name.ends_with(".gltf")
}

/// The folder that the scene is really in: a scene opened through a link finds the same pictures.
fn folder_of_scene(scene_path: &Path) -> PathBuf {
    let is_link = scene_path.symlink_metadata().is_ok_and(|found| found.is_symlink());
    let real = if is_link { std::fs::canonicalize(scene_path).ok() } else { None };
    disk::folder_of(&real.unwrap_or_else(|| scene_path.to_owned())).to_owned()
}

/// Opens a file that the scene at `scene_path` names by `path`.
///
/// # Errors
/// If the path leads out of the scene's folder and [`Options::allow_outside`] is not set; if there is no such file; if
/// it is a folder, a device, a FIFO or a socket.
pub fn open(scene_path: &Path, path: &str, options: &Options) -> Result<File> {
    let opened = opened(scene_path, path, options);
    let file = File::from(opened.map_err(|error| explain(path, &folder_of_scene(scene_path).join(path), error))?);
    regular(file, path)
}

/// Whether [`open`] fails as there is no such file.
pub fn is_missing(scene_path: &Path, path: &str, options: &Options) -> bool {
    opened(scene_path, path, options).is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
}

fn opened(scene_path: &Path, path: &str, options: &Options) -> io::Result<OwnedFd> {
    if options.allow_outside {
        beneath::open_anywhere(&beside(scene_path, path))
    } else {
        beneath::open(&folder_of_scene(scene_path), Path::new(file_of(path)))
    }
}

/// Opens a file that a person named.
///
/// # Errors
/// If there is no such file, or it is a folder, a device, a FIFO or a socket.
pub fn open_named(path: &Path) -> Result<File> {
    let place = path.display().to_string();
    let opened = beneath::open_anywhere(path).map_err(|error| explain(&place, path, error))?;
    regular(File::from(opened), &place)
}

/// Reads a regular file of at most `most` bytes; anything else is refused without blocking.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = disk::regular(beneath::open_anywhere(path)?.into())?;
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("is larger than {most} bytes")));
    }
    Ok(bytes)
}

fn regular(file: File, place: &str) -> Result<File> {
    let is_folder = file.metadata().is_ok_and(|found| found.is_dir());
    disk::regular(file).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidInput if is_folder => Error::at(place, error).cure("name a file in it"),
        io::ErrorKind::InvalidInput => Error::at(place, error).cure("name a regular file"),
        _ => Error::at(place, error),
    })
}

/// Opens a picture that a person named, whole or by a layer of it.
///
/// # Errors
/// As [`open_named`].
pub fn open_picture(path: &Path) -> Result<File> {
    let file = path.to_str().map_or(path, |path| Path::new(file_of(path)));
    // What is missing is called by the whole of its name.
    open_named(if file.exists() { file } else { path })
}

/// What is behind the `#` of a name that is no file, where what is before it is one.
fn no_layer(place: &str, path: &Path) -> Option<Error> {
    let (file, layer) = path.to_str()?.rsplit_once('#')?;
    if !Path::new(file).is_file() {
        return None;
    }
    Some(if layer.is_empty() {
        Error::at(place, "has no name of a layer after the #").cure("name the layer, or leave the # out")
    } else {
        let cure = format!("leave #{layer} out");
        Error::at(place, "there is no such file, and only an OpenEXR has layers to name after a #").cure(cure)
    })
}

fn explain(place: &str, path: &Path, error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::CrossesDevices => Error::at(place, "leads out of the scene's folder")
            .cure("copy the file beside the scene, or give --allow-outside"),
        io::ErrorKind::NotFound => {
            let missing = || Error::at(place, "there is no such file").cure(how_to_find(path));
            no_layer(place, path)
                .or_else(|| dead_link(path).map(|what| Error::at(place, what).cure("mend the link")))
                .unwrap_or_else(missing)
        }
        io::ErrorKind::NotADirectory => Error::at(place, "is to be in a folder that is a file").cure("mend the path"),
        io::ErrorKind::PermissionDenied => Error::at(place, "may not be read").cure("change who may read it"),
        _ if beneath::is_loop(&error) => Error::at(place, LOOP).cure("mend the link"),
        _ if place.contains('\0') => {
            Error::at(place, "holds a NUL, which no name of a file does").cure("mend the name")
        }
        _ => Error::at(place, format!("cannot be opened: {error}")),
    }
}

const LOOP: &str = "is a link that leads back to itself";

/// What is said of a link that leads to nothing, if it is one.
pub(super) fn dead_link(path: &Path) -> Option<String> {
    let (to, error) = (std::fs::read_link(path).ok()?, path.metadata().err()?);
    Some(if beneath::is_loop(&error) {
        LOOP.to_owned()
    } else {
        format!("is a link to {}, which is not there", to.display())
    })
}

/// What to do about a file that is not there: its folder may be missing, or another be meant.
fn how_to_find(path: &Path) -> String {
    let folder = disk::folder_of(path);
    let Ok(entries) = std::fs::read_dir(folder) else {
        return format!("there is no folder {}: put the file there, or mend the name", folder.display());
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let meant = |other: &str| kind_of(other) == kind_of(&name);
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let names: Vec<String> = names.filter(|other| meant(other)).collect();
    // Names may differ in their ends.
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_lowercase();
    let wanted = stem(&name);
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let like = problem::like(&wanted, stems.iter().map(String::as_str));
    let name = like.and_then(|like| names.get(stems.iter().position(|stem| stem == like)?));
    name.map_or("put it there, or mend the name".to_owned(), |name| format!("did you mean {name}?"))
}

/// How the names of files end that are of one kind: models, videos, and pictures.
const ENDS: [(List, &[&str]); 3] = [
    (List::Meshes, &["obj", "glb", "gltf"]),
    (List::Clips, &["mp4", "mov", "m4v", "webm", "mkv", "avi", "mpg", "ogv", "y4m"]),
    (
        List::Images,
        &[
            "png", "jpg", "jpeg", "jpe", "tif", "tiff", "webp", "gif", "exr", "hdr", "bmp", "tga", "ppm", "pgm", "pbm",
            "pnm", "pam", "qoi", "dds", "ico", "heic", "heif", "avif", "jxl", "jp2", "psd", "svg",
        ],
    ),
];

/// The list of a scene that a file is meant for, as far as its name tells.
pub fn kind_of(name: &str) -> Option<List> {
    let end = name.rsplit_once('.')?.1.to_lowercase();
    ENDS.iter().find(|(_, ends)| ends.contains(&end.as_str())).map(|(list, _)| *list)
}

/// A path as typed by a person: a leading `~` is the home folder, as in a shell.
pub fn typed(path: &str) -> PathBuf {
    let home = || std::env::var_os("HOME").filter(|home| !home.is_empty()).map(PathBuf::from);
    match path.strip_prefix('~').filter(|rest| rest.is_empty() || rest.starts_with('/')) {
        Some(rest) => home().map_or_else(|| path.into(), |home| home.join(rest.trim_start_matches('/'))),
        None => path.into(),
    }
}

/// The most files that a completion offers.
const MOST_OFFERED: usize = 500;

/// The paths that begin with `typed`, relative to `folder` unless absolute: folders end in `/`; hidden ones are listed
/// only if a dot is typed. Empty if the folder cannot be read.
pub fn complete(folder: &Path, typed: &str) -> Vec<String> {
    let (parent, begun) = typed.rfind('/').map_or(("", typed), |at| typed.split_at(at + 1));
    let Ok(entries) = std::fs::read_dir(folder.join(self::typed(parent))) else { return Vec::new() };
    let fits = |name: &String| name.starts_with(begun) && (begun.starts_with('.') || !name.starts_with('.'));
    let path = |entry: std::fs::DirEntry| {
        let name = entry.file_name().into_string().ok().filter(fits)?;
        // A link to a folder counts as a folder.
        let slash = if entry.path().is_dir() { "/" } else { "" };
        Some(format!("{parent}{name}{slash}"))
    };
    let mut found: Vec<String> = entries.flatten().filter_map(path).take(MOST_OFFERED).collect();
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn what_a_scene_may_name() {
        let outer = tempfile::tempdir().unwrap();
        let root = outer.path().join("root");
        std::fs::create_dir_all(root.join("sub")).unwrap();
        std::fs::write(root.join("sub/cat.png"), "").unwrap();
        std::fs::write(root.join("sub/a.exr"), "").unwrap();
        std::fs::write(root.join("sub/b.GLB"), "").unwrap();
        std::fs::write(outer.path().join("dog.png"), "").unwrap();
        symlink("../dog.png", root.join("link.png")).unwrap();
        rustix::fs::mknodat(rustix::fs::CWD, root.join("fifo"), rustix::fs::FileType::Fifo, rustix::fs::Mode::RUSR, 0)
            .unwrap();
        symlink("away.png", root.join("nowhere.png")).unwrap();
        symlink("loop.png", root.join("loop.png")).unwrap();
        std::fs::write(root.join("model.gltf"), "{}").unwrap();
        let outside = outer.path().join("dog.png");
        let scene = root.join("scene.plica.json");
        // Path; part of the message without --allow-outside, and with it.
        for (path, beneath, anywhere) in [
            ("sub/cat.png", None, None),
            ("../dog.png", Some("--allow-outside"), None),
            ("link.png", Some("--allow-outside"), None),
            (outside.to_str().unwrap(), Some("--allow-outside"), None),
            ("/dev/zero", Some("--allow-outside"), Some("a device")),
            ("sub", Some("a folder"), Some("a folder")),
            ("fifo", Some("a FIFO"), Some("a FIFO")),
            ("no.png", Some("no such file (put it there, or mend"), Some("no such file (put it there, or mend")),
            ("sub/Cat.jpg", Some("no such file (did you mean cat.png?)"), Some("no such file (did you mean cat.png?)")),
            ("gone/a.png", Some("no such file (there is no folder "), Some("no such file (there is no folder ")),
            ("no.exr#layer", Some("no such file"), Some("no such file")),
            ("sub/cat.png/x.png", Some("a folder that is a file (mend"), Some("a folder that is a file (mend")),
            ("nowhere.png", Some("a link to away.png, which is not there"), Some("(mend the link)")),
            ("loop.png", Some("leads back to itself (mend the link)"), Some("leads back to itself (mend the link)")),
            ("model.bin", Some("no such file (put it there"), Some("no such file (put it there")),
            ("sub/b.GLB#12", None, None),
            ("sub/b.GLB#x", Some("only an OpenEXR has layers"), Some("(leave #x out)")),
            ("sub/cat.png#x", Some("only an OpenEXR has layers"), Some("(leave #x out)")),
            ("sub/a.exr#", Some("has no name of a layer after the #"), Some("name the layer")),
            ("a\0b", Some("holds a NUL, which no name of a file does (mend"), Some("holds a NUL")),
            ("", Some("no such file"), Some("a folder")),
        ] {
            for (allow_outside, refusal) in [(false, beneath), (true, anywhere)] {
                let options = Options { allow_outside, ..Options::default() };
                let error = open(&scene, path, &options).err().map(|e| e.to_string());
                match refusal {
                    None => assert_eq!(error, None, "{path}"),
                    Some(part) => assert!(error.as_ref().unwrap().contains(part), "{path}: {error:?}"),
                }
            }
        }
        assert_eq!(beside(Path::new("scene.plica.json"), "cat.png"), Path::new("./cat.png"));
        for (path, name, expected) in [("a.gltf", "b.bin", "b.bin"), ("sub/a.gltf", "c/b.bin", "sub/c/b.bin")] {
            assert_eq!(sibling(path, name), expected);
        }
        std::fs::write(&scene, "").unwrap();
        let link = outer.path().join("link.plica.json");
        symlink(&scene, &link).unwrap();
        open(&link, "sub/cat.png", &Options::default()).unwrap();
    }

    #[test]
    fn a_tilde_is_the_home_folder() {
        let home = PathBuf::from(std::env::var_os("HOME").unwrap_or("~".into()));
        for (path, expected) in [
            ("~", home.clone()),
            ("~/a.gif", home.join("a.gif")),
            ("~//a.gif", home.join("a.gif")),
            ("~ann/a.gif", "~ann/a.gif".into()),
            ("a~/b", "a~/b".into()),
            ("/a.gif", "/a.gif".into()),
        ] {
            assert_eq!(typed(path), expected, "{path}");
        }
    }

    #[test]
    fn paths_are_completed_a_folder_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("cats")).unwrap();
        for name in ["cat.png", "dog.png", ".hidden", "cats/tom.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        for (typed, expected) in [
            ("", &["cat.png", "cats/", "dog.png"][..]),
            ("cat", &["cat.png", "cats/"]),
            ("cats/", &["cats/tom.png"]),
            (".", &[".hidden"]),
            ("x/", &[]),
        ] {
            assert_eq!(complete(folder.path(), typed), expected, "{typed}");
        }
    }
}
