//! The tutor: the keys of each lesson complete it, and not before the last of them.

use super::support::press;
use crate::files::Options;
use crate::files::materials;
use crate::files::profiles::TUTOR;
use crate::files::session::Mode as Open;
use crate::render::{self, cpu};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::keys::Keymap;
use crate::tui::state::State;
use crate::tui::state::tutor::Tutor;
use crate::tui::text::color::Depth;
use crate::tui::tutor::lessons::LESSONS;

/// The tutor's scene with its first lesson.
fn begun() -> (tempfile::TempDir, State) {
    let folder = tempfile::tempdir().unwrap();
    let scene = TUTOR.unpack(folder.path()).unwrap();
    let scene = OpenScene::open(&scene, Open::Edit, &Options::default()).unwrap();
    let mut state = State::new(scene, (80, 24), Depth::None);
    state.picture.size = Some((480, 360));
    state.tutor = Some(Tutor::begin());
    (folder, state)
}

/// Performs effects as the editor would, as far as lessons depend on them.
fn perform(state: &mut State, effects: Vec<Effect>) {
    for effect in effects {
        match effect {
            Effect::Save { overwrite, .. } => {
                let result = state.scene.save(None, overwrite).map_err(|error| error.to_string());
                update(state, Event::Saved(result));
            }
            Effect::Run(words) => {
                state.outside.work = Some(words[0].clone());
                update(state, Event::Done(Ok("line\nline".into())));
            }
            _ => {}
        }
    }
}

fn at(state: &State) -> usize {
    state.tutor.as_ref().map_or(0, |tutor| tutor.at)
}

/// Checks that the line of the closed lid is dark from one corner of the eye to the other, with nothing below it.
fn lid_is_closed(state: &State) {
    let scene = state.document().scene();
    let loaded = materials::load(state.scene.path(), scene, &Options::default(), &mut materials::Cache::default());
    let frame = cpu::frame(&render::synth(scene, &loaded.unwrap().0, None).unwrap(), 0.5);
    let dark = |x: usize, y: usize| frame.get(x, y)[..3].iter().map(|c| u32::from(*c)).sum::<u32>() < 200;
    for x in 126..213 {
        let rows: Vec<usize> = (170..240).filter(|&y| dark(x, y)).collect();
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else { panic!("the line has a gap at {x}") };
        assert!(last - first < 12, "{x}: dark from {first} to {last}");
    }
}

#[test]
fn every_lesson_is_done_by_its_keys() {
    let (_folder, mut state) = begun();
    for (i, lesson) in LESSONS[..LESSONS.len() - 1].iter().enumerate() {
        assert_eq!(at(&state), i, "{}", lesson.title);
        for press_ in lesson.keys {
            assert!(!(lesson.done)(&state), "{} is done before {press_:?}", lesson.title);
            let label = press_.label(&state.keymap);
            assert!(!label.starts_with(':') || label == ":", "{press_:?} of {} has no key", lesson.title);
            let effects = press(&mut state, &label);
            perform(&mut state, effects);
            let bad = state.message.as_ref().is_some_and(|message| message.bad);
            assert!(!bad, "{}: {press_:?}: {:?}", lesson.title, state.message);
        }
        assert_eq!(at(&state), i + 1, "{} is not done by its keys: {:?}", lesson.title, state.message);
    }
    lid_is_closed(&state);
    assert!(press(&mut state, "Esc Esc : \"q\" Enter").iter().any(|effect| matches!(effect, Effect::Quit)));
}

#[test]
fn lessons_fit_the_smallest_screen() {
    let keymap = Keymap::default();
    for lesson in LESSONS {
        let keys: usize = lesson.keys.iter().map(|press| press.label(&keymap).chars().count() + 2).sum();
        let wide = lesson.text.iter().map(|line| line.chars().count()).max().unwrap();
        assert!(lesson.text.len() <= 3 && wide <= 76 && keys <= 68, "{}: {wide} {keys}", lesson.title);
    }
}

#[test]
pub fn lessons_are_gone_through_by_command() {
    let (_folder, mut state) = begun();
    for (line, expected) in [("next", 1), ("next", 2), ("back", 1), ("back", 0), ("back", 0)] {
        press(&mut state, &format!(": \"tutor {line}\" Enter"));
        assert_eq!(at(&state), expected, "{line}");
    }
    // A lesson that was done before stays until it is done again.
    let keys: Vec<String> = LESSONS[0].keys.iter().map(|press| press.label(&state.keymap)).collect();
    for key in keys {
        press(&mut state, &key);
    }
    assert_eq!(at(&state), 1);
    press(&mut state, ": \"tutor back\" Enter");
    assert_eq!(at(&state), 0, "looked at again");
    press(&mut state, ": \"tutor quit\" Enter");
    assert!(state.tutor.is_none());
    assert!(press(&mut state, "Space T").iter().any(|effect| matches!(effect, Effect::Tutor)));
    press(&mut state, ": \"set title=x\" Enter Space T");
    assert!(state.message.clone().unwrap().bad, "not over unsaved edits");
}
