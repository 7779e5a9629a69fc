//! Handles a paste of the terminal while nothing is being typed: a number into a cell, rows into a list, a value as JSON.
//! Each becomes a line, so that scripts and macros can contain it.

use serde_json::Value;

use super::command::Done;
use super::{cells, obey};
use crate::base::pointer::Pointer;
use crate::scene::field;
use crate::tui::document::csv;
use crate::tui::document::pointers::item_of;
use crate::tui::document::rows::Target;
use crate::tui::state::{Pane, State};
use crate::tui::text::numbers;

/// Pastes a text as one step of undo. If something is wrong with it, nothing changes.
pub fn pasted(state: &mut State, text: &str) -> Done {
    let limits = &state.scene.options().limits;
    if text.len() as u64 > limits.paste {
        return Err(format!("{} bytes are too many to paste: {} at most", text.len(), limits.paste));
    }
    let trimmed = text.trim();
    if trimmed.is_empty() {
        return Err("the paste is empty".into());
    }
    // A quote may begin a table with a quoted field, or JSON.
    let json = trimmed.starts_with(['{', '['])
        || trimmed.starts_with('"') && serde_json::from_str::<Value>(trimmed).is_ok_and(|value| value.is_string());
    if json {
        return obey(state, &format!("paste {}", trimmed.replace(['\n', '\r'], " ")), None);
    }
    let in_table = state.cursor.focus == Pane::Table;
    let on_number = in_table && cells::current(state).is_some_and(|(_, cell)| cell.is_number());
    // A comma within one number is a decimal comma, as in an entry.
    if let (true, Some(number)) = (on_number, csv::number(trimmed)) {
        return obey(state, &format!("put {}", numbers::exact(number)), None);
    }
    if state.cursor.selects() && in_table {
        let lines: Vec<&str> = trimmed.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let column = on_number && lines.iter().all(|line| csv::number(line).is_some());
        let rows: Vec<Vec<String>> = match column {
            true => lines.iter().map(|line| vec![(*line).to_owned()]).collect(),
            false => csv::records(text)?.into_iter().map(|record| record.fields).collect(),
        };
        return obey(state, &format!("fill {}", Value::from(rows)), None);
    }
    let most = limits.items();
    let items = target(state)
        .ok_or("no list here takes rows: go to one whose items are numbers in columns")?
        .items(text, most)?;
    let value = if let [one] = &items[..] { one.clone() } else { Value::from(items) };
    obey(state, &format!("paste {value}"), None)
}

/// The list that takes rows: the one under the cursor, one around it, or one inside the node.
fn target(state: &State) -> Option<Target<'_>> {
    let document = state.document();
    let here = state.here();
    let lists = Pointer(&here).upward().map(|path| item_of(document, path).map_or(path, |(list, _)| list).to_owned());
    let inside = field::children(document, &state.cursor.node).into_iter();
    let inside = inside.filter(|child| child.field.kind.is_list()).map(|child| child.pointer);
    lists.chain(inside).find_map(|list| Target::of(document, &list))
}
