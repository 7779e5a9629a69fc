//! Marks, the jump list and the search. Remembered places follow their items through edits.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cursor::{Cursor, Pane};
use crate::base::pointer::Pointer;
use crate::scene::Document;
use crate::tui::document::places;
use crate::tui::document::places::Listed;
use crate::tui::events::Published;

/// The most places in the jump list.
const MOST_JUMPS: usize = 100;

/// A place of the cursor that can be returned to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spot {
    /// The pane that had the focus.
    pub focus: Pane,
    /// The node that was shown.
    pub node: String,
    /// The row under the cursor, by its pointer.
    pub row: String,
    /// The index of the cell in the row.
    pub column: usize,
}

/// Where the cursor was when a search began, so that cancelling it changes nothing.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The place.
    pub spot: Spot,
    /// The cursor with its selection and the collapsed nodes.
    pub cursor: Cursor,
}

/// Marks, jumps and the search.
#[derive(Clone, Debug, Default)]
pub struct Finding {
    /// What was searched for last.
    pub sought: String,
    /// Where the cursor was when a search began to be typed.
    pub origin: Option<Origin>,
    marks: BTreeMap<char, Spot>,
    older: Vec<Spot>,
    newer: Vec<Spot>,
    listed: Option<(Document, Arc<[Listed]>)>,
}

impl Finding {
    /// Sets a mark.
    pub fn mark(&mut self, name: char, spot: Spot) {
        self.marks.insert(name, spot);
    }

    /// All marks.
    pub fn marks(&self) -> impl Iterator<Item = (char, &Spot)> {
        self.marks.iter().map(|(letter, spot)| (*letter, spot))
    }

    /// Where a mark was set.
    pub fn marked(&self, name: char) -> Option<&Spot> {
        self.marks.get(&name)
    }

    /// Remembers the place that a jump leaves.
    pub fn left(&mut self, spot: Spot) {
        if self.older.last() != Some(&spot) {
            self.older.push(spot);
        }
        if self.older.len() > MOST_JUMPS {
            self.older.remove(0);
        }
        self.newer.clear();
    }

    /// The place that an older (or newer) jump left, from `here`; `None` at the end.
    pub fn back(&mut self, older: bool, here: Spot) -> Option<Spot> {
        let (from, to) = match older {
            true => (&mut self.older, &mut self.newer),
            false => (&mut self.newer, &mut self.older),
        };
        let last = from.iter().rposition(|spot| *spot != here)?;
        from.truncate(last + 1);
        let spot = from.pop()?;
        to.push(here);
        Some(spot)
    }

    /// The pointers of the places that jumps have left, the latest first.
    pub fn jumps(&self) -> impl Iterator<Item = &str> {
        self.older.iter().rev().map(|spot| spot.row.as_str())
    }

    /// After an edit: places follow their items; those of deleted items stay at the list.
    pub fn follow(&mut self, change: &Published) {
        self.older.iter_mut().chain(&mut self.newer).chain(self.marks.values_mut()).for_each(|spot| {
            spot.node = followed(&spot.node, change);
            spot.row = followed(&spot.row, change);
        });
    }

    /// All places of the scene.
    pub fn listed(&mut self, document: &Document) -> Arc<[Listed]> {
        let known = self.listed.as_ref().filter(|(of, _)| Arc::ptr_eq(of.scene(), document.scene()));
        if let Some((_, listed)) = known {
            return listed.clone();
        }
        let listed: Arc<[Listed]> = places::list(document).into();
        self.listed = Some((document.clone(), listed.clone()));
        listed
    }
}

fn followed(pointer: &str, change: &Published) -> String {
    Pointer(pointer).upward().find_map(|at| change.edit.follow(&change.document, at)).unwrap_or_default()
}
