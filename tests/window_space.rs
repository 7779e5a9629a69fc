//! The window over a scene in space: its own camera goes round the scene, which stays as it is.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![cfg(feature = "window")]

mod display;

use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use display::{Display, Place, View, corner};
use plica::base::pixels::Frame;
use plica::files::{Options, materials, scene};
use plica::layers::space::camera::Camera;
use plica::preview::editor::{Event, Preview};
use plica::preview::wire::message::{Gesture, ToEditor};
use plica::render::passes::{self, Asked};
use plica::render::{self, cpu};

const MESH: &str = "v -1 -0.5 0\nv 1 -0.5 0\nv 0 1 0.4\nv 0.2 0 -1\nf 1 2 3\nf 2 4 3\nf 4 1 3\nf 1 4 2\n";
const SCENE: &str = r##"{
  "plica": 1, "size": [400, 300], "background": "#203040",
  "camera": { "position": [0.5, 1, 4], "target": [0, 0.2, 0] },
  "meshes": { "stone": { "path": "stone.obj" } },
  "layers": [{ "kind": "mesh", "name": "stone", "mesh": "stone" }]
}
"##;

/// A stone in a folder of its own.
fn stone() -> Place {
    let place = Place::new();
    std::fs::write(place.folder.path().join("stone.obj"), MESH).unwrap();
    std::fs::write(&place.scene, SCENE).unwrap();
    place
}

/// The frame that a camera sees which has gone round by so many degrees.
fn round(place: &Place, degrees: f64) -> Frame {
    let mut scene = place.scene();
    scene.camera.as_mut().unwrap().turn = degrees;
    let loaded = materials::load(&place.scene, &scene, &Options::default(), &mut materials::Cache::default());
    cpu::frame(&render::synth(&scene, &loaded.unwrap().0, None).unwrap(), 1.0)
}

/// The same of a pass.
fn pass(place: &Place, name: &str, degrees: f64) -> Frame {
    let mut scene = place.scene();
    scene.camera.as_mut().unwrap().turn = degrees;
    let loaded = materials::load(&place.scene, &scene, &Options::default(), &mut materials::Cache::default());
    let asked = Asked::parse(name, &scene).unwrap();
    passes::view(asked.pass, &asked.picture(&render::synth(&scene, &loaded.unwrap().0, None).unwrap(), 1.0))
}

/// Waits until the window shows `frame` at 1:1 where it is not transparent, but for some pixels at edges.
fn shows(view: &mut View<'_>, what: &str, frame: &Frame) {
    view.until(what, |v| {
        let shot = v.shot();
        if shot.width() < frame.width() || shot.height() < frame.height() + display::BAR {
            return false;
        }
        let (left, top) = corner(&shot, frame);
        let far = |a: &[u8; 4], b: &[u8; 4]| b[3] > 0 && (0..3).any(|c| a[c].abs_diff(b[c]) > 2);
        let row = |y: usize| shot.row(top + y)[left..].iter().zip(frame.row(y)).filter(|(a, b)| far(a, b)).count();
        (0..frame.height()).map(row).sum::<usize>() * 300 <= frame.width() * frame.height()
    });
}

#[test]
fn the_windows_own_camera_goes_round_and_comes_back() {
    let Some(display) = Display::open() else { return };
    let place = stone();
    let before = std::fs::read(&place.scene).unwrap();
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    let at_first = round(&place, 0.0);
    shows(&mut view, "the scene's camera", &at_first);
    view.keys(&["6", "6", "6", "6"]);
    shows(&mut view, "four steps of 5 degrees", &round(&place, 20.0));
    let middle = [200, 140].map(|n: i32| n.to_string());
    let moved = |by: &str| drop(display.tool("xdotool", &["mousemove_relative", "--sync", "--", by, "0"]));
    display.tool("xdotool", &["mousemove", "--sync", "--window", &view.window, &middle[0], &middle[1]]);
    display.tool("xdotool", &["mousedown", "2"]);
    moved("-50");
    display.tool("xdotool", &["mouseup", "2"]);
    shows(&mut view, "and 50 pixels of 0.4 degrees", &round(&place, 40.0));
    view.keys(&["l", "9"]);
    view.until("another view", |v| v.shot() != at_first);
    view.keys(&["0"]);
    shows(&mut view, "the scene's camera again", &at_first);
    assert_eq!(std::fs::read(&place.scene).unwrap(), before, "the scene stays as it is");
}

