//! The table of commands, which keys run and people type after `:`.

use super::state::State;
use command::{Command, Done, Table};

mod adding;
mod apart;
mod camera;
mod cells;
mod columns;
pub mod command;
mod completing;
pub mod conflicts;
pub mod contexts;
mod fields;
mod files;
mod filling;
mod finding;
pub mod help;
mod items;
mod keymap;
mod macros;
pub mod manual;
pub mod messages;
mod moving;
mod naming;
mod ordering;
pub mod own_keys;
mod painting;
mod palette;
pub mod pasting;
mod picking;
mod picture;
mod piping;
mod placing;
mod playing;
mod profiles;
mod replacing;
mod rowing;
mod scripts;
mod selecting;
mod shaping;
mod sharing;
mod snapping;
mod snapshots;
mod styles;
mod transforming;
pub mod tutor;
mod typing;
mod undoing;
pub mod update;
mod values;
mod views;
pub mod waiting;
mod yanking;

/// Every command.
pub static TABLE: Table = Table(&[
    files::COMMANDS,
    cells::COMMANDS,
    adding::COMMANDS,
    items::COMMANDS,
    ordering::COMMANDS,
    rowing::COMMANDS,
    naming::COMMANDS,
    selecting::COMMANDS,
    apart::COMMANDS,
    columns::COMMANDS,
    values::COMMANDS,
    replacing::COMMANDS,
    sharing::COMMANDS,
    shaping::COMMANDS,
    undoing::COMMANDS,
    snapshots::COMMANDS,
    yanking::COMMANDS,
    filling::COMMANDS,
    piping::COMMANDS,
    moving::COMMANDS,
    finding::COMMANDS,
    palette::COMMANDS,
    help::COMMANDS,
    messages::COMMANDS,
    profiles::COMMANDS,
    styles::COMMANDS,
    placing::COMMANDS,
    snapping::COMMANDS,
    transforming::COMMANDS,
    playing::COMMANDS,
    camera::COMMANDS,
    views::COMMANDS,
    painting::COMMANDS,
    picking::COMMANDS,
    picture::COMMANDS,
    typing::COMMANDS,
    scripts::COMMANDS,
    macros::COMMANDS,
    conflicts::COMMANDS,
    keymap::COMMANDS,
    tutor::COMMANDS,
]);

/// Every command of the editor.
pub fn all() -> impl Iterator<Item = &'static Command> {
    TABLE.all()
}

/// Runs a line, and shows why it could not be done.
pub fn run(state: &mut State, line: &str, count: Option<usize>) {
    TABLE.run(state, line, count);
}

/// Runs a line `[COUNT] NAME [ARGS]`.
///
/// # Errors
/// Why it could not be done.
pub fn obey(state: &mut State, line: &str, count: Option<usize>) -> Done {
    TABLE.obey(state, line, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_name_and_help() {
        let mut names: Vec<_> = all().map(|command| command.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "two commands of one name");
        for command in all() {
            assert!(command.help.starts_with(char::is_uppercase) && !command.help.ends_with('.'), "{}", command.name);
        }
    }
}
