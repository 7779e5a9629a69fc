//! Scenes made of models: the real program in a fresh folder.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

mod binary;

use std::path::Path;
use std::process::Output;

use base64::Engine;
use image::RgbaImage;
use serde_json::{Value, json};

/// Standard output and messages of a run that must succeed, or else fail.
fn plica(folder: &Path, args: &[&str], succeeds: bool) -> (String, String) {
    let Output { status, stdout, stderr } = binary::plica(folder, args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let (out, messages) = (text(stdout), text(stderr));
    assert_eq!(status.success(), succeeds, "{args:?}: {out}{messages}");
    (out, messages)
}

fn get(folder: &Path, scene: &str, address: &str) -> Value {
    serde_json::from_str(&plica(folder, &["get", scene, address], true).0).unwrap()
}

/// The corners of a square from (0, 0) to (2, 2), facing forward, and their texture coordinates.
fn square() -> Vec<u8> {
    let positions = [0., 0., 0., 2., 0., 0., 2., 2., 0., 0., 2., 0.];
    let uvs = [0., 1., 1., 1., 1., 0., 0., 0.];
    let floats = positions.into_iter().chain(uvs).flat_map(f32::to_le_bytes);
    floats.chain([0, 1, 2, 0, 2, 3]).collect()
}

/// The square as glTF, its bytes and its picture at these addresses.
fn gltf(buffer: &str, image: &str) -> String {
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": image }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 6 },
        ],
        "buffers": [{ "uri": buffer, "byteLength": 86 }],
    })
    .to_string()
}

/// A folder with a picture, and in a folder `from` the square as `square.gltf` with its parts in `from/parts`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("from/parts")).unwrap();
    std::fs::create_dir(at("to")).unwrap();
    RgbaImage::from_pixel(80, 60, image::Rgba([0, 0, 90, 255])).save(at("cat.png")).unwrap();
    RgbaImage::from_pixel(4, 4, image::Rgba([200, 0, 0, 255])).save(at("from/parts/skin.png")).unwrap();
    std::fs::write(at("from/parts/square.bin"), square()).unwrap();
    std::fs::write(at("from/square.gltf"), gltf("parts/square.bin", "parts/skin.png")).unwrap();
    std::fs::write(at("flat.obj"), "v -1 5 0\nv 1 5 0\nv 1 9 0\nv -1 9 0\nf 1 2 3 4\n").unwrap();
    folder
}

fn rendered(folder: &Path, scene: &str) -> RgbaImage {
    plica(folder, &["render", scene, "--frames", "0", "-o", "frame.png"], true);
    image::open(folder.join("frame.png")).unwrap().to_rgba8()
}

#[test]
fn a_model_is_seen_whole_by_a_camera() {
    let folder = folder();
    assert_eq!(plica(folder.path(), &["new", "flat.obj"], true).0, "flat.plica.json\n");
    let scene = std::fs::read_to_string(folder.path().join("flat.plica.json")).unwrap();
    let scene: Value = serde_json::from_str(&scene).unwrap();
    assert_eq!(scene["layers"], json!([{ "kind": "mesh", "name": "flat", "mesh": "flat" }]));
    assert_eq!(scene["camera"]["target"][0], json!(0));
    assert_eq!(scene["images"], Value::Null);
    assert!(plica(folder.path(), &["check", "--lenient", "flat.plica.json"], true).1.contains("no problems"));
    let frame = rendered(folder.path(), "flat.plica.json");
    assert_eq!(frame.dimensions(), (1280, 720));
    let rows: Vec<u32> = (0..720).filter(|&y| (0..1280).any(|x| frame.get_pixel(x, y)[3] > 0)).collect();
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    // A twentieth of the height from the edges of the frame.
    assert!((35..38).contains(&first) && (682..685).contains(&last), "{first} to {last}");
}

