//! What layers name by its name in the scene: images, meshes, clips, other layers. A layer that another shows as a texture is
//! not composed by itself.

use std::collections::{BTreeMap, BTreeSet};

use super::Scene;
use crate::base::problem::{Problem, nearest, quoted};
use crate::layers::parts::materials::{List, Of};

/// At most this many unknown references of a layer are listed.
const MAX_REFERENCES: usize = 100;

impl Scene {
    /// The names in one of its lists.
    pub fn names(&self, list: List) -> BTreeSet<&str> {
        match list {
            List::Images => self.images.keys().map(String::as_str).collect(),
            List::Meshes => self.meshes.keys().map(String::as_str).collect(),
            List::Clips => self.clips.keys().map(String::as_str).collect(),
            List::Shapes => self.shapes.keys().map(String::as_str).collect(),
            List::Layers => self.layers.iter().map(|layer| layer.technique().name()).collect(),
        }
    }

    /// For each layer, the indices of the layers that it shows as textures, each with the pointer, relative to the
    /// layer, to where it is named.
    pub fn shown_by(&self, layer: usize) -> Vec<(usize, String)> {
        let index = |name: &str| self.layers.iter().position(|layer| layer.technique().name() == name);
        let uses = self.layers.get(layer).map(|layer| layer.technique().uses()).unwrap_or_default();
        let shown = uses.into_iter().filter_map(|used| match used.of {
            Of::Name(List::Layers, name) => Some((index(name)?, used.at)),
            Of::Name(..) | Of::Path(_) => None,
        });
        shown.collect()
    }

    /// The layers that others show as textures.
    pub fn textures(&self) -> BTreeSet<usize> {
        // A layer alone is shown by none, and need not go through all that it names.
        let several = (0..self.layers.len()).filter(|_| self.layers.len() > 1);
        several.flat_map(|i| self.shown_by(i)).map(|(shown, _)| shown).collect()
    }
}

/// Problems with what layers name and the scene does not have, and with layers that show themselves.
pub fn problems(scene: &Scene) -> Vec<Problem> {
    let mut names = BTreeMap::new();
    let mut problems = Vec::new();
    for (i, layer) in scene.layers.iter().enumerate() {
        let mut unknown = Vec::new();
        for used in layer.technique().uses() {
            let Of::Name(list, name) = used.of else { continue };
            let (key, item) = list.words();
            let known = names.entry(key).or_insert_with(|| scene.names(list));
            if known.contains(name) || unknown.len() == MAX_REFERENCES {
                continue;
            }
            // A layer that shows itself is no cure.
            let own = layer.technique().name();
            let others = known.iter().copied().filter(|other| list != List::Layers || *other != own);
            let hint = nearest(name, others);
            let hint = hint.unwrap_or_else(|| match list {
                List::Shapes => "the scene has no shapes yet: share one of its paths (:share NAME)".to_owned(),
                _ if name.is_empty() => format!("add one to the scene's {key} first, and name it here"),
                List::Images | List::Meshes | List::Clips | List::Layers => format!("add it to the scene's {key}"),
            });
            let message = match name {
                "" => format!("names no {item}"),
                _ => format!("there is no {item} {}", quoted(name)),
            };
            unknown.push(Problem::error(format!("/layers/{i}{}", used.at), message).hint(hint));
        }
        problems.extend(unknown);
        problems.extend(circle(scene, i));
    }
    problems
}

/// The place where a layer names what, in the end, shows the layer itself.
fn circle(scene: &Scene, layer: usize) -> Option<Problem> {
    let reaches = |first: usize| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![first]);
        while let Some(at) = next.pop() {
            if seen.insert(at) {
                next.extend(scene.shown_by(at).into_iter().map(|(shown, _)| shown));
            }
        }
        seen.contains(&layer)
    };
    let (shown, at) = scene.shown_by(layer).into_iter().find(|(shown, _)| reaches(*shown))?;
    let what = match shown == layer {
        true => "the layer shows itself".to_owned(),
        false => format!("the layer shows itself, by {}", quoted(scene.layers[shown].technique().name())),
    };
    Some(Problem::error(format!("/layers/{layer}{at}"), what).hint("name a layer that does not show this one"))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_is_named_and_not_there_is_told_with_the_cure() {
        for (surface, told, cure) in [
            (json!({ "kind": "texture", "image": "" }), "names no image", "add one to the scene's images first"),
            (json!({ "kind": "texture", "image": "a" }), "there is no image \"a\"", "add it to the scene's images"),
            (json!({ "kind": "layer", "layer": "" }), "names no layer", "add one to the scene's layers first"),
            (json!({ "kind": "layer", "layer": "spo" }), "there is no layer \"spo\"", "add it to the scene's layers"),
        ] {
            let layer = json!({ "kind": "mesh", "name": "spot", "mesh": "m", "surface": surface });
            let scene = json!({ "plica": 1, "meshes": { "m": { "path": "m.obj" } }, "layers": [layer] });
            let found = problems(&serde_json::from_value(scene).unwrap());
            let [Problem { message, hint: Some(hint), .. }] = &found[..] else { panic!("{found:?}") };
            assert!(message == told && hint.starts_with(cure), "{surface}: {message} ({hint})");
        }
    }
}
