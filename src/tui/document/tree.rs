//! The tree of the scene: all nodes by name. Lists of named items (layers, zones) show as their items; other lists are leaves
//! with a count, and their items are the rows of a table.

use crate::base::pointer::Pointer;
use crate::tui::text::plain;
use std::collections::BTreeSet;

use kurbo::Point;
use serde_json::Value;

use super::cell;
use crate::scene::Document;
use crate::scene::field::{self, Child, Kind};
use crate::scene::schema::{Body, Place, Shape};

/// A row of the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeRow {
    /// Where the node is.
    pub pointer: String,
    /// Its name.
    pub label: String,
    /// A word on what it is, or how many items it has.
    pub note: String,
    /// How deep it is in the tree.
    pub depth: usize,
    /// Whether it is collapsed; `None` if nothing is below it.
    pub collapsed: Option<bool>,
}

/// The rows of the tree, from the scene itself down.
pub fn rows(document: &Document, collapsed: &BTreeSet<String>) -> Vec<TreeRow> {
    let scene =
        TreeRow { pointer: String::new(), label: "scene".into(), note: String::new(), depth: 0, collapsed: None };
    let mut rows = vec![scene];
    below(Place::root(document.json()), "", 0, collapsed, &mut rows);
    rows
}

fn below(place: Place, pointer: &str, depth: usize, collapsed: &BTreeSet<String>, rows: &mut Vec<TreeRow>) {
    for (child, place) in field::below(place, pointer) {
        let value = place.value.filter(|value| cell::is_node(&child.field.kind) && !value.is_null());
        let Some(value) = value else { continue };
        if named(value) {
            below_list(place, &child.pointer, depth, collapsed, rows);
        } else {
            rows.push(leaf(child, value, depth));
        }
    }
}

/// The items of a list of named items, each with what is below it.
fn below_list(list: Place, pointer: &str, depth: usize, collapsed: &BTreeSet<String>, rows: &mut Vec<TreeRow>) {
    for (item, place) in field::below(list, pointer) {
        let is_collapsed = collapsed.contains(&item.pointer);
        let label = plain(&item.name);
        let inside = item.pointer.clone();
        rows.push(TreeRow { pointer: item.pointer, label, note: String::new(), depth, collapsed: Some(is_collapsed) });
        if !is_collapsed {
            below(place, &inside, depth + 1, collapsed, rows);
        }
    }
}

fn leaf(child: Child, value: &Value, depth: usize) -> TreeRow {
    let is_form = child.field.kind == Kind::Object;
    let note = if is_form { String::new() } else { cell::summary(&child.field, value) };
    TreeRow { pointer: child.pointer, label: plain(&child.name), note, depth, collapsed: None }
}

/// Whether a value is a list of named items.
fn named(value: &Value) -> bool {
    value.as_array().is_some_and(|items| items.first().is_some_and(|item| item.get("name").is_some()))
}

/// The row for the node at `pointer`: its own, else that of its nearest ancestor.
pub fn row_of(rows: &[TreeRow], pointer: &str) -> usize {
    let above = |row: &TreeRow| Pointer(pointer).is_within(&row.pointer);
    let deepest = rows.iter().enumerate().filter(|(_, row)| above(row)).max_by_key(|(_, row)| row.pointer.len());
    deepest.map_or(0, |(i, _)| i)
}

/// The node that is shown first: the first named item in the first layer (a zone), else the first layer, else the scene.
pub fn first(document: &Document) -> String {
    match document.json().pointer(FIRST_LAYER) {
        Some(_) => first_item(document).unwrap_or_else(|| FIRST_LAYER.into()),
        None => String::new(),
    }
}

const FIRST_LAYER: &str = "/layers/0";

/// The first named item in the first layer.
fn first_item(document: &Document) -> Option<String> {
    let fields = document.json().pointer(FIRST_LAYER)?.as_object()?;
    let (list, _) = fields.iter().find(|(_, value)| named(value))?;
    Some(Pointer(&Pointer(FIRST_LAYER).join(list)).join(0))
}

/// The word for the named items of the layer that the node at `pointer` belongs to, as the schema has it: "zone". `None` if
/// such a layer has no named items, or if there is no layer.
pub fn item_word(document: &Document, pointer: &str) -> Option<&'static str> {
    let layer = Place::of(document.json(), &format!("/layers/{}", layer_of(pointer).unwrap_or(0)))?;
    let named = |list: Shape| matches!(list.body(), Body::List(item, ..) if item.property(None, "name").is_some());
    let lists = layer.shape.properties(layer.value);
    lists.into_iter().find(|(_, shape)| named(*shape)).map(|(name, _)| name.trim_end_matches('s'))
}

/// The index of the layer that the node at `pointer` belongs to.
pub fn layer_of(pointer: &str) -> Option<usize> {
    Pointer(pointer).item_of("/layers").map(|(layer, _)| layer)
}

/// Where the cursor of the picture starts: the center of the first named item in the first layer.
pub fn picture_center(document: &Document) -> Point {
    let layer = document.scene().layers.first().zip(first_item(document));
    let middle = layer.map(|(layer, item)| layer.technique().bounds(&item[FIRST_LAYER.len()..]).center());
    middle
        .filter(|p| p.x.is_finite() && p.y.is_finite())
        .map_or(Point::ZERO, |p| Point::new(p.x.floor() + 0.5, p.y.floor() + 0.5))
}
