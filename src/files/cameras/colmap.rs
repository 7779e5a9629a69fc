//! The text model of COLMAP: `cameras.txt` and `images.txt` in one folder. `points3D.txt` is not read.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::{DMat3, DQuat, DVec3};

use super::list::{Cameras, Reading, is_there, size, text_of};
use crate::base::error::{Error, Result};
use crate::base::geometry::Xy;
use crate::base::problem::quoted;
use crate::files::disk;
use crate::layers::parts::shots::Shot;

pub(super) const IMAGES: &str = "images.txt";
pub(super) const CAMERAS: &str = "cameras.txt";
/// Where COLMAP writes a model in the folder of a project, and that itself.
const WITHIN: [&str; 4] = ["", "sparse", "sparse/0", "0"];

/// The models that are read: how many focal lengths each has, and how many numbers of distortion follow the center.
const MODELS: [(&str, usize, usize); 5] =
    [("SIMPLE_PINHOLE", 1, 0), ("PINHOLE", 2, 0), ("SIMPLE_RADIAL", 1, 1), ("RADIAL", 1, 2), ("OPENCV", 2, 4)];

/// The error for a binary model.
pub(super) fn binary(path: &Path) -> Error {
    let error = Error::at(path.display(), "is a binary model");
    error.cure("colmap model_converter --output_type TXT writes it as text")
}

/// A camera of the model; several pictures may have the same.
struct Camera {
    focal_px: Xy,
    center_px: Xy,
    size_px: [u32; 2],
}

pub(super) fn read(path: &Path, reading: &Reading) -> Result<Cameras> {
    let folder = if path.is_dir() { path } else { disk::folder_of(path) };
    let (cameras, images) = (folder.join(CAMERAS), folder.join(IMAGES));
    if !is_there(&images) {
        return Err(without(folder));
    }
    let known = read_cameras(&cameras, reading)?;
    let beside = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let pictures = [beside.join("images"), folder.join("images")].into_iter().find(|one| one.is_dir());
    let pictures = reading.images.map(Path::to_owned).or(pictures).unwrap_or_else(|| beside.join("images"));
    let shots = read_images(&images, &known, &pictures, reading)?;
    Ok(Cameras { shots, ..Cameras::default() })
}

/// Why a folder is no text model, with the one that it holds.
fn without(folder: &Path) -> Error {
    let has = |place: &&str, end: &str| is_there(&folder.join(place).join(IMAGES).with_extension(end));
    let holds = |end: &str| {
        WITHIN.iter().find(|place| has(place, end)).map(|place| folder.join(place).components().collect::<PathBuf>())
    };
    match (holds("txt"), holds("bin")) {
        (Some(text), _) => {
            Error::at(folder.display(), format!("has no {IMAGES}")).cure(format!("name {}", text.display()))
        }
        (None, Some(other)) => binary(&other),
        (None, None) => {
            Error::at(folder.display(), format!("has no {IMAGES}")).cure("name the folder of a COLMAP text model")
        }
    }
}

fn read_cameras(path: &Path, reading: &Reading) -> Result<HashMap<u64, Camera>> {
    let text = text_of(path, reading, "a COLMAP text model has numbers and names")?;
    let lines =
        text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with('#') && !line.trim().is_empty());
    lines.map(|(i, line)| camera(line).map_err(|why| at(path, i, why))).collect()
}

fn at(path: &Path, line: usize, (what, cure): (String, &'static str)) -> Error {
    let error = Error::at(path.display(), format!("line {}: {what}", line + 1));
    if cure.is_empty() { error } else { error.cure(cure) }
}

type Why = (String, &'static str);

fn camera(line: &str) -> std::result::Result<(u64, Camera), Why> {
    let mut words = line.split_ascii_whitespace();
    let id = words.next().and_then(|id| id.parse().ok()).ok_or_else(|| ("no number of a camera".into(), ""))?;
    let model = words.next().unwrap_or_default();
    let numbers: Option<Vec<f64>> =
        words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect();
    let numbers = numbers.ok_or_else(|| ("a parameter is no number".into(), ""))?;
    let Some(&(_, focals, distortion)) = MODELS.iter().find(|known| known.0 == model) else {
        let cure = "undistort first: colmap image_undistorter";
        return Err((format!("the camera model {} is no pinhole", quoted(model)), cure));
    };
    let [width, height, parameters @ ..] = &numbers[..] else {
        return Err(("a camera has no width and height".into(), ""));
    };
    let wanted = focals + 2 + distortion;
    if parameters.len() != wanted {
        return Err((format!("{model} has {wanted} parameters, here are {}", parameters.len()), ""));
    }
    if parameters[focals + 2..].iter().any(|one| *one != 0.0) {
        return Err(("the camera has distortion".into(), "undistort first: colmap image_undistorter"));
    }
    let size_px = size(*width, *height).ok_or_else(|| ("width and height are no size".into(), ""))?;
    let focal_px = [parameters[0], parameters[focals - 1]];
    if focal_px.iter().any(|focal| *focal <= 0.0) {
        return Err(("a focal length is not above 0".into(), ""));
    }
    Ok((id, Camera { focal_px, center_px: [parameters[focals], parameters[focals + 1]], size_px }))
}

/// Pictures have two lines each: the camera, and the points that were seen, which may be empty.
fn read_images(
    path: &Path,
    known: &HashMap<u64, Camera>,
    pictures: &Path,
    reading: &Reading,
) -> Result<Vec<(PathBuf, Shot)>> {
    let text = text_of(path, reading, "a COLMAP text model has numbers and names")?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with('#'));
    let mut shots = Vec::new();
    while let Some((i, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let (name, shot) = image(line, known).map_err(|why| at(path, i, why))?;
        shots.push((pictures.join(name), shot));
        lines.next();
    }
    Ok(shots)
}

fn image<'a>(line: &'a str, known: &HashMap<u64, Camera>) -> std::result::Result<(&'a str, Shot), Why> {
    let mut rest = line.trim();
    let mut word = || {
        let (word, after) = rest.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((rest, ""));
        rest = after.trim_start();
        word
    };
    word();
    let mut numbers = [0.0; 7];
    for (number, name) in numbers.iter_mut().zip(["QW", "QX", "QY", "QZ", "TX", "TY", "TZ"]) {
        let word = word();
        let read = word.parse().ok().filter(|number: &f64| number.is_finite());
        let line = "a line is IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";
        *number = read.ok_or_else(|| (format!("{name} is no number: {}", quoted(word)), line))?;
    }
    let id = word();
    let camera = id.parse().ok().and_then(|id: u64| known.get(&id));
    let both = "take both files from one model";
    let camera = camera.ok_or_else(|| (format!("its camera {} is not in {CAMERAS}", quoted(id)), both))?;
    if rest.is_empty() {
        return Err(("a picture has no name".into(), ""));
    }
    let [w, x, y, z, shift @ ..] = numbers;
    let turn = DQuat::from_xyzw(x, y, z, w);
    if turn.length() < 1e-9 {
        return Err(("the rotation is 0".into(), ""));
    }
    let shot = Shot {
        turn: DMat3::from_quat(turn.normalize()),
        shift: DVec3::from(shift),
        focal_px: camera.focal_px,
        center_px: Some(camera.center_px),
        size_px: Some(camera.size_px),
    };
    Ok((rest, shot))
}
