//! Duplicates, moves and sorts rows and nodes.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use serde_json::Value;

use super::command::{Call, Command, Done, command};
use super::items::{alike, bearable, go_to, insert_entries, owned, target};
use crate::base::pointer::Pointer;
use crate::base::text::counted;
use crate::layers::parts::materials::List;
use crate::scene::{Edit, field, json};
use crate::tui::document::cell::Cell;
use crate::tui::document::pointers::item_of;
use crate::tui::document::rows::same;
use crate::tui::state::{Pane, State, entry};
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[
    command("duplicate", "", "Duplicate the row or the node", duplicate).change().counted(),
    command("reorder", "down|up", "Move the row or the node among its siblings", reorder).change().counted(),
    command(
        "sort",
        "[COLUMN|EXPRESSION] [desc]",
        "Sort the selected rows, or all of the list, by a column or an expression",
        sort,
    )
    .change(),
];

/// The block of items that an edit of whole rows applies to: their list, the first and the last index.
fn block(state: &State) -> Result<(String, usize, usize), String> {
    let one = || -> Option<(String, usize, usize)> {
        let (list, index) = item_of(state.document(), &target(state).ok()?).map(owned)?;
        Some((list, index, index))
    };
    if state.cursor.focus == Pane::Tree || !state.cursor.selects() {
        return one().ok_or("only items of lists are duplicated and moved".into());
    }
    let (sheet, rows) = (state.sheet(), state.cursor.rows());
    let end = |row: usize| item_of(state.document(), &sheet.pointer(row)?).map(owned);
    let ends = rows.first().zip(rows.last());
    match ends.map(|(&first, &last)| (end(first), end(last))) {
        Some((Some((list, from)), Some((other, to)))) if list == other && to + 1 - from == rows.len() => {
            Ok((list, from, to))
        }
        Some((Some((list, _)), Some((other, _)))) if list == other => {
            Err("only rows next to each other are duplicated and moved together".into())
        }
        _ => Err("only items of one list are duplicated and moved together".into()),
    }
}

/// Moves the cursor and the selection with a block that moved by `by` rows.
fn follow(state: &mut State, list: &str, at: usize, by: i64) {
    let moved = |row: usize| usize::try_from(row as i64 + by).unwrap_or(0);
    match state.cursor.selects() && state.cursor.focus != Pane::Tree {
        true => {
            state.cursor.selected_from = state.cursor.selected_from.map(moved);
            state.cursor.selected_to = state.cursor.selected_to.map(moved);
            state.cursor.picked = state.cursor.picked.iter().map(|&row| moved(row)).collect();
            state.cursor.row = moved(state.cursor.row);
        }
        false => go_to(state, &Pointer(list).join(at)),
    }
    state.settle();
}

/// Inserts copies after the originals, and moves the selection to them.
fn duplicate(state: &mut State, call: &Call) -> Done {
    let times = call.times_of("duplicate")?;
    let path = target(state)?;
    if let Some((map, name)) = Pointer(&path).split().filter(|_| List::entry(&path).is_some()) {
        let value = field::value(state.document(), &path).unwrap_or(Value::Null);
        let entry = [(name, value)].into_iter().collect();
        let (edit, path) = insert_entries(state, map, &entry, times)?.ok_or("there is nothing to duplicate here")?;
        state.edit(edit, false)?;
        go_to(state, &path);
        return Ok(());
    }
    let (list, from, to) = block(state)?;
    let items = field::value(state.document(), &list).unwrap_or(Value::Null);
    let items = items.as_array().and_then(|items| items.get(from..=to)).unwrap_or_default();
    bearable(state, items.iter().map(json::bytes).sum::<u64>().saturating_mul(times as u64))?;
    let copies = items.iter().cloned().cycle().take(items.len() * times).collect();
    let added = Edit::insert_all(state.document(), &list, to + 1, copies);
    let (edit, path) = added.ok_or("only items of lists are duplicated")?;
    let revision = state.scene.revision();
    state.edit(edit, false)?;
    if state.scene.revision() == revision {
        return Err("copies of several of these would overlap them: duplicate them one by one".into());
    }
    match state.cursor.selects() {
        true => follow(state, &list, to + 1, (to + 1 - from) as i64),
        false => go_to(state, &path),
    }
    Ok(())
}

