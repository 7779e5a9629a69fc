//! Picking pictures from a clip: what is seen of it, and the squares that are picked.

use kurbo::Point;
use serde_json::{Value, json};

use super::command::{Call, Command, Done, command};
use super::items::go_to;
use crate::base::pointer::Pointer;
use crate::layers::parts::picking::Picks;
use crate::ops::sprites;
use crate::scene::Edit;
use crate::scene::field;
use crate::tui::document::tree;
use crate::tui::events::Effect;
use crate::tui::layout::picture;
use crate::tui::state::looking::{self, Looking};
use crate::tui::state::{Pane, State, first, place};
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[
    command(
        "clip",
        "show|previous|next|first|last|cut|sheet|off",
        "Look at the clip that sprites are picked from",
        clip,
    )
    .awaiting(|state, _| state.picture.looking.is_none())
    .counted_with(&["previous", "next"]),
    command(
        "pick",
        "add|foam|move|track|previous|next",
        "Pick the square at the cursor, change a pick, or go to one",
        pick,
    )
    .change()
    .awaiting(|_, _| true)
    .counted_with(&["previous", "next"]),
    command("sprites", "take|OPTIONS", "Turn the automatic choice into picks; or as `plica sprites`", take)
        .awaiting(|_, text| text == "take"),
];

fn clip(state: &mut State, call: &Call) -> Done {
    let Some(now) = state.picture.looking else {
        return if call.text == "show" { show(state) } else { Err(NOT_LOOKING.into()) };
    };
    let last = now.frames.saturating_sub(1);
    let by = |steps: i64| (now.frame as i64 + steps).clamp(0, last as i64) as usize;
    let (frame, plain) = (|frame| Looking { frame, sheet: false, ..now }, Looking { cut: false, sheet: false, ..now });
    let to = match call.text {
        "previous" => Some(frame(by(-call.times()))),
        "next" => Some(frame(by(call.times()))),
        "first" => Some(frame(0)),
        "last" => Some(frame(last)),
        "cut" => Some(Looking { cut: !now.cut, ..plain }),
        "sheet" => Some(Looking { sheet: !now.sheet, ..now }),
        "show" => Some(plain),
        _ => None,
    };
    looking::look(state, to);
    picture::settle(state);
    Ok(())
}

/// Why nothing is picked.
const NOT_LOOKING: &str = "the clip is not shown: Enter on the sprites of a layer shows it";

/// Shows the clip of the layer that the cursor is in, at the selected pick.
fn show(state: &mut State) -> Done {
    let (layer, picks, _) = looking::picks(state).ok_or("nothing is picked from a clip here")?;
    looking::look(state, Some(Looking::at(layer)));
    if state.picture.looking.is_none() {
        return Err("there is no clip to show yet: the layer names none, or it is not read yet".into());
    }
    state.show(format!("/layers/{layer}{}", picks.list));
    state.cursor.focus = Pane::Picture;
    state.settle();
    if let Some(now) = state.picture.looking {
        move_inside(state, now.side);
    }
    go_to_pick(state);
    Ok(())
}

/// Where the layer that is looked at has its picks.
fn picks(state: &State) -> Option<Picks> {
    state.document().scene().layers.get(state.picture.looking?.layer)?.technique().picks()
}

/// A number of the selected pick.
fn number(state: &State, field: &str) -> Option<f64> {
    state.document().json().pointer(&format!("{}/{field}", selected(state)?))?.as_f64()
}

/// The pick under the cursor of the table.
fn selected(state: &State) -> Option<String> {
    let row = state.sheet().pointer(state.cursor.row)?;
    let layer = state.picture.looking?.layer;
    Pointer(&row).is_inside(&format!("/layers/{layer}{}", picks(state)?.list)).then_some(row)
}

/// Shows the frame of the selected pick, with the cursor on it.
fn go_to_pick(state: &mut State) {
    let to = || {
        let picks = picks(state)?;
        let at = |axis: usize| number(state, &format!("{}/{axis}", picks.at));
        Some((number(state, picks.frame)? as usize, Point::new(at(0)?, at(1)?)))
    };
    let (Some((frame, at)), Some(now)) = (to(), state.picture.looking) else { return };
    looking::look(state, Some(Looking { frame, sheet: false, ..now }));
    state.picture.cursor = at;
    picture::settle(state);
    state.ask(Effect::Show);
}

