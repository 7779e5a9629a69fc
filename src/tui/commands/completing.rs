//! Completion of the command line.

use std::collections::BTreeSet;

use super::command::Table;
use super::{fields, profiles};
use crate::base::pointer::Pointer;
use crate::layers::parts::materials::List;
use crate::layers::parts::vectors;
use crate::ops::style;
use crate::scene::{address, complete};
use crate::tui::state::State;
use crate::tui::text::said::one_word;

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

/// The lines that `typed` can be completed to: names of commands, of presets, of styles, of shapes, of fields, the words that a command
/// takes, and paths of the scene after `set`, `get`, `go` and the like.
pub fn candidates(table: &Table, state: &State, typed: &str) -> Vec<String> {
    match typed.split_once(' ') {
        None => table.names().into_iter().filter(|name| name.starts_with(typed)).collect(),
        Some(("set", settings)) => {
            // Of several, the last goes on.
            let begin = settings.rfind(" ").filter(|&end| settings[..end].contains('=')).map_or(0, |end| end + 1);
            let (before, last) = settings.split_at(begin);
            setting(state, last).into_iter().map(|one| format!("set {before}{one}")).collect()
        }
        Some((command @ ("get" | "go"), path)) => {
            let paths = complete::paths_around(state.document(), &state.here(), path).into_iter();
            paths.map(|path| format!("{command} {path}")).collect()
        }
        Some((command @ ("mute" | "solo" | "lock"), path)) => {
            let paths = complete::paths(state.document(), path).into_iter().filter(|path| leads_apart(state, path));
            paths.map(|path| format!("{command} {path}")).collect()
        }
        Some(("help", name)) => {
            let fields = fields::all(state).into_iter().map(|found| found.name);
            let all: BTreeSet<String> = table.names().into_iter().chain(fields).collect();
            all.into_iter().filter(|own| own.starts_with(name)).map(|own| format!("help {own}")).collect()
        }
        Some((command @ ("use" | "along" | "shape"), name)) => {
            let names = state.document().scene().names(List::Shapes).into_iter();
            let begins = |own: &&str| own.starts_with(name.trim_start_matches('"'));
            names.filter(begins).map(|own| format!("{command} {}", one_word(own))).collect()
        }
        Some(("profile", name)) => {
            let names = profiles::offered(state).map(|found| found.preset.name).filter(|own| own.starts_with(name));
            names.map(|own| format!("profile {own}")).collect()
        }
        Some(("style", name)) => {
            let names = style::names().into_iter().map(|(own, _)| own).filter(|own| own.starts_with(name));
            names.map(|own| format!("style {own}")).collect()
        }
        Some((vectors::COMMAND, words)) => {
            let (before, last) = words.split_at(words.rfind(' ').map_or(0, |end| end + 1));
            let names = vectors::SETTINGS.iter().map(|setting| setting.name).filter(|name| name.starts_with(last));
            names.map(|name| format!("{} {before}{name}=", vectors::COMMAND)).collect()
        }
        Some((name, typed)) => {
            let words = table.find(name).and_then(|command| command.words()).map(|(words, _)| words);
            let words = words.into_iter().flatten().filter(|word| word.starts_with(typed));
            words.map(|word| format!("{name} {word}")).collect()
        }
    }
}

/// What a setting can go on as: with a step of its path, or with one of the words that it may set.
fn setting(state: &State, typed: &str) -> Vec<String> {
    let (document, here) = (state.document(), state.here());
    let Some((path, value)) = typed.split_once('=') else { return complete::paths_around(document, &here, typed) };
    let whole = address::around(document, &here, path).unwrap_or_default();
    let values = complete::values(document, &format!("{whole}={value}")).into_iter();
    values.map(|value| format!("{path}={value}")).collect()
}

/// Whether an address is that of a layer or a zone, or leads to some.
fn leads_apart(state: &State, path: &str) -> bool {
    let Ok(pointer) = address::resolve(state.document(), path) else { return false };
    let scene = state.document().scene();
    let is_one = |pointer: &str| scene.mutable(pointer).as_deref() == Some(pointer);
    is_one(&pointer) || is_one(&Pointer(&pointer).join(0))
}
