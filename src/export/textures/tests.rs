//! What is in the folder. `tests/player.rs` plays it.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::base::pixels::Frame;
use crate::files::outputs::Guard;
use crate::layers::parts::materials::Materials;
use crate::render;

fn materials() -> Materials {
    let smooth = |x: usize, y: usize, k: usize| {
        let wave = |a: usize| {
            ((a * 37 % 256) as f64 / 255.0 * 0.1 + 0.45 + 0.4 * crate::base::maths::sin(a as f64 / 9.0)) * 255.0
        };
        [wave(x + k) as u8, wave(y + 2 * k) as u8, wave(x + y + 5 * k) as u8, 255]
    };
    let picture = |w: usize, h: usize, alpha: &dyn Fn(usize, usize) -> u8, k: usize| {
        let cell = |i: usize| {
            let [r, g, b, _] = smooth(i % w, i / w, k);
            [r, g, b, alpha(i % w, i / w)]
        };
        Arc::new(Frame::from_cells(w, h, (0..w * h).map(cell).collect()).to_linear().into())
    };
    let hole = |x: usize, y: usize| if x.abs_diff(45) + y.abs_diff(30) < 15 { 0 } else { 255 };
    Materials {
        pictures: [
            ("cat".to_owned(), picture(80, 60, &|_, _| 255, 0)),
            ("mask".to_owned(), picture(80, 60, &hole, 0)),
            ("other".to_owned(), picture(31, 23, &|x, _| if x < 10 { 200 } else { 255 }, 40)),
        ]
        .into(),
        ..Materials::default()
    }
}

fn zone(extra: Value) -> Value {
    let mut zone = json!({
        "name": "zone", "outline": { "kind": "ellipse", "center": [40, 30], "radii": [25, 20] },
        "motion": [{ "tool": "point", "at": [40, 30], "jump": [18, -11.3] }, { "tool": "still-border", "spacing": 5 }],
        "interpolation": { "method": "shepard", "power": 1.5 }
    });
    for (name, value) in extra.as_object().unwrap() {
        zone[name] = value.clone();
    }
    zone
}

fn scene(wrap: &str, zones: Vec<Value>) -> Scene {
    serde_json::from_value(json!({
        "plica": 1, "title": "Test", "timeline": { "duration": 1.0, "fps": 12, "loop": wrap },
        "images": { "cat": { "path": "cat.png" }, "mask": { "path": "m.png" }, "other": { "path": "o.png" } },
        "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": zones }]
    }))
    .unwrap()
}

/// A zone, and one that reads another image under a name that is no file name.
fn two() -> Scene {
    let regions = json!([{ "kind": "rectangle", "x": 38, "y": 10, "width": 9.5, "height": 40 }, { "kind": "ellipse", "center": [55, 25], "radii": [4, 6] }]);
    let other = zone(json!({
        "name": "Second/zone", "sampler": { "image": "other", "offset": [-30.25, -20] },
        "fold": { "rule": "fly-over", "regions": regions }
    }));
    scene("repeat", vec![zone(json!({})), other])
}

fn manifest(dir: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap()
}

fn place(dir: &Path) -> FolderPlace {
    Guard::new(false).folder(dir, &|_| true, earlier(dir)).unwrap()
}

fn written(scene: &Scene, materials: &Materials, depth: Depth) -> (tempfile::TempDir, Synth) {
    let dir = tempfile::tempdir().unwrap();
    let synth = render::synth(scene, materials, None).unwrap();
    write(scene, &synth, depth, &place(&dir.path().join("out")), &mut |_, _| Ok(())).unwrap();
    (dir, synth)
}

#[test]
fn names_are_plain_and_nothing_else_is_left() {
    let (dir, _) = written(&two(), &materials(), Depth::Float);
    let mut names: Vec<_> = std::fs::read_dir(dir.path().join("out"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let wanted = [
        "Second-zone-init.exr",
        "Second-zone-jump.exr",
        "Second-zone-thresholds.exr",
        "colour.png",
        "function.exr",
        "manifest.json",
        "zone-init.exr",
        "zone-jump.exr",
    ];
    assert_eq!(names, wanted);
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn an_interrupt_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let scene = &two();
    let synth = render::synth(scene, &materials(), None).unwrap();
    let mut step = |done, _| if done == 1 { Err(Error::Interrupted) } else { Ok(()) };
    assert!(write(scene, &synth, Depth::Float, &place(&dir.path().join("out")), &mut step).is_err());
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn pieces_are_cropped_to_what_is_reached() {
    let (dir, _) = written(&two(), &materials(), Depth::Float);
    let manifest = manifest(&dir.path().join("out"));
    let pieces = manifest["colour"]["pieces"].as_array().unwrap();
    let index = |value: &Value, name: &str| value[name].as_u64().unwrap();
    assert_eq!((pieces.len(), index(&pieces[0], "width"), index(&pieces[0], "height")), (2, 80, 60));
    assert!(index(&pieces[1], "width") <= 33 && index(&pieces[1], "height") <= 25, "{}", pieces[1]);
}

#[test]
fn colors_under_alpha_0_and_light_above_white_are_kept() {
    let mut materials = materials();
    let codes = (0..80 * 60).flat_map(|i| [250, (i % 256) as u8, 10, if i % 80 < 40 { 255 } else { 0 }]).collect();
    let light = crate::base::picture::SRGB_8.clone();
    let samples = crate::base::picture::Samples::Bytes(codes, light);
    let bled = crate::base::picture::Picture::new(80, 60, crate::base::picture::Channels::Rgba, samples);
    materials.pictures.insert("cat".into(), Arc::new(bled));
    let (dir, _) = written(&scene("repeat", vec![]), &materials, Depth::Float);
    let image = image::open(dir.path().join("out/colour.png")).unwrap().to_rgba8();
    assert_eq!((image.get_pixel(30, 0).0, image.get_pixel(50, 1).0), ([250, 30, 10, 255], [250, 130, 10, 0]));
    assert_eq!(manifest(&dir.path().join("out"))["colour"].get("float"), None);
    let bright = crate::base::picture::Picture::filled(80, 60, [7.5, 0.25, 0.0, 1.0]);
    materials.pictures.insert("cat".into(), Arc::new(bright));
    let (dir, _) = written(&scene("repeat", vec![]), &materials, Depth::Float);
    assert_eq!(manifest(&dir.path().join("out"))["colour"]["float"]["file"], "colour.exr");
    let image = image::open(dir.path().join("out/colour.exr")).unwrap().to_rgba32f();
    assert_eq!(image.get_pixel(9, 9).0, [7.5, 0.25, 0.0, 1.0]);
}
