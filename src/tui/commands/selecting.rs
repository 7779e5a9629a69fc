//! Selects rows, which an edit then applies to together.

use std::collections::BTreeSet;

use kurbo::{Point, Rect};

use super::command::{Call, Command, Done, command};
use super::items::{alike, rows};
use super::transforming::numbers;
use crate::base::pointer::Pointer;
use crate::base::text::counted;
use crate::tui::events::Effect;
use crate::tui::state::cursor::Selection;
use crate::tui::state::{Pane, State, entry, place};
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[
    command(
        "select",
        "[all|again|within X Y X Y|EXPRESSION]",
        "Begin or end a selection of rows; select all, the last again, those in a box of the picture, or for which something holds",
        select,
    )
    .counted_with(&[""]),
    command("toggle", "", "Take the row into the selection or out of it, and go to the next", toggle).counted(),
    command("invert", "", "Select the rows that are not selected", invert),
];

fn select(state: &mut State, call: &Call) -> Done {
    match call.text {
        "" if call.count.is_some() => {
            let rows = rows(state, call)?;
            state.cursor.selected_from = rows.first().copied();
            state.cursor.row = rows.last().copied().unwrap_or(state.cursor.row);
        }
        "" if state.cursor.unselect() => {}
        "" => state.cursor.selected_from = Some(state.cursor.row),
        "all" => all(state)?,
        "again" => again(state)?,
        text if text.starts_with("within ") => within(state, text)?,
        condition => matching(state, &unquoted(condition))?,
    }
    Ok(())
}

/// All rows of the table; in a form all items of the list under the cursor, else all fields.
fn all(state: &mut State) -> Done {
    let sheet = state.sheet();
    let row = sheet.row(state.cursor.row).ok_or("there are no rows here")?;
    let list = Pointer(&row.pointer).parent().filter(|_| row.item && !sheet.table);
    let within = |row: usize| match list {
        Some(list) => sheet.pointer(row).is_some_and(|one| Pointer(&one).parent() == Some(list)),
        None => row < sheet.len(),
    };
    let first = (0..=state.cursor.row).rev().take_while(|&row| within(row)).last();
    let last = (state.cursor.row..sheet.len()).take_while(|&row| within(row)).last();
    // The cursor stays, because it says which column is edited.
    state.cursor.pick(BTreeSet::new());
    (state.cursor.selected_from, state.cursor.selected_to) = (first, last);
    Ok(())
}

fn again(state: &mut State) -> Done {
    let Selection { node, rows, row } =
        state.cursor.last_selection.clone().ok_or("nothing has been selected yet: v begins a selection")?;
    state.show(node);
    state.cursor.row = row;
    let ends = rows.first().copied().zip(rows.last().copied());
    match ends.filter(|(first, last)| last + 1 - first == rows.len() && (row == *first || row == *last)) {
        // The cursor moves its end, as before.
        Some((first, last)) => {
            state.cursor.pick(BTreeSet::new());
            state.cursor.selected_from = Some(if row == first { last } else { first });
        }
        None => state.cursor.pick(rows),
    }
    state.settle();
    Ok(())
}

/// The rows that can be selected together: those like the one under the cursor.
fn choosable(state: &State) -> Result<BTreeSet<usize>, String> {
    let (first, last) = alike(state).ok_or("there are no rows here")?;
    Ok((first..=last).collect())
}

/// Selects the rows for which a condition over their columns holds.
fn matching(state: &mut State, condition: &str) -> Done {
    let rows = choosable(state)?;
    let values = entry::of_rows(state, &rows, condition)?;
    let holds = |value: &Option<f64>| value.is_some_and(|value| value != 0.0);
    let found: BTreeSet<usize> = rows.iter().zip(&values).filter(|(_, value)| holds(value)).map(|(&i, _)| i).collect();
    if found.is_empty() {
        return Err(format!("that holds for none of {}", counted(rows.len(), "row")));
    }
    state.say(format!("{} of {} selected", found.len(), counted(rows.len(), "row")));
    state.cursor.pick(found);
    // What follows is about the rows, not about the node of the tree.
    state.cursor.focus = Pane::Table;
    Ok(())
}

/// Selects the rows that stand within a box of the picture, given by two of its corners.
fn within(state: &mut State, text: &str) -> Done {
    let [x0, y0, x1, y1] = numbers(state, text.split_whitespace().skip(1))?[..] else {
        return Err("select within takes two corners: X Y X Y".into());
    };
    let corners = Rect::from_points((x0, y0), (x1, y1));
    let sheet = state.sheet();
    let stands = |row: &usize| sheet.pointer(*row).and_then(|pointer| place::seen(state, &pointer));
    let standing: Vec<(usize, Point)> = (0..sheet.len()).filter_map(|row| Some((row, stands(&row)?))).collect();
    let found: BTreeSet<usize> = standing.iter().filter(|(_, at)| corners.contains(*at)).map(|(row, _)| *row).collect();
    match standing.len() {
        0 => Err("no row here stands in the picture: go to a list of points first".into()),
        all if found.is_empty() => Err(format!("none of {} is there", counted(all, "row"))),
        all => {
            state.say(format!("{} of {} selected", found.len(), counted(all, "row")));
            state.cursor.row = found.first().copied().unwrap_or(state.cursor.row);
            state.cursor.pick(found);
            state.cursor.focus = Pane::Table;
            state.ask(Effect::Show);
            Ok(())
        }
    }
}

fn toggle(state: &mut State, call: &Call) -> Done {
    let all = choosable(state)?;
    let from = state.cursor.row;
    let mut rows = if state.cursor.selects() { state.cursor.rows() } else { BTreeSet::new() };
    let mut last = from;
    for &row in all.range(from..).take(call.steps().len()) {
        if !rows.remove(&row) {
            rows.insert(row);
        }
        last = row;
    }
    state.cursor.pick(rows);
    state.cursor.row = if all.contains(&(last + 1)) { last + 1 } else { last };
    state.ask(Effect::Show);
    state.settle();
    Ok(())
}

fn invert(state: &mut State, _: &Call) -> Done {
    let all = choosable(state)?;
    let selected = if state.cursor.selects() { state.cursor.rows() } else { BTreeSet::new() };
    let rest: BTreeSet<usize> = all.difference(&selected).copied().collect();
    state.say(format!("{} of {} selected", rest.len(), counted(all.len(), "row")));
    state.cursor.pick(rest);
    Ok(())
}
