//! The pictures of models: which are named, and those in the file itself.

use base64::Engine;
use image::{DynamicImage, ImageBuffer, Rgb};
use serde_json::json;

use super::built::{glb, put, square, views};
use super::*;
use crate::files::picture;

fn png(width: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let image: DynamicImage = ImageBuffer::from_pixel(width, 1, Rgb([255u8, 0, 0])).into();
    image.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

/// A model that shows image 2, then 0, then 1; each is one pixel wider than the one before it.
fn model() -> Vec<u8> {
    let (mut json, binary) = square();
    let encoded = base64::engine::general_purpose::STANDARD.encode(png(2));
    let (mut view, all) = views(&[&binary, &png(1)]);
    json["bufferViews"].as_array_mut().unwrap().push(view[1].take());
    put(&mut json, "/buffers/0/byteLength", json!(all.len()));
    json["images"] = json!([
        { "bufferView": 4, "mimeType": "image/png" },
        { "uri": format!("data:image/png;base64,{encoded}") },
        { "uri": "skins/red%20one.png" },
        {},
    ]);
    json["textures"] = json!([
        { "source": 0 },
        { "extensions": { "EXT_texture_webp": { "source": 1 } } },
        { "source": 2 },
        { "extensions": { "KHR_texture_basisu": { "source": 3 } } },
    ]);
    let of = |texture: usize| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } });
    json["materials"] = json!([of(2), of(0), of(1), of(3), {}]);
    let part = |material: usize| json!({ "attributes": { "POSITION": 0 }, "indices": 3, "material": material });
    json["meshes"] =
        json!([{ "primitives": [part(0), part(1), part(0), part(4)] }, { "primitives": [part(2), part(3)] }]);
    json["nodes"] = json!([{ "mesh": 0, "children": [1, 2] }, { "mesh": 0 }, { "mesh": 1 }]);
    glb(&json, &all)
}

#[test]
fn the_pictures_of_a_model_are_named_as_a_scene_names_them() {
    let names = pictures(file(&model()), "sub/cow.glb", &Options::default()).unwrap();
    assert_eq!(names, ["sub/skins/red one.png", "sub/cow.glb#0", "sub/cow.glb#1"]);
    let none = pictures(file(b"v 0 0 0\nf 1 1 1\n"), "a.obj", &Options::default()).unwrap();
    assert_eq!(none, [""; 0]);
}

#[test]
fn a_picture_in_a_model_is_read_by_its_number() {
    let limits = Limits::default();
    let read = |place: &str| {
        let found = picture::decode(file(&model()), place, &limits, &limits.budget());
        found.map(|(found, _)| found.picture.width()).map_err(|error| error.to_string())
    };
    assert_eq!(read("cow.glb#0"), Ok(1));
    assert_eq!(read("cow.GLB#1"), Ok(2));
    assert_eq!(picture::header(file(&model()), "cow.glb#1", &limits).unwrap(), (2, 1));
    for (place, expected) in [
        ("sub/cow.glb#2", "image 2 is not in the file (name it by sub/skins/red one.png)"),
        ("cow.glb#3", "image 3 is empty (export it again)"),
        ("cow.glb#4", "there is no picture 4 in the model (there are cow.glb#0 to cow.glb#3)"),
    ] {
        assert_eq!(read(place).unwrap_err(), format!("{place}: {expected}"));
    }
}

#[test]
fn a_layer_takes_over_what_the_first_material_with_a_picture_says_and_else_the_first() {
    let color = |color: [f32; 4]| json!({ "baseColorFactor": color });
    let of = |material: usize| json!({ "attributes": { "POSITION": 0 }, "material": material });
    let bare = json!({ "attributes": { "POSITION": 0 } });
    let line = json!({ "attributes": { "POSITION": 0 }, "material": 1, "mode": 1 });
    let red = json!({ "name": "red", "pbrMetallicRoughness": color([1.0, 0.0, 0.0, 0.5]) });
    let skin = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } }, "doubleSided": true });
    let glass = json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": color([0.2158605, 1.0, 0.0, 0.5]) });
    for (materials, primitives, expected, both_sides, left_out) in [
        (json!([]), json!([bare]), None, false, &[][..]),
        (json!([{}]), json!([of(0)]), Some("#ffffff"), false, &[]),
        (json!([red, skin]), json!([of(0), of(0), line]), Some("#ff0000"), false, &[]),
        (json!([glass]), json!([of(0)]), Some("#80ff0080"), false, &[]),
        (
            json!([red, skin]),
            json!([of(0), of(1), bare]),
            Some("#ffffff"),
            true,
            &["\"red\"", "that of parts without one"],
        ),
        (json!([skin, red, glass]), json!([of(1), of(2)]), Some("#ff0000"), false, &["2"]),
    ] {
        let (mut json, binary) = square();
        json["materials"] = materials;
        json["textures"] = json!([{ "source": 0 }]);
        json["meshes"] = json!([{ "primitives": primitives }]);
        let found = looks(file(&glb(&json, &binary)), "a.glb", &Options::default()).unwrap();
        let left_out = left_out.iter().map(|name| (*name).to_owned()).collect();
        assert_eq!(found, Looks { color: expected.map(str::to_owned), both_sides, left_out });
    }
}