#[test]
fn the_picture_of_a_model_is_on_its_surface_and_its_files_come_along() {
    let folder = folder();
    let new = ["new", "cat.png", "from/square.gltf", "flat.obj", "-o", "to/a.plica.json"];
    plica(folder.path(), &new, true);
    let to = folder.path().join("to");
    for (address, expected) in [
        ("meshes", json!({ "square": { "path": "square.gltf" }, "flat": { "path": "flat.obj" } })),
        ("images", json!({ "cat": { "path": "cat.png" }, "skin": { "path": "parts/skin.png" } })),
        ("layers.square.surface", json!({ "kind": "texture", "image": "skin" })),
    ] {
        assert_eq!(get(&to, "a.plica.json", address), expected);
    }
    for name in ["cat.png", "square.gltf", "flat.obj", "parts/square.bin", "parts/skin.png"] {
        assert!(to.join(name).is_file(), "{name}");
    }
    std::fs::remove_dir_all(folder.path().join("from")).unwrap();
    let frame = rendered(&to, "a.plica.json");
    assert_eq!(frame.dimensions(), (80, 60), "the picture gives the frame its size");
    let count = |fits: fn(&[u8; 4]) -> bool| frame.pixels().filter(|pixel| fits(&pixel.0)).count();
    assert!(count(|[r, g, ..]| *r > 60 && *g == 0) > 20, "the red square is seen");
    assert!(count(|[r, _, b, _]| *r == 0 && *b == 90) > 1000, "before the picture");
}

#[test]
fn a_picture_in_the_model_has_its_number_and_names_do_not_collide() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let data = |kind: &str, bytes: &[u8]| {
        format!("data:{kind};base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
    };
    let (bytes, skin) = (square(), std::fs::read(at("from/parts/skin.png")).unwrap());
    let whole = gltf(&data("application/octet-stream", &bytes), &data("image/png", &skin));
    std::fs::write(at("cat.gltf"), whole).unwrap();
    plica(folder.path(), &["new", "cat.png", "cat.gltf", "-o", "a.plica.json"], true);
    assert_eq!(get(folder.path(), "a.plica.json", "images.cat-0.path"), json!("cat.gltf#0"));
    let names: Vec<Value> = ["/layers/0/name", "/layers/1/name", "/layers/1/mesh"]
        .into_iter()
        .map(|at| get(folder.path(), "a.plica.json", at))
        .collect();
    assert_eq!(names, ["cat", "cat 2", "cat"]);
    plica(folder.path(), &["check", "--lenient", "a.plica.json"], true);
}

#[cfg(feature = "tui")]
#[test]
fn a_model_that_is_opened_gets_its_scene() {
    let folder = folder();
    let from = folder.path().join("from");
    std::fs::write(from.join("script"), "get layers.square.mesh\n").unwrap();
    for there in [false, true] {
        assert_eq!(from.join("square.plica.json").exists(), there);
        let (_, why) = plica(&from, &["edit", "square.gltf", "--read-only", "--script", "script"], there);
        assert_eq!(why.contains("square.gltf: has no scene yet, and --read-only makes none (leave"), !there, "{why}");
        let (out, _) = plica(&from, &["edit", "square.gltf", "--script", "script"], true);
        assert!(out.contains("\"square\""), "{out}");
    }
}

