//! The check of shape: walks a document along its schema, choosing branches by their tags, and lists every unknown or
//! missing field, wrong type, unknown word and number out of range at once. (Deserialising would stop at the first, and
//! would not say where.)

use serde_json::{Map, Number, Value};

use super::VERSION;
use super::json_schema::{is_widest, range_text};
use super::schema::{Body, Shape};
use crate::base::change::Change;
use crate::base::number::written;
use crate::base::pointer;
use crate::base::problem::{Problem, nearest, quoted, there_are};
use crate::base::text::counted;

/// At most this many problems are listed.
const MAX_PROBLEMS: usize = 1000;

/// Every problem of shape in `json`.
pub fn check(json: &Value) -> Vec<Problem> {
    let mut walk = Walk { path: String::new(), problems: Vec::new() };
    walk.value(Shape::root(), json);
    if walk.problems.len() >= MAX_PROBLEMS {
        walk.problems.push(Problem::error("", format!("more than {MAX_PROBLEMS} problems; the rest are not listed")));
    }
    walk.problems
}

/// Whether `json` has the right shape, given that it had before `change`.
pub fn still_fits(json: &Value, change: &Change) -> bool {
    changed_fits(Shape::root(), json, change)
}

fn changed_fits(shape: Shape, value: &Value, change: &Change) -> bool {
    match (change, shape.body(), value) {
        (Change::Same, ..) => true,
        (Change::Items(items), Body::List(item, min, max), Value::Array(all)) => {
            let fits = |(i, change): (usize, &Change)| all.get(i).is_some_and(|one| changed_fits(item, one, change));
            (min..=max).contains(&all.len()) && items.each().all(fits)
        }
        (Change::Fields(fields), Body::Map(item), Value::Object(map)) => {
            fields.iter().all(|(name, change)| map.get(name).is_none_or(|value| changed_fits(item, value, change)))
        }
        (Change::Fields(fields), body @ (Body::Object | Body::Tagged(_)), Value::Object(map)) => {
            let retagged = matches!(body, Body::Tagged(tag) if *change.field(tag) != Change::Same);
            let Some(branch) = shape.branch(Some(value)).filter(|_| !retagged) else { return fits(shape, value) };
            let field = |(name, change): &(String, Change)| match (map.get(name), branch.property(None, name)) {
                (None, _) => true,
                (Some(value), Some(field)) => changed_fits(field, value, change),
                (Some(_), None) => false,
            };
            let whole = branch.required().all(|name| map.contains_key(name)) && one_of(branch, map).is_ok();
            whole && fields.iter().all(field)
        }
        _ => fits(shape, value),
    }
}

/// Whether `value` has this shape.
pub fn fits(shape: Shape, value: &Value) -> bool {
    problems(shape, value).is_empty()
}

/// Every problem of `value` as this shape; paths are relative to it.
pub fn problems(shape: Shape, value: &Value) -> Vec<Problem> {
    let mut walk = Walk { path: String::new(), problems: Vec::new() };
    walk.value(shape, value);
    walk.problems
}

struct Walk {
    path: String,
    problems: Vec<Problem>,
}

impl Walk {
    fn report(&mut self, message: String, hint: impl Into<Option<String>>) {
        if self.problems.len() < MAX_PROBLEMS {
            let problem = Problem::error(self.path.as_str(), message);
            self.problems.push(Problem { hint: hint.into(), ..problem });
        }
    }

    /// Runs `below` one step deeper.
    fn under(&mut self, token: &str, below: impl FnOnce(&mut Self)) {
        let length = self.path.len();
        pointer::push(&mut self.path, token);
        below(self);
        self.path.truncate(length);
    }

    fn value(&mut self, shape: Shape, value: &Value) {
        let full = self.problems.len() >= MAX_PROBLEMS;
        if full || (value.is_null() && shape.allows_null()) {
            return;
        }
        match (shape.body(), value) {
            (Body::Number { integer }, Value::Number(number)) => {
                self.number(number, integer, shape.range(), shape.unit());
            }
            (Body::Text, Value::String(text)) if text.chars().count() < shape.min_length() => {
                self.report("is empty".into(), Some(format!("expected {}", expected(shape))));
            }
            (Body::Text, Value::String(_)) | (Body::Bool, Value::Bool(_)) => {}
            (Body::Choice, Value::String(word)) if shape.choices().any(|(name, _)| name == word) => {}
            (Body::Choice, Value::String(word)) => {
                self.report(format!("{} is not known here", quoted(word)), nearest(word, shape.choices().map(|c| c.0)));
            }
            (Body::Numbers(count), Value::Array(items)) if items.len() == count => {
                let (range, whole) = (shape.range(), shape.has_whole_numbers());
                self.items(items, |walk, item| match item {
                    Value::Number(number) => walk.number(number, whole, range, shape.unit()),
                    _ => walk.report(format!("expected a number, found {}", found(item)), None),
                });
            }
            (Body::Row(count), Value::Array(items)) if items.len() == count => {
                for (i, item) in items.iter().enumerate() {
                    let part = shape.part(i).into_iter();
                    self.under(&i.to_string(), |walk| part.for_each(|part| walk.value(part, item)));
                }
            }
            (Body::List(item, min, max), Value::Array(items)) => self.list(item, items, min, max),
            (Body::List(..), Value::String(_)) if shape.named().is_some() => {}
            (Body::Map(item), Value::Object(map)) => {
                for (key, value) in map {
                    self.under(key, |walk| walk.value(item, value));
                }
            }
            (Body::Object, Value::Object(map)) => self.fields(shape, map),
            (Body::Tagged(tag), Value::Object(map)) => self.tagged(shape, map, tag),
            _ => self.report(format!("expected {}, found {}", expected(shape), found(value)), None),
        }
    }