fn pick(state: &mut State, call: &Call) -> Done {
    let now = state.picture.looking.ok_or(NOT_LOOKING)?;
    if now.sheet && matches!(call.text, "add" | "foam" | "move") {
        return Err("this is the sheet: z C shows the clip again".into());
    }
    let none = "no pick is selected: w goes to one, a picks one";
    let picks = picks(state).ok_or(NOT_LOOKING)?;
    if matches!(call.text, "add" | "foam" | "move") {
        move_inside(state, now.side);
    }
    if let Some((_, kind)) = picks.kinds.iter().find(|(word, _)| *word == call.text) {
        return add(state, now, picks, kind);
    }
    match call.text {
        "move" => {
            let pointer = selected(state).ok_or(none)?;
            let frame = Edit::set(state.document(), &format!("{pointer}/{}", picks.frame), json!(now.frame));
            let track = format!("{pointer}/{}", picks.track);
            let unfollowed = now.unfollowed().filter(|_| follows(state, &track));
            let alone = unfollowed.as_ref().map(|_| Edit::set(state.document(), &track, json!(false)));
            let edit = Edit::all([place::move_here(state)?, frame].into_iter().chain(alone));
            state.edit(edit, false)?;
            tell_alone(state, unfollowed);
            Ok(())
        }
        "track" => {
            let pointer = selected(state).ok_or(none)?;
            let track = format!("{pointer}/{}", picks.track);
            let follows = follows(state, &track);
            let frame = number(state, picks.frame).map_or(now.frame, |frame| frame as usize);
            if let (false, Some(why)) = (follows, Looking { frame, ..now }.unfollowed()) {
                return Err(why);
            }
            let edit = Edit::set(state.document(), &track, json!(!follows));
            state.edit(edit, false)?;
            state.say(if follows { "a single picture" } else { "it follows what moves" });
            Ok(())
        }
        way => {
            let count = state.sheet().len() as i64;
            selected(state).ok_or("there are no picks: a picks one")?;
            let by = if way == "previous" { -call.times() } else { call.times() };
            state.cursor.row = (state.cursor.row as i64 + by).rem_euclid(count) as usize;
            state.settle();
            go_to_pick(state);
            Ok(())
        }
    }
}

/// Picks the square at the cursor, as one of this kind.
fn add(state: &mut State, now: Looking, picks: Picks, kind: &str) -> Done {
    let (edit, pointer) = place::add_here(state)?;
    let with = state.document().apply(&edit).map_err(|problems| first(&problems))?;
    let set = |name: &str, value: Value| Edit::set(&with, &format!("{pointer}/{name}"), value);
    let unfollowed = now.unfollowed();
    let alone = unfollowed.as_ref().map(|_| set(picks.track, json!(false)));
    let edits = [set(picks.frame, json!(now.frame)), set(picks.kind, json!(kind))].into_iter().chain(alone);
    state.edit(Edit::all([edit].into_iter().chain(edits)), false)?;
    go_to(state, &pointer);
    if is_first(state, &pointer) {
        state.say("picks stand in place of the sprites of their kind that are found by themselves: :sprites take keeps those too");
    }
    tell_alone(state, unfollowed);
    Ok(())
}

/// Whether a pick is the only one in its list.
fn is_first(state: &State, pointer: &str) -> bool {
    let list = Pointer(pointer).split().and_then(|(list, _)| state.document().json().pointer(list)?.as_array());
    list.is_some_and(|picks| picks.len() == 1)
}

/// Whether a pick follows what moves, by the field that says so.
fn follows(state: &State, track: &str) -> bool {
    let track = field::value(state.document(), track);
    track.and_then(|value| value.as_bool()).unwrap_or(true)
}

/// Says why a pick is a single picture, if it is one because it cannot be followed.
fn tell_alone(state: &mut State, why: Option<String>) {
    if let Some(why) = why {
        state.say(format!("a single picture: {why}"));
    }
}

/// Moves the cursor so that the square around it lies in the picture.
fn move_inside(state: &mut State, side: f64) {
    let (width, height) = state.picture.size.unwrap_or_default();
    // A whole number, as the square's pixels are.
    let inside = |at: f64, size: usize| at.round().min(size as f64 - side / 2.0).max(side / 2.0);
    let Point { x, y } = state.picture.cursor;
    state.picture.cursor = Point::new(inside(x, width), inside(y, height));
    picture::settle(state);
}

/// Writes the automatic choice of the layer that the cursor is in, or of the first that has one, as picks.
fn take(state: &mut State, call: &Call) -> Done {
    if call.text != "take" {
        state.ask(Effect::Run(words(&format!("sprites {}", call.text))?));
        return Ok(());
    }
    if state.picture.synthesising {
        return Err("the sprites are being chosen: once more when that is done".into());
    }
    let synth = state.picture.synth.clone().ok_or("the pictures are not read yet")?;
    let own = tree::layer_of(&state.cursor.node);
    let albums = synth.layers.iter().enumerate().filter_map(|(layer, ready)| Some((layer, ready.album(0)?)));
    let mut albums: Vec<_> = albums.collect();
    albums.sort_by_key(|(layer, _)| Some(*layer) != own);
    let (layer, album) = albums.into_iter().next().ok_or("no layer of the scene has sprites")?;
    if album.taken.is_empty() {
        return Err("nothing to take: all sprites are picked by hand, or come from sheets".into());
    }
    let edit = sprites::taken(state.document(), layer, &album);
    state.edit(edit, false)
}
