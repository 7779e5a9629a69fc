//! Styles that layers are drawn in: the list, and putting a layer into one.

use super::command::{Call, Command, Done, command};
use super::profiles::shown;
use crate::files::paths;
use crate::layers::KINDS;
use crate::ops::style::{self, Meant};
use crate::scene::styles;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::state::{Mode, State};
use crate::tui::text::plain;
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[command(
    "style",
    "[NAME|FILE|none [--whole]]",
    "Draw the layer in a style, as hatching or watercolor, or in none",
    draw,
)
.change()];

fn draw(state: &mut State, call: &Call) -> Done {
    if !call.text.is_empty() {
        return apply(state, call.text);
    }
    let title = "style".into();
    state.typing.mode = Mode::Choice(Choice { title, options: style::names(), at: 0, then: Then::Style });
    Ok(())
}

/// Draws the layer that is shown in a style if it can be, otherwise the first one that can. The style has a name, or is in a
/// file relative to the scene; after it may stand `--whole`.
pub fn apply(state: &mut State, text: &str) -> Done {
    let whole = text.strip_suffix("--whole").filter(|rest| rest.ends_with(' '));
    let name = unquoted(whole.unwrap_or(text).trim());
    let file = paths::beside(state.scene.path(), &name);
    let meant = Meant::of(&name, &file, &state.scene.options().limits).map_err(|error| error.to_string())?;
    let has = |kind: &str| KINDS.iter().any(|own| own.name == kind && own.styles.is_some());
    let layer = shown(state).filter(|(kind, _)| has(kind)).map(|(_, layer)| layer);
    let applied = styles::apply(state.document(), layer.as_deref(), meant.source(), whole.is_some())?;
    state.edit(applied.edit, false)?;
    state.say(plain(&applied.told));
    Ok(())
}
