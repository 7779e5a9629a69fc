//! What is looked at alone, not looked at, or kept from edits for now. The scene and its exports know nothing of it.

use std::collections::BTreeSet;

use super::State;
use crate::base::pointer::Pointer;
use crate::layers::parts::materials::{List, Of, Use};
use crate::render::shown::Shown;
use crate::scene::{Document, Edit, address};
use crate::tui::events::{Change, Effect};
use crate::tui::text::plain;

/// Layers and zones by their pointers, and what is compared.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Apart {
    /// They are not shown.
    pub muted: BTreeSet<String>,
    /// If there are any, only they are shown.
    pub solo: BTreeSet<String>,
    /// They are not changed.
    pub locked: BTreeSet<String>,
    /// The comparison that is shown, such as "anchor": the scene in all its ways, side by side.
    pub compared: Option<String>,
}

impl Apart {
    /// How the scene is shown.
    pub fn shown(&self, document: &Document) -> Shown {
        Shown { muted: self.hidden(document), compared: self.compared.clone() }
    }

    /// What is not shown.
    pub fn hidden(&self, document: &Document) -> Vec<String> {
        let mut hidden = self.muted.clone();
        if !self.solo.is_empty() {
            for (i, layer) in document.scene().layers.iter().enumerate() {
                let own = format!("/layers/{i}");
                let zones: Vec<&String> = self.solo.iter().filter(|one| one.starts_with(&format!("{own}/"))).collect();
                match self.solo.contains(&own) {
                    true => {}
                    false if zones.is_empty() => drop(hidden.insert(own)),
                    // Its own picture stays below them.
                    false => hidden
                        .extend(siblings(document, &zones).filter(|one| layer.technique().can_mute(&one[own.len()..]))),
                }
            }
        }
        hidden.into_iter().collect()
    }

    /// Letters for the thing at a place, as the keys are: x if it is muted, s if it is solo, L if it is locked.
    pub fn told(&self, pointer: &str) -> String {
        let letters = [(&self.muted, "x"), (&self.solo, "s"), (&self.locked, "L")];
        letters.into_iter().filter(|(set, _)| set.contains(pointer)).map(|(_, letter)| letter).collect()
    }

    fn follow(&mut self, change: &Change) {
        for set in [&mut self.muted, &mut self.solo, &mut self.locked] {
            *set = set.iter().filter_map(|pointer| change.edit.follow(&change.document, pointer)).collect();
        }
    }

    fn is_empty(&self) -> bool {
        *self == Apart::default()
    }
}

/// The other items of the lists that these are in.
fn siblings<'a>(document: &'a Document, items: &'a [&'a String]) -> impl Iterator<Item = String> + 'a {
    let lists: BTreeSet<&str> = items.iter().filter_map(|item| Pointer(item).parent()).collect();
    let all = lists.into_iter().flat_map(|list| {
        let count = document.json().pointer(list).and_then(serde_json::Value::as_array).map_or(0, Vec::len);
        (0..count).map(|i| Pointer(list).join(i)).collect::<Vec<_>>()
    });
    all.filter(|one| !items.contains(&one))
}

/// The shapes that a layer or a zone is made of.
fn shapes_in(document: &Document, pointer: &str) -> Vec<String> {
    let Some((index, way)) = Pointer(pointer).item_of("/layers") else { return Vec::new() };
    let uses = document.scene().layers.get(index).map(|layer| layer.technique().uses()).unwrap_or_default();
    let within = |at: &str| at.strip_prefix(way).is_some_and(|rest| rest.starts_with('/'));
    let named = |one: Use| match one.of {
        Of::Name(List::Shapes, name) if within(&one.at) => Some(name.to_owned()),
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
    pub(super) fn follow_apart(&mut self, change: &Change) {
        if !self.apart.is_empty() {
            self.apart.follow(change);
            self.ask(Effect::Mute);
        }
    }
}
