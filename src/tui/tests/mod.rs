//! Tests of the editor: (scene, keys, scene), without a terminal.

use serde_json::{Value, json};

use super::events::Effect;
use super::state::Mode;
use super::tests::support::{press, replayed, state};

mod apart;
mod automatic;
mod camera;
mod conflicts;
mod counts;
pub mod coverage;
mod falling;
pub mod finding;
mod images;
mod items;
mod laid;
mod lines;
mod looks;
mod macros;
mod pasting;
pub mod picking;
mod picture;
mod piping;
mod profiles;
mod recipes;
mod rowing;
mod rows;
pub mod screens;
mod sharing;
mod sketches;
mod space;
pub mod support;
mod table;
mod told;
mod transforming;
mod tutor;
mod undoing;
mod views;
pub mod windows;

/// Rows of keys from the opened editor (in the tree, on the first zone), a place of the scene, and its value after them. Also
/// checks that the log of these keys leads to the same scene.
fn check(rows: &[(&str, &str, Value)]) {
    for (keys, pointer, expected) in rows {
        let mut state = state();
        press(&mut state, keys);
        let found = state.document().json().pointer(pointer).cloned().unwrap_or(Value::Null);
        assert_eq!(&found, expected, "{keys}: {pointer}; said {:?}", state.message);
        assert_eq!(
            replayed(&state).document().json(),
            state.document().json(),
            "{keys}: {:#?}",
            state.memory.recorder.log()
        );
    }
}

const ZONE: &str = "/layers/0/zones/0";

fn zone(rest: &str) -> String {
    format!("{ZONE}{rest}")
}

/// The keys that go from the zone to its table of motion.
const MOTION: &str = "/ \"motion\" Enter Enter";

fn motion(keys: &str) -> String {
    format!("{MOTION} {keys}")
}

