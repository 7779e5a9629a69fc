//! Changes to a session's file by other programs: they are noticed by the file's hash and taken in as one edit, merged
//! with what is unsaved here, or left for the person to decide. Nothing of either side is lost without asking: undo has
//! it.

use std::io::ErrorKind;

use super::open::Session;
use crate::base::error::{Error, Result};
use crate::files::journal::Kind;
use crate::files::{hash, now_ms, paths, scene, through};
use crate::scene::history::{Applied, Stamp};
use crate::scene::merge::{Merged, Side, merge};
use crate::scene::{Document, Edit, words};

/// What became of the file's version.
#[derive(Clone, Debug, PartialEq)]
pub enum Taken {
    /// Nothing: the file is as we left it.
    Nothing,
    /// The file is no longer there; the document counts as unsaved.
    Gone,
    /// The document is now the file's version.
    Whole,
    /// The document is now both merged; what was unsaved still is.
    Merged,
    /// Both changed these places, in words; nothing is done until somebody says which side wins.
    Asked(Vec<String>),
}

impl Session {
    /// If another program changed the file, takes its version in as one edit. What is unsaved here is merged with it;
    /// if both changed the same place, the `prefer`red side wins, and if there is none, nothing is done. Returns the
    /// edit, if there is one.
    ///
    /// # Errors
    /// If the file cannot be read or contains errors: the document then stays as it is, the last good one.
    pub fn take_in(&mut self, prefer: Option<Side>) -> Result<(Taken, Option<Applied>)> {
        if self.is_gone() {
            self.history.mark_unsaved();
            return Ok((Taken::Gone, None));
        }
        let (theirs, file, text) = self.file_version()?;
        if file == self.file {
            // The file may have been missing for a moment.
            if self.history.document().to_text() == theirs.to_text() {
                self.history.mark_saved();
            }
            return Ok((Taken::Nothing, None));
        }
        if let Some(offer) = &mut self.offer {
            // The offer stands; until it is accepted or declined, the document is the file's.
            offer.recovery.file_changed = true;
            self.is_file(theirs.clone(), file, text);
            let edit = Edit::between(self.history.document(), &theirs);
            let applied = self.history.apply(edit, Stamp::default()).ok().flatten();
            self.history.mark_saved();
            return Ok((Taken::Whole, applied));
        }
        if self.history.is_saved() {
            self.is_file(theirs.clone(), file, text);
            return Ok((Taken::Whole, self.enter(&theirs)));
        }
        let (merged, conflicts) = self.merged(&theirs, prefer.unwrap_or(Side::Mine));
        if prefer.is_none() && !conflicts.is_empty() {
            return Ok((Taken::Asked(conflicts), None));
        }
        self.is_file(theirs.clone(), file, text);
        if merged.to_text() == theirs.to_text() {
            return Ok((Taken::Whole, self.enter(&theirs)));
        }
        let applied = self.enter_edit(&merged);
        self.history.mark_unsaved();
        Ok((Taken::Merged, applied))
    }

    /// Replaces the document with the file's version, as one edit; returns the edit if there is a difference.
    ///
    /// # Errors
    /// As [`Session::take_in`].
    pub fn revert(&mut self) -> Result<Option<Applied>> {
        let (theirs, file, text) = self.file_version()?;
        self.discard_recovery();
        self.is_file(theirs.clone(), file, text);
        Ok(self.enter(&theirs))
    }

    /// The differences of the file from the document, in words.
    ///
    /// # Errors
    /// As [`Session::take_in`].
    pub fn difference(&self) -> Result<Vec<String>> {
        let (theirs, ..) = self.file_version()?;
        Ok(words::describe(self.document().json(), &Edit::between(self.document(), &theirs)))
    }

    /// The document merged with the file's version, and where one of them is overruled, in words.
    fn merged(&self, theirs: &Document, prefer: Side) -> (Document, Vec<String>) {
        let mine = self.document();
        let base = self.base.as_ref().map(Document::json);
        let Merged { json, conflicts } = merge(base, mine.json(), theirs.json(), prefer);
        let conflicts: Vec<String> = conflicts.iter().map(|one| words::conflict(mine.json(), one)).collect();
        match Document::from_json_under(json, self.options.rules()) {
            Ok(merged) => (merged, conflicts),
            Err(problems) => {
                let whole = if prefer == Side::Mine { mine } else { theirs };
                let why = problems.iter().map(|problem| format!("together they would be wrong: {problem}"));
                (whole.clone(), conflicts.into_iter().chain(why).collect())
            }
        }
    }

    /// The document in the file, the file's hash and its text.
    fn file_version(&self) -> Result<(Document, String, String)> {
        let text = scene::read_text(&self.path, &self.options.limits)?;
        Ok((scene::parse(&self.path, &text, &self.options)?, hash::of(text.as_bytes()), text))
    }

    /// The document in the file, if that can be read.
    pub(super) fn file_document(&self) -> Option<Document> {
        self.file_version().ok().map(|(document, ..)| document)
    }

    /// Notes what is in the file.
    fn is_file(&mut self, document: Document, file: String, text: String) {
        (self.file, self.source, self.base) = (file, text, Some(document));
        // The layout is the other program's from now on.
        self.texts.clear();
    }

    /// Refuses to replace a file that is write-protected.
    ///
    /// # Errors
    /// If it is.
    pub fn refuse_protected(&self) -> Result<()> {
        through::refuse_protected(&self.path)
    }

    /// Whether the file was removed.
    pub fn is_gone(&self) -> bool {
        std::fs::metadata(&self.path).is_err_and(|error| error.kind() == ErrorKind::NotFound)
    }

    /// Refuses to overwrite the file without asking if it was changed; a file that is gone may be written again.
    ///
    /// # Errors
    /// Why it must not be overwritten.
    pub fn may_overwrite(&self) -> Result<()> {
        match paths::read(&self.path, self.options.limits.scene) {
            Ok(bytes) if hash::of(&bytes) == self.file => Ok(()),
            Ok(_) => Err(Error::at(self.path.display(), "was changed by another program")),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
            Err(error) => Err(Error::at(self.path.display(), error)),
        }
    }

    /// Whether the file has exactly this content; for after a save that failed on the way.
    pub(super) fn file_holds(&self, hash: &str) -> bool {
        paths::read(&self.path, self.options.limits.scene).is_ok_and(|bytes| hash::of(&bytes) == hash)
    }

    /// Takes over the document in the file, as one edit.
    pub(super) fn enter(&mut self, document: &Document) -> Option<Applied> {
        let applied = self.enter_edit(document);
        self.now_saved(true);
        applied
    }

    fn enter_edit(&mut self, document: &Document) -> Option<Applied> {
        let edit = Edit::between(self.history.document(), document);
        self.history.close_step();
        let applied = self.history.apply(edit, Stamp { time_ms: now_ms(), held: false }).ok().flatten();
        if let Some(applied) = &applied {
            self.record(Kind::Edit, applied);
        }
        applied
    }

    /// Notes that the document is the file's; with `tell`, in the journal too.
    pub(super) fn now_saved(&mut self, tell: bool) {
        self.history.mark_saved();
        if tell {
            let (revision, edit) = (self.history.revision(), Edit::default());
            let applied = Applied { revision, step: 0, edit: edit.clone(), inverse: edit };
            self.record(Kind::Saved(self.file.clone()), &applied);
        }
    }
}
