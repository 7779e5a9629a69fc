//! The small drawings beside forms.

use super::screens::screen;
use super::support::state_of;
use crate::tui::commands;
use crate::tui::graphics::counts::{Counts, PARTS};
use crate::tui::layout::{self, picture};
use crate::tui::state::State;

pub const SCENE: &str = r##"{"plica": 1, "size": [64, 48], "camera": {"position": [0, 0, 4]}, "meshes": {"m": {"path": "m.obj"}},
  "layers": [{"kind": "mesh", "name": "m", "mesh": "m", "strokes": {"style": "none",
    "noises": {"a": {"spacing": 8, "regularity": 2}},
    "marks": [{"name": "ink", "kind": "ink", "noise": "a", "amount": 0.5}, {"name": "line", "kind": "outline"}]}}]}"##;

fn at(path: &str) -> State {
    let mut state = state_of(SCENE);
    state.size = (160, 48);
    commands::run(&mut state, &format!("go {path}"), None);
    state
}

#[test]
fn a_noise_is_drawn_with_its_lengths_to_scale() {
    let text = screen(&at("layers.m.strokes.noises.a"));
    assert!(text.contains("spacing 8 px ├──────┤   radius 16 px ├──────────────┤"), "{text}");
    let grey = text.chars().filter(|c| "-=+*#".contains(*c)).count();
    assert!(grey > 300, "without colors characters are dark and light: {grey}\n{text}");
}

#[test]
fn a_mark_of_ink_has_a_curve_over_the_pixels_of_each_tone() {
    let mut state = at("layers.m.strokes.marks.ink");
    let asked = picture::count_at(&state).unwrap();
    assert_eq!((asked.of.pass.name, asked.of.layer), ("tone", Some(0)));
    assert!(screen(&state).contains("counting pixels"));
    let drawn = |state: &State| screen(state).chars().filter(|c| ('⠁'..='⣿').contains(c)).count();
    let before = drawn(&state);
    let mut shares = vec![0.0; PARTS];
    (shares[40], shares[41]) = (0.25, 0.75);
    state.picture.counts = Some(Counts { at: asked, shares }.into());
    assert!(screen(&state).contains("pixels of each tone") && drawn(&state) > before);
    // What was counted at another time is not that.
    state.play.time = 0.25;
    assert!(screen(&state).contains("counting pixels"));
}

#[test]
fn what_has_no_drawing_says_what_has_one() {
    for path in ["layers.m.strokes.marks.line", "layers.m", "camera"] {
        let state = at(path);
        assert_eq!(picture::count_at(&state), None, "{path}");
        assert!(screen(&state).contains("select a noise or a mark of ink"), "{path}");
    }
    let mut narrow = at("layers.m.strokes.marks.ink");
    narrow.size = (80, 24);
    assert!(
        layout::areas_of(&narrow).sketch.is_none() && picture::count_at(&narrow).is_none(),
        "nobody counts in vain"
    );
}