#[test]
fn what_is_drawn_on_a_model_is_compared_side_by_side() {
    let folder = folder();
    let folder = folder.path();
    plica(folder, &["new", "from/square.gltf", "-o", "s.plica.json"], true);
    plica(folder, &["set", "s.plica.json", "size=[40, 30]"], true);
    let compared = |by: &'static str| ["render", "s.plica.json", "--compare", by, "--frames", "0", "-o", "beside.png"];
    let (_, why) = plica(folder, &compared("anchor"), false);
    assert!(why.contains("no layer has strokes"), "{why}");
    plica(folder, &["style", "apply", "stipple", "s.plica.json"], true);
    for (by, ways) in [("anchor", vec!["surface", "screen", "texture"]), ("style", vec!["hatching", "cross-hatching"])]
    {
        plica(folder, &compared(by), true);
        let all = image::open(folder.join("beside.png")).unwrap().to_rgba8();
        assert_eq!(all.dimensions(), (40 * if by == "anchor" { 3 } else { 9 }, 30), "{by}");
        for (i, way) in ways.into_iter().enumerate() {
            plica(folder, &["set", "s.plica.json", &format!("layers.0.strokes.{by}={way}")], true);
            let own = image::imageops::crop_imm(&all, 40 * i as u32, 0, 40, 30).to_image();
            assert!(own == rendered(folder, "s.plica.json"), "{by} {way}");
        }
    }
    let (_, why) = plica(folder, &["render", "s.plica.json", "--compare", "anchor", "-o", "a.exr"], false);
    assert!(why.contains(".png, not .exr"), "{why}");
}

/// What is run, part of what it says, and whether it succeeds.
const TOLD: &[(&[&str], &str, bool)] = &[
    (&["new", "broken.obj"], "broken.obj: line 1", false),
    (&["new", "no.obj"], "no.obj: there is no such file", false),
    (&["new", "lost.gltf"], "lost.gltf: its buffer lost.bin: there is no such file", false),
    (&["new", "a.ply"], "a.ply: is a PLY mesh, which Plica does not read (export it as .glb or .obj", false),
    (&["new", "b.STL"], "b.STL: is an STL mesh, which Plica does not read", false),
    (
        &["new", "huge.obj"],
        "huge.obj: its coordinates reach 1e30 m, and no camera sees more than 1e8 m (scale it down",
        false,
    ),
    (&["new", "from/far.gltf"], "../square.bin, which is not in the model's folder (give --allow-outside", false),
    (
        &["new", "from/far.gltf", "--allow-outside", "-o", "to/far.plica.json"],
        "names ../square.bin, which is not in its folder and cannot be copied with it (make the scene beside it)",
        false,
    ),
    (&["new", "from/far.gltf", "--allow-outside"], "the scene needs --allow-outside wherever", true),
    (&["check", "from/far.plica.json"], "1 error", false),
    (&["check", "from/far.plica.json", "--allow-outside"], "no problems", true),
    (&["new", "from/out.gltf"], "its picture is not shown: out.gltf: has a part at ../cat.png", true),
    (
        &["new", "from/out.gltf", "--allow-outside", "-o", "from/seen.plica.json"],
        "the scene needs --allow-outside wherever",
        true,
    ),
    (
        &["new", "from/unwrapped.gltf"],
        "its picture is not shown: the mesh has no texture coordinates (unwrap it)",
        true,
    ),
    (&["check", "flat.obj"], "flat.obj: is a model, not a scene (plica edit flat.obj makes a scene of it)", false),
    (&["render", "cat.png", "-o", "x.png"], "cat.png: is a picture, not a scene (plica edit cat.png", false),
    (&["new", "flat0.obj"], "nothing of the mesh \"flat0\" is seen: none of its triangles has an area", true),
    (&["new", "from/bare.gltf"], "from/bare.gltf: its picture is not shown: gone.png: there is no such file", true),
    (&["new", "cat.obj"], "cat.obj: is a PNG picture, not a mesh (rename it if it is to be shown as a picture;", false),
    (&["new", ""], "a word of the line is empty, as \"\" is", false),
    (&["new", "flat.obj", "-o", "from"], "from: is a folder (name a file in it, as from/NAME.plica.json)", false),
    (&["new", "dir.obj"], "dir.obj: is a folder, not a model (name the model in it)", false),
    (&["new", "flat.obj", "./flat.obj"], "./flat.obj: is named twice (name it once", false),
    (&["new", "flatt.glb"], "flatt.glb: there is no such file (did you mean flat.obj?)", false),
    (&["new", "notez.obj"], "notez.obj: there is no such file (put it there, or mend the name)", false),
    (&["new", "notes.md"], "a model (.obj, .glb, .gltf) or a clip (falls/%04d.jpg, a folder of numbered", false),
];

