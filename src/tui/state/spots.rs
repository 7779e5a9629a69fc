//! Going to places and back.

use super::State;
use super::cursor::Cursor;
use super::finding::{Origin, Spot};
use crate::tui::events::Effect;

impl State {
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
