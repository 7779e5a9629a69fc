//! An edit in words, for people who want to know what was done: `left eye · radius 60 → 80`. Made from the schema, so
//! that a new field needs nothing here.

use json_patch::PatchOperation;
use serde_json::Value;

use super::edit::Edit;
use super::merge::Conflict;
use super::named::name_of;
use super::schema::{Body, Place, Shape};
use crate::base::number;
use crate::base::pointer::{self, Pointer};
use crate::base::text::counted;
use crate::base::text::short;

/// The most characters of a value in words.
const LONGEST: usize = 40;

/// What `edit` does to the document `before`, one line per operation: where, what, the old value and the new one. Names
/// are as in the document, including control characters.
pub fn describe(before: &Value, edit: &Edit) -> Vec<String> {
    let operations = &edit.0.0;
    let mut now = (operations.len() > 1).then(|| before.clone());
    let mut lines = Vec::new();
    for operation in operations {
        lines.extend(one(now.as_ref().unwrap_or(before), operation));
        if let Some(json) = &mut now
            && Edit(json_patch::Patch(vec![operation.clone()])).patch(json).is_err()
        {
            break;
        }
    }
    lines
}

/// An edit as one line: its first operation, and how many more there are.
pub fn in_short(before: &Value, edit: &Edit) -> String {
    let lines = describe(before, edit);
    match lines.as_slice() {
        [] => "nothing".into(),
        [one] => one.clone(),
        [first, rest @ ..] => format!("{first} (and {} more)", rest.len()),
    }
}

/// A place that two versions changed, each in its own way: `left eye · radius 80 here, 70 in the file`. `mine` is the
/// version that is here.
pub fn conflict(mine: &Value, conflict: &Conflict) -> String {
    let at = conflict.pointer.as_str();
    let shape = Place::of(mine, at).map(|place| place.shape);
    let said = |value: &Option<Value>| match value.as_ref().map(|value| words(shape, value)) {
        None => "deleted".into(),
        Some(words) if words.is_empty() => "changed".into(),
        Some(words) => words,
    };
    let place = place(mine, at, conflict.mine.as_ref().or(conflict.theirs.as_ref()));
    format!("{place} {} here, {} in the file", said(&conflict.mine), said(&conflict.theirs))
}

/// The thing with a name that a place of a layer belongs to: the outermost item below the layer, of a list whose items have
/// names (a zone), as a part of `pointer`. `None` if the place is in none.
pub fn item_of(pointer: &str) -> Option<&str> {
    let mut lengths = pointer.match_indices('/').map(|(at, _)| at).skip(1).chain([pointer.len()]);
    let (list, layer) = (lengths.next()?, lengths.next()?);
    let mut here = vec![Shape::root().property(None, pointer.get(1..list)?).filter(|_| &pointer[..list] == LAYERS)?];
    here = here.into_iter().flat_map(|shape| shape.below("0")).collect();
    let mut begin = layer;
    for end in lengths {
        let token = &pointer[begin + 1..end];
        let of_list = here.iter().any(|shape| shape.body().is_list());
        here = here.into_iter().flat_map(|shape| shape.below(token)).collect();
        if of_list && here.iter().any(|shape| shape.property(None, "name").is_some()) {
            return Some(&pointer[..end]);
        }
        begin = end;
    }
    None
}

/// The list of layers.
const LAYERS: &str = "/layers";

/// One operation in words; `None` for a test.
fn one(json: &Value, operation: &PatchOperation) -> Option<String> {
    let path = operation.path().as_str();
    Some(match operation {
        PatchOperation::Add(add) if is_in_list(json, path) => {
            let at = if path.ends_with("/-") { end_of(json, path) } else { path.to_owned() };
            format!("{} added{}", place(json, &at, Some(&add.value)), kind(json, &at, &add.value))
        }
        PatchOperation::Add(add) => change(json, path, &add.value),
        PatchOperation::Replace(replace) => change(json, path, &replace.value),
        PatchOperation::Remove(_) => removal(json, path),
        PatchOperation::Move(moved) => {
            let from = moved.from.as_str();
            let (old, new) = (Pointer(from).split(), Pointer(path).split());
            match (old, new) {
                (Some((a, _)), Some((b, last))) if a == b => match pointer::index(&last) {
                    Some(index) => format!("{} moved to place {}", place(json, from, None), index),
                    None => format!("{} renamed to {last}", place(json, from, None)),
                },
                _ => format!("{} moved to {}", place(json, from, None), place(json, path, None)),
            }
        }
        PatchOperation::Copy(copy) => format!("{} copied", place(json, copy.from.as_str(), None)),
        PatchOperation::Test(_) => return None,
    })
}

