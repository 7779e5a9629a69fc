//! What is loaded, what is kept, and what is said of the rest.

mod clips;

use std::path::PathBuf;

use super::*;
use crate::base::clip::Clip;
use image::{DynamicImage, ImageBuffer, Luma};

fn scene(images: &[(&str, &str)], field: Option<&str>) -> Scene {
    let images: serde_json::Map<_, _> =
        images.iter().map(|(name, path)| (name.to_string(), serde_json::json!({ "path": path }))).collect();
    let motion: Vec<_> = field.iter().map(|path| serde_json::json!({ "tool": "field", "path": path })).collect();
    let outline = serde_json::json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 1, "height": 1 });
    serde_json::from_value(serde_json::json!({ "plica": 1, "images": images, "layers": [{
        "kind": "picture", "name": "l", "image": "a",
        "zones": [{ "name": "z", "outline": outline, "motion": motion }]
    }] }))
    .unwrap()
}

fn paint(folder: &Path, name: &str, width: u32) {
    let image: DynamicImage = ImageBuffer::from_pixel(width, 1, Luma([9u8])).into();
    image.save(folder.join(name)).unwrap();
}

#[test]
fn what_did_not_change_is_not_loaded_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    paint(folder.path(), "a.png", 2);
    paint(folder.path(), "b.png", 3);
    let scene = scene(&[("a", "a.png"), ("b", "b.png"), ("again", "a.png")], None);
    let mut cache = Cache::default();
    let options = Options::default();
    let (first, _) = load(&path, &scene, &options, &mut cache).unwrap();
    assert!(Arc::ptr_eq(&first.pictures["a"], &first.pictures["again"]));
    paint(folder.path(), "b.png", 4);
    let (second, _) = load(&path, &scene, &options, &mut cache).unwrap();
    assert!(Arc::ptr_eq(&first.pictures["a"], &second.pictures["a"]));
    assert_eq!(second.pictures["b"].width(), 4);
    std::fs::write(folder.path().join("b.png"), "half a pict").unwrap();
    for _ in 0..2 {
        let (third, problems) = gather(&path, &scene, &options, &mut cache);
        assert!(Arc::ptr_eq(&third.pictures["b"], &second.pictures["b"]), "the last good one");
        assert_eq!(problems.iter().map(|p| p.path.as_str()).collect::<Vec<_>>(), ["/images/b/path"]);
    }
    assert_eq!(Watched::default().files(&path, &scene, &Options::default()).len(), 2, "each file once");
}

#[test]
fn every_problem_has_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    paint(folder.path(), "good.png", 2);
    let scene = scene(&[("a", "missing.png"), ("b/c~d", "../out.png"), ("good", "good.png")], Some("v.flo"));
    let problems = load(&path, &scene, &Options::default(), &mut Cache::default()).unwrap_err();
    let places = |problems: &[Problem]| problems.iter().map(|p| p.path.clone()).collect::<Vec<_>>();
    let expected = ["/images/a/path", "/images/b~1c~0d/path", "/layers/0/zones/0/motion/0/path"];
    assert_eq!(places(&problems), expected);
    assert!(problems[1].hint.as_ref().unwrap().contains("--allow-outside"));
    let (sizes, problems) = sizes(&path, &scene, &Options::default());
    assert_eq!(sizes, BTreeMap::from([("good".to_owned(), (2, 1))]));
    assert_eq!(places(&problems), expected, "fields are looked for too");
}

#[test]
fn copies_stand_for_files_on_another_machine() {
    let folder = tempfile::tempdir().unwrap();
    paint(folder.path(), "0.png", 2);
    paint(folder.path(), "1.png", 3);
    let scene = scene(&[("a", "a.png"), ("b", "../b.png"), ("c", "c.png")], None);
    let mut cache = Cache::default();
    let mut copies =
        Copies::from([("a.png".into(), Ok(folder.path().join("0.png"))), ("c.png".into(), Err("no".into()))]);
    let mut look = |copies: &Copies| {
        let (materials, problems) = gather_copies(copies, &scene, &Options::default(), &mut cache);
        (materials.pictures.get("a").map(|a| a.width()), problems.iter().map(|p| p.message.clone()).collect::<Vec<_>>())
    };
    let missing = vec!["../b.png: is not here yet".to_owned(), "c.png: no".to_owned()];
    assert_eq!(look(&copies), (Some(2), missing.clone()));
    copies.insert("a.png".into(), Ok(folder.path().join("1.png")));
    assert_eq!(look(&copies), (Some(3), missing));
    copies.insert("a.png".into(), Err("gone".into()));
    assert_eq!(look(&copies).0, Some(3), "the last good one");
}

