//! Pictures with cameras on a mesh: painting over what is seen, looking from a picture's camera, and giving it the eye's
//! place. What the command line does with them, `:views` does with the open scene.

use glam::DVec3;
use serde_json::json;

use super::camera::eye;
use super::command::{Call, Command, Done, command};
use super::items::go_to;
use super::profiles::shown;
use crate::base::pointer::Pointer;
use crate::base::problem::{nearest, quoted};
use crate::layers::parts::shots::{SeenFrom, Shot};
use crate::layers::space::camera::Camera;
use crate::layers::space::fit;
use crate::ops::views::paint::{Drawn, Standpoint, Wanted};
use crate::scene::shots;
use crate::tui::events::{Effect, ToDraw};
use crate::tui::state::painting::Sees;
use crate::tui::state::{State, painting};
use crate::tui::text::numbers::rounded;
use crate::tui::text::plain;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[command(
    "views",
    "[add|go|take|next|previous|guide|import|balance ...]",
    "Paint over what is seen of a mesh (add NAME), look from a view (go NAME), move it here (take NAME), select the next; as on the shell",
    views,
)
// What is painted over is what is seen.
.awaiting(|_, text| text.starts_with("add "))];

/// What runs while a view is drawn.
const ADDING: &str = "views add";

const NONE: &str = "no view lies on a mesh yet: :views add NAME lays one";

/// What is done with views; the last four on the command line too.
const WORDS: [&str; 8] = ["go", "take", "next", "previous", "add", "guide", "import", "balance"];
const OF_SHELL: &[&str] = &["add", "guide", "import", "balance"];

fn views(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let is_size =
        |word: &&str| word.split_once('x').is_some_and(|(w, h)| w.parse::<u32>().is_ok() && h.parse::<u32>().is_ok());
    match words.as_slice() {
        ["add", name, rest @ ..] if rest.len() <= 2 && !rest.iter().any(|word| word.starts_with('-')) => {
            let size = rest.iter().find(|word| is_size(word));
            let kind = rest.iter().find(|word| !is_size(word));
            add(state, name, kind.copied(), size.copied())
        }
        ["go", name @ ..] if name.len() <= 1 => go(state, name.first().copied()),
        [way @ ("next" | "previous")] => step(state, if *way == "next" { 1 } else { -1 }),
        ["guide"] => {
            let (_, name) = view(state, layer(state)?, None)?;
            state.say(format!("drawing the guide of {}", plain(&name)));
            outside(state, &["guide", &name]);
            Ok(())
        }
        ["take", name @ ..] if name.len() <= 1 => take(state, call, name.first().copied()),
        ["add" | "import"] => {
            Err(format!("{} is followed by {}", words[0], if words[0] == "add" { "a name" } else { "a file" }))
        }
        [first, ..] if !first.starts_with('-') && !OF_SHELL.contains(first) => {
            let hint = nearest(first, WORDS.into_iter()).unwrap_or_default();
            Err(format!("views takes no {} ({hint})", quoted(first)))
        }
        _ => {
            outside(state, &words);
            Ok(())
        }
    }
}

/// Runs what the command line does with the open scene, whose place there is behind what is added, imported or drawn.
fn outside(state: &mut State, words: &[&str]) {
    let scene = state.scene.path().to_string_lossy().into_owned();
    let at = match words.first() {
        Some(&("add" | "import" | "guide")) => 2.min(words.len()),
        Some(&"balance") => 1,
        _ => 0,
    };
    let mut all: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
    all.insert(at, scene);
    all.insert(0, "views".to_owned());
    state.ask(Effect::Run(all));
}

/// The layer that is shown if pictures can lie on it, otherwise the first on which they do.
fn layer(state: &State) -> Result<usize, String> {
    let document = state.document();
    let own = shown(state).and_then(|(_, name)| shots::layer(document, Some(&name)).ok());
    own.map_or_else(|| shots::layer(document, None), Ok)
}

