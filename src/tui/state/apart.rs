//! What is looked at alone, not looked at, or kept from edits for now. The scene and its exports know nothing of it.

use std::collections::BTreeSet;

use crate::base::pointer::Pointer;
use crate::render::shown::Shown;
use crate::scene::Document;
use crate::tui::events::Published;

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
        Shown { muted: self.hidden(document), compared: self.compared.clone(), sight: None }
    }

    /// What is not shown.
    pub fn hidden(&self, document: &Document) -> Vec<String> {
        let mut hidden = self.muted.clone();
        if !self.solo.is_empty() {
            for (i, layer) in document.scene().layers.iter().enumerate() {
                let own = format!("/layers/{i}");
                let zones: Vec<&String> =
                    self.solo.iter().filter(|one| **one != own && Pointer(one).is_within(&own)).collect();
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

    pub(super) fn follow(&mut self, change: &Published) {
        for set in [&mut self.muted, &mut self.solo, &mut self.locked] {
            *set = set.iter().filter_map(|pointer| change.edit.follow(&change.document, pointer)).collect();
        }
    }

    pub(super) fn is_empty(&self) -> bool {
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
