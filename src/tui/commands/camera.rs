//! The scene's camera: from what a window shows, and so that all that is in space is seen.

use glam::{DMat3, DVec3};
use serde_json::{Value, json};

use super::command::{Call, Command, Done, Table, command};
use crate::base::geometry::{Xyz, farther};
use crate::base::number;
use crate::base::problem::{Problem, Severity};
use crate::base::text::counted;
use crate::files::materials::{self, Cache};
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::Space;
use crate::layers::ready::Making;
use crate::layers::space::camera::{self, Camera};
use crate::layers::space::fit::{self, Reach, fit};
use crate::preview::editor::Silent;
use crate::render::{frame_size, reach};
use crate::scene::Scene;
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::state::outside::Asking;
use crate::tui::text::numbers::{rounded, short};

pub const COMMANDS: &[Command] = &[command(
    "camera",
    "take|key|fit",
    "Make the window's camera the scene's, or a key of it at this time; or see all that is in space",
    camera,
)
.inside()];

/// What is said while the windows are asked.
const ASKING: &str = "asking the window";
/// Why no camera sees anything of layers whose files are there.
const NOTHING: &str = "nothing is in space: all of it is without a size (make pose.scale 1, or give it points)";
/// Where a new camera stands.
const FIRST_BACK: DVec3 = DVec3::new(0.0, 0.3, 1.0);
/// What moves is looked at at so many times.
const TIMES: u32 = 16;
/// Two keys that are nearer than this are one.
const SAME_TIME: f64 = 1e-6;

fn camera(state: &mut State, call: &Call) -> Done {
    match call.text {
        "fit" => see_all(state, call.table),
        word if state.outside.window.is_empty() => of_window(state, call.table, (word, state.play.time)),
        // A window that draws slowly has not told its last keys yet.
        word => {
            state.outside.idle()?;
            state.outside.asking = Some(Asking { word: word.to_owned(), time: state.play.time });
            state.outside.work = Some(ASKING.to_owned());
            state.ask(Effect::Ask);
            Ok(())
        }
    }
}

/// The windows have told where they look from, but for those that are silent.
pub fn answered(state: &mut State, table: &'static Table, silent: &Silent) {
    let Some(Asking { word, time }) = state.outside.asking.take() else { return };
    state.outside.work = None;
    if !silent.windows.is_empty() {
        let numbers: Vec<String> = silent.windows.iter().map(ToString::to_string).collect();
        let which = match silent.of {
            1 => "the window".to_owned(),
            of => format!("number {} of {of} windows, in the order in which they joined,", numbers.join(" and ")),
        };
        return state.complain(format!("{which} did not tell where it looks from: try again once it has drawn"));
    }
    if let Err(why) = of_window(state, table, (&word, time)) {
        state.complain(why);
    }
}

/// Does what the camera of the window is wanted for, at a scene time.
fn of_window(state: &mut State, table: &'static Table, (word, time): (&str, f64)) -> Done {
    match word {
        "take" => take(state, table),
        _ => key(state, table, time),
    }
}

fn take(state: &mut State, table: &'static Table) -> Done {
    let own = state.outside.camera.clone();
    let own = own.ok_or(match state.outside.window.is_empty() {
        true => "there is no window to take the camera from: :view opens one, and plica view elsewhere joins",
        false => "the window moved last shows the scene's camera: move it first (drag with the middle button)",
    })?;
    write(state, table, rounded(standing(&own)), "the window's camera is the scene's now")
}

/// Sets the window's view, or that of the scene, as a key at this time. What the other keys do not name they get as it is at
/// their times, since it would be that of the new key there.
fn key(state: &mut State, table: &'static Table, time: f64) -> Done {
    let scene = state.document().scene().camera.clone();
    let scene = scene.ok_or("the scene has no camera: :camera fit makes one")?;
    let seen = state.outside.camera.as_ref().map_or_else(|| scene.view(time), |own| own.view(time));
    let ([position, target, _], fov) = seen;
    // The turn comes after the keys.
    let axis = DVec3::from(scene.up).normalize_or(DVec3::Y);
    let back = DMat3::from_axis_angle(axis, (-scene.turn * time).to_radians());
    let key = camera::Key {
        at: time,
        position: Some((target + back * (position - target)).into()),
        target: Some(target.into()),
        fov: Some(fov),
    };
    let unturned = Camera { turn: 0.0, ..scene.clone() };
    let whole = |other: &camera::Key| {
        let ([position, target, _], fov) = unturned.view(other.at);
        let (position, target) = (other.position.or(Some(position.into())), other.target.or(Some(target.into())));
        camera::Key { at: other.at, position, target, fov: other.fov.or(Some(fov)) }
    };
    let others = scene.keys.iter().filter(|other| (other.at - time).abs() > SAME_TIME).map(whole);
    let mut keys: Vec<camera::Key> = others.chain([key]).collect();
    keys.sort_by(|a, b| a.at.total_cmp(&b.at));
    let alone = if keys.len() == 1 { "; with one key the camera stands still" } else { "" };
    let keys = serde_json::to_value(keys).map_err(|error| error.to_string())?;
    table.obey(state, &format!("set camera.keys={}", rounded(keys)), None)?;
    state.say(format!("the camera has a key at {}{alone}", short(time)));
    Ok(())
}

