//! What was run: every line that the editor runs goes through `commands::obey`, which reports it here. The
//! log of the session keeps all of them, so that they lead to the same scene again; a macro keeps what the person asked for;
//! `.` keeps the last change. Typing, choosing and the help are not kept, but what came of them is: `put *1.1`.

use crate::tui::text::plain;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::scene::{Document, json};

/// Macros that play macros, at most.
const DEEPEST: usize = 50;
/// Lines that one key plays, at most: keys never wait for long.
const MOST_PLAYED: usize = if cfg!(test) { 300 } else { 10_000 };

/// Bytes of scenes that the lines of one key change, at most, in sum: on a large scene each line takes longer.
const MOST_CHANGED: u64 = 16 << 30;

/// How much the lines that one key plays have done.
#[derive(Clone, Debug, Default)]
pub struct WorkLimit {
    lines: usize,
    bytes: u64,
}

impl WorkLimit {
    /// A line is about to change `document`.
    ///
    /// # Errors
    /// There were too many.
    pub fn spend(&mut self, document: &Document) -> Result<(), String> {
        if self.lines == MOST_PLAYED || self.bytes > MOST_CHANGED {
            return Err(format!("stopped after {} lines", self.lines));
        }
        self.lines += 1;
        self.bytes += json::bytes(document.json());
        Ok(())
    }
}

/// What the recorder notes of a command that was run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// Its line.
    Line,
    /// Its line, which `.` repeats where it changed the scene.
    Change,
    /// Its line together with the one that asked: it answers a list of choices.
    Answer,
    /// Only the lines that it runs itself, if any: typing, asking, the help.
    Inside,
    /// The lines that it runs; in a macro its own line.
    Played,
}

/// How a line ended.
pub struct Ended<'a> {
    /// The line, with its count.
    pub line: String,
    /// What the recorder notes of its command.
    pub recorded: Recorded,
    /// What was said where it could not be done.
    pub refused: Option<&'a str>,
    /// Whether it began to ask for something: an entry or a list of choices is open, which was not before.
    pub asks: bool,
    /// Whether the scene is another one.
    pub changed: bool,
}

/// Who listens to the lines.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// The log of the session: lines as a script has them, refused ones as comments.
    log: Vec<String>,
    /// How much of it was handed out to be written.
    written: usize,
    /// The file that it is written to.
    place: Option<PathBuf>,
    /// The line that began to ask, until it is answered.
    asked: Option<String>,
    /// The lines that `.` runs.
    change: Vec<String>,
    /// Macros by their letters.
    macros: BTreeMap<char, Vec<String>>,
    /// The macro being recorded.
    recording: Option<(char, Vec<String>)>,
    /// The macro played last.
    played: Option<char>,
    /// Commands running now that play other lines, and how many lines they have played.
    playing: usize,
    spent: WorkLimit,
    /// Commands running now of which the line is recorded: what they run is part of them.
    within: usize,
}

impl Recorder {
    /// A command begins.
    pub fn begin(&mut self, recorded: Recorded) {
        match recorded {
            Recorded::Inside => {}
            Recorded::Played => {
                if self.playing == 0 {
                    self.spent = WorkLimit::default();
                }
                self.playing += 1;
            }
            Recorded::Line | Recorded::Change | Recorded::Answer => self.within += 1,
        }
    }

    /// A command that began has ended.
    pub fn end(&mut self, ended: Ended) {
        match ended.recorded {
            Recorded::Inside => return,
            Recorded::Played => self.playing -= 1,
            Recorded::Line | Recorded::Change | Recorded::Answer => self.within -= 1,
        }
        if self.within > 0 {
            return;
        }
        let Ended { line, recorded, refused, asks, changed } = ended;
        if let Some(why) = refused {
            self.log.push(format!("# {}", plain(&format!("{line}: {why}"))));
            return;
        }
        match recorded {
            Recorded::Played => self.keep_in_macro(&[line]),
            _ if asks => self.asked = Some(line),
            _ => {
                let asked = self.asked.take().filter(|_| recorded == Recorded::Answer);
                let lines: Vec<String> = asked.into_iter().chain([line]).collect();
                self.keep_in_macro(&lines);
                self.log.extend_from_slice(&lines);
                if changed && matches!(recorded, Recorded::Change | Recorded::Answer) {
                    self.change = lines;
                }
            }
        }
    }

    /// A macro keeps what was asked for, not what that plays.
    fn keep_in_macro(&mut self, lines: &[String]) {
        if let (Some((_, kept)), 0) = (&mut self.recording, self.playing) {
            kept.extend_from_slice(lines);
        }
    }

    /// Begins to record a macro.
    pub fn begin_macro(&mut self, letter: char) {
        self.recording = Some((letter, Vec::new()));
    }

    /// Ends the recording: its letter, and how many lines it has. `None` if there is none.
    pub fn end_macro(&mut self) -> Option<(char, usize)> {
        let (letter, lines) = self.recording.take()?;
        let count = lines.len();
        self.macros.insert(letter, lines);
        Some((letter, count))
    }

    /// The macro being recorded.
    pub fn recording(&self) -> Option<char> {
        self.recording.as_ref().map(|(letter, _)| *letter)
    }

    /// The macro played last.
    pub fn played(&self) -> Option<char> {
        self.played
    }

    /// The lines of a macro, to be played now.
    ///
    /// # Errors
    /// There is no such macro, or macros play one another without an end.
    pub fn play(&mut self, letter: char) -> Result<Vec<String>, String> {
        let lines = self.macros.get(&letter);
        let lines = lines.ok_or_else(|| format!("there is no macro {letter}: q{letter} records one"))?;
        if self.playing > DEEPEST {
            return Err(format!("macros play one another {DEEPEST} deep: one of them plays itself"));
        }
        self.played = Some(letter);
        Ok(lines.clone())
    }

    /// A line is about to be played.
    ///
    /// # Errors
    /// There were too many.
    pub fn spend(&mut self, document: &Document) -> Result<(), String> {
        self.spent.spend(document)
    }

    /// The lines that `.` runs.
    pub fn change(&self) -> &[String] {
        &self.change
    }

    /// A remark for whoever reads the log.
    pub fn remark(&mut self, text: &str) {
        self.log.push(format!("# {}", plain(text)));
    }

    /// The log of the session.
    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// The lines that were added since this was asked last.
    pub fn unwritten(&mut self) -> &[String] {
        let from = std::mem::replace(&mut self.written, self.log.len());
        &self.log[from..]
    }

    /// The file that the log is written to; `None` if it is not.
    pub fn place(&self) -> Option<&Path> {
        self.place.as_deref()
    }

    /// The log is written to this file, or to none any more.
    pub fn set_place(&mut self, place: Option<PathBuf>) {
        self.place = place;
    }
}
