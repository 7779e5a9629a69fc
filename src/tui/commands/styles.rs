//! Styles that layers are drawn in: the list, and putting a layer into one.

use super::command::{Call, Command, Done, command};
use super::profiles::shown;
use crate::layers::KINDS;
use crate::scene::styles::{self, Source};
use crate::tui::document::choice::{Choice, Then};
use crate::tui::state::{Mode, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] =
    &[command("style", "[NAME]", "Draw the layer in a style, as hatching or watercolor", style).change()];

fn style(state: &mut State, call: &Call) -> Done {
    if !call.text.is_empty() {
        return apply(state, call.text);
    }
    let options = styles::all().map(|style| (style.name.into(), style.help.into())).collect();
    state.typing.mode = Mode::Choice(Choice { title: "style".into(), options, at: 0, then: Then::Style });
    Ok(())
}

/// Draws the layer that is shown in a style if it can be, otherwise the first one that can.
pub fn apply(state: &mut State, name: &str) -> Done {
    let source = Source::Named(styles::find(name)?);
    let has = |kind: &str| KINDS.iter().any(|own| own.name == kind && own.styles.is_some());
    let layer = shown(state).filter(|(kind, _)| has(kind)).map(|(_, layer)| layer);
    let applied = styles::apply(state.document(), layer.as_deref(), source, false)?;
    state.edit(applied.edit, false)?;
    state.say(plain(&applied.told));
    Ok(())
}
