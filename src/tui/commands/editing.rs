//! Changing the scene: entries, steps, choices, items added, taken away and moved; undo.

use serde_json::Value;

use super::{Call, Command, Done, command};
use crate::base::maths;
use crate::scene::field::{self, Kind};
use crate::scene::{Edit, address};
use crate::tui::app::{Mode, Pane, State};
use crate::tui::choice::{self, Choice, Then};
use crate::tui::door::Door;
use crate::tui::entry::{self, Entry};
use crate::tui::sheet::{Cell, Row};
use crate::tui::update::Change;

pub const COMMANDS: &[Command] = &[
    command("enter", "[clear]", "Edit the cell, or go into the node", enter),
    command("commit", "[next]", "Take the value being typed", commit),
    command("digit", "BY", "Step the digit under the cursor", digit),
    command("choice", "next|previous|take", "Move in the list of choices, or take one", choose),
    command("step", "BY", "Step the number by the step", step),
    command("step-size", "smaller|larger|POWER", "Change the step tenfold", step_size),
    command("select", "", "Begin or end a selection of rows", select),
    command("add", "", "Add an item to the list, or an optional node", add),
    command("delete", "", "Delete the row, the selection or the node", delete),
    command("duplicate", "", "Duplicate the row or the node", duplicate),
    command("reorder", "down|up", "Move the row or the node among its siblings", reorder),
    command("set", "PATH=VALUE", "Set a value by its path", set),
    command("get", "PATH", "Say the value at a path", get),
    command("undo", "[STEPS]", "Undo", undo),
    command("redo", "[STEPS]", "Redo", redo),
];

fn current(state: &State) -> Option<(Row, Cell)> {
    let row = state.sheet().rows.get(state.row)?.clone();
    let cell = row.cells.get(state.column)?.clone();
    Some((row, cell))
}

fn enter(state: &mut State, call: &Call) -> Done {
    let (row, cell) = current(state).ok_or("there is nothing to edit here: o adds an item")?;
    let missing = field::value(state.document(), &cell.pointer).is_none_or(|value| value.is_null());
    if cell.is_node() && missing {
        return add(state, call);
    }
    // The kind of an item with an inside of its own stands for the item; its form has the kind again.
    let into = row.item && state.column == 0 && row.cells.iter().any(Cell::is_node);
    if cell.is_node() || into {
        state.show(if into { row.pointer } else { cell.pointer });
        return Ok(());
    }
    let sheet = state.sheet();
    let others = entry::cells(state, &sheet).iter().map(|(_, cell)| cell.pointer.clone()).collect();
    if cell.is_number() || matches!(cell.field.kind, Kind::Text) {
        state.mode = Mode::Entry(Entry::new(state.document(), &cell, call.text == "clear"));
    } else if let Some(choice) = choice::of_cell(state, &cell, others) {
        state.mode = Mode::Choice(choice);
    } else {
        return Err(format!("{} cannot be edited here", row.label));
    }
    Ok(())
}

/// Takes the entry. Where it cannot be taken it stays as it was typed.
fn commit(state: &mut State, call: &Call) -> Done {
    let Mode::Entry(typed) = &state.mode else { return Ok(()) };
    let text = typed.text.value().to_string();
    let edit = entry::edit(state, &text)?;
    state.edit(edit, false)?;
    state.mode = Mode::Normal;
    if call.text == "next" {
        let cells = state.sheet().rows.get(state.row).map_or(0, |row| row.cells.len());
        if state.column + 1 < cells {
            state.column += 1;
        } else {
            state.row += 1;
            state.column = 0;
            state.settle();
        }
        let typed = current(state).is_some_and(|(_, cell)| cell.is_number() || matches!(cell.field.kind, Kind::Text));
        if typed {
            return enter(state, &Call { text: "", count: None });
        }
    }
    Ok(())
}

fn digit(state: &mut State, call: &Call) -> Done {
    let by = call.text.parse().unwrap_or(1);
    let Mode::Entry(entry) = &mut state.mode else { return Ok(()) };
    if entry.text.step_digit(by) { Ok(()) } else { Err("there is no digit under the cursor".into()) }
}

fn choose(state: &mut State, call: &Call) -> Done {
    let Mode::Choice(choice) = &mut state.mode else { return Ok(()) };
    match call.text {
        "next" => choice.step(call.times()),
        "previous" => choice.step(-call.times()),
        _ => {
            let (then, word) = (choice.then.clone(), choice.taken().map(str::to_owned));
            state.mode = Mode::Normal;
            if let Some(word) = word {
                return take(state, then, &word);
            }
        }
    }
    Ok(())
}

fn take(state: &mut State, then: Then, word: &str) -> Done {
    let document = state.document();
    let edit = match &then {
        Then::Set(pointers) => {
            let bool = |pointer: &str| field::field(document, pointer).is_some_and(|field| field.kind == Kind::Bool);
            let value = |pointer: &str| if bool(pointer) { Value::from(word == "true") } else { Value::from(word) };
            Edit::all(pointers.iter().map(|pointer| entry::set(document, pointer, value(pointer))))
        }
        Then::Become(pointer) => match field::field(document, pointer).map(|field| field.kind) {
            Some(Kind::Tagged { tag, .. }) => entry::set(document, &format!("{pointer}/{tag}"), word.into()),
            _ => return Err(format!("{pointer} has no kinds")),
        },
        Then::Recover => {
            let change = state.door.recover(word == choice::RECOVER);
            change.into_iter().for_each(|change| state.changed(change));
            return Ok(());
        }
    };
    state.edit(edit, false)
}

