//! Presets applied in the editor.

use serde_json::{Value, json};

use super::support::{at, press, said_last, state, state_of};
use crate::tui::commands::obey;
use crate::tui::events::Effect;
use crate::tui::state::{Mode, State};

const SCENE: &str = r#"{
  "plica": 1, "camera": {}, "clips": { "water": { "path": "%d.png" } },
  "layers": [
    { "kind": "fill", "name": "sky" },
    { "kind": "waterfall", "name": "falls", "clip": "water" },
    { "kind": "waterfall", "name": "mist", "clip": "water" }
  ]
}"#;

fn shown(layer: &str) -> State {
    let mut state = state_of(SCENE);
    state.show(layer);
    state
}

#[test]
pub fn a_preset_is_applied_in_one_step_to_the_layer_that_is_shown() {
    for (shows, changed) in [("", 1), ("/layers/0", 1), ("/layers/1", 1), ("/layers/2/look", 2)] {
        let mut state = shown(shows);
        let before = state.document().json().clone();
        let effects = press(&mut state, ": \"profile fire\" Enter");
        assert_eq!(at(&state, &format!("/layers/{changed}/gravity")), json!(-5), "{shows}");
        assert!(effects.iter().any(|effect| matches!(effect, Effect::Publish(_))), "the pictures change");
        let name = if changed == 1 { "falls" } else { "mist" };
        let told = format!("fire is applied to {name}; it wants a clip that was taken against black");
        assert_eq!(said_last(&state), (false, told));
        press(&mut state, "u");
        assert_eq!(state.document().json(), &before, "one step of undo");
    }
}

#[test]
fn without_a_name_the_presets_for_the_layer_are_listed() {
    let mut state = shown("/layers/2");
    press(&mut state, ": \"profile\" Enter");
    let Mode::Choice(choice) = &state.typing.mode else { panic!("no list") };
    assert!(choice.options.iter().any(|(name, help)| name == "smoke" && help.contains("rises")), "{choice:?}");
    press(&mut state, "s Enter");
    assert_eq!(at(&state, "/layers/2/blend"), json!("over"));
    let mut again = shown("/layers/2");
    for line in state.memory.recorder.log().iter() {
        obey(&mut again, line, None).unwrap();
    }
    assert_eq!(again.document().json(), state.document().json(), "{:?}", state.memory.recorder.log());
    press(&mut state, ": \"profile smoke\" Enter");
    assert_eq!(said_last(&state).1, "smoke changes nothing in mist");
    let mut state = shown("/layers/0");
    press(&mut state, ": \"profile\" Enter");
    assert_eq!(said_last(&state), (true, "there are no presets for this layer".into()));
}

#[test]
fn a_preset_that_cannot_be_applied_says_why() {
    let mut state = state();
    for (line, told) in [
        ("profile smok", "there is no preset \"smok\" (did you mean \"smoke\"?)"),
        ("profile smoke", "smoke is for layers of kind waterfall, and the scene has none"),
    ] {
        press(&mut state, &format!(": \"{line}\" Enter"));
        assert_eq!(said_last(&state), (true, told.into()));
    }
    assert_eq!(at(&state, "/layers/1"), Value::Null);
}

#[test]
fn a_layer_is_drawn_in_a_style_in_one_step() {
    let scene = r##"{ "plica": 1, "camera": {}, "meshes": { "m": { "path": "m.obj" } }, "layers": [
        { "kind": "mesh", "name": "one", "mesh": "m" },
        { "kind": "mesh", "name": "two", "mesh": "m", "strokes": { "ink": "#20304a", "marks": [] } },
        { "kind": "fill", "name": "sky" }] }"##;
    for (shows, changed, written) in [
        ("/layers/1", 1, json!({ "style": "charcoal", "ink": "#20304a" })),
        ("/layers/2", 0, json!({ "style": "charcoal" })),
    ] {
        let mut state = state_of(scene);
        state.show(shows);
        let before = state.document().json().clone();
        press(&mut state, ": \"style charc\" Tab Enter");
        assert_eq!(at(&state, &format!("/layers/{changed}/strokes")), written, "{shows}");
        assert!(said_last(&state).1.starts_with("charcoal is applied to "), "{:?}", said_last(&state));
        press(&mut state, "u");
        assert_eq!(state.document().json(), &before, "one step of undo");
        press(&mut state, ": \"style\" Enter w Enter");
        assert_eq!(at(&state, &format!("/layers/{changed}/strokes/style")), json!("watercolor"));
    }
    let mut state = state_of(scene);
    press(&mut state, ": \"style oil\" Enter");
    assert!(said_last(&state).1.starts_with("there is no style \"oil\""), "{:?}", said_last(&state));
}

#[test]
fn names_are_completed() {
    let mut state = shown("/layers/1");
    press(&mut state, ": \"profile fi\" Tab");
    assert!(matches!(&state.typing.mode, Mode::Line(line) if line.text.value() == "profile fire"));
}

/// The anchor and the turn of the first layer's strokes.
fn drawn(state: &State) -> (Value, Value) {
    (at(state, "/layers/0/strokes/anchor"), at(state, "/layers/0/strokes/direction/turn"))
}

#[test]
pub fn strokes_are_turned_in_the_picture_and_fixed_to_the_next_thing() {
    let scene = r##"{ "plica": 1, "size": [32, 32], "camera": {}, "meshes": { "m": { "path": "m.obj" } }, "layers": [
        { "kind": "mesh", "name": "cow", "mesh": "m", "strokes": { "style": "hatching" } },
        { "kind": "mesh", "name": "bare", "mesh": "m" } ] }"##;
    for (layer, keys, anchor, turn) in [
        (0, "Space a", json!("screen"), Value::Null),
        (0, "Space a Space a", json!("texture"), Value::Null),
        (0, "Space a Space a Space a", json!("surface"), Value::Null),
        (0, ": \"anchor texture\" Enter", json!("texture"), Value::Null),
        (0, "g i r Left r Left r Right", Value::Null, json!(5)),
        (0, "g i r Right", Value::Null, json!(355)),
        (0, "g i r Up : \"turn 0.5\" Enter", Value::Null, json!(45.5)),
        (0, "g i 3 r Down", Value::Null, json!(225)),
    ] {
        let mut state = state_of(scene);
        state.picture.size = Some((32, 32));
        state.show(format!("/layers/{layer}"));
        press(&mut state, keys);
        assert_eq!(drawn(&state), (anchor, turn), "{keys}: {:?}", state.message);
    }
    let mut state = state_of(scene);
    state.show("/layers/0");
    press(&mut state, ": \"anchor scene\" Enter");
    assert!(said_last(&state).1.starts_with("strokes are not fixed to \"scene\""), "{:?}", state.message);
    for (line, style) in
        [("next", "cross-hatching"), ("previous", "hatching"), ("previous", "painterly"), ("next", "hatching")]
    {
        press(&mut state, &format!(": \"style {line}\" Enter"));
        assert_eq!(at(&state, "/layers/0/strokes/style"), json!(style), "{line}");
    }
    // Where nothing is drawn in strokes a point is moved by the same key.
    state.show("/layers/1");
    press(&mut state, "g i r");
    assert!(said_last(&state).1.contains("no row here has a place") || said_last(&state).0, "{:?}", state.message);
}
