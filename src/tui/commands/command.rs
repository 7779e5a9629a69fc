//! What a command is, and the one function that runs a line. What is not in the table but on the command line of `plica`
//! (render, synth, ...) runs as there, with the same arguments.

use std::path::PathBuf;

use crate::base::problem;
use crate::files::paths;
use crate::ops;
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::state::recorder::{Ended, Recorded};
use crate::tui::text::said::{Said, one_of, words};

/// How a command ends: what to say where it could not be done.
pub type Done = Result<(), String>;

/// What a command is given.
pub struct Call<'a> {
    /// What stands after its name.
    pub text: &'a str,
    /// The count typed before its key.
    pub count: Option<usize>,
    /// All commands.
    pub table: &'static Table,
}

/// Counts go so far: to any row that a scene may have.
const MOST_COUNT: usize = 1_000_000;

impl Call<'_> {
    /// The path that it is given, as words of a command line are: double quotes keep spaces, `~` is the home folder.
    ///
    /// # Errors
    /// It is given more than one, or a program to run.
    pub fn path(&self) -> Result<Option<PathBuf>, String> {
        match words(self.text)?.as_slice() {
            [] => Ok(None),
            [one] if one.is_empty() => Err("a path is empty".into()),
            [first, ..] if self.text.starts_with('!') => {
                Err(format!("programs are not run from here; a file of that name is ./{first}"))
            }
            [one] => Ok(Some(paths::typed(one))),
            several => Err(format!("one path is taken, not {}; in double quotes it may have spaces", several.len())),
        }
    }

    /// The count, 1 where none was typed.
    pub fn times(&self) -> i64 {
        self.count.unwrap_or(1) as i64
    }

    /// The steps of a command that goes so far; no way is longer.
    pub fn steps(&self) -> std::ops::Range<usize> {
        0..self.count.unwrap_or(1).min(1000)
    }

    /// The count of a command that makes something each time.
    ///
    /// # Errors
    /// It is more than anybody means.
    pub fn times_of(&self, name: &str) -> Result<usize, String> {
        /// Keys never wait for long.
        const MOST: usize = 10_000;
        let times = self.count.unwrap_or(1);
        if times > MOST { Err(format!("{name} goes {MOST} times at most, not {times}")) } else { Ok(times) }
    }

    /// Runs another line, as a part of this one.
    ///
    /// # Errors
    /// What to say where it could not be done.
    pub fn obey(&self, state: &mut State, line: &str) -> Done {
        self.table.obey(state, line, None)
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
    /// What the recorder notes of it: in the log of the session, in macros, for `.`.
    pub recorded: Recorded,
    /// Whether it takes a count.
    pub counts: Counts,
    /// Does it.
    pub run: fn(&mut State, &Call) -> Done,
}

/// Where a command does something with a count: repeats itself, or goes so far. Elsewhere a count is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// Nowhere.
    Never,
    /// Whatever it is told.
    Always,
    /// Where its text begins with one of these words; an empty one stands for no text.
    With(&'static [&'static str]),
}

impl Command {
    /// One that changes the scene, which `.` repeats.
    pub const fn change(self) -> Command {
        Command { recorded: Recorded::Change, ..self }
    }

    /// One that takes a count.
    pub const fn counted(self) -> Command {
        Command { counts: Counts::Always, ..self }
    }

    /// One that takes a count with these words.
    pub const fn counted_with(self, words: &'static [&'static str]) -> Command {
        Command { counts: Counts::With(words), ..self }
    }

    /// The words that may stand after its name, where there are no others, and whether it can do without.
    pub fn words(&self) -> Option<(Vec<&'static str>, bool)> {
        let inside = self.args.strip_prefix('[').and_then(|args| args.strip_suffix(']'));
        let words: Vec<&str> = inside.unwrap_or(self.args).split('|').filter(|word| !word.is_empty()).collect();
        let plain = |word: &&str| word.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        words.iter().all(plain).then(|| (words, inside.is_some() || self.args.is_empty()))
    }

    /// Refuses what the table says that the command does not take: another word, a count.
    fn takes(&self, said: &Said) -> Done {
        if let Some((words, optional)) = self.words()
            && !words.contains(&said.text)
            && !(optional && said.text.is_empty())
        {
            let found = if said.text.is_empty() { "nothing".into() } else { problem::quoted(said.text) };
            return Err(match words.as_slice() {
                [] => format!("{} takes nothing after it, not {found}", self.name),
                words => format!("{} takes {}, not {found}", self.name, one_of(words)),
            });
        }
        let first = said.text.split(' ').next().unwrap_or_default();
        let counts = match self.counts {
            Counts::Never => false,
            Counts::Always => true,
            Counts::With(words) => words.contains(&first),
        };
        match said.count {
            Some(_) if !counts => Err(format!("{} takes no count", format!("{} {first}", self.name).trim_end())),
            _ => Ok(()),
        }
    }

    /// Whether it would change the scene.
    fn edits(&self, said: &Said) -> bool {
        // `place next` and `place previous` only go to points.
        self.recorded == Recorded::Change && !matches!(said.text, "next" | "previous")
    }

    /// One that answers a list of choices.
    pub const fn answer(self) -> Command {
        Command { recorded: Recorded::Answer, ..self }
    }

    /// One that plays lines, which are kept in its place.
    pub const fn played(self) -> Command {
        Command { recorded: Recorded::Played, ..self }
    }

    /// One of which only the lines are kept that it runs itself, if any: it types, asks, or only shows.
    pub const fn inside(self) -> Command {
        Command { recorded: Recorded::Inside, ..self }
    }
}