/// Whether a place is in a list that is written, or at its end.
fn is_in_list(json: &Value, path: &str) -> bool {
    Pointer(path)
        .split()
        .and_then(|(parent, _)| Place::of(json, parent))
        .is_some_and(|parent| parent.shape.body().is_list() && parent.value.is_some_and(Value::is_array))
}

fn end_of(json: &Value, path: &str) -> String {
    let parent = Pointer(path).split().map_or("", |(parent, _)| parent);
    Pointer(parent).join(json.pointer(parent).and_then(Value::as_array).map_or(0, Vec::len))
}

/// A value that changes, or that replaces its default.
fn change(json: &Value, path: &str, new: &Value) -> String {
    let found = Place::of(json, path);
    let old = found.and_then(|place| place.value).filter(|value| !value.is_null());
    let (shape, at) = (found.map(|place| place.shape), place(json, path, None));
    let new_words = words(shape, new);
    match old.map(|old| words(shape, old)) {
        None if new_words.is_empty() => format!("{at} added"),
        None => format!("{at} {new_words}"),
        // Objects have no words.
        Some(old) if old == new_words || old.is_empty() || new_words.is_empty() => format!("{at} changed"),
        Some(old) => format!("{at} {old} → {new_words}"),
    }
}

fn removal(json: &Value, path: &str) -> String {
    let at = place(json, path, None);
    let Some(found) = Place::of(json, path) else { return format!("{at} deleted") };
    match found.shape.default().filter(|default| !default.is_null() && !is_in_list(json, path)) {
        Some(default) => {
            let old = found.value.map(|value| words(Some(found.shape), value)).unwrap_or_default();
            let default = words(Some(found.shape), default);
            let is_told = old != default && !old.is_empty() && !default.is_empty();
            if is_told { format!("{at} {old} → {default}") } else { format!("{at} back to its default") }
        }
        None => format!("{at} deleted"),
    }
}

/// The place that a pointer leads to: the innermost thing with a name, and the field in it. `new` is the value to come.
fn place(json: &Value, path: &str, new: Option<&Value>) -> String {
    let mut here = Some(Place::root(json));
    let mut owner = "scene".to_owned();
    let mut steps: Vec<(String, bool)> = Vec::new();
    let tokens: Vec<String> = Pointer(path).tokens().collect();
    for (depth, token) in tokens.iter().enumerate() {
        let below = here.and_then(|place| place.step(token));
        let last = depth + 1 == tokens.len();
        let value =
            if last { new.or(below.and_then(|below| below.value)) } else { below.and_then(|below| below.value) };
        match (here.map(|place| place.shape.body()), name_of(value)) {
            (Some(Body::List(..)), Some(name)) => {
                owner = name;
                steps.clear();
            }
            (Some(Body::List(..)), None) => {
                let index = pointer::index(token).map_or_else(|| token.clone(), |index| index.to_string());
                steps.push((index, true));
            }
            (Some(Body::Numbers(_) | Body::Row(_)), _) => {
                let column = pointer::index(token).and_then(|i| here?.shape.column(i));
                steps.push((column.map_or_else(|| token.clone(), str::to_owned), true));
            }
            (Some(Body::Map(_)), _) => steps.push((token.clone(), true)),
            _ => steps.push((token.clone(), false)),
        }
        here = below;
    }
    if steps.is_empty() { owner } else { format!("{owner} · {}", spoken(&steps)) }
}

/// The steps below the named thing; objects that are only passed through are left out.
fn spoken(steps: &[(String, bool)]) -> String {
    let needed = |i: usize| i + 1 >= steps.len() || steps[i].1 || steps[i + 1].1;
    let kept: Vec<&str> = (0..steps.len()).filter(|&i| needed(i)).map(|i| steps[i].0.as_str()).collect();
    kept.join(" ")
}

/// The kind of a new item, in parentheses, if it has one.
fn kind(json: &Value, path: &str, value: &Value) -> String {
    let words = words(Place::of(json, path).map(|place| place.shape), value);
    if words.is_empty() || name_of(Some(value)).is_some() { String::new() } else { format!(" ({words})") }
}

/// A value in a few words: numbers and texts as they are, an object by its tag, a long list by its length.
fn words(shape: Option<Shape>, value: &Value) -> String {
    let text = match (shape.map(Shape::body), value) {
        (Some(Body::Tagged(tag)), Value::Object(map)) => map.get(tag).and_then(Value::as_str).unwrap_or("?").to_owned(),
        (_, Value::Object(_)) => String::new(),
        (_, Value::Array(items)) if items.is_empty() => "none".into(),
        (_, Value::Array(items)) if items.iter().all(Value::is_number) && items.len() <= 4 => {
            items.iter().map(number).collect::<Vec<_>>().join(", ")
        }
        (_, Value::Array(items)) => counted(items.len(), "item"),
        (_, Value::String(text)) if text.is_empty() => "\"\"".into(),
        (_, Value::String(text)) => text.clone(),
        (_, Value::Null) => "none".into(),
        (_, other) => number(other),
    };
    match text.char_indices().nth(LONGEST) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text,
    }
}

