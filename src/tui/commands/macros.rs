//! Runs recorded lines again: macros, and `.` for the last change. A line that cannot be done ends them.

use super::command::{Call, Command, Done, command};
use crate::base::text::counted;
use crate::tui::state::{Mode, State};
use crate::tui::text::said::Said;

pub const COMMANDS: &[Command] = &[
    command("record", "[LETTER]", "Record a macro, or end the recording", record).inside(),
    command("play-macro", "LETTER|last", "Play a macro", play).played().counted(),
    command("again", "", "Repeat the last change here", again).played().counted(),
];

fn record(state: &mut State, call: &Call) -> Done {
    if call.text.is_empty() {
        let (letter, lines) = state.memory.recorder.end_macro().ok_or("no macro is being recorded: qa begins a")?;
        let lines = counted(lines, "line");
        state.say(format!("macro {letter} has {lines}: @{letter} plays it"));
        return Ok(());
    }
    if let Some(letter) = state.memory.recorder.recording() {
        return Err(format!("macro {letter} is being recorded: q ends it"));
    }
    state.memory.recorder.begin_macro(letter(call.text)?);
    Ok(())
}

fn letter(text: &str) -> Result<char, String> {
    let mut letters = text.chars();
    let one = letters.next().filter(char::is_ascii_lowercase).filter(|_| letters.next().is_none());
    one.ok_or_else(|| format!("macros have letters from a to z, not {text}"))
}

fn play(state: &mut State, call: &Call) -> Done {
    let letter = match call.text {
        "last" => state.memory.recorder.played().ok_or("no macro has been played yet: @a plays a")?,
        text => letter(text)?,
    };
    let lines = state.memory.recorder.play(letter)?;
    for _ in 0..call.times_of("play-macro")? {
        for (at, line) in lines.iter().enumerate() {
            repeat(state, call, line).map_err(|why| match line.starts_with("play-macro") {
                true => why, // it says itself which macro stopped, and where
                false => format!("macro {letter} stopped at line {} ({line}): {why}", at + 1),
            })?;
        }
    }
    Ok(())
}

/// Runs one of several lines. If it is refused, a list that it has opened is closed.
fn repeat(state: &mut State, call: &Call, line: &str) -> Done {
    state.memory.recorder.spend(state.scene.document())?;
    call.obey(state, line).inspect_err(|_| {
        if matches!(state.typing.mode, Mode::Choice(_)) {
            state.typing.mode = Mode::Normal;
        }
    })
}

/// Repeats the last change; a count replaces the change's own.
fn again(state: &mut State, call: &Call) -> Done {
    let mut lines = state.memory.recorder.change().to_vec();
    let last = lines.last_mut().ok_or("nothing has been changed yet: . repeats the last change")?;
    if call.count.is_some() {
        *last = Said { count: None, ..Said::parse(last, None) }.to_string();
    }
    for _ in 0..call.times_of("again")? {
        for line in &lines {
            repeat(state, call, line)?;
        }
    }
    Ok(())
}
