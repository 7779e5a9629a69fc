//! A list whose items lie in space and have columns that follow from their fields: (scene, keys, scene).

use glam::{DVec2, DVec3};
use kurbo::Point;
use serde_json::{Value, json};

use super::screens::screen;
use super::support::{at, paste, press, said, said_last, state_of};
use crate::layers::space::camera::Camera;
use crate::layers::space::eye::Eye;
use crate::preview::wire::message::Gesture;
use crate::tui::commands::obey;
use crate::tui::commands::update::update;
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pane, State, spatial};

/// A camera that sees all nodes and the pool.
fn camera() -> Camera {
    Camera { position: [0.0, 3.0, 12.0], target: [0.0, 2.0, 0.0], ..Camera::default() }
}

/// The editor in the table of three nodes, from 5 m above the pool; the first has no velocity of its own.
fn falling(more: Value) -> State {
    let mut layer = json!({ "kind": "waterfall", "name": "falls", "clip": "w", "drag": { "model": "none" }, "lip": [
        { "at": [-1, 4.905, 0] },
        { "at": [0, 4.905, 0], "velocity": [0.5, 0, 1] },
        { "at": [1, 4.905, 0], "velocity": [3, 0, 4], "flow": 2 },
    ]});
    layer.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    let clips = json!({ "w": { "path": "w-%04d.png" } });
    let mut state = state_of(&json!({ "plica": 1, "clips": clips, "camera": camera(), "layers": [layer] }).to_string());
    state.picture.size = Some((400, 300));
    state.show("/layers/0/lip");
    state.cursor.focus = Pane::Table;
    state
}

fn columns(state: &State, row: usize) -> Vec<(String, String)> {
    let cells = state.sheet().row(row).unwrap().cells;
    cells.into_iter().map(|cell| (cell.head, cell.text)).collect()
}

#[test]
fn a_whole_name_is_found_first_and_what_is_no_place_stays() {
    let mut state = falling(json!({}));
    state.show("");
    state.cursor.focus = Pane::Tree;
    press(&mut state, "/ \"lip\" Enter");
    assert_eq!(state.cursor.node, "/layers/0/lip");
    press(&mut state, "n");
    assert!(!said_last(&state).0, "then all others: {:?}", said_last(&state));
    state.show("/clips");
    let before = state.document().json().clone();
    press(&mut state, "g i r");
    assert!(said_last(&state).0 && said_last(&state).1.contains("has no place"), "{:?}", said_last(&state));
    assert_eq!(state.document().json(), &before);
}

#[test]
fn a_lip_that_is_not_written_begins_as_what_stands_for_it() {
    let layer = json!({ "kind": "waterfall", "name": "falls", "clip": "w" });
    let clips = json!({ "w": { "path": "w-%04d.png" } });
    let scene = json!({ "plica": 1, "clips": clips, "camera": camera(), "layers": [layer] }).to_string();
    for (line, expected) in [
        ("reorder down", Ok(vec![1.0, -1.0])),
        ("5 reorder down", Ok(vec![1.0, -1.0])),
        ("reorder up", Err("it cannot move any further")),
        ("add", Ok(vec![-1.0, 0.0, 1.0])),
    ] {
        let mut state = state_of(&scene);
        state.show("/layers/0/lip");
        state.cursor.focus = Pane::Table;
        let found = obey(&mut state, line, None);
        let lip = state.document().json().pointer("/layers/0/lip");
        let x = |node: &Value| node["at"][0].as_f64().unwrap_or(f64::NAN);
        match expected {
            Ok(expected) => {
                let lip: Vec<f64> = lip.unwrap().as_array().unwrap().iter().map(x).collect();
                assert!(found.is_ok() && lip == expected, "{line}: {found:?} {lip:?}");
            }
            Err(why) => assert_eq!((found.unwrap_err().as_str(), lip), (why, None), "{line}"),
        }
    }
}

