//! The edits that people ask for: set, insert, duplicate, move, rename. They also create what must exist around the new
//! value: parents that were only defaults, and the fields that a new kind of thing needs.

use kurbo::Rect;
use serde_json::{Map, Value, json};

use super::edit::Edit;
use super::schema::{Body, Place, Shape};
use super::{Document, FRAME, field, named, shape};
use crate::base::pointer::{self, Pointer};
use crate::layers::KINDS;
use crate::layers::parts::materials::List;
use crate::layers::parts::moment::Space;
use crate::layers::space::camera;
use crate::layers::starts::Starts;
use crate::layers::technique::{Kind, Technique, Turned};

impl Edit {
    /// Writes `value` at `path`. Missing parents are created from their defaults; `null` removes an optional value, so
    /// that its default applies; a new tag (another kind of outline, another method) keeps what the new kind can
    /// express.
    pub fn set(document: &Document, path: &str, value: Value) -> Edit {
        Edit::set_told(document, path, value).0
    }

    /// As [`Edit::set`]; also returns what a new kind cannot keep, in words.
    pub fn set_told(document: &Document, path: &str, value: Value) -> (Edit, Option<String>) {
        let json = document.json();
        let Some(place) = Place::of(json, path) else { return (Edit::add(path, value), None) };
        if value.is_null() && (place.shape.allows_null() || !place.required) {
            return (cleared(document, path, place), None);
        }
        if let (Some((parent, last)), Some(name)) = (Pointer(path).split(), value.as_str())
            && let Some(holder) = Place::of(json, parent)
            && matches!(holder.shape.body(), Body::Tagged(tag) if tag == last)
            && let Some(variant) = holder.shape.variant(name)
        {
            return turn(document, parent, holder, (last.as_str(), name, variant));
        }
        let users = layer_users(document, path).map(|user| Edit::replace(&user, value.clone()));
        let users: Vec<Edit> = users.collect();
        let others = others(document, path, &value).map(|other| Edit::remove(&other));
        (Edit::all(std::iter::once(write(document, path, value.clone())).chain(others).chain(users)), None)
    }

    /// Removes what is written at `path`.
    pub fn unset(document: &Document, path: &str) -> Edit {
        Edit::remove(&field::as_written(document, path).0)
    }

    /// Adds `item` to the list at `list`, before the one at `index` (or at the end).
    pub fn insert(document: &Document, list: &str, index: usize, item: Value) -> Edit {
        if document.json().pointer(list).is_some_and(Value::is_array) {
            return Edit::add(&Pointer(list).join(index), item);
        }
        // A list that is not written begins as what stands for it.
        let items = Place::of(document.json(), list).and_then(|place| place.value?.as_array());
        let mut items = items.cloned().unwrap_or_default();
        items.insert(index.min(items.len()), item);
        write(document, list, items.into())
    }

    /// Adds a new item with sensible values to the list at `list`, before the one at `index` or as near to it as an
    /// ascending list allows; also returns its pointer. `None` if there is no such list.
    pub fn insert_new(document: &Document, list: &str, index: usize) -> Option<(Edit, String)> {
        let (index, item) = new_item(document, list, index)?;
        let camera = camera_for(document, list, std::slice::from_ref(&item));
        let insert = Edit::insert(document, list, index, item);
        Some((Edit::all(camera.into_iter().chain([insert])), Pointer(list).join(index)))
    }

    /// Adds a copy of the item at `path` after it, under a unique name; also returns its pointer. `None` if `path` is
    /// not an item of a list.
    pub fn duplicate(document: &Document, path: &str) -> Option<(Edit, String)> {
        let (list, last) = Pointer(path).split()?;
        let index = pointer::index(&last)?;
        let copy = document.json().pointer(list)?.as_array()?.get(index)?.clone();
        Edit::insert_all(document, list, index + 1, vec![copy])
    }

    /// Moves the item at `path` to `index` in its list; also returns its new pointer. `None` if either is not an item
    /// of a list.
    pub fn move_item(document: &Document, path: &str, index: usize) -> Option<(Edit, String)> {
        let (list, last) = Pointer(path).split()?;
        let items = document.json().pointer(list)?.as_array()?;
        let from = pointer::index(&last)?;
        let to = Pointer(list).join(index);
        (from < items.len() && index < items.len()).then(|| (Edit::moved(path, &to), to))
    }

