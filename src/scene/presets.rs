//! Presets of layers, as their techniques bring them: the list, and the edit that applies one to a layer.

use serde_json::{Map, Value};

use super::edit::Edit;
use super::{Document, json};
use crate::base::pointer::Pointer;
use crate::base::problem;
use crate::layers::KINDS;
use crate::layers::starts::Preset;
use crate::layers::technique::{Kind, Technique};

/// A preset, with the technique whose layers it is for.
#[derive(Clone, Copy, Debug)]
pub struct Offered {
    /// The technique.
    pub kind: &'static Kind,
    /// The preset.
    pub preset: &'static Preset,
}

/// What applying a preset does.
#[derive(Clone, Debug)]
pub struct Applied {
    /// The edit; empty if the layer is so already.
    pub edit: Edit,
    /// What was done and what else is needed, in words.
    pub told: String,
}

/// All presets of all techniques.
pub fn all() -> impl Iterator<Item = Offered> + Clone {
    KINDS.iter().flat_map(|kind| kind.presets.iter().map(move |preset| Offered { kind, preset }))
}

/// The preset of this name.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> Result<Offered, String> {
    let unknown = || {
        let hint = problem::nearest(name, all().map(|found| found.preset.name)).unwrap_or_default();
        format!("there is no preset {} ({hint})", problem::quoted(name))
    };
    all().find(|found| found.preset.name == name).ok_or_else(unknown)
}

impl Offered {
    /// The preset applied to the layer `name`, or to the first one that it is for.
    ///
    /// # Errors
    /// There is no such layer, or the preset is not for it.
    pub fn apply(&self, document: &Document, name: Option<&str>) -> Result<Applied, String> {
        let Preset { name: own, wants, .. } = self.preset;
        let (index, layer) = layer_of(document, name, own, self.kind.name)?;
        let edit = Edit::merge(document, &format!("/layers/{index}"), &self.patch()?);
        let done = if edit.is_empty() { "changes nothing in" } else { "is applied to" };
        let wants = if wants.is_empty() || edit.is_empty() { String::new() } else { format!("; it wants {wants}") };
        Ok(Applied { told: format!("{own} {done} {}{wants}", layer.name()), edit })
    }

    /// What it changes: a JSON Merge Patch (RFC 7396) on the layer.
    fn patch(&self) -> Result<Value, String> {
        json::parse(self.preset.patch).map_err(|problem| format!("{}: {problem}", self.preset.name))
    }
}

/// The layer `name`, or the first one of a kind, for something called `own`.
///
/// # Errors
/// There is no such layer, or it is of another kind.
pub(super) fn layer_of<'a>(
    document: &'a Document,
    name: Option<&str>,
    own: &str,
    kind: &str,
) -> Result<(usize, &'a dyn Technique), String> {
    let layers = document.scene().layers.iter().map(|layer| layer.technique()).enumerate();
    let mut named = layers.filter(|(_, layer)| name.is_none_or(|name| layer.name() == name));
    let first = named.clone().next();
    name.map_or(Ok(0), |name| document.scene().layer_called(name))?;
    let found = named.find(|(_, layer)| layer.kind().name == kind);
    found.ok_or_else(|| match (name, first) {
        (Some(name), Some((_, other))) => {
            format!("{own} is for layers of kind {kind}; {name} is of kind {}", other.kind().name)
        }
        _ => format!("{own} is for layers of kind {kind}, and the scene has none"),
    })
}

impl Edit {
    /// Applies a JSON Merge Patch (RFC 7396) to what is written at `path`. What is the same already is left alone.
    pub fn merge(document: &Document, path: &str, patch: &Value) -> Edit {
        let mut edits = Vec::new();
        if let (Some(written), Value::Object(patch)) = (document.json().pointer(path), patch) {
            merge(written, patch, path, &mut edits);
        }
        Edit::all(edits)
    }
}

fn merge(written: &Value, patch: &Map<String, Value>, path: &str, edits: &mut Vec<Edit>) {
    for (key, value) in patch {
        let below = Pointer(path).join(key);
        match (written.get(key), value) {
            (Some(old @ Value::Object(_)), Value::Object(patch)) => merge(old, patch, &below, edits),
            (Some(_), Value::Null) => edits.push(Edit::remove(&below)),
            (None, Value::Null) => {}
            (Some(old), value) if old == value => {}
            (Some(_), value) => edits.push(Edit::replace(&below, value.clone())),
            (None, value) => edits.push(Edit::add(&below, value.clone())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_are_unique_and_every_preset_fits_a_layer_of_its_technique() {
        for found in all() {
            let name = found.preset.name;
            assert_eq!(all().filter(|other| other.preset.name == name).count(), 1, "{name}");
            let scene: Value = json::parse(found.kind.example).unwrap();
            let document = Document::from_json(scene).unwrap();
            let Applied { edit, told } = found.apply(&document, None).unwrap();
            let with = document.apply(&edit).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
            assert!(told.contains(name), "{told}");
            let again = found.apply(&with, None).unwrap();
            assert!(again.edit.is_empty(), "{name}: {:?}", again.edit);
        }
    }

    #[test]
    fn a_merge_patch_changes_only_what_differs_and_null_removes() {
        let stops = json!([[0, "#000000"], [1, "#ffffff"]]);
        let gradient = json!({ "from": [0, 0], "to": [9, 0], "stops": stops });
        let layer = json!({ "kind": "fill", "name": "sky", "gradient": gradient });
        let document = Document::from_json(json!({ "plica": 1, "layers": [layer] })).unwrap();
        let merged = |patch: Value| {
            let edit = Edit::merge(&document, "/layers/0", &patch);
            let with = document.apply(&edit).unwrap();
            (edit.0.0.len(), with.json()["layers"][0].clone())
        };
        let (count, layer) = merged(json!({ "name": "sky", "gradient": { "to": [5, 0] }, "color": "#ff0000" }));
        assert_eq!(count, 2, "the name is the same already");
        assert_eq!(layer["gradient"], json!({ "from": [0, 0], "to": [5, 0], "stops": stops }));
        assert_eq!(layer["color"], "#ff0000");
        let (count, layer) = merged(json!({ "gradient": null, "color": null }));
        assert_eq!((count, layer), (1, json!({ "kind": "fill", "name": "sky" })));
    }
}
