//! Moves the cursor in the tree, in forms and tables, and between panes.

use super::command::{Call, Command, Done, command};
use super::finding::leave as leave_place;
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::tui::document::tree;
use crate::tui::events::Effect;
use crate::tui::state::{Pane, State};

pub const COMMANDS: &[Command] = &[
    command(
        "move",
        "down|up|left|right|first|last|start|end|page-down|page-up|next|DX DY",
        "Move the cursor; by DX DY, as translate",
        go,
    )
    .counted_with(&["down", "up", "left", "right", "first", "last", "page-down", "page-up", "next"]),
    command("pane", "next|previous|tree|table|picture", "Go to another pane", pane).counted_with(&["next", "previous"]),
    command("enlarge", "", "Give the pane that has the focus the whole screen, or show all panes again", |state, _| {
        state.cursor.enlarged = !state.cursor.enlarged;
        Ok(())
    }),
    command(
        "collapse",
        "[PATH]",
        "Collapse the node of the tree, else go to its parent; or the node at a path",
        collapse,
    )
    .counted_with(&[""]),
    command("expand", "", "Expand the node of the tree, else edit it", expand).counted(),
    command("up", "", "Go to the parent node", up).counted(),
    command("back", "", "End the selection, else running work", back).counted(),
    command("leave", "", "Do as back does, and say how to leave", leave).counted(),
];

/// Roughly half the rows of a pane.
fn page(state: &State) -> i64 {
    i64::from(state.size.1.saturating_sub(8) / 2).max(1)
}

fn go(state: &mut State, call: &Call) -> Done {
    if call.text.starts_with(|c: char| !c.is_ascii_lowercase()) {
        return call.obey(state, &format!("translate {}", call.text));
    }
    let rows = (state.cursor.focus == Pane::Tree).then(|| tree::rows(state.document(), &state.cursor.collapsed));
    let count = rows.as_ref().map_or_else(|| state.sheet().len(), Vec::len);
    let at = rows.as_ref().map_or(state.cursor.row, |rows| tree::row_of(rows, &state.cursor.node));
    let by = |steps: i64| (at as i64 + steps).clamp(0, (count as i64 - 1).max(0)) as usize;
    let to = match call.text {
        "down" => by(call.times()),
        "up" => by(-call.times()),
        "page-down" => by(page(state) * call.times()),
        "page-up" => by(-page(state) * call.times()),
        "first" => call.count.unwrap_or(0).min(count.saturating_sub(1)),
        "last" => call.count.unwrap_or(usize::MAX).min(count.saturating_sub(1)),
        "next" => {
            call.steps().for_each(|_| move_on(state));
            return Ok(());
        }
        sideways => return move_sideways(state, sideways, call.times()),
    };
    if matches!(call.text, "first" | "last") && to != at {
        leave_place(state);
    }
    match rows {
        Some(mut rows) if to < rows.len() => state.show(rows.swap_remove(to).pointer),
        Some(_) => {}
        None => {
            state.cursor.row = to;
            state.ask(Effect::Show);
            state.settle();
        }
    }
    Ok(())
}

fn move_sideways(state: &mut State, way: &str, times: i64) -> Done {
    let cells = state.row().map_or(0, |row| row.cells.len());
    let by = |steps: i64| (state.cursor.column as i64 + steps).clamp(0, cells.saturating_sub(1) as i64) as usize;
    state.cursor.column = match way {
        "left" if state.cursor.column == 0 => {
            state.cursor.focus = Pane::Tree;
            state.settle();
            return Ok(());
        }
        "left" => by(-times),
        "right" => by(times),
        "start" => 0,
        "end" => by(i64::from(u16::MAX)),
        _ => return Err(format!("move takes a way, as down or page-up, or DX DY, not {}", quoted(way))),
    };
    Ok(())
}

/// Goes to the next cell, after the last of a row to the first of the row below.
fn move_on(state: &mut State) {
    let cells = state.row().map_or(0, |row| row.cells.len());
    (state.cursor.row, state.cursor.column) = match state.cursor.column + 1 < cells {
        true => (state.cursor.row, state.cursor.column + 1),
        false => (state.cursor.row + 1, 0),
    };
    state.settle();
}

fn pane(state: &mut State, call: &Call) -> Done {
    const PANES: [Pane; 3] = [Pane::Tree, Pane::Table, Pane::Picture];
    let at = PANES.iter().position(|&pane| pane == state.cursor.focus).unwrap_or(0);
    state.cursor.focus = match call.text {
        "tree" => Pane::Tree,
        "table" => Pane::Table,
        "picture" => Pane::Picture,
        way => {
            let by = if way == "previous" { -call.times() } else { call.times() };
            PANES[(at as i64 + by).rem_euclid(3) as usize]
        }
    };
    state.settle();
    Ok(())
}

fn collapse(state: &mut State, call: &Call) -> Done {
    if !call.text.is_empty() {
        let pointer = state.resolve(call.text)?;
        state.cursor.collapsed.insert(pointer);
        return Ok(());
    }
    call.steps().for_each(|_| collapse_once(state));
    Ok(())
}

fn collapse_once(state: &mut State) {
    let rows = tree::rows(state.document(), &state.cursor.collapsed);
    let at = tree::row_of(&rows, &state.cursor.node);
    if rows[at].collapsed == Some(false) {
        state.cursor.collapsed.insert(rows[at].pointer.clone());
        return;
    }
    let parent = rows[..at].iter().rposition(|row| row.depth < rows[at].depth).unwrap_or(0);
    state.show(rows[parent].pointer.clone());
}

fn expand(state: &mut State, call: &Call) -> Done {
    call.steps().try_for_each(|_| expand_once(state))
}

fn expand_once(state: &mut State) -> Done {
    let rows = tree::rows(state.document(), &state.cursor.collapsed);
    let at = tree::row_of(&rows, &state.cursor.node);
    if rows[at].collapsed == Some(true) {
        state.cursor.collapsed.remove(&rows[at].pointer);
        return Ok(());
    }
    state.cursor.focus = Pane::Table;
    state.settle();
    Ok(())
}

fn up(state: &mut State, call: &Call) -> Done {
    for _ in call.steps() {
        let Some(parent) = Pointer(&state.cursor.node).parent() else { break };
        let (parent, child) = (parent.to_string(), state.cursor.node.clone());
        state.show(parent);
        state.cursor.row = state.sheet().position(&child).unwrap_or(0);
    }
    Ok(())
}

/// Ends one thing: a count, a program that the selection goes through, the selection, or other running work.
fn back(state: &mut State, call: &Call) -> Done {
    if call.count.is_some() {
        return Ok(());
    }
    if state.outside.asking.take().is_some() {
        state.outside.work = None;
        return Ok(());
    }
    let piping = state.outside.piping.is_some();
    if piping || !state.cursor.unselect() && state.outside.work.is_some() {
        state.ask(Effect::Cancel);
    }
    Ok(())
}

fn leave(state: &mut State, call: &Call) -> Done {
    back(state, call)?;
    state.say(":q leaves, :wq saves and leaves, :q! leaves without saving");
    Ok(())
}
