//! The window, as a person sees it: a real window on its own display (Xvfb), real keys (xdotool), real screenshots
//! (ImageMagick's import). If a tool is missing the reason is printed; in CI that is a failure.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]
#![cfg(feature = "window")]

mod display;

use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use display::{Display, Place, View, corner, difference};
use kurbo::Point;
use plica::base::pixels::Frame;
use plica::layers::parts::marks::{self, Mark, Shape};
use plica::render::overlay;

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
    for key in ["o", "r", "a", "c", "v", "d", "p", "x", "e"] {
        view.keys(&["z", key]);
        view.until("an overlay", |v| v.shot() != bare);
        view.keys(&[key]);
        view.until("the overlay gone", |v| v.shot() == bare);
    }
    view.keys(&["plus"]);
    view.until("a larger picture", |v| v.shot() != bare);
    view.keys(&["1", "s"]);
    let mut still = place.scene();
    let plica::layers::Layer::Picture(layer) = &mut still.layers[0] else { panic!() };
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
fn keys_with_others_and_held_ones_switch_nothing() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    view.shows("frame 0", &place.frame(0));
    view.keys(&["ctrl+o", "alt+o", "super+o", "ctrl+bracketright", "ctrl+q"]);
    view.keys(&["bracketright"]);
    view.shows("frame 1 without outlines", &place.frame(1));
    let bare = view.shot();
    display.tool("xdotool", &["keydown", "o"]);
    sleep(Duration::from_millis(1500));
    let held = view.shot();
    for _ in 0..6 {
        assert!(view.shot() == held && held != bare, "held, the switch stays on");
    }
    display.tool("xdotool", &["keyup", "o", "keydown", "bracketright"]);
    view.until("several frames on", |v| difference(&v.shot(), &place.frame(1)) > 2);
    display.tool("xdotool", &["keyup", "bracketright"]);
}

#[test]
fn the_mouse_plays_zooms_and_moves_the_border() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    let frame = place.frame(0);
    view.shows("frame 0", &frame);
    let shot = view.shot();
    let (left, top) = corner(&shot, &frame);
    let window = view.window.clone();
    let at = |x: usize, y: usize| {
        display.tool("xdotool", &["mousemove", "--window", &window, &x.to_string(), &y.to_string()]);
    };
    // A notch of a virtual wheel is one step: 100 % to 141 %, and one back is 100 % again.
    at(left + 100, top + 60);
    display.tool("xdotool", &["click", "4"]);
    view.until("a larger picture", |v| difference(&v.shot(), &frame) > 2);
    display.tool("xdotool", &["click", "5"]);
    view.shows("the frame at 1:1", &frame);
    view.keys(&["bracketright", "b"]);
    let (width, still, second) = (frame.width(), place.still(), place.frame(1));
    let halves = |border: usize| {
        let side = |x: usize| if x < border { &still } else { &second };
        let cells = (0..frame.height()).flat_map(|y| (0..width).map(move |x| *side(x).get(x, y)));
        plica::base::pixels::Grid::from_cells(width, frame.height(), cells.collect())
    };
    let moved = |v: &View<'_>, border: usize| {
        let (shot, wanted) = (v.shot(), halves(border));
        if shot.width() < left + width || shot.height() < top + wanted.height() {
            return false; // caught while it changed
        }
        let far = |a: &[u8; 4], b: &[u8; 4]| (0..3).any(|c| a[c].abs_diff(b[c]) > 2);
        let differ = |x: &usize| (0..wanted.height()).any(|y| far(shot.get(left + x, top + y), wanted.get(*x, y)));
        // The border with its handle hides some columns.
        (0..width).filter(differ).all(|x| x.abs_diff(border) < 14)
    };
    view.until("before and after", |v| moved(v, width / 2));
    at(left + width / 2, top + 40);
    display.tool("xdotool", &["mousedown", "1"]);
    at(left + width / 4, top + 44);
    display.tool("xdotool", &["mouseup", "1"]);
    view.until("the border at a quarter", |v| moved(v, width / 4));
    view.keys(&["b", "bracketleft"]);
    view.shows("frame 0", &frame);
    at(18, shot.height() - 10);
    display.tool("xdotool", &["click", "1"]);
    view.until("something that moves", |v| difference(&v.shot(), &frame) > 2);
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
    let ended = view.process.wait().unwrap();
    assert_eq!(ended.code(), Some(130), "{ended}");
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

