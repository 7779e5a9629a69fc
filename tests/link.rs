//! Editor and window over the real socket, in one process and in two: what one sends the other shows, and neither is
//! affected if the other dies. The other process is this test binary again; an environment variable says which part it
//! plays.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use plica::base::error::Error;
use plica::base::problem::Problem;
use plica::files::Options;
use plica::files::session::{Mode, Overwrite, Session};
use plica::preview::Transport;
use plica::preview::editor::script;
use plica::preview::editor::{Event, Preview, Status};
use plica::preview::follow::Update;
use plica::preview::follow::client::{self, Link};
use plica::preview::wire::frame::{self, most};
use plica::preview::wire::message::{FromEditor, Gesture, Role, ToEditor};
use plica::preview::wire::socket::socket_path;
use plica::scene::Document;
use plica::scene::edit::Edit;
use serde_json::{Value, json};

/// How long a test waits for something that must happen before it fails.
const PATIENCE: Duration = Duration::from_secs(60);

/// How often each side is killed; `tests/kills.rs` makes it a hundred kills in total, with a real window.
const KILLS: usize = 45;

struct Stage {
    _folder: tempfile::TempDir,
    scene: PathBuf,
    document: Document,
}

fn stage() -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("s.plica.json");
    let document = Document::parse(&text("0")).unwrap();
    std::fs::write(&scene, document.to_text()).unwrap();
    Stage { _folder: folder, scene, document }
}

fn text(title: &str) -> String {
    json!({"plica": 1, "title": title}).to_string()
}

impl Stage {
    fn editor(&self) -> (Preview, Receiver<Event>) {
        let (sender, events) = channel();
        (Preview::start(&self.scene, &self.document, 0, move |event| drop(sender.send(event))), events)
    }

    fn window(&self) -> Link {
        client::follow(&self.scene, &Options::default(), false)
    }

    /// A peer for which the test writes the protocol itself.
    fn peer(&self) -> UnixStream {
        let peer = UnixStream::connect(socket_path(&self.scene).unwrap()).unwrap();
        peer.set_read_timeout(Some(PATIENCE)).unwrap();
        peer
    }

    /// A peer that has joined as a window and received the first document.
    fn joined(&self) -> UnixStream {
        let mut peer = self.peer();
        frame::write(&mut peer, &ToEditor::Hello { program: "test".into(), role: Role::Window }).unwrap();
        assert!(matches!(hear(&mut peer), FromEditor::Hello { revision: 0, .. }));
        peer
    }
}

fn hear(peer: &mut UnixStream) -> FromEditor {
    frame::read(peer, most()).unwrap().expect("the editor is there")
}

/// An edit of the title, and the document it makes.
fn titled(document: &Document, title: &str) -> (Document, Edit) {
    let edit: Edit = serde_json::from_value(json!([{"op": "replace", "path": "/title", "value": title}])).unwrap();
    (document.apply(&edit).unwrap(), edit)
}

fn publish(editor: &Preview, document: &Document, revisions: std::ops::RangeInclusive<u64>) -> Document {
    revisions.fold(document.clone(), |document, revision| {
        let (document, edit) = titled(&document, &revision.to_string());
        editor.publish(&document, revision, &edit);
        document
    })
}

/// The first update that `wanted` accepts; those before it are skipped.
fn next<T>(link: &Link, wanted: impl Fn(&Update) -> Option<T>) -> T {
    loop {
        let update = link.updates.recv_timeout(PATIENCE).expect("an update");
        if let Some(found) = wanted(&update) {
            return found;
        }
    }
}

fn next_title(link: &Link) -> (String, u64) {
    next(link, |update| match update {
        Update::Scene { document, revision } => Some((document.scene().title.clone(), *revision)),
        _ => None,
    })
}

/// Waits for a problem whose text contains `part`.
fn problem(link: &Link, part: &str) {
    let said = |problems: &[Problem]| problems.iter().any(|problem| problem.to_string().contains(part));
    next(link, |update| matches!(update, Update::Said(FromEditor::Problems(problems)) if said(problems)).then_some(()));
}

fn notice(link: &Link, part: &str) {
    next(link, |update| matches!(update, Update::Said(FromEditor::Notice(line)) if line.contains(part)).then_some(()));
}

fn until(events: &Receiver<Event>, editor: &Preview, wanted: impl Fn(&Status) -> bool) {
    while !wanted(&editor.status()) {
        events.recv_timeout(PATIENCE).expect("an event");
    }
}

fn windows(wanted: usize) -> impl Fn(&Status) -> bool {
    move |status| match status {
        Status::Connected { windows, .. } => *windows == wanted,
        _ => wanted == 0,
    }
}