    fn number(&mut self, own: &Number, whole: bool, range: Option<(f64, f64)>, unit: Option<&str>) {
        let Some(number) = own.as_f64() else { return };
        match range {
            Some(range @ (min, max)) if !(min..=max).contains(&number) => {
                let side = if number < min { "small" } else { "large" };
                let range = range_text(Some(range), unit).unwrap_or_default();
                self.report(format!("{} is too {side}: {range}", written(own)), None);
            }
            _ if whole && own.is_f64() => {
                let hint =
                    (number.fract() == 0.0 && number.abs() < 1e18).then(|| format!("write it as {}", number as i64));
                self.report(format!("expected a whole number, found {}", written(own)), hint);
            }
            _ => {}
        }
    }

    fn items(&mut self, items: &[Value], mut each: impl FnMut(&mut Self, &Value)) {
        for (i, item) in items.iter().enumerate() {
            self.under(&i.to_string(), |walk| each(walk, item));
        }
    }

    fn list(&mut self, shape: Shape, items: &[Value], min: usize, max: usize) {
        if !(min..=max).contains(&items.len()) {
            let count = items.len();
            let (few, bound) = if count < min { ("at least ", min) } else { ("at most ", max) };
            let few = if min == max { "" } else { few };
            let wanted = format!("{few}{}", counted(bound, "item"));
            let cure = match count {
                0 if min > 0 => Some("add one".to_owned()),
                _ if count > max && min < max => Some(format!("leave {} out", count - max)),
                _ => None,
            };
            self.report(format!("expected {wanted}, found {count}"), cure);
        }
        self.items(items, |walk, item| walk.value(shape, item));
    }

    fn tagged(&mut self, shape: Shape, map: &Map<String, Value>, tag: &'static str) {
        let tags = || shape.choices().map(|(name, _)| name);
        match map.get(tag) {
            None => self.report(format!("{} is missing", quoted(tag)), Some(there_are(tags()))),
            Some(Value::String(name)) => match shape.variant(name) {
                Some(branch) => self.fields(branch, map),
                None => self.under(tag, |walk| {
                    walk.report(format!("there is no {tag} {}", quoted(name)), nearest(name, tags()));
                }),
            },
            Some(other) => self.under(tag, |walk| {
                walk.report(format!("expected a word, found {}", found(other)), Some(there_are(tags())));
            }),
        }
    }

    fn fields(&mut self, shape: Shape, map: &Map<String, Value>) {
        let known = || shape.fields().into_iter().flat_map(Map::keys).map(String::as_str);
        for name in shape.required().filter(|&name| !map.contains_key(name)) {
            let field = shape.property(None, name);
            let value = |field| if name == "plica" { VERSION.to_string() } else { expected(field) };
            let hint = field.map(|field| format!("write {}: {}", quoted(name), value(field)));
            self.report(format!("{} is missing", quoted(name)), hint);
        }
        if let Err((message, hint)) = one_of(shape, map) {
            self.report(message, Some(hint));
        }
        for (name, value) in map {
            match shape.property(None, name) {
                Some(_) if shape.constant(name).is_some() => {}
                Some(field) => self.under(name, |walk| walk.value(field, value)),
                None => self.under(name, |walk| {
                    walk.report(format!("unknown field {}", quoted(name)), nearest(name, known()));
                }),
            }
        }
    }
}

/// Whether an object has exactly one of the fields that exclude each other; else what is wrong, and the cure.
fn one_of(shape: Shape, map: &Map<String, Value>) -> Result<(), (String, String)> {
    let all: Vec<String> = shape.either().map(quoted).collect();
    let written: Vec<String> =
        shape.either().filter(|name| map.get(*name).is_some_and(|v| !v.is_null())).map(quoted).collect();
    match written.as_slice() {
        [] if !all.is_empty() => Err((format!("{} is missing", all.join(" or ")), "write one of them".into())),
        [] | [_] => Ok(()),
        several => Err((format!("{} do not go together", several.join(" and ")), "remove all but one".into())),
    }
}

/// What a shape expects, in words.
pub fn expected(shape: Shape) -> String {
    let range = shape.range().filter(|&range| !is_widest(range));
    let range = range_text(range, shape.unit()).map(|range| format!(", {range}")).unwrap_or_default();
    match shape.body() {
        Body::Number { integer: false } => format!("a number{range}"),
        Body::Number { integer: true } => format!("a whole number{range}"),
        Body::Text => shape.reference().map_or("text".into(), |list| format!("a name of the scene's {list}")),
        Body::Bool => "true or false".into(),
        Body::Choice if shape.choices().next().is_none() => "null".into(),
        Body::Choice => {
            shape.choices().map(|(name, _)| quoted(name)).collect::<Vec<_>>().join(", ").replace(", ", " or ")
        }
        Body::Numbers(count) => format!("a list of {count} numbers{range}"),
        Body::Row(count) => {
            let parts = (0..count).filter_map(|i| Some((shape.column(i)?, expected(shape.part(i)?))));
            let parts: Vec<String> = parts.map(|(name, expected)| format!("{name} ({expected})")).collect();
            format!("a list of {}", parts.join(" and "))
        }
        Body::List(..) => "a list".into(),
        Body::Map(_) | Body::Object => "an object".into(),
        Body::Tagged(tag) => format!("an object with {}", quoted(tag)),
    }
}

/// What was found, in words.
pub fn found(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Bool(value) => value.to_string(),
        Value::Number(number) => written(number),
        Value::String(text) => format!("the text {}", quoted(text)),
        Value::Array(items) if items.iter().all(Value::is_number) => {
            format!("a list of {}", counted(items.len(), "number"))
        }
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "an object".into(),
    }
}
