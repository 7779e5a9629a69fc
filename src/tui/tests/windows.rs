//! What the editor and its windows share: the time, and the point that is marked in a window.

use serde_json::json;

use super::support::{press, said, state};
use super::{motion, zone};
use crate::preview::Transport;
use crate::preview::wire::message::Gesture;
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event};
use crate::tui::state::State;

fn pass(state: &mut State, seconds: f64) -> Vec<Effect> {
    update(state, Event::Tick(seconds))
}

#[test]
fn a_window_leads_and_is_not_told_what_it_said() {
    let mut state = state();
    let told = update(&mut state, said(Gesture::Transport(Transport { playing: true, time: 0.5, speed: 0.5 })));
    assert!(matches!(told[..], [Effect::Pass]), "{told:?}");
    assert_eq!((state.play.playing, state.play.time, state.play.speed), (true, 0.25, 0.5));
    let told = pass(&mut state, 1.0);
    assert!(matches!(told[..], [Effect::Pass]), "windows run by themselves: {told:?}");
    assert_eq!(state.play.time, 0.5);
    let told = press(&mut state, "P");
    assert!(matches!(told[..], [Effect::Show]), "{told:?}");
    assert_eq!(state.transport(), Transport { playing: false, time: 1.0, speed: 0.5 });
    update(&mut state, said(Gesture::Transport(Transport { playing: false, time: f64::NAN, speed: 1.0 })));
    assert_eq!(state.play.time, 0.5);
}

#[test]
fn what_plays_once_ends() {
    let mut state = state();
    press(&mut state, ": \"set timeline.loop=once\" Enter P");
    pass(&mut state, 1.5);
    let told = pass(&mut state, 1.5);
    assert!(matches!(told[..], [Effect::Show]), "{told:?}");
    assert_eq!((state.play.playing, state.play.time), (false, 1.0));
}

#[test]
pub fn speed_is_shared() {
    for (keys, speed) in [
        ("z <", 0.5),
        ("z < z < z < z < z <", 0.1),
        ("z > z > z > z >", 4.0),
        (": \"speed 0.7\" Enter", 0.7),
        (": \"speed 0.7\" Enter z >", 1.0),
        (": \"speed 7\" Enter", 1.0),
    ] {
        let mut state = state();
        press(&mut state, keys);
        assert_eq!(state.play.speed, speed, "{keys}");
    }
}

#[test]
fn a_point_marked_in_a_window_moves_the_cursor_only() {
    let mut state = state();
    press(&mut state, &motion(""));
    let before = state.document().json().clone();
    update(&mut state, said(Gesture::Pointer { x: 12.5, y: 13.25 }));
    update(&mut state, said(Gesture::Command("mark-point".into())));
    assert_eq!(state.picture.cursor, (12.5, 13.25).into());
    assert_eq!(state.document().json(), &before);
    assert!(state.message.as_ref().is_some_and(|said| said.text.starts_with("marked 12.5, 13.25")));
}

#[test]
fn what_is_selected_in_a_window_is_shown() {
    for (at, keys, node, row) in [
        ((29.6, 25.4), String::new(), zone("/motion"), 1),
        ((11.0, 38.0), String::new(), zone(""), 0),
        ((22.0, 50.0), motion(""), "/layers/0/zones/1".into(), 0),
        ((63.0, 1.0), motion("j"), zone("/motion"), 1),
        ((11.0, 38.0), motion("l i"), zone("/motion"), 0),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        update(&mut state, said(Gesture::Pointer { x: at.0, y: at.1 }));
        update(&mut state, said(Gesture::Command("select-point".into())));
        assert_eq!((&state.cursor.node, state.cursor.row), (&node, row), "{at:?} {keys}");
    }
}

#[test]
fn what_a_window_drags_is_one_step_of_undo_and_one_line() {
    let mut state = state();
    let before = state.document().json().clone();
    let at = zone("/motion/0/at");
    let say = |state: &mut State, verb: &str, (x, y): (f64, f64)| {
        update(state, said(Gesture::Pointer { x, y }));
        update(state, said(Gesture::Command(format!("{verb} {at}"))));
        state.document().json().pointer(&at).cloned().unwrap()
    };
    assert_eq!(say(&mut state, "drag", (12.5, 13.0)), json!([12.5, 13]));
    assert_eq!((&state.cursor.node, state.cursor.row), (&zone("/motion"), 0), "its numbers are seen");
    assert_eq!(say(&mut state, "drag", (13.5, 14.0)), json!([13.5, 14]));
    assert_eq!(say(&mut state, "drop", (14.5, 15.5)), json!([14.5, 15.5]));
    let line = state.memory.recorder.log().last().cloned().unwrap_or_default();
    assert!(line.starts_with("set ") && line.ends_with(".at=[14.5,15.5]"), "{line}");
    say(&mut state, "drag", (1.0, 1.0));
    update(&mut state, said(Gesture::Command("undrag".into())));
    assert_eq!(state.document().json().pointer(&at), Some(&json!([14.5, 15.5])), "as if it had not been");
    press(&mut state, "u");
    assert_eq!(state.document().json(), &before);
    press(&mut state, ":");
    assert_eq!(say(&mut state, "drag", (3.0, 3.0)), before.pointer(&at).cloned().unwrap(), "something is being typed");
}

