//! What a command is, and the function that runs a line. Subcommands of the command line that are not in the table (render,
//! synth, ...) run with the same arguments as there.

use std::path::PathBuf;

use crate::base::problem;
use crate::files::paths;
use crate::ops;
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::state::recorder::{Ended, Recorded};
use crate::tui::text::said::{Said, one_of, words};

/// The result of a command: why it could not be done.
pub type Done = Result<(), String>;

/// The arguments of a command.
pub struct Call<'a> {
    /// The text after its name.
    pub text: &'a str,
    /// The count, if one was given.
    pub count: Option<usize>,
    /// All commands.
    pub table: &'static Table,
}

/// The largest count; more than the rows that a scene may have.
const MOST_COUNT: usize = 1_000_000;

impl Call<'_> {
    /// Its argument as a path. Double quotes keep spaces, `~` is the home folder.
    ///
    /// # Errors
    /// It is more than one path, or a program to run (`!`).
    pub fn path(&self) -> Result<Option<PathBuf>, String> {
        match words(self.text)?.as_slice() {
            [] => Ok(None),
            [one] if one.is_empty() => Err("a path is empty".into()),
            [first, ..] if self.text.starts_with('!') => {
                Err(format!("programs are not run from here; for a file of that name write ./{first}"))
            }
            [one] => Ok(Some(paths::typed(one))),
            several => {
                Err(format!("one path is needed, not {}; a path with spaces needs double quotes", several.len()))
            }
        }
    }

    /// The count, 1 if none was given.
    pub fn times(&self) -> i64 {
        self.count.unwrap_or(1) as i64
    }

    /// An iterator over the count, for commands that repeat a step; at most 1000.
    pub fn steps(&self) -> std::ops::Range<usize> {
        0..self.count.unwrap_or(1).min(1000)
    }

    /// The count of a command that makes something each time.
    ///
    /// # Errors
    /// It is too large.
    pub fn times_of(&self, name: &str) -> Result<usize, String> {
        /// At most this many, so that no key waits long.
        const MOST: usize = 10_000;
        let times = self.count.unwrap_or(1);
        if times > MOST { Err(format!("{name} repeats {MOST} times at most, not {times}")) } else { Ok(times) }
    }

    /// Runs another line as a part of this one.
    ///
    /// # Errors
    /// Why it could not be done.
    pub fn obey(&self, state: &mut State, line: &str) -> Done {
        self.table.obey(state, line, None)
    }
}

/// A command.
pub struct Command {
    /// Its name, as typed after `:`.
    pub name: &'static str,
    /// Its arguments, for help.
    pub args: &'static str,
    /// What it does, in a few words.
    pub help: &'static str,
    /// What the recorder notes of it: in the log of the session, in macros, for `.`.
    pub recorded: Recorded,
    /// When it takes a count.
    pub counts: Counts,
    /// Whether, with this argument, it depends on what is shown being that of the scene as it is.
    pub awaits: fn(&State, &str) -> bool,
    /// Runs it.
    pub run: fn(&mut State, &Call) -> Done,
}

/// When a command takes a count; otherwise a count is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// Never.
    Never,
    /// With any arguments.
    Always,
    /// If its argument begins with one of these words; an empty word means no argument.
    With(&'static [&'static str]),
}

impl Command {
    /// Marks it as one that changes the scene, which `.` repeats.
    pub const fn change(self) -> Command {
        Command { recorded: Recorded::Change, ..self }
    }

    /// Makes it depend, with some arguments, on what is shown being that of the scene as it is.
    pub const fn awaiting(self, awaits: fn(&State, &str) -> bool) -> Command {
        Command { awaits, ..self }
    }

    /// Makes it take a count.
    pub const fn counted(self) -> Command {
        Command { counts: Counts::Always, ..self }
    }

    /// Makes it take a count with these words.
    pub const fn counted_with(self, words: &'static [&'static str]) -> Command {
        Command { counts: Counts::With(words), ..self }
    }

    /// The words that it takes as an argument, and whether the argument is optional. `None` if it takes other arguments.
    pub fn words(&self) -> Option<(Vec<&'static str>, bool)> {
        let inside = self.args.strip_prefix('[').and_then(|args| args.strip_suffix(']'));
        let words: Vec<&str> = inside.unwrap_or(self.args).split('|').filter(|word| !word.is_empty()).collect();
        let plain = |word: &&str| word.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        words.iter().all(plain).then(|| (words, inside.is_some() || self.args.is_empty()))
    }

    /// Refuses words and counts that the command does not take according to the table.
    fn takes(&self, said: &Said) -> Done {
        if let Some((words, optional)) = self.words()
            && !words.contains(&said.text)
            && !(optional && said.text.is_empty())
        {
            let found = problem::quoted(said.text);
            return Err(match words.as_slice() {
                [] => format!("{} takes no argument, not {found}", self.name),
                words if said.text.is_empty() => format!("{} wants {}", self.name, one_of(words)),
                words => format!("{} is followed by {}, not {found}", self.name, one_of(words)),
            });
        }
        let first = said.text.split(' ').next().unwrap_or_default();
        let counts = match self.counts {
            Counts::Never => false,
            Counts::Always => true,
            Counts::With(words) => words.contains(&first),
        };
        match said.count {
            Some(count) if !counts => Err(match format!("{} {first}", self.name).trim_end() {
                "choice take" => format!("an answer takes no count: leave out the {count}"),
                name => format!("{name} takes no count: leave out the {count}"),
            }),
            _ => Ok(()),
        }
    }

    /// Whether it would change the scene with these arguments.
    fn edits(&self, said: &Said) -> bool {
        // `place next` and `place previous` only go to points.
        self.recorded == Recorded::Change && !matches!(said.text, "next" | "previous")
    }

    /// Marks it as one that answers a list of choices.
    pub const fn answer(self) -> Command {
        Command { recorded: Recorded::Answer, ..self }
    }

    /// Marks it as one that plays lines, which are recorded in its place.
    pub const fn played(self) -> Command {
        Command { recorded: Recorded::Played, ..self }
    }

    /// Marks it as one that types, asks or only shows something: only lines that it runs itself are recorded.
    pub const fn inside(self) -> Command {
        Command { recorded: Recorded::Inside, ..self }
    }
}

