//! The scene's camera from the editor: what a window shows, a key, all meshes in the frame.

use std::sync::Arc;

use glam::DVec3;
use serde_json::{Value, json};

use super::support::{press, said, state, state_of};
use crate::base::mesh::{Mesh, Vertex};
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use crate::layers::space::camera::Camera;
use crate::preview::editor::{self, Silent};
use crate::preview::wire::message::Gesture;
use crate::render;
use crate::scene::check as scene;
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event, Synthesis};
use crate::tui::state::State;
use crate::tui::text::color::Depth;

const SCENE: &str = r#"{
  "plica": 1, "size": [200, 100], "camera": { "turn": 90, "fov": 30 },
  "meshes": { "m": { "path": "m.obj" } },
  "layers": [{ "kind": "mesh", "name": "m", "mesh": "m", "pose": { "position": [5, 0, 0], "spin": 360 } }]
}"#;

fn run(state: &mut State, line: &str) -> String {
    press(state, &format!(": \"{line}\" Enter"));
    state.message.as_ref().map(|message| message.text.clone()).unwrap_or_default()
}

/// That all windows have answered.
fn answer() -> Event {
    Event::Window(editor::Event::Answered(Silent { windows: Vec::new(), of: 1 }))
}

/// What a line says that asks the windows, of which these of so many are silent.
fn asked(state: &mut State, line: &str, (windows, of): (&[usize], usize)) -> String {
    run(state, line);
    update(state, Event::Window(editor::Event::Answered(Silent { windows: windows.to_vec(), of })));
    state.message.as_ref().map(|message| message.text.clone()).unwrap_or_default()
}

fn camera(state: &State) -> Value {
    state.document().json()["camera"].clone()
}

fn own() -> Camera {
    Camera { position: [1.0, 2.0, 3.0000000004], target: [0.0, 0.5, 0.0], fov: 50.0, ..Camera::default() }
}

#[test]
fn the_windows_camera_is_taken_and_what_is_lost_is_told() {
    let mut state = state_of(SCENE);
    let told = run(&mut state, "camera take");
    assert!(told.starts_with("there is no window"), "{told}");
    state.outside.window = "window".into();
    update(&mut state, said(Gesture::Camera(Some(own()))));
    let told = asked(&mut state, "camera take", (&[], 1));
    assert!(told.contains("without its turn"), "{told}");
    let taken = json!({ "position": [1, 2, 3], "target": [0, 0.5, 0], "fov": 50 });
    assert_eq!(camera(&state), taken);
    press(&mut state, "u");
    assert_eq!(camera(&state), json!({ "turn": 90, "fov": 30 }), "one step of undo");
    update(&mut state, said(Gesture::Camera(None)));
    let told = asked(&mut state, "camera take", (&[], 1));
    assert!(told.starts_with("the window moved last shows"), "it is back at the scene's: {told}");
}

#[test]
fn what_the_window_has_not_told_is_waited_for() {
    let mut state = state_of(SCENE);
    state.outside.window = "window".into();
    let before = camera(&state);
    let effects = update(&mut state, Event::Line("camera take".into()));
    assert!(matches!(effects.as_slice(), [Effect::Ask]), "{effects:?}");
    assert_eq!((camera(&state), state.outside.work.is_some()), (before.clone(), true));
    update(&mut state, said(Gesture::Camera(Some(own()))));
    update(&mut state, answer());
    assert_eq!((camera(&state)["fov"].clone(), state.outside.work.is_some()), (json!(50), false));
    press(&mut state, "u");
    for (silent, expected) in [
        ((&[1][..], 1), "the window did not tell where it looks from: try again"),
        ((&[2], 2), "number 2 of 2 windows, in the order in which they joined, did not tell"),
        ((&[1, 3], 3), "number 1 and 3 of 3 windows"),
    ] {
        let told = asked(&mut state, "camera take", silent);
        assert!(told.starts_with(expected), "{told}");
    }
    run(&mut state, "camera take");
    press(&mut state, "Esc");
    update(&mut state, answer());
    assert_eq!((camera(&state), state.outside.work.is_some()), (before, false), "Esc ends the asking");
}