/// The camera that one looks through: the window's own, or the scene's.
///
/// # Errors
/// There is none.
pub fn eye(state: &State) -> Result<Camera, String> {
    let scene = state.document().scene().camera.clone();
    state.outside.camera.clone().or(scene).ok_or_else(|| "the scene has no camera: :camera fit makes one".into())
}

fn see_all(state: &mut State, table: &'static Table) -> Done {
    let before = state.document().scene().camera.clone();
    let of = before.clone().unwrap_or_default();
    let ([position, target, up], fov) = of.view(state.play.time);
    let back = if before.is_some() { position - target } else { FIRST_BACK };
    let fitted = |reach: Reach, size| fit(reach, [back, up], fov, size);
    let made = state.picture.synth.as_ref();
    let seen = made.and_then(|synth| fitted(&|ways| reach(&synth.layers, TIMES, ways), synth.size));
    let seen = match (seen.map_or_else(|| unmade(state, &fitted), Ok), &before) {
        (Ok(seen), _) => fit::short(seen),
        (Err(why), Some(_)) => return Err(why),
        // A layer in space asks for a camera before there is anything to see.
        (Err(why), None) => {
            let said = format!("the scene has a camera, but {why}");
            return write(state, table, standing(&Camera::default()), &said);
        }
    };
    let stands = before.is_some() && of.keys.is_empty() && of.turn == 0.0;
    if stands && fit::is_same([position, target], seen) {
        state.ask(Effect::Look(None));
        state.say("nothing changes: the camera sees all that is in space already");
        return Ok(());
    }
    let [position, target] = seen.map(Into::into);
    let fitted = Camera { position, target, up: up.into(), fov, ..Camera::default() };
    let is_shown = state.document().scene().layers.iter().any(is_in_space);
    let said = if is_shown {
        "the camera sees all that is in space"
    } else {
        "the camera sees all meshes, but no layer shows one"
    };
    write(state, table, standing(&fitted), said)
}

/// A camera that stands still, without what is so anyway.
fn standing(camera: &Camera) -> Value {
    let (plain, numbers) = (Camera::default(), |all: Xyz| all.map(number::json));
    let mut value = json!({ "position": numbers(camera.position), "target": numbers(camera.target) });
    if camera.up != plain.up {
        value["up"] = json!(numbers(camera.up));
    }
    if camera.fov != plain.fov {
        value["fov"] = number::json(camera.fov);
    }
    value
}

/// Where a camera sees all of something in frames of this size.
type Fitted<'a> = &'a dyn Fn(Reach, (usize, usize)) -> Option<[DVec3; 2]>;

/// Where a camera sees all layers in space, or without any all meshes, where nothing is shown, or not yet. Files are read only
/// where the document does not tell. Otherwise why there is nothing to see.
fn unmade(state: &State, fitted: Fitted) -> Result<[DVec3; 2], String> {
    let scene = state.document().scene();
    let sized = scene.size.is_some() || scene.layers.iter().all(|layer| layer.technique().frame_of().is_none());
    if let Some(seen) = fitted(&|ways| told(scene, ways), frame_size(scene, &Materials::default())).filter(|_| sized) {
        return Ok(seen);
    }
    if scene.meshes.is_empty() && !scene.layers.iter().any(is_in_space) {
        return Err("nothing in it is in space: :add MODEL.obj adds a mesh, and :camera fit sees it".into());
    }
    let (materials, problems) =
        materials::gather(state.scene.path(), scene, state.scene.options(), &mut Cache::default());
    let in_space = scene.layers.iter().filter(|layer| is_in_space(layer));
    let making = Making::plain(scene.timeline.wrap, &materials);
    let layers: Vec<_> = in_space.filter_map(|layer| layer.technique().synth(&making, None).ok()).collect();
    let meshes = |ways: &[DVec3]| materials.meshes.values().filter_map(|mesh| mesh.reach(ways)).reduce(farther);
    let all = |ways: &[DVec3]| if layers.is_empty() { meshes(ways) } else { reach(&layers, TIMES, ways) };
    let told = |problem: &Problem| Problem { severity: Severity::Error, ..problem.clone().at("") }.to_string();
    let why = || problems.first().map_or(NOTHING.to_owned(), told);
    fitted(&all, frame_size(scene, &materials)).ok_or_else(why)
}

fn is_in_space(layer: &Layer) -> bool {
    layer.technique().kind().space == Space::World
}

/// How far all layers in space reach, if the document tells that of each.
fn told(scene: &Scene, ways: &[DVec3]) -> Option<Vec<f64>> {
    let in_space = scene.layers.iter().filter(|layer| is_in_space(layer));
    let told = in_space.map(|layer| layer.technique().reach(ways)).collect::<Option<Vec<_>>>()?;
    told.into_iter().reduce(farther)
}

/// Makes a camera that stands still the scene's; says so, and what is lost by it.
fn write(state: &mut State, table: &'static Table, camera: Value, said: &str) -> Done {
    let before = state.document().scene().camera.clone().unwrap_or_default();
    table.obey(state, &format!("set camera={camera}"), None)?;
    // Windows that look from elsewhere would not show it.
    state.ask(Effect::Look(None));
    let keys = (!before.keys.is_empty()).then(|| counted(before.keys.len(), "key"));
    let turn = (before.turn != 0.0).then(|| "turn".to_owned());
    let lost = keys.into_iter().chain(turn).collect::<Vec<_>>().join(" and ");
    state.say(if lost.is_empty() {
        said.to_owned()
    } else {
        format!("{said}, without its {lost} (u brings them back)")
    });
    Ok(())
}
