//! Counts and arguments: each command uses a count or refuses it, and refuses words that it does not know, by name.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::support::{at, press, replayed, said_last, state, state_of};
use super::{MOTION, check, motion, zone};
use crate::files::session::Mode as Open;
use crate::tui::commands::command::Counts;
use crate::tui::commands::update::update;
use crate::tui::commands::{self, obey};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::color::Depth;

/// All that a count can change.
fn everything(state: &State) -> String {
    let State { cursor, typing, picture, play, memory, .. } = state;
    let effects: Vec<&Effect> =
        state.effects.iter().filter(|effect| matches!(effect, Effect::View(_) | Effect::Copy(_))).collect();
    let (at, viewport, yanked) = (picture.cursor, picture.viewport, &memory.yanked);
    let looking = picture.looking;
    format!(
        "{looking:?} {} {cursor:?} {typing:?} {at:?} {viewport:?} {play:?} {effects:?} {yanked:?}",
        state.document().json()
    )
}

/// Every command that takes a count: the keys before it, and the line.
const COUNTED: &[(&str, &str)] = &[
    (MOTION, "add"),
    (MOTION, "delete"),
    (MOTION, "duplicate"),
    (MOTION, "reorder down"),
    ("/ \"motion\" Enter Enter G", "reorder up"),
    (MOTION, "yank"),
    (MOTION, "yank csv"),
    ("/ \"motion\" Enter Enter y", "paste"),
    ("/ \"motion\" Enter Enter l i", "digit 1"),
    ("/ \"function\" Enter Enter", "choice next"),
    ("/ \"function\" Enter Enter j j j j", "choice previous"),
    ("/ \"function\" Enter Enter", "choice to s"),
    ("/ \"motion\" Enter Enter l", "step 1"),
    ("", "turn 5"),
    ("", "step-size smaller"),
    ("", "step-size larger"),
    ("g g", "move down"),
    ("G", "move up"),
    ("/ \"motion\" Enter Enter 5 l", "move left"),
    (MOTION, "move right"),
    ("", "move first"),
    ("", "move last"),
    ("g g", "move page-down"),
    ("G", "move page-up"),
    (MOTION, "move next"),
    ("", "pane next"),
    ("", "pane previous"),
    ("", "collapse"),
    ("h", "expand"),
    ("", "up"),
    ("/ \"motion\" Enter Enter v", "back"),
    ("/ \"motion\" Enter Enter v", "leave"),
    ("/ \"function\" Enter Enter", "cancel"),
    (MOTION, "select"),
    (MOTION, "toggle"),
    ("/ \"radius\" Enter + k j + k j +", "undo"),
    ("/ \"radius\" Enter + k j + k j + u u u", "redo"),
    ("/ \"radius\" Enter + k j + k j + ", "earlier"),
    ("/ \"radius\" Enter + k j + k j + u u u", "later"),
    ("/ \"at\" Enter", "search next"),
    ("/ \"at\" Enter", "search previous"),
    ("", "search 25"),
    ("/ \"motion\" Enter / \"radius\" Enter / \"outline\" Enter", "jumps older"),
    ("/ \"motion\" Enter / \"radius\" Enter / \"outline\" Enter Ctrl-o Ctrl-o Ctrl-o", "jumps newer"),
    (": \"go layers.0.zones.0.motion.0\" Enter", "sibling next"),
    ("", "problem next"),
    ("?", "scroll 1"),
    ("? / \"row\" Enter", "scroll next"),
    ("g i", "cursor 1 1"),
    ("/ \"motion\" Enter Enter g i", "place next"),
    ("/ \"motion\" Enter Enter g i", "place previous"),
    ("", "clip next"),
    ("}", "clip previous"),
    ("", "pick next"),
    ("", "pick previous"),
    ("", "frame next"),
    ("", "frame previous"),
    ("", "speed slower"),
    ("", "speed faster"),
    ("g i", "zoom in"),
    ("g i + + +", "zoom out"),
    ("g i 1 0 0 l + + +", "pan left"),
    ("g i + + +", "pan right"),
    ("g i 1 0 0 j + + +", "pan up"),
    ("g i + + +", "pan down"),
    ("Space Space", "palette next"),
    ("Space Space Down Down Down", "palette previous"),
    ("/ \"radius\" Enter q a + q", "play-macro a"),
    ("/ \"radius\" Enter + ", "again"),
    ("", "view view-field"),
];

