//! The strokes in force: over the defaults the style's table, over that what the document says. Objects are laid over one
//! another field by field, lists of named things by their names; anything else replaces.

use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use serde_json::{Map, Value};

use super::marks::Set;
use super::model::{Anchor, Force, Mark};
use super::styles::Style;
use crate::base::number;
use crate::base::pointer::{self, Pointer};

/// The fields that null clears; null in any other is as if nothing were written.
const CLEARED: [&str; 6] = ["vary", "grain", "creases", "anchor", "noise", "direction"];

/// Strokes as they are written, with what that means.
#[derive(Clone, Debug)]
pub struct Strokes {
    /// What is written.
    pub written: Value,
    force: Arc<(Force, OnceLock<Value>)>,
}

impl PartialEq for Strokes {
    fn eq(&self, other: &Self) -> bool {
        self.written == other.written
    }
}

impl Deref for Strokes {
    type Target = Force;

    fn deref(&self) -> &Force {
        &self.force.0
    }
}

impl<'de> Deserialize<'de> for Strokes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = Value::deserialize(deserializer)?;
        let style = Style::named(written.get("style"));
        let mut force: Force = serde_json::from_value(in_force(&style.table(), &written)).map_err(de::Error::custom)?;
        force.style = style;
        Ok(Strokes { written, force: Arc::new((force, OnceLock::new())) })
    }
}

impl Serialize for Strokes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.written.serialize(serializer)
    }
}

impl JsonSchema for Strokes {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        Force::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Force::json_schema(generator)
    }
}

impl Strokes {
    /// The same with all noises fixed to the same.
    pub fn anchored(&self, anchor: Anchor) -> Strokes {
        let mut force = self.force.0.clone();
        force.anchor = anchor;
        force.noises.values_mut().for_each(|noise| noise.anchor = None);
        Strokes { written: self.written.clone(), force: Arc::new((force, OnceLock::new())) }
    }

    /// Everything in force as JSON.
    fn whole(&self) -> &Value {
        self.force.1.get_or_init(|| whole(self))
    }

    /// The value in force at `path`, relative to the strokes. Marks are at their names or where they are written.
    pub fn value(&self, path: &str) -> Option<Value> {
        if path == "/style" {
            return Some(Value::from("hatching"));
        }
        let Some((token, field)) = Pointer(path).below("/marks").and_then(|way| Pointer(way).first()) else {
            return self.whole().pointer(path).cloned();
        };
        let name = match pointer::index(&token) {
            Some(index) => self.written.get("marks")?.get(index)?.get("name")?.as_str()?.to_owned(),
            None => token,
        };
        let marks = self.whole().get("marks")?.as_array()?;
        marks.iter().find(|mark| mark["name"] == name)?.pointer(field).cloned()
    }

    /// The names of the style's noises or marks.
    pub fn of_style(&self, path: &str) -> Option<Vec<String>> {
        let of = |list: &Value| match list {
            Value::Object(noises) => noises.keys().cloned().collect(),
            Value::Array(marks) => marks.iter().filter_map(|mark| Some(mark["name"].as_str()?.to_owned())).collect(),
            _ => Vec::new(),
        };
        ["/noises", "/marks"].contains(&path).then(|| of(&self.style.table()[&path[1..]]))
    }

    /// Where the mark of this name is written, relative to the strokes; the list if it is the style's alone.
    pub fn place_of(&self, mark: &str) -> String {
        let written = self.written.get("marks").and_then(Value::as_array);
        let index = written.and_then(|marks| marks.iter().position(|one| one.get("name").is_some_and(|n| n == mark)));
        index.map_or("/marks".into(), |index| format!("/marks/{index}"))
    }
}

