//! What is locked is not edited; after an edit, what is apart goes along.

use super::State;
use crate::base::pointer::Pointer;
use crate::layers::parts::materials::{List, Of, Use};
use crate::scene::{Document, Edit, address};
use crate::tui::events::{Effect, Published};
use crate::tui::text::plain;

/// The shapes that a layer or a zone is made of.
fn shapes_in(document: &Document, pointer: &str) -> Vec<String> {
    let Some((index, way)) = Pointer(pointer).item_of("/layers") else { return Vec::new() };
    let uses = document.scene().layers.get(index).map(|layer| layer.technique().uses()).unwrap_or_default();
    let named = |one: Use| match one.of {
        Of::Name(List::Shapes, name) if Pointer(&one.at).is_inside(way) => Some(name.to_owned()),
        _ => None,
    };
    uses.into_iter().filter_map(named).collect()
}

impl State {
    /// Refuses an edit of what is locked, also through a shape that it is made of.
    ///
    /// # Errors
    /// What that is, and how it is unlocked.
    pub fn unlocked(&self, edit: &Edit) -> Result<(), String> {
        if self.apart.locked.is_empty() {
            return Ok(());
        }
        let before = self.document();
        // What is wrong with an edit is told when it is applied.
        let Ok(after) = before.apply(edit) else { return Ok(()) };
        let shapes = |document: &Document, name: &str| document.json().pointer(&Pointer("/shapes").join(name)).cloned();
        let is_touched = |pointer: &&String| {
            let now = edit.follow(&after, pointer);
            let own = now.and_then(|now| after.json().pointer(&now)) != before.json().pointer(pointer);
            own || shapes_in(before, pointer).iter().any(|name| shapes(before, name) != shapes(&after, name))
        };
        self.apart.locked.iter().find(is_touched).map_or(Ok(()), |pointer| {
            let place = plain(&address::address(before, pointer));
            Err(format!("{place} is locked: :lock {place} (L on it) unlocks it"))
        })
    }

    /// After an edit, what is apart goes along.
    pub(super) fn follow_apart(&mut self, change: &Published) {
        if !self.apart.is_empty() {
            self.apart.follow(change);
            self.ask(Effect::Mute);
        }
    }
}
