//! What the line being typed could become.

use super::command::Table;
use crate::scene::field;
use crate::tui::state::State;

/// Commands that take the path of a file, and whether it is meant relative to the scene.
const PATHS: &[(&str, bool)] = &[
    ("add", true),
    ("e", false),
    ("e!", false),
    ("log", false),
    ("source", false),
    ("w", false),
    ("w!", false),
    ("wq", false),
];

/// The command, the path typed so far (without the quote that it may begin with) and whether it is relative to the scene,
/// where `typed` asks for a file.
pub fn path_of(typed: &str) -> Option<(&str, &str, bool)> {
    let (name, path) = typed.split_once(' ')?;
    let path = path.strip_prefix('"').unwrap_or(path);
    PATHS.iter().find(|(own, _)| *own == name).map(|(_, beside)| (name, path, *beside))
}

/// The lines that `typed` could become: command names, paths of the scene after `set`.
pub fn candidates(table: &Table, state: &State, typed: &str) -> Vec<String> {
    match typed.split_once(' ') {
        None => table.names().into_iter().filter(|name| name.starts_with(typed)).collect(),
        Some((command @ ("set" | "get"), path)) => {
            paths(state, path).into_iter().map(|path| format!("{command} {path}")).collect()
        }
        Some(_) => Vec::new(),
    }
}

/// The paths of the scene that go on from `typed`, one name further.
fn paths(state: &State, typed: &str) -> Vec<String> {
    if typed.contains('=') {
        return Vec::new();
    }
    let (parent, last) = typed.rsplit_once('.').unwrap_or(("", typed));
    let pointer = if parent.is_empty() {
        Some(String::new())
    } else {
        crate::scene::address::resolve(state.document(), parent).ok()
    };
    let children = pointer.map(|pointer| field::children(state.document(), &pointer)).unwrap_or_default();
    let quoted = |name: String| if name.contains([' ', '.', '"', '=']) { format!("\"{name}\"") } else { name };
    let names = children.into_iter().map(|child| quoted(child.name)).filter(|name| name.starts_with(last));
    names.map(|name| if parent.is_empty() { name } else { format!("{parent}.{name}") }).collect()
}
