//! A window on another machine, with everything real except the machine: the far end is the real binary behind a pipe,
//! reached by a stand-in for ssh that runs the command on this machine. `tests/sshd.rs` has a real sshd.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use plica::files::cache::Cache;
use plica::files::session::{Mode, Session};
use plica::files::{Options, materials};
use plica::layers::parts::materials::Materials;
use plica::preview::editor::{Event, Preview};
use plica::preview::follow::Update;
use plica::preview::follow::client::Link;
use plica::preview::remote::address::Address;
use plica::preview::remote::ssh::Way;
use plica::preview::remote::{far, fetch};
use plica::preview::wire::message::{FromEditor, Gesture, ToEditor};
use plica::scene::{Document, Edit, Scene};
use serde_json::json;

/// How long a test waits for something that must happen before it fails.
const PATIENCE: Duration = Duration::from_secs(60);

/// A scene with a picture, a cache, and the way to reach it.
struct Stage {
    folder: tempfile::TempDir,
    scene: PathBuf,
    document: Document,
}

fn stage() -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("a s'cene.plica.json");
    paint(folder.path(), 3);
    let document = Document::parse(&text("0")).unwrap();
    std::fs::write(&scene, document.to_text()).unwrap();
    Stage { folder, scene, document }
}

fn text(title: &str) -> String {
    let layer = json!({"kind": "picture", "name": "l", "image": "cat"});
    json!({"plica": 1, "title": title, "images": {"cat": {"path": "cat.png"}}, "layers": [layer]}).to_string()
}

/// Saves as GIMP does: another file, in chunks, renamed over the old one.
fn paint(folder: &Path, width: u32) {
    let new = folder.join("new.png");
    image::RgbImage::from_pixel(width, 2, image::Rgb([9, 9, 9])).save(&new).unwrap();
    std::fs::rename(new, folder.join("cat.png")).unwrap();
}

impl Stage {
    /// Writes a shell script to the folder.
    fn script(&self, name: &str, text: &str) -> String {
        let path = self.folder.path().join(name);
        std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        path.to_str().unwrap().to_owned()
    }

    /// A stand-in for ssh: runs the command here, and writes its process id to a file for cutting the link.
    fn ssh(&self) -> String {
        let runs = "while [ \"$1\" != -- ]; do shift; done; shift; cd; exec sh -c \"exec $*\"";
        self.script("ssh", &format!("echo $$ > {}/pid; {runs}", self.folder.path().display()))
    }

    fn way(&self, program: String) -> Way {
        let address = Address { user: None, host: "far".into(), port: None, path: self.scene.to_str().unwrap().into() };
        let remote_plica = env!("CARGO_BIN_EXE_plica").to_owned();
        Way { address, program, remote_plica, options: Options::default() }
    }

    fn window(&self) -> Window {
        let way = self.way(self.ssh());
        let (cache, copies) = (Cache::at(self.folder.path().join("cache"), 1 << 20).unwrap(), fetch::Shared::default());
        let connected = way.connect(drop).unwrap();
        let link = far::follow(way, connected, cache, copies.clone()).unwrap();
        Window { link, copies }
    }

    fn editor(&self) -> (Preview, Receiver<Event>) {
        let (sender, events) = channel();
        (Preview::start(&self.scene, &self.document, 0, move |event| drop(sender.send(event))), events)
    }

    fn cut(&self) {
        let pid = std::fs::read_to_string(self.folder.path().join("pid")).unwrap();
        Command::new("kill").args(["-9", pid.trim()]).status().unwrap();
    }
}

struct Window {
    link: Link,
    copies: fetch::Shared,
}

impl Window {
    fn next<T>(&self, wanted: impl Fn(&Update) -> Option<T>) -> T {
        loop {
            let update = self.link.updates.recv_timeout(PATIENCE).expect("an update");
            if let Some(found) = wanted(&update) {
                return found;
            }
        }
    }

    /// Waits for the scene with this title and answers that it is shown; returns what is loaded of its pictures.
    fn shows(&self, title: &str) -> Materials {
        let (scene, revision) = self.next(|update| match update {
            Update::Scene { document, revision } if document.scene().title == title => {
                Some((document.scene().clone(), *revision))
            }
            _ => None,
        });
        self.link.replies.send(ToEditor::Ack { revision, synth_ms: 1.5 }).unwrap();
        self.load(&scene)
    }

