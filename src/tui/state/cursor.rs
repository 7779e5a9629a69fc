//! Where the cursor is, and which rows are selected.

use std::collections::BTreeSet;

use crate::base::pointer::Pointer;
use crate::tui::document::cell::Cell;
use crate::tui::document::sheet::{Row, Sheet};

/// A pane that can have the focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The tree of the scene.
    Tree,
    /// The form or table.
    Table,
    /// The picture.
    Picture,
}

/// A selection of rows that has ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// Pointer of the node whose rows were selected.
    pub node: String,
    /// The rows.
    pub rows: BTreeSet<usize>,
    /// The row where the cursor was.
    pub row: usize,
}

/// The cursor in the tree and in the sheet of the node that it is on.
#[derive(Clone, Debug)]
pub struct Cursor {
    /// The pane that takes the keys.
    pub focus: Pane,
    /// Whether that pane has the whole screen.
    pub enlarged: bool,
    /// Pointer of the node that is shown in the middle column.
    pub node: String,
    /// Nodes of the tree that are collapsed.
    pub collapsed: BTreeSet<String>,
    /// The row of the sheet under the cursor.
    pub row: usize,
    /// The cell of the row under the cursor.
    pub column: usize,
    /// The row where the selection began.
    pub selected_from: Option<usize>,
    /// The row where the selection ends; `None` if it ends at the cursor.
    pub selected_to: Option<usize>,
    /// Rows that are selected one by one, or because something holds for them; besides those from `selected_from` on.
    pub picked: BTreeSet<usize>,
    /// The last selection that has ended, for `gv`.
    pub last_selection: Option<Selection>,
}

impl Cursor {
    /// The cursor in the tree, on a node.
    pub fn new(node: String) -> Cursor {
        Cursor {
            focus: Pane::Tree,
            enlarged: false,
            node,
            collapsed: BTreeSet::new(),
            row: 0,
            column: 0,
            selected_from: None,
            selected_to: None,
            picked: BTreeSet::new(),
            last_selection: None,
        }
    }

    /// The rows that an edit applies to, in order: the selection, else the row under the cursor.
    pub fn rows(&self) -> BTreeSet<usize> {
        let mut rows = self.picked.clone();
        if let Some(from) = self.selected_from {
            let to = self.selected_to.unwrap_or(self.row);
            rows.extend(from.min(to)..=from.max(to));
        } else if rows.is_empty() {
            rows.insert(self.row);
        }
        rows
    }

    /// Whether rows are selected.
    pub fn selects(&self) -> bool {
        self.selected_from.is_some() || !self.picked.is_empty()
    }

    /// Selects these rows and no others.
    pub fn pick(&mut self, rows: BTreeSet<usize>) {
        (self.selected_from, self.selected_to, self.picked) = (None, None, rows);
    }

    /// Ends the selection, which `gv` takes up again; false if there is none.
    pub fn unselect(&mut self) -> bool {
        let selects = self.selects();
        if selects {
            self.last_selection = Some(Selection { node: self.node.clone(), rows: self.rows(), row: self.row });
        }
        self.pick(BTreeSet::new());
        selects
    }

    /// The cell of this row that the cursor is on.
    pub fn cell<'a>(&self, row: &'a Row) -> Option<&'a Cell> {
        row.cells.get(self.column)
    }

    /// Moves the cursor and the selection back to rows and a cell that exist.
    pub fn settle(&mut self, sheet: &Sheet) {
        let last = sheet.len().saturating_sub(1);
        self.row = self.row.min(last);
        self.column = self.column.min(sheet.row(self.row).map_or(0, |row| row.cells.len().saturating_sub(1)));
        self.selected_from = self.selected_from.map(|row| row.min(last));
        self.selected_to = self.selected_to.map(|row| row.min(last)).filter(|_| self.selected_from.is_some());
        let selected = !self.picked.is_empty();
        self.picked.retain(|row| *row <= last);
        if selected && self.picked.is_empty() {
            self.picked.insert(self.row);
        }
    }

    /// Expands the ancestors of the node at `pointer` in the tree.
    pub fn expand_to(&mut self, pointer: &str) {
        self.collapsed.retain(|node| !Pointer(pointer).is_inside(node));
    }
}
