//! An edit: a JSON Patch (RFC 6902), the only way in which a scene changes. An edit is a value; it is checked when it
//! is applied ([`super::Document::apply`]).
//!
//! The patch is applied here and not by json-patch, because keys keep their order: a new one goes to its place in the
//! schema, and removing one does not reorder the others. So undo restores the text exactly.

use json_patch::jsonptr::PointerBuf;
use json_patch::{AddOperation, MoveOperation, Patch, PatchOperation, RemoveOperation, ReplaceOperation};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::schema::Place;
use super::{Document, json};
use crate::base::change::{Change, Items};
use crate::base::pointer::{self, Pointer};
use crate::base::problem::Problem;

/// A change of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Edit(pub Patch);

impl Edit {
    /// The edits one after another, as one.
    pub fn all(edits: impl IntoIterator<Item = Edit>) -> Edit {
        Edit(Patch(edits.into_iter().flat_map(|edit| edit.0.0).collect()))
    }

    /// Whether it does nothing.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Replaces what is written at `path`.
    pub(super) fn replace(path: &str, value: Value) -> Edit {
        Edit::one(PatchOperation::Replace(ReplaceOperation { path: parsed(path), value }))
    }

    /// Adds a key to an object, or an item to a list before the one at that index (`-`: at its end).
    pub(super) fn add(path: &str, value: Value) -> Edit {
        Edit::one(PatchOperation::Add(AddOperation { path: parsed(path), value }))
    }

    /// Removes what is written at `path`.
    pub fn remove(path: &str) -> Edit {
        Edit::one(PatchOperation::Remove(RemoveOperation { path: parsed(path) }))
    }

    pub(super) fn moved(from: &str, path: &str) -> Edit {
        Edit::one(PatchOperation::Move(MoveOperation { from: parsed(from), path: parsed(path) }))
    }

    fn one(operation: PatchOperation) -> Edit {
        Edit(Patch(vec![operation]))
    }

    /// What of this is not seen since keys of the camera say it at every time, in words with a cure; `document` is what it
    /// changes.
    pub fn overruled(&self, document: &Document) -> Option<String> {
        let camera = document.scene().camera.as_ref()?;
        let named = |path: &str| Pointer(Pointer(path).below("/camera")?).tokens().next();
        let ruled = |field: &String| camera.is_ruled(field);
        let field = self.0.iter().find_map(|one| named(one.path().as_str()).filter(ruled))?;
        Some(format!("the camera's keys rule its {field}, so this is not seen (in the editor :camera key sets them)"))
    }

    /// Merges the next edit into this one if it only replaces what this one wrote; otherwise gives it back as the
    /// error.
    pub fn absorb(&mut self, next: Edit) -> Result<(), Edit> {
        let mut own = self.clone();
        let taken = !own.is_empty() && next.0.iter().all(|operation| own.take(operation));
        if !taken {
            return Err(next);
        }
        *self = own;
        Ok(())
    }

    fn take(&mut self, operation: &PatchOperation) -> bool {
        let PatchOperation::Replace(replace) = operation else { return false };
        let writes = |one: &PatchOperation| matches!(one, PatchOperation::Add(_) | PatchOperation::Replace(_));
        if !self.0.iter().all(writes) {
            return false;
        }
        let place = self.0.0.iter_mut().rev().find_map(|one| {
            let rest = replace.path.as_str().strip_prefix(one.path().as_str())?.to_owned();
            match one {
                PatchOperation::Add(AddOperation { value, .. })
                | PatchOperation::Replace(ReplaceOperation { value, .. }) => value.pointer_mut(&rest),
                _ => None,
            }
        });
        place.map(|place| place.clone_from(&replace.value)).is_some()
    }

    /// Changes `json` without checking the result. Returns the inverse, which restores the text exactly.
    pub(super) fn patch(&self, json: &mut Value) -> Result<Edit, Problem> {
        self.patch_within(json, &mut Copies::default())
    }

    /// The same as one of several edits, which share one limit on what may be copied.
    pub(super) fn patch_within(&self, json: &mut Value, copies: &mut Copies) -> Result<Edit, Problem> {
        let mut undo = Vec::with_capacity(self.0.len());
        for operation in self.0.iter() {
            copies.bear(json, operation)?;
            undo.push(step(json, operation)?);
        }
        undo.reverse();
        Ok(Edit::all(undo))
    }

    /// The inverse: applied after the edit, it restores `document` exactly. Empty if the edit cannot be applied.
    pub fn inverse(&self, document: &Document) -> Edit {
        self.patch(&mut document.json().clone()).unwrap_or_default()
    }

