//! Placing things in space with the picture's cursor, as the scene's camera sees them at the time that is shown: in the plane
//! through what is selected that is parallel to the view. What has a place in space is read from the schema.

use glam::{DAffine3, DVec2, DVec3};
use kurbo::Point;
use serde_json::Value;

use super::State;
use crate::base::pointer::Pointer;
use crate::layers::parts::derived::Derived;
use crate::layers::parts::goal::Goal;
use crate::layers::parts::moment::Space;
use crate::layers::parts::readout::Fact;
use crate::layers::space::eye::{Eye, NEAR_M, Ray};
use crate::scene::field::{self, Field, Kind};
use crate::scene::{Document, Edit};
use crate::tui::text::numbers;

/// The place of something in space: the field that has it, and where that is in the world.
pub type InSpace = (String, DVec3);

/// From the coordinates of what is at `pointer` to the world, at the time that is shown.
fn to_world(state: &State, document: &Document, pointer: &str) -> DAffine3 {
    let layer = field::layer_of(document, pointer).filter(|(layer, way)| layer.is_in_model(way));
    layer.and_then(|(layer, _)| layer.model_to_world(state.play.time)).unwrap_or_default()
}

/// The place of what is at `pointer` in a document; `None` if it has none in space.
pub fn place(state: &State, document: &Document, pointer: &str) -> Option<InSpace> {
    let (layer, _) = field::layer_of(document, pointer)?;
    let in_space = layer.kind().space == Space::World;
    let is_object = field::field(document, pointer)?.kind.is_object();
    let children = if in_space && is_object { field::children(document, pointer) } else { Vec::new() };
    let child = children.into_iter().find(|child| is_place(&child.field))?;
    let at: [f64; 3] = serde_json::from_value(field::value(document, &child.pointer)?).ok()?;
    Some((child.pointer, to_world(state, document, pointer).transform_point3(at.into())))
}

fn is_place(field: &Field) -> bool {
    field.unit == Some("m") && matches!(&field.kind, Kind::Numbers(names) if *names == ["x", "y", "z"])
}

/// What has the focus and a place in space: the row, or one of its ancestors.
pub fn selected(state: &State) -> Option<(String, InSpace)> {
    let focused = state.focused();
    let mut upward = Pointer(&focused).upward();
    upward.find_map(|pointer| Some((pointer.to_owned(), place(state, state.document(), pointer)?)))
}

/// Where the picture is seen from.
fn eye(state: &State) -> Result<Eye, String> {
    let camera = state.document().scene().camera.as_ref().ok_or("the scene has no camera (:camera fit makes one)")?;
    Ok(camera.at(state.play.time, state.picture.size.ok_or("nothing is shown yet")?))
}

/// What the cursor points along.
fn ray(state: &State) -> Result<Ray, String> {
    let Point { x, y } = state.picture.cursor;
    Ok(eye(state)?.ray_in_world(DVec2::new(x, y)))
}

/// Where a place in space is in the picture; `None` if it is not in it.
pub fn seen(state: &State, at: DVec3) -> Option<Point> {
    let eye = eye(state).ok()?;
    let seen = eye.seen(at);
    let at = (-seen.z >= NEAR_M).then(|| eye.project(seen))?;
    let size = eye.middle_px * 2.0;
    let within = (0.0..size.x).contains(&at.x) && (0.0..size.y).contains(&at.y);
    within.then(|| Point::new(at.x, at.y))
}

/// The edit that moves what is at `pointer` in `document` under the cursor: as far away as what is selected is, else as it is
/// itself. `None` if it has no place in space, or is behind the camera.
pub fn moved(state: &State, document: &Document, pointer: &str) -> Option<Edit> {
    let (field, to) = under(state, document, pointer)?;
    let to = to_world(state, document, pointer).inverse().transform_point3(to);
    Some(Edit::set(document, &field, numbers::rounded(Value::from(to.to_array().to_vec()))))
}

/// The place under the cursor to which [`moved`] brings what is at `pointer`, and the field that has it.
pub fn under(state: &State, document: &Document, pointer: &str) -> Option<InSpace> {
    let (field, own) = place(state, document, pointer)?;
    let beside = selected(state).map_or(own, |(_, (_, at))| at);
    let depth = Some(-eye(state).ok()?.seen(beside).z).filter(|depth| *depth >= NEAR_M)?;
    Some((field, ray(state).ok()?.at_depth(depth)))
}

