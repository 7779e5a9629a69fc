//! The tutor: a first animation in the real editor, lesson by lesson. Each lesson says what to do and with which keys, and
//! looks at the state to see that it was done.

use super::commands::{Call, Command, Done, command};
use super::events::Effect;
use super::state::State;

pub mod lessons;

use lessons::{LESSONS, Lesson};

pub const COMMANDS: &[Command] =
    &[command("tutor", "[next|back|quit]", "Learn the editor: a first animation, step by step", tutor).inside()];

/// The lesson that is on.
#[derive(Clone, Debug)]
pub struct Tutor {
    /// Which one, from 0.
    pub at: usize,
    /// Whether it is over once it is done: not while one that was done before is looked at again.
    armed: bool,
    /// Long work that ended well since then.
    ended: Vec<String>,
}

impl Tutor {
    /// The first lesson.
    pub fn begin() -> Tutor {
        Tutor { at: 0, armed: true, ended: Vec::new() }
    }

    /// The lesson that is on.
    pub fn lesson(&self) -> &'static Lesson {
        &LESSONS[self.at.min(LESSONS.len() - 1)]
    }
}

fn tutor(state: &mut State, call: &Call) -> Done {
    match (call.text, &state.tutor) {
        ("", None) => {
            if !state.door.is_saved() {
                return Err("there are unsaved edits: :w saves them before the tutor opens its own scene".into());
            }
            state.ask(Effect::Tutor);
        }
        ("quit", Some(_)) => {
            state.tutor = None;
            state.say("the tutor has gone; :tutor begins it anew");
        }
        ("next", Some(tutor)) => go(state, (tutor.at + 1).min(LESSONS.len() - 1), true),
        ("back", Some(tutor)) => go(state, tutor.at.saturating_sub(1), false),
        ("next" | "back" | "quit", None) => return Err("the tutor is not here: :tutor begins it".into()),
        ("", Some(_)) => return Err("the tutor is here: it takes next, back or quit".into()),
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

/// Long work has ended well; `work` is what the status line said of it.
pub fn ended(state: &mut State, work: &str) {
    if let Some(tutor) = &mut state.tutor {
        tutor.ended.push(work.to_owned());
    }
}

/// Goes on where the lesson is done.
pub fn follow(state: &mut State) {
    let Some(tutor) = &state.tutor else { return };
    let (at, armed, done) = (tutor.at, tutor.armed, (tutor.lesson().done)(state));
    if done && armed && at + 1 < LESSONS.len() {
        go(state, at + 1, true);
    } else if let (false, Some(tutor)) = (done, &mut state.tutor) {
        tutor.armed = true;
    }
}

/// Whether long work of this name ended well since the lesson began.
fn has_ended(state: &State, name: &str) -> bool {
    state.tutor.as_ref().is_some_and(|tutor| tutor.ended.iter().any(|work| work.starts_with(name)))
}
