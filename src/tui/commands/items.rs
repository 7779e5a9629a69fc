//! Adds and deletes rows and nodes as a whole.

use crate::base::pointer::Pointer;
use crate::scene::{Document, address};
use crate::tui::document::pointers::item_of;
use crate::tui::text::plain;
use serde_json::{Map, Value};

use std::collections::BTreeSet;

use super::command::{Call, Command, Done, command};
use crate::base::budget;
use crate::base::problem::quoted;
use crate::layers::parts::materials::List;
use crate::layers::shapes::node::{self, Node};
use crate::layers::shapes::shape;
use crate::scene::field::{self, Kind};
use crate::scene::schema::Place;
use crate::scene::{Edit, json};
use crate::tui::document::cell::Cell;
use crate::tui::document::choice;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::events::Effect;
use crate::tui::state::recorder::WorkLimit;
use crate::tui::state::{Mode, Pane, State, first};
use crate::tui::text::line::Line;

pub const COMMANDS: &[Command] =
    &[command("delete", "", "Delete the row, the selection or the node", delete).change().counted()];

/// The pointer of the node or the row under the cursor.
pub fn target(state: &State) -> Result<String, String> {
    match state.cursor.focus {
        Pane::Tree => Ok(state.cursor.node.clone()),
        Pane::Table | Pane::Picture => state.sheet().pointer(state.cursor.row).ok_or("there is no row here".into()),
    }
}

/// The nodes or rows that a command applies to, in order: the selection, else as many as the count says from the cursor on,
/// to the end of the list at most.
pub fn targets(state: &State, call: &Call) -> Result<Vec<String>, String> {
    let sheet = state.sheet();
    if state.cursor.focus != Pane::Tree {
        return Ok(rows(state, call)?.into_iter().filter_map(|i| sheet.pointer(i)).collect());
    }
    let node = target(state)?;
    match (call.count, item_of(state.document(), &node).map(owned)) {
        (None | Some(1), _) => Ok(vec![node]),
        (Some(_), None) => Err("a count needs items of a list: go to one".into()),
        (Some(count), Some((list, index))) => {
            let items = state.document().json().pointer(&list).and_then(Value::as_array).map_or(0, Vec::len);
            Ok((index..items.min(index + count.max(1))).map(|i| Pointer(&list).join(i)).collect())
        }
    }
}

/// The rows that a command applies to: the selection, else as many as the count says from the cursor on, as far as there are
/// rows like the one under it.
pub fn rows(state: &State, call: &Call) -> Result<BTreeSet<usize>, String> {
    match call.count {
        None => Ok(state.cursor.rows()),
        Some(_) if state.cursor.selects() => Err("the selection says which rows, not a count".into()),
        Some(count) => {
            let row = state.cursor.row;
            let last = alike(state).map_or(row, |(_, last)| last);
            Ok((row..=(row + count.max(1) - 1).min(last)).collect())
        }
    }
}

/// The first and the last of the rows around the cursor that are like the one under it: in a table all rows, in a form the
/// items of one list, or the fields.
pub fn alike(state: &State) -> Option<(usize, usize)> {
    let sheet = state.sheet();
    if sheet.table {
        return Some((0, sheet.len().checked_sub(1)?));
    }
    let row = sheet.row(state.cursor.row)?;
    let list = |row: &crate::tui::document::sheet::Row| {
        row.item.then(|| Pointer(&row.pointer).parent().map(str::to_owned)).flatten()
    };
    let own = list(&row);
    let like = |i: &usize| sheet.row(*i).is_some_and(|row| list(&row) == own);
    let first = (0..=state.cursor.row).rev().take_while(like).last()?;
    let last = (state.cursor.row..sheet.len()).take_while(like).last()?;
    Some((first, last))
}

