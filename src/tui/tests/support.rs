//! What the tests of the editor share: a scene, pressing keys, and looking at the result.

use std::sync::LazyLock;

use serde_json::Value;

use crate::preview::editor;
use crate::preview::wire::message::Gesture;
use crate::tui::commands::obey;
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::State;
use crate::tui::text::color::Depth;

/// A scene with one of everything that the tests need.
pub const SCENE: &str = r#"{
  "plica": 1,
  "timeline": { "duration": 2, "fps": 10 },
  "images": { "cat": { "path": "cat.png" } },
  "layers": [
    {
      "kind": "picture", "name": "face", "image": "cat",
      "zones": [
        {
          "name": "left eye",
          "outline": { "kind": "polygon", "points": [[10, 10], [50, 10], [50, 40], [10, 40]] },
          "motion": [
            { "tool": "point", "at": [20, 20], "jump": [0, -18] },
            { "tool": "point", "at": [30, 25], "jump": [3, 4] },
            { "tool": "point", "at": [40, 30] },
            { "tool": "scale", "center": [30, 25], "factor": [1.1, 1] }
          ],
          "interpolation": { "method": "modified-shepard", "radius": 60 },
          "position": { "function": "sine", "cycles": 0.5 }
        },
        { "name": "mouth", "outline": { "kind": "rectangle", "x": 20, "y": 45, "width": 30, "height": 10 } }
      ]
    }
  ]
}"#;

/// A message of a window.
pub fn said(message: Gesture) -> Event {
    Event::Window(editor::Event::Said(message.into()))
}

/// The editor with [`SCENE`] open on a terminal of 80 x 24. Edits stay in memory.
pub fn state() -> State {
    static FOLDER: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("cat.plica.json"), SCENE).unwrap();
        for first in ["falls/0000.jpg", "falls/0.png", "late/0007.jpg", "b/fire-0.png", "a.0.png"] {
            let file = folder.path().join(first);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, "").unwrap();
        }
        folder
    });
    let scene = OpenScene::in_memory(&FOLDER.path().join("cat.plica.json"));
    let mut state = State::new(scene, (80, 24), Depth::None);
    state.picture.size = Some((64, 64));
    state
}

/// The editor with the scene `text` open, as [`state`].
pub fn state_of(text: &str) -> State {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    std::fs::write(&path, text).unwrap();
    State::new(OpenScene::in_memory(&path), (80, 24), Depth::None)
}

/// Presses keys, which are separated by spaces; `"text"` types text. Returns all effects.
pub fn press(state: &mut State, keys: &str) -> Vec<Effect> {
    let mut effects = Vec::new();
    for (i, part) in keys.split('"').enumerate() {
        if i % 2 == 1 {
            for c in part.chars() {
                effects.extend(update(state, Event::Key(if c == ' ' { "Space".into() } else { c.to_string() })));
            }
        } else {
            for key in part.split_whitespace() {
                effects.extend(update(state, Event::Key(key.into())));
            }
        }
    }
    effects
}

/// Pastes a text as the terminal does.
pub fn paste(state: &mut State, text: &str) {
    update(state, Event::Paste(text.into()));
}

/// The value at a pointer.
pub fn at(state: &State, pointer: &str) -> Value {
    state.document().json().pointer(pointer).cloned().unwrap_or(Value::Null)
}

/// The last message, and whether it says that something could not be done.
pub fn said_last(state: &State) -> (bool, String) {
    state.message.as_ref().map_or((false, String::new()), |message| (message.bad, message.text.clone()))
}

/// Another editor on [`SCENE`] that has run the log of this one.
pub fn replayed(state: &State) -> State {
    let mut other = self::state();
    for line in state.memory.recorder.log().iter().filter(|line| !line.starts_with('#')) {
        obey(&mut other, line, None).unwrap_or_else(|why| panic!("{line}: {why}\n{:#?}", state.memory.recorder.log()));
    }
    other
}
