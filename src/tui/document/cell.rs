//! What can be edited in a row: a cell is a value, or one number of it, or what follows from both, with its range and its
//! text in a few characters.

use super::derived;
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::tui::text::plain;
use std::sync::Arc;

use kurbo::Vec2;
use serde_json::Value;

use crate::layers::parts::derived::Derived;
use crate::scene::Document;
use crate::scene::field::{Field, Kind};
use crate::scene::schema::Place;
use crate::tui::text::numbers;

/// A value, or a part of one, that is edited by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Where its value is in the document; for a part of a list of numbers, where that list is.
    pub pointer: String,
    /// Which part of the value it is.
    pub part: Part,
    /// Its name in the row (x, y, dx, |J|, in dx); empty if the row's own name is enough.
    pub head: String,
    /// What the value is.
    pub field: Arc<Field>,
    /// The text that it shows.
    pub text: String,
    /// Whether its value is written in the document.
    pub set: bool,
}

/// Which part of a value a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    Whole,
    /// One of its numbers.
    Number(usize),
    /// The length of the vector that it is.
    Length,
    /// The direction of the vector that it is, in degrees.
    Degrees,
    /// A number that follows from it and other fields of its item.
    Derived(&'static Derived),
}

impl Cell {
    /// Whether it takes numbers.
    pub fn is_number(&self) -> bool {
        self.part != Part::Whole || matches!(self.field.kind, Kind::Number { .. })
    }

    /// Whether it stands for a node.
    pub fn is_node(&self) -> bool {
        is_node(&self.field.kind)
    }

    /// Its number in the document.
    pub fn number(&self, document: &Document) -> Option<f64> {
        if let Part::Derived(column) = self.part {
            return derived::number(document, column, &self.pointer).map(numbers::tidy);
        }
        let value = derived::value(document, &self.pointer)?;
        match self.part {
            Part::Derived(_) => None,
            Part::Whole => value.as_f64(),
            Part::Number(index) => value.get(index)?.as_f64(),
            Part::Length => vector(&value).map(|v| numbers::polar(v).0),
            Part::Degrees => vector(&value).map(|v| numbers::polar(v).1),
        }
    }

    /// The value at its place that gives it this number.
    ///
    /// # Errors
    /// Why there is none.
    pub fn with_number(&self, document: &Document, number: f64) -> Result<Value, String> {
        match self.part {
            Part::Derived(column) => derived::solved(document, column, &self.pointer, number),
            _ => self.changed(document, number).ok_or_else(|| "there is no number here".into()),
        }
    }

    fn changed(&self, document: &Document, number: f64) -> Option<Value> {
        let whole = self.field.kind == Kind::Number { integer: true };
        let json = |number: f64| match whole && number == number.trunc() {
            true => Value::from(number as i64),
            false => number::json(number),
        };
        let both = |v: Vec2| Some(Value::from(vec![number::json(v.x), number::json(v.y)]));
        let old = derived::value(document, &self.pointer)?;
        match self.part {
            Part::Whole => Some(json(number)),
            Part::Number(index) => {
                let mut all = old.as_array()?.clone();
                *all.get_mut(index)? = json(number);
                Some(all.into())
            }
            Part::Derived(_) => None,
            Part::Length => both(numbers::with_length(vector(&old)?, number)),
            Part::Degrees => both(numbers::cartesian(numbers::polar(vector(&old)?).0, number)),
        }
    }
}

/// Whether something of this kind is a node.
pub fn is_node(kind: &Kind) -> bool {
    kind.is_object() || matches!(kind, Kind::List(_) | Kind::Map(_))
}

fn vector(value: &Value) -> Option<Vec2> {
    Some(Vec2::new(value.get(0)?.as_f64()?, value.get(1)?.as_f64()?))
}

/// The cell of a column that follows from the fields of an item.
pub fn follows(document: &Document, item: &str, column: &'static Derived) -> Cell {
    let field = derived::field(column);
    let pointer = Pointer(item).join(column.of);
    let set = document.json().pointer(&pointer).is_some();
    let cell = Cell {
        pointer,
        part: Part::Derived(column),
        head: column.name.into(),
        field: Arc::new(field),
        text: String::new(),
        set,
    };
    Cell { text: cell.number(document).map_or("none".into(), numbers::shown), ..cell }
}

