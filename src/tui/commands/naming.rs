//! Renames items that have a name; and images, meshes, clips and shapes, to which others refer by name, as they do to layers.

use super::command::{Call, Command, Done, command};
use super::items::{go_to, target};
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::layers::parts::materials::List;
use crate::scene::{Edit, field, named};
use crate::tui::state::{Mode, State};
use crate::tui::text::line::Line;
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[command(
    "rename",
    "[NAME]",
    "Rename the node or row; an image, a mesh, a clip, a shape or a layer is renamed everywhere",
    rename,
)
.change()];

fn rename(state: &mut State, call: &Call) -> Done {
    let path = target(state)?;
    let entry = List::entry(&path);
    let value = field::value(state.document(), &path);
    let old =
        entry.clone().map(|(_, name)| name).or_else(|| named::name_of(value.as_ref())).ok_or("this has no name")?;
    let name = unquoted(call.text);
    if name.is_empty() {
        state.typing.mode = Mode::Line(Line::with(&format!("rename {old}")));
        return Ok(());
    }
    let Some((list, _)) = entry else {
        let edit = Edit::set(state.document(), &Pointer(&path).join("name"), name.into());
        return state.edit(edit, false);
    };
    let (map, item) = list.words();
    if state.document().scene().names(list).contains(name.as_str()) {
        return Err(format!("there is already {} {}", article(item), quoted(&name)));
    }
    let edit = Edit::rename(state.document(), list, &old, &name);
    state.edit(edit, false)?;
    go_to(state, &Pointer(&format!("/{map}")).join(&name));
    Ok(())
}

fn article(noun: &str) -> String {
    let vowel = noun.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {noun}", if vowel { "an" } else { "a" })
}