#[test]
fn meshes_are_loaded_with_what_they_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    let corners = |x: f32| [0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let model = |uri: &str| {
        serde_json::json!({
            "asset": { "version": "2.0" },
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36, "uri": uri }],
        })
    };
    write("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
    write("sub/b.gltf", model("b.bin").to_string().as_bytes());
    write("sub/b.bin", &corners(1.0));
    write("sub/c.gltf", model("../sub/b.bin").to_string().as_bytes());
    let meshes = serde_json::json!({
        "a": { "path": "a.obj" }, "b": { "path": "sub/b.gltf" }, "c": { "path": "sub/c.gltf" }, "d": { "path": "d.obj" },
    });
    let scene: Scene = serde_json::from_value(serde_json::json!({ "plica": 1, "meshes": meshes })).unwrap();
    let mut cache = Cache::default();
    let options = Options::default();
    let (first, problems) = gather(&path, &scene, &options, &mut cache);
    let told: Vec<_> = problems.iter().map(|p| (p.path.as_str(), p.message.as_str())).collect();
    assert_eq!(
        told,
        [
            ("/meshes/c/path", "sub/c.gltf: has a part at ../sub/b.bin, which is not in the model's folder"),
            ("/meshes/d/path", "d.obj: there is no such file"),
            ("/meshes/a/path", "a.obj: 1 of 2 triangles has no area and is never seen"),
        ]
    );
    assert_eq!(first.meshes.keys().collect::<Vec<_>>(), ["a", "b"]);
    let taken: u64 = first.meshes.values().map(|mesh| mesh.bytes()).sum();
    assert_eq!(first.budget.taken(), taken);
    let (second, _) = gather(&path, &scene, &options, &mut cache);
    assert!(Arc::ptr_eq(&first.meshes["b"], &second.meshes["b"]));
    write("sub/b.bin", &corners(2.0));
    let (third, _) = gather(&path, &scene, &options, &mut cache);
    assert!(Arc::ptr_eq(&first.meshes["a"], &third.meshes["a"]));
    assert_eq!(third.meshes["b"].bounds().unwrap().1.x, 2.0, "what it names has changed");
    write("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    let (fourth, problems) = gather(&path, &scene, &options, &mut cache);
    assert!(Arc::ptr_eq(&third.meshes["a"], &fourth.meshes["a"]));
    let told = problems.iter().find(|problem| problem.path == "/meshes/a/path").unwrap();
    let expected = "a.obj: line 4: there is no vertex 9: there are 3, and what was read before is still shown";
    assert_eq!(told.message, expected);
    let copy = |name: &str| (name.to_owned(), Ok(folder.path().join(name)));
    let copies = Copies::from(["sub/b.gltf", "sub/b.bin"].map(copy));
    let (copied, _) = gather_copies(&copies, &scene, &options, &mut Cache::default());
    assert_eq!(copied.meshes["b"], third.meshes["b"]);
    assert_eq!(Watched::default().files(&path, &scene, &Options::default()).len(), 5, "and the part of a model");
    assert_eq!(sizes(&path, &scene, &options).1.len(), 1, "each is opened");
}

#[test]
fn the_parts_of_a_model_are_watched() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.plica.json");
    let scene: Scene = serde_json::from_str(r#"{"plica": 1, "meshes": {"m": {"path": "in/m.gltf"}}}"#).unwrap();
    std::fs::create_dir(folder.path().join("in")).unwrap();
    let mut watched = Watched::default();
    let mut found = || {
        let files = watched.files(&path, &scene, &Options::default());
        let name = |file: &PathBuf| file.strip_prefix(folder.path()).unwrap().to_string_lossy().into_owned();
        files.iter().map(name).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(found(), "in/m.gltf", "which is not there yet");
    for (uri, expected) in [("a.bin", "in/a.bin in/m.gltf"), ("b/c.bin", "in/b/c.bin in/m.gltf")] {
        let text = format!(r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{uri}", "byteLength": 4}}]}}"#);
        std::fs::write(folder.path().join("in/m.gltf"), text).unwrap();
        assert_eq!(found(), expected);
    }
    let shown = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "images": [{"uri": "cow.png"}],
        "meshes": [{"primitives": [{"attributes": {}, "material": 0}]}], "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]}"#;
    std::fs::write(folder.path().join("in/m.gltf"), shown).unwrap();
    assert_eq!(found(), "in/cow.png in/m.gltf", "its picture, which is not there yet");
    std::fs::write(folder.path().join("in/m.gltf"), "{").unwrap();
    assert_eq!(found(), "in/m.gltf");
}
