//! Tests of this room as a whole, on two scenes: a small one, and one with every kind of thing.

mod edits;
mod fields;
mod reread;
mod undo;

use super::field::{Field, Kind, children};
use super::history::Stamp;
use super::*;
use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::materials::Materials;

fn squint() -> Document {
    Document::parse(include_str!("../../../tests/scenes/good/squint.plica.json")).unwrap()
}

fn everything() -> Document {
    Document::parse(include_str!("../../../tests/scenes/good/everything.json")).unwrap()
}

/// Every place in a document below the root, including those that are not written.
fn places(document: &Document) -> Vec<(String, Field)> {
    let mut found = Vec::new();
    let mut open = vec![String::new()];
    while let Some(pointer) = open.pop() {
        for child in children(document, &pointer) {
            open.push(child.pointer.clone());
            found.push((child.pointer, child.field));
        }
    }
    found
}

#[test]
fn a_limit_is_told_at_the_outline_that_exceeds_it() {
    let region = |radius: f64| serde_json::json!({ "kind": "ellipse", "center": [9, 9], "radii": [radius, radius] });
    let json = serde_json::json!({
        "plica": 1, "images": { "cat": { "path": "cat.png" } },
        "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": [{
            "name": "all", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 },
            "fold": { "rule": "cover", "regions": [region(8.0), region(9.0), region(8.0)] }
        }] }]
    });
    let rules = check::Rules { counted: [("points", 2000)].into(), ..check::Rules::default() };
    let problems = check::read(&json, &rules).unwrap_err();
    assert_eq!(problems[0].path, "/layers/0/zones/0/fold/regions/1", "{problems:?}");
}

/// A scene of a picture in which nothing moves and of what else is given, as JSON.
fn with_backdrop(camera: &str, layer: &str) -> Document {
    let zone = r#"{ "name": "all", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 8, "height": 6 } }"#;
    let text = format!(
        r#"{{ "plica": 1, "camera": {camera}, "images": {{ "sky": {{ "path": "sky.png" }} }},
        "meshes": {{ "m": {{ "path": "m.obj" }} }}, "clips": {{ "c": {{ "path": "c%d.png" }} }},
        "layers": [{{ "kind": "picture", "name": "sky", "image": "sky", "zones": [{zone}] }}{layer}] }}"#
    );
    Document::parse(&text).unwrap()
}

#[test]
fn that_nothing_moves_is_told_only_where_nothing_does() {
    const MESH: &str = r#"{ "kind": "mesh", "name": "m", "mesh": "m" "#;
    for (camera, layer, told) in [
        ("{}", String::new(), 1),
        (r#"{ "turn": 90 }"#, String::new(), 1),
        ("{}", format!(", {MESH}}}"), 1),
        ("{}", format!(r#", {MESH}, "pose": {{ "bend": {{ "degrees": 9 }} }} }}"#), 1),
        ("{}", format!(r#", {MESH}, "pose": {{ "bend": {{ "degrees": 9, "swing": 1 }} }} }}"#), 0),
        ("{}", format!(r#", {MESH}, "pose": {{ "bend": {{ "swing": 1 }} }} }}"#), 1),
        ("{}", format!(r#", {MESH}, "pose": {{ "spin": 90 }} }}"#), 0),
        (r#"{ "keys": [{ "at": 0, "fov": 30 }, { "at": 1, "fov": 30 }] }"#, format!(", {MESH}}}"), 1),
        (r#"{ "turn": 90 }"#, format!(", {MESH}}}"), 0),
        (r#"{ "keys": [{ "at": 0, "fov": 30 }, { "at": 1, "fov": 40 }] }"#, format!(", {MESH}}}"), 0),
        ("{}", r#", { "kind": "waterfall", "name": "w", "clip": "c" }"#.to_owned(), 0),
    ] {
        let document = with_backdrop(camera, &layer);
        let still = document.warnings().iter().filter(|problem| problem.message.starts_with("nothing moves"));
        assert_eq!(still.count(), told, "{camera} {layer}: {:?}", document.warnings());
    }
}

#[test]
fn a_mesh_that_is_in_no_frame_is_told_once() {
    let corners = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices = corners.map(|at| Vertex { position: at.into(), ..Vertex::default() }).to_vec();
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let materials = Materials { meshes: [("m".to_owned(), mesh.into())].into(), ..Materials::default() };
    let layer = r#", { "kind": "mesh", "name": "m", "mesh": "m" }"#;
    for (camera, part) in [
        ("{}", None),
        (r#"{ "position": [0, 1.2, -4] }"#, Some("/layers/1/sides: nothing of the mesh \"m\" is seen")),
        (r#"{ "target": [0, 1.2, 9] }"#, Some("/layers/1/pose/position: nothing of the mesh \"m\" is seen: it is")),
        // At some time it is.
        (r#"{ "position": [0, 1.2, -4], "turn": 200 }"#, None),
        (r#"{ "target": [0, 1.2, 9], "keys": [{ "at": 0, "fov": 30 }, { "at": 0.51, "target": [0, 0, 0] }] }"#, None),
    ] {
        let told = check::check_materials(with_backdrop(camera, layer).scene(), &materials);
        let told: Vec<String> = told.iter().map(|problem| format!("{}: {}", problem.path, problem.message)).collect();
        assert_eq!(told.len(), usize::from(part.is_some()), "{camera}: {told:?}");
        assert!(part.is_none_or(|part| told[0].starts_with(part)), "{camera}: {told:?}");
    }
}