    /// Renames an image, a mesh or a clip of the scene, everywhere.
    pub fn rename(document: &Document, list: List, from: &str, to: &str) -> Edit {
        let named = document.scene().users_of(list, from).map(|path| Edit::replace(&path, to.into()));
        let at = |name| Pointer(&format!("/{}", list.words().0)).join(name);
        Edit::all(std::iter::once(Edit::moved(&at(from), &at(to))).chain(named))
    }

    /// Writes the optional object at `path` with only the fields that it must have. `None` if there is no such place.
    pub fn begin(document: &Document, path: &str) -> Option<Edit> {
        let place = Place::of(document.json(), path)?;
        Some(write(document, path, Fresh::at(document, path).value(place.shape)))
    }
}

/// The places that name a layer whose own name is at `path`: it is renamed everywhere.
fn layer_users<'a>(document: &'a Document, path: &'a str) -> impl Iterator<Item = String> + 'a {
    let layer = Pointer(path).item_of("/layers").filter(|(_, way)| *way == "/name");
    let layer = layer.and_then(|(index, _)| document.scene().layers.get(index));
    let name = layer.map(|layer| layer.technique().name());
    name.into_iter().flat_map(|name| document.scene().users_of(List::Layers, name))
}

/// Removes an optional value; where something stands there all the same, as what a style has, `null` is written if that
/// clears it.
fn cleared(document: &Document, path: &str, Place { set, shape, .. }: Place) -> Edit {
    let stands = |with: &Document| field::in_force(with, path).is_some();
    let removed = if set { Edit::unset(document, path) } else { Edit::default() };
    if !shape.allows_null() || !document.apply(&removed).is_ok_and(|with| stands(&with)) {
        return removed;
    }
    let null = write(document, path, Value::Null);
    match document.apply(&null) {
        Ok(with) if stands(&with) => removed,
        // What is wrong with that is to be told.
        Ok(_) | Err(_) => null,
    }
}

/// The camera that the first layers in space need, if these are some and the scene has none.
pub(super) fn camera_for(document: &Document, list: &str, items: &[Value]) -> Option<Edit> {
    let in_space = |item: &Value| {
        KINDS.iter().any(|kind| kind.space == Space::World && item.get("kind").is_some_and(|name| name == kind.name))
    };
    let needed = list == "/layers" && document.scene().camera.is_none() && items.iter().any(in_space);
    needed.then(|| write(document, "/camera", json!({})))
}

/// Turns the thing at `path` into another kind.
fn turn(document: &Document, path: &str, place: Place, to: (&str, &str, Shape)) -> (Edit, Option<String>) {
    let (tag, name, variant) = to;
    let old = place.value.filter(|old| old.is_object());
    let layer = Fresh::layer(document, path);
    let turned = old.zip(layer).and_then(|(old, (layer, rest))| layer.turned(&rest, old, name));
    if let Some(Turned { items, lost }) = turned {
        let mut items = items.into_iter();
        let first = write(document, path, items.next().unwrap_or_default());
        let more: Vec<Value> = items.collect();
        let list = Pointer(path).split().and_then(|(list, last)| Some((list, pointer::index(&last)?)));
        let more = list.and_then(|(list, index)| Edit::insert_all(document, list, index + 1, more));
        return (Edit::all(std::iter::once(first).chain(more.map(|(edit, _)| edit))), lost);
    }
    let new = Fresh::at(document, path).converted(variant, name, old);
    let same = old.and_then(|old| old.get(tag)) == Some(&Value::from(name));
    let lost = old.and_then(|old| lost(tag, old, &new)).filter(|_| !same);
    let list = Pointer(path).split().map_or("", |(list, _)| list);
    let camera = camera_for(document, list, std::slice::from_ref(&new));
    (Edit::all(camera.into_iter().chain([write(document, path, new)])), lost)
}

