//! The window and an editor in this process: what each sends the other, and what the window recovers from.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![cfg(feature = "window")]

mod display;

use std::sync::mpsc::{Receiver, channel};

use display::{Display, Place, View, corner};
use plica::base::pixels::Frame;
use plica::export::still;
use plica::files::{Options, scene};
use plica::preview::Transport;
use plica::preview::editor::{Event, Preview};
use plica::preview::wire::message::{FromEditor, Gesture, ToEditor};
use plica::scene::edit::Edit;

/// An editor of the scene, and the replies of its windows.
fn editor(place: &Place) -> (Preview, Receiver<ToEditor>) {
    let (sender, replies) = channel();
    let document = scene::open(&place.scene, &Options::default()).unwrap();
    let deliver = move |event| {
        if let Event::Said(reply) = event {
            drop(sender.send(reply));
        }
    };
    (Preview::start(&place.scene, &document, 0, deliver), replies)
}

/// The first reply that `wanted` accepts.
fn heard<T>(replies: &Receiver<ToEditor>, wanted: impl Fn(&ToEditor) -> Option<T>) -> T {
    loop {
        let reply = replies.recv_timeout(display::PATIENCE).expect("a reply");
        if let Some(found) = wanted(&reply) {
            return found;
        }
    }
}

fn transport(replies: &Receiver<ToEditor>) -> Transport {
    heard(replies, |reply| match reply {
        ToEditor::Gesture(Gesture::Transport(transport)) => Some(*transport),
        _ => None,
    })
}

#[test]
fn a_round_of_what_the_window_shows_is_captured_and_told() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let (editor, _replies) = editor(&place);
    let mut view = View::of(&display, &mut place.joining());
    editor.view("zoom-one");
    view.shows("frame 0", &place.frame(0));
    editor.view("capture png");
    view.until("the end of the capture", |_| editor.status().to_string().contains("captured as"));
    let frames = place.scene().timeline.frames();
    let path = |number: u64| place.folder.path().join(format!("blink-capture-1.{number:04}.png"));
    assert!(path(frames - 1).exists() && !path(frames).exists(), "{frames}: {:?}", place.files());
    for number in [0, 20] {
        let taken = image::open(path(number)).unwrap().to_rgba8();
        let (wanted, size) = (place.frame(number), (taken.width() as usize, taken.height() as usize));
        let (left, top) = ((size.0 - wanted.width()) / 2, (size.1 - wanted.height()) / 2);
        for (x, y) in [(100, 60), (240, 180), (250, 140)] {
            let (shown, wanted) = (taken.get_pixel((left + x) as u32, (top + y) as u32), wanted.get(x, y));
            assert!((0..3).all(|c| shown[c].abs_diff(wanted[c]) <= 2), "{number}, {x} {y}: {shown:?} {wanted:?}");
        }
    }
}

#[test]
fn editor_and_window_share_time_point_and_view() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let (editor, replies) = editor(&place);
    let mut view = View::of(&display, &mut place.joining());
    let timeline = place.scene().timeline;
    let time = |frame: u64| timeline.time_of(frame) * timeline.duration;
    editor.view("zoom-one");
    view.shows("frame 0", &place.frame(0));

    let stands = |frame: u64| Transport { playing: false, time: time(frame), speed: 1.0 };
    editor.say(FromEditor::Transport(stands(5)));
    view.shows("the editor's frame", &place.frame(5));
    view.keys(&["bracketright"]);
    let said = transport(&replies);
    assert!(!said.playing && (said.time - time(6)).abs() < 1e-9, "{said:?}");
    view.keys(&["greater"]);
    assert_eq!(transport(&replies).speed, 2.0);
    view.keys(&["P"]);
    assert!(transport(&replies).playing);
    view.keys(&["P"]);
    assert!(!transport(&replies).playing);

    let (left, top) = corner(&view.shot(), &place.frame(0));
    let at = [left + 100, top + 60].map(|n| n.to_string());
    display.tool("xdotool", &["mousemove", "--window", &view.window, &at[0], &at[1]]);
    view.keys(&["Return"]);
    heard(&replies, |reply| matches!(reply, ToEditor::Gesture(Gesture::Pointer { x: 100.0, y: 60.0 })).then_some(()));
    heard(&replies, |reply| {
        matches!(reply, ToEditor::Gesture(Gesture::Command(name)) if name == "mark-point").then_some(())
    });

    for click in [false, true] {
        match click {
            true => drop(display.tool("xdotool", &["click", "1"])),
            false => view.keys(&["u"]),
        }
        heard(&replies, |reply| {
            matches!(reply, ToEditor::Gesture(Gesture::Command(name)) if name == "select-point").then_some(())
        });
    }

    let bare = view.shot();
    for command in ["view-outlines", "view-wheel", "view-samplers"] {
        editor.view(command);
        view.until(command, |v| v.shot() != bare);
        editor.view(command);
        view.until("no overlay", |v| v.shot() == bare);
    }
}