fn shown(link: &Link, revision: u64) {
    link.replies.send(ToEditor::Ack { revision, synth_ms: 1.5 }).unwrap();
}

#[test]
fn a_window_gets_the_state_and_then_joined_edits() {
    let stage = stage();
    let (editor, events) = stage.editor();
    editor.say(FromEditor::Selection(Some("/layers/0".into())));
    let half = Transport { playing: true, time: 0.5, speed: 2.0 };
    editor.say(FromEditor::Transport(half));
    let window = stage.window();
    assert_eq!(next_title(&window), ("0".into(), 0));
    let selection = next(&window, |update| match update {
        Update::Said(FromEditor::Selection(pointer)) => Some(pointer.clone()),
        _ => None,
    });
    assert_eq!(selection.as_deref(), Some("/layers/0"));
    let transport = next(&window, |update| match update {
        Update::Said(FromEditor::Transport(transport)) => Some(*transport),
        _ => None,
    });
    assert_eq!(transport, half);
    shown(&window, 0);
    until(&events, &editor, |status| matches!(status, Status::Connected { synth_ms: Some(_), .. }));
    let document = publish(&editor, &stage.document, 1..=1);
    assert_eq!(next_title(&window), ("1".into(), 1));
    publish(&editor, &document, 2..=9);
    editor.view("view-field");
    next(&window, |update| {
        matches!(update, Update::Said(FromEditor::View(name)) if name == "view-field on").then_some(())
    });
    shown(&window, 1);
    assert_eq!(next_title(&window), ("9".into(), 9), "eight edits in one patch");
}

#[test]
fn the_editor_hears_the_window() {
    let stage = stage();
    let (editor, events) = stage.editor();
    let window = stage.window();
    next_title(&window);
    let report = |fps| ToEditor::Report { fps, adapter: "a\u{1b}b".into(), notice: String::new() };
    window.replies.send(Gesture::Pointer { x: f64::NAN, y: 0.0 }.into()).unwrap();
    window.replies.send(report(60.0)).unwrap();
    window.replies.send(Gesture::Pointer { x: 1.5, y: -2.0 }.into()).unwrap();
    window.replies.send(Gesture::Transport(Transport { playing: true, time: 0.5, speed: 2.0 }).into()).unwrap();
    window.replies.send(Gesture::Command("mark-point".into()).into()).unwrap();
    let mut heard = Vec::new();
    while heard.len() < 3 {
        let event = events.recv_timeout(PATIENCE).expect("an event");
        if let Event::Said(ToEditor::Gesture(reply)) = event {
            heard.push(format!("{reply:?}"));
        }
    }
    let transport = "Transport(Transport { playing: true, time: 0.5, speed: 2.0 })";
    assert_eq!(heard, ["Pointer { x: 1.5, y: -2.0 }", transport, "Command(\"mark-point\")"]);
    assert_eq!(editor.status().to_string(), "connected 60 fps");
    assert!(matches!(editor.status(), Status::Connected { adapter, .. } if adapter == "ab"));
}

#[test]
fn a_stuck_window_holds_nobody_up() {
    let stage = stage();
    let (editor, _events) = stage.editor();
    let _stuck = stage.joined();
    let window = stage.window();
    next_title(&window);
    shown(&window, 0);
    // Far more than fits in any buffer between the two.
    let long = "x".repeat(1 << 20);
    let mut document = stage.document.clone();
    for revision in 1..=50 {
        let (after, edit) = titled(&document, &format!("{revision}{long}"));
        editor.publish(&after, revision, &edit);
        document = after;
    }
    loop {
        let (title, revision) = next_title(&window);
        assert!(title.starts_with(&revision.to_string()));
        if revision == 50 {
            break;
        }
        shown(&window, revision);
    }
}

#[test]
fn a_patch_that_does_not_fit_is_answered_with_the_scene() {
    let stage = stage();
    let (editor, _events) = stage.editor();
    let mut peer = stage.joined();
    publish(&editor, &stage.document, 1..=3);
    frame::write(&mut peer, &ToEditor::WantScene).unwrap();
    loop {
        if let FromEditor::Scene { revision, document } = hear(&mut peer) {
            assert_eq!((revision, &document["title"]), (3, &Value::from("3")));
            return;
        }
    }
}