/// A command of which the line is kept; [`Command::change`] and [`Command::inside`] say otherwise.
pub const fn command(
    name: &'static str,
    args: &'static str,
    help: &'static str,
    run: fn(&mut State, &Call) -> Done,
) -> Command {
    Command { name, args, help, recorded: Recorded::Line, counts: Counts::Never, run }
}

/// Other names of commands: as vim has them, and as they were called before.
const ALIASES: &[(&str, &str)] = &[
    ("edit", "e"),
    ("edit!", "e!"),
    ("fold", "collapse"),
    ("h", "help"),
    ("open", "expand"),
    ("qa", "q"),
    ("qa!", "q!"),
    ("quit", "q"),
    ("quit!", "q!"),
    ("quitall", "q"),
    ("red", "redo"),
    ("u", "undo"),
    ("wa", "w"),
    ("wqa", "wq"),
    ("write", "w"),
    ("write!", "w!"),
    ("x", "wq"),
    ("xa", "wq"),
    ("xit", "wq"),
];

/// All commands together: what finds them by name and runs lines of them.
pub struct Table(pub &'static [&'static [Command]]);

impl Table {
    /// Every command of the editor.
    pub fn all(&self) -> impl Iterator<Item = &'static Command> + use<> {
        self.0.iter().copied().flatten()
    }

    /// The command of this name, or of this other name.
    pub fn find(&self, name: &str) -> Option<&'static Command> {
        let name = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, name)| name);
        self.all().find(|command| command.name == name)
    }

    /// The other names of commands.
    pub fn aliases(&self) -> impl Iterator<Item = &'static str> {
        ALIASES.iter().map(|(alias, _)| *alias)
    }

    /// Whether a line only saves or leaves.
    pub fn leaves(&self, line: &str) -> bool {
        let command = self.find(Said::parse(line, None).name);
        command.is_some_and(|command| matches!(command.name, "q" | "q!" | "w" | "w!" | "wq"))
    }

    /// The subcommands of the command line that have a use in the editor.
    pub fn subcommands(&self) -> impl Iterator<Item = String> {
        const OUTSIDE: &[&str] = &["demo", "new", "edit", "tutor", "attach", "completions", "man"];
        ops::names().filter(|name| !OUTSIDE.contains(&name.as_str()) && self.find(name).is_none())
    }

    /// That there is no such command, and what may have been meant.
    pub fn unknown(&self, name: &str) -> String {
        let names = self.names();
        let near = problem::nearest(name, names.iter().map(String::as_str));
        let near = near.filter(|near| near.starts_with("did you mean")).unwrap_or("? lists them".into());
        format!("there is no command {} ({near})", problem::quoted(name))
    }

    /// The names of all commands, those of the command line included, in order.
    pub fn names(&self) -> Vec<String> {
        let own = self.all().map(|command| command.name.to_string());
        let mut names: Vec<String> = own.chain(self.subcommands()).collect();
        names.sort();
        names.dedup();
        names
    }

    /// Runs a line, and says where it could not be done.
    pub fn run(&'static self, state: &mut State, line: &str, count: Option<usize>) {
        if let Err(why) = self.obey(state, line, count) {
            state.complain(why);
        }
    }

    /// Runs a line `[COUNT] NAME [ARGS]`: keys, what is typed after `:`, scripts, macros and windows all come here.
    ///
    /// # Errors
    /// What to say where it could not be done.
    pub fn obey(&'static self, state: &mut State, line: &str, count: Option<usize>) -> Done {
        let said = Said::parse(line, count);
        if said.name.is_empty() {
            return Ok(());
        }
        if let Some(count) = said.count.filter(|&count| count > MOST_COUNT) {
            return Err(format!("a count goes to {MOST_COUNT}, not {count}"));
        }
        #[cfg(test)]
        crate::tui::tests::coverage::ran(said.name);
        let command = self.find(said.name);
        let recorded = command.map_or(Recorded::Line, |command| command.recorded);
        let (revision, asked) = (state.scene.revision(), state.typing.mode.asks());
        state.memory.recorder.begin(recorded);
        let done = match command {
            Some(command) => command.takes(&said).and_then(|()| {
                // Nothing is typed or chosen that would be refused at its end.
                if command.edits(&said) {
                    state.scene.writable()?;
                }
                (command.run)(state, &Call { text: said.text, count: said.count, table: self })
            }),
            None => self.subcommand(state, &said),
        };
        let asks = state.typing.mode.asks() && !asked;
        // Only a run of steps joins into one step of undo, whatever was looked at meanwhile.
        if done.is_ok() && !matches!(recorded, Recorded::Inside | Recorded::Played) && !asks && said.name != "step" {
            state.scene.close_step();
        }
        let refused = done.as_ref().err().map(String::as_str);
        state.memory.recorder.end(Ended {
            line: said.to_string(),
            recorded,
            refused,
            asks,
            changed: state.scene.revision() != revision,
        });
        done
    }

    /// Asks for a subcommand of the command line, with the same arguments.
    fn subcommand(&self, state: &mut State, said: &Said) -> Done {
        let name = said.name;
        if !ops::names().any(|known| known == name) {
            return Err(self.unknown(name));
        }
        if said.count.is_some() {
            return Err(format!("{name} takes no count"));
        }
        let words = words(&format!("{name} {}", said.text))?;
        state.ask(Effect::Run(words));
        Ok(())
    }
}
