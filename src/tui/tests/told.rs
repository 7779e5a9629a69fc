//! Messages, problems, the help of a command, pages; and pasting and typing.

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use serde_json::{Value, json};

use super::support::{at, press, replayed, state, state_of};
use super::{motion, zone};
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event};
use crate::tui::panes::marks::Kept;
use crate::tui::panes::view;
use crate::tui::state::{Mode, Pages, State};

fn said(state: &State) -> String {
    state.message.as_ref().map_or(String::new(), |message| message.text.clone())
}

/// The rows of the screen.
fn screen(state: &State) -> Vec<String> {
    let (width, height) = state.size;
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| view::draw(frame, state, &mut Kept::default())).unwrap();
    let cells = terminal.backend().buffer().content().chunks(usize::from(width));
    cells.map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>().trim_end().to_owned()).collect()
}

#[test]
pub fn tables_are_pasted_over_a_selection() {
    for (keys, text, jumps) in [
        ("v j", "dx,dy\n1,2\n3,4", json!([[1, 2], [3, 4], null])),
        ("v j", "dy\n7", json!([[0, 7], [3, 7], null])),
        ("v j", "\"dy\"\t\"dx\"\n\"2\"\t\"1,5\"\n4\t3", json!([[1.5, 2], [3, 4], null])),
        ("3 l v 2 j", "1 2\n3 4\n5 6", json!([[1, 2], [3, 4], [5, 6]])),
        ("v j", "|J|\n5", json!([[0, -5], [3, 4], null])),
        ("v j", "dx,dy,|J|,°\n10,0,18,90\n5,5,5,-53.13", json!([[10, 0], [5, 5], null])),
        ("v j", "|J|,°,dy,dx\n18,90,0,10", json!([[10, 0], [10, 0], null])),
        ("v 2 j", "°,|J|\n90,2", json!([[0, -2], [0, -2], [0, -2]])),
        ("3 l v j", "7,5", json!([[7.5, -18], [7.5, 4], null])),
        ("3 l v j", "7,5\n8", json!([[7.5, -18], [8, 4], null])),
        ("v j", "dx\n7,5\n\u{2212}8,25", json!([[7.5, -18], [-8.25, 4], null])),
        ("3 l v j", "7,5;1\n8", json!([[0, -18], [3, 4], null])),
        ("3 l v j", "1;2\n3;4\n5;6", json!([[0, -18], [3, 4], null])),
        ("v j", "dx,dy\n\u{2212}1,2\n3,x", json!([[0, -18], [3, 4], null])),
        ("v j", "color\n1\n2", json!([[0, -18], [3, 4], null])),
    ] {
        let mut state = state();
        press(&mut state, &motion(keys));
        update(&mut state, Event::Paste(text.into()));
        let found: Vec<Value> = (0..3).map(|i| at(&state, &zone(&format!("/motion/{i}/jump")))).collect();
        assert_eq!(Value::from(found), jumps, "{keys} {text}: {}", said(&state));
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{text}");
        press(&mut state, "u");
        assert!(state.scene.is_saved(), "{text}");
    }
}

#[test]
fn what_was_yanked_changes_nothing_where_it_was() {
    let jumps = json!([{ "along": 0, "jump": [0, -3.0] }, { "along": 1, "jump": [0.123456789012, -8] }]);
    let curve = json!({ "tool": "curve", "samples": 9, "nodes": [{ "at": [1, 2] }, { "at": [30, 4.000000000001] }], "jumps": jumps });
    let list = json!([curve, { "tool": "point", "at": [3, 4], "jump": [0.123456789012, -18] }, { "tool": "point", "at": [5, 6] }]);
    for place in ["motion", "motion.0.jumps", "motion.0.nodes", "outline.points"] {
        for yank in ["V Y", "V y"] {
            let mut state = state();
            super::super::commands::obey(&mut state, &format!("set layers.0.zones.0.motion={list}"), None).unwrap();
            press(&mut state, &format!(": \"go layers.0.zones.0.{place}\" Enter g e g g"));
            let before = state.document().json().clone();
            let copied = press(&mut state, yank).into_iter().find_map(|effect| match effect {
                Effect::Copy(text) => Some(text),
                _ => None,
            });
            update(&mut state, Event::Paste(copied.unwrap()));
            assert!(said(&state).starts_with("pasted over"), "{place} {yank}: {}", said(&state));
            assert_eq!(state.document().json(), &before, "{place} {yank}");
            press(&mut state, "p u");
            assert!(state.scene.is_saved(), "no step of undo: {place} {yank}");
        }
    }
}

