//! Painting on a mesh: which of its three views the picture's pane shows.

use glam::{DVec2, DVec3};
use kurbo::Point;
use serde_json::Value;

use super::State;
pub use super::picture::{ALL, Painting, Sees};
use crate::base::geometry::farther;
use crate::base::maths::{cos, sin};
use crate::base::pointer::Pointer;
use crate::base::statistics::median;
use crate::layers::parts::shots::{Put, SeenFrom};
use crate::layers::space::camera::Camera;
use crate::layers::space::fit::{Ball, fit};
use crate::render::sight::Sight;
use crate::tui::events::Effect;
use crate::tui::graphics::viewport::Viewport;

/// A camera that is so many times as far away as is usual stands far behind the others.
const FAR: f64 = 3.0;

/// How near to the poles one goes, in degrees.
const HIGHEST: f64 = 85.0;

/// The picture on a mesh that is painted on: that of the row under the cursor, else the one that was selected last, else the
/// first of its layer, else the first of all; its layer, its index and its name.
pub fn current(state: &State) -> Option<(usize, usize, String)> {
    let focused = state.focused();
    let layers = state.document().scene().layers.iter().enumerate();
    let found = layers.filter_map(|(i, layer)| {
        let technique = layer.technique();
        let lying = technique.lying().filter(|lying| !lying.is_empty())?;
        let path = format!("/layers/{i}");
        let list = format!("{path}{}", technique.lay(&[]).map_or("", |laying| laying.list));
        let is_there = |row: &usize| *row < lying.len();
        let row = Pointer(&focused).item_of(&list).map(|(row, _)| row).filter(is_there);
        let last = state.picture.laid.filter(|(layer, _)| *layer == i).map(|(_, row)| row).filter(is_there);
        let nearness = match (row, last) {
            (Some(_), _) => 3,
            (None, Some(_)) => 2,
            (None, None) => i32::from(Pointer(&focused).is_within(&path)),
        };
        let index = row.or(last).unwrap_or(0);
        Some((nearness, (i, index, lying[index].name.to_owned())))
    });
    // Of several that are as near the first.
    let found: Vec<_> = found.collect();
    let nearest = found.iter().map(|(nearness, _)| *nearness).max()?;
    found.into_iter().find(|(nearness, _)| *nearness == nearest).map(|(_, view)| view)
}

/// The row of a picture on a mesh.
pub fn row(state: &State, layer: usize, index: usize) -> String {
    let layers = &state.document().scene().layers;
    let laying = layers.get(layer).and_then(|layer| layer.technique().lay(&[]));
    format!("/layers/{layer}{}/{index}", laying.map_or("", |laying| laying.list))
}

/// What marks show as selected: what is under the cursor, but in select the picture that is painted on.
pub fn selection(state: &State) -> String {
    marked(state).unwrap_or_else(|| state.focused())
}

/// The row that marks show as selected in place of what is under the cursor, which counts more on an item of the same layer.
fn marked(state: &State) -> Option<String> {
    state.picture.painting.filter(|painting| painting.sees == Sees::Select)?;
    let (layer, index, _) = current(state)?;
    let focused = state.focused();
    let below = Pointer(&focused).below(&format!("/layers/{layer}")).unwrap_or_default();
    let is_item = below.split('/').any(|part| part.parse::<usize>().is_ok());
    (!is_item).then(|| row(state, layer, index))
}

/// What the pane shows in place of what the scene's camera sees.
pub fn sight(state: &State) -> Option<Sight> {
    let painting = state.picture.painting.filter(|_| state.picture.looking.is_none())?;
    match painting.sees {
        Sees::Results => None,
        Sees::Painting => {
            let (layer, picture, _) = current(state)?;
            Some(Sight::Painting { layer, picture, share: painting.share })
        }
        Sees::Select => camera(state, painting.around).map(|camera| Sight::From(Box::new(camera))),
    }
}

