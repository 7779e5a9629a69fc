//! Scripts: files of lines that the editor runs one after the other, as if they were typed after `:`. They run between
//! events, so that keys never wait for a long one; a mistake in it ends it. Without a screen they are all there is.

use std::path::Path;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::runner::Editor;
use super::terminal;
use crate::base::error::{Error, Result};
use crate::files::lines;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::events::Event;
use crate::tui::state::{Message, Mode};

/// Scripts that run scripts, at most.
const DEEPEST: usize = 16;
/// How long lines are run before the screen and the keys have their turn.
const TURN: Duration = Duration::from_millis(20);
/// How long to wait for an event before looking again.
const PATIENCE: Duration = Duration::from_secs(1);

/// The scripts that run, the innermost last.
#[derive(Debug, Default)]
pub struct Scripts {
    running: Vec<Script>,
    /// The line whose work still runs.
    waits: Option<String>,
}

#[derive(Debug)]
struct Script {
    file: String,
    lines: Vec<String>,
    next: usize,
}

impl Scripts {
    /// Begins a script; what runs now goes on after it.
    ///
    /// # Errors
    /// Where scripts run one another without an end.
    pub fn begin(&mut self, file: &str, text: &str) -> Result<()> {
        if self.running.len() >= DEEPEST {
            let what = format!("there are {DEEPEST} scripts inside one another already");
            return Err(Error::at(file, what).cure("let none of them run itself"));
        }
        self.running.push(Script { file: file.into(), lines: text.lines().map(str::to_owned).collect(), next: 0 });
        Ok(())
    }

    /// The next line, and its place as FILE:LINE. Comments (`#`) and blank lines are none.
    pub fn next(&mut self) -> Option<(String, String)> {
        while let Some(script) = self.running.last_mut() {
            while let Some(line) = script.lines.get(script.next) {
                script.next += 1;
                let line = line.trim();
                if !line.is_empty() && !line.starts_with('#') {
                    return Some((format!("{}:{}", script.file, script.next), line.to_owned()));
                }
            }
            self.running.pop();
        }
        None
    }

    /// Whether nothing is left to run.
    pub fn is_empty(&self) -> bool {
        self.running.is_empty() && self.waits.is_none()
    }
}

impl Editor {
    /// Begins the script of a file.
    ///
    /// # Errors
    /// It cannot be read, or scripts run one another without an end.
    pub fn source(&mut self, path: &Path) -> Result<()> {
        let text = lines::read(path)?;
        self.scripts.begin(&path.display().to_string(), &text)
    }

    /// Runs a line as if it was typed.
    ///
    /// # Errors
    /// What was said where it could not be done.
    pub fn obey(&mut self, line: String) -> std::result::Result<(), String> {
        self.take(Event::Line(line));
        self.refused()
    }

    fn refused(&self) -> std::result::Result<(), String> {
        match &self.state.message {
            Some(Message { text, bad: true }) => Err(text.clone()),
            _ => Ok(()),
        }
    }

    /// Runs the next line of the scripts; the work that the one before began is waited for. A mistake ends all of them.
    /// False where there is nothing to run now.
    ///
    /// # Errors
    /// FILE:LINE and the mistake.
    fn run_next(&mut self) -> Result<bool> {
        if self.state.seen.work.is_some() || self.leaving {
            return Ok(false);
        }
        let (place, done) = match self.scripts.waits.take() {
            Some(place) => (place, self.refused()),
            None => match self.scripts.next() {
                Some((place, line)) => (place, self.obey(line)),
                None => return Ok(false),
            },
        };
        if let Err(why) = done {
            self.scripts = Scripts::default();
            return Err(Error::at(place, why).cure("nothing after it was run"));
        }
        self.scripts.waits = self.state.seen.work.is_some().then_some(place);
        Ok(true)
    }

    /// Runs the scripts for a short while; says where there is a mistake.
    pub fn run_scripts(&mut self) {
        let begun = Instant::now();
        while begun.elapsed() < TURN {
            match self.run_next() {
                Ok(true) => {}
                Ok(false) => return,
                Err(error) => return self.state.complain(error.to_string()),
            }
        }
    }

    /// Runs the scripts without a screen; what lines say is printed.
    ///
    /// # Errors
    /// The first mistake.
    pub fn run_unseen(mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        let result = self.refuse_undecided().and_then(|()| self.run_all(events));
        let unsaved = !self.leaving && !self.state.door.is_saved();
        let left = unsaved.then(|| self.state.door.left_unsaved());
        self.end();
        self.ended()?;
        match (result, left) {
            (Ok(()), Some(left)) => {
                Err(Error::at("the script", format!("ends, and {left}")).cure("w saves them, q! gives them up"))
            }
            (Err(error), Some(left)) => {
                terminal::remark(&left);
                Err(error)
            }
            (result, None) => result,
        }
    }

    /// A script does not run on a scene of which nobody has said what it is.
    fn refuse_undecided(&self) -> Result<()> {
        let Some(offer) = self.state.door.offered() else { return Ok(()) };
        let what = format!("{} left behind, and the script is not run", offer.in_words());
        Err(Error::at(self.state.door.path().display(), what)
            .cure("--after-recovery keep takes them, drop leaves them; plica edit shows them"))
    }

    fn run_all(&mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        while !self.leaving && !self.scripts.is_empty() {
            self.state.door.tend();
            let ran = self.run_next()?;
            self.said().iter().for_each(|line| terminal::print(line));
            let patience = if ran { Duration::ZERO } else { PATIENCE };
            for event in events.recv_timeout(patience).into_iter().chain(events.try_iter()) {
                self.take(event);
            }
        }
        Ok(())
    }

    /// What the last line said, which is forgotten by it.
    pub fn said(&mut self) -> Vec<String> {
        let pages = match std::mem::replace(&mut self.state.mode, Mode::Normal) {
            Mode::Pages(pages) => pages.lines,
            Mode::Choice(Choice { options, then: Then::Go, .. }) => {
                options.into_iter().map(|(place, text)| format!("{place}: {text}")).collect()
            }
            mode => {
                self.state.mode = mode;
                Vec::new()
            }
        };
        self.state.message.take().into_iter().map(|message| message.text).chain(pages).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_with_their_places() {
        let mut scripts = Scripts::default();
        scripts.begin("a", "# first\n\n  move down \nput 5\n").unwrap();
        let place = |scripts: &mut Scripts| scripts.next().map(|(place, line)| format!("{place} {line}"));
        assert_eq!(place(&mut scripts).as_deref(), Some("a:3 move down"));
        scripts.begin("b", "undo").unwrap();
        assert_eq!(place(&mut scripts).as_deref(), Some("b:1 undo"));
        assert_eq!(place(&mut scripts).as_deref(), Some("a:4 put 5"));
        assert_eq!(place(&mut scripts), None);
        assert!(scripts.is_empty());
    }

    #[test]
    fn a_script_that_runs_itself_ends() {
        let mut scripts = Scripts::default();
        let begun = (0..100).take_while(|_| scripts.begin("a", "source a").is_ok()).count();
        assert_eq!(begun, DEEPEST);
    }
}