#[test]
fn json_goes_over_all_that_is_selected_or_is_refused() {
    let point = json!({ "tool": "point", "at": [9, 9] });
    for (keys, text, pointer, expected) in [
        ("l V", "[9,9]", "/motion/0/at", json!([9, 9])),
        ("l V", "[9,9]", "/motion/3/center", json!([9, 9])),
        ("l v 2 j", "[9,9]", "/motion/2/at", json!([9, 9])),
        ("v j", r#"{"tool":"point","at":[9,9]}"#, "/motion/1", point.clone()),
        ("v j", r#"[{"tool":"point","at":[9,9]},{"tool":"point","at":[8,8]}]"#, "/motion/1/at", json!([8, 8])),
        ("v", r#"{"tool":"point","at":[9,9]}"#, "/motion/0", point),
    ] {
        let mut state = state();
        press(&mut state, &motion(keys));
        update(&mut state, Event::Paste(text.into()));
        assert_eq!(at(&state, &zone(pointer)), expected, "{keys} {text}: {}", said(&state));
        assert_eq!(at(&state, &zone("/motion")).as_array().unwrap().len(), 4, "{keys} {text}");
        assert!(said(&state).starts_with("pasted over"), "{keys} {text}: {}", said(&state));
        press(&mut state, "u");
        assert!(state.scene.is_saved(), "{keys} {text}");
    }
    for (keys, text, why) in [
        ("v 2 j", r#"[{"tool":"point","at":[9,9]},{"tool":"point","at":[8,8]}]"#, "2 rows over 3 selected"),
        ("v j", "[9,9]", "2 rows are selected"),
        ("v j", "1 2 3\n1 2 3\n1 2 3", "3 rows over 2 selected"),
    ] {
        let mut state = state();
        press(&mut state, &motion(keys));
        update(&mut state, Event::Paste(text.into()));
        assert!(said(&state).contains(why) && state.scene.is_saved(), "{keys} {text}: {}", said(&state));
    }
}

#[test]
fn quoted_tables_are_tables() {
    for text in [
        "\"1\",\"2\",\"3\",\"4\"",
        "\"1\";\"2\";\"3\";\"4\"",
        "\"1\"\t\"2\"\t\"3\"\t\"4\"",
        "\"x\",\"y\",\"dx\",\"dy\"\n\"1\",\"2\",\"3\",\"4\"",
        "\"1,0\";\"2,0\";\"3,0\";\"4,0\"",
    ] {
        let mut state = state();
        press(&mut state, super::MOTION);
        update(&mut state, Event::Paste(text.into()));
        let pasted = json!({ "tool": "point", "at": [1, 2], "jump": [3, 4] });
        assert_eq!(at(&state, &zone("/motion/1")), pasted, "{text}: {}", said(&state));
    }
}

#[test]
fn entries_take_the_decimal_comma() {
    for (typed, value) in
        [("4,5", json!(4.5)), ("\u{2212}4,5", json!(-4.5)), ("min(4,5)", json!(4)), ("*1,5", json!(30))]
    {
        let mut state = state();
        press(&mut state, &motion(&format!("l i \"{typed}\" Enter")));
        assert_eq!(at(&state, &zone("/motion/0/at/0")), value, "{typed}: {}", said(&state));
    }
}

#[test]
fn the_help_of_an_object_tells_what_is_set_in_it() {
    let scene = r#"{"plica": 1, "meshes": {"m": {"path": "m.obj"}}, "layers": [{"kind": "mesh", "name": "tree", "mesh": "m"}]}"#;
    let mut state = state_of(scene);
    press(&mut state, ": \"help bend\" Enter");
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no help") };
    let text = pages.lines.join("\n");
    for part in
        ["layers.tree.pose.bend.degrees=VALUE)", "fields    degrees = 0 degrees: How far it leans", "axis = y: "]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn the_help_of_entries_opens_over_one_and_leaves_it_as_typed() {
    let mut state = state();
    press(&mut state, &motion("l i \"12\" ?"));
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
    let text = pages.lines.join("\n");
    assert!(crate::base::expression::functions().all(|name| text.contains(name)), "{text}");
    assert!(pages.lines.iter().all(|line| line.chars().count() <= 74), "{text}");
    press(&mut state, "q \"5\" Enter");
    assert_eq!(at(&state, &zone("/motion/0/at/0")), json!(125));
    for (line, part) in [("help put", "decimal point"), ("help render", "--frames")] {
        press(&mut state, &format!(": \"{line}\" Enter"));
        let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages for {line}") };
        assert!(pages.lines.join("\n").contains(part), "{line}");
        press(&mut state, "q");
    }
    press(&mut state, ": \"help rendr\" Enter");
    assert_eq!(said(&state), "there is no command or field \"rendr\" (did you mean \"render\"?)");
}

#[test]
fn long_messages_are_shown_whole() {
    let mut state = state();
    let long = format!("{} the end", "a word and ".repeat(20));
    state.complain(long.clone());
    let shown = screen(&state);
    assert!(shown.last().unwrap().ends_with("the end"), "{shown:#?}");
    let rows = shown.iter().filter(|row| row.contains("a word")).count();
    assert!((2..5).contains(&rows), "{shown:#?}");
    state.say("first\nsecond");
    let shown = screen(&state);
    assert_eq!((shown[22].trim(), shown[23].trim()), ("first", "second"));
    state.complain("x".repeat(10_000));
    assert!(screen(&state).last().unwrap().ends_with("(:messages)"));
    press(&mut state, "j");
    assert!(!screen(&state)[22].contains('x'));
}

pub const TWO_PROBLEMS: &str = r#"{ "plica": 1, "images": { "cat": { "path": "cat.png" } }, "layers": [
    { "kind": "picture", "name": "face", "image": "cat", "zones": [
        { "name": "a", "outline": { "kind": "rectangle", "x": 1, "y": 1, "width": 9, "height": 9 } },
        { "name": "b", "outline": { "kind": "polygon", "points": [[0, 0], [9, 9], [9, 0], [0, 9]] } } ] } ] }"#;

#[test]
pub fn what_was_said_and_what_is_wrong_can_be_read_again() {
    let mut state = state_of(TWO_PROBLEMS);
    press(&mut state, ": \"nosuch\" Enter : \"messages\" Enter");
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
    assert_eq!(pages.lines, ["there is no command \"nosuch\" (? lists them)"]);
    press(&mut state, "q Space c");
    let Mode::Choice(choice) = &state.typing.mode else { panic!("no list") };
    let places: Vec<&str> = choice.options.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(places, ["layers.face.zones.a.motion", "layers.face.zones.b.outline", "layers.face.zones.b.motion"]);
    press(&mut state, "j Enter");
    assert_eq!(state.cursor.node, "/layers/0/zones/1/outline");
    press(&mut state, "g d");
    assert_eq!((state.cursor.node.as_str(), &said(&state)[..15]), ("/layers/0/zones/1/motion", "problem 3 of 3:"));
    press(&mut state, "g d");
    assert_eq!(state.cursor.node, "/layers/0/zones/0/motion");
    press(&mut state, "g D");
    assert_eq!(state.cursor.node, "/layers/0/zones/1/motion");
    let mut state = self::state();
    press(&mut state, ": \"set layers.0.zones.0.fether=3\" Enter");
    assert!(said(&state).ends_with("(did you mean \"feather\"?)"), "{}", said(&state));
}

#[test]
fn settings_are_answered_with_addresses() {
    for (line, answer) in [
        ("set layers.0.zones.0.feather=-3", "layers.face.zones.\"left eye\".feather: -3 is too small: 0 to 1000000 px"),
        (
            "set /layers/0/zones/0/feather=-3",
            "layers.face.zones.\"left eye\".feather: -3 is too small: 0 to 1000000 px",
        ),
        (
            "set layers.0.zones.0.feather=3 layers.0.zones.1.speed=2",
            "layers.face.zones.\"left eye\".feather, layers.face.zones.mouth.speed are set",
        ),
        ("set title=two words", "title is set"),
        ("set layers.face.zones.left eye.feather=3", "layers.face.zones.\"left eye\".feather is set"),
        (
            "set layers.0.zones.left eye.feather=3 layers.0.zones.1.speed=2",
            "layers.face.zones.\"left eye\".feather, layers.face.zones.mouth.speed are set",
        ),
        ("set layers.face", "layers.face: write it as PATH=VALUE, a name with a space in quotes"),
        ("get layers.0.zones.-.name", "layers.0.zones.-.name is not set, and has no default"),
        ("get layers.0.zones.1.name", "\"mouth\""),
        (
            "set layers.0.zones.1.outline.kind=ellipse",
            "layers.face.zones.mouth.outline.kind: only the ellipse inside its box is kept: 300 px² became 235.62",
        ),
    ] {
        let mut state = state();
        press(&mut state, &format!(": \"{line}\" Enter"));
        assert_eq!(said(&state), answer);
    }
}

#[test]
fn names_with_spaces_are_completed_in_quotes() {
    for (typed, completed) in [
        ("set layers.face.zones.le", "set layers.face.zones.\"left eye\""),
        ("set layers.face.zones.\"left e", "set layers.face.zones.\"left eye\""),
        ("set layers.0.zones.\"left eye\".fe", "set layers.0.zones.\"left eye\".feather"),
        ("set layers.face.zones.mo", "set layers.face.zones.mouth"),
        ("get tim", "get timeline"),
    ] {
        let mut state = state();
        press(&mut state, ":");
        update(&mut state, Event::Paste(typed.into()));
        press(&mut state, "Tab");
        let Mode::Line(line) = &state.typing.mode else { panic!("no line") };
        assert_eq!(line.text.value(), completed, "{typed}");
    }
}

#[test]
fn a_new_kind_keeps_the_shape_in_one_step() {
    let mut state = state();
    press(&mut state, "/ \"outline\" Enter Enter i");
    let Mode::Choice(choice) = &mut state.typing.mode else { panic!("no list") };
    choice.at = choice.options.iter().position(|(word, _)| word == "path").unwrap();
    press(&mut state, "Enter");
    let nodes = json!([{ "at": [10, 10] }, { "at": [50, 10] }, { "at": [50, 40] }, { "at": [10, 40] }]);
    assert_eq!(at(&state, &zone("/outline/nodes")), nodes);
    press(&mut state, "u");
    assert_eq!(at(&state, &zone("/outline/kind")), json!("polygon"));
    let lines = r#"paste {"tool":"lasso","vertices":[{"from":[1,1],"to":[2,2]},{"from":[9,1],"to":[9,1]},{"from":[5,8],"to":[5,9]}]}"#;
    super::super::commands::obey(&mut state, "go layers.0.zones.0.motion", None).unwrap();
    super::super::commands::obey(&mut state, lines, None).unwrap();
    let list = at(&state, &zone("/motion"));
    let count = list.as_array().unwrap().len();
    let i = list.as_array().unwrap().iter().position(|tool| tool["tool"] == "lasso").unwrap();
    press(&mut state, &format!(": \"set layers.0.zones.0.motion.{i}.tool=point\" Enter"));
    assert_eq!(at(&state, &zone("/motion")).as_array().unwrap().len(), count + 2, "{}", said(&state));
    assert_eq!(at(&state, &zone(&format!("/motion/{}/at", i + 2))), json!([5, 8]));
    press(&mut state, "u");
    assert_eq!(at(&state, &zone("/motion")), list);
}

#[test]
fn pages_wrap_what_is_wider_than_the_screen() {
    let mut state = state();
    state.size = (60, 20);
    let mut lines = vec!["line".to_owned(); 40];
    lines[0] = format!("key        {} the end", "word ".repeat(12));
    lines[39] = format!("{} the last", "word ".repeat(12));
    state.typing.mode = Mode::Pages(Pages { title: "page".into(), lines, scroll: 0 });
    let rows = screen(&state);
    let (first, end) = (
        &rows.iter().find(|row| row.contains("key  ")).unwrap(),
        &rows.iter().find(|row| row.contains("the end")).unwrap(),
    );
    assert_eq!(first.find("word"), end.find("word"), "{rows:#?}");
    press(&mut state, "G");
    assert!(screen(&state).iter().any(|row| row.contains("the last")));
}