#[test]
fn what_of_a_model_cannot_be_read_is_told() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("broken.obj"), "v 0 0\nf 1 1 1\n").unwrap();
    std::fs::write(at("cat.obj"), std::fs::read(at("cat.png")).unwrap()).unwrap();
    std::fs::write(at("lost.gltf"), gltf("lost.bin", "x.png")).unwrap();
    std::fs::write(at("from/bare.gltf"), gltf("parts/square.bin", "gone.png")).unwrap();
    std::fs::write(at("from/far.gltf"), gltf("../square.bin", "parts/skin.png")).unwrap();
    std::fs::write(at("from/out.gltf"), gltf("parts/square.bin", "../cat.png")).unwrap();
    let unwrapped = gltf("parts/square.bin", "parts/skin.png").replace(r#","TEXCOORD_0":1"#, "");
    assert!(!unwrapped.contains("TEXCOORD"));
    std::fs::write(at("from/unwrapped.gltf"), unwrapped).unwrap();
    std::fs::write(at("square.bin"), square()).unwrap();
    std::fs::write(at("flat0.obj"), "v 0 0 0\nf 1 1 1\n").unwrap();
    std::fs::create_dir(at("dir.obj")).unwrap();
    std::fs::write(at("notes.md"), "# Notes\n").unwrap();
    std::fs::write(at("a.ply"), "ply\nformat ascii 1.0\n").unwrap();
    std::fs::write(at("b.STL"), [0; 84]).unwrap();
    std::fs::write(at("huge.obj"), "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    for (args, told, succeeds) in TOLD {
        let (_, messages) = plica(folder.path(), args, *succeeds);
        assert!(messages.contains(told), "{args:?}: {messages}");
    }
    assert_eq!(
        get(&at("from"), "bare.plica.json", "layers.bare"),
        json!({ "kind": "mesh", "name": "bare", "mesh": "bare", "surface": { "kind": "plain", "color": "#ffffff" } })
    );
    let (told, _) = plica(&at("from"), &["check", "--lenient", "bare.plica.json"], true);
    assert!(
        told.contains("meshes.bare.path: warning: bare.gltf: its picture gone.png: there is no such file"),
        "{told}"
    );
    let seen = plica(&at("from"), &["get", "--allow-outside", "seen.plica.json", "images.cat.path"], true);
    assert_eq!(seen.0, "\"../cat.png\"\n");
    assert!(!at("to/far.gltf").exists() && !at("to/far.plica.json").exists() && !at("lost.plica.json").exists());
}

/// A list of two pictures: of one from the front, and of one from behind for testing; a mesh and the pictures beside it.
fn shots(folder: &Path) {
    let (at, look) = (folder.join("shots"), [[1, 0, 0], [0, -1, 0], [0, 0, -1]]);
    std::fs::create_dir_all(at.join("images")).unwrap();
    std::fs::copy(folder.join("flat.obj"), at.join("wall.obj")).unwrap();
    for (name, alpha) in [("front.png", 255), ("back.png", 255)] {
        RgbaImage::from_pixel(40, 20, image::Rgba([90, 0, 0, alpha])).save(at.join("images").join(name)).unwrap();
    }
    let view = |file: &str, split: &str| {
        json!({ "file": format!("images/{file}"), "split": split, "width": 40, "height": 20, "fx": 30, "fy": 30,
            "cx": 20, "cy": 10, "R": look, "t": [0, 7, 9] })
    };
    let list = json!({ "mesh": "wall.obj", "views": [view("front.png", "train"), view("back.png", "test")] });
    std::fs::write(at.join("cameras.json"), list.to_string()).unwrap();
}

