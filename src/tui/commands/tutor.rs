//! Goes from lesson to lesson of the tutor.

use super::command::{Call, Command, Done, command};
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::tutor::lesson;
use crate::tui::tutor::lessons::LESSONS;

pub const COMMANDS: &[Command] =
    &[command("tutor", "[next|back|quit]", "Learn the editor: a first animation, step by step", tutor).inside()];

fn tutor(state: &mut State, call: &Call) -> Done {
    match (call.text, &state.tutor) {
        ("", None) => {
            if !state.scene.is_saved() {
                return Err("there are unsaved edits: :w saves them before the tutor opens its own scene".into());
            }
            state.ask(Effect::Tutor);
        }
        ("quit", Some(_)) => {
            state.tutor = None;
            state.say("the tutor is closed; :tutor begins again");
        }
        ("next", Some(tutor)) => go(state, (tutor.at + 1).min(LESSONS.len() - 1), true),
        ("back", Some(tutor)) => go(state, tutor.at.saturating_sub(1), false),
        ("next" | "back" | "quit", None) => return Err("the tutor is not running: :tutor begins it".into()),
        ("", Some(_)) => return Err("the tutor is running: tutor takes next, back or quit".into()),
        _ => return Err("tutor takes next, back or quit".into()),
    }
    Ok(())
}

fn go(state: &mut State, at: usize, armed: bool) {
    if let Some(tutor) = &mut state.tutor {
        (tutor.at, tutor.armed) = (at, armed);
        tutor.ended.clear();
    }
}

/// Notes that long work has succeeded; `work` is its text in the status line.
pub fn ended(state: &mut State, work: &str) {
    if let Some(tutor) = &mut state.tutor {
        tutor.ended.push(work.to_owned());
    }
}

/// Goes on to the next lesson if this one is done.
pub fn follow(state: &mut State) {
    let Some(tutor) = &state.tutor else { return };
    let (at, armed, done) = (tutor.at, tutor.armed, (lesson(tutor).done)(state));
    if done && armed && at + 1 < LESSONS.len() {
        go(state, at + 1, true);
    } else if let (false, Some(tutor)) = (done, &mut state.tutor) {
        tutor.armed = true;
    }
}