/// The share of the dots of these looks, drawn over a picture at 1:1, whose color is found `right` of their middle.
fn found(shot: &Frame, frame: &Frame, marks: &[Mark], looks: &[&str], right: f64) -> f64 {
    let (left, top) = corner(shot, frame);
    let dots = marks.iter().filter(|mark| looks.contains(&mark.look.name)).filter_map(|mark| match mark.shape {
        Shape::Dot(at) => Some((mark.look.color, at)),
        _ => None,
    });
    let mut count = (0, 0);
    for (color, Point { x, y }) in dots {
        let (x, y) = ((x + right) as usize + left, y as usize + top);
        let near = shot.get(x, y).iter().zip(color).take(3).all(|(a, b)| a.abs_diff(b) < 24);
        count = (count.0 + 1, count.1 + usize::from(near));
    }
    assert!(count.0 > 8, "{count:?} of {looks:?}");
    count.1 as f64 / count.0 as f64
}

#[test]
fn overlays_stand_where_they_are_computed() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let (scene, synth, frame) = (place.scene(), place.synth(), place.frame(0));
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    view.shows("frame 0", &frame);
    let spacing = 32.0; // the first power of two that is not below 22 pixels of the screen
    for (key, looks, name) in [
        ("a", &["anchor", "still anchor"][..], "view-anchors"),
        ("x", &["threshold"], "view-thresholds"),
        ("e", &["sampler", "resting sampler"], "view-samplers"),
    ] {
        let shown = marks::View { spacing_px: spacing, times: vec![0.0], ..marks::View::of(&[name]) };
        let marks = overlay::overlay(&scene, Some(&synth), &shown);
        view.keys(&[key]);
        // Dots that are closer than they are wide hide parts of each other.
        view.until("dots", |v| found(&v.shot(), &frame, &marks, looks, 0.0) > 0.7);
        assert!(found(&view.shot(), &frame, &marks, looks, 5.0) < 0.4, "dots of {key} are small");
        view.keys(&[key]);
        view.shows("the bare frame", &frame);
    }
}

#[test]
fn marks_are_as_large_as_the_screen_asks_for() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let frame = place.frame(0);
    let marks = overlay::overlay(&place.scene(), None, &marks::View::of(&["view-anchors"]));
    let mut command = place.command();
    let mut view = View::of(&display, command.env("WINIT_X11_SCALE_FACTOR", "2"));
    view.keys(&["1", "a"]);
    // An anchor's dot has a radius of 3.5 logical pixels; the bar is twice as high too.
    let lower = |shot: Frame| {
        let (width, height) = (shot.width(), shot.height() - display::BAR);
        plica::base::pixels::Grid::from_cells(width, height, shot.cells()[..width * height].to_vec())
    };
    view.until("large dots", |v| found(&lower(v.shot()), &frame, &marks, &["anchor"], 5.0) > 0.5);
}

#[test]
fn nothing_is_drawn_while_nothing_moves() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let log = place.folder.path().join("log");
    let mut command = place.command();
    let mut view = View::of(&display, command.arg("--log").arg(&log));
    view.keys(&["1"]);
    view.shows("frame 0", &place.frame(0));
    sleep(Duration::from_millis(1500));
    view.keys(&["q"]);
    assert!(view.process.wait().unwrap().success());
    let said = std::fs::read_to_string(log).unwrap();
    let drawn = said.lines().find_map(|line| line.split_once("the window drew ")?.1.split(' ').next()?.parse().ok());
    assert!(drawn.is_some_and(|times: u64| (1..30).contains(&times)), "{said}");
}

#[test]
fn without_anything_to_draw_with_one_line_says_so() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut command = place.command();
    command.env("DISPLAY", &display.name);
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_FILENAMES"] {
        command.env(name, "/dev/null");
    }
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("plica: ") && said.contains("neither a GPU nor a software driver"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn a_click_takes_the_keyboard_where_no_window_manager_gives_it() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let mut view = View::beside(&display, &mut place.command());
    view.until("a picture", |v| v.shot().cells().iter().any(|p| p[0] > 200));
    let shot = view.shot();
    let (x, y) = ((shot.width() / 2).to_string(), (shot.height() / 2).to_string());
    display.tool("xdotool", &["mousemove", "--sync", "--window", &view.window, &x, &y]);
    let focused = || String::from_utf8(display.tool("xdotool", &["getwindowfocus"])).unwrap().trim().to_owned();
    assert_ne!(focused(), view.window);
    display.tool("xdotool", &["click", "1"]);
    view.until("the keyboard", |v| focused() == v.window);
    view.keys(&["P"]);
    view.until("something that moves", |v| v.shot() != shot);
}
