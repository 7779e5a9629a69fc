//! Tests of this room as a whole, on two scenes: a small one, and one with every kind of thing.

mod edits;
mod fields;
mod reread;
mod undo;

use super::field::{Field, Kind, children};
use super::history::Stamp;
use super::*;

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
