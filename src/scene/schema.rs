//! The only walker over the schema of a scene: from a JSON pointer to the shape of what is there. The check of shape,
//! forms, help, completion and edits all use it.

use serde_json::{Map, Value};

use super::json_schema::{PLAIN, json_schema};
use crate::base::pointer::{self, Pointer};

/// A node of the schema with its references followed.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Where the type is used: description, default and unit of the field.
    site: &'static Value,
    /// The type itself.
    body: &'static Value,
    /// The field whose items these are, for what they inherit from it: help, unit, names of columns.
    outer: Option<&'static Value>,
    /// Set if this is the tag of the tagged type in `body`.
    tag: Option<&'static str>,
    /// Whether it may be `null` or missing.
    pub optional: bool,
}

/// What a [`Shape`] is.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    /// A number.
    Number {
        /// Whether it is a whole number.
        integer: bool,
    },
    /// Text.
    Text,
    /// true or false.
    Bool,
    /// One of several words: [`Shape::choices`].
    Choice,
    /// This many numbers.
    Numbers(usize),
    /// This many values, each of its own shape: [`Shape::part`].
    Row(usize),
    /// A list of items of a shape, with its least and greatest length.
    List(Shape, usize, usize),
    /// An object with arbitrary keys and values of a shape.
    Map(Shape),
    /// An object with known fields.
    Object,
    /// An object with a tag that says which fields it has: [`Shape::choices`].
    Tagged(&'static str),
}

impl Body {
    /// Whether it is a list, whose items have indexes.
    pub fn is_list(&self) -> bool {
        matches!(self, Body::List(..))
    }

    /// Whether it has fields that are known by name.
    pub fn is_object(&self) -> bool {
        match self {
            Body::Object | Body::Tagged(_) => true,
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice | Body::Numbers(_) | Body::Row(_) => false,
            Body::List(..) | Body::Map(_) => false,
        }
    }

    /// The shape of everything in it, if there may be any number of them.
    pub fn item(&self) -> Option<Shape> {
        match self {
            Body::List(item, ..) | Body::Map(item) => Some(*item),
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice | Body::Numbers(_) | Body::Row(_) => None,
            Body::Object | Body::Tagged(_) => None,
        }
    }

    /// How many values it has, if their number is fixed and they may have columns.
    pub fn count(&self) -> Option<usize> {
        match self {
            Body::Numbers(count) | Body::Row(count) => Some(*count),
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice | Body::List(..) | Body::Map(_) => None,
            Body::Object | Body::Tagged(_) => None,
        }
    }
}

impl Shape {
    /// The whole document.
    pub fn root() -> Shape {
        Shape::of(json_schema(), None)
    }

    fn of(site: &'static Value, outer: Option<&'static Value>) -> Shape {
        let mut shape = Shape { site, body: site, outer, tag: None, optional: false };
        loop {
            if let Some(any) = shape.body.get("anyOf").and_then(Value::as_array) {
                let (nulls, others): (Vec<_>, Vec<_>) = any.iter().partition(|one| one["type"] == "null");
                shape.optional |= !nulls.is_empty();
                shape.body = others.first().copied().unwrap_or(&Value::Null);
            } else if let Some(name) = shape.body.get("$ref").and_then(Value::as_str) {
                shape.body = json_schema().pointer(name.trim_start_matches('#')).unwrap_or(&Value::Null);
            } else {
                return shape;
            }
        }
    }

    /// Distinguishes types: uses of the same type have the same.
    pub fn id(self) -> usize {
        std::ptr::from_ref(self.body).addr()
    }

    /// Whether new objects have it, though it may be left out.
    pub fn begins(self) -> bool {
        self.site.get("begins") == Some(&Value::Bool(true))
    }

    /// Whether it is read-only.
    pub fn is_fixed(self) -> bool {
        self.site.get("readOnly") == Some(&Value::Bool(true))
    }

