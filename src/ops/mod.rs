//! One file a subcommand: its arguments and its function, used by the command line and by the editor's `:`.
//! [`Command`] is the only list of them.

use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::base::error::{Error, Result};
use crate::base::text::printable;

pub mod check;
pub mod command_line;
pub mod completions;
pub mod get;
pub mod man;
pub mod new;
pub mod opened;
pub mod probe;
pub mod scene_options;
pub mod schema;
pub mod set;

/// What `plica` can be asked to do.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Make a scene of pictures
    New(new::Args),
    /// Set values in a scene
    Set(set::Args),
    /// Print a value of a scene
    Get(get::Args),
    /// Find every problem of a scene
    Check(check::Args),
    /// Tell what a pixel does at a time, and why
    Probe(probe::Args),
    /// Print the JSON Schema of a scene
    Schema(schema::Args),
    /// Print a shell's completions
    Completions(completions::Args),
    /// Print the manual
    Man(man::Args),
}

impl Command {
    /// Does it.
    pub fn run(self, context: &mut Context) -> Result<()> {
        match self {
            Command::New(args) => new::run(args, context),
            Command::Set(args) => set::run(args, context),
            Command::Get(args) => get::run(args, context),
            Command::Check(args) => check::run(args, context),
            Command::Probe(args) => probe::run(args, context),
            Command::Schema(args) => schema::run(args, context),
            Command::Completions(args) => completions::run(args, context),
            Command::Man(args) => man::run(args, context),
        }
    }
}

/// What a subcommand is given besides its arguments: where data and messages go, and the wish to stop.
pub struct Context {
    /// Data: standard output, or a buffer in the editor and in tests.
    pub out: Box<dyn Write + Send>,
    /// Messages and progress: standard error, or the editor's status line.
    pub messages: Box<dyn Progress>,
    /// Set by a signal or by Esc; long work looks at it between frames and files and ends with [`Error::Interrupted`].
    pub cancel: Arc<AtomicBool>,
}

/// Where messages and the progress of long work go.
pub trait Progress: Send {
    /// One line for the person.
    fn say(&mut self, line: &str);
    /// `done` of `total` steps of `what`; called often, shown as often as it makes sense.
    fn step(&mut self, what: &str, done: u64, total: u64);
}

impl Context {
    /// The command line's own: standard output and standard error.
    pub fn process(cancel: Arc<AtomicBool>) -> Self {
        let messages = Box::new(Stderr { tty: std::io::stderr().is_terminal(), shown: None });
        Context { out: Box::new(std::io::stdout()), messages, cancel }
    }

    /// Ends the work with [`Error::Interrupted`] once cancelled.
    pub fn check_cancelled(&self) -> Result<()> {
        if self.cancel.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Writes `text` and a line end to where data goes.
    pub fn print(&mut self, text: impl std::fmt::Display) -> Result<()> {
        writeln!(self.out, "{text}").map_err(|e| Error::at("standard output", e))
    }
}

/// Messages on standard error; progress there only where a person looks.
struct Stderr {
    tty: bool,
    shown: Option<std::time::Instant>,
}

impl Progress for Stderr {
    fn say(&mut self, line: &str) {
        // A terminal that went away is no reason to fail.
        let _ = writeln!(std::io::stderr(), "{}", printable(line));
    }

    fn step(&mut self, what: &str, done: u64, total: u64) {
        let due = self.shown.is_none_or(|at| at.elapsed().as_millis() >= 100);
        if self.tty && (due || done == total) {
            self.shown = Some(std::time::Instant::now());
            let end = if done == total { "\n" } else { "" };
            let _ = write!(std::io::stderr(), "\r\x1b[K{} {done}/{total}{end}", printable(what));
        }
    }
}