/// These go to a row, take so many rows, or round what is visible.
const USES: [&str; 12] = [
    "move first",
    "move last",
    "select",
    "yank",
    "duplicate",
    "paste",
    "add",
    "back",
    "leave",
    "cancel",
    "zoom",
    "pan",
];

#[test]
pub fn every_command_repeats_by_its_count_or_uses_it_or_refuses_it() {
    let mut seen = BTreeSet::new();
    for (keys, line) in COUNTED {
        let run = |times: usize, line: &str| {
            let mut state = match line.trim_start_matches("2 ").split(' ').next() {
                Some("clip" | "pick") => super::picking::looking(),
                Some("turn") => state_of(super::sketches::SCENE),
                _ if line.contains("problem") => state_of(super::told::TWO_PROBLEMS),
                _ => state(),
            };
            press(&mut state, keys);
            for _ in 0..times {
                // What can be done only once has nothing to repeat.
                let _ = obey(&mut state, line, None);
            }
            everything(&state)
        };
        let (once, twice, counted) = (run(1, line), run(2, line), run(1, &format!("2 {line}")));
        assert!(counted != once, "{keys} : {line} ignores its count");
        let used = USES.iter().any(|name| line.starts_with(name));
        assert!(counted == twice || used, "{line}:\n{counted}\n{twice}");
        let mut words = line.split(' ');
        seen.insert((words.next().unwrap(), words.next().unwrap_or_default()));
    }
    for command in commands::all() {
        let has = |word: &str| seen.contains(&(command.name, word));
        match command.counts {
            Counts::Always => {
                assert!(seen.iter().any(|(name, _)| *name == command.name), "no case for {}", command.name)
            }
            Counts::With(words) => {
                words.iter().for_each(|word| assert!(has(word), "no case for {} {word}", command.name));
            }
            Counts::Never => {}
        }
        // The words that take no count, if the command takes only words.
        let words = command.words().map_or(vec![""], |(words, _)| if words.is_empty() { vec![""] } else { words });
        let counted = |word: &&str| match command.counts {
            Counts::Always => true,
            Counts::With(with) => with.contains(word),
            Counts::Never => false,
        };
        for word in words.into_iter().filter(|word| !counted(word)) {
            let mut state = state();
            let line = format!("2 {} {word}", command.name);
            let refused = obey(&mut state, &line, None).unwrap_err();
            assert!(refused.contains("takes no count") || word.is_empty(), "{line}: {refused}");
            assert!(refused.starts_with(command.name) && state.scene.is_saved(), "{line}: {refused}");
        }
    }
}

