//! From a journal back to a history: its records are replayed in order, starting with the document in its header.

use serde_json::Value;

use super::journal::{Contents, Kind, Record};
use crate::base::problem::Problem;
use crate::scene::check::Rules;
use crate::scene::history::{Remade, Replay, Stamp};
use crate::scene::{Edit, History, migrate};

/// How many records at the end may be dropped because they lead to a document with errors.
const MOST_TRIES: usize = 100;

/// The result of replaying a journal.
#[derive(Debug)]
pub struct Replayed {
    /// The history after the last record that could be replayed.
    pub history: History,
    /// How many records could be replayed.
    pub records: usize,
    /// SHA-256 of the scene file as last recorded in the journal.
    pub file: String,
    /// The document in that file, if the journal has it.
    pub base: Option<Value>,
    /// Changes since then.
    pub unsaved: usize,
    /// When the last record was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// The edit that brought the document to the current version of the format, and its inverse.
    pub migration: Option<(Edit, Edit)>,
}

/// Replays the records of a journal, as far as they can be applied and lead to a document without errors. `None` if not
/// even the document that the journal starts from is one that this program understands.
pub fn replay(contents: &Contents) -> Option<Replayed> {
    replay_with(contents, &migrate::migrate)
}

type Migrate = dyn Fn(&mut Value) -> Result<(), Problem>;

fn replay_with(contents: &Contents, migrate: &Migrate) -> Option<Replayed> {
    let mut count = contents.records.len();
    for _ in 0..MOST_TRIES {
        match attempt(contents, count, migrate) {
            Ok(replayed) => return Some(replayed),
            Err(fewer) => count = fewer?,
        }
    }
    None
}

/// Replays the first `count` records. Fails with how many to try instead.
fn attempt(contents: &Contents, count: usize, migrate: &Migrate) -> Result<Replayed, Option<usize>> {
    let start = &contents.header.document;
    let mut replay = Replay::new(start.clone());
    let mut file = contents.header.file.clone();
    let mut base = contents.header.is_file.then(|| start.clone());
    let (mut unsaved, mut time_ms, mut last_edit) = (0, 0, None);
    for (index, (record, _)) in contents.records[..count].iter().enumerate() {
        let held = last_edit == Some(record.step);
        again(&mut replay, record, held).map_err(|_| Some(index))?;
        last_edit = (record.kind == Kind::Edit).then_some(record.step);
        unsaved += 1;
        if let Kind::Saved(hash) = &record.kind {
            (file, unsaved, base) = (hash.clone(), 0, Some(replay.json().clone()));
        }
        time_ms = record.time;
    }
    let base = base.and_then(|mut json| migrate(&mut json).ok().map(|()| json));
    let Remade { history, migration } = replay.finish(Rules::NONE, migrate).map_err(|_| count.checked_sub(1))?;
    Ok(Replayed { history, records: count, file, base, unsaved, time_ms, migration })
}

fn again(replay: &mut Replay, record: &Record, held: bool) -> Result<(), Problem> {
    let stamp = Stamp { time_ms: record.time, held };
    let Record { kind, patch, inverse, step, .. } = record;
    match kind {
        Kind::Edit => replay.edit(patch, inverse, stamp, *step),
        Kind::Undo => replay.undo(patch, inverse, stamp, *step),
        Kind::Redo => replay.redo(patch, inverse, stamp, *step),
        Kind::Saved(_) => {
            replay.saved();
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::journal::Header;
    use super::*;
    use crate::scene::Edit;

    fn edit(text: &str) -> Edit {
        Edit(serde_json::from_str(text).unwrap())
    }

    fn record(kind: Kind, step: u64, patch: &str, inverse: &str) -> (Record, usize) {
        (Record { revision: step + 1, time: 9, step, kind, patch: edit(patch), inverse: edit(inverse) }, 0)
    }

    /// In these tests, `name` in version 1 becomes `title` in version 2; no real scene of version 1 has a `name`.
    fn to_two(json: &mut Value) -> Result<(), Problem> {
        if json["plica"] == 1 {
            let name = json.as_object_mut().unwrap().shift_remove("name");
            json["title"] = name.unwrap_or_default();
            json["plica"] = 2.into();
        }
        Ok(())
    }

    #[test]
    fn records_fit_the_version_that_they_were_made_in() {
        let header = Header { file: "f".into(), document: json!({ "plica": 1, "name": "a" }), is_file: true };
        let rename = |step, from: &str, to: &str| {
            let set = |name| format!(r#"[{{"op": "replace", "path": "/name", "value": "{name}"}}]"#);
            record(Kind::Edit, step, &set(to), &set(from))
        };
        let saved = (Record { kind: Kind::Saved("g".into()), ..rename(0, "", "").0 }, 0);
        let records = vec![rename(0, "a", "b"), saved, rename(1, "b", "c")];
        let mut contents = Contents { header, records, header_end: 0 };
        let replayed = replay_with(&contents, &to_two).unwrap();
        assert_eq!(replayed.history.document().json(), &json!({ "plica": 2, "title": "c" }));
        assert_eq!((replayed.unsaved, replayed.history.is_saved(), replayed.history.depth()), (1, false, (0, 0)));
        assert_eq!(replayed.base, Some(json!({ "plica": 2, "title": "b" })));
        // The migration is recorded, and later records are of the new version.
        let (patch, inverse) = replayed.migration.unwrap();
        contents.records.push((Record { patch, inverse, ..rename(2, "", "").0 }, 0));
        let set = |title| format!(r#"[{{"op": "replace", "path": "/title", "value": "{title}"}}]"#);
        contents.records.push(record(Kind::Edit, 3, &set("d"), &set("c")));
        let replayed = replay_with(&contents, &to_two).unwrap();
        assert_eq!(replayed.history.document().json(), &json!({ "plica": 2, "title": "d" }));
        assert_eq!((replayed.history.depth(), replayed.migration.is_some()), ((1, 0), false));
    }

    #[test]
    fn a_journal_of_a_scene_that_was_given_another_version_goes_as_far_as_it_makes_sense() {
        let header = Header { file: "f".into(), document: json!({ "plica": 1 }), is_file: true };
        let title = record(
            Kind::Edit,
            0,
            r#"[{"op": "add", "path": "/title", "value": "a"}]"#,
            r#"[{"op": "remove", "path": "/title"}]"#,
        );
        let set = |version: u32| format!(r#"[{{"op": "replace", "path": "/plica", "value": {version}}}]"#);
        let records = vec![title, record(Kind::Edit, 1, &set(7), &set(1))];
        let replayed = replay(&Contents { header, records, header_end: 0 }).unwrap();
        assert_eq!((replayed.records, replayed.history.document().scene().title.as_str()), (1, "a"));
    }
}
