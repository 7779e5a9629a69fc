//! Picking pictures from a clip: (scene, keys, scene), and what the pane shows then.

use std::sync::Arc;

use kurbo::Point;
use serde_json::{Value, json};

use super::support::{at, press, said_last, state_of};
use crate::base::clip::Clip;
use crate::base::picture::Picture;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::picking::Subject;
use crate::scene::check;
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event, Synthesis};
use crate::tui::graphics::TerminalPicture;
use crate::tui::layout::picture;
use crate::tui::panes;
use crate::tui::state::{Pane, State};

/// A clip of 64 x 48 in which a bright square falls by 3 pixels a frame.
fn clip() -> Arc<Clip> {
    let frame = |k: usize| {
        let cell = move |i: usize| {
            let inside = (20..28).contains(&(i % 64)) && (10 + 3 * k..18 + 3 * k).contains(&(i / 64));
            let v = if inside { 0.6 } else { 0.01 + ((i % 64 * 5 + i / 64 * 3) % 7) as f32 / 1000.0 };
            [v, v, v, 1.0]
        };
        Arc::new(Picture::from_cells(64, 48, (0..64 * 48).map(cell).collect()))
    };
    Arc::new(Clip { fps: 25.0, frames: (0..8).map(frame).collect() })
}

/// Answers the worker's request for the scene as it is.
fn read(state: &mut State) {
    let materials = Materials { clips: [("w".to_owned(), clip())].into(), ..Materials::default() };
    let synth = crate::render::synth(state.document().scene(), &materials, None).unwrap();
    let made = Synthesis { synth: Arc::new(synth), ms: 1.0, longest: Vec::new(), warning: None };
    update(state, Event::Synthesised(Box::new(Ok(made))));
}

fn opened(picks: Value) -> State {
    let sprites = json!({ "size": 16, "keys": 3, "picks": picks });
    let layer = json!({ "kind": "waterfall", "name": "falls", "clip": "w", "lines": 30, "sprites": sprites });
    let clips = json!({ "w": { "path": "w-%04d.png" } });
    let scene = json!({ "plica": 1, "size": [120, 90], "clips": clips, "camera": {}, "layers": [layer] });
    let mut state = state_of(&scene.to_string());
    read(&mut state);
    state.show("/layers/0/sprites");
    state.cursor.focus = Pane::Tree;
    state
}

/// The editor with the clip in the pane, at the first of three picks.
pub fn looking() -> State {
    let mut state = opened(json!([
        { "frame": 1, "at": [24, 17] }, { "frame": 3, "at": [24, 23], "kind": "foam" }, { "frame": 0, "at": [40, 20] }
    ]));
    press(&mut state, "Enter");
    state
}

#[test]
pub fn sprites_are_picked_from_frames_of_the_clip() {
    for (keys, path, wanted) in [
        ("2 ] 3 l a", "/1/frame", json!(3)),
        ("2 ] 3 l a", "/1/at", json!([27, 17])),
        ("2 ] 3 l a", "/1/kind", json!("water")),
        ("A", "/1/kind", json!("foam")),
        ("[ r", "/0/frame", json!(0)),
        ("} J r", "/0/frame", json!(7)),
        ("} J r", "/0/at", json!([24, 27])),
        ("{ r", "/0/frame", json!(0)),
        ("t", "/0/track", json!(false)),
        ("t t", "/0/track", json!(true)),
        ("w r", "/1", json!({ "frame": 3, "at": [24, 23], "kind": "foam" })),
        ("w d", "/1/at", json!([40, 20])),
        ("b r", "/2/frame", json!(0)),
        ("b d", "/2", Value::Null),
    ] {
        let mut state = looking();
        press(&mut state, keys);
        let found = at(&state, &format!("/layers/0/sprites/picks{path}"));
        assert_eq!(found, wanted, "{keys}: {:?}", state.message);
    }
    let mut state = opened(json!([]));
    press(&mut state, ": \"sprites take\" Enter");
    let taken = at(&state, "/layers/0/sprites/picks");
    assert!(taken.as_array().is_some_and(|picks| !picks.is_empty()), "{taken} {:?}", state.message);
    press(&mut state, "u : \"sprites -o out\" Enter");
    let effects = press(&mut state, ": \"sprites -o out\" Enter");
    let asked = |effect: &Effect| matches!(effect, Effect::Run(words) if words.join(" ") == "sprites -o out");
    assert!(effects.iter().any(asked), "{effects:?}");
}

