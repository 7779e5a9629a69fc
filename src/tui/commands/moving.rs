//! Moving about: in the tree, in forms and tables, between panes, and by search.

use super::{Call, Command, Done, command, unquoted};
use crate::scene::{address, field};
use crate::tui::app::{Mode, Pane, State};
use crate::tui::sheet::is_node;
use crate::tui::tree;
use crate::tui::update::Effect;

pub const COMMANDS: &[Command] = &[
    command("move", "down|up|left|right|first|last|start|end|page-down|page-up|next", "Move the cursor", go),
    command("pane", "next|previous|tree|table|picture", "Go to another pane", pane),
    command("fold", "", "Fold the node of the tree, else go to its parent", fold),
    command("open", "", "Unfold the node of the tree, else edit it", open),
    command("up", "", "Go to the node that holds this one", up),
    command("back", "", "End the selection, else running work, else go to the tree", back),
    command("leave", "", "As back, and say how to leave", leave),
    command("search", "next|previous|NAME", "Go to the node of that name", search),
    command("go", "PATH", "Go to the node or the field at a path; without one, to the scene", go_to_path),
];

/// Rows that a page holds, about.
fn page(state: &State) -> i64 {
    i64::from(state.size.1.saturating_sub(8) / 2).max(1)
}

fn go(state: &mut State, call: &Call) -> Done {
    let tree = state.focus == Pane::Tree;
    let rows = if tree { tree::rows(state.document(), &state.folded).len() } else { state.sheet().len() };
    let at = if tree { tree::row_of(&tree::rows(state.document(), &state.folded), &state.node) } else { state.row };
    let by = |steps: i64| (at as i64 + steps).clamp(0, rows as i64 - 1).max(0) as usize;
    let to = match call.text {
        "down" => by(call.times()),
        "up" => by(-call.times()),
        "page-down" => by(page(state) * call.times()),
        "page-up" => by(-page(state) * call.times()),
        "first" => call.count.unwrap_or(0).min(rows.saturating_sub(1)),
        "last" => call.count.unwrap_or(usize::MAX).min(rows.saturating_sub(1)),
        "next" => return move_on(state),
        sideways => return move_sideways(state, sideways, call.times()),
    };
    if tree {
        let rows = tree::rows(state.document(), &state.folded);
        let node = rows.get(to).map(|row| row.pointer.clone()).unwrap_or_default();
        state.show(node);
    } else {
        state.row = to;
        state.ask(Effect::Show);
        state.settle();
    }
    Ok(())
}

fn move_sideways(state: &mut State, way: &str, times: i64) -> Done {
    let cells = state.sheet().row(state.row).map_or(0, |row| row.cells.len());
    let by = |steps: i64| (state.column as i64 + steps).clamp(0, cells.saturating_sub(1) as i64) as usize;
    state.column = match way {
        "left" if state.column == 0 => return pane(state, &Call { text: "tree", count: None }),
        "left" => by(-times),
        "right" => by(times),
        "start" => 0,
        "end" => by(i64::from(u16::MAX)),
        _ => return Err(format!("cannot move {way}")),
    };
    Ok(())
}

/// Goes to the next cell, after the last of a row to the first of the row below.
fn move_on(state: &mut State) -> Done {
    let cells = state.sheet().row(state.row).map_or(0, |row| row.cells.len());
    (state.row, state.column) = match state.column + 1 < cells {
        true => (state.row, state.column + 1),
        false => (state.row + 1, 0),
    };
    state.settle();
    Ok(())
}

fn pane(state: &mut State, call: &Call) -> Done {
    const PANES: [Pane; 3] = [Pane::Tree, Pane::Table, Pane::Picture];
    let at = PANES.iter().position(|&pane| pane == state.focus).unwrap_or(0);
    state.focus = match call.text {
        "tree" => Pane::Tree,
        "table" => Pane::Table,
        "picture" => Pane::Picture,
        "previous" => PANES[(at + 2) % 3],
        _ => PANES[(at + 1) % 3],
    };
    state.settle();
    Ok(())
}