    /// The edit that turns `from` into exactly `to`.
    pub fn between(from: &Document, to: &Document) -> Edit {
        let mut edits = Vec::new();
        let (from, to) = (from.json(), to.json());
        difference(from, &Change::of(from, to), from, to, "", &mut edits);
        let edit = Edit::all(edits);
        let mut made = from.clone();
        let exact = edit.patch(&mut made).is_ok() && json::same(&made, to);
        if exact { edit } else { Edit::replace("", to.clone()) }
    }
}

impl Document {
    /// The document after an edit.
    ///
    /// # Errors
    /// The problems that the edit would cause.
    pub fn apply(&self, edit: &Edit) -> Result<Document, Vec<Problem>> {
        Ok(self.change(edit)?.map_or_else(|| self.clone(), |(document, _)| document))
    }

    /// The same, with the inverse of the edit; `None` if it changes nothing.
    pub(super) fn change(&self, edit: &Edit) -> Result<Option<(Document, Edit)>, Vec<Problem>> {
        let mut json = self.json().clone();
        let inverse = edit.patch(&mut json).map_err(|problem| vec![problem])?;
        Ok(self.changed(json)?.map(|document| (document, inverse)))
    }
}

/// The bytes that `copy` operations have made so far. Only `copy` can make much out of little: each one may double the
/// scene, while what other operations write is no longer than the edit. Plica itself never writes one.
#[derive(Debug, Default)]
pub(super) struct Copies(u64);

impl Copies {
    const MOST_BYTES: u64 = 64 << 20;

    /// Refuses an operation that copies too much, or nests deeper than a scene may.
    fn bear(&mut self, json: &Value, operation: &PatchOperation) -> Result<(), Problem> {
        let there = |from: &str| json.pointer(from).ok_or_else(|| missing(from));
        let value = match operation {
            PatchOperation::Add(one) => &one.value,
            PatchOperation::Replace(one) => &one.value,
            PatchOperation::Move(one) => there(one.from.as_str())?,
            PatchOperation::Copy(one) => {
                let value = there(one.from.as_str())?;
                self.0 += json::bytes(value);
                value
            }
            PatchOperation::Remove(_) | PatchOperation::Test(_) => return Ok(()),
        };
        let path = operation.path().as_str();
        if path.matches('/').count() + json::depth(value) > json::MAX_DEPTH {
            return Err(Problem::error("", format!("the edit nests deeper than {}", json::MAX_DEPTH)));
        }
        if self.0 > Copies::MOST_BYTES {
            let most = Copies::MOST_BYTES >> 20;
            return Err(
                Problem::error("", format!("the edit copies more than {most} MiB")).hint("add the values themselves")
            );
        }
        Ok(())
    }
}

/// A pointer of ours as json-patch's type; text that is no pointer leads nowhere.
fn parsed(path: &str) -> PointerBuf {
    PointerBuf::parse(path).unwrap_or_else(|_| PointerBuf::from_tokens([path]))
}

/// Applies one operation and returns its inverse.
fn step(json: &mut Value, operation: &PatchOperation) -> Result<Edit, Problem> {
    let path = operation.path().as_str();
    match operation {
        PatchOperation::Add(one) => add(json, path, one.value.clone()),
        PatchOperation::Remove(_) => remove(json, path).map(|(_, inverse)| inverse),
        PatchOperation::Replace(one) => {
            let target = json.pointer_mut(path).ok_or_else(|| missing(path))?;
            Ok(Edit::replace(path, std::mem::replace(target, one.value.clone())))
        }
        PatchOperation::Move(one) => {
            let from = one.from.as_str();
            if Pointer(path).is_inside(from) {
                return Err(Problem::error(path, format!("{from} cannot be moved into itself")));
            }
            let (value, back) = remove(json, from)?;
            let away = add(json, path, value)?;
            Ok(Edit::all([away, back]))
        }
        PatchOperation::Copy(one) => {
            let value = json.pointer(one.from.as_str()).cloned().ok_or_else(|| missing(one.from.as_str()))?;
            add(json, path, value)
        }
        PatchOperation::Test(one) if json.pointer(path) == Some(&one.value) => Ok(Edit::default()),
        PatchOperation::Test(_) => Err(Problem::error(path, "is not what the edit was made for")),
    }
}

fn missing(path: &str) -> Problem {
    Problem::error(path, "there is nothing here")
}

/// RFC 6902 `add`. A new key goes to its place in the schema.
fn add(json: &mut Value, path: &str, value: Value) -> Result<Edit, Problem> {
    let Some((parent, last)) = Pointer(path).split() else {
        return Ok(Edit::replace("", std::mem::replace(json, value)));
    };
    let place = key_place(json, parent, &last);
    match json.pointer_mut(parent).ok_or_else(|| missing(parent))? {
        Value::Object(map) => match map.get_mut(&last) {
            Some(old) => Ok(Edit::replace(path, std::mem::replace(old, value))),
            None => {
                map.shift_insert(place, last, value);
                Ok(Edit::remove(path))
            }
        },
        Value::Array(items) => {
            let index = if last == "-" { Some(items.len()) } else { pointer::index(&last) };
            let index = index.filter(|&index| index <= items.len()).ok_or_else(|| missing(path))?;
            items.insert(index, value);
            Ok(Edit::remove(&Pointer(parent).join(index)))
        }
        _ => Err(missing(path)),
    }
}