/// Adds so many items at the cursor. If a path or a kind is needed, it is typed or chosen next.
pub fn add_here(state: &mut State, times: usize) -> Done {
    let mut pointer = target(state).unwrap_or(state.cursor.node.clone());
    if let Some(holder) = Pointer(&pointer).parent().filter(|_| field::is_there(state.document(), &pointer))
        && field::laid(state.document(), holder).is_some()
    {
        pointer.truncate(holder.len());
    }
    let field = field::field(state.document(), &pointer).ok_or("nothing can be added here")?;
    let there = field::is_there(state.document(), &pointer);
    let in_list = match (&field.kind, there) {
        (Kind::List(_), _) => true,
        (Kind::Map(_), _) | (Kind::Object | Kind::Tagged { .. }, false) => false,
        (Kind::Object | Kind::Tagged { .. }, true)
        | (Kind::Number { .. } | Kind::Numbers(_), _)
        | (Kind::Text | Kind::Bool | Kind::Choice(_) | Kind::Reference(_), _) => item_of(state.document(), &pointer)
            .map(owned)
            .or_else(|| item_of(state.document(), &state.cursor.node).map(owned))
            .is_some(),
    };
    if times > 1 && !in_list {
        return Err("only items of a list are added several at a time".into());
    }
    let end = || state.document().json().pointer(&pointer).and_then(Value::as_array).map_or(0, Vec::len);
    match (&field.kind, there) {
        (Kind::Tagged { .. }, false) => {
            let options = choice::options(state.document(), &field.kind);
            state.typing.mode = Mode::Choice(Choice { title: field.name, options, at: 0, then: Then::Become(pointer) });
            Ok(())
        }
        (Kind::Object, false) => add_object(state, &pointer),
        (Kind::List(_), _) => insert(state, &pointer.clone(), end(), times),
        (Kind::Map(_), _) if entry_of_file(&Pointer(&pointer).join("")) => ask_for_path(state, &pointer),
        (Kind::Map(_), _) if pointer == SHAPES => add_shape(state),
        (Kind::Map(_), _) => insert_entry(state, &pointer, &field.name),
        (Kind::Object | Kind::Tagged { .. }, true)
        | (Kind::Number { .. } | Kind::Numbers(_), _)
        | (Kind::Text | Kind::Bool | Kind::Choice(_) | Kind::Reference(_), _) => {
            match item_of(state.document(), &pointer).map(owned) {
                Some((list, index)) => insert(state, &list, index + 1, times),
                None if entry_of_file(&pointer) => ask_for_path(state, &pointer),
                None if List::entry(&pointer).is_some() => add_shape(state),
                None if state.cursor.focus == Pane::Tree => {
                    Err("o adds to lists: go to a list or to one of its items".into())
                }
                None => match item_of(state.document(), &state.cursor.node.clone()).map(owned) {
                    Some((list, index)) => insert(state, &list, index + 1, times),
                    None => Err("nothing can be added here".into()),
                },
            }
        }
    }
}

/// Where the shapes of the scene are.
const SHAPES: &str = "/shapes";

/// Adds a shape at the picture's cursor.
fn add_shape(state: &mut State) -> Done {
    const HALF_PX: f64 = 20.0;
    let at = state.picture.cursor;
    let node = |by: f64| node::written(&Node::corner([(at.x + by).round(), at.y.round()]));
    let entry = [("shape".to_owned(), shape::written(vec![node(-HALF_PX), node(HALF_PX)]))];
    let added = Edit::insert_entries(state.document(), SHAPES, entry.into_iter().collect());
    let (edit, pointer) = added.ok_or("nothing can be added here")?;
    state.edit(edit, false)?;
    go_to(state, &pointer);
    let place = plain(&address::address(state.document(), &pointer));
    state.say(format!("{place}: R renames it, :use on an outline or a curve makes that of it"));
    Ok(())
}

fn entry_of_file(pointer: &str) -> bool {
    List::entry(pointer).is_some_and(|(list, _)| list.has_files())
}

fn ask_for_path(state: &mut State, pointer: &str) -> Done {
    let what = match Pointer(pointer).tokens().next().as_deref() {
        Some("clips") => "the clip's files as falls/%04d.jpg, or a video",
        Some("meshes") => "the mesh's file",
        _ => "the picture's file",
    };
    state.typing.mode = Mode::Line(Line::with("add "));
    state.say(format!("{what}, relative to the scene (Tab completes)"));
    Ok(())
}

/// Adds an optional object, with the fields that it must have.
fn add_object(state: &mut State, pointer: &str) -> Done {
    let edit = Edit::begin(state.document(), pointer).ok_or("nothing can be added here")?;
    state.edit(edit, false)
}

/// Adds an entry to a map in which nothing is written yet.
fn insert_entry(state: &mut State, map: &str, name: &str) -> Done {
    let entry = [(name.trim_end_matches('s').to_owned(), Value::Object(Map::new()))].into_iter().collect();
    let (edit, pointer) = Edit::insert_entries(state.document(), map, entry).ok_or("nothing can be added here")?;
    state.edit(edit, false)?;
    go_to(state, &pointer);
    Ok(())
}

fn insert(state: &mut State, list: &str, index: usize, times: usize) -> Done {
    let nothing = "nothing can be added here";
    let (mut edit, mut pointer) = Edit::insert_new(state.document(), list, index).ok_or(nothing)?;
    if times > 1 {
        let with = state.document().apply(&edit).map_err(|problems| first(&problems))?;
        let item = field::value(&with, &pointer).ok_or(nothing)?;
        bearable(state, json::bytes(&item).saturating_mul(times as u64))?;
        (edit, pointer) = Edit::insert_all(state.document(), list, index, vec![item; times]).ok_or(nothing)?;
    }
    state.edit(edit, false)?;
    go_to(state, &pointer);
    let row = state.row().filter(|_| state.cursor.focus == Pane::Table);
    let number = row.and_then(|row| row.cells.iter().position(Cell::is_number));
    state.cursor.column = number.unwrap_or(state.cursor.column);
    Ok(())
}

