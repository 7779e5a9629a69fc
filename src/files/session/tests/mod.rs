//! Sessions: every way in which one can end, and changes by other programs.

mod keeping;
mod saving;

use std::path::{Path, PathBuf};

use super::{Mode, Overwrite, Session, Taken};
use crate::files::{Options, hash, journal, scene};
use crate::scene::merge::Side;
use crate::scene::{Document, Edit};

const SCENE: &str = "{ \"plica\": 1,\n   \"title\": \"start\" }\n";

struct Place {
    folder: tempfile::TempDir,
    scene: PathBuf,
}

fn place() -> Place {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().canonicalize().unwrap().join("cat.plica.json");
    std::fs::write(&scene, SCENE).unwrap();
    Place { folder, scene }
}

fn open(path: &Path) -> Session {
    Session::open(path, &Options::default(), Mode::Edit).unwrap()
}

fn title(text: &str) -> Edit {
    Edit(serde_json::from_value(serde_json::json!([{ "op": "replace", "path": "/title", "value": text }])).unwrap())
}

fn edit(session: &mut Session, text: &str) {
    session.apply(title(text), false).unwrap().unwrap();
}

fn shown(session: &Session) -> &str {
    &session.document().scene().title
}

/// Ends a session as `kill -9` would: what is in the journal stays, nothing else is done.
fn kill(session: Session) -> Vec<u8> {
    session.flush().unwrap();
    let journal = std::fs::read(journal::path_beside(session.path())).unwrap();
    let path = session.path().to_owned();
    drop(session);
    std::fs::write(journal::path_beside(&path), &journal).unwrap();
    journal
}

fn outside(place: &Place, text: &str) {
    std::fs::write(&place.scene, SCENE.replace("start", text)).unwrap();
}

#[test]
fn undo_survives_save_and_quit() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "one");
    edit(&mut session, "two");
    session.undo().unwrap();
    session.save(Overwrite::No).unwrap();
    assert!(session.safety().saved);
    drop(session);
    let mut session = open(&place.scene);
    assert_eq!((shown(&session), session.recovery()), ("one", None));
    assert!(session.safety().saved && session.safety().journaled);
    assert_eq!(session.redo().map(|_| shown(&session).to_owned()).unwrap(), "two");
    session.undo().unwrap();
    session.undo().unwrap();
    assert_eq!(session.undo(), None);
    assert_eq!(shown(&session), "start");
    assert!(!session.safety().saved);
    session.redo().unwrap();
    assert!(session.safety().saved);
}

#[test]
fn a_held_key_is_one_step_after_reopening_too() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "a");
    for text in ["b", "c", "d"] {
        session.apply(title(text), true).unwrap();
    }
    session.close_step();
    session.apply(title("e"), true).unwrap();
    session.save(Overwrite::No).unwrap();
    drop(session);
    let mut session = open(&place.scene);
    let mut seen = Vec::new();
    while session.undo().is_some() {
        seen.push(shown(&session).to_owned());
    }
    assert_eq!(seen, ["d", "start"]);
}

#[test]
fn a_session_without_edits_leaves_nothing() {
    let place = place();
    drop(open(&place.scene));
    assert_eq!(std::fs::read_dir(&place.folder).unwrap().count(), 1);
    assert_eq!(std::fs::read_to_string(&place.scene).unwrap(), SCENE);
}

#[test]
fn unsaved_edits_are_offered_and_wait_for_an_answer() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "saved");
    session.save(Overwrite::No).unwrap();
    edit(&mut session, "lost?");
    kill(session);
    for _ in 0..2 {
        let session = open(&place.scene);
        assert_eq!(shown(&session), "saved");
        let offer = session.recovery().unwrap();
        assert_eq!((offer.changes, offer.file_changed), (1, false));
        // Not answered: offered again.
    }
    let mut session = open(&place.scene);
    session.recover();
    assert_eq!((shown(&session), session.recovery()), ("lost?", None));
    assert!(!session.safety().saved);
    drop(session);
    let mut session = open(&place.scene);
    session.discard_recovery();
    assert_eq!(shown(&session), "saved");
    assert!(session.safety().saved);
    drop(session);
    let mut session = open(&place.scene);
    assert_eq!(session.recovery(), None);
    session.undo().unwrap();
    assert_eq!(shown(&session), "lost?", "left, not lost");
}