/// What was written in the `old` thing and is not in the new one, in words.
fn lost(tag: &str, old: &Value, new: &Value) -> Option<String> {
    let gone = |(name, value): &(&String, &Value)| *name != tag && new.get(name.as_str()) != Some(*value);
    let names: Vec<&str> = old.as_object()?.iter().filter(gone).map(|(name, _)| name.as_str()).collect();
    match names.as_slice() {
        [] => None,
        // Regions are several, a radius is one.
        [one] if one.ends_with('s') && !one.ends_with("us") => Some(format!("its {one} are not kept")),
        [one] => Some(format!("its {one} is not kept")),
        [most @ .., last] => Some(format!("its {} and {last} are not kept", most.join(", "))),
    }
}

/// The places that are written and that a `value` at `path` excludes.
fn others<'a>(document: &'a Document, path: &'a str, value: &Value) -> impl Iterator<Item = String> + 'a {
    let (holder, last) = Pointer(path).split().filter(|_| !value.is_null()).unwrap_or_default();
    let place = Place::of(document.json(), holder);
    let either = place.into_iter().flat_map(|place| place.shape.either());
    let excluded = either.clone().any(|name| name == last).then_some(either).into_iter().flatten();
    let others = excluded.filter(move |name| *name != last).map(move |name| Pointer(holder).join(name));
    others.filter(|other| document.json().pointer(other).is_some())
}

/// Writes `value` at `path`, creating parents that are not written from their defaults.
pub(super) fn write(document: &Document, path: &str, value: Value) -> Edit {
    let (path, missing) = field::as_written(document, path);
    match missing {
        None => write_at(document, &path, value),
        Some((item, name)) => write_into(document, (&item, &name), &path, value),
    }
}

/// Writes `value` at a `path` in an item that is not written yet, which stands there by its name.
fn write_into(document: &Document, (item, name): (&str, &str), path: &str, mut value: Value) -> Edit {
    if item == path {
        if let Value::Object(fields) = &mut value {
            fields.insert("name".into(), name.into());
        }
        return write_at(document, item, value);
    }
    let begun = write_at(document, item, json!({ "name": name }));
    let Ok(with) = document.apply(&begun) else { return begun };
    let inside = write_at(&with, path, value);
    // One operation rather than two, where it can be.
    let whole = with.apply(&inside).ok().and_then(|with| with.json().pointer(item).cloned());
    whole.map_or_else(|| Edit::all([begun, inside]), |whole| write_at(document, item, whole))
}

fn write_at(document: &Document, path: &str, value: Value) -> Edit {
    let json = document.json();
    if json.pointer(path).is_some() {
        return Edit::replace(path, value);
    }
    let Some((parent, last)) = Pointer(path).split() else { return Edit::replace("", value) };
    match json.pointer(parent) {
        Some(there) if !there.is_null() => Edit::add(path, value),
        _ => {
            let Some(place) = Place::of(json, parent) else { return Edit::add(path, value) };
            let fresh = Fresh::at(document, parent);
            // A number of a vector that stands there; other things begin with nothing written in them.
            let is_vector = |all: &Value| all.as_array().is_some_and(|all| all.iter().all(Value::is_number));
            let standing = field::in_force(document, parent).filter(is_vector);
            let default = place.value.filter(|value| !value.is_null()).or(standing.as_ref());
            // Half of a size alone would make a frame that is one pixel wide or high.
            let frame = (parent == "/size").then(|| json!([FRAME.0, FRAME.1]));
            let default = default.or(frame.as_ref());
            let mut holder = default.map_or_else(|| fresh.value(place.shape), |default| barest(place.shape, default));
            match &mut holder {
                Value::Object(map) => {
                    if place.shape.either().any(|name| name == last) {
                        place.shape.either().for_each(|other| drop(map.shift_remove(other)));
                    }
                    map.insert(last, value);
                }
                Value::Array(items) => match pointer::index(&last).and_then(|index| items.get_mut(index)) {
                    Some(item) => *item = value,
                    None => items.push(value),
                },
                _ => {}
            }
            write_at(document, parent, holder)
        }
    }
}

