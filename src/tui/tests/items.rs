//! Adding and renaming: lists, pictures, paths.

use serde_json::{Value, json};

use super::support::{press, said_last, state, state_of};
use super::{check, motion, zone};
use crate::scene::field::{self, Kind};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::color::Depth;

#[test]
pub fn pictures_and_names_come_and_go() {
    let images = "/ \"images\" Enter Enter";
    check(&[
        (&format!("{images} o \"art/dog.jpg\" Enter"), "/images/dog/path", json!("art/dog.jpg")),
        (&format!("{images} o \"art/cat.jpg\" Enter"), "/images/cat 2/path", json!("art/cat.jpg")),
        (&format!("{images} o \"dog.png\" Esc"), "/images/dog", Value::Null),
        (": \"add falls/%04d.jpg\" Enter", "/clips/falls", json!({ "path": "falls/%04d.jpg" })),
        (": \"add late/%04d.jpg\" Enter", "/clips/late/first", json!(7)),
        (": \"add nosuch/%04d.jpg\" Enter", "/clips", Value::Null),
        (": \"add b/fire-%d.png\" Enter", "/clips/fire/path", json!("b/fire-%d.png")),
        (": \"add a.%d.png\" Enter R Ctrl-w \"c\" Enter", "/layers/1/name", json!("c")),
        (": \"add b/fire.MP4\" Enter", "/clips/fire/path", json!("b/fire.MP4")),
        (": \"add 100%.png\" Enter", "/images/100%/path", json!("100%.png")),
        (&format!("{images} o \"dog.png\" Enter d"), "/images/dog", Value::Null),
        (&format!("{images} d"), "/images/cat/path", json!("cat.png")),
        (&format!("{images} R Ctrl-w \"tom\" Enter"), "/layers/0/image", json!("tom")),
        (&format!("{images} D : \"rename cat\" Enter"), "/images/cat 2/path", json!("cat.png")),
        (&format!("{images} i \"x.png\" Enter"), "/images/cat/path", json!("x.png")),
        ("R Ctrl-u \"rename right eye\" Enter", &zone("/name"), json!("right eye")),
        ("o", "/layers/0/zones/1/outline/kind", json!("rectangle")),
        ("o", "/layers/0/zones/1/name", json!("zone")),
    ]);
    for (keys, words) in [
        (format!("{images} d"), "cat is used by layers.face.image: choose another"),
        (format!("{images} D : \"rename cat\" Enter"), "there is already an image \"cat\""),
        (motion("R"), "this has no name"),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).0 && said_last(&state).1.starts_with(words), "{keys}: {}", said_last(&state).1);
    }
}

#[test]
fn what_is_broken_is_not_added_and_what_a_file_is_its_content_tells() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("s.plica.json"), r#"{ "plica": 1, "layers": [] }"#).unwrap();
    let mut state = State::new(OpenScene::in_memory(&at("s.plica.json")), (80, 24), Depth::None);
    std::fs::create_dir_all(at("falls")).unwrap();
    image::RgbaImage::new(2, 2).save(at("cat.png")).unwrap();
    for name in ["cat.obj", "falls/3.png", "falls/4.png", "the cat.png"] {
        std::fs::copy(at("cat.png"), at(name)).unwrap();
    }
    let models = [
        ("nan.obj", "v 0 0 nan\nf 1 1 1\n"),
        ("none.obj", "v 0 0 0\n"),
        ("hello.glb", "hello"),
        ("broken.png", "\u{89}PNG"),
        ("empty.obj", ""),
        ("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n"),
    ];
    models.iter().for_each(|(name, text)| std::fs::write(at(name), text).unwrap());
    for (path, bad, part, pointer) in [
        ("nan.obj", true, "line 1: \"nan\" is not a finite number", ""),
        ("none.obj", true, "has no triangles", ""),
        ("hello.glb", true, "is not a mesh", ""),
        ("broken.png", true, "broken.png: ", ""),
        ("empty.obj", true, "is empty", ""),
        ("no.mp4", false, "no.mp4 is among the clips; there is no file", "/clips/no"),
        ("no.obj", false, "there is no file", "/meshes/no"),
        ("[1]", true, ":set PATH.-=VALUE", ""),
        ("cat.obj", true, "is a PNG picture, not a mesh", ""),
        ("cat.png", false, "the image \"cat\" is among the images, and the layer \"cat\" shows it", "/images/cat"),
        ("cat.png", false, "and the layer \"cat 2\" shows it", "/layers/1/image"),
        ("tri.obj", false, "its points and lines are not drawn", "/meshes/tri"),
        ("the cat.png", false, "the image \"the cat\" is among the images", "/images/the cat"),
        ("the dog.png", true, "a path with spaces needs double quotes", ""),
        ("falls", false, "the clip \"falls\" is among the clips, and the layer \"falls\" shows it", "/clips/falls"),
    ] {
        let before = state.document().json().clone();
        press(&mut state, &format!(": \"add {path}\" Enter"));
        let (is_bad, told) = said_last(&state);
        assert!(is_bad == bad && told.contains(part), "{path}: {told}");
        match pointer {
            "" => assert_eq!(state.document().json(), &before, "{path}"),
            pointer => assert!(state.document().json().pointer(pointer).is_some(), "{path}: {told}"),
        }
    }
    assert_eq!(super::support::at(&state, "/clips/falls"), json!({ "path": "falls/%d.png", "first": 3 }));
}

