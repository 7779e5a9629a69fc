//! Records the lines that are run: every one goes through `commands::obey`, which reports it here. The log of the session has
//! all of them, so that running it again leads to the same scene; a macro has what the person asked for; `.` repeats the last
//! change. Typing, choosing and the help are not recorded, but their result is: `put *1.1`.

use crate::tui::text::plain;
use crate::tui::text::wrap::clipped;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::scene::{Document, json};

/// How deep macros may play macros.
const DEEPEST: usize = 50;
/// The most lines that one key may play, so that keys never wait for long.
const MOST_PLAYED: usize = if cfg!(test) { 300 } else { 10_000 };

/// The most characters of a refused line that the log keeps: a table may have come with it.
const LONGEST_REFUSED: usize = 400;

/// The most bytes of scenes that the lines of one key may change, in total: on a large scene each line takes longer.
const MOST_CHANGED: u64 = 16 << 30;

/// Limits what the lines played by one key do.
#[derive(Clone, Debug, Default)]
pub struct WorkLimit {
    lines: usize,
    bytes: u64,
}

impl WorkLimit {
    /// Counts a line that is about to change `document`.
    ///
    /// # Errors
    /// It would be one too many.
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
    /// Its line, which `.` repeats if it changed the scene.
    Change,
    /// Its line together with the one that opened the list of choices, which this one answers.
    Answer,
    /// Only the lines that it runs itself, if any. For typing, choosing and the help.
    Inside,
    /// The lines that it runs; but in a macro its own line.
    Played,
}

/// How a line ended.
pub struct Ended<'a> {
    /// The line, with its count.
    pub line: String,
    /// What the recorder notes of its command.
    pub recorded: Recorded,
    /// Why it could not be done.
    pub refused: Option<&'a str>,
    /// Whether it opened an entry, a command line or a list of choices.
    pub asks: bool,
    /// Whether it changed the scene.
    pub changed: bool,
}

/// The log, macros and the last change.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// The log of the session: lines as in a script, with refused ones as comments.
    log: Vec<String>,
    /// How many of its lines were handed out to be written.
    written: usize,
    /// So many lines at its beginning are only worth writing once others follow.
    preface: usize,
    /// The file that the log is written to.
    place: Option<PathBuf>,
    /// The line that opened an entry or a list, until it is answered.
    asked: Option<String>,
    /// The lines that `.` runs.
    change: Vec<String>,
    /// Macros by their letters.
    macros: BTreeMap<char, Vec<String>>,
    /// The macro being recorded.
    recording: Option<(char, Vec<String>)>,
    /// The macro played last.
    played: Option<char>,
    /// How many running commands play other lines.
    playing: usize,
    /// What these lines have done so far.
    spent: WorkLimit,
    /// How many running commands have their own line recorded: the lines that they run are part of it.
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
            self.log.push(format!("# {}", plain(&format!("{}: {why}", clipped(&line, LONGEST_REFUSED)))));
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

    /// A macro has the lines that were asked for, not those that they play.
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
    /// There is no such macro, or macros play one another endlessly.
    pub fn play(&mut self, letter: char) -> Result<Vec<String>, String> {
        let lines = self.macros.get(&letter);
        let lines = lines.ok_or_else(|| format!("there is no macro {letter}: q{letter} records one"))?;
        if self.playing > DEEPEST {
            return Err(format!("macros play one another {DEEPEST} deep: one of them plays itself"));
        }
        self.played = Some(letter);
        Ok(lines.clone())
    }

    /// Takes the macros of an earlier session.
    pub fn recall(&mut self, macros: BTreeMap<char, Vec<String>>) {
        self.macros = macros;
    }

    /// All macros.
    pub fn macros(&self) -> &BTreeMap<char, Vec<String>> {
        &self.macros
    }

    /// Counts a line that is about to be played.
    ///
    /// # Errors
    /// It would be one too many.
    pub fn spend(&mut self, document: &Document) -> Result<(), String> {
        self.spent.spend(document)
    }

    /// The lines that `.` runs.
    pub fn change(&self) -> &[String] {
        &self.change
    }

    /// Adds a comment to the log.
    pub fn remark(&mut self, text: &str) {
        self.log.push(format!("# {}", plain(text)));
    }

    /// Adds a line to the log that the line after it needs.
    pub fn note(&mut self, line: String) {
        self.log.push(line);
    }

    /// All lines so far only lead to where the session begins.
    pub fn end_preface(&mut self) {
        self.preface = self.log.len();
    }

    /// The log of the session.
    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// The lines that were added since the last call.
    pub fn unwritten(&mut self) -> &[String] {
        if self.log.len() <= self.preface {
            return &[];
        }
        let from = std::mem::replace(&mut self.written, self.log.len());
        &self.log[from..]
    }

    /// The file that the log is written to; `None` if it is not.
    pub fn place(&self) -> Option<&Path> {
        self.place.as_deref()
    }

    /// Sets the file that the log is written to.
    pub fn set_place(&mut self, place: Option<PathBuf>) {
        self.place = place;
    }
}
