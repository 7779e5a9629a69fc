//! One file per subcommand: its arguments and its function, used by the command line and by the editor's `:`.
//! [`Command`] is the only list of them.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::{FromArgMatches, Subcommand};

use crate::base::error::{Error, Result};
use crate::base::text::printable;
use crate::files;
use crate::scene::Document;

pub mod attach;
pub mod check;
pub mod command_line;
pub mod completions;
pub mod demo;
pub mod edit;
pub mod field;
pub mod get;
pub mod lines;
pub mod man;
pub mod measure;
pub mod new;
pub mod opened;
pub mod probe;
pub mod profile;
pub mod render;
pub mod scene_options;
pub mod schema;
pub mod set;
pub mod sprites;
pub mod style;
pub mod synth;
pub mod tutor;
#[cfg(feature = "window")]
pub mod view;
pub mod views;
mod watched;
mod writing;

/// What `plica` can be asked to do.
#[derive(clap::Subcommand)]
#[allow(missing_docs, reason = "the comment on its arguments is the help of a subcommand")]
pub enum Command {
    Demo(demo::Args),
    New(new::Args),
    Edit(edit::Args),
    Tutor(tutor::Args),
    Set(set::Args),
    Profile(profile::Args),
    Style(style::Args),
    Get(get::Args),
    Check(check::Args),
    Probe(probe::Args),
    Measure(measure::Args),
    Lines(lines::Args),
    Sprites(sprites::Args),
    Views(views::Args),
    Render(render::Args),
    Synth(synth::Args),
    #[cfg(feature = "window")]
    View(view::Args),
    Attach(attach::Args),
    Field(field::Args),
    Schema(schema::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Command {
    /// Runs the subcommand.
    pub fn run(self, context: &mut Context) -> Result<()> {
        match self {
            Command::Demo(args) => demo::run(args, context),
            Command::New(args) => new::run(args, context),
            Command::Edit(_) => Err(Error::Usage("edit opens a terminal of its own: here :e opens a scene".into())),
            Command::Tutor(_) => Err(Error::Usage("tutor opens a terminal of its own".into())),
            Command::Set(args) => set::run(args, context),
            Command::Profile(args) => profile::run(args, context),
            Command::Style(args) => style::run(args, context),
            Command::Get(args) => get::run(args, context),
            Command::Check(args) => check::run(args, context),
            Command::Probe(args) => probe::run(args, context),
            Command::Measure(args) => measure::run(args, context),
            Command::Lines(args) => lines::run(args, context),
            Command::Sprites(args) => sprites::run(args, context),
            Command::Views(args) => views::run(args, context),
            Command::Render(args) => render::run(args, context),
            Command::Synth(args) => synth::run(args, context),
            Command::Field(args) => field::run(args, context),
            Command::Schema(args) => schema::run(args, context),
            Command::Completions(args) => completions::run(args, context),
            Command::Man(args) => man::run(args, context),
            Command::Attach(args) => attach::run(args, context),
            #[cfg(feature = "window")]
            Command::View(args) => view::run(args, context),
        }
    }
}

/// The names of all subcommands.
pub fn names() -> impl Iterator<Item = String> {
    let table = Command::augment_subcommands(clap::Command::new("plica"));
    table.get_subcommands().map(|one| one.get_name().to_owned()).collect::<Vec<_>>().into_iter()
}

/// Parses `words`, the subcommand's name first, as on the command line.
///
/// # Errors
/// If the words are wrong; the message says how.
pub fn parse(words: &[String]) -> Result<Command> {
    let table = Command::augment_subcommands(clap::Command::new("plica").no_binary_name(true));
    let usage = |error: clap::Error| {
        let text = error.to_string();
        let told = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let told = told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more information"));
        Error::Usage(told.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned())
    };
    table.try_get_matches_from(words).and_then(|found| Command::from_arg_matches(&found)).map_err(usage)
}

/// What `--help` prints about a subcommand; `None` if there is no such subcommand.
pub fn help(name: &str) -> Option<String> {
    let mut table = Command::augment_subcommands(clap::Command::new("plica"));
    table.build();
    Some(table.find_subcommand_mut(name)?.render_long_help().to_string())
}

/// A scene that an editor has open: a subcommand that reads this file gets the scene as it is in the editor, with
/// unsaved edits.
#[derive(Clone)]
pub struct Open {
    /// Its file.
    pub path: PathBuf,
    /// The scene.
    pub document: Document,
}

/// What a subcommand gets besides its arguments: where data and messages go, and the flag that cancels it.
pub struct Context {
    /// Data: standard output, or a buffer in the editor and in tests.
    pub out: Box<dyn Write + Send>,
    /// Messages and progress: standard error, or the editor's status line.
    pub messages: Box<dyn Progress>,
    /// Set by a signal or by Esc; long work looks at it between frames and files and ends with [`Error::Interrupted`].
    pub cancel: Arc<AtomicBool>,
    /// The scene that the editor has open; `None` on the command line.
    pub open: Option<Open>,
}

/// Where messages and the progress of long work go.
pub trait Progress: Send {
    /// Shows one line.
    fn say(&mut self, line: &str);
    /// Shows that `done` of `total` steps of `what` are done; called often, shown as often as makes sense.
    fn step(&mut self, what: &str, done: u64, total: u64);
}

impl Context {
    /// That of the command line: standard output and standard error.
    pub fn process(cancel: Arc<AtomicBool>) -> Self {
        let messages = Box::new(Stderr { tty: std::io::stderr().is_terminal(), begun: None, shown: None });
        Context { out: Box::new(std::io::stdout()), messages, cancel, open: None }
    }

    /// The scene at `path`: as the editor has it if it is open there, otherwise from the file.
    ///
    /// # Errors
    /// As [`files::scene::open`].
    pub fn document(&self, path: &Path, options: &files::Options) -> Result<Document> {
        match &self.open {
            Some(open) if open.path == path => Ok(open.document.clone()),
            _ => files::scene::open(path, options),
        }
    }

    /// Ends the work with [`Error::Interrupted`] once cancelled.
    pub fn check_cancelled(&self) -> Result<()> {
        if self.cancel.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Writes `text` and a line end to the data output.
    pub fn print(&mut self, text: impl std::fmt::Display) -> Result<()> {
        writeln!(self.out, "{text}").map_err(|e| files::write::failed("standard output", &e))
    }
}

/// Messages on standard error; progress only if it is a terminal.
struct Stderr {
    tty: bool,
    /// When the work in progress began.
    begun: Option<Instant>,
    /// When its line was last written; `None` while there is no such line.
    shown: Option<Instant>,
}

impl Progress for Stderr {
    fn say(&mut self, line: &str) {
        let clear = if self.shown.take().is_some() { "\r\x1b[K" } else { "" };
        // A terminal that has gone away is no reason to fail.
        let _ = writeln!(std::io::stderr(), "{clear}{}", printable(line));
    }

    fn step(&mut self, what: &str, done: u64, total: u64) {
        let begun = *self.begun.get_or_insert_with(Instant::now);
        let due = self.shown.is_none_or(|at| at.elapsed().as_millis() >= 100);
        if self.tty && (due || done == total) {
            let end = if done == total { "\n" } else { "" };
            let left = left(begun.elapsed(), done, total);
            let _ = write!(std::io::stderr(), "\r\x1b[K{} {done}/{total}{left}{end}", printable(what));
            self.shown = Some(Instant::now());
        }
        if done == total {
            (self.begun, self.shown) = (None, None);
        }
    }
}

/// How long the rest will take, as text, once that can be estimated.
pub fn left(spent: Duration, done: u64, total: u64) -> String {
    if done == 0 || done >= total || spent.as_millis() < 500 {
        return String::new();
    }
    let secs = (spent.as_secs_f64() / done as f64 * (total - done) as f64).ceil() as u64;
    match secs {
        0..60 => format!(", {secs} s left"),
        60..3600 => format!(", {} min {} s left", secs / 60, secs % 60),
        _ => format!(", {} h {} min left", secs / 3600, secs / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_told_once_it_can_be() {
        for (millis, done, total, text) in [
            (100, 1, 10, ""),
            (1000, 0, 10, ""),
            (1000, 10, 10, ""),
            (1000, 5, 10, ", 1 s left"),
            (10_000, 1, 10, ", 1 min 30 s left"),
            (10_000, 1, 1000, ", 2 h 46 min left"),
        ] {
            assert_eq!(left(Duration::from_millis(millis), done, total), text, "{millis} {done}/{total}");
        }
    }

    #[test]
    fn words_are_parsed_as_on_the_command_line() {
        assert!(names().any(|name| name == "schema"));
        assert!(matches!(parse(&["schema".into()]), Ok(Command::Schema(_))));
        let wrong = parse(&["schema".into(), "--no-such".into()]).err().unwrap();
        assert!(matches!(&wrong, Error::Usage(text) if text.contains("--no-such") && !text.contains('\n')), "{wrong}");
    }
}