#[test]
fn a_change_from_outside_is_one_edit() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "ours");
    session.save(Overwrite::No).unwrap();
    assert_eq!(session.take_in(None).unwrap(), (Taken::Nothing, None), "our own save is not from outside");
    drop(session);
    outside(&place, "theirs");
    let mut session = open(&place.scene);
    assert_eq!((shown(&session), session.recovery()), ("theirs", None));
    assert!(session.safety().saved);
    outside(&place, "again");
    assert!(matches!(session.take_in(None).unwrap(), (Taken::Whole, Some(_))));
    assert_eq!(shown(&session), "again");
    std::fs::write(&place.scene, "{ half").unwrap();
    assert!(session.take_in(None).is_err());
    assert_eq!(shown(&session), "again", "the last good one");
    for text in ["theirs", "ours", "start"] {
        session.undo().unwrap();
        assert_eq!(shown(&session), text);
    }
}

#[test]
fn unsaved_edits_and_a_change_from_outside_are_both_kept() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "ours");
    kill(session);
    outside(&place, "theirs");
    let mut session = open(&place.scene);
    assert!(session.recovery().unwrap().file_changed);
    assert_eq!(shown(&session), "theirs");
    session.recover();
    assert_eq!(shown(&session), "ours");
    assert!(session.save(Overwrite::No).is_err(), "not before somebody has decided");
    let asked = session.take_in(None).unwrap();
    assert_eq!(asked, (Taken::Asked(vec!["scene · title ours here, theirs in the file".into()]), None));
    let (taken, applied) = session.take_in(Some(Side::Theirs)).unwrap();
    assert!(taken == Taken::Whole && applied.is_some() && session.safety().saved);
    assert_eq!(shown(&session), "theirs");
    session.undo().unwrap();
    assert_eq!(shown(&session), "ours");
}

#[test]
fn what_others_do_to_the_file() {
    let both = "{ \"plica\": 1, \"title\": \"start\", \"timeline\": { \"fps\": 5 } }";
    let theirs = SCENE.replace("start", "theirs");
    // The title here, the new file, which side wins; the result, the title, whether it is saved.
    for (ours, file, prefer, taken, title, saved) in [
        (None, Some(SCENE), None, Some("Nothing"), "start", true),
        (None, Some(theirs.as_str()), None, Some("Whole"), "theirs", true),
        (None, None, None, Some("Gone"), "start", false),
        (None, Some("{ half"), None, None, "start", true),
        (Some("ours"), Some(SCENE), None, Some("Nothing"), "ours", false),
        (Some("ours"), Some(theirs.as_str()), None, Some("Asked"), "ours", false),
        (Some("ours"), Some(theirs.as_str()), Some(Side::Mine), Some("Merged"), "ours", false),
        (Some("ours"), Some(theirs.as_str()), Some(Side::Theirs), Some("Whole"), "theirs", true),
        (Some("theirs"), Some(theirs.as_str()), None, Some("Whole"), "theirs", true),
        (Some("ours"), Some(both), None, Some("Merged"), "ours", false),
        (Some("ours"), Some("{ half"), Some(Side::Theirs), None, "ours", false),
        (Some("ours"), None, None, Some("Gone"), "ours", false),
    ] {
        let place = place();
        let mut session = open(&place.scene);
        ours.into_iter().for_each(|title| edit(&mut session, title));
        match file {
            Some(text) => std::fs::write(&place.scene, text).unwrap(),
            None => std::fs::remove_file(&place.scene).unwrap(),
        }
        let case = format!("{ours:?} {file:?} {prefer:?}");
        let found = session.take_in(prefer).ok().map(|(taken, _)| format!("{taken:?}"));
        assert!(found.as_deref().unwrap_or("").starts_with(taken.unwrap_or("")), "{case}: {found:?}");
        assert_eq!(found.is_none(), taken.is_none(), "{case}");
        assert_eq!((shown(&session), session.safety().saved), (title, saved), "{case}");
        let decided = !matches!(taken, Some("Asked") | None);
        assert_eq!(session.save(Overwrite::No).is_ok(), decided, "{case}: a save, once it is decided");
        session.save(Overwrite::Yes).unwrap();
        assert!(std::fs::read_to_string(&place.scene).unwrap().contains(title), "{case}");
        if file == Some(both) {
            assert_eq!(session.document().scene().timeline.fps, 5.0, "{case}");
        }
        // It is at most one step.
        if shown(&session) != ours.unwrap_or("start") {
            session.undo().unwrap();
            assert_eq!(shown(&session), ours.unwrap_or("start"), "{case}");
        }
    }
}

