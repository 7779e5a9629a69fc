//! Values that come into a scene from elsewhere (the clipboard, a pasted table): whether they fit, and the edit that
//! inserts them with unique names and, in an ascending list, in order.

use std::collections::HashSet;

use serde_json::{Map, Value};

use super::build::{Fresh, camera_for, unique_name, variant_of, write};
use super::edit::Edit;
use super::schema::{Body, Place};
use super::{Document, named, shape};
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::layers::starts::Starts;

/// More items than this are inserted by replacing the whole list: a single operation, however many there are.
const ONE_BY_ONE: usize = 100;

/// Why `value` cannot be put at `path`, by the schema alone; `None` if it can. The problem's path is relative to
/// `path`.
pub fn misfit(document: &Document, path: &str, value: &Value) -> Option<Problem> {
    match Place::of(document.json(), path) {
        Some(place) => shape::problems(place.shape, value).into_iter().next(),
        None => Some(Problem::error("", "there is no such place")),
    }
}

/// Whether the last item of a list comes before its first again, as the corners of a polygon.
pub fn is_closed(document: &Document, list: &str) -> bool {
    let Some((holder, name)) = Pointer(list).split() else { return false };
    let variant = Place::of(document.json(), holder).map_or("", variant_of);
    (Fresh::starts(document, list).closed)(variant, &name)
}

impl Edit {
    /// Adds `items` to the list at `list`, before the one at `index`: names become unique, and in an ascending list
    /// each item goes to its place (if that is taken, a single item goes half way to the next, and several replace what
    /// is there). Returns the edit and the pointer to the first item; `None` if there is no such list, or nothing to
    /// add.
    pub fn insert_all(document: &Document, list: &str, index: usize, items: Vec<Value>) -> Option<(Edit, String)> {
        let place = Place::of(document.json(), list)?;
        let Body::List(..) = place.shape.body() else { return None };
        let old = place.value.and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
        let (holder, name) = Pointer(list).split()?;
        let variant = variant_of(Place::of(document.json(), holder)?);
        let (index, items) = (index.min(old.len()), named_apart(old, items));
        let starts = Fresh::starts(document, list);
        if let Some(key) = (starts.ascending)(variant, &name) {
            let placed = match items.as_slice() {
                [one] => placed_alone(starts, (variant, &name), key, old, one, index)?,
                _ => placed(key, old, items)?,
            };
            return Some((write(document, list, placed.0.into()), Pointer(list).join(placed.1)));
        }
        let first = Pointer(list).join(index);
        if items.is_empty() {
            return None;
        }
        let camera = camera_for(document, list, &items).into_iter();
        if items.len() <= ONE_BY_ONE && document.json().pointer(list).is_some_and(Value::is_array) {
            let each = items.into_iter().enumerate();
            let edits = each.map(|(i, item)| Edit::add(&Pointer(list).join(index + i), item));
            return Some((Edit::all(camera.chain(edits)), first));
        }
        let all: Vec<Value> = old[..index].iter().cloned().chain(items).chain(old[index..].iter().cloned()).collect();
        Some((Edit::all(camera.chain([write(document, list, all.into())])), first))
    }

    /// Adds entries to the map at `map` under unique names. Returns the edit and the pointer to the first entry; `None`
    /// if there is no such map, or nothing to add.
    pub fn insert_entries(document: &Document, map: &str, entries: Map<String, Value>) -> Option<(Edit, String)> {
        let place = Place::of(document.json(), map)?;
        let Body::Map(_) = place.shape.body() else { return None };
        let mut all = place.value.and_then(Value::as_object).cloned().unwrap_or_default();
        let mut first = None;
        for (name, value) in entries {
            let name = unique_name(&name, |name| all.contains_key(name));
            first.get_or_insert_with(|| Pointer(map).join(&name));
            all.insert(name, value);
        }
        Some((write(document, map, all.into()), first?))
    }
}

/// The items with names that differ from those in `old` and from each other.
fn named_apart(old: &[Value], mut items: Vec<Value>) -> Vec<Value> {
    let mut taken: HashSet<String> = old.iter().filter_map(|item| named::name_of(Some(item))).collect();
    for item in &mut items {
        if let Some(name) = named::name_of(Some(item)) {
            let name = unique_name(&name, |name| taken.contains(name));
            item["name"] = name.as_str().into();
            taken.insert(name);
        }
    }
    items
}

fn key_of(item: &Value, key: &str) -> Option<f64> {
    item.pointer(key).and_then(Value::as_f64)
}

/// One item in an ascending list: at its place, or if that is taken half way to the next, as for a duplicate.
fn placed_alone(
    starts: &Starts,
    (variant, list): (&str, &str),
    key: &str,
    old: &[Value],
    item: &Value,
    index: usize,
) -> Option<(Vec<Value>, usize)> {
    let mut to = old.partition_point(|one| key_of(one, key) < key_of(item, key));
    let mut item = item.clone();
    if old.get(to).is_some_and(|one| key_of(one, key) == key_of(&item, key)) {
        let (near, between) = (starts.item)(variant, list, old, index)?;
        (*item.pointer_mut(key)?, to) = (between.pointer(key)?.clone(), near);
    }
    let mut all = old.to_vec();
    all.insert(to, item);
    Some((all, to))
}

/// Several items in an ascending list, each at its place, replacing what is there.
fn placed(key: &str, old: &[Value], items: Vec<Value>) -> Option<(Vec<Value>, usize)> {
    let least = items.iter().filter_map(|item| key_of(item, key)).fold(f64::INFINITY, f64::min);
    let mut all = items;
    all.sort_by(|a, b| key_of(a, key).unwrap_or(0.0).total_cmp(&key_of(b, key).unwrap_or(0.0)));
    let kept = old.iter().filter(|one| {
        let own = key_of(one, key).unwrap_or(0.0);
        let at = all.partition_point(|new| key_of(new, key).unwrap_or(0.0) < own);
        all.get(at).is_none_or(|new| key_of(new, key) != Some(own))
    });
    let kept: Vec<Value> = kept.cloned().collect();
    all.extend(kept);
    all.sort_by(|a, b| key_of(a, key).unwrap_or(0.0).total_cmp(&key_of(b, key).unwrap_or(0.0)));
    let first = all.iter().position(|item| key_of(item, key) == Some(least))?;
    Some((all, first))
}