#[test]
fn a_map_that_needs_more_memory_than_is_allowed_is_rendered_without_what_it_needs() {
    let folder = folder();
    let at = folder.path();
    shots(at);
    let view = json!({ "name": "a", "image": "a", "camera": { "position": [0, 7, 9], "target": [0, 7, 0] } });
    let surface = json!({ "kind": "view-map", "levels": 4, "views": [view] });
    let scene = json!({ "plica": 1, "size": [8, 8], "camera": { "position": [0, 7, 9], "target": [0, 7, 0] },
        "images": { "a": { "path": "images/front.png" } }, "meshes": { "wall": { "path": "wall.obj" } },
        "layers": [{ "kind": "mesh", "name": "wall", "mesh": "wall", "surface": surface }] });
    std::fs::write(at.join("shots/s.plica.json"), scene.to_string()).unwrap();
    for (limit, told) in [("300000", true), ("40000000", false)] {
        for pass in [&[][..], &["--pass", "independent"]] {
            let line = ["render", "shots/s.plica.json", "-o", "o.png", "--limit", &format!("memory={limit}")];
            let (_, said) = plica(at, &[&line[..], pass].concat(), true);
            assert_eq!(
                said.contains("layers.wall.surface: warning: needs ") && said.contains(" is shown"),
                told,
                "{said}"
            );
        }
    }
}

