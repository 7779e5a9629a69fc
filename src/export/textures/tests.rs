//! What is in the folder. `tests/player.rs` plays it.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::base::clip::Clip;
use crate::base::picture::{Channels, Picture, SRGB_8, Samples};
use crate::files::outputs::Guard;
use crate::layers::parts::materials::Materials;
use crate::render;

fn materials() -> Materials {
    let picture = |width, height| Arc::new(Picture::filled(width, height, [0.2, 0.4, 0.6, 1.0]));
    let pictures = [("cat".to_owned(), picture(80, 60)), ("other".to_owned(), picture(31, 23))];
    Materials { pictures: pictures.into(), ..Materials::default() }
}

fn zone(name: &str) -> Value {
    json!({
        "name": name, "outline": { "kind": "ellipse", "center": [40, 30], "radii": [25, 20] },
        "motion": [{ "tool": "point", "at": [40, 30], "jump": [18, -11.3] }]
    })
}

fn scene(wrap: &str, zones: Vec<Value>) -> Scene {
    serde_json::from_value(json!({
        "plica": 1, "title": "Test", "timeline": { "duration": 1.0, "fps": 12, "loop": wrap },
        "images": { "cat": { "path": "cat.png" }, "other": { "path": "o.png" } },
        "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": zones }]
    }))
    .unwrap()
}

/// A zone, and one that reads another image under a name that is no file name.
fn two() -> Scene {
    let regions = json!([{ "kind": "rectangle", "x": 38, "y": 10, "width": 9.5, "height": 40 }, { "kind": "ellipse", "center": [55, 25], "radii": [4, 6] }]);
    let mut other = zone("Second/zone");
    other["sampler"] = json!({ "image": "other", "offset": [-30.25, -20] });
    other["fold"] = json!({ "rule": "fly-over", "regions": regions });
    scene("repeat", vec![zone("zone"), other])
}

fn manifest(dir: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap()
}

fn place(dir: &Path) -> ClearedFolder {
    Guard::new(false).folder(dir, &|_| true, earlier(dir)).unwrap()
}

fn written(scene: &Scene, materials: &Materials, depth: Depth) -> (tempfile::TempDir, Synth) {
    let dir = tempfile::tempdir().unwrap();
    let synth = render::synth(scene, materials, None).unwrap();
    write(scene, &synth, depth.into(), &place(&dir.path().join("out")), &mut |_, _| Ok(())).unwrap();
    (dir, synth)
}

#[test]
fn a_clip_is_refused_with_its_place() {
    let mut moving = zone("water");
    moving["sampler"] = json!({ "clip": "falls" });
    let scene = scene("repeat", vec![zone("zone"), moving]);
    let frame = Arc::new(Picture::filled(4, 4, [0.5; 4]));
    let clips = [("falls".to_owned(), Arc::new(Clip { fps: 25.0, frames: vec![frame; 3] }))].into();
    let synth = render::synth(&scene, &Materials { clips, ..materials() }, None).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let place = place(&dir.path().join("out"));
    let told = write(&scene, &synth, Depth::Float.into(), &place, &mut |_, _| Ok(())).err().unwrap().to_string();
    assert!(told.starts_with("layer \"face\", zone \"water\": reads the clip \"falls\", and textures"), "{told}");
    assert!(!dir.path().join("out").exists(), "nothing is written");
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
    assert!(write(scene, &synth, Depth::Float.into(), &place(&dir.path().join("out")), &mut step).is_err());
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
    let light = SRGB_8.clone();
    let samples = Samples::Bytes(codes, light);
    let bled = Picture::new(80, 60, Channels::Rgba, samples);
    materials.pictures.insert("cat".into(), Arc::new(bled));
    let (dir, _) = written(&scene("repeat", vec![]), &materials, Depth::Float);
    let image = image::open(dir.path().join("out/colour.png")).unwrap().to_rgba8();
    assert_eq!((image.get_pixel(30, 0).0, image.get_pixel(50, 1).0), ([250, 30, 10, 255], [250, 130, 10, 0]));
    assert_eq!(manifest(&dir.path().join("out"))["colour"].get("float"), None);
    let bright = Picture::filled(80, 60, [7.5, 0.25, 0.0, 1.0]);
    materials.pictures.insert("cat".into(), Arc::new(bright));
    let (dir, _) = written(&scene("repeat", vec![]), &materials, Depth::Float);
    assert_eq!(manifest(&dir.path().join("out"))["colour"]["float"]["file"], "colour.exr");
    let image = image::open(dir.path().join("out/colour.exr")).unwrap().to_rgba32f();
    assert_eq!(image.get_pixel(9, 9).0, [7.5, 0.25, 0.0, 1.0]);
}
