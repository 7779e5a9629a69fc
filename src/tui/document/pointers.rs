//! JSON pointers: the ancestors of a place, and the list that it is an item of.

use crate::base::pointer::{self, Pointer};
use crate::scene::Document;
use crate::scene::field;

/// Whether `path` is an item of a list.
pub fn is_item(document: &Document, path: &str) -> bool {
    item_of(document, path).is_some()
}

/// The list and the index of an item that is written.
pub fn item_of<'a>(document: &Document, path: &'a str) -> Option<(&'a str, usize)> {
    let (list, last) = Pointer(path).split()?;
    let is_list = field::field(document, list)?.kind.is_list();
    let named = || {
        let (written, missing) = field::as_written(document, path);
        pointer::index(&Pointer(&written).split()?.1).filter(|_| missing.is_none())
    };
    Some((list, pointer::index(&last).or_else(named).filter(|_| is_list)?))
}
