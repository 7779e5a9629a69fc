//! glTF: what is read from built files.

use base64::Engine;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::built::{changed, floats, glb, positions, put, square, views};
use super::*;

#[test]
fn a_model_is_the_same_in_one_file_and_in_several() {
    let (json, binary) = square();
    let (mesh, notes) = read("a.glb", &glb(&json, &binary)).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!((mesh.without_uv, mesh.degenerate, notes), (None, 0, Vec::new()));
    assert!(mesh.vertices.iter().all(|vertex| vertex.normal == DVec3::Z));
    assert_eq!(mesh.vertices[0].uv, DVec2::ZERO, "v goes up");
    assert_eq!(mesh.vertices[2].uv, DVec2::ONE);
    let mut embedded = json.clone();
    let text = base64::engine::general_purpose::STANDARD.encode(&binary);
    for text in [text.clone(), text.trim_end_matches('=').to_owned()] {
        embedded["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{text}"));
        assert_eq!(read("a.gltf", embedded.to_string().as_bytes()).unwrap().0, mesh);
    }
    let mut beside = json;
    for (uri, path) in [("parts/a%20b%.bin", "parts/a b%.bin"), ("./\u{e9}.bin", "./\u{e9}.bin")] {
        beside["buffers"][0]["uri"] = json!(uri);
        let text = format!("\u{feff} {beside}");
        let found = read_with("a.gltf", text.as_bytes(), &[(path, &binary)], &Limits::default());
        assert_eq!(found.unwrap().0, mesh);
        assert_eq!(
            read("a.gltf", text.as_bytes()).unwrap_err(),
            format!("a.gltf: its buffer {path}: there is no such file")
        );
        let short = read_with("a.gltf", text.as_bytes(), &[(path, &binary[1..])], &Limits::default()).unwrap_err();
        let cure = format!("(copy {path} again from where it came)");
        assert!(short.starts_with(&format!("a.gltf: its buffer {path} has ")) && short.ends_with(&cure), "{short}");
        let limits = Limits { mesh: text.len() as u64, ..Limits::default() };
        let long = vec![0; text.len() + 1];
        let error = read_with("a.gltf", text.as_bytes(), &[(path, &long)], &limits).unwrap_err();
        assert!(error.starts_with(&format!("a.gltf: its buffer {path}: has {} bytes", long.len())), "{error}");
    }
}

#[test]
fn nodes_move_what_they_hold() {
    let turned = [0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()];
    // The corner that was at (1, 0, 0), the normal, and the winding.
    for (nodes, expected, normal, mirrored) in [
        (json!([{ "mesh": 0, "translation": [1, 2, 3] }]), [2.0, 2.0, 3.0], DVec3::Z, false),
        (json!([{ "mesh": 0, "rotation": turned }]), [0.0, 1.0, 0.0], DVec3::Z, false),
        (json!([{ "mesh": 0, "rotation": turned.map(|x| x * 3.0) }]), [0.0, 1.0, 0.0], DVec3::Z, false),
        (json!([{ "mesh": 0, "scale": [-2, 1, 1] }]), [-2.0, 0.0, 0.0], DVec3::Z, true),
        (json!([{ "mesh": 0, "scale": [2, 1, -1] }]), [2.0, 0.0, 0.0], DVec3::NEG_Z, true),
        (json!([{ "mesh": 0, "scale": [2, 2, 0] }]), [2.0, 0.0, 0.0], DVec3::Z, false),
        (
            json!([{ "mesh": 0, "matrix": [1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1] }]),
            [6.0, 0.0, 1.0],
            DVec3::new(-1.0, 0.0, 1.0).normalize(),
            false,
        ),
        (
            // Translation, rotation and scale of the child come first, in the order scale, rotation, translation.
            json!([
                { "children": [1], "translation": [10, 0, 0] },
                { "mesh": 0, "translation": [0, 1, 0], "rotation": turned, "scale": [3, 1, 1] },
            ]),
            [10.0, 4.0, 0.0],
            DVec3::Z,
            false,
        ),
    ] {
        let (mesh, _) = changed(&[("/nodes", nodes.clone())]).unwrap();
        let corner = mesh.vertices[mesh.triangles[0][if mirrored { 2 } else { 1 }] as usize];
        assert!(corner.position.abs_diff_eq(DVec3::from_array(expected), 1e-15), "{nodes}: {corner:?}");
        assert!(corner.normal.abs_diff_eq(normal, 1e-15), "{nodes}: {corner:?}");
        // The front stays the front.
        let [a, b, c] = mesh.triangles[0].map(|at| mesh.vertices[at as usize].position);
        assert!((b - a).cross(c - a).dot(corner.normal) > 0.0, "{nodes}");
    }
}