#[test]
fn bad_peers_are_refused_and_harm_nobody() {
    let stage = stage();
    let (editor, _events) = stage.editor();
    let hello = |role| {
        let mut bytes = Vec::new();
        frame::write(&mut bytes, &ToEditor::Hello { program: "test".into(), role }).unwrap();
        bytes
    };
    let mut edit = hello(Role::Window);
    frame::write(&mut edit, &ToEditor::Edit { revision: 0, patch: Edit::default() }).unwrap();
    let mut pointer = hello(Role::Script);
    frame::write(&mut pointer, &ToEditor::from(Gesture::Pointer { x: 0.0, y: 0.0 })).unwrap();
    let mut newer = hello(Role::Window);
    newer[4] = 9;
    let mut huge = hello(Role::Window);
    huge[8..12].fill(0xff);
    let half = hello(Role::Window)[..20].to_vec();
    let mut cut_later = hello(Role::Window);
    cut_later.extend(&half);
    let table: [(&str, Vec<u8>, bool, &str); 8] = [
        ("garbage", b"GET / HTTP/1.1\r\n\r\n".to_vec(), false, "not plica"),
        ("another version", newer, false, "version 9"),
        ("a huge length", huge, false, "is the most"),
        ("nothing at all", Vec::new(), false, "does not answer"),
        ("half a hello", half, true, "in the middle"),
        ("half a message", cut_later, true, ""),
        ("a window that edits", edit, false, ""),
        ("a script that points", pointer, false, ""),
    ];
    for (name, bytes, cut, reason) in table {
        let mut peer = stage.peer();
        peer.write_all(&bytes).unwrap();
        if cut {
            peer.shutdown(std::net::Shutdown::Write).unwrap();
        }
        // The end of the stream shows that the editor hung up.
        let mut answer = Vec::new();
        drop(peer.read_to_end(&mut answer));
        assert!(String::from_utf8_lossy(&answer).contains(reason), "{name}: {}", String::from_utf8_lossy(&answer));
    }
    let window = stage.window();
    assert_eq!(next_title(&window).0, "0");
    drop(editor);
}

#[test]
fn scripts_edit_through_the_editor() {
    let stage = stage();
    assert!(script::document(&stage.scene).is_none());
    assert!(script::edit(&stage.scene, |_| Ok(Edit::default())).is_none());
    let (editor, events) = stage.editor();
    let mut document = publish(&editor, &stage.document, 1..=1);
    let part = std::thread::spawn(move || {
        // The editor's part: accepts every edit that fits the document.
        let mut revision = 1;
        for event in events {
            let Event::Edit(asked) = event else { continue };
            match document.apply(&asked.edit) {
                Ok(after) => {
                    revision += 1;
                    editor.publish(&after, revision, &asked.edit);
                    document = after;
                    asked.answer(Vec::new());
                }
                Err(problems) => asked.answer(problems),
            }
            if document.scene().title == "last" {
                return;
            }
        }
    });
    let seen = script::document(&stage.scene).unwrap().unwrap();
    assert_eq!(seen.scene().title, "1");
    let wrong = |_: &Document| Ok(serde_json::from_value(json!([{"op": "remove", "path": "/plica"}])).unwrap());
    match script::edit(&stage.scene, wrong) {
        Some(Err(Error::Scene { problems, .. })) => assert!(!problems.is_empty()),
        other => panic!("{other:?}"),
    }
    script::edit(&stage.scene, |document| Ok(titled(document, "two").1)).unwrap().unwrap();
    assert_eq!(script::document(&stage.scene).unwrap().unwrap().scene().title, "two");
    script::edit(&stage.scene, |document| Ok(titled(document, "last").1)).unwrap().unwrap();
    part.join().unwrap();
}

#[test]
fn an_editor_that_takes_no_edits_says_so() {
    let stage = stage();
    let (_editor, events) = stage.editor();
    let part = std::thread::spawn(move || events.iter().for_each(drop));
    let refused = script::edit(&stage.scene, |document| Ok(titled(document, "x").1)).unwrap().unwrap_err();
    assert!(refused.to_string().contains("does not take the edit"), "{refused}");
    drop(_editor);
    part.join().unwrap();
}

#[test]
fn one_scene_has_one_editor() {
    let stage = stage();
    let (editor, _events) = stage.editor();
    let (second, _) = stage.editor();
    let status = second.status().to_string();
    assert!(status.contains("another editor has this scene open"), "{status}");
    drop(second);
    let _window = stage.joined();
    drop(editor);
    let (third, _) = stage.editor();
    assert_eq!(third.status(), Status::Off);
}

#[test]
fn the_socket_is_private_and_goes_with_the_editor() {
    use std::os::unix::fs::PermissionsExt;
    let stage = stage();
    let path = socket_path(&stage.scene).unwrap();
    let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
    let (editor, _events) = stage.editor();
    assert_eq!((mode(&path), mode(path.parent().unwrap())), (0o600, 0o700));
    drop(editor);
    assert!(!path.exists());
}