#[test]
fn passes_are_shown_in_place_of_the_frame() {
    let Some(display) = Display::open() else { return };
    let place = stone();
    let (sender, replies) = channel();
    let document = scene::open(&place.scene, &Options::default()).unwrap();
    let editor = Preview::start(&place.scene, &document, 0, move |event| {
        if let Event::Said(ToEditor::Gesture(Gesture::Command(command))) = event {
            drop(sender.send(command));
        }
    });
    editor.view("pass normal:stone");
    let mut view = View::of(&display, &mut place.joining());
    view.keys(&["1"]);
    shows(&mut view, "the pass that was shown before it came", &pass(&place, "normal", 0.0));
    view.keys(&["D"]);
    shows(&mut view, "the next pass", &pass(&place, "uv", 0.0));
    assert_eq!(replies.recv_timeout(display::PATIENCE).unwrap(), "pass uv", "other windows and the editor follow");
    editor.view("pass depth");
    view.keys(&["6"]);
    shows(&mut view, "depth from its own camera", &pass(&place, "depth", 5.0));
    view.keys(&["0"]);
    editor.view("pass color");
    shows(&mut view, "the frame again", &round(&place, 0.0));
}

#[test]
fn the_editor_is_told_where_the_window_looks_from() {
    let Some(display) = Display::open() else { return };
    let place = stone();
    let (sender, replies) = channel();
    let document = scene::open(&place.scene, &Options::default()).unwrap();
    let _editor = Preview::start(&place.scene, &document, 0, move |event| {
        if let Event::Said(ToEditor::Gesture(Gesture::Camera(camera))) = event {
            drop(sender.send(camera));
        }
    });
    let mut view = View::of(&display, &mut place.joining());
    view.keys(&["1"]);
    shows(&mut view, "the scene's camera", &round(&place, 0.0));
    view.keys(&["6"]);
    let told = replies.recv_timeout(display::PATIENCE).unwrap().unwrap();
    let ([wanted, target, _], fov) = Camera { turn: 5.0, ..place.scene().camera.unwrap() }.view(1.0);
    assert!(wanted.distance(told.position.into()) < 1e-9, "{told:?}");
    assert_eq!((told.target, told.fov), (target.to_array(), fov));
    view.keys(&["0"]);
    assert_eq!(replies.recv_timeout(display::PATIENCE).unwrap(), None);
}

#[test]
fn a_frame_that_takes_long_holds_no_key_and_gives_way_to_a_newer_scene() {
    let Some(display) = Display::open() else { return };
    let place = stone();
    let scene = |strokes: &str| {
        let own = format!(r#""mesh": "stone", "strokes": {strokes} }}"#);
        std::fs::write(&place.scene, SCENE.replace(r#""mesh": "stone" }"#, &own)).unwrap();
    };
    // Minutes of work.
    let names = || (0..32).map(|i| format!("n{i}"));
    let noise = |name| format!(r#""{name}": {{ "spacing": 2, "overlap": 128 }}"#);
    let mark = |name| format!(r#"{{ "name": "{name}", "kind": "ink", "noise": "{name}" }}"#);
    let [noises, marks] =
        [names().map(noise).collect::<Vec<_>>(), names().map(mark).collect()].map(|all: Vec<String>| all.join(", "));
    let heavy = format!(r#"{{ "style": "none", "noises": {{ {noises} }}, "marks": [ {marks} ] }}"#);
    let shown = |view: &mut View, what: &str| shows(view, what, &round(&place, 0.0));

    scene("{}");
    let mut view = View::open(&display, &place);
    view.keys(&["1"]);
    shown(&mut view, "strokes");
    scene(&heavy);
    std::thread::sleep(Duration::from_secs(3));
    scene(r##"{ "ink": "#902010" }"##);
    shown(&mut view, "the newer scene");
    scene(&heavy);
    std::thread::sleep(Duration::from_secs(3));
    view.keys(&["q"]);
    let begun = Instant::now();
    while view.process.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(5), "q is obeyed while a frame is drawn");
        std::thread::sleep(Duration::from_millis(50));
    }
}
