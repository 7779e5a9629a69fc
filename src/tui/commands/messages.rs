//! Earlier messages, and the problems of the scene.

use super::command::{Call, Command, Done, command};
use crate::base::pointer::Pointer;
use crate::base::problem::{Problem, Severity};
use crate::scene::address;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::state::memory::here;
use crate::tui::state::{Mode, Pages, State};
use crate::tui::text::plain;
use crate::tui::text::wrap::wrapped_lines;

pub const COMMANDS: &[Command] = &[
    command("messages", "", "Show earlier messages in full", messages).inside(),
    command("problems", "", "List what is wrong in the scene; Enter goes there", problems).inside(),
    command("problem", "[next|previous]", "Go to the next place where something is wrong", problem).counted(),
];

/// Width of the text, in columns.
const WIDTH: u16 = 70;

fn messages(state: &mut State, _: &Call) -> Done {
    let lines: Vec<String> = state.memory.said.iter().flat_map(|message| wrapped_lines(&message.text, WIDTH)).collect();
    if lines.is_empty() {
        return Err("there are no messages yet".into());
    }
    // Scroll to the newest.
    let scroll = lines.len().saturating_sub(usize::from(state.size.1 / 2));
    state.typing.mode = Mode::Pages(Pages { title: "messages".into(), lines, scroll });
    Ok(())
}

/// The problems, each as a place and a message; the place of the whole scene is empty.
fn found(state: &State) -> Vec<(String, String)> {
    let unseen = state.outside.problem.iter();
    let warnings = state.document().warnings().iter();
    let told = |problem: &Problem| {
        let kind = if problem.severity == Severity::Warning { "" } else { "error: " };
        let hint = problem.hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
        here(&plain(&format!("{kind}{}{hint}", problem.message)))
    };
    unseen.chain(warnings).map(|problem| (problem.path.clone(), told(problem))).collect()
}

fn problems(state: &mut State, _: &Call) -> Done {
    let found = found(state);
    if found.is_empty() {
        state.say("no problems");
        return Ok(());
    }
    let place = |path: &str| match address::told(state.document(), path) {
        whole if whole.is_empty() => "scene".to_owned(),
        place => place,
    };
    let options = found.into_iter().map(|(path, message)| (place(&path), message)).collect();
    state.typing.mode = Mode::Choice(Choice { title: "problems".into(), options, at: 0, then: Then::Go });
    Ok(())
}

/// Goes to the next problem, as often as the count says; after the last comes the first.
fn problem(state: &mut State, call: &Call) -> Done {
    let found: Vec<_> = found(state).into_iter().filter(|(path, _)| !path.is_empty()).collect();
    let n = found.len() as i64;
    if n == 0 {
        return Err("no problems".into());
    }
    let here = [state.focused(), state.cursor.node.clone()];
    let at = here.iter().find_map(|here| found.iter().rposition(|(path, _)| path == here));
    let by = match call.text {
        "" | "next" => call.times(),
        _ => -call.times(),
    };
    let from = at.map_or(if by > 0 { -1 } else { 0 }, |at| at as i64);
    let to = (from + by).rem_euclid(n) as usize;
    let (path, message) = &found[to];
    go(state, call, path)?;
    state.say(format!("problem {} of {n}: {message}", to + 1));
    Ok(())
}

/// Goes to a place, or to its nearest ancestor that exists.
fn go(state: &mut State, call: &Call, path: &str) -> Done {
    let mut path = path.to_owned();
    while !path.is_empty() && !crate::scene::field::is_there(state.document(), &path) {
        path = Pointer(&path).split().map_or(String::new(), |(holder, _)| holder.to_owned());
    }
    call.obey(state, &format!("go {path}"))
}

/// Goes to a place of the list.
pub fn go_to(state: &mut State, call: &Call, place: &str) -> Done {
    let path = if place == "scene" { String::new() } else { place.to_owned() };
    let path = address::resolve(state.document(), &path).unwrap_or_default();
    go(state, call, &path)
}