/// A default, with only the required fields written.
fn barest(shape: Shape, default: &Value) -> Value {
    let required = |name: &String| {
        shape.branch(Some(default)).is_some_and(|branch| branch.required().any(|required| required == name))
    };
    match default {
        Value::Object(map) if !matches!(shape.body(), Body::Map(_)) => {
            Value::Object(map.iter().filter(|(name, _)| required(name)).map(|(k, v)| (k.clone(), v.clone())).collect())
        }
        other => other.clone(),
    }
}

/// A new item for the list at `list`, to go before item `index`, and the index it gets.
pub fn new_item(document: &Document, list: &str, index: usize) -> Option<(usize, Value)> {
    let json = document.json();
    let place = Place::of(json, list)?;
    let Body::List(item, ..) = place.shape.body() else { return None };
    let items = place.value.and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
    let index = index.min(items.len());
    let (holder, name) = Pointer(list).split()?;
    let variant = variant_of(Place::of(json, holder)?);
    let starts = Fresh::starts(document, list);
    if let Some(between) = (starts.item)(variant, &name, items, index) {
        return Some(between);
    }
    let fresh = Fresh::at(document, &Pointer(list).join(index));
    let like = items.get(index.saturating_sub(1)).filter(|_| list == "/layers");
    let like = like.and_then(|like| like.get("kind")?.as_str()).filter(|kind| fresh.lacks(item, kind) < 2);
    let mut value = like.and_then(|kind| fresh.variant(item, kind)).unwrap_or_else(|| fresh.value(item));
    if value.get("name").is_some() {
        value["name"] = unique(name.trim_end_matches('s'), items).into();
    }
    if let Some((field, start)) = (starts.beyond)(variant, &name) {
        value[field] = start;
    }
    Some((index, value))
}

/// The tag of the value at a place; empty if it has none.
pub(super) fn variant_of(place: Place<'_>) -> &str {
    let Body::Tagged(tag) = place.shape.body() else { return "" };
    place.value.and_then(|value| value.get(tag)?.as_str()).unwrap_or_default()
}

fn unique(name: &str, items: &[Value]) -> String {
    unique_name(name, |name| items.iter().any(|item| named::name_of(Some(item)).as_deref() == Some(name)))
}

