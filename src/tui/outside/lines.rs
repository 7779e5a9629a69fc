//! The line mode, for a terminal that cannot draw (TERM=dumb) or without a terminal. The commands that are otherwise typed
//! after `:` come from standard input; answers go to standard output as plain text, mistakes to standard error with the
//! number of the line, and without a person the first of them ends the session. Long work runs in the foreground.

use crate::tui::text::plain;
use crate::tui::text::said::quoted;
use std::io::{BufRead, Read, Write, stdin, stdout};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::editor::Editor;
use super::terminal;
use crate::base::error::{Error, Result};
use crate::scene::address;
use crate::tui::commands;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::events::Event;
use crate::tui::state::{Mode, Pane, State};

/// The most bytes of a line.
const LONGEST: u64 = 1 << 20;
/// How often progress is printed.
const TELL_EVERY: Duration = Duration::from_secs(1);
/// How long to wait for an event before looking again.
const PATIENCE: Duration = Duration::from_secs(1);

/// How the lines went so far.
#[derive(Default)]
struct Session {
    interactive: bool,
    /// How many lines were read.
    number: usize,
    /// The line that was refused: without a person, nothing after it is run.
    refused: Option<usize>,
    /// Whether the input has ended once while there were unsaved edits.
    warned: bool,
    /// What happens to unsaved edits at the end of the input.
    left: Option<String>,
    /// The last message on why edits do not reach the journal.
    failing: Option<String>,
    /// A line that waits for what is shown.
    held: Option<String>,
    /// The last progress that was printed, and when.
    told: Option<(String, Instant)>,
}

impl Editor {
    /// Runs the lines of standard input until one leaves, or until they end.
    ///
    /// # Errors
    /// A line was refused, and no person was there to see it.
    pub fn run_lines(mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        let interactive = terminal::is_interactive();
        let mut session = Session { interactive, ..Session::default() };
        if let Some(aside) = self.state.scene.kept_aside() {
            let what = "the journal was damaged; what could not be read is in";
            terminal::remark(&format!("{what} {}", plain(&aside.display().to_string())));
        }
        if interactive {
            terminal::print(&format!("{}  (? lists the commands, q leaves)", self.state.scene.path().display()));
        }
        self.state.message = None;
        let mut reading = false;
        while !self.leaving {
            self.run_scripts();
            self.answer(&mut session);
            self.state.scene.tend();
            session.see_journal(self.state.scene.failing());
            if let Some(line) = session.held.take() {
                self.typed(Some(line), &mut session);
            }
            let busy = self.state.outside.work.is_some() || !self.scripts.is_empty() || session.held.is_some();
            if !busy && !reading {
                session.prompt(&self.state);
                read_line(self.sender.clone());
                reading = true;
            }
            let patience = if self.scripts_go_on() { Duration::ZERO } else { PATIENCE };
            for event in events.recv_timeout(patience).into_iter().chain(events.try_iter()) {
                if let Event::Typed(line) = event {
                    reading = false;
                    self.typed(line, &mut session);
                } else {
                    self.take(event);
                }
            }
        }
        self.end();
        self.ended().and(session.result())
    }

    /// Handles a line of the input; `None` at its end.
    fn typed(&mut self, line: Option<String>, session: &mut Session) {
        let Some(line) = line else { return self.input_ended(session) };
        if self.awaits(&line) {
            session.held = Some(line);
            return;
        }
        session.number += 1;
        session.warned = false;
        let line = line.trim();
        let line = line.strip_prefix(':').unwrap_or(line).trim();
        if line.is_empty() || line.starts_with('#') {
            return;
        }
        match &self.state.typing.mode {
            Mode::Choice(choice) if choice.options.iter().any(|(word, _)| word == line) => {
                self.take(Event::Line(format!("choose {}", quoted(line))));
            }
            Mode::Choice(_) if line == "cancel" => self.state.typing.mode = Mode::Normal,
            _ if line == "?" || line == "help" => help().iter().for_each(|line| terminal::print(line)),
            _ => {
                if !line.starts_with("choose") && matches!(&self.state.typing.mode, Mode::Choice(_)) {
                    self.state.typing.mode = Mode::Normal;
                }
                let before = place(&self.state);
                self.take(Event::Line(line.to_owned()));
                // Without a screen nothing else shows where the cursor is now.
                let here = place(&self.state);
                if session.interactive && self.state.message.is_none() && here != before {
                    self.state.say(here);
                }
            }
        }
        self.answer(session);
    }

    /// Leaves at the end of the input; a person with unsaved edits has to end it twice.
    fn input_ended(&mut self, session: &mut Session) {
        let unsaved = !self.state.scene.is_saved();
        if unsaved && session.interactive && !session.warned {
            session.warned = true;
            return terminal::remark("there are unsaved edits: w saves them, q! leaves them");
        }
        session.left = unsaved.then(|| self.state.scene.left_unsaved());
        self.leaving = true;
    }

