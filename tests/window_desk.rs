//! The window among others: with a window manager (openbox) that gives the keyboard to new windows and minimizes
//! windows. And what a window says when it has nothing to show.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![cfg(feature = "window")]

mod display;

use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use display::{Display, Place, View};
use plica::files::{Options, scene};
use plica::preview::editor::Preview;

/// A display with a window manager, and another window that has the keyboard.
struct Desk {
    manager: Child,
    other: Child,
    display: Display,
}

impl Desk {
    fn open() -> Option<Desk> {
        let display = Display::open()?;
        for tool in ["openbox", "xterm"] {
            let found = Command::new("sh").args(["-c", &format!("command -v {tool}")]).output().unwrap();
            if !found.status.success() {
                assert!(std::env::var_os("CI").is_none(), "in CI {tool} has to be installed");
                let _ = writeln!(std::io::stderr(), "not run: {tool} is not installed");
                return None;
            }
        }
        let run = |line: &[&str]| {
            let mut command = Command::new(line[0]);
            command
                .args(&line[1..])
                .env("DISPLAY", &display.name)
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap()
        };
        let manager = run(&["openbox"]);
        let wait = |what: &str, holds: &dyn Fn() -> bool| {
            let began = std::time::Instant::now();
            while !holds() {
                assert!(began.elapsed() < display::PATIENCE, "waited in vain for {what}");
                sleep(Duration::from_millis(50));
            }
        };
        let tool = |arguments: &[&str]| String::from_utf8(display.tool("xdotool", arguments)).unwrap();
        wait("openbox", &|| {
            let asked = display.tool("xprop", &["-root", "_NET_SUPPORTING_WM_CHECK"]);
            String::from_utf8(asked).unwrap().contains("window id")
        });
        let other = run(&["xterm", "-T", "terminal", "-e", "sleep", "1000"]);
        wait("a window with the keyboard", &|| tool(&["getactivewindow", "getwindowname"]).contains("terminal"));
        Some(Desk { manager, other, display })
    }

    /// The name of the window that has the keyboard.
    fn focused(&self) -> String {
        String::from_utf8(self.display.tool("xdotool", &["getactivewindow", "getwindowname"])).unwrap()
    }

    /// Puts the window away, and waits until the other one has the keyboard: what the manager says before that is old.
    fn put_away(&self, view: &mut View<'_>) {
        self.display.tool("xdotool", &["windowminimize", "--sync", &view.window]);
        view.until("the keyboard in the terminal", |_| self.focused().contains("terminal"));
    }

    /// Brings the window back, with the keyboard.
    fn bring_back(&self, view: &mut View<'_>) {
        self.display.tool("xdotool", &["windowactivate", "--sync", &view.window]);
        view.until("the keyboard", |_| self.focused().contains("plica"));
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        for child in [&mut self.other, &mut self.manager] {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

#[test]
fn the_editors_window_leaves_the_keyboard_and_another_takes_it() {
    let Some(desk) = Desk::open() else { return };
    let place = Place::new();
    let document = scene::open(&place.scene, &Options::default()).unwrap();
    let _editor = Preview::start(&place.scene, &document, 0, |_| {});
    let mut of_editor = place.joining();
    let mut view = View::beside(&desk.display, of_editor.arg("--joined"));
    view.until("a picture", |v| v.shot().cells().iter().any(|p| p[0] > 200));
    assert!(desk.focused().contains("terminal"), "{}", desk.focused());
    drop(view);
    let mut view = View::beside(&desk.display, &mut place.command());
    view.until("the keyboard", |_| desk.focused().contains("plica"));
}

#[test]
fn a_window_that_is_put_away_draws_nothing() {
    let Some(desk) = Desk::open() else { return };
    let place = Place::new();
    let mut view = View::of(&desk.display, &mut place.command());
    view.until("a picture", |v| v.shot().cells().iter().any(|p| p[0] > 200));
    desk.put_away(&mut view);
    desk.bring_back(&mut view);
    view.keys(&["P"]);
    let shot = view.shot();
    view.until("something that moves", |v| v.shot() != shot);
    desk.put_away(&mut view);
    sleep(Duration::from_millis(1500));
    let before = cpu(&view);
    sleep(Duration::from_millis(2000));
    let worked = cpu(&view) - before;
    assert!(worked < 0.5, "{worked} s of work in 2 s, hidden");
    desk.bring_back(&mut view);
    let shot = view.shot();
    view.until("something that moves again", |v| v.shot().cells().len() > 1 && v.shot() != shot);
}

/// CPU seconds that the process has used so far.
fn cpu(view: &View<'_>) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", view.process.id())).unwrap();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
    let ticks = |i: usize| -> f64 { fields[i].parse().unwrap() };
    (ticks(11) + ticks(12)) / 100.0
}

#[test]
fn what_keeps_the_first_picture_away_is_said_in_the_window_and_on_standard_error() {
    let Some(display) = Display::open() else { return };
    for (text, said) in [
        ("{bad".to_owned(), "plica: blink.plica.json: "),
        (
            std::fs::read_to_string(Place::new().scene).unwrap().replace("\"curve\"", "\"curvy\""),
            "plica: blink.plica.json: layers.face.zones.",
        ),
    ] {
        let place = Place::new();
        std::fs::write(&place.scene, text).unwrap();
        let mut view = View::of(&display, &mut place.command());
        // The color of warnings.
        let near = |p: &[u8; 4]| p[0].abs_diff(240) < 16 && p[1].abs_diff(160) < 16 && p[2].abs_diff(40) < 16;
        view.until("the list of problems", |v| v.shot().cells().iter().filter(|p| near(p)).count() > 100);
        view.keys(&["q"]);
        assert!(view.process.wait().unwrap().success());
        let mut lines = String::new();
        view.process.stderr.take().unwrap().read_to_string(&mut lines).unwrap();
        assert!(lines.lines().any(|line| line.starts_with(said)), "{lines}");
    }
}
