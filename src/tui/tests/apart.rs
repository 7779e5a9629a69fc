//! Layers and zones that are shown alone, not shown, or locked.

use serde_json::json;

use super::support::{at, press, replayed, said_last, state, state_of};
use super::{check, zone};
use crate::tui::commands::obey;
use crate::tui::events::Effect;
use crate::tui::layout::picture::request;
use crate::tui::panes::status;
use crate::tui::state::State;

const EYE: &str = "/layers/0/zones/0";
const MOUTH: &str = "/layers/0/zones/1";

fn hidden(state: &State) -> Vec<String> {
    request(state).how.muted
}

#[test]
pub fn what_is_locked_is_not_edited() {
    check(&[
        (
            "L : \"set layers.face.zones.*.feather=3\" Enter",
            MOUTH,
            json!({ "name": "mouth", "outline": { "kind": "rectangle", "x": 20, "y": 45, "width": 30, "height": 10 } }),
        ),
        ("L d", &zone("/name"), json!("left eye")),
        ("L L d", &zone("/name"), json!("mouth")),
        ("L : \"set layers.face.zones.mouth.feather=3\" Enter", "/layers/0/zones/1/feather", json!(3)),
        ("L : \"lock none\" Enter d", &zone("/name"), json!("mouth")),
        ("/ \"radius\" Enter L +", &zone("/interpolation/radius"), json!(60)),
        // A lock goes along with its zone.
        ("L j j j j j j : \"go layers.face.zones.mouth\" Enter K d", "/layers/0/zones/0/name", json!("left eye")),
        ("x s d", &zone("/name"), json!("mouth")),
        (": \"seen\" Enter L d", &zone("/name"), json!("left eye")),
    ]);
    let mut state = state();
    press(&mut state, "L d");
    assert!(
        said_last(&state).1.contains("is locked: :lock layers.face.zones.\"left eye\" (L on it) unlocks it"),
        "{:?}",
        said_last(&state)
    );
    assert!(state.scene.is_saved());
}

#[test]
fn what_is_muted_or_not_solo_is_hidden_here_and_in_the_window() {
    for (lines, expected) in [
        (&["mute"][..], vec![EYE]),
        (&["mute", "mute"], vec![]),
        (&["solo"], vec![MOUTH]),
        (&["solo", "solo layers.face.zones.mouth"], vec![]),
        (&["solo", "mute"], vec![EYE, MOUTH]),
        (&["solo layers.face"], vec![]),
        (&["mute layers.face.image"], vec!["/layers/0"]),
        (&["mute", "mute layers.face.zones.mouth", "mute none"], vec![]),
        // They go along with their zones.
        (&["mute", "go layers.face.zones.mouth", "reorder up"], vec![MOUTH]),
        (&["mute", "delete"], vec![]),
    ] {
        let mut state = state();
        let run = |line: &&str| obey(&mut state, line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
        lines.iter().for_each(run);
        assert_eq!(hidden(&state), expected, "{lines:?}");
        assert!(state.effects.iter().any(|effect| matches!(effect, Effect::Mute)), "{lines:?}");
        assert_eq!(hidden(&replayed(&state)), expected, "{lines:?}");
    }
    let mut state = state();
    for (line, said) in [
        ("mute", "layers.face.zones.\"left eye\" is muted: not shown, but exported"),
        ("solo timeline", "only layers and zones: go to one"),
        ("lock nowhere", "there is no field \"nowhere\""),
        ("seen edit", "seen takes a subcommand"),
        ("seen", "seen takes a subcommand: :seen render"),
    ] {
        let done = obey(&mut state, line, None);
        let told = done.err().unwrap_or_else(|| said_last(&state).1);
        assert!(told.contains(said), "{line}: {told}");
    }
    obey(&mut state, "seen render -o a.gif", None).unwrap();
    assert!(state.effects.iter().any(|effect| matches!(effect, Effect::RunSeen(words) if words[0] == "render")));
    assert_eq!(at(&state, EYE)["name"], "left eye");
    let area = ratatui::layout::Rect::new(0, 0, 80, 1);
    let mut buffer = ratatui::buffer::Buffer::empty(area);
    status::draw(&state, area, &mut buffer);
    let line: String = buffer.content().iter().map(|cell| cell.symbol()).collect();
    assert!(line.contains("muted"), "{line}");
}

#[test]
pub fn what_is_drawn_is_compared_here_and_in_the_window() {
    let with_strokes = r#"{ "plica": 1, "size": [8, 6], "camera": { "position": [0, 0, 3] }, "meshes": { "m": { "path": "m.obj" } },
        "layers": [{ "kind": "mesh", "name": "m", "mesh": "m", "strokes": {} }] }"#;
    for (lines, expected, said) in [
        (&["compare style"][..], Some("style"), "from left to right: hatching, cross-hatching"),
        (&["compare"], Some("anchor"), "from left to right: surface, screen, texture; :compare ends it"),
        (&["compare", "compare"], None, "the scene as it is"),
        (&["compare none"], None, "nothing is compared"),
        (&["compare style", "compare anchor"], Some("anchor"), "surface"),
    ] {
        let mut state = state_of(with_strokes);
        let run = |line: &&str| obey(&mut state, line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
        lines.iter().for_each(run);
        assert_eq!(request(&state).how.compared.as_deref(), expected, "{lines:?}");
        assert!(said_last(&state).1.contains(said), "{:?}", said_last(&state));
        assert!(state.effects.iter().any(|effect| matches!(effect, Effect::Compare)), "{lines:?}");
    }
    let mut state = state_of(with_strokes);
    obey(&mut state, "compare", None).unwrap();
    let why = obey(&mut state, "seen render -o a.png", None).unwrap_err();
    assert!(why.contains(":compare none"), "{why}");
    let why = obey(&mut self::state(), "compare anchor", None).unwrap_err();
    assert!(why.contains("no layer has strokes"), "{why}");
    let words = |line: &str| obey(&mut self::state(), line, None).unwrap_err();
    for name in crate::scene::compared::names() {
        assert!(words("compare x").contains(name), "the command knows {name}");
    }
}

#[test]
fn what_is_locked_is_not_changed_through_its_shapes() {
    let mut state = state();
    for line in ["go layers.face.zones.mouth.outline", "share k", "lock"] {
        obey(&mut state, line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
    }
    let why = obey(&mut state, "set shapes.k.nodes.0.at=[1,1]", None).unwrap_err();
    assert!(why.contains("layers.face.zones.mouth is locked"), "{why}");
    obey(&mut state, "lock none", None).unwrap();
    obey(&mut state, "set shapes.k.nodes.0.at=[1,1]", None).unwrap();
}

#[test]
fn what_is_muted_and_solo_says_that_it_is_not_shown() {
    let mut state = state();
    for line in ["mute layers.face.zones.mouth", "solo layers.face.zones.mouth"] {
        obey(&mut state, line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
    }
    assert!(said_last(&state).1.contains("but it is muted, so it is not shown: x shows it"), "{:?}", said_last(&state));
}
