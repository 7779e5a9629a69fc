//! Lines do what keys do, and the log of a session leads to the same scene.

use crate::tui::commands::contexts::contexts;
use serde_json::{Value, json};

use super::support::{press, replayed, said, state};
use super::{check, motion, zone};
use crate::preview::wire::message::Gesture;
use crate::tui::commands::update::update;
use crate::tui::commands::{self, obey};
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pane, State};

fn log(state: &State) -> Vec<&str> {
    state.memory.recorder.log().iter().map(String::as_str).collect()
}

#[test]
pub fn lines_say_what_keys_do() {
    check(&[
        (&motion("l : \"put *1.5\" Enter"), &zone("/motion/0/at"), json!([30, 20])),
        (&motion("l v j : \"put +=1\" Enter"), &zone("/motion/1/at"), json!([31, 25])),
        (": \"go layers.face.zones.mouth.name\" Enter : \"put lips\" Enter", "/layers/0/zones/1/name", json!("lips")),
        ("/ \"method\" Enter : \"put thin-plate\" Enter", &zone("/interpolation/method"), json!("thin-plate")),
        ("/ \"method\" Enter : \"put thin\" Enter", &zone("/interpolation/method"), json!("modified-shepard")),
        (&motion(": \"2 move right\" Enter 3 +"), &zone("/motion/0/at"), json!([20, 23])),
        (&motion("l : \"2 move down\" Enter : \"2 step 3\" Enter"), &zone("/motion/2/at"), json!([46, 30])),
        (&motion("g i : \"cursor at 12 13\" Enter r"), &zone("/motion/0/at"), json!([12, 13])),
    ]);
}

#[test]
pub fn what_lasts_of_no_key_changes_no_scene() {
    let title = |keys| (keys, "/title", Value::Null);
    check(&[
        title("? j Ctrl-d q"),
        title(": \"problems\" Enter"),
        title(": \"get title\" Enter"),
        title(": \"log\" Enter"),
        title("Ctrl-l Ctrl-z"),
        title(": \"x\" Up Down Left Ctrl-u Esc"),
    ]);
}

#[test]
pub fn nodes_are_reached_by_collapsing_and_going_up() {
    check(&[
        ("h d", "/layers/0/zones/0/name", json!("mouth")),
        ("h h D", "/layers/1/name", json!("face 2")),
        ("h l l i \"x\" Enter", &zone("/name"), json!("x")),
        // The earlier names of these commands.
        (": \"fold\" Enter : \"2 open\" Enter i \"x\" Enter", &zone("/name"), json!("x")),
        (&motion("Backspace g g i \"x\" Enter"), &zone("/name"), json!("x")),
        (&motion("g i + l r"), &zone("/motion/0/at"), json!([31.5, 25.5])),
        ("d : \"und\" Tab Enter", &zone("/name"), json!("left eye")),
        ("P d", &zone("/name"), json!("mouth")),
        ("d : \"e!\" Enter", &zone("/name"), json!("left eye")),
    ]);
}

#[test]
pub fn what_is_outside_is_asked_for() {
    for (line, effect) in [
        ("w", "Save { to: None, overwrite: false, leave: false }"),
        ("w b.json", "Save { to: Some(\"b.json\"), overwrite: false, leave: false }"),
        ("w!", "Save { to: None, overwrite: true, leave: false }"),
        ("wq", "Save { to: None, overwrite: false, leave: true }"),
        ("e b.json", "Open(\"b.json\")"),
        ("w! b.json", "Save { to: Some(\"b.json\"), overwrite: true, leave: false }"),
        ("write! \"a b.json\"", "Save { to: Some(\"a b.json\"), overwrite: true, leave: false }"),
        ("wq b.json", "Save { to: Some(\"b.json\"), overwrite: false, leave: true }"),
        ("x b.json", "Save { to: Some(\"b.json\"), overwrite: false, leave: true }"),
        ("source \"a b\"", "Source(\"a b\")"),
        ("keys reload", "Keymap"),
        ("log a", "Write(\"a\", \"\")"),
        ("view", "View(None)"),
        ("shot", "View(Some(\"shot\"))"),
        ("capture", "View(Some(\"capture\"))"),
        ("capture apng", "View(Some(\"capture apng\"))"),
        ("view view-field", "View(Some(\"view-field on\"))"),
        ("render -o \"a b.gif\"", "Run([\"render\", \"-o\", \"a b.gif\"])"),
    ] {
        let mut state = state();
        obey(&mut state, line, None).unwrap();
        assert_eq!(state.effects.iter().map(|effect| format!("{effect:?}")).collect::<Vec<_>>(), [effect], "{line}");
    }
}