#[test]
fn what_follows_from_a_lip_that_is_not_written_is_shown_as_not_set() {
    let layer = json!({ "kind": "waterfall", "name": "falls", "clip": "w" });
    let scene = json!({ "plica": 1, "clips": { "w": { "path": "w-%04d.png" } }, "camera": {}, "layers": [layer] });
    let mut state = state_of(&scene.to_string());
    state.show("/layers/0/lip");
    state.cursor.focus = Pane::Table;
    let cells = state.sheet().row(1).unwrap().cells;
    let of =
        |head: &str| cells.iter().find(|cell| cell.head == head).map(|cell| (cell.text.clone(), cell.set)).unwrap();
    for head in ["speed", "land x", "land z", "air time", "impact"] {
        assert!(of(head).0 != "none" && !of(head).1, "{head}: {:?}", of(head));
    }
    let go = to_column(&state, "air time");
    press(&mut state, &format!("{go} i \"+=0.1\" Enter"));
    assert!(!said_last(&state).0, "{:?}", state.message);
}

fn velocity(state: &State, node: usize) -> Vec<f64> {
    serde_json::from_value(at(state, &format!("/layers/0/lip/{node}/velocity"))).unwrap()
}

/// Keys that go to a column, from the first one.
fn to_column(state: &State, head: &str) -> String {
    let at = columns(state, 0).iter().position(|(own, _)| own == head).unwrap();
    let digits: Vec<String> = at.to_string().chars().map(String::from).collect();
    format!("Home {} l", digits.join(" "))
}