#[test]
fn what_is_in_another_folder_is_copied_as_new_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    ["in", "out", "out/falls"].iter().for_each(|name| std::fs::create_dir(at(name)).unwrap());
    std::fs::write(at("in/s.plica.json"), r#"{ "plica": 1, "layers": [] }"#).unwrap();
    std::fs::write(at("in/dog.png"), "another").unwrap();
    image::RgbaImage::new(2, 2).save(at("out/cat.png")).unwrap();
    for name in ["dog.png", "falls/3.png", "falls/4.png"] {
        std::fs::copy(at("out/cat.png"), at("out").join(name)).unwrap();
    }
    std::fs::write(at("out/tri.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let mut state = State::new(OpenScene::in_memory(&at("in/s.plica.json")), (80, 24), Depth::None);
    let far = at("out/cat.png");
    for (path, pointer, expected, copy) in [
        ("../out/tri.obj", "/meshes/tri", json!({ "path": "tri.obj" }), "in/tri.obj"),
        ("../out/falls", "/clips/falls", json!({ "path": "falls/%d.png", "first": 3 }), "in/falls/4.png"),
        (far.to_str().unwrap(), "/images/cat", json!({ "path": "cat.png" }), "in/cat.png"),
    ] {
        press(&mut state, &format!(": \"add {path}\" Enter"));
        let (is_bad, told) = said_last(&state);
        assert!(!is_bad && told.ends_with("; copied beside the scene"), "{path}: {told}");
        assert_eq!(super::support::at(&state, pointer), expected, "{path}");
        assert!(at(copy).exists(), "{copy}");
    }
    press(&mut state, ": \"add ../out/dog.png\" Enter");
    assert!(said_last(&state).0 && said_last(&state).1.contains("is there already"), "{:?}", said_last(&state));
    assert_eq!(super::support::at(&state, "/images/dog"), Value::Null);
    assert_eq!(std::fs::read(at("in/dog.png")).unwrap(), b"another");
}

#[test]
fn paths_are_asked_for_and_completed() {
    let beside = |state: &State| state.scene.path().parent().map(std::path::Path::to_owned);
    for (keys, name, path, relative) in [
        ("/ \"images\" Enter o \"ca\" Tab", "add", "ca", true),
        (": \"w a/\" Tab", "w", "a/", false),
        (": \"e x\" Tab", "e", "x", false),
    ] {
        let mut state = state();
        let effects = press(&mut state, keys);
        let Some(Effect::Complete { name: asked, path: typed, beside: folder }) = effects.last() else {
            panic!("{keys}")
        };
        let folder_wanted = if relative { beside(&state) } else { None };
        assert_eq!((asked.as_str(), typed.as_str(), folder.clone()), (name, path, folder_wanted), "{keys}");
        update(&mut state, Event::Completed(vec![format!("{name} one"), format!("{name} two")]));
        press(&mut state, "Tab");
        assert!(matches!(&state.typing.mode, Mode::Line(line) if line.text.value() == format!("{name} two")), "{keys}");
    }
}

#[test]
fn every_list_of_the_schema_can_be_added_to() {
    let whole = state_of(include_str!("../../../tests/scenes/good/everything.json")).document().clone();
    let mut open = vec![String::new()];
    let mut seen = std::collections::BTreeSet::new();
    let mut state = state_of(&whole.to_text());
    while let Some(pointer) = open.pop() {
        open.extend(field::children(&whole, &pointer).into_iter().map(|child| child.pointer));
        let field = field::field(&whole, &pointer).unwrap();
        let list = matches!(field.kind, Kind::List(_) | Kind::Map(_)) && field::is_there(&whole, &pointer);
        if !list || !seen.insert(format!("{} {:?}", field.name, field.kind)) {
            continue;
        }
        state.show(pointer.clone());
        (state.cursor.focus, state.typing.mode) = (Pane::Table, Mode::Normal);
        press(&mut state, "o");
        let (bad, text) = said_last(&state);
        let told = bad && text.contains("expected 2 items");
        let asked = matches!(state.typing.mode, Mode::Line(_));
        assert!(asked || told || !state.scene.is_saved() && !bad, "{pointer}: {text}");
        while !state.scene.is_saved() {
            press(&mut state, "u");
        }
    }
    assert!(seen.len() > 10, "{seen:?}");
}

#[test]
fn windows_are_told_of_a_new_row_that_is_selected() {
    let mut state = state();
    press(&mut state, "/ \"motion\" Enter Enter");
    let before = state.focused();
    let effects = press(&mut state, "o");
    assert_ne!(state.focused(), before);
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Show)));
}
