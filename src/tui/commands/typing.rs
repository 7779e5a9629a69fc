//! Typing: the command line, texts, and the pages of the help.

use std::path::Path;

use super::finding::{search_left, search_typed};
use super::{Call, Command, Done, all, command, obey, quoted, unquoted};
use crate::tui::app::{Mode, Pages, State};
use crate::tui::keys::OWN_FILE;
use crate::tui::line::{self, Line};
use crate::tui::update::Effect;

pub const COMMANDS: &[Command] = &[
    command("line", "[/]", "Type a command, or with / a search", |state, call| {
        let kind = call.text.chars().next().unwrap_or(':');
        state.finding.origin = (kind == '/').then(|| state.origin());
        state.mode = Mode::Line(Line::new(kind));
        Ok(())
    })
    .inside(),
    command("type", "TEXT", "Type text where something is typed", type_text).inside(),
    command("run", "", "Run the line being typed", run_typed).inside(),
    command("complete", "", "Complete the line being typed", complete).inside(),
    command("recall", "older|newer", "Recall a line typed before", recall).inside(),
    command("text", "left|right|start|end|rub|delete|clear", "Change the text being typed", text).inside(),
    command("cancel", "", "Leave what is being done as it was", |state, _| {
        state.mode = Mode::Normal;
        search_left(state);
        Ok(())
    })
    .inside(),
    command("help", "[COMMAND]", "Show keys and commands", help).inside(),
    command("scroll", "LINES", "Scroll the pages", scroll).inside(),
];

/// Quotes, as JSON has them, keep spaces at the ends.
fn type_text(state: &mut State, call: &Call) -> Done {
    let typed = unquoted(call.text);
    match &mut state.mode {
        Mode::Entry(entry) => entry.text.insert(&typed),
        Mode::Line(line) => {
            line.typed();
            line.text.insert(&typed);
            seek(state);
        }
        _ => return Err("nothing is being typed: i edits a cell, : begins a command".into()),
    }
    Ok(())
}

/// While a search is being typed the cursor goes along.
fn seek(state: &mut State) {
    if let Mode::Line(line) = &state.mode
        && line.kind == '/'
    {
        let typed = line.text.value().trim().to_owned();
        search_typed(state, &typed);
    }
}

fn run_typed(state: &mut State, _: &Call) -> Done {
    let Mode::Line(line) = &state.mode else { return Ok(()) };
    let (kind, typed) = (line.kind, line.text.value().trim().to_string());
    state.mode = Mode::Normal;
    search_left(state);
    if typed.is_empty() {
        return Ok(());
    }
    if kind == '/' {
        return obey(state, &format!("search {}", quoted(&typed)), None);
    }
    state.lines.retain(|old| *old != typed);
    state.lines.push(typed.clone());
    obey(state, &typed, None)
}

fn complete(state: &mut State, _: &Call) -> Done {
    let Mode::Line(mut line) = state.mode.clone() else { return Ok(()) };
    let wanted = line::path_of(line.text.value()).filter(|_| line.kind == ':' && line.offered().is_none());
    if let Some((name, path, beside)) = wanted {
        let beside = beside.then(|| state.door.path().parent().map(Path::to_owned)).flatten();
        state.effects.push_back(Effect::Complete { name: name.into(), path: path.into(), beside });
        return Ok(());
    }
    if line.kind == ':' {
        line.complete(|typed| line::candidates(state, typed));
    }
    state.mode = Mode::Line(line);
    Ok(())
}

fn recall(state: &mut State, call: &Call) -> Done {
    if let Mode::Line(line) = &mut state.mode {
        line.recall(&state.lines, if call.text == "older" { 1 } else { -1 });
    }
    Ok(())
}

fn text(state: &mut State, call: &Call) -> Done {
    let changed = match &mut state.mode {
        Mode::Entry(entry) => entry.text.change(call.text),
        Mode::Line(line) => {
            // Rubbing out an empty line leaves it, as in vim.
            if call.text == "rub" && line.text.value().is_empty() {
                state.mode = Mode::Normal;
                search_left(state);
                return Ok(());
            }
            line.typed();
            line.text.change(call.text)
        }
        _ => true,
    };
    seek(state);
    if changed { Ok(()) } else { Err(format!("a text cannot {}", call.text)) }
}

/// The keys in force, then all others, then the commands; all from the tables.
fn help(state: &mut State, call: &Call) -> Done {
    if let Some(command) = super::find(call.text) {
        state.say(format!(":{} {}  {}", command.name, command.args, command.help));
        return Ok(());
    }
    let here = state.contexts();
    let mut contexts = here.clone();
    for row in state.keymap.rows() {
        if !contexts.contains(&row.context) {
            contexts.push(row.context);
        }
    }
    let mut lines = Vec::new();
    for context in contexts {
        lines.push(format!("-- {context} --"));
        let rows = state.keymap.rows().iter().filter(|row| row.context == context);
        lines.extend(rows.map(|row| format!("{:<10} {}", row.key, row.help)));
        lines.push(String::new());
    }
    lines.push(format!("Your own keys stand in {OWN_FILE}; :keys shows them"));
    lines.push(String::new());
    lines.push("-- entries --".into());
    lines.extend(entries_help());
    lines.push(String::new());
    lines.push("-- commands, after : --".into());
    lines.extend(all().map(|command| format!("{:<28} {}", format!("{} {}", command.name, command.args), command.help)));
    lines.extend(crate::ops::names().map(|name| format!("{name:<28} As `plica {name}` on this scene")));
    state.mode = Mode::Pages(Pages { title: format!("help: {}", here[0]), lines, scroll: 0 });
    Ok(())
}

fn entries_help() -> Vec<String> {
    let functions: Vec<&str> = crate::base::expression::functions().collect();
    vec![
        "5  -18  +5           The value".into(),
        "+=3  -=3  *=2  /=2   Changes the old value; so do *2 and /2".into(),
        "w/2  sqrt(2)*r       Computed; v is the old value, x y dx dy the row's columns,".into(),
        "                     r a length and degrees, w h the picture, i n the place in the selection".into(),
        format!("functions            {} (angles in degrees)", functions.join(" ")),
    ]
}

fn scroll(state: &mut State, call: &Call) -> Done {
    let by = call.text.parse::<i64>().unwrap_or(1) * call.times();
    if let Mode::Pages(Pages { lines, scroll, .. }) = &mut state.mode {
        *scroll = (*scroll as i64 + by).clamp(0, lines.len().saturating_sub(1) as i64) as usize;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::keys;

    #[test]
    fn the_help_holds_every_key_and_command() {
        let mut state = crate::tui::tests::support::state();
        obey(&mut state, "help", None).unwrap();
        let Mode::Pages(pages) = &state.mode else { panic!("no pages") };
        let text = pages.lines.join("\n");
        assert!(keys::KEYS.iter().all(|row| text.contains(row.help)));
        assert!(all().all(|command| text.contains(command.help)));
        assert!(text.starts_with(&format!("-- {} --", keys::TREE)));
    }
}
