//! A node of the scene as rows and cells, made from the schema: a list becomes a table, anything else a form, and a list of
//! unnamed items inside a form is shown in it row by row. The panes draw a sheet and the commands edit its cells; neither
//! knows a field by name, so a new parameter appears by itself.

use super::derived;
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::tui::text::plain;
use std::ops::Range;
use std::sync::Arc;

use kurbo::Vec2;
use serde_json::Value;

use crate::layers::parts::derived::Derived;
use crate::scene::Document;
use crate::scene::field::{self, Child, Field, Kind};
use crate::scene::schema::{Body, Place};
use crate::tui::text::numbers;

/// A node as rows. A row is made only when it is needed, so that a list of ten thousand is as quick as one of ten.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Whether it is a list, whose items are the rows.
    pub table: bool,
    document: Document,
    blocks: Vec<Block>,
    /// The columns of items that are shown, in order; all if there are none.
    columns: Arc<[String]>,
}

/// Consecutive rows that are made in the same way.
#[derive(Clone, Debug)]
struct Block {
    /// The list whose items they are, or the one field.
    pointer: String,
    /// How many items; `None` for a field.
    items: Option<usize>,
}

/// One row: a field, an item of a list, or the heading of a list inside a form.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Where it is in the document.
    pub pointer: String,
    /// Its name or index.
    pub label: String,
    /// What it is.
    pub field: Arc<Field>,
    /// Whether it is written in the document.
    pub set: bool,
    /// Whether it is an item of a list.
    pub item: bool,
    /// What can be edited in it, from left to right.
    pub cells: Vec<Cell>,
}

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
        let json = |number: f64| match self.field.kind {
            Kind::Number { integer: true } if number == number.trunc() => Value::from(number as i64),
            _ => number::json(number),
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
    matches!(kind, Kind::Object | Kind::Tagged { .. } | Kind::List(_) | Kind::Map(_))
}

fn vector(value: &Value) -> Option<Vec2> {
    Some(Vec2::new(value.get(0)?.as_f64()?, value.get(1)?.as_f64()?))
}

impl Block {
    fn len(&self) -> usize {
        self.items.unwrap_or(1)
    }
}

impl Sheet {
    /// The node at `node`; empty if there is none.
    pub fn of(document: &Document, node: &str) -> Sheet {
        let place = field::standing(document, node);
        let body = place.map(|place| place.shape.body());
        let laid = field::laid(document, node).map(|tokens| {
            let row = |token: String| Block { pointer: Pointer(node).join(token), items: None };
            tokens.into_iter().map(row)
        });
        let table = matches!(body, Some(Body::List(..) | Body::Map(_)));
        let blocks = match (place, body) {
            (Some(_), Some(Body::List(..) | Body::Map(_))) if laid.is_some() => laid.into_iter().flatten().collect(),
            (Some(place), Some(Body::List(..))) => {
                vec![Block { pointer: node.to_owned(), items: Some(field::count(place)) }]
            }
            (Some(place), Some(_)) => blocks(place, node),
            _ => Vec::new(),
        };
        Sheet { table, document: document.clone(), blocks, columns: Arc::default() }
    }

    /// The same with these columns only, and the kind of each item.
    pub fn with(self, columns: Arc<[String]>) -> Sheet {
        Sheet { columns, ..self }
    }

    /// The same with all columns.
    pub fn whole(&self) -> Sheet {
        self.clone().with(Arc::default())
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One row.
    pub fn row(&self, index: usize) -> Option<Row> {
        self.rows(index..index.checked_add(1)?).pop()
    }

    /// The rows of a range, as far as they exist.
    pub fn rows(&self, range: Range<usize>) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut first = 0;
        for block in &self.blocks {
            let end = first + block.len();
            let (from, to) = (range.start.clamp(first, end), range.end.clamp(first, end));
            if from < to {
                self.make(block, from - first..to - first, &mut rows);
            }
            first = end;
        }
        rows
    }

    /// The rows that are fields, not items of lists.
    pub fn fields(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        self.blocks.iter().filter(|block| block.items.is_none()).for_each(|block| self.make(block, 0..1, &mut rows));
        rows
    }

    fn make(&self, block: &Block, range: Range<usize>, rows: &mut Vec<Row>) {
        let json = self.document.json();
        match block.items {
            Some(_) => {
                let Some(list) = Place::of(json, &block.pointer) else { return };
                let items = range.filter_map(|i| field::child(list, &block.pointer, &i.to_string()));
                rows.extend(items.map(|(child, place)| self.chosen(item(&self.document, child, place))));
            }
            None => {
                let parent = Pointer(&block.pointer).split();
                let place = parent.as_ref().and_then(|(parent, _)| Place::of(json, parent));
                let (Some((parent, name)), Some(place)) = (parent, place) else { return };
                let Some((child, _)) = field::child(place, parent, &name) else { return };
                let Some(place) = field::standing(&self.document, &block.pointer) else { return };
                rows.push(match self.table {
                    true => self.chosen(item(&self.document, child, place)),
                    false => form_row(&self.document, child, place),
                });
            }
        }
    }

