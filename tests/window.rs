//! The window, as a person meets it: a real window on a display of its own (Xvfb), real keys (xdotool), real screenshots
//! (ImageMagick's import). Where a tool is missing the reason is printed; in CI that is a failure.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]
#![cfg(feature = "window")]

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use plica::base::pixels::{Frame, Grid};
use plica::files::{Options, materials};
use plica::render::{self, cpu};
use plica::scene::Scene;

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(60);
/// Height of the bar at scale 1.
const BAR: usize = 34;

/// A display of its own, gone with the value.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    fn open() -> Option<Display> {
        for tool in ["Xvfb", "xdotool", "import"] {
            let found = Command::new("sh").args(["-c", &format!("command -v {tool}")]).output().unwrap();
            if !found.status.success() {
                assert!(std::env::var_os("CI").is_none(), "in CI {tool} has to be installed");
                println!("not run: {tool} is not installed");
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

    fn tool(&self, program: &str, arguments: &[&str]) -> Vec<u8> {
        Command::new(program).args(arguments).env("DISPLAY", &self.name).output().unwrap().stdout
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A scene copied to a folder of its own, and where the program may keep its sockets.
struct Place {
    folder: tempfile::TempDir,
    runtime: tempfile::TempDir,
    scene: PathBuf,
}

impl Place {
    fn new() -> Place {
        let folder = tempfile::tempdir().unwrap();
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/blink");
        for name in ["blink.plica.json", "eye.png", "lashes.png"] {
            std::fs::copy(from.join(name), folder.path().join(name)).unwrap();
        }
        Place { scene: folder.path().join("blink.plica.json"), folder, runtime: tempfile::tempdir().unwrap() }
    }

    /// All files beside the scene and among the program's sockets.
    fn files(&self) -> Vec<PathBuf> {
        let folders = [self.folder.path().to_owned(), self.runtime.path().join("plica")];
        let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
        let mut files: Vec<_> = entries.map(|e| e.unwrap().path()).collect();
        files.sort();
        files
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plica"));
        command.arg("view").arg(&self.scene).env_remove("WAYLAND_DISPLAY").env("XDG_RUNTIME_DIR", self.runtime.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn scene(&self) -> Scene {
        serde_json::from_slice(&std::fs::read(&self.scene).unwrap()).unwrap()
    }

    /// The frame as the CPU makes it.
    fn frame(&self, number: u64) -> Frame {
        let scene = self.scene();
        let loaded = materials::load(&self.scene, &scene, &Options::default(), &mut materials::Cache::default());
        let synth = render::synth(&scene, &loaded.unwrap(), None).unwrap();
        cpu::frame(&synth, scene.timeline.time_of(number))
    }
}

/// A running `plica view`.
struct View<'a> {
    display: &'a Display,
    process: Child,
    window: String,
}

impl<'a> View<'a> {
    fn open(display: &'a Display, place: &Place) -> View<'a> {
        let process = place.command().env("DISPLAY", &display.name).spawn().unwrap();
        let mut view = View { display, process, window: String::new() };
        view.until("a window", |v| {
            let found = v.display.tool("xdotool", &["search", "--onlyvisible", "--name", "blink.*plica"]);
            v.window = String::from_utf8(found).unwrap().lines().next().unwrap_or_default().to_owned();
            !v.window.is_empty()
        });
        display.tool("xdotool", &["windowfocus", "--sync", &view.window]);
        view
    }

    fn until(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
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

    fn keys(&self, keys: &[&str]) {
        let arguments: Vec<_> = ["key", "--clearmodifiers", "--delay", "40"].iter().chain(keys).copied().collect();
        self.display.tool("xdotool", &arguments);
    }

    /// What the window shows, without its bar, opaque.
    fn shot(&self) -> Frame {
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
    fn shows(&mut self, what: &str, frame: &Frame) {
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
fn difference(shot: &Frame, frame: &Frame) -> u8 {
    let (width, height) = (shot.width(), shot.height() - BAR);
    if width < frame.width() || height < frame.height() {
        return u8::MAX;
    }
    let left = ((width as f64 - frame.width() as f64) / 2.0).round() as usize;
    let top = ((height as f64 - frame.height() as f64) / 2.0).round() as usize;
    let mut largest = 0;
    for y in 0..frame.height() {
        let shown = &shot.row(top + y)[left..left + frame.width()];
        for (a, b) in shown.iter().zip(frame.row(y)) {
            largest = (0..3).map(|c| a[c].abs_diff(b[c])).fold(largest, u8::max);
        }
    }
    largest
}

#[test]
fn shows_what_the_cpu_shows_and_follows_keys_and_file() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    view.shows("frame 0 at 1:1", &place.frame(0));
    view.keys(&["bracketright", "bracketright", "bracketright"]);
    view.shows("frame 3", &place.frame(3));
    view.keys(&["braceright", "bracketleft"]);
    let last = place.scene().timeline.frames() - 1;
    view.shows("the last frame but one", &place.frame(last - 1));

    let bare = view.shot();
    for key in ["o", "r", "a", "c", "v"] {
        view.keys(&["z", key]);
        view.until("an overlay", |v| v.shot() != bare);
        view.keys(&[key]);
        view.until("the overlay gone", |v| v.shot() == bare);
    }
    view.keys(&["plus"]);
    view.until("a larger picture", |v| v.shot() != bare);
    view.keys(&["1", "s"]);
    let mut still = place.scene();
    let plica::layers::Layer::Picture(layer) = &mut still.layers[0];
    layer.zones.clear();
    std::fs::write(&place.scene, serde_json::to_string(&still).unwrap()).unwrap();
    let picture = place.frame(0);
    view.shows("the still picture", &picture);
    view.keys(&["s"]);
    view.shows("the changed file", &picture);
    view.keys(&["q"]);
    let ended = view.process.wait().unwrap();
    assert!(ended.success(), "{ended}");
}

#[test]
fn plays_and_pauses() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    view.shows("frame 0", &place.frame(0));
    view.keys(&["P"]);
    let frames = [place.frame(0), place.frame(36)];
    view.until("something that moves", |v| frames.iter().all(|f| difference(&v.shot(), f) > 2));
    view.keys(&["P", "braceleft"]);
    view.shows("the first frame again", &frames[0]);
    let stopped = view.shot();
    sleep(Duration::from_millis(300));
    assert_eq!(view.shot(), stopped);
}

#[test]
fn a_killed_window_leaves_nothing_behind() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let before = place.files();
    let mut view = View::open(&display, &place);
    view.process.kill().unwrap();
    view.process.wait().unwrap();
    assert_eq!(place.files(), before);
    View::open(&display, &place).keys(&["q"]);
}

#[test]
fn a_signal_ends_it_as_interrupted() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::open(&display, &place);
    assert!(Command::new("kill").arg(view.process.id().to_string()).status().unwrap().success());
    assert_eq!(view.process.wait().unwrap().code(), Some(130));
}

#[test]
fn without_a_display_one_line_says_so() {
    let place = Place::new();
    for display in [None, Some(":987")] {
        let mut command = place.command();
        command.env_remove("DISPLAY").envs(display.map(|d| ("DISPLAY", d)));
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.starts_with("plica: window: no display") && said.lines().count() == 1, "{said}");
        assert!(!said.contains(".rs"), "{said}");
    }
}
