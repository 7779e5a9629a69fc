//! The process and its surroundings: signals, closed and full outputs, the log, and what reaches a terminal.

#![allow(clippy::unwrap_used, reason = "a test fails where its helpers do")]

mod binary;

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

fn plica(arguments: &[&str], folder: &Path) -> Command {
    let mut command = binary::plica(folder, arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The exit status, and everything printed on either output.
fn outcome(mut command: Command) -> (Option<i32>, String) {
    let Output { status, stdout, stderr } = command.output().unwrap();
    (status.code(), String::from_utf8([stderr, stdout].concat()).unwrap())
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
    assert!(status.unwrap().success());
}

/// Waits until the child listens for signals: then there is a thread for them.
fn listening(child: &Child) {
    let tasks = format!("/proc/{}/task", child.id());
    let named = |entry: std::fs::DirEntry| std::fs::read_to_string(entry.path().join("comm")).unwrap_or_default();
    while !std::fs::read_dir(&tasks).unwrap().flatten().any(|entry| named(entry).trim() == "signals") {
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_signal_ends_with_130_even_where_work_is_stuck() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["INT", "TERM", "HUP", "QUIT", "ALRM", "USR1", "USR2"] {
        // A scene from standard input that never arrives.
        let mut child = plica(&["check", "-"], folder.path()).stdin(Stdio::piped()).spawn().unwrap();
        listening(&child);
        while child.try_wait().unwrap().is_none() {
            signal(&child, name);
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(child.wait().unwrap().code(), Some(130), "{name}");
    }
}

#[test]
fn an_interrupted_render_leaves_nothing_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let image = image::RgbImage::from_pixel(64, 64, image::Rgb([9, 9, 9]));
    image.save(folder.path().join("cat.png")).unwrap();
    // An hour of frames: nobody waits for the end.
    let scene = serde_json::json!({
        "plica": 1, "timeline": { "duration": 3000 }, "images": { "cat": { "path": "cat.png" } },
        "layers": [{ "kind": "picture", "name": "face", "image": "cat" }]
    });
    std::fs::write(folder.path().join("cat.plica.json"), scene.to_string()).unwrap();
    let names = || -> Vec<String> {
        let entries = std::fs::read_dir(folder.path()).unwrap().flatten();
        let mut names: Vec<_> = entries.map(|entry| entry.file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    let before = names();
    for (signals, out) in [(1, "out.apng"), (1, "out.webp"), (1, "%05d.png"), (2, "out.apng")] {
        let mut child = plica(&["render", "cat.plica.json", "-o", out], folder.path()).spawn().unwrap();
        while names() == before {
            assert_eq!(child.try_wait().unwrap(), None, "{out}");
            std::thread::sleep(Duration::from_millis(1));
        }
        for _ in 0..signals {
            signal(&child, "INT");
        }
        assert_eq!(child.wait().unwrap().code(), Some(130), "{out}");
        // Numbered frames that are done stay, and each is complete.
        for name in names().into_iter().filter(|name| out.starts_with('%') && name.starts_with('0')) {
            let path = folder.path().join(name);
            image::open(&path).unwrap();
            std::fs::remove_file(path).unwrap();
        }
        assert_eq!(names(), before, "{out}");
    }
}

#[test]
fn a_stopped_process_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = plica(&["check", "-"], folder.path()).stdin(Stdio::piped()).spawn().unwrap();
    listening(&child);
    signal(&child, "TSTP");
    let state = || std::fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    while !state().contains(") T ") {
        std::thread::sleep(Duration::from_millis(1));
    }
    signal(&child, "CONT");
    drop(child.stdin.take());
    assert_eq!(child.wait().unwrap().code(), Some(1), "an empty scene is an error");
}

#[test]
fn a_closed_pipe_is_no_error_and_a_full_disk_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = plica(&["schema"], folder.path()).spawn().unwrap();
    drop(child.stdout.take());
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!((child.wait().unwrap().code(), said.as_str()), (Some(0), ""));
    if let Ok(full) = File::options().write(true).open("/dev/full") {
        let mut command = plica(&["schema"], folder.path());
        command.stdout(full);
        let (status, said) = outcome(command);
        assert!(status == Some(1) && said.starts_with("plica: standard output: "), "{status:?} {said}");
    }
}

#[test]
fn the_log_is_where_it_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let (status, _) = outcome(plica(&["schema", "--log", "here.log"], folder.path()));
    assert_eq!((status, folder.path().join("here.log").exists()), (Some(0), true));
    assert!(!folder.path().join("state").exists(), "nothing is made where nothing is to be said");
    let (status, said) = outcome(plica(&["--log", "no/such/folder.log", "schema"], folder.path()));
    assert!(status == Some(1) && said.contains("no/such/folder.log"), "{said}");
}

#[test]
fn nothing_from_a_file_steers_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let name = "evil\x1b[2J\u{9b}31m.json";
    std::fs::write(folder.path().join(name), "{ \"pli\\u001b[31mca\": 1, \"\x1b]0;title\x07\": 2 }").unwrap();
    let (status, said) = outcome(plica(&["check", name], folder.path()));
    assert_eq!(status, Some(1));
    assert!(!said.chars().any(|c| c.is_control() && c != '\n'), "{said:?}");
    let (status, said) = outcome(plica(&["check", "missing\x1b[2J"], folder.path()));
    assert!(status == Some(1) && !said.contains('\x1b') && said.contains("no such file"), "{said:?}");
    // Text that the parser of the command line quotes, and text in our own messages.
    for (line, status) in [
        (&["check", "a", "b\x1b[31mRED\x1b]0;title\x07"][..], 2),
        (&["no\x1bsuch"], 2),
        (&["--no-\x1b[2Jsuch"], 2),
        (&["render", "a", "-o", "x.gif", "--samples", "\x1b[31m"], 2),
        (&["probe", "a", "--at", "\u{9b}31m"], 2),
        (&["check", "x\nplica: all is well"], 1),
        (&["get", "a", "x\nplica: all is well"], 1),
        (&["field", "a", "-o", "x\nplica: all is well"], 2),
        (&["check", "a", "x\nplica: all is well"], 2),
    ] {
        let (ended, said) = outcome(plica(line, folder.path()));
        let steers = said.chars().any(|c| c.is_control() && c != '\n');
        let forged = said.lines().any(|line| line.starts_with("plica: all"));
        assert!(ended == Some(status) && !steers && !forged, "{line:?}: {ended:?} {said:?}");
    }
}

#[test]
fn nothing_waits_at_a_fifo() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = |name: &str| {
        let path = folder.path().join(name);
        assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    };
    let scene =
        r#"{"plica": 1, "images": {"f": {"path": "f"}}, "layers": [{"kind": "picture", "name": "l", "image": "f"}]}"#;
    std::fs::write(folder.path().join("s.plica.json"), scene).unwrap();
    ["f", ".s.journal", ".s.editor", "log", "fifo.plica.json"].into_iter().for_each(fifo);
    for (line, status, part) in [
        (&["set", "s.plica.json", "title=cat"][..], 0, ""),
        (&["get", "s.plica.json", "title"], 0, "cat"),
        (&["check", "s.plica.json"], 1, "is a FIFO, not a file"),
        (&["check", "fifo.plica.json"], 1, "is a FIFO, not a file"),
        (&["set", "fifo.plica.json", "title=cat"], 1, "is a FIFO, not a file"),
        (&["schema", "--log", "log"], 1, "log: cannot be written"),
    ] {
        let (ended, said) = outcome(plica(line, folder.path()));
        assert!(ended == Some(status) && said.contains(part), "{line:?}: {ended:?} {said}");
    }
}
