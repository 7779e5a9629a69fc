//! Typing into the command line, entries and the palette.

use crate::tui::commands::completing;
use std::path::Path;

use super::command::{Call, Command, Done, command};
use super::finding::{search_left, search_typed};
use crate::tui::events::Effect;
use crate::tui::state::{Mode, State};
use crate::tui::text::input::Text;
use crate::tui::text::line::Line;
use crate::tui::text::said::{quoted, unquoted};

pub const COMMANDS: &[Command] = &[
    command("line", "[/|:TEXT]", "Type a command, also with a given beginning; with /, a search", |state, call| {
        let mut begun = call.text.chars();
        let mut line = Line::new(begun.next().unwrap_or(':'));
        let over_pages = matches!(state.typing.mode, Mode::Pages(_) | Mode::Choice(_));
        state.memory.finding.origin = (line.kind == '/' && !over_pages).then(|| state.origin());
        if !begun.as_str().is_empty() {
            line.text = Text::new(format!("{} ", begun.as_str()), false);
        }
        match state.typing.mode {
            Mode::Aim => state.memory.under = vec![Mode::Aim],
            // Pages may themselves be over something.
            Mode::Pages(_) | Mode::Choice(_) => state.memory.under.push(state.typing.mode.clone()),
            Mode::Normal | Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) => state.memory.under.clear(),
        }
        state.typing.mode = Mode::Line(line);
        Ok(())
    })
    .inside(),
    command("type", "TEXT", "Type text where something is typed", type_text).inside(),
    command("run", "", "Run the line being typed", run_typed).inside(),
    command("complete", "", "Complete the line being typed", complete).inside(),
    command("recall", "older|newer", "Recall an earlier line", recall).inside(),
    command(
        "text",
        "left|right|start|end|word-left|word-right|rub|delete|rub-word|delete-word|clear",
        "Change the text being typed",
        text,
    )
    .inside(),
    command("cancel", "", "Cancel what is being typed or chosen", |state, call| {
        // Esc ends a count first.
        if call.count.is_some() {
            return Ok(());
        }
        close(state);
        search_left(state);
        Ok(())
    })
    .inside()
    .counted(),
];

/// Closes what is typed, chosen or shown; what it was opened over comes back.
fn close(state: &mut State) {
    if !matches!(state.typing.mode, Mode::Pages(_) | Mode::Line(_)) {
        state.memory.under.clear();
    }
    let under = state.memory.under.pop();
    state.typing.mode = under.unwrap_or(Mode::Normal);
}

/// Types text. JSON quotes keep spaces at its ends.
fn type_text(state: &mut State, call: &Call) -> Done {
    let typed = unquoted(call.text);
    match &mut state.typing.mode {
        Mode::Entry(entry) => entry.text.insert(&typed),
        Mode::Line(line) => {
            line.typed();
            line.text.insert(&typed);
            seek(state);
        }
        Mode::Palette(palette) => {
            palette.text.insert(&typed);
            palette.narrow();
        }
        Mode::Normal | Mode::Choice(_) | Mode::Pages(_) | Mode::Aim => {
            return Err("nothing is being typed: i edits a cell, : begins a command".into());
        }
    }
    Ok(())
}

/// Moves the cursor along while a search is being typed.
fn seek(state: &mut State) {
    if let Mode::Line(line) = &state.typing.mode
        && line.kind == '/'
    {
        let typed = line.text.value().trim().to_owned();
        search_typed(state, &typed);
    }
}

fn run_typed(state: &mut State, call: &Call) -> Done {
    let Mode::Line(line) = &state.typing.mode else { return Ok(()) };
    let (kind, typed) = (line.kind, line.text.value().trim().to_string());
    if typed.is_empty() {
        close(state);
        search_left(state);
        return Ok(());
    }
    let under = state.memory.under.pop();
    state.typing.mode = Mode::Normal;
    search_left(state);
    if let ('/', Some(Mode::Pages(pages))) = (kind, &under) {
        state.typing.mode = Mode::Pages(pages.clone());
        state.memory.sought_in_pages = typed.to_lowercase();
        return call.obey(state, "scroll next");
    }
    if let ('/', Some(Mode::Choice(choice))) = (kind, &under) {
        let narrowed = choice.narrowed(&typed);
        state.typing.mode = Mode::Choice(narrowed.clone().unwrap_or_else(|| choice.clone()));
        return narrowed.map(drop).ok_or_else(|| format!("nothing here has {typed} in it"));
    }
    if kind == '/' && !state.is_small() {
        return call.obey(state, &format!("search {}", quoted(&typed)));
    }
    if state.is_small() && !call.table.leaves(&typed) {
        return Err("the terminal is too small for that: :q leaves, :wq saves and leaves".into());
    }
    state.memory.lines.retain(|old| *old != typed);
    state.memory.lines.push(typed.clone());
    let before = (state.scene.revision(), state.focused());
    let done = call.obey(state, &typed);
    // Aiming goes on, unless it is no longer what it was.
    let under = under.filter(|_| before == (state.scene.revision(), state.focused()));
    match (under, &state.typing.mode) {
        (Some(under), Mode::Normal) => state.typing.mode = under,
        (Some(under), Mode::Pages(_)) => state.memory.under.push(under),
        _ => {}
    }
    done
}

fn complete(state: &mut State, call: &Call) -> Done {
    let Mode::Line(mut line) = state.typing.mode.clone() else { return Ok(()) };
    let wanted = completing::path_of(line.text.value()).filter(|_| line.kind == ':' && line.offered().is_none());
    // Names come before files.
    let wanted = wanted.filter(|_| completing::candidates(call.table, state, line.text.value()).is_empty());
    if let Some((name, path, beside)) = wanted {
        let beside = beside.then(|| state.scene.path().parent().map(Path::to_owned)).flatten();
        state.effects.push_back(Effect::Complete { name: name.into(), path: path.into(), beside });
        return Ok(());
    }
    if line.kind == ':' {
        line.complete(|typed| completing::candidates(call.table, state, typed));
    }
    state.typing.mode = Mode::Line(line);
    Ok(())
}

fn recall(state: &mut State, call: &Call) -> Done {
    if let Mode::Line(line) = &mut state.typing.mode {
        line.recall(&state.memory.lines, if call.text == "older" { 1 } else { -1 });
    }
    Ok(())
}

fn text(state: &mut State, call: &Call) -> Done {
    let changed = match &mut state.typing.mode {
        Mode::Entry(entry) => entry.text.change(call.text),
        Mode::Line(line) => {
            // Backspace in an empty line leaves it, as in vim.
            if call.text == "rub" && line.text.value().is_empty() {
                close(state);
                search_left(state);
                return Ok(());
            }
            line.typed();
            line.text.change(call.text)
        }
        Mode::Palette(palette) => {
            let changed = palette.text.change(call.text);
            palette.narrow();
            changed
        }
        Mode::Normal | Mode::Choice(_) | Mode::Pages(_) | Mode::Aim => true,
    };
    seek(state);
    if changed { Ok(()) } else { Err(format!("a text cannot {}", call.text)) }
}
