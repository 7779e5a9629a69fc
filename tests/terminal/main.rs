//! The real binary in a pseudo-terminal: keys in, screen out, and the terminal restored afterwards.
#![cfg(feature = "tui")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use base64::Engine;
use portable_pty::PtySize;

mod life;
mod pieces;
mod shell;
mod support;
mod tutor;

use support::{Editor, folder, json, on_motion};

#[test]
fn a_picture_becomes_a_scene_that_is_edited_and_saved() {
    let folder = folder();
    let scene = folder.path().join("photo.plica.json");
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("photo.plica.json: made");
    assert!(scene.exists());
    editor.press("/outline\r");
    editor.wait_for("zones.all.outline");
    editor.press("\rjji+=5.5\r");
    editor.wait_for("  *");
    editor.press(":q\r");
    editor.wait_for("unsaved edits");
    editor.press(":wq\r");
    assert_eq!(editor.end(), 0);
    editor.assert_restored();
    assert_eq!(json(&scene).pointer("/layers/0/zones/0/outline/y"), Some(&serde_json::json!(5.5)));
}

#[test]
fn the_log_of_a_session_is_a_script_that_does_the_same_again() {
    let (first, second) = (folder(), folder());
    std::fs::create_dir_all(first.path().join("config/plica")).unwrap();
    let keys = "[everywhere]\n\"F2\" = \"play-macro a\"\n\"g\" = \"undo\"\n";
    std::fs::write(first.path().join("config/plica/keys.toml"), keys).unwrap();
    let mut editor = Editor::open(first.path(), &["photo.png"]);
    editor.wait_for("keys.toml:3: g would hide");
    editor.press("/outline\r\rjj");
    editor.press("qai+=5.5\rq");
    editor.wait_for("macro a has 1 line:");
    editor.press("\x1bOQi7");
    editor.wait_for(" INS ");
    editor.press("\x1b");
    editor.wait_for(" NOR ");
    editor.press(".:wq\r");
    assert_eq!(editor.end(), 0);
    let saved = json(&first.path().join("photo.plica.json"));
    assert_eq!(saved.pointer("/layers/0/zones/0/outline/y"), Some(&serde_json::json!(16.5)));
    let logs = std::fs::read_dir(first.path().join("state/plica/sessions")).unwrap().flatten();
    let log = logs.map(|log| log.path()).next().unwrap();
    let text = std::fs::read_to_string(&log).unwrap();
    let expected = "search outline\npane table\nmove down\nmove down\nput +=5.5\nput +=5.5\nput +=5.5\nwq\n";
    assert!(text.ends_with(expected) && text.starts_with("# plica "), "{text}");
    let mut editor = Editor::open(second.path(), &["photo.png", "--script", log.to_str().unwrap()]);
    assert_eq!(editor.end(), 0);
    assert_eq!(json(&second.path().join("photo.plica.json")), saved);
}

#[test]
fn rows_are_pasted_and_yanked_through_the_terminal() {
    let folder = folder();
    let scene = folder.path().join("photo.plica.json");
    let mut editor = on_motion(folder.path());
    editor.press("\x1b[200~x,y,dx,dy\r1,2,3,4\r5,6,7,8\r\x1b[201~");
    editor.wait_for("2 rows pasted");
    editor.press("gtY");
    let encoded = editor.wait_for_sequence("\x1b]52;c;", "\x07");
    let yanked = base64::engine::general_purpose::STANDARD.decode(encoded).unwrap();
    let expected = "tool,x,y,dx,dy,|J|,°\npoint,1,2,3,4,5,-53.130102354\npoint,5,6,7,8,10.630145813,-48.814074834\n";
    assert_eq!(String::from_utf8(yanked).unwrap(), expected);
    editor.press(":wq\r");
    assert_eq!(editor.end(), 0);
    assert_eq!(json(&scene).pointer("/layers/0/zones/0/motion/1/jump"), Some(&serde_json::json!([7, 8])));
}