    fn load(&self, scene: &Scene) -> Materials {
        let copies = self.copies.lock().unwrap().clone();
        materials::gather_copies(&copies, scene, &Options::default(), &mut materials::Cache::default()).0
    }

    fn notice(&self, part: &str) {
        self.next(|update| {
            matches!(update, Update::Said(FromEditor::Notice(line)) if line.contains(part)).then_some(())
        });
    }

    /// Waits until the picture has this width.
    fn is_wide(&self, width: usize) {
        self.next(|update| match update {
            Update::Scene { document, .. } if self.load(document.scene()).pictures["cat"].width() == width => Some(()),
            _ => None,
        });
    }
}

fn titled(document: &Document, title: &str) -> (Document, Edit) {
    let edit: Edit = serde_json::from_value(json!([{"op": "replace", "path": "/title", "value": title}])).unwrap();
    (document.apply(&edit).unwrap(), edit)
}

#[test]
fn the_file_is_followed_there_with_its_pictures() {
    let stage = stage();
    let window = stage.window();
    assert_eq!(window.shows("0").pictures["cat"].width(), 3, "a scene comes with its pictures");
    window.notice("far: following the file");
    let set = Command::new(env!("CARGO_BIN_EXE_plica")).arg("set").arg(&stage.scene).arg("title=set").status();
    assert!(set.unwrap().success());
    window.shows("set");
    std::fs::write(&stage.scene, "{\"plica\": 1, ").unwrap();
    window.next(|update| match update {
        Update::Said(FromEditor::Problems(problems)) => {
            problems.iter().any(|p| p.to_string().contains("line 1")).then_some(())
        }
        _ => None,
    });
    std::fs::write(&stage.scene, text("mended")).unwrap();
    window.shows("mended");
    paint(stage.folder.path(), 5);
    window.is_wide(5);
    assert_eq!(std::fs::read_dir(stage.folder.path().join("cache")).unwrap().count(), 2, "both are kept");
}

#[test]
fn an_editor_there_is_joined_and_hears_the_window() {
    let stage = stage();
    let (editor, events) = stage.editor();
    editor.say(FromEditor::Selection(Some("/layers/0".into())));
    editor.view("view-field");
    let window = stage.window();
    window.shows("0");
    let selected = |update: &Update| {
        matches!(update, Update::Said(FromEditor::Selection(Some(at))) if at == "/images").then_some(())
    };
    let (document, edit) = titled(&stage.document, "1");
    editor.publish(&document, 1, &edit);
    window.shows("1");
    editor.say(FromEditor::Selection(Some("/images".into())));
    window.next(selected);
    for reply in [
        ToEditor::Report { fps: 60.0, adapter: "far".into(), notice: String::new() },
        Gesture::Pointer { x: 1.0, y: 2.0 }.into(),
        Gesture::Command("play".into()).into(),
    ] {
        window.link.replies.send(reply.clone()).unwrap();
        loop {
            if matches!(events.recv_timeout(PATIENCE).expect("an event"), Event::Said(said) if said == reply) {
                break;
            }
        }
    }
    assert_eq!(editor.status().to_string(), "connected 60 fps");
    drop(editor);
    window.notice("following the file");
}

#[test]
fn a_lost_link_keeps_the_last_state_and_comes_back() {
    let stage = stage();
    let (editor, _events) = stage.editor();
    editor.view("view-field");
    let window = stage.window();
    let seen = std::cell::Cell::new((false, false));
    window.next(|update| {
        match update {
            Update::Said(FromEditor::View(name)) if name == "view-field on" => seen.set((true, seen.get().1)),
            Update::Scene { .. } => seen.set((seen.get().0, true)),
            _ => {}
        }
        (seen.get() == (true, true)).then_some(())
    });
    stage.cut();
    window.notice("reconnecting: the connection was lost");
    let (document, edit) = titled(&stage.document, "meanwhile");
    editor.publish(&document, 1, &edit);
    window.next(|update| match update {
        Update::Said(FromEditor::View(name)) => panic!("{name} is switched over"),
        Update::Scene { document, .. } if document.scene().title == "meanwhile" => Some(()),
        _ => None,
    });
    let (document, edit) = titled(&document, "after");
    editor.publish(&document, 2, &edit);
    // It is sent nothing more until it shows what it has.
    window.link.replies.send(ToEditor::Ack { revision: 1, synth_ms: 1.0 }).unwrap();
    window.shows("after");
}

