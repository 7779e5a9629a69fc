//! What a layer makes of the fields of a document: the values of those that are not set, and columns that follow from
//! others.

use serde_json::Value;

use crate::base::number;
use crate::base::pointer::Pointer;
use crate::layers::parts::derived::Derived;
use crate::scene::Document;
use crate::scene::field::{self, Field, Kind, layer_of};

/// The value at a place; if it is not set and the schema has no default, the one that its layer has for it.
pub fn value(document: &Document, pointer: &str) -> Option<Value> {
    let value = field::value(document, pointer)?;
    Some(if value.is_null() { automatic(document, pointer).unwrap_or_default() } else { value })
}

/// The value that a layer has for a field that is not set.
pub fn automatic(document: &Document, pointer: &str) -> Option<Value> {
    Some(number::mapped(field::in_force(document, pointer)?, number::tidy))
}

/// What is known of a column.
pub fn field(column: &Derived) -> Field {
    Field {
        name: column.name.into(),
        help: column.help,
        kind: Kind::Number { integer: false },
        range: None,
        unit: Some(column.unit),
        symbol: None,
        default: None,
        optional: true,
    }
}

/// The columns that follow from the item at `pointer`.
pub fn columns(document: &Document, pointer: &str) -> &'static [Derived] {
    let layer = Pointer(pointer).parent().and_then(|list| layer_of(document, list));
    layer.map_or(&[], |(layer, list)| layer.derived(list))
}

/// The number in a column of the item whose field is at `pointer`.
pub fn number(document: &Document, column: &Derived, pointer: &str) -> Option<f64> {
    let item = Pointer(pointer).parent()?;
    layer_of(document, item)?.0.derive(column, &field::value(document, item)?)
}

/// The value of the field at `pointer` with which its item has this number in a column.
///
/// # Errors
/// Why there is none.
pub fn solved(document: &Document, column: &Derived, pointer: &str, to: f64) -> Result<Value, String> {
    let found = || {
        let item = Pointer(pointer).parent()?;
        Some((item, layer_of(document, item)?.0, field::value(document, item)?))
    };
    let (item, layer, value) = found().ok_or("there is no number here")?;
    let row = Pointer(item).split().map(|(_, row)| row).unwrap_or_default();
    layer.solve(column, &value, to).map_err(|why| format!("row {row}: {why}"))
}
