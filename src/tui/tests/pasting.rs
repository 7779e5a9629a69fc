//! Yanking and pasting: (scene, keys, scene), and what the terminal pastes.

use serde_json::{Value, json};

use super::support::{at, paste, press, said_last, state, state_of};
use super::{check, motion, zone};
use crate::scene::field;
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pane, State};

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
        let (bad, text) = said_last(&state);
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
        ("/ \"points\" Enter Enter i \"1/3\" Enter Y", "x,y\n0.333333333,10\n"),
    ] {
        let mut state = state();
        let effects = press(&mut state, keys);
        assert_eq!(copied(&effects), Some(text), "{keys}: {:?}", said_last(&state));
    }
    let mut large = state();
    let points: String = (0..20_000).map(|i| format!("{i} {}\n", i * i % 977)).collect();
    press(&mut large, "/ \"points\" Enter Enter");
    paste(&mut large, &points);
    let effects = press(&mut large, "v G y");
    assert_eq!(copied(&effects), None);
    assert!(said_last(&large).1.contains("too much for the terminal's clipboard"), "{:?}", said_last(&large));
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
            // One place for each kind of value.
            let place: Vec<&str> = holder.split('/').filter(|token| token.parse::<usize>().is_err()).collect();
            if !seen.insert(format!("{place:?} {} {:?}", child.field.help, child.field.kind)) {
                continue;
            }
            state.cursor.focus = if seen.len() % 2 == 0 { Pane::Tree } else { Pane::Table };
            state.show(if state.cursor.focus == Pane::Tree { &child.pointer } else { &holder }.clone());
            state.cursor.row = state.sheet().position(&child.pointer).unwrap_or(0);
            press(&mut state, "y p");
            assert!(!said_last(&state).0, "{}: {}", child.pointer, said_last(&state).1);
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
        assert!(!said_last(&state).0, "{text}: {}", said_last(&state).1);
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
        assert_eq!(at(&state, &pointer), expected, "{keys}: {:?}", said_last(&state));
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
        let (bad, told) = said_last(&state);
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
            assert_eq!(at(&state, &pointer), expected, "{keys} {text}: {:?}", said_last(&state));
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
            let told = said_last(&state).1.contains("lines were pasted");
            assert_eq!(told, expected.is_empty(), "{keys} {text:?}: {:?}", said_last(&state));
        }
    }
}
