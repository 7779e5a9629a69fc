//! Numbers that follow from others: dimmed where nothing is written, and an edit starts from them; and what the status line
//! tells of a layer.

use std::sync::Arc;

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Modifier;
use serde_json::{Value, json};

use super::screens::{changed, screen};
use super::support::{at, press, state_of};
use crate::base::clip::Clip;
use crate::base::picture::Picture;
use crate::layers::parts::materials::Materials;
use crate::render;
use crate::tui::panes::marks::Kept;
use crate::tui::panes::view;
use crate::tui::state::{Pane, State};

const SCENE: &str = r#"{
  "plica": 1, "size": [32, 32], "camera": {}, "clips": { "water": { "path": "%d.png" } },
  "layers": [{
    "kind": "waterfall", "name": "falls", "clip": "water", "thickness": 0.125,
    "sprites": { "size": 16, "keys": 2, "step": 1 }
  }]
}"#;

fn shown(node: &str) -> State {
    let mut state = state_of(SCENE);
    state.show(node);
    state.cursor.focus = Pane::Table;
    state
}

/// Whether the number in the row of this name is dimmed.
fn dimmed(state: &State, name: &str) -> bool {
    let mut terminal = Terminal::new(TestBackend::new(state.size.0, state.size.1)).unwrap();
    terminal.draw(|frame| view::draw(frame, state, &mut Kept::default())).unwrap();
    let buffer = terminal.backend().buffer();
    let mut rows = buffer.content().chunks(usize::from(state.size.0));
    let row = rows.find_map(|row| {
        let line: String = row.iter().map(|cell| cell.symbol()).collect();
        let at = line.find(&format!("│{name} "))?;
        Some((row, line[..at].chars().count() + name.len() + 1))
    });
    let (row, end) = row.unwrap();
    let number = row[end..].iter().find(|cell| cell.symbol().chars().all(|c| c.is_ascii_digit())).unwrap();
    number.modifier.contains(Modifier::DIM)
}

#[test]
fn screens_are_as_kept_of_automatic_numbers() {
    let mut state = shown("/layers/0");
    press(&mut state, "/ \"spread\" Enter");
    assert_eq!(changed("automatic", &state), None, "PLICA_UPDATE=1 writes it anew");
    assert!(dimmed(&state, "rate") && !dimmed(&state, "thickness"));
}

#[test]
fn an_edit_starts_from_the_automatic_number_and_writes_nothing_else() {
    for (node, keys, pointer, expected) in [
        ("/layers/0", "/ \"soft\" Enter i \"*2\" Enter", "/soft", json!(0.2)),
        ("/layers/0", "/ \"soft\" Enter +", "/soft", json!(1.1)),
        ("/layers/0", "/ \"soft\" Enter + u", "/soft", Value::Null),
        ("/layers/0", ": \"set layers.falls.pool=-2\" Enter / \"soft\" Enter i \"*2\" Enter", "/soft", json!(0.4)),
        ("/layers/0", "/ \"scatter\" Enter i \"1\" Enter", "/scatter/0", json!(1)),
        ("/layers/0", "/ \"soft\" Enter +", "/height", Value::Null),
    ] {
        let mut state = shown(node);
        press(&mut state, keys);
        assert_eq!(at(&state, &format!("/layers/0{pointer}")), expected, "{keys}: {:?}", state.message);
    }
}

#[test]
fn the_status_line_tells_of_the_layer_that_is_shown() {
    let mut state = shown("/layers/0");
    // A pattern that falls by 2 pixels a frame.
    let shade = |i: usize, k: usize| (((i % 48) * 7919 + (i / 48 + 96 - 2 * k) * 104_729) % 251) as f32 / 250.0;
    let frame = |k| {
        let cells = (0..48 * 48).map(|i| [shade(i, k), shade(i, k), shade(i, k), 1.0]).collect();
        Arc::new(Picture::from_cells(48, 48, cells))
    };
    let clip = Clip { fps: 25.0, frames: (0..6).map(frame).collect() };
    let materials = Materials { clips: [("water".to_owned(), Arc::new(clip))].into(), ..Materials::default() };
    state.picture.synth = Some(Arc::new(render::synth(state.document().scene(), &materials, None).unwrap()));
    state.picture.frame_ms = Some(35.4);
    let line = |state: &State| screen(state).lines().find(|line| line.contains("  t 0")).unwrap().to_owned();
    let told = line(&state);
    assert!(told.contains("h 2 m  life 0.") && told.contains("  frame 35 ms  step 1"), "{told}");
    let sprites = told.split("sprites ").nth(1).unwrap().split(' ').next().unwrap();
    assert!(sprites.parse::<f64>().is_ok_and(|sprites| sprites > 1000.0), "{told}");
    state.show("");
    assert!(!line(&state).contains("sprites"), "the scene is shown, not the layer");
}