/// RFC 6902 `remove`; also returns what was there. The inverse is an `add` if that restores the key to its old place,
/// otherwise the whole object as it was.
fn remove(json: &mut Value, path: &str) -> Result<(Value, Edit), Problem> {
    let (parent, last) =
        Pointer(path).split().ok_or_else(|| Problem::error("", "the whole scene cannot be removed"))?;
    let whole = json.pointer(parent).filter(|parent| parent.is_object()).cloned();
    let value = match json.pointer_mut(parent).ok_or_else(|| missing(parent))? {
        Value::Object(map) => map.shift_remove(&last).ok_or_else(|| missing(path))?,
        Value::Array(items) => {
            let index = pointer::index(&last).filter(|&index| index < items.len()).ok_or_else(|| missing(path))?;
            items.remove(index)
        }
        _ => return Err(missing(path)),
    };
    let was = whole.as_ref().and_then(Value::as_object).and_then(|map| map.keys().position(|key| *key == last));
    let inverse = match (was, whole) {
        (Some(was), Some(whole)) if was != key_place(json, parent, &last) => Edit::replace(parent, whole),
        _ => Edit::add(path, value.clone()),
    };
    Ok((value, inverse))
}

/// Where a new key of the object at `parent` goes: after the last of those that precede it in the schema; at the end if
/// the schema does not know it.
fn key_place(json: &Value, parent: &str, key: &str) -> usize {
    let Some(map) = json.pointer(parent).and_then(Value::as_object) else { return 0 };
    let keys: Vec<&str> = map.keys().map(String::as_str).collect();
    place_among(&keys, &known_keys(json, parent), key)
}

/// The fields that the schema knows at `parent`, in its order.
fn known_keys(json: &Value, parent: &str) -> Vec<&'static str> {
    let known = Place::of(json, parent).map(|place| place.shape.properties(place.value)).unwrap_or_default();
    known.into_iter().map(|(name, _)| name).collect()
}

fn place_among(written: &[&str], known: &[&str], key: &str) -> usize {
    let Some(rank) = known.iter().position(|&name| name == key) else { return written.len() };
    written.iter().rposition(|name| known[..rank].contains(name)).map_or(0, |last| last + 1)
}

/// Adds the edits that turn `from` into `to`, both at `path` in `json` and different by `change`.
fn difference(json: &Value, change: &Change, from: &Value, to: &Value, path: &str, edits: &mut Vec<Edit>) {
    match (change, from, to) {
        (Change::Same, ..) => {}
        (Change::Fields(fields), Value::Object(a), Value::Object(b)) if reachable(json, a, b, path) => {
            for (key, change) in fields {
                let below = Pointer(path).join(key);
                match (a.get(key), b.get(key)) {
                    (Some(from), Some(to)) => difference(json, change, from, to, &below, edits),
                    (None, Some(to)) => edits.push(Edit::add(&below, to.clone())),
                    (_, None) => edits.push(Edit::remove(&below)),
                }
            }
        }
        (Change::Items(Items { ahead, behind, between }), Value::Array(a), Value::Array(b)) => {
            let (a, b) = (&a[*ahead..a.len() - behind], &b[*ahead..b.len() - behind]);
            let at = |i: usize| Pointer(path).join(ahead + i);
            for (i, ((from, to), change)) in a.iter().zip(b).zip(between).enumerate() {
                difference(json, change, from, to, &at(i), edits);
            }
            edits.extend((b.len()..a.len()).rev().map(|i| Edit::remove(&at(i))));
            edits.extend((a.len()..b.len()).map(|i| Edit::add(&at(i), b[i].clone())));
        }
        _ => edits.push(Edit::replace(path, to.clone())),
    }
}

/// Whether removing keys and adding others one by one leaves them in the order of `to`.
fn reachable(json: &Value, from: &Map<String, Value>, to: &Map<String, Value>, path: &str) -> bool {
    let known = known_keys(json, path);
    let mut keys: Vec<&str> = from.keys().filter(|&key| to.contains_key(key)).map(String::as_str).collect();
    for key in to.keys().filter(|&key| !from.contains_key(key)) {
        keys.insert(place_among(&keys, &known, key), key);
    }
    keys.iter().copied().eq(to.keys().map(String::as_str))
}
