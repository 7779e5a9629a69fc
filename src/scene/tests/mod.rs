//! Tests of the room as a whole, on two scenes: a small one, and one that holds every kind of thing.

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

/// Every place of a document below the whole, also those that are not written.
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
