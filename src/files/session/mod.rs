//! A scene being edited: the one door for edits at run time. Document, history, journal and file change together here,
//! whoever asks: a key, a command, a script, `plica set`.

use std::path::{Path, PathBuf};

use super::holder::{Holder, Sign};
use super::journal::{self, Found, Header, Journal, Kind, Record, Unopened};
use super::recovery::{self, Replayed};
use super::{Options, disk, now_ms, scene, temporary};
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::scene::history::{Applied, Stamp};
use crate::scene::{Document, Edit, History, words};

mod outside;
#[cfg(test)]
mod tests;

pub use outside::Taken;

/// What a session may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Edit and save: nobody else may edit meanwhile.
    Edit,
    /// The same; where somebody else edits the scene already, look at it: see [`Session::held_by`].
    EditOrLook,
    /// Edit, also where somebody whose lock cannot be seen may do so too.
    TakeOver,
    /// Look, and edit in memory at most: no lock, no journal.
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
    /// It is refused.
    No,
    /// It is lost.
    Yes,
}

/// Unsaved edits that a session left behind which did not end well.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovery {
    /// How many changes.
    pub changes: usize,
    /// What they change in the file, in words.
    pub words: Vec<String>,
    /// When the last one was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether another program changed the file since.
    pub file_changed: bool,
}

/// How safe the present document is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Safety {
    /// It is what was last written to the file.
    pub saved: bool,
    /// Every change is on the disk, in the journal.
    pub journaled: bool,
    /// Why changes do not reach the journal.
    pub failing: Option<String>,
}

/// An open scene.
#[derive(Debug)]
pub struct Session {
    path: PathBuf,
    options: Options,
    mode: Mode,
    history: History,
    journal: Option<Journal>,
    /// Why there is no journal although there should be.
    journal_missing: Option<String>,
    aside: Option<PathBuf>,
    /// SHA-256 of the file as last read or written.
    file: String,
    /// Added to the history's steps, so that none is used twice in a journal.
    first_step: u64,
    offer: Option<Offer>,
    /// What the file held when it was last read or written; none where that is not known.
    base: Option<Document>,
    /// Who edits the scene instead of us.
    held_by: Option<Holder>,
    _sign: Option<Sign>,
}

/// Unsaved edits that are offered, and what was known of the file then.
#[derive(Debug)]
struct Offer {
    recovery: Recovery,
    history: History,
    file: String,
    base: Option<Document>,
}

impl Session {
    /// Opens the scene at `path`, takes its lock and rebuilds its history from the journal. Unsaved edits of a session
    /// that did not end well are not taken but offered: see [`Session::recovery`].
    ///
    /// # Errors
    /// When the scene cannot be read or has errors in it, or another process edits it. A journal that cannot be written
    /// is no error: [`Session::safety`] tells why.
    pub fn open(path: &Path, options: &Options, mode: Mode) -> Result<Session> {
        // Nothing is made on the disk for a scene that cannot be opened.
        scene::open(path, options)?;
        let path = std::fs::canonicalize(path).map_err(|error| Error::at(path.display(), error))?;
        let (found, held_by) = claim(&path, mode)?;
        // Under the lock nobody of ours writes any more: this is the text that counts.
        let text = scene::read_text(&path, &options.limits)?;
        let document = scene::parse(&path, &text, options)?;
        let mut session = Session {
            path,
            options: options.clone(),
            mode,
            history: History::new(document.clone()),
            journal: None,
            journal_missing: None,
            aside: None,
            file: scene::hash(text.as_bytes()),
            first_step: 0,
            offer: None,
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
            Some(Err(error)) => session.journal_missing = Some(error.to_string()),
            None => session.mode = Mode::ReadOnly,
        }
        Ok(session)
    }

    /// Goes on from what the journal tells.
    fn take_up(&mut self, mut found: Found, document: Document) {
        let replayed = found.contents.as_ref().and_then(recovery::replay);
        if replayed.is_none() {
            found.contents = None;
        }
        let (records, revision) = replayed.as_ref().map_or((0, 0), |r| (r.records, r.history.revision()));
        let header = Header { file: self.file.clone(), document: document.json().clone(), is_file: true };
        let place = found.path().display().to_string();
        match found.open(&header, records, revision) {
            Ok(opened) => (self.journal, self.aside) = (Some(opened.journal), opened.aside),
            Err(error) => self.journal_missing = Some(format!("{place}: {error}")),
        }
        if let Some(replayed) = replayed {
            self.compare(replayed, document);
        }
    }

    /// Decides between the journal's document and the file's.
    fn compare(&mut self, replayed: Replayed, document: Document) {
        let Replayed { mut history, unsaved, time_ms, next_step, file, base, .. } = replayed;
        self.first_step = next_step;
        history.govern(self.options.rules());
        let file_changed = file != self.file;
        if history.document().to_text() == document.to_text() {
            self.history = history;
            self.now_saved(file_changed);
        } else if unsaved > 0 && !history.is_saved() {
            let words = words::describe(document.json(), &Edit::between(&document, history.document()));
            let recovery = Recovery { changes: unsaved, words, time_ms, file_changed };
            let base = base.and_then(|json| Document::from_json_under(json, self.options.rules()).ok());
            self.offer = Some(Offer { recovery, history, file, base });
        } else {
            self.history = history;
            self.enter(&document);
        }
    }

    /// The file, absolute and free of links.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The document as it is now.
    pub fn document(&self) -> &Document {
        self.history.document()
    }

    /// What was done and can be undone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Unsaved edits that are offered; until they are taken or not, the document is the file's.
    pub fn recovery(&self) -> Option<&Recovery> {
        self.offer.as_ref().map(|offer| &offer.recovery)
    }

