//! Where the cursor is, going to places, and back.

use super::State;
use super::cursor::{Cursor, Pane};
use super::finding::{Origin, Spot};
use crate::scene::address;
use crate::tui::events::Effect;

impl State {
    /// What is under the cursor: the cell in a table or form, else the node.
    pub fn here(&self) -> String {
        match self.row().filter(|_| self.cursor.focus != Pane::Tree) {
            Some(row) => self.cursor.cell(&row).map_or(&row.pointer, |cell| &cell.pointer).clone(),
            None => self.cursor.node.clone(),
        }
    }

    /// The place that an address means, typed with the cursor where it is.
    ///
    /// # Errors
    /// As [`address::resolve`].
    pub fn resolve(&self, address: &str) -> Result<String, String> {
        let whole = address::around(self.document(), &self.here(), address);
        whole.and_then(|whole| address::resolve(self.document(), &whole)).map_err(|error| error.to_string())
    }

    /// Where the cursor is.
    pub fn spot(&self) -> Spot {
        let cursor = &self.cursor;
        Spot { focus: cursor.focus, node: cursor.node.clone(), row: self.focused(), column: cursor.column }
    }

    /// Moves the cursor back to a place, or as near as possible.
    pub fn return_to(&mut self, spot: &Spot) {
        self.cursor.expand_to(&spot.node);
        self.show(spot.node.clone());
        self.settle();
        let row = self.sheet().position(&spot.row).filter(|_| self.cursor.node == spot.node);
        let cursor = &mut self.cursor;
        (cursor.row, cursor.column, cursor.focus) = (row.unwrap_or(cursor.row), spot.column, spot.focus);
        self.settle();
        self.ask(Effect::Show);
    }

    /// Where the cursor is, with all that a search may change.
    pub fn origin(&self) -> Origin {
        Origin { spot: self.spot(), cursor: self.cursor.clone() }
    }

    /// Undoes what a search has changed.
    pub fn return_to_origin(&mut self, origin: &Origin) {
        self.return_to(&origin.spot);
        // The scene may have changed since then, so the place stays as `return_to` found it.
        let Cursor { focus, node, row, column, .. } = self.cursor.clone();
        self.cursor = Cursor { focus, node, row, column, ..origin.cursor.clone() };
    }
}
