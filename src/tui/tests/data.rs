//! Numbers, rows, clipboard and undo: (scene, keys, scene), and what the terminal pastes.

use serde_json::{Value, json};

use super::support::{press, state, state_of};
use super::{check, motion, zone};
use crate::scene::field::{self, Kind};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::{Mode, Pane, State};

fn paste(state: &mut State, text: &str) {
    update(state, Event::Paste(text.into()));
}

fn at(state: &State, pointer: &str) -> Value {
    state.document().json().pointer(pointer).cloned().unwrap_or(Value::Null)
}

fn said(state: &State) -> (bool, String) {
    state.message.as_ref().map_or((false, String::new()), |message| (message.bad, message.text.clone()))
}

fn copied(effects: &[Effect]) -> Option<&str> {
    effects.iter().find_map(|effect| if let Effect::Copy(text) = effect { Some(text.as_str()) } else { None })
}

#[test]
pub fn what_is_yanked_is_pasted_where_it_fits() {
    let still = json!({"tool": "point", "at": [20, 20], "jump": [0, -18]});
    check(&[
        (&motion("y p"), &zone("/motion/1"), still.clone()),
        (&motion("y j j p"), &zone("/motion/3"), still.clone()),
        (&motion("v j y Esc G p"), &zone("/motion/4"), still.clone()),
        (&motion("y 3 p"), &zone("/motion/3"), still.clone()),
        (&motion("y p u"), &zone("/motion/1/at"), json!([30, 25])),
        ("y p", "/layers/0/zones/1/name", json!("left eye 2")),
        ("y / \"motion\" Enter p", "/layers/0/zones/1/name", json!("left eye 2")),
        (&motion("y / \"mouth\" Enter p"), "/layers/0/zones/1/motion/0", still.clone()),
        (
            "/ \"outline\" Enter y / \"mouth\" Enter / \"outline\" Enter p",
            "/layers/0/zones/1/outline/kind",
            json!("polygon"),
        ),
        ("/ \"radius\" Enter y / \"feather\" Enter p", &zone("/feather"), json!(60)),
        (&motion("y / \"radius\" Enter p"), &zone("/interpolation/radius"), json!(60)),
        ("/ \"images\" Enter Enter y p", "/images/cat 2/path", json!("cat.png")),
        ("/ \"name\" Enter y j p", &zone("/name"), json!("left eye")),
        (&motion("Y p"), &zone("/motion/1"), still.clone()),
        (&motion("j y k Y p"), &zone("/motion/1"), still.clone()),
        (&motion("Y j y p"), &zone("/motion/2/at"), json!([30, 25])),
        (&motion("G Y g g p"), &zone("/motion/1/factor"), json!([1.1, 1])),
        (&motion("v j Y Esc G p"), &zone("/motion/4"), still.clone()),
    ]);
}

#[test]
fn what_does_not_fit_says_why_and_changes_nothing() {
    for (keys, part) in [
        ("p", "nothing has been yanked"),
        ("/ \"interpolation\" Enter y / \"points\" Enter Enter p", "expected a list of 2 numbers"),
        ("/ \"position\" Enter y / \"images\" Enter Enter p", "does not fit"),
        (": \"yank xml\" Enter", "json or csv"),
        ("Y", "as JSON"),
    ] {
        let mut state = state();
        press(&mut state, keys);
        let (bad, text) = said(&state);
        assert!(bad && text.contains(part), "{keys}: {text}");
        assert!(state.scene.is_saved(), "{keys}");
    }
}

#[test]
fn yanked_rows_go_to_the_clipboard_as_json_and_csv() {
    for (keys, text) in [
        ("/ \"radius\" Enter y", "60"),
        ("/ \"points\" Enter Enter y", "[10, 10]"),
        ("/ \"points\" Enter Enter v j Y", "x,y\n10,10\n50,10\n"),
        (&motion("Y"), "tool,x,y,dx,dy,|J|,°\npoint,20,20,0,-18,18,90\n"),
        ("/ \"points\" Enter Enter i \"1/3\" Enter Y", "x,y\n0.3333333333333333,10\n"),
    ] {
        let mut state = state();
        let effects = press(&mut state, keys);
        assert_eq!(copied(&effects), Some(text), "{keys}: {:?}", said(&state));
    }
    let mut large = state();
    let points: String = (0..20_000).map(|i| format!("{i} {}\n", i * i % 977)).collect();
    press(&mut large, "/ \"points\" Enter Enter");
    paste(&mut large, &points);
    let effects = press(&mut large, "v G y");
    assert_eq!(copied(&effects), None);
    assert!(said(&large).1.contains("too much for the terminal's clipboard"), "{:?}", said(&large));
}

