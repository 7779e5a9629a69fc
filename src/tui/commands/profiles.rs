//! Presets of layers: the list of those for the layer that is shown, and applying one.

use super::command::{Call, Command, Done, command};
use crate::scene::presets::{self, Offered};
use crate::tui::document::choice::{Choice, Then};
use crate::tui::document::tree;
use crate::tui::state::{Mode, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] =
    &[command("profile", "[NAME]", "Apply a preset to the layer, as smoke or fire", profile).change()];

fn profile(state: &mut State, call: &Call) -> Done {
    if !call.text.is_empty() {
        return apply(state, call.text);
    }
    let options: Vec<_> = offered(state).map(|found| (found.preset.name.into(), found.preset.help.into())).collect();
    if options.is_empty() {
        return Err("there are no presets for this layer".into());
    }
    state.typing.mode = Mode::Choice(Choice { title: "profile".into(), options, at: 0, then: Then::Preset });
    Ok(())
}

/// Applies a preset to the layer that is shown if it is for that, otherwise to the first one that it is for.
pub fn apply(state: &mut State, name: &str) -> Done {
    let found = presets::find(name)?;
    let shown = shown(state).filter(|(kind, _)| *kind == found.kind.name).map(|(_, layer)| layer);
    let applied = found.apply(state.document(), shown.as_deref())?;
    state.edit(applied.edit, false)?;
    state.say(plain(&applied.told));
    Ok(())
}

/// The presets for the layer that is shown, or all if no layer is shown.
pub fn offered(state: &State) -> impl Iterator<Item = Offered> {
    let shown = shown(state).map(|(kind, _)| kind);
    presets::all().filter(move |found| shown.is_none_or(|kind| kind == found.kind.name))
}

/// The technique and the name of the layer that is shown.
pub(super) fn shown(state: &State) -> Option<(&'static str, String)> {
    let index = tree::layer_of(&state.cursor.node)?;
    let layer = state.document().scene().layers.get(index)?.technique();
    Some((layer.kind().name, layer.name().to_owned()))
}