#[test]
fn the_default_scene_is_read_in_the_order_of_its_nodes() {
    let at = |x: i32| json!({ "mesh": 0, "translation": [x, 0, 0] });
    let mut parent = at(1);
    parent["children"] = json!([3, 2]);
    let nodes = ("/nodes", json!([at(0), parent, at(2), at(3)]));
    let list = |scenes: Value, scene: Value| vec![nodes.clone(), ("/scenes", scenes), ("/scene", scene)];
    for (changes, expected) in [
        (list(json!([{ "nodes": [0] }, { "nodes": [1, 0] }]), json!(1)), &[1.0, 4.0, 3.0, 0.0][..]),
        (list(json!([{ "nodes": [0] }, { "nodes": [1] }]), json!(null)), &[0.0]),
        (list(json!([]), json!(null)), &[0.0, 1.0, 4.0, 3.0]),
    ] {
        let (mesh, _) = changed(&changes).unwrap();
        let found: Vec<f64> = mesh.triangles.iter().map(|&[a, ..]| mesh.vertices[a as usize].position.x).collect();
        let expected: Vec<f64> = expected.iter().flat_map(|&x| [x, x]).collect();
        assert_eq!(found, expected);
    }
    // A tree may be deep, and many nodes may show one mesh.
    let chain = |i: usize| if i < 50_000 { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) };
    let (mesh, _) = changed(&[("/nodes", (0..=50_000).map(chain).collect())]).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
}

#[test]
fn triangles_come_as_lists_strips_and_fans() {
    let cut = "node 0: mesh 0 lists triangles by 4 corners: the last 1 make none";
    for (mode, indices, expected, told) in [
        (json!(null), json!(3), &[0, 1, 2, 0, 2, 3][..], &[][..]),
        (json!(4), json!(null), &[0, 1, 2], &[cut]),
        (json!(5), json!(null), &[0, 1, 2, 1, 3, 2], &[]),
        (json!(6), json!(null), &[1, 2, 0, 2, 3, 0], &[]),
    ] {
        let (mesh, notes) =
            changed(&[("/meshes/0/primitives/0/mode", mode), ("/meshes/0/primitives/0/indices", indices)]).unwrap();
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(positions(&mesh), expected.iter().map(|&at: &usize| corners[at]).collect::<Vec<_>>());
        assert_eq!(notes, told);
    }
    let lines = json!({ "attributes": { "POSITION": 0 }, "mode": 1 });
    let posed = json!({ "attributes": { "POSITION": 0 }, "indices": 3, "targets": [{ "POSITION": 0 }] });
    let bare = json!({ "attributes": { "NORMAL": 1 } });
    let add = |primitive| ("/meshes/0/primitives/-", primitive);
    let laid = |info: Value| json!([{ "pbrMetallicRoughness": { "baseColorTexture": info } }]);
    for (info, told) in [
        (json!({ "index": 0 }), 0),
        (json!({ "index": 0, "extensions": { "OTHER": {} } }), 0),
        (json!({ "index": 0, "texCoord": 1 }), 1),
        (json!({ "index": 0, "extensions": { "KHR_texture_transform": {} } }), 1),
    ] {
        let of = ("/meshes/0/primitives/0/material", json!(0));
        assert_eq!(changed(&[("/materials", laid(info)), of]).unwrap().1.len(), told);
    }
    let colored = json!({ "attributes": { "POSITION": 0, "COLOR_0": 0 }, "indices": 3 });
    assert_eq!(changed(&[add(colored)]).unwrap().1, ["the colors of its vertices are not shown"]);
    let gone = json!({ "name": "hat", "mesh": 0, "scale": [1, 0, 0] });
    let more = [("/nodes/-", gone.clone()), ("/scenes/0/nodes", json!([0, 1]))];
    let told = "node 1 \"hat\" is scaled to nothing, itself or by one that it is in";
    assert_eq!(changed(&more).unwrap().1, [told, "2 of 4 triangles have no area and are never seen"]);
    for (change, told) in [
        (("/nodes/0/scale", json!([1, 1, 0])), "node 0 is made flat, itself or by one that it is in"),
        (
            ("/nodes/0/rotation", json!([0, 0, 0, 5])),
            "node 0: its rotation is of length 5.000, and is taken as if that were 1",
        ),
        (("/accessors/3/count", json!(5)), "node 0: mesh 0 lists triangles by 5 corners: the last 2 make none"),
    ] {
        assert_eq!(changed(&[change]).unwrap().1, [told]);
    }
    let both = json!({ "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "scale": [2, 2, 2] });
    let told = "node 0 has a matrix, beside which its translation, rotation and scale are not applied";
    assert_eq!(changed(&[("/nodes/0", both)]).unwrap().1, [told]);
    let (mesh, notes) = changed(&[add(lines), add(posed), add(bare), ("/nodes/0/skin", json!(0))]).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.without_uv), (4, Some(2)));
    assert_eq!(
        notes,
        [
            "its points and lines are not drawn",
            "its bones and morph targets are not applied: it is shown as it is stored"
        ]
    );
}