#[test]
fn every_kind_of_node_can_be_yanked_and_pasted() {
    let mut state = state_of(include_str!("../../../tests/scenes/good/everything.json"));
    let whole = state.document().clone();
    let mut open = vec![String::new()];
    let mut seen = std::collections::BTreeSet::new();
    while let Some(holder) = open.pop() {
        for child in field::children(&whole, &holder) {
            open.push(child.pointer.clone());
            if field::value(&whole, &child.pointer).is_none_or(|value| value.is_null()) {
                continue;
            }
            // One of each kind of thing in each kind of place.
            let place: Vec<&str> = holder.split('/').filter(|token| token.parse::<usize>().is_err()).collect();
            if !seen.insert(format!("{place:?} {} {:?}", child.field.help, child.field.kind)) {
                continue;
            }
            state.cursor.focus = if seen.len() % 2 == 0 { Pane::Tree } else { Pane::Table };
            state.show(if state.cursor.focus == Pane::Tree { &child.pointer } else { &holder }.clone());
            state.cursor.row = state.sheet().position(&child.pointer).unwrap_or(0);
            press(&mut state, "y p");
            assert!(!said(&state).0, "{}: {}", child.pointer, said(&state).1);
            while !state.scene.is_saved() {
                press(&mut state, "u");
            }
        }
    }
    assert!(seen.len() > 50, "{}", seen.len());
}

#[test]
fn rows_are_pasted_into_tables() {
    let anchor = |x: f64, y: f64, dx: f64, dy: f64| json!({"tool": "point", "at": [x, y], "jump": [dx, dy]});
    let same = |a: &Value, b: &Value| {
        crate::scene::json::to_text(a).replace(".0", "") == crate::scene::json::to_text(b).replace(".0", "")
    };
    for (text, first, count) in [
        ("1,2,3,4\n5,6,7,8\n", anchor(1.0, 2.0, 3.0, 4.0), 2),
        ("x\ty\tdx\tdy\n1\t2\t3\t4\n", anchor(1.0, 2.0, 3.0, 4.0), 1),
        ("dy dx y x\n4 3 2 1\n", anchor(1.0, 2.0, 3.0, 4.0), 1),
        ("x;y;|J|;°\n1,5;2;18;90\n", anchor(1.5, 2.0, 0.0, -18.0), 1),
        ("tool,x,y,dx,dy,|J|,°\npoint,1,2,3,4,99,99\n", anchor(1.0, 2.0, 3.0, 4.0), 1),
        ("1 2 3 4\r5 6 7 8\r", anchor(1.0, 2.0, 3.0, 4.0), 2),
        ("1,5 2,5 3,5 4,5", anchor(1.5, 2.5, 3.5, 4.5), 1),
        ("1,5 2 3 4\r5 6,5 7 8", anchor(1.5, 2.0, 3.0, 4.0), 2),
        ("#,x,y\n1,7,8\n2,9,10\n", json!({"tool": "point", "at": [7, 8]}), 2),
        ("[{\"tool\": \"point\", \"at\": [1, 2]}]", json!({"tool": "point", "at": [1, 2]}), 1),
    ] {
        let mut state = state();
        press(&mut state, super::MOTION);
        paste(&mut state, text);
        assert!(!said(&state).0, "{text}: {}", said(&state).1);
        assert!(same(&at(&state, &zone("/motion/1")), &first), "{text}: {}", at(&state, &zone("/motion/1")));
        assert_eq!(at(&state, &zone("/motion")).as_array().unwrap().len(), 4 + count, "{text}");
        assert_eq!(state.cursor.row, 1);
        press(&mut state, "u");
        assert!(state.scene.is_saved(), "one step: {text}");
    }
}

#[test]
fn every_list_of_numbers_takes_rows() {
    for (keys, text, pointer, expected) in [
        ("/ \"points\" Enter Enter", "1 2\n3 4", zone("/outline/points/2"), json!([3, 4])),
        ("/ \"motion\" Enter", "1 2", zone("/motion/4"), json!({"tool": "point", "at": [1, 2]})),
        ("/ \"mouth\" Enter", "1 2", "/layers/0/zones/1/motion/0".into(), json!({"tool": "point", "at": [1, 2]})),
        (
            ": \"set layers.face.zones.mouth.position.function=keyframes\" Enter / \"mouth\" Enter / \"position\" Enter",
            "t,s\n0,0\n0.25,1\n1,0",
            "/layers/0/zones/1/position/points".into(),
            json!([[0, 0], [0.25, 1], [1, 0]]),
        ),
        (
            ": \"set layers.face.zones.mouth.position.function=piecewise\" Enter / \"mouth\" Enter / \"position\" Enter",
            "0.5 0 1\n1 1 0",
            "/layers/0/zones/1/position/segments".into(),
            json!([{"until": 0.5, "from": 0, "to": 1}, {"until": 1, "from": 1, "to": 0}]),
        ),
    ] {
        let mut state = state();
        press(&mut state, keys);
        paste(&mut state, text);
        assert_eq!(at(&state, &pointer), expected, "{keys}: {:?}", said(&state));
    }
}

