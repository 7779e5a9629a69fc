//! What happens to a scene outside the editor, and what is asked about it: unsaved edits of a session that did not end
//! well, somebody else who edits the scene, another program that writes its file.

use crate::tui::document::choice::About;
use crate::tui::state::outside::{about_recovery, few, question};
use crate::tui::text::plain;
use std::path::PathBuf;

use super::command::{Call, Command, Done, command};
use crate::base::error::Error;
use crate::files::session::Taken;
use crate::scene::merge::Side;
use crate::tui::document::choice::Choice;
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pages, State};

/// Where both changed the file and nothing was decided.
const UNDECIDED: &str = "file differs";

pub const COMMANDS: &[Command] = &[
    command("merge", "[mine|theirs]", "Take in what another program wrote to the file", merge),
    command("recovery", "[keep|drop]", "Answer about unsaved edits that were left behind, or ask again", recovery),
];

/// Does what was chosen; `asked` comes again where something is to be looked at first.
pub fn answer(state: &mut State, about: About, word: &str, asked: Choice) -> Done {
    match (about, word) {
        (About::Holder, "quit") => state.ask(Effect::Quit),
        (About::Holder, "edit") => state.ask(Effect::TakeOver),
        (About::Recovery, "recover") => return recover(state, true),
        (About::Recovery, "leave") => return recover(state, false),
        (About::Recovery, _) if word == "difference" => {
            let lines = state.scene.offered().map(|offer| offer.words.clone()).unwrap_or_default();
            look(state, lines, asked);
        }
        (About::File, "mine") => return take_in(state, Some(Side::Mine)),
        (About::File, "theirs") => return take_in(state, Some(Side::Theirs)),
        (About::File, "difference") => {
            let lines = state.scene.difference().map_err(|error| error.to_string())?;
            look(state, lines, asked);
        }
        _ => {}
    }
    Ok(())
}

/// Takes the unsaved edits that are offered, or leaves them.
fn recover(state: &mut State, take: bool) -> Done {
    let change = state.scene.recover(take);
    change.into_iter().for_each(|change| state.changed(change));
    if take { take_in(state, None) } else { Ok(()) }
}

fn recovery(state: &mut State, call: &Call) -> Done {
    let asked = about_recovery(&state.scene).ok_or("no unsaved edits were left behind")?;
    match call.text {
        "" => state.outside.waiting = Some(asked),
        "keep" => return recover(state, true),
        "drop" => return recover(state, false),
        _ => return Err("recovery takes keep, drop or nothing".into()),
    }
    Ok(())
}

/// Shows lines, and then the question again.
fn look(state: &mut State, lines: Vec<String>, then: Choice) {
    let lines = if lines.is_empty() { vec!["there is no difference".into()] } else { lines };
    let lines = lines.iter().map(|line| plain(line)).collect();
    state.typing.mode = Mode::Pages(Pages { title: "what differs".into(), lines, scroll: 0 });
    state.outside.waiting = Some(then);
}

/// Another program wrote the scene or one of its pictures.
pub fn follow(state: &mut State, files: &[PathBuf]) {
    if files.iter().any(|file| file != state.scene.path()) {
        state.ask(Effect::Reload);
    }
    if files.iter().any(|file| file == state.scene.path())
        && let Err(why) = take_in(state, None)
    {
        state.complain(why);
    }
}

fn merge(state: &mut State, call: &Call) -> Done {
    let side = match call.text {
        "" => None,
        "mine" => Some(Side::Mine),
        "theirs" => Some(Side::Theirs),
        _ => return Err("merge takes mine, theirs or nothing".into()),
    };
    take_in(state, side)?;
    if state.message.is_none() && state.outside.waiting.is_none() {
        state.say("the file is as it was left");
    }
    Ok(())
}

/// Takes the file's version in, says so, or asks.
fn take_in(state: &mut State, prefer: Option<Side>) -> Done {
    let (taken, change) = match state.scene.take_in(prefer) {
        Ok(taken) => taken,
        Err(error) => {
            state.outside.file = Some("file unreadable");
            return Err(format!("what is here stays: {}", first_line(&error)));
        }
    };
    change.into_iter().for_each(|change| state.changed(change));
    state.outside.file = None;
    match taken {
        Taken::Nothing => {}
        Taken::Gone => {
            state.outside.file = Some("file gone");
            state.complain("the file was taken away: :w writes it again");
        }
        Taken::Whole if state.scene.read_only() => state.say("the file was saved: this is what it holds now"),
        Taken::Whole => state.say("the file was changed by another program: its version is here, u takes it back"),
        Taken::Merged => {
            state.say("the file was changed by another program: its changes are here beside the unsaved ones")
        }
        Taken::Asked(places) => ask_about_file(state, &places),
    }
    Ok(())
}

fn ask_about_file(state: &mut State, places: &[String]) {
    state.outside.file = Some(UNDECIDED);
    let options = [
        ("mine", "There, keep what is here; take in the rest"),
        ("theirs", "There, take what the file has; keep the rest"),
        ("difference", "Look at everything that differs"),
        ("later", "Leave it open: :merge asks again, :w waits"),
    ];
    let title = "another program changed the same places".into();
    state.outside.waiting = Some(question(About::File, title, few(places), &options));
}

/// An error on one line.
fn first_line(error: &Error) -> String {
    match error {
        Error::Scene { file, problems } => match problems.as_slice() {
            [first, rest @ ..] if !rest.is_empty() => format!("{file}: {first} (and {} more)", rest.len()),
            _ => error.to_string(),
        },
        _ => error.to_string(),
    }
}