#[test]
fn numbers_are_read_as_they_are_stored() {
    let bytes = |words: &[u16]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let long = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let corners = floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    // What is stored, the accessor, and what the first coordinates of the four positions are.
    for (stored, accessor, expected) in [
        (vec![0, 0, 0, 129, 0, 0, 127, 1, 0, 255, 1, 0], json!({ "componentType": 5120 }), [0.0, -127.0, 127.0, -1.0]),
        (
            vec![0, 0, 0, 128, 0, 0, 127, 1, 0, 129, 1, 0],
            json!({ "componentType": 5120, "normalized": true }),
            [0.0, -1.0, 1.0, -1.0],
        ),
        (
            vec![0, 0, 0, 255, 0, 0, 51, 1, 0, 0, 1, 0],
            json!({ "componentType": 5121, "normalized": true }),
            [0.0, 1.0, 0.2, 0.0],
        ),
        (
            bytes(&[0, 0, 0, 65535, 0, 0, 32767, 1, 0, 0, 1, 0]),
            json!({ "componentType": 5122 }),
            [0.0, -1.0, 32767.0, 0.0],
        ),
        (
            bytes(&[0, 0, 0, 65535, 0, 0, 13107, 1, 0, 0, 1, 0]),
            json!({ "componentType": 5123, "normalized": true }),
            [0.0, 1.0, 0.2, 0.0],
        ),
        ([&[9, 9, 9, 9], &corners[..]].concat(), json!({ "byteOffset": 4 }), [0.0, 1.0, 1.0, 0.0]),
    ] {
        let (mut json, _) = square();
        let (views, binary) = views(&[&stored]);
        put(&mut json, "/bufferViews", views);
        put(&mut json, "/buffers/0/byteLength", json!(binary.len()));
        put(&mut json, "/meshes/0/primitives/0", json!({ "attributes": { "POSITION": 0 }, "mode": 5 }));
        for (name, value) in accessor.as_object().unwrap() {
            put(&mut json, &format!("/accessors/0/{name}"), value.clone());
        }
        let (mesh, _) = read("a.glb", &glb(&json, &binary)).unwrap();
        let found = [0, 1, 2, 4].map(|at| positions(&mesh)[at][0]);
        assert_eq!([found[0], found[1], found[2], found[3]], expected, "{accessor}");
    }
    for (kind, indices) in [(5123, bytes(&[0, 1, 2, 0, 2, 3])), (5125, long(&[0, 1, 2, 0, 2, 3]))] {
        let (mut json, binary) = square();
        let buffer = [&binary[..], &indices].concat();
        put(&mut json, "/buffers/0/byteLength", json!(buffer.len()));
        put(
            &mut json,
            "/bufferViews/3",
            json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": indices.len() }),
        );
        put(&mut json, "/accessors/3/componentType", json!(kind));
        assert_eq!(read("a.glb", &glb(&json, &buffer)).unwrap(), read("a.glb", &glb(&square().0, &binary)).unwrap());
    }
}

