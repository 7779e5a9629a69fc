//! A value being typed into a cell.

use super::cell::Cell;
use crate::scene::{Document, field};
use crate::tui::text::input::Text;
use crate::tui::text::numbers;

/// A value being typed.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What has been typed.
    pub text: Text,
}

impl Entry {
    /// Starts with the cell's value, with all of its decimals, or empty if `clear`.
    pub fn new(document: &Document, cell: &Cell, clear: bool) -> Self {
        let text = match cell.number(document) {
            _ if clear => String::new(),
            Some(number) if cell.is_number() => numbers::exact(number),
            _ => field::value(document, &cell.pointer).and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default(),
        };
        Entry { text: Text::new(text, true) }
    }
}
