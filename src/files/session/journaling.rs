//! The journal of a session: how it is used when a scene is opened, what is recorded in it, and the retries if it could
//! not be opened.

use std::time::{Duration, Instant};

use super::keeping::{Keeping, Waiting};
use super::open::{Offer, Recovery, Session};
use crate::files::journal::{self, Candidate, Header, Kind, Record, Unopened};
use crate::files::now_ms;
use crate::files::recovery::{self, Replayed};
use crate::scene::history::{Applied, Way};
use crate::scene::{Document, Edit, History, json, words};

/// How long after a failure to try a journal again.
const TRY_AGAIN: Duration = Duration::from_secs(1);

impl Session {
    /// Continues from what is in the journal.
    pub(super) fn take_up(&mut self, mut found: Candidate, document: Document) {
        let replayed = found.contents.as_ref().and_then(recovery::replay);
        if replayed.is_none() {
            found.contents = None;
        }
        let leads_to = replayed.as_ref().map_or_else(|| document.clone(), |r| r.history.document().clone());
        let (records, revision) = replayed.as_ref().map_or((0, 0), |r| (r.records, r.history.revision()));
        self.keep_in(found, leads_to, (records, revision));
        if let Some(mut replayed) = replayed {
            if let Some((edit, inverse)) = replayed.migration.take() {
                self.record_migration(&replayed, edit, inverse);
            }
            self.compare(replayed, document);
        }
    }

    /// Opens a journal that was found, or leaves it for later if that fails.
    fn keep_in(&mut self, mut found: Candidate, leads_to: Document, (records, revision): (usize, u64)) {
        let is_file = self.base.as_ref().is_some_and(|base| json::same(base.json(), leads_to.json()));
        let header = Header { file: self.file.clone(), document: leads_to.json().clone(), is_file };
        self.keeping = match found.open(&header, records, revision) {
            Ok(opened) => {
                self.aside = opened.aside;
                Keeping::Journal(opened.journal)
            }
            Err(error) => {
                let why = format!("{}: {error}", found.path().display());
                Keeping::Waiting(Waiting { found: Some(found), leads_to, records, why, tried: Instant::now() })
            }
        };
    }

    /// Records that the journal continues in the current version of the format.
    fn record_migration(&mut self, replayed: &Replayed, edit: Edit, inverse: Edit) {
        let Keeping::Journal(journal) = &mut self.keeping else { return };
        let (history, file) = (&replayed.history, &replayed.file);
        let revision = history.revision();
        let mut record = Record { revision, time: now_ms(), step: 0, kind: Kind::Edit, patch: edit, inverse };
        journal.append(&record, history.document(), file);
        if history.is_saved() {
            (record.patch, record.inverse, record.kind) = (Edit::default(), Edit::default(), Kind::Saved(file.clone()));
            journal.append(&record, history.document(), file);
        }
    }

    /// Decides between the journal's document and the file's.
    fn compare(&mut self, replayed: Replayed, document: Document) {
        let Replayed { mut history, unsaved, time_ms, file, base, .. } = replayed;
        history.govern(self.options.rules());
        let file_changed = file != self.file;
        if history.document().to_text() == document.to_text() {
            self.history = history;
            self.now_saved(file_changed);
        } else if unsaved > 0 && !history.is_saved() {
            let recovery = offered(&history, &document, (unsaved, time_ms, file_changed));
            let base = base.and_then(|json| Document::from_json_under(json, self.options.rules()).ok());
            self.offer = Some(Offer { recovery, history, file, base });
        } else {
            self.history = history;
            self.enter(&document);
        }
    }

    /// Tries again to open a journal that could not be opened; to be called now and then. What was edited meanwhile is
    /// recorded as one edit.
    pub fn tend(&mut self) {
        let Keeping::Waiting(waiting) = &mut self.keeping else { return };
        if waiting.tried.elapsed() < TRY_AGAIN {
            return;
        }
        waiting.tried = Instant::now();
        let (leads_to, records) = (waiting.leads_to.clone(), waiting.records);
        let (found, leads_to, records) = match waiting.found.take() {
            Some(found) => (found, leads_to, records),
            None => match find_again(&self.path, leads_to) {
                Ok(found) => found,
                Err(why) => return waiting.why = why,
            },
        };
        self.keep_in(found, leads_to.clone(), (records, self.history.revision()));
        if self.keeping.journal().is_some() && self.offer.is_none() {
            self.catch_up(&leads_to);
        }
    }

    /// Records what has changed since the document that the journal leads to.
    fn catch_up(&mut self, leads_to: &Document) {
        let edit = Edit::between(leads_to, self.history.document());
        if edit.is_empty() {
            return;
        }
        let (revision, inverse) = (self.history.revision(), edit.inverse(leads_to));
        let step = self.history.reserve_step();
        self.record(Kind::Edit, &Applied { revision, step, edit, inverse });
        if self.history.is_saved() {
            self.now_saved(true);
        }
    }

    pub(super) fn record_all(&mut self, all: &[(Way, Applied)]) {
        for (way, applied) in all {
            self.record(if *way == Way::Back { Kind::Undo } else { Kind::Redo }, applied);
        }
    }

    pub(super) fn record(&mut self, kind: Kind, applied: &Applied) {
        let Keeping::Journal(journal) = &mut self.keeping else { return };
        let Applied { revision, step, edit, inverse } = applied;
        let (patch, inverse) = (edit.clone(), inverse.clone());
        let record = Record { revision: *revision, time: now_ms(), step: *step, kind, patch, inverse };
        journal.append(&record, self.history.document(), &self.file);
    }
}

/// The unsaved edits that a session of the scene at `path` left behind, if its file holds `document`. Nothing is locked, and
/// nothing is taken: opening the scene still offers them.
pub fn left_behind(path: &std::path::Path, document: &Document) -> Option<Recovery> {
    let path = std::fs::canonicalize(path).ok()?;
    let Replayed { history, unsaved, time_ms, .. } = recovery::replay(&journal::look(&path)?)?;
    let left = unsaved > 0 && !history.is_saved() && history.document().to_text() != document.to_text();
    left.then(|| offered(&history, document, (unsaved, time_ms, false)))
}

/// What is said of unsaved edits: how many, of when, and whether the file changed since.
fn offered(history: &History, document: &Document, (changes, time_ms, file_changed): (usize, u64, bool)) -> Recovery {
    let words = words::describe(document.json(), &Edit::between(document, history.document()));
    Recovery { changes, words, time_ms, file_changed }
}

/// Tries again to find a journal; returns it, the document that it leads to, and by how many records. A new journal
/// starts from `document`.
fn find_again(path: &std::path::Path, document: Document) -> Result<(Candidate, Document, usize), String> {
    let mut found = match journal::find(path) {
        Ok(found) => found,
        Err(Unopened::Locked { .. }) => return Err("another process has it".into()),
        Err(Unopened::Failed(error)) => return Err(error.to_string()),
    };
    let Some(replayed) = found.contents.as_ref().and_then(recovery::replay) else {
        found.contents = None;
        return Ok((found, document, 0));
    };
    if replayed.migration.is_some() || (replayed.unsaved > 0 && !replayed.history.is_saved()) {
        let why = format!("{} holds unsaved edits of before: open the scene anew", found.path().display());
        found.leave();
        return Err(why);
    }
    Ok((found, replayed.history.document().clone(), replayed.records))
}
