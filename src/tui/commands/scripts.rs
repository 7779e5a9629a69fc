//! Lines that were run, as one thing: the log of the session.

use super::{Call, Command, Done, command};
use crate::tui::app::{Mode, Pages, State};

pub const COMMANDS: &[Command] = &[command("log", "", "Show the lines that this session has run", log).inside()];

fn log(state: &mut State, _: &Call) -> Done {
    let lines = state.recorder.log().to_vec();
    let scroll = lines.len().saturating_sub(1);
    state.mode = Mode::Pages(Pages { title: "log of this session".into(), lines, scroll });
    Ok(())
}