#[test]
fn signals_end_the_editor_and_lose_nothing() {
    for name in ["TERM", "HUP", "INT"] {
        let folder = folder();
        let mut editor = Editor::open(folder.path(), &["photo.png"]);
        editor.wait_for("made");
        editor.press("/speed\r+");
        editor.wait_for("  *");
        editor.signal(name);
        editor.end();
        editor.assert_restored();
        let mut editor = Editor::open(folder.path(), &["photo.png"]);
        editor.wait_for("1 unsaved change was left behind");
        editor.press("\r:wq\r");
        assert_eq!(editor.end(), 0, "{name}");
        let scene = json(&folder.path().join("photo.plica.json"));
        assert_eq!(scene.pointer("/layers/0/zones/0/speed"), Some(&serde_json::json!(2)), "{name}");
    }
}

#[test]
fn a_terminal_that_goes_away_ends_the_editor() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+");
    editor.wait_for("  *");
    editor.keys = None;
    editor.master = None;
    editor.signal("HUP");
    editor.end();
}

#[test]
fn help_comes_from_the_table_and_small_terminals_are_waited_for() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("?");
    editor.wait_for("-- tree --");
    // A key that arrives while the size is too small is ignored, so the size is changed only after this is answered.
    editor.press("q:nosuch\r");
    editor.wait_for("no command");
    let size = |rows, cols| PtySize { rows, cols, pixel_width: 0, pixel_height: 0 };
    editor.master.as_ref().unwrap().resize(size(10, 40)).unwrap();
    editor.wait_for("Plica needs 60 x 20");
    editor.master.as_ref().unwrap().resize(size(24, 80)).unwrap();
    editor.wait_for("zones.all");
    editor.press(":q\r");
    assert_eq!(editor.end(), 0);
    editor.assert_restored();
}

#[test]
fn subcommands_run_beside_the_editor_on_the_scene_as_it_is_there() {
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("/speed\r+:render -o out.png --frames 0\r");
    // What it says at its end may cover the status line, so that is what is waited for.
    editor.wait_for("done: out.png");
    assert!(folder.path().join("out.png").is_file());
    editor.press(":q!\r");
    assert_eq!(editor.end(), 0);
    editor.assert_restored();
}

/// A terminal that answers nothing gets half-blocks; with `--graphics` it gets pixels, within the limit of bytes.
#[test]
fn pictures_come_as_the_protocol_wants_them() {
    for (protocol, start, end) in [
        ("kitty", "\x1b_Gi=", "\u{10eeee}"),
        ("iterm2", "\x1b]1337;File=inline=1;", "\x07"),
        ("sixel", "\x1bP0;1;0q\"1;1;", "\x1b\\"),
    ] {
        let folder = folder();
        let mut editor = Editor::open(folder.path(), &["photo.png", "--graphics", protocol]);
        editor.wait_for("made");
        editor.press("gi");
        let body = editor.wait_for_sequence(start, end);
        assert!(body.len() > 500 && body.len() < 256_000, "{protocol}: {} bytes", body.len());
        let plain = |c: char| c.is_ascii_graphic() || "\x1b".contains(c);
        assert!(body.chars().all(plain), "{protocol}");
        editor.press(":q\r");
        assert_eq!(editor.end(), 0);
        editor.assert_restored();
    }
    let folder = folder();
    let mut editor = Editor::open(folder.path(), &["photo.png"]);
    editor.wait_for("made");
    editor.press("gi");
    editor.wait_for("▀▀▀");
    let sent = String::from_utf8_lossy(&editor.sent.lock().unwrap()).into_owned();
    assert!(!["\x1b_G", "\x1b]1337", "\x1bP"].iter().any(|start| sent.contains(start)));
    editor.press(":q\r");
    assert_eq!(editor.end(), 0);
}

#[test]
fn what_cannot_be_opened_is_said_on_a_terminal_left_alone() {
    let folder = folder();
    std::fs::write(folder.path().join("bad.plica.json"), "{").unwrap();
    for name in ["bad.plica.json", "missing.png"] {
        let mut editor = Editor::open(folder.path(), &[name]);
        assert_eq!(editor.end(), 1, "{name}");
        editor.wait_for(name);
        editor.assert_restored();
    }
}
