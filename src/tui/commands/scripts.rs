//! The log of the session, and scripts.

use super::command::{Call, Command, Done, command};
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pages, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[
    command("log", "[FILE]", "Show the lines that this session has run, or write them to a file", log).inside(),
    command("source", "FILE", "Run the lines of a file", source).inside(),
];

fn log(state: &mut State, call: &Call) -> Done {
    let lines = state.memory.recorder.log().to_vec();
    if let Some(path) = call.path()? {
        let text = lines.iter().map(|line| format!("{line}\n")).collect();
        state.ask(Effect::Write(path, text));
        return Ok(());
    }
    let place = match state.memory.recorder.place() {
        Some(place) => format!("this log is {}", place.display()),
        None => "this log is only here: :log FILE writes it".into(),
    };
    let lines = vec![format!("-- {} --", plain(&place))].into_iter().chain(lines).collect();
    state.typing.mode = Mode::Pages(Pages { title: "log".into(), lines, scroll: 0 });
    Ok(())
}

fn source(state: &mut State, call: &Call) -> Done {
    let path = call.path()?.ok_or("source takes a FILE")?;
    state.ask(Effect::Source(path));
    Ok(())
}
