//! The editor in a pseudo-terminal: keys in, screen out.

use std::io::{Read, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

/// Longer than anything here takes, even on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// The editor in a terminal.
pub struct Editor {
    pub child: Box<dyn Child + Send + Sync>,
    pub master: Option<Box<dyn MasterPty + Send>>,
    pub keys: Option<Box<dyn Write + Send>>,
    pub seen: Arc<Mutex<vt100::Parser>>,
    pub sent: Arc<Mutex<Vec<u8>>>,
    closing: Arc<AtomicBool>,
    reader: Option<JoinHandle<()>>,
}

impl Editor {
    /// `plica edit` without a window.
    pub fn open(folder: &Path, arguments: &[&str]) -> Editor {
        Editor::run(folder, &[&["edit", "--no-view"], arguments].concat())
    }

    /// `plica` with these arguments, on a terminal of 80 x 24 and without a display.
    pub fn run(folder: &Path, arguments: &[&str]) -> Editor {
        Editor::on("xterm-256color", folder, arguments)
    }

    /// `plica edit` on a terminal that draws nothing.
    pub fn dumb(folder: &Path, arguments: &[&str]) -> Editor {
        Editor::on("dumb", folder, &[&["edit", "--no-view"], arguments].concat())
    }

    fn on(term: &str, folder: &Path, arguments: &[&str]) -> Editor {
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_plica"));
        command.args(arguments);
        Editor::start(command, term, folder)
    }

    /// A shell in place of the editor, which finds `plica`.
    pub fn bash(folder: &Path) -> Editor {
        let mut command = CommandBuilder::new("bash");
        command.args(["--norc", "--noprofile", "-i"]);
        let plica = Path::new(env!("CARGO_BIN_EXE_plica")).parent().unwrap();
        command.env("PATH", format!("{}:{}", plica.display(), std::env::var("PATH").unwrap()));
        command.env("PS1", "> ");
        Editor::start(command, "xterm-256color", folder)
    }

    fn start(mut command: CommandBuilder, term: &str, folder: &Path) -> Editor {
        let size = PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        command.cwd(folder);
        command.env("TERM", term);
        for (name, own) in
            [("XDG_RUNTIME_DIR", "run"), ("XDG_STATE_HOME", "state"), ("XDG_CONFIG_HOME", "config"), ("TMPDIR", "tmp")]
        {
            std::fs::create_dir_all(folder.join(own)).unwrap();
            command.env(name, folder.join(own));
        }
        for name in ["DISPLAY", "WAYLAND_DISPLAY"] {
            command.env_remove(name);
        }
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let seen = Arc::new(Mutex::new(vt100::Parser::new(24, 80, 0)));
        let mut output = pair.master.try_clone_reader().unwrap();
        let (parser, sent) = (seen.clone(), Arc::new(Mutex::new(Vec::new())));
        let all = sent.clone();
        let closing = Arc::new(AtomicBool::new(false));
        let closed = closing.clone();
        let reader = std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(n @ 1..) = output.read(&mut bytes) {
                parser.lock().unwrap().process(&bytes[..n]);
                all.lock().unwrap().extend_from_slice(&bytes[..n]);
                if closed.load(Ordering::Relaxed) {
                    return;
                }
            }
        });
        let keys = pair.master.take_writer().unwrap();
        Editor { child, master: Some(pair.master), keys: Some(keys), seen, sent, closing, reader: Some(reader) }
    }

    /// Closes the terminal, as a dropped connection does: only the system sends a signal.
    pub fn close(&mut self) {
        self.closing.store(true, Ordering::Relaxed);
        // The drawing for this key wakes the reading thread.
        self.press("?");
        self.reader.take().unwrap().join().unwrap();
        (self.keys, self.master) = (None, None);
    }

    pub fn press(&mut self, keys: &str) {
        let writer = self.keys.as_mut().unwrap();
        writer.write_all(keys.as_bytes()).unwrap();
        writer.flush().unwrap();
    }

    pub fn screen(&self) -> String {
        self.seen.lock().unwrap().screen().contents()
    }

    pub fn wait_for(&self, text: &str) {
        let begun = Instant::now();
        while !self.screen().contains(text) {
            assert!(begun.elapsed() < PATIENCE, "no {text:?} on the screen:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until `start` has been sent; returns what follows it, up to and including `end`.
    pub fn wait_for_sequence(&self, start: &str, end: &str) -> String {
        let begun = Instant::now();
        loop {
            let sent = String::from_utf8_lossy(&self.sent.lock().unwrap()).into_owned();
            let found = sent.split_once(start).and_then(|(_, rest)| rest.split_once(end));
            if let Some((body, _)) = found {
                return body.to_owned();
            }
            assert!(begun.elapsed() < PATIENCE, "no {start:?} was sent:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// The screen, once it has not changed for a moment: a drawing arrives in pieces.
    pub fn settled_screen(&self) -> String {
        let mut screen = self.screen();
        loop {
            std::thread::sleep(Duration::from_millis(200));
            let now = self.screen();
            if now == screen {
                return now;
            }
            screen = now;
        }
    }

    /// Waits until `text` is no longer on the screen.
    pub fn wait_without(&self, text: &str) {
        let begun = Instant::now();
        while self.screen().contains(text) {
            assert!(begun.elapsed() < PATIENCE, "{text:?} stays on the screen:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until every edit is safe in the journal, that is, until the mark for those that are not is gone.
    pub fn wait_until_synced(&self) {
        self.wait_for("  *");
        self.wait_without("* ~");
    }

    pub fn resize(&self, rows: u16, cols: u16) {
        let size = PtySize { rows, cols, pixel_width: 0, pixel_height: 0 };
        // As terminals do: first resize the screen, then notify the program.
        self.seen.lock().unwrap().screen_mut().set_size(rows, cols);
        self.master.as_ref().unwrap().resize(size).unwrap();
    }

    /// Waits until the process is stopped, as after Ctrl-Z.
    pub fn wait_until_stopped(&self) {
        let stat = format!("/proc/{}/stat", self.child.process_id().unwrap());
        let begun = Instant::now();
        let stopped = || std::fs::read_to_string(&stat).unwrap().rsplit(')').next().unwrap().trim().starts_with('T');
        while !stopped() {
            assert!(begun.elapsed() < PATIENCE, "it does not stop:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    pub fn signal(&self, name: &str) {
        let pid = self.child.process_id().unwrap().to_string();
        assert!(std::process::Command::new("kill").args([&format!("-{name}"), &pid]).status().unwrap().success());
    }

    /// Waits for the end; returns the exit status.
    pub fn end(&mut self) -> u32 {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.exit_code();
            }
            assert!(begun.elapsed() < PATIENCE, "it does not end:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Whether every mode that the editor sets is undone.
    pub fn assert_restored(&self) {
        let begun = Instant::now();
        loop {
            let parser = self.seen.lock().unwrap();
            let screen = parser.screen();
            let restored = !screen.alternate_screen()
                && !screen.hide_cursor()
                && !screen.bracketed_paste()
                && screen.mouse_protocol_mode() == vt100::MouseProtocolMode::None;
            if restored {
                return;
            }
            assert!(begun.elapsed() < PATIENCE, "the terminal is not as it was");
            drop(parser);
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // The process has ended, or the test has failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The editor on the empty table of motion of the scene that is made for the picture in `folder`.
pub fn on_motion(folder: &Path) -> Editor {
    let mut editor = Editor::open(folder, &["photo.png"]);
    editor.wait_for("photo.plica.json: made");
    editor.press("/motion\r");
    editor.wait_for("zones.all.motion");
    editor
}

/// A folder with a picture in it.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut picture = image::RgbImage::new(64, 48);
    picture.enumerate_pixels_mut().for_each(|(x, y, pixel)| pixel.0 = [x as u8 * 4, y as u8 * 5, 90]);
    picture.save(folder.path().join("photo.png")).unwrap();
    folder
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}