fn fold(state: &mut State, _: &Call) -> Done {
    let rows = tree::rows(state.document(), &state.folded);
    let at = tree::row_of(&rows, &state.node);
    if rows[at].folded == Some(false) {
        state.folded.insert(rows[at].pointer.clone());
        return Ok(());
    }
    let parent = rows[..at].iter().rposition(|row| row.depth < rows[at].depth).unwrap_or(0);
    state.show(rows[parent].pointer.clone());
    Ok(())
}

fn open(state: &mut State, call: &Call) -> Done {
    let rows = tree::rows(state.document(), &state.folded);
    let at = tree::row_of(&rows, &state.node);
    if rows[at].folded == Some(true) {
        state.folded.remove(&rows[at].pointer);
        return Ok(());
    }
    pane(state, &Call { text: "table", count: call.count })
}

fn up(state: &mut State, _: &Call) -> Done {
    let Some((parent, _)) = state.node.rsplit_once('/') else { return Ok(()) };
    let (parent, child) = (parent.to_string(), state.node.clone());
    state.show(parent);
    state.row = state.sheet().position(&child).unwrap_or(0);
    Ok(())
}

fn back(state: &mut State, _: &Call) -> Done {
    if state.unselect() {
    } else if state.seen.work.is_some() {
        state.ask(Effect::Cancel);
    } else {
        state.focus = Pane::Tree;
    }
    Ok(())
}

fn leave(state: &mut State, call: &Call) -> Done {
    back(state, call)?;
    state.say(":q leaves, :wq saves and leaves, :q! leaves without saving");
    Ok(())
}

fn go_to_path(state: &mut State, call: &Call) -> Done {
    let pointer = match call.text {
        "" => String::new(),
        path => address::resolve(state.document(), path).map_err(|error| error.to_string())?,
    };
    reveal(state, &pointer);
    Ok(())
}

/// Goes to the next node or field whose name holds the text, in the order of the document, around its end.
fn search(state: &mut State, call: &Call) -> Done {
    match call.text {
        "next" | "previous" => {}
        text => state.sought = unquoted(text).to_lowercase(),
    }
    if state.sought.is_empty() {
        return Err("nothing was searched for yet: / searches".into());
    }
    let mut all = Vec::new();
    places(state, "", &mut all);
    let found: Vec<usize> = (0..all.len()).filter(|&i| all[i].1.to_lowercase().contains(&state.sought)).collect();
    let here = state.focused();
    let at = all.iter().position(|(pointer, _)| *pointer == here).unwrap_or(0);
    let next = match call.text {
        "previous" => found.iter().rev().find(|&&i| i < at).or(found.last()),
        _ => found.iter().find(|&&i| i > at).or(found.first()),
    };
    let Some(&next) = next else { return Err(format!("nothing here is called {}", state.sought)) };
    reveal(state, &all[next].0.clone());
    Ok(())
}

/// Every place that has a name, in the order of the document.
fn places(state: &State, pointer: &str, all: &mut Vec<(String, String)>) {
    for child in field::children(state.document(), pointer) {
        let inside = is_node(&child.field.kind);
        let pointer = child.pointer.clone();
        all.push((child.pointer, child.name));
        if inside {
            places(state, &pointer, all);
        }
    }
}

/// Shows the node or the field at `pointer`.
pub fn reveal(state: &mut State, pointer: &str) {
    let kind = field::field(state.document(), pointer).map(|field| field.kind);
    let is_node = field::is_there(state.document(), pointer) && kind.is_some_and(|kind| is_node(&kind));
    let node = if is_node { pointer } else { pointer.rsplit_once('/').map_or("", |(parent, _)| parent) };
    state.mode = Mode::Normal;
    state.show(node);
    let row = state.sheet().position(pointer);
    state.row = row.unwrap_or(state.row);
    state.focus = if is_node { Pane::Tree } else { Pane::Table };
    state.settle();
}
