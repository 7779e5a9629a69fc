//! States of the scene that are kept under a letter, and flipped to and back.

use super::command::{Call, Command, Done, command};
use crate::tui::state::State;

pub const COMMANDS: &[Command] = &[
    command("snapshot", "[a..z]", "Keep the scene as it is now under a letter, to flip to", snapshot),
    command("flip", "[a..z]", "Show the scene as in the snapshot; there, as it was before that", flip),
];

/// The letter where none is given.
const FIRST: char = 'a';

fn letter(call: &Call) -> Result<char, String> {
    let mut letters = call.text.chars();
    match (letters.next(), letters.next()) {
        (None, _) => Ok(FIRST),
        (Some(letter @ 'a'..='z'), None) => Ok(letter),
        _ => Err(format!("a snapshot has a letter from a to z, not {}", call.text)),
    }
}

fn snapshot(state: &mut State, call: &Call) -> Done {
    let letter = letter(call)?;
    state.memory.snapshots.insert(letter, state.scene.history().state());
    state.say(format!("kept as snapshot {letter}: :flip {letter} (g a) shows it, and again what is there now"));
    Ok(())
}

/// Goes to the state of a snapshot, and from there to where that was asked for. Both are states of the history: whatever is
/// edited at either is kept.
fn flip(state: &mut State, call: &Call) -> Done {
    let letter = letter(call)?;
    let Some(&kept) = state.memory.snapshots.get(&letter) else {
        return Err(format!("there is no snapshot {letter}: :snapshot {letter} keeps the scene as it is"));
    };
    let here = state.scene.history().state();
    let to = if here == kept { state.memory.flipped_from.unwrap_or(here) } else { kept };
    if to == here {
        return Err(format!("the scene is as in snapshot {letter}: edit it first"));
    }
    call.obey(state, &format!("undo #{to}"))?;
    if to == kept {
        state.memory.flipped_from = Some(here);
    }
    let shown = if to == kept { format!("snapshot {letter}") } else { format!("as it is without snapshot {letter}") };
    state.say(format!("{shown} (g a flips)"));
    Ok(())
}
