//! A node of the scene as rows and cells, made from the schema: a list becomes a table, anything else a form, and a list of
//! unnamed items inside a form is shown in it row by row. The panes draw a sheet and the commands edit its cells; neither
//! knows a field by name, so a new parameter appears by itself.

use super::cell::{Cell, cells, follows};
use super::derived;
use crate::base::pointer::Pointer;
use std::ops::Range;
use std::sync::Arc;

use crate::scene::Document;
use crate::scene::field::{self, Child, Field, Kind};
use crate::scene::schema::{Body, Place};

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
        let has_rows = matches!(&child.field.kind, Kind::List(of) if is_flat(&of.kind));
        let inside = has_rows.then(|| field::count(place));
        blocks.push(Block { pointer: child.pointer.clone(), items: None });
        blocks.extend(inside.map(|count| Block { pointer: child.pointer, items: Some(count) }));
    }
    blocks
}

fn item(document: &Document, child: Child, place: Place) -> Row {
    let label = Pointer(&child.pointer).split().map(|(_, token)| token).unwrap_or_default();
    let field = Arc::new(child.field);
    let mut cells = match field.kind.is_object() && place.value.is_some_and(|value| !value.is_null()) {
        true => {
            let inner = field::below(place, &child.pointer).into_iter();
            inner.fold(Vec::new(), |row, (child, place)| {
                joined(row, cells(document, (&child.name, &child.pointer), &Arc::new(child.field), place, true))
            })
        }
        false => cells(document, (&child.name, &child.pointer), &field, place, true),
    };
    cells.extend(
        derived::columns(document, &child.pointer).iter().map(|column| follows(document, &child.pointer, column)),
    );
    Row { label, set: true, item: true, cells, pointer: child.pointer, field }
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