fn add(state: &mut State, name: &str, kind: Option<&str>, size: Option<&str>) -> Done {
    state.outside.idle()?;
    state.scene.writable()?;
    let layer = layer(state)?;
    let synth = state.picture.synth.clone().ok_or_else(|| unseen(state))?;
    let size_px = match size.and_then(|size| size.split_once('x')) {
        Some((width, height)) => (side(width)?, side(height)?),
        None => synth.size,
    };
    let sight = Standpoint { layer, camera: eye(state)?, time: state.play.time, size_px };
    let scene = (state.scene.path(), state.document());
    let wanted = Wanted::new(scene, sight, (name, kind)).map_err(|error| error.to_string())?;
    state.outside.work = Some(ADDING.to_owned());
    let document = state.document().clone();
    state.ask(Effect::Draw(Box::new(ToDraw { wanted, document, synth })));
    Ok(())
}

/// Lays what has been drawn to be painted on, unless the scene has been left meanwhile.
pub fn drawn(state: &mut State, result: Result<(Wanted, Drawn), String>) {
    if state.outside.work.take().is_none() {
        return;
    }
    if let Err(why) = result.and_then(|(wanted, drawn)| lay(state, &wanted, &drawn)) {
        state.tell_beside(Err(format!("{ADDING}: {why}")));
    }
}

fn lay(state: &mut State, wanted: &Wanted, drawn: &Drawn) -> Done {
    let laid = wanted.lay((state.scene.path(), state.document()), drawn);
    let (layer, applied, picture) = laid.map_err(|error| error.to_string())?;
    state.edit(applied.edit, false)?;
    let count = state.document().scene().layers[layer].technique().lying().map_or(0, |lying| lying.len());
    if let Some(last) = count.checked_sub(1) {
        paint_on(state, layer, last);
    }
    let path = std::path::absolute(picture).map_err(|error| error.to_string())?;
    state.ask(Effect::EditImage { path, after: Some(plain(&applied.told)) });
    Ok(())
}

/// Why nothing is seen of the scene yet.
fn unseen(state: &State) -> String {
    let picture = &state.picture;
    match picture.read.or(picture.filled) {
        _ if !picture.synthesising => "nothing is shown yet".into(),
        Some(percent) => format!("the picture is still being made ({percent} %): add the view once it is there"),
        None => "the picture is still being made: add the view once it is there".into(),
    }
}

/// The most pixels that a side of a picture to paint on has.
const MOST_SIDE: usize = 16_384;

fn side(text: &str) -> Result<usize, String> {
    let side = text.parse().ok().filter(|side| (1..=MOST_SIDE).contains(side));
    side.ok_or_else(|| format!("a picture has 1 to {MOST_SIDE} pixels a side, not {text}"))
}

/// Selects the view that is so many after the one that is painted on, and so it is painted on; after the last comes the first.
fn step(state: &mut State, by: i64) -> Done {
    let (layer, index, _) = painting::current(state).ok_or(NONE)?;
    let lying = state.document().scene().layers[layer].technique().lying().unwrap_or_default();
    let next = (index as i64 + by).rem_euclid(lying.len() as i64) as usize;
    let told = format!("{}, {} of {}", plain(lying[next].name), next + 1, lying.len());
    select(state, layer, next);
    state.say(told);
    Ok(())
}

/// Goes to the row of a view, and so it is painted on.
fn select(state: &mut State, layer: usize, index: usize) {
    state.picture.laid = Some((layer, index));
    go_to(state, &painting::row(state, layer, index));
}

/// Makes a view the one that is painted on. The cursor stays, but on the row of another, which would count more.
fn paint_on(state: &mut State, layer: usize, index: usize) {
    state.picture.laid = Some((layer, index));
    if painting::current(state).is_some_and(|(on, row, _)| (on, row) != (layer, index)) {
        select(state, layer, index);
    }
}