/// Puts the cursor on the item at `pointer`: on its row if its list is shown, else on its node.
pub fn go_to(state: &mut State, pointer: &str) {
    match state.sheet().position(pointer) {
        Some(row) => state.cursor.row = row,
        None if state.cursor.focus == Pane::Tree => state.show(pointer),
        None => {
            let list = Pointer(pointer).parent().unwrap_or_default().to_owned();
            state.show(list);
            state.cursor.row = state.sheet().position(pointer).unwrap_or(0);
        }
    }
    state.settle();
    // Windows show what is selected.
    state.ask(Effect::Show);
}

/// Deletes items in one edit, the last first; a field goes back to its default.
fn delete(state: &mut State, call: &Call) -> Done {
    let targets = targets(state, call)?;
    let mut pointers: Vec<String> =
        targets.iter().rev().map(|pointer| field::as_written(state.document(), pointer).0).collect();
    if targets.iter().rev().ne(&pointers) {
        // Rows by name may be written in any order.
        pointers.sort_by_key(|pointer| std::cmp::Reverse(item_of(state.document(), pointer).map(|(_, index)| index)));
    }
    let written = |pointer: &&String| !pointer.is_empty() && state.document().json().pointer(pointer).is_some();
    let edits: Vec<Edit> = pointers.iter().filter(written).map(|pointer| Edit::remove(pointer)).collect();
    if edits.is_empty() {
        return Err(targets.first().and_then(|target| kept(state.document(), target)).unwrap_or(NOTHING.into()));
    }
    pointers.iter().try_for_each(|pointer| unused(state.document(), pointer, &pointers))?;
    let top = state.cursor.rows().first().copied().unwrap_or(0);
    state.edit(Edit::all(edits), false)?;
    if state.cursor.selects() {
        state.cursor.pick(BTreeSet::new());
        state.cursor.row = top;
        state.settle();
    }
    Ok(())
}

const NOTHING: &str = "there is nothing to delete here";

/// What to set so that an item that is there without being written is left out.
fn kept(document: &Document, pointer: &str) -> Option<String> {
    let (holder, name) = Pointer(pointer).split()?;
    let laid = Place::of(document.json(), holder)?.shape.laid().filter(|_| field::is_there(document, pointer))?;
    let address = address::address(document, pointer);
    let setting = if laid == "null" { format!("{address}=null") } else { format!("{address}.{laid}=true") };
    Some(plain(&format!(
        "{} is the style's, and nothing of it is written here (:set {setting} leaves it out)",
        quoted(&name)
    )))
}

/// Refuses to make something that takes this much memory, if that is too much.
pub fn bearable(state: &State, bytes: u64) -> Done {
    let most = state.scene.options().limits.paste.saturating_mul(8);
    if bytes <= most {
        return Ok(());
    }
    Err(format!(
        "that makes {} of the scene, at most {} at once (--limit paste)",
        budget::size(bytes),
        budget::size(most)
    ))
}

/// The edit that adds entries to a map so many times, each time under new names; also returns the pointer of the first.
pub fn insert_entries(
    state: &State,
    map: &str,
    entries: &Map<String, Value>,
    times: usize,
) -> Result<Option<(Edit, String)>, String> {
    let (mut document, mut work) = (state.document().clone(), WorkLimit::default());
    let (mut edits, mut first_path) = (Vec::new(), None);
    for _ in 0..times {
        work.spend(&document)?;
        let Some((edit, path)) = Edit::insert_entries(&document, map, entries.clone()) else { return Ok(None) };
        document = document.apply(&edit).map_err(|problems| first(&problems))?;
        edits.push(edit);
        first_path.get_or_insert(path);
    }
    Ok(first_path.map(|path| (Edit::all(edits), path)))
}

/// Refuses to delete a picture, a mesh, a clip or a layer that is used.
fn unused(document: &Document, path: &str, deleted: &[String]) -> Done {
    let layer = Pointer(path).item_of("/layers").filter(|(_, way)| way.is_empty());
    let layer = layer.and_then(|(index, _)| document.scene().layers.get(index));
    let layer = layer.map(|layer| (List::Layers, layer.technique().name().to_owned()));
    let Some((list, name)) = List::entry(path).or(layer) else { return Ok(()) };
    let stays = |user: &String| !deleted.iter().any(|path| Pointer(user).is_within(path));
    let users = document.scene().users_of(list, &name).filter(stays);
    let users: Vec<String> = users.map(|path| address::address(document, &path)).collect();
    match users.as_slice() {
        [] => Ok(()),
        [first, rest @ ..] => {
            let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
            Err(plain(&format!("{name} is used by {first}{more}: choose another {} there first", list.words().1)))
        }
    }
}

/// The list and the index of an item, by themselves.
pub fn owned((list, index): (&str, usize)) -> (String, usize) {
    (list.to_owned(), index)
}
