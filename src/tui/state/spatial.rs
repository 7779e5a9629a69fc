//! Placing things in space with the picture's cursor, as the scene's camera sees them at the time that is shown: in the plane
//! through what is selected that is parallel to the view. What has a place in space is read from the schema.

use glam::{DVec2, DVec3};
use kurbo::Point;
use serde_json::Value;

use super::State;
use crate::base::pointer::Pointer;
use crate::layers::parts::moment::Space;
use crate::layers::space::eye::{Eye, NEAR_M, Ray};
use crate::scene::field::{self, Field, Kind};
use crate::scene::{Document, Edit};
use crate::tui::document::derived;
use crate::tui::text::numbers;

/// The place of something in space: the field that has it, and where that is.
pub type Place = (String, DVec3);

/// The place of what is at `pointer`; `None` if it has none in space.
pub fn place(document: &Document, pointer: &str) -> Option<Place> {
    let (layer, _) = derived::layer_of(document, pointer)?;
    let in_space = layer.kind().space == Space::World;
    let is_object = matches!(field::field(document, pointer)?.kind, Kind::Object | Kind::Tagged { .. });
    let children = if in_space && is_object { field::children(document, pointer) } else { Vec::new() };
    let child = children.into_iter().find(|child| is_place(&child.field))?;
    let at: [f64; 3] = serde_json::from_value(field::value(document, &child.pointer)?).ok()?;
    Some((child.pointer, at.into()))
}

fn is_place(field: &Field) -> bool {
    field.unit == Some("m") && matches!(&field.kind, Kind::Numbers(names) if *names == ["x", "y", "z"])
}

/// What has the focus and a place in space: the row, or one of its ancestors.
pub fn selected(state: &State) -> Option<(String, Place)> {
    let focused = state.focused();
    let mut upward = Pointer(&focused).upward();
    upward.find_map(|pointer| Some((pointer.to_owned(), place(state.document(), pointer)?)))
}

/// Where the picture is seen from.
fn eye(state: &State) -> Option<Eye> {
    Some(state.document().scene().camera.as_ref()?.at(state.play.time, state.picture.size?))
}

/// What a place of the picture looks along.
fn ray(state: &State, at: Point) -> Option<Ray> {
    Some(eye(state)?.ray_in_world(DVec2::new(at.x, at.y)))
}

/// Where a place in space is in the picture; `None` if it is not in it.
pub fn seen(state: &State, at: DVec3) -> Option<Point> {
    let eye = eye(state)?;
    let seen = eye.seen(at);
    let at = (-seen.z >= NEAR_M).then(|| eye.project(seen))?;
    let size = eye.middle_px * 2.0;
    let within = (0.0..size.x).contains(&at.x) && (0.0..size.y).contains(&at.y);
    within.then(|| Point::new(at.x, at.y))
}

/// The edit that moves what is at `pointer` in `document` under the cursor: as far away as what is selected is, else as it is
/// itself. `None` if it has no place in space, or is behind the camera.
pub fn moved(state: &State, document: &Document, pointer: &str) -> Option<Edit> {
    let (field, own) = place(document, pointer)?;
    let beside = selected(state).map_or(own, |(_, (_, at))| at);
    let depth = Some(-eye(state)?.seen(beside).z).filter(|depth| *depth >= NEAR_M)?;
    let to = ray(state, state.picture.cursor)?.at_depth(depth);
    Some(Edit::set(document, &field, numbers::rounded(Value::from(to.to_array().to_vec()))))
}

/// The field of what is at `pointer`, and the value with which it goes to where a ray points.
///
/// # Errors
/// Why there is none.
pub fn aimed(state: &State, pointer: &str, ray: &Ray) -> Result<(String, Value), String> {
    let (layer, way) = derived::layer_of(state.document(), pointer).ok_or("nothing there goes to a place")?;
    let (path, value) = layer.aimed(way, ray)?;
    Ok((format!("{}{path}", &pointer[..pointer.len() - way.len()]), numbers::rounded(value)))
}

/// The same for where the window's pointer points, seen by the window's own camera if it has one.
///
/// # Errors
/// Why there is none.
pub fn dropped(state: &State, pointer: &str) -> Result<(String, Value), String> {
    let (at, size) = state.outside.pointer.zip(state.picture.size).ok_or("nothing is shown yet")?;
    let camera = state.outside.camera.as_ref().or(state.document().scene().camera.as_ref());
    let camera = camera.ok_or("the scene has no camera yet")?;
    aimed(state, pointer, &camera.at(state.play.time, size).ray_in_world(at.into()))
}

/// The edit with which what is selected goes to where the cursor points; `None` if it has no place in space.
///
/// # Errors
/// Why there is none.
pub fn aim_here(state: &State) -> Result<Option<Edit>, String> {
    let Some((pointer, _)) = selected(state) else { return Ok(None) };
    let ray = ray(state, state.picture.cursor).ok_or("the scene has no camera yet")?;
    let (field, value) = aimed(state, &pointer, &ray)?;
    Ok(Some(Edit::set(state.document(), &field, value)))
}