#[test]
fn cameras_of_other_programs_become_views_once() {
    let folder = folder();
    let at = folder.path();
    shots(at);
    plica(at, &["new", "cat.png", "-o", "to/a.plica.json"], true);
    let import = ["views", "import", "shots/cameras.json", "to/a.plica.json"];
    let (_, told) = plica(at, &import, true);
    for line in [
        "1 pictures for testing are left out; --all takes them",
        "1 picture laid on wall",
        "1 of 1 cameras see the mesh",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
    // Files that are elsewhere are copied; the camera of the first picture is that of the scene.
    assert!(at.join("to/images/front.png").is_file() && at.join("to/wall.obj").is_file());
    let camera = get(at, "to/a.plica.json", "camera");
    assert_eq!((&camera["position"], &camera["target"]), (&json!([0, 7, 9]), &json!([0, 7, 0])));
    let view = get(at, "to/a.plica.json", "layers.wall.surface.views.front");
    assert_eq!(view["camera"]["matrix"], json!([[1, 0, 0, 0], [0, -1, 0, 7], [0, 0, -1, 9]]));
    assert_eq!((&view["image"], &view["feather"]), (&json!("front"), &json!(1)), "its alpha ends nowhere");
    let before = std::fs::read_to_string(at.join("to/a.plica.json")).unwrap();
    let (_, told) = plica(at, &import, true);
    assert!(told.contains("1 lie there already"), "{told}");
    assert_eq!(std::fs::read_to_string(at.join("to/a.plica.json")).unwrap(), before);
    // What the wall shows is the picture.
    assert_eq!(rendered(at, "to/a.plica.json").get_pixel(40, 30).0, [90, 0, 0, 255]);
    let lines = plica(at, &["views", "to/a.plica.json", "--json"], true).0;
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(
        (&lines[0]["view"], &lines[0]["layer"], &lines[1]["map"]["charts"]),
        (&json!("front"), &json!("wall"), &json!(1))
    );

    let (_, told) = plica(at, &["views", "import", "shots/cameras.json", "to/a.plica.json", "--names", "x*"], false);
    assert!(told.contains("has no pictures, or none that are meant"), "{told}");
    plica(
        at,
        &["views", "add", "cat", "to/a.plica.json", "--image", "cat", "--position", "0,7,-5", "--target", "0,7,0"],
        true,
    );
    assert_eq!(get(at, "to/a.plica.json", "layers.wall.surface.views.cat.camera.position"), json!([0, 7, -5]));
    let (_, told) =
        plica(at, &["views", "add", "cat", "to/a.plica.json", "--image", "cat", "--position", "0,7,5"], false);
    assert!(told.contains("the name \"cat\" is taken by another view"), "{told}");

    // A picture of another shape, from the list and in a scene: all are told.
    RgbaImage::new(40, 30).save(at.join("shots/images/front.png")).unwrap();
    let (_, told) = plica(at, &["views", "import", "shots/cameras.json", "b.plica.json"], false);
    assert!(told.contains("images/front.png: the picture is 40x30, its camera is for 40x20"), "{told}");
    plica(at, &["views", "import", "shots/cameras.json", "to/a.plica.json", "--all", "--names", "back*"], true);
    let sizes = ["front", "back"].map(|view| format!("layers.wall.surface.views.{view}.camera.size=[41,30]"));
    plica(at, &["set", "to/a.plica.json", &sizes[0], &sizes[1]], true);
    let (told, _) = plica(at, &["check", "to/a.plica.json"], false);
    assert_eq!(told.matches("the picture is 40x20, its camera is for").count(), 2, "{told}");
}

/// What was not painted stays as it was, and what is painted over can be drawn anew.
#[test]
fn the_first_view_keeps_the_look_of_a_mesh() {
    let folder = folder();
    let at = folder.path();
    plica(at, &["new", "flat.obj", "-o", "b.plica.json"], true);
    plica(at, &["set", "b.plica.json", "size=[64,48]"], true);
    let before = rendered(at, "b.plica.json");
    let add =
        ["views", "add", "spot", "b.plica.json", "--image", "cat.png", "--position", "0,7,-9", "--target", "0,7,0"];
    let (_, told) = plica(at, &add, true);
    assert!(
        told.contains("of it as it was are its base coat") && at.join("views/spot-base-front.png").is_file(),
        "{told}"
    );
    let after = rendered(at, "b.plica.json");
    let far = before.pixels().zip(after.pixels()).filter(|(a, b)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 3)).count();
    assert!(far * 50 < before.pixels().filter(|pixel| pixel.0[3] > 0).count(), "{far}");
    plica(at, &["views", "guide", "base-front", "b.plica.json", "-o", "over.png"], true);
    let (own, guide) =
        (image::open(at.join("views/spot-base-front.png")).unwrap(), image::open(at.join("over.png")).unwrap());
    assert_eq!(own.width(), guide.width());
    let (_, told) = plica(at, &["views", "guide", "spot", "b.plica.json"], true);
    assert!(
        told.contains("views/spot-guide.png is what is seen without \"spot\"")
            && at.join("views/spot-guide.png").is_file()
    );
    let (_, told) = plica(at, &["views", "guide", "sport", "b.plica.json"], false);
    assert!(told.contains("there is no view \"sport\" (did you mean \"spot\"?)"), "{told}");
}

/// Finer ones would only be lost, and be warned of.
#[test]
fn pictures_that_keep_the_look_are_no_finer_than_the_map() {
    let folder = folder();
    let at = folder.path();
    plica(at, &["new", "flat.obj", "-o", "b.plica.json"], true);
    let add =
        ["views", "add", "spot", "b.plica.json", "--image", "cat.png", "--position", "0,7,-9", "--target", "0,7,0"];
    plica(at, &add, true);
    let lines = plica(at, &["views", "b.plica.json", "--json"], true).0;
    let rows = lines.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let of_base = |row: &Value| row["view"].as_str().is_some_and(|name| name.starts_with("base-"));
    let depths: Vec<(f64, f64)> =
        rows.filter(of_base).map(|row| (row["depth"].as_f64().unwrap(), row["beyond"].as_f64().unwrap())).collect();
    assert!(depths.iter().any(|(depth, _)| *depth > 4.0), "as fine as the finest layer: {depths:?}");
    assert!(depths.iter().all(|(_, beyond)| *beyond <= 0.25), "{depths:?}");
}
