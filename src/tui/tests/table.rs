//! Narrow tables: whole numbers, whole columns, and the row under the cursor is visible.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use serde_json::json;

use super::support::{press, state, state_of};
use crate::tui::panes;
use crate::tui::state::{Pane, State};

/// The lines of the table alone, at this width.
fn table(state: &State, width: u16) -> Vec<String> {
    let mut buffer = Buffer::empty(Rect::new(0, 0, width, 8));
    panes::table::draw(state, buffer.area, &mut buffer);
    let rows = buffer.content().chunks(usize::from(width));
    rows.map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>().trim_end().to_owned()).collect()
}

/// The editor in a table of one zone's motion.
fn with_motion(motion: serde_json::Value) -> State {
    let scene = json!({ "plica": 1, "images": { "cat": { "path": "cat.png" } }, "layers": [{ "kind": "picture",
        "name": "face", "image": "cat", "zones": [{ "name": "eye",
        "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 }, "motion": motion }] }] });
    let mut state = state_of(&scene.to_string());
    state.show("/layers/0/zones/0/motion");
    state.cursor.focus = Pane::Table;
    state
}

#[test]
fn no_number_is_shown_in_part() {
    let mut state = with_motion(json!([
        { "tool": "point", "at": [123.456, 78.9], "jump": [-139.7, 41.5] },
        { "tool": "point", "at": [1, 2.00004], "jump": [0.0001, -82.4] },
        { "tool": "scale", "center": [30, 25], "factor": [1.125, 1] }
    ]));
    let sheet = state.sheet();
    let known: Vec<String> = sheet.rows(0..3).iter().flat_map(|row| row.cells.clone()).map(|cell| cell.text).collect();
    for row in 0..2 {
        state.cursor.row = row;
        for column in 0..7 {
            state.cursor.column = column;
            let own = &sheet.row(row).unwrap().cells[column].text;
            for width in 20..70 {
                let lines = table(&state, width);
                let text = lines.join("\n");
                for word in lines.iter().skip(1).flat_map(|line| line.split_whitespace()) {
                    let number = word.starts_with(|c: char| c.is_ascii_digit() || "-~.".contains(c));
                    let whole = known.iter().any(|known| known == word)
                        || word.starts_with('~')
                        || ["0", "1", "2"].contains(&word);
                    assert!(!number || whole, "{word} in {width} columns, column {column}:\n{text}");
                }
                let line: Vec<&str> = lines[row + 1].split_whitespace().collect();
                assert!(width < 26 || line.contains(&own.as_str()), "{own} in {width} columns:\n{text}");
                assert_eq!((line[0], line[1].starts_with("point")), (row.to_string().as_str(), true), "{text}");
                let marked = line.iter().any(|word| word.contains(['<', '>']));
                let all = line.iter().filter(|word| !["<", ">"].contains(*word)).count() == 8;
                assert_eq!(all, !marked, "{text}");
            }
        }
    }
}

#[test]
fn a_number_wider_than_its_room_is_rounded_with_a_mark() {
    let mut state = with_motion(json!([{ "tool": "point", "at": [123456.125, 2] }]));
    state.cursor.column = 1;
    for (width, shown) in [(30, "123456.125"), (22, "~123456.1"), (20, "~123456"), (16, "…")] {
        let line = table(&state, width)[1].clone();
        assert!(line.split_whitespace().any(|word| word == shown), "{line:?} in {width}");
    }
}

#[test]
fn handles_are_called_handles() {
    let curve = json!([{ "tool": "curve", "samples": 3, "nodes": [{ "at": [1, 2], "in": [3, 4], "out": [5, 6] }, { "at": [9, 9] }],
        "jumps": [{ "along": 0, "jump": [1, 2] }] }]);
    let mut state = with_motion(curve);
    state.show("/layers/0/zones/0/motion/0/nodes");
    let heads = |state: &State| {
        let row = state.sheet().row(0).unwrap();
        row.cells.into_iter().map(|cell| cell.head).collect::<Vec<_>>()
    };
    let expected = ["x", "y", "in dx", "in dy", "in r", "in °", "out dx", "out dy", "out r", "out °"];
    assert_eq!(heads(&state), expected);
    for (column, title) in [(0, "-- at x --"), (2, "-- in dx --"), (6, "-- out dx --"), (9, "-- out ° --")] {
        state.cursor.column = column;
        press(&mut state, "?");
        let crate::tui::state::Mode::Pages(pages) = &state.typing.mode else { panic!("no help") };
        assert_eq!(pages.lines[0], title);
        assert!(
            !pages.lines.iter().take(9).any(|line| line.contains("1000000000") || line.contains("(2)")),
            "{pages:?}"
        );
        press(&mut state, "Esc");
    }
    // dx and dy are those of the handle that is edited.
    state.cursor.column = 6;
    press(&mut state, "i \"dx+dy\" Enter");
    assert_eq!(state.document().json().pointer("/layers/0/zones/0/motion/0/nodes/0/out"), Some(&json!([11, 6])));
    state.show("/layers/0/zones/0/motion/0/jumps");
    assert_eq!(heads(&state), ["along", "dx", "dy", "|J|", "°"]);
}

#[test]
fn one_index_counts_from_zero_everywhere() {
    let mut state = state();
    press(&mut state, "/ \"motion\" Enter Enter j l + u");
    let said = state.message.clone().unwrap().text;
    assert_eq!(said, "undone: left eye · motion 1 at 30, 25 → 31, 25");
    press(&mut state, "J u");
    assert!(state.message.clone().unwrap().text.contains("motion 2 moved to place 1"), "{:?}", state.message);
}

#[test]
fn the_column_of_degrees_says_which_way_they_turn() {
    let mut state = with_motion(json!([{ "tool": "point", "at": [1, 2], "jump": [0, -18] }]));
    state.cursor.column = 6;
    let mut buffer = Buffer::empty(Rect::new(0, 0, 60, 3));
    panes::detail::draw(&state, buffer.area, &mut buffer);
    let text: String = buffer.content().iter().map(|cell| cell.symbol()).collect();
    assert!(text.contains("90 degrees counter-clockwise"), "{text}");
}

#[test]
fn all_rows_are_selected_where_the_cursor_stays() {
    let mut state = with_motion(json!([
        { "tool": "point", "at": [10, 2] },
        { "tool": "point", "at": [20, 2] },
        { "tool": "still-border", "spacing": 20 }
    ]));
    (state.cursor.row, state.cursor.column) = (1, 1);
    press(&mut state, "V");
    assert_eq!((state.cursor.row, state.cursor.column), (1, 1));
    press(&mut state, "i \"100-v\"");
    assert!(table(&state, 70).join("\n").contains("= 90, 80 (2 of 3 rows)"), "{:?}", table(&state, 70));
    press(&mut state, "Enter");
    let at = |i: usize| state.document().json().pointer(&format!("/layers/0/zones/0/motion/{i}/at/0")).cloned();
    assert_eq!((at(0), at(1)), (Some(json!(90)), Some(json!(80))));
    assert_eq!(state.document().json().pointer("/layers/0/zones/0/motion/2/spacing"), Some(&json!(20)));
    assert_eq!(state.message.clone().unwrap().text, "2 of 3 rows have x");
    press(&mut state, "+");
    assert_eq!(state.message.clone().unwrap().text, "2 of 3 rows have x");
    // The cursor moves, and all rows stay selected.
    press(&mut state, "k d");
    assert_eq!(state.document().json().pointer("/layers/0/zones/0/motion"), Some(&json!([])));
}