    /// Who edits the scene, so that here it may only be looked at.
    pub fn held_by(&self) -> Option<&Holder> {
        self.held_by.as_ref()
    }

    /// Whether the scene may only be looked at.
    pub fn reads_only(&self) -> bool {
        !self.mode.edits()
    }

    /// Where bytes of a damaged journal were kept aside.
    pub fn kept_aside(&self) -> Option<&Path> {
        self.aside.as_deref()
    }

    /// Takes the unsaved edits that are offered. Where another program changed the file since, all is as if it had done so
    /// now: see [`Session::take_in`].
    pub fn recover(&mut self) {
        let Some(offer) = self.offer.take() else { return };
        (self.history, self.file, self.base) = (offer.history, offer.file, offer.base);
    }

    /// Leaves the unsaved edits that are offered; undo still gives them.
    pub fn discard_recovery(&mut self) {
        let Some(offer) = self.offer.take() else { return };
        let file = std::mem::replace(&mut self.history, offer.history).document().clone();
        self.enter(&file);
    }

    /// Applies an edit; `held` by a key held down joins the edit before it into one step. None where it changes nothing.
    /// Unsaved edits still offered are left.
    ///
    /// # Errors
    /// When the result has errors in it; the document stays as it was.
    pub fn apply(&mut self, edit: Edit, held: bool) -> std::result::Result<Option<Applied>, Vec<Problem>> {
        self.discard_recovery();
        let applied = self.history.apply(edit, Stamp { time_ms: now_ms(), held })?;
        if let Some(applied) = &applied {
            self.record(Kind::Edit, applied);
        }
        Ok(applied)
    }

    /// Ends the step: a held key that follows begins another.
    pub fn close_step(&mut self) {
        self.history.close_step();
    }

    /// Takes the last step back; none where there is none.
    pub fn undo(&mut self) -> Option<Applied> {
        self.discard_recovery();
        let applied = self.history.undo()?;
        self.record(Kind::Undo, &applied);
        Some(applied)
    }

    /// Does again what was undone last; none where there is nothing.
    pub fn redo(&mut self) -> Option<Applied> {
        let applied = self.history.redo()?;
        self.record(Kind::Redo, &applied);
        Some(applied)
    }

    /// Back to the document as it was at a time, in milliseconds since the epoch.
    pub fn earlier(&mut self, time_ms: u64) -> Vec<Applied> {
        self.discard_recovery();
        let all = self.history.earlier(time_ms);
        self.record_all(&Kind::Undo, &all);
        all
    }

    /// On to the document as it was at a time, as far as it was undone.
    pub fn later(&mut self, time_ms: u64) -> Vec<Applied> {
        let all = self.history.later(time_ms);
        self.record_all(&Kind::Redo, &all);
        all
    }

    /// Writes the document to its file, atomically.
    ///
    /// # Errors
    /// When it cannot be written: it is not saved then, and stays as it is in memory. When another program changed the
    /// file meanwhile, unless it may be overwritten; when the session only reads.
    pub fn save(&mut self, overwrite: Overwrite) -> Result<()> {
        let place = self.path.display();
        if self.reads_only() {
            return Err(Error::at(place, "is open to read only").cure("save a copy under another name"));
        }
        if overwrite == Overwrite::No {
            self.may_overwrite().map_err(|error| error.cure("take its changes in, or overwrite it"))?;
        }
        // The edits first: should we die in between, the journal knows what the file has become. Where they cannot be
        // kept, saving is all the more urgent.
        if let Some(Err(reason)) = self.journal.as_ref().map(Journal::flush) {
            tracing::warn!("saving without a journal: {reason}");
        }
        let text = self.document().to_text();
        let ours = scene::hash(text.as_bytes());
        if let Err(error) = scene::save(&self.path, &text) {
            // It may have come as far as the file and not be safe there: what is there is ours all the same.
            if self.file_holds(&ours) {
                self.file = ours;
            }
            return Err(error);
        }
        self.file = ours;
        self.base = Some(self.document().clone());
        self.now_saved(true);
        Ok(())
    }

    /// How safe the present document is.
    pub fn safety(&self) -> Safety {
        let failing = self.journal.as_ref().and_then(Journal::failing).or_else(|| self.journal_missing.clone());
        let revision = self.history.revision();
        let journaled = self.offer.is_some() || self.journal.as_ref().is_some_and(|j| j.acknowledged() >= revision);
        Safety { saved: self.history.is_saved(), journaled, failing }
    }

    /// Waits until every change is in the journal.
    ///
    /// # Errors
    /// Why they are not.
    pub fn flush(&self) -> std::result::Result<(), String> {
        match (&self.journal, &self.journal_missing) {
            (Some(journal), _) => journal.flush(),
            (None, Some(reason)) => Err(reason.clone()),
            (None, None) => Ok(()),
        }
    }

    fn record_all(&mut self, kind: &Kind, all: &[Applied]) {
        all.iter().for_each(|applied| self.record(kind.clone(), applied));
    }

    fn record(&mut self, kind: Kind, applied: &Applied) {
        let Some(journal) = &mut self.journal else { return };
        let (patch, inverse) = (applied.edit.clone(), applied.inverse.clone());
        let step = self.first_step + applied.step;
        let record = Record { revision: applied.revision, time: now_ms(), step, kind, patch, inverse };
        journal.append(&record, self.history.document(), &self.file);
    }
}

/// A journal, or why there is none.
type Claimed = std::io::Result<Found>;

/// Finds and locks the journal of the scene at `path`. Neither that nor a reason where it may only be looked at: then
/// perhaps who holds it.
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
