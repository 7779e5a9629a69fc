//! Conflicts about a scene: (files on the disk, keys, the result).

use std::path::PathBuf;

use super::support::{SCENE, press};
use crate::files::Options;
use crate::files::session::Mode as Open;
use crate::tui::commands::update::update;
use crate::tui::document::choice::Then;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::{Mode, State};
use crate::tui::text::color::Depth;

/// A scene on disk, with its journal.
struct Place {
    _folder: tempfile::TempDir,
    scene: PathBuf,
}

fn place() -> Place {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().canonicalize().unwrap().join("cat.plica.json");
    std::fs::write(&scene, SCENE).unwrap();
    Place { _folder: folder, scene }
}

impl Place {
    fn open(&self) -> State {
        let scene = OpenScene::open(&self.scene, Open::EditOrLook, &Options::default()).unwrap();
        State::new(scene, (80, 24), Depth::None)
    }

    /// Replaces `old` by `new` in the file, as another program would.
    fn outside(&self, state: &mut State, old: &str, new: &str) -> Vec<Effect> {
        let text = std::fs::read_to_string(&self.scene).unwrap();
        std::fs::write(&self.scene, text.replace(old, new)).unwrap();
        update(state, Event::FilesChanged(vec![self.scene.clone()]))
    }

    fn saved(&self) -> String {
        std::fs::read_to_string(&self.scene).unwrap()
    }
}

/// The open question: the words that answer it, and its text.
fn asked(state: &State) -> Option<(Vec<&str>, String)> {
    let Mode::Choice(choice) = &state.typing.mode else { return None };
    let Then::Answer(question) = &choice.then else { return None };
    Some((choice.options.iter().map(|(word, _)| word.as_str()).collect(), question.text.join("\n")))
}

fn save(state: &mut State, line: &str) -> Result<String, String> {
    let effects = press(state, &format!(": \"{line}\" Enter"));
    let Some(Effect::Save { to, overwrite, .. }) = effects.into_iter().next() else { panic!("{:?}", state.message) };
    let result = state.scene.save(to.as_deref(), overwrite).map_err(|error| error.to_string());
    update(state, Event::Saved(result.clone()));
    result
}

fn speed_now(state: &State) -> f64 {
    let pointer = "/layers/0/zones/0/speed";
    state.document().json().pointer(pointer).and_then(serde_json::Value::as_f64).unwrap_or(1.0)
}

#[test]
pub fn unsaved_edits_that_were_left_behind_are_told_in_words_and_offered() {
    for (keys, expected, depth) in [
        ("Enter", 3.0, 2),
        ("j Enter", 1.0, 3),
        ("Esc", 1.0, 0),
        ("Esc / \"speed\" Enter + : \"recovery\" Enter Enter", 3.0, 2),
        ("Esc : \"recovery keep\" Enter", 3.0, 2),
        ("Esc : \"recovery drop\" Enter", 1.0, 3),
    ] {
        let place = place();
        let mut state = place.open();
        press(&mut state, "/ \"speed\" Enter + j k +");
        drop(state);
        let mut state = place.open();
        let (words, text) = asked(&state).unwrap();
        assert_eq!(words, ["keep", "drop", "difference"]);
        assert!(text.contains("left eye · speed 1 → 3"), "{text}");
        press(&mut state, "j j Enter");
        assert!(matches!(&state.typing.mode, Mode::Pages(pages) if pages.lines[0].contains("speed")));
        press(&mut state, "q");
        assert!(asked(&state).is_some(), "asked again after a look");
        press(&mut state, "k k");
        press(&mut state, keys);
        assert_eq!((speed_now(&state), asked(&state).is_some()), (expected, false), "{keys}");
        if keys == "Esc" {
            assert!(state.scene.offered().is_some(), "not decided");
            continue;
        }
        let undone = (0..9).take_while(|_| state.scene.undo().is_some()).count();
        assert_eq!(undone, depth, "{keys}");
    }
}

#[test]
fn a_second_editor_is_told_and_looks_on() {
    let place = place();
    let mut first = place.open();
    let mut second = place.open();
    let (words, text) = asked(&second).unwrap();
    assert_eq!(words, ["look", "quit"]);
    assert!(text.contains("is being edited by") && text.contains(&std::process::id().to_string()), "{text}");
    let shown = super::screens::screen(&second);
    let words: Vec<&str> = shown.split(['│', '▾', ' ', '\n']).filter(|word| !word.is_empty()).collect();
    let told = words.join(" ");
    assert!(told.contains("opened just now)."), "{shown}");
    press(&mut second, "Enter");
    for keys in ["/ \"speed\" Enter +", "u", "Ctrl-r", ": \"set title=x\" Enter", ": \"w\" Enter", "g t d"] {
        press(&mut second, keys);
        let message = second.message.clone().unwrap();
        assert!(message.bad && message.text.contains("read-only"), "{keys}: {message:?}");
    }
    press(&mut first, "/ \"speed\" Enter +");
    save(&mut first, "w").unwrap();
    update(&mut second, Event::FilesChanged(vec![place.scene.clone()]));
    assert_eq!(speed_now(&second), 2.0);
    assert!(second.scene.is_saved());
    assert!(press(&mut second, ": \"q\" Enter").iter().any(|effect| matches!(effect, Effect::Quit)));
    let mut third = place.open();
    assert!(press(&mut third, "j Enter").iter().any(|effect| matches!(effect, Effect::Quit)), "quit");
    drop(first);
    assert!(asked(&place.open()).is_none(), "free again");
}

