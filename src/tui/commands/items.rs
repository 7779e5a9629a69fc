//! Rows and nodes as a whole: added, taken away, doubled and moved.

use serde_json::Value;

use super::{Call, Command, Done, command};
use crate::scene::Edit;
use crate::scene::field::{self, Kind};
use crate::tui::app::{Mode, Pane, State};
use crate::tui::choice::{self, Choice, Then};
use crate::tui::entry;

pub const COMMANDS: &[Command] = &[
    command("add", "", "Add an item to the list, or an optional node", add).change(),
    command("delete", "", "Delete the row, the selection or the node", delete).change(),
    command("duplicate", "", "Duplicate the row or the node", duplicate).change(),
    command("reorder", "down|up", "Move the row or the node among its siblings", reorder).change(),
];

/// What the node or the row under the cursor is: its pointer.
pub fn target(state: &State) -> Result<String, String> {
    match state.focus {
        Pane::Tree => Ok(state.node.clone()),
        _ => state.sheet().pointer(state.row).ok_or("there is no row here".into()),
    }
}

fn split_item(state: &State, pointer: &str) -> Option<(String, usize)> {
    let (list, index) = pointer.rsplit_once('/')?;
    let index = index.parse().ok()?;
    let is_list = field::field(state.document(), list).is_some_and(|field| matches!(field.kind, Kind::List(_)));
    is_list.then(|| (list.to_string(), index))
}

pub fn add(state: &mut State, _: &Call) -> Done {
    let pointer = target(state).unwrap_or(state.node.clone());
    let field = field::field(state.document(), &pointer).ok_or("nothing can be added here")?;
    let there = field::is_there(state.document(), &pointer);
    let end = || state.document().json().pointer(&pointer).and_then(Value::as_array).map_or(0, Vec::len);
    match (&field.kind, there) {
        (Kind::Tagged { .. }, false) => {
            let options = choice::options(state, &field.kind);
            state.mode = Mode::Choice(Choice { title: field.name, options, at: 0, then: Then::Become(pointer) });
            Ok(())
        }
        (Kind::Object, false) => add_object(state, &pointer),
        (Kind::List(_), _) => insert(state, &pointer.clone(), end()),
        (Kind::Map(_), _) => Err("a picture is added by :set images.NAME.path=FILE".into()),
        _ => match split_item(state, &pointer) {
            Some((list, index)) => insert(state, &list, index + 1),
            None if state.focus == Pane::Tree => Err("o adds to lists: go to a list or to one of its items".into()),
            None => match split_item(state, &state.node.clone()) {
                Some((list, index)) => insert(state, &list, index + 1),
                None => Err("nothing can be added here".into()),
            },
        },
    }
}

/// An optional object comes with its first field that must be written.
fn add_object(state: &mut State, pointer: &str) -> Done {
    let document = state.document();
    let image = document.scene().images.keys().next().cloned();
    let image = image.ok_or("the scene has no images: add one first")?;
    let edit = entry::set(document, &format!("{pointer}/image"), image.into());
    state.edit(edit, false)
}

fn insert(state: &mut State, list: &str, index: usize) -> Done {
    let (edit, pointer) = Edit::insert_new(state.document(), list, index).ok_or("nothing can be added here")?;
    state.edit(edit, false)?;
    go_to(state, &pointer);
    Ok(())
}

/// Puts the cursor on the item at `pointer`: its row where its list is shown, else its node.
pub fn go_to(state: &mut State, pointer: &str) {
    match state.sheet().position(pointer) {
        Some(row) => state.row = row,
        None if state.focus == Pane::Tree => state.show(pointer),
        None => {
            let list = pointer.rsplit_once('/').map_or("", |(list, _)| list).to_string();
            state.show(list);
            state.row = state.sheet().position(pointer).unwrap_or(0);
        }
    }
    state.settle();
}

/// Items go from their lists, the last first, as one edit; a field goes back to its default.
fn delete(state: &mut State, _: &Call) -> Done {
    let sheet = state.sheet();
    let pointers: Vec<String> = match state.focus {
        Pane::Tree => vec![state.node.clone()],
        _ => entry::rows(state).rev().filter_map(|i| sheet.pointer(i)).collect(),
    };
    let written = |pointer: &&String| !pointer.is_empty() && state.document().json().pointer(pointer).is_some();
    let edits: Vec<Edit> = pointers.iter().filter(written).map(|pointer| Edit::remove(pointer)).collect();
    if edits.is_empty() {
        return Err("there is nothing to delete here".into());
    }
    state.edit(Edit::all(edits), false)?;
    state.selected_from = None;
    Ok(())
}

fn duplicate(state: &mut State, call: &Call) -> Done {
    for _ in 0..call.times() {
        let pointer = target(state)?;
        let (edit, pointer) =
            Edit::duplicate(state.document(), &pointer).ok_or("only items of lists are duplicated")?;
        state.edit(edit, false)?;
        go_to(state, &pointer);
    }
    Ok(())
}

fn reorder(state: &mut State, call: &Call) -> Done {
    let pointer = target(state)?;
    let (_, index) = split_item(state, &pointer).ok_or("only items of lists are moved")?;
    let to = index as i64 + if call.text == "up" { -call.times() } else { call.times() };
    let moved = usize::try_from(to).ok().and_then(|to| Edit::move_item(state.document(), &pointer, to));
    let (edit, pointer) = moved.ok_or("it cannot go farther")?;
    state.edit(edit, false)?;
    go_to(state, &pointer);
    Ok(())
}
