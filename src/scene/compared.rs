//! A scene in several ways, to be looked at side by side: with each anchor, in each style.

use serde::Deserialize;
use serde_json::Value;

use super::Scene;
use crate::base::problem;
use crate::layers::starts::Comparison;
use crate::layers::{KINDS, Layer};

/// The names of all comparisons.
pub fn names() -> Vec<&'static str> {
    KINDS.iter().flat_map(|kind| kind.comparisons.iter().map(|comparison| comparison.by)).collect()
}

impl Scene {
    /// The scene in each of the ways that its layers have by something (see [`names`]), with their names, from left to right.
    /// All layers that have such ways have the same.
    ///
    /// # Errors
    /// No layer has any, or there is nothing of that name.
    pub fn compared(&self, by: &str) -> Result<Vec<(&'static str, Scene)>, String> {
        let mut found: Vec<(&'static str, Scene)> = Vec::new();
        for (i, layer) in self.layers.iter().enumerate() {
            let ways = comparison(layer, by).map(|own| ways(own, layer)).transpose()?.unwrap_or_default();
            if found.is_empty() {
                found = ways.iter().map(|(name, _)| (*name, self.clone())).collect();
            }
            found.iter_mut().zip(ways).for_each(|((_, scene), (_, way))| scene.layers[i] = way);
        }
        match found.is_empty() {
            false => Ok(found),
            true if names().contains(&by) => Err(format!("no layer has strokes, of which each {by} could be shown")),
            true => {
                let hint = problem::nearest(by, names().into_iter()).unwrap_or_default();
                Err(format!("nothing is compared by {} ({hint})", problem::quoted(by)))
            }
        }
    }
}

fn comparison(layer: &Layer, by: &str) -> Option<&'static Comparison> {
    layer.technique().kind().comparisons.iter().find(|own| own.by == by)
}

fn ways(comparison: &Comparison, layer: &Layer) -> Result<Vec<(&'static str, Layer)>, String> {
    let read = |(name, way): (&'static str, Value)| Ok((name, Layer::deserialize(&way)?));
    let json = serde_json::to_value(layer);
    let ways = json.and_then(|json| (comparison.ways)(&json).into_iter().map(read).collect());
    ways.map_err(|error: serde_json::Error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;
    use serde_json::json;

    fn scene(strokes: &Value) -> Document {
        Document::from_json(json!({ "plica": 1, "size": [8, 6], "camera": { "position": [0, 0, 3] },
            "meshes": { "m": { "path": "m.obj" } },
            "layers": [{ "kind": "fill", "name": "sky", "color": "#102030" },
                { "kind": "mesh", "name": "m", "mesh": "m", "strokes": strokes }] }))
        .unwrap()
    }

    #[test]
    fn every_way_is_a_scene_that_is_right() {
        let own = json!({ "style": "hatching", "anchor": "screen", "noises": { "a": { "anchor": "texture" } } });
        for (by, expected) in [("anchor", 3), ("style", 9)] {
            let ways = scene(&own).scene().compared(by).unwrap();
            assert_eq!(ways.len(), expected, "{by}");
            for (name, way) in ways {
                let written = serde_json::to_value(&way).unwrap();
                let way =
                    Document::from_json(written.clone()).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
                let strokes = &written["layers"][1]["strokes"];
                assert_eq!(strokes[by], name, "{strokes}");
                assert_eq!(way.scene().layers[0], scene(&own).scene().layers[0], "others stay");
                if by == "anchor" {
                    let noises = strokes["noises"].as_object().unwrap();
                    assert!(noises.len() > 1 && noises.values().all(|noise| noise["anchor"] == name), "{strokes}");
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_compared_says_why() {
        for (strokes, by, told) in [
            (json!(null), "anchor", "no layer has strokes, of which each anchor could be shown"),
            (json!({}), "color", "nothing is compared by \"color\" (there are \"anchor\", \"style\")"),
        ] {
            assert_eq!(scene(&strokes).scene().compared(by).unwrap_err(), told);
        }
    }
}
