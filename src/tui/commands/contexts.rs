//! Which keys are in use.

use super::styles;
use crate::tui::keys;
use crate::tui::state::painting::Sees;
use crate::tui::state::{Mode, Pane, State, entry, looking};

/// The contexts of the key table that apply, the innermost first.
pub fn contexts(state: &State) -> Vec<&'static str> {
    if state.is_small() && !matches!(state.typing.mode, Mode::Line(_)) {
        return vec![keys::SMALL];
    }
    let mut contexts = match (&state.typing.mode, state.cursor.focus) {
        (Mode::Entry(_), _) if entry::of_number(state) => vec![keys::NUMBER, keys::ENTRY, keys::TYPING],
        (Mode::Entry(_), _) => vec![keys::ENTRY, keys::TYPING],
        (Mode::Line(_), _) => vec![keys::LINE, keys::TYPING],
        (Mode::Choice(_), _) => vec![keys::LIST],
        (Mode::Palette(_), _) => vec![keys::PALETTE, keys::TYPING],
        (Mode::Pages(_), _) => vec![keys::HELP],
        (Mode::Aim, _) => vec![keys::AIM, keys::MOVING],
        (Mode::Normal, Pane::Tree) if looking::picks(state).is_some_and(|(.., here)| here) => {
            vec![keys::PICKABLE, keys::TREE, keys::EVERYWHERE]
        }
        (Mode::Normal, Pane::Picture) if state.picture.looking.is_some() => {
            vec![keys::PICKING, keys::PICTURE, keys::MOVING, keys::EVERYWHERE]
        }
        (Mode::Normal, Pane::Picture) if let Some(painting) = state.picture.painting => {
            let own = match painting.sees {
                Sees::Results => None,
                Sees::Painting => Some(keys::PAINTED),
                Sees::Select => Some(keys::SELECTING),
            };
            let all = [keys::PAINTING, keys::PICTURE, keys::MOVING, keys::EVERYWHERE];
            own.into_iter().chain(all).collect()
        }
        (Mode::Normal, Pane::Tree) => vec![keys::TREE, keys::EVERYWHERE],
        (Mode::Normal, Pane::Table) => vec![keys::TABLE, keys::EVERYWHERE],
        (Mode::Normal, Pane::Picture) if styles::is_drawn(state) => {
            vec![keys::TURNING, keys::PICTURE, keys::MOVING, keys::EVERYWHERE]
        }
        (Mode::Normal, Pane::Picture) => vec![keys::PICTURE, keys::MOVING, keys::EVERYWHERE],
    };
    if matches!(state.typing.mode, Mode::Normal) && state.memory.recorder.recording().is_some() {
        contexts.insert(0, keys::RECORDING);
    }
    contexts
}
