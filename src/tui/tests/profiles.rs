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
