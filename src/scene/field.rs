//! Fields for people: what a form, a line of help and completion need to know about one place in a document. Made from
//! the schema alone.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

use super::json_schema::range_text;
use super::named::name_of;
use super::schema::{Body, Place, Shape};
use super::{Document, FRAME};
use crate::base::number;
use crate::base::pointer::{self, Pointer};
use crate::layers::technique::Technique;

/// One place in a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name among its siblings: a key, the name of an item, or an index.
    pub name: String,
    /// One line of help.
    pub help: &'static str,
    /// Its kind.
    pub kind: Kind,
    /// Least and greatest number.
    pub range: Option<(f64, f64)>,
    /// The unit of its numbers.
    pub unit: Option<&'static str>,
    /// The letter for its vector in formulas: J for a jump.
    pub symbol: Option<&'static str>,
    /// The value if nothing is written.
    pub default: Option<Value>,
    /// Whether it may be removed.
    pub optional: bool,
}

/// What a [`Field`] is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A number.
    Number {
        /// Whether it is a whole number.
        integer: bool,
    },
    /// Text.
    Text,
    /// true or false.
    Bool,
    /// One of several words; also the tag of a tagged object.
    Choice(Vec<Choice>),
    /// A fixed number of numbers, with their names if they have any ("x", "y").
    Numbers(Vec<String>),
    /// A list of items of this kind.
    List(Box<Field>),
    /// An object with arbitrary keys and values of this kind.
    Map(Box<Field>),
    /// An object with known fields.
    Object,
    /// An object whose tag says which fields it has.
    Tagged {
        /// Name of the tag.
        tag: &'static str,
        /// The values of the tag.
        variants: Vec<Choice>,
    },
    /// The name of one of the entries of this list of the scene ("images").
    Reference(&'static str),
}

impl Kind {
    /// Whether it is a list, whose items have indexes.
    pub fn is_list(&self) -> bool {
        matches!(self, Kind::List(_))
    }

    /// Whether it has fields that are known by name.
    pub fn is_object(&self) -> bool {
        match self {
            Kind::Object | Kind::Tagged { .. } => true,
            Kind::Number { .. } | Kind::Text | Kind::Bool | Kind::Choice(_) | Kind::Numbers(_) => false,
            Kind::List(_) | Kind::Map(_) | Kind::Reference(_) => false,
        }
    }

    /// The words that it can be, or its tag; none if it is no choice of words.
    pub fn words(&self) -> &[Choice] {
        match self {
            Kind::Choice(all) | Kind::Tagged { variants: all, .. } => all,
            Kind::Number { .. } | Kind::Text | Kind::Bool | Kind::Numbers(_) | Kind::List(_) | Kind::Map(_) => &[],
            Kind::Object | Kind::Reference(_) => &[],
        }
    }

    /// The name of its tag and the values of that, if it has one.
    pub fn tag(&self) -> Option<(&'static str, &[Choice])> {
        if let Kind::Tagged { tag, variants } = self { Some((*tag, variants)) } else { None }
    }
}

/// One word of a choice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The word.
    pub name: &'static str,
    /// One line of help.
    pub help: &'static str,
}

/// A place below another.
#[derive(Clone, Debug, PartialEq)]
pub struct Child {
    /// Its name among its siblings: a key, the name of an item, or an index.
    pub name: String,
    /// Where it is.
    pub pointer: String,
    /// Whether it is written in the document; otherwise its default applies.
    pub set: bool,
    /// Its field.
    pub field: Field,
}

/// The field at `pointer`, whether written or not; `None` if the schema knows no such place.
pub fn field(document: &Document, pointer: &str) -> Option<Field> {
    let place = Place::of(document.json(), pointer)?;
    let (holder, last) = Pointer(pointer).split().unwrap_or_default();
    let holder = Place::of(document.json(), holder);
    let column = holder.and_then(|holder| column(holder, &last));
    let name = name_of(place.value).or(column.map(str::to_owned)).unwrap_or(last);
    Some(Field::new(name, place))
}

/// The value at `pointer`, or its default; `null` for an optional thing that is not there. `None` if the schema knows
/// no such place.
pub fn value(document: &Document, pointer: &str) -> Option<Value> {
    // What is written needs no schema.
    if let Some(written) = document.json().pointer(pointer).filter(|value| !value.is_null()) {
        return Some(written.clone());
    }
    let place = Place::of(document.json(), pointer)?;
    place.value.cloned().or_else(|| place.shape.allows_null().then_some(Value::Null))
}

/// The value that counts at `pointer`: as [`value`], or what is in force.
pub fn counting(document: &Document, pointer: &str) -> Option<Value> {
    value(document, pointer)
        .filter(|value| !value.is_null())
        .or_else(|| in_force(document, pointer))
        .or_else(|| value(document, pointer))
}

/// The same as a person writes it: `40` where the schema's default is `40.0`; what is written stays as it is.
pub fn told(document: &Document, pointer: &str) -> Option<Value> {
    let is_written = document.json().pointer(pointer).is_some_and(|written| !written.is_null());
    let value = counting(document, pointer)?;
    Some(if is_written { value } else { number::mapped(value, |number| number) })
}