#[test]
fn what_is_lost_comes_back_in_the_same_window() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let (editor, replies) = editor(&place);
    let mut view = View::of(&display, &mut place.joining());
    view.keys(&["1"]);
    view.shows("frame 0", &place.frame(0));
    let window = view.window.clone();
    editor.view("lose-device");
    view.keys(&["bracketright"]);
    view.shows("frame 1 on a new device", &place.frame(1));
    display.tool("xdotool", &["windowunmap", "--sync", &window]);
    display.tool("xdotool", &["windowmap", "--sync", &window]);
    view.shows("frame 1 after it was hidden", &place.frame(1));
    display.tool("xdotool", &["windowsize", &window, "1", "1"]);
    display.tool("xdotool", &["windowsize", &window, "700", "600"]);
    view.shows("frame 1 after it was tiny", &place.frame(1));

    let document = scene::open(&place.scene, &Options::default()).unwrap();
    let patch = serde_json::json!([{"op": "remove", "path": "/layers/0/zones"}]);
    let edit: Edit = serde_json::from_value(patch).unwrap();
    let edited = document.apply(&edit).unwrap();
    editor.publish(&edited, 7, &edit);
    heard(&replies, |reply| matches!(reply, ToEditor::Ack { revision: 7, .. }).then_some(()));
    assert_eq!(view.window, window);
}

#[test]
fn a_picture_that_the_gpu_cannot_hold_is_reduced_and_said_so() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    let (_editor, replies) = editor(&place);
    let mut command = place.joining();
    let mut view = View::of(&display, command.args(["--limit", "texture=200"]));
    let said = heard(&replies, |reply| match reply {
        ToEditor::Report { notice, .. } if !notice.is_empty() => Some(notice.clone()),
        _ => None,
    });
    assert_eq!(said, "480 x 360 is shown reduced 3 times");
    let frame = place.frame(0);
    // So wide that the bar has room for the message.
    display.tool("xdotool", &["windowsize", &view.window, "900", "600"]);
    view.keys(&["1"]);
    let far = |a: [u8; 4], b: [u8; 4]| (0..3).any(|c| a[c].abs_diff(b[c]) > 60);
    view.until("about the picture", |v| {
        let shot = v.shot();
        if shot.width() < frame.width() || shot.height() < frame.height() + display::BAR {
            return false;
        }
        let (left, top) = corner(&shot, &frame);
        let places = (0..frame.height()).flat_map(|y| (0..frame.width()).map(move |x| (x, y)));
        let differ = places.filter(|&(x, y)| far(*shot.get(left + x, top + y), *frame.get(x, y))).count();
        differ * 20 < frame.cells().len()
    });
}

#[test]
fn a_large_picture_is_as_fine_as_it_is_seen() {
    let Some(display) = Display::open() else { return };
    let place = Place::new();
    // Black and white columns: from afar they are gray.
    let columns = |i: usize| [[0, 0, 0, 255], [255; 4]][i % 2];
    let large = Frame::from_cells(4200, 4100, (0..4200 * 4100).map(columns).collect());
    std::fs::write(place.folder.path().join("eye.png"), still::frame(&large).unwrap()).unwrap();
    let scene = r#"{"plica": 1, "images": {"a": {"path": "eye.png"}},
        "layers": [{"kind": "picture", "name": "a", "image": "a"}]}"#;
    std::fs::write(&place.scene, scene).unwrap();
    let mut view = View::open(&display, &place);
    let middle = |view: &View| {
        let shot = view.shot();
        let (y, half) = (shot.height() / 2, shot.width() / 2);
        shot.row(y).iter().skip(half.saturating_sub(20)).take(40).map(|color| color[0]).collect::<Vec<u8>>()
    };
    let is_gray = |codes: &[u8]| codes.len() == 40 && codes.iter().all(|code| (160..220).contains(code));
    let is_fine =
        |codes: &[u8]| codes.len() == 40 && codes.chunks(2).all(|codes| codes.contains(&0) && codes.contains(&255));
    view.until("all of the picture", |view| is_gray(&middle(view)));
    view.keys(&["1"]);
    view.until("each of its pixels", |view| is_fine(&middle(view)));
    view.keys(&["f"]);
    view.until("all of the picture again", |view| is_gray(&middle(view)));
}
