//! Which columns of a table are shown, in which order, and how many stay while the others move.

use super::command::{Call, Command, Done, command};
use crate::base::problem::{nearest, quoted};
use crate::scene::field::Kind;
use crate::tui::document::rows::same;
use crate::tui::state::State;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[command(
    "columns",
    "[NAME ...|-NAME ...|all|freeze N]",
    "Show these columns of the table only, or leave some out, or show all; let N of them stay while others move",
    columns,
)];

fn columns(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let node = state.cursor.node.clone();
    let whole = state.sheet().whole();
    let row =
        whole.row(state.cursor.row).filter(|row| row.item).ok_or("only the rows of a list have columns: go to one")?;
    let all: Vec<String> = row.cells.iter().map(|cell| cell.head.clone()).collect();
    let head = |word: &str| {
        let found = all.iter().find(|head| same(word, head)).cloned();
        let near = || nearest(word, all.iter().map(String::as_str)).unwrap_or_default();
        found.ok_or_else(|| format!("there is no column {} here: {}", quoted(word), near()))
    };
    let plain: Vec<&str> = words.iter().map(String::as_str).collect();
    let here = state.row().and_then(|row| state.cursor.cell(&row).map(|cell| cell.head.clone()));
    match plain.as_slice() {
        [] => {
            let shown = state.row().map(|row| row.cells).unwrap_or_default();
            let is_shown = |head: &String| shown.iter().any(|cell| cell.head == *head);
            let mark = |head: &String| if is_shown(head) { head.clone() } else { format!("-{head}") };
            state.say(all.iter().map(mark).collect::<Vec<_>>().join("  "));
            return Ok(());
        }
        ["all"] => state.memory.columns.choose(&node, Vec::new()),
        ["freeze", count] => {
            let most = all.len().saturating_sub(1);
            let count = count.parse().ok().filter(|count| *count <= most);
            let count = count.ok_or_else(|| {
                let not = quoted(plain[1]);
                format!("freeze takes how many columns stay while the others move, 0 to {most}, not {not}")
            })?;
            state.memory.columns.freeze(&node, count);
            return Ok(());
        }
        some if some.iter().all(|word| word.starts_with('-')) => {
            let out = some.iter().map(|word| head(&word[1..])).collect::<Result<Vec<_>, _>>()?;
            let kind = row.cells.first().filter(|cell| matches!(cell.field.kind, Kind::Choice(_)));
            if let Some(kind) = kind.filter(|kind| out.contains(&kind.head)) {
                return Err(format!("{} says what a row is, so it always stays: leave out others", kind.head));
            }
            let shown = state.memory.columns.of(&node);
            let shown = if shown.is_empty() { all.clone() } else { shown.to_vec() };
            let rest: Vec<String> = shown.into_iter().filter(|head| !out.contains(head)).collect();
            if rest.is_empty() {
                return Err("one column has to stay".into());
            }
            state.memory.columns.choose(&node, rest);
        }
        some => {
            let chosen = some.iter().map(|word| head(word)).collect::<Result<Vec<_>, _>>()?;
            state.memory.columns.choose(&node, chosen);
        }
    }
    // The cursor stays on its column, where that is still shown.
    let cells = state.row().map(|row| row.cells).unwrap_or_default();
    let at = cells.iter().position(|cell| Some(&cell.head) == here.as_ref());
    state.cursor.column = at.unwrap_or(state.cursor.column.min(cells.len().saturating_sub(1)));
    state.settle();
    Ok(())
}