#[test]
fn what_is_typed_while_the_window_is_asked_comes_after_it() {
    let mut state = state_of(SCENE);
    state.outside.window = "window".into();
    state.play.time = 0.25;
    run(&mut state, "camera key");
    state.play.time = 0.75;
    update(&mut state, said(Gesture::Camera(Some(own()))));
    update(&mut state, Event::Line("set camera.fov=20".into()));
    assert!(update(&mut state, Event::Line("wq".into())).is_empty(), "nothing is saved before it");
    let effects = update(&mut state, answer());
    assert_eq!((camera(&state)["keys"][0]["at"].clone(), camera(&state)["fov"].clone()), (json!(0.25), json!(20)));
    assert!(matches!(effects.last(), Some(Effect::Save { leave: true, .. })), "{effects:?}");
}

#[test]
fn a_key_shows_at_its_time_what_the_window_shows() {
    let mut state = state_of(SCENE);
    state.play.time = 0.5;
    update(&mut state, said(Gesture::Camera(Some(own()))));
    assert!(run(&mut state, "camera key").contains("stands still"));
    let ([position, target, _], fov) = state.document().scene().camera.clone().unwrap().view(0.5);
    assert!((position - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-5, "the turn is not done twice: {position}");
    assert_eq!((target, fov), (DVec3::new(0.0, 0.5, 0.0), 50.0));
    update(&mut state, said(Gesture::Camera(None)));
    state.play.time = 0.25;
    run(&mut state, "camera key");
    run(&mut state, "camera key");
    let keys = state.document().scene().camera.clone().unwrap().keys;
    assert_eq!(keys.iter().map(|key| key.at).collect::<Vec<_>>(), [0.25, 0.5], "in order, each time once");
}

#[test]
fn all_meshes_are_seen_at_all_times() {
    let mut state = state_of(SCENE);
    let told = run(&mut state, "camera fit");
    assert!(told.contains("no such file"), "{told}");
    let corners = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
    let vertices = corners.map(|at| Vertex { position: DVec3::from(at), ..Vertex::default() }).to_vec();
    let mesh = Arc::new(Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() });
    let materials = Materials { meshes: [("m".to_owned(), mesh)].into(), ..Materials::default() };
    state.picture.synth = Some(Arc::new(render::synth(state.document().scene(), &materials, None).unwrap()));
    let told = run(&mut state, "camera fit");
    assert!(told.starts_with("the camera sees all that is in space"), "{told}");
    let fitted = state.document().scene().camera.clone().unwrap();
    assert_eq!((fitted.target[0], fitted.turn, fitted.fov), (5.0, 0.0, 30.0));
    let back = DVec3::from(fitted.position) - DVec3::from(fitted.target);
    assert!((back.normalize() - DVec3::new(0.0, 0.4, 4.0).normalize()).length() < 1e-4, "from where it was: {back}");
    let eye = fitted.at(0.0, (200, 100));
    for at in [[4.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 0.0, 1.0], [5.0, 0.0, -1.0], [5.0, 3.0, 0.0]] {
        let seen = eye.project(eye.seen(DVec3::from(at)));
        assert!(seen.x > 0.0 && seen.x < 200.0 && seen.y > 4.9 && seen.y < 95.1, "{at:?} at {seen}");
    }
    let top = eye.project(eye.seen(DVec3::new(5.0, 3.0, 0.0)));
    assert!((top.y - 5.0).abs() < 0.01, "it fills the frame: {top}");
    let before = state.document().to_text();
    let told = run(&mut state, "camera fit");
    assert!(told.starts_with("nothing changes"), "{told}");
    assert_eq!(state.document().to_text(), before);
}

#[test]
fn a_scene_without_a_mesh_gets_the_camera_that_a_mesh_layer_asks_for() {
    let mut state = state();
    assert!(run(&mut state, "camera key").starts_with("the scene has no camera"));
    assert_eq!(run(&mut state, "camera"), "camera wants take, key or fit");
    run(&mut state, "camera fit");
    assert_eq!(state.document().scene().camera, Some(Camera::default()));
}

