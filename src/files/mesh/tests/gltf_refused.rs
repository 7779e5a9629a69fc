//! glTF files that are broken, cut short or mean too much: what is said of them.

use serde_json::{Value, json};

use super::built::{changed, glb, put, square};
use super::*;

/// What is said of a square in which a value is changed.
fn are_refused(cases: &[(&str, Value, String)]) {
    for (pointer, value, expected) in cases {
        let told = changed(&[(pointer, value.clone())]).unwrap_err();
        assert_eq!(told, format!("a.glb: {expected}"), "{pointer} {value}");
    }
}

const AGAIN: &str = "(export it again)";

#[test]
fn what_is_wrong_with_nodes_is_told_by_its_number() {
    are_refused(&[
        ("/meshes", json!([]), format!("there is no mesh 0: there are 0 {AGAIN}")),
        ("/nodes", json!([{}]), "has no triangles (name a mesh with faces)".to_owned()),
        (
            "/nodes/0/scale",
            json!([0, 0, 0]),
            "node 0 is scaled to nothing, itself or by one that it is in (mend its scale, and export it again)"
                .to_owned(),
        ),
        (
            "/nodes/0/rotation",
            json!([0, 0, 0, 0]),
            "node 0: the rotation [0, 0, 0, 0] is none (write [0, 0, 0, 1], which turns nothing, or export it again)"
                .to_owned(),
        ),
        (
            "/meshes/0/primitives/0/mode",
            json!(1),
            "has only points and lines, which are not drawn (export it with its faces)".to_owned(),
        ),
        ("/scene", json!(7), format!("there is no scene 7: there is 1 {AGAIN}")),
        ("/scenes/0/nodes", json!([1]), format!("there is no node 1: there is 1 {AGAIN}")),
        ("/scenes/0/nodes", json!([0, 0]), format!("node 0 is in the scene twice {AGAIN}")),
        ("/nodes/0/children", json!([0]), format!("node 0 is in the scene twice {AGAIN}")),
        (
            "/nodes/0/matrix",
            json!([1e308, 0, 0, 0, 0, 1e308, 0, 0, 0, 0, 1, 0, 1e308, 0, 0, 1]),
            format!("accessor 0: its node moves it out of all bounds {AGAIN}"),
        ),
        (
            "/nodes/0/matrix",
            json!([1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            "node 0: the last row of its matrix is [0.5, 0, 0, 1], and is to be [0, 0, 0, 1] \
             (write translation, rotation and scale in its place, or export it again)"
                .to_owned(),
        ),
    ]);
}

#[test]
fn what_is_wrong_with_accessors_is_told_by_its_number() {
    are_refused(&[
        ("/accessors/0/bufferView", json!(9), format!("there is no buffer view 9: there are 4 {AGAIN}")),
        ("/accessors/0/type", json!("VEC4"), format!("accessor 0 is VEC4, and VEC3 was expected {AGAIN}")),
        ("/accessors/0/componentType", json!(5124), format!("accessor 0: there is no type of numbers 5124 {AGAIN}")),
        ("/accessors/0/count", json!(3), format!("accessor 1 has 4 elements for 3 positions {AGAIN}")),
        (
            "/accessors/1/byteOffset",
            json!(4),
            format!("accessor 1 has 4 elements: its buffer view 1 is too short {AGAIN}"),
        ),
        (
            "/accessors/1/byteOffset",
            json!(u64::MAX),
            format!("accessor 1 has 4 elements: its buffer view 1 is too short {AGAIN}"),
        ),
        (
            "/accessors/3/count",
            json!(u64::MAX),
            format!("accessor 3 has {} elements: its buffer view 3 is too short {AGAIN}", u64::MAX),
        ),
        (
            "/accessors/0/count",
            json!(1_u64 << 40),
            format!("accessor 0 has {} elements: its buffer view 0 is too short {AGAIN}", 1_u64 << 40),
        ),
        (
            "/accessors/0",
            json!({ "componentType": 5126, "count": 30_000_000, "type": "VEC3" }),
            "accessor 0 has 30000000 elements that are not stored, at most 10000000 are allowed \
             (make it smaller, or give --limit triangles=30000000)"
                .to_owned(),
        ),
        (
            "/accessors/0",
            json!({
                "componentType": 5126, "count": 10_000_001, "type": "VEC3",
                "sparse": { "count": 1, "indices": { "bufferView": 3, "componentType": 5121 }, "values": { "bufferView": 0 } },
            }),
            "accessor 0 has 10000001 elements that are not stored, at most 10000000 are allowed \
             (make it smaller, or give --limit triangles=10000001)"
                .to_owned(),
        ),
        (
            "/bufferViews/0/byteStride",
            json!(5),
            format!("the byteStride of buffer view 0 is 5, and an element of accessor 0 has 12 bytes {AGAIN}"),
        ),
        (
            "/meshes/0/primitives/0/mode",
            json!(9),
            format!("mesh 0 has a primitive of mode 9: there are 0 to 6 {AGAIN}"),
        ),
        ("/accessors/3/count", json!(7), format!("accessor 3 has 7 elements: its buffer view 3 is too short {AGAIN}")),
        ("/accessors/3/componentType", json!(5120), format!("accessor 3 is not of whole numbers {AGAIN}")),
        ("/accessors/3/componentType", json!(5126), format!("accessor 3 is not of whole numbers {AGAIN}")),
    ]);
}

#[test]
fn what_is_wrong_with_buffers_is_told_by_its_number() {
    const AS_GLB: &str = "(export it again as .glb)";
    const OUTSIDE: &str =
        "not in the model's folder (give --allow-outside, or copy the file beside the model and mend its uri)";
    are_refused(&[
        (
            "/bufferViews/3/byteStride",
            json!(u64::MAX),
            format!("accessor 3 has 6 elements: its buffer view 3 is too short {AGAIN}"),
        ),
        ("/bufferViews/3/byteOffset", json!(u64::MAX), format!("buffer view 3 reaches beyond its buffer {AGAIN}")),
        ("/bufferViews/3/buffer", json!(1), format!("there is no buffer 1: there is 1 {AGAIN}")),
        (
            "/buffers/0/byteLength",
            json!(200),
            "its buffer 0 has 134 bytes, and is to have 200 (copy it again from where it came, or export it again)"
                .to_owned(),
        ),
        ("/buffers/0/uri", json!("data:,a"), format!("its buffer 0 is in the file, but not in base64 {AS_GLB}")),
        (
            "/buffers/0/uri",
            json!("data:a/b;base64,AA?A"),
            format!("its buffer 0 is broken base64: '?' at character 2 of 4 {AS_GLB}"),
        ),
        (
            "/buffers/0/uri",
            json!("data:a/b;base64,AAAAA"),
            format!("its buffer 0 is broken base64: its 5 characters end within a byte {AS_GLB}"),
        ),
        (
            "/buffers/0/uri",
            json!("https://x.org/a.bin"),
            "has a part at https://x.org/a.bin, which Plica does not fetch \
             (export it as .glb, which is one file)"
                .to_owned(),
        ),
        ("/buffers/0/uri", json!("../x.bin"), format!("has a part at ../x.bin, which is {OUTSIDE}")),
        ("/buffers/0/uri", json!("a/%2e%2e/x.bin"), format!("has a part at a/%2e%2e/x.bin, which is {OUTSIDE}")),
        ("/buffers/0/uri", json!("/x.bin"), format!("has a part at /x.bin, which is {OUTSIDE}")),
        ("/buffers/0/uri", json!("%ff.bin"), format!("has a part at %ff.bin, which is no path {AGAIN}")),
        ("/buffers/0/uri", json!("a\0b"), format!("has a part at a\\0b, which is no path {AGAIN}")),
        ("/buffers/0/uri", json!("a%00b"), format!("has a part at a%00b, which is no path {AGAIN}")),
    ]);
}

#[test]
fn what_is_not_read_is_told_by_its_name() {
    are_refused(&[
        ("/accessors/0/sparse", json!({ "count": 5 }), format!("accessor 0: 5 of 4 elements differ {AGAIN}")),
        (
            "/accessors/0/sparse",
            json!({ "count": 1, "indices": { "bufferView": 2, "componentType": 5123, "byteOffset": 6 }, "values": {} }),
            format!("accessor 0: there is no element 16256: there are 4 {AGAIN}"),
        ),
        ("/asset/version", json!("1.0"), "is glTF 1.0 (Plica reads glTF 2.0: export it again as .glb)".to_owned()),
        (
            "/asset/minVersion",
            json!("2.9"),
            "needs a reader of glTF 2.9 (Plica reads glTF 2.0: export it again as .glb)".to_owned(),
        ),
        (
            "/extensionsRequired",
            json!(["KHR_texture_transform", "KHR_draco_mesh_compression"]),
            "needs the extension KHR_draco_mesh_compression, which Plica does not read \
             (unpack it: gltf-transform cp a.glb a-plain.glb)"
                .to_owned(),
        ),
        (
            "/extensionsRequired",
            json!(["EXT_mesh_gpu_instancing"]),
            "needs the extension EXT_mesh_gpu_instancing, which Plica does not read \
             (export it again without that extension)"
                .to_owned(),
        ),
        (
            "/nodes/0/mesh",
            json!(-1),
            format!(
                "is not a glTF file: line 1, column 103 (nodes.0.mesh): invalid value: integer `-1`, expected usize {AGAIN}"
            ),
        ),
    ]);
    changed(&[("/extensionsRequired", json!(["KHR_mesh_quantization", "KHR_materials_unlit"]))]).unwrap();
    let (json, mut binary) = square();
    binary[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = read("a.glb", &glb(&json, &binary)).unwrap_err();
    assert_eq!(error, format!("a.glb: accessor 0: element 0 is not finite {AGAIN}"));
}

#[test]
fn a_file_that_is_cut_short_says_so() {
    let (json, binary) = square();
    let whole = glb(&json, &binary);
    for length in 4..whole.len() {
        let error = read("a.glb", &whole[..length]).unwrap_err();
        let all = whole.len();
        let sizes = if length < 12 { String::new() } else { format!(": it has {length} bytes, and is to have {all}") };
        assert_eq!(error, format!("a.glb: is cut short{sizes} (copy it again from where it came)"));
    }
    let error = read("a.glb", &[&whole[..], &[0; 3]].concat()).unwrap_err();
    let (found, told) = (whole.len() + 3, whole.len());
    assert_eq!(error, format!("a.glb: has {found} bytes, and says that it has {told} {AGAIN}"));
    let mut longer = whole.clone();
    longer[13] = 0x7f;
    assert!(read("a.glb", &longer).unwrap_err().contains("its chunk 0 reaches beyond its end"));
    let text = json.to_string();
    for length in 1..text.len() {
        let error = read("a.gltf", &text.as_bytes()[..length]).unwrap_err();
        assert_eq!(error, "a.gltf: is cut short (copy it again from where it came)", "{length}");
    }
    assert_eq!(read("a.gltf", text.as_bytes()).unwrap_err(), "a.gltf: buffer 0 is not in the file (export it again)");
    assert_eq!(
        read("a.gltf", b"{}").unwrap_err(),
        "a.gltf: is not a glTF file: it has no asset.version (Plica reads glTF 2.0: export it again as .glb)"
    );
    let mut old = whole.clone();
    old[4] = 1;
    assert!(read("a.glb", &old).unwrap_err().contains("is a .glb of version 1"));
    let mut no_text = whole.clone();
    let at = whole.windows(7).position(|seven| seven == b"by hand").unwrap();
    no_text[at] = 0xff;
    let told = format!("a.glb: its JSON is no text from byte {} on: that is not UTF-8 {AGAIN}", at - 20);
    assert_eq!(read("a.glb", &no_text).unwrap_err(), told);
    let mut odd = whole;
    odd[16] = b'X';
    assert!(read("a.glb", &odd).unwrap_err().contains("does not begin with its JSON"));
}

#[test]
fn a_small_file_that_means_much_is_refused() {
    let limits = Limits { memory: 16 << 20, ..Limits::default() };
    let braces = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}]}}", vec!["{}"; 20_000].join(","));
    // Many nodes show a mesh of many parts.
    let (mut json, binary) = square();
    let many = vec![json!({ "attributes": { "POSITION": 0 } }); 1000];
    put(&mut json, "/meshes/0/primitives", json!(many));
    put(&mut json, "/nodes", json!(vec![json!({ "mesh": 0 }); 1000]));
    put(&mut json, "/scenes/0/nodes", json!((0..1000).collect::<Vec<_>>()));
    let parts = glb(&json, &binary);
    let (mut json, binary) = square();
    let (indices, values) = (json!({ "bufferView": 3, "componentType": 5121 }), json!({ "bufferView": 0 }));
    let sparse = json!({ "count": 1, "indices": indices, "values": values });
    put(
        &mut json,
        "/accessors/0",
        json!({ "componentType": 5126, "count": 1_000_000, "type": "VEC3", "sparse": sparse }),
    );
    put(&mut json, "/meshes/0/primitives/0", json!({ "attributes": { "POSITION": 0 }, "mode": 5 }));
    let zeros = glb(&json, &binary);
    for bytes in [braces.into_bytes(), parts, zeros] {
        let error = read_with("a.glb", &bytes, &[], &limits).unwrap_err();
        assert!(error.contains("of memory besides"), "{error}");
    }
}

#[test]
fn triangles_are_counted_before_anything_is_made_for_a_node() {
    let (mut json, binary) = square();
    put(&mut json, "/meshes/0/primitives", json!(vec![json!({ "attributes": { "POSITION": 0 } }); 1000]));
    put(&mut json, "/nodes", json!(vec![json!({ "mesh": 0 }); 11_000]));
    put(&mut json, "/scenes/0/nodes", json!((0..11_000).collect::<Vec<_>>()));
    // For the document alone.
    let limits = Limits { memory: 32 << 20, ..Limits::default() };
    assert_eq!(
        read_with("a.glb", &glb(&json, &binary), &[], &limits).unwrap_err(),
        "a.glb: has 11000000 triangles, at most 10000000 are allowed \
         (make it smaller, or give --limit triangles=11000000)"
    );
}
