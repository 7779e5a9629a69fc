//! An open scene: document, history, journal and file change together.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use super::keeping::Keeping;
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::holder::{Holder, Sign};
use crate::files::journal::{self, Candidate, Kind, Unopened};
use crate::files::{Options, disk, hash, now_ms, scene, temporary, through};
use crate::scene::history::{Applied, Stamp, Way};
use crate::scene::{Document, Edit, History, json, layout};

/// So many earlier texts of a file are kept,
const MOST_KEPT: usize = 8;
/// if they have no more than so many bytes.
const LONGEST_KEPT: usize = 1 << 20;

/// What a session may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Edit and save; nobody else may edit meanwhile.
    Edit,
    /// The same, but read-only if somebody else is editing the scene already: see [`Session::held_by`].
    EditOrLook,
    /// Edit, even if another editor, whose lock cannot be checked from here, may have the scene open.
    TakeOver,
    /// Read-only, with edits at most in memory: no lock, no journal.
    ReadOnly,
}

impl Mode {
    fn edits(self) -> bool {
        self != Mode::ReadOnly
    }
}

/// Whether a save may replace what another program wrote meanwhile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// No: the save is refused.
    No,
    /// Yes: what the other program wrote is lost.
    Yes,
}

/// Unsaved edits left behind by a session that did not end properly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovery {
    /// How many changes there are.
    pub changes: usize,
    /// What they change in the file, in words.
    pub words: Vec<String>,
    /// When the last one was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether another program has changed the file since.
    pub file_changed: bool,
}

impl Recovery {
    /// `1 unsaved change was`, `3 unsaved changes were`.
    pub fn in_words(&self) -> String {
        match self.changes {
            1 => "1 unsaved change was".into(),
            many => format!("{many} unsaved changes were"),
        }
    }
}

/// How safe the current document is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Safety {
    /// Whether it is what was last written to the file.
    pub saved: bool,
    /// Whether every change is on the disk, in the journal.
    pub journaled: bool,
    /// Why changes do not reach the journal.
    pub failing: Option<String>,
}

/// An open scene.
#[derive(Debug)]
pub struct Session {
    pub(super) path: PathBuf,
    pub(super) options: Options,
    pub(super) mode: Mode,
    pub(super) history: History,
    pub(super) keeping: Keeping,
    pub(super) aside: Option<PathBuf>,
    /// SHA-256 of the file as last read or written.
    pub(super) file: String,
    /// The text of the file as last read or written: a save keeps its layout.
    pub(super) source: String,
    /// Texts that the file had earlier in this session, with what they mean: a save after undo has the same bytes again.
    pub(super) texts: VecDeque<(Document, String)>,
    pub(super) offer: Option<Offer>,
    /// The document in the file when it was last read or written; `None` if that is not known.
    pub(super) base: Option<Document>,
    /// Who edits the scene, so that we do not.
    pub(super) held_by: Option<Holder>,
    pub(super) _sign: Option<Sign>,
}

/// Unsaved edits that are offered, and what was known about the file when they were made.
#[derive(Debug)]
pub(super) struct Offer {
    pub(super) recovery: Recovery,
    pub(super) history: History,
    pub(super) file: String,
    pub(super) base: Option<Document>,
}

impl Session {
    /// Opens the scene at `path`, takes its lock and rebuilds its history from the journal. Unsaved edits of a session
    /// that did not end properly are not applied but offered: see [`Session::recovery`].
    ///
    /// # Errors
    /// If the scene cannot be read or contains errors, or another process is editing it. A journal that cannot be
    /// written is no error: [`Session::safety`] says why.
    pub fn open(path: &Path, options: &Options, mode: Mode) -> Result<Session> {
        // Nothing is created on the disk for a scene that cannot be opened.
        scene::open(path, options)?;
        let path = std::fs::canonicalize(path).map_err(|error| Error::at(path.display(), error))?;
        let (found, held_by) = claim(&path, mode)?;
        // With the lock no other Plica writes any more: this is the text that counts.
        if let Some(Ok(_)) = &found {
            through::mend(&path, scene::is_whole)?;
        }
        let text = scene::read_text(&path, &options.limits)?;
        let document = scene::parse(&path, &text, options)?;
        let mut session = Session {
            path,
            options: options.clone(),
            mode,
            history: History::new(document.clone()),
            keeping: Keeping::Nowhere,
            aside: None,
            file: hash::of(text.as_bytes()),
            offer: None,
            source: text,
            texts: VecDeque::new(),
            base: Some(document.clone()),
            held_by,
            _sign: None,
        };
        match found {
            Some(Ok(found)) => {
                temporary::remove_stale(disk::folder_of(&session.path));
                session._sign = Sign::put_up(&session.path);
                session.take_up(found, document);
            }
            Some(Err(error)) => session.keeping = Keeping::unfound(error.to_string(), document),
            None => session.mode = Mode::ReadOnly,
        }
        Ok(session)
    }

