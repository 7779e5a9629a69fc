//! `cameras.json`: pictures with a pinhole camera each, `x_cam = R x_world + t`, and the mesh that they show.

use std::path::Path;

use glam::{DMat3, DVec3};
use serde_json::Value;

use super::list::{Cameras, Item, Reading, folder, is_there, numbers, size};
use crate::base::error::{Error, Result};
use crate::base::problem::quoted;
use crate::files::disk;
use crate::layers::parts::shots::Shot;

/// What the pictures are called that are kept for testing.
const TEST: &str = "test";

pub(super) fn read(path: &Path, list: &Value, reading: &Reading) -> Result<Cameras> {
    let mut found = Cameras::default();
    let mut left_out = 0;
    for (i, view) in list["views"].as_array().into_iter().flatten().enumerate() {
        let fields = view.as_object().ok_or_else(|| Error::at(path.display(), format!("views {i} is no object")))?;
        let file = fields.get("file").and_then(Value::as_str);
        let called = file.map_or_else(|| format!("views {i}"), |file| format!("views {i} ({file})"));
        let item = Item { file: path, called, fields };
        if !reading.all && fields.get("split").and_then(Value::as_str) == Some(TEST) {
            left_out += 1;
            continue;
        }
        let size_px = [item.required("width")?, item.required("height")?];
        let size_px = size(size_px[0], size_px[1])
            .ok_or_else(|| item.error(format!("width and height are no size ({size_px:?})")))?;
        let turn = item.rows::<3, 3>("R")?;
        let shift = fields.get("t").ok_or_else(|| item.error("t is missing"))?;
        let shift = shift.as_array().and_then(|items| numbers::<3>(items));
        let shift = shift.ok_or_else(|| item.error("t is not 3 numbers"))?;
        let shot = Shot {
            turn: DMat3::from_cols_array_2d(&turn).transpose(),
            shift: DVec3::from(shift),
            focal_px: item.focal([item.required("fx")?, item.required("fy")?])?,
            center_px: Some([item.required("cx")?, item.required("cy")?]),
            size_px: Some(size_px),
        };
        found.shots.push((folder(path, reading).join(item.text("file")?), shot));
    }
    if left_out > 0 {
        found.notes.push(format!("{left_out} pictures for testing are left out; --all takes them"));
    }
    if let Some(mesh) = list.get("mesh").and_then(Value::as_str) {
        let mesh_path = disk::folder_of(path).join(mesh);
        if is_there(&mesh_path) {
            found.mesh = Some(mesh_path);
        } else {
            found.notes.push(format!("its mesh {} is not there", quoted(mesh)));
        }
    }
    Ok(found)
}
