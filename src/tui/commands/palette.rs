//! The palette and the leader menu.

use super::command::{Call, Command, Done, command};
use crate::tui::commands::command::Table;
use crate::tui::document::palette::{Action, Palette};
use crate::tui::keys;
use crate::tui::state::recorder::Recorded;
use crate::tui::state::{Mode, State};

pub const COMMANDS: &[Command] = &[
    command("palette", "[next|previous|take]", "Find commands, nodes and fields by a few of their letters", palette)
        .inside()
        .counted_with(&["next", "previous"]),
    command("leader", "[menu]", "Show the keys of the leader menu", |state, _| {
        state.typing.pressed = "Space".into();
        Ok(())
    })
    .inside(),
];

fn palette(state: &mut State, call: &Call) -> Done {
    let Mode::Palette(palette) = &mut state.typing.mode else {
        state.typing.mode = Mode::Palette(opened(call.table, state));
        return Ok(());
    };
    match call.text {
        "next" => palette.step(call.times()),
        "previous" => palette.step(-call.times()),
        "take" => {
            let row = palette.row(palette.at);
            state.typing.mode = Mode::Normal;
            if let Some(row) = row {
                return call.obey(state, &row.line);
            }
        }
        _ => {}
    }
    Ok(())
}

/// The palette with all commands, then all places.
fn opened(table: &Table, state: &mut State) -> Palette {
    let document = state.document().clone();
    let places = state.memory.finding.listed(&document);
    Palette::new(actions(table, state), places)
}

/// The lines of keys that work in the panes, then commands that take arguments or have no key.
fn actions(table: &Table, state: &State) -> Vec<Action> {
    let shown = [keys::EVERYWHERE, keys::TREE, keys::TABLE, keys::PICTURE, keys::MOVING];
    let mut all: Vec<Action> = Vec::new();
    for row in state.keymap.rows().iter().filter(|row| shown.contains(&row.context) && !row.command.contains('{')) {
        let line = row.command.to_string();
        match all.iter_mut().find(|one| one.line == line) {
            Some(one) if one.key.len() < 16 => one.key = format!("{}, {}", one.key, row.key),
            Some(_) => {}
            None => all.push(Action { name: line.clone(), key: row.key.to_string(), help: row.help.to_string(), line }),
        }
    }
    let only_typing = |name: &str| {
        let mut rows = state.keymap.rows().iter().filter(|row| row.command.split(' ').next() == Some(name)).peekable();
        rows.peek().is_some() && rows.all(|row| !shown.contains(&row.context))
    };
    let offered = |command: &&Command| command.recorded != Recorded::Inside && !only_typing(command.name);
    for command in table.all().filter(offered) {
        let Command { name, args, help, .. } = command;
        if args.is_empty() && all.iter().any(|one| one.line == *name) {
            continue;
        }
        let typed = !args.is_empty() && !args.starts_with('[');
        let line = if typed { format!("line :{name}") } else { name.to_string() };
        all.push(Action {
            name: format!("{name} {args}").trim().into(),
            key: String::new(),
            help: help.to_string(),
            line,
        });
    }
    let others = crate::ops::names().filter(|name| table.find(name).is_none());
    all.extend(others.map(|name| {
        let help = format!("As `plica {name}` on this scene");
        Action { line: format!("line :{name}"), name, key: String::new(), help }
    }));
    all
}