#[test]
fn a_mistake_in_pasted_rows_names_its_place_and_nothing_changes() {
    for (text, part) in [
        ("1,2,3,4\n5,six,7,8", "line 2, column 2: \"six\" is not a number"),
        ("1,2,3,4\r\r5,six,7,8", "line 3, column 2: \"six\""),
        ("1,2\n3\n", "line 2 has 1 value, the lines before have 2"),
        ("1 2 3 4 5", "line 1 has 5 values, but a row takes x y dx dy"),
        ("x,y,color\n1,2,3", "line 1, column 3: there is no column \"color\""),
        ("x,dx\n1,2", "line 2: y is missing"),
        ("x,y,°\n1,2,90", "line 2: ° needs |J|"),
        ("tool,x,y\npont,1,2", "line 2, column 1: there is no tool \"pont\": did you mean \"point\"?"),
        ("x,y\n1e12,2", "line 2, column 1: 1000000000000 is out of range"),
        ("x,y", "a header but no rows"),
        ("x,y,dx\n1,2", "line 2 has 2 values, the lines before have 3"),
        ("\"1,2,3,4", "the quote of line 1 is not closed"),
        ("1,2,3,4\n5,\"6,7,8", "the quote of line 2 is not closed"),
        ("１ ２", "line 1: \"１\" is neither a number nor a column: a row takes x y dx dy"),
        ("1，2", "line 1: \"1，2\" is neither a number nor a column"),
        ("{\"tool\":", "not JSON"),
        ("", "the paste is empty"),
    ] {
        let mut state = state();
        press(&mut state, super::MOTION);
        paste(&mut state, text);
        let (bad, told) = said(&state);
        assert!(bad && told.contains(part), "{text}: {told}");
        assert!(state.scene.is_saved(), "{text}");
    }
}

#[test]
fn a_number_is_pasted_into_its_cell() {
    for (keys, pointer, expected) in [
        (motion("l"), zone("/motion/0/at"), json!([-7.5, 20])),
        (motion("l v j"), zone("/motion/1/at"), json!([-7.5, 25])),
        ("/ \"points\" Enter Enter".into(), zone("/outline/points"), json!([[-7.5, 10], [50, 10], [50, 40], [10, 40]])),
        ("/ \"cycles\" Enter".into(), zone("/position/cycles"), json!(-7.5)),
    ] {
        for text in ["-7.5\n", "-7,5", "\u{2212}7,5\r"] {
            let mut state = state();
            press(&mut state, &keys);
            paste(&mut state, text);
            assert_eq!(at(&state, &pointer), expected, "{keys} {text}: {:?}", said(&state));
        }
    }
}

#[test]
fn one_line_is_typed_and_several_are_refused() {
    let typed = |state: &State| match &state.typing.mode {
        Mode::Entry(entry) => entry.text.value().to_owned(),
        Mode::Line(line) => line.text.value().to_owned(),
        _ => "nothing".into(),
    };
    for keys in [motion("l i Ctrl-u"), ":".into(), "/".into()] {
        for (text, expected) in [("12\r13", ""), ("7\n8\n9\n", ""), ("12\r", "12"), ("\n12\n\n", "12")] {
            let mut state = state();
            press(&mut state, &keys);
            paste(&mut state, text);
            assert_eq!(typed(&state), expected, "{keys} {text:?}");
            let told = said(&state).1.contains("lines were pasted");
            assert_eq!(told, expected.is_empty(), "{keys} {text:?}: {:?}", said(&state));
        }
    }
}

