//! Tests of edits, addresses and history on one scene.

use serde_json::json;

use super::*;

const SQUINT: &str = include_str!("../../tests/scenes/good/squint.plica.json");

fn squint() -> Document {
    Document::parse(SQUINT).unwrap()
}

fn set(document: &Document, address: &str, value: serde_json::Value) -> Document {
    let path = address::resolve(document, address).unwrap();
    let edit = Edit::set(document, &path, value);
    let changed = document.apply(&edit).unwrap_or_else(|problems| panic!("{address}: {problems:?}"));
    let back = changed.apply(&edit.inverse(document)).unwrap();
    assert_eq!(back.to_text(), document.to_text(), "{address}");
    changed
}

#[test]
fn set_makes_parents_and_keeps_what_fits() {
    let eye = "layers.face.zones.\"left eye\"";
    let zone = |rest: &str| format!("{eye}.{rest}");
    for (address, value, at, expected) in [
        ("interpolation.radius", json!(12), "interpolation", json!({ "method": "modified-shepard", "radius": 12 })),
        ("interpolation.method", json!("thin-plate"), "interpolation", json!({ "method": "thin-plate" })),
        (
            "interpolation.method",
            json!("modified-shepard-random"),
            "interpolation",
            json!({ "method": "modified-shepard-random", "radius": 60, "ring": 12.5 }),
        ),
        (
            "outline.kind",
            json!("rectangle"),
            "outline",
            json!({ "kind": "rectangle", "x": 110, "y": 80, "width": 100, "height": 70 }),
        ),
        ("sampler.offset", json!([1, 2]), "sampler", json!({ "image": "cat", "offset": [1, 2] })),
        ("fold", json!(null), "fold", json!(null)),
        ("motion.0.jump.y", json!(-20), "motion.0", json!({ "tool": "point", "at": [150, 100], "jump": [0, -20] })),
        ("position.function", json!("cosine"), "position", json!({ "function": "cosine", "cycles": 0.5 })),
    ] {
        let changed = set(&squint(), &zone(address), value);
        let path = address::resolve(&changed, &zone(at)).unwrap();
        assert_eq!(field::value(&changed, &path), Some(expected), "{address}");
    }
    let bare = Document::new(&[("cat", "cat.png", 9, 9)]).unwrap();
    for (address, value, at, expected) in [
        ("timeline.fps", json!(24), "/timeline", json!({ "fps": 24 })),
        (
            "layers.cat.zones.all.interpolation.power",
            json!(3),
            "/layers/0/zones/0/interpolation",
            json!({ "method": "shepard", "power": 3 }),
        ),
        (
            "layers.cat.zones.all.position.function",
            json!("sigmoid"),
            "/layers/0/zones/0/position",
            json!({ "function": "sigmoid" }),
        ),
    ] {
        assert_eq!(set(&bare, address, value).json().pointer(at), Some(&expected), "{address}");
    }
    let changed = set(&squint(), "layers.0.zones.0.fold.rule", json!("mask"));
    assert_eq!(changed.json()["layers"][0]["zones"][0]["fold"], json!({ "rule": "mask", "image": "cat" }));
}
