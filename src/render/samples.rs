//! Scenes in space for tests.

use std::sync::Arc;

use super::{Synth, synth};
use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::materials::Materials;
use crate::scene::Scene;

/// Two squares of 2 m seen from 4 m: `near` around the origin, and `far` 1 m behind it, half a meter to the right.
pub fn two_squares() -> (Scene, Synth) {
    let scene = r#"{ "plica": 1, "size": [60, 60], "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
        "meshes": {"m": {"path": "m.obj"}}, "layers": [{"kind": "mesh", "name": "near", "mesh": "m"},
        {"kind": "mesh", "name": "far", "mesh": "m", "pose": {"position": [0.5, 0, -1]}}] }"#;
    let scene: Scene = serde_json::from_str(scene).unwrap();
    let synth = synth(&scene, &square(), None).unwrap();
    (scene, synth)
}

/// The square, drawn with strokes.
pub fn square_with_strokes() -> (Arc<Scene>, Materials) {
    let scene = r#"{ "plica": 1, "size": [40, 30], "camera": {"position": [0, 0, 3], "target": [0, 0, 0]},
        "meshes": {"m": {"path": "m.obj"}},
        "layers": [{"kind": "mesh", "name": "own", "mesh": "m", "pose": {"rotate": [20, 30, 0]}, "strokes": {}}] }"#;
    (Arc::new(serde_json::from_str(scene).unwrap()), square())
}

/// Its mesh.
pub fn square() -> Materials {
    let corner = |[x, y]: [f64; 2]| Vertex { position: [x, y, 0.0].into(), ..Vertex::default() };
    let vertices = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner).to_vec();
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    Materials { meshes: [("m".to_owned(), Arc::new(mesh))].into(), ..Materials::default() }
}