/// A number without needless decimals, rounded where it has many; other values as JSON.
fn number(value: &Value) -> String {
    let Some(number) = value.as_f64() else { return value.to_string() };
    let text = number::text(number);
    match (text.len() > MOST_DIGITS, number.abs() >= 0.001) {
        (false, _) => text,
        (true, true) => short(number, DECIMALS),
        (true, false) => format!("{number:.DECIMALS$e}"),
    }
}

/// Numbers with more characters are rounded, to so many decimals.
const MOST_DIGITS: usize = 9;
const DECIMALS: usize = 4;

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::{Document, address};
    use super::*;
    use crate::layers::parts::materials::List;

    fn squint() -> Document {
        Document::parse(include_str!("../../tests/scenes/good/squint.plica.json")).unwrap()
    }

    #[test]
    fn edits_are_told_in_words() {
        let document = squint();
        let zone = "/layers/0/zones/0";
        let set = |address: &str, value| Edit::set(&document, &address::resolve(&document, address).unwrap(), value);
        let eye = |rest: &str| format!("layers.face.zones.\"left eye\".{rest}");
        for (edit, expected) in [
            (set(&eye("interpolation.radius"), json!(80)), "left eye · radius 60 → 80"),
            (set(&eye("motion.0.jump"), json!([0, -20])), "left eye · motion 0 jump 0, -18 → 0, -20"),
            (
                set(&eye("motion.0.jump"), json!([1.933_925_815_543_853_5, 0.000_012_345_678_9])),
                "left eye · motion 0 jump 0, -18 → 1.9339, 1.2346e-5",
            ),
            (set(&eye("motion.0.at.x"), json!(151)), "left eye · motion 0 at x 150 → 151"),
            (set(&eye("motion.1.jumps.1.along"), json!(0.6)), "left eye · motion 1 jumps 1 along 0.5 → 0.6"),
            (set(&eye("outline.kind"), json!("rectangle")), "left eye · outline polygon → rectangle"),
            (set(&eye("position.function"), json!("linear")), "left eye · position sine → linear"),
            (set(&eye("name"), json!("right eye")), "left eye · name left eye → right eye"),
            (set(&eye("fold"), json!(null)), "left eye · fold deleted"),
            (set(&eye("feather"), json!(null)), "left eye · feather 4 → 0"),
            (set("timeline.fps", json!(24)), "scene · fps 30 → 24"),
            (Edit::remove(&format!("{zone}/motion/1")), "left eye · motion 1 deleted"),
            (Edit::remove(zone), "left eye deleted"),
            (Edit::duplicate(&document, zone).unwrap().0, "left eye 2 added"),
            (
                Edit::insert(&document, &format!("{zone}/motion"), 1, json!({ "tool": "point", "at": [1, 2] })),
                "left eye · motion 1 added (point)",
            ),
            (
                Edit::move_item(&document, &format!("{zone}/motion/0"), 2).unwrap().0,
                "left eye · motion 0 moved to place 2",
            ),
            (Edit::default(), "nothing"),
            (Edit::rename(&document, List::Images, "cat", "dog"), "scene · images cat renamed to dog (and 1 more)"),
        ] {
            assert_eq!(in_short(document.json(), &edit), expected);
        }
    }

    #[test]
    fn the_named_thing_that_a_place_belongs_to() {
        for (pointer, item) in [
            ("/layers/0/zones/2", Some("/layers/0/zones/2")),
            ("/layers/0/zones/12/motion/1/jumps/0", Some("/layers/0/zones/12")),
            ("/layers/0/zones/7/position/segments/0", Some("/layers/0/zones/7")),
            ("/layers/0/zones", None),
            ("/layers/0/name", None),
            ("/layers/0", None),
            ("/layers", None),
            ("/timeline/fps", None),
            ("/images/zones/path", None),
            ("", None),
        ] {
            assert_eq!(item_of(pointer), item, "{pointer}");
        }
    }

    #[test]
    fn an_edit_that_does_not_fit_is_told_as_far_as_it_goes() {
        let document = squint();
        let edit = Edit::all([Edit::remove("/layers/7"), Edit::remove("/layers/0")]);
        assert_eq!(describe(document.json(), &edit).len(), 1);
    }
}
