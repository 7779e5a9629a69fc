//! Completion of the command line.

use std::collections::BTreeSet;

use super::command::Table;
use super::{fields, profiles};
use crate::base::pointer::Pointer;
use crate::ops::style;
use crate::scene::{Document, address, field};
use crate::tui::document::derived;
use crate::tui::state::State;

/// Commands that take the path of a file, and whether it is relative to the scene.
const PATHS: &[(&str, bool)] = &[
    ("add", true),
    ("e", false),
    ("e!", false),
    ("log", false),
    ("source", false),
    ("style", true),
    ("w", false),
    ("w!", false),
    ("wq", false),
];

/// The command, the path typed so far (without an opening quote) and whether it is relative to the scene. `None` if `typed`
/// is no command that takes a path.
pub fn path_of(typed: &str) -> Option<(&str, &str, bool)> {
    let (name, path) = typed.split_once(' ')?;
    let path = path.strip_prefix('"').unwrap_or(path);
    PATHS.iter().find(|(own, _)| *own == name).map(|(_, beside)| (name, path, *beside))
}

/// The lines that `typed` can be completed to: names of commands, of presets, of styles, of fields, and paths of the scene after `set` and `get`.
pub fn candidates(table: &Table, state: &State, typed: &str) -> Vec<String> {
    match typed.split_once(' ') {
        None => table.names().into_iter().filter(|name| name.starts_with(typed)).collect(),
        Some((command @ ("set" | "get"), path)) => {
            paths(state, path).into_iter().map(|path| format!("{command} {path}")).collect()
        }
        Some(("help", name)) => {
            let fields = fields::all(state).into_iter().map(|found| found.name);
            let all: BTreeSet<String> = table.names().into_iter().chain(fields).collect();
            all.into_iter().filter(|own| own.starts_with(name)).map(|own| format!("help {own}")).collect()
        }
        Some(("profile", name)) => {
            let names = profiles::offered(state).map(|found| found.preset.name).filter(|own| own.starts_with(name));
            names.map(|own| format!("profile {own}")).collect()
        }
        Some(("style", name)) => {
            let names = style::names().into_iter().map(|(own, _)| own).filter(|own| own.starts_with(name));
            names.map(|own| format!("style {own}")).collect()
        }
        Some(_) => Vec::new(),
    }
}

/// The paths of the scene that continue `typed` by one name.
fn paths(state: &State, typed: &str) -> Vec<String> {
    if typed.contains('=') {
        return Vec::new();
    }
    let (parent, last) = typed.split_at(last_step(typed));
    let document = state.document();
    let pointer = match parent.trim_end_matches('.') {
        "" => Some(String::new()),
        // With a `*`, the first place that it means stands for all.
        parent => address::resolve_all(document, parent).ok().and_then(|all| all.into_iter().next()),
    };
    let holder = pointer.as_deref().map(|pointer| address::address(document, pointer)).unwrap_or_default();
    let children = pointer.map(|pointer| below(document, &pointer)).unwrap_or_default();
    // The name as an address spells it, with quotes if it has spaces.
    let name = |child: String| {
        let whole = address::address(document, &child);
        whole.strip_prefix(holder.as_str()).unwrap_or(&whole).trim_start_matches('.').to_owned()
    };
    let begins = |name: &String| name.trim_start_matches('"').starts_with(last.trim_start_matches('"'));
    children.into_iter().map(name).filter(begins).map(|name| format!("{parent}{name}")).collect()
}

/// The places directly below a place, also those that stand there though they are not written.
fn below(document: &Document, pointer: &str) -> Vec<String> {
    let children = || match derived::place(document, pointer) {
        Some(place) => field::below(place, pointer).into_iter().map(|(child, _)| child.pointer).collect(),
        None => Vec::new(),
    };
    let laid = field::laid(document, pointer);
    laid.map_or_else(children, |tokens| tokens.iter().map(|token| Pointer(pointer).join(token)).collect())
}

/// Where the last step of an address begins: after the last dot outside quotes.
fn last_step(typed: &str) -> usize {
    let mut inside = false;
    let dots = typed.char_indices().filter(|&(_, c)| {
        inside ^= c == '"';
        c == '.' && !inside
    });
    dots.last().map_or(0, |(at, _)| at + 1)
}
