//! The one table of commands: what keys run and what is typed after `:`. What is not here but on the command line of
//! `plica` (render, synth, ...) runs as there, with the same arguments.

use super::app::State;
use super::keys::{EVERYWHERE, KEYS};
use super::update::Effect;
use crate::base::problem;
use crate::ops;
use crate::preview::keys as window;

mod cells;
pub use cells::step_of;
mod files;
mod items;
mod moving;
mod placing;
mod playing;
mod typing;
mod values;

/// How a command ends: what to say where it could not be done.
pub type Done = Result<(), String>;

/// What a command is given.
pub struct Call<'a> {
    /// What stands after its name.
    pub text: &'a str,
    /// The count typed before its key.
    pub count: Option<usize>,
}

impl Call<'_> {
    /// The count, 1 where none was typed.
    pub fn times(&self) -> i64 {
        self.count.unwrap_or(1) as i64
    }
}

/// One command.
pub struct Command {
    /// Its name, as typed after `:`.
    pub name: &'static str,
    /// Its arguments, for help.
    pub args: &'static str,
    /// What it does, in a few words.
    pub help: &'static str,
    /// Does it.
    pub run: fn(&mut State, &Call) -> Done,
}

const fn command(
    name: &'static str,
    args: &'static str,
    help: &'static str,
    run: fn(&mut State, &Call) -> Done,
) -> Command {
    Command { name, args, help, run }
}

const TABLES: &[&[Command]] = &[
    files::COMMANDS,
    cells::COMMANDS,
    items::COMMANDS,
    values::COMMANDS,
    moving::COMMANDS,
    placing::COMMANDS,
    playing::COMMANDS,
    typing::COMMANDS,
];

/// Every command of the editor.
pub fn all() -> impl Iterator<Item = &'static Command> {
    TABLES.iter().copied().flatten()
}

/// The command of this name.
pub fn find(name: &str) -> Option<&'static Command> {
    all().find(|command| command.name == name)
}

/// The names of all commands, those of the command line included, in order.
pub fn names() -> Vec<String> {
    let mut names: Vec<String> = all().map(|command| command.name.to_string()).chain(ops::names()).collect();
    names.sort();
    names.dedup();
    names
}

/// Runs the command of a key.
pub fn run(state: &mut State, line: &str, count: Option<usize>) {
    let (name, text) = line.split_once(' ').unwrap_or((line, ""));
    let Some(command) = find(name) else { return state.complain(format!("there is no command {name}")) };
    // Only a run of steps joins into one step of undo.
    if name != "step" {
        state.door.close_step();
    }
    if let Err(why) = (command.run)(state, &Call { text: text.trim(), count }) {
        state.complain(why);
    }
}

/// Runs a command of the window's table: what the same key does here.
pub fn run_of_window(state: &mut State, name: &str) {
    let row = window::KEYS.iter().find(|row| row.command == name && row.context == window::PLAY);
    let here = row.and_then(|row| KEYS.iter().find(|own| own.context == EVERYWHERE && own.key == row.key));
    if let Some(row) = here {
        run(state, row.command, None);
    }
}

/// Runs a line that was typed after `:`.
pub fn run_line(state: &mut State, line: &str) {
    let line = line.trim();
    let name = line.split(' ').next().unwrap_or_default();
    if name.is_empty() {
        return;
    }
    if find(name).is_some() {
        return run(state, line, None);
    }
    if let Ok(row) = name.parse::<usize>() {
        return run(state, "move last", Some(row));
    }
    if !ops::names().any(|known| known == name) {
        let near = problem::nearest(name, names().iter().map(String::as_str)).map(|near| format!(": {near}"));
        return state.complain(format!("there is no command {name}{}", near.unwrap_or_default()));
    }
    match words(line) {
        Ok(words) => state.ask(Effect::Run(words)),
        Err(why) => state.complain(why),
    }
}

/// The words of a line; double quotes keep spaces.
pub fn words(line: &str) -> Result<Vec<String>, String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => {
                quoted = !quoted;
                word.get_or_insert_default();
            }
            ' ' if !quoted => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    if quoted { Err("a \" is not closed".into()) } else { Ok(words) }
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

    #[test]
    fn quotes_keep_words_together() {
        assert_eq!(
            words("render -o \"my file.gif\"  x"),
            Ok(vec!["render".into(), "-o".into(), "my file.gif".into(), "x".into()])
        );
        assert!(words("a \"b").is_err());
    }
}