#[test]
fn nothing_is_captured_in_a_format_that_there_is_not() {
    for format in ["mp3", "../x.gif", "gif apng"] {
        let refused = obey(&mut state(), &format!("capture {format}"), None).unwrap_err();
        assert!(refused.contains(&format!("nothing is captured as \"{format}\": there are png, apng,")), "{refused}");
    }
}

#[test]
fn a_command_that_takes_nothing_says_so_where_it_is_given_something() {
    let (names, others): (Vec<_>, Vec<_>) = commands::TABLE.all().partition(|command| command.args.is_empty());
    assert!(names.len() > 15 && others.len() > 40);
    for line in names.iter().map(|command| format!("{} x y", command.name)).chain(["quit! now".into()]) {
        let mut state = state();
        let refused = obey(&mut state, &line, None).unwrap_err();
        assert!(refused.contains(" takes no argument, not \""), "{line}: {refused}");
        assert!(state.effects.is_empty() && state.scene.revision() == 0, "{line}");
    }
}

#[test]
fn a_path_is_one_word_or_in_quotes_and_no_program() {
    for name in ["w", "w!", "wq", "e", "e!", "log", "source", "add"] {
        for (path, refusal) in [
            ("a b", "one path is needed, not 2"),
            ("!cat", "programs are not run from here"),
            ("\"a", "a \" is not closed"),
            ("\"\"", "a path is empty"),
        ] {
            let mut state = state();
            let refused = obey(&mut state, &format!("{name} {path}"), None).unwrap_err();
            assert!(refused.contains(refusal), "{name} {path}: {refused}");
            assert!(state.effects.is_empty() && state.scene.revision() == 0, "{name} {path}");
        }
    }
}

#[test]
pub fn the_pointer_of_a_window_is_kept_as_a_place() {
    let mut state = state();
    update(&mut state, said(Gesture::Pointer { x: 12.5, y: 13.0 }));
    press(&mut state, &motion("M"));
    assert_eq!(state.document().json().pointer(&zone("/motion/0/at")), Some(&json!([12.5, 13])));
    assert_eq!(replayed(&state).document().json(), state.document().json());
}

#[test]
fn a_window_copies_its_pointer_and_files_that_are_dropped_on_it_come_in() {
    let gesture = |state: &mut State, command: &str| {
        update(state, said(Gesture::Command(command.to_owned())));
        state.message.clone().unwrap().text
    };
    let mut state = state();
    assert!(gesture(&mut state, "copy-point").contains("not over the picture"));
    update(&mut state, said(Gesture::Pointer { x: 12.53, y: 13.0 }));
    let effects = update(&mut state, said(Gesture::Command("copy-point".to_owned())));
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Copy(text) if text == "12.53, 13")), "{effects:?}");
    assert_eq!(state.message.clone().unwrap().text, "12.53, 13 yanked");
    press(&mut state, "/ \"motion\" Enter Enter p");
    assert_eq!(state.memory.yanked.as_ref().map(|yanked| yanked.value.clone()), Some(json!([12.53, 13.0])));
    press(&mut state, ": \"set title=new\" Enter");
    assert!(gesture(&mut state, "file /b/other scene.plica.json").contains("unsaved edits"), "the guard of :e");
    press(&mut state, "u");
    let told = gesture(&mut state, "file /nowhere/a b.png");
    assert!(told.contains("a b.png"), "{told}");
}

