//! From a journal back to a history: its records are done again, one after another, from the document it starts from.

use super::journal::{Contents, Kind, Record};
use crate::scene::check::Rules;
use crate::scene::history::Stamp;
use crate::scene::{Document, History};

/// What a journal tells.
#[derive(Debug)]
pub struct Replayed {
    /// The history after the last record that could be done.
    pub history: History,
    /// How many records could be done.
    pub records: usize,
    /// SHA-256 of the scene file as the journal last knew it.
    pub file: String,
    /// Changes since then.
    pub unsaved: usize,
    /// When the last record was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// One more than the largest step.
    pub next_step: u64,
}

/// Does the records of a journal again, as far as they can be done. None where it does not start from a document that
/// this program understands.
pub fn replay(contents: &Contents) -> Option<Replayed> {
    let document = Document::from_json_under(contents.header.document.clone(), Rules::NONE).ok()?;
    let history = History::new(document);
    let file = contents.header.file.clone();
    let mut replayed = Replayed { history, records: 0, file, unsaved: 0, time_ms: 0, next_step: 0 };
    // Only the file's hash tells whether the first document is the file's.
    replayed.history.mark_unsaved();
    let mut last_edit = None;
    for (record, _) in &contents.records {
        if !replayed.again(record, last_edit == Some(record.step)) {
            break;
        }
        last_edit = (record.kind == Kind::Edit).then_some(record.step);
        replayed.records += 1;
        replayed.time_ms = record.time;
        replayed.next_step = replayed.next_step.max(record.step + 1);
    }
    replayed.history.close_step();
    Some(replayed)
}

impl Replayed {
    fn again(&mut self, record: &Record, held: bool) -> bool {
        let stamp = Stamp { time_ms: record.time, held };
        let done = match &record.kind {
            Kind::Saved(file) => {
                self.history.mark_saved();
                (self.file, self.unsaved) = (file.clone(), 0);
                return true;
            }
            Kind::Edit => false,
            Kind::Undo => self.as_recorded(record, History::undo, History::redo),
            Kind::Redo => self.as_recorded(record, History::redo, History::undo),
        };
        self.unsaved += 1;
        // The step that an undo takes back may have been dropped from the journal: then it is an edit like others.
        done || self.history.apply(record.patch.clone(), stamp).is_ok()
    }

    /// Goes a step, and back again where it is not the one recorded.
    fn as_recorded(&mut self, record: &Record, go: Go, back: Go) -> bool {
        match go(&mut self.history) {
            Some(applied) if applied.edit == record.patch => true,
            Some(_) => {
                back(&mut self.history);
                false
            }
            None => false,
        }
    }
}

type Go = fn(&mut History) -> Option<crate::scene::history::Applied>;