    /// Prints the messages of the last line.
    fn answer(&mut self, session: &mut Session) {
        let bad = self.state.message.as_ref().is_some_and(|message| message.bad);
        if bad {
            let text = self.state.message.take().map(|message| message.text).unwrap_or_default();
            if !session.interactive && session.number > 0 {
                session.refused = Some(session.number);
                session.left = (!self.state.scene.is_saved()).then(|| self.state.scene.left_unsaved());
                self.leaving = true;
            }
            let mut lines = text.lines();
            let first = lines.next().unwrap_or_default();
            match session.interactive {
                true => terminal::print(first),
                false => terminal::remark(&format!("line {}: {first}", session.number)),
            }
            lines.for_each(|line| if session.interactive { terminal::print(line) } else { terminal::remark(line) });
            // On a screen the same lines are pages.
            if let Mode::Pages(_) = self.state.typing.mode {
                self.state.typing.mode = Mode::Normal;
            }
        }
        self.said().iter().for_each(|line| terminal::print(line));
        session.tell(self.state.outside.work.as_deref());
    }
}

impl Session {
    /// Prints the open question and the prompt.
    fn prompt(&self, state: &State) {
        if let Mode::Choice(choice) = &state.typing.mode {
            let lines = question(choice);
            if self.interactive {
                lines.iter().for_each(|line| terminal::print(line));
            } else if matches!(choice.then, Then::Answer(_)) {
                lines.iter().for_each(|line| terminal::remark(line));
            }
        }
        if self.interactive {
            let unsaved = if state.scene.is_saved() { "" } else { "*" };
            let mut out = stdout();
            // A terminal that has gone away ends the input too.
            let _ = write!(out, "plica{unsaved}> ").and_then(|()| out.flush());
        }
    }

    /// Prints the progress of long work now and then.
    fn tell(&mut self, work: Option<&str>) {
        let Some(work) = work else {
            self.told = None;
            return;
        };
        let due = self.told.as_ref().is_none_or(|(told, at)| told != work && at.elapsed() >= TELL_EVERY);
        if due {
            terminal::remark(work);
            self.told = Some((work.to_owned(), Instant::now()));
        }
    }

    /// Says when edits stop reaching the journal, and when they reach it again.
    fn see_journal(&mut self, failing: Option<String>) {
        if failing != self.failing {
            match &failing {
                Some(why) => terminal::remark(&format!("no journal: {} (only what is saved is safe)", plain(why))),
                None => terminal::remark("the journal is written again"),
            }
            self.failing = failing;
        }
    }

    fn result(&self) -> Result<()> {
        let failed = self.refused.map(|line| format!("line {line} was refused, and nothing after it was run"));
        match (failed, &self.left) {
            (None, None) => Ok(()),
            (_, left) if self.interactive => {
                left.iter().for_each(|left| terminal::remark(left));
                Ok(())
            }
            (Some(failed), left) => {
                left.iter().for_each(|left| terminal::remark(left));
                Err(Error::at("standard input", failed))
            }
            (None, Some(left)) => Err(Error::at("standard input", left).cure("w saves them, q! gives them up")),
        }
    }
}

/// The address under the cursor, and the value there.
fn place(state: &State) -> String {
    let row = (state.cursor.focus != Pane::Tree).then(|| state.row()).flatten();
    let cell = row.as_ref().and_then(|row| state.cursor.cell(row));
    let Some((row, cell)) = row.as_ref().zip(cell) else {
        let node = address::told(state.document(), &state.cursor.node);
        return if node.is_empty() { "scene".into() } else { node };
    };
    let name = if cell.head.is_empty() || cell.head == row.label { String::new() } else { format!(" {}", cell.head) };
    format!("{}{name}: {}", address::told(state.document(), &row.pointer), cell.text)
}

/// A list of choices as lines.
fn question(choice: &Choice) -> Vec<String> {
    let text: &[String] = if let Then::Answer(question) = &choice.then { &question.text } else { &[] };
    let title = std::iter::once(format!("{}:", choice.title));
    let text = text.iter().map(|line| format!("  {line}"));
    let options = choice.options.iter().map(|(word, help)| format!("  {word:<12} {help}"));
    let all: Vec<String> = title.chain(text).chain(options).collect();
    all.into_iter().chain(["type one of these words, or cancel".into()]).collect()
}

/// Every command, as plain text.
fn help() -> Vec<String> {
    let commands = commands::all().map(|one| format!("{:<34} {}", format!("{} {}", one.name, one.args), one.help));
    let ops = commands::TABLE.subcommands().map(|name| format!("{name:<34} As `plica {name}` on this scene"));
    commands.chain(ops).collect()
}

/// Reads one line, on a thread of its own.
fn read_line(sender: mpsc::Sender<Event>) {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let read = stdin().lock().take(LONGEST).read_until(b'\n', &mut bytes);
        let line = read.ok().filter(|&n| n > 0).map(|_| String::from_utf8_lossy(&bytes).into_owned());
        // Nobody listens once the editor has left.
        let _ = sender.send(Event::Typed(line));
    });
}