/// The view called so, or that of the selected row, or the one that is painted on: its index, and its name.
fn view(state: &State, layer: usize, name: Option<&str>) -> Result<(usize, String), String> {
    let technique = state.document().scene().layers[layer].technique();
    let lying = technique.lying().unwrap_or_default();
    if lying.is_empty() {
        return Err(NONE.into());
    }
    let list = technique.lay(&[]).map_or("", |laying| laying.list);
    let focused = state.focused();
    let own = Pointer(&focused).item_of(&format!("/layers/{layer}{list}"));
    let index = match (name, own.map(|(index, _)| index)) {
        (Some(name), _) => lying.iter().position(|lying| lying.name == name).ok_or_else(|| {
            let hint = nearest(name, lying.iter().map(|lying| lying.name)).unwrap_or_default();
            format!("there is no view {} ({hint})", quoted(name))
        })?,
        (None, Some(index)) => index,
        (None, None) => match state.picture.laid.filter(|(on, _)| *on == layer) {
            Some((_, index)) => index,
            None if lying.len() == 1 => 0,
            None => return Err("which view: name it, or go to its row".into()),
        },
    };
    let name = lying.get(index).ok_or("there is no such view")?.name.to_owned();
    Ok((index, name))
}

fn go(state: &mut State, name: Option<&str>) -> Done {
    let layer = layer(state)?;
    let (index, name) = view(state, layer, name)?;
    paint_on(state, layer, index);
    if state.outside.window.is_empty() {
        return Err(format!("{} is painted on, but there is no window to look through: :view opens one", plain(&name)));
    }
    let technique = state.document().scene().layers[layer].technique();
    let from = technique.lying().and_then(|lying| lying.get(index)?.from).ok_or("its camera sees nothing")?;
    let place = technique.model_to_world(state.play.time).ok_or("the layer has no model")?;
    let made = state.picture.synth.as_ref().and_then(|synth| synth.layers.get(layer));
    let middle = made.and_then(|made| fit::middle(&|ways| made.reach(state.play.time, ways)));
    let ([position, target, up], fov) = match from {
        SeenFrom::Standing { position, target, up, fov } => {
            let up = up.unwrap_or(DVec3::Y);
            ([position, target, up], fov.unwrap_or(Camera::default().fov))
        }
        SeenFrom::Shot(shot) => {
            let middle = middle.map_or(DVec3::ZERO, |middle| place.inverse().transform_point3(middle));
            let distance = (middle - shot.position()).dot(shot.forward()).max(1e-3);
            ([shot.position(), shot.position() + shot.forward() * distance, shot.up()], fov(&shot))
        }
    };
    let [position, target] = [position, target].map(|at| place.transform_point3(at).into());
    let up = place.transform_vector3(up).normalize_or(DVec3::Y).into();
    let camera = Camera { position, target, up, fov, ..Camera::default() };
    // One looks from there at the result.
    if let Some(painting) = &mut state.picture.painting {
        painting.sees = Sees::Results;
    }
    state.ask(Effect::Look(Some(Box::new(camera))));
    state.say(format!("the window looks from {}", plain(&name)));
    Ok(())
}

fn fov(shot: &Shot) -> f64 {
    let height = shot.size_px.map(|[_, height]| f64::from(height)).or(shot.center_px.map(|[_, y]| 2.0 * y));
    shot.fov(height.unwrap_or(2.0 * shot.focal_px[1]))
}

fn take(state: &mut State, call: &Call, name: Option<&str>) -> Done {
    let layer = layer(state)?;
    let (index, name) = view(state, layer, name)?;
    let technique = state.document().scene().layers[layer].technique();
    let list = technique.lay(&[]).ok_or("the layer has no views")?.list.replace('/', ".");
    let place = technique.model_to_world(state.play.time).ok_or("the layer has no model")?.inverse();
    let ([position, target, up], fov) = eye(state)?.view(state.play.time);
    let [position, target] = [position, target].map(|at| place.transform_point3(at).to_array());
    let up = place.transform_vector3(up).normalize_or(DVec3::Y).to_array();
    let camera = rounded(json!({ "position": position, "target": target, "up": up, "fov": fov }));
    call.obey(state, &format!("set layers.{layer}{list}.{index}.camera={camera}"))?;
    let (name, outside) = (plain(&name), &state.outside);
    state.say(match (&outside.camera, outside.window.is_empty()) {
        (Some(_), _) => format!("{name} is seen from here now"),
        (None, false) => format!("{name} is seen from the scene's camera now: the window looks from there too"),
        (None, true) => format!("{name} is seen from the scene's camera now; open the window (:view) to aim"),
    });
    Ok(())
}
