//! Tests of moving and finding: (scene, keys, place).

use serde_json::json;

use super::support::{press, state};
use super::{check, motion, zone};
use crate::scene::schema::Place;
use crate::tui::document::sheet::Sheet;
use crate::tui::state::{Mode, Pane, State};

/// What is under the cursor: the node in the tree, else the cell by its pointer and its name.
fn place(state: &State) -> String {
    if state.cursor.focus == Pane::Tree {
        return state.cursor.node.clone();
    }
    let row = state.row().unwrap();
    row.cells
        .get(state.cursor.column)
        .map_or(row.pointer, |cell| format!("{} {}", cell.pointer, cell.head).trim().to_owned())
}

/// Keys from the opened editor, the place that they lead to, and a part of the message there.
fn leads(rows: &[(&str, &str, &str)]) {
    for (keys, expected, said) in rows {
        let mut state = state();
        press(&mut state, keys);
        let message = state.message.as_ref().map_or("", |message| message.text.as_str());
        assert_eq!((place(&state), message.contains(said)), (expected.to_string(), true), "{keys}: {message}");
    }
}

#[test]
fn a_row_is_the_same_wherever_it_is_looked_at_from() {
    let state = state();
    let zone = "/layers/0/zones/0";
    for node in ["", "/images", "/timeline", zone, &format!("{zone}/outline"), &format!("{zone}/motion"), "/nowhere"] {
        let sheet = Sheet::of(state.document(), node);
        let rows = sheet.rows(0..usize::MAX);
        assert_eq!(rows.len(), sheet.len(), "{node}");
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(sheet.row(i).as_ref(), Some(row));
            assert_eq!(sheet.pointer(i).as_ref(), Some(&row.pointer));
            assert_eq!(sheet.position(&row.pointer), Some(i));
        }
        assert_eq!((sheet.row(rows.len()), sheet.pointer(rows.len())), (None, None));
    }
}

#[test]
fn names_and_values_are_found() {
    let (point, eye) = (zone("/motion/1/at y"), zone(""));
    leads(&[
        (
            "/ \"radius\" Enter",
            &zone("/interpolation/radius"),
            "1 of 1   layers.face.zones.\"left eye\".interpolation.radius",
        ),
        ("/ \"60\" Enter", &zone("/interpolation/radius"), "1 of 1"),
        ("/ \"25\" Enter", &point, "1 of 2   layers.face.zones.\"left eye\".motion.1.at"),
        ("/ \"25\" Enter n", &zone("/motion/3/center y"), "2 of 2"),
        ("/ \"25\" Enter n n", &point, "1 of 2"),
        ("/ \"25\" Enter N", &zone("/motion/3/center y"), "2 of 2"),
        ("/ \"25\" Enter 2 n", &point, "1 of 2"),
        ("/ \"-18\" Enter", &zone("/motion/0/jump dy"), ""),
        ("/ \"EYE\" Enter", &zone("/name"), "2 of 2"),
        ("/ \"eye\" Enter n", &eye, "1 of 2"),
        ("/ \"sine\" Enter", &zone("/position/function"), "1 of 1"),
        ("/ \"nothing like it\" Enter", &eye, "no name or value matches nothing like it"),
        ("/ \"mou\"", "/layers/0/zones/1", ""),
        ("/ \"mou\" Esc", &eye, ""),
        ("/ \"mou\" Backspace Backspace Backspace Backspace", &eye, ""),
    ]);
}

#[test]
fn marks_and_jumps_lead_back() {
    let (first, second) = (zone("/motion/0/at y"), zone("/motion/1/at x"));
    leads(&[
        (&motion("2 l m a G ' a"), &first, ""),
        (&motion("j l m b g g d ' b"), &zone("/motion/0/at x"), ""),
        (&motion("j l m b g g D ' b"), &zone("/motion/2/at x"), ""),
        (&motion("2 l G Ctrl-o"), &first, ""),
        (&motion("j l G g g Ctrl-o Ctrl-o"), &second, ""),
        (&motion("j l G g g 2 Ctrl-o"), &second, ""),
        (&motion("j l G Ctrl-o g o"), &zone("/motion/3/center x"), ""),
        ("' z", &zone(""), "mark z is not set"),
        ("Ctrl-o", &zone(""), "no older jump"),
        ("h / \"60\" Enter Ctrl-o", &zone(""), ""),
    ]);
}

