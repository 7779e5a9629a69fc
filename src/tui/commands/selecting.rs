//! Selects rows, which an edit then applies to together.

use super::command::{Call, Command, Done, command};
use super::items::rows;
use crate::base::pointer::Pointer;
use crate::tui::state::State;
use crate::tui::state::cursor::Selection;

pub const COMMANDS: &[Command] = &[command(
    "select",
    "[all|again]",
    "Begin or end a selection of rows; select all, or the last selection again",
    select,
)
.counted_with(&[""])];

fn select(state: &mut State, call: &Call) -> Done {
    match call.text {
        "" if call.count.is_some() => {
            let rows = rows(state, call)?;
            (state.cursor.selected_from, state.cursor.selected_to, state.cursor.row) =
                (Some(*rows.start()), None, *rows.end());
        }
        "" if state.cursor.unselect() => {}
        "" => (state.cursor.selected_from, state.cursor.selected_to) = (Some(state.cursor.row), None),
        "all" => all(state)?,
        _ => again(state)?,
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
    (state.cursor.selected_from, state.cursor.selected_to) = (first, last);
    Ok(())
}

fn again(state: &mut State) -> Done {
    let Selection { node, from, to } =
        state.cursor.last_selection.clone().ok_or("nothing has been selected yet: v begins a selection")?;
    state.show(node);
    (state.cursor.selected_from, state.cursor.selected_to, state.cursor.row) = (Some(from), None, to);
    state.settle();
    Ok(())
}
