//! A private display (Xvfb), a scene in its own folder, and a real `plica view` on them, driven by keys (xdotool) and
//! observed by screenshots (ImageMagick's import).
#![allow(dead_code, reason = "each test program uses a part of it")]

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use plica::base::pixels::{Frame, Grid};
use plica::files::{Options, materials};
use plica::render::{self, Synth, cpu};
use plica::scene::Scene;

/// Generous: the machine may be busy with other tests.
pub const PATIENCE: Duration = Duration::from_secs(60);
/// Height of the bar at scale 1.
pub const BAR: usize = 34;

/// A private display; it ends when the value is dropped.
pub struct Display {
    server: Child,
    pub name: String,
}

impl Display {
    pub fn open() -> Option<Display> {
        for tool in ["Xvfb", "xdotool", "import"] {
            let found = Command::new("sh").args(["-c", &format!("command -v {tool}")]).output().unwrap();
            if !found.status.success() {
                assert!(std::env::var_os("CI").is_none(), "in CI {tool} has to be installed");
                let _ = writeln!(std::io::stderr(), "not run: {tool} is not installed");
                return None;
            }
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1000x800x24", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Some(Display { server, name: format!(":{}", number.trim()) })
    }

    pub fn tool(&self, program: &str, arguments: &[&str]) -> Vec<u8> {
        Command::new(program).args(arguments).env("DISPLAY", &self.name).output().unwrap().stdout
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A scene copied to its own folder, and a folder for the program's sockets.
pub struct Place {
    pub folder: tempfile::TempDir,
    runtime: tempfile::TempDir,
    pub scene: PathBuf,
}

impl Place {
    pub fn new() -> Place {
        let folder = tempfile::tempdir().unwrap();
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/blink");
        for name in ["blink.plica.json", "eye.png", "lashes.png"] {
            std::fs::copy(from.join(name), folder.path().join(name)).unwrap();
        }
        Place { scene: folder.path().join("blink.plica.json"), folder, runtime: tempfile::tempdir().unwrap() }
    }

    /// All files beside the scene and in the folder for sockets.
    pub fn files(&self) -> Vec<PathBuf> {
        let folders = [self.folder.path().to_owned(), self.runtime.path().join("plica")];
        let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
        let mut files: Vec<_> = entries.map(|e| e.unwrap().path()).collect();
        files.sort();
        files
    }

    pub fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plica"));
        command.arg("view").arg(&self.scene).env_remove("WAYLAND_DISPLAY").env("XDG_RUNTIME_DIR", self.runtime.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// As [`Place::command`], for a window that joins an editor in this process.
    pub fn joining(&self) -> Command {
        let mut command = self.command();
        match std::env::var_os("XDG_RUNTIME_DIR") {
            Some(folder) => command.env("XDG_RUNTIME_DIR", folder),
            None => command.env_remove("XDG_RUNTIME_DIR"),
        };
        command
    }

    pub fn scene(&self) -> Scene {
        serde_json::from_slice(&std::fs::read(&self.scene).unwrap()).unwrap()
    }

    /// The synthesis, for frames and overlays.
    pub fn synth(&self) -> Synth {
        let scene = self.scene();
        let loaded = materials::load(&self.scene, &scene, &Options::default(), &mut materials::Cache::default());
        render::synth(&scene, &loaded.unwrap().0, None).unwrap()
    }

    /// The picture with no zone moving.
    pub fn still(&self) -> Frame {
        let mut scene = self.scene();
        for layer in &mut scene.layers {
            let plica::layers::Layer::Picture(layer) = layer else { continue };
            layer.zones.clear();
        }
        let loaded = materials::load(&self.scene, &scene, &Options::default(), &mut materials::Cache::default());
        cpu::frame(&render::synth(&scene, &loaded.unwrap().0, None).unwrap(), 0.0)
    }

    /// The frame as rendered on the CPU.
    pub fn frame(&self, number: u64) -> Frame {
        cpu::frame(&self.synth(), self.scene().timeline.time_of(number))
    }
}

/// A running `plica view`.
pub struct View<'a> {
    display: &'a Display,
    pub process: Child,
    pub window: String,
}

impl<'a> View<'a> {
    pub fn open(display: &'a Display, place: &Place) -> View<'a> {
        View::of(display, &mut place.command())
    }

    /// The window that a command opens, with the keyboard focus.
    pub fn of(display: &'a Display, command: &mut Command) -> View<'a> {
        let view = View::beside(display, command);
        display.tool("xdotool", &["windowfocus", "--sync", &view.window]);
        view
    }

    /// The window that a command opens, without giving it the focus.
    pub fn beside(display: &'a Display, command: &mut Command) -> View<'a> {
        let process = command.env("DISPLAY", &display.name).spawn().unwrap();
        let mut view = View { display, process, window: String::new() };
        view.until("a window", |v| {
            let found = v.display.tool("xdotool", &["search", "--onlyvisible", "--name", "blink.*plica"]);
            v.window = String::from_utf8(found).unwrap().lines().next().unwrap_or_default().to_owned();
            !v.window.is_empty()
        });
        view
    }

    pub fn until(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
        let began = Instant::now();
        while !holds(self) {
            if let Some(status) = self.process.try_wait().unwrap() {
                let mut said = String::new();
                self.process.stderr.take().unwrap().read_to_string(&mut said).unwrap();
                panic!("waiting for {what}: ended with {status}: {said}");
            }
            assert!(began.elapsed() < PATIENCE, "waited in vain for {what}");
            sleep(Duration::from_millis(50));
        }
    }

    pub fn keys(&self, keys: &[&str]) {
        let arguments: Vec<_> = ["key", "--clearmodifiers", "--delay", "40"].iter().chain(keys).copied().collect();
        self.display.tool("xdotool", &arguments);
    }

    /// The contents of the window without its bar, opaque.
    pub fn shot(&self) -> Frame {
        let geometry = self.display.tool("xdotool", &["getwindowgeometry", "--shell", &self.window]);
        let geometry = String::from_utf8(geometry).unwrap();
        let number = |name: &str| -> usize {
            let line = geometry.lines().find_map(|l| l.strip_prefix(name)).unwrap_or("0");
            line.parse().unwrap()
        };
        let (width, height) = (number("WIDTH="), number("HEIGHT="));
        let bytes = self.display.tool("import", &["-window", &self.window, "-depth", "8", "rgba:-"]);
        let pixels: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
        if pixels.len() != width * height {
            return Grid::filled(1, BAR + 1, [0; 4]); // caught while it changed
        }
        Grid::from_cells(width, height, pixels)
    }

    /// Waits until the window shows `frame` at 1:1 in its middle.
    pub fn shows(&mut self, what: &str, frame: &Frame) {
        self.until(what, |v| difference(&v.shot(), frame) <= 2);
    }
}

impl Drop for View<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The largest difference between `frame` and the middle of the picture area.
pub fn difference(shot: &Frame, frame: &Frame) -> u8 {
    if shot.width() < frame.width() || shot.height() < frame.height() + BAR {
        return u8::MAX;
    }
    let (left, top) = corner(shot, frame);
    let mut largest = 0;
    for y in 0..frame.height() {
        let shown = &shot.row(top + y)[left..left + frame.width()];
        for (a, b) in shown.iter().zip(frame.row(y)) {
            largest = (0..3).map(|c| a[c].abs_diff(b[c])).fold(largest, u8::max);
        }
    }
    largest
}

/// The corner of a picture of the size of `frame` at 1:1 in a window.
pub fn corner(shot: &Frame, frame: &Frame) -> (usize, usize) {
    let middle = |room: usize, size: usize| ((room as f64 - size as f64) / 2.0).round() as usize;
    (middle(shot.width(), frame.width()), middle(shot.height() - BAR, frame.height()))
}
