//! Styles that layers are drawn in: the list, and putting a layer into one.

use super::command::{Call, Command, Done, command};
use super::profiles::shown;
use crate::base::number::{json, tidy};
use crate::base::problem::{nearest, quoted};
use crate::files::paths;
use crate::layers::KINDS;
use crate::layers::starts::Styles;
use crate::ops::style::{self, Meant};
use crate::scene::field::{self, Kind};
use crate::scene::{Edit, styles};
use crate::tui::document::choice::{Choice, Then};
use crate::tui::state::{Mode, State};
use crate::tui::text::numbers::short;
use crate::tui::text::plain;
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[
    command(
        "style",
        "[NAME|FILE|none [--whole]|next|previous]",
        "Draw the layer in a style, as hatching or watercolor, in the one after, or in none",
        draw,
    )
    .change(),
    command(
        "anchor",
        "[next|WORD]",
        "Fix the strokes of the layer to the next of surface, screen and texture, or to one",
        anchor,
    )
    .change(),
    command("turn", "DEGREES", "Turn the strokes of the layer counter-clockwise, wherever they run", turn)
        .change()
        .counted(),
];

/// Directions come round.
const ROUND: f64 = 360.0;

fn draw(state: &mut State, call: &Call) -> Done {
    match call.text {
        "" => {}
        "next" => return step(state, 1),
        "previous" => return step(state, -1),
        text => return apply(state, text),
    }
    let title = "style".into();
    state.typing.mode = Mode::Choice(Choice { title, options: style::names(), at: 0, then: Then::Style });
    Ok(())
}

/// The styles of the layer that is shown, or of the first that can be drawn in one, and where it says in which.
fn field(state: &State) -> Result<(&'static Styles, String), String> {
    styles::of_layer(state.document(), styled(state).as_deref())
}

/// Whether the layer that is shown is drawn in strokes.
pub fn is_drawn(state: &State) -> bool {
    let path = styled(state).and_then(|_| field(state).ok()).map(|(_, path)| path);
    path.and_then(|path| state.document().json().pointer(&path)).is_some_and(|strokes| !strokes.is_null())
}

/// Draws the layer in the style that is so many places after its own.
fn step(state: &mut State, by: i64) -> Done {
    let (styles, path) = field(state)?;
    let own = state.document().json().pointer(&(path + styles.name));
    let at = styles.list.iter().position(|style| own.is_some_and(|own| *own == style.name));
    let count = styles.list.len() as i64;
    let next = at.map_or(if by > 0 { 0 } else { count - 1 }, |at| (at as i64 + by).rem_euclid(count));
    apply(state, styles.list[next as usize].name)
}

fn anchor(state: &mut State, call: &Call) -> Done {
    let (styles, path) = field(state)?;
    let pointer = path + styles.anchor;
    let field = field::field(state.document(), &pointer).ok_or(UNDRAWN)?;
    let Kind::Choice(words) = &field.kind else { return Err(UNDRAWN.into()) };
    let names: Vec<&str> = words.iter().map(|word| word.name).collect();
    let own = field::in_force(state.document(), &pointer);
    let own = names.iter().position(|name| own.as_ref().is_some_and(|own| own == name));
    let to = match call.text {
        "" | "next" => names[own.map_or(0, |at| (at + 1) % names.len())],
        word => names.iter().find(|name| **name == word).ok_or_else(|| {
            let hint = nearest(word, names.iter().copied()).unwrap_or_default();
            format!("strokes are not fixed to {} ({hint})", quoted(word))
        })?,
    };
    state.edit(Edit::set(state.document(), &pointer, to.into()), false)?;
    state.say(format!("fixed to {to}"));
    Ok(())
}

fn turn(state: &mut State, call: &Call) -> Done {
    let by: f64 = call.text.parse().ok().filter(|by: &f64| by.is_finite()).ok_or("turn takes degrees")?;
    let (styles, path) = field(state)?;
    let pointer = path + styles.turn;
    let own = field::in_force(state.document(), &pointer).and_then(|own| own.as_f64()).unwrap_or(0.0);
    let to = tidy((own + by * call.times() as f64).rem_euclid(ROUND));
    state.edit(Edit::set(state.document(), &pointer, json(to)), true)?;
    state.say(format!("turned by {} degrees", short(to)));
    Ok(())
}

/// Why there is nothing to be changed.
const UNDRAWN: &str = "the layer is not drawn in strokes: :style draws it";

/// The name of the layer that is shown, if it can be drawn in a style.
fn styled(state: &State) -> Option<String> {
    let has = |kind: &str| KINDS.iter().any(|own| own.name == kind && own.styles.is_some());
    shown(state).filter(|(kind, _)| has(kind)).map(|(_, layer)| layer)
}

/// Draws the layer that is shown in a style if it can be, otherwise the first one that can. The style has a name, or is in a
/// file relative to the scene; after it may stand `--whole`.
pub fn apply(state: &mut State, text: &str) -> Done {
    let whole = text.strip_suffix("--whole").filter(|rest| rest.ends_with(' '));
    let name = unquoted(whole.unwrap_or(text).trim());
    let file = paths::beside(state.scene.path(), &name);
    let meant = Meant::of(&name, &file, &state.scene.options().limits).map_err(|error| error.to_string())?;
    let layer = styled(state);
    let applied = styles::apply(state.document(), layer.as_deref(), meant.source(), whole.is_some())?;
    state.edit(applied.edit, false)?;
    state.say(plain(&applied.told));
    Ok(())
}
