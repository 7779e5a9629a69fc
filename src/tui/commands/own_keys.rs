//! The person's own keys, read with what there is to run.

use super::TABLE;
use crate::tui::keys::Keymap;

/// The keymap of a file; what is wrong in it names `file`.
pub fn read(file: &str, text: &str) -> Keymap {
    let help = |name: &str| TABLE.find(name).map_or("", |command| command.help);
    let known: Vec<(String, &'static str)> =
        TABLE.names().into_iter().map(|name| (name.clone(), help(&name))).collect();
    Keymap::with(file, text, &known)
}