/// A command whose line is recorded, and which takes no count. The methods of [`Command`] change that.
pub const fn command(
    name: &'static str,
    args: &'static str,
    help: &'static str,
    run: fn(&mut State, &Call) -> Done,
) -> Command {
    Command { name, args, help, recorded: Recorded::Line, counts: Counts::Never, awaits: |_, _| false, run }
}

/// Other names of commands: vim's, and earlier ones.
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

/// All commands. Finds them by name and runs lines.
pub struct Table(pub &'static [&'static [Command]]);

impl Table {
    /// Every command of the editor.
    pub fn all(&self) -> impl Iterator<Item = &'static Command> + use<> {
        self.0.iter().copied().flatten()
    }

    /// The command with this name or this other name.
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

    /// The subcommands of the command line that are useful in the editor.
    pub fn subcommands(&self) -> impl Iterator<Item = String> {
        const OUTSIDE: &[&str] = &["demo", "new", "edit", "tutor", "attach", "completions", "man"];
        ops::names().filter(|name| !OUTSIDE.contains(&name.as_str()) && self.find(name).is_none())
    }

    /// A message that there is no such command, with what may have been meant.
    pub fn unknown(&self, name: &str) -> String {
        let names = self.names();
        let near = problem::nearest(name, names.iter().map(String::as_str));
        let near = near.filter(|near| near.starts_with("did you mean")).unwrap_or("? lists them".into());
        format!("there is no command {} ({near})", problem::quoted(name))
    }

    /// The names of all commands and subcommands, in order.
    pub fn names(&self) -> Vec<String> {
        let own = self.all().map(|command| command.name.to_string());
        let mut names: Vec<String> = own.chain(self.subcommands()).collect();
        names.sort();
        names.dedup();
        names
    }

    /// Runs a line, and shows why it could not be done.
    pub fn run(&'static self, state: &mut State, line: &str, count: Option<usize>) {
        if let Err(why) = self.obey(state, line, count) {
            state.complain(why);
        }
    }

    /// Runs a line `[COUNT] NAME [ARGS]`. Keys, what is typed after `:`, scripts, macros and windows all come here.
    ///
    /// # Errors
    /// Why it could not be done.
    pub fn obey(&'static self, state: &mut State, line: &str, count: Option<usize>) -> Done {
        let said = Said::parse(line, count);
        if said.name.is_empty() {
            return Ok(());
        }
        if let Some(count) = said.count.filter(|&count| count > MOST_COUNT) {
            return Err(format!("a count is at most {MOST_COUNT}, not {count}"));
        }
        #[cfg(test)]
        crate::tui::tests::coverage::ran(said.name);
        let command = self.find(said.name);
        let recorded = command.map_or(Recorded::Line, |command| command.recorded);
        let (revision, asked) = (state.scene.revision(), state.typing.mode.asks());
        state.memory.recorder.begin(recorded);
        let done = match command {
            Some(command) => command.takes(&said).and_then(|()| {
                // Refuse at once, not after something was typed or chosen.
                if command.edits(&said) {
                    state.scene.writable()?;
                }
                (command.run)(state, &Call { text: said.text, count: said.count, table: self })
            }),
            None => self.subcommand(state, &said),
        };
        let asks = state.typing.mode.asks() && !asked;
        // Only successive `step`s join into one step of undo; lines that are not recorded may come in between.
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

    /// Requests a subcommand of the command line, with the same arguments.
    fn subcommand(&self, state: &mut State, said: &Said) -> Done {
        let name = said.name;
        if !ops::names().any(|known| known == name) {
            return Err(self.unknown(name));
        }
        if said.count.is_some() {
            return Err(format!("{name} takes no count: leave it out"));
        }
        let words = words(&format!("{name} {}", said.text))?;
        state.ask(Effect::Run(words));
        Ok(())
    }
}