#[test]
fn the_place_beside_this_one_is_reached() {
    leads(&[
        (")", "/layers/0/zones/1", ""),
        (") (", &zone(""), ""),
        (") )", "/layers/0/zones/1", "this is the last of its kind"),
        ("/ \"speed\" Enter )", "/layers/0/zones/1/speed", ""),
        (": \"go layers.face.zones.0.motion.0\" Enter 2 )", &zone("/motion/2"), ""),
        (": \"go layers.face.zones.0.motion.2\" Enter )", &zone("/motion/2"), "this is the last of its kind"),
        ("h h )", "/layers/0", "this is the last of its kind"),
    ]);
}

#[test]
pub fn what_is_found_is_edited() {
    check(&[
        ("/ \"25\" Enter i \"7\" Enter", &zone("/motion/1/at"), json!([30, 7])),
        (&motion("j m a g g K G ' a d"), &zone("/motion/1/at"), json!([40, 30])),
        (&motion("l G Ctrl-o g o +"), &zone("/motion/3/center"), json!([31, 25])),
        (") D", "/layers/0/zones/2/name", json!("mouth 2")),
        (": \"leader menu\" Enter p \"duplicate\" Enter", "/layers/0/zones/1/name", json!("left eye 2")),
        ("Space Space \"mouth speed\" Enter +", "/layers/0/zones/1/speed", json!(2)),
        ("Space p \"set images\" Ctrl-u \"undo\" Esc d", "/layers/0/zones/0/name", json!("mouth")),
        ("d ? q Space p \"undo\" Enter", &zone("/name"), json!("left eye")),
    ]);
}

#[test]
fn the_palette_goes_to_places_and_begins_lines() {
    leads(&[
        ("Space Space \"left radius\" Enter", &zone("/interpolation/radius"), ""),
        ("Space Space \"lefteye motion 1 at\" Enter Ctrl-o", &zone(""), ""),
        (": \"palette\" Enter \"eye outl\" Down Up Enter", &zone("/outline"), ""),
        (": \"palette\" Enter \"no such thing at all\" Enter", &zone(""), ""),
    ]);
    for (keys, typed) in [("\"go path\"", "go "), ("\"time t\"", "time "), ("\"synth\"", "synth ")] {
        let mut state = state();
        press(&mut state, &format!("Space Space {keys} Enter"));
        assert!(
            matches!(&state.typing.mode, Mode::Line(line) if line.text.value() == typed),
            "{keys}: {:?}",
            state.typing.mode
        );
    }
}

#[test]
fn the_help_begins_with_what_is_under_the_cursor() {
    for (keys, expected) in [
        (
            "/ \"radius\" Enter ?",
            &["-- radius --", "value     60 px", "range     0.001 to 1000000 px", ".radius=VALUE)", "(R d))²"][..],
        ),
        ("/ \"cycles\" Enter ?", &["default   0.5", "function  sine:", "formula   s = offset + amplitude sin(2π"]),
        ("/ \"motion\" Enter Enter 6 l ?", &["-- jump ° --", "value     90 degrees"]),
        ("?", &["-- left eye --", "path      layers.face.zones.\"left eye\""]),
    ] {
        let mut state = state();
        press(&mut state, keys);
        let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages after {keys}") };
        let text = pages.lines[..16].join("\n");
        expected.iter().for_each(|part| assert!(text.contains(part), "{keys}: {part}\n{text}"));
    }
}

#[test]
fn every_function_method_and_rule_says_its_formula() {
    for tagged in ["/position", "/interpolation", "/fold"] {
        let pointer = zone(tagged);
        let document = state().document().clone();
        let shape = Place::of(document.json(), &pointer).unwrap().shape;
        for (name, _) in shape.choices() {
            assert!(shape.variant(name).unwrap().formula().is_some(), "{tagged}: {name}");
        }
    }
}
