//! The fields of the scene by their names, for help: those that are written, those that are not, and columns that follow.

use super::command::Table;
use crate::base::pointer::Pointer;
use crate::base::problem::{nearest, quoted};
use crate::layers::parts::derived::Derived;
use crate::scene::field::{self, Field};
use crate::scene::schema::{Body, Place};
use crate::scene::{Document, address};
use crate::tui::document::derived;
use crate::tui::state::State;

/// At most so many items of a list are looked at: they are alike.
const MOST_ITEMS: usize = 20;
/// At most so deep.
const DEEPEST: usize = 12;
/// At most so many places are named where a name means several.
const MOST_NAMED: usize = 4;

/// A field, or a column that follows from one.
#[derive(Clone)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Where it is; that of a column is the field that it follows from.
    pub pointer: String,
    /// The column.
    pub column: Option<&'static Derived>,
}

impl Column {
    /// What is known of it.
    pub fn field(&self, document: &Document) -> Option<Field> {
        match self.column {
            Some(column) => Some(derived::field(column)),
            None => field::field(document, &self.pointer),
        }
    }
}

/// All fields, those of the layer that is shown first.
pub fn all(state: &State) -> Vec<Column> {
    let document = state.document();
    let mut found = Vec::new();
    walk(document, Place::root(document.json()), "", 0, &mut found);
    let mut around = Pointer(&state.cursor.node).upward();
    let shown = around.find(|at| Pointer(at).tokens().count() <= 2).unwrap_or_default();
    found.sort_by_key(|one| !Pointer(&one.pointer).is_within(shown));
    found
}

fn walk(document: &Document, place: Place, pointer: &str, depth: usize, found: &mut Vec<Column>) {
    if depth > DEEPEST {
        return;
    }
    let value = place.value.filter(|value| !value.is_null());
    let tokens: Vec<String> = match place.shape.body() {
        Body::List(..) | Body::Map(_) if place.shape.laid().is_some() => {
            field::laid(document, pointer).unwrap_or_default()
        }
        Body::List(..) => (0..field::count(place).clamp(1, MOST_ITEMS)).map(|i| i.to_string()).collect(),
        Body::Map(_) | Body::Row(_) => field::steps(place).into_iter().map(|(token, _)| token).collect(),
        Body::Object | Body::Tagged(_) => {
            let fields = place.shape.properties(value).into_iter().filter(|(_, shape)| !shape.is_fixed());
            fields.map(|(name, _)| name.to_owned()).collect()
        }
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice | Body::Numbers(_) => Vec::new(),
    };
    let is_named = place.shape.body().is_object();
    for token in tokens {
        let (Some(below), at) = (place.step(&token), Pointer(pointer).join(&token)) else { continue };
        walk(document, below, &at, depth + 1, found);
        if is_named {
            found.push(Column { name: token, pointer: at, column: None });
        } else {
            let column = |of: &'static Derived| Column {
                name: of.name.to_owned(),
                pointer: Pointer(&at).join(of.of),
                column: Some(of),
            };
            found.extend(derived::columns(document, &at).iter().map(column));
        }
    }
}

/// The field that a person means by an address, by the end of one, or by its name alone.
///
/// # Errors
/// There is none, or several that differ.
pub fn called(state: &State, table: &Table, text: &str) -> Result<Column, String> {
    let document = state.document();
    let exact = address::resolve(document, text).ok().filter(|pointer| field::field(document, pointer).is_some());
    if let Some(pointer) = exact.filter(|pointer| !pointer.is_empty()) {
        let name = Pointer(&pointer).split().map(|(_, name)| name).unwrap_or_default();
        return Ok(Column { name, pointer, column: None });
    }
    let all = all(state);
    let name = text.rsplit('.').next().unwrap_or(text);
    let is_name = |one: &&Column| one.name == name || one.column.is_some() && one.name == name.replace('_', " ");
    let ends = |one: &&Column| {
        let address = address::address(document, &one.pointer);
        !text.contains('.') || address.ends_with(&format!(".{text}"))
    };
    let mut meant: Vec<&Column> = Vec::new();
    for one in all.iter().filter(is_name).filter(ends) {
        let is_same = |other: &&Column| same(document, one, other);
        if !meant.iter().any(is_same) {
            meant.push(one);
        }
    }
    // A field of the layer itself is meant before one inside another.
    let depth = |one: &Column| one.pointer.matches('/').count();
    let least = meant.iter().map(|one| depth(one)).min();
    meant.retain(|one| Some(depth(one)) == least);
    match meant.as_slice() {
        [] => {
            let names = table.names();
            let known = names.iter().map(String::as_str).chain(all.iter().map(|one| one.name.as_str()));
            let near = nearest(text, known).filter(|near| near.starts_with("did you mean"));
            let near = near.unwrap_or("? lists commands, Space Space finds fields".into());
            Err(format!("there is no command or field {} ({near})", quoted(text)))
        }
        [one] => Ok((*one).clone()),
        several => {
            let places: Vec<String> =
                several.iter().take(MOST_NAMED).map(|one| address::address(document, &one.pointer)).collect();
            let more = if several.len() > MOST_NAMED { ", ..." } else { "" };
            Err(format!("{} is several fields: {}{more}", quoted(text), places.join(", ")))
        }
    }
}

/// Whether the same is known of two fields.
fn same(document: &Document, one: &Column, other: &Column) -> bool {
    let known = |found: &Column| found.field(document).map(|field| (field.help, field.range, field.unit));
    known(one) == known(other)
}