    /// Its body.
    pub fn body(self) -> Body {
        if self.tag.is_some() {
            return Body::Choice;
        }
        if let Some(variants) = self.body.get("oneOf").and_then(Value::as_array) {
            return variants.first().and_then(tag_of).map_or(Body::Choice, Body::Tagged);
        }
        match self.type_name() {
            "number" => Body::Number { integer: false },
            "integer" => Body::Number { integer: true },
            "boolean" => Body::Bool,
            "array" => self.array(),
            "object" => match self.body.get("additionalProperties").filter(|of| of.is_object()) {
                Some(item) => Body::Map(Shape::of(item, None)),
                None => Body::Object,
            },
            _ if self.body.get("enum").is_some() => Body::Choice,
            _ => Body::Text,
        }
    }

    fn parts(self) -> &'static [Value] {
        self.body.get("prefixItems").and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }

    /// Value `index` of a row; its name is [`Shape::column`].
    pub fn part(self, index: usize) -> Option<Shape> {
        Some(Shape::of(self.parts().get(index)?, None))
    }

    fn array(self) -> Body {
        if !self.parts().is_empty() {
            return Body::Row(self.parts().len());
        }
        let item = Shape::of(&self.body["items"], Some(self.outer.unwrap_or(self.site)));
        let length = |key, otherwise| self.body.get(key).and_then(Value::as_u64).map_or(otherwise, |n| n as usize);
        let (min, max) = (length("minItems", 0), length("maxItems", usize::MAX));
        let numbers = min == max && matches!(item.body(), Body::Number { .. });
        if numbers { Body::Numbers(min) } else { Body::List(item, min, max) }
    }

    /// The JSON type; "null" beside another type is left out (it makes the shape optional).
    fn type_name(self) -> &'static str {
        let one = |value: &'static Value| value.as_str().filter(|&name| name != "null");
        match self.body.get("type") {
            Some(Value::Array(names)) => names.iter().find_map(one).unwrap_or_default(),
            Some(name) => one(name).unwrap_or_default(),
            None => "",
        }
    }

    /// Whether its schema allows `null`.
    pub fn allows_null(self) -> bool {
        let listed = |names: &'static Value| names.as_array().is_some_and(|names| names.iter().any(|n| n == "null"));
        self.optional || self.body.get("type").is_some_and(listed)
    }

    fn meta(self, key: &str) -> Option<&'static Value> {
        self.site.get(key).or_else(|| self.body.get(key)).or_else(|| self.outer?.get(key))
    }

    fn text(self, key: &str) -> Option<&'static str> {
        self.meta(key).and_then(Value::as_str)
    }

    /// One line of help.
    pub fn help(self) -> &'static str {
        self.text("description").unwrap_or_default()
    }

    /// The formula of a branch of a tagged type.
    pub fn formula(self) -> Option<&'static str> {
        self.text("formula")
    }

    /// The unit of its numbers; `None` if they have none.
    pub fn unit(self) -> Option<&'static str> {
        self.text("unit").filter(|unit| *unit != PLAIN)
    }

    /// The letter for its vector in formulas.
    pub fn symbol(self) -> Option<&'static str> {
        self.text("symbol")
    }

    /// Whether a pair in pixels is a vector from one place to another: its numbers are called dx and dy, or the schema says so.
    pub fn is_relative(self) -> bool {
        self.column(0) == Some("dx") || self.meta("relative").is_some()
    }

    /// What its text names: the key of one of the scene's lists ("images").
    pub fn reference(self) -> Option<&'static str> {
        self.text("reference")
    }

    /// Where a list may be named in its place: the key of one of the scene's lists ("shapes").
    pub fn named(self) -> Option<&'static str> {
        self.site.get("named").and_then(Value::as_str)
    }

    /// How an item of this list or map that is there without being written, such as one of a style, is left out: by writing
    /// `null`, or by a field of it that is true. Items of such a list are addressed by name, also those that are not written.
    pub fn laid(self) -> Option<&'static str> {
        self.site.get("laid").and_then(Value::as_str)
    }

    /// The fields of an object of which exactly one is written; a new object has the first.
    pub fn either(self) -> impl Iterator<Item = &'static str> + Clone {
        self.body.get("either").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
    }

    /// The names of a fixed number of numbers, if they have any: x and y for anything in pixels, x, y and z for three.
    pub fn column(self, index: usize) -> Option<&'static str> {
        match self.meta("columns") {
            Some(names) => names.get(index).and_then(Value::as_str),
            None if matches!(self.body(), Body::Numbers(3)) => ["x", "y", "z"].get(index).copied(),
            None if self.unit() == Some("px") => ["x", "y"].get(index).copied(),
            None => None,
        }
    }

    /// Whether its numbers must be whole.
    pub fn has_whole_numbers(self) -> bool {
        match self.body() {
            Body::Number { integer } => integer,
            Body::Numbers(_) => Shape::of(&self.body["items"], None).has_whole_numbers(),
            Body::Text | Body::Bool | Body::Choice | Body::Row(_) | Body::List(..) | Body::Map(_) => false,
            Body::Object | Body::Tagged(_) => false,
        }
    }

    /// Least and greatest value of the number, or of each of its numbers.
    pub fn range(self) -> Option<(f64, f64)> {
        if let Body::Numbers(_) = self.body() {
            return Shape::of(&self.body["items"], None).range();
        }
        let limit = |key| self.body.get(key).and_then(Value::as_f64);
        match (limit("minimum"), limit("maximum")) {
            (None, None) => None,
            (min, max) => Some((min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY))),
        }
    }

    /// The least number of characters of a text.
    pub fn min_length(self) -> usize {
        self.body.get("minLength").and_then(Value::as_u64).unwrap_or(0) as usize
    }

    /// The value if nothing is written.
    pub fn default(self) -> Option<&'static Value> {
        self.site.get("default")
    }

    /// The words that a choice allows, or the tags of a tagged type, each with its help.
    pub fn choices(self) -> impl Iterator<Item = (&'static str, &'static str)> + Clone {
        let list = self.body.get("oneOf").or_else(|| self.body.get("enum")).and_then(Value::as_array);
        list.into_iter().flatten().filter_map(|one| {
            let name = tag_of(one).map(|tag| &one["properties"][tag]["const"]).or_else(|| one.get("const"));
            let help = one.get("description").and_then(Value::as_str).unwrap_or_default();
            Some((name.unwrap_or(one).as_str()?, help))
        })
    }

    /// The branch of a tagged type whose tag is `name`.
    pub fn variant(self, name: &str) -> Option<Shape> {
        let variants = self.body.get("oneOf")?.as_array()?;
        let branch = variants.iter().find(|one| tag_of(one).is_some_and(|tag| one["properties"][tag]["const"] == name));
        branch.map(|branch| Shape { site: self.site, body: branch, outer: None, tag: None, optional: self.optional })
    }

    /// The branch that `value` chooses: the shape itself if it has no tag, `None` if the tag is missing or unknown.
    pub fn branch(self, value: Option<&Value>) -> Option<Shape> {
        let Body::Tagged(tag) = self.body() else { return Some(self) };
        self.variant(value?.get(tag)?.as_str()?)
    }

    /// The field `name` of an object whose tag, if it has one, is in `value`.
    pub fn property(self, value: Option<&Value>, name: &str) -> Option<Shape> {
        match self.body() {
            Body::Tagged(tag) if tag == name => Some(Shape { tag: Some(tag), site: self.body, ..self }),
            Body::Tagged(_) => self.branch(value)?.property(None, name),
            Body::Map(item) => Some(item),
            Body::Object => Some(Shape::of(self.fields()?.get(name)?, None)),
            Body::List(..) | Body::Numbers(_) | Body::Row(_) => None,
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => None,
        }
    }

    /// The fields of an object in their order, the tag first.
    pub fn properties(self, value: Option<&Value>) -> Vec<(&'static str, Shape)> {
        let names = self.branch(value).and_then(Shape::fields).into_iter().flat_map(Map::keys).map(String::as_str);
        let mut names: Vec<_> = names.collect();
        if let (Body::Tagged(tag), true) = (self.body(), names.is_empty()) {
            names.push(tag);
        }
        names.into_iter().filter_map(|name| Some((name, self.property(value, name)?))).collect()
    }

    /// The shapes that may be one token deeper, for any tag of a tagged type.
    pub fn below(self, token: &str) -> Vec<Shape> {
        match self.body() {
            Body::List(item, ..) => pointer::index(token).map(|_| item).into_iter().collect(),
            Body::Row(_) => pointer::index(token).and_then(|index| self.part(index)).into_iter().collect(),
            Body::Tagged(_) => {
                let branches = self.choices().filter_map(|(name, _)| self.variant(name));
                branches.filter_map(|branch| branch.property(None, token)).collect()
            }
            Body::Object | Body::Map(_) => self.property(None, token).into_iter().collect(),
            // Numbers have shapes by their place: [`Place::step`].
            Body::Numbers(_) => Vec::new(),
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => Vec::new(),
        }
    }

    /// The only value that a field may have: the tag of a branch.
    pub fn constant(self, name: &str) -> Option<&'static Value> {
        self.fields()?.get(name)?.get("const")
    }

    /// The required fields of an object whose tag is already chosen.
    pub fn required(self) -> impl Iterator<Item = &'static str> {
        self.body.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
    }

    /// The known fields of an object whose tag is already chosen.
    pub fn fields(self) -> Option<&'static Map<String, Value>> {
        self.body.get("properties").and_then(Value::as_object)
    }
}