#[test]
fn sparse_and_strided_accessors_are_read() {
    let (mut json, binary) = square();
    // Elements 1 and 3 are the positions 2 and 0 of the square: their view is read with a stride, from its third.
    let sparse = json!({
        "count": 2,
        "indices": { "bufferView": 4, "componentType": 5123 },
        "values": { "bufferView": 5 },
    });
    let buffer = [&binary[..], &[1, 0, 3, 0], &floats(&[7., 8., 9., 4., 5., 6.])].concat();
    put(&mut json, "/buffers/0/byteLength", json!(buffer.len()));
    put(&mut json, "/bufferViews/-", json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": 4 }));
    put(&mut json, "/bufferViews/-", json!({ "buffer": 0, "byteOffset": binary.len() + 4, "byteLength": 24 }));
    put(&mut json, "/accessors/0/sparse", sparse);
    put(&mut json, "/meshes/0/primitives/0/mode", json!(5));
    put(&mut json, "/meshes/0/primitives/0/indices", json!(null));
    let corners = |mesh: &Mesh| [0, 1, 2, 4].map(|at| positions(mesh)[at]);
    let (mesh, _) = read("a.glb", &glb(&json, &buffer)).unwrap();
    assert_eq!(corners(&mesh), [[0.0; 3], [7.0, 8.0, 9.0], [1.0, 1.0, 0.0], [4.0, 5.0, 6.0]]);
    put(&mut json, "/accessors/0/bufferView", json!(null));
    let (mesh, _) = read("a.glb", &glb(&json, &buffer)).unwrap();
    assert_eq!(corners(&mesh), [[0.0; 3], [7.0, 8.0, 9.0], [0.0; 3], [4.0, 5.0, 6.0]], "the others are zero");
    put(&mut json, "/accessors/0/sparse", json!(null));
    put(&mut json, "/accessors/0/bufferView", json!(0));
    put(&mut json, "/accessors/0/count", json!(2));
    put(&mut json, "/bufferViews/0/byteStride", json!(24));
    put(&mut json, "/meshes/0/primitives/0", json!({ "attributes": { "POSITION": 0 }, "indices": 3 }));
    let (indices, values) = (json!({ "bufferView": 3, "componentType": 5121 }), json!({ "bufferView": 0 }));
    let zeros = json!({ "count": 1, "indices": indices, "values": values });
    put(&mut json, "/accessors/3", json!({ "componentType": 5125, "count": 3, "type": "SCALAR", "sparse": zeros }));
    let (mesh, notes) = read("a.glb", &glb(&json, &buffer)).unwrap();
    assert_eq!((positions(&mesh), mesh.degenerate), (vec![[0.0; 3]; 3], 1));
    assert_eq!(notes, [""; 0], "the layer tells that nothing is seen");
    put(&mut json, "/accessors/3", json!({ "bufferView": 3, "componentType": 5121, "count": 3, "type": "SCALAR" }));
    put(&mut json, "/accessors/3/byteOffset", json!(0));
    assert!(read("a.glb", &glb(&json, &buffer)).unwrap_err().contains("there is no vertex 2: there are 2"));
}

#[test]
fn what_is_not_stored_is_zero() {
    let of = |accessor: usize| {
        let mesh = changed(&[(&format!("/accessors/{accessor}/bufferView"), json!(null))]);
        mesh.unwrap_or_else(|error| panic!("accessor {accessor}: {error}")).0
    };
    let whole = changed(&[]).unwrap().0;
    let flat = of(0);
    assert_eq!((positions(&flat), flat.degenerate), (vec![[0.0; 3]; 6], 2), "positions");
    assert_eq!(positions(&of(1)), positions(&whole));
    // A normal of no length is computed.
    assert!(of(1).vertices.iter().all(|vertex| vertex.normal.abs() == DVec3::Z), "{:?}", of(1));
    assert!(of(2).vertices.iter().all(|vertex| vertex.uv == DVec2::new(0.0, 1.0)), "{:?}", of(2));
    assert_eq!((of(3).triangles, of(3).degenerate), (vec![[0; 3]; 2], 2), "indices");
}