/// The formula of the thing at `pointer`, by its tag; `None` if it has none.
pub fn formula(document: &Document, pointer: &str) -> Option<&'static str> {
    let place = Place::of(document.json(), pointer)?;
    place.shape.branch(place.value)?.formula()
}

/// Whether there is a value at `pointer`: written, by default, or in force.
pub fn is_there(document: &Document, pointer: &str) -> bool {
    Place::of(document.json(), pointer).is_some_and(|place| place.value.is_some_and(|value| !value.is_null()))
        || in_force(document, pointer).is_some()
}

/// What is at `pointer`, as a form shows it: what is not written but in force is an object in which nothing is written.
pub fn standing<'a>(document: &'a Document, pointer: &str) -> Option<Place<'a>> {
    static NOTHING: LazyLock<Value> = LazyLock::new(|| Value::Object(Map::new()));
    let place = Place::of(document.json(), pointer)?;
    let missing = place.value.is_none_or(Value::is_null);
    let stands = missing && in_force(document, pointer).is_some_and(|value| value.is_object());
    Some(if stands { Place { value: Some(&NOTHING), ..place } } else { place })
}

/// The layer that a place belongs to, and the way from it to there.
pub fn layer_of<'a>(document: &'a Document, pointer: &'a str) -> Option<(&'a dyn Technique, &'a str)> {
    let (index, way) = Pointer(pointer).item_of("/layers")?;
    Some((document.scene().layers.get(index)?.technique(), way))
}

/// The value that its layer, or the scene, has for a place, if that is not in the schema.
pub fn in_force(document: &Document, pointer: &str) -> Option<Value> {
    let scene = document.scene();
    if let Some(way) = Pointer(pointer).below("/camera") {
        return scene.camera.as_ref()?.automatic(way);
    }
    if pointer == "/size" {
        let sized = scene.layers.iter().any(|layer| layer.technique().frame_of().is_some());
        return (!sized).then(|| json!([FRAME.0, FRAME.1]));
    }
    let (layer, way) = layer_of(document, pointer)?;
    layer.automatic(way)
}

/// The tokens of all that stands in the list or the map at `pointer`, in order, if some of it need not be written: the
/// names of that, then of what else is written. `None` elsewhere.
pub fn laid(document: &Document, pointer: &str) -> Option<Vec<String>> {
    let (layer, way) = layer_of(document, pointer)?;
    let mut all = layer.laid(way)?;
    let written = match document.json().pointer(pointer) {
        Some(Value::Object(map)) => map.keys().cloned().collect(),
        Some(Value::Array(items)) => (0..items.len()).map(|i| token(items, i)).collect(),
        _ => Vec::new(),
    };
    let more: Vec<String> = written.into_iter().filter(|token| !all.contains(token)).collect();
    all.extend(more);
    Some(all)
}

/// The token of an item of a list with names: its name, if that cannot be taken for an index.
fn token(items: &[Value], index: usize) -> String {
    let name = name_of(items.get(index)).filter(|name| pointer::index(name).is_none() && name != "-");
    name.unwrap_or_else(|| index.to_string())
}

/// The same pointer with names in place of indices in lists that [`laid`] knows, which stay as they are whatever is
/// written.
pub fn by_name(document: &Document, pointer: &str) -> String {
    let mut place = Some(Place::root(document.json()));
    let mut path = String::new();
    for step in Pointer(pointer).tokens() {
        let list = place.filter(|place| place.shape.laid().is_some()).and_then(|place| place.value?.as_array());
        let index = pointer::index(&step).filter(|index| list.is_some_and(|list| *index < list.len()));
        let step = index.zip(list).map_or_else(|| step.clone(), |(index, list)| token(list, index));
        pointer::push(&mut path, &step);
        place = place.and_then(|place| place.step(&step));
    }
    path
}

/// The same pointer as it is in the document, with indices in place of names. If the item of a name is not written, that is
/// the place after the last item, and that place comes with its name.
pub fn as_written(document: &Document, pointer: &str) -> (String, Option<(String, String)>) {
    let mut place = Some(Place::root(document.json()));
    let (mut path, mut missing) = (String::new(), None);
    for step in Pointer(pointer).tokens() {
        let is_named = place.is_some_and(|place| place.shape.laid().is_some() && list_of(place).is_some());
        let items = place.and_then(list_of).filter(|_| is_named && pointer::index(&step).is_none() && step != "-");
        place = place.and_then(|place| place.step(&step));
        match items {
            None => pointer::push(&mut path, &step),
            Some(items) => {
                let at = items.iter().position(|item| name_of(Some(item)).is_some_and(|name| name == *step));
                pointer::push(&mut path, &at.unwrap_or(items.len()).to_string());
                missing = missing.or(at.is_none().then(|| (path.clone(), step)));
            }
        }
    }
    (path, missing)
}