#[test]
fn what_is_offered_stays_offered_while_the_file_changes() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "ours");
    kill(session);
    let mut session = open(&place.scene);
    outside(&place, "theirs");
    assert_eq!(session.take_in(None).unwrap().0, Taken::Whole);
    assert_eq!(shown(&session), "theirs");
    assert!(session.recovery().unwrap().file_changed);
    session.recover();
    assert_eq!(shown(&session), "ours");
    assert!(matches!(session.take_in(None).unwrap().0, Taken::Asked(_)));
}

#[test]
fn who_comes_second_may_look_and_is_told_who_edits() {
    let place = place();
    let first = open(&place.scene);
    let mut second = Session::open(&place.scene, &Options::default(), Mode::EditOrLook).unwrap();
    assert!(second.reads_only());
    assert_eq!(second.held_by().unwrap().pid, std::process::id());
    drop(first);
    outside(&place, "saved by the first");
    assert_eq!(second.take_in(None).unwrap().0, Taken::Whole);
    assert_eq!(shown(&second), "saved by the first");
    let third = Session::open(&place.scene, &Options::default(), Mode::EditOrLook).unwrap();
    assert!(!third.reads_only() && third.held_by().is_none());
    let left: Vec<_> = std::fs::read_dir(place.folder.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert!(left.iter().any(|name| name == ".cat.editor"), "{left:?}");
    drop(third);
    assert!(!place.folder.path().join(".cat.editor").exists());
}

#[test]
fn a_save_does_not_lose_what_another_program_wrote() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "ours");
    outside(&place, "theirs");
    assert!(session.save(Overwrite::No).unwrap_err().to_string().contains("another program"));
    assert!(std::fs::read_to_string(&place.scene).unwrap().contains("theirs"));
    session.save(Overwrite::Yes).unwrap();
    assert!(std::fs::read_to_string(&place.scene).unwrap().contains("ours"));
    assert!(session.safety().saved);
}

#[test]
fn two_may_not_edit_but_anybody_may_look() {
    let place = place();
    let first = open(&place.scene);
    let error = Session::open(&place.scene, &Options::default(), Mode::Edit).unwrap_err().to_string();
    assert!(error.contains(&format!("process {}", std::process::id())), "{error}");
    let link = place.folder.path().join("link.plica.json");
    std::os::unix::fs::symlink(&place.scene, &link).unwrap();
    assert!(Session::open(&link, &Options::default(), Mode::Edit).is_err(), "by another name");
    let mut reader = Session::open(&place.scene, &Options::default(), Mode::ReadOnly).unwrap();
    edit(&mut reader, "mine");
    assert!(reader.save(Overwrite::Yes).unwrap_err().to_string().contains("read only"));
    drop(first);
    open(&place.scene);
}