/// Where in a list of places a line through all of them gets longer by the least with one more.
pub fn least_detour(state: &State, list: &str, to: DVec3) -> usize {
    let document = state.document();
    let count = document.json().pointer(list).and_then(Value::as_array).map_or(0, Vec::len);
    let places: Vec<DVec3> =
        (0..count).filter_map(|i| Some(place(state, document, &format!("{list}/{i}"))?.1)).collect();
    let longer = |&index: &usize| {
        let before = index.checked_sub(1).and_then(|i| places.get(i));
        let far = |at: Option<&DVec3>| at.map_or(0.0, |at| at.distance(to));
        far(before) + far(places.get(index)) - before.zip(places.get(index)).map_or(0.0, |(a, b)| a.distance(*b))
    };
    let all = 0..=places.len();
    all.rev().min_by(|a, b| longer(a).total_cmp(&longer(b))).unwrap_or(0)
}

/// The field of what is at `pointer`, and the value with which it goes to where a ray points.
///
/// # Errors
/// Why there is none.
pub fn aimed(state: &State, pointer: &str, ray: &Ray) -> Result<(String, Value), String> {
    let (layer, way) = field::layer_of(state.document(), pointer).ok_or("nothing there goes to a place")?;
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
    let camera = camera.ok_or("the scene has no camera (:camera fit makes one)")?;
    aimed(state, pointer, &camera.at(state.play.time, size).ray_in_world(at.into()))
}

/// The edit with which what is selected goes to where the cursor points; `None` if it has no place in space.
///
/// # Errors
/// Why there is none.
pub fn aim_here(state: &State) -> Result<Option<Edit>, String> {
    let Some((pointer, _)) = selected(state) else { return Ok(None) };
    let (field, value) = aimed(state, &pointer, &ray(state)?)?;
    Ok(Some(Edit::set(state.document(), &field, value)))
}

/// Where the goal of what is selected is in the picture, as far as it is seen; else the nearest place at which one could be;
/// else where the cursor is. `None` if it has no place in space.
///
/// # Errors
/// What is selected has no goal, or nothing is seen.
pub fn aim_from(state: &State) -> Result<Option<Point>, String> {
    let Some((pointer, _)) = selected(state) else { return Ok(None) };
    let goal = goal(state, &pointer)?;
    let (eye, cursor) = (eye(state)?, state.picture.cursor);
    let size = eye.middle_px * 2.0;
    let inside = |at: DVec2| at.clamp(DVec2::splat(0.5), (size - 0.5).max(DVec2::splat(0.5)));
    let possible = |at: &DVec2| eye.ray_in_world(*at).meets_level(goal.level).is_some();
    let seen = goal.at.map(|at| eye.seen(at)).filter(|seen| -seen.z >= NEAR_M);
    let now = seen.map(|seen| inside(eye.project(seen))).filter(possible);
    let nearest = || {
        let step = (size.max_element() / SEARCHED).max(1.0);
        let steps = |side: f64| (0..).map(move |i| f64::from(i) * step + 0.5).take_while(move |at| *at < side);
        let places = steps(size.y).flat_map(|y| steps(size.x).map(move |x| DVec2::new(x, y)));
        let far = |at: &DVec2| at.distance_squared(DVec2::new(cursor.x, cursor.y));
        places.filter(possible).min_by(|a, b| far(a).total_cmp(&far(b)))
    };
    Ok(Some(now.or_else(nearest).map_or(cursor, |at| Point::new(at.x, at.y))))
}

/// At most so many places in a row are looked at for one where a goal could be.
const SEARCHED: f64 = 256.0;

fn goal(state: &State, pointer: &str) -> Result<Goal, String> {
    let (layer, way) = field::layer_of(state.document(), pointer).ok_or("nothing there goes to a place")?;
    layer.goal(way)
}

/// What would be true of the goal of what is selected, were it where the cursor is; or why it cannot be there. `None` if it
/// has none.
pub fn aiming(state: &State) -> Option<Result<Vec<Fact>, String>> {
    let (pointer, _) = selected(state)?;
    let goal = goal(state, &pointer).ok()?;
    let told = |(field, to): (String, Value)| {
        let name = Pointer(&field).below(&pointer)?.strip_prefix('/')?;
        let mut item = field::value(state.document(), &pointer)?;
        item.as_object_mut()?.insert(name.to_owned(), to);
        let (layer, _) = field::layer_of(state.document(), &pointer)?;
        let fact = |of: &Derived| Some(Fact { name: of.name, value: layer.derive(of, &item)?, unit: of.unit });
        Some(goal.told.iter().filter_map(fact).collect())
    };
    Some(ray(state).and_then(|ray| aimed(state, &pointer, &ray)).map(|aimed| told(aimed).unwrap_or_default()))
}
