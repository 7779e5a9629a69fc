//! What was run, and who listens: every line that the editor runs passes one door (`commands::obey`) and is told here. The
//! log of the session keeps all of them, so that they lead to the same scene again; a macro keeps what the person asked for;
//! `.` keeps the last change. Typing, choosing and the help are not kept, but what came of them is: `put *1.1`.

use std::path::{Path, PathBuf};

/// What is kept of a command that was run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// Its line.
    Line,
    /// Its line, which `.` repeats: it changes the scene.
    Change,
    /// Its line together with the one that asked: it answers a list of choices.
    Answer,
    /// Only the lines that it runs itself, if any: typing, asking, the help.
    Inside,
}

/// How a line ended.
pub struct Ended<'a> {
    /// The line, with its count.
    pub line: String,
    /// What is kept of its command.
    pub kept: Kept,
    /// What was said where it could not be done.
    pub refused: Option<&'a str>,
    /// Whether it began to ask for something: an entry or a list of choices is open, which was not before.
    pub asks: bool,
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
    /// Commands running now of which the line is kept: what they run is part of them.
    within: usize,
}

impl Recorder {
    /// A command begins.
    pub fn begin(&mut self, kept: Kept) {
        match kept {
            Kept::Inside => {}
            Kept::Line | Kept::Change | Kept::Answer => self.within += 1,
        }
    }

    /// A command that began has ended.
    pub fn end(&mut self, ended: Ended) {
        match ended.kept {
            Kept::Inside => return,
            Kept::Line | Kept::Change | Kept::Answer => self.within -= 1,
        }
        if self.within > 0 {
            return;
        }
        let Ended { line, kept, refused, asks } = ended;
        if let Some(why) = refused {
            self.log.push(format!("# {}", super::terminal::plain(&format!("{line}: {why}"))));
            return;
        }
        match kept {
            _ if asks => self.asked = Some(line),
            _ => {
                let asked = self.asked.take().filter(|_| kept == Kept::Answer);
                let lines: Vec<String> = asked.into_iter().chain([line]).collect();
                self.log.extend_from_slice(&lines);
            }
        }
    }

    /// A remark for whoever reads the log.
    pub fn remark(&mut self, text: &str) {
        self.log.push(format!("# {}", super::terminal::plain(text)));
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

    /// The file that the log is written to; none where it is not.
    pub fn place(&self) -> Option<&Path> {
        self.place.as_deref()
    }

    /// The log is written to this file, or to none any more.
    pub fn set_place(&mut self, place: Option<PathBuf>) {
        self.place = place;
    }
}