#[test]
fn numbers_are_entered_in_place() {
    check(&[
        // tool x y dx dy |J| °
        (&motion("l i \"150\" Enter"), &zone("/motion/0/at"), json!([150, 20])),
        (&motion("l i \"+=5\" Enter"), &zone("/motion/0/at"), json!([25, 20])),
        (&motion("l i \"*1.5\" Enter"), &zone("/motion/0/at"), json!([30, 20])),
        (&motion("l i \"w/2\" Enter"), &zone("/motion/0/at"), json!([32, 20])),
        (&motion("l i \"x+y*2\" Enter"), &zone("/motion/0/at"), json!([60, 20])),
        (&motion("l i Esc"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion("l i \"7\" Esc"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion("l i End \"5\" Enter"), &zone("/motion/0/at"), json!([205, 20])),
        (&motion("l i Up Enter"), &zone("/motion/0/at"), json!([21, 20])),
        (&motion("l i Home Up Enter"), &zone("/motion/0/at"), json!([30, 20])),
        (&motion("l i \"1\" Tab \"2\" Enter"), &zone("/motion/0/at"), json!([1, 2])),
    ]);
}

#[test]
fn polar_and_cartesian_columns_edit_the_same_jump() {
    check(&[
        (&motion("5 l i \"20\" Enter"), &zone("/motion/0/jump"), json!([0, -20])),
        (&motion("6 l i \"0\" Enter"), &zone("/motion/0/jump"), json!([18, 0])),
        (&motion("6 l i \"180\" Enter"), &zone("/motion/0/jump"), json!([-18, 0])),
        (&motion("j 5 l i \"*2\" Enter"), &zone("/motion/1/jump"), json!([6, 8])),
        (&motion("4 l i \"r\" Enter"), &zone("/motion/0/jump"), json!([0, 18])),
        (&motion("2 j 3 l i \"5\" Enter"), &zone("/motion/2/jump"), json!([5, 0.0])),
        (&motion("2 j 5 l i \"5\" Enter"), &zone("/motion/2/jump"), json!([5, 0])),
    ]);
    let mut state = state();
    press(&mut state, MOTION);
    let texts: Vec<String> = state.sheet().row(0).unwrap().cells.iter().map(|cell| cell.text.clone()).collect();
    assert_eq!(texts, ["point", "20", "20", "0", "-18", "18", "90"]);
}

#[test]
fn numbers_step_and_counts_multiply() {
    check(&[
        (&motion("l +"), &zone("/motion/0/at"), json!([21, 20])),
        (&motion("l 5 -"), &zone("/motion/0/at"), json!([15, 20])),
        (&motion("l < +"), &zone("/motion/0/at"), json!([20.1, 20])),
        (&motion("l > + +"), &zone("/motion/0/at"), json!([40, 20])),
        (&motion("l + + + u"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion("l + + u Ctrl-r"), &zone("/motion/0/at"), json!([22, 20])),
        (&motion("l v 2 j i \"+=1\" Enter"), &zone("/motion/2/at"), json!([41, 30])),
        (&motion("l v 2 j i \"10*i\" Enter"), &zone("/motion/2/at"), json!([20, 30])),
        (&motion("l v j + u"), &zone("/motion/1/at"), json!([30, 25])),
    ]);
}

#[test]
fn what_is_no_number_does_not_step() {
    for keys in
        [motion("+"), motion("5 -"), motion("v j +"), "/ \"function\" Enter +".into(), "/ \"name\" Enter -".into()]
    {
        let mut state = state();
        press(&mut state, &keys);
        let message = state.message.clone().unwrap();
        assert!(message.bad && message.text.contains("is not a number"), "{keys}: {message:?}");
        assert!(state.scene.is_saved(), "{keys}");
    }
}

#[test]
fn out_of_range_tells_the_range_and_keeps_what_was_typed() {
    let mut state = state();
    press(&mut state, "/ \"radius\" Enter i \"-5\" Enter");
    let message = state.message.clone().unwrap();
    assert!(message.bad && message.text.contains("0.001 to 1000000 px"), "{message:?}");
    assert!(matches!(&state.typing.mode, Mode::Entry(entry) if entry.text.value() == "-5"));
    press(&mut state, "Ctrl-u \"1/0\" Enter");
    assert!(state.message.clone().unwrap().text.contains("finite"));
    press(&mut state, "Ctrl-u \"80\" Enter");
    assert_eq!(state.document().json().pointer(&zone("/interpolation/radius")), Some(&json!(80)));
}

#[test]
fn rows_and_nodes_come_and_go() {
    check(&[
        (&motion("j d"), &zone("/motion/1"), json!({"tool": "point", "at": [40, 30]})),
        (&motion("D"), &zone("/motion/1"), json!({"tool": "point", "at": [20, 20], "jump": [0, -18]})),
        (&motion("J"), &zone("/motion/1/at"), json!([20, 20])),
        (&motion("j K"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("v j d"), &zone("/motion/0/at"), json!([40, 30])),
        (&motion("o"), &zone("/motion/1/tool"), json!("point")),
        ("d", "/layers/0/zones/0/name", json!("mouth")),
        ("D", "/layers/0/zones/1/name", json!("left eye 2")),
        ("J", "/layers/0/zones/1/name", json!("left eye")),
        ("d u", "/layers/0/zones/0/name", json!("left eye")),
    ]);
}

#[test]
fn kinds_and_optional_nodes_are_chosen() {
    check(&[
        ("/ \"interpolation\" Enter Enter Enter j j Enter", &zone("/interpolation/method"), json!("thin-plate")),
        ("/ \"function\" Enter Enter j Enter", &zone("/position/function"), json!("cosine")),
        ("/ \"fold\" Enter o Enter", &zone("/fold/rule"), json!("cover")),
        ("/ \"fold\" Enter o j Enter", &zone("/fold/rule"), json!("return")),
        ("/ \"fold\" Enter o Enter d", &zone("/fold"), Value::Null),
        ("/ \"sampler\" Enter o", &zone("/sampler/image"), json!("cat")),
        (
            ": \"add falls/%d.png\" Enter / \"sampler\" Enter o / \"clip\" Enter Enter Enter",
            &zone("/sampler"),
            json!({ "clip": "falls" }),
        ),
        ("/ \"loop\" Enter Enter j Enter", "/timeline/loop", json!("ping-pong")),
    ]);
}

#[test]
fn points_are_placed_on_the_picture() {
    check(&[
        (&motion("g i 5 l 2 J a"), &zone("/motion/1/at"), json!([35.5, 45.5])),
        (&motion("g i w r"), &zone("/motion/1/at"), json!([30, 25])),
        (&motion("g i b w w l j r"), &zone("/motion/1/at"), json!([31, 26])),
        (&motion("g i w s l l 3 K Enter"), &zone("/motion/1/jump"), json!([2, -24.5])),
        (&motion("g i w s l l Esc"), &zone("/motion/1/jump"), json!([3, 4])),
        ("/ \"outline\" Enter g i H a", &zone("/outline/points/4"), json!([20.5, 25.5])),
    ]);
}

#[test]
fn commands_set_and_say() {
    check(&[
        (": \"set layers.face.zones.mouth.speed=2\" Enter", "/layers/0/zones/1/speed", json!(2)),
        (": \"set /layers/0/zones/1/feather=1.5\" Enter", "/layers/0/zones/1/feather", json!(1.5)),
        (": \"set title=12\" Enter", "/title", json!("12")),
        (": \"set layers.face.zones.mouth.speed=2\" Enter : \"undo\" Enter", "/layers/0/zones/1/speed", Value::Null),
        (": \"set lay Tab . Tab", "/title", Value::Null),
    ]);
    for (line, part) in [
        ("sett a=1", "did you mean \"set\""),
        ("set a=1", "a"),
        ("set layers.face.zones.mouth.speeed=1", "speed"),
        ("q", ":q!"),
        ("probe x", "X,Y"),
        ("view zoom-in on", "no switch"),
        ("select within 1 2 3 x", "\"x\""),
        ("cursor 1 x", "\"x\""),
    ] {
        let mut state = state();
        press(&mut state, "/ \"speed\" Enter + :");
        press(&mut state, &format!("\"{line}\" Enter"));
        let message = state.message.clone().unwrap();
        assert!(message.bad && message.text.contains(part), "{line}: {message:?}");
    }
}

#[test]
fn leaving_is_refused_with_unsaved_edits_only() {
    let quits = |keys: &str| press(&mut state(), keys).iter().any(|effect| matches!(effect, Effect::Quit));
    for (keys, leaves) in [
        (": \"q\" Enter", true),
        ("d : \"q\" Enter", false),
        ("d u : \"q\" Enter", true),
        ("d : \"q!\" Enter", true),
        ("Space q", true),
        ("Ctrl-c", false),
    ] {
        assert_eq!(quits(keys), leaves, "{keys}");
    }
}

#[test]
fn time_goes_by_frames() {
    for (keys, time) in
        [("]", 0.05), ("3 ]", 0.15), ("[", 0.95), ("}", 0.95), ("} {", 0.0), (": \"time 0.5\" Enter", 0.5)]
    {
        let mut state = state();
        press(&mut state, keys);
        assert_eq!(state.play.time, time, "{keys}");
    }
}

#[test]
fn escape_ends_one_thing_after_the_other() {
    let mut state = state();
    press(&mut state, &motion("v i"));
    for left in ["entry", "selection", "nothing", "nothing"] {
        press(&mut state, "Esc");
        let now =
            (matches!(state.typing.mode, Mode::Entry(_)), state.cursor.selected_from.is_some(), state.cursor.focus);
        let expected = match left {
            "entry" => (false, true, super::state::Pane::Table),
            _ => (false, false, super::state::Pane::Table),
        };
        assert_eq!(now, expected, "after {left}");
    }
    // Esc pressed by habit does not leave the row, so that d then deletes only the row.
    check(&[(&motion("Esc Esc d"), &zone("/motion/2/tool"), json!("scale"))]);
}

#[test]
fn an_alt_key_that_is_not_bound_is_escape_and_that_key() {
    check(&[
        (&motion("Alt-j d"), &zone("/motion/1/at"), json!([40, 30])),
        (&motion("v j Alt-d"), &zone("/motion/1/at"), json!([40, 30])),
        (&motion("l i \"99\" Alt-d Esc"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion("l i \"99\" Alt-j i \"7\" Enter"), &zone("/motion/1/at"), json!([7, 25])),
        (&motion("g Alt-j d"), &zone("/motion/1/at"), json!([40, 30])),
        (
            &motion("Ctrl-Alt-d d"),
            &zone("/motion"),
            json!([
                { "tool": "point", "at": [20, 20], "jump": [0, -18] },
                { "tool": "point", "at": [30, 25], "jump": [3, 4] },
                { "tool": "point", "at": [40, 30] }
            ]),
        ),
    ]);
}

#[test]
fn nothing_is_edited_on_a_terminal_that_is_too_small() {
    use super::commands::update::update;
    use super::events::Event;
    let keys = ["d", "o", "+", "D", "p", "P", "u", "Enter", "5", "Alt-d", "Space w", "v", ".", "q a", "Tab", "y"];
    for small in [(59, 24), (60, 19), (1, 1), (0, 0)] {
        let mut state = state();
        press(&mut state, &motion("l"));
        update(&mut state, Event::Resize(small.0, small.1));
        let before = (state.document().json().clone(), state.cursor.row, state.cursor.column, state.cursor.focus);
        for key in keys {
            let effects = press(&mut state, key);
            assert!(effects.is_empty(), "{key}: {effects:?}");
        }
        for paste in ["7", "1,2,3,4\r", "{}"] {
            update(&mut state, Event::Paste(paste.into()));
        }
        update(&mut state, Event::Click(3, 3));
        press(&mut state, ": \"set layers.0.name=x\" Enter / \"x\" Enter");
        assert!(matches!(state.typing.mode, Mode::Normal) && state.memory.recorder.recording().is_none());
        let after = (state.document().json().clone(), state.cursor.row, state.cursor.column, state.cursor.focus);
        assert_eq!(after, before, "{small:?}");
        assert!(matches!(press(&mut state, ": \"quit\" Enter")[..], [Effect::Quit]));
        update(&mut state, Event::Resize(60, 20));
        press(&mut state, "+");
        assert_ne!(state.document().json(), &before.0);
    }
}