#[test]
fn what_would_leave_the_clip_is_picked_inside_it_or_as_a_single_picture() {
    let followed = "a track of 5 frames would pass the clip's end (8)";
    for (keys, path, wanted, told) in [
        (": \"cursor at 0 0\" Enter a", "/1/at", json!([8, 8]), ""),
        (": \"cursor at 63 47\" Enter r", "/0/at", json!([56, 40]), ""),
        (": \"cursor at 24.3 21.6\" Enter a", "/1/at", json!([24, 22]), ""),
        ("} a", "/1/track", json!(false), followed),
        ("3 [ 3 ] a", "/1/track", Value::Null, ""),
        ("} r", "/0/track", json!(false), followed),
        ("} r t", "/0/track", json!(false), followed),
    ] {
        let mut state = looking();
        press(&mut state, keys);
        let found = at(&state, &format!("/layers/0/sprites/picks{path}"));
        assert_eq!(found, wanted, "{keys}: {:?}", state.message);
        assert!(said_last(&state).1.contains(told), "{keys}: {:?}", state.message);
        read(&mut state);
        let materials = Materials { clips: [("w".to_owned(), clip())].into(), ..Materials::default() };
        assert_eq!(check::check_materials(state.document().scene(), &materials), [], "{keys}");
    }
}

#[test]
fn the_pane_shows_the_clip_until_it_is_left() {
    let mut state = looking();
    assert_eq!((state.cursor.focus, state.picture.size), (Pane::Picture, Some((64, 48))));
    assert_eq!(state.picture.cursor, Point::new(24.0, 17.0));
    for (keys, sight, size) in [
        ("", Some(Subject::Frame(1)), (64, 48)),
        ("3 ]", Some(Subject::Frame(4)), (64, 48)),
        ("z M", Some(Subject::Cut(4)), (64, 48)),
        ("z C", Some(Subject::Sheet), (48, 48)),
        ("z C", Some(Subject::Cut(4)), (64, 48)),
        ("z M 9 ]", Some(Subject::Frame(7)), (64, 48)),
        ("w", Some(Subject::Frame(3)), (64, 48)),
        ("Esc", None, (120, 90)),
    ] {
        press(&mut state, keys);
        let seen = state.picture.looking.map(|looking| looking.sight());
        assert_eq!((seen, state.picture.size), (sight, Some(size)), "{keys}");
    }
    press(&mut state, "z C");
    assert!(state.picture.looking.is_none(), "without the clip this is another key");
}

#[test]
fn windows_and_the_square_at_the_cursor_lie_over_the_frame() {
    let mut state = looking();
    let request = picture::request(&state);
    let (wanted, synth) = (request.picture.unwrap(), state.picture.synth.clone().unwrap());
    let shown = TerminalPicture::new(&synth, &request.scene, 0.0, wanted, None);
    let [bright, dark] = [(24.0, 17.0), (5.0, 40.0)].map(|place| shown.color_at(place.into()).unwrap()[0]);
    assert!(bright > 150 && dark < 60, "{bright} {dark}");
    let paths: Vec<(String, bool)> = shown.over.iter().map(|mark| (mark.pointer(), mark.selected)).collect();
    assert!(paths.contains(&("/layers/0/sprites/picks/0".into(), true)), "{paths:?}");
    assert!(paths.contains(&("/layers/0/sprites/picks/2".into(), false)), "{paths:?}");
    assert_eq!(panes::picture::title(&state).split("  ").next(), Some("clip 1 of 8"));
    read(&mut state);
    assert!(state.picture.looking.is_some(), "a new synthesis changes nothing");
}

#[test]
fn where_no_clip_is_there_says_so() {
    let mut state = looking();
    press(&mut state, "Esc : \"clip next\" Enter : \"pick add\" Enter");
    assert!(said_last(&state).1.contains("the clip is not shown"));
    press(&mut state, "g t : \"go /layers/0/look\" Enter Enter");
    assert_eq!(state.picture.looking, None, "other nodes are edited");
    (state.picture.size, state.picture.cursor) = (None, Point::new(3.5, 4.5));
    read(&mut state);
    assert_eq!((state.picture.size, state.picture.cursor), (Some((120, 90)), Point::new(3.5, 4.5)), "the cursor stays");
    state.picture.synth = None;
    press(&mut state, ": \"clip show\" Enter");
    assert!(said_last(&state).1.contains("no clip to show yet"), "{:?}", state.message);
    let mut other = super::support::state();
    press(&mut other, ": \"clip show\" Enter");
    assert!(said_last(&other).1.contains("nothing is picked from a clip here"));
    press(&mut other, ": \"sprites take\" Enter");
    assert!(said_last(&other).0);
}
