//! Edits of a selection, undo and the history.

use serde_json::{Value, json};

use super::support::{at, press, said_last, state};
use super::{check, motion, zone};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::state::{Mode, State};

#[test]
pub fn edits_apply_to_the_selection_which_stays() {
    check(&[
        (&motion("l V i \"7\" Enter"), &zone("/motion/2/at"), json!([7, 30])),
        (&motion("l % + +"), &zone("/motion/2/at"), json!([42, 30])),
        (&motion("l v j + + + u"), &zone("/motion/1/at"), json!([30, 25])),
        (&motion("l v 2 j i \"100+10*i/n\" Enter"), &zone("/motion/1/at"), json!([103.333333333, 25])),
        (&motion("l v j Esc j g v +"), &zone("/motion/0/at"), json!([21, 20])),
        (&motion("v j J"), &zone("/motion/0/at"), json!([40, 30])),
        (&motion("v j J J"), &zone("/motion/3/at"), json!([30, 25])),
        (&motion("v j 9 J 9 K"), &zone("/motion/1/at"), json!([30, 25])),
        (&motion("v j J l +"), &zone("/motion/1/at"), json!([21, 20])),
        (&motion("v j D"), &zone("/motion/2/at"), json!([20, 20])),
        (&motion("v j D l +"), &zone("/motion/2/at"), json!([21, 20])),
        (&motion("2 D u"), &zone("/motion/1/at"), json!([30, 25])),
        (&motion("j v j d"), &zone("/motion/1/tool"), json!("scale")),
        (&motion("v j y Esc p"), &zone("/motion/2/at"), json!([20, 20])),
        (&motion("6 l v 2 j i \"0\" Enter"), &zone("/motion/1/jump"), json!([5, 0])),
        (&motion("6 l v 2 j i \"0\" Enter"), &zone("/motion/2/jump"), Value::Null),
        (&motion("5 l v 2 j i \"*2\" Enter"), &zone("/motion/1/jump"), json!([6, 8])),
        (&motion("o i \"1\" Tab \"2\" Enter"), &zone("/motion/1/at"), json!([1, 2])),
        ("d : \"history\" Enter j q u", &zone("/name"), json!("left eye")),
        ("/ \"images\" Enter Enter D", "/images/cat 2/path", json!("cat.png")),
        ("/ \"outline\" Enter Enter j V y", &zone("/outline/kind"), json!("polygon")),
    ]);
}

#[test]
fn a_held_key_is_one_step_whatever_it_steps() {
    for keys in [
        motion("l + + +"),
        motion("l v j + + +"),
        motion("2 j 3 l + + +"),
        "/ \"feather\" Enter + + +".into(),
        "/ \"mouth\" Enter / \"cycles\" Enter + + +".into(),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(!state.scene.is_saved(), "{keys}");
        press(&mut state, "u");
        assert!(state.scene.is_saved(), "{keys}");
    }
}

#[test]
pub fn undo_says_what_it_undid() {
    for (keys, words) in [
        ("/ \"radius\" Enter i \"80\" Enter u", "undone: left eye · radius 60 → 80"),
        ("/ \"radius\" Enter i \"80\" Enter u Ctrl-r", "done again: left eye · radius 60 → 80"),
        ("/ \"radius\" Enter + j + : \"undo 2\" Enter", "2 steps undone, the last: left eye · radius 60 → 61"),
        ("/ \"radius\" Enter + j + : \"earlier 2\" Enter", "2 steps undone, the last: left eye · radius 60 → 61"),
        ("/ \"radius\" Enter + j + u u : \"later 2\" Enter", "2 steps done again, the last:"),
        ("/ \"radius\" Enter + : \"earlier 1h\" Enter", "1 step undone"),
        ("/ \"radius\" Enter + u : \"later 30s\" Enter", "1 step done again"),
        ("u", "nothing to undo"),
        ("/ \"radius\" Enter + u k j + g -", "at #1 of 2: left eye · radius 60 → 61"),
        ("/ \"radius\" Enter + u k j + g - g +", "at #2 of 2: left eye · radius 60 → 61"),
        ("/ \"radius\" Enter + u k j + 2 g -", "undone: left eye · radius 60 → 61"),
        ("/ \"radius\" Enter + u k j + : \"undo #1\" Enter", "at #1 of 2: left eye · radius 60 → 61"),
        (": \"undo #1\" Enter", "there is no state #1: there are #0 to #0"),
        ("/ \"radius\" Enter : \"snapshot\" Enter + g a", "snapshot a (g a flips)"),
        (
            "/ \"radius\" Enter : \"snapshot b\" Enter + : \"flip b\" Enter : \"flip b\" Enter",
            "as it is without snapshot b",
        ),
        (": \"snapshot\" Enter g a", "the scene is as in snapshot a: edit it first"),
        ("g a", "there is no snapshot a: :snapshot a keeps the scene as it is"),
        (": \"snapshot A\" Enter", "a snapshot has a letter from a to z, not A"),
        ("g +", "nothing to redo"),
        (": \"undo x\" Enter", "x is not a number of steps"),
        (": \"earlier 3w\" Enter", "3w is not a time"),
        (": \"later 3m\" Enter", "nothing to redo within 3m"),
    ] {
        let mut state = state();
        press(&mut state, keys);
        assert!(said_last(&state).1.starts_with(words), "{keys}: {}", said_last(&state).1);
    }
}