#[test]
fn who_does_not_want_to_wait_tries_now() {
    let stage = stage();
    let window = stage.window();
    window.shows("0");
    let away = stage.folder.path().join("away");
    std::fs::rename(stage.folder.path().join("ssh"), &away).unwrap();
    stage.script("ssh", "echo 'ssh: connect to host far port 22: No route to host' >&2; exit 255");
    stage.cut();
    window.notice("again in 5 s, T tries now");
    std::fs::rename(&away, stage.folder.path().join("ssh")).unwrap();
    let began = std::time::Instant::now();
    window.link.replies.send(Gesture::Command("try-now".into()).into()).unwrap();
    window.notice("far: connected again");
    assert!(began.elapsed() < Duration::from_secs(4), "{:?}", began.elapsed());
}

#[test]
fn a_recovery_that_is_offered_there_is_told_here() {
    let stage = stage();
    let mut session = Session::open(&stage.scene, &Options::default(), Mode::Edit).unwrap();
    session.apply(titled(&stage.document, "unsaved").1, false).unwrap();
    drop(session);
    stage.window().notice("far: following the file; 1 unsaved change was left behind");
}

#[test]
fn what_is_wrong_on_the_way_is_one_clear_line() {
    let stage = stage();
    let older = r"printf 'PLCA\011\000\001\000\000\000\000\000'; sleep 1";
    let table = [
        ("sh: plica: not found", "echo 'sh: plica: not found' >&2; exit 127", "far: there is no", "--remote-plica"),
        (
            "refused",
            "echo 'ssh: connect to host far port 22: Connection refused' >&2; exit 255",
            "Connection refused",
            "",
        ),
        ("another version", older, "speaks version 9", "here is plica"),
        ("an old plica", "echo \"error: unrecognized subcommand 'attach'\" >&2; exit 2", "too old", "install"),
        ("a chatty shell", "echo Welcome; sleep 1", "speaks before plica", "start-up file"),
        ("an echo", "cat", "cannot be understood", ""),
        ("nothing at all", "exit 0", "ended before", ""),
        ("its own reason", "echo 'plica: a\x1b[2J: broken' >&2; exit 1", "far: a[2J: broken", ""),
    ];
    for (name, script, reason, cure) in table {
        let way = stage.way(stage.script("fake", script));
        let error = way.connect(drop).err().expect(name).to_string();
        assert!(error.contains(reason) && error.contains(cure) && !error.contains('\n'), "{name}: {error}");
    }
    let error = stage.way("/no/ssh".into()).connect(drop).err().unwrap().to_string();
    assert!(error.contains("cannot be started"), "{error}");
    let mut way = stage.way(stage.ssh());
    way.address.path = "/no/such.plica.json".into();
    let error = way.connect(drop).err().unwrap().to_string();
    assert!(error.contains("there is no such scene"), "{error}");
    std::fs::write(&stage.scene, "{").unwrap();
    let error = stage.way(stage.ssh()).connect(drop).err().unwrap().to_string();
    assert!(error.contains("line 1"), "{error}");
}

#[test]
fn the_far_end_refuses_what_is_no_window() {
    let stage = stage();
    for (name, said, reason) in [
        ("garbage", "GET / HTTP/1.1\\r\\n\\r\\n", "not plica"),
        ("another version", "PLCA\\011\\000\\001\\000\\000\\000\\000\\000", "version 9"),
        ("nothing, for two seconds", "", "does not answer"),
    ] {
        let plica = env!("CARGO_BIN_EXE_plica");
        let line = format!(
            "(printf '{said}'; sleep 3) | {plica} attach --stdio '{}'",
            stage.folder.path().join("a s'cene.plica.json").display().to_string().replace('\'', "'\\''")
        );
        let out = Command::new("sh").args(["-c", &line]).output().unwrap();
        let told = String::from_utf8_lossy(&out.stdout).into_owned();
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert!(told.contains(reason) && said.contains(reason) && said.lines().count() == 1, "{name}: {told} {said}");
    }
}
