//! `transforms.json`, as Blender's exporters, NeRF and instant-ngp have it: camera-to-world matrices, x right, y up, z
//! back.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use serde_json::Value;

use super::list::{Cameras, Item, Reading, folder, is_there, numbers, size};
use crate::base::error::{Error, Result};
use crate::base::geometry::Xy;
use crate::base::maths;
use crate::files::picture;
use crate::layers::parts::shots::Shot;

/// Numbers of distortion.
const DISTORTION: [&str; 8] = ["k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"];
/// Parts of the names of camera models that are no pinholes, and what those are.
const NO_PINHOLES: [(&str, &str); 7] = [
    ("FISHEYE", "a fisheye"),
    ("ORTHO", "an orthographic camera"),
    ("EQUIRECT", "a panorama"),
    ("SPHERICAL", "a panorama"),
    ("PANO", "a panorama"),
    ("OMNI", "a panorama"),
    ("VR180", "a panorama"),
];
/// What is tried behind a path without an ending.
const ENDS: [&str; 3] = ["png", "jpg", "jpeg"];
/// How much the columns of a matrix may differ in length, or from a right angle.
const SKEW: f64 = 1e-3;

pub(super) fn read(path: &Path, list: &Value, reading: &Reading) -> Result<Cameras> {
    let mut found = Cameras::default();
    let Some(whole) = list.as_object() else { return Ok(found) };
    let common = Item { file: path, called: "the list".into(), fields: whole };
    let mut scales: Vec<f64> = Vec::new();
    for (i, frame) in list["frames"].as_array().into_iter().flatten().enumerate() {
        let fields = frame.as_object().ok_or_else(|| Error::at(path.display(), format!("frames {i} is no object")))?;
        let own = Item { file: path, called: format!("frames {i}"), fields };
        let file = own.text("file_path")?;
        let own = Item { called: format!("frames {i} ({file})"), ..own };
        let picture = picture_of(folder(path, reading), file);
        let (shot, scale) = shot(&own, &common, &picture, reading)?;
        scales.push(scale);
        found.shots.push((picture, shot));
    }
    if let Some(scale) = scales.into_iter().find(|scale| (scale - 1.0).abs() > SKEW) {
        found.notes.push(format!("the matrices have a scale of {scale:.4}, which is divided out"));
    }
    Ok(found)
}

fn picture_of(folder: &Path, file: &str) -> PathBuf {
    let path = folder.join(file);
    let ends = ENDS.iter().map(|end| PathBuf::from(format!("{}.{end}", path.display())));
    let tried =
        if path.extension().is_some() && is_there(&path) { None } else { ends.into_iter().find(|one| is_there(one)) };
    tried.unwrap_or(path)
}

/// The camera of a frame, and the scale of its matrix.
fn shot(own: &Item, common: &Item, picture: &Path, reading: &Reading) -> Result<(Shot, f64)> {
    refuse_bent(own)?;
    refuse_bent(common)?;
    let number = |name: &str| Ok::<_, Error>(own.number(name)?.or(common.number(name)?));
    let (width, height) = match (number("w")?, number("h")?) {
        (Some(width), Some(height)) => (width, height),
        (width, height) => {
            let of_picture = picture::size(picture, reading.limits)?;
            (width.unwrap_or(of_picture.0 as f64), height.unwrap_or(of_picture.1 as f64))
        }
    };
    let size_px =
        size(width, height).ok_or_else(|| own.error(format!("w and h are no size ({width} and {height})")))?;
    let focal_px = own.focal(focal(own, common, size_px)?)?;
    let center_px = match (number("cx")?, number("cy")?) {
        (None, None) => None,
        (x, y) => Some([x.unwrap_or(width / 2.0), y.unwrap_or(height / 2.0)]),
    };
    let rows = own.rows::<4, 3>("transform_matrix")?;
    let last = own.fields["transform_matrix"].get(3).and_then(Value::as_array).and_then(|row| numbers::<4>(row));
    if last.is_some_and(|last| last != [0.0, 0.0, 0.0, 1.0]) {
        return Err(own.error("the last row of transform_matrix is not 0 0 0 1"));
    }
    let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
    let axes = [column(0), column(1), column(2)];
    let scale = axes.iter().map(|axis| axis.length()).sum::<f64>() / 3.0;
    let units = axes.map(|axis| axis / scale);
    let even = scale > 0.0 && units.iter().all(|axis| (axis.length() - 1.0).abs() <= SKEW);
    let square = [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| units[i].dot(units[j]).abs() <= SKEW);
    let to_world = DMat3::from_cols(units[0], units[1], units[2]);
    if !(even && square && to_world.determinant() > 0.0) {
        return Err(own.error("transform_matrix is no rotation (its axes are stretched, skewed or mirrored)"));
    }
    let turn = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)) * to_world.transpose();
    let shot = Shot { turn, shift: -(turn * column(3)), focal_px, center_px, size_px: Some(size_px) };
    Ok((shot, scale))
}

/// Focal lengths, of the frame where it has any. Where one alone is known, pixels are square.
fn focal(own: &Item, common: &Item, [width, height]: [u32; 2]) -> Result<Xy> {
    let of = |item: &Item| {
        let across = length(item, ["fl_x", "camera_angle_x"], width)?;
        Ok::<_, Error>((across, length(item, ["fl_y", "camera_angle_y"], height)?))
    };
    Ok(match (of(own)?, of(common)?) {
        ((Some(across), down), _) | ((None, None), (Some(across), down)) => [across, down.unwrap_or(across)],
        ((None, Some(down)), (across, _)) => [across.unwrap_or(down), down],
        ((None, None), (None, Some(down))) => [down, down],
        ((None, None), (None, None)) => return Err(own.error("camera_angle_x is missing, and fl_x too")),
    })
}

/// A focal length in pixels, by itself or by the angle in radians that a side of the picture fills.
fn length(item: &Item, [length, angle]: [&str; 2], side: u32) -> Result<Option<f64>> {
    if let Some(length) = item.number(length)? {
        return Ok(Some(length));
    }
    let Some(radians) = item.number(angle)? else { return Ok(None) };
    match radians > 0.0 && radians < PI {
        true => Ok(Some(0.5 * f64::from(side) / maths::tan(0.5 * radians))),
        false => Err(item.error(format!("{angle} is not between 0 and pi radians: {radians}"))),
    }
}

/// Refuses cameras that are no pinholes.
fn refuse_bent(item: &Item) -> Result<()> {
    for name in DISTORTION {
        if item.number(name)?.is_some_and(|amount| amount != 0.0) {
            let error =
                Error::at(item.file.display(), format!("{}: {name} is not 0: the camera has distortion", item.called));
            return Err(error.cure("undistort the pictures first: colmap image_undistorter"));
        }
    }
    let model = item.fields.get("camera_model").and_then(Value::as_str).unwrap_or_default().to_ascii_uppercase();
    let is_fisheye = item.fields.get("is_fisheye").and_then(Value::as_bool) == Some(true);
    let by_model =
        NO_PINHOLES.into_iter().find(|(part, _)| model.contains(part)).map(|(_, what)| ("camera_model", what));
    let bent = is_fisheye.then_some(("is_fisheye", "a fisheye")).or(by_model);
    bent.map_or(Ok(()), |(field, what)| {
        let error = item.error(format!("{field}: {what} is no pinhole"));
        Err(error.cure("render or undistort the pictures with a perspective camera"))
    })
}
