//! glTF files that tests build: a square, and the square with changes.

use serde_json::{Value, json};

use super::*;

/// A `.glb` of these chunks.
pub(super) fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let number = |number: usize| (number as u32).to_le_bytes();
    let length = number(12 + 8 + json.len() + 8 + binary.len());
    let head = [&b"glTF"[..], &number(2), &length].concat();
    [&head[..], &number(json.len()), b"JSON", &json, &number(binary.len()), b"BIN\0", binary].concat()
}

pub(super) fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Views, one after the other, of parts of a buffer.
pub(super) fn views(parts: &[&[u8]]) -> (Value, Vec<u8>) {
    let binary = parts.concat();
    let mut at = 0;
    let view = |part: &&[u8]| {
        at += part.len();
        json!({ "buffer": 0, "byteOffset": at - part.len(), "byteLength": part.len() })
    };
    (parts.iter().map(view).collect(), binary)
}

/// A square in two triangles, facing forward: views of positions, normals, texture coordinates and indices.
pub(super) fn square() -> (Value, Vec<u8>) {
    let positions = floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    let normals = floats(&[0., 0., 2., 0., 0., 2., 0., 0., 2., 0., 0., 2.]);
    let uvs = floats(&[0., 1., 1., 1., 1., 0., 0., 0.]);
    let (views, binary) = views(&[&positions, &normals, &uvs, &[0, 1, 2, 0, 2, 3]]);
    let json = json!({
        "asset": { "version": "2.0", "generator": "by hand" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "_MORE": 9 }, "indices": 3 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 3, "componentType": 5121, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    (json, binary)
}

/// The square with changes: each a pointer and what is put there.
pub(super) fn changed(changes: &[(&str, Value)]) -> std::result::Result<(Mesh, Vec<String>), String> {
    let (mut json, binary) = square();
    for (pointer, value) in changes {
        put(&mut json, pointer, value.clone());
    }
    read("a.glb", &glb(&json, &binary))
}

pub(super) fn put(json: &mut Value, pointer: &str, value: Value) {
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    match json.pointer_mut(parent).unwrap() {
        Value::Array(list) => match name.parse::<usize>() {
            Ok(at) => list[at] = value,
            Err(_) => list.push(value),
        },
        parent => parent[name] = value,
    }
}

pub(super) fn positions(mesh: &Mesh) -> Vec<[f64; 3]> {
    mesh.triangles.iter().flatten().map(|&at| mesh.vertices[at as usize].position.to_array()).collect()
}