/// Moves a block as far as possible, by moving the items that it passes to its other side.
fn reorder(state: &mut State, call: &Call) -> Done {
    let (list, from, to) = block(state)?;
    let mut items =
        field::value(state.document(), &list).and_then(|items| items.as_array().cloned()).unwrap_or_default();
    let (up, times) = (call.text == "up", call.times() as usize);
    let by = times.min(if up { from } else { items.len().saturating_sub(to + 1) });
    if by == 0 {
        return Err("it cannot move any further".into());
    }
    let passed = (0..by).filter_map(|k| {
        let (at, onto) = if up { (from - 1 - k, to - k) } else { (to + 1 + k, from + k) };
        Edit::move_item(state.document(), &Pointer(&list).join(at), onto).map(|(edit, _)| edit)
    });
    let edit = match state.document().json().pointer(&list) {
        Some(_) => Edit::all(passed),
        // It is not written: its default is, in the new order.
        None => {
            if up {
                items[from - by..=to].rotate_left(by)
            } else {
                items[from..=to + by].rotate_right(by)
            }
            Edit::set(state.document(), &list, items.into())
        }
    };
    let by = if up { -(by as i64) } else { by as i64 };
    state.edit(edit, false)?;
    follow(state, &list, (from as i64 + by) as usize, by);
    Ok(())
}

/// What rows are sorted by.
#[derive(PartialEq, PartialOrd)]
enum Key {
    Number(f64),
    Word(String),
    /// The row has nothing in that column: it comes last.
    Missing,
}

/// Sorts the selected rows, else all rows of the list, by a column or by what an expression over their columns gives.
fn sort(state: &mut State, call: &Call) -> Done {
    let text = call.text.trim();
    let (by, down) = match text.strip_suffix("desc") {
        Some(by) if by.is_empty() || by.ends_with(' ') => (by.trim_end(), true),
        _ => (text, false),
    };
    let rows = match state.cursor.selects() && state.cursor.focus != Pane::Tree {
        true => state.cursor.rows(),
        false => alike(state).map(|(first, last)| (first..=last).collect()).unwrap_or_default(),
    };
    let sheet = state.sheet();
    let places = rows.iter().map(|&row| item_of(state.document(), &sheet.pointer(row)?).map(owned));
    let places: Vec<(String, usize)> = places.collect::<Option<_>>().unwrap_or_default();
    let (list, _) = places.first().cloned().ok_or("only rows of a list are sorted: go to one")?;
    if places.iter().any(|(other, _)| *other != list) {
        return Err("only rows of one list are sorted together".into());
    }
    let (name, keys) = keys(state, &rows, &unquoted(by))?;
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|&a, &b| match (&keys[a], &keys[b]) {
        (Key::Missing, _) | (_, Key::Missing) => (keys[a] == Key::Missing).cmp(&(keys[b] == Key::Missing)),
        (a, b) if down => b.partial_cmp(a).unwrap_or(Ordering::Equal),
        (a, b) => a.partial_cmp(b).unwrap_or(Ordering::Equal),
    });
    let old = field::value(state.document(), &list).and_then(|items| items.as_array().cloned()).unwrap_or_default();
    let mut items = old.clone();
    for (to, &from) in places.iter().zip(&order) {
        if let (Some(item), Some(value)) = (items.get_mut(to.1), old.get(places[from].1)) {
            item.clone_from(value);
        }
    }
    let edit = if items == old { Edit::default() } else { Edit::set(state.document(), &list, items.into()) };
    let here = rows.iter().position(|&row| row == state.cursor.row);
    state.edit(edit, false)?;
    // The cursor goes with its row.
    let now = here.and_then(|here| order.iter().position(|&from| from == here));
    state.cursor.row = now.and_then(|now| rows.iter().nth(now)).copied().unwrap_or(state.cursor.row);
    state.settle();
    let way = if down { ", the largest first" } else { "" };
    state.say(format!("{} sorted by {name}{way}", counted(rows.len(), "row")));
    Ok(())
}

/// What rows are sorted by, and its name: a column, that under the cursor if none is given, or an expression.
fn keys(state: &State, rows: &BTreeSet<usize>, by: &str) -> Result<(String, Vec<Key>), String> {
    let (document, sheet) = (state.document(), state.sheet());
    let here = state.row();
    let head = match by {
        "" => here.as_ref().and_then(|row| state.cursor.cell(row)).map(|cell| cell.head.clone()).unwrap_or_default(),
        by => by.to_owned(),
    };
    let key = |cell: &Cell| match cell.number(document) {
        Some(number) if cell.is_number() => Key::Number(number),
        _ => Key::Word(cell.text.to_lowercase()),
    };
    let of = |&row: &usize| {
        let row = sheet.row(row);
        let cell = row.as_ref().and_then(|row| row.cells.iter().find(|cell| same(&head, &cell.head)));
        cell.map_or(Key::Missing, key)
    };
    let keys: Vec<Key> = rows.iter().map(of).collect();
    if by.is_empty() || keys.iter().any(|key| *key != Key::Missing) {
        return Ok((if head.is_empty() { "value".into() } else { head }, keys));
    }
    let values = entry::of_rows(state, rows, by)?;
    Ok((head, values.into_iter().map(|value| value.map_or(Key::Missing, Key::Number)).collect()))
}