/// The cells of a field. In a table, a cell without a head of its own gets the field's name.
pub fn cells(
    document: &Document,
    (name, pointer): (&str, &str),
    field: &Arc<Field>,
    place: Place,
    table: bool,
) -> Vec<Cell> {
    let automatic = match place.value {
        None | Some(Value::Null) => derived::automatic(document, pointer),
        _ => None,
    };
    let value = automatic.as_ref().or(place.value).unwrap_or(&Value::Null);
    let cell = |part, head: String, text| {
        let (pointer, field) = (pointer.to_owned(), field.clone());
        Cell { pointer, part, head, field, text, set: place.set }
    };
    let Kind::Numbers(names) = &field.kind else {
        let head = if table { name.to_owned() } else { String::new() };
        return vec![cell(Part::Whole, head, summary(field, value))];
    };
    let number = |i: usize| value.get(i).and_then(Value::as_f64).unwrap_or(0.0);
    // A vector with a symbol needs no name; handles and the like say which one they are.
    let symbol = field.symbol;
    let head = |own: &str| {
        if symbol.is_some() || !table || !is_vector(names) { own.to_owned() } else { format!("{name} {own}") }
    };
    let shown = |i: usize| numbers::shown(number(i));
    let mut all: Vec<Cell> =
        names.iter().enumerate().map(|(i, name)| cell(Part::Number(i), head(name), shown(i))).collect();
    if is_vector(names) {
        let (length, degrees) = numbers::polar(Vec2::new(number(0), number(1)));
        all.push(cell(
            Part::Length,
            head(&symbol.map_or("r".into(), |symbol| format!("|{symbol}|"))),
            numbers::short(length),
        ));
        all.push(cell(Part::Degrees, head("°"), numbers::short(degrees)));
    }
    all
}

/// Whether numbers with these names are a vector, which then also has a length and a direction.
fn is_vector(names: &[String]) -> bool {
    names == ["dx", "dy"]
}

/// Checks a number against the range of its field.
pub fn in_range(field: &Field, part: Part, value: f64) -> Result<(), String> {
    let whole = matches!(field.kind, Kind::Number { integer: true });
    if whole && value != value.trunc() {
        return Err(format!("{} takes whole numbers, not {}", field.name, numbers::short(value)));
    }
    let counts = matches!(part, Part::Whole | Part::Number(_));
    match field.range.filter(|(min, max)| counts && !(*min..=*max).contains(&value)) {
        None => Ok(()),
        Some(_) => {
            let range = field.range_text().unwrap_or_default();
            Err(format!("{} is out of range: {} takes {range}", numbers::exact(value), field.name))
        }
    }
}

/// The range of a field; `None` if it is so wide that it only keeps sums finite.
pub fn told_range(field: &Field) -> Option<String> {
    const UNTOLD: f64 = 1e9;
    field.range.filter(|(min, max)| *min > -UNTOLD || *max < UNTOLD)?;
    field.range_text()
}

/// A value in a few characters.
pub fn summary(field: &Field, value: &Value) -> String {
    match (&field.kind, value) {
        (_, Value::Null) => "none".into(),
        (Kind::Number { .. }, value) => value.as_f64().map(numbers::shown).unwrap_or_default(),
        (_, Value::String(text)) => plain(text),
        (_, Value::Bool(on)) => if *on { "yes" } else { "no" }.into(),
        (Kind::Tagged { tag, .. }, value) => value.get(tag).and_then(Value::as_str).unwrap_or("?").into(),
        (Kind::Numbers(_), Value::Array(items)) => {
            items.iter().filter_map(Value::as_f64).map(numbers::shown).collect::<Vec<_>>().join(", ")
        }
        (_, Value::Array(items)) => format!("({})", items.len()),
        (_, Value::Object(fields)) if matches!(field.kind, Kind::Map(_)) => format!("({})", fields.len()),
        (_, Value::Object(fields)) => fields.get("name").and_then(Value::as_str).map(plain).unwrap_or_default(),
        (_, value) => value.to_string(),
    }
}
