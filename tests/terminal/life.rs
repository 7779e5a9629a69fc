//! Terminals that go away, and other processes beside the editor: what is acknowledged is never lost.

use serde_json::json;

use crate::support::{Editor, folder, json as read};

/// The speed of the only zone in the file.
fn saved_speed(folder: &tempfile::TempDir) -> serde_json::Value {
    let scene = read(&folder.path().join("photo.plica.json"));
    scene.pointer("/layers/0/zones/0/speed").cloned().unwrap_or(json!(1))
}

#[test]
fn a_killed_editor_offers_in_words_what_it_had() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+++");
    editor.wait_until_synced();
    editor.signal("KILL");
    editor.end();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("left behind");
    editor.wait_for("all · speed 1 → 4");
    editor.press("jj\r");
    editor.wait_for("what differs");
    editor.press("q");
    editor.wait_for("left behind");
    editor.press("kk\r");
    editor.wait_without("left behind");
    editor.press(":wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(4)));
}

#[test]
fn a_second_editor_is_told_who_edits_and_follows() {
    let folder = folder();
    let mut first = Editor::open(folder.path(), &["photo.png"]);
    first.wait_for("made");
    let mut second = Editor::open(folder.path(), &["photo.png"]);
    second.wait_for("is being edited by");
    second.wait_for(&first.child.process_id().unwrap().to_string());
    second.press("\r");
    second.wait_for("  RO");
    second.press("/speed\r+");
    second.wait_for("read-only");
    first.press("/speed\r+:w\r");
    first.wait_for("is saved");
    second.wait_for("the file was saved");
    second.press(":q\r");
    assert_eq!(second.end(), 0);
    let mut third = Editor::open(folder.path(), &["photo.png"]);
    third.wait_for("is being edited by");
    third.press("j\r");
    assert_eq!(third.end(), 0, "it may leave at once");
    first.press(":q\r");
    assert_eq!((first.end(), saved_speed(&folder)), (0, json!(2)));
}

#[test]
fn another_program_changes_the_file_and_nothing_is_lost() {
    let folder = folder();
    let scene = folder.path().join("photo.plica.json");
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+");
    editor.wait_for("  *");
    let text = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, text.replace("\"all\"", "\"whole\"")).unwrap();
    editor.wait_for("its changes are merged");
    let mut theirs = read(&scene);
    theirs["layers"][0]["zones"][0]["speed"] = json!(7);
    std::fs::write(&scene, theirs.to_string()).unwrap();
    editor.wait_for("2 here, 7 in the file");
    editor.press("jjj\r:w\r");
    editor.wait_for(":w! overwrites it");
    assert_eq!(saved_speed(&folder), json!(7));
    editor.press(":merge mine\r:wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(2)));
    assert_eq!(read(&scene)["layers"][0]["zones"][0]["name"], json!("whole"));
}

#[test]
fn ctrl_z_gives_the_terminal_back_and_fg_draws_anew() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+");
    editor.wait_for("  *");
    editor.press("\u{1a}");
    editor.wait_until_stopped();
    editor.assert_restored();
    editor.signal("CONT");
    editor.wait_for("  *");
    editor.press("+:wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(3)));
    editor.assert_restored();
}

#[test]
fn what_a_shell_writes_while_the_editor_is_stopped_is_gone_when_it_goes_on() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+");
    editor.wait_for("  *");
    editor.signal("STOP");
    editor.wait_until_stopped();
    let terminal = format!("/proc/{}/fd/0", editor.child.process_id().unwrap());
    assert!(std::process::Command::new("stty").args(["-F", &terminal, "sane"]).status().unwrap().success());
    editor.seen.lock().unwrap().process(b"\x1b[?1049l$ ls");
    editor.signal("CONT");
    editor.wait_for("  *");
    editor.wait_without("$ ls");
    editor.press("+:wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(3)));
    editor.assert_restored();
}

#[test]
fn a_storm_of_sizes_loses_no_key() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r");
    for i in 0..200 {
        editor.resize(20 + i % 40, 80 + (i * 7) % 120);
        editor.press("+");
    }
    editor.resize(24, 80);
    editor.wait_for("201");
    editor.press(":wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(201)));
}

/// The terminal here answers no queries: if the editor sent one, it would take the following keys for the answer.
#[test]
fn drawing_anew_loses_no_key() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r");
    editor.press(&"\x0c+".repeat(40));
    editor.wait_for("41");
    editor.press(":wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(41)));
}

#[test]
fn a_closed_terminal_ends_the_editor_by_itself() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+");
    editor.wait_until_synced();
    editor.close();
    editor.end();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("all · speed 1 → 2");
    editor.press("\r:wq\r");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(2)));
}

#[test]
fn a_dumb_terminal_takes_lines() {
    let folder = folder();
    let mut editor = Editor::dumb(folder.path(), &["photo.png"]);
    editor.wait_for("plica> ");
    editor.press("set layers.photo.zones.all.speed=3\n");
    editor.wait_for("plica*> ");
    editor.press("q\n");
    editor.wait_for("unsaved edits");
    editor.press("render -o out.gif --frames 0-3\nwq\n");
    assert_eq!((editor.end(), saved_speed(&folder)), (0, json!(3)));
    assert!(folder.path().join("out.gif").exists());
}
