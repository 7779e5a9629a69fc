//! Going to places and back.

use super::State;
use super::finding::{Origin, Spot};
use crate::tui::events::Effect;

impl State {
    /// Where the cursor is.
    pub fn spot(&self) -> Spot {
        Spot { focus: self.focus, node: self.node.clone(), row: self.focused(), column: self.column }
    }

    /// Brings the cursor back to a place, or as near to it as there is one.
    pub fn return_to(&mut self, spot: &Spot) {
        self.unfold(&spot.node);
        self.show(spot.node.clone());
        self.settle();
        let row = self.sheet().position(&spot.row).filter(|_| self.node == spot.node);
        (self.row, self.column, self.focus) = (row.unwrap_or(self.row), spot.column, spot.focus);
        self.settle();
        self.ask(Effect::Show);
    }

    /// Where the cursor is, to be gone back to as if nothing had been.
    pub fn origin(&self) -> Origin {
        let (folded, selection) = (self.folded.clone(), self.kept.selection.clone());
        Origin { spot: self.spot(), folded, selected: (self.selected_from, self.selected_to), selection }
    }

    /// Goes back there.
    pub fn return_to_origin(&mut self, origin: &Origin) {
        self.return_to(&origin.spot);
        self.folded.clone_from(&origin.folded);
        (self.selected_from, self.selected_to) = origin.selected;
        self.kept.selection.clone_from(&origin.selection);
    }

    /// Unfolds what holds the node at `pointer` in the tree.
    pub fn unfold(&mut self, pointer: &str) {
        self.folded.retain(|folded| !pointer.strip_prefix(folded.as_str()).is_some_and(|rest| rest.starts_with('/')));
    }
}