#[test]
fn a_snapshot_is_flipped_to_and_back_and_loses_nothing() {
    let mut state = state();
    let radius = |state: &State| state.document().json().pointer(&zone("/interpolation/radius")).cloned();
    press(&mut state, "/ \"radius\" Enter : \"snapshot\" Enter + +");
    let seen = |state: &mut State, keys: &str| {
        press(state, keys);
        radius(state).unwrap()
    };
    assert_eq!(["g a", "g a", "g a"].map(|keys| seen(&mut state, keys)), [60, 62, 60].map(|n| json!(n)));
    // What is edited at the snapshot is a branch of its own.
    assert_eq!(["- -", "g a", "g a"].map(|keys| seen(&mut state, keys)), [58, 60, 58].map(|n| json!(n)));
}

#[test]
fn the_history_lists_what_each_step_did() {
    let mut state = state();
    press(&mut state, "/ \"radius\" Enter + k j / \"feather\" Enter + k j + u : \"history\" Enter");
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
    let told: Vec<&str> = pages.lines.iter().map(|line| line.split("just now").last().unwrap().trim()).collect();
    let expected = ["left eye · feather 1 → 2", "-- now --", "left eye · feather 0 → 1", "left eye · radius 60 → 61"];
    assert_eq!(told[..4], expected);
    assert_eq!(told[4].split_whitespace().collect::<Vec<_>>().join(" "), "#0 the beginning (as saved)");
    assert!(pages.lines[0].starts_with("redo 1") && pages.lines[3].starts_with("undo 2"), "{:?}", pages.lines);
    press(&mut state, "q u / \"feather\" Enter 9 + : \"history\" Enter");
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
    let told: Vec<String> =
        pages.lines.iter().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    let expected = [
        "-- now --",
        "undo 1 #4 just now mouth · feather 0 → 9",
        "undo 2 #1 just now left eye · radius 60 → 61",
        "#0 the beginning (as saved)",
        "",
        "-- other branches: :undo #STATE goes there, g- and g+ go through all states --",
        "after #2 #3 just now left eye · feather 1 → 2",
        "after #1 #2 just now left eye · feather 0 → 1",
    ];
    assert_eq!(told, expected);
}

#[test]
fn the_history_marks_the_state_that_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cat.plica.json");
    std::fs::write(&path, super::support::SCENE).unwrap();
    let scene = OpenScene::open(&path, crate::files::session::Mode::Edit, &crate::files::Options::default()).unwrap();
    let mut state = State::new(scene, (80, 24), crate::tui::text::color::Depth::None);
    press(&mut state, "/ \"radius\" Enter + k j +");
    state.scene.save(None, false).unwrap();
    press(&mut state, "k j +");
    for (keys, now) in [("", "-- now --"), ("u", "-- now (saved) --"), ("2 u", "-- now --"), ("3 Ctrl-r", "-- now --")]
    {
        press(&mut state, &format!("{keys} : \"history\" Enter"));
        let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
        let marked: Vec<&String> = pages.lines.iter().filter(|line| line.contains("(as saved)")).collect();
        assert!(matches!(marked[..], [line] if line.contains("#2 ")), "{keys}: {:#?}", pages.lines);
        assert!(pages.lines.iter().any(|line| line == now), "{keys}: {:#?}", pages.lines);
        press(&mut state, "q");
    }
}

#[test]
fn undo_goes_on_over_save_and_reopening_and_the_mark_follows() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cat.plica.json");
    std::fs::write(&path, super::support::SCENE).unwrap();
    let open = || {
        let scene =
            OpenScene::open(&path, crate::files::session::Mode::Edit, &crate::files::Options::default()).unwrap();
        State::new(scene, (80, 24), crate::tui::text::color::Depth::None)
    };
    let marks = |state: &mut State, keys: &[(&str, bool, i64)]| {
        for (key, saved, radius) in keys {
            press(state, key);
            let found = at(state, &zone("/interpolation/radius"));
            assert_eq!((state.scene.is_saved(), found), (*saved, json!(radius)), "{key}");
        }
    };
    let mut first = open();
    press(&mut first, "/ \"radius\" Enter");
    marks(&mut first, &[("+", false, 61), ("k j +", false, 62)]);
    first.scene.save(None, false).unwrap();
    marks(&mut first, &[("u", false, 61), ("Ctrl-r", true, 62), ("k j +", false, 63), ("u", true, 62)]);
    drop(first);
    let mut second = open();
    marks(&mut second, &[("", true, 62), ("u", false, 61), ("Ctrl-r", true, 62), ("Ctrl-r", false, 63)]);
    marks(&mut second, &[(": \"earlier 1h\" Enter", false, 60), (": \"later 1h\" Enter", false, 63), ("u", true, 62)]);
}