#[test]
pub fn what_another_program_writes_is_taken_in_merged_or_asked_about() {
    let radius = ("\"radius\": 60", "\"radius\": 61");
    let speed = ("\"cycles\": 0.5 }", "\"cycles\": 0.5 }, \"speed\": 7");
    // Keys before, what is written outside, keys after; then the speed, the radius, and whether a question came first.
    for (before, (old, new), after, expected, asks) in [
        ("", radius, "", (1.0, 61), false),
        ("", radius, "u", (1.0, 60), false),
        ("/ \"speed\" Enter +", radius, "", (2.0, 61), false),
        ("/ \"speed\" Enter +", radius, "u", (2.0, 60), false),
        ("/ \"speed\" Enter +", speed, "Enter", (2.0, 60), true),
        ("/ \"speed\" Enter +", speed, "j Enter", (7.0, 60), true),
        ("/ \"speed\" Enter +", speed, "j Enter u", (2.0, 60), true),
        ("/ \"speed\" Enter +", speed, "j j j Enter", (2.0, 60), true),
        ("/ \"speed\" Enter +", speed, "Esc : \"merge theirs\" Enter", (7.0, 60), true),
        ("/ \"speed\" Enter +", speed, "j j Enter q : \"choose mine\" Enter", (2.0, 60), true),
    ] {
        let place = place();
        let mut state = place.open();
        press(&mut state, before);
        place.outside(&mut state, old, new);
        let case = format!("{before} | {new} | {after}");
        assert_eq!(asked(&state).is_some(), asks, "{case}");
        if asks {
            let (_, text) = asked(&state).unwrap();
            assert_eq!(text, "left eye · speed 2 here, 7 in the file", "{case}");
        }
        press(&mut state, after);
        let found = state.document().json().pointer("/layers/0/zones/0/interpolation/radius").unwrap().as_i64();
        assert_eq!((speed_now(&state), found), (expected.0, Some(expected.1)), "{case}");
    }
}

#[test]
fn a_question_waits_until_nothing_else_goes_on_and_the_file_is_safe_meanwhile() {
    let place = place();
    let mut state = place.open();
    press(&mut state, "/ \"speed\" Enter + i \"5\"");
    place.outside(&mut state, "\"cycles\": 0.5 }", "\"cycles\": 0.5 }, \"speed\": 7");
    assert!(matches!(state.typing.mode, Mode::Entry(_)), "what is typed is not interrupted");
    press(&mut state, "Esc");
    assert!(asked(&state).is_some());
    press(&mut state, "Esc");
    let refused = save(&mut state, "w").unwrap_err();
    assert!(refused.contains(":merge") && refused.contains(":w!"), "{refused}");
    assert!(place.saved().contains("\"speed\": 7"));
    save(&mut state, "w!").unwrap();
    assert!(place.saved().contains("\"speed\": 2") && state.outside.file.is_none());
}

#[test]
fn a_file_that_is_gone_or_broken_leaves_the_last_good_state() {
    let place = place();
    let mut state = place.open();
    std::fs::write(&place.scene, "{ half").unwrap();
    update(&mut state, Event::FilesChanged(vec![place.scene.clone()]));
    let message = state.message.clone().unwrap();
    assert!(message.bad && message.text.contains("the scene here stays"), "{message:?}");
    assert_eq!(state.outside.file, Some("file unreadable"));
    let refused = save(&mut state, "w").unwrap_err();
    assert!(refused.contains(":w!") && !refused.contains(":merge"), "somebody may be mending it: {refused}");
    std::fs::remove_file(&place.scene).unwrap();
    update(&mut state, Event::FilesChanged(vec![place.scene.clone()]));
    assert!(state.message.clone().unwrap().text.contains(":w writes it again"));
    assert!(press(&mut state, ": \"q\" Enter").is_empty(), "it is not saved any more");
    save(&mut state, "w").unwrap();
    assert!(place.saved().contains("left eye") && state.outside.file.is_none() && state.scene.is_saved());
}