#[test]
fn a_damaged_journal_gives_what_is_whole_and_keeps_the_rest() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "one");
    edit(&mut session, "two");
    let whole = kill(session);
    let rest = place.scene.with_file_name(".cat.journal.rest");
    for (cut, expected) in [(whole.len() - 1, Some("one")), (whole.len(), Some("two")), (9, None), (0, None)] {
        let mut damaged = whole[..cut].to_vec();
        if cut == whole.len() {
            damaged.extend(b"rubbish");
        }
        std::fs::write(journal::path_beside(&place.scene), &damaged).unwrap();
        let mut session = open(&place.scene);
        assert_eq!(session.recovery().is_some(), expected.is_some(), "cut at {cut}");
        session.recover();
        assert_eq!(shown(&session), expected.unwrap_or("start"));
        assert_eq!(session.kept_aside().is_some(), cut > 0);
        assert_eq!(rest.exists(), cut > 0);
        if cut > 0 {
            let kept = std::fs::read(&rest).unwrap();
            assert!(damaged.ends_with(&kept) && !kept.is_empty());
            std::fs::remove_file(&rest).unwrap();
        }
        drop(session);
    }
}

#[test]
fn a_record_that_cannot_be_done_ends_the_valid_part() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "one");
    kill(session);
    let path = journal::path_beside(&place.scene);
    let bytes = std::fs::read(&path).unwrap();
    let mut record = journal::read(&bytes).unwrap().records[0].0.clone();
    record.patch = Edit(serde_json::from_str(r#"[{"op": "remove", "path": "/nothing"}]"#).unwrap());
    std::fs::write(&path, [bytes, journal::encode(&record)].concat()).unwrap();
    let mut session = open(&place.scene);
    session.recover();
    assert_eq!(shown(&session), "one");
    assert!(session.kept_aside().is_some());
}

#[test]
fn the_journal_is_for_its_owner_alone() {
    use std::os::unix::fs::{MetadataExt, symlink};
    let place = place();
    let path = journal::path_beside(&place.scene);
    let session = open(&place.scene);
    assert_eq!(path.metadata().unwrap().mode() & 0o777, 0o600);
    drop(session);
    let victim = place.folder.path().join("victim");
    std::fs::write(&victim, "precious").unwrap();
    symlink(&victim, &path).unwrap();
    drop(open(&place.scene));
    assert_eq!(std::fs::read_to_string(&victim).unwrap(), "precious");
}

#[test]
fn a_long_journal_drops_its_oldest_part() {
    let place = place();
    let text = std::fs::read_to_string(&place.scene).unwrap();
    let mut document = Document::parse(&text).unwrap();
    let mut history = crate::scene::History::new(document.clone());
    let file = hash::of(text.as_bytes());
    let header = journal::Header { file: file.clone(), document: document.json().clone(), is_file: true };
    let mut found = journal::find(&place.scene).unwrap();
    let mut journal = found.open(&header, 0, 0).unwrap().journal;
    journal.compact_every(2000);
    for n in 1..=200 {
        let applied = history.apply(title(&n.to_string()), Default::default()).unwrap().unwrap();
        document = history.document().clone();
        let (patch, inverse) = (applied.edit, applied.inverse);
        let kind = journal::Kind::Edit;
        let record = journal::Record { revision: n, time: n, step: applied.step, kind, patch, inverse };
        journal.append(&record, &document, &file);
    }
    journal.flush().unwrap();
    assert_eq!((journal.acknowledged(), journal.failing()), (200, None));
    drop(journal);
    let length = std::fs::read(journal::path_beside(&place.scene)).unwrap().len();
    assert!((2000..7000).contains(&length), "{length}");
    let mut session = open(&place.scene);
    session.recover();
    assert_eq!(shown(&session), "200");
    session.undo().unwrap();
    assert_eq!(shown(&session), "199");
}
