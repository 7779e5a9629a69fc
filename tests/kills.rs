//! kill -9 of a real editor and of its real window, again and again: neither takes the other down, no window is opened
//! twice, and a window that was turned off for dying too often comes back by `:view`. `tests/link.rs` has many more
//! rounds without a display.
#![cfg(all(feature = "tui", feature = "window"))]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]

use std::io::{Read, Write};
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread::sleep;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

mod display;
use display::{Display, PATIENCE, Place};

/// An editor in a terminal, with a display.
struct Editor {
    child: Box<dyn Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    seen: Arc<Mutex<vt100::Parser>>,
    _master: Box<dyn MasterPty + Send>,
}

impl Editor {
    fn open(display: &Display, place: &Place) -> Editor {
        let pair =
            native_pty_system().openpty(PtySize { rows: 24, cols: 160, pixel_width: 0, pixel_height: 0 }).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_plica"));
        command.arg("edit");
        command.arg(&place.scene);
        command.cwd(place.folder.path());
        for name in ["SSH_CONNECTION", "SSH_TTY", "WAYLAND_DISPLAY"] {
            command.env_remove(name);
        }
        let run = place.folder.path().join("run");
        std::fs::create_dir_all(&run).unwrap();
        command.env("XDG_RUNTIME_DIR", run);
        command.env("XDG_STATE_HOME", place.folder.path().join("state"));
        command.env("TERM", "xterm-256color");
        command.env("DISPLAY", &display.name);
        let child = pair.slave.spawn_command(command).unwrap();
        let seen = Arc::new(Mutex::new(vt100::Parser::new(24, 160, 0)));
        let (mut output, parser) = (pair.master.try_clone_reader().unwrap(), seen.clone());
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(n @ 1..) = output.read(&mut bytes) {
                parser.lock().unwrap().process(&bytes[..n]);
            }
        });
        Editor { child, keys: pair.master.take_writer().unwrap(), seen, _master: pair.master }
    }

    fn says(&self, text: &str) -> bool {
        self.seen.lock().unwrap().screen().contents().contains(text)
    }

    fn wait_for(&self, what: &str, holds: impl Fn() -> bool) {
        let began = Instant::now();
        while !holds() {
            let screen = self.seen.lock().unwrap().screen().contents();
            assert!(began.elapsed() < PATIENCE, "waited in vain for {what}:\n{screen}");
            sleep(Duration::from_millis(20));
        }
    }

    /// Waits until exactly one window has joined, not `before`; returns its process.
    fn window(&self, place: &Place, before: Option<u32>) -> u32 {
        let other = || windows(place).into_iter().find(|&window| Some(window) != before);
        self.wait_for("a window", || other().is_some() && self.says("window: connected"));
        assert_eq!(windows(place).len(), 1, "no window is doubled");
        other().unwrap()
    }

    fn kill(mut self) {
        kill(self.child.process_id().unwrap());
        self.child.wait().unwrap();
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn kill(process: u32) {
    assert!(Command::new("kill").args(["-9", &process.to_string()]).status().unwrap().success());
}

/// The running windows of the scene that were opened by an editor.
fn windows(place: &Place) -> Vec<u32> {
    let scene = place.scene.display().to_string();
    let is_window = |process: &u32| {
        let line = std::fs::read(format!("/proc/{process}/cmdline")).unwrap_or_default();
        let words: Vec<_> = line.split(|&byte| byte == 0).collect();
        words.contains(&&b"--joined"[..]) && words.contains(&scene.as_bytes())
    };
    let all = std::fs::read_dir("/proc").unwrap().flatten();
    all.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).filter(is_window).collect()
}

#[test]
fn neither_side_minds_that_the_other_is_killed() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut editor = Editor::open(&display, &place);
    for _ in 0..2 {
        let mut window = editor.window(&place, None);
        for _ in 0..2 {
            kill(window);
            window = editor.window(&place, Some(window));
        }
        kill(window);
        editor.wait_for("the window to be off", || editor.says("window: off"));
        assert!(windows(&place).is_empty());
        editor.keys.write_all(b":view\r").unwrap();
        editor.keys.flush().unwrap();
    }
    let window = editor.window(&place, None);
    for _ in 0..4 {
        editor.kill();
        editor = Editor::open(&display, &place);
        assert_eq!(editor.window(&place, None), window, "the same window joins again");
    }
    let sockets = std::fs::read_dir(place.folder.path().join("run/plica")).unwrap().flatten();
    let sockets: Vec<_> = sockets.filter(|entry| entry.path().extension().is_some()).collect();
    assert_eq!(sockets.len(), 1, "no socket of a killed editor stays: {sockets:?}");
}