/// A camera that sees the mesh and the cameras of the pictures on it, from where the scene's camera stands, turned by so many
/// degrees to the right and up. One that stands far behind the others would make all small: it is seen while it is selected.
fn camera(state: &State, (right, lift): (f64, f64)) -> Option<Camera> {
    let (layer, index, _) = current(state)?;
    let (scene, time) = (state.document().scene(), state.play.time);
    let technique = scene.layers.get(layer)?.technique();
    let place = technique.model_to_world(time)?;
    let at = |from: SeenFrom| match from {
        SeenFrom::Shot(shot) => shot.position(),
        SeenFrom::Standing { position, .. } => position,
    };
    let cameras = technique.lying()?.into_iter().enumerate().filter_map(|(i, lying)| Some((i, at(lying.from?))));
    let mut cameras: Vec<(usize, DVec3)> = cameras.map(|(i, at)| (i, place.transform_point3(at))).collect();
    let synth = state.picture.synth.as_ref()?;
    let made = synth.layers.get(layer)?;
    let mesh = Ball::around(&|ways| made.reach(time, ways))?;
    let usual = median(&mut cameras.iter().map(|(_, at)| at.distance(mesh.middle)).collect::<Vec<_>>());
    let most = FAR * usual.unwrap_or_default();
    cameras.retain(|(i, at)| *i == index || at.distance(mesh.middle) <= most);
    let reach = |ways: &[DVec3]| {
        let of_cameras = cameras.iter().map(|(_, at)| ways.iter().map(|way| way.dot(*at)).collect::<Vec<f64>>());
        of_cameras.chain(made.reach(time, ways)).reduce(farther)
    };
    let ball = Ball::around(&reach)?;
    let own = scene.camera.clone().unwrap_or_default();
    let ([position, target, up], fov) = own.view(time);
    let up = up.normalize_or(DVec3::Y);
    let back = (position - target).normalize_or(DVec3::Z);
    let level = (back - up * back.dot(up)).normalize_or(up.any_orthonormal_vector());
    let angle = (90.0 - back.angle_between(up).to_degrees() + lift).clamp(-HIGHEST, HIGHEST).to_radians();
    let turned = level * cos(right.to_radians()) + up.cross(level) * sin(right.to_radians());
    let back = turned * cos(angle) + up * sin(angle);
    let [position, target] = fit(&|ways| ball.reach(ways), [back, up], fov, synth.size)?;
    Some(Camera { position: position.into(), target: target.into(), up: up.into(), fov, ..Camera::default() })
}

/// What is put where the cursor is, on the sphere of the view that is selected: its list, or what is to be set, and its value.
///
/// # Errors
/// Why there is nothing to put.
pub fn put(state: &State, put: Put) -> Result<(String, Value), String> {
    let Some(Sight::From(camera)) = sight(state) else {
        return Err("this is put in select: :layout select shows it".into());
    };
    let (layer, index, _) = current(state).ok_or("no picture lies on a mesh")?;
    let (size, synth) = state.picture.size.zip(state.picture.synth.as_ref()).ok_or("nothing is shown yet")?;
    let Point { x, y } = state.picture.cursor;
    let ray = camera.at(state.play.time, size).ray_in_world(DVec2::new(x, y));
    let made = synth.layers.get(layer).ok_or("nothing is shown yet")?;
    let (path, value) = made.put_round(index, put, &ray, state.play.time)?;
    Ok((format!("/layers/{layer}{path}"), value))
}

/// In select, how far the cursor is from the camera of the view that is selected, on its sphere: to the right and up, in degrees.
pub fn degrees(state: &State) -> Option<[f64; 2]> {
    let (_, value) = put(state, Put::Nothing).ok()?;
    serde_json::from_value(value).ok()
}

/// The width and height of what the pane shows, if it is known and no clip.
pub fn size(state: &State) -> Option<(usize, usize)> {
    let synth = state.picture.synth.as_ref()?;
    let painted = || match sight(state)? {
        Sight::Painting { layer, picture, .. } => synth.layers.get(layer)?.laid_px(picture),
        Sight::From(_) => None,
    };
    Some(painted().unwrap_or(synth.size))
}

/// Notes which picture is selected, has windows show what the pane shows and mark what it marks, and takes the size of that. Where it
/// is another, the pane shows all of it.
pub fn follow(state: &mut State) {
    if let Some((layer, index, _)) = current(state) {
        state.picture.laid = Some((layer, index));
    }
    let marked = marked(state);
    if state.picture.marked != marked {
        state.picture.marked = marked;
        state.ask(Effect::Show);
    }
    let sight = sight(state);
    if state.picture.told != sight {
        state.picture.told = sight;
        state.ask(Effect::Sight);
    }
    let size = size(state);
    if state.picture.looking.is_some() || size.is_none() || state.picture.size == size {
        return;
    }
    state.picture.size = size;
    let (width, height) = size.unwrap_or_default();
    let center = Point::new((width / 2) as f64 + 0.5, (height / 2) as f64 + 0.5);
    state.picture.viewport = Viewport { zoom: None, center };
    state.picture.cursor = center;
}