/// Steps every selected cell from its own value: numbers by the step, choices by one.
fn step(state: &mut State, call: &Call) -> Done {
    let by = call.text.parse::<i64>().unwrap_or(1) * call.times();
    let sheet = state.sheet();
    let (_, cell) = current(state).ok_or("there is nothing to step here")?;
    if !cell.is_number() {
        let others = entry::cells(state, &sheet).iter().map(|(_, cell)| cell.pointer.clone()).collect();
        let mut choice: Choice = choice::of_cell(state, &cell, others).ok_or("only numbers and choices step")?;
        choice.step(by);
        let word = choice.taken().unwrap_or_default().to_string();
        return take(state, choice.then, &word);
    }
    let unit = step_of(state.step);
    let edits = entry::cells(state, &sheet).into_iter().map(|(_, cell)| {
        let old = cell.number(state.document()).unwrap_or(0.0);
        let value = crate::tui::numbers::tidy(old + by as f64 * unit);
        entry::number(state.document(), cell, value)
    });
    let edit = Edit::all(edits.collect::<Result<Vec<_>, _>>()?);
    state.edit(edit, true)
}

/// The step of a power of ten.
pub fn step_of(power: i32) -> f64 {
    let size = maths::powi(10.0, power.unsigned_abs());
    if power < 0 { 1.0 / size } else { size }
}

fn step_size(state: &mut State, call: &Call) -> Done {
    let times = call.times() as i32;
    let power = match call.text {
        "smaller" => state.step - times,
        "larger" => state.step + times,
        text => text.parse().map_err(|_| "step-size takes smaller, larger or a power of ten")?,
    };
    state.step = power.clamp(-3, 3);
    state.say(format!("step {}", step_of(state.step)));
    Ok(())
}

fn select(state: &mut State, _: &Call) -> Done {
    state.selected_from = if state.selected_from.is_some() { None } else { Some(state.row) };
    Ok(())
}

/// What the node or the row under the cursor is: its pointer.
fn target(state: &State) -> Result<String, String> {
    match state.focus {
        Pane::Tree => Ok(state.node.clone()),
        _ => state.sheet().rows.get(state.row).map(|row| row.pointer.clone()).ok_or("there is no row here".into()),
    }
}

fn split_item(state: &State, pointer: &str) -> Option<(String, usize)> {
    let (list, index) = pointer.rsplit_once('/')?;
    let index = index.parse().ok()?;
    let is_list = field::field(state.document(), list).is_some_and(|field| matches!(field.kind, Kind::List(_)));
    is_list.then(|| (list.to_string(), index))
}

fn add(state: &mut State, _: &Call) -> Done {
    let pointer = target(state).unwrap_or(state.node.clone());
    let field = field::field(state.document(), &pointer).ok_or("nothing can be added here")?;
    let there = field::value(state.document(), &pointer).is_some_and(|value| !value.is_null());
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
    match state.sheet().rows.iter().position(|row| row.pointer == pointer) {
        Some(row) => state.row = row,
        None if state.focus == Pane::Tree => state.show(pointer),
        None => {
            let list = pointer.rsplit_once('/').map_or("", |(list, _)| list).to_string();
            state.show(list);
            state.row = state.sheet().rows.iter().position(|row| row.pointer == pointer).unwrap_or(0);
        }
    }
    state.settle();
}

/// Items go from their lists, the last first, as one edit; a field goes back to its default.
fn delete(state: &mut State, _: &Call) -> Done {
    let sheet = state.sheet();
    let pointers: Vec<String> = match state.focus {
        Pane::Tree => vec![state.node.clone()],
        _ => entry::rows(state).rev().filter_map(|i| sheet.rows.get(i)).map(|row| row.pointer.clone()).collect(),
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

/// VALUE is JSON, else text.
fn set(state: &mut State, call: &Call) -> Done {
    let (path, value) = split_path(call.text).ok_or("set takes PATH=VALUE")?;
    let pointer = address::resolve(state.document(), path).map_err(|error| error.to_string())?;
    let text = field::field(state.document(), &pointer).is_some_and(|field| field.kind == Kind::Text);
    let value = match serde_json::from_str(value) {
        Ok(value) if !text => value,
        _ => Value::from(value),
    };
    let edit = entry::set(state.document(), &pointer, value);
    state.edit(edit, false)?;
    state.say(format!("{path} is set"));
    Ok(())
}

/// The path and the value around the first `=` outside quotes.
fn split_path(text: &str) -> Option<(&str, &str)> {
    let mut quoted = false;
    let equals = text.char_indices().find(|&(_, c)| {
        quoted ^= c == '"';
        c == '=' && !quoted
    })?;
    Some((text[..equals.0].trim(), text[equals.0 + 1..].trim()))
}

fn get(state: &mut State, call: &Call) -> Done {
    let pointer = address::resolve(state.document(), call.text).map_err(|error| error.to_string())?;
    let value = field::value(state.document(), &pointer).unwrap_or(Value::Null);
    state.say(crate::tui::terminal::plain(&value.to_string()));
    Ok(())
}

fn undo(state: &mut State, call: &Call) -> Done {
    repeat(state, call, "nothing to undo", Door::undo)
}

fn redo(state: &mut State, call: &Call) -> Done {
    repeat(state, call, "nothing to redo", Door::redo)
}

fn repeat(state: &mut State, call: &Call, none: &str, step: fn(&mut Door) -> Option<Change>) -> Done {
    let times = call.text.parse().unwrap_or(call.times()).max(1);
    let done: Vec<Change> = (0..times).map_while(|_| step(&mut state.door)).collect();
    if done.is_empty() {
        return Err(none.into());
    }
    done.into_iter().for_each(|change| state.changed(change));
    Ok(())
}