    /// A row with the chosen columns only.
    fn chosen(&self, mut row: Row) -> Row {
        if !self.columns.is_empty() {
            let kind = |cell: &Cell| matches!(cell.field.kind, Kind::Choice(_));
            let cells = std::mem::take(&mut row.cells).into_iter().enumerate();
            let place = |(i, cell): (usize, Cell)| match self.columns.iter().position(|head| *head == cell.head) {
                _ if i == 0 && kind(&cell) => Some((0, cell)),
                place => place.map(|place| (place + 1, cell)),
            };
            let mut placed: Vec<(usize, Cell)> = cells.filter_map(place).collect();
            placed.sort_by_key(|(place, _)| *place);
            row.cells = placed.into_iter().map(|(_, cell)| cell).collect();
        }
        row
    }

    /// Where a row is in the document.
    pub fn pointer(&self, index: usize) -> Option<String> {
        let mut rest = index;
        for block in &self.blocks {
            match block.items {
                Some(_) if rest < block.len() => return Some(Pointer(&block.pointer).join(rest)),
                None if rest == 0 => return Some(block.pointer.clone()),
                _ => rest -= block.len(),
            }
        }
        None
    }

    /// The row of a place in the document.
    pub fn position(&self, pointer: &str) -> Option<usize> {
        let pointer = &*field::by_name(&self.document, pointer);
        let mut first = 0;
        for block in &self.blocks {
            match block.items {
                None if block.pointer == pointer => return Some(first),
                Some(count) => {
                    let item = Pointer(pointer).item_of(&block.pointer).filter(|(_, way)| way.is_empty());
                    if let Some((index, _)) = item.filter(|(index, _)| *index < count) {
                        return Some(first + index);
                    }
                }
                None => {}
            }
            first += block.len();
        }
        None
    }
}

/// The fields of a form, with the items of each list that is shown inside it.
fn blocks(place: Place, node: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (child, place) in field::below(place, node) {
        let inside = match &child.field.kind {
            Kind::List(of) if is_flat(&of.kind) => Some(field::count(place)),
            _ => None,
        };
        blocks.push(Block { pointer: child.pointer.clone(), items: None });
        blocks.extend(inside.map(|count| Block { pointer: child.pointer, items: Some(count) }));
    }
    blocks
}

fn item(document: &Document, child: Child, place: Place) -> Row {
    let label = Pointer(&child.pointer).split().map(|(_, token)| token).unwrap_or_default();
    let field = Arc::new(child.field);
    let mut cells = match &field.kind {
        Kind::Object | Kind::Tagged { .. } if place.value.is_some_and(|value| !value.is_null()) => {
            let inner = field::below(place, &child.pointer).into_iter();
            inner.fold(Vec::new(), |row, (child, place)| {
                joined(row, cells(document, (&child.name, &child.pointer), &Arc::new(child.field), place, true))
            })
        }
        _ => cells(document, (&child.name, &child.pointer), &field, place, true),
    };
    cells.extend(
        derived::columns(document, &child.pointer).iter().map(|column| follows(document, &child.pointer, column)),
    );
    Row { label, set: true, item: true, cells, pointer: child.pointer, field }
}

/// The cell of a column that follows from the fields of an item.
fn follows(document: &Document, item: &str, column: &'static Derived) -> Cell {
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

fn form_row(document: &Document, child: Child, place: Place) -> Row {
    let Child { name, pointer, set, field } = child;
    let field = Arc::new(field);
    let cells = cells(document, (&name, &pointer), &field, place, false);
    Row { pointer, label: name, field, set, item: false, cells }
}

/// Adds the cells of a field to a row. Heads that the row has already are prefixed with the field's name.
fn joined(mut row: Vec<Cell>, mut more: Vec<Cell>) -> Vec<Cell> {
    if more.iter().any(|cell| row.iter().any(|other| other.head == cell.head)) {
        more.iter_mut().for_each(|cell| cell.head = format!("{} {}", cell.field.name, cell.head));
    }
    row.append(&mut more);
    row
}

/// Whether items of this kind are shown inside the form that holds their list: unnamed ones are.
fn is_flat(kind: &Kind) -> bool {
    matches!(kind, Kind::Numbers(_) | Kind::Number { .. } | Kind::Object)
}

/// The cells of a field. In a table, a cell without a head of its own gets the field's name.
fn cells(
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