#[test]
fn an_editor_that_leaves_says_goodbye() {
    let stage = stage();
    for joined in [false, true] {
        let (editor, _events) = stage.editor();
        let window = client::follow(&stage.scene, &Options::default(), joined);
        notice(&window, "joined");
        drop(editor);
        if joined {
            next(&window, |update| matches!(update, Update::Said(FromEditor::Bye(_))).then_some(()));
        } else {
            notice(&window, "following the file");
        }
    }
}

#[test]
fn without_an_editor_the_file_is_followed_and_the_last_good_scene_stays() {
    let stage = stage();
    let window = stage.window();
    assert_eq!(next_title(&window), ("0".into(), 0));
    notice(&window, "following the file");
    let write = |text: &str| std::fs::write(&stage.scene, text).unwrap();
    write("{\"plica\": 1, ");
    problem(&window, "line 1");
    write(&text("mended"));
    assert_eq!(next_title(&window).0, "mended", "nothing but the problem came while the file was broken");
    std::fs::remove_file(&stage.scene).unwrap();
    problem(&window, "");
    write(&text("back"));
    assert_eq!(next_title(&window).0, "back");
}

#[test]
fn what_a_session_left_behind_is_told() {
    let stage = stage();
    let mut session = Session::open(&stage.scene, &Options::default(), Mode::Edit).unwrap();
    let (_, edit) = titled(&stage.document, "unsaved");
    session.apply(edit, false).unwrap();
    drop(session);
    let window = stage.window();
    assert_eq!(next_title(&window).0, "0");
    notice(&window, "following the file; 1 unsaved change was left behind");
    // It is still offered, and once it is answered nothing is told any more.
    let mut session = Session::open(&stage.scene, &Options::default(), Mode::Edit).unwrap();
    session.recover();
    session.save(Overwrite::No).unwrap();
    drop(session);
    assert_eq!(next_title(&window).0, "unsaved");
    next(&window, |update| {
        matches!(update, Update::Said(FromEditor::Notice(line)) if line == "following the file").then_some(())
    });
}

#[test]
fn a_window_may_wait_for_its_scene() {
    let stage = stage();
    std::fs::remove_file(&stage.scene).unwrap();
    let window = stage.window();
    problem(&window, "");
    let (editor, _events) = stage.editor();
    assert_eq!(next_title(&window).0, "0");
    drop(editor);
}

/// Plays one part of the two-process tests; does nothing when run as a test.
#[test]
fn other_process() {
    let (Ok(part), Ok(scene)) = (std::env::var("PLICA_TEST_PART"), std::env::var("PLICA_TEST_SCENE")) else { return };
    let scene = PathBuf::from(scene);
    let say = |line: String| {
        println!("\n{line}");
        std::io::stdout().flush().unwrap();
    };
    if part == "window" {
        let link = client::follow(&scene, &Options::default(), false);
        loop {
            let (title, revision) = next_title(&link);
            shown(&link, revision);
            say(format!("shows {title}"));
        }
    }
    let document = Document::parse(&text("0")).unwrap();
    let editor = Preview::start(&scene, &document, 0, |_| {});
    publish(&editor, &document, 1..=part.parse().unwrap());
    say("ready".into());
    std::thread::park();
}

struct Other(Child);

impl Other {
    fn start(part: &str, scene: &Path) -> (Self, impl FnMut(&str)) {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "other_process", "--nocapture"])
            .env("PLICA_TEST_PART", part)
            .env("PLICA_TEST_SCENE", scene)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let wait_for = move |wanted: &str| {
            lines.by_ref().map(|line| line.unwrap()).find(|line| line == wanted).expect("the other process speaks");
        };
        (Other(child), wait_for)
    }

    /// `kill -9`.
    fn kill(mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

#[test]
fn a_window_outlives_its_editors() {
    let stage = stage();
    let window = stage.window();
    assert_eq!(next_title(&window).0, "0");
    for part in ["3", "5", "4"].into_iter().cycle().take(KILLS) {
        let (editor, mut wait_for) = Other::start(part, &stage.scene);
        wait_for("ready");
        loop {
            let (title, revision) = next_title(&window);
            shown(&window, revision);
            if title == part {
                break;
            }
        }
        editor.kill();
        notice(&window, "the editor is gone");
    }
}

#[test]
fn an_editor_outlives_its_windows() {
    let stage = stage();
    let (editor, events) = stage.editor();
    let mut document = stage.document.clone();
    for revision in 1..=KILLS as u64 {
        let (window, mut wait_for) = Other::start("window", &stage.scene);
        wait_for(&format!("shows {}", revision - 1));
        document = publish(&editor, &document, revision..=revision);
        wait_for(&format!("shows {revision}"));
        until(&events, &editor, windows(1));
        window.kill();
        until(&events, &editor, windows(0));
    }
}
