//! A node of the scene as rows and cells, made from the schema: a list becomes a table, anything else a form, and a short
//! list inside a form stands in it row by row. The panes draw a sheet and the commands edit its cells; neither knows a
//! field by name, so a new parameter shows up here by itself.

use kurbo::Vec2;
use serde_json::Value;

use super::numbers;
use crate::scene::Document;
use crate::scene::field::{self, Child, Field, Kind};

/// A node as rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Whether it is a list, its items the rows.
    pub table: bool,
    /// The rows.
    pub rows: Vec<Row>,
}

/// One row: a field, an item of a list, or the heading of a list inside a form.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Where it is in the document.
    pub pointer: String,
    /// Its name or index.
    pub label: String,
    /// What it is.
    pub field: Field,
    /// Whether it is written in the document.
    pub set: bool,
    /// Whether it is an item of a list.
    pub item: bool,
    /// What can be edited in it, from left to right.
    pub cells: Vec<Cell>,
}

/// Something that is edited by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Where its value is in the document; for a part of a list of numbers, where that list is.
    pub pointer: String,
    /// Which part of the value it is.
    pub part: Part,
    /// Its name in the row (x, y, dx, |J|), empty where the row's own name says it.
    pub head: String,
    /// What the value is.
    pub field: Field,
    /// What it shows.
    pub text: String,
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
}

impl Cell {
    /// Whether it takes numbers.
    pub fn is_number(&self) -> bool {
        self.part != Part::Whole || matches!(self.field.kind, Kind::Number { .. })
    }

    /// Whether it stands for something with an inside of its own.
    pub fn is_node(&self) -> bool {
        is_node(&self.field.kind)
    }

    /// Its number in the document.
    pub fn number(&self, document: &Document) -> Option<f64> {
        let value = field::value(document, &self.pointer)?;
        match self.part {
            Part::Whole => value.as_f64(),
            Part::Number(index) => value.get(index)?.as_f64(),
            Part::Length => vector(&value).map(|v| numbers::polar(v).0),
            Part::Degrees => vector(&value).map(|v| numbers::polar(v).1),
        }
    }

    /// The pointer and the value that say `number` in the document.
    pub fn with_number(&self, document: &Document, number: f64) -> Option<(String, Value)> {
        let json = |number: f64| match self.field.kind {
            Kind::Number { integer: true } if number == number.trunc() => Value::from(number as i64),
            _ => tidy_json(number),
        };
        let both = |v: Vec2| Some((self.pointer.clone(), Value::from(vec![tidy_json(v.x), tidy_json(v.y)])));
        let old = field::value(document, &self.pointer)?;
        match self.part {
            Part::Whole => Some((self.pointer.clone(), json(number))),
            Part::Number(index) => {
                let mut all = old.as_array()?.clone();
                *all.get_mut(index)? = json(number);
                Some((self.pointer.clone(), all.into()))
            }
            Part::Length => both(numbers::with_length(vector(&old)?, number)),
            Part::Degrees => both(numbers::cartesian(numbers::polar(vector(&old)?).0, number)),
        }
    }
}

/// A JSON number, without a fraction where it has none.
pub fn tidy_json(number: f64) -> Value {
    if number == number.trunc() && number.abs() < 1e15 { Value::from(number as i64) } else { Value::from(number) }
}

/// Whether something of this kind has an inside of its own.
pub fn is_node(kind: &Kind) -> bool {
    matches!(kind, Kind::Object | Kind::Tagged { .. } | Kind::List(_) | Kind::Map(_))
}

fn vector(value: &Value) -> Option<Vec2> {
    Some(Vec2::new(value.get(0)?.as_f64()?, value.get(1)?.as_f64()?))
}

impl Sheet {
    /// The node at `pointer`; empty where there is none.
    pub fn of(document: &Document, pointer: &str) -> Sheet {
        let table = field::field(document, pointer).is_some_and(|f| matches!(f.kind, Kind::List(_) | Kind::Map(_)));
        let rows = if table { items(document, pointer) } else { form(document, pointer) };
        Sheet { table, rows }
    }

    /// The names of the columns of a table: those of its longest row.
    pub fn heads(&self) -> Vec<&str> {
        let longest = self.rows.iter().filter(|row| row.item).max_by_key(|row| row.cells.len());
        longest.map(|row| row.cells.iter().map(|cell| cell.head.as_str()).collect()).unwrap_or_default()
    }
}

