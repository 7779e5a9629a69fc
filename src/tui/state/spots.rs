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

    /// Brings the cursor back to a place, or as near to it as there is one.
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

    /// Where the cursor is, to be gone back to as if nothing had been.
    pub fn origin(&self) -> Origin {
        Origin { spot: self.spot(), cursor: self.cursor.clone() }
    }

    /// Goes back there.
    pub fn return_to_origin(&mut self, origin: &Origin) {
        self.return_to(&origin.spot);
        // The scene may have changed since: the cursor itself is where it can be.
        let Cursor { focus, node, row, column, .. } = self.cursor.clone();
        self.cursor = Cursor { focus, node, row, column, ..origin.cursor.clone() };
    }
}