/// Everything in force as JSON, with every field written that counts.
pub fn whole(force: &Force) -> Value {
    let mut whole = serde_json::to_value(force).unwrap_or_default(); // numbers and texts alone
    if let Some(Value::Array(marks)) = whole.get_mut("marks") {
        for (mark, of) in marks.iter_mut().zip(&force.marks) {
            *mark = written(of);
        }
    }
    if let Some(Value::Object(noises)) = whole.get_mut("noises") {
        noises
            .values_mut()
            .filter_map(Value::as_object_mut)
            .for_each(|noise| noise.retain(|_, value| !value.is_null()));
    }
    if let Value::Object(fields) = &mut whole {
        fields.retain(|_, value| !value.is_null());
    }
    tidy(&mut whole);
    whole
}

/// Writes numbers as a person does.
fn tidy(value: &mut Value) {
    match value {
        Value::Number(number) => {
            let number = number.as_f64();
            number.into_iter().for_each(|number| *value = number::json(number));
        }
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(fields) => fields.values_mut().for_each(tidy),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// A mark with all fields of its kind that have a value.
fn written(mark: &Mark) -> Value {
    let mut map = Map::new();
    map.insert("name".into(), mark.name.as_str().into());
    if let Some(Ok(Value::Object(fields))) = Set::of(mark).map(serde_json::to_value) {
        map.extend(fields.into_iter().filter(|(_, value)| !value.is_null()));
    }
    Value::Object(map)
}

/// What is in force by a style's table and what is written.
pub fn in_force(style: &Value, written: &Value) -> Value {
    let mut whole = style.clone();
    for (name, value) in written.as_object().into_iter().flatten() {
        let below = whole.get_mut(name.as_str()).map(Value::take);
        match (name.as_str(), value) {
            ("style", _) => continue,
            ("noises", Value::Object(noises)) => whole[name] = of_names(below, noises),
            _ => lay(&mut whole, name, below, value),
        }
    }
    if let Some(Value::Array(marks)) = whole.get_mut("marks") {
        marks.retain(|mark| mark.get("off") != Some(&Value::Bool(true)));
    }
    whole
}

/// Noises by their names: null takes one away.
fn of_names(below: Option<Value>, noises: &Map<String, Value>) -> Value {
    let mut all = below.and_then(|below| below.as_object().cloned()).unwrap_or_default();
    for (name, noise) in noises {
        match noise {
            Value::Null => drop(all.shift_remove(name)),
            noise => {
                let below = all.get_mut(name).map(Value::take);
                all.insert(name.clone(), over(below.unwrap_or_default(), noise));
            }
        }
    }
    Value::Object(all)
}

/// Lays `value` over what is `below` it in the field `name`.
fn lay(fields: &mut Value, name: &str, below: Option<Value>, value: &Value) {
    let below = below.unwrap_or_default();
    fields[name] = match value {
        Value::Null if !CLEARED.contains(&name) => below,
        value => over(below, value),
    };
    // What is null has its default.
    if let (true, Value::Object(map)) = (fields[name].is_null(), &mut *fields) {
        map.shift_remove(name);
    }
}

fn over(mut base: Value, own: &Value) -> Value {
    match (&mut base, own) {
        (Value::Object(_), Value::Object(own)) => {
            for (name, value) in own {
                let below = base.get_mut(name.as_str()).map(Value::take);
                lay(&mut base, name, below, value);
            }
            base
        }
        (Value::Array(items), Value::Array(own)) if items.iter().chain(own).all(is_named) => {
            for value in own {
                match items.iter_mut().find(|item| item.get("name") == value.get("name")) {
                    Some(item) => *item = over(item.take(), value),
                    None => items.push(over(Value::Object(Map::new()), value)),
                }
            }
            base
        }
        (Value::Null, Value::Object(_)) => over(Value::Object(Map::new()), own),
        (Value::Null, Value::Array(items)) if items.iter().all(is_named) => over(Value::Array(Vec::new()), own),
        _ => own.clone(),
    }
}

fn is_named(value: &Value) -> bool {
    value.get("name").is_some_and(Value::is_string)
}