/// The property that distinguishes a branch of a tagged type.
fn tag_of(branch: &'static Value) -> Option<&'static str> {
    let properties = branch.get("properties")?.as_object()?;
    properties.iter().find(|(_, property)| property.get("const").is_some()).map(|(name, _)| name.as_str())
}

/// What a pointer leads to.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Its shape.
    pub shape: Shape,
    /// The value written there, otherwise the default; `None` if there is neither.
    pub value: Option<&'a Value>,
    /// Whether it is written in the document.
    pub set: bool,
    /// Whether it must be written.
    pub required: bool,
}

impl<'a> Place<'a> {
    /// The whole of a document.
    pub fn root(json: &'a Value) -> Place<'a> {
        Place { shape: Shape::root(), value: Some(json), set: true, required: true }
    }

    /// What `pointer` leads to; `None` if the schema knows no such place or a list is too short. The place just after
    /// the end of a list, also written `-`, and any key in a map are places without a value.
    pub fn of(json: &'a Value, pointer: &str) -> Option<Place<'a>> {
        if !pointer.is_empty() && !pointer.starts_with('/') {
            return None;
        }
        Pointer(pointer).tokens().try_fold(Place::root(json), |place, token| place.step(&token))
    }

    /// One token deeper.
    pub fn step(self, token: &str) -> Option<Place<'a>> {
        let here = self.value.filter(|value| !value.is_null());
        match self.shape.body() {
            Body::List(item, ..) => {
                let items = here.and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
                let index = if token == "-" { Some(items.len()) } else { pointer::index(token) };
                let named = || {
                    let at = items.iter().position(|item| item.get("name").is_some_and(|name| name == token));
                    self.shape.laid().map(|_| at.unwrap_or(items.len()))
                };
                let index = index.or_else(named)?;
                let value = items.get(index);
                let known = index <= items.len();
                known.then_some(Place { shape: item, value, set: self.set && value.is_some(), required: true })
            }
            Body::Numbers(count) => {
                let index = pointer::index(token).filter(|&index| index < count)?;
                let shape = Shape::of(&self.shape.body["items"], Some(self.shape.outer.unwrap_or(self.shape.site)));
                Some(Place { shape, value: here.and_then(|v| v.get(index)), set: self.set, required: true })
            }
            Body::Row(_) => {
                let index = pointer::index(token)?;
                let (shape, value) = (self.shape.part(index)?, here.and_then(|value| value.get(index)));
                Some(Place { shape, value, set: self.set, required: true })
            }
            Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => None,
            Body::Object | Body::Tagged(_) | Body::Map(_) => {
                let shape = self.shape.property(here, token)?;
                let written = here.and_then(|value| value.get(token));
                let required = self.shape.branch(here).is_some_and(|branch| branch.required().any(|n| n == token));
                let set = self.set && written.is_some();
                Some(Place { shape, value: written.or(shape.default()), set, required })
            }
        }
    }
}
