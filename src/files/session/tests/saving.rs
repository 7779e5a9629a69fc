//! What a save leaves unchanged: the layout of the text, the file's names, mode and attributes; and whose journal is
//! used.

use std::os::unix::fs::{MetadataExt, PermissionsExt};

use super::*;

fn mode(path: &Path, mode: u32) {
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn every_save_changes_only_what_was_edited() {
    let place = place();
    let written =
        "{\r\n   \"title\":\"start\",\r\n\r\n \"plica\":1,\r\n\t\"timeline\": { \"duration\": 2.50, \"fps\": 1e1 }}";
    std::fs::write(&place.scene, written).unwrap();
    let mut session = open(&place.scene);
    for title in ["one", "two"] {
        edit(&mut session, title);
        session.save(Overwrite::No).unwrap();
        assert_eq!(text(&place.scene), written.replace("start", title));
    }
    session.undo().unwrap();
    session.undo().unwrap();
    session.save(Overwrite::No).unwrap();
    assert_eq!(text(&place.scene), written);
    // What was removed has its bytes again too.
    session.apply(Edit::remove("/timeline"), false).unwrap();
    session.save(Overwrite::No).unwrap();
    assert!(!text(&place.scene).contains("timeline"));
    session.undo().unwrap();
    session.save(Overwrite::No).unwrap();
    assert_eq!(text(&place.scene), written);
    // Another program changes the layout: that is the layout from now on.
    let other = "{\"plica\":1,\"title\":\"start\",\"timeline\":{\"duration\":2.50,\"fps\":1e1}}";
    std::fs::write(&place.scene, other).unwrap();
    session.take_in(None).unwrap();
    edit(&mut session, "three");
    session.save(Overwrite::No).unwrap();
    assert_eq!(text(&place.scene), other.replace("start", "three"));
}

#[test]
fn a_read_only_file_is_written_only_when_told_so() {
    let place = place();
    let mut session = open(&place.scene);
    edit(&mut session, "new");
    mode(&place.scene, 0o444);
    let refused = session.save(Overwrite::No).unwrap_err().to_string();
    assert!(refused.contains("is read-only (make it writable"), "{refused}");
    assert_eq!((text(&place.scene).as_str(), session.safety().saved), (SCENE, false));
    session.save(Overwrite::Yes).unwrap();
    assert!(text(&place.scene).contains("new"));
    assert_eq!(place.scene.metadata().unwrap().mode() & 0o777, 0o444);
}

#[test]
fn hard_links_stay_and_a_save_cut_short_is_ended_at_the_next_opening() {
    let place = place();
    let other = place.folder.path().join("other");
    std::fs::hard_link(&place.scene, &other).unwrap();
    let mut session = open(&place.scene);
    edit(&mut session, "both");
    session.save(Overwrite::No).unwrap();
    drop(session);
    assert_eq!((place.scene.metadata().unwrap().nlink(), text(&other)), (2, SCENE.replace("start", "both")));
    // A crash in the middle of the next save.
    let whole = SCENE.replace("start", "next");
    std::fs::write(crate::files::beside::path(&place.scene, "saving"), &whole).unwrap();
    std::fs::write(&place.scene, &whole[..20]).unwrap();
    assert_eq!(scene::open(&place.scene, &Options::default()).unwrap().scene().title, "next", "whoever only reads");
    let session = open(&place.scene);
    assert_eq!((shown(&session), text(&other)), ("next", whole));
    drop(session);
    let left = std::fs::read_dir(&place.folder).unwrap().count();
    assert_eq!(left, 3, "the scene, its other name, its journal");
}

#[test]
#[cfg(target_os = "linux")]
fn extended_attributes_stay() {
    let place = place();
    let (name, flags) = ("user.note", rustix::fs::XattrFlags::empty());
    if rustix::fs::setxattr(&place.scene, name, b"mine", flags).is_err() {
        return eprintln!("skipped: there are no extended attributes here");
    }
    let mut session = open(&place.scene);
    edit(&mut session, "new");
    session.save(Overwrite::No).unwrap();
    let mut value = [0; 4];
    assert_eq!((rustix::fs::getxattr(&place.scene, name, &mut value[..]), &value), (Ok(4), b"mine"));
}

#[test]
fn a_journal_that_others_may_read_or_reach_is_not_used_as_it_is() {
    let place = place();
    let path = journal::path_beside(&place.scene);
    std::fs::write(&path, "").unwrap();
    mode(&path, 0o666);
    let mut session = open(&place.scene);
    edit(&mut session, "secret");
    session.save(Overwrite::No).unwrap();
    assert_eq!(path.metadata().unwrap().mode() & 0o777, 0o600);
    drop(session);
    std::fs::remove_file(&path).unwrap();
    let precious = place.folder.path().join("precious");
    std::fs::write(&precious, "not a journal").unwrap();
    std::fs::hard_link(&precious, &path).unwrap();
    let found = journal::find(&place.scene).map(|found| found.path().to_owned());
    assert!(found.is_err() || found.is_ok_and(|found| found != path));
    assert_eq!(text(&precious), "not a journal");
}

#[test]
fn scenes_with_names_alike_have_journals_of_their_own() {
    let place = place();
    let other = place.scene.with_file_name("cat");
    std::fs::write(&other, SCENE).unwrap();
    let mut session = open(&place.scene);
    edit(&mut session, "unsaved");
    let other = open(&other);
    assert_eq!((shown(&other), other.recovery()), ("start", None));
}