#[test]
pub fn counts_of_rows_are_one_step_of_undo() {
    let still = json!({"tool": "point", "at": [20, 20], "jump": [0, -18]});
    check(&[
        (&motion("3 d"), &zone("/motion/0/tool"), json!("scale")),
        (&motion("9 d"), &zone("/motion"), json!([])),
        (&motion("3 d u"), &zone("/motion/2/tool"), json!("point")),
        ("2 d", "/layers/0/zones", json!([])),
        ("/ \"points\" Enter Enter o j 2 d", &zone("/outline/points"), json!([[10, 10], [30, 10], [10, 40]])),
        (&motion("3 o"), &zone("/motion/6/tool"), json!("scale")),
        (&motion("3 o u"), &zone("/motion/3/tool"), json!("scale")),
        ("2 o", "/layers/0/zones/3/name", json!("mouth")),
        (&motion("y 2 p"), &zone("/motion/2"), still.clone()),
        (&motion("y 2 p u"), &zone("/motion/3/tool"), json!("scale")),
        (&motion("2 y G p"), &zone("/motion/5/at"), json!([30, 25])),
        (&motion("2 y 2 p"), &zone("/motion/4/at"), json!([30, 25])),
        (&motion("l 2 v +"), &zone("/motion/1/at"), json!([31, 25])),
        ("/ \"images\" Enter Enter y 2 p", "/images/cat 3/path", json!("cat.png")),
        ("/ \"images\" Enter Enter 2 D", "/images/cat 3/path", json!("cat.png")),
        (&motion("3 Esc d"), &zone("/motion/2/tool"), json!("scale")),
        (&motion("v j 2 d"), &zone("/motion/0"), still),
    ]);
    for (keys, part) in [
        (motion("y 2 p"), "2 rows pasted"),
        (motion("v j 2 d"), "the selection says which rows"),
        (motion("l 9 9 9 9 9 9 9 9 +"), "a count is at most 1000000, not 99999999"),
        (motion(&format!("l {} j", "9 ".repeat(30))), "a count is at most 1000000, not"),
        ("/ \"outline\" Enter 2 d".into(), "a count needs items of a list"),
        ("/ \"fold\" Enter 2 o".into(), "several at a time"),
        ("3 ?".into(), "help takes no count"),
        ("3 : q".into(), "line takes no count"),
        (": \"2 render -o a.gif\" Enter".into(), "render takes no count"),
        (motion("l : \"2 cursor at 1 1\" Enter"), "cursor at takes no count"),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
fn unknown_words_are_refused_by_name() {
    for command in commands::all() {
        let Some((words, optional)) = command.words() else { continue };
        for text in ["nonsense", ""] {
            if text.is_empty() && optional {
                continue;
            }
            let mut state = state();
            let before = everything(&state);
            let why = obey(&mut state, &format!("{} {text}", command.name), None).unwrap_err();
            let refused = match text.is_empty() {
                true => why.starts_with(&format!("{} wants ", command.name)),
                false => why.starts_with(command.name) && why.ends_with("not \"nonsense\""),
            };
            assert!(refused, "{}: {why}", command.name);
            assert!(words.iter().all(|word| why.contains(word)), "{}: {why}", command.name);
            assert_eq!(everything(&state), before, "{}", command.name);
        }
    }
    for (keys, line) in [
        ("", "step foo"),
        (MOTION, "step foo"),
        ("/ \"function\" Enter Enter", "choice foo"),
        ("?", "scroll foo"),
        ("/ \"motion\" Enter Enter l i", "digit foo"),
        ("", "cursor foo"),
        ("", "view foo"),
        ("", "frame foo"),
        ("", "step-size foo"),
        ("", "undo foo"),
        ("", "earlier foo"),
        ("", "graphics foo"),
        ("", "vectors foo"),
        ("", "view vectors foo"),
        ("", "yank foo"),
        ("", "foo"),
    ] {
        let mut state = state();
        press(&mut state, keys);
        let before = everything(&state);
        let why = obey(&mut state, line, None).unwrap_err();
        assert!(why.contains("foo"), "{line}: {why}");
        assert_eq!(everything(&state), before, "{line}");
    }
}

#[test]
fn lists_end_where_they_end_and_take_counts_and_letters() {
    for (keys, word) in [
        ("", "sine"),
        ("k k", "exponential-inverse"),
        ("9 9 k", "linear"),
        ("9 9 j", "piecewise"),
        ("2 j", "cubic-bezier"),
        ("K", "keyframes"),
        ("c", "cosine"),
        ("c c", "cubic-bezier"),
        ("3 c", "cosine"),
        ("x", "sine"),
        ("3 Esc Enter", ""),
    ] {
        let mut state = state();
        press(&mut state, "/ \"function\" Enter Enter");
        press(&mut state, keys);
        let taken = match &state.typing.mode {
            Mode::Choice(choice) => choice.taken().unwrap_or_default().to_owned(),
            _ => String::new(),
        };
        assert_eq!(taken, word, "{keys}");
    }
}

#[test]
fn a_scene_that_is_only_looked_at_refuses_at_the_first_key() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    std::fs::write(&path, super::support::SCENE).unwrap();
    let open = || {
        let scene = OpenScene::open(&path, Open::ReadOnly, &crate::files::Options::default()).unwrap();
        State::new(scene, (80, 24), Depth::None)
    };
    for keys in [
        "/ \"name\" Enter Enter",
        "/ \"name\" Enter c",
        "/ \"function\" Enter Enter",
        "/ \"fold\" Enter o",
        "/ \"motion\" Enter Enter o",
        "R",
        "d",
        "g i s",
        "/ \"motion\" Enter Enter l +",
        ": \"put 5\" Enter",
        ": \"paste 5\" Enter",
    ] {
        let mut state = open();
        press(&mut state, keys);
        assert!(matches!(state.typing.mode, Mode::Normal), "{keys}");
        assert!(said_last(&state).1.contains("open read-only"), "{keys}: {:?}", said_last(&state));
    }
    let mut state = open();
    press(&mut state, "/ \"motion\" Enter Enter g i w");
    assert_eq!((state.cursor.row, said_last(&state).0), (1, false), "points are gone to");
    press(&mut state, "g t Backspace Enter");
    state.cursor.row = state.sheet().position(&zone("/outline")).unwrap();
    press(&mut state, "Enter");
    assert_eq!(state.cursor.node, zone("/outline"));
    assert!(!said_last(&state).0, "nodes are gone into: {:?}", said_last(&state));
}

#[test]
fn going_to_a_list_leads_to_its_rows_and_jumps_are_listed() {
    let mut state = state();
    press(&mut state, ": \"go layers.0.zones.0.motion\" Enter");
    assert_eq!((state.cursor.node.as_str(), state.cursor.focus), (zone("/motion").as_str(), Pane::Table));
    press(&mut state, "V");
    assert_eq!(state.cursor.selected_from, Some(0));
    press(&mut state, ": \"go layers.0.zones.1\" Enter");
    assert_eq!((state.cursor.node.as_str(), state.cursor.focus), ("/layers/0/zones/1", Pane::Tree));
    press(&mut state, ": \"jumps\" Enter");
    let Mode::Choice(choice) = &state.typing.mode else { panic!("no list: {:?}", said_last(&state)) };
    let places: Vec<&str> = choice.options.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(places, ["layers.face.zones.\"left eye\".motion.0", "layers.face.zones.\"left eye\".name"]);
    press(&mut state, "Enter");
    assert_eq!(state.cursor.node, zone("/motion/0"));
    let mut fresh = self::state();
    press(&mut fresh, ": \"jumps\" Enter");
    assert!(said_last(&fresh).1.contains("no jumps"));
    assert_eq!(replayed(&state).document().json(), state.document().json());
}

#[test]
fn handles_are_yanked_under_their_heads_and_pasted_back() {
    let nodes = json!([
        { "at": [10, 10], "in": [-3, 4], "out": [3, -4] },
        { "at": [50, 10] },
        { "at": [50, 40], "out": [1.5, 2] }
    ]);
    let mut state = state();
    let outline = json!({ "kind": "path", "nodes": nodes });
    obey(&mut state, &format!("set layers.0.zones.0.outline={outline}"), None).unwrap();
    press(&mut state, ": \"go layers.0.zones.0.outline.nodes\" Enter");
    let effects = press(&mut state, "V Y Esc");
    let csv = effects.iter().find_map(|effect| match effect {
        Effect::Copy(text) => Some(text.clone()),
        _ => None,
    });
    let csv = csv.unwrap();
    let shown = state.sheet().row(0).unwrap().cells.iter().map(|cell| cell.head.clone()).collect::<Vec<_>>();
    assert_eq!(csv.lines().next().unwrap().split(',').collect::<Vec<_>>(), shown);
    assert!(csv.starts_with("x,y,in dx,in dy,in r,in °,out dx,"), "{csv}");
    press(&mut state, "3 d");
    update(&mut state, Event::Paste(csv));
    let numbers = |value: Value| value.to_string().replace(".0", "");
    let back = numbers(at(&state, &zone("/outline/nodes")));
    assert!(
        back.contains(r#""in":[-3,4],"out":[3,-4]"#) && back.contains(r#""out":[1.5,2]"#),
        "{back}: {:?}",
        said_last(&state)
    );
}
