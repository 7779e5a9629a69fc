//! Shows the person's own keys and the mistakes in their file, and reads the file again.

use super::command::{Call, Command, Done, command};
use crate::tui::events::Effect;
use crate::tui::keys::OWN_FILE;
use crate::tui::state::{Mode, Pages, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] =
    &[command("keys", "[reload]", "Show your own keys and the mistakes in them, or read them again", keys).inside()];

fn keys(state: &mut State, call: &Call) -> Done {
    match call.text {
        "" => {}
        "reload" => {
            state.ask(Effect::Keymap);
            return Ok(());
        }
        other => return Err(format!("keys takes reload or nothing, not {other}")),
    }
    let mut lines = vec![format!("They are in {OWN_FILE}; docs/keymap.md explains how."), String::new()];
    if !state.keymap.mistakes().is_empty() {
        lines.push("-- mistakes --".into());
        lines.extend(state.keymap.mistakes().iter().map(|mistake| plain(mistake)));
        lines.push(String::new());
    }
    lines.push("-- your keys --".into());
    let own = state.keymap.rows().iter().filter(|row| row.own);
    lines.extend(own.map(|row| format!("{:<12} {:<20} {}", plain(&row.key), row.context, plain(&row.command))));
    state.typing.mode = Mode::Pages(Pages { title: "keys".into(), lines, scroll: 0 });
    Ok(())
}
