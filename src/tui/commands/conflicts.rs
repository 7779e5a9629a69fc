//! Conflicts about a scene: unsaved edits that a session left behind, somebody else who is editing the scene, another program
//! that has changed its file.

use crate::tui::state::outside::{about_recovery, few, question};
use crate::tui::text::plain;
use std::path::PathBuf;

use super::command::{Call, Command, Done, command};
use crate::base::error::Error;
use crate::files::session::Taken;
use crate::scene::merge::Side;
use crate::tui::document::choice::{About, Choice, Then};
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pages, State};

/// In the status line while a conflict with another program is not decided.
const UNDECIDED: &str = "file differs";

pub const COMMANDS: &[Command] = &[
    command("merge", "[mine|theirs]", "Merge what another program wrote to the file", merge),
    command("recovery", "[keep|drop]", "Take or leave unsaved edits that were left behind, or ask again", recovery),
];

/// Does what was chosen. After looking at a difference, the question `asked` comes again.
pub fn answer(state: &mut State, about: About, word: &str, asked: Choice) -> Done {
    match about {
        About::Holder => match word {
            "quit" => state.ask(Effect::Quit),
            "edit" => state.ask(Effect::TakeOver),
            // Looking on is what is done already.
            _ => {}
        },
        About::Recovery => match word {
            "keep" => return recover(state, true),
            "drop" => return recover(state, false),
            "difference" => {
                let lines = state.scene.offered().map(|offer| offer.words.clone()).unwrap_or_default();
                look(state, lines, asked);
            }
            _ => {}
        },
        About::File => match word {
            "mine" => return take_in(state, Some(Side::Mine)),
            "theirs" => return take_in(state, Some(Side::Theirs)),
            "difference" => {
                let lines = state.scene.difference().map_err(|error| error.to_string())?;
                look(state, lines, asked);
            }
            _ => {}
        },
    }
    Ok(())
}

/// Takes the unsaved edits that are offered, or leaves them to undo.
fn recover(state: &mut State, take: bool) -> Done {
    // Also where it is answered by a command or an option, the question is over.
    let asks = matches!(&state.typing.mode, Mode::Choice(Choice { then: Then::Answer(asked), .. }) if asked.about == About::Recovery);
    if asks {
        state.typing.mode = Mode::Normal;
    }
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

/// Shows lines, and after that the question again.
fn look(state: &mut State, lines: Vec<String>, then: Choice) {
    let lines = if lines.is_empty() { vec!["there is no difference".into()] } else { lines };
    let lines = lines.iter().map(|line| plain(line)).collect();
    state.typing.mode = Mode::Pages(Pages { title: "what differs".into(), lines, scroll: 0 });
    state.outside.waiting = Some(then);
}

/// Handles that another program has written the scene or one of its pictures.
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
        state.say("no other program has changed the file");
    }
    Ok(())
}

/// Merges the file's version into the scene, or asks what to do about a conflict.
fn take_in(state: &mut State, prefer: Option<Side>) -> Done {
    let (taken, change) = match state.scene.take_in(prefer) {
        Ok(taken) => taken,
        Err(error) => {
            state.outside.file = Some("file unreadable");
            return Err(format!("the file is unreadable, so the scene here stays as it is: {}", first_line(&error)));
        }
    };
    change.into_iter().for_each(|change| state.changed(change));
    state.outside.file = None;
    match taken {
        Taken::Nothing => {}
        Taken::Gone => {
            state.outside.file = Some("file gone");
            state.complain("the file is gone: :w writes it again");
        }
        Taken::Whole if state.scene.read_only() => state.say("the file was saved: this is its present version"),
        Taken::Whole => state.say("another program changed the file: this is its version, u brings back yours"),
        Taken::Merged => state.say("another program changed the file: its changes are merged with the unsaved ones"),
        Taken::Asked(places) => ask_about_file(state, &places),
    }
    Ok(())
}

fn ask_about_file(state: &mut State, places: &[String]) {
    state.outside.file = Some(UNDECIDED);
    let options = [
        ("mine", "Keep your version of these places; merge the rest"),
        ("theirs", "Take the file's version of these places; keep the rest"),
        ("difference", "Look at everything that differs"),
        ("later", "Decide later: :merge asks again; :w is refused until then"),
    ];
    let title = "another program changed the same places".into();
    state.outside.waiting = Some(question(About::File, title, few(places), &options));
}

/// An error in one line.
fn first_line(error: &Error) -> String {
    match error {
        Error::Scene { file, problems } => match problems.as_slice() {
            [first, rest @ ..] if !rest.is_empty() => format!("{file}: {first} (and {} more)", rest.len()),
            _ => error.to_string(),
        },
        _ => error.to_string(),
    }
}
