//! A layer after an edit: only what has changed is read again, so that editing one anchor among a thousand costs no
//! more than editing a single one. The result is the same as reading the whole layer.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::model::{PictureLayer, Zone};
use crate::base::change::{Change, Items};

/// The layer that `json` means, if `change` is how it differs from what `old` was read from; `None` if it must be read
/// as a whole.
pub fn layer(old: &PictureLayer, json: &Value, change: &Change) -> Option<PictureLayer> {
    let zones = list(&old.zones, json, change, "zones", zone)?;
    let bare: PictureLayer = without(json, &["kind", "zones"])?;
    Some(PictureLayer { zones, ..bare })
}

fn zone(old: &Zone, json: &Value, change: &Change) -> Option<Zone> {
    let motion = list(&old.motion, json, change, "motion", |_, json, _| read(json))?;
    let bare: Zone = without(json, &["motion"])?;
    Some(Zone { motion, ..bare })
}

fn read<T: DeserializeOwned>(json: &Value) -> Option<T> {
    T::deserialize(json).ok()
}

/// Reads an object without some of its fields.
fn without<T: DeserializeOwned>(json: &Value, fields: &[&str]) -> Option<T> {
    let kept = json.as_object()?.iter().filter(|(name, _)| !fields.contains(&name.as_str()));
    let kept: Map<String, Value> = kept.map(|(name, value)| (name.clone(), value.clone())).collect();
    T::deserialize(Value::Object(kept)).ok()
}

/// The list in the field `name` of `json`: unchanged items come from `old`, `reread` reads those that changed in part.
fn list<T: Clone + DeserializeOwned>(
    old: &[T],
    json: &Value,
    change: &Change,
    name: &str,
    reread: impl Fn(&T, &Value, &Change) -> Option<T>,
) -> Option<Vec<T>> {
    let Some(all) = json.get(name) else { return Some(Vec::new()) };
    match change.field(name) {
        Change::Same => Some(old.to_vec()),
        Change::Items(items) => {
            let Items { ahead, behind, .. } = items;
            let between = items.each().map(|(i, change)| match (change, all.get(i)?) {
                (Change::Same, _) => old.get(i).cloned(),
                (Change::Other, json) => read(json),
                (change, json) => reread(old.get(i)?, json, change),
            });
            let between: Vec<T> = between.collect::<Option<_>>()?;
            let behind = old.get(old.len().checked_sub(*behind)?..)?;
            Some([old.get(..*ahead)?, &between, behind].concat())
        }
        _ => read(all),
    }
}
