//! The tree of the scene: what has an inside of its own, by name. Lists of named things (layers, zones) show as those
//! things; other lists are leaves with a count, their items are the rows of a table.

use crate::tui::text::plain;
use std::collections::BTreeSet;

use kurbo::Point;
use serde_json::Value;

use super::sheet;
use crate::layers::Layer;
use crate::scene::Document;
use crate::scene::field::{self, Child, Kind};
use crate::scene::schema::Place;

/// A row of the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeRow {
    /// Where the node is.
    pub pointer: String,
    /// Its name.
    pub label: String,
    /// What it is or how much is in it, in a word.
    pub note: String,
    /// How deep it stands.
    pub depth: usize,
    /// Whether it is folded; `None` if nothing is below it.
    pub folded: Option<bool>,
}

/// The rows of the tree, from the scene itself down.
pub fn rows(document: &Document, folded: &BTreeSet<String>) -> Vec<TreeRow> {
    let scene = TreeRow { pointer: String::new(), label: "scene".into(), note: String::new(), depth: 0, folded: None };
    let mut rows = vec![scene];
    below(Place::root(document.json()), "", 0, folded, &mut rows);
    rows
}

fn below(place: Place, pointer: &str, depth: usize, folded: &BTreeSet<String>, rows: &mut Vec<TreeRow>) {
    for (child, place) in field::below(place, pointer) {
        let value = place.value.filter(|value| sheet::is_node(&child.field.kind) && !value.is_null());
        let Some(value) = value else { continue };
        if named(value) {
            below_list(place, &child.pointer, depth, folded, rows);
        } else {
            rows.push(leaf(child, value, depth));
        }
    }
}

/// The items of a list of named things, each with what is below it.
fn below_list(list: Place, pointer: &str, depth: usize, folded: &BTreeSet<String>, rows: &mut Vec<TreeRow>) {
    for (item, place) in field::below(list, pointer) {
        let is_folded = folded.contains(&item.pointer);
        let label = plain(&item.name);
        let inside = item.pointer.clone();
        rows.push(TreeRow { pointer: item.pointer, label, note: String::new(), depth, folded: Some(is_folded) });
        if !is_folded {
            below(place, &inside, depth + 1, folded, rows);
        }
    }
}

fn leaf(child: Child, value: &Value, depth: usize) -> TreeRow {
    let note = match child.field.kind {
        Kind::Object => String::new(),
        _ => sheet::summary(&child.field, value),
    };
    TreeRow { pointer: child.pointer, label: plain(&child.name), note, depth, folded: None }
}

/// Whether a value is a list of named things.
fn named(value: &Value) -> bool {
    value.as_array().is_some_and(|items| items.first().is_some_and(|item| item.get("name").is_some()))
}

/// The row that stands for the node at `pointer`: its own, else the nearest one above it.
pub fn row_of(rows: &[TreeRow], pointer: &str) -> usize {
    let above =
        |row: &TreeRow| pointer.strip_prefix(&row.pointer).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
    let deepest = rows.iter().enumerate().filter(|(_, row)| above(row)).max_by_key(|(_, row)| row.pointer.len());
    deepest.map_or(0, |(i, _)| i)
}

/// The node to begin with: the first zone, else the first layer, else the scene.
pub fn first(document: &Document) -> String {
    let there = |pointer: &&str| document.json().pointer(pointer).is_some();
    ["/layers/0/zones/0", "/layers/0"].iter().find(|p| there(p)).map_or(String::new(), |p| p.to_string())
}

/// The index of the layer and of the zone that the node at `pointer` belongs to.
pub fn place(pointer: &str) -> (Option<usize>, Option<usize>) {
    let tokens: Vec<&str> = pointer.split('/').skip(1).collect();
    let layer = tokens.get(1).filter(|_| tokens[0] == "layers").and_then(|i| i.parse().ok());
    let zone = tokens.get(3).filter(|_| layer.is_some() && tokens[2] == "zones").and_then(|i| i.parse().ok());
    (layer, zone)
}

/// Where the cursor of the picture begins: the middle of the first zone.
pub fn picture_centre(document: &Document) -> Point {
    let Some(Layer::Picture(layer)) = document.scene().layers.first() else { return Point::ZERO };
    let middle = layer.zones.first().map(|zone| zone.outline.polygon().bounds().center());
    middle
        .filter(|p| p.x.is_finite() && p.y.is_finite())
        .map_or(Point::ZERO, |p| Point::new(p.x.floor() + 0.5, p.y.floor() + 0.5))
}
