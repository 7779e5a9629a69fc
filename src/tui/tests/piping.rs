//! Rows go through programs and back.

use serde_json::json;

use super::support::{at, press, replayed, said_last, state};
use super::{MOTION, motion, zone};
use crate::tui::commands::obey;
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event};
use crate::tui::state::State;

#[test]
pub fn rows_go_through_a_program_or_nothing_changes() {
    let sent = |state: &mut State, keys: &str| -> Option<String> {
        press(state, MOTION);
        press(state, keys).into_iter().find_map(|effect| match effect {
            Effect::Pipe(program, table) => Some(format!("{program}: {table}")),
            _ => None,
        })
    };
    let pipe = "t j t | \"awk\" Enter";
    for (back, said, expected) in [
        (Ok("x,y\n1,2\n3,4\n"), "2 rows came back from awk", json!([[1, 2], [30, 25], [3, 4]])),
        (Ok("1,2\n3,4\n"), "2 rows came back", json!([[1, 2], [30, 25], [3, 4]])),
        (Ok("1,2,0,-18,18,90\n3,4,0,0,0,0\n"), "2 rows came back", json!([[1, 2], [30, 25], [3, 4]])),
        (
            Ok("point,3,4,0,0,0,0\ntool,x,y,dx,dy,|J|,°\npoint,1,2,0,-18,18,90\n"),
            "2 rows came back",
            json!([[3, 4], [30, 25], [1, 2]]),
        ),
        (
            Ok("x,y\n1,2\n"),
            "2 rows went out and 1 came back, so nothing was taken: give back a row for each",
            json!([[20, 20], [30, 25], [40, 30]]),
        ),
        (Ok(""), "2 rows went out and 0 came back", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok("x,y\n1,a\nb,2\n"), "2 rows refused, and nothing changed: row 0", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok("x,y\n1,a\n3,2\n"), "row 0, y: \"a\" is not a number", json!([[20, 20], [30, 25], [40, 30]])),
        (Err("awk took too long"), "pipe: awk took too long", json!([[20, 20], [30, 25], [40, 30]])),
    ] {
        let mut state = state();
        // Without a header values begin at the column of the cursor.
        let column = if back.is_ok_and(|back| back.starts_with("1,2")) { "l " } else { "" };
        let table = sent(&mut state, &format!("{column}{pipe}")).unwrap();
        assert_eq!(table, "awk: tool,x,y,dx,dy,|J|,°\npoint,20,20,0,-18,18,90\npoint,40,30,0,0,0,0\n");
        assert_eq!(state.outside.work.as_deref(), Some("pipe awk"));
        update(&mut state, Event::Piped(back.map(str::to_owned).map_err(str::to_owned)));
        assert!(said_last(&state).1.contains(said), "{back:?}: {:?}", said_last(&state));
        let places: Vec<_> = (0..3).map(|i| at(&state, &zone(&format!("/motion/{i}/at")))).collect();
        assert_eq!(json!(places), expected, "{back:?}");
        assert!(state.outside.work.is_none());
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{back:?}");
    }
    // Only a change of the rows themselves is in the way, not where the cursor is or what else has changed.
    for (meanwhile, said) in [
        ("l +", "changed meanwhile: nothing was taken"),
        ("Esc : \"go layers.face.zones.mouth\" Enter", "2 rows came back from awk"),
        (": \"set layers.face.zones.mouth.feather=3\" Enter j V", "2 rows came back from awk"),
        (": \"columns x\" Enter", "2 rows came back from awk"),
    ] {
        let mut state = state();
        sent(&mut state, pipe).unwrap();
        press(&mut state, meanwhile);
        update(&mut state, Event::Piped(Ok("x\n1\n2\n".into())));
        assert!(said_last(&state).1.contains(said), "{meanwhile}: {:?}", said_last(&state));
        let taken = at(&state, &zone("/motion/2/at")) == json!([2, 30]);
        assert_eq!(taken, said.contains("came back"), "{meanwhile}");
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{meanwhile}");
    }
    assert!(sent(&mut state(), "g t : \"pipe cat\" Enter").unwrap().contains("point,30,25,3,4"), "all rows");
    assert_eq!(sent(&mut state(), ": \"pipe\" Enter"), None);
}

#[test]
fn a_changed_column_of_a_table_that_comes_back_counts() {
    let mut state = state();
    press(&mut state, &motion("v : \"pipe turn\" Enter"));
    update(&mut state, Event::Piped(Ok("tool,x,y,dx,dy,|J|,°\npoint,20,20,0,-18,9,90\n".into())));
    assert_eq!(at(&state, &zone("/motion/0/jump")), json!([0, -9]), "{:?}", said_last(&state));
}

#[test]
fn esc_ends_a_program_before_the_selection_that_it_has() {
    let mut state = state();
    press(&mut state, &motion("t j t | \"sort\" Enter"));
    let effects = press(&mut state, "Esc");
    assert!(matches!(effects.as_slice(), [Effect::Cancel]), "{effects:?}");
    assert!(state.cursor.selects());
    update(&mut state, Event::Piped(Err("sort was ended: nothing was taken".into())));
    press(&mut state, "Esc");
    assert!(!state.cursor.selects());
}

#[test]
fn how_it_ended_stays_until_it_was_seen() {
    let mut state = state();
    press(&mut state, &motion("t j t | \"sort\" Enter"));
    update(&mut state, Event::Piped(Err("no".into())));
    press(&mut state, "j > k");
    assert_eq!(said_last(&state), (true, "pipe: no".into()));
    state.drawn();
    press(&mut state, "j");
    assert_eq!(said_last(&state), (true, "pipe: no".into()), "keys that say nothing leave it");
    press(&mut state, ">");
    assert!(said_last(&state).1.starts_with("step"), "{:?}", said_last(&state));
    update(&mut state, Event::Done(Ok("a.gif is written".into())));
    press(&mut state, "j");
    assert_eq!(said_last(&state), (false, "a.gif is written".into()));
    press(&mut state, "Esc");
    assert_eq!(said_last(&state), (false, String::new()));
}

#[test]
fn a_rounded_length_does_not_change_a_vector() {
    let mut state = state();
    press(&mut state, &motion("j l l l i \"1/3\" Enter v : \"pipe awk\" Enter"));
    update(&mut state, Event::Piped(Ok("tool,x,y,dx,dy,|J|,°\npoint,31,25,0.333333333,4,4.01386,-85.2364\n".into())));
    assert_eq!(at(&state, &zone("/motion/1")), json!({ "tool": "point", "at": [31, 25], "jump": [0.333333333, 4] }));
}

#[test]
fn a_table_is_filled_into_rows_that_are_named() {
    for (line, part) in [
        (r#"fill layers.face.zones."left eye".motion 0,2 [["x"],["1"],["2"]]"#, "pasted over 2 rows"),
        (r#"fill layers.face.zones."left eye".motion 7 [["x"],["1"]]"#, "has 4 rows, 0 the first: not 7"),
        (r#"fill layers.face.zones."left eye".motion [["x"],["1"]]"#, "takes PATH ROWS"),
    ] {
        let mut state = state();
        let done = obey(&mut state, line, None);
        let said = done.err().unwrap_or_else(|| said_last(&state).1);
        assert!(said.contains(part), "{line}: {said}");
    }
}