/// `name`, or the first of `name 2`, `name 3` … that is not taken; a number at its end is counted up.
pub fn unique_name(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end();
    let stem = if stem.is_empty() { name } else { stem };
    let numbered = (2..).map(|n| format!("{stem} {n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken(name)).unwrap_or_default()
}

/// Makes new values from the schema, for one place in a document.
#[derive(Clone, Copy)]
pub(super) struct Fresh<'a> {
    bounds: Rect,
    document: &'a Document,
    /// The technique of the layer that the values belong to.
    kind: Option<&'static Kind>,
    /// The index of that layer.
    own: Option<usize>,
    /// Whether the values are layers themselves, whose variant is the technique.
    layers: bool,
}

impl<'a> Fresh<'a> {
    fn at(document: &'a Document, path: &str) -> Self {
        let layer = Fresh::layer(document, path);
        let bounds = layer.as_ref().map(|(layer, rest)| layer.bounds(rest));
        let bounds = bounds.unwrap_or(Rect::new(0.0, 0.0, 100.0, 100.0));
        let inside = layer.filter(|(_, rest)| !rest.is_empty());
        let layers = inside.is_none() && (Pointer(path).is_within("/layers"));
        let kind = inside.map(|(layer, _)| layer.kind());
        let own = Pointer(path).item_of("/layers").map(|(layer, _)| layer);
        Fresh { bounds, document, kind, own, layers }
    }

    /// The layer that a place is in, and the place relative to it.
    pub(super) fn layer(document: &'a Document, path: &str) -> Option<(&'a dyn Technique, String)> {
        let (layer, way) = Pointer(path).item_of("/layers")?;
        Some((document.scene().layers.get(layer)?.technique(), way.to_owned()))
    }

    /// How new things at a place begin.
    pub(super) fn starts(document: &Document, path: &str) -> &'static Starts {
        match Fresh::layer(document, path) {
            Some((layer, _)) => &layer.kind().starts,
            None if Pointer(path).is_inside("/camera") => &camera::STARTS,
            None => &Starts::PLAIN,
        }
    }

    /// The same for the fields of a new `variant`.
    fn within(&self, variant: &str) -> Self {
        match self.layers {
            true => Fresh { kind: KINDS.iter().find(|kind| kind.name == variant).copied(), layers: false, ..*self },
            false => *self,
        }
    }

    /// The first name in a list of the scene: by the alphabet, or of the first item that is not the place's own.
    fn first(&self, list: &str) -> Option<&'a str> {
        match self.document.json().get(list)? {
            Value::Object(map) => map.keys().map(String::as_str).min(),
            Value::Array(items) => {
                let names = items.iter().filter_map(|item| item.get("name")?.as_str());
                names.enumerate().find(|(i, _)| self.own != Some(*i)).map(|(_, name)| name)
            }
            _ => None,
        }
    }

    /// A new value of a shape, with only the required fields.
    fn value(&self, shape: Shape) -> Value {
        let whole = shape.has_whole_numbers();
        let least = |(min, max): (f64, f64)| match (min..=max).contains(&0.0) {
            true => json!(0),
            false if whole => json!(min as u64),
            false => json!(min),
        };
        match shape.body() {
            Body::Number { .. } => shape.range().map_or(json!(0), least),
            Body::Text => json!(shape.reference().and_then(|list| self.first(list)).unwrap_or_default()),
            Body::Bool => json!(false),
            Body::Choice => shape.choices().next().map_or(Value::Null, |(name, _)| json!(name)),
            Body::Numbers(count) => Value::from(vec![shape.range().map_or(json!(0), least); count]),
            Body::Row(count) => (0..count).filter_map(|i| Some(self.value(shape.part(i)?))).collect(),
            Body::List(item, min, _) => Value::from(vec![self.value(item); min]),
            Body::Map(_) => json!({}),
            Body::Object => self.object(shape, ""),
            Body::Tagged(_) => {
                let best = shape.choices().map(|(name, _)| name).min_by_key(|name| self.lacks(shape, name));
                best.and_then(|name| self.variant(shape, name)).unwrap_or_default()
            }
        }
    }

    /// A new value of one variant of a tagged type.
    fn variant(&self, shape: Shape, name: &str) -> Option<Value> {
        Some(self.within(name).object(shape.variant(name)?, name))
    }

    /// How much a variant lacks of what it has to name: nothing; for a layer, that it shows nothing of the scene's lists;
    /// or what it names is not there.
    fn lacks(&self, shape: Shape, name: &str) -> u8 {
        let Some(variant) = shape.variant(name) else { return 3 };
        let mut lists = variant.required().filter_map(|name| variant.property(None, name)?.reference()).peekable();
        let shows_nothing = self.layers && lists.peek().is_none();
        if lists.all(|list| self.first(list).is_some()) { u8::from(shows_nothing) } else { 2 }
    }

    /// The required fields of an object or of a variant, and those that it begins with.
    fn object(&self, shape: Shape, variant: &str) -> Value {
        let begins = |name: &&str| shape.property(None, name).is_some_and(Shape::begins);
        let begins = shape.fields().into_iter().flat_map(Map::keys).map(String::as_str).filter(begins);
        let required = shape.required().chain(shape.either().take(1)).chain(begins).filter_map(|name| {
            let field = shape.property(None, name)?;
            let start = || (self.kind?.starts.start)(variant, name, self.bounds);
            let start = shape.constant(name).cloned().or_else(start);
            Some((name.to_owned(), start.unwrap_or_else(|| self.value(field))))
        });
        Value::Object(required.collect())
    }

    /// A value of `variant` made from one of another variant: common fields are kept if they fit.
    fn converted(&self, variant: Shape, name: &str, old: Option<&Value>) -> Value {
        let fresh = self.within(name).object(variant, name);
        let mut map = Map::new();
        for name in variant.fields().into_iter().flat_map(Map::keys) {
            let kept = old.and_then(|old| old.get(name)).filter(|_| variant.constant(name).is_none());
            let kept = kept.filter(|kept| variant.property(None, name).is_some_and(|field| shape::fits(field, kept)));
            if let Some(value) = kept.or_else(|| fresh.get(name)) {
                map.insert(name.clone(), value.clone());
            }
        }
        Value::Object(map)
    }
}
