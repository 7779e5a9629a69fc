//! What the terminal pastes while nothing is being typed: a number into a cell, rows into a list, a value as JSON. Each
//! becomes a line, so that a script or a macro has it too.

use serde_json::Value;

use super::yanking::{here, item_of, upward};
use super::{Done, cells, obey};
use crate::scene::field::{self, Kind};
use crate::tui::app::{Pane, State};
use crate::tui::rows::Target;

/// Takes a pasted text, as one step of undo; where something is wrong with it, nothing changes.
pub fn pasted(state: &mut State, text: &str) -> Done {
    let limits = &state.door.options().limits;
    if text.len() as u64 > limits.paste {
        return Err(format!("{} bytes are too many to paste: {} at most", text.len(), limits.paste));
    }
    let trimmed = text.trim();
    if trimmed.is_empty() {
        return Err("nothing was pasted".into());
    }
    if trimmed.starts_with(['{', '[', '"']) {
        return obey(state, &format!("paste {}", trimmed.replace(['\n', '\r'], " ")), None);
    }
    let on_number = state.focus == Pane::Table && cells::current(state).is_some_and(|(_, cell)| cell.is_number());
    if on_number && trimmed.parse().is_ok_and(f64::is_finite) {
        return obey(state, &format!("put {trimmed}"), None);
    }
    let most = limits.points;
    let items =
        target(state).ok_or("no list here takes rows: go to anchors, points or keyframes")?.items(text, most)?;
    let value = if let [one] = &items[..] { one.clone() } else { Value::from(items) };
    obey(state, &format!("paste {value}"), None)
}

/// The list that takes rows: the one under the cursor, one that holds it, one inside the node.
fn target(state: &State) -> Option<Target<'_>> {
    let document = state.document();
    let here = here(state);
    let lists = upward(&here).map(|path| item_of(document, path).map_or(path, |(list, _)| list).to_owned());
    let inside = field::children(document, &state.node).into_iter();
    let inside = inside.filter(|child| matches!(child.field.kind, Kind::List(_))).map(|child| child.pointer);
    lists.chain(inside).find_map(|list| Target::of(document, &list))
}