#[test]
pub fn edits_apply_to_the_selection_which_stays() {
    check(&[
        (&motion("l V i \"7\" Enter"), &zone("/motion/2/at"), json!([7, 30])),
        (&motion("l % + +"), &zone("/motion/2/at"), json!([42, 30])),
        (&motion("l v j + + + u"), &zone("/motion/1/at"), json!([30, 25])),
        (&motion("l v 2 j i \"100+10*i/n\" Enter"), &zone("/motion/1/at"), json!([100.0 + 10.0 / 3.0, 25])),
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
        ("g +", "nothing to redo"),
        (": \"undo x\" Enter", "x is not a number of steps"),
        (": \"earlier 3w\" Enter", "3w is not a time"),
        (": \"later 3m\" Enter", "nothing to redo within 3m"),
    ] {
        let mut state = state();
        press(&mut state, keys);
        assert!(said(&state).1.starts_with(words), "{keys}: {}", said(&state).1);
    }
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

#[test]
pub fn pictures_and_names_come_and_go() {
    let images = "/ \"images\" Enter Enter";
    check(&[
        (&format!("{images} o \"art/dog.jpg\" Enter"), "/images/dog/path", json!("art/dog.jpg")),
        (&format!("{images} o \"art/cat.jpg\" Enter"), "/images/cat 2/path", json!("art/cat.jpg")),
        (&format!("{images} o \"dog.png\" Esc"), "/images/dog", Value::Null),
        (&format!("{images} o \"dog.png\" Enter d"), "/images/dog", Value::Null),
        (&format!("{images} d"), "/images/cat/path", json!("cat.png")),
        (&format!("{images} R Ctrl-w \"tom\" Enter"), "/layers/0/image", json!("tom")),
        (&format!("{images} D : \"rename cat\" Enter"), "/images/cat 2/path", json!("cat.png")),
        (&format!("{images} i \"x.png\" Enter"), "/images/cat/path", json!("x.png")),
        ("R Ctrl-u \"rename right eye\" Enter", &zone("/name"), json!("right eye")),
        ("o", "/layers/0/zones/1/outline/kind", json!("rectangle")),
        ("o", "/layers/0/zones/1/name", json!("zone")),
    ]);
    for (keys, words) in [
        (format!("{images} d"), "cat is used by layers.face.image: choose another"),
        (format!("{images} D : \"rename cat\" Enter"), "there is already a picture \"cat\""),
        (motion("R"), "this has no name"),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said(&state).0 && said(&state).1.starts_with(words), "{keys}: {}", said(&state).1);
    }
}

#[test]
fn paths_are_asked_for_and_completed() {
    let beside = |state: &State| state.scene.path().parent().map(std::path::Path::to_owned);
    for (keys, name, path, relative) in [
        ("/ \"images\" Enter o \"ca\" Tab", "add", "ca", true),
        (": \"w a/\" Tab", "w", "a/", false),
        (": \"e x\" Tab", "e", "x", false),
    ] {
        let mut state = state();
        let effects = press(&mut state, keys);
        let Some(Effect::Complete { name: asked, path: typed, beside: folder }) = effects.last() else {
            panic!("{keys}")
        };
        let folder_wanted = if relative { beside(&state) } else { None };
        assert_eq!((asked.as_str(), typed.as_str(), folder.clone()), (name, path, folder_wanted), "{keys}");
        update(&mut state, Event::Completed(vec![format!("{name} one"), format!("{name} two")]));
        press(&mut state, "Tab");
        assert!(matches!(&state.typing.mode, Mode::Line(line) if line.text.value() == format!("{name} two")), "{keys}");
    }
}

#[test]
fn every_list_of_the_schema_can_be_added_to() {
    let whole = state_of(include_str!("../../../tests/scenes/good/everything.json")).document().clone();
    let mut open = vec![String::new()];
    let mut seen = std::collections::BTreeSet::new();
    let mut state = state_of(&whole.to_text());
    while let Some(pointer) = open.pop() {
        open.extend(field::children(&whole, &pointer).into_iter().map(|child| child.pointer));
        let field = field::field(&whole, &pointer).unwrap();
        let list = matches!(field.kind, Kind::List(_) | Kind::Map(_)) && field::is_there(&whole, &pointer);
        if !list || !seen.insert(format!("{} {:?}", field.name, field.kind)) {
            continue;
        }
        state.show(pointer.clone());
        (state.cursor.focus, state.typing.mode) = (Pane::Table, Mode::Normal);
        press(&mut state, "o");
        let (bad, text) = said(&state);
        let told = bad && text.contains("expected 2 items");
        let asked = matches!(state.typing.mode, Mode::Line(_));
        assert!(asked || told || !state.scene.is_saved() && !bad, "{pointer}: {text}");
        while !state.scene.is_saved() {
            press(&mut state, "u");
        }
    }
    assert!(seen.len() > 10, "{seen:?}");
}
