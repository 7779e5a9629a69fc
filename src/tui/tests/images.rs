//! `:image edit`: which picture is opened, and which is not.

use super::support::state_of;
use crate::tui::commands::run;
use crate::tui::events::Effect;

#[test]
pub fn a_picture_of_the_scene_is_opened_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cat.png"), "").unwrap();
    let two = r#"{"plica": 1, "images": {"cat": {"path": "cat.png"}, "dog": {"path": "dog.png"}}}"#;
    for (scene, line, part) in [
        (two, "image edit", "which picture: cat, dog"),
        (two, "image edit cow", "no picture cow: cat, dog"),
        (two, "image edit dog", "no such file"),
        (two, "image", "image edit NAME"),
        (r#"{"plica": 1}"#, "image edit cat", "the scene has no pictures"),
    ] {
        let mut state = state_of(scene);
        run(&mut state, line, None);
        let said = state.message.as_ref().map_or("", |message| &message.text);
        assert!(said.contains(part) && state.effects.is_empty(), "{line}: {said}");
    }
    let scene = folder.path().join("s.plica.json");
    std::fs::write(&scene, r#"{"plica": 1, "images": {"cat": {"path": "cat.png"}}}"#).unwrap();
    for line in ["image edit", "image edit cat"] {
        let scene = crate::tui::document::open_scene::OpenScene::in_memory(&scene);
        let mut state = crate::tui::state::State::new(scene, (80, 24), crate::tui::text::color::Depth::None);
        run(&mut state, line, None);
        let asked = state.effects.pop_front();
        assert!(matches!(&asked, Some(Effect::EditImage { path, after: None }) if path.ends_with("cat.png")), "{line}");
    }
}
