//! What a subcommand gets besides its arguments.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::base::error::{Error, Result};
use crate::base::text::printable;
use crate::files;
use crate::scene::Document;

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
}
