//! What is in space, in forms and under the window's pointer: what is not written stands there and is changed number by number.

use std::sync::Arc;

use glam::DVec3;
use serde_json::json;

use super::support::{at, press, said, said_last, state_of};
use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::materials::Materials;
use crate::preview::wire::message::Gesture;
use crate::render;
use crate::tui::commands::update::update;
use crate::tui::state::State;

const SCENE: &str = r##"{
  "plica": 1, "camera": { "keys": [{ "at": 0 }, { "at": 0.5, "fov": 20 }], "position": [0, 0, 4], "target": [0, 0, 0] },
  "meshes": { "m": { "path": "m.obj" } },
  "layers": [
    { "kind": "fill", "name": "face", "color": "#102030" },
    { "kind": "mesh", "name": "m", "mesh": "m", "surface": { "kind": "layer", "layer": "face" } }
  ]
}"##;

fn run(state: &mut State, line: &str) {
    press(state, &format!(": \"{line}\" Enter"));
}

#[test]
fn one_number_of_what_is_not_written_keeps_the_others_as_they_stand() {
    for (lines, pointer, expected) in [
        (&["set camera.keys.1.position.x=1"][..], "/camera/keys/1/position", json!([1, 0, 4])),
        (&["go camera.keys.1.target", "put 3"], "/camera/keys/1/target", json!([3, 0, 0])),
        (&["set size.x=300"], "/size", json!([300, 720])),
        (&["go size", "put 300"], "/size", json!([300, 720])),
    ] {
        let mut state = state_of(SCENE);
        lines.iter().for_each(|line| run(&mut state, line));
        assert_eq!(at(&state, pointer), expected, "{lines:?}: {:?}", state.message);
    }
}

#[test]
fn a_layer_is_renamed_everywhere_and_not_deleted_while_it_is_shown() {
    for line in ["rename mask", "set layers.0.name=mask"] {
        let mut state = state_of(SCENE);
        run(&mut state, "go layers.0");
        run(&mut state, line);
        assert_eq!(at(&state, "/layers/1/surface/layer"), json!("mask"), "{line}: {:?}", state.message);
        press(&mut state, "u");
        assert_eq!(at(&state, "/layers/1/surface/layer"), json!("face"), "one step of undo");
    }
    let mut state = state_of(SCENE);
    run(&mut state, "go layers.0");
    run(&mut state, "delete");
    let told = "face is used by layers.m.surface.layer: choose another layer there first";
    assert_eq!(said_last(&state), (true, told.into()));
}

#[test]
fn a_click_on_a_mesh_goes_to_its_layer() {
    let mut state = state_of(SCENE);
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices = corners.map(|at| Vertex { position: DVec3::from(at), ..Vertex::default() }).to_vec();
    let mesh = Arc::new(Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() });
    let materials = Materials { meshes: [("m".to_owned(), mesh)].into(), ..Materials::default() };
    state.picture.synth = Some(Arc::new(render::synth(state.document().scene(), &materials, None).unwrap()));
    state.picture.size = Some((1280, 720));
    for (x, expected) in [(640.0, "/layers/1"), (20.0, "/layers/0")] {
        run(&mut state, "go layers.0");
        update(&mut state, said(Gesture::Pointer { x, y: 400.0 }));
        update(&mut state, said(Gesture::Command("select-point".into())));
        assert!(state.focused().starts_with(expected), "{}: {:?}", state.focused(), state.message);
    }
}