    /// The file, absolute and free of links.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The document as it is now.
    pub fn document(&self) -> &Document {
        self.history.document()
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Unsaved edits that are offered; until they are accepted or declined, the document is the file's.
    pub fn recovery(&self) -> Option<&Recovery> {
        self.offer.as_ref().map(|offer| &offer.recovery)
    }

    /// Who else edits the scene, so that it is read-only here.
    pub fn held_by(&self) -> Option<&Holder> {
        self.held_by.as_ref()
    }

    /// Whether the scene is read-only.
    pub fn reads_only(&self) -> bool {
        !self.mode.edits()
    }

    /// The file that bytes of a damaged journal were moved to.
    pub fn kept_aside(&self) -> Option<&Path> {
        self.aside.as_deref()
    }

    /// Accepts the unsaved edits that are offered. If another program has changed the file since, it is as if it had
    /// done so just now: see [`Session::take_in`].
    pub fn recover(&mut self) {
        let Some(offer) = self.offer.take() else { return };
        (self.history, self.file, self.base) = (offer.history, offer.file, offer.base);
    }

    /// Declines the unsaved edits that are offered; they are still in the undo history.
    pub fn discard_recovery(&mut self) {
        let Some(offer) = self.offer.take() else { return };
        let file = std::mem::replace(&mut self.history, offer.history).document().clone();
        self.enter(&file);
    }

    /// Refuses to change the document while unsaved edits are offered: which document to change is not decided yet.
    ///
    /// # Errors
    /// If there is an offer.
    pub fn refuse_undecided(&self) -> std::result::Result<(), Problem> {
        let Some(recovery) = self.recovery() else { return Ok(()) };
        let problem = Problem::error("", format!("{} left behind and wait for an answer", recovery.in_words()));
        Err(problem.hint("keep or drop them first"))
    }

    /// Applies an edit; if `held` (made by a key held down), it joins the step of the edit before it. `None` if it
    /// changes nothing.
    ///
    /// # Errors
    /// If the result would contain errors, or unsaved edits are offered; the document stays as it was.
    pub fn apply(&mut self, edit: Edit, held: bool) -> std::result::Result<Option<Applied>, Vec<Problem>> {
        self.refuse_undecided().map_err(|problem| vec![problem])?;
        self.tend();
        let applied = self.history.apply(edit, Stamp { time_ms: now_ms(), held })?;
        if let Some(applied) = &applied {
            self.record(Kind::Edit, applied);
        }
        Ok(applied)
    }

    /// Ends the step: a held key that follows begins a new one.
    pub fn close_step(&mut self) {
        self.history.close_step();
    }

    /// Undoes the last step; `None` if there is none, or unsaved edits are offered.
    pub fn undo(&mut self) -> Option<Applied> {
        self.refuse_undecided().ok()?;
        let applied = self.history.undo()?;
        self.record(Kind::Undo, &applied);
        Some(applied)
    }

    /// Redoes what was undone last; `None` if there is nothing, or unsaved edits are offered.
    pub fn redo(&mut self) -> Option<Applied> {
        self.refuse_undecided().ok()?;
        let applied = self.history.redo()?;
        self.record(Kind::Redo, &applied);
        Some(applied)
    }

    /// Moves through the history: to a state, or to a time. Does nothing if unsaved edits are offered.
    pub fn travel(&mut self, how: impl FnOnce(&mut History) -> Vec<(Way, Applied)>) -> Vec<(Way, Applied)> {
        if self.offer.is_some() {
            return Vec::new();
        }
        let all = how(&mut self.history);
        self.record_all(&all);
        all
    }

    /// Discards unsaved edits: the document is the file's again, and the next opening offers nothing. Undo still has
    /// them.
    pub fn give_up(&mut self) {
        if self.offer.is_some() || self.history.is_saved() {
            return;
        }
        if let Some(base) = self.base.clone().or_else(|| self.file_document()) {
            self.enter(&base);
        }
    }

    /// Writes the document to its file, atomically.
    ///
    /// # Errors
    /// If it cannot be written: then it is not saved, and stays as it is in memory. If another program changed the file
    /// meanwhile, unless it may be overwritten; if the session is read-only.
    pub fn save(&mut self, overwrite: Overwrite) -> Result<()> {
        let place = self.path.display();
        if self.reads_only() {
            return Err(Error::at(place, "is open to read only").cure("save a copy under another name"));
        }
        self.refuse_undecided().map_err(|problem| Error::at(place, problem))?;
        if overwrite == Overwrite::No {
            self.may_overwrite().map_err(|error| error.cure("take its changes in, or overwrite it"))?;
            self.refuse_protected()?;
        }
        // The journal first: if we are killed in between, it explains the new file. If edits do not reach the journal,
        // saving is all the more urgent.
        self.tend();
        if let Err(reason) = self.keeping.flush() {
            tracing::warn!("saving without a journal: {reason}");
        }
        let text = self.text();
        let ours = hash::of(text.as_bytes());
        if let Err(error) = scene::save(&self.path, &text) {
            // The file may be written without being safe on the disk: it is ours all the same.
            if self.file_holds(&ours) {
                self.file = ours;
            }
            return Err(error);
        }
        let source = std::mem::replace(&mut self.source, text);
        let before = self.base.replace(self.document().clone()).filter(|_| source.len() <= LONGEST_KEPT);
        self.texts.extend(before.map(|before| (before, source)));
        if self.texts.len() > MOST_KEPT {
            self.texts.pop_front();
        }
        self.file = ours;
        self.now_saved(true);
        Ok(())
    }

    /// The text that a save writes: what has not changed since the file was read keeps its layout, and what comes back
    /// has the one that it had.
    pub fn text(&self) -> String {
        let now = self.document().json();
        let is_now = |document: &Document| json::same(document.json(), now);
        let known = self.texts.iter().filter(|_| !self.base.as_ref().is_some_and(is_now));
        let known = known.rev().find(|(document, _)| is_now(document));
        known.map_or_else(|| layout::rewrite(&self.source, now), |(_, text)| text.clone())
    }

    /// How safe the current document is.
    pub fn safety(&self) -> Safety {
        let failing = self.keeping.failing();
        let revision = self.history.revision();
        let journaled = self.offer.is_some() || self.keeping.journal().is_some_and(|j| j.acknowledged() >= revision);
        Safety { saved: self.history.is_saved(), journaled, failing }
    }

    /// Waits until every change is in the journal.
    ///
    /// # Errors
    /// Why they are not.
    pub fn flush(&self) -> std::result::Result<(), String> {
        self.keeping.flush()
    }
}

/// A journal, or why there is none.
type Claimed = std::io::Result<Candidate>;

/// Finds and locks the journal of the scene at `path`; `None` if the session is read-only, then perhaps with who holds
/// the scene.
fn claim(path: &Path, mode: Mode) -> Result<(Option<Claimed>, Option<Holder>)> {
    if !mode.edits() {
        return Ok((None, None));
    }
    let holder = match journal::find(path) {
        Err(Unopened::Locked { pid }) => Holder::of_lock(path, pid),
        Err(Unopened::Failed(error)) => return Ok((Some(Err(error)), None)),
        Ok(found) => match Holder::unseen(path, found.path()).filter(|_| mode != Mode::TakeOver) {
            None => return Ok((Some(Ok(found)), None)),
            Some(holder) => {
                found.leave();
                holder
            }
        },
    };
    if mode == Mode::EditOrLook { Ok((None, Some(holder))) } else { Err(held(path, &holder)) }
}

fn held(path: &Path, holder: &Holder) -> Error {
    let error = Error::at(path.display(), holder.in_words());
    error.cure("close it there first, or open it to read only")
}
