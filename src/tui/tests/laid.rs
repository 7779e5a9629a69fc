//! Lists and maps in which things stand that are not written: what a style has. An edit of one writes what is changed, and
//! nothing else.

use serde_json::{Value, json};

use super::support::{at, press, said_last, state_of};
use crate::scene::{address, field};
use crate::tui::state::{Mode, Pane, State};

fn shown(strokes: &str, node: &str) -> State {
    let scene = r##"{ "plica": 1, "size": [32, 32], "camera": {}, "meshes": { "ring": { "path": "ring.obj" } },
      "layers": [{ "kind": "mesh", "name": "ring", "mesh": "ring", "strokes": "##;
    let mut state = state_of(&format!("{scene}{strokes}}}] }}"));
    state.show(node);
    state.cursor.focus = Pane::Table;
    state
}

fn labels(state: &State) -> Vec<String> {
    let sheet = state.sheet();
    sheet.rows(0..sheet.len()).into_iter().map(|row| row.label).collect()
}

const STROKES: &str = "/layers/0/strokes";

#[test]
fn all_that_is_in_force_has_a_row_and_what_is_not_written_is_dimmed() {
    let written = r#"{ "noises": { "b": { "spacing": 9 }, "own": {} },
      "marks": [{ "name": "dark", "amount": 0.3 }, { "name": "rim", "kind": "outline" }] }"#;
    let state = shown(written, "/layers/0/strokes/noises");
    assert_eq!(labels(&state), ["a", "b", "c", "own"]);
    let cell = |state: &State, row: usize, head: &str| {
        let row = state.sheet().row(row).unwrap();
        let cell = row.cells.iter().find(|cell| cell.head == head).unwrap();
        (cell.text.clone(), cell.set)
    };
    assert_eq!(cell(&state, 0, "spacing"), ("7.5".into(), false));
    assert_eq!(cell(&state, 1, "spacing"), ("9".into(), true));
    assert_eq!(cell(&state, 1, "regularity"), ("2.4".into(), false));
    let state = shown(written, "/layers/0/strokes/marks");
    assert_eq!(labels(&state), ["light", "middle", "dark", "contour", "rim"]);
    assert_eq!((cell(&state, 0, "amount"), cell(&state, 2, "amount")), (("0.36".into(), false), ("0.3".into(), true)));
    assert_eq!(cell(&state, 2, "from"), ("0.35".into(), false));
}

#[test]
fn an_edit_of_what_a_style_has_writes_that_field_alone_in_one_step() {
    for (node, keys, expected) in [
        ("noises", "Enter i \"9\" Enter", json!({ "noises": { "a": { "spacing": 9 } } })),
        ("noises", "l i \"*2\" Enter", json!({ "noises": { "a": { "regularity": 4.8 } } })),
        (
            "noises",
            "j l i \"3\" Enter k i \"4\" Enter",
            json!({ "noises": { "b": { "regularity": 3 }, "a": { "regularity": 4 } } }),
        ),
        (
            "marks",
            "j Enter / \"amount\" Enter i \"0.5\" Enter",
            json!({ "marks": [{ "name": "middle", "amount": 0.5 }] }),
        ),
        ("tone", "j i \"0.1\" Enter", json!({ "tone": { "dark": 0.1 } })),
        ("noises", "l i \"4\" Enter u", json!({})),
        ("marks", "j Enter / \"amount\" Enter i \"0.5\" Enter u", json!({})),
    ] {
        let mut state = shown("{}", &format!("{STROKES}/{node}"));
        press(&mut state, keys);
        assert_eq!(at(&state, STROKES), expected, "{keys}: {:?}", state.message);
    }
    // The form stays where it is, whatever is written and taken back.
    let mut state = shown("{}", "/layers/0/strokes/marks");
    press(&mut state, "j Enter / \"amount\" Enter i \"0.5\" Enter");
    let node = "/layers/0/strokes/marks/middle";
    assert_eq!(state.cursor.node, node);
    press(&mut state, "u");
    assert_eq!(state.cursor.node, node);
    assert_eq!(address::address(state.document(), node), "layers.ring.strokes.marks.middle");
}

#[test]
fn what_is_written_is_taken_away_and_what_is_not_says_how_it_is_left_out() {
    let mut state = shown(r#"{ "noises": { "b": { "spacing": 9 } } }"#, "/layers/0/strokes/noises");
    press(&mut state, "j d d");
    assert_eq!(at(&state, STROKES), json!({ "noises": {} }));
    assert_eq!(labels(&state), ["a", "b", "c"]);
    press(&mut state, "d d");
    let told = "\"b\" is the style's, and nothing of it is written here (:set layers.ring.strokes.noises.b=null leaves it out)";
    assert_eq!(said_last(&state), (true, told.into()));
    let mut state = shown(
        r#"{ "marks": [{ "name": "dark", "amount": 0.3 }, { "name": "light", "amount": 0.2 }] }"#,
        "/layers/0/strokes/marks",
    );
    press(&mut state, "d d");
    assert_eq!(at(&state, STROKES), json!({ "marks": [{ "name": "dark", "amount": 0.3 }] }));
    press(&mut state, "d d");
    assert!(
        said_last(&state).1.ends_with("(:set layers.ring.strokes.marks.light.off=true leaves it out)"),
        "{:?}",
        state.message
    );
    press(&mut state, ": \"set layers.ring.strokes.marks.light.off=true\" Enter");
    assert_eq!(at(&state, "/layers/0/strokes/marks/1"), json!({ "name": "light", "off": true }));
    assert_eq!(labels(&state), ["light", "middle", "dark", "contour"], "it can be brought back");
}

#[test]
fn null_is_written_where_it_clears_what_stands_there() {
    let scene = r#"{ "style": "charcoal", "noises": { "own": {}, "tooth": { "spacing": 4 } }, "size": 2 }"#;
    for (setting, pointer, expected) in [
        ("noises.own=null", "/noises", json!({ "tooth": { "spacing": 4 } })),
        ("marks.strokes.grain=null", "/marks", json!([{ "name": "strokes", "grain": null }])),
        ("marks.contour.width*=2", "/marks", json!([{ "name": "contour", "width": 8 }])),
        ("noises.tooth.spacing*=2", "/noises/tooth", json!({ "spacing": 8 })),
        ("noises.broad.spacing+=2", "/noises/broad", json!({ "spacing": 20 })),
        ("size=null", "/size", Value::Null),
    ] {
        let mut state = shown(scene, "");
        press(&mut state, &format!(": \"set layers.ring.strokes.{setting}\" Enter"));
        assert_eq!(at(&state, &format!("{STROKES}{pointer}")), expected, "{setting}: {:?}", state.message);
        assert_eq!(at(&state, STROKES).get("size").is_some(), setting != "size=null");
    }
    let mut state = shown(r#"{ "noises": { "b": { "spacing": 9 } } }"#, "");
    press(&mut state, ": \"set layers.ring.strokes.noises.b=null\" Enter");
    assert!(said_last(&state).1.contains("is made of the noise \"b\", which is not there"), "{:?}", state.message);
    assert_eq!(at(&state, "/layers/0/strokes/noises/b/spacing"), json!(9), "refused, not half done");
    let mut state = shown(r#"{ "style": "stipple", "marks": [{ "name": "more dots", "off": true }] }"#, "");
    let noises = field::laid(state.document(), "/layers/0/strokes/noises").unwrap();
    let used = at(&state, "/layers/0/strokes/marks").to_string();
    press(&mut state, &format!(": \"set layers.ring.strokes.noises.{}=null\" Enter", noises[1]));
    assert_eq!(
        at(&state, "/layers/0/strokes/noises"),
        json!({ noises[1].as_str(): null }),
        "{used}: {:?}",
        state.message
    );
    state.show("/layers/0/strokes/noises");
    assert_eq!(labels(&state), noises, "it can be brought back");
}

#[test]
fn something_new_goes_into_the_list_or_the_map_under_the_cursor() {
    for (node, expected) in [
        ("noises", json!({ "noises": { "noise": {} } })),
        ("marks", json!({ "marks": [{ "name": "mark", "kind": "outline" }] })),
    ] {
        let mut state = shown("{}", &format!("{STROKES}/{node}"));
        press(&mut state, "o");
        assert!(matches!(state.typing.mode, Mode::Normal));
        assert_eq!(at(&state, STROKES), expected, "{:?}", state.message);
        assert_eq!(
            state.sheet().pointer(state.cursor.row).unwrap(),
            format!("{STROKES}/{node}/{}", node.trim_end_matches('s'))
        );
    }
}

#[test]
fn names_of_what_stands_there_complete_and_have_help() {
    let mut state = shown("{}", "/layers/0");
    press(&mut state, ": \"set layers.ring.strokes.marks.mid\" Tab");
    let Mode::Line(line) = &state.typing.mode else { panic!() };
    assert!(line.text.value().contains("marks.middle"), "{}", line.text.value());
    press(&mut state, "Esc : \"help spacing\" Enter");
    assert!(
        matches!(&state.typing.mode, Mode::Pages(pages) if pages.lines.join(" ").contains("mean distance of strokes")),
        "{:?}",
        state.message
    );
    press(&mut state, "Esc : \"get layers.ring.strokes.noises.a.spacing\" Enter");
    assert_eq!(said_last(&state), (false, "7.5".into()));
    press(&mut state, ": \"set layers.ring.strokes.marks.drak.amount=1\" Enter");
    assert!(
        said_last(&state).1.contains("there is no \"drak\" in layers.ring.strokes.marks (did you mean \"dark\"?)"),
        "{:?}",
        state.message
    );
}

#[test]
fn a_style_goes_by_name_by_file_or_is_taken_away() {
    let mut state =
        shown(r##"{ "style": "stipple", "ink": "#203040", "noises": { "a": { "spacing": 9 } } }"##, STROKES);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.json");
    std::fs::write(&file, r#"{ "ground": "scene", "noises": {}, "marks": [] }"#).unwrap();
    let bad = folder.path().join("bad.json");
    std::fs::write(&bad, r#"{ "style": "hatching", "sise": 2 }"#).unwrap();
    let style = |state: &mut State, text: &str| press(state, &format!(": \"style {text}\" Enter"));
    style(&mut state, &bad.display().to_string());
    let (is_bad, told) = said_last(&state);
    assert!(is_bad && told.starts_with(&format!("{}: sise: unknown field", bad.display())), "{told}");
    // In the form the field does as the command: what changed the old style goes with it.
    press(&mut state, "/ \"style\" Enter Enter \"c\" Enter");
    assert_eq!(at(&state, STROKES), json!({ "style": "charcoal", "ink": "#203040" }), "{:?}", state.message);
    style(&mut state, &file.display().to_string());
    assert_eq!(at(&state, STROKES), json!({ "style": "none", "ground": "scene", "noises": {}, "marks": [] }));
    style(&mut state, "charcoal --whole");
    assert_eq!(at(&state, "/layers/0/strokes/noises/tooth/spacing"), json!(3.2), "{:?}", state.message);
    style(&mut state, "none");
    assert_eq!(at(&state, STROKES), Value::Null);
    assert_eq!(said_last(&state), (false, "ring is drawn in no style".into()));
    press(&mut state, ": \"pass ink\" Enter");
    assert_eq!(said_last(&state), (false, "no layer has ink: the picture is empty".into()));
}