fn near(found: &[f64], wanted: &[f64]) -> bool {
    found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn columns_that_follow_are_shown_beside_the_others() {
    let state = falling(json!({}));
    let own = |row: usize| columns(&state, row).into_iter().map(|(head, text)| format!("{head} {text}")).collect();
    let second: Vec<String> = own(2);
    assert_eq!(
        second,
        [
            "x 1",
            "y 4.905",
            "z 0",
            "vx 3",
            "vy 0",
            "vz 4",
            "flow 2",
            "speed 5",
            "land x 4",
            "land z 4",
            "air time 1",
            "impact ~11.011"
        ]
    );
    let first: Vec<String> = own(0);
    assert_eq!(first[3..6], ["vx 0", "vy 0", "vz 1.962"], "what is not set shows what stands for it");
    assert_eq!(first[7..10], ["speed 1.962", "land x -1", "land z 1.962"]);
}

#[test]
fn typing_a_column_that_follows_solves_for_the_velocity() {
    for (head, keys, node, wanted) in [
        ("land x", "j i \"3\" Enter", 1, [3.0, 0.0, 1.0]),
        ("land x", "i \"2\" Enter", 0, [3.0, 0.0, 1.962]),
        ("land z", "j +", 1, [0.5, 0.0, 2.0]),
        ("land x", "v 2 j i \"+=0.2\" Enter", 0, [0.2, 0.0, 1.962]),
        ("land x", "v 2 j i \"+=0.2\" Enter", 2, [3.2, 0.0, 4.0]),
        ("land z", "v 2 j i \"land_x*2\" Enter", 2, [3.0, 0.0, 8.0]),
        ("speed", "2 j i \"*2\" Enter", 2, [6.0, 0.0, 8.0]),
        ("air time", "2 j i \"2\" Enter", 2, [3.0, 7.3575, 4.0]),
        ("impact", "2 j i \"sqrt(9.81^2+100)\" Enter", 2, [6.0, 0.0, 8.0]),
    ] {
        let mut state = falling(json!({}));
        let go = to_column(&state, head);
        press(&mut state, &format!("{go} {keys}"));
        assert!(near(&velocity(&state, node), &wanted), "{head} {keys}: {:?}", state.message);
        press(&mut state, "u");
        assert_eq!(state.document().json(), falling(json!({})).document().json(), "{head} {keys}: one step of undo");
    }
}

#[test]
fn a_velocity_that_is_not_set_is_edited_from_what_stands_for_it() {
    let mut state = falling(json!({}));
    let go = to_column(&state, "vx");
    press(&mut state, &format!("{go} i \"1\" Enter"));
    assert!(near(&velocity(&state, 0), &[1.0, 0.0, 1.962]), "{:?}", state.message);
}

#[test]
fn what_has_no_answer_says_why_and_changes_nothing() {
    for (more, head, keys, why) in [
        (json!({ "gravity": -1 }), "land x", "i \"3\" Enter", "row 0: the line of this node never meets the pool"),
        (json!({ "gravity": -1 }), "air time", "i \"+=1\" Enter", "there is no value to change"),
        (json!({}), "impact", "v 2 j i \"9\" Enter", "row 0: it comes down at 9.81 m/s"),
        (json!({}), "air time", "i \"100\" Enter", "less than the life"),
    ] {
        let mut state = falling(more);
        let before = state.document().json().clone();
        let go = to_column(&state, head);
        press(&mut state, &format!("{go} {keys}"));
        let (bad, told) = said_last(&state);
        assert!(bad && told.contains(why), "{head} {keys}: {told}");
        assert_eq!(*state.document().json(), before);
    }
    let state = falling(json!({ "gravity": -1 }));
    assert!(columns(&state, 1).contains(&("land x".into(), "none".into())));
}

#[test]
fn tables_have_the_columns_that_follow_and_take_them_back_with_what_they_follow_from() {
    let mut state = falling(json!({}));
    let effects = press(&mut state, "2 j Y");
    let copied =
        effects.iter().find_map(|effect| if let Effect::Copy(text) = effect { Some(text.clone()) } else { None });
    let csv = copied.unwrap();
    assert!(csv.starts_with("x,y,z,vx,vy,vz,flow,speed,land x,land z,air time,impact\n1,4.905,0,3,0,4,2,5,4,4,1,"));
    paste(&mut state, &csv);
    assert_eq!(at(&state, "/layers/0/lip/3"), at(&state, "/layers/0/lip/2"), "{:?}", state.message);
    paste(&mut state, "x,y,z,land x\n1,2,3,4\n");
    assert!(said_last(&state).1.contains("line 2: land x follows from velocity, which is missing"));
    press(&mut state, "v");
    paste(&mut state, "land x,land z\n7,8\n");
    assert!(said_last(&state).1.contains("land x follows from velocity: paste that, or type it"));
}

#[test]
fn help_tells_of_the_column_not_of_the_field_behind_it() {
    let mut state = falling(json!({}));
    let go = to_column(&state, "land x");
    press(&mut state, &format!("{go} ?"));
    let Mode::Pages(pages) = &state.typing.mode else { panic!("no help") };
    assert!(pages.lines[0].contains("-- land x --"), "{}", pages.lines[0]);
    assert!(pages.lines.iter().any(|line| line.contains("keeps the air time")));
}

#[test]
fn help_tells_of_any_field_by_its_name() {
    for (name, parts) in [
        ("lines", &["-- lines --", "How many", "range", "path      layers.falls.lines"][..]),
        ("surge.width", &["-- width --", " m\n", "path      layers.falls.surge.width"]),
        ("layers.falls.gravity", &["-- gravity --", "default   9.81", "range     -1000 to 1000 m/s2"]),
        ("frame", &["-- frame --", "The frame of its first key"]),
        ("air time", &["-- air time --", "How long the line of the node takes"]),
        ("land_x", &["-- land x --"]),
        ("speed", &[":speed ", "-- speed --"]),
    ] {
        let mut state = falling(json!({}));
        press(&mut state, &format!(": \"help {name}\" Enter"));
        let Mode::Pages(pages) = &state.typing.mode else { panic!("{name}: {:?}", state.message) };
        let text = pages.lines.join("\n");
        assert!(parts.iter().all(|part| text.contains(part)), "{name}: {text}");
    }
    let mut state = falling(json!({}));
    for (name, told) in [
        ("gravitty", "there is no command or field \"gravitty\" (did you mean \"gravity\"?)"),
        ("width", "\"width\" is several fields: layers.falls."),
        ("look.widths", "there is no command or field"),
    ] {
        press(&mut state, &format!(": \"help {name}\" Enter"));
        assert!(said_last(&state).1.contains(told), "{name}: {:?}", state.message);
    }
    press(&mut state, ": \"help grav\" Tab");
    let Mode::Line(line) = &state.typing.mode else { panic!("no line") };
    assert_eq!(line.text.value(), "help gravity");
}

fn eye(camera: &Camera) -> Eye {
    camera.at(0.0, (400, 300))
}

fn place(state: &State, node: usize) -> DVec3 {
    let at: [f64; 3] = serde_json::from_value(at(state, &format!("/layers/0/lip/{node}/at"))).unwrap();
    at.into()
}

fn seen(camera: &Camera, at: DVec3) -> Point {
    let at = eye(camera).project(eye(camera).seen(at));
    Point::new(at.x, at.y)
}

/// Where a node lands, by its columns.
fn landing(state: &State, node: usize) -> DVec3 {
    let cells = state.sheet().row(node).unwrap().cells;
    let of = |head: &str| cells.iter().find(|cell| cell.head == head).unwrap().number(state.document()).unwrap();
    DVec3::new(of("land x"), 0.0, of("land z"))
}

/// Checks that the log of an editor leads to the same scene.
#[track_caller]
fn replays(state: &State) {
    let mut other = falling(json!({}));
    let log = state.memory.recorder.log();
    log.iter().filter(|line| !line.starts_with('#')).for_each(|line| obey(&mut other, line, None).unwrap());
    assert_eq!(other.document().json(), state.document().json(), "{log:#?}");
}

#[test]
fn the_cursor_sets_where_the_selected_node_lands() {
    let mut state = falling(json!({}));
    press(&mut state, "j g i s : \"cursor at 150 250\" Enter 2 J 5 l");
    assert_eq!(velocity(&state, 1), [0.5, 0.0, 1.0], "not before Enter");
    press(&mut state, "Enter");
    assert_eq!(state.picture.cursor, Point::new(155.0, 270.0));
    let ray = eye(&camera()).ray_in_world(DVec2::new(155.0, 270.0));
    let wanted = ray.meets_level(0.0).unwrap();
    assert!((landing(&state, 1) - wanted).length() < 1e-5, "{} {wanted}", landing(&state, 1));
    replays(&state);
    press(&mut state, "u");
    assert_eq!(velocity(&state, 1), [0.5, 0.0, 1.0]);
    press(&mut state, "s : \"cursor at 150 10\" Enter Enter");
    assert!(said_last(&state).1.contains("the pool (y 0) is not seen there"), "{:?}", state.message);
    assert!(matches!(state.typing.mode, Mode::Aim), "it can be tried again");
}

#[test]
fn aiming_begins_where_the_line_lands_as_far_as_that_is_seen() {
    let landed = |state: &State, node| seen(&camera(), landing(state, node));
    for (more, node, wanted) in
        [(json!({}), "j", Some(1)), (json!({ "pool": -3 }), "2 j", None), (json!({ "gravity": -1 }), "", None)]
    {
        let mut state = falling(more.clone());
        press(&mut state, &format!("{node} g i : \"cursor at 150 10\" Enter s"));
        assert!(matches!(state.typing.mode, Mode::Aim), "{more}: {:?}", state.message);
        let at = state.picture.cursor;
        if let Some(node) = wanted {
            assert!(at.distance(landed(&state, node)) < 1e-9, "{at}");
        }
        let level = more["pool"].as_f64().unwrap_or(0.0);
        assert!(eye(&camera()).ray_in_world(DVec2::new(at.x, at.y)).meets_level(level).is_some(), "{more} {at}");
        assert!((0.0..400.0).contains(&at.x) && (0.0..300.0).contains(&at.y), "{more} {at}");
    }
}

#[test]
fn while_aiming_only_the_cursor_acts_and_the_status_line_tells_the_landing() {
    let mut state = falling(json!({}));
    press(&mut state, "j g i s");
    let before = state.document().json().clone();
    for key in ["a", "r", "d", "w", "b", "s", "u", "p", "Tab", "z", "g"] {
        press(&mut state, key);
        assert!(
            said_last(&state).1.contains("aiming: only the cursor, Enter, Esc, : and ? act"),
            "{key}: {:?}",
            state.message
        );
        assert!(matches!(state.typing.mode, Mode::Aim) && *state.document().json() == before, "{key}");
    }
    let facts = spatial::aiming(&state).unwrap().unwrap();
    let told: Vec<(&str, f64)> = facts.iter().map(|fact| (fact.name, (fact.value * 1e6).round() / 1e6)).collect();
    assert_eq!(told, [("land x", 0.5), ("land z", 1.0), ("air time", 1.0)], "where it lands already");
    state.message = None;
    for width in [80, 60] {
        state.size = (width, 24);
        let shown = screen(&state);
        assert!(shown.contains(" AIM  ") && shown.contains("land x 0.5 m  land z 1 m  air time 1 s"), "{shown}");
    }
    for keys in ["? Esc", ": Esc", ": Backspace", ": \"help put\" Enter Esc"] {
        press(&mut state, keys);
        assert!(matches!(state.typing.mode, Mode::Aim), "{keys} comes back to it");
    }
    press(&mut state, ": \"go layers.0.look\" Enter");
    assert!(matches!(state.typing.mode, Mode::Normal), "nothing is aimed there");
}

#[test]
fn nodes_are_added_and_moved_as_far_away_as_the_selected_one() {
    let camera = camera();
    for (key, node) in [("a", 2), ("r", 1)] {
        let mut state = falling(json!({}));
        let depth = -eye(&camera).seen(place(&state, 1)).z;
        press(&mut state, &format!("j g i : \"cursor at 215 80\" Enter {key}"));
        assert_eq!(state.cursor.row, node, "{key}: {:?}", state.message);
        let found = place(&state, node);
        assert!(seen(&camera, found).distance(Point::new(215.0, 80.0)) < 1e-2, "{key}: {found}");
        assert!((-eye(&camera).seen(found).z - depth).abs() < 1e-5, "{key}: {found}");
        assert_eq!(velocity(&state, node), [0.5, 0.0, 1.0], "{key}: a new one is like the one before");
        replays(&state);
    }
}

#[test]
fn a_new_node_never_folds_the_lip_back() {
    for (x, row) in [(-2.0, 0), (-0.4, 1), (0.7, 2), (1.6, 3)] {
        for selected in ["", "j", "2 j"] {
            let mut state = falling(json!({}));
            let Point { x, y } = seen(&camera(), DVec3::new(x, 4.8, 0.0));
            press(&mut state, &format!("{selected} g i : \"cursor at {x} {y}\" Enter a"));
            assert_eq!(state.cursor.row, row, "{x} {selected}: {:?}", state.message);
            let places: Vec<f64> = (0..4).map(|node| place(&state, node).x).collect();
            assert!(places.is_sorted(), "{x} {selected}: {places:?}");
        }
    }
}

#[test]
fn the_cursor_goes_from_node_to_node() {
    let mut state = falling(json!({}));
    for (keys, node) in [("g i w", 1), ("w", 2), ("b b", 0)] {
        press(&mut state, keys);
        let wanted = seen(&camera(), place(&state, node));
        assert_eq!((state.cursor.row, state.picture.cursor), (node, wanted), "{keys}");
    }
}

#[test]
fn a_window_drops_a_landing_where_it_sees_the_pool() {
    for own in [None, Some(Camera { position: [3.0, 2.0, 3.0], ..camera() })] {
        let mut state = falling(json!({}));
        update(&mut state, said(Gesture::Camera(own.clone())));
        update(&mut state, said(Gesture::Pointer { x: 230.5, y: 260.0 }));
        update(&mut state, said(Gesture::Command("drop /layers/0/lip/2".into())));
        let wanted = eye(&own.unwrap_or_else(camera)).ray_in_world(DVec2::new(230.5, 260.0)).meets_level(0.0).unwrap();
        assert!((landing(&state, 2) - wanted).length() < 1e-5, "{} {wanted}", landing(&state, 2));
        assert_eq!(state.cursor.row, 2);
        replays(&state);
        press(&mut state, "u");
        assert_eq!(state.document().json(), falling(json!({})).document().json());
        update(&mut state, said(Gesture::Command("drop /layers/0/look".into())));
        assert!(said_last(&state).0);
        press(&mut state, "i");
        update(&mut state, said(Gesture::Command("drop /layers/0/lip/2".into())));
        assert!(said_last(&state).1.contains("something is being typed"));
    }
}
