//! Renames items that have a name, and pictures, to which others refer by name.

use super::command::{Call, Command, Done, command};
use super::items::{go_to, target};
use crate::base::problem::quoted;
use crate::scene::{Edit, field, pointer};
use crate::tui::state::{Mode, State};
use crate::tui::text::line::Line;
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] =
    &[command("rename", "[NAME]", "Rename the node or row; a picture is renamed everywhere", rename).change()];

/// The pictures of a scene, by name.
const IMAGES: &str = "/images";

fn rename(state: &mut State, call: &Call) -> Done {
    let path = target(state)?;
    let image = pointer::split(&path).filter(|(map, _)| *map == IMAGES).map(|(_, name)| name);
    let value = field::value(state.document(), &path);
    let old = image.clone().or_else(|| field::name_of(value.as_ref())).ok_or("this has no name")?;
    let name = unquoted(call.text);
    if name.is_empty() {
        state.typing.mode = Mode::Line(Line::with(&format!("rename {old}")));
        return Ok(());
    }
    if image.is_none() {
        let edit = Edit::set(state.document(), &pointer::join(&path, "name"), name.into());
        return state.edit(edit, false);
    }
    if state.document().scene().images.contains_key(&name) {
        return Err(format!("there is already a picture {}", quoted(&name)));
    }
    let edit = Edit::rename_image(state.document(), &old, &name);
    state.edit(edit, false)?;
    go_to(state, &pointer::join(IMAGES, &name));
    Ok(())
}