#[test]
fn the_log_is_short_and_says_what_was_meant() {
    for (keys, expected) in [
        ("j 3 k", &["move down", "3 move up"][..]),
        ("/ \"motion\" Enter", &["search motion"]),
        (": \"set title=12\" Enter", &["set title=12"]),
        ("Enter i Esc", &["pane table"]),
        ("Enter i \" a\" Enter", &["pane table", "put \" a\""]),
        ("Enter i \"7\" Tab", &["pane table", "put 7", "move next"]),
        ("/ \"method\" Enter i j Enter", &["search method", "enter", "choose modified-shepard-random"]),
        ("/ \"method\" Enter i j Esc", &["search method"]),
        ("? j q Ctrl-l", &[]),
        ("/ \"nowhere\" Enter", &["# search nowhere: no name or value matches nowhere"]),
        (": \"render -o a.gif\" Enter", &["render -o a.gif"]),
    ] {
        let mut state = state();
        press(&mut state, keys);
        assert_eq!(log(&state), expected, "{keys}");
    }
}

#[test]
fn a_step_of_undo_is_the_same_when_the_log_is_replayed() {
    for keys in ["l + i Esc + ? q + u", "l + j k + u", "l i \"5\" Enter + + u", "l v 2 j i \"+=1\" Enter + u u Ctrl-r"]
    {
        let mut state = state();
        press(&mut state, &motion(keys));
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{keys}");
    }
}

/// Everything that running the log again must reproduce.
#[derive(Debug, PartialEq)]
struct Place(String, usize, usize, Option<usize>, i32, Pane);

fn place(state: &State) -> Place {
    Place(
        state.cursor.node.clone(),
        state.cursor.row,
        state.cursor.column,
        state.cursor.selected_from,
        state.typing.step,
        state.cursor.focus,
    )
}

/// A random key: one that means something here, or something to type.
fn any_key(state: &State, next: &mut impl FnMut(usize) -> usize) -> String {
    let typed: &[&str] = match &state.typing.mode {
        Mode::Entry(_) => &["\"7\" Enter", "\"+=3\" Enter", "\"*0.5\" Tab", "\"w/2\" Enter", "\"nonsense\" Enter"],
        Mode::Line(line) if line.kind == ':' => {
            &["\"put 7\" Enter", "\"3 move down\" Enter", "\"set title=a\" Enter", "\"undo 2\" Enter"]
        }
        Mode::Palette(_) => &["\"radius\" Enter", "\"undo\" Enter", "\"dup\" Enter", "Down Enter"],
        Mode::Line(_) => &["\"motion\" Enter", "\"radius\" Enter", "\"outline\" Enter", "\"speed\" Enter"],
        _ => &[],
    };
    let contexts = contexts(state);
    let rows = state.keymap.rows().iter().filter(|row| contexts.contains(&row.context) && row.command != "q");
    let keys: Vec<String> = rows.map(|row| row.key.replace("{a-z}", "a")).collect();
    match next(3) {
        0 if !typed.is_empty() => typed[next(typed.len())].to_owned(),
        0 => format!("{} {}", 1 + next(3), keys[next(keys.len())]),
        _ => keys[next(keys.len())].clone(),
    }
}

#[test]
fn whatever_is_pressed_the_log_leads_to_the_same_place() {
    for seed in 1..=40u64 {
        let mut random = 0x9e37_79b9_7f4a_7c15 ^ seed;
        let mut next = |n: usize| {
            for shift in [13, -7, 17] {
                random ^= if shift > 0 { random << shift } else { random >> -shift };
            }
            (random % n as u64) as usize
        };
        let [mut state, mut other] = [(); 2].map(|()| state());
        let (mut keys, mut replayed) = (Vec::new(), 0);
        for _ in 0..40 {
            let key = any_key(&state, &mut next);
            press(&mut state, &key);
            keys.push(key);
            for line in &state.memory.recorder.log()[replayed..] {
                if !line.starts_with('#') {
                    obey(&mut other, line, None).unwrap_or_else(|why| panic!("{line}: {why}\n{keys:?}"));
                }
            }
            replayed = state.memory.recorder.log().len();
            if matches!(state.typing.mode, Mode::Normal) {
                assert_eq!(other.document().json(), state.document().json(), "{keys:?}\n{:#?}", log(&state));
                assert_eq!(place(&other), place(&state), "{keys:?}\n{:#?}", log(&state));
            }
        }
    }
}
