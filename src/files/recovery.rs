//! From a journal back to a history: its records are done again, one after another, from the document it starts from.

use serde_json::Value;

use super::journal::{Contents, Kind, Record};
use crate::base::problem::Problem;
use crate::scene::check::Rules;
use crate::scene::history::{Replay, Stamp};
use crate::scene::{Document, History};

/// How many records may be left out at the end because of what they lead to.
const MOST_TRIES: usize = 100;

/// What a journal tells.
#[derive(Debug)]
pub struct Replayed {
    /// The history after the last record that could be done.
    pub history: History,
    /// How many records could be done.
    pub records: usize,
    /// SHA-256 of the scene file as the journal last knew it.
    pub file: String,
    /// What that file held, where the journal tells.
    pub base: Option<Value>,
    /// Changes since then.
    pub unsaved: usize,
    /// When the last record was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// One more than the largest step.
    pub next_step: u64,
}

/// Does the records of a journal again, as far as they can be done and lead to a document without errors. None where it
/// does not start from a document that this program understands.
pub fn replay(contents: &Contents) -> Option<Replayed> {
    let document = Document::from_json_under(contents.header.document.clone(), Rules::NONE).ok()?;
    let mut count = contents.records.len();
    for _ in 0..MOST_TRIES {
        match attempt(&document, contents, count) {
            Ok(replayed) => return Some(replayed),
            Err(fewer) => count = fewer?,
        }
    }
    None
}

/// Does the first `count` records. Fails with how many to try instead.
fn attempt(document: &Document, contents: &Contents, count: usize) -> Result<Replayed, Option<usize>> {
    let mut replay = Replay::new(document.clone());
    let mut file = contents.header.file.clone();
    let mut base = contents.header.is_file.then(|| contents.header.document.clone());
    let (mut unsaved, mut time_ms, mut next_step, mut last_edit) = (0, 0, 0, None);
    for (index, (record, _)) in contents.records[..count].iter().enumerate() {
        let held = last_edit == Some(record.step);
        again(&mut replay, record, held).map_err(|_| Some(index))?;
        last_edit = (record.kind == Kind::Edit).then_some(record.step);
        unsaved += 1;
        if let Kind::Saved(hash) = &record.kind {
            (file, unsaved, base) = (hash.clone(), 0, Some(replay.json().clone()));
        }
        time_ms = record.time;
        next_step = next_step.max(record.step + 1);
    }
    let history = replay.finish(Rules::NONE).map_err(|_| count.checked_sub(1))?;
    Ok(Replayed { history, records: count, file, base, unsaved, time_ms, next_step })
}

fn again(replay: &mut Replay, record: &Record, held: bool) -> Result<(), Problem> {
    let stamp = Stamp { time_ms: record.time, held };
    let Record { kind, patch, inverse, .. } = record;
    match kind {
        Kind::Edit => replay.edit(patch, inverse, stamp),
        Kind::Undo => replay.undo(patch, inverse, stamp),
        Kind::Redo => replay.redo(patch, inverse, stamp),
        Kind::Saved(_) => {
            replay.saved();
            Ok(())
        }
    }
}