#[test]
fn meshes_are_seen_before_anything_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.plica.json");
    let obj = "v -1 0 5\nv 1 0 5\nv 0 2 5\nf 1 2 3\n";
    std::fs::write(folder.path().join("m.obj"), obj).unwrap();
    let layer = |scale| format!(r#"{{ "kind": "mesh", "name": "m", "mesh": "m", "pose": {{ "scale": {scale} }} }}"#);
    let (fitted, unshown) =
        ("the camera sees all that is in space", "the camera sees all meshes, but no layer shows one");
    for (own, layers, expected) in [
        ("", String::new(), unshown),
        (r#""camera": {},"#, layer(2), fitted),
        (r#""camera": {},"#, layer(0), "nothing of the mesh \"m\" is seen: its scale is 0 (make scale 1)"),
    ] {
        let scene =
            format!(r#"{{ "plica": 1, {own} "meshes": {{ "m": {{ "path": "m.obj" }} }}, "layers": [{layers}] }}"#);
        std::fs::write(&path, scene).unwrap();
        let mut state = State::new(OpenScene::in_memory(&path), (80, 24), Depth::None);
        let told = run(&mut state, "camera fit");
        assert!(told.starts_with(expected), "{told}");
        assert_eq!(
            camera(&state)["target"][0] == json!(0),
            expected == fitted || expected == unshown,
            "{}",
            camera(&state)
        );
        assert_eq!(camera(&state).get("up"), None);
    }
}

#[test]
fn a_file_that_is_missing_from_the_start_is_told_and_found() {
    let mut state = state_of(SCENE);
    let problem = Problem::error("/meshes/m/path", "m.obj: there is no such file");
    update(&mut state, Event::Synthesised(Box::new(Err(problem))));
    let told = state.message.clone().unwrap();
    assert!(told.bad && told.text.contains("meshes.m.path") && told.text.contains("no such file"), "{}", told.text);
    press(&mut state, "g d");
    assert_eq!(state.focused(), "/meshes/m/path");
}

#[test]
fn a_warning_of_the_start_is_told_and_fails_no_line() {
    let mut state = state_of(SCENE);
    let warning = Some(Problem::warning("/meshes/m/path", "m.obj: has no normals"));
    let made = Synthesis { synth: Arc::new(render::Synth::default()), ms: 1.0, longest: Vec::new(), warning };
    update(&mut state, Event::Synthesised(Box::new(Ok(made))));
    let told = state.message.clone().unwrap();
    assert!(!told.bad && told.text.contains("meshes.m.path"), "{}", told.text);
}

#[test]
fn a_scene_in_space_opens_without_a_camera_and_gets_one_that_sees_it() {
    let falls = r#"{ "plica": 1, "size": [200, 100], "clips": { "w": { "path": "w-%04d.png" } }, "layers": [
        { "kind": "waterfall", "name": "falls", "clip": "w", "lip": [{ "at": [50, 4, 0] }] }] }"#;
    let mut state = state_of(falls);
    let problem = scene::check_materials(state.document().scene(), &Materials::default()).pop().unwrap();
    assert!(problem.to_string().contains("set camera={}"), "{problem}");
    update(&mut state, Event::Synthesised(Box::new(Err(problem))));
    assert!(state.message.clone().unwrap().text.contains("no camera"));
    let told = run(&mut state, "camera fit");
    assert!(told.starts_with("the camera sees all that is in space"), "no clip is needed: {told}");
    let fitted = state.document().scene().camera.clone().unwrap();
    let eye = fitted.at(0.0, (200, 100));
    for at in [[50.0, 4.0, 0.0], [50.0, 0.0, 0.5]] {
        let seen = eye.project(eye.seen(DVec3::from(at)));
        assert!(seen.x > 0.0 && seen.x < 200.0 && seen.y > 0.0 && seen.y < 100.0, "{at:?} at {seen}");
    }
    let mut state = state_of(falls);
    run(&mut state, "set camera={}");
    assert_eq!(state.document().scene().camera, Some(Camera::default()));
}

#[test]
fn other_keys_show_what_they_showed() {
    let keys = r#""keys": [{ "at": 0.2, "position": [3, 1, 4] }, { "at": 0.7, "position": [1, 2, 5], "fov": 20 }]"#;
    let mut state = state_of(&SCENE.replace(r#""fov": 30"#, &format!(r#""fov": 30, {keys}"#)));
    let views = |state: &State| [0.2, 0.7].map(|t| state.document().scene().camera.as_ref().unwrap().view(t));
    let before = views(&state);
    state.outside.window = "window".into();
    update(&mut state, said(Gesture::Camera(Some(own()))));
    run(&mut state, "time 0.5");
    assert_eq!(asked(&mut state, "camera key", (&[], 1)), "the camera has a key at 0.5");
    assert_eq!(camera(&state)["keys"].as_array().map(Vec::len), Some(3));
    for ((places, fov), (places_before, fov_before)) in views(&state).into_iter().zip(before) {
        assert!(fov == fov_before && places.iter().zip(places_before).all(|(a, b)| a.distance(b) < 1e-6));
    }
}