/// The items of the list at a place, written or not; `None` if it is no list.
fn list_of(place: Place<'_>) -> Option<&[Value]> {
    place.shape.body().is_list().then(|| place.value.and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice))
}

/// The places directly below `pointer`: the fields of an object in the schema's order, including those that are not
/// written; the items of a list. Empty for plain values and lists of numbers.
pub fn children(document: &Document, pointer: &str) -> Vec<Child> {
    let Some(place) = Place::of(document.json(), pointer) else { return Vec::new() };
    below(place, pointer).into_iter().map(|(child, _)| child).collect()
}

/// The places directly below `place`, which is at `pointer`, each with its own place for its value.
pub fn below<'a>(place: Place<'a>, pointer: &str) -> Vec<(Child, Place<'a>)> {
    steps(place).into_iter().map(|(token, below)| (described(place, pointer, &token, below), below)).collect()
}

/// The places directly below `place`, each with its token; without the version of the format, which nobody edits.
pub fn steps(place: Place<'_>) -> Vec<(String, Place<'_>)> {
    let value = place.value.filter(|value| !value.is_null());
    match place.shape.body() {
        Body::List(shape, ..) => {
            let items = value.and_then(Value::as_array).into_iter().flatten().enumerate();
            let item = |value| Place { shape, value: Some(value), set: place.set, required: true };
            items.map(|(i, value)| (i.to_string(), item(value))).collect()
        }
        Body::Row(count) => {
            let part = |i: usize| Some((i.to_string(), place.step(&i.to_string())?));
            (0..count).filter(|_| value.is_some()).filter_map(part).collect()
        }
        Body::Map(_) => {
            let keys = value.and_then(Value::as_object).into_iter().flat_map(|map| map.keys());
            keys.filter_map(|key| Some((key.clone(), place.step(key)?))).collect()
        }
        Body::Object | Body::Tagged(_) if value.is_some() => {
            let branch = place.shape.branch(value);
            let required = |name: &str| branch.is_some_and(|branch| branch.required().any(|one| one == name));
            let properties = place.shape.properties(value).into_iter().filter(|(_, shape)| !shape.is_fixed());
            let inner = properties.map(|(name, shape)| {
                let written = value.and_then(|value| value.get(name));
                let set = place.set && written.is_some();
                let value = written.or(shape.default());
                (name.to_owned(), Place { shape, value, set, required: required(name) })
            });
            inner.collect()
        }
        Body::Object | Body::Tagged(_) => Vec::new(),
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice | Body::Numbers(_) => Vec::new(),
    }
}

/// The place one token below `place`, which is at `pointer`.
pub fn child<'a>(place: Place<'a>, pointer: &str, token: &str) -> Option<(Child, Place<'a>)> {
    let below = place.step(token)?;
    Some((described(place, pointer, token, below), below))
}

fn described(parent: Place, pointer: &str, token: &str, place: Place) -> Child {
    let name = name_of(place.value).unwrap_or_else(|| column(parent, token).unwrap_or(token).to_owned());
    let field = Field::new(name.clone(), place);
    Child { name, pointer: Pointer(pointer).join(token), set: place.set, field }
}

/// The name of one of a fixed number of values, if it has one.
fn column(parent: Place, token: &str) -> Option<&'static str> {
    parent.shape.body().count()?;
    parent.shape.column(pointer::index(token)?)
}

/// How many items the list at a place has.
pub fn count(place: Place) -> usize {
    place.value.and_then(Value::as_array).map_or(0, Vec::len)
}

impl Field {
    fn new(name: String, place: Place) -> Field {
        let shape = place.shape;
        Field {
            name,
            help: shape.help(),
            kind: kind(shape),
            range: shape.range(),
            unit: shape.unit(),
            symbol: shape.symbol(),
            default: shape.default().cloned(),
            optional: !place.required,
        }
    }

    fn item(shape: Shape) -> Box<Field> {
        Box::new(Field::new(String::new(), Place { shape, value: None, set: false, required: true }))
    }

    /// The range and unit in words: `0.001 to 1000000 px`.
    pub fn range_text(&self) -> Option<String> {
        range_text(self.range, self.unit)
    }
}

fn kind(shape: Shape) -> Kind {
    let choices = || shape.choices().map(|(name, help)| Choice { name, help }).collect();
    match shape.body() {
        Body::Number { integer } => Kind::Number { integer },
        Body::Text => shape.reference().map_or(Kind::Text, Kind::Reference),
        Body::Bool => Kind::Bool,
        Body::Choice => Kind::Choice(choices()),
        Body::Numbers(n) => {
            Kind::Numbers((0..n).map(|i| shape.column(i).map_or_else(|| i.to_string(), str::to_owned)).collect())
        }
        Body::List(item, ..) => Kind::List(Field::item(item)),
        Body::Map(item) => Kind::Map(Field::item(item)),
        Body::Object | Body::Row(_) => Kind::Object,
        Body::Tagged(tag) => Kind::Tagged { tag, variants: choices() },
    }
}