#[test]
fn a_box_that_a_window_draws_selects_the_points_in_it() {
    for (keys, corners, rows) in [
        (motion(""), "15 15 35 30", Some(vec![0, 1, 3])),
        (motion(""), "35 30 15 15", Some(vec![0, 1, 3])),
        (String::new(), "28 23 32 27", Some(vec![1, 3])),
        (motion(""), "90 90 91 91", None),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        update(&mut state, said(Gesture::Command(format!("band {corners}"))));
        let selected = state.cursor.selects().then(|| state.cursor.rows().into_iter().collect::<Vec<_>>());
        assert_eq!(selected, rows, "{keys} {corners}: {:?}", state.message);
    }
}

#[test]
fn the_pointer_goes_into_the_entry() {
    let at = |field: &str| zone(&format!("/motion/0/{field}"));
    for (keys, pointer, expected) in [
        ("l i M Enter", at("at"), json!([12.5, 20])),
        ("l l i M Enter", at("at"), json!([20, 13.25])),
        ("l l l i M Enter", at("jump"), json!([-7.5, -18])),
        ("l l l l i M Enter", at("jump"), json!([0, -6.75])),
    ] {
        let mut state = state();
        update(&mut state, said(Gesture::Pointer { x: 12.5, y: 13.25 }));
        press(&mut state, &motion(keys));
        assert_eq!(state.document().json().pointer(&pointer), Some(&expected), "{keys}");
    }
}

#[test]
fn the_pointer_goes_into_the_column_of_the_cursor() {
    let at = |field: &str| zone(&format!("/motion/0/{field}"));
    for (keys, moved, aimed) in [
        ("M", json!([12.5, 13.25]), json!([0, -18])),
        ("l M", json!([12.5, 13.25]), json!([0, -18])),
        ("l l l M", json!([20, 20]), json!([-7.5, -6.75])),
        ("l l l l M", json!([20, 20]), json!([-7.5, -6.75])),
        ("l l l l l M", json!([20, 20]), json!([-7.5, -6.75])),
        ("l l l l l l M", json!([20, 20]), json!([-7.5, -6.75])),
    ] {
        let mut state = state();
        update(&mut state, said(Gesture::Pointer { x: 12.5, y: 13.25 }));
        press(&mut state, &motion(keys));
        let read = |field: &str| state.document().json().pointer(&at(field)).cloned();
        assert_eq!((read("at"), read("jump")), (Some(moved), Some(aimed)), "{keys}");
    }
}

#[test]
fn a_name_takes_a_capital_m() {
    let mut state = state();
    update(&mut state, said(Gesture::Pointer { x: 12.5, y: 13.25 }));
    press(&mut state, "/ \"name\" Enter i Ctrl-u \"Mouth\" Enter");
    let names = state.document().json().to_string();
    assert!(names.contains("\"Mouth\""), "{names}");
}

#[test]
fn a_pass_is_the_same_here_and_in_the_windows() {
    let mut state = state();
    let shown = |state: &State| {
        let words = state.picture.pass.as_ref().map(|asked| asked.words(state.document().scene()));
        words.unwrap_or_default()
    };
    for (typed, told, here) in
        [("pass depth", "pass depth", "depth"), ("pass uv:face", "pass uv:face", "uv:face"), ("pass", "pass color", "")]
    {
        let effects = update(&mut state, Event::Line(typed.into()));
        assert!(effects.iter().any(|effect| matches!(effect, Effect::View(Some(view)) if view == told)), "{typed}");
        assert_eq!(shown(&state), here, "{typed}");
    }
    for (told, here) in [("pass depth:face", "depth:face"), ("pass uv:gone", "depth:face"), ("pass color", "")] {
        let effects = update(&mut state, said(Gesture::Command(told.into())));
        assert!(!effects.iter().any(|effect| matches!(effect, Effect::View(_))), "{told} is not told again");
        assert_eq!(shown(&state), here, "{told}");
    }
}
