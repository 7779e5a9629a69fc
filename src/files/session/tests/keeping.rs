//! What the journal keeps from one session to the next: every branch of undo, edits that were discarded, edits made
//! while there was no journal.

use super::*;

#[test]
fn every_branch_is_there_after_reopening() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "one");
    edit(&mut session, "two");
    session.undo().unwrap();
    session.undo().unwrap();
    edit(&mut session, "other");
    assert_eq!((session.history().state(), session.history().newest()), (3, 3));
    session.travel(|history| history.go_to(2));
    assert_eq!(shown(&session), "two");
    session.undo().unwrap();
    session.redo().unwrap();
    session.travel(|history| history.go_to(3));
    session.save(Overwrite::No).unwrap();
    drop(session);
    let mut session = open(&place.scene);
    assert_eq!((session.history().state(), session.history().newest()), (3, 3));
    let aside: Vec<_> = session.history().told_aside(9).into_iter().map(|told| (told.before, told.state)).collect();
    assert_eq!(aside, [(0, 1), (1, 2)]);
    for (state, title) in [(2, "two"), (1, "one"), (0, "start"), (3, "other"), (2, "two")] {
        session.travel(|history| history.go_to(state));
        assert_eq!((shown(&session), session.safety().saved), (title, state == 3), "{state}");
    }
}

#[test]
fn edits_that_were_given_up_are_not_asked_about_and_undo_has_them() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "saved");
    session.save(Overwrite::No).unwrap();
    edit(&mut session, "no");
    edit(&mut session, "no more");
    session.give_up();
    assert!(session.safety().saved);
    kill(session);
    let mut session = open(&place.scene);
    assert_eq!((shown(&session), session.recovery()), ("saved", None));
    session.undo().unwrap();
    assert_eq!(shown(&session), "no more");
    drop(session);
    // Nothing to discard: nothing is recorded.
    let mut session = open(&place.scene);
    session.discard_recovery();
    let before = session.history().revision();
    session.give_up();
    assert_eq!(session.history().revision(), before);
}

#[test]
fn nothing_is_changed_or_saved_while_unsaved_edits_wait_for_an_answer() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "lost?");
    kill(session);
    let mut session = open(&place.scene);
    let refused = session.apply(title("x"), false).unwrap_err();
    assert!(refused[0].message.contains("1 unsaved change was left behind"), "{refused:?}");
    assert_eq!((session.undo(), session.redo()), (None, None));
    assert!(session.travel(|history| history.go_to(0)).is_empty());
    assert!(session.save(Overwrite::Yes).unwrap_err().to_string().contains("left behind"));
    session.give_up();
    drop(session);
    assert_eq!(open(&place.scene).recovery().map(|offer| offer.changes), Some(1));
}

/// Waits, at most a minute, until the session's edits reach the journal again.
fn tend(session: &mut Session) {
    let begun = std::time::Instant::now();
    while session.safety().failing.is_some() {
        assert!(begun.elapsed().as_secs() < 60, "{:?}", session.safety());
        session.tend();
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

fn undone(session: &mut Session) -> Vec<String> {
    let mut seen = vec![shown(session).to_owned()];
    while session.undo().is_some() {
        seen.push(shown(session).to_owned());
    }
    seen
}

#[test]
fn a_journal_that_could_not_be_written_is_tried_again_and_takes_up_what_was_edited() {
    for (saves, changes) in [(false, 2), (true, 1)] {
        let place = place();
        let mut session = open(&place.scene);
        edit(&mut session, "before");
        session.save(Overwrite::No).unwrap();
        drop(session);
        crate::files::disk::IS_FULL.set(true);
        let mut session = open(&place.scene);
        crate::files::disk::IS_FULL.set(false);
        assert!(session.safety().failing.is_some() && !session.safety().journaled);
        let second = Session::open(&place.scene, &Options::default(), Mode::Edit);
        assert!(second.is_err(), "it is locked all the same");
        edit(&mut session, "meanwhile");
        if saves {
            session.save(Overwrite::No).unwrap();
        }
        tend(&mut session);
        edit(&mut session, "after");
        kill(session);
        let mut session = open(&place.scene);
        assert_eq!(session.recovery().map(|offer| offer.changes), Some(changes));
        session.recover();
        assert_eq!(undone(&mut session), ["after", "meanwhile", "before", "start"]);
    }
}

#[test]
fn a_journal_that_could_not_be_found_is_looked_for_again() {
    let place = place();
    let path = journal::path_beside(&place.scene);
    let mut session = open(&place.scene);
    edit(&mut session, "before");
    session.save(Overwrite::No).unwrap();
    drop(session);
    // A journal of a newer program, which is gone a moment later.
    let mut newer = std::fs::read(&path).unwrap();
    let older = std::mem::replace(&mut newer[8], 9);
    std::fs::write(&path, &newer).unwrap();
    let mut session = open(&place.scene);
    assert!(session.safety().failing.unwrap().contains("newer"));
    edit(&mut session, "meanwhile");
    newer[8] = older;
    std::fs::write(&path, &newer).unwrap();
    tend(&mut session);
    edit(&mut session, "after");
    kill(session);
    let mut session = open(&place.scene);
    session.recover();
    assert_eq!(undone(&mut session), ["after", "meanwhile", "before", "start"]);
}

/// Scenes and journals that earlier versions of the program left: they stay readable for ever. `tests/scenes/old` has
/// one pair for each version of the format.
#[test]
fn scenes_and_journals_of_old_are_read_for_good() {
    let old = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/old");
    let place = place();
    std::fs::copy(old.join("v1-squint.plica.json"), &place.scene).unwrap();
    std::fs::copy(old.join("v1-squint.journal"), journal::path_beside(&place.scene)).unwrap();
    let mut session = open(&place.scene);
    let offer = session.recovery().unwrap();
    assert_eq!((offer.changes, offer.file_changed), (2, false));
    session.recover();
    assert_eq!((shown(&session), session.history().state(), session.history().newest()), ("unsaved", 5, 5));
    let feather = |session: &Session| session.document().json().pointer("/layers/0/zones/0/feather").cloned().unwrap();
    for (state, expected) in [(3, 7), (2, 2), (1, 1), (0, 4)] {
        session.travel(|history| history.go_to(state));
        assert_eq!((feather(&session).as_f64(), session.safety().saved), (Some(f64::from(expected)), state == 3));
    }
}