fn items(document: &Document, pointer: &str) -> Vec<Row> {
    field::children(document, pointer).into_iter().map(|child| item(document, child)).collect()
}

fn item(document: &Document, child: Child) -> Row {
    let label = child.pointer.rsplit_once('/').map(|(_, token)| token.replace("~1", "/").replace("~0", "~"));
    let cells = match &child.field.kind {
        Kind::Object | Kind::Tagged { .. } => {
            let fields = field::children(document, &child.pointer);
            fields.iter().fold(Vec::new(), |row, field| joined(row, cells(document, field, true)))
        }
        _ => cells(document, &child, true),
    };
    let label = label.unwrap_or_default();
    Row { label, set: true, item: true, cells, pointer: child.pointer, field: child.field }
}

/// A row with the cells of one more field; their heads carry the field's name where they would be there twice.
fn joined(mut row: Vec<Cell>, mut more: Vec<Cell>) -> Vec<Cell> {
    if more.iter().any(|cell| row.iter().any(|other| other.head == cell.head)) {
        more.iter_mut().for_each(|cell| cell.head = format!("{} {}", cell.field.name, cell.head));
    }
    row.append(&mut more);
    row
}

fn form(document: &Document, pointer: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    for child in field::children(document, pointer) {
        let cells = cells(document, &child, false);
        let inside = match &child.field.kind {
            Kind::List(of) if is_flat(&of.kind) => items(document, &child.pointer),
            _ => Vec::new(),
        };
        let Child { name, pointer, set, field } = child;
        rows.push(Row { pointer, label: name, field, set, item: false, cells });
        rows.extend(inside);
    }
    rows
}

/// Whether items of this kind are shown inside the form that holds their list: unnamed ones are.
fn is_flat(kind: &Kind) -> bool {
    matches!(kind, Kind::Numbers(_) | Kind::Number { .. } | Kind::Object)
}

/// The cells of a field. In a table each takes the field's name as its head where it has none of its own.
fn cells(document: &Document, child: &Child, table: bool) -> Vec<Cell> {
    let value = field::value(document, &child.pointer).unwrap_or(Value::Null);
    let cell = |part, head: String, text| Cell {
        pointer: child.pointer.clone(),
        part,
        head,
        field: child.field.clone(),
        text,
    };
    let Kind::Numbers(names) = &child.field.kind else {
        let head = if table { child.name.clone() } else { String::new() };
        return vec![cell(Part::Whole, head, summary(&child.field, &value))];
    };
    let number = |i: usize| value.get(i).and_then(Value::as_f64).unwrap_or(0.0);
    let shown = |i: usize| numbers::short(number(i));
    let mut all: Vec<Cell> =
        names.iter().enumerate().map(|(i, name)| cell(Part::Number(i), name.clone(), shown(i))).collect();
    if is_vector(names) {
        let (length, degrees) = numbers::polar(Vec2::new(number(0), number(1)));
        all.push(cell(Part::Length, "|J|".into(), numbers::short(length)));
        all.push(cell(Part::Degrees, "°".into(), numbers::short(degrees)));
    }
    all
}

/// Whether numbers of these names are a vector, which also has a length and a direction.
fn is_vector(names: &[String]) -> bool {
    names == ["dx", "dy"]
}

/// A value in a few characters.
pub fn summary(field: &Field, value: &Value) -> String {
    match (&field.kind, value) {
        (_, Value::Null) => "none".into(),
        (Kind::Number { .. }, value) => value.as_f64().map(numbers::short).unwrap_or_default(),
        (_, Value::String(text)) => super::terminal::plain(text),
        (_, Value::Bool(on)) => if *on { "yes" } else { "no" }.into(),
        (Kind::Tagged { tag, .. }, value) => value.get(tag).and_then(Value::as_str).unwrap_or("?").into(),
        (_, Value::Array(items)) => format!("({})", items.len()),
        (_, Value::Object(fields)) if matches!(field.kind, Kind::Map(_)) => format!("({})", fields.len()),
        (_, Value::Object(fields)) => {
            fields.get("name").and_then(Value::as_str).map(super::terminal::plain).unwrap_or_default()
        }
        (_, value) => value.to_string(),
    }
}
